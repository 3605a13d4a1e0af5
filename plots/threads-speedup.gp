# Speed-up by threads for each schedule, with the ideal line and the published numbers. The ends of an interval combine
# those of both times, so it contains the speed-up if both contain their medians.
# needs: tables/threads.tsv wall_s_median
width = 1000; height = 760
load "plots/style.gp"

rows = table("threads")
schedules = "columns rows tiles dynamic"
together(n) = units > 0 && n > units ? units : n
times(schedule) = select(rows, "render.schedule=".schedule, "render.threads wall_s_median wall_s_low? wall_s_high?")
published_1 = first(published."threads.csv", "threads=1", "wall_s")

set label 100 remarks("threads") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 2,2 margins 0.07,0.97,0.09,0.955 spacing 0.1,0.12
set logscale x 2
set xrange [0.9:1140]
set xtics rotate by 0 1,4
set yrange [0:1.7*(units > 5 ? units : 5)]
set samples 401
set key top left font ",9" spacing 1.05
do for [i=1:4] {
    schedule = word(schedules, i)
    one = first(rows, "render.threads=1 render.schedule=".schedule, "wall_s_median")
    one_low = first(rows, "render.threads=1 render.schedule=".schedule, "wall_s_low")
    one_high = first(rows, "render.threads=1 render.schedule=".schedule, "wall_s_high")
    set title "schedule: ".schedule
    set xlabel (i > 2 ? "threads" : "")
    set ylabel (i % 2 ? "speed-up" : "")
    plot together(x) lt 8 title units > 0 ? sprintf("ideal on %d units, min(n, %d)", units, units) : "ideal", \
         select(published."threads.csv", "", "threads wall_s") using 1:(published_1/$2) with linespoints lt 7 title published_name, \
         times(schedule) using 1:(one/$2):(one_low/$4):(over(one_high, $3)) with yerrorbars lt i title "measured, wall"
    unset label 100
}
unset multiplot
