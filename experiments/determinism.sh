#!/bin/bash
# determinism.sh - what the same bits everywhere cost, and what they buy: the program as it is, and builds whose film
# sums doubles (float), whose compiler contracts products and sums to FMA (fast), or both: make variants.
#   experiments/determinism.sh build FOLDER            the programs FOLDER/FILM-CONTRACT-COMPILER, by gcc and clang
#   experiments/determinism.sh measure FOLDER RESULTS  adds to RESULTS/{rows,bits,images}.csv; needs only these programs
# rows.csv: CPU time of one thread. In a round every program renders each scene with each instruction set once, one
# program after another; the first in a round is another each time. bits.csv: the film and the number of rays of small
# images for numbers of threads and schedules. images.csv: each distinct film of bits.csv against the film of the
# program as it is. Environment: ROUNDS=15, FRAMES=5 (frames of one process, of which the median counts), SIZE=240x180;
# QUICK=1: 12 rounds of 3 frames of 160x120, four minutes. ISAS, COMPILERS and SCENES restrict the lists.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
usage() {
    sed -n 's/^#   //p' "$0" >&2
    exit 2
}
(($# >= 2)) || usage
mkdir -p "$2"
folder=$(cd "$2" && pwd)
variants=(fixed-off fixed-fast float-off float-fast)
read -ra compilers <<<"${COMPILERS:-gcc clang}"
read -ra scenes <<<"${SCENES:-rod vessel-mesh caustic}"

build() {
    local variant compiler name built=$here/../build
    for compiler in "${compilers[@]}"; do
        for variant in "${variants[@]}"; do
            name=$variant-$compiler
            "${MAKE:-make}" -C "$here/.." --no-print-directory variants VARIANTS="$name"
            strip -o "$folder/$name" "$built/variants/$name/cuvette"
        done
    done
    strip -o "$folder/cuvette-import" "$built/cuvette-import"
    # What a machine without these libraries lacks; glibc must be its own.
    mkdir -p "$folder/lib"
    ldd "$built/cuvette" "$built/cuvette-import" | awk '$2 == "=>" && $1 !~ /^lib(c|m)[.]/ { print $3 }' | sort -u |
        xargs cp -L -t "$folder/lib"
}

# of NAME: the first value of that name in $json, in $value. Without a process, whose start takes longer than a film.
of() {
    [[ $json =~ \"$1\":\ \"?([^\",$'\n']*) ]] && value=${BASH_REMATCH[1]}
}

# render PROGRAM ISA SCENE SIZE ARGUMENT...: one JSON object
render() {
    local program=$1 isa=$2 scene=$3 size=$4 less=()
    shift 4
    [[ $scene == rod ]] && less=(--set render.depth=8)
    [[ $scene == caustic ]] && less=(--set render.photons=20000 --set render.samples=1)
    CUVETTE_ISA=$isa CUVETTE_IMPORT=$folder/cuvette-import "$folder/$program" render "$here/scenes/$scene.yaml" \
        --json --set "render.width=${size%x*}" --set "render.height=${size#*x}" "${less[@]}" "$@"
}

times() { # ROUNDS FRAMES SIZE
    local round scene isa compiler i variant json row name value
    for ((round = 0; round < $1; round++)); do
        for scene in "${scenes[@]}"; do
            for isa in "${isas[@]}"; do
                for compiler in "${compilers[@]}"; do
                    for ((i = 0; i < ${#variants[@]}; i++)); do
                        variant=${variants[(round + i) % ${#variants[@]}]}
                        json=$(render "$variant-$compiler" "$isa" "$scene" "$3" --repeat "$2" --set render.threads=1)
                        row=${variant/-/,},$compiler,$isa,$scene,$round,$i
                        for name in cpu_s film_hash total others_fraction; do of "$name" && row+=,$value; done
                        echo "$row,$3"
                    done
                done
            done
        done
    done
}

# Keeps the image of each distinct film in $work as SCENE-HASH.pfm.
bits() { # SIZE
    local scene isa compiler variant threads schedule json hash value
    for scene in "${scenes[@]}"; do
        for compiler in "${compilers[@]}"; do
            for variant in "${variants[@]}"; do
                for isa in "${isas[@]}"; do
                    for threads in 1 2 3 4 7; do
                        for schedule in columns rows tiles dynamic; do
                            json=$(render "$variant-$compiler" "$isa" "$scene" "$1" -o "$work/image.pfm" \
                                --set "render.threads=$threads" --set "render.schedule=$schedule")
                            of film_hash && hash=$value && of total
                            [[ -e $work/$scene-$hash.pfm ]] || mv "$work/image.pfm" "$work/$scene-$hash.pfm"
                            echo "${variant/-/,},$compiler,$isa,$scene,$threads,$schedule,$hash,$value"
                        done
                    done
                done
            done
        done
    done
}

# The image of each distinct film, as floats, compared with that of the first row: the program as it is.
images() {
    local scene hash expected=
    cut -d , -f 5,8 "$work/bits" | awk '!seen[$0]++' | while IFS=, read -r scene hash; do
        [[ $expected == "$work/$scene-"* ]] || expected=$work/$scene-$hash.pfm
        "$here/../plots/difference.sh" "$work/$scene-$hash.pfm" "$expected" | awk -v name="$scene,$hash" '
            { for (c = 4; c <= 6; c++) { d = $c < 0 ? -$c : $c; differing += d > 0; if (d > most) most = d } }
            END { printf "%s,%.9g,%.6f\n", name, most, differing / (3 * NR) }'
    done
}

# Rows of several calls, such as one for each compiler, stand in one file.
add() { # FILE HEADER
    [[ -s $results/$1.csv ]] || echo "$2" >"$results/$1.csv"
    cat >>"$results/$1.csv"
}

case $1 in
build) build ;;
measure)
    (($# == 3)) || usage
    mkdir -p "$3"
    results=$(cd "$3" && pwd)
    work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-determinism.XXXXXX")
    trap 'rm -rf "$work"' EXIT
    # Of programs that were built elsewhere.
    if ldd "$folder/fixed-off-${compilers[0]}" | grep -q 'not found'; then export LD_LIBRARY_PATH=$folder/lib; fi
    isas=()
    for isa in ${ISAS:-sse2 avx2 avx512}; do
        if CUVETTE_ISA=$isa "$folder/fixed-off-${compilers[0]}" machine --json >/dev/null 2>&1; then isas+=("$isa"); fi
    done
    rounds=15 frames=5 size=240x180
    if ((${QUICK:-0})); then rounds=12 frames=3 size=160x120; fi
    times "${ROUNDS:-$rounds}" "${FRAMES:-$frames}" "${SIZE:-$size}" |
        add rows 'film,contract,compiler,isa,scene,repetition,place,cpu_s,film_hash,rays_total,others_fraction,size'
    bits 64x48 >"$work/bits"
    add bits 'film,contract,compiler,isa,scene,threads,schedule,film_hash,rays_total' <"$work/bits"
    images | add images 'scene,film_hash,max_difference,differing_fraction'
    ;;
*) usage ;;
esac
