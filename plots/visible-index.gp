# Which error of a refractive index can be seen: how far it moves the edges of the rod in the image, for the observer of
# FLIP and for an eye at the camera, next to thresholds of acuity; and FLIP against the image with the right index.
# needs: tables/visible-index.tsv tables/visible-index-metrics.tsv
width = 318; height = 330
load "plots/style.gp"

moved(which) = sprintf("< awk -v which=%s -f plots/visible.awk '%s'", which, table("visible-index-metrics"))
rows = table("visible-index")
# The size of the error of one index and FLIP, for one sign of the error.
flips(which, right, other, value, sign) = select(rows, other.".ior=".value, which.".ior flip"). \
    sprintf(" | awk '{ e = %s * ($1 - %s); if (e > 1e-9) print e \"\\t\" $2 }' | sort -g", sign, right)

unset label 9999
set multiplot layout 2,1 margins 0.135,0.985,0.115,0.985 spacing 0,0.05
set logscale xy
set xrange [7e-5:0.15]
set key off
set tics font ",7"
set format x ""
set format y "10^{%T}"
set yrange [1e-3:4e3]
set ytics 10
set ylabel "shift of an edge / arc seconds" offset 1,0
set arrow 1 from graph 0, first 60 to graph 1, first 60 nohead dt (6,3) lc rgb grey
set arrow 2 from graph 0, first 5 to graph 1, first 5 nohead dt (2,3) lc rgb grey
set arrow 3 from 0.003, graph 0 to 0.003, graph 1 nohead dt (2,3) lc rgb pale
set label 1 "acuity, 60″" at 8e-5,95 left font ",7" textcolor rgb grey
set label 2 "vernier acuity, 5″" at 8e-5,7.8 left font ",7" textcolor rgb grey
set label 3 "1.33 for 1.333" at 0.0033,0.0018 left font ",7" textcolor rgb grey
along = 13.5 # degrees: the slope of proportionality in the panel
set label 4 "liquid, eye at the camera" at 5.2e-4,24 rotate by along left font ",7" textcolor rgb blue
set label 5 "liquid, 67 px a degree" at 1.1e-2,33 rotate by along left font ",7" textcolor rgb blue
set label 6 "vessel, eye at the camera" at 5.2e-4,0.21 rotate by along left font ",7" textcolor rgb vermillion
set label 7 "vessel, 67 px a degree" at 1.1e-2,0.36 rotate by along left font ",7" textcolor rgb vermillion
plot moved("liquid") using 1:4 with linespoints lt 1 pt 6, moved("liquid") using 1:3 with linespoints lt 1, \
     moved("vessel") using 1:4 with linespoints lt 2 pt 4, moved("vessel") using 1:3 with linespoints lt 2
do for [i=1:7] { unset label i }
unset arrow 1; unset arrow 2
set format x "10^{%T}"
set xlabel "error of the refractive index" offset 0,0.4
set ylabel "FLIP" offset 1,0
set yrange [2e-4:0.05]
set label 1 "liquid" at 0.008,0.0095 right font ",7" textcolor rgb blue
set label 2 "vessel" at 0.02,0.0045 left font ",7" textcolor rgb vermillion
set label 3 "solid: index too small; dashed: too large" at 8e-5,0.034 left font ",7" textcolor rgb grey
plot flips("liquid", "1.333", "vessel", "1.5", "-1") using 1:2 with linespoints lt 1, \
     flips("liquid", "1.333", "vessel", "1.5", "1") using 1:2 with linespoints lt 1 pt 6 dt (6,3), \
     flips("vessel", "1.5", "liquid", "1.333", "-1") using 1:2 with linespoints lt 2, \
     flips("vessel", "1.5", "liquid", "1.333", "1") using 1:2 with linespoints lt 2 pt 4 dt (6,3)
unset multiplot
