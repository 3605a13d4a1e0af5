# Throughput cut off at the depth limit, and the rays by kind, by recursion depth.
# needs: tables/depth.tsv rays_camera
width = 1000; height = 430
load "plots/style.gp"

rows = table("depth")
set multiplot layout 1,2 margins 0.08,0.985,0.13,0.92 spacing 0.11
set xlabel "recursion depth"
set xrange [-0.5:largest(rows, "render.depth") + 0.5]
set xtics 1

set title "Light cut off at the depth limit"
set ylabel "mean throughput cut off / camera ray"
set logscale y
set format y "10^{%T}"
unset key
plot select(rows, "", "render.depth cut_depth_throughput rays_camera") using 1:($2 > 0 ? $2/$3 : NaN) with linespoints lt 1

unset logscale y
set format y "%h"
set yrange [0:*]
set title "Rays by kind"
set ylabel "rays / 10^6"
set key top left invert
set boxwidth 0.62
kinds = select(rows, "", "render.depth rays_camera rays_refract rays_reflect rays_shadow")
plot kinds using 1:(($2 + $3 + $4 + $5)/1e6) with boxes lc rgb 0xB0B0B0 title "shadow", \
     kinds using 1:(($2 + $3 + $4)/1e6) with boxes lc rgb vermillion title "reflected", \
     kinds using 1:(($2 + $3)/1e6) with boxes lc rgb sky title "refracted", \
     kinds using 1:($2/1e6) with boxes lc rgb blue title "camera"
unset multiplot
