# Print the values of `cuvette motion` in a study's cells as TeX numbers, \setval{study/integrator/step in ms/stiffness/name/measured}{text}, theory, error,
# and the relative error; by name the largest error and the largest relative one over all cells; by integrator the power of the step with
# which a value grows (least squares over the cells of one stiffness that has several steps).
#   awk -v study=NAME -f scientific.awk -f motion.awk TABLE-motion.tsv          NA defines no number: the paper then prints n/a.
function set(key, text) { if (text != "") printf "\\setval{%s}{%s}\n", key, text }
# Three digits, as a power of ten if plain digits would hide the value.
function shown(v,   size, places) {
    if (v == "NA") return ""
    if (v == 0) return "0"
    size = v < 0 ? -v : v
    if (size != 0 && size < 1e-3) return (v < 0 ? "\\ensuremath{-}" : "") scientific(size)
    for (places = size >= 100 ? 0 : size >= 10 ? 1 : 2; size && size < 1; size *= 10) places++
    return (v < 0 ? "\\ensuremath{-}" : "") sprintf("%." places "f", v < 0 ? -v : v)
}
BEGIN { FS = "\t" }
NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
{
    name = $at["name"]
    key = study "/" $at["toy.integrator"] "/" $at["toy.dt_s"] * 1000 "/" $at["toy.stiffness"] + 0 "/" name
    # Times and steps in ms.
    scale = $at["unit"] == "s" ? 1000 : 1
    set(key "/measured", $at["measured"] == "NA" ? "" : shown($at["measured"] * scale))
    set(key "/theory", $at["theory"] == "NA" ? "" : shown($at["theory"] * scale))
    set(key "/error", $at["error"] == "NA" ? "" : shown($at["error"] * scale))
    if ($at["error"] == "NA") next
    error = $at["error"] + 0
    theory = $at["theory"] < 0 ? -$at["theory"] : $at["theory"] + 0
    if (theory > 0) set(key "/relative", shown(error / theory))
    if (theory > 0 && error / theory > relative[name] + 0) relative[name] = error / theory
    if (error > worst[name] + 0) worst[name] = error
    known[name] = 1
    if (error > 0 && $at["toy.stiffness"] == 10) {
        group = study "/" $at["toy.integrator"] "/" name
        x = log($at["toy.dt_s"])
        y = log(error)
        points[group]++; sum_x[group] += x; sum_y[group] += y; sum_xx[group] += x * x; sum_xy[group] += x * y
    }
}
END {
    for (name in known) {
        set(study "/" name "/worst", shown(worst[name] + 0))
        if (name in relative) set(study "/" name "/worst-relative", shown(relative[name]))
    }
    for (g in points) {
        spread = points[g] * sum_xx[g] - sum_x[g] ^ 2
        if (points[g] > 2) set(g "/power", sprintf("%.2f", (points[g] * sum_xy[g] - sum_x[g] * sum_y[g]) / spread))
    }
}
