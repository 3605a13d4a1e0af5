#!/bin/bash
# The documents against the project: linked files exist, every command of README.md works as printed, and
# results/README.md describes every column that a study writes. readme.sh [PROGRAM]; needs the compiler (CC) for
# tests/tools/json_get.c. CHECK=1 also builds and serves the site, and runs a slow command as it stands. One line
# per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-readme.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset CUVETTE_ISA NO_COLOR

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
# shellcheck source=tests/shell/await.sh
source "$root/tests/shell/await.sh"

# --- named files: links and images relative to the page's folder, `src/...` and similar paths relative to the root
links() { # PAGE: targets of links, except on the web and within the page
    grep -o '](\([^)]*\))' "$1" | sed 's/^](//; s/[)#].*$//' | grep -v -e '^[a-z]*:' -e '^$' | sort -u
}
words() { # PAGE
    # shellcheck disable=SC2016
    grep -oE '`(src|experiments|plots|tests|paper)(/[A-Za-z0-9_./-]*)?`' "$1" | tr -d '`' | sort -u
}
has_reference=0
for file in "$root"/results/reference/*; do [[ -e $file ]] && has_reference=1; done
pages=(README.md CONTRIBUTING.md src/web/README.md results/README.md experiments/published/README.md
    src/manual/site/gallery.md)
for page in "${pages[@]}"; do
    lost=
    while read -r target; do
        [[ -e $root/$(dirname "$page")/$target ]] && continue
        if [[ $target == *reference/* ]] && ((!has_reference)); then
            skip "$page: $target, there is no reference run yet"
        else
            lost+="${lost:+$'\n'}$target"
        fi
    done < <(links "$root/$page")
    empty "the linked files of $page exist" "$lost"
    lost=
    while read -r target; do
        [[ -e $root/$target ]] || lost+="${lost:+$'\n'}$target"
    done < <(words "$root/$page")
    empty "the files named by $page exist" "$lost"
done
# shellcheck disable=SC2016
empty "the README names the two commands" \
    "$(for line in 'make setup experiments' 'make setup test'; do grep -qE "^    $line( |$)" "$root/README.md" ||
        echo "$line"; done)"

# --- a reader's folder: studies and scenes, with the program in PATH
mkdir -p "$work/bin" "$work/lab"
ln -s "$program" "$work/bin/cuvette"
cp -r "$root/experiments" "$work/lab/"
"${CC:-gcc}" -std=gnu17 -o "$work/bin/json_get" "$root/tests/tools/json_get.c" $(pkg-config --cflags --libs jansson)
verdict $? "tests/tools/json_get.c compiles"
export PATH=$work/bin:$PATH
export CUVETTE_LIVE=$work/live.html # the laboratory in one file, which the build need not have
echo '<!doctype html><html><head></head><body></body></html>' >"$CUVETTE_LIVE"
cd "$work/lab" || exit 1

try() { # COMMAND LINE: passes when it succeeds; its output is in said
    eval "$1" >said 2>&1 </dev/null
    verdict $? "${1%%$'\n'*}" "$(<said)"
}

# --- the gallery's fast commands that README.md does not have, with small images of few paths and photons, without the
# part after a |, whose program may be missing
small='--set=render.width=40 --set=render.height=30 --set=render.paths=2 --set=render.photons=2000'
while read -r line; do
    try "set -o pipefail; ${line%% | *}"
done < <(sed -n \
    's/^    \(cuvette \(render\|fan\|trace\|realism\).*\)/\1/p' \
    "$root/src/manual/site/gallery.md" | sed 's/ *#.*//' |
    grep -vxFf <(sed -n 's/^    //p' "$root/README.md") | awk '!seen[$0]++' |
    sed "s/ render / render $small /")

