# The fitted lines of plots/areas.gp as TeX numbers, in ms, except that a of the published line is in s; b is for 1000 pixels.
load "plots/rows.gp"
load "plots/areas.gp"
set print "-"
do for [i=1:3] {
    key = "line/".word("octant bvh published", i)
    if (line_fits[i]) {
        print sprintf('\setval{%s/a}{%.3g}', key, line_a[i]*(i < 3 ? 1e3 : 1))
        print sprintf('\setval{%s/b}{%.3g}', key, line_b[i]*10)
        print sprintf('\setval{%s/off}{%.1f}', key, line_off[i]*100)
    }
}
