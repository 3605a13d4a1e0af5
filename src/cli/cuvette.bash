# bash completion for cuvette(1)                                        -*- shell-script -*-
# Parameter names come from the program itself, so that both always agree.

_cuvette_files() # ENDINGS: completes files that match the pattern, and folders
{
    local IFS=$'\n'
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -X "!*.@($1)" -- "$current"; compgen -d -- "$current")
}

_cuvette_words() # WORD...
{
    mapfile -t COMPREPLY < <(compgen -W "$*" -- "$current")
}

# Completes parameter paths of the scene on the command line, or of the general table without one.
_cuvette_parameters()
{
    local word scene=
    for word in "${COMP_WORDS[@]}"; do
        [[ $word == *.@(yaml|yml) && -r $word ]] && scene=$word
    done
    compopt -o nospace
    _cuvette_words "$("${COMP_WORDS[0]}" params ${scene:+"$scene"} 2>/dev/null |
        awk 'NR > 1 && $1 !~ /^[A-Z]+\./ { print $1 "=" }')"
}

_cuvette_objects() # SUFFIX WORD...: completes the objects of the scene on the command line, the camera, and these words
{
    local word scene= suffix=$1
    shift
    for word in "${COMP_WORDS[@]}"; do
        [[ $word == *.@(yaml|yml) && -r $word ]] && scene=$word
    done
    [[ -z $suffix ]] || compopt -o nospace
    _cuvette_words "$({ printf 'x %s\n' camera "$@"; [[ $scene ]] && "${COMP_WORDS[0]}" scene "$scene" --list 2>/dev/null; } | awk -v s="$suffix" '{ print $2 s }')"
}

_cuvette_axes() # OPTION: completes the parameters in the grid of the study on the command line
{
    local word study= suffix=
    for word in "${COMP_WORDS[@]}"; do
        [[ $word == *.study && -r $word ]] && study=$word
    done
    [[ $1 == -w || $1 == --where ]] && suffix='=' && compopt -o nospace
    [[ -z $study ]] || _cuvette_words "$(sed -n '/^grid:/,/^[a-z]*:/p' "$study" |
        grep -oE '[A-Za-z0-9_]+(\.[A-Za-z0-9_]+)+ *:' | sed "s/ *:/$suffix/" | sort -u)"
}

