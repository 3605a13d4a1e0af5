#!/bin/sh
# How often conclusions flip: the rates that experiments/repeat.sh drew from its rows, of RESULTS and of the other
# machines in results/machines, as OUT/tables/flips.tsv; prints their \setval lines.
#   paper/flips.sh RESULTS OUT
# The rates are not drawn again, which takes minutes; tests/claims.sh checks that the program still gives some of them.
export LC_ALL=C
set -eu
results=$1
out=$2
here=$(cd "$(dirname "$0")" && pwd)
table=$out/tables/flips.tsv

rates() { # FOLDER MACHINE LOAD
    [ -r "$1/power.tsv" ] && [ -r "$1/values.csv" ] || return 0
    [ -s "$table.new" ] ||
        printf '%s\n' machine load others contrast work order design processes repetitions rule \
            n ratio ratio_low ratio_high wrong wrong_low wrong_high silent silent_low silent_high |
        paste -s - >"$table.new"
    others=$(awk -f "$here/../plots/select.awk" -v columns=others_share "$1/values.csv" |
        awk '{ sum += $1 } END { if (NR) printf "%.3f", sum / NR }')
    printf '\\setval{flips/%s/%s/others}{%.0f}\n' "$2" "$3" "$(awk -v s="$others" 'BEGIN { print 100 * s }')"
    works=$(awk -f "$here/../plots/select.awk" -v columns='cell rays_total' "$1/values.csv" | sort -u | sort -n |
        awk 'BEGIN { split("inert two ten fifty threads", name, " ") } { rays[$1] = $2; print "kinds", NR }
            $1 > 0 { print name[$1], $2 / rays[0] }')
    printf '%s\n' "$works" | awk -v key="flips/$2/$3" '{ last[$1] = $2 }
        END {
            for (c in last)
                if (c == "kinds") printf "\\setval{%s/rays/kinds}{%d}\n", key, last[c]
                else printf "\\setval{%s/%s/rays}{%.3f}\n", key, c, last[c]
        }' |
        sort
    printf '\\setval{flips/%s/%s/rows}{%d}\n' "$2" "$3" "$(($(wc -l <"$1/values.csv") - 1))"
    awk -v machine="$2" -v load="$3" -v others="$others" -v works="$works" -v table="$table.new" \
        -f "$here/flips.awk" "$1/power.tsv"
}

rm -f "$table.new"
rates "$results/repeat" here found
rates "$results/repeat-loaded" here loaded
for folder in "$here"/../results/machines/*/; do
    rates "$folder/repeat" "$(basename "$folder")" found
    rates "$folder/repeat-loaded" "$(basename "$folder")" loaded
done
[ ! -s "$table.new" ] || mv "$table.new" "$table"
