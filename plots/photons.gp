# Error by time of random paths alone and with photons, on logarithmic axes.
# needs: tables/photons.tsv wall_s_median error_rms
width = 760; height = 480
load "plots/style.gp"

rows = table("photons")
noise = first(rows, "cell=0", "reference_noise_rms")
method(caustics) = select(rows, "render.caustics=".caustics, "wall_s_median wall_s_min wall_s_max error_rms render.paths")
set margins screen 0.11, screen 0.97, screen 0.135, screen 0.91
set title "Paths alone and with 200 000 photons, for a lamp of radius 0.4"
set xlabel "wall time of a frame / s"
set ylabel "rms error against the reference, linear"
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set key top right

set arrow 1 from graph 0, first noise to graph 1, first noise nohead dt (2,3) lc rgb grey
set label 100 remarks("photons") at screen 0.015,0.022 left font ",8" textcolor rgb grey
set label 1 sprintf("noise of the reference, %.2g", noise) at graph 0.015, first noise*1.13 left font ",8" textcolor rgb grey
plot method("off") using 1:4:2:3 with xerrorlines lt 1 title "paths alone, N a pixel", \
     method("photons") using 1:4:2:3 with xerrorlines lt 2 title "with photons", \
     method("off") using 1:4:(sprintf("N = %d", $5)) with labels left offset 0.9,0.5 font ",9" notitle, \
     method("photons") using 1:4:(sprintf("N = %d", $5)) with labels left offset 0.9,0.5 font ",9" notitle
