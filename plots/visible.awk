# The displacement of the rod's edges by an error of an index, from the metrics of the study visible-index: the larger
# shift of both edges against the cell with the right indices, and that of the errors of both signs.
#   awk -v which=liquid -f visible.awk visible-index-metrics.tsv         which: liquid or vessel
# Prints, tab separated: size of the error, displacement in px, and in arc seconds for FLIP's observer (below) and for an
# eye at the camera. Pixels: FLIP's observer sees 3840 px on 0.7 m from 0.7 m, 3840 pi / 180 = 67 a degree (Andersson et
# al. 2020, section 4.1.1); the camera sees 300 px under 45 degrees, near the middle one px under 1 / focal length.
BEGIN {
    FS = OFS = "\t"
    pi = atan2(0, -1)
    arcsec = 180 * 3600 / pi
    right["liquid"] = 1.333
    right["vessel"] = 1.5
    other = which == "liquid" ? "vessel" : "liquid"
    focal_px = 300 / 2 / (sin(pi / 8) / cos(pi / 8))
}
NR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
$at["metric"] ~ /^edges[.](left|right)$/ && $at[other ".ior"] == right[other] {
    edge[$at[which ".ior"], $at["metric"]] = $at["measured"]
    index_of[$at[which ".ior"]] = 1
}
END {
    for (n in index_of) {
        size = n - right[which]
        if (size < 0) size = -size
        if (size < 1e-9) continue
        size = sprintf("%.6g", size)
        for (m = 1; m <= 2; m++) {
            name = m == 1 ? "edges.left" : "edges.right"
            moved = edge[n, name] - edge[right[which], name]
            if (moved < 0) moved = -moved
            if (moved > most[size] + 0) most[size] = moved
        }
    }
    for (size in most)
        print size, most[size], most[size] / (3840 * pi / 180) * 3600, most[size] / focal_px * arcsec | "sort -g"
}
