# Time by the area that a model covers, with fitted lines (tables/laws.tsv), and the published times with their line.
# needs: tables/coverage.tsv first_hits.model cpu_s_median
# needs: tables/laws.tsv study=coverage a b deviation
width = 1000; height = 470
load "plots/style.gp"

# For the octant tree, the box tree and the published series, with the line fitted to each.
areas(i) = i < 3 ? select(table("coverage"), "render.accel=".word("octant bvh", i), "first_hits.model cpu_s_median cpu_s_min cpu_s_max") : \
    select("experiments/published/coverage.csv", "", "pixels time_s")
line(pixels, a, b) = a + b*pixels/1e5
array line_a[3]; array line_b[3]; array line_off[3]
do for [i=1:3] {
    of = "study=coverage series=".word("octant bvh published", i)
    line_a[i] = first(table("laws"), of, "a"); line_b[i] = first(table("laws"), of, "b")
    line_off[i] = first(table("laws"), of, "deviation")
}
names = "'octant tree of spheres' 'BVH of boxes'"
set label 100 remarks("coverage") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.075,0.985,0.13,0.92 spacing 0.1
set xlabel "covered pixels / 1000"
set xrange [0:*]
set yrange [0:*]
set ylabel "CPU time of a frame / ms"
set title "A ball of 40500 triangles"
set key top left spacing 2.3
set offsets graph 0, graph 0, graph 0.25, graph 0
plot for [i=1:2] areas(i) using ($1/1e3):($2*1e3):($3*1e3):($4*1e3) with yerrorbars lt i + 2 \
         title sprintf("%s:\n%.0f ms + %.2f ms / 1000 pixels, rms deviation %.1f %%", word(names, i), line_a[i]*1e3, line_b[i]*10, line_off[i]*100), \
     for [i=1:2] line(x*1e3, line_a[i], line_b[i])*1e3 with lines lt i + 2 notitle
unset label 100

unset offsets
set title "Published: 40000 triangles, 800 by 600 pixels"
set ylabel "time / s"
set yrange [0:8]
set label 1 "0: nothing covered (our reading)" at 12, line_a[3] - 0.35 left font ",8" textcolor rgb grey
set label 2 "480: the whole image " \
    at 480, line(480e3, line_a[3], line_b[3]) + 0.4 right font ",8" textcolor rgb grey
plot areas(3) using ($1/1e3):2 with points lt 7 \
         title sprintf("published:\n%.2f s + %.2f ms / 1000 pixels, rms deviation %.1f %%", \
             line_a[3], line_b[3]*10, line_off[3]*100), \
     line(x*1e3, line_a[3], line_b[3]) with lines lt 7 notitle
unset multiplot
