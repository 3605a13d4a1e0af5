#!/bin/bash
# A later version of the program, with one more parameter and one more column: built from a changed copy of the sources,
# it summarises the rows of this version as this version does, also those of the reference run, and this version reads
# its rows. Only where the program was built without instrumentation, and only with CHECK=1, since it builds all.
# CUVETTE names the program.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
program=$(realpath "${CUVETTE:-build/cuvette}")
[[ -n ${CHECK:-} ]] || {
    echo "ok 1 # SKIP another version is built with CHECK=1 only"
    exit 0
}
[[ ${CONFIG:-release} == release ]] || {
    echo "ok 1 # SKIP only for the release build"
    exit 0
}
[[ -x $program ]] || {
    echo "# $program is not built"
    exit 77
}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-version-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

count=0 failed=0
check() { # NAME COMMAND...
    local name=$1
    count=$((count + 1))
    shift
    if "$@" >"$work/out" 2>&1; then echo "ok $count - $name"; else
        echo "not ok $count - $name"
        sed 's/^/# /' "$work/out" | head -n 5
        failed=$((failed + 1))
    fi
}

# --- the later version
mkdir "$work/later"
cp -r Makefile mk src plots .ci "$work/later"
mkdir -p "$work/later/tests" "$work/later/experiments"
cp -r experiments/cluster "$work/later/experiments"
cd "$work/later" || exit 1
change() { # FILE OLD NEW: the first OLD becomes NEW
    local text
    text=$(<"$1")
    [[ $text == *"$2"* ]] || {
        echo "not ok - $1 has no '$2'"
        exit 1
    }
    printf '%s\n' "${text/"$2"/"$3"}" >"$1"
}
field='    int64_t depth; '
change src/scene/model/render_settings.h "$field" "    int64_t later;
$field"
row='    INTEGER(PARAM_RENDER, render_settings, depth,'
change src/scene/model/params_table.c "$row" \
    "    INTEGER(PARAM_RENDER, render_settings, later, \"\", 0, 9, \"3\", \"of a later version\"),
$row"
quantity=' Q(cpu_s, "s", REAL,'
change src/job/quantities.c "$quantity" \
    " Q(later, \"\", COUNT, MEDIAN, IN_ROWS, \"later\", NULL, \"of a later version\", a->of->render.later) \\
$quantity"
make -s -j"$(nproc)" warnings= build/cuvette build/cuvette-import >"$work/build.log" 2>&1 || {
    sed 's/^/# /' "$work/build.log" | tail -n 5
    echo "not ok - the later version is built"
    exit 1
}
later=$work/later/build/cuvette
cd "$root" || exit 1
check "the later version has another build" test "$("$program" --version)" != "$("$later" --version)"
check "the later version has a parameter more" grep -q 'render.later' <("$later" params)

# --- the reference run
for rows in results/reference/*/rows.csv; do
    study=$(basename "$(dirname "$rows")")
    file=$(ls experiments/{,full/}"$study.study" 2>/dev/null)
    "$program" study summary --results results/reference "$file" >"$work/now.tsv"
    "$later" study summary --results results/reference "$file" >"$work/later.tsv"
    check "$study: the reference rows have the same summary" cmp "$work/now.tsv" "$work/later.tsv"
done

# --- rows of each version for the other
cat >"$work/own.study" <<END
study: own
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 16, render.height: 12}
grid: [{render.depth: [0, 1]}]
repetitions: 2
keep: {workers: on}
END
cd "$work" || exit 1
"$program" study run own.study --quiet
"$program" study summary own.study >now.tsv
"$later" study summary own.study >later.tsv
check "rows of this version have the same summary" cmp now.tsv later.tsv
check "rows of this version pass every check of the later one" "$later" study verify own.study
cp results/own/rows.csv before.csv
check "the later version measures for itself" "$later" study run own.study --quiet
check "its file has a column more" grep -q ',later' <(head -n 1 results/own/rows.csv)
check "rows of both pass every check of the later version" "$later" study verify own.study
check "rows of both pass every check of this version" "$program" study verify own.study
check "the rows of this version stay as they were" \
    diff <(sed 1d before.csv) <(sed 1d results/own/rows.csv | head -n 6 | sed 's/,NA$//')
"$program" study summary own.study --environment "$(awk 'NR == 2 {print $NF}' now.tsv)" >again.tsv
check "and their summary" cmp now.tsv again.tsv
check "nothing of them is measured again" test "$("$program" study run own.study)" = "own: complete, nothing to do"
sed 's/render.height: 12/render.height: 12, render.later: 4/' own.study >changed.study
"$later" study status changed.study >status.txt
check "a value that is not the default is another cell" grep "own: 0 of 2 cells done" status.txt

echo "$((count - failed)) passed, $failed failed"
((failed == 0))
