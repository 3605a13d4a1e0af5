# Errors of predicted speed-ups for each machine and schedule, and for all schedules of a machine, from scaling.tsv: the
# counts, and the worst and the mean factor by which a model is off, less 1; the mean is geometric. least, largest: the
# model with the lowest and the highest yield.
BEGIN {
    FS = OFS = "\t"
    models = split("model predicted least least largest largest busy busy even even amdahl amdahl gunther gunther " \
        "gunther-units gunther_units", name, " ")
    print "machine", "render.schedule", "model", "counts", "worst", "worst_threads", "mean"
}
NR == 1 {
    for (i = 1; i <= NF; i++) at[$i] = i
    next
}
{
    add($1 OFS $at["render.schedule"])
    add($1 OFS "all")
}
function add(group,   i, key, off) {
    if (!(group in known)) {
        known[group] = 1
        order[++groups] = group
    }
    for (i = 1; i <= models; i += 2) {
        if ($at[name[i + 1]] == "NA") continue
        key = group OFS name[i]
        off = log($at[name[i + 1]] / $at["speedup_median"])
        if (off < 0) off = -off
        counts[key]++
        sum[key] += off
        if (!(key in worst) || off > worst[key]) {
            worst[key] = off
            worst_at[key] = $at["render.threads"]
        }
    }
}
END {
    for (g = 1; g <= groups; g++)
        for (i = 1; i <= models; i += 2) {
            key = order[g] OFS name[i]
            if (counts[key]) print key, counts[key], exp(worst[key]) - 1, worst_at[key], exp(sum[key] / counts[key]) - 1
        }
}
