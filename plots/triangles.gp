# Time by the number of triangles for each hierarchy, the law a + b log n fitted (polygons.gp), the published times, and the time of a ray.
# needs: tables/triangles.tsv
width = 1000; height = 790
load "plots/style.gp"

load "plots/polygons.gp"
rows = table("triangles")
empty_s = first(rows, "model.visible=off", "cpu_s_median")
names = "'no hierarchy' 'one sphere' 'octant tree of spheres' 'boxes'"
about(i) = sprintf("%s: a = %.3g ms, b = %.2g ms, off by %.0f %%", word(names, i), log_a[i]*1e3, log_b[i]*1e3, log_off[i]*100)

set label 100 disturbed("triangles") at screen 0.5,0.012 center font ",8" textcolor rgb grey
set multiplot layout 2,2 margins 0.075,0.935,0.08,0.955 spacing 0.13,0.125
set xlabel "triangles n"
set format x "10^{%T}"
set format y "10^{%T}"
set logscale xy
set xrange [700:6e6]
set yrange [1e-3:100]
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set title "All hierarchies, small triangles"
set ylabel "CPU time of a frame / s"
set key bottom right
set arrow 1 from graph 0, first empty_s to graph 1, first empty_s nohead dt (2,3) lc rgb grey
set label 1 "the empty scene" at graph 0.015, first empty_s*0.6 left font ",8" textcolor rgb grey
plot for [i=1:4] measured_times(i) using 1:2:3:4 with yerrorlines lt i title word(names, i)
unset label 100; unset arrow 1; unset label 1

unset logscale
set format "%h"
set title "From 10000 to 50000, and the published times"
set xlabel "triangles n / 1000"
set ylabel "CPU time / ms"
set xrange [0:55]
set yrange [0:*]
set y2label "published / s"
set y2range [0:*]
set y2tics
set border 11
few(i) = measured_times(i)." | awk '$1 >= 10000 && $1 <= 50000'"
plot [1:55] few(3) using ($1/1e3):($2*1e3):($3*1e3):($4*1e3) with yerrorbars lt 3 title word(names, 3), \
     few(4) using ($1/1e3):($2*1e3):($3*1e3):($4*1e3) with yerrorbars lt 4 title word(names, 4), \
     x < 9 ? NaN : log_law(x*1e3, log_a[3], log_b[3])*1e3 lt 3 notitle, \
     x < 9 ? NaN : log_law(x*1e3, log_a[4], log_b[4])*1e3 lt 4 notitle, \
     measured_times(5) using ($1/1e3):2 axes x1y2 with points lt 7 title "published (right axis)", \
     x < 1.2 ? NaN : log_law(x*1e3, log_a[5], log_b[5]) axes x1y2 with lines lt 7 title "its a + b ln n, from 10000 on"
unset y2tics; unset y2label
set border 3

set title "Fitted: T = a + b ln(n / 10000)"
set xlabel "triangles n"
set ylabel "CPU time of a frame / ms"
set logscale x
set format x "10^{%T}"
set xrange [7e3:6e6]
set yrange [0:*]
set key top left
plot for [i=3:4] long(i) using 1:($2*1e3):($3*1e3):($4*1e3) with yerrorbars lt i title about(i), \
     for [i=3:4] log_fits[i] ? log_law(x, log_a[i], log_b[i])*1e3 : NaN with lines lt i notitle, \
     for [i=3:4] log_fits[i] ? power_law(x, power_c[i], power_p[i])*1e3 : NaN with lines lt i lw 1 dt (2,3) \
         title sprintf("its power law: n^{%.2f}, off by %.0f %%", power_p[i], power_off[i]*100)

set title "Time of a ray, less the empty scene's frame"
set ylabel "ns / ray"
set logscale xy
set format y "10^{%T}"
set xrange [700:6e6]
set yrange [10:1e5]
set key top left
ray(i) = select(rows, "model.visible=on render.accel=".word(hierarchies, i), "soup.count cpu_s_median rays_total")
plot for [i=1:4] ray(i) using 1:(($2 - empty_s)/$3*1e9) with linespoints lt i title word(names, i)
unset multiplot
