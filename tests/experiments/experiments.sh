#!/bin/bash
# The way of `make experiments`: experiments/run.sh on small studies in a copy of the scripts, one of which fails;
# Ctrl-C and going on; the comparison with a committed run; and the closing page from the reference rows. CUVETTE names
# the program, BUILD the build.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
root=$PWD
build=$(cd "${BUILD:-build}" && pwd) || exit 1
export CUVETTE=${CUVETTE:-$build/cuvette}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-experiments.XXXXXX")
trap 'rm -rf "$work"' EXIT

# A tree with three studies: the first figure's, one whose scene is missing, and a long one.
mkdir -p "$work/experiments" "$work/results/reference"
cp -r experiments/{run.sh,tables.sh,report.sh,report.awk,published} "$work/experiments/"
cp -r plots "$work/"
tiny() { # NAME REPETITIONS
    cat >"$work/experiments/$1.study" <<END
study: $1
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 16, render.height: 12, render.threads: 1}
grid: [{render.depth: [0, 1]}]
repetitions: $2
warmups: 0
keep: {image: on}
END
}
tiny portrait 2
tiny first 2
run() { # into $code and $work/said
    (cd "$work" && experiments/run.sh "$@") >"$work/said" 2>&1
    code=$?
}
rows() { grep -c "^$1," "$work/results/$1/rows.csv"; }

# --- all is well
run
equal "status 0" "$code" 0
equal "a line per study, the first figure's first" "$(grep -o '^\[ [12]/2\] [a-z]*' "$work/said" | paste -sd ' ')" \
    "[ 1/2] portrait [ 2/2] first"
grep -q 'figures rod; about [0-9]* s left$' "$work/said"
verdict $? "with the figure that was drawn and the time left" "$(cat "$work/said")"
[[ -s $work/results/figures/rod.png && -s $work/results/tables/first.tsv ]]
verdict $? "figure and tables are there" "$(ls "$work/results"/*)"
page=$work/results/report.txt
empty "the page is saved" "$(tail -n "$(wc -l <"$page")" "$work/said" | diff "$page" -)"

# --- against a committed run
mkdir -p "$work/results/reference"
cp -r "$work"/results/{portrait,first} "$work/results/reference/"
run
equal "a complete run again: status 0" "$code" 0
equal "and no new row" "$(rows first)" 4
grep -q "^Films and ray counts: 4 of 4 cells equal the committed run's, bit for bit (4 films)" "$work/said"
verdict $? "all films are those of the committed run" "$(grep Films "$work/said")"
awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
    NR > 1 && $at["cell"] == 1 { $at["film_hash"] = $at["film_expected"] = "0123456789abcdef" } { print }' \
    "$work/results/first/rows.csv" >"$work/results/reference/first/rows.csv"
"$build/tests/recheck" "$work/results/reference/first/rows.csv" "$work/results/reference/first/runs.json"
run
equal "a film that differs: status 1" "$code" 1
grep -q "^Films and ray counts: 3 of 4 cells" "$work/said" && grep -q '^  different: first, cells 1$' "$work/said"
verdict $? "the page names the cell" "$(cat "$work/said")"
rm -r "$work/results/reference"

# --- a study that fails
tiny broken 2
sed -i 's|^scene: .*|scene: missing.yaml|' "$work/experiments/broken.study"
rm -r "$work/results"
run
equal "a study fails: status 1" "$code" 1
equal "the others are measured" "$(rows portrait) $(rows first)" "4 4"
grep -q '^FAILED: broken$' "$work/said"
verdict $? "the page names it" "$(cat "$work/said")"
rm "$work/experiments/broken.study"

# --- quick
run --quick
equal "quick: status 0" "$code" 0
equal "quick: rows in a folder of their own" "$(cd "$work/results" && ls -d quick/*/rows.csv | paste -sd ' ')" \
    "quick/first/rows.csv quick/portrait/rows.csv"
equal "quick: a repetition each" "$(grep -c ^first, "$work/results/quick/first/rows.csv")" 2
equal "quick: the table says so" "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "quick") at = i; next }
    { print $at }' "$work/results/quick/tables/first.tsv" | paste -sd ' ')" "1 1"
