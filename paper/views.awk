# The published speed-up with 4, 8 and 16 threads against the model for other fields of view, as \setval lines.
#   awk -v rates='LOW ASSUMED HIGH' -f share.awk -f views.awk MEASURED maps-views.tsv       (see paper/scaling.sh)
BEGIN {
    FS = "\t"
    split(rates, rate, FS)
    cores = 4
    logical = 8
    yield = rate[2]
    busy = 1
}
FILENAME == ARGV[1] {
    if ($1 == "published") speed[$3] = $6
    next
}
$1 + 0 > 0 {
    worst = all = 0
    sixteenths = split($2, part, " ")
    for (i = 1; i <= sixteenths; i++) {
        cost[i - 1] = part[i]
        all += part[i]
    }
    for (n = 4; n <= 16; n *= 2) {
        ratio = all / finish(load, loads_of_blocks(cost, sixteenths, n, load)) / speed[n]
        printf "\\setval{scaling/view/%s/%d}{%.2f}\n", $1, n, ratio
        far = ratio > 1 ? ratio : 1 / ratio
        if (far > worst) worst = far
    }
    if (!nearest || worst < nearest) {
        nearest = worst
        view = $1
    }
}
END {
    printf "\\setval{scaling/view/nearest}{%.2f}\n", nearest
    printf "\\setval{scaling/view/nearest-fov}{%s}\n", view
}
