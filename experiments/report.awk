# The closing page of `make experiments`: films and counts against the committed run, published and measured series side
# by side, and the figures to open. Plain text, at most 100 columns. See experiments/report.sh.
#   awk -v results=DIR -v shown=DIR -v tables=NAMES -v published=DIR -v failed=TEXT -f report.awk
# results: the folder with tables/ and figures/; shown: its name on the page; tables: the names of all tables.

# --- tables: T[name, row, column], rows from 1; R[name]: their number, 0 without the table ---

function load(name,    path, line, field, head, n, i, row) {
    if (name in R) return R[name]
    path = results "/tables/" name ".tsv"
    row = 0
    if ((getline line < path) > 0) {
        n = split(line, head, "\t")
        for (i = 1; i <= n; i++) has[name, head[i]] = 1
        while ((getline line < path) > 0) {
            split(line, field, "\t")
            row++
            for (i = 1; i <= n; i++) T[name, row, head[i]] = field[i]
        }
    }
    close(path)
    return R[name] = row
}
# The first row with these values, "COLUMN=VALUE COLUMN=VALUE", and with a measurement; 0: none.
function find(name, where,    row, part, n, i, pair, all) {
    n = split(where, part, " ")
    for (row = 1; row <= load(name); row++) {
        all = T[name, row, "n"] != 0
        for (i = 1; i <= n; i++) {
            split(part[i], pair, "=")
            all = all && same(T[name, row, pair[1]], pair[2])
        }
        if (all) return row
    }
    return 0
}
function same(a, b) { return a == b || (a ~ /^[-0-9.]/ && b ~ /^[-0-9.]/ && a + 0 == b + 0) }
function value(name, where, column,    row) {
    row = find(name, where)
    return row ? known(T[name, row, column]) : ""
}
function known(text) { return text == "NA" || text == "" ? "" : text + 0 }

# A published series: P[name, i, column], i from 1; PN[name]: its length.
function load_published(name,    path, line, field, head, n, i) {
    path = published "/" name ".csv"
    n = (getline line < path) > 0 ? split(line, head, ",") : 0
    PN[name] = 0
    while ((getline line < path) > 0) {
        split(line, field, ",")
        PN[name]++
        for (i = 1; i <= 2; i++) P[name, PN[name], head[i]] = field[i]
    }
    close(path)
}

# --- two blocks of lines in two columns ---

function left(text) { L[++left_count] = text }
function right(text) { S[++right_count] = text }
function flush_blocks(    i) {
    for (i = 1; i <= left_count || i <= right_count; i++)
        print trimmed(sprintf("%-50s%s", i <= left_count ? L[i] : "", i <= right_count ? S[i] : ""))
    if (left_count || right_count) print ""
    left_count = right_count = 0
}
function trimmed(text) { sub(/ +$/, "", text); return text }
function put(side, text) { if (side == "left") left(text); else right(text) }

function ratio(a, b, form) { return a == "" || b == "" || b == 0 ? "-" : sprintf(form, a / b) }
function seconds(x) {
    if (x == "") return "?"
    if (x >= 1) return sprintf("%.3g s", x)
    return sprintf(x < 1e-3 ? "%.2g ms" : "%.3g ms", x * 1e3)
}

# A series of the rod's report: every value divided by the first, and the 95 % interval of ours.
function series(side, title, name, x, y, study, where, axis, column,
                i, at, first, ours, base, low, high) {
    load_published(name)
    first = P[name, 1, y]
    base = value(study, where axis "=" P[name, 1, x], column "_median")
    put(side, title)
    if (base == "") { put(side, "  not measured"); return }
    put(side, sprintf("  1 = %s published, %s here", seconds(first + 0), seconds(base)))
    put(side, sprintf("  %7s %9s %7s %-13s %6s", x, "published", "here", "  95 %", "ratio"))
    for (i = 1; i <= PN[name]; i++) {
        at = where axis "=" P[name, i, x]
        ours = value(study, at, column "_median")
        low = value(study, at, column "_low"); high = value(study, at, column "_high")
        put(side, sprintf("  %7s %9.3f %7s %-13s %6s", P[name, i, x], P[name, i, y] / first, ratio(ours, base, "%.3f"),
            low == "" ? "" : "[" ratio(low, base, "%.3g") ", " ratio(high, base, "%.3g") "]",
            ours == "" ? "-" : sprintf("%.2f", ours / base / (P[name, i, y] / first))))
    }
}

