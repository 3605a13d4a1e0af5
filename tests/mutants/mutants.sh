#!/bin/bash
# mutants.sh, run by `make mutants`: small errors in src/optics, src/geometry, src/render and src/study,
# one at a time, that a unit test must detect. MUTANTS (600) are drawn by SEED (1) and compiled into one copy of the
# sources, build/mutants/tree (instrument.py); run.py runs the tests. The same command goes on where it stopped, after
# MUTANT_SECONDS at most, as long as the sources are the same; tests that changed or are new run with those that
# survived. equivalent.tsv lists survivors that change nothing, and why. The status is 1 if others survive.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=${BUILD:-build}/mutants tree=${BUILD:-build}/mutants/tree python=/usr/bin/python3
"$python" -c 'import clang.cindex' 2>/dev/null || {
    echo 'mutants: the Python module clang is missing; install it with: apt-get install python3-clang-14' >&2
    exit 1
}
mkdir -p "$work"
sources=$(find src tests/mutants/instrument.py Makefile mk -type f -print0 | sort -z |
    xargs -0 sha256sum | sha256sum)
wanted="$sources ${MUTANTS:-600} ${SEED:-1}"
if [[ "$(cat "$work/made" 2>/dev/null)" != "$wanted" ]]; then
    rm -rf "$tree" "$work/made"
    mkdir -p "$tree"
    cp -r Makefile mk README.md CHANGELOG.md .ci src tests experiments plots results paper "$tree"
    "$python" tests/mutants/instrument.py "$tree" "${MUTANTS:-600}" "${SEED:-1}"
    echo "$wanted" >"$work/made"
fi
cp -ru tests "$tree"
begun=$SECONDS limit=${MUTANT_SECONDS:-1000000} code=0
# shellcheck disable=SC2046 # names of programs
nice timeout --foreground "$limit" make -j"$(nproc)" -s -C "$tree" warnings=-w all \
    $(find "$tree/tests" -name 'test_*.c' -printf 'build/tests/%f\n' | sed 's/\.c$//') \
    >"$work/build.log" 2>&1 || code=$?
if ((code == 124)); then
    echo "${MUTANTS:-600} mutants: still being compiled after $limit s; the same command goes on"
    exit 0
elif ((code != 0)); then
    grep -m 5 'error' "$work/build.log" >&2
    exit 1
fi
exec "$python" tests/mutants/run.py "$tree" tests/mutants/equivalent.tsv $((limit - (SECONDS - begun)))
