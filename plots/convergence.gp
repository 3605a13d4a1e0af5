# Error against the reference, light cut at the depth limit, and time, by recursion depth. A depth is sufficient from
# the first one whose mean FLIP error is below 0.01.
# needs: tables/convergence.tsv error_rms flip wall_s_median
width = 1000; height = 480
load "plots/style.gp"

rows = table("convergence")
of(beyond, columns) = select(rows, "render.beyond=".beyond, "render.depth ".columns)
enough(beyond) = number(system(of(beyond, "flip")[3:*]." | awk '$2 < 0.01 { print $1; exit }'"))
words_of = "sky black"
set label 100 remarks("convergence") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.08,0.985,0.125,0.92 spacing 0.105
set xlabel "recursion depth"
set xrange [-0.5:24.5]
set xtics 0,4,24
set mxtics 4
set logscale y
set format y "10^{%T}"

# Sufficient depths, in both panels.
do for [i=1:2] {
    depth = enough(word(words_of, i))
    if (depth == depth) {
        set arrow i from depth, graph 0 to depth, graph 0.66 nohead dt (2,3) lc rgb grey back
        set label i sprintf("%s: %d ", word(words_of, i), depth) at depth, graph 0.03 right font ",8" textcolor rgb grey
    }
}
set title "Error, and light cut at the depth limit"
set ylabel "error, or throughput cut / camera ray"
set yrange [1e-3:1]
set arrow 3 from graph 0, first 0.01 to graph 1, first 0.01 nohead dt (2,3) lc rgb grey back
set label 3 "FLIP 0.01: sufficient" at graph 0.99, first 0.0113 right font ",8" textcolor rgb grey
set key top right Right noreverse samplen 2.6
plot of("black", "error_rms") using 1:2 with linespoints lt 1 pt 6 dt (6,3) title "rms, black beyond the limit", \
     of("sky", "error_rms") using 1:2 with linespoints lt 1 title "rms, sky beyond the limit", \
     of("black", "flip") using 1:2 with linespoints lt 2 pt 4 dt (6,3) title "FLIP, black", \
     of("sky", "flip") using 1:2 with linespoints lt 2 title "FLIP, sky", \
     of("sky", "cut_depth_throughput rays_camera") using 1:($2/$3) with linespoints lt 3 title "light cut off"

unset label 100
unset arrow 3
unset label 3
set title "Time of a frame"
set ylabel "wall time (median, minimum, maximum) / s"
set yrange [*:*]
set key top left Left reverse
plot of("sky", "wall_s_median wall_s_min wall_s_max") using 1:2:3:4 with yerrorlines lt 1 title "sky beyond the limit", \
     of("black", "wall_s_median wall_s_min wall_s_max") using 1:2:3:4 with yerrorlines lt 1 pt 6 dt (6,3) title "black"
unset multiplot
