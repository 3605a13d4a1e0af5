# The numbers of the model of speed-ups as \setval lines, from scaling.tsv and scaling-errors.tsv.
#   scaling/MACHINE/SCHEDULE/THREADS/{measured,predicted,ratio,...}    scaling/MACHINE/SCHEDULE/MODEL/{worst,mean,...}
function value(key, text) { printf "\\setval{scaling/%s}{%s}\n", key, text }
function percent(v) { return sprintf(v < 0.2 ? "%.1f" : "%.0f", 100 * v) }
function ends(name) {
    return $at[name "_low"] == "NA" ? "" : sprintf("\\within{%.2f}{%.2f}", $at[name "_low"], $at[name "_high"])
}
BEGIN { FS = "\t" }
FNR == 1 {
    split("", at)
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
"worst" in at {
    key = $1 "/" $2 "/" $3
    value(key "/worst", percent($at["worst"]))
    value(key "/worst-threads", $at["worst_threads"])
    value(key "/mean", percent($at["mean"]))
    value(key "/counts", $at["counts"])
    next
}
{
    key = $1 "/" $at["render.schedule"] "/" $at["render.threads"]
    value(key "/measured", sprintf("%.2f", $at["speedup_median"]) ends("speedup"))
    value(key "/predicted", sprintf("%.2f", $at["predicted"]))
    value(key "/least", sprintf("%.2f", $at["least"]))
    value(key "/largest", sprintf("%.2f", $at["largest"]))
    value(key "/even", sprintf("%.2f", $at["even"]))
    value(key "/busy", sprintf("%.2f", $at["busy"]))
    value(key "/ratio", sprintf("%.2f", $at["ratio_median"]) ends("ratio"))
}