# --- the dictionary against the files of a study; a name with <...> represents several columns
cat >experiments/columns.study <<'END'
study: columns
scene: scenes/rod.yaml
set: {render.width: 16, render.height: 12}
grid: [{render.depth: [0, 1]}]
repetitions: 1
keep: {image: on, workers: on}
END
cuvette study run --quick --quiet experiments/columns.study # which has columns of its own
cuvette study summary experiments/columns.study >summary.tsv
described() { # SECTION: first column of its table
    awk -v title="## $1" '/^## / {on = $0 == title} on && /^\| `/' "$root/results/README.md" |
        sed -n 's/^| \(`[^|]*\) |.*/\1/p' | sed 's/^| *//' | cut -d'|' -f1 | tr -d '` ' | tr ',' '\n'
}
written() { # FILE SEPARATOR: the columns of its header, one per line, with the dictionary's <...> names
    head -1 "$1" | tr "$2" '\n' | sed \
        's/^render\.depth$/<axis>/; s/hits\.\(ground\|vessel\|liquid\|rod\)$/hits.<solid>/' | uniq
}
compare() { # SECTION NAMES: the dictionary has the same columns in the same order
    empty "results/README.md has the columns of $1" "$(diff <(described "$1") <(echo "$2"))"
}
folder=results/columns
compare rows.csv "$(written $folder/rows.csv ,)"
compare workers.csv "$(written $folder/workers.csv ,)"
compare 'tables/<study>.tsv' "$(written summary.tsv '\t')"
compare images/index.tsv "$(written $folder/images/index.tsv '\t')"
recorded() { json_get $folder/runs.json "$1@keys" | sed "s/^/$2/"; }
compare runs.json "$(
    echo schema
    recorded study study.
    recorded machine machine.
    recorded 'runs[0]' 'runs[].'
)"
empty "runs.json has no other part" \
    "$(json_get $folder/runs.json @keys | grep -vx -e schema -e study -e machine -e runs)"

# --- every command of README.md, as it stands and in order, in a copy of the tree with its build
tree=$work/tree
mkdir -p "$tree/build" "$tree/results" "$work/home"
find "$root" -mindepth 1 -maxdepth 1 ! -name .git ! -name build ! -name results -exec cp -a -t "$tree" {} +
find "$root"/results/{README.md,reference} -prune -exec cp -a -t "$tree/results" {} +
built= # whether the program is that of README.md, not one with sanitizers
if [[ $(dirname "$program") == "$(realpath "$root/build")" ]]; then
    built=1
    find "$root/build" -maxdepth 1 \( -type f -o -name obj -o -name plain -o -name web \) \
        -exec cp -a -t "$tree/build" {} +
    mkdir "$tree/build/wasm" # what `make setup-wasm` fetches, and what it takes minutes to compile
    [[ ! -d $root/build/wasm/sources ]] || ln -s "$root/build/wasm/sources" "$tree/build/wasm/"
    [[ ! -d $root/build/wasm/libraries ]] || cp -a "$root/build/wasm/libraries" "$tree/build/wasm/"
else
    ln -s "$program" "$(dirname "$program")/cuvette-import" "$tree/build/"
fi
printf '#!/bin/sh\n' >"$work/bin/xdg-open" # cuvette lab starts a browser
chmod +x "$work/bin/xdg-open"
export HOME=$work/home
unset MAKEFLAGS MFLAGS MAKELEVEL
cd "$tree" || exit 1

# What does not run as it stands, and why; the first pattern that fits a line decides.
exceptions=(
    'sudo apt*|skip|it installs packages'
    'cp -r /usr/share/cuvette/*|skip|only an installed package has that folder'
    'make setup|skip|it installs packages'
    'make setup experiments|plan|CI runs it'
    'make setup test|plan|this is a part of it'
    'make setup setup-wasm setup-site site|site|it takes minutes, and needs emscripten'
    'python3 -m http.server *|site|it serves the site'
    'make setup-python install-python *|python|it needs cffi, NumPy and pandas'
    'import cuvette*|python|it needs cffi, NumPy and pandas'
    'cuvette: *|error|not a command, but an error that the program prints'
    'cuvette lab*|serve|a server'
    'cuvette render experiments/scenes/caustic.yaml *|fewer|as it stands it takes a quarter of a minute'
    'cuvette study run experiments/depth.study|small|as it stands it takes two minutes; its frames are smaller'
)
python=python3
[[ -x /usr/bin/python3 ]] && python=/usr/bin/python3

