#!/bin/bash
# A study that is killed (SIGKILL) at 5 random times, with CHECK=1 at 20, and resumed each time: no row is lost,
# duplicated or incomplete, and the final cells equal those of an uninterrupted run. CUVETTE names the program; KILLS
# is the number of kills, KILL_SEED the seed of their times.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
program=${CUVETTE:-build/cuvette}
kills=${KILLS:-${CHECK:+20}}
kills=${kills:-5}
seed=${KILL_SEED:-$(($(date +%s) % 32768))}
RANDOM=$seed
[[ -x $program ]] || {
    echo "# $program is not built"
    exit 77
}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-kill-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
echo "# seed $seed"

cat >"$work/kill.study" <<END
study: kill
scene: $PWD/experiments/scenes/rod.yaml
set: {render.width: 200, render.height: 150}
grid:
  - {render.depth: [0, 1, 2, 3, 4]}
  - {render.threads: [1, 2, 8]}
repetitions: 4
warmups: 1
keep: {workers: on, image: on, timeline: on}
END

case=0 bad=0
result() { # status name
    case=$((case + 1))
    if (($1 == 0)); then echo "ok $case - $2"; else
        echo "not ok $case - $2"
        bad=1
    fi
}

study() { "$program" study run --results "$1" "$work/kill.study" >"$work/output" 2>&1; }

# The complete lines of a file: text after the last newline is an incomplete row.
complete_lines() { [[ -f $1 ]] && if [[ -n $(tail -c 1 "$1") ]]; then sed '$d' "$1"; else cat "$1"; fi; }

# Each line of rows.csv has all its columns; no cell and repetition is duplicated; with "complete", each cell has 4
# measured repetitions.
check_rows() {
    awk -F, -v complete="${2:-}" '
        NR == 1 { columns = NF; next }
        NF != columns { print "line " NR " has " NF " columns"; bad = 1 }
        seen[$3, $4]++ { print "duplicate row: cell " $3 ", repetition " $4; bad = 1 }
        { cells[$3]; counted[$3] += !$5; marked += $12 }
        END {
            for (cell in cells) {
                n++
                if (complete && counted[cell] != 4) { print "cell " cell " has " counted[cell] " repetitions"; bad = 1 }
            }
            if (complete && n != 15) { print n " cells"; bad = 1 }
            if (marked) { print marked " rows are marked"; bad = 1 }
            exit bad
        }' <(complete_lines "$1")
}

# Every row has one worker row per thread, and there are no other worker rows.
check_workers() {
    awk -F, '
        FNR == 1 { file++; next }
        file == 1 { threads[$3, $4] = $9; rows++ }
        file == 2 && !(($3, $4) in threads) { print "worker row without a row: cell " $3 " repetition " $4; bad = 1 }
        file == 2 && seen[$3, $4, $8]++ { print "duplicate worker row"; bad = 1 }
        file == 2 { have[$3, $4]++ }
        END {
            for (key in threads)
                if (have[key] != threads[key]) { print "a row has " have[key] " worker rows"; bad = 1 }
            exit bad
        }
    ' "$1/rows.csv" "$1/workers.csv"
}

cells() { awk -F, 'NR > 1 { print $3, $8, $9 }' "$1" | sort -u; }

study "$work/whole"
result $? "an uninterrupted run succeeds"
check_rows "$work/whole/kill/rows.csv" complete
result $? "its rows are complete"

killed=0 round=0 lost=0 torn=0 rounds_bad=0
while ((killed < kills)); do
    round=$((round + 1))
    results=$work/results-$round
    : >"$work/before"
    while :; do
        "$program" study run --results "$results" "$work/kill.study" >"$work/output" 2>&1 &
        child=$!
        sleep "$(awk -v r=$RANDOM 'BEGIN { printf "%.3f", 0.02 + 0.9 * r / 32768 }')"
        kill -9 "$child" 2>/dev/null
        wait "$child" 2>/dev/null
        code=$?
        complete_lines "$results/kill/rows.csv" >"$work/after"
        cmp -s -n "$(stat -c %s "$work/before")" "$work/before" "$work/after" || lost=$((lost + 1))
        check_rows "$results/kill/rows.csv" || torn=$((torn + 1))
        cp "$work/after" "$work/before"
        ((code == 137)) || break
        killed=$((killed + 1))
        ((killed < kills)) || {
            study "$results"
            code=$?
            break
        }
    done
    ((code == 0)) || {
        cat "$work/output"
        rounds_bad=$((rounds_bad + 1))
    }
    cmp -s -n "$(stat -c %s "$work/before")" "$work/before" "$results/kill/rows.csv" || lost=$((lost + 1))
    check_rows "$results/kill/rows.csv" complete || rounds_bad=$((rounds_bad + 1))
    check_workers "$results/kill" || rounds_bad=$((rounds_bad + 1))
    [[ $(cells "$results/kill/rows.csv") == "$(cells "$work/whole/kill/rows.csv")" ]] || rounds_bad=$((rounds_bad + 1))
    [[ $(cd "$results/kill/images" && sha256sum *.png) == "$(cd "$work/whole/kill/images" && sha256sum *.png)" ]] ||
        rounds_bad=$((rounds_bad + 1))
    study "$results" && grep -q "nothing to do" "$work/output" || rounds_bad=$((rounds_bad + 1))
done
result $lost "$killed kills: no row is lost"
result $torn "after each kill every line is complete and none is duplicated"
result $rounds_bad "$round resumed studies have the same cells and images, and every row has its worker rows"
echo "1..$case"
exit $bad
