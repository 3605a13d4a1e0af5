# Wall and CPU time of a frame by the number of threads, for each schedule.
# needs: tables/threads.tsv wall_s_median cpu_s_median
width = 1000; height = 430
load "plots/style.gp"

rows = table("threads")
times(schedule, v) = select(rows, "render.schedule=".schedule, sprintf("render.threads %s_median %s_low? %s_high?", v, v, v))
schedules = "columns rows tiles dynamic"

set label 100 remarks("threads") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.08,0.985,0.14,0.92 spacing 0.1
set logscale x 2
set xlabel "threads"
set xrange [0.9:1140]
set xtics rotate by 0 1,4
set yrange [0:*]
set key bottom left
if (units > 0) {
    set arrow 1 from units, graph 0 to units, graph 1 nohead dt (2,3) lc rgb grey
    set label 1 sprintf(" %d units", units) at units, graph 0.97 left textcolor rgb grey
}
do for [v in "wall cpu"] {
    set title v eq "wall" ? "Wall time of a frame" : "CPU time of a frame"
    set ylabel (v eq "wall" ? "wall time / s" : "CPU time / s")
    plot for [i=1:words(schedules)] times(word(schedules, i), v."_s") using 1:2:3:4 with yerrorlines lt i title word(schedules, i)
    unset label 100
}
unset multiplot
