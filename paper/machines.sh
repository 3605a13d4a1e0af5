#!/bin/sh
# Compare the rows of other machines (results/machines/NAME/STUDY) with those of a run: one line a machine and study. A
# cell is compared if both have it, by its identity; the same are film hash and ray count.
#   paper/machines.sh RESULTS
# Columns: machine; study; its processor; other: 1 if the run has another one; n: cells; same; different: their numbers.
export LC_ALL=C
set -eu
results=$1
machines=$(cd "$(dirname "$0")/../results" && pwd)/machines

# The identity of each cell, its number, and each pair of film and count of its rows.
cells() {
    awk -F, '
        /^#/ { next }
        !column["identity"] { for (i = 1; i <= NF; i++) column[$i] = i; next }
        { print $column["identity"], $column["cell"], $column["film_hash"], $column["rays_total"] }' "$1" | sort -u
}
# The processor is the last part of the topology.
processor() { sed -n '/"topology"/ { s/.*, //; s/",*$//; s/ *$//; p; q; }' "$1"; }

work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-machines.XXXXXX")
trap 'rm -rf "$work"' EXIT
printf 'machine\tstudy\tprocessor\tother\tn\tsame\tdifferent\n'
for rows in "$machines"/*/*/rows.csv; do
    folder=${rows%/rows.csv}
    study=${folder##*/}
    machine=${folder%/*}
    [ -r "$results/$study/runs.json" ] && [ -r "$folder/runs.json" ] || continue # those of a study
    cells "$rows" >"$work/theirs"
    cells "$results/$study/rows.csv" >"$work/ours"
    there=$(processor "$folder/runs.json")
    here=$(processor "$results/$study/runs.json")
    join "$work/theirs" "$work/ours" | awk -v OFS='\t' -v machine="${machine##*/}" -v study="$study" -v there="$there" \
        -v other="$([ "$there" != "$here" ] && echo 1 || echo 0)" '
        { cell[$1] = $2; if ($2 == $5 && $3 == $6 && $4 == $7) equal[$1] = 1; else if ($2 == $5) odd[$1] = 1 }
        $2 == $5 { both[$1] = 1 }
        END {
            for (id in both) {
                n++
                if (id in odd) list = list (list == "" ? "" : " ") cell[id]
                else same++
            }
            print machine, study, there, other, n + 0, same + 0, list == "" ? "none" : list
        }'
done
