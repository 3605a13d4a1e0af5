# Format a positive number as TeX: 1.2 . 10^-5. Used by metrics.awk and curves.awk.
function scientific(v,   exponent) {
    if (v == 0) return "0"
    exponent = 0
    while (v < 1) { v *= 10; exponent-- }
    while (v >= 9.95) { v /= 10; exponent++ }
    return sprintf("\\ensuremath{%.1f\\cdot 10^{%d}}", v, exponent)
}
