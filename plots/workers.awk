# Medians over the repetitions, by schedule, pinning and worker, from a study's workers.csv; warm-ups are left out.
# Prints, tab separated: schedule, pinning, worker, workers, busy_s, waiting_s, cpu_s.
function median(values,   n, i, j, v, sorted) {
    n = split(values, sorted, " ")
    for (i = 2; i <= n; i++) {
        v = sorted[i] + 0
        for (j = i - 1; j >= 1 && sorted[j] + 0 > v; j--) sorted[j + 1] = sorted[j]
        sorted[j + 1] = v
    }
    return n % 2 ? sorted[(n + 1) / 2] : (sorted[n / 2] + sorted[n / 2 + 1]) / 2
}
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
    busy[key] = busy[key] " " $at["busy_s"]
    waiting[key] = waiting[key] " " $at["waiting_s"]
    cpu[key] = cpu[key] " " $at["cpu_s"]
}
END {
    for (i = 1; i <= keys; i++) {
        key = order[i]
        print key, workers[group_of[key]], median(busy[key]), median(waiting[key]), median(cpu[key])
    }
}
