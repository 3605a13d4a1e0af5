#!/bin/bash
# arch.sh FOLDER [ARCHITECTURE...], run by `make test-arch`: builds Cuvette for other architectures in FOLDER,
# which .ci/setup-arch prepares, and runs it with qemu-user. Every scene of experiments/scenes must have the film hash
# of the native build $CUVETTE; unit tests must pass; each must read what the other writes (rows, images, scenes, shared
# scenes, meshes) as if it were its own. SIZE=80x60: pixels of the films; qemu is 50 to 100 times slower than a
# processor. UNIT="NAME NAME": the unit tests. ROWS=results/films: also the rows of each architecture, by
# experiments/films.sh. Prints a table, and a line for each difference.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
folder=${1:?tests/check/arch.sh: give a folder}
shift
cuvette=${CUVETTE:?tests/check/arch.sh: CUVETTE is the native program}
size=${SIZE:-80x60}
unit=(base optics elementary dispersion mueller sobol solid_shape mesh mesh_file gltf
    mesh_generators texture image shared)
[[ ! ${UNIT:-} ]] || read -ra unit <<<"$UNIT"
scenes=(experiments/scenes/*.yaml)
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-arch.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
export CUVETTE_MACHINE=one # rows then belong to the same machine, if all else is equal

declare -A cpu
while read -r name its_cpu _; do
    cpu[$name]=$its_cpu
done < <(grep -v '^#' .ci/architectures)
(($#)) || mapfile -t names < <(awk '!/^#/ {print $1}' .ci/architectures)
(($#)) && names=("$@")

failed=0
differ() { # a difference, or something that does not work: one line
    echo "FAIL  $*"
    failed=$((failed + 1))
}

# on ARCHITECTURE ARGUMENT...: runs its program; `native` is this machine's
on() {
    local name=$1
    shift
    if [[ $name == native ]]; then
        "$cuvette" "$@"
    else
        CUVETTE_IMPORT=$work/import-$name $(emulator "$name") "$folder/$name/cuvette" "$@"
    fi
}

emulator() {
    echo "qemu-${cpu[$1]} -L $folder/$1/system"
}

# PKG_CONFIG and the compiler see only the unpacked system.
build() {
    local name=$1 triplet=${cpu[$1]}-linux-gnu system
    system=$(cd "$folder/$name/system" && pwd -P) || return
    shift
    PKG_CONFIG_SYSROOT_DIR=$system PKG_CONFIG_LIBDIR=$system/usr/lib/$triplet/pkgconfig:$system/usr/share/pkgconfig \
        ${MAKE:-make} --no-print-directory CC="$triplet-gcc --sysroot=$system" build="$folder/$name" STRICT=1 \
        "${@/#/$folder/$name/}"
}

# The slime's motion is computed in full whatever the size of the film: its first quarter of a second.
film_hash() { # ARCHITECTURE SCENE
    local shorter=()
    [[ $2 == */slime.yaml ]] && shorter=(--set toy.time_s=0.25)
    on "$1" render "$2" --json --set "render.width=${size%x*}" --set "render.height=${size#*x}" "${shorter[@]}" \
        2>"$work/why" |
        experiments/json_value.py film_hash
}

films() { # ARCHITECTURE: seconds and hash of each scene, in files
    local scene began hash
    for scene in "${scenes[@]}"; do
        began=$EPOCHREALTIME
        hash=$(film_hash "$1" "$scene")
        bc <<<"scale=1; ($EPOCHREALTIME - $began) / 1" >"$work/$1-$(basename "$scene" .yaml).s"
        echo "${hash:-none}" >"$work/$1-$(basename "$scene" .yaml).hash"
        [[ $1 == native || ${hash:-none} == "$(<"$work/native-$(basename "$scene" .yaml).hash")" ]] && continue
        differ "$1: $scene: film ${hash:-none}, $(<"$work/native-$(basename "$scene" .yaml).hash") on this machine" \
            "$(head -n 1 "$work/why")"
    done
}

