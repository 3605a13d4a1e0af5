# Print every value of a study's table as a TeX number, \setval{study/axis values/column}{text}, formatted by its kind:
# times in ms, rays in millions, shares in percent; and numbers derived from them: ratios and differences of measured values
# have an interval, or with fewer than six repetitions a range.
#   awk -v study=NAME -f interval.awk -f numbers.awk TABLE.tsv
# NA defines no number: the paper then prints n/a.
# For a study whose axes all depend on one of them, that one is the key: alias().
function set(key, text) { if (text != "") printf "\\setval{%s}{%s}\n", key, text }

# About four digits, without an exponent.
function digits(v,   size) {
    size = v < 0 ? -v : v
    return (v < 0 ? "\\ensuremath{-}" : "") sprintf(size >= 1000 ? "%.0f" : size >= 100 ? "%.1f" : size >= 10 ? "%.2f" : "%.3f", size)
}
# A power of ten if plain digits would hide the value.
function scientific(v,   exponent) {
    if (v == 0) return "0"
    exponent = 0
    while (v < 1) { v *= 10; exponent-- }
    while (v >= 10) { v /= 10; exponent++ }
    return sprintf("\\ensuremath{%.2f\\cdot 10^{%d}}", v, exponent)
}
# Three digits.
function significant(v,   places) {
    if (v == 0) return "0"
    if (v < 1e-4) return scientific(v)
    for (places = 2; v < 1 && places < 6; v *= 10) places++
    return sprintf("%." places "f", v / 10 ^ (places - 2))
}
function formatted(column, v) {
    if (v == "NA" || v == "") return ""
    if (column ~ /_s(_[a-z]+)?$/) return digits(v * 1e3)
    if (column ~ /^rays_/) return sprintf("%.3f", v / 1e6)
    if (column ~ /^others_share$/) return sprintf("%.1f", v * 100)
    if (column ~ /^(peak_rss|accel)_bytes$/) return sprintf("%.1f", v / 1048576)
    if (column == "psnr_db") return sprintf("%.1f", v)
    if (column == "ssim") return sprintf("%.4f", v)
    if (column == "differing_share") return sprintf("%.1f", v * 100)
    if (column ~ /^(flip|mse|largest|error_rms|noise_rms|reference_noise_rms)$/) return significant(v)
    if (column ~ /^(first_hits|total_internal|n$|marked|triangles|instances)/) return sprintf("%d", v)
    return v
}
function alias() {
    if (study == "methods") return $2 == "path" ? study "/path/" $3 : study "/" $2
    if (study == "lighting") return study "/" $2
    if (study == "triangles") return $4 == "off" ? study "/empty" : study "/" $2 "/" $3 + 0
    if (study == "coverage") return study "/" $2 "/" sprintf("%.0f", value("first_hits.model") / 1000)
    if (study == "hidden") return study "/" $2 + 0 "/" $6
    if (study == "shading")
        return study "/" ($2 + 0 < 100 ? "few" : "many") "/" ($5 == "off" ? $4 : "shadows") "/" ($7 + 0 ? $6 : "unlit")
    if (study == "texture") return study "/" $2 "/" $3 "/" $4
    if (study == "slime-step") return study "/" $2 + 0 "/" $3 "/" $6 + 0
    if (study == "build") return study "/" $2 "/" $3 + 0 "/" $4 "/" $7 + 0
    return ""
}
function value(column) { return (column in at) && $at[column] != "NA" ? $at[column] + 0 : "" }
# The line's value of a column with its interval (interval.awk), 0 without one.
function measured(column,   fields, i) {
    for (i = at["n"]; i <= NF; i++) fields[name[i]] = $i
    return value_of_fields(fields, column)
}
function set_value(key, v) { if (v) set(key, value_tex(v)) }
# A cost is a difference of two times. It is a number only if it is certainly positive.
function set_cost(key, v) { if (v && value_kind[v] != "unbounded" && value_low[v] > 0) set(key, value_tex(v)) }

