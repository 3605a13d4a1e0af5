#!/bin/bash
# Fault injection: makes allocations, threads and system calls fail in each command of tests/faults/commands.txt, one
# a run, and judges how the command ends (tests/faults/judge.h). One line for each command and kind of fault ("ok
# ...", "not ok ..."). A part of the sites, unless FAULTS_EVERY=1: of every second command, every FAULTS_EVERYth site;
# and call stacks count as the same when their FAULTS_DEPTH innermost frames are (0: all frames). FAULTS_ONLY,
# FAULTS_KINDS: names, separated by commas. FAULTS_TABLE: a file for the table of verdicts.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root" || exit 1
build=$(realpath "${BUILD:-build}")
export CUVETTE=${CUVETTE:-$build/cuvette}
export CUVETTE_IMPORT=${CUVETTE_IMPORT:-${CUVETTE%/*}/cuvette-import}
case ${CONFIG:-release} in
release) ;;
*)
    echo "# instrumented programs allocate by themselves"
    exit 77
    ;;
esac
[[ -x $build/faults/faults ]] || {
    echo "# $build/faults is not built"
    exit 77
}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-faults.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
bash tests/faults/template.sh "$work/template" || exit 1

# The commands are divided among the processors.
without='^#'
command -v gnuplot >/dev/null || without="$without| gnuplot "
some=memory,thread,open-emfile,read-eio,write-enospc,fsync-eio,rename-eio
[[ ${FAULTS_EVERY:-96} == 1 ]] || FAULTS_KINDS=${FAULTS_KINDS:-$some}
every=2
[[ ${FAULTS_EVERY:-96} != 1 && ! ${FAULTS_ONLY:-} ]] || every=1
jobs=${FAULTS_JOBS:-$(nproc)} only=${FAULTS_ONLY:-}
grep -Ev "$without" tests/faults/commands.txt |
    awk -v every="$every" -v jobs="$jobs" -v only="${only// /,}" -v folder="$work" '
    number++ % every { next }
    only == "" || index("," only ",", "," $1 ",") { print >(folder "/table." n++ % jobs) }'
started=()
for table in "$work"/table.*; do
    own=$work/work.${table##*.}
    mkdir "$own"
    "$build/faults/faults" --every "${FAULTS_EVERY:-96}" --depth "${FAULTS_DEPTH:-5}" \
        ${FAULTS_KINDS:+--kinds "${FAULTS_KINDS// /,}"} --shown "${FAULTS_SHOWN:-5}" \
        --library "$build/faults/preload.so" \
        --work "$own" --template "$work/template" "$table" "cuvette=$CUVETTE" "engine=$build/faults/engine_user" \
        "lab=$build/faults/lab_client" >"$own.out" 2>&1 &
    started+=($!)
done
failed=0
for one in "${started[@]}"; do wait "$one" || failed=1; done
cat "$work"/work.*.out | grep -v '^##'
cat "$work"/work.*.out | sed -n 's/^##\t//p' | sort -s -k 1,1 >"$work/table"
[[ ${FAULTS_TABLE:-} ]] && cp "$work/table" "$FAULTS_TABLE"
awk -F '\t' '
    { sites += $3; tried += $4; missed += $5; unharmed += $6; reported += $7; crash += $8; silent += $9; message += $10
      leftover += $11; leak += $12 }
    END {
        printf "# %d sites, %d failed once, %d not reached; ", sites, tried, missed
        printf "%d reported, %d unharmed; ", reported, unharmed
        printf "crashes %d, silent %d, messages %d, leftovers %d, leaks %d\n", crash, silent, message, leftover, leak
    }' "$work/table"
exit "$failed"
