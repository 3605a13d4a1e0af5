# Predicts speed-ups by share.awk from what pieces of the image cost, and compares them with measured ones, and with
# laws fitted to half of the counts and tested on the other half.
#   awk -f share.awk -f law.awk -f scaling.awk maps-cost.tsv MACHINES MEASURED
# MACHINES, tab separated without a header: machine, cores, units, seconds for each thread, rate of a busy unit, and the
# yield of a core (lowest, assumed, highest). MEASURED: machine, schedule, threads, rows, seconds of the best serial
# run, speed-up (median, low, high; NA without an interval).
# Prints a line for each measured speed-up. ratio: predicted / measured; miss: its distance from 1 as a share, 1 / ratio
# if that is farther. even: the model with equal blocks. busy: with the measured rate of busy units. amdahl, gunther:
# laws fitted without this count, gunther_units: on at most as many threads at a time as there are units.
function loads(schedule, threads, load,   edge) {
    if (schedule == "columns") return loads_of_blocks(column, pieces["column"], threads, load)
    if (schedule == "rows") return loads_of_blocks(row, pieces["row"], threads, load)
    edge = 32
    while (cut(edge) < 4 * threads && edge > 8) edge /= 2
    return schedule == "tiles" ? loads_of_tiles(tile, cut(edge), threads, load) \
        : loads_on_demand(tile, cut(edge), threads, load)
}
# Sums squares to tiles of that edge; returns their number.
function cut(edge,   side, across, wide, i, x, y) {
    if (edge == cut_edge) return cut_count
    split("", tile)
    side = edge / 8
    wide = int((pieces["column"] + 7) / 8)
    across = int((wide + side - 1) / side)
    for (i = 0; i < pieces["square"]; i++) {
        x = i % wide
        y = int(i / wide)
        tile[int(y / side) * across + int(x / side)] += square[i]
    }
    cut_edge = edge
    return cut_count = across * int((int(pieces["square"] / wide) + side - 1) / side)
}
# The speed-up of a frame that takes serial_s alone: sharing, and the cost of starting or waking each thread.
function predict(machine, schedule, threads, serial_s, core_yield, rate, even,   load, count, i) {
    cores = cores_of[machine]
    logical = units_of[machine]
    yield = core_yield
    busy = rate
    count = loads(schedule, threads, load)
    if (even) {
        count = threads
        for (i = 1; i <= count; i++) load[i] = all / threads
    }
    return 1 / (finish(load, count) / all + thread_s[machine] * threads / serial_s)
}
function quotient(a, b) { return a == "NA" || b == "NA" || b == 0 ? "NA" : sprintf("%.6g", a / b) }
function far(ratio) { return ratio == "NA" ? "NA" : ratio > 1 ? ratio - 1 : 1 / ratio - 1 }
function larger(a, b) { return a == "NA" || b == "NA" ? "NA" : a > b ? a : b }

# Fits of each half of the counts of a curve predict the other half.
function fit_halves(group,   half, i, many, n, speed, k) {
    for (half = 0; half < 2; half++) {
        many = 0
        for (i = 1; i <= tested[group]; i++)
            if (i % 2 == half) {
                k = line_of[group, i]
                n[++many] = threads[k]
                speed[many] = measured[k]
            }
        if (many < 2) continue
        fit_law(n, speed, many, 0, 0)
        apply(group, 1 - half, amdahl, 0)
        fit_law(n, speed, many, 1, 0)
        apply(group, 1 - half, gunther, 0)
        fit_law(n, speed, many, 1, units_of[machine[k]])
        apply(group, 1 - half, gunther_units, units_of[machine[k]])
    }
}
function apply(group, half, out, units,   i, k) {
    for (i = 1; i <= tested[group]; i++)
        if (i % 2 == half) {
            k = line_of[group, i]
            out[k] = law(threads[k], law_s, law_k, units)
        }
}
BEGIN { FS = OFS = "\t" }
FILENAME == ARGV[1] {
    if ($1 == "column") { column[pieces[$1]++] = $2; all += $2 }
    if ($1 == "row") row[pieces[$1]++] = $2
    if ($1 == "square") square[pieces[$1]++] = $2
    next
}
FILENAME == ARGV[2] {
    cores_of[$1] = $2
    units_of[$1] = $3
    thread_s[$1] = $4
    busy_of[$1] = $5
    yield_low[$1] = $6
    yield_mid[$1] = $7
    yield_high[$1] = $8
    next
}
$1 in cores_of {
    machine[++lines] = $1
    schedule[lines] = $2
    threads[lines] = $3
    rows[lines] = $4
    serial[lines] = $5
    measured[lines] = $6
    low[lines] = $7
    high[lines] = $8
    group = $1 OFS $2
    line_of[group, ++tested[group]] = lines
}
END {
    for (group in tested) fit_halves(group)
    print "machine", "units", "render.schedule", "render.threads", "n", "speedup_median", "speedup_low", \
        "speedup_high", "predicted", "least", "largest", "even", "busy", "ratio_median", "ratio_low", "ratio_high", \
        "miss_median", "miss_low", "miss_high", "busy_ratio", "amdahl", "gunther", "gunther_units"
    for (k = 1; k <= lines; k++) {
        m = machine[k]
        p = predict(m, schedule[k], threads[k], serial[k], yield_mid[m], 1, 0)
        b = predict(m, schedule[k], threads[k], serial[k], yield_mid[m], busy_of[m], 0)
        down = quotient(p, high[k])
        up = quotient(p, low[k])
        near = down == "NA" ? "NA" : down <= 1 && up >= 1 ? 0 : far(down) < far(up) ? far(down) : far(up)
        print m, units_of[m], schedule[k], threads[k], rows[k], measured[k], low[k], high[k], p, \
            predict(m, schedule[k], threads[k], serial[k], yield_low[m], 1, 0), \
            predict(m, schedule[k], threads[k], serial[k], yield_high[m], 1, 0), \
            predict(m, schedule[k], threads[k], serial[k], yield_mid[m], 1, 1), b, \
            quotient(p, measured[k]), down, up, \
            far(quotient(p, measured[k])), near, larger(far(down), far(up)), quotient(b, measured[k]), \
            k in amdahl ? amdahl[k] : "NA", k in gunther ? gunther[k] : "NA", \
            k in gunther_units ? gunther_units[k] : "NA"
    }
}
