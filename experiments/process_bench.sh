#!/bin/bash
# process_bench.sh - wall time of whole processes, from the scene file to the image; the speed of the build by clang.
#   experiments/process_bench.sh [CUVETTE [CUVETTE_BY_CLANG]]
# Environment: REPS=7 (rounds), SIZE=800x600, TRIANGLES=1000000 (of the OBJ file, generated before: the set dense),
# CLANG (the second program).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/rounds.sh"
ours=${1:-${CUVETTE:-build/cuvette}} clang=${2:-${CLANG:-}} reps=${REPS:-7} size=${SIZE:-800x600}
triangles=${TRIANGLES:-1000000} rod=$here/scenes/rod.yaml
need "$ours" 'make builds it'
[ -z "$clang" ] || need "$clang" 'make CC=clang build=build/clang builds it'
size=(--set "render.width=${size%x*}" --set "render.height=${size#*x}")

"$ours" mesh --generate dense --count "$triangles" -f obj -o "$work/soup.obj"
sed "s|soup: {.*|soup: {file: soup.obj}|" "$here/scenes/soup.yaml" >"$work/soup.yaml"
traced() { # traced CONTESTANT PROGRAM SCENE SET: CPU seconds of tracing and rays
    local json
    json=$("$2" render "$3" --json --repeat 3 "${size[@]}" --set "$4")
    note "$1" "$(field cpu_s <<<"$json")" "$(field total <<<"$json")"
}
for ((round = 0; round < reps; round++)); do
    note 'rod 8' "$(seconds "$ours" render "$rod" -o "$work/rod.png" "${size[@]}")"
    note 'rod 16' "$(seconds "$ours" render "$rod" -o "$work/rod.png" --bits 16 "${size[@]}")"
    note obj "$(seconds "$ours" render "$work/soup.yaml" -o "$work/soup.png" "${size[@]}")"
    [ -n "$clang" ] || continue
    for program in ours clang; do
        traced "rod by $program" "${!program}" "$rod" render.depth=8
        traced "mesh by $program" "${!program}" "$here/scenes/soup.yaml" soup.generate=sphere
    done
done
row 'rod 8' '$1 * 1e3' 'rod.yaml to a PNG of 8 bits, whole process, ms'
row 'rod 16' '$1 * 1e3' 'rod.yaml to a PNG of 16 bits, whole process, ms'
row obj '$1' "OBJ of $triangles triangles to a PNG, whole process, s"
ratio 'rod by ours' 'rod by clang' 'rod, depth 8: speed of the build by clang / by gcc'
ratio 'mesh by ours' 'mesh by clang' 'sphere of 50000 triangles: speed of the build by clang / by gcc'
