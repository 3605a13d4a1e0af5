# The tests of a ray (experiments/queries.study), from the tables of that study and of triangles, which has
# the times of the same frames: those of one thread in visibility queries, nearest hits and shadows.
#   awk -v show=WHAT [-v topology=TEXT] -f paper/queries.awk TABLES/queries.tsv [TABLES/triangles.tsv]
# topology: of the machine with the times, as in runs.json, for the sizes of its caches.
# WHAT: numbers    \setval lines: counts, exponents, what geometry asks for, time of a test
#       series     scene, hierarchy, triangles, tests, boxes, triangles tested a camera ray
#       exponents  scene, hierarchy, triangles (geometric mean of two), local exponent
#       cache      hierarchy, bytes, ns a test: median, least, most
#
# What geometry asks for. A line that meets a convex body meets a convex part of it with a probability of the ratio of
# their surfaces (Cauchy; MacDonald and Booth 1990 build on it). At a level of the tree with m boxes of edge h, a ray
# therefore enters about m h^2 of them. Triangles that fill a volume have h ~ m^(-1/3), hence m^(1/3) boxes: the leaves'
# level outweighs all others, and the power is 1/3. On a surface h ~ m^(-1/2), hence as many boxes on each level, and the
# sum is the number of levels: a logarithm.
BEGIN {
    FS = "\t"
    LATTICE = 4000
    scenes = split("sparse sphere dense", scene, " ")
    trees = split("octant bvh", tree, " ")
}

