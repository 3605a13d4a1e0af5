#!/bin/bash
# bench.sh - measure speed as ratios of contestants that take turns in one run; medians of REPS rounds.
#   experiments/bench.sh CUVETTE [CUVETTE_WITHOUT_COUNTERS]
# Environment: REPS=7 (rounds), SIZE=800x600. One round runs every contestant once, so that drift of the machine affects
# all equally: the report's algorithm (peers/report next to CUVETTE; make peers) and, if it is installed, POV-Ray
# (make setup-peers) with peers/rod.pov. Pruned: branches with less than 1/255 of a camera ray's weight are not
# followed. CPU seconds cover only the tracing; POV-Ray reports its own. POV-Ray traces the whole tree only in the first
# three rounds, because it takes a quarter of a minute each time.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/rounds.sh"
ours=${1:-${CUVETTE:-build/cuvette}} bare=${2:-${NOCOUNTERS:-}} reps=${REPS:-7}
report=$(dirname "$ours")/peers/report
need "$ours" 'make builds it'
need "$report" 'make peers builds it next to CUVETTE'
scene=$here/scenes/rod.yaml size=${SIZE:-800x600} with_pov=
if command -v povray >/dev/null; then
    with_pov=1
else
    echo "bench.sh: POV-Ray is not installed and is left out; make setup-peers installs it" >&2
fi

# A contestant's values: seconds, rays.
# frame CONTESTANT PROGRAM CLOCK [set...]: the median of five frames in one worker pool
frame() {
    local who=$1 program=$2 clock=$3 json
    shift 3
    json=$("$program" render "$scene" --json --repeat 5 --set "render.width=${size%x*}" --set \
        "render.height=${size#*x}" "${@/#/--set=}")
    note "$who" "$(field "$clock" <<<"$json")" "$(field total <<<"$json")"
}
pov() { # pov CONTESTANT depth adc; the ground is unbounded, so the number of its tests is the number of rays
    povray "+I$here/peers/rod.pov" "+O$work/pov.png" "+W${size%x*}" "+H${size#*x}" -D -A -V +WT1 \
        "Declare=DEPTH=$2" "Declare=ADC=$3" >"$work/log" 2>&1 ||
        {
            echo "bench.sh: povray failed: $(tail -n 1 "$work/log")" >&2
            exit 1
        }
    note "$1" "$(awk \
        '/Trace Time/ {f = 1} f && /CPU-seconds/ {for (i = 1; i <= NF; i++) if ($i == "with") {print $(i + 1); exit}}' \
        "$work/log")" \
        "$(awk '/^Plane /{print $2; exit}' "$work/log")"
}
report_frame() { # report_frame CONTESTANT depth
    local row
    row=$("$report" -d "$2" -s "$size" | tail -n 1)
    note "$1" "$(cut -f 4 <<<"$row")" "$(cut -f 6 <<<"$row")"
}

for ((round = 0; round < reps; round++)); do
    for depth in 0 4 8; do frame "depth $depth" "$ours" cpu_s render.depth=$depth; done
    [ -z "$bare" ] || for depth in 4 8; do frame "depth $depth, no counters" "$bare" cpu_s render.depth=$depth; done
    frame "depth 8, pruned" "$ours" cpu_s render.depth=8 render.min_weight=0.00392156862745098
    for threads in 1 2 16 128 1024; do frame "wall, depth 8, $threads threads" "$ours" wall_s render.depth=8 \
        render.threads=$threads; done
    # The limit of the machine itself: its processing units may share a core, a cache, or a host.
    frame "other process" "$ours" wall_s render.depth=8 &
    frame "wall, depth 8, 1 thread next to another" "$ours" wall_s render.depth=8
    wait
    for depth in 0 4 8; do report_frame "the report's algorithm, depth $depth" $depth; done
    [ -n "$with_pov" ] || continue
    pov "POV-Ray, depth 8, pruned" 8 0.00392156862745098
    ((round >= 3)) || pov "POV-Ray, depth 8, whole tree" 8 0
done

printf '%-40s %10s %12s %10s\n' "rod.yaml, $size" seconds rays "M rays/s"
rm -f "$work/other process"
for f in "$work"/*\ *; do
    who=${f##*/}
    awk -v who="$who" -v s="$(median "$who" 1)" -v n="$(median "$who" 2)" \
        'BEGIN {printf "%-40s %10.4f %12s %10s\n", who, s, n,
            n == "NA" || n == "" ? "NA" : sprintf("%.1f", n / s / 1e6)}'
done
echo
ratio "depth 4" "depth 4, no counters" "counters, depth 4: time with / without"
ratio "depth 8" "depth 8, no counters" "counters, depth 8: time with / without"
ratio "wall, depth 8, 1 threads" "wall, depth 8, 2 threads" "two threads, depth 8: wall of one / wall of two"
ratio "wall, depth 8, 1 thread next to another" "wall, depth 8, 1 threads" \
    "one thread next to another process: wall / wall of one alone"
ratio "wall, depth 8, 1024 threads" "wall, depth 8, 2 threads" "1024 threads, depth 8: wall / wall of two"
ratio "the report's algorithm, depth 0" "depth 0" "the report's algorithm / ours, depth 0 (it casts no shadow rays)"
ratio "the report's algorithm, depth 4" "depth 4" "the report's algorithm / ours, depth 4"
ratio "the report's algorithm, depth 8" "depth 8" "the report's algorithm / ours, depth 8"
ratio "POV-Ray, depth 8, pruned" "depth 8, pruned" "POV-Ray / ours, depth 8, both pruned at 1/255"
ratio "POV-Ray, depth 8, whole tree" "depth 8" "POV-Ray / ours, depth 8, whole tree"
