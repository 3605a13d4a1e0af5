#!/bin/bash
# bench.sh NAME... - measure speed as ratios of contestants that take turns: one round runs every contestant once, so
# that drift of the machine affects all equally; medians and ranges over the rounds. Without a name it prints the list:
# a bench is a file experiments/bench/NAME.sh, whose head says what it measures and which variables change it.
# Common to all: CUVETTE=build/cuvette, REPS (rounds).
#   SEED=7 experiments/bench.sh solids lights
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
ours=${CUVETTE:-build/cuvette}
build=$(dirname "$ours")
source "$here/rounds.sh"

# A file defines round, and what it needs of prepare, report (after the rounds), reps (rounds, without REPS).
bench() (
    name="bench.sh $1" work=$work/$1 reps=${REPS:-5}
    mkdir "$work"
    prepare() { :; }
    report() { :; }
    need "$ours" 'make builds it'
    source "$here/bench/$1.sh"
    prepare
    for ((round = 0; round < reps; round++)); do round; done
    report
)

if (($# == 0)); then
    echo 'usage: experiments/bench.sh NAME...; the head of experiments/bench/NAME.sh has its variables'
    sed -sn '2s/^# /  /p' "$here"/bench/*.sh
    exit 2
fi
for bench in "$@"; do
    [ -f "$here/bench/$bench.sh" ] || {
        names=("$here"/bench/*.sh)
        names=("${names[@]##*/}")
        echo "bench.sh: no bench $bench; there are: ${names[*]%.sh}" >&2
        exit 2
    }
done
for bench in "$@"; do
    [ "$bench" == "$1" ] || echo
    bench "$bench"
done
