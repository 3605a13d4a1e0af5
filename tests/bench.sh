#!/bin/bash
# experiments/bench.sh runs, in a size too small to mean anything, and prints every ratio.
set -uo pipefail
cuvette=${CUVETTE:-build/cuvette}
if report=$(REPS=1 SIZE=32x24 experiments/bench.sh "$cuvette" "$cuvette" 2>&1); then
    echo "ok 1 - the benchmark runs"
else
    echo "not ok 1 - the benchmark runs"
    printf '%s\n' "$report"
    exit 1
fi
for want in 'counters, depth 4' 'counters, depth 8' 'two threads' '1024 threads, depth 8: wall / wall of two'; do
    if grep -qE "^$want.* [0-9]+\.[0-9]{3}   \(1 rounds" <<<"$report"; then
        echo "ok - $want"
    else
        echo "not ok - $want"
        printf '%s\n' "$report"
        failed=1
    fi
done
exit "${failed:-0}"
