#!/bin/bash
# Checks that make targets build the programs that their commands run. Reads the plan of `make -n` for an empty build
# folder; builds nothing.
set -uo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-targets.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset MAKEFLAGS MFLAGS MAKELEVEL

count=0 failed=0
builds() { # TARGET PROGRAM...: passes if the plan links each program
    local target=$1 plan program
    shift
    plan=$(make -n CC=gcc config=release build="$work/build" RESULTS="$work/results" "$target" 2>&1)
    for program in "$@"; do
        count=$((count + 1))
        if grep -qE -- "-o $work/build/$program( |$)" <<<"$plan"; then
            echo "ok $count - make $target builds $program"
        else
            failed=1
            echo "not ok $count - make $target builds $program"
            tail -n 3 <<<"$plan" | cut -c 1-200 | sed 's/^/# /'
        fi
    done
}

# cuvette runs cuvette-import to read mesh files.
builds experiments cuvette cuvette-import
builds bench cuvette cuvette-import nocounters/cuvette peers/report tests/bench_mesh
builds test peers/report tests/bench_mesh
exit "$failed"
