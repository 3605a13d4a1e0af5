#!/bin/bash
# Checks that the text of every fault in tests/faults/laws.tsv, checks.tsv and detect.tsv still occurs in its file:
# `make law-faults`, `make fault-checks` and experiments/detect.sh, which take long, stop at the first one that does
# not.
set -uo pipefail
cd "$(dirname "$0")/../.."
count=0 failed=0
while IFS=$'\t' read -r file old new _; do
    [[ $file == \#* ]] && continue
    old=${old//'\n'/$'\n'}
    count=$((count + 1))
    if [[ -f $file && -n $old && $new != "$old" && $(<"$file") == *"$old"* ]]; then
        echo "ok $count - $file: $new"
    else
        failed=1
        echo "not ok $count - $file does not contain '$old', which the fault replaces by '$new'"
    fi
done < <(cat tests/faults/laws.tsv tests/faults/checks.tsv tests/faults/detect.tsv)
if grep -q $'\t\t' tests/faults/laws.tsv tests/faults/checks.tsv tests/faults/detect.tsv; then
    # read takes two tabs for one
    failed=1
    echo "not ok $((count + 1)) - a field is empty"
fi
((count > 0)) || failed=1
exit $failed
