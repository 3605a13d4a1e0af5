#!/bin/bash
# Checks that make targets build the programs that their commands run, and which tests `make test only=NAME` runs. Reads
# the plan of `make -n` for an empty build folder; builds nothing. `make help` fits two screens and names targets.
set -uo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-targets.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset MAKEFLAGS MFLAGS MAKELEVEL

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh

plan() { make -n CC=gcc config=release build="$work/build" RESULTS="$work/results" "$@" 2>&1; }
builds() { # TARGET PROGRAM...: passes if the plan links each program
    local target=$1 plan program
    shift
    plan=$(plan "$target")
    for program in "$@"; do
        grep -qE -- "-o $work/build/$program( |$)" <<<"$plan"
        verdict $? "make $target builds $program" "$(tail -n 3 <<<"$plan" | cut -c 1-200)"
    done
}
# cuvette runs cuvette-import to read mesh files.
builds experiments cuvette cuvette-import
builds bench cuvette cuvette-import nocounters/cuvette peers/report tests/bench_mesh
builds test peers/report tests/bench_mesh

# only=NAME: programs and scripts, with what they run.
tests_of() { plan test only="$1" | sed -n "s, *tests/run *,,p" | sed "s,$work/build/,,g; s, *\$,,"; }
equal "only=optics is a program" "$(tests_of optics)" tests/test_optics
equal "only=cli is a script" "$(tests_of cli)" tests/cli/test_cli.sh
equal "only=study_plot is both" "$(tests_of study_plot)" "tests/study/study_plot.sh tests/test_study_plot"
equal "two names" "$(tests_of "limits optics readme")" "tests/cli/limits.sh tests/manual/readme.sh tests/test_optics"
[[ $(plan test only=limits) == *"-o $work/build/cuvette "*"-o $work/build/tests/bench_mesh "* ]]
verdict $? "only=limits builds what scripts run"
says=$(plan test only=limit)
equal "an unknown name: status 2" $? 2
[[ $(wc -l <<<"$says") == 1 && $says == *"limit.sh; did you mean: "*limits* ]]
verdict $? "an unknown name: one line, with names that resemble it" "$says"

help=$(make --no-print-directory help)
[[ $(wc -l <<<"$help") -le 48 ]]
verdict $? "help has at most 48 lines" "$(wc -l <<<"$help")"
equal "lines of help of more than 80 columns" "$(awk 'length > 80' <<<"$help")" ""
missing=
for name in $(sed 's/  .*//; s/\(.*\)\[-\(.*\)\]/\1 \1-\2/; s/|-.*//; s/,//; 1d; s/setup-NAME//' <<<"$help"); do
    grep -qE "^$name( [^=]*)?:" Makefile mk/*.mk || [[ $name == setup ]] || missing+=" $name"
done
equal "targets of help that no rule has" "$missing" ""
conclude
