# Time of a step of the slime by masses, integrator and threads, and simulated time per second.
# needs: tables/slime-step.tsv motion_s_median
width = 1000; height = 430
load "plots/style.gp"

rows = table("slime-step")
integrators = "euler implicit"
names = "'semi-implicit Euler' 'backward Euler'"
threads = system(select(rows, "", "toy.threads")[3:*]." | sort -gu | tr '\\n' ' '")
masses(level) = 10*4**level + 2
steps(i, t) = select(rows, sprintf("toy.integrator=%s toy.threads=%s", word(integrators, i), word(threads, t)), \
    "toy.level motion_s_median motion_steps toy.time_s")
kind(i, t) = i == 1 ? t : t + 2
set label 100 remarks("slime-step") at screen 0.5,0.02 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.07,0.985,0.15,0.93 spacing 0.1
set logscale xy
set xlabel "masses n"
set format x "10^{%T}"
set format y "10^{%T}"
set xrange [8:3e5]
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set title "Time of a step"
set ylabel "wall time of a step / s"
set key top left
plot for [i=1:2] for [t=1:words(threads)] steps(i, t) using (masses($1)):($2/$3) with linespoints lt kind(i, t) \
         title sprintf("%s, %s thread%s", word(names, i), word(threads, t), word(threads, t) eq "1" ? "" : "s")
unset label 100
set title "Simulated time, steps of half the stable length"
set ylabel "simulated / wall time"
set key off
set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead dt (2,3) lc rgb grey
set label 1 "real time" at graph 0.985, first 1.8 right font ",8" textcolor rgb grey
plot for [i=1:2] for [t=1:words(threads)] steps(i, t) using (masses($1)):($4/$2) with linespoints lt kind(i, t)
unset multiplot
