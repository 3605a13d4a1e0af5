# Effect of polarisation: transmittance of a stack of two plates by angle, with s and p traced separately or averaged
# at every
# interface, and the image of the rod in the vessel with polarisation minus that without.
# needs: tables/polarisation-metrics.tsv metric=stack.straight measured
# needs: tables/polarised.tsv render.polarisation=on flip
# needs: tables/polarised.tsv render.polarisation=off cell
# needs: polarised/images/0000.png
# needs: polarised/images/0001.png
# needs: polarised/images/0000.pfm
# needs: polarised/images/0001.pfm
width = 1000; height = 820
load "plots/style.gp"

rows = table("polarisation-metrics")
n = 1.5
# Power reflectances of an interface, Hecht, Optics, 4.6.2; i and t are the angles of incidence and of refraction, x
# is i in deg.
i(x) = x*pi/180
t(x) = asin(sin(i(x))/n)
R_s(x) = ((cos(i(x)) - n*cos(t(x)))/(cos(i(x)) + n*cos(t(x))))**2
R_p(x) = ((n*cos(i(x)) - cos(t(x)))/(n*cos(i(x)) + cos(t(x))))**2
R(x) = (R_s(x) + R_p(x))/2
# Straight through four interfaces; through two plates with all reflections: Stokes, Proc. R. Soc. 11, 545 (1862).
straight(R) = (1 - R)**4
whole(R) = (1 - R)/(1 + 3*R)
traced(how, metric) = select(rows, sprintf("render.polarisation=%s metric=%s", how, metric), "plate1.rotation.y measured tolerance")
worst(how, metric) = number(system(select(rows, sprintf("render.polarisation=%s metric=%s", how, metric), "error")[3:*]." | sort -g | tail -n 1"))
larger(a, b) = a > b ? a : b

set multiplot
set xrange [0:90]
set xtics 15
set yrange [0:1]
set xlabel "angle of incidence / deg"
set ylabel "transmittance"
set key bottom left
set tmargin at screen 0.955
set bmargin at screen 0.6
panel(left, right) = sprintf("set lmargin at screen %g; set rmargin at screen %g", left, right)

eval panel(0.07, 0.49)
set title "Two plates without reflections, n = 1.5"
set label 1 sprintf("largest error %.0e", larger(worst("on", "stack.straight"), worst("off", "stack.straight"))) at graph 0.03,0.4 left font ",9"
set samples 400
plot (straight(R_s(x)) + straight(R_p(x)))/2 with lines lt 1 notitle, \
     traced("on", "stack.straight") using 1:2 with points lt 1 title "polarisation on: s and p separate", \
     straight(R(x)) with lines lt 2 notitle, \
     traced("off", "stack.straight") using 1:2 with points lt 2 title "off: their mean at every interface", \
     NaN with lines lc rgb ink dt solid title "theory"

eval panel(0.57, 0.985)
set xrange [60:90]
set xtics 5
set yrange [0:0.8]
set title "With all reflections between the faces"
set label 1 "bars: plus the light\ncut off at depth 16" at graph 0.03,0.42 left font ",9"
plot (whole(R_s(x)) + whole(R_p(x)))/2 with lines lt 1 notitle, \
     traced("on", "stack.whole") using 1:2:2:($2 + $3) with yerrorbars lt 1 title "polarisation on", \
     whole(R(x)) with lines lt 2 notitle, \
     traced("off", "stack.whole") using 1:2:2:($2 + $3) with yerrorbars lt 2 title "off", \
     NaN with lines lc rgb ink dt solid title "theory"
unset label

rod = table("polarised")
float_image(cell) = sprintf("%s/polarised/images/%04d.pfm", results, cell)
on(name) = first(rod, "render.polarisation=on", name)
cell_of(how) = first(rod, "render.polarisation=".how, "cell")
side(axis) = real(word(pfm_line(float_image(0)), axis))
unset xlabel; unset ylabel
set xrange [*:*]; set yrange [*:*]
load "plots/image_panels.gp"
# Crop, the vessel and its shadow: fractions of the width from the left and of the height from the bottom.
set xrange [0.12*side(1):0.76*side(1)]
set yrange [0.10*side(2):0.98*side(2)]
set tmargin at screen 0.49
set bmargin at screen 0.012
set lmargin at screen 0.045
set rmargin at screen 0.43
set title "The rod in the vessel with polarisation"
plot image("polarised", cell_of("on")) binary filetype=png with rgbimage notitle

set lmargin at screen 0.445
set rmargin at screen 0.83
set title "minus the image without polarisation"
limit = 0.02
set palette defined @signed
set cbrange [-limit:limit]
set cbtics limit/2 format "%+.2f" scale 0.4 font ",9" textcolor rgb ink
set colorbox user origin 0.845,0.1 size 0.013,0.37
set cblabel "difference of luminance (white = 1)" font ",9" offset 0.8,0
set border 15 lc rgb pale
set label 1 sprintf("FLIP %.4f\nPSNR %.1f dB\nSSIM %.5f", on("flip"), on("psnr_db"), on("ssim")) at screen 0.84,0.065 left font ",9"
set datafile separator whitespace
plot sprintf("< plots/difference.sh '%s' '%s'", float_image(int(cell_of("on"))), float_image(int(cell_of("off")))) using 1:2:3 with image notitle
unset multiplot
