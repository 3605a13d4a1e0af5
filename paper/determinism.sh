#!/bin/sh
# Write the tables about the same bits everywhere and their price: determinism.tsv and determinism-bits.tsv, from the
# rows of experiments/determinism.sh of this run ("this") and of other machines; films.tsv, of experiments/films.sh; and
# machines.tsv, of the studies of other machines. A table without rows is not written.
#   paper/determinism.sh RESULTS TABLES
export LC_ALL=C
set -eu
results=$1 tables=$2
here=$(cd "$(dirname "$0")" && pwd)
committed=$here/../results

# The lines of a table after those that are there, without a second header.
add() { # TABLE
    if [ -s "$1" ]; then tail -n +2 >>"$1"; else cat >"$1"; fi
}
for folder in "$results" "$committed"/machines/*; do
    machine=${folder##*/}
    [ "$folder" != "$results" ] || machine=this
    [ -r "$folder/determinism/rows.csv" ] || continue
    awk -v machine="$machine" -f "$here/../experiments/order.awk" -f "$here/prices.awk" \
        "$folder/determinism/rows.csv" | add "$tables/determinism.tsv"
    awk -v machine="$machine" -f "$here/bits.awk" "$folder/determinism/images.csv" "$folder/determinism/bits.csv" |
        add "$tables/determinism-bits.tsv"
done
if ls "$committed"/films/*.csv >/dev/null 2>&1; then
    awk -f "$here/films.awk" "$committed"/films/*.csv >"$tables/films.tsv"
fi
"$here/machines.sh" "$results" >"$tables/machines.tsv"
[ "$(wc -l <"$tables/machines.tsv")" -gt 1 ] || rm "$tables/machines.tsv"