BEGIN {
    FS = "\t"
    split("none sphere octant bvh", kind, " ")
    for (i in kind) hierarchy[kind[i]] = 1
    split("sparse dense sphere", kind, " ")
}
NR == 1 {
    for (i = 1; i <= NF; i++) {
        at[$i] = i
        name[i] = $i
    }
    axes = at["n"] - 2
    next
}
value("n") > 0 {
    key = study
    if (alias() != "") key = alias()
    else for (i = 2; i <= axes + 1; i++) key = key "/" ($i ~ /^[-+0-9.]+$/ ? $i + 0 : $i)
    for (i = at["n"]; i <= NF; i++)
        if (name[i] !~ /\/|^imbalance|^environment$/) set(key "/" name[i], formatted(name[i], $i))
    if (measured("imbalance")) set_value(key "/imbalance", scaled(measured("imbalance"), 100))
    rays = value("rays_total")
    cpu = measured("cpu_s")
    wall = measured("wall_s")
    rate = measured("rays_total/cpu_s")
    if (!rate && rays && cpu) rate = combine("/", exact(rays), cpu)
    if (rate) set_value(key "/rate", scaled(rate, 1e-6))
    if (value("rays_camera") && value("cut_depth_throughput") != "")
        set(key "/cut", scientific(value("cut_depth_throughput") / value("rays_camera")))
    if (value("triangles")) {
        set(key "/bytes-triangle", sprintf("%.0f", value("accel_bytes") / value("triangles")))
        if (rate) set_value(key "/million-rays", scaled(rate, 1e-6))
    }
    if (value("rays_camera"))
        set(key "/glass", sprintf("%.1f", (value("first_hits.vessel") + value("first_hits.liquid")) / value("rays_camera") * 100))
    if (value("others_share") != "") { others += value("others_share"); told++ }
    cells++
    rows += value("n")
    if (fewest == "" || value("n") < fewest) fewest = value("n")
    if (value("n") > most_rows) most_rows = value("n")
    if (value("wall_s_low") != "") spans++
    disturbed += value("disturbed")
    marked += value("marked")
    if (study == "depth") {
        if ($2 == 0) { cpu_0 = cpu; rays_0 = rays }
        if (cpu_0) set_value(key "/growth", combine("/", cpu, cpu_0))
        if (rays_0) set(key "/rays-growth", digits(rays / rays_0))
    }
    if (study == "threads") {
        if ($3 == 1) one[$2] = wall
        if (one[$2]) set_value(key "/speedup", combine("/", one[$2], wall))
        if (!($2 in best) || value_mid[wall] < value_mid[best[$2]]) { best[$2] = wall; best_count[$2] = $3 }
        if ($3 == 1024) most[$2] = wall
        if ($3 == 2) two[$2] = wall
        if ($3 == 4 && two[$2]) set_value(study "/" $2 "/two-four", combine("/", two[$2], wall))
    }
    # The sufficient depth, by the rule of plots/convergence.gp.
    if (study ~ /^(convergence|visible-(depth|lens|window|coin))$/ && \
        value("flip") != "" && value("flip") < 0.01 && !($2 in enough)) {
        enough[$2] = $3
        set(study "/" $2 "/enough", $3)
    }
    if (study == "methods") {
        if ($2 == "path" && value("error_rms") > 0) {
            x = log($3); y = log(value("error_rms"))
            n_xy++; sum_x += x; sum_y += y; sum_xx += x * x; sum_xy += x * y
            if (rms_whitted != "" && !rms_first && value("error_rms") < rms_whitted) set(study "/rms-first", rms_first = $3)
            if (flip_whitted != "" && !flip_first && value("flip") < flip_whitted) set(study "/flip-first", flip_first = $3)
        }
        if ($2 == "whitted") { rms_whitted = value("error_rms"); flip_whitted = value("flip"); rays_whitted = rays }
        rays_of[key] = rays
    }
    # Relative to the first cell.
    if (study ~ /^(spectral|polarised)$/) {
        if (!first_cpu) { first_cpu = cpu; first_rays = rays }
        set_value(key "/cpu-ratio", combine("/", cpu, first_cpu))
        set(key "/rays-ratio", digits(rays / first_rays))
    }
    if (study == "pool") wall_of[$2, $3] = wall
    if (study ~ /^(triangles|crowding|build|hidden)$/) {
        cpu_of[key] = cpu
        build_of[key] = measured("build_s")
        if (rate) ray_of[key] = combine("/", exact(1), rate)
    }
    # The memory of a method in addition to triangles and film: hierarchies, or the depth buffer and its triangles.
    if (study == "hidden" && value("accel_bytes") + value("drawn_bytes") > 0)
        set(key "/memory", sprintf("%.1f", (value("accel_bytes") + value("drawn_bytes")) / 1048576))
    # With one thread, its busy time is the frame's.
    if (study == "slime-frame" && measured("visibility_s_sum/wall_s")) {
        share = scaled(measured("visibility_s_sum/wall_s"), 100)
        set_value(key "/visible-share", share)
        visible_of[key] = scaled(measured("visibility_s_sum/rays_total"), 1e9)
        set_value(key "/visible-ray", visible_of[key])
        if ($4 == "bvh" && $2 == 0) {
            if (!least_share || value_mid[share] < value_mid[least_share]) least_share = share
            if (!most_share || value_mid[share] > value_mid[most_share]) most_share = share
        }
    }
    # Microseconds a step, and seconds simulated in a second.
    if (study == "slime-step" && value("motion_steps") && measured("motion_s/motion_steps")) {
        step_of[key] = measured("motion_s/motion_steps")
        set_value(key "/step", scaled(step_of[key], 1e6))
        set_value(key "/simulated", combine("/", exact($5), measured("motion_s")))
    }
    # The cost of a shading: its frame minus the one without light. Shadow rays are not part of it, so that a frame with shadows has the
    # cost of the one without. The excess of Phong shading over flat shading is the cost of its normals.
    if (study == "shading") {
        light_of[key] = cpu
        split(key, part, "/")
        frames = study "/" part[2] "/" (part[3] == "shadows" ? "whitted" : part[3])
        if ($7 + 0) {
            shading_cost = combine("-", light_of[frames "/" part[4]], light_of[frames "/unlit"])
            share = scaled(combine("/", shading_cost, cpu), 100)
            set_cost(key "/cost", scaled(shading_cost, 1e3))
            set_cost(key "/share", share)
            cost_of[key] = shading_cost
            if (part[4] == "smooth") {
                if (!least_phong || value_mid[share] < value_mid[least_phong]) least_phong = share
                if (!most_phong || value_mid[share] > value_mid[most_phong]) most_phong = share
            }
            # Corners of the mesh, each of which Gouraud's original method would light once.
            if (part[4] == "gouraud" && part[3] == "zbuffer")
                set(study "/" part[2] "/points-corner", value("first_hits.model") > 10 * $2 * $3 ? \
                    sprintf("%.0f", value("first_hits.model") / ($2 * $3)) : significant(value("first_hits.model") / ($2 * $3)))
        }
    }
    if (study == "sectors") {
        if ($4 == 1) one[$2, $3] = wall
        if ($4 == 2) two[$2, $3] = wall
        if ($4 == 4 && two[$2, $3]) set_value(key "/two-four", combine("/", two[$2, $3], wall))
        set_value(key "/wall", scaled(wall, 1e3))
    }
}
# What the bars of a study's figures are.
function bars(   count) {
    count = "$n = " fewest (most_rows > fewest ? "$ to~$" most_rows : "") "$"
    if (spans == cells) return "95\\,\\% intervals of the median, " count
    return most_rows > 1 ? "smallest and largest value, " count : count
}
# The ratio of the values of two keys.
function ratio(result, of, above, below) {
    if ((above in of) && (below in of) && of[below] && of[above]) set_value(result, combine("/", of[above], of[below]))
}
END {
    set(study "/cells", cells)
    set(study "/rows", rows)
    set(study "/marked", marked + 0)
    set(study "/disturbed-rows", disturbed + 0)
    if (cells) set(study "/n", most_rows > fewest ? fewest "--" most_rows : fewest)
    if (cells) set(study "/bars", bars())
    if (told) set(study "/others", sprintf("%.0f", others / told * 100))
    for (k in rays_of) if (rays_whitted) set(k "/rays-ratio", digits(rays_of[k] / rays_whitted))
    # Least-squares fit of log error against log N.
    if (n_xy > 1) set("methods/slope", digits((n_xy * sum_xy - sum_x * sum_y) / (n_xy * sum_xx - sum_x * sum_x)))
    for (s in best) {
        set("threads/" s "/best", best_count[s])
        if (s in most) set_value("threads/" s "/loss", most[s] == best[s] ? exact(0) : \
            scaled(combine("-", combine("/", most[s], best[s]), exact(1)), 100))
    }
    for (accel in hierarchy) {
        ratio("triangles/" accel "/growth", cpu_of, "triangles/" accel "/50000", "triangles/" accel "/10000")
        ratio("triangles/" accel "/gain", cpu_of, "triangles/none/10000", "triangles/" accel "/10000")
        ratio("triangles/" accel "/first-doubling", cpu_of, "triangles/" accel "/20000", "triangles/" accel "/10000")
        ratio("triangles/" accel "/last-doubling", cpu_of, "triangles/" accel "/4000000", "triangles/" accel "/2000000")
        ratio("crowding/" accel "/growth", cpu_of, "crowding/" accel "/50000", "crowding/" accel "/10000")
        ratio("crowding/" accel "/gain", cpu_of, "crowding/none/10000", "crowding/" accel "/10000")
    }
    # The number of rays after which a build with one thread has paid off.
    for (accel in hierarchy)
        for (i = 1; i <= 3; i++) {
            built = "build/" kind[i] "/50000/" accel "/1"
            if (!build_of[built] || !ray_of[built] || !ray_of["build/" kind[i] "/50000/none/1"]) continue
            saved = combine("-", ray_of["build/" kind[i] "/50000/none/1"], ray_of[built])
            set_cost("build/" kind[i] "/50000/" accel "/pays", combine("/", build_of[built], saved))
        }
    ratio("triangles/octant-bvh", cpu_of, "triangles/octant/50000", "triangles/bvh/50000")
    ratio("crowding/octant-bvh", cpu_of, "crowding/octant/50000", "crowding/bvh/50000")
    set_value("slime-frame/ball/bvh/least-share", least_share)
    set_value("slime-frame/ball/bvh/most-share", most_share)
    for (level = 0; level <= 7; level++) {
        ratio("slime-frame/" level "/stretch", visible_of, "slime-frame/0.5/" level "/bvh", "slime-frame/0/" level "/bvh")
        ratio("slime-frame/" level "/gain", visible_of, "slime-frame/0/" level "/none", "slime-frame/0/" level "/bvh")
        ratio("slime-frame/" level "/octant-bvh", visible_of, "slime-frame/0/" level "/octant", "slime-frame/0/" level "/bvh")
        ratio("slime-step/" level "/dearer", step_of, "slime-step/" level "/implicit/1", "slime-step/" level "/euler/1")
        ratio("slime-step/" level "/speedup", step_of, "slime-step/" level "/euler/1", "slime-step/" level "/euler/2")
        ratio("slime-step/" level "/implicit-speedup", step_of, "slime-step/" level "/implicit/1", "slime-step/" level "/implicit/2")
    }
    set_cost("shading/least-phong", least_phong)
    set_cost("shading/most-phong", most_phong)
    for (k in cost_of)
        if (sub(/\/gouraud$/, "", k)) ratio(k "/gouraud-phong", cost_of, k "/gouraud", k "/smooth")
    split("zbuffer raycast whitted", method, " ")
    for (i in method) ratio("hidden/" method[i] "/more", cpu_of, "hidden/6/" method[i], "hidden/3/" method[i])
    for (pair in wall_of) {
        split(pair, part, SUBSEP)
        if (part[1] == "off" && ("on", part[2]) in wall_of)
            set_cost("pool/" part[2] "/added", scaled(combine("-", wall_of[pair], wall_of["on", part[2]]), 1e3))
    }
}
