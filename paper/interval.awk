# Measured values with what is known of their error, for paper/claims.awk and paper/numbers.awk. The only place where
# intervals are combined.
# A value has a median, two ends and a kind: "exact" (a count, or computed without noise), "interval" (95 % of the median,
# from six repetitions on), "range" (smallest and largest, of fewer) or "unbounded" (one repetition, or a divisor that may
# be 0).
# Sums, products and quotients combine the ends that are farthest apart. For independent medians that is wider than their
# joint 95 % interval, whose half-widths add as squares; so it covers at least 95 %.
function value_new(mid, low, high, kind) {
    values_made++
    value_mid[values_made] = mid
    value_low[values_made] = low
    value_high[values_made] = high
    value_kind[values_made] = kind
    return values_made
}
function exact(v) { return value_new(v, v, v, "exact") }

# The value of a column from the fields of a summary: NAME_median or NAME, with NAME_low and NAME_high, or _min and _max.
# fields: text by column name. 0 without a value.
function value_of_fields(fields, name,   mid) {
    mid = known(fields, name "_median") ? fields[name "_median"] : known(fields, name) ? fields[name] : "NA"
    if (mid == "NA") return 0
    if (known(fields, name "_low")) return value_new(mid + 0, fields[name "_low"] + 0, fields[name "_high"] + 0, "interval")
    if (known(fields, name "_min") && fields["n"] > 1)
        return value_new(mid + 0, fields[name "_min"] + 0, fields[name "_max"] + 0, "range")
    if (is_measured(name)) return value_new(mid + 0, mid + 0, mid + 0, "unbounded")
    return exact(mid + 0)
}
function known(fields, name) { return (name in fields) && fields[name] != "NA" && fields[name] != "" }
# Columns that differ between repetitions; an axis, such as toy.time_s, does not.
function is_measured(name) {
    return name !~ /^differing_share$|^[a-z-]+[.]/ && name ~ /(_s$|_s_|^imbalance$|_share$|^peak_rss|_switches$|^cycles|^instructions)/
}

function joint_kind(a, b) {
    if (value_kind[a] == "unbounded" || value_kind[b] == "unbounded") return "unbounded"
    if (value_kind[a] == "range" || value_kind[b] == "range") return "range"
    if (value_kind[a] == "interval" || value_kind[b] == "interval") return "interval"
    return "exact"
}
function combine(op, a, b,   kind, i, j, v, low, high, x, y) {
    kind = joint_kind(a, b)
    if (op == "+") return value_new(value_mid[a] + value_mid[b], value_low[a] + value_low[b], value_high[a] + value_high[b], kind)
    if (op == "-") return value_new(value_mid[a] - value_mid[b], value_low[a] - value_high[b], value_high[a] - value_low[b], kind)
    if (op == "/" && value_low[b] <= 0 && value_high[b] >= 0)
        return value_new(value_mid[b] ? value_mid[a] / value_mid[b] : 0, 0, 0, "unbounded")
    for (i = 0; i < 2; i++)
        for (j = 0; j < 2; j++) {
            x = i ? value_high[a] : value_low[a]
            y = j ? value_high[b] : value_low[b]
            v = op == "*" ? x * y : x / y
            if (i + j == 0 || v < low) low = v
            if (i + j == 0 || v > high) high = v
        }
    return value_new(op == "*" ? value_mid[a] * value_mid[b] : value_mid[a] / value_mid[b], low, high, kind)
}

# The larger (way 1) or smaller (way -1) of two values, whichever that is: its ends are the larger or smaller ones.
function extreme(way, a, b) {
    return value_new(further(way, value_mid[a], value_mid[b]), further(way, value_low[a], value_low[b]), \
        further(way, value_high[a], value_high[b]), joint_kind(a, b))
}
function further(way, x, y) { return way * (x - y) >= 0 ? x : y }

# 1 or 0 if the ends decide a < b, "unknown" otherwise.
function is_below(a, b, or_equal) {
    if (joint_kind(a, b) == "unbounded") return "unknown"
    if (value_high[a] < value_low[b] || (or_equal && value_high[a] <= value_low[b])) return 1
    if (value_low[a] > value_high[b] || (!or_equal && value_low[a] >= value_high[b])) return 0
    return "unknown"
}

# Decimals that leave about two digits of the interval's half-width, and at most five digits of the value.
function decimals_of(v,   half, size, places) {
    size = value_mid[v] < 0 ? -value_mid[v] : value_mid[v]
    half = (value_high[v] - value_low[v]) / 2
    places = 1
    if (half > 0) for (; half < 1 && places < 9; half *= 10) places++
    else places = 4
    if (half >= 10) places = 0
    for (; size >= 10 && places > 0; size /= 10) if (half == 0) places--
    return places
}
function plain_number(v, places,   text) {
    text = sprintf("%." places "f", v)
    if (text + 0 == 0) sub(/^-/, "", text)
    return text
}
function short_number(v) { return v == int(v) && v < 1e9 && v > -1e9 ? sprintf("%d", v) : sprintf("%.4g", v) }
# "1.93 [1.90, 1.97]"; a range has round brackets: "1.93 (1.90 to 1.97)".
function value_text(v,   places) {
    if (value_kind[v] == "exact") return short_number(value_mid[v])
    if (value_kind[v] == "unbounded") return short_number(value_mid[v]) " (unknown error)"
    places = decimals_of(v)
    if (value_kind[v] == "interval")
        return plain_number(value_mid[v], places) " [" plain_number(value_low[v], places) ", " plain_number(value_high[v], places) "]"
    return plain_number(value_mid[v], places) " (" plain_number(value_low[v], places) " to " plain_number(value_high[v], places) ")"
}
# The same for TeX; paper.tex says how ends are set.
function tex_number(v, places,   text) {
    text = plain_number(v, places)
    sub(/^-/, "\\ensuremath{-}", text)
    return text
}
function value_tex(v,   places, text) {
    text = short_number(value_mid[v])
    sub(/^-/, "\\ensuremath{-}", text)
    if (value_kind[v] == "exact") return text
    if (value_kind[v] == "unbounded") return text "\\single{}"
    places = decimals_of(v)
    return tex_number(value_mid[v], places) (value_kind[v] == "interval" ? "\\within" : "\\ranging") \
        "{" tex_number(value_low[v], places) "}{" tex_number(value_high[v], places) "}"
}
function scaled(v, factor) { return combine("*", v, exact(factor)) }
