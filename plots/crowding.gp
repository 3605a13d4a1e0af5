# Time by the number of triangles in a cube of fixed size, for each hierarchy, and the growth since 10000 compared
# with the published one.
# needs: tables/crowding.tsv soup.count cpu_s_median
width = 1000; height = 450
load "plots/style.gp"

rows = table("crowding")
hierarchies = "none sphere octant bvh"
names = "'no hierarchy' 'one sphere' 'octant tree of spheres' 'BVH of boxes'"
times(i) = select(rows, "render.accel=".word(hierarchies, i), "soup.count cpu_s_median cpu_s_min cpu_s_max")
first_of(i) = first(rows, "soup.count=10000 render.accel=".word(hierarchies, i), "cpu_s_median")
published_first = first(published."crowding.csv", "triangles=10000", "time_s")

set label 100 remarks("crowding") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.08,0.985,0.14,0.92 spacing 0.11
set xlabel "triangles n / 1000"
set xrange [5:55]
set title "Triangles up to a quarter as wide as the cube"
set ylabel "CPU time of a frame / s"
set logscale y
set format y "10^{%T}"
plot for [i=1:4] times(i) using ($1/1e3):2:3:4 with yerrorlines lt i title word(names, i)
unset label 100
unset logscale y
set format y "%h"
set title "Growth from 10000 on"
set ylabel "relative to 10000 triangles"
set yrange [0:*]
plot x/10 with lines lt 8 title "proportional to n", \
     for [i=1:4] times(i) using ($1/1e3):($2/first_of(i)):($3/first_of(i)):($4/first_of(i)) with yerrorlines lt i title word(names, i), \
     select(published."crowding.csv", "", "triangles time_s")." | awk '$1 > 0'" using ($1/1e3):($2/published_first) \
         with linespoints lt 7 title "published, octant tree"
unset multiplot