# A series of the polygons report, from its second time on, and two hierarchies of ours. The cell of a number of covered
# pixels is the one that covers about as many.
function covering(name, accel, pixels,    row, found) {
    found = ""
    for (row = 1; row <= load("coverage"); row++)
        if (T["coverage", row, "render.accel"] == accel &&
            near(T["coverage", row, "first_hits.model"] / largest * 480000, pixels))
            found = known(T["coverage", row, "cpu_s_median"])
    return found
}
function near(a, b) { return a > 0.93 * b && a < 1.07 * b }
function polygons(side, title, name, x,    i, k, accel, ours, base, first, row) {
    load_published(name)
    first = P[name, 2, "time_s"]
    put(side, title)
    if (!load(name)) { put(side, "  not measured"); return }
    largest = 0
    for (row = 1; row <= R[name]; row++)
        if (T[name, row, "first_hits.model"] + 0 > largest) largest = T[name, row, "first_hits.model"] + 0
    split("octant bvh", accel, " ")
    for (i = 2; i <= PN[name]; i++)
        for (k = 1; k <= 2; k++) {
            ours[i, k] = x == "pixels" ? covering(name, accel[k], P[name, i, x]) \
                : value(name, "render.accel=" accel[k] " soup.count=" P[name, i, x], "cpu_s_median")
            if (i == 2) base[k] = ours[i, k]
        }
    put(side, sprintf("  1 = %s; %s octant, %s boxes", seconds(first + 0), seconds(base[1]), seconds(base[2])))
    put(side, sprintf("  %9s %9s %6s %5s %6s %5s", x, "published", "octant", "ratio", "boxes", "ratio"))
    for (i = 2; i <= PN[name]; i++)
        put(side, sprintf("  %9s %9.3f %6s %5s %6s %5s", P[name, i, x], P[name, i, "time_s"] / first,
            ratio(ours[i, 1], base[1], "%.3f"),
            ratio(ratio(ours[i, 1], base[1], "%.9g"), P[name, i, "time_s"] / first, "%.2f"),
            ratio(ours[i, 2], base[2], "%.3f"),
            ratio(ratio(ours[i, 2], base[2], "%.9g"), P[name, i, "time_s"] / first, "%.2f")))
}

# --- parts of the page ---

function films(    row, n, same_cells, distinct, cells, list) {
    if (!load("reproduced")) return
    for (row = 1; row <= R["reproduced"]; row++) {
        cells += T["reproduced", row, "cells"]
        n += T["reproduced", row, "n"]
        same_cells += T["reproduced", row, "same"]
        distinct += T["reproduced", row, "films"]
        if (T["reproduced", row, "different"] != "none")
            list = list "  different: " T["reproduced", row, "study"] ", cells " T["reproduced", row, "different"] "\n"
    }
    printf "Films and ray counts: %d of %d cells equal the committed run's, bit for bit (%d films).\n", \
        same_cells, n, distinct
    if (n < cells) printf "  %d more cells have no rows there or here.\n", cells - n
    printf "%s", list
}

function disturbed(    row, i, name, list, n, bad) {
    n = split(tables, list, " ")
    for (i = 1; i <= n; i++)
        for (row = 1; row <= load(list[i]) && ((list[i], "disturbed") in has); row++) {
            measured_rows += T[list[i], row, "n"]
            bad += known(T[list[i], row, "disturbed"])
            if (T[list[i], row, "quick"] == 1) quick = 1
            if (T[list[i], row, "environment"] != "NA") environment = T[list[i], row, "environment"]
        }
    return bad + 0
}

function methods(    name) {
    left("Table 1, methods: published load, realism")
    right("Table 2, lighting: published load, realism")
    method("left", "ray casting", "low, low", "methods", "render.integrator=raycast")
    method("left", "backward tracing", "medium, medium", "methods", "render.integrator=whitted")
    method("left", "path tracing", "high, high", "methods", "render.integrator=path render.paths=256")
    method("right", "simple (Lambert)", "low, low", "lighting", "render.lighting=lambert")
    right(sprintf("  %-17s%-15s%s", "Gouraud", "medium, medium", "see below"))
    method("right", "Phong", "high, high", "lighting", "render.lighting=phong")
    flush_blocks()
}
function method(side, title, words, name, where,    flip) {
    flip = value(name, where, "flip")
    put(side, sprintf("  %-17s%-15s%s", title, words,
        !find(name, where) ? "-" \
        : seconds(value(name, where, "cpu_s_median")) (flip == "" ? "" : sprintf(" %.3f", flip))))
}