grep -q '^A QUICK RUN: ' "$work/results/quick/report.txt"
verdict $? "quick: and the page" "$(cat "$work/results/quick/report.txt")"

# --- Ctrl-C, as a terminal sends it: to all processes of the job, when a row is there
tiny first 100000
rm -r "$work/results"
set -m # a job of its own, with SIGINT as a terminal's job has it
(cd "$work" && exec experiments/run.sh) >"$work/said" 2>&1 &
job=$!
set +m
until [[ $(rows first 2>/dev/null || true) -gt 2 ]] || ! kill -0 $job 2>/dev/null; do sleep 0.05; done
kill -INT -- -$job
wait $job
equal "Ctrl-C: status 130" "$?" 130
kept=$(rows first)
[[ $kept -gt 2 ]]
verdict $? "Ctrl-C: rows are kept" "$kept rows"
grep -q 'run it again to go on$' "$work/said"
verdict $? "Ctrl-C: the message says how to go on" "$(tail -3 "$work/said")"
tiny first 2
run
equal "after it: status 0" "$code" 0
equal "after it: no row is lost" "$(($(rows first) >= kept))" 1

# --- mistakes
for mistake in "--wrong:unknown option --wrong" "--results:--results is empty" \
    "none.study:there is no study none.study"; do
    run "${mistake%%:*}"
    equal "${mistake%%:*}: status 2" "$code" 2
    equal "${mistake%%:*}: one line" "$(wc -l <"$work/said")" 1
    grep -q "^run.sh: ${mistake#*:}" "$work/said"
    verdict $? "${mistake%%:*}: what is wrong" "$(cat "$work/said")"
done

# --- the closing page from the reference rows
mkdir "$work/page"
ln -s "$root"/results/reference/{depth,threads,triangles,coverage,crowding,methods,lighting,shading} "$work/page/"
experiments/tables.sh "$work/page" depth threads triangles coverage crowding methods lighting shading
experiments/report.sh "$work/page" >"$work/said"
equal "page: status 0" "$?" 0
empty "page: every statement has its number" \
    "$(sed -n '/^Said in the reports/,/^$/p' "$work/said" | grep ' -$')"
empty "page: at most 100 columns" "$(awk 'length($0) > 100' "$work/said")"
ours() { # STUDY CELL BASE COLUMN
    awk -F '\t' -v cell="$2" -v base="$3" -v column="$4" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["cell"] == cell { a = $at[column] } $at["cell"] == base { b = $at[column] } END { printf "%.3f", a / b }' \
        "$work/page/tables/$1.tsv"
}
# The published values are 24.755420 / 2.709822, 1.21875 / 5.10565 and 300 / 110.
line=$(grep -o '^  *8  *9\.135 .*\]  *[0-9.]*' "$work/said" | tr -s ' ')
[[ $line == " 8 9.135 $(ours depth 8 0 cpu_s_median) [13"*" 1.4"* ]]
verdict $? "page: depth 8, published and here, interval and ratio" "$line"
grep -q " 1024  *0\.239  *$(ours threads 10 0 wall_s_median) \[" "$work/said"
verdict $? "page: 1024 threads" "$(grep 1024 "$work/said")"
grep -q "^  *50000  *2\.727  *$(ours crowding 8 4 cpu_s_median) .* $(ours crowding 13 9 cpu_s_median) " "$work/said"
verdict $? "page: 50000 overlapping triangles, octant tree and boxes" "$(grep 50000 "$work/said")"
equal "page: a line for each published value" "$(grep -cE '^ +([0-8]|[1-5]0000) +[0-9.]+ ' "$work/said")" 19
rm "$work/page/tables/depth.tsv"
experiments/report.sh "$work/page" | grep -A 1 'Recursion depth' | grep -q '^  not measured'
verdict $? "page: a study without rows is not measured" "$(experiments/report.sh "$work/page" | sed -n 5,8p)"
experiments/report.sh "$work/none" >"$work/said" 2>&1
equal "page: no tables: status 2" "$? $(wc -l <"$work/said")" "2 1"
conclude
