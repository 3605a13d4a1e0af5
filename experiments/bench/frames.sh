# shellcheck shell=bash
# frames: rod.yaml by depth and threads, with the report's algorithm and POV-Ray
# SIZE=800x600; NOCOUNTERS, a program without counters. The others are peers/report next to CUVETTE (make peers) and,
# if it is installed, POV-Ray (make setup-peers), which reads rod.yaml from `cuvette scene --export`. Pruned: branches
# with less than 1/255 of a camera ray's weight are not followed. CPU seconds cover only the tracing; POV-Ray reports
# its own. POV-Ray traces the whole tree only in the first three rounds, because it takes a quarter of a minute each
# time.
reps=${REPS:-7} size=${SIZE:-800x600} bare=${NOCOUNTERS:-} algorithm=$build/peers/report with_pov=

prepare() {
    need "$algorithm" 'make peers builds it next to CUVETTE'
    if command -v povray >/dev/null; then
        with_pov=1
    else
        echo "$name: POV-Ray is not installed and is left out; make setup-peers installs it" >&2
    fi
}
# frame CONTESTANT PROGRAM CLOCK [set...]: the median of five frames in one worker pool
frame() { traced "$1" "$3" "$2" "$here/scenes/rod.yaml" --repeat 5 "${@:4}"; }
pov() { # pov CONTESTANT depth adc; the ground is unbounded, so the number of its tests is the number of rays
    "$ours" scene "$here/scenes/rod.yaml" --set "render.depth=$2" --set "render.min_weight=$3" \
        --export "$work/rod.pov" >"$work/log" 2>&1 || failed "$ours" "$work/log"
    povray "+I$work/rod.pov" "+O$work/pov.png" "+W${size%x*}" "+H${size#*x}" -D -A -V +WT1 >"$work/log" 2>&1 ||
        failed povray "$work/log"
    note "$1" "$(awk \
        '/Trace Time/ {f = 1} f && /CPU-seconds/ {for (i = 1; i <= NF; i++) if ($i == "with") {print $(i + 1); exit}}' \
        "$work/log")" \
        "$(awk '/^Plane /{print $2; exit}' "$work/log")"
}
report_frame() { # report_frame CONTESTANT depth
    local row
    row=$("$algorithm" -d "$2" -s "$size" | tail -n 1)
    note "$1" "$(cut -f 4 <<<"$row")" "$(cut -f 6 <<<"$row")"
}

round() {
    local depth threads deep=(--set render.depth=8)
    for depth in 0 4 8; do frame "depth $depth" "$ours" cpu_s --set render.depth=$depth; done
    [ -z "$bare" ] || for depth in 4 8; do
        frame "depth $depth, no counters" "$bare" cpu_s --set render.depth=$depth
    done
    frame "depth 8, pruned" "$ours" cpu_s "${deep[@]}" --set render.min_weight=0.00392156862745098
    for threads in 1 2 16 128 1024; do
        frame "wall, depth 8, $threads threads" "$ours" wall_s "${deep[@]}" --set render.threads=$threads
    done
    # The limit of the machine itself: its processing units may share a core, a cache, or a host.
    frame "other process" "$ours" wall_s "${deep[@]}" &
    frame "wall, depth 8, 1 thread next to another" "$ours" wall_s "${deep[@]}"
    wait
    for depth in 0 4 8; do report_frame "the report's algorithm, depth $depth" $depth; done
    [ -n "$with_pov" ] || return 0
    pov "POV-Ray, depth 8, pruned" 8 0.00392156862745098
    ((round >= 3)) || pov "POV-Ray, depth 8, whole tree" 8 0
}

report() {
    local file who
    printf '%-40s %10s %12s %10s\n' "rod.yaml, $size" seconds rays "M rays/s"
    rm -f "$work/other process"
    for file in "$work"/*\ *; do
        who=${file##*/}
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
}
