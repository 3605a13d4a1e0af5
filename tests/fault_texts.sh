#!/bin/bash
# Every fault of tests/faults/laws.tsv names text that stands in its file: else `make law-faults`, which takes an hour,
# would stop at it.
set -uo pipefail
cd "$(dirname "$0")/.."
count=0 failed=0
while IFS=$'\t' read -r file old new; do
    [[ $file == \#* ]] && continue
    count=$((count + 1))
    if [[ -f $file && -n $old && $new != "$old" ]] && grep -qF -- "$old" "$file"; then
        echo "ok $count - $file: $new"
    else
        failed=1
        echo "not ok $count - $file has no '$old' for '$new' to take the place of"
    fi
done <tests/faults/laws.tsv
((count > 0)) || failed=1
exit $failed