one_page='import sys, urllib.error, urllib.request as web
browser = web.build_opener(web.HTTPCookieProcessor())
while True:
    try:
        print(browser.open(sys.argv[1]).read().decode())
        break
    except urllib.error.HTTPError:
        raise
    except urllib.error.URLError: # it is not yet listening
        pass'
serve() { # COMMAND [ADDRESS]: asks the server for one page; without ADDRESS it prints one
    local server address=${2-}
    : >printed
    eval "exec $1" >printed 2>said </dev/null &
    server=$!
    if [[ -z $address ]]; then
        await $server test -s printed
        address=$(<printed)
    fi
    "$python" -c "$one_page" "$address" >page 2>>said
    grep -qi '<title>' page
    verdict $? "$1" "$(<said)"
    kill -INT $server
    wait $server
}
declare -A met=()
command() { # TEXT: a line of README.md, or a text in Python
    local line one pattern how=try reason
    line=$(sed '1s/ *# .*//' <<<"$1")
    for one in "${exceptions[@]}"; do
        IFS='|' read -r pattern how reason <<<"$one"
        # shellcheck disable=SC2053 # a pattern
        [[ $line == $pattern ]] && met[$pattern]=1 && break
        how=try
    done
    if [[ $line == make* && ! $built ]]; then how=skip reason='this is another build'; fi
    [[ $how == python ]] && ! "$python" -c 'import cffi, numpy, pandas' 2>said && how=skip
    [[ $how == site && ! ${CHECK:-} ]] && how=skip reason+='; CHECK=1 runs it'
    [[ $how == site && ! (-d $root/build/wasm/sources && -x $(command -v esbuild)) ]] &&
        how=skip reason='make setup-wasm setup-site has not run'
    case $how:$line in
    try:*) try "$line" ;;
    skip:*) skip "$line: $reason" ;;
    plan:*) try "make -n${line#make}" ;;
    serve:*) serve "$line" ;;
    fewer:*)
        [[ ${CHECK:-} ]] || line+=' --set=render.photons=20000 --set=render.samples=1'
        try "$line"
        ;;
    small:*)
        sed -i 's/^set:$/set:\n  render.width: 80\n  render.height: 60/' experiments/depth.study
        try "$line"
        ;;
    error:*)
        printf '#\n%.0s' {1..10} >mine.yaml
        printf '%s\n' 'solids: {ball: {shape: sphere,' '    raduis: 1}}' >>mine.yaml
        equal "an error: $line" "$(cuvette render mine.yaml -o mine.png 2>&1)" "$line"
        ;;
    python:import*) [[ ! $built ]] || try "$python -c '$line'" ;;
    python:*) try "${line/ setup-python/}" ;;
    site:make*) try "${line/ setup setup-wasm setup-site/}" ;;
    site:*) serve "$line" http://localhost:8000/ ;;
    esac
}
# The indented blocks; one that begins with `import` is one text.
mapfile -d '' -t commands < <(awk '
    /^    / { line = substr($0, 5); if (line ~ /^import /) { python = 1; text = "" }
        if (python) text = text line "\n"; else if (!seen[line]++) printf "%s%c", line, 0; next }
    python { printf "%s%c", text, 0; python = 0 }' "$root/README.md")
for one in "${commands[@]}"; do command "$one"; done
unmet=
for one in "${exceptions[@]}"; do [[ ${met[${one%%|*}]:-} ]] || unmet+="$one"$'\n'; done
empty "each exception of this test is still a line of README.md" "$unmet"

conclude