# Files from one architecture to the other; a study of a scene with a mesh file and a texture, whose contents are part
# of the rows' identity.
write_files() { # ARCHITECTURE
    local to=$work/from-$1
    mkdir -p "$to"
    on "$1" mesh --generate torus --around 12 -o "$to/torus.ply" &&
        printf '%s\n' 'render: {width: 24, height: 18}' 'camera: {position: [0, 2, 6], target: [0, 0, 0]}' \
            'background: {kind: gradient}' "textures: {tiles: {file: $PWD/experiments/scenes/chequer.png}}" \
            'meshes: {torus: {file: torus.ply}}' 'materials: {tiled: {texture: tiles, reflectivity: 0.3}}' \
            'lights: {lamp: {position: [3, 5, 4]}}' \
            'solids: {ring: {shape: mesh, mesh: torus, material: tiled, rotation: [50, 0, 0]}}' >"$to/scene.yaml" &&
        printf '%s\n' 'study: exchange' 'scene: scene.yaml' 'grid: [{render.depth: [0, 2]}]' 'repetitions: 2' \
            'warmups: 0' >"$to/exchange.study" &&
        on "$1" study run -q --results "$to/results" "$to/exchange.study" &&
        on "$1" render "$to/scene.yaml" -o "$to/film.pfm" --set render.samples=4 &&
        on "$1" render "$to/scene.yaml" -o "$to/film.png" --bits 16 --set render.samples=4 &&
        on "$1" scene experiments/scenes/rod.yaml --set render.width=24 --set render.height=18 -o "$to/rod.yaml" &&
        on "$1" render "$to/rod.yaml" -o "$to/rod.png" &&
        on "$1" scene experiments/scenes/rod.yaml --link >"$to/link"
}

# read_files READER WRITER: reads what WRITER wrote, and compares it with what READER writes itself.
read_files() {
    local from=$work/from-$2 own=$work/from-$1 copy=$work/$1-of-$2 file before
    for file in torus.ply film.pfm rod.yaml; do
        cmp -s "$from/$file" "$own/$file" || differ "$1 and $2 write different bytes: $file"
    done
    for file in film.png film.pfm rod.png; do
        on "$1" compare "$from/$file" "$own/$file" 2>&1 | grep -q identical ||
            differ "$1 reads another image than $2 wrote: $file"
    done
    for file in "$from/rod.png" "$(<"$from/link")"; do
        on "$1" scene "$file" --set render.width=24 --set render.height=18 2>"$work/why" | cmp -s - "$own/rod.yaml" ||
            differ "$1 does not read the scene that $2 shared: ${file:0:60} $(head -n 1 "$work/why")"
    done
    rm -rf "$copy" && cp -r "$from" "$copy"
    on "$1" study verify --results "$copy/results" "$copy/exchange.study" >"$work/why" 2>&1 ||
        differ "$1 finds faults in the rows of $2: $(head -n 1 "$work/why")"
    before=$(wc -l <"$copy/results/exchange/rows.csv")
    on "$1" study run -q --any-environment --results "$copy/results" "$copy/exchange.study" >"$work/why" 2>&1 ||
        differ "$1 cannot go on with the study of $2: $(head -n 1 "$work/why")"
    (($(wc -l <"$copy/results/exchange/rows.csv") == before)) ||
        differ "$1 takes the rows of $2 for those of another study"
    on "$1" study run -q --results "$copy/results" "$copy/exchange.study" >"$work/why" 2>&1 ||
        differ "$1 cannot add rows to those of $2: $(head -n 1 "$work/why")"
    on "$2" study verify --results "$copy/results" "$copy/exchange.study" >"$work/why" 2>&1 ||
        differ "$2 finds faults in the rows that $1 added: $(head -n 1 "$work/why")"
    [[ $(awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i == "film_hash") at = i; next} /^[^#]/ {print $at}' \
        "$copy/results/exchange/rows.csv" | sort -u | wc -l) == 2 ]] ||
        differ "the rows of $1 and $2 do not have one film hash for each of the two cells"
}

