# Build time of the hierarchies with one thread and with two, their memory, and the rays traced per second.
# needs: tables/build.tsv build_s_median
width = 1000; height = 700
load "plots/style.gp"

rows = table("build")
hierarchies = "none sphere octant bvh"
names = "'no hierarchy' 'one sphere' 'octant tree of spheres' 'BVH of boxes'"
sets = "sparse dense sphere sparse dense sphere"
counts = "50000 50000 50000 500000 500000 500000"
# The value of a bar; NaN if there is no such cell.
bar(i, set, threads, column) = first(rows, sprintf("render.accel=%s soup.generate=%s soup.count=%s render.build_threads=%d", \
    word(hierarchies, i), word(sets, int(set)), word(counts, int(set)), threads), column)
half = 0.09
place(i, set) = set + 2*half*(i - 2.5)
set xrange [0.5:6.5]
set xtics ("sparse" 1, "dense" 2, "ball" 3, "sparse" 4, "dense" 5, "ball" 6) scale 0
set label 11 "50000 triangles" at graph 0.25, -0.15 center textcolor rgb ink
set label 12 "500000 triangles" at graph 0.75, -0.15 center textcolor rgb ink
set arrow 11 from 3.5, graph 0 to 3.5, graph 1 nohead lc rgb pale back
set logscale y
set format y "10^{%T}"

set label 100 remarks("build") at screen 0.5,0.008 center font ",8" textcolor rgb grey
set multiplot layout 2,2 margins 0.075,0.985,0.1,0.955 spacing 0.1,0.165
set samples 6
set boxwidth 1.8*half
unset key
do for [threads=1:2] {
    set title sprintf("Time to build, %d thread%s", threads, threads > 1 ? "s" : "")
    set ylabel "build time / s"
    plot for [i=1:4] [1:6] '+' using (place(i, $1)):(bar(i, $1, threads, "build_s_median")) with boxes lt i title word(names, i)
    unset label 100
}
unset logscale y
set format y "%h"
set title "Memory"
set ylabel "bytes / triangle"
set yrange [0:*]
set key top left maxrows 2 samplen 1
set offsets 0, 0, graph 0.2, 0
plot for [i=1:4] [1:6] '+' using (place(i, $1)):(bar(i, $1, 1, "accel_bytes")/bar(i, $1, 1, "triangles")) with boxes lt i title word(names, i)
unset key
unset offsets
set logscale y
set format y "10^{%T}"
set title "Rays, one thread"
set ylabel "rays / CPU second"
set yrange [*:*]
plot for [i=1:4] [1:6] '+' using (place(i, $1)):(bar(i, $1, 1, "rays_total")/bar(i, $1, 1, "cpu_s_median")) with boxes lt i
unset multiplot
