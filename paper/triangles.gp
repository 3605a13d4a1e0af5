# The fitted laws of plots/polygons.gp as TeX numbers, in ms, the published ones in s; deviations in percent.
load "plots/rows.gp"
load "plots/polygons.gp"
set print "-"
do for [i=3:5] {
    key = "law/".(i < 5 ? word(hierarchies, i) : "published")
    scale = i < 5 ? 1e3 : 1
    if (log_fits[i]) {
        print sprintf('\setval{%s/a}{%.3g}', key, log_a[i]*scale)
        print sprintf('\setval{%s/b}{%.3g}', key, log_b[i]*scale)
        # Where the logarithm is zero: a number of triangles only if it lies below those that were fitted.
        if (log_a[i] > 0 && log_b[i] > 0) { print sprintf('\setval{%s/zero}{%.0f}', key, 1e4*exp(-log_a[i]/log_b[i])) }
        print sprintf('\setval{%s/off}{%.1f}', key, log_off[i]*100)
        print sprintf('\setval{%s/power}{%.2f}', key, power_p[i])
        print sprintf('\setval{%s/power-off}{%.1f}', key, power_off[i]*100)
    }
    if (wide_fits[i]) {
        print sprintf('\setval{%s/wide/off}{%.0f}', key, wide_off[i]*100)
        print sprintf('\setval{%s/wide/power}{%.2f}', key, wide_p[i])
        print sprintf('\setval{%s/wide/power-off}{%.0f}', key, wide_power_off[i]*100)
    }
}
