#!/bin/bash
# experiments/mpi_bench.sh [ROUNDS]: the speed of cuvette-mpi on this machine: two ranks with one thread each against
# one process with two threads, measured in turn; and what a rank holds. Medians; needs two units and a quiet machine.
set -euo pipefail
cd "$(dirname "$0")/.."
rounds=${1:-7} build=${BUILD:-build}
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-mpi-bench.XXXXXX")
trap 'rm -rf "$work"' EXIT

on_ranks() { # N ARGUMENT...
    local n=$1
    shift
    mpirun --oversubscribe --bind-to none -n "$n" "$build/cuvette-mpi" render "$@" --json 2>/dev/null
}
value() { python3 -c 'import json, sys; o = json.load(sys.stdin); print(eval(sys.argv[1]))' "$1"; }
median() { sort -g "$1" | awk '{v[NR] = $1} END {print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2}'; }

printf 'scene\tthreads_2_s\tranks_2_s\tspeed_ratio\n'
for scene in 'rod --set render.width=1600 --set render.height=1200 --set render.depth=8' \
    'models --set render.width=1600 --set render.height=1200' \
    'rod --set render.integrator=path --set render.paths=64'; do
    read -ra words <<<"$scene"
    words[0]=experiments/scenes/${words[0]}.yaml
    rm -f "$work"/*
    for ((i = 0; i < rounds; i++)); do
        "$build/cuvette" render "${words[@]}" --set render.threads=2 --json 2>/dev/null | value 'o["wall_s"]' \
            >>"$work/threads"
        on_ranks 2 "${words[@]}" | value 'o["wall_s"]' >>"$work/ranks"
    done
    awk -v s="$scene" -v t="$(median "$work/threads")" -v r="$(median "$work/ranks")" \
        'BEGIN {printf "%s\t%.3f\t%.3f\t%.3f\n", s, t, r, t / r}'
done

printf '\nframe\tfilm_mb\trank_0_peak_mb\trank_1_peak_mb\tscene_bytes\tbytes_of_a_tile\n'
for size in 400x300 1600x1200 6400x4800; do
    on_ranks 2 experiments/scenes/rod.yaml --set render.width="${size%x*}" --set render.height="${size#*x}" |
        python3 -c '
import json, sys
o = json.load(sys.stdin)
zero, one = o["ranks"]
film = 24 * o["params"]["render.width"] * o["params"]["render.height"]
print(sys.argv[1], *("%.1f" % (v / 1e6) for v in (film, zero["peak_rss_bytes"], one["peak_rss_bytes"])),
      o["scene_bytes"], round(one["bytes_sent"] / max(1, one["tiles_sent"])), sep="\t")' "$size"
done
