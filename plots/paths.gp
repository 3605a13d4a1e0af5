# Error of random paths against time: the default sampler, the earlier one, and Blender's Cycles, on five scenes.
# needs: tables/paths.tsv time_s error
width = 1000; height = 620
load "plots/style.gp"

rows = table("paths")
curve(scene, settings) = select(rows, "scene=".scene." settings=".settings, "time_s error")
scenes = "matte glass room models lights64"
titles = "'Matte solids' 'Glass sphere' 'Room with a lamp in glass' 'Meshes' '64 lights'"
set multiplot layout 2,3 margins 0.075,0.985,0.085,0.95 spacing 0.075,0.14
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set key bottom left
do for [i=1:5] {
    set title word(titles, i)
    set xlabel (i > 3 ? "CPU time, s" : "")
    set ylabel (i % 3 == 1 ? "RMS error of a film value" : "")
    if (has_rows(select(rows, "scene=".word(scenes, i), "time_s error"))) {
        plot curve(word(scenes, i), "old") using 1:2 with linespoints lt 7 title "before", \
             curve(word(scenes, i), "new") using 1:2 with linespoints lt 1 title "now", \
             curve(word(scenes, i), "cycles") using 1:2 with linespoints lt 2 title "Cycles"
    } else {
        @empty
    }
}
unset multiplot
