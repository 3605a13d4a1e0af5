# Time by the number of triangles for each hierarchy, the fitted law a + b ln n (tables/laws.tsv), the published times,
# and the time of a ray.
# needs: tables/triangles.tsv model.visible=on cpu_s_median
# needs: tables/laws.tsv study=triangles a b deviation
width = 1000; height = 790
load "plots/style.gp"

hierarchies = "none sphere octant bvh"
measured_times(i) = i < 5 ? select(table("triangles"), "model.visible=on render.accel=".word(hierarchies, i), \
    "soup.count cpu_s_median cpu_s_min cpu_s_max") : select("experiments/published/triangles.csv", "", "triangles time_s time_s time_s")
wide(i) = measured_times(i)." | awk '$1 >= 10000'"
few(i) = measured_times(i)." | awk '$1 >= 10000 && $1 <= 50000'"
log_law(n, a, b) = a + b*log(n/1e4)
power_law(n, c, p) = c*(n/1e4)**p
# The laws of the octant tree, the box tree and the published series, NaN without enough rows: over the report's range, and
# over all from 10000 on.
law(i, extent, kind, column) = first(table("laws"), sprintf("study=triangles series=%s extent=%s law=%s", \
    i < 5 ? word(hierarchies, i) : "published", extent, kind), column)
array log_a[5]; array log_b[5]; array log_off[5]
array wide_a[5]; array wide_b[5]; array wide_off[5]; array wide_c[5]; array wide_p[5]; array wide_power_off[5]
do for [i=3:5] {
    log_a[i] = law(i, "report", "log", "a"); log_b[i] = law(i, "report", "log", "b")
    log_off[i] = law(i, "report", "log", "deviation")
    wide_a[i] = law(i, "wide", "log", "a"); wide_b[i] = law(i, "wide", "log", "b")
    wide_off[i] = law(i, "wide", "log", "deviation")
    wide_c[i] = law(i, "wide", "power", "a"); wide_p[i] = law(i, "wide", "power", "b")
    wide_power_off[i] = law(i, "wide", "power", "deviation")
}
rows = table("triangles")
empty_s = first(rows, "model.visible=off", "cpu_s_median")
names = "'no hierarchy' 'one sphere' 'octant tree of spheres' 'BVH of boxes'"

set label 100 remarks("triangles") at screen 0.5,0.012 center font ",8" textcolor rgb grey
set multiplot layout 2,2 margins 0.075,0.935,0.08,0.955 spacing 0.13,0.125
set xlabel "triangles n"
set format x "10^{%T}"
set format y "10^{%T}"
set logscale xy
set xrange [700:6e6]
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set title "All hierarchies, small triangles"
set ylabel "CPU time of a frame / s"
set key top right Right noreverse
plot for [i=1:4] measured_times(i) using 1:2:3:4 with yerrorlines lt i title word(names, i), \
     empty_s with lines lt 8 title "the empty scene"
unset label 100

unset logscale
set format "%h"
set title "From 10000 to 50000, and the published times"
set xlabel "triangles n / 1000"
set ylabel "CPU time / ms"
set xrange [0:55]
set yrange [0:*]
set offsets graph 0, graph 0, graph 0.45, graph 0
set y2label "published / s"
set y2range [0:10]
set y2tics
set border 11
set key top left Left reverse font ",9"
about(i) = log_a[i] == log_a[i] ? sprintf("%s: %.0f + %.0f ln(n / 10000) ms, rms deviation %.1f %%", \
    i == 3 ? "octants" : "boxes", log_a[i]*1e3, log_b[i]*1e3, log_off[i]*100) : word(names, i)
fitted(i, n) = n >= 7 ? log_law(n*1e3, log_a[i], log_b[i]) : NaN
plot for [i=3:4] few(i) using ($1/1e3):($2*1e3):($3*1e3):($4*1e3) with yerrorbars lt i title about(i), \
     for [i=3:4] '+' using 1:(fitted(i, $1)*1e3) with lines lt i notitle, \
     measured_times(5) using ($1/1e3):2 axes x1y2 with points lt 7 \
         title sprintf("published: %.2f + %.2f ln(n / 10000) s, rms deviation %.1f %%", log_a[5], log_b[5], log_off[5]*100), \
     '+' using 1:(fitted(5, $1)) axes x1y2 with lines lt 7 notitle
unset y2tics; unset y2label; unset offsets
set border 3

set title "From 10000 on: logarithm and power law"
set xlabel "triangles n"
set ylabel "CPU time of a frame / ms"
set logscale x
set format x "10^{%T}"
set xrange [7e3:6e6]
set yrange [0:*]
set offsets graph 0, graph 0, graph 0.35, graph 0
plot for [i=3:4] wide(i) using 1:($2*1e3):($3*1e3):($4*1e3) with yerrorbars lt i title word(names, i), \
     for [i=3:4] wide(i) using 1:(log_law($1, wide_a[i], wide_b[i])*1e3) with lines lt i dt (6,3) \
         title sprintf("a + b ln n, rms deviation %.0f %%", wide_off[i]*100), \
     for [i=3:4] wide(i) using 1:(power_law($1, wide_c[i], wide_p[i])*1e3) with lines lt i \
         title sprintf("n^{%.2f}, rms deviation %.0f %%", wide_p[i], wide_power_off[i]*100)
unset offsets

set title "Time per ray, without the frame of the empty scene"
set ylabel "ns / ray"
set logscale xy
set format y "10^{%T}"
set xrange [700:6e6]
set yrange [*:*]
set key top right Right noreverse font ",10"
ray(i) = select(rows, "model.visible=on render.accel=".word(hierarchies, i), "soup.count cpu_s_median rays_total")
plot for [i=1:4] ray(i) using 1:(($2 - empty_s)/$3*1e9) with linespoints lt i title word(names, i)
unset multiplot
