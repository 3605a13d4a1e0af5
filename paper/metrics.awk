# Print every metric of a study as TeX numbers, \setval{study/axis values/metric/measured}{text} and theory and error, and, by metric and by
# its first word, the number of values, the number within tolerance, and the largest error.
#   awk -v study=NAME -f scientific.awk -f metrics.awk TABLE-metrics.tsv
# Angles are converted from radians to degrees, errors are not. NA defines no number: the paper then prints n/a.
function set(key, text) { if (text != "") printf "\\setval{%s}{%s}\n", key, text }
# A number without the sign of a zero, and with TeX's minus.
function places(v, count,   text) {
    text = sprintf("%." count "f", v)
    if (text + 0 == 0) sub(/^-/, "", text)
    sub(/^-/, "\\ensuremath{-}", text)
    return text
}
function shown(v) {
    if (v == "NA") return ""
    if ($at["unit"] == "rad") return places(v * 180 / 3.14159265358979323846, 3)
    return places(v, $at["unit"] == "px" || $at["unit"] == "deg" ? 2 : 4)
}
function count(group) {
    if ($at["passes"] == "NA") { none[group]++; return }
    values[group]++
    passed[group] += $at["passes"]
    if ($at["error"] == "NA") return
    if ($at["error"] + 0 > worst[group] + 0) worst[group] = $at["error"] + 0
    if ($at["tolerance"] + 0 > tolerance[group] + 0) tolerance[group] = $at["tolerance"] + 0
    if ($at["tolerance"] + 0 > 0 && $at["error"] / $at["tolerance"] > share[group] + 0) share[group] = $at["error"] / $at["tolerance"]
}
function percent_more(a, b) { return places((a / b - 1) * 100, 1) }

BEGIN {
    FS = "\t"
    CONVFMT = "%.10g" # wavelengths in keys
}
NR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    axes = at["metric"] - 3
    next
}
{
    name = $at["metric"]
    measured = $at["measured"]
    key = study
    last = study == "polarisation" ? 2 : axes # both plates have the same rotation
    for (i = 3; i <= last + 2; i++) key = key "/" ($i ~ /^[-+0-9.]+$/ ? $i + 0 : $i)
    set(key "/" name "/measured", shown(measured))
    set(key "/" name "/theory", shown($at["theory"]))
    if ($at["error"] != "NA") set(key "/" name "/error", scientific($at["error"] + 0))
    family = name
    sub(/\..*/, "", family)
    count("all")
    count(name)
    if (family != name) count(family)
    cell[key] = 1
    if ($at["error"] != "NA" && $at["tolerance"] + 0 > 0 && $at["error"] / $at["tolerance"] > of_cell[key] + 0)
        of_cell[key] = $at["error"] / $at["tolerance"]
    if (family ~ /^(prism|rainbow)$/ && measured != "NA") {
        line = substr(name, length(family) + 2)
        angle[$3, line] = measured
        medium[$3] = 1
    }
    if (name ~ /\.own$/ && !seen[$4]++) wavelengths++
    if (study == "polarisation") through[name, $3, $4] = measured
}
END {
    for (k in cell) set(k "/share", scientific(of_cell[k] + 0))
    for (g in values) {
        prefix = g == "all" ? study "/metrics" : study "/" g
        set(prefix "/values", values[g])
        set(prefix "/passed", passed[g])
        set(prefix "/failed", values[g] - passed[g])
        set(prefix "/none", none[g] + 0)
        set(prefix "/worst", scientific(worst[g] + 0))
        set(prefix "/tolerance", scientific(tolerance[g] + 0))
        set(prefix "/share", scientific(share[g] + 0))
    }
    if (wavelengths) set(study "/wavelengths", wavelengths)
    for (m in medium) {
        if ((m, "F") in angle) {
            spread = (angle[m, "F"] - angle[m, "C"]) * 180 / 3.14159265358979323846
            set(study "/" m "/spread", places(spread < 0 ? -spread : spread, 3))
        }
        # The prism of experiments/scenes/prism.yaml has 60 degrees: n = sin((60 + D) / 2) / sin(60 / 2), Hecht, 5.5.1.
        if (study == "dispersion" && (m, "d") in angle) {
            n_d = 2 * sin(3.14159265358979323846 / 6 + angle[m, "d"] / 2)
            n_F = 2 * sin(3.14159265358979323846 / 6 + angle[m, "F"] / 2)
            n_C = 2 * sin(3.14159265358979323846 / 6 + angle[m, "C"] / 2)
            set(study "/" m "/index", places(n_d, 5))
            if (n_F > n_C) set(study "/" m "/abbe", places((n_d - 1) / (n_F - n_C), 2))
        }
    }
    # The error of the mean of s and p, by angle; and its largest value, as a difference of shares, with the angle.
    for (t in through) {
        split(t, part, SUBSEP)
        if (part[2] != "on" || !((part[1], "off", part[3]) in through)) continue
        set("polarisation/" part[3] "/" part[1] "/more", percent_more(through[t], through[part[1], "off", part[3]]))
        off = through[t] - through[part[1], "off", part[3]]
        if (off > most[part[1]] + 0) { most[part[1]] = off; most_at[part[1]] = part[3] }
    }
    for (name in most) {
        set("polarisation/" name "/most", places(most[name], 3))
        set("polarisation/" name "/most-at", most_at[name] + 0)
    }
}
