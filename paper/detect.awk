# Print the numbers of results/detect/rows.csv as TeX: for each kind of error, the smallest size that the most sensitive
# metric detects in every cell, and that of each family; and which kinds no metric detects.
#   awk -f detect.awk rows.csv
function set(key, text) { printf "\\setval{detect/%s}{%s}\n", key, text }
function power(text) { return text == "NA" ? "none" : sprintf("\\ensuremath{1.0\\cdot 10^{%d}}", substr(text, 3)) }
BEGIN { FS = "," }
NR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
{
    metric = $at["metric"]
    kind = $at["error_kind"]
    key = $at["scene"] "/" kind "/" metric
    every = $at["cells_detected"] == $at["cells"]
    set(key "/cells", $at["cells"])
    set(key "/detected", $at["cells_detected"])
    if ($at["size_most"] != "NA") {
        set(key "/least", power($at["size_least"]))
        set(key "/median", power($at["size_median"]))
        set(key "/most", power($at["size_most"]))
    }
    if (metric !~ /(^|\.)any$/ && $at["scene"] == "rod") {
        metrics[metric] = 1
        kinds[kind] = 1
        if ($at["cells_detected"] > 0) detects[kind]++
        of[metric, kind] = 1
        if (every && (!(kind in best) || substr($at["size_most"], 3) + 0 < best[kind])) {
            best[kind] = substr($at["size_most"], 3) + 0
            by[kind] = metric
        }
    }
}
END {
    for (m in metrics) count++
    for (k in kinds) {
        number++
        set("metrics/" k, detects[k] + 0)
        if (k in by) { name = by[k]; gsub(/_/, "\\_", name); set("best/" k, name); set("best/" k "/size", power("1e" best[k])) }
        if (!detects[k]) none++
    }
    set("metrics", count + 0)
    set("kinds", number + 0)
    set("kinds/undetected", none + 0)
}