FNR == 1 {
    delete at
    for (i = 1; i <= NF; i++) {
        gsub(/"/, "", $i)
        at[$i] = i
    }
    times = !("soup.generate" in at)
    next
}

function value(name) {
    return (name in at) && $at[name] != "NA" ? $at[name] : ""
}

{ gsub(/"/, "") }

times {
    if (value("model.visible") == "on") {
        key = value("render.accel") SUBSEP value("soup.count")
        time[key] = value("visibility_s_sum_median")
        time_least[key] = value("visibility_s_sum_min")
        time_most[key] = value("visibility_s_sum_max")
        time_film[key] = value("film_hash")
        bytes[key] = value("accel_bytes")
    }
    next
}

value("query_rays_median") > 0 {
    boxes = value("query_boxes_median")
    tested = value("query_triangles_median")
    rays = value("query_rays_median")
    if (value("render.shadows") != "off") { # the frames of triangles
        if (value("soup.generate") != "sparse") next
        key = value("render.accel") SUBSEP value("soup.count")
        tests_of[key] = boxes + tested
        film_of[key] = value("film_hash")
        timed[++timed_count] = key
        next
    }
    s = value("soup.generate") SUBSEP value("render.accel")
    k = ++count[s]
    n[s, k] = value("triangles")
    box[s, k] = boxes / rays
    tri[s, k] = tested / rays
    y[s, k] = (boxes + tested) / rays
    asked_rays[s, k] = rays
    hits[s, k] = value("first_hits.model")
}

function exponent(s, k) {
    return log(y[s, k + 1] / y[s, k]) / log(n[s, k + 1] / n[s, k])
}

# --- what the soup asks for ---

# The mean shadow, along a unit direction, of a triangle with corners anywhere in a unit cube, over points of a lattice
# (Korobov's kind, of the golden ratio's generalisation to nine dimensions). Along an axis it is the mean area of a
# triangle in a unit square, 11/144 (a classical result, which `numbers` prints beside ours).
function lay_triangles(   i, k, root, g, p, ax, ay, az, bx, by, bz) {
    root = 1
    for (i = 0; i < 60; i++) root = exp(log(1 + root) / 10)
    for (k = 1; k <= 9; k++) g[k] = exp(-k * log(root))
    for (i = 1; i <= LATTICE; i++) {
        for (k = 1; k <= 9; k++) {
            p[k] = i * g[k] + 0.5
            p[k] -= int(p[k])
        }
        ax = p[4] - p[1]; ay = p[5] - p[2]; az = p[6] - p[3]
        bx = p[7] - p[1]; by = p[8] - p[2]; bz = p[9] - p[3]
        cross_x[i] = ay * bz - az * by
        cross_y[i] = az * bx - ax * bz
        cross_z[i] = ax * by - ay * bx
    }
}

function shadow(x, y, z,   i, dot, sum) {
    for (i = 1; i <= LATTICE; i++) {
        dot = cross_x[i] * x + cross_y[i] * y + cross_z[i] * z
        sum += dot < 0 ? -dot : dot
    }
    return sum / LATTICE / 2
}

# The ways of every twentieth camera ray (experiments/scenes/soup.yaml) through the cube [-1, 1]^3: chord[1..chords], and
# the mean shadows, along the ray, of a triangle in a cube of edge 1 and of its box. Of three numbers in 0..1 the largest
# and the smallest differ by 1/2 in the mean, and the axes are independent.
function lay_chords(   i, j, k, d, o, near, far, a, b, t, length_d) {
    chords = 0
    t = sin(atan2(0, -1) / 8) / cos(atan2(0, -1) / 8)
    o[1] = 0; o[2] = 0; o[3] = -3
    for (j = 10; j < 300; j += 20)
        for (i = 10; i < 400; i += 20) {
            d[1] = (i - 200) / 150 * t; d[2] = (j - 150) / 150 * t; d[3] = 1
            near = 0; far = 1e9
            for (k = 1; k <= 3; k++) {
                if (d[k] == 0) continue
                a = (-1 - o[k]) / d[k]; b = (1 - o[k]) / d[k]
                if ((a < b ? a : b) > near) near = a < b ? a : b
                if ((a < b ? b : a) < far) far = a < b ? b : a
            }
            if (far <= near) continue
            length_d = sqrt(d[1] ^ 2 + d[2] ^ 2 + 1)
            chord[++chords] = (far - near) * length_d
            for (k = 1; k <= 3; k++) d[k] = (d[k] < 0 ? -d[k] : d[k]) / length_d
            box_shadow[chords] = (d[1] + d[2] + d[3]) / 4
            tri_shadow[chords] = shadow(d[1], d[2], d[3])
        }
}

# Sets asked (boxes of single triangles that a ray meets up to its first hit) and covered (the share of rays that hit
# something) for a soup of that many triangles, each within a cube of edge e, a quarter of the spacing 2 / cbrt(total):
# boxes and hits are Poisson in the length of the way, if the ends of the cube are left aside.
function ask(total,   e, density, box_rate, hit_rate, i, passed, sum) {
    e = 0.5 / exp(log(total) / 3)
    density = total / 8
    for (i = 1; i <= chords; i++) {
        box_rate = density * e ^ 2 * box_shadow[i]
        hit_rate = density * e ^ 2 * tri_shadow[i]
        passed += exp(-hit_rate * chord[i])
        sum += box_rate * (1 - exp(-hit_rate * chord[i])) / hit_rate
    }
    covered = 1 - passed / chords
    asked = sum / chords
}

# --- output ---

function set(key, format, x) {
    printf "\\setval{queries/%s}{" format "}\n", key, x
}

function number_of(x) { # 4000000 as 4\,000\,000
    x = sprintf("%d", x)
    while (match(x, /^[0-9]+[0-9][0-9][0-9]($|\\)/)) {
        cut = RLENGTH - (substr(x, RLENGTH, 1) == "\\" ? 4 : 3)
        x = substr(x, 1, cut) "\\," substr(x, cut + 1)
    }
    return x
}

function counts_of(s, name,   k, last, least, most) {
    last = count[s]
    set(name "/first", "%.1f", y[s, 1])
    set(name "/last", "%.1f", y[s, last])
    set(name "/last/boxes", "%.1f", box[s, last])
    set(name "/last/triangles", "%.2f", tri[s, last])
    set(name "/n", "%s", number_of(n[s, last]))
    set(name "/growth", "%.2f", y[s, last] / y[s, 1])
    set(name "/exponent/first", "%.2f", exponent(s, 1))
    set(name "/exponent/last", "%.2f", exponent(s, last - 1))
    least = most = exponent(s, 1)
    for (k = 2; k < last; k++) {
        if (exponent(s, k) < least) least = exponent(s, k)
        if (exponent(s, k) > most) most = exponent(s, k)
    }
    set(name "/exponent/least", "%.2f", least)
    set(name "/exponent/most", "%.2f", most)
}

function soup_numbers(   k, s, last, worst, off, before) {
    s = "sparse" SUBSEP "bvh"
    if (!count[s]) return
    last = count[s]
    lay_triangles()
    lay_chords()
    set("soup/square", "%.4f", shadow(0, 0, 1))
    set("soup/square-known", "%.4f", 11 / 144)
    for (k = 1; k <= last; k++) {
        ask(n[s, k])
        off = hits[s, k] / asked_rays[s, k] - covered
        if (off < 0) off = -off
        if (off > worst) worst = off
        if (k == 1 || k == last) {
            set("soup/" (k == 1 ? "first" : "last") "/covered", "%.0f", 100 * covered)
            set("soup/" (k == 1 ? "first" : "last") "/hit", "%.0f", 100 * hits[s, k] / asked_rays[s, k])
            set("soup/" (k == 1 ? "first" : "last") "/asked", "%.2f", asked)
            set("soup/" (k == 1 ? "first" : "last") "/overhead", "%.1f", tri[s, k] / asked)
        }
        if (k == last - 1) before = asked
    }
    set("soup/covered-off", "%.1f", 100 * worst)
    set("soup/asked/exponent", "%.2f", log(asked / before) / log(n[s, last] / n[s, last - 1]))
}

# Film hashes of both studies; then ns a test at the fewest and at the most triangles of each hierarchy.
function time_numbers(   i, key, part, same, different) {
    for (i = 1; i <= timed_count; i++) {
        key = timed[i]
        if (!(key in time)) continue
        if (film_of[key] == time_film[key]) same++
        else different++
        split(key, part, SUBSEP)
        if (!((part[1], "first") in ns)) {
            ns[part[1], "first"] = ns_of(key, time[key])
            set("time/" part[1] "/first/ns", "%.2f", ns_of(key, time[key]))
            set("time/" part[1] "/first/mib", "%.1f", bytes[key] / 1048576)
            first_key[part[1]] = key
        }
        last_key[part[1]] = key
    }
    set("time/same", "%d", same)
    set("time/different", "%d", different)
    for (i = 1; i <= trees; i++) {
        if (!(tree[i] in last_key)) continue
        key = last_key[tree[i]]
        split(key, part, SUBSEP)
        set("time/" tree[i] "/last/ns", "%.2f", ns_of(key, time[key]))
        set("time/" tree[i] "/last/mib", "%.1f", bytes[key] / 1048576)
        set("time/" tree[i] "/last/n", "%s", number_of(part[2]))
        set("time/" tree[i] "/growth", "%.2f", ns_of(key, time[key]) / ns_of(first_key[tree[i]], time[first_key[tree[i]]]))
        set("time/" tree[i] "/tests-growth", "%.2f", tests_of[key] / tests_of[first_key[tree[i]]])
        set("time/" tree[i] "/time-growth", "%.2f", time[key] / time[first_key[tree[i]]])
    }
}

# "L2 1024 KiB, L3 32 MiB": the sizes, in MiB, of the caches that the machine reports.
function cache_numbers(   level) {
    for (level = 2; level <= 3; level++)
        if (match(topology, "L" level " [0-9.]+ [KM]iB")) {
            split(substr(topology, RSTART, RLENGTH), part, " ")
            set("cache/L" level, "%g", part[2] / (part[3] == "KiB" ? 1024 : 1))
        }
}

function ns_of(key, seconds) {
    return 1e9 * seconds / tests_of[key]
}

function each(what,   i, j, k, s) {
    for (i = 1; i <= scenes; i++)
        for (j = 1; j <= trees; j++) {
            s = scene[i] SUBSEP tree[j]
            if (!count[s]) continue
            if (what == "numbers") counts_of(s, scene[i] "/" tree[j])
            for (k = 1; k <= count[s] && what == "series"; k++)
                print scene[i], tree[j], n[s, k], y[s, k], box[s, k], tri[s, k]
            for (k = 1; k < count[s] && what == "exponents"; k++)
                print scene[i], tree[j], sqrt(n[s, k] * n[s, k + 1]), exponent(s, k)
        }
}

END {
    if (show != "numbers") OFS = "\t"
    each(show)
    for (i = 1; i <= timed_count && show == "cache"; i++)
        if (timed[i] in time) {
            split(timed[i], part, SUBSEP)
            print part[1], bytes[timed[i]], ns_of(timed[i], time[timed[i]]), ns_of(timed[i], time_least[timed[i]]),
                ns_of(timed[i], time_most[timed[i]])
        }
    if (show != "numbers") exit
    soup_numbers()
    if (timed_count) time_numbers()
    cache_numbers()
}
