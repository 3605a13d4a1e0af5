# Numbers of what can be seen, \setval{KEY}{text}.
#   plots/visible.awk -v which=liquid ... | awk -v which=liquid -f visible.awk        of an error of an index:
#     visible-index/liquid/0.003/px, /display, /camera   shift of an edge: px, arc seconds at 67 px a degree, at the camera
#     visible-index/liquid/vernier/display, /camera      the error whose shift is 5 arc seconds
#     visible-index/liquid/acuity/display, /camera       ... 60 arc seconds; no number beyond the largest error
#   awk -v grid=1 -f visible.awk visible-grid-metrics.tsv
#     visible-grid/LIQUID/spread                         magnification over all vessels: its range, % of the smallest
function set(key, text) { printf "\\setval{%s}{%s}\n", key, text }
# Three digits, at most five places.
function digits(v,   places, size) {
    for (size = v; size < 100 && places < 5; size *= 10) places++
    return sprintf("%." places "f", v)
}
# The shift is proportional to a small error: between two rows the error follows by a line through their logarithms.
function find(name, column, goal,   share) {
    if (NR > 1 && last[column] < goal && $column >= goal) {
        share = log(goal / last[column]) / log($column / last[column])
        set("visible-index/" which "/" name, digits(exp(log(last[1]) + share * log($1 / last[1]))))
    }
}
BEGIN { FS = "\t" }
grid {
    if (FNR == 1) for (i = 1; i <= NF; i++) at[$i] = i
    else if ($at["metric"] == "edges.magnification" && $at["measured"] != "NA") {
        m = $at["measured"] + 0
        n = $at["liquid.ior"] + 0
        if (!(n in low) || m < low[n]) low[n] = m
        if (!(n in high) || m > high[n]) high[n] = m
    }
    next
}
{
    set("visible-index/" which "/" $1 "/px", digits($2))
    set("visible-index/" which "/" $1 "/display", digits($3))
    set("visible-index/" which "/" $1 "/camera", digits($4))
    find("vernier/display", 3, 5)
    find("vernier/camera", 4, 5)
    find("acuity/display", 3, 60)
    find("acuity/camera", 4, 60)
    for (i = 1; i <= 4; i++) last[i] = $i
}
END { for (n in low) set("visible-grid/" n "/spread", digits((high[n] / low[n] - 1) * 100)) }
