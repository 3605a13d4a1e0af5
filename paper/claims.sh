#!/bin/sh
# Judge every claim of paper/claims.tsv by the rows of a folder, and print its verdict: reproduced, not reproduced, or
# underpowered, which is what rows are that cannot decide it.
#   paper/claims.sh RESULTS OUT         after experiments/tables.sh RESULTS
# Writes OUT/claims.tsv (id, verdict, figure, reason, sentence), OUT/claims.tex (the sentences that the paper prints
# instead of claims that are not reproduced, and its table of claims) and, by numbers.sh, OUT/numbers.tex.
# Status: 0; 1 if a claim is not reproduced; 2 if claims.tsv is wrong, or there are no rows.
export LC_ALL=C.UTF-8
set -eu

here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
[ -d "$1" ] || {
    echo "claims: there is no folder $1; give one with RESULTS=DIR" >&2
    exit 2
}
# The environment of each study whose table has one.
for table in "$1"/tables/*.tsv; do
    [ ! -r "$table" ] || awk -F '\t' -v study="$(basename "$table" .tsv)" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == "environment") at = i }
        NR > 1 && at && $at != "NA" { print study "\t" $at; exit }' "$table"
done >"$out/environments"
[ -s "$out/environments" ] || {
    echo "claims: no tables of rows in $1/tables; run make experiments, or give another folder with RESULTS=DIR" >&2
    exit 2
}
"$here/numbers.sh" "$1" "$out"
awk -v tables="$1/tables" -v numbers="$out/numbers.tex" -f "$here/interval.awk" -f "$here/claims.awk" \
    "$here/claims.tsv" >"$out/claims.tsv" || exit 2
awk -v environments="$(cut -f 2 "$out/environments" | sort -u | tr '\n' ' ')" -f "$here/claims_tex.awk" \
    "$out/numbers.tex" "$out/claims.tsv" "$here/paper.tex" "$here/supplement.tex" >"$out/claims.tex"

echo "claims on the rows of $1"
cut -f 2 "$out/environments" | sort | uniq -c | while read -r count environment; do
    echo "environment $environment: $count studies"
done
awk -F '\t' -v here="$here" '{
    printf "%-15s %-18s %s%s\n", $2, $1, $3 == "-" ? "" : $3 "  ", $4 == "-" ? "" : "(" $4 ")"
    if ($2 != "reproduced") printf "%34s %s\n", "", $5
    number[$2]++
    if (match($4, /^no rows of [a-z-]+$/)) {
        study = substr($4, 12)
        command = "cd \"" here "/..\" && ls experiments/" study ".study experiments/full/" study ".study 2>/dev/null"
        if (!(study in missing) && (command | getline file) > 0) studies = studies " " file
        close(command)
        missing[study] = 1
    }
}
END {
    if (studies != "") print "for the missing rows: cuvette study run" studies
    printf "%d claims: %d reproduced, %d not reproduced, %d underpowered\n", NR, number["reproduced"],
        number["not reproduced"], number["underpowered"]
    exit number["not reproduced"] > 0
}' "$out/claims.tsv"
