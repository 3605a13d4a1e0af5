# Time by recursion depth with 95% intervals, and rays on the second axis; growth since depth 0 compared with the
# published one.
# needs: tables/depth.tsv wall_s_median cpu_s_median
width = 1000; height = 430
load "plots/style.gp"

rows = table("depth")
times(v) = select(rows, "", sprintf("render.depth %s_median %s_low? %s_high?", v, v, v))
cpu_0 = first(rows, "render.depth=0", "cpu_s_median")
rays_0 = first(rows, "render.depth=0", "rays_total")
published_0 = first(published."depth.csv", "depth=0", "cpu_s")

set label 100 remarks("depth") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.08,0.985,0.13,0.92 spacing 0.15
set xlabel "recursion depth"
set xrange [-0.5:largest(rows, "render.depth") + 0.5]
set xtics 1

set title "Time and rays of a frame"
set ylabel "time / s"
set yrange [0:*]
set y2label "rays / 10^6"
set y2range [0:*]
set y2tics
set border 11
set boxwidth 0.62
plot select(rows, "", "render.depth rays_total") using 1:($2/1e6) axes x1y2 with boxes lc rgb pale title "rays (right axis)", \
     times("wall_s") using 1:2:3:4 with yerrorlines lt 1 title "wall, median", \
     times("cpu_s") using 1:2:3:4 with yerrorlines lt 2 pt 4 dt (4,2) title "CPU, median"
unset label 100

unset y2tics
unset y2label
set border 3
set title "Growth from depth 0 on"
set ylabel "relative to depth 0"
set logscale y
set yrange [0.5:*]
plot times("cpu_s") using 1:($2/cpu_0):($3/cpu_0):($4/cpu_0) with yerrorlines lt 2 title "CPU time", \
     select(rows, "", "render.depth rays_total") using 1:($2/rays_0) with linespoints lt 3 title "rays", \
     select(published."depth.csv", "", "depth cpu_s") using 1:($2/published_0) with linespoints lt 7 \
         title "CPU time, published (thread count not given)"
unset multiplot