exchange() { # ARCHITECTURE
    local seen=$failed
    write_files "$1" 2>"$work/why" >&2 || differ "$1: writing files: $(grep -v note: "$work/why" | head -n 1)"
    ((failed == seen)) && read_files native "$1" && read_files "$1" native
    ((failed == seen)) && echo yes >"$work/$1-exchange" || echo NO >"$work/$1-exchange"
}

unit_tests() { # ARCHITECTURE
    local code=0
    CUVETTE_IMPORT=$work/import-$1 RUNNER=$(emulator "$1") TEST_LIMIT_S=3600 \
        tests/run "${unit[@]/#/$folder/$1/tests/test_}" >"$work/unit" || code=1
    tail -n 1 "$work/unit" >"$work/$1-unit"
    ((code == 0)) || { cat "$work/unit" && differ "$1: unit tests"; }
}

lap() { # NAME: the seconds since the last lap, for the table
    echo $((SECONDS - lapped)) >"$work/$1"
    lapped=$SECONDS
}
lapped=0

films native
write_files native 2>"$work/why" >&2 || differ "this machine: writing files: $(grep -v note: "$work/why" | head -n 1)"
for name in "${names[@]}"; do
    [[ ${cpu[$name]:-} ]] || { differ "unknown architecture $name; see .ci/architectures" && continue; }
    lapped=$SECONDS
    build "$name" cuvette cuvette-import "${unit[@]/#/tests/test_}" >"$work/built" 2>&1 ||
        { grep -A 3 -E 'error|undefined' "$work/built" | head -n 20 && differ "$name: it does not build" && continue; }
    lap "$name-built.s"
    printf '#!/bin/sh\nexec %s %s "$@"\n' "$(emulator "$name")" "$folder/$name/cuvette-import" >"$work/import-$name"
    chmod +x "$work/import-$name"
    films "$name"
    [[ ! ${ROWS:-} ]] || CUVETTE_IMPORT=$work/import-$name experiments/films.sh --cuvette "$folder/$name/cuvette" \
        --run "$(emulator "$name")" --emulated qemu --processor qemu --name "qemu-$name" --out "$ROWS/qemu-$name.csv" ||
        differ "$name: rows of its films"
    lap "$name-films.s"
    exchange "$name"
    lap "$name-exchange.s"
    unit_tests "$name"
    lap "$name-unit.s"
done

shown() { cat "$work/$1" 2>/dev/null || echo -; }
row() { # TITLE, then a cell for each architecture
    printf '%-20s' "$1"
    shift
    printf ' %18s' "$@"
    echo
}
cells() { # SUFFIX FUNCTION: sets `cell`
    local name
    cell=()
    for name in "${names[@]}"; do
        cell+=("$("$2" "$name" "$1")")
    done
}
film_cell() {
    case $(shown "$1-$2.hash") in
    "$(shown "native-$2.hash")") echo "equal $(shown "$1-$2.s") s" ;;
    -) echo - ;;
    *) echo DIFFERS ;;
    esac
}
plain_cell() { shown "$1-$2"; }
seconds_cell() { echo "$(shown "$1-$2.s") s"; }
echo "Films of $size pixels, on $(uname -m) and by qemu-user:"
row scene "${names[@]}" "hash on $(uname -m)"
for scene in "${scenes[@]}"; do
    key=$(basename "$scene" .yaml)
    cells "$key" film_cell
    row "$key" "${cell[@]}" "$(shown "native-$key.hash")"
done
cells exchange plain_cell && row 'files exchanged' "${cell[@]}"
cells unit plain_cell && row 'unit tests' "${cell[@]}"
for part in built films exchange unit; do
    cells "$part" seconds_cell && row "time: $part" "${cell[@]}"
done
echo "$SECONDS s in all"
((failed)) && echo "$failed differences or failures"
exit $((failed > 0))
