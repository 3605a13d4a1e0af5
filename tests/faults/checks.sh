#!/bin/bash
# checks.sh [N...]: removes each check of checks.tsv (or those of the numbers given) from a copy of the
# sources, builds it, and expects that the injected faults find it. A missing check that they do not find is reported,
# and the status is 1. BUILD is the folder with the tools of make faults.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-checks.XXXXXX")
trap 'rm -rf "$work"' EXIT
cp -a "$root/Makefile" "$root/mk" "$root/src" "$root/tests" "$root/.ci" "$root/plots" "$work"
mkdir -p "$work/experiments" "$work/build"
cp -r "$root"/experiments/{scenes,hands,cluster} "$work/experiments"
# What is built already, with its times, so that only what changes is built again.
cp -a "$BUILD"/{flags,obj,plain,web,lib*.a,cuvette,cuvette-import} "$work/build"
build() {
    CCACHE_NOHASHDIR=1 make -s -j2 -C "$work" build/cuvette build/cuvette-import >"$work/log" 2>&1 || {
        cat "$work/log" >&2
        exit 2
    }
}
missed=0 number=0
build
while IFS=$'\t' read -r file old new command kind; do
    [[ $file == \#* ]] && continue
    number=$((number + 1))
    [[ $# -eq 0 || " $* " == *" $number "* ]] || continue
    old=${old//'\n'/$'\n'} new=${new//'\n'/$'\n'}
    text=$(<"$root/$file")
    [[ $text == *"$old"* ]] || {
        echo "checks.sh: check $number: $file has no '$old' any more" >&2
        exit 2
    }
    printf '%s\n' "${text/"$old"/"$new"}" >"$work/$file"
    build
    CUVETTE=$work/build/cuvette FAULTS_EVERY=1 FAULTS_DEPTH=0 FAULTS_ONLY=$command FAULTS_KINDS=$kind \
        FAULTS_SHOWN=1 bash "$work/tests/faults/faults.sh" >"$work/out" 2>&1 && status=0 || status=$?
    found=$(sed -n 's/^# \(crash\|silent\|message\|leftover\|leak\), call/\1 of call/p' "$work/out" |
        head -1 | cut -c 1-150)
    if ((status == 1)) && [[ $found ]]; then
        echo "ok $number - $file without '${old//$'\n'/ }': $found"
    else
        echo "not ok $number - $file without '${old//$'\n'/ }': not found"
        tail -3 "$work/out" | sed 's/^/# /'
        missed=1
    fi
    cp "$root/$file" "$work/$file" # newer than its object
done <"$root/tests/faults/checks.tsv"
exit $missed
