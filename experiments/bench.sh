#!/bin/bash
# bench.sh - how fast, as ratios of things measured in turn in one run; medians of REPS rounds.
#   experiments/bench.sh CUVETTE [CUVETTE_WITHOUT_COUNTERS]
# Environment: REPS=7 (rounds), SIZE=800x600, PEERS=DIR (a folder with rod.pov and listing_baseline.cpp: POV-Ray and the report's
# algorithm then run in the same rounds; needs povray and g++). One round runs every contestant once, so that drift of the machine
# falls on all alike. Pruned: branches of less than 1/255 of a camera ray's weight are not followed. CPU seconds are of the tracing
# alone, for POV-Ray its own figure.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
[ -x "${1:-${CUVETTE:-build/cuvette}}" ] || { echo "usage: bench.sh [CUVETTE [CUVETTE_WITHOUT_COUNTERS]]" >&2; exit 2; }
ours=${1:-${CUVETTE:-build/cuvette}} bare=${2:-${NOCOUNTERS:-}} reps=${REPS:-7} peers=${PEERS:-}
scene=$here/scenes/rod.yaml size=${SIZE:-800x600}
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT

# field NAME < JSON: the first number under that name
field() { sed -n "s/^ *\"$1\": *\([-0-9.eE+]*\),*$/\1/p" | head -n 1; }
note() { printf '%s\t%s\n' "$2" "$3" >>"$work/$1"; } # note CONTESTANT seconds rays
frame() { # frame CONTESTANT PROGRAM CLOCK [set...]: the median of five frames in a pool that the first ones start
    local who=$1 program=$2 clock=$3 json; shift 3
    json=$("$program" render "$scene" --json --repeat 5 --set "render.width=${size%x*}" --set "render.height=${size#*x}" "${@/#/--set=}")
    note "$who" "$(field "$clock" <<<"$json")" "$(field total <<<"$json")"
}
pov() { # pov CONTESTANT depth adc
    povray "+I$peers/rod.pov" "+O$work/pov.png" +W800 +H600 -D -A -V +WT1 "Declare=DEPTH=$2" "Declare=ADC=$3" >"$work/log" 2>&1
    note "$1" "$(awk '/Trace Time/ {f = 1} f && /CPU-seconds/ {for (i = 1; i <= NF; i++) if ($i == "with") {print $(i + 1); exit}}' "$work/log")" \
        "$(awk '/^Plane /{print $2; exit}' "$work/log")"
}
listing() { # listing CONTESTANT depth
    note "$1" "$("$work/listing" -d "$2" -t 1 -r 1 | awk 'END {print $3}')" "${listing_rays[$2]}"
}
declare -A listing_rays=([4]=NA [8]=NA)
if [ -n "$peers" ]; then
    [ "$size" = 800x600 ] || { echo "bench.sh: the peers' size is 800x600; leave SIZE out" >&2; exit 2; }
    command -v povray >/dev/null && command -v g++ >/dev/null || { echo "bench.sh: PEERS needs povray and g++" >&2; exit 1; }
    g++ -std=c++17 -O2 -o "$work/listing" "$peers/listing_baseline.cpp" -pthread
    g++ -std=c++17 -O2 -DCOUNT -o "$work/listing_count" "$peers/listing_baseline.cpp" -pthread
    while read -r _ depth _ _ _ _ _ _ _ total _; do listing_rays[$depth]=$total; done < <("$work/listing_count" | grep '^depth [48] ')
fi

for ((round = 0; round < reps; round++)); do
    for depth in 0 4 8; do frame "depth $depth" "$ours" cpu_s render.depth=$depth; done
    [ -z "$bare" ] || for depth in 4 8; do frame "depth $depth, no counters" "$bare" cpu_s render.depth=$depth; done
    frame "depth 8, pruned" "$ours" cpu_s render.depth=8 render.min_weight=0.00392156862745098
    for threads in 1 2 16 128 1024; do frame "wall, depth 8, $threads threads" "$ours" wall_s render.depth=8 render.threads=$threads; done
    # What the machine has to give: its units may share a core, a cache, or a host.
    frame "beside another" "$ours" wall_s render.depth=8 &
    frame "wall, depth 8, 1 thread beside another" "$ours" wall_s render.depth=8
    wait
    [ -n "$peers" ] || continue
    listing "the report's algorithm, depth 4" 4
    listing "the report's algorithm, depth 8" 8
    pov "POV-Ray, depth 8, pruned" 8 0.00392156862745098
    ((round >= 3)) || pov "POV-Ray, depth 8, whole tree" 8 0
done

median() { cut -f "$2" "$work/$1" | sort -g | awk '{a[NR] = $1} END {print NR % 2 ? a[(NR + 1) / 2] : (a[NR / 2] + a[NR / 2 + 1]) / 2}'; }
# The ratio of two contestants, round by round, then the median.
ratio() {
    [ -s "$work/$1" ] && [ -s "$work/$2" ] || return 0
    paste "$work/$1" "$work/$2" | awk -F'\t' '$1 != "" && $3 != "" {print $1 / $3}' | sort -g |
        awk -v what="$3" '{a[NR] = $1} END {printf "%-64s %8.3f   (%d rounds, %.3f to %.3f)\n", what, NR % 2 ? a[(NR + 1) / 2] : (a[NR / 2] + a[NR / 2 + 1]) / 2, NR, a[1], a[NR]}'
}
printf '%-40s %10s %12s %10s\n' "rod.yaml, $size" seconds rays "M rays/s"
rm -f "$work/beside another"
for f in "$work"/*\ *; do
    who=${f##*/}
    awk -v who="$who" -v s="$(median "$who" 1)" -v n="$(median "$who" 2)" 'BEGIN {printf "%-40s %10.4f %12s %10s\n", who, s, n, n == "NA" || n == "" ? "NA" : sprintf("%.1f", n / s / 1e6)}'
done
echo
ratio "depth 4" "depth 4, no counters" "counters, depth 4: time with / without"
ratio "depth 8" "depth 8, no counters" "counters, depth 8: time with / without"
ratio "wall, depth 8, 1 threads" "wall, depth 8, 2 threads" "two threads, depth 8: wall of one / wall of two"
ratio "wall, depth 8, 1 thread beside another" "wall, depth 8, 1 threads" "one thread beside another process: wall / wall of one alone"
ratio "wall, depth 8, 1024 threads" "wall, depth 8, 2 threads" "1024 threads, depth 8: wall / wall of two"
ratio "the report's algorithm, depth 4" "depth 4" "the report's algorithm / ours, depth 4"
ratio "the report's algorithm, depth 8" "depth 8" "the report's algorithm / ours, depth 8"
ratio "POV-Ray, depth 8, pruned" "depth 8, pruned" "POV-Ray / ours, depth 8, both pruned at 1/255"
ratio "POV-Ray, depth 8, whole tree" "depth 8" "POV-Ray / ours, depth 8, whole tree"