# Frames of the mesh of 512 x 256: a shading costs its frame minus the unlit one.
function shading(where, light) {
    return value("shading", "soup.around=512 " where " " light, "cpu_s_median")
}
function statements(    unlit, gouraud, phong, where, row, fraction, least, most, name) {
    where = "render.integrator=raycast render.shadows=off"
    no_time = "no times in a quick run"
    unlit = shading(where, "model.shading=flat model.diffuse=0")
    gouraud = shading(where, "model.shading=gouraud")
    phong = shading(where, "model.shading=smooth")
    print "Said in the reports, and measured here"
    statement("Gouraud's shading is about 5 times as fast as Phong's", quick ? no_time \
        : unlit == "" || gouraud <= unlit ? "-" : sprintf("%.2f times as fast", (phong - unlit) / (gouraud - unlit)))
    statement("Phong's shading takes at most 3 % of the time",
        quick ? no_time : unlit == "" ? "-" : sprintf("%.1f %% of a ray-cast frame", 100 * (phong - unlit) / phong))
    least = 2
    for (row = 1; row <= load("triangles"); row++)
        if (T["triangles", row, "model.visible"] == "on" && T["triangles", row, "render.accel"] ~ /octant|bvh/ &&
            known(T["triangles", row, "visibility_s_sum/wall_s_median"]) != "") {
            fraction = T["triangles", row, "visibility_s_sum/wall_s_median"]
            least = fraction < least ? fraction : least
            most = fraction > most ? fraction : most
        }
    statement("finding intersections takes 70 to 90 % of the time",
        quick ? no_time : least == 2 ? "-" : sprintf("%.0f to %.0f %% (test 1)", 100 * least, 100 * most))
    statement("CPU and wall time (tables 4 and 5 are of unlike clocks)", quick ? no_time : cpu_and_wall())
    if (load("realism-metrics")) {
        row = passing("realism-metrics")
        statement("images are realistic (judged by eye)", row " metrics agree with theory")
    }
    print ""
}
function statement(said, here) { printf "  %-58s %s\n", said, here }
function passing(name,    row, passes, all) {
    for (row = 1; row <= R[name]; row++)
        if (T[name, row, "passes"] != "NA") { all++; passes += T[name, row, "passes"] }
    return sprintf("%d of %d", passes, all)
}
function cpu_and_wall(    count, i, n, text, wall, at) {
    n = split("1 2 8", count, " ")
    for (i = 1; i <= n; i++) {
        at = "render.schedule=dynamic render.threads=" count[i]
        wall = value("threads", at, "wall_s_median")
        if (wall != "")
            text = text sprintf("%s%s: %.2f", text == "" ? "CPU/wall " : ", ", count[i],
                value("threads", at, "cpu_s_median") / wall)
    }
    return text == "" ? "-" : text
}

function figures(    i, n, part, list, path, line, there) {
    n = split("rod|the rod in the vessel;" \
        "depth-time|time and rays by depth, table 4;" \
        "depth-images|the image at every depth;" \
        "threads-time|wall time by threads, table 5;" \
        "threads-speedup|the same as speed-up;" \
        "profile-bars|CPU, wall and waiting times;" \
        "ior-pairs|table 6: four pairs of indices;" \
        "ior-grid|images by both indices;" \
        "index-maps|magnification by both indices;" \
        "realism|traced light and closed forms;" \
        "methods|table 1: time and error;" \
        "lighting|table 2: lighting models;" \
        "published|all published series and ours;" \
        "triangles|test 1: number of triangles;" \
        "coverage|test 2: covered area;" \
        "crowding|test 3: overlapping triangles;" \
        "shading|flat, Gouraud, Phong shading;" \
        "texture|textures by filter;" \
        "sectors|sectors of the image;" \
        "hidden|depth buffer and ray tracing;" \
        "slime-grab|a slime in the hand;" \
        "slime-optics|slime, by transparency", list, ";")
    for (i = 1; i <= n; i++) {
        split(list[i], part, "|")
        path = results "/figures/" part[1] ".png"
        there = (getline line < path) >= 0
        close(path)
        if (there) put(shown_figures++ % 2 ? "right" : "left", sprintf("  %-16s%s", part[1], part[2]))
    }
    if (!shown_figures) return
    print "Figures: open " shown "/figures/NAME.png (or .svg)"
    flush_blocks()
}

BEGIN {
    bad = disturbed()
    if (quick)
        print "A QUICK RUN: frames of at most 80 x 60 pixels, each measured once. ITS TIMES MEAN NOTHING;\n" \
            "films and counts are exact. `make experiments` without QUICK=1 measures."
    printf "What was reproduced: rows in %s%s\n\n", shown, environment == "" ? "" : ", environment " environment
    films()
    if (failed != "") print "FAILED: " failed
    if (bad && !quick)
        printf "Disturbed by other programs: %d of %d measured rows; their times are less certain.\n", bad, measured_rows
    print ""
    print "Times, published and here, each divided by its first (shapes compare); ratio: here/published"
    print ""
    series("left", "Recursion depth (rod, table 4), CPU time", "depth", "depth", "cpu_s", "depth", "", "render.depth",
        "cpu_s")
    series("right", "Threads at depth 4 (rod, table 5), wall time", "threads", "threads", "wall_s", "threads",
        "render.schedule=columns ", "render.threads", "wall_s")
    flush_blocks()
    polygons("left", "Sparse triangles (polygons, test 1)", "triangles", "triangles")
    polygons("right", "Covered pixels (polygons, test 2)", "coverage", "pixels")
    flush_blocks()
    polygons("left", "Overlapping triangles (polygons, test 3)", "crowding", "triangles")
    right("Here, in the tables below: CPU time, and FLIP")
    right("error against path tracing (0: none).")
    flush_blocks()
    methods()
    statements()
    figures()
}
