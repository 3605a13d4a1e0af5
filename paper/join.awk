# Print a summary's lines of one environment, without that column, and with the intervals of `cuvette study summary
# --interval` appended: for a column X of it X_median, X_low, X_high, X_min and X_max.
#   awk -v chosen=HEX -f join.awk SPREAD.tsv SUMMARY.tsv          SPREAD.tsv may be empty
# A summary without a column of environments belongs to "unknown".
BEGIN {
    FS = OFS = "\t"
    parts = split("median low high min max", part, " ")
}
FILENAME == ARGV[1] {
    if (FNR == 1) {
        for (i = 1; i <= NF; i++) spread_at[$i] = i
        next
    }
    if ($spread_at["environment"] != chosen) next
    name = $spread_at["column"]
    if (!(name in seen)) { seen[name] = 1; names[++count] = name }
    for (i = 1; i <= parts; i++) of[$1, name, part[i]] = $spread_at[part[i]]
    next
}
FNR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    place = ("environment" in at) ? at["environment"] : 0
    line = ""
    for (i = 1; i <= NF; i++) if (i != place) line = line (line == "" ? "" : OFS) $i
    for (k = 1; k <= count; k++)
        for (i = 1; i <= parts; i++) line = line OFS names[k] "_" part[i]
    print line
    next
}
place ? $place == chosen : chosen == "unknown" {
    line = ""
    for (i = 1; i <= NF; i++) if (i != place) line = line (line == "" ? "" : OFS) $i
    for (k = 1; k <= count; k++)
        for (i = 1; i <= parts; i++)
            line = line OFS ((($1, names[k], part[i]) in of) ? of[$1, names[k], part[i]] : "NA")
    print line
}
