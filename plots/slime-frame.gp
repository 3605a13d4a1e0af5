# Time of visibility queries in a frame of the slime, and its fraction of the frame, by level and hierarchy, for a ball
# and a stretched slime.
# needs: tables/slime-frame.tsv visibility_s_sum_median
width = 1000; height = 430
load "plots/style.gp"

rows = table("slime-frame")
hierarchies = "none sphere octant bvh"
names = "'no hierarchy' 'one sphere' 'octant tree of spheres' 'BVH of boxes'"
moments = "0 0.5"
frames(i, m) = select(rows, sprintf("render.accel=%s toy.time_s=%s", word(hierarchies, i), word(moments, m)), \
    "triangles visibility_s_sum_median wall_s_median rays_total")
set label 100 remarks("slime-frame") at screen 0.5,0.02 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.07,0.985,0.15,0.93 spacing 0.1
set logscale x
set xlabel "triangles n"
set format x "10^{%T}"
set xrange [15:5e5]
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set title "Visibility queries"
set ylabel "time per ray / ns"
set logscale y
set format y "10^{%T}"
set key top left
plot for [i=1:4] frames(i, 1) using 1:($2/$4*1e9) with linespoints lt i title word(names, i), \
     for [i=1:4] frames(i, 2) using 1:($2/$4*1e9) with linespoints lt i dt (6,3) notitle, \
     NaN with lines lc rgb ink lw 1.6 title "a ball", NaN with lines lc rgb ink lw 1.6 dt (6,3) title "stretched"
unset label 100
unset logscale y
set format y "%h"
set title "Share of the frame"
set ylabel "fraction of the wall time / %"
set yrange [0:100]
set key off
plot for [i=1:4] frames(i, 1) using 1:($2/$3*100) with linespoints lt i, \
     for [i=1:4] frames(i, 2) using 1:($2/$3*100) with linespoints lt i dt (6,3)
unset multiplot
