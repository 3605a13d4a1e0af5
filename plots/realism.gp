# Traced values and theory for a vessel of index 1.5 with a liquid of 1.33: lines are theory, points are traced.
# needs: tables/realism-curves.tsv vessel.ior=1.5 liquid.ior=1.33 measured
# needs: tables/realism-metrics.tsv metric measured
width = 1000; height = 660
load "plots/style.gp"

rows = table("realism-curves")
vessel = 1.5; liquid = 1.33
where(curve) = sprintf("vessel.ior=%g liquid.ior=%g curve=%s", vessel, liquid, curve)
curve(name) = select(rows, where(name), "x theory measured")
# The largest |measured - theory| of a curve, to one digit.
residual(name) = number(system(curve(name)[3:*]." | awk '{ e = $3 - $2; if (e < 0) e = -e; if (e > w) w = e } END { printf \"%g\", w }'"))
largest_error(name, unit) = sprintf("largest error %.0e%s", residual(name), unit)
metric(name, column) = first(table("realism-metrics"), sprintf("vessel.ior=%g liquid.ior=%g metric=%s", vessel, liquid, name), column)

set multiplot layout 2,3 margins 0.075,0.985,0.08,0.945 spacing 0.08,0.135
set label 1 at graph 0.97,0.07 right font ",9" textcolor rgb ink
set key top left font ",9"

set title sprintf("Fresnel: reflectance of glass, n = %g", vessel)
set xlabel "angle of incidence / deg"
set ylabel "reflectance"
set xrange [0:90]; set xtics 15
set yrange [0:1]
worst = residual("fresnel-s") > residual("fresnel-p") ? residual("fresnel-s") : residual("fresnel-p")
worst = worst > residual("fresnel") ? worst : residual("fresnel")
set label 1 sprintf("largest error %.0e", worst) at graph 0.04,0.66 left
set arrow 1 from atan(vessel)*180/pi, first 0.30 to atan(vessel)*180/pi, first 0.015 head size 1.5,25 filled lc rgb grey
set label 2 "Brewster" at atan(vessel)*180/pi, first 0.335 center font ",9" textcolor rgb grey
plot curve("fresnel-s") using 1:2 with lines lt 1 notitle, "" using 1:3 every 10 with points lt 1 title "s-polarised, R_s", \
     curve("fresnel") using 1:2 with lines lt 3 notitle, "" using 1:3 every 10 with points lt 3 title "unpolarised, R", \
     curve("fresnel-p") using 1:2 with lines lt 2 notitle, "" using 1:3 every 10 with points lt 2 title "p-polarised, R_p"
unset arrow 1; unset label 2

set title "The filled vessel as a lens"
set xlabel "offset from the axis / scene units"
set ylabel "deviation / deg"
set xrange [0:1]; set xtics 0.2
set yrange [0:*]
set label 1 largest_error("deviation", " deg") at graph 0.97,0.07 right
power = metric("lens.power", "measured")
plot curve("deviation") using 1:2 with lines lt 1 title "theory", "" using 1:3 every 10 with points lt 1 title "traced", \
     [0:0.75] power*x*180/pi with lines lt 7 title sprintf("thin lens, focal length %.2f", 1/power)

set title "Displacement of the rod's left edge"
set xlabel "refractive index of the liquid"
set ylabel "displacement / px"
set xrange [1:1.6]; set xtics 0.1
set yrange [0:*]
set label 1 largest_error("edges", " px")
plot curve("edges") using 1:2 with lines lt 1 title "theory", "" using 1:3 every 3 with points lt 1 title "traced"

set title "Series of a slab, cut at a depth"
set xlabel "recursion depth"
set ylabel "light cut off, fraction" offset 0.8,0
set xrange [-0.5:10.5]; set xtics 2
set logscale y
set yrange [1e-15:30]
set format y "10^{%T}"
set ytics 1e3
whole = number(system(curve("depth")[3:*]." | tail -n 1 | cut -f 2"))
set label 1 largest_error("depth", "") at graph 0.04,0.07 left
set key top right
plot curve("depth") using 1:(1 - $2/whole) with steps lt 1 notitle, NaN with lines lt 1 title "theory", \
     "" using 1:(abs(1 - $3/whole)) with points lt 1 title "traced"
unset logscale y
set format y "%h"
set ytics autofreq

set title "Absorption in the liquid"
set xlabel "length / m"
set ylabel "transmittance, red"
set xrange [0:0.92]; set xtics 0.2
set yrange [0:1.03]
set label 1 largest_error("absorption", "")
plot curve("absorption") using 1:2 with lines lt 2 title "theory, exp(-ad)", "" using 1:3 every 6 with points lt 2 title "traced"

set title "Residuals: |traced − theory|"
set xlabel "fraction of the x range"
set ylabel "error, in the curve's unit" offset 0.8,0
set xrange [0:1]; set xtics 0.2
set logscale y
set yrange [1e-17:1e-6]
set format y "10^{%T}"
set ytics 1e2
set label 1 "errors other than 0" at graph 0.97,0.62 right
set key top left maxrows 3 samplen 1 width 1
# Fraction of the x range, and the error where it is not 0.
left = "{ x[NR] = $1; e[NR] = $3 < $2 ? $2 - $3 : $3 - $2 } " \
    ."END { for (i = 1; i <= NR; i++) if (e[i]) print (x[i] - x[1])/(x[NR] - x[1]) \"\t\" e[i] }"
error(name) = sprintf("%s | awk '%s'", curve(name), left)
plot error("edges") with points lt 4 ps 0.6 title "edge / px", \
     error("deviation") with points lt 1 ps 0.6 title "deviation / deg", \
     error("depth") with points lt 5 ps 0.6 title "slab", \
     error("fresnel") with points lt 3 ps 0.6 title "R", \
     error("absorption") with points lt 2 ps 0.6 title "absorption"
unset multiplot
