# shellcheck shell=bash
# mpi: two ranks of cuvette-mpi with one thread each against one process with two threads; what a rank holds
# Needs cuvette-mpi next to CUVETTE (make mpi), two processing units and a quiet machine.
reps=${REPS:-7} ranked=$build/cuvette-mpi
scenes=('rod --set render.width=1600 --set render.height=1200 --set render.depth=8'
    'models --set render.width=1600 --set render.height=1200'
    'rod --set render.integrator=path --set render.paths=64')

prepare() {
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    need "$ranked" 'make mpi builds it next to CUVETTE'
}
on_ranks() { # on_ranks N ARGUMENT...
    mpirun --oversubscribe --bind-to none -n "$1" "$ranked" render "${@:2}" --json 2>/dev/null
}
round() {
    local scene words
    for scene in "${scenes[@]}"; do
        read -ra words <<<"$scene"
        words[0]=$here/scenes/${words[0]}.yaml
        note "threads $scene" "$("$ours" render "${words[@]}" --set render.threads=2 --json | field wall_s)"
        note "ranks $scene" "$(on_ranks 2 "${words[@]}" | field wall_s)"
    done
}

report() {
    local scene size
    printf 'scene\tthreads_2_s\tranks_2_s\tspeed_ratio\n'
    for scene in "${scenes[@]}"; do
        awk -v s="$scene" -v t="$(median "threads $scene" 1)" -v r="$(median "ranks $scene" 1)" \
            'BEGIN {printf "%s\t%.3f\t%.3f\t%.3f\n", s, t, r, t / r}'
    done
    printf '\nframe\tfilm_mb\trank_0_peak_mb\trank_1_peak_mb\tscene_bytes\tbytes_of_a_tile\n'
    for size in 400x300 1600x1200 6400x4800; do
        on_ranks 2 "$here/scenes/rod.yaml" --set render.width="${size%x*}" --set render.height="${size#*x}" |
            python3 -c '
import json, sys
o = json.load(sys.stdin)
zero, one = o["ranks"]
film = 24 * o["params"]["render.width"] * o["params"]["render.height"]
print(sys.argv[1], *("%.1f" % (v / 1e6) for v in (film, zero["peak_rss_bytes"], one["peak_rss_bytes"])),
      o["scene_bytes"], round(one["bytes_sent"] / max(1, one["tiles_sent"])), sep="\t")' "$size"
    done
}
