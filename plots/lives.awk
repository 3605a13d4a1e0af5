# The working time of each thread of one frame, from a study's workers.csv: the first measured frame of the cell.
#   awk -v schedule=dynamic -v threads=64 -f lives.awk workers.csv
# Prints, tab separated: worker, its first moment and its last one in ms since the frame's start, and the fraction of
# the time between in which it had a processing unit. Workers without a tile are left out.
BEGIN { FS = ","; OFS = "\t" }
{ gsub(/[\r"]/, "") }
FNR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
$at["warmup"] == "0" && $at["render.schedule"] == schedule && $at["render.threads"] == threads && $at["tiles"] > 0 {
    frame = $at["run"] " " $at["process"] " " $at["repetition"]
    if (chosen == "") chosen = frame
    if (frame == chosen && $at["wall_s"] > 0)
        print $at["worker"], 1e3 * $at["start_s"], 1e3 * ($at["start_s"] + $at["wall_s"]),
            $at["running_s"] == "NA" ? "NA" : $at["running_s"] / $at["wall_s"]
}
