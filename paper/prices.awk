# Prices of determinism: the ratio of the CPU time of the program as it is to that of a build without a part of what
# makes the same bits everywhere, in the same round of experiments/determinism.sh. Reads its rows.csv, writes a table.
#   awk -v machine=NAME -f experiments/order.awk -f paper/prices.awk rows.csv
# The interval of a median of n ratios is that of its order statistics: from the k-th to the (n+1-k)-th, with the
# largest k for which a binomial (n, 1/2) is below k with a probability of at most 0.025 (Hahn and Meeker, Statistical
# Intervals).
# scene "all": in each round the geometric mean over the scenes. disturbed: rounds in which others used more than a
# quarter of the machine; the system counts in steps of 10 ms, and one step is up to a fifth of such a short frame.
BEGIN {
    FS = ","; OFS = "\t"
    split("both film contraction", part_name, " ")
    split("float-fast float-off fixed-fast", without, " ")
}
FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
{
    group = $at["compiler"] OFS $at["isa"]
    if (!(group in known_group)) { known_group[group] = 1; groups[++group_count] = group }
    if (!($at["scene"] in known_scene)) { known_scene[$at["scene"]] = 1; scenes[++scene_count] = $at["scene"] }
    if ($at["repetition"] >= rounds) rounds = $at["repetition"] + 1
    cpu[$at["film"] "-" $at["contract"], group, $at["scene"], $at["repetition"]] = $at["cpu_s"]
    if ($at["others_share"] > 0.25)
        loud[group, $at["scene"], $at["repetition"]] = loud[group, "all", $at["repetition"]] = 1
}
function rank_of(n,   k, term, sum) {
    term = 0.5 ^ n
    for (k = 0; k < n / 2; k++) {
        sum += term
        if (sum > 0.025) return k
        term *= (n - k) / (k + 1)
    }
    return k
}
function line(part, group, scene, list, ours, theirs,   n, v, k, r, disturbed) {
    n = sorted(list, v)
    if (!n) return
    k = rank_of(n)
    for (r = 0; r < rounds; r++) disturbed += (group, scene, r) in loud
    print machine, part, group, scene, n, median(list), k ? v[k] : "NA", k ? v[n + 1 - k] : "NA", v[1], v[n],
        ours == "NA" ? ours : median(ours), theirs == "NA" ? theirs : median(theirs), disturbed + 0
}
END {
    print "machine", "part", "compiler", "isa", "scene", "n", "price_median", "price_low", "price_high", "price_min",
        "price_max", "cpu_s_median", "without_cpu_s_median", "disturbed"
    for (p = 1; p <= 3; p++)
        for (g = 1; g <= group_count; g++) {
            split("", product); split("", factors)
            for (s = 1; s <= scene_count; s++) {
                list = ours = theirs = ""
                for (r = 0; r < rounds; r++) {
                    a = cpu["fixed-off", groups[g], scenes[s], r] + 0
                    b = cpu[without[p], groups[g], scenes[s], r] + 0
                    if (!(a > 0 && b > 0)) continue
                    list = list " " a / b; ours = ours " " a; theirs = theirs " " b
                    product[r] += log(a / b); factors[r]++
                }
                line(part_name[p], groups[g], scenes[s], list, ours, theirs)
            }
            list = ""
            for (r = 0; r < rounds; r++) if (factors[r] == scene_count) list = list " " exp(product[r] / scene_count)
            line(part_name[p], groups[g], "all", list, "NA", "NA")
        }
}
