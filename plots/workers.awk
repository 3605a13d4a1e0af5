# Print means over the repetitions, by schedule, pinning and worker, from a study's workers.csv, without warm-ups. Means, not
# medians, so that busy and waiting time add up to the frame's time.
# Prints, tab separated: schedule, pinning, worker, workers, busy_s, waiting_s, cpu_s.
BEGIN { FS = ","; OFS = "\t" }
{ gsub(/[\r"]/, "") }
FNR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
$at["warmup"] == "0" {
    group = $at["render.schedule"] OFS $at["render.pin"]
    key = group OFS $at["worker"]
    if (!(key in busy)) {
        order[++keys] = key
        group_of[key] = group
        workers[group]++
    }
    rows[key]++
    busy[key] += $at["busy_s"]
    waiting[key] += $at["waiting_s"]
    cpu[key] += $at["cpu_s"]
}
END {
    for (i = 1; i <= keys; i++) {
        key = order[i]
        print key, workers[group_of[key]], busy[key] / rows[key], waiting[key] / rows[key], cpu[key] / rows[key]
    }
}
