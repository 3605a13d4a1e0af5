# Error by time of ray casting, Whitted ray tracing and path tracing, on logarithmic axes.
# needs: tables/methods.tsv render.integrator=path wall_s_median error_rms
width = 760; height = 560
load "plots/style.gp"

rows = table("methods")
noise = first(rows, "cell=0", "reference_noise_rms")
method(name) = select(rows, "render.integrator=".name, "wall_s_median error_rms render.paths")
times(name) = select(rows, "render.integrator=".name, "wall_s_median wall_s_min wall_s_max error_rms")
# Monte Carlo convergence: error^2 times time is constant, here its geometric mean.
law_mean = NaN
if (has_rows(method("path")." | awk '$1*$2 > 0'")) {
    stats method("path") using (log($2*sqrt($1))) nooutput name "law"
}
law(t) = exp(law_mean)/sqrt(t)
set margins screen 0.11, screen 0.97, screen 0.115, screen 0.925
set title "Time and error of three methods"
set xlabel "wall time of a frame / s"
set ylabel "rms error against the reference, linear"
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set key top right

set arrow 1 from graph 0, first noise to graph 1, first noise nohead dt (2,3) lc rgb grey
set label 100 remarks("methods") at screen 0.015,0.022 left font ",8" textcolor rgb grey
set label 1 sprintf("noise of the reference, %.2g", noise) at graph 0.015, first noise*1.13 left font ",8" textcolor rgb grey
plot law(x) with lines lt 8 lw 1.2 title "1 / √N", \
     times("path") using 1:4:2:3 with xerrorlines lt 1 title "path tracing, N paths / pixel", \
     times("whitted") using 1:4:2:3 with xerrorbars lt 2 ps 1.3 title "Whitted, depth 8", \
     times("raycast") using 1:4:2:3 with xerrorbars lt 3 ps 1.3 title "ray casting", \
     method("path") using 1:2:(sprintf("N = %d", $3)) with labels left offset 0.9,0.5 font ",9" textcolor rgb blue notitle
