#!/bin/bash
# tests/faults/laws.sh [N...]: puts each fault of laws.tsv (or those of the numbers given) into a copy of the sources, builds tests/test_laws there and
# wants it to fail. A fault that no law catches is reported, and the status is 1. LAWS_SCENES=10000 is how many scenes each law may use.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
cp -r "$root/Makefile" "$root/src" "$root/tests" "$root/.ci" "$work"
mkdir -p "$work/experiments"
missed=0 number=0
# Fewer scenes first: most faults show at once, or never come to an end.
catches() { ! LAWS_SCENES=500 timeout 120 "$work/build/tests/test_laws" || ! LAWS_SCENES=${LAWS_SCENES:-10000} timeout 900 "$work/build/tests/test_laws"; }
while IFS=$'\t' read -r file old new; do
    [[ $file == \#* ]] && continue
    number=$((number + 1))
    [[ $# -eq 0 || " $* " == *" $number "* ]] || continue
    text=$(<"$root/$file")
    [[ $text == *"$old"* ]] || { echo "laws.sh: fault $number: $file has no '$old' any more" >&2; exit 2; }
    printf '%s\n' "${text/"$old"/"$new"}" >"$work/$file"
    if ! make -s -j2 -C "$work" warnings= build/tests/test_laws >"$work/log" 2>&1; then
        cat "$work/log" >&2
        exit 2
    fi
    if catches >"$work/out" 2>&1; then
        laws=$(sed -n 's/^law \([0-9]\).*, \([1-9][0-9]*\) broken.*/law \1/p' "$work/out" | sort -u | paste -s -d ',')
        echo "ok $number - $file: $new: caught by ${laws:-a crash or no end}"
    else
        echo "not ok $number - $file: $new: not caught"
        missed=1
    fi
    cp "$root/$file" "$work/$file"
done <"$root/tests/faults/laws.tsv"
exit $missed
