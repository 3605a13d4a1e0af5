#!/bin/bash
# What targets of the Makefile would build, from nothing: the programs that a target's commands run are among it. Reads
# `make -n`; builds nothing.
set -uo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-targets.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset MAKEFLAGS MFLAGS MAKELEVEL

count=0 failed=0
builds() { # TARGET PROGRAM...: each is linked when nothing is there yet
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
