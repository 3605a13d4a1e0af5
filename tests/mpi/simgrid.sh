#!/bin/bash
# The simulation of cuvette-mpi on a cluster (experiments/cluster/simulated), with few ranks: it hands out all tiles,
# loses none, and its times follow from the costs and the cables.
# SIMULATED: the program that SimGrid runs. Not a part of make test: make test-simgrid runs it.
set -uo pipefail
export LC_ALL=C.UTF-8 SIMULATED=${SIMULATED:-$PWD/build/cluster/simulated}
folder=experiments/cluster/simulated
work=$(mktemp -d "${TMPDIR:-/tmp}/simgrid.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
holds() { # WHAT EXPRESSION: an awk expression
    awk "BEGIN { exit !($2) }"
    verdict $? "$1" "$2"
}
simulate() { # PLATFORM RANKS NAME=VALUE...: the row, its cells in the array `cell` from 0 (ranks)
    row=$("$folder/simulate.sh" "$@" scene_bytes=3500 2>"$work/errors")
    verdict $? "a frame on $1 with $2 ranks" "$(cat "$work/errors")"
    IFS=, read -ra cell <<<"$row"
}

if ! command -v smpirun >/dev/null || [[ ! -x $SIMULATED ]]; then
    skip 'SimGrid is missing: make setup-simgrid simulated'
    conclude
    exit
fi

# --- every tile once, whatever the ranks
path=("map=$folder/maps/path.pgm" width=1920 height=1080 paths=1024 pixel_bytes=48)
declare -A check
for ranks in 4 64; do
    simulate switch-100g "$ranks" "${path[@]}"
    holds "$ranks ranks: all 2040 tiles arrive, each of them once" "${cell[5]} == 2040 && ${cell[6]} == 0"
    holds "$ranks ranks: the efficiency is high and below 1" "${cell[12]} > 0.9 && ${cell[12]} <= 1"
    check[$ranks]=${cell[7]},${cell[8]},${cell[14]}
done
[[ ${check[4]} == "${check[64]}" ]]
verdict $? 'the sums over tiles, the work and the bytes are the same' "${check[4]} and ${check[64]}"

# --- times that follow by hand: work without messages' cost, a half-speed host, and the cable of rank 0
printf 'P2\n# unit 1000\n# paths 1\n1 1\n1\n1\n' >"$work/even.pgm" # 1 us a pixel
even=(map="$work/even.pgm" width=1024 height=1024 tile=32 tiles=0)
simulate switch-100g 4 "${even[@]}" pixel_bytes=0
holds '4 ranks share 1.048576 s of work' "${cell[11]} > 0.262144 && ${cell[11]} < 0.262144 * 1.01"
simulate stragglers-100g 64 "${even[@]}" pixel_bytes=0 paths=1000
holds 'one of 64 hosts at half the speed: all together have 63.5' "${cell[10]} / (${cell[8]} / 63.5) > 0.999999 && \
    ${cell[10]} / (${cell[8]} / 63.5) < 1.000001 && ${cell[12]} > 0.8"
simulate ethernet-10g 64 "${even[@]}" pixel_bytes=2400
link_s=$(awk 'BEGIN { print 63 / 64 * 1024 * 1024 * 2400 / (0.95 * 1.25e9) }') # 95% of the cable is payload
holds "the cable of rank 0 needs at least $link_s s for the others' tiles" \
    "${cell[11]} > 0.95 * $link_s && ${cell[11]} < 1.2 * $link_s"
conclude
