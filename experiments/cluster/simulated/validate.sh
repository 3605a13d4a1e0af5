#!/bin/bash
# Compare the simulation with real runs of cuvette-mpi on this machine: rod.yaml by random paths, with ranks of one
# thread each. Prints CSV: ranks, median and least measured wall time of a frame (s), the simulated times for the median
# and for the least costs, and their relative errors.
#   validate.sh [RANKS...]       1 2 8. REPEAT (7): rounds. CORES (2): of this machine; SIZE (480x270), PATHS (64)
# MEASURED: a table of another machine's times instead, as measured-16.csv (what,method,count,wall_s,film_hash: threads
# or ranks; path or whitted), of its METHOD (path); SIZE, PATHS (1 for whitted) and CORES are then that table's.
# MESSAGE_NS (2400), BYTE_NS (0.30): what a tile costs rank 0.
# The costs are measured by a render of the same frame on one thread in each round, so that only the ranks' sharing is
# judged, not this machine's speed from one hour to the next. With other programs on the machine, compare the least.
set -euo pipefail
export LC_ALL=C.UTF-8

here=$(cd "$(dirname "$0")" && pwd)
root=$here/../../..
build=${BUILD:-$root/build} repeat=${REPEAT:-7} size=${SIZE:-480x270} paths=${PATHS:-64} cores=${CORES:-2}
ranks=("$@")
(($#)) || ranks=(1 2 8)
scratch=$(mktemp -d "${TMPDIR:-/tmp}/validate.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
scene=$root/experiments/scenes/rod.yaml
settings=(-s "render.width=${size%x*}" -s "render.height=${size#*x}" -s render.integrator=path -s "render.paths=$paths"
    -s render.threads=1 --json)

seconds() { # NAME: of the first object of JSON on the standard input
    sed -n "s/.*\"$1\": *\([0-9.e+-]*\).*/\1/p" | head -n 1
}
method=${METHOD:-path}
pixel_bytes=48
[[ $method == path ]] || pixel_bytes=24
if [[ ${MEASURED:-} ]]; then
    repeat=0
    awk -F, -v method="$method" -v to="$scratch" '$2 == method && $1 == "threads" && $3 == 1 { print $4 >to "/alone" }
        $2 == method && $1 == "ranks" { print $4 >to "/" $3 }' "$MEASURED"
fi
for ((i = 0; i < repeat; i++)); do
    "$build/cuvette" render "$scene" "${settings[@]}" 2>/dev/null | seconds wall_s >>"$scratch/alone"
    for n in "${ranks[@]}"; do
        mpirun --oversubscribe -n "$n" "$build/cuvette-mpi" render "$scene" "${settings[@]}" 2>/dev/null |
            seconds wall_s >>"$scratch/$n"
    done
done
median() { sort -g "$1" | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }

# The map's costs, scaled to the measured time of one thread.
map_s=$(awk -v size="$size" -v paths="$paths" '
    NR == 2 { unit = $3 }
    NR == 3 { of = $3 }
    NR > 5 { for (i = 1; i <= NF; i++) { sum += $i; n++ } }
    END { split(size, s, "x"); print sum / n * unit * paths / of * s[1] * s[2] / 1e9 }' "$here/maps/$method.pgm")
least() { sort -g "$1" | sed -n 1p; }
simulated_s() { # STATISTIC RANKS
    awk -v factor="$("$1" "$scratch/alone")" -v map_s="$map_s" 'NR == 2 { $3 = $3 * factor / map_s } { print }' \
        "$here/maps/$method.pgm" >"$scratch/map.pgm"
    CORES=$cores nice -n 19 "$here/simulate.sh" two-cores "$2" "map=$scratch/map.pgm" "width=${size%x*}" \
        "height=${size#*x}" "paths=$paths" "pixel_bytes=$pixel_bytes" scene_bytes=3500 \
        "message_ns=${MESSAGE_NS:-2400}" "byte_ns=${BYTE_NS:-0.30}" | cut -d, -f12
}
echo ranks,median_s,least_s,simulated_median_s,simulated_least_s,error_median,error_least
for n in "${ranks[@]}"; do
    echo "$n,$(median "$scratch/$n"),$(least "$scratch/$n"),$(simulated_s median "$n"),$(simulated_s least "$n")" |
        awk -F, '{ printf "%s,%.3f,%.3f\n", $0, $4 / $2 - 1, $5 / $3 - 1 }'
done
