#!/bin/bash
# check.sh, run by `make check`: everything that checks Cuvette, in slices. Each run goes on where the last
# one stopped: slices that failed come first, then those that have waited longest; those that have passed with the
# present sources are not run again. The last lines are a table of what ran, and how many have passed.
#   check.sh [NAME...]    the slices of these names (acts-3), or whose names begin with them (acts, sanitize)
# CHECK_SECONDS: when to stop, in seconds; a slice that is not done then is stopped, and is no failure.
# CHECK_FIRST: begin with this slice of the list, a number of any size: another one each time where nothing is kept.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
export LC_ALL=C.UTF-8
build=${BUILD:-build} check=${BUILD:-build}/check
state=$check/state.tsv
mkdir -p "$check"
touch "$state"
unset MAKEFLAGS MFLAGS MAKELEVEL

# in_groups NAME SIZE COMMAND WORD...: a slice for SIZE words at a time; the command finds them in the variable only.
in_groups() {
    local name=$1 size=$2 command=$3 number=0
    shift 3
    while (($#)); do
        printf '%s-%d\tonly="%s" %s\n' "$name" $((number++)) "${*:1:size}" "$command"
        shift $(($# < size ? $# : size))
    done
}

# All slices, a line each: name, tab, command.
slices() {
    local i
    local -a tests commands threaded=(worker_pool renderer render sampling_kernels determinism
        lab_render_worker lab_live lab_semaphore lab_rescue lab_load http study_run engine tile_source tracing)
    mapfile -t tests < <(find tests -name 'test_*.c' | sed 's,.*/test_\(.*\)\.c,\1,' | sort)
    mapfile -t commands < <(awk '/^[a-z]/ { print $1 }' tests/faults/commands.txt)
    for i in {0..11}; do
        printf 'acts-%d\tACTS_SLICE=%d/12 ACTS_NOTES="%s" make -s test only=acts\n' "$i" "$i" "$check/acts-$i.notes"
    done
    printf 'acts-notes\t%s\n' "tests/check/acts_notes.sh $check"
    for i in 1 2 3 4; do
        printf 'laws-%d\tLAWS_SCENES=3000 LAWS_SEED=%d make -s test only=laws\n' "$i" "$i"
    done
    in_groups whole 1 'CHECK=1 make -s STRICT=1 test' "${whole[@]}"
    in_groups faults 4 'make -s faults' "${commands[@]}"
    printf 'power-cuts\tPOWER_STATES=6000 POWER_RESUMED=5 make -s power-cuts\n'
    printf 'interrupts\tmake -s interrupts MOMENTS=96\n'
    in_groups sanitize 12 'make -s sanitize LAWS_SCENES=200' "${tests[@]}"
    in_groups threads 4 'make -s tsan LAWS_SCENES=200' "${threaded[@]}"
    in_groups clang 24 'make -s clang LAWS_SCENES=200' "${tests[@]}"
    in_groups valgrind 6 'make -s valgrind' "${tests[@]}"
    printf 'fuzz\tmake -s fuzz FUZZ_TOTAL=120 FUZZ_SECONDS=30\n'
    printf 'mutants\tMUTANT_SECONDS=250 tests/mutants/mutants.sh\n'
}
# Tests that are shorter in `make test`: scripts look at the variable CHECK, programs include whole.h.
mapfile -t whole < <(grep -rlE --include='*.sh' --include='test_*.c' '\{CHECK:[-+]|^#include "whole.h"' tests |
    sed 's,.*/,,; s,^test_,,; s,\.[a-z]*$,,' | sort)

sources() {
    find Makefile mk .ci src tests experiments plots paper -type f -print0 | sort -z | xargs -0 sha256sum | sha256sum
}

# The slices of these sources that have not passed, in the order in which they are to run: name, tab, command.
due() { # KEY NAME...
    local key=$1
    shift
    slices | awk -F '\t' -v OFS='\t' -v key="$key" -v names="$*" -v first="${CHECK_FIRST:-0}" '
        FILENAME != "-" { when[$1] = $3; passed[$1] = $2 == key && $4 == "passed"; failed[$1] = $4 == "failed"; next }
        function wanted(name, i, n, each) {
            if (names == "") return !passed[name]
            n = split(names, each, " ")
            for (i = 1; i <= n; i++) if (name == each[i] || index(name, each[i] "-") == 1) return 1
        }
        { line[count++] = $0; name[count - 1] = $1 }
        END {
            for (i = 0; i < count; i++)
                if (wanted(name[i]))
                    print !failed[name[i]], when[name[i]] + 0, (i - first % count + count) % count, line[i]
        }' "$state" - | sort -k1,1n -k2,2n -k3,3n | cut -f 4-
}

# Runs a slice within what is left of the time, and notes how it ended: name, key, when, result, seconds, last line.
# tests/tools/limit.c, without limits here, ends all its processes at the end of the time and at Ctrl-C.
run_slice() { # NAME COMMAND KEY
    local begun=$SECONDS code=0 result
    TEST_LIMIT_S=1e9 TEST_IDLE_S=1e9 timeout --foreground $((CHECK_SECONDS - SECONDS)) "$check/limit" \
        env -u TEST_LIMIT_S -u TEST_IDLE_S bash -c "$2" >"$check/$1.log" 2>&1 </dev/null || code=$?
    case $code in
    0) result=passed ;;
    77 | 124) result=unfinished ;;
    130 | 143) exit $code ;;
    *) result=failed ;;
    esac
    printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$1" "$3" "$(date +%s)" $result $((SECONDS - begun)) \
        "$(tail -n 1 "$check/$1.log" | tr '\t' ' ')" >>"$state"
    tail -n 1 "$state" | table
    [[ $result != failed ]] || grep -aE -m 20 '^(FAIL| *not ok)|error|stopped:|\*\*\*' "$check/$1.log" | sed 's/^/    /'
    [[ $result != failed ]]
}
table() { awk -F '\t' '{ printf "%-12s %-10s %5d s  %s\n", $1, $4, $5, $6 }'; }

if [[ ${1:-} == --list ]]; then
    slices
    exit
fi
: "${CHECK_SECONDS:=1000000}"
key=$(sources | cut -c 1-16)
[[ $(cat "$check/key" 2>/dev/null) == "$key" ]] || rm -f "$check"/acts-*.notes
echo "$key" >"$check/key"
"${CC:-gcc}" -std=gnu17 -D_GNU_SOURCE -O1 -o "$check/limit" tests/tools/limit.c -lm || exit 1
failed=0 ran=0
mapfile -t list < <(due "$key" "$@")
for line in "${list[@]}"; do
    ((SECONDS < CHECK_SECONDS)) || break
    ran=$((ran + 1))
    run_slice "${line%%$'\t'*}" "${line#*$'\t'}" "$key" || failed=$((failed + 1))
done
# One line for each slice: the last.
awk -F '\t' '{ last[$1] = $0 } END { for (name in last) print last[name] }' "$state" | sort >"$state.new"
mv "$state.new" "$state"
passed=$(awk -F '\t' -v key="$key" '$2 == key && $4 == "passed"' "$state" | wc -l)
echo "$ran slices ran, $failed failed; with these sources $passed of $(slices | wc -l) have passed"
((failed == 0))
