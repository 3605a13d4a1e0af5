# Print the environment of a summary that has most rows (of equal ones the last), or the wanted one; "unknown" for tables without environments.
#   awk -v wanted=HEX -f environment.awk SUMMARY.tsv
BEGIN { FS = "\t" }
NR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
"environment" in at && $at["n"] > 0 {
    rows[$at["environment"]] += $at["n"]
    if (!($at["environment"] in order)) order[$at["environment"]] = ++count
}
END {
    best = "unknown"
    for (e in rows)
        if (best == "unknown" || rows[e] > rows[best] || (rows[e] == rows[best] && order[e] > order[best])) best = e
    print wanted != "" ? wanted : best
}