_cuvette_value() # OPTION: completes its value; false for a flag
{
    case $1 in
    -s | --set | -a | --axis) _cuvette_parameters ;;
    --generate) _cuvette_words sparse dense sphere icosphere torus lathe terrain box ;;
    -f | --format)
        case ${COMP_WORDS[1]-} in
        study) _cuvette_words png svg pdf ;;
        *) _cuvette_words obj ply glb ;;
        esac
        ;;
    --log) _cuvette_words x y xy none ;;
    --y) _cuvette_words wall_s cpu_s rays_total busy_s_mean imbalance peak_rss_bytes build_s error_rms flip ;;
    --x | --by | -w | --where) _cuvette_axes "$1" ;;
    -p | --partition) _cuvette_words "$(sinfo --noheader --format=%R 2>/dev/null)" ;;
    -C | --constraint) _cuvette_words "$(sinfo --noheader --format=%f 2>/dev/null | tr ',' '\n' | sort -u)" ;;
    --tasks | --node-type | --memory | --factor | --sbatch) COMPREPLY=() ;;
    -g | --glasses) _cuvette_files 'agf|AGF' ;;
    --figure) _cuvette_files 'png|svg|pdf' ;;
    --template) _cuvette_files 'slurm|sh' ;;
    --published) _cuvette_files 'csv' ;;
    --export) _cuvette_files 'pov|gltf|glb' ;;
    --curve)
        _cuvette_words fresnel-s fresnel-p fresnel deviation depth absorption edges mirror apparent-depth prism \
            rainbow plates malus coin arrow soap
        ;;
    -o | --output | --diff)
        case ${COMP_WORDS[1]-} in
        trace) _cuvette_files 'txt|json|csv|svg' ;;
        fan) _cuvette_files 'svg|csv' ;;
        section) _cuvette_files 'svg|json' ;;
        lens) _cuvette_files 'yaml|yml|zmx|dat|csv' ;;
        scene | fit) _cuvette_files 'yaml|yml' ;;
        mesh) _cuvette_files 'obj|ply|glb' ;;
        study)
            case ${COMP_WORDS[2]-} in
            plot) _cuvette_files 'png|svg|pdf' ;;
            *) _cuvette_files 'study' ;;
            esac
            ;;
        animate) _cuvette_files 'png|jpg|jpeg|pfm|exr|y4m' ;;
        render) _cuvette_files 'png|jpg|jpeg|pfm|exr|html' ;;
        *) _cuvette_files 'png|jpg|jpeg|pfm|exr' ;;
        esac
        ;;
    --rays | --time | --cut | --noise)
        [[ ${COMP_WORDS[1]-} == @(fan|study) ]] || _cuvette_files 'png|pfm|exr'
        ;;
    --timeline) _cuvette_files 'json' ;;
    --script) _cuvette_files 'yaml|yml' ;;
    --rows) _cuvette_files 'csv' ;;
    --fps) _cuvette_words 24 25 30 30000/1001 50 60 ;;
    --move | --turn | --scale) _cuvette_objects = all solids lights ;;
    --rename) _cuvette_objects = ;;
    --delete) _cuvette_objects '' ;;
    --add)
        compopt -o nospace
        _cuvette_words solid: light: material: mesh: texture:
        ;;
    --title | --name | --repetitions | --warmups | --row | --reason) COMPREPLY=() ;;
    --duration | --start) COMPREPLY=() ;;
    --bits) _cuvette_words 8 16 ;;
    --truth) _cuvette_words same larger smaller ;;
    --cells | --designs | --effect | --draws | --seed) COMPREPLY=() ;;
    --repeat | --shard | --at | --pixel | --ray | --depth | --lambda | --min-weight | --from | --to | --width | --spread | --plane) COMPREPLY=() ;;
    --count | --level | --major | --minor | --around | --tube | --profile | --crease | --size | --weld) COMPREPLY=() ;;
    --port | --threads | --memory-limit | --layers | --process | --processes) COMPREPLY=() ;;
    -r | --results | --folder)
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -d -- "$current")
        ;;
    *) return 1 ;;
    esac
}

_cuvette_study() # VERB
{
    local -A options=([new]='--axis --set --name --repetitions --warmups --output --force'
        [run]='--results --shard --by --any-environment --process --processes --instructions --wait-quiet --memory-limit --against --quick --dry-run --quiet --progress'
        [submit]='--slurm --partition --constraint --node-type --tasks --by --threads --memory --time --factor --sbatch --template --results --dry-run'
        [status]=--results [merge]=--results
        [verify]=--results [summary]='--results --environment --interval' [list]=''
        [exclude]='--row --reason --results'
        [compare]='--results --column --detect --fail-if-slower --tsv --json'
        [films]='--results --against'
        [power]='--column --cells --truth --designs --effect --draws --seed --tsv'
        [plot]='--output --format --x --y --by --log --where --images --published --results')
    if [[ $current == -* ]]; then
        _cuvette_words "${options[$1]} --help --usage --version"
    elif [[ $1 == list ]]; then
        compopt -o filenames
        mapfile -t COMPREPLY < <(compgen -d -- "$current")
    elif [[ $1 == new ]]; then
        _cuvette_files 'yaml|yml'
    elif [[ $1 == power ]]; then
        _cuvette_files 'csv'
    else
        _cuvette_files 'study'
    fi
}

