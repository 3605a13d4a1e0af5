# Tests of a ray against the number of triangles: the counts, the local exponent between successive counts, and the time
# of a test against the memory of the hierarchy. One column of the paper.
# needs: tables/query-tests.tsv scene hierarchy triangles tests
# needs: tables/query-exponents.tsv scene hierarchy triangles exponent
# needs: tables/query-times.tsv hierarchy accel_bytes ns_median ns_min ns_max l2_bytes? l3_bytes?
width = 318; height = 520
load "plots/style.gp"

of(scene, tree) = "scene=".scene." hierarchy=".tree
tests(scene, tree) = select(table("query-tests"), of(scene, tree), "triangles tests")
set border 3
set lmargin at screen 0.135; set rmargin at screen 0.985
set xtics font ",7"; set ytics font ",7"
set xlabel font ",7.5" offset 0,0.6; set ylabel font ",7.5" offset 1.2,0
set grid xtics ytics lc rgb pale lw 0.4 dt solid
unset key
set multiplot

set logscale xy
set xrange [800:3e7]
set format x ""
set tmargin at screen 0.985; set bmargin at screen 0.595
set ylabel "tests a camera ray"
set yrange [20:1500]
set ytics (10, 20, 50, 100, 200, 500, 1000, 2000)
set xtics (1e3, 1e4, 1e5, 1e6)
last(scene, tree) = number(system(tests(scene, tree)[3:*]." | tail -n 1 | cut -f 2"))
do for [i=1:4] {
    y = last(word("sparse sparse sphere sphere", i), word("octant bvh octant bvh", i))
    if (y == y) {
        set label i word("'octants, soup' 'BVH, soup' 'octants, surface' 'BVH, surface'", i) at (i % 2 ? 1.25e6 : 4.8e6),y*(i % 2 ? 1.12 : 1) left noenhanced \
            font ",6.8" textcolor rgb (i % 2 ? vermillion : blue)
    }
}
plot for [i=1:4] tests(word("sparse sparse sphere sphere", i), word("octant bvh octant bvh", i)) \
         using 1:2 with linespoints pt (i < 3 ? (i % 2 ? 5 : 7) : (i % 2 ? 4 : 6)) ps 0.55 lw 0.8 lc rgb (i % 2 ? vermillion : blue)
unset label; unset arrow

set tmargin at screen 0.575; set bmargin at screen 0.375
unset logscale y
set format x "10^{%T}"
set ytics auto font ",7"
set ytics 0.1
set yrange [0:0.6]
set ylabel "local exponent"
set xlabel "triangles n"
set arrow 1 from 800,1.0/3 to 4.5e6,1.0/3 nohead lc rgb ink lw 0.8 dt (2,3)
set label 1 "1/3" at 4.8e6,1.0/3 left font ",6.8"
plot for [i=1:4] select(table("query-exponents"), \
         of(word("sparse sparse sphere sphere", i), word("octant bvh octant bvh", i)), "triangles exponent") using 1:2 with linespoints pt (i < 3 ? (i % 2 ? 5 : 7) : (i % 2 ? 4 : 6)) ps 0.5 lw 0.8 \
         lc rgb (i % 2 ? vermillion : blue)
unset label; unset arrow

set tmargin at screen 0.29; set bmargin at screen 0.075
set logscale xy
set xrange [5e5:2e9]
set xtics ("1 MiB" 1048576, "10 MiB" 10485760, "100 MiB" 104857600, "1 GiB" 1073741824)
set format x "%h"
set xlabel "memory of the hierarchy"
set ylabel "ns a test"
set yrange [*:*]
set ytics auto
set ytics (0.5, 1, 2, 5, 10, 20, 50)
# Of the machine that measured the times.
l2 = first(table("query-times"), "", "l2_bytes"); l3 = first(table("query-times"), "", "l3_bytes")
if (l2 == l2) {
    set arrow 1 from l2,graph 0 to l2,graph 1 nohead lc rgb grey lw 0.8 dt (2,3)
    set label 1 " L2" at l2,graph 0.96 left font ",6.8" textcolor rgb grey
}
if (l3 == l3) {
    set arrow 2 from l3,graph 0 to l3,graph 1 nohead lc rgb grey lw 0.8 dt (2,3)
    set label 2 " L3" at l3,graph 0.96 left font ",6.8" textcolor rgb grey
}
plot for [i=1:2] select(table("query-times"), "hierarchy=".word("octant bvh", i), "accel_bytes ns_median ns_min ns_max") \
    using 1:2:3:4 with yerrorlines pt (i % 2 ? 5 : 7) ps 0.5 lw 0.8 lc rgb (i % 2 ? vermillion : blue)
unset multiplot
