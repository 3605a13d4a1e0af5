# Time by the area that a model covers, with straight lines fitted (areas.gp), beside the published times and their line.
# needs: tables/coverage.tsv
width = 1000; height = 470
load "plots/style.gp"

load "plots/areas.gp"
names = "'octant tree of spheres' 'boxes'"
set label 100 disturbed("coverage") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.075,0.985,0.13,0.92 spacing 0.1
set xlabel "covered pixels / 1000"
set xrange [0:500]
set yrange [0:*]
set ylabel "CPU time of a frame / ms"
set title "A ball of 40500 triangles, 800 by 600 pixels"
set key top left spacing 2.3
set offsets graph 0, graph 0, graph 0.25, graph 0
plot for [i=1:2] areas(i) using ($1/1e3):($2*1e3):($3*1e3):($4*1e3) with yerrorbars lt i + 2 \
         title sprintf("%s:\n%.0f ms + %.2f ms a 1000 pixels, off by %.1f %%", word(names, i), line_a[i]*1e3, line_b[i]*10, line_off[i]*100), \
     for [i=1:2] line(x*1e3, line_a[i], line_b[i])*1e3 with lines lt i + 2 notitle
unset label 100

set xrange [0:700]
unset offsets
set title "Published: 40000 triangles"
set ylabel "time / s"
set yrange [0:7]
sixth = number(system("awk -F, '$1 == \"NA\" { print $2 }' experiments/published/coverage.csv"))
set arrow 1 from graph 0, first sixth to graph 1, first sixth nohead dt (2,3) lc rgb grey
set arrow 2 from 480, graph 0 to 480, graph 0.9 nohead dt (2,3) lc rgb grey
set label 1 sprintf("a sixth time, %.2f s, that belongs to no area:", sixth) at 10, sixth + 0.28 left font ",8" textcolor rgb grey
set label 2 sprintf("on the line it would be %.0f thousand pixels", (sixth - line_a[3])/line_b[3]*100) \
    at 10, sixth - 0.28 left font ",8" textcolor rgb grey
set label 3 " all of 800 by 600" at 480, graph 0.03 left font ",8" textcolor rgb grey
set label 4 sprintf("%.2f s + %.4f s a 1000 pixels,\noff by %.1f %%", line_a[3], line_b[3]/100, line_off[3]*100) at 130, 0.75 left textcolor rgb ink
unset key
plot areas(3) using ($1/1e3):2 with points lt 7, \
     line(x*1e3, line_a[3], line_b[3]) with lines lt 7
unset multiplot
