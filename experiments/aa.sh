#!/bin/bash
# experiments/aa.sh: can one believe `cuvette study compare`? Compares the program with itself under a load that comes
# and goes (A/A: every verdict is wrong), then looks for a known difference of 3% with the number of processes that a
# pilot predicts for a power of 95% (A/B). Prints one line per comparison, separated by tabs, and the numbers of wrong
# and found.
# TRIES (20) comparisons of each kind; PROCESSES (8) of an A/A comparison, PILOT (12) of a pilot. CUVETTE: the program
# (build/cuvette). About 15 minutes. Exit status 1 if more than 2 in 25 are wrong, or fewer than 4 in 5 found.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C

cuvette=$(realpath "${CUVETTE:-build/cuvette}")
tries=${TRIES:-20}
processes=${PROCESSES:-8}
pilot=${PILOT:-12}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-aa.XXXXXX")
load=()
unload() {
    if ((${#load[@]})); then
        kill "${load[@]}" 2>/dev/null || true
        wait "${load[@]}" 2>/dev/null || true
    fi
    load=()
}
trap 'unload; rm -rf "$work"' EXIT

# The work is proportional to the number of paths, which are traced in batches of 16: 1648 take 3% longer than 1600.
write_study() { # NAME GRID
    cat >"$work/$1.study" <<EOF
study: $1
scene: $PWD/experiments/scenes/rod.yaml
set: {render.integrator: path, render.width: 12, render.height: 8, render.threads: 1}
grid: [{render.paths: $2}]
repetitions: 2
EOF
}
write_study same '[1600]'
write_study slower '[1600, 1648]'

field() { # NAME: of the line of all cells
    awk -F'\t' -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) n = i } $1 == "all" { print $n }'
}
compare() { # STUDY A B RESULTS: the table
    "$cuvette" study compare "$work/$1.study" "$2" "$3" --results "$4" --tsv
}
report() { # KIND TRY TABLE
    printf '%s\t%s' "$1" "$2"
    for name in processes_a ratio low high verdict pairs_needed; do
        printf '\t%s' "$(field "$name" <"$3")"
    done
    echo
}

printf 'kind\ttry\tprocesses\tratio\tlow\thigh\tverdict\tpairs_needed\n'
wrong=0
for ((try = 1; try <= tries; try++)); do
    # A load on every unit that starts or ends in the middle of every second comparison.
    if ((try % 2)); then
        for ((unit = 0; unit < $(nproc); unit++)); do
            (
                sleep 0.$((RANDOM % 10))
                exec timeout $((1 + RANDOM % 4)) sh -c 'while :; do :; done'
            ) &
            load+=($!)
        done
    fi
    results=$work/same$try
    "$cuvette" study run "$work/same.study" --quiet --processes="$processes" --against="$cuvette" --results "$results"
    unload
    compare same "$results" "$results-against" "$results" >"$work/table"
    report A/A "$try" "$work/table"
    [[ $(field verdict <"$work/table") == 'cannot tell' ]] || wrong=$((wrong + 1))
    rm -rf "$results" "$results-against"
done

found=0 looked=0
for ((try = 1; try <= tries; try++)); do
    results=$work/slower$try
    "$cuvette" study run "$work/slower.study" --quiet --processes="$pilot" --results "$results"
    compare slower render.paths=1600 render.paths=1648 "$results" >"$work/table"
    needed=$(field pairs_needed <"$work/table")
    rm -rf "$results"
    if [[ $needed == NA ]] || ((needed > 300)); then
        report A/B-too-noisy "$try" "$work/table"
        continue
    fi
    looked=$((looked + 1))
    # At least 6 repetitions and 3 processes have an interval.
    "$cuvette" study run "$work/slower.study" --quiet --processes=$((needed < 3 ? 3 : needed)) --results "$results"
    compare slower render.paths=1600 render.paths=1648 "$results" >"$work/table"
    report A/B "$try" "$work/table"
    [[ $(field verdict <"$work/table") == slower ]] && found=$((found + 1))
    rm -rf "$results"
done
echo "$wrong of $tries comparisons of the program with itself had a verdict; 3% was found in $found of $looked tries"
((wrong * 25 <= 2 * tries && looked > 0 && found * 5 >= 4 * looked))
