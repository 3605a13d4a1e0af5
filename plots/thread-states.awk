# The mean share of the frame that the threads of a frame spent in each state, by schedule and number of threads, from a
# study's workers.csv; warm-ups are left out.
# Prints, tab separated: schedule, threads, and the shares of: not started, running, runnable, blocked, done. Rows without
# these columns, or with NA in them, print nothing.
BEGIN { FS = ","; OFS = "\t" }
{ gsub(/[\r"]/, "") }
FNR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
("runnable_s" in at) && $at["warmup"] == "0" && $at["runnable_s"] != "NA" {
    key = $at["render.schedule"] OFS $at["render.threads"]
    if (!(key in whole)) order[++keys] = key
    end = $at["busy_s"] + $at["waiting_s"]
    left = end - $at["start_s"] - $at["running_s"] - $at["runnable_s"] - $at["blocked_s"]
    whole[key] += end
    start[key] += $at["start_s"]
    running[key] += $at["running_s"]
    runnable[key] += $at["runnable_s"]
    blocked[key] += $at["blocked_s"]
    done[key] += left > 0 ? left : 0
}
END {
    for (i = 1; i <= keys; i++) {
        key = order[i]
        if (whole[key] > 0)
            print key, start[key] / whole[key], running[key] / whole[key], runnable[key] / whole[key],
                blocked[key] / whole[key], done[key] / whole[key]
    }
}
