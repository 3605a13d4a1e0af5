# Two maps over the refractive indices of vessel and liquid, as contours: FLIP against the image without refraction, and
# the magnification of the rod in the image.
# needs: tables/visible-grid.tsv flip
# needs: tables/visible-grid-metrics.tsv metric=edges.magnification measured
width = 318; height = 190
load "plots/style.gp"

flip = select(table("visible-grid"), "", "liquid.ior vessel.ior flip")
magnification = select(table("visible-grid-metrics"), "metric=edges.magnification", "liquid.ior vessel.ior measured")
unset label 9999
# Lines of one vessel are a block: a blank line between them makes a grid.
grid_of(command) = command." | sort -k 2,2g -k 1,1g | awk 'NR > 1 && $2 != last { print \"\" } { last = $2; print }'"
set datafile separator whitespace
set multiplot layout 1,2 margins 0.12,0.985,0.19,0.9 spacing 0.075,0
set contour base
unset surface
set view map
set key off
unset colorbox
unset grid
set border 15
set tics font ",7"
set xrange [1:1.7]
set yrange [1:2.4]
set xtics 0.2
set ytics 0.4
set xlabel "index of the liquid" offset 0,0.4
set ylabel "index of the vessel" offset 0.6,0
set title font ",7.5" offset 0,-0.8
set style textbox opaque noborder fillcolor rgb "#ffffff" margins 0.2,0.2
set cntrlabel onecolor start 2 interval 1000 font ",6.6"
set cntrparam levels incremental 0.01,0.01,0.09
set title "FLIP against no refraction"
splot grid_of(flip) using 1:2:3 with lines lc rgb blue lw 1.2, grid_of(flip) using 1:2:3 with labels boxed
unset ylabel
set cntrlabel onecolor start 4 interval 1000 font ",6.6"
set format y ""
set cntrparam levels incremental 1.1,0.1,1.9
set title "magnification of the rod"
splot grid_of(magnification) using 1:2:3 with lines lc rgb blue lw 1.2, \
      grid_of(magnification) using 1:2:3 with labels boxed
unset multiplot
