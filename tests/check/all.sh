#!/bin/bash
# tests/check/all.sh, run by `make check-all`: every kind of check, about an hour on two processors, and a page of the
# results, build/check/page.md. The tests with gcc run whole. What would take hours runs in rotation: each time those
# that ran longest ago, so that all have run after some times (tests/check/rotate.sh).
#   all.sh [PART...]      the parts below; all of them without arguments
# CHECK_SCALE (1) multiplies the time that a part in rotation may take.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
export LC_ALL=C.UTF-8
build=${BUILD:-build} check=${BUILD:-build}/check scale=${CHECK_SCALE:-1}
mkdir -p "$check"
unset MAKEFLAGS MFLAGS MAKELEVEL
failed=0

mapfile -t tests < <(printf '%s\n' tests/test_*.c | sed 's,tests/test_\(.*\)\.c,\1,')

# The longest of them, acts and laws, are shortened: whole they are among the tests with gcc.
in_rotation() { # STATE SECONDS COMMAND [NAME...]: the unit tests, or those named
    local state=$1 seconds=$2 command=$3
    shift 3
    (($#)) || set -- "${tests[@]}"
    ACTS_SCENE=coin.yaml tests/check/rotate.sh "$check/$state.state" $((seconds * scale)) "$command" "$@"
}

part() { # NAME COMMAND...
    local name=$1 begun=$SECONDS code
    shift
    ((${#chosen[@]} == 0)) || [[ " ${chosen[*]} " == *" $name "* ]] || return 0
    echo "check-all: $name"
    "$@" >"$check/$name.log" 2>&1 </dev/null
    code=$?
    ((code == 0)) || failed=1
    printf '%s\t%s\t%s\t%s\n' "$name" "$([[ $code == 0 ]] && echo passed || echo "FAILED, status $code")" \
        $((SECONDS - begun)) "$(tail -n 1 "$check/$name.log" | tr '\t|' ' /')" >>"$check/rows"
}

write_page() {
    {
        printf '# Results of make check-all\n\n'
        printf 'Cuvette %s, %s processors, %s.\n\n' "$("$build/cuvette" --version | cut -d ' ' -f 2-)" "$(nproc)" \
            "$("${CC:-gcc}" --version | head -n 1)"
        printf '| part | result | time (s) | last line |\n|---|---|---:|---|\n'
        awk -F '\t' '{ printf "| %s | %s | %s | %s |\n", $1, $2, $3, $4 }' "$check/rows"
        printf '\nParts in rotation run the tests that ran longest ago; the last line says how many of all.\n'
    } >"$check/page.new"
    mv "$check/page.new" "$check/page.md"
}

chosen=("$@")
: >"$check/rows"
threaded=(tracer_pool worker_pool renderer render path_determinism determinism lab_render_worker lab_live lab_semaphore
    lab_rescue lab_load http study_run engine piece_source tracing)
part tests make STRICT=1 test
part clang in_rotation clang 100 'make -s clang LAWS_SCENES=200'
part sanitize in_rotation sanitize 150 'make -s sanitize LAWS_SCENES=200'
part threads in_rotation threads 100 'make -s tsan LAWS_SCENES=200' "${threaded[@]}"
part valgrind in_rotation valgrind 100 'make -s valgrind'
mapfile -t commands < <(awk '/^[a-z]/ { print $1 }' tests/faults/commands.txt)
part faults in_rotation faults 120 'make -s faults' "${commands[@]}"
part power-cuts env POWER_STATES=$((6000 * scale)) POWER_RESUMED=5 make -s power-cuts
part interrupts make -s interrupts MOMENTS=$((96 * scale))
part fuzz make -s fuzz FUZZ_TOTAL=$((120 * scale)) FUZZ_SECONDS=30
measure_coverage() { # the last line: how many of all ran, and what all that ran before reach
    local code=0 line
    in_rotation coverage 100 'make -s coverage-add' >"$check/coverage.out" 2>&1 || code=$?
    make -s coverage-report >"$check/coverage.report" || code=$?
    line=$(tail -n 1 "$check/coverage.out")
    cat "$check/coverage.out" "$check/coverage.report"
    echo "$line; $(awk '/^lines|^branches/ { printf "%s %s  ", $1, $2 }' "$check/coverage.report")"
    return $code
}
part coverage measure_coverage
part mutants env MUTANT_SECONDS=$((200 * scale)) tests/mutants/mutants.sh
write_page
cat "$check/page.md"
exit $failed