_cuvette()
{
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local command=${COMP_WORDS[1]-} verbs='new run submit list status merge verify summary compare films power exclude plot'
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        _cuvette_words render animate scene trace fan section params media lens mesh study fit compare realism motion lesson lab machine help --help --usage --version
        return
    fi
    _cuvette_value "$previous" && return
    case $command in
    render)
        if [[ $current == -* ]]; then
            _cuvette_words --output --set --json --bits --rays --time --cut --noise --stokes --bands --timeline --repeat --beams --layers --live --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    animate)
        if [[ $current == -* ]]; then
            _cuvette_words --output --script --duration --fps --start --set --rows --restart --json --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    scene)
        if [[ $current == -* ]]; then
            _cuvette_words --add --set --move --turn --scale --rename --delete --title --new --from --check --list --link --export --all --output --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    trace)
        if [[ $current == -* ]]; then
            _cuvette_words --pixel --ray --beams --depth --lambda --min-weight --set --text --json --csv --svg --output --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    fan)
        if [[ $current == -* ]]; then
            _cuvette_words --from --to --rays --width --spread --plane --depth --lambda --set --tree --output --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    section)
        if [[ $current == -* ]]; then
            _cuvette_words --view --at --through --extent --cells --lambda --set --output --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    params)
        if [[ $current == -* ]]; then
            _cuvette_words --json --man --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    media)
        if [[ $current == -* ]]; then
            _cuvette_words --at --glass --column --json --help --usage --version
        elif [[ $current == */* || $current == *.* ]]; then
            _cuvette_files 'yml|yaml|agf|csv|txt|tsv'
        else
            _cuvette_words "$("${COMP_WORDS[0]}" media 2>/dev/null | awk 'NR > 1 { print $1 }')"
        fi
        ;;
    lens)
        if [[ $current == -* && ${COMP_WORDS[2]-} == report ]]; then
            _cuvette_words --json --csv --figure --system --glasses --field --wavelength --frequency --fan --spot --wave --help --usage --version
        elif [[ $current == -* ]]; then
            _cuvette_words --output --glasses --system --help --usage --version
        else
            _cuvette_files 'zmx|ZMX|dat|csv|yaml|yml'
            ((COMP_CWORD > 2)) || [[ report != "$current"* ]] || COMPREPLY+=(report)
        fi
        ;;
    mesh)
        _cuvette_words --generate --count --level --major --minor --around --tube --profile --crease --size --depth --seed --close --weld --format --output --json \
            --memory-limit --help --usage --version
        ;;
    study)
        if ((COMP_CWORD == 2)); then
            _cuvette_words "$verbs" --help
        else
            _cuvette_study "${COMP_WORDS[2]}"
        fi
        ;;
    fit)
        if [[ $current == -* ]]; then
            _cuvette_words --results --output --json --quiet --memory-limit --help --usage --version
        else
            _cuvette_files 'study'
        fi
        ;;
    compare)
        if [[ $current == -* ]]; then
            _cuvette_words --diff --json --memory-limit --help --usage --version
        else
            _cuvette_files 'png|jpg|jpeg|pfm|exr|bmp|hdr'
        fi
        ;;
    realism)
        if [[ $current == -* ]]; then
            _cuvette_words --set --json --csv --curve --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    motion)
        if [[ $current == -* ]]; then
            _cuvette_words --set --json --csv --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    lab)
        if [[ $current == -* ]]; then
            _cuvette_words --folder --results --port --threads --embed-origin --no-browser --memory-limit --help --usage --version
        else
            _cuvette_files 'yaml|yml'
        fi
        ;;
    lesson)
        if ((COMP_CWORD == 2)); then
            _cuvette_words list check show --help --usage --version
        else
            _cuvette_files 'lesson'
        fi
        ;;
    machine) _cuvette_words --json --help --usage --version ;;
    help)
        if [[ $previous == study ]]; then
            _cuvette_words "$verbs"
        elif ((COMP_CWORD == 2)); then
            _cuvette_words render animate scene trace fan section params media lens mesh study fit compare realism motion lesson lab machine
        fi
        ;;
    esac
}

complete -F _cuvette cuvette
