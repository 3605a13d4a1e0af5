# The fitted lines of plots/areas.gp as TeX numbers: in ms, the published one in s; b is for 1000 pixels.
load "plots/rows.gp"
load "plots/areas.gp"
set print "-"
do for [i=1:3] {
    key = "line/".word("octant bvh published", i)
    scale = i < 3 ? 1e3 : 1
    if (line_fits[i]) {
        print sprintf('\setval{%s/a}{%.3g}', key, line_a[i]*scale)
        print sprintf('\setval{%s/b}{%.3g}', key, line_b[i]*scale/100)
        print sprintf('\setval{%s/off}{%.1f}', key, line_off[i]*100)
    }
}
sixth = number(system("awk -F, '$1 == \"NA\" { print $2 }' experiments/published/coverage.csv"))
print sprintf('\setval{line/published/more}{%.0f}', (sixth - line_a[3])/line_b[3]*1e5)
