# Of each metric and kind of error, over the cells (scenes with their settings): how many are detected; the smallest
# size that is detected, in the most sensitive, the median and the least sensitive of them; the error and the tolerance
# of the metric at the last; and the largest size up to 0.01 that is not detected in some cell. Metrics FAMILY.any and
# any: the most sensitive metric of a family, and of all. Used by experiments/detect.sh, which writes the header.
BEGIN {
    FS = OFS = ","
    smallest = -14
}
# A size counts if it and all larger ones up to 0.01 are detected: a still larger error may leave a metric undefined.
# Kinds without any size but 1, a complete exchange, count there.
function size_of(one, cell,   power, from) {
    from = "NA"
    if ((one, cell, 0) in hit) from = 0
    for (power = -2; power >= smallest; power--) {
        if (!((one, cell, power) in hit)) break
        from = power
    }
    return from
}
function take(metric,   one, power) {
    one = $1 OFS metric OFS $4
    if (!((one, cell) in seen)) {
        seen[one, cell] = 1
        at_cell[one, ++cells[one]] = cell
    }
    power = int(log($5) / log(10) + ($5 < 1 ? -0.5 : 0.5))
    if ($9 && !((one, cell, power) in hit)) hit[one, cell, power] = $7 OFS $8
    if (!$9 && $5 <= 0.01 && !((one, cell, power) in missed)) missed[one, cell, power] = 1
}
$4 == "none" { # the first lines of a cell: without an error
    if (last != "none") cell++
    last = $4
    if ($9) {
        print "detect.awk: " $0 ": fails without an error" >"/dev/stderr"
        exit failed = 1
    }
    next
}
{
    last = $4
    take($6)
    split($6, part, ".")
    take(part[1] ".any")
    take("any")
}
END {
    if (failed) exit 1
    for (one in cells) {
        n = 0
        most = -99
        not = "NA"
        for (i = 1; i <= cells[one]; i++) {
            for (power = -2; power >= smallest; power--)
                if (!((one, at_cell[one, i], power) in hit) && ((one, at_cell[one, i], power) in missed)) {
                    if (not == "NA" || power > not) not = power
                    break
                }
            from = size_of(one, at_cell[one, i])
            if (from == "NA") continue
            for (j = n++; j > 0 && size[j] > from; j--) size[j + 1] = size[j]
            size[j + 1] = from
            if (from > most) {
                most = from
                there = hit[one, at_cell[one, i], from]
            }
        }
        printf "%s,%d,%d", one, cells[one], n
        if (n) printf ",1e%d,1e%d,1e%d,%s", size[1], size[int((n + 1) / 2)], size[n], there
        else printf ",NA,NA,NA,NA,NA"
        print not == "NA" ? ",NA" : ",1e" not
    }
}
