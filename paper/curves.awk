# Print, for each curve, the number of points and their largest deviation from theory: awk -v study=NAME -f scientific.awk -f curves.awk TABLE-curves.tsv
BEGIN { FS = "\t" }
NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
$at["measured"] != "NA" && $at["theory"] != "NA" {
    curve = $at["curve"]
    off = $at["measured"] - $at["theory"]
    if (off < 0) off = -off
    if (off > worst[curve] + 0) worst[curve] = off
    points[curve]++
    all++
}
END {
    for (c in points) {
        printf "\\setval{%s/curve/%s/points}{%d}\n", study, c, points[c]
        printf "\\setval{%s/curve/%s/worst}{%s}\n", study, c, scientific(worst[c] + 0)
    }
    if (all) printf "\\setval{%s/curves/points}{%d}\n", study, all
}
