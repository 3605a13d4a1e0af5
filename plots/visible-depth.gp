# Which recursion depth can be seen: FLIP of each depth against depth 64, for four scenes at one size with 16 samples a
# pixel; the sky continues the rays at the depth limit. Short lines at the right: what black instead of the sky changes
# at depth 64, the accuracy of the references; errors below it are left out.
# needs: tables/visible-depth.tsv tables/visible-lens.tsv tables/visible-window.tsv tables/visible-coin.tsv
width = 318; height = 215
load "plots/style.gp"

studies = "visible-depth visible-lens visible-window visible-coin"
flip(i) = select(table(word(studies, i)), "render.beyond=sky", "render.depth flip")
floor_of(i) = first(table(word(studies, i)), "render.beyond=black render.depth=64", "flip")
unset label 9999
set lmargin at screen 0.125; set rmargin at screen 0.985; set tmargin at screen 0.98; set bmargin at screen 0.17
set key off
set tics font ",7"
set logscale y
set format y "10^{%T}"
set xrange [-0.5:34]
set yrange [1e-4:0.25]
set xtics 0,4,32
set mxtics 4
set xlabel "recursion depth" offset 0,0.4
set ylabel "FLIP against depth 64" offset 1,0
array spot_x[4] = [3.5, 6.5, 4.5, 2.6]
array spot_y[4] = [0.14, 0.032, 0.0041, 0.0005]
array name[4] = ["rod in a vessel", "glass of water", "empty glass", "coin in a cup:\n0 from depth 3 on"]
do for [i=1:4] {
    set label i name[i] at spot_x[i],spot_y[i] left font ",7" textcolor lt i
    if (floor_of(i) > 1e-4) { set arrow i from 29,floor_of(i) to 34,floor_of(i) nohead lt i lw 1 dt (2,2) }
}
set label 9 "accuracy of\nthe references" at 34,0.0042 right font ",7" textcolor rgb grey
set arrow 9 from graph 0, first 0.01 to graph 1, first 0.01 nohead dt (6,3) lc rgb pale
plot for [i=1:4] flip(i) using 1:($2 > floor_of(i) ? $2 : NaN) with linespoints lt i ps 0.8
