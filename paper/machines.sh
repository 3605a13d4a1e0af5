#!/bin/sh
# Compare the rows of other machines (results/machines/NAME/STUDY) with those of a run: one line a machine and study, of
# `cuvette study films`.
#   paper/machines.sh RESULTS
# CUVETTE: the program (default: build/cuvette). Columns: machine; those of `study films`, of studies with cells that
# both have.
export LC_ALL=C
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
for folder in "$root"/results/machines/*/; do
    "${CUVETTE:-$root/build/cuvette}" study films --results "$1" --against "$folder" \
        "$root"/experiments/*.study "$root"/experiments/full/*.study 2>/dev/null |
        awk -F '\t' -v OFS='\t' -v machine="$(basename "$folder")" '
            NR == 1 { for (i = 1; i <= NF; i++) if ($i == "n") n = i; print "machine", $0; next }
            $n > 0 { print machine, $0 }'
done | awk 'NR == 1 || !/^machine\t/'
