# Dispersion: minimum deviation of a prism and angle of the first rainbow by wavelength, with their closed forms, and
# images.
# needs: tables/dispersion-metrics.tsv metric=prism.own measured
# needs: tables/rainbow-metrics.tsv metric=rainbow.own measured
# needs: prism-portrait/images/0000.png
# needs: rainbow-portrait/images/0000.png
width = 1000; height = 860
load "plots/style.gp"
load "plots/media.gp"

prism = table("dispersion-metrics")
bow = table("rainbow-metrics")
traced(file, column, medium, metric) = select(file, sprintf("%s=%s metric=%s", column, medium, metric), "render.lambda_nm measured")
worst(file, metric) = number(system(select(file, "metric=".metric, "error")[3:*]." | sort -g | tail -n 1"))*180/pi

set multiplot
set xrange [390:720]
set xtics 50
set xlabel "wavelength / nm"
set border 3
# Fraunhofer lines.
fraunhofer = "F:486.1327 d:587.5618 C:656.2725"
do for [i=1:3] {
    line = word(fraunhofer, i)
    at = real(line[3:*])
    set arrow i from at, graph 0 to at, graph 1 nohead dt (2,3) lw 0.8 lc rgb grey back
    set label 10 + i line[1:1] at at, graph 1.02 center font ",9" textcolor rgb grey
}

set lmargin at screen 0.07
set rmargin at screen 0.49
set tmargin at screen 0.945
set bmargin at screen 0.56
set title "Minimum deviation of a prism of 60°" offset 0,0.4
set ylabel "deviation / deg"
set yrange [30:80]
set key at graph 0.99,0.66 right top Left reverse
set label 1 sprintf("largest error %.0e deg", worst(prism, "prism.own")) at graph 0.02,0.955 left font ",9"
plot least_deviation(n_sf11(x)) with lines lt 1 notitle, \
     traced(prism, "glass.medium", "sf11", "prism.own") using 1:($2*180/pi) with points lt 1 title "SF11, flint", \
     least_deviation(n_bk7(x)) with lines lt 2 notitle, \
     traced(prism, "glass.medium", "bk7", "prism.own") using 1:($2*180/pi) with points lt 2 title "BK7, crown", \
     least_deviation(n_silica(x)) with lines lt 3 notitle, \
     traced(prism, "glass.medium", "fused-silica", "prism.own") using 1:($2*180/pi) with points lt 3 title "fused silica", \
     NaN with lines lc rgb ink dt solid title "lines: Hecht 5.5.1, Sellmeier"

set lmargin at screen 0.07
set rmargin at screen 0.49
set tmargin at screen 0.445
set bmargin at screen 0.065
set title "Angle of the first rainbow"
set ylabel "angle from the antisolar point / deg"
set yrange [36:43]
set key at graph 0.99,0.64 right top
set label 1 sprintf("largest error %.0e deg", worst(bow, "rainbow.own"))
plot rainbow(n_water(x)) with lines lt 1 notitle, \
     traced(bow, "water.medium", "water", "rainbow.own") using 1:($2*180/pi) with points lt 1 title "water", \
     [476.5:720] rainbow(n_ethanol(x)) with lines lt 2 notitle, \
     [390:476.5] rainbow(n_ethanol(x)) with lines lt 2 dt (3,4) notitle, \
     traced(bow, "water.medium", "ethanol", "rainbow.own") using 1:($2*180/pi) with points lt 2 title "ethanol (dashed: extrapolated)", \
     NaN with lines lc rgb ink dt solid title "lines: Descartes, Sellmeier, Cauchy"

unset arrow; unset label; unset xlabel; unset ylabel
set xtics autofreq
load "plots/image_panels.gp"

# The non-empty part of the prism's image, in pixels from the left and from the bottom.
rendered = image("prism-portrait", 0)
set lmargin at screen 0.525
set rmargin at screen 0.995
set tmargin at screen 0.945
set bmargin at screen 0.56
set title "A slit through the prism of SF11, 96 wavelengths" offset 0,-0.5
set xrange [110:530]
set yrange [0:300]
set label 1 "a second slit,\nwithout the prism" at 312,275 left font ",9" textcolor rgb "white" front
set label 2 "seen through\nthe prism" at 208,100 right font ",9" textcolor rgb "white" front
set label 3 "reflected by\nthe base" at 449,185 left font ",9" textcolor rgb "white" front
plot rendered binary filetype=png with rgbimage notitle
unset label

# The drops: the height of a pixel in the image is its angle above the antisolar point.
rendered = image("rainbow-portrait", 0)
centre = 41.4; field = 2.9
angle(row) = centre + atan((2.0*row/png_height(rendered) - 1)*tan(field/2*pi/180))*180/pi
row(angle) = (1 + tan((angle - centre)*pi/180)/tan(field/2*pi/180))*png_height(rendered)/2
set lmargin at screen 0.6
set rmargin at screen 0.763
set tmargin at screen 0.445
set bmargin at screen 0.065
set title ""
set label 30 "Nine drops of water, and their glints enlarged" at screen 0.77,0.463 center font ",11"
set xrange [0:png_width(rendered)]
set yrange [0:png_height(rendered)]
set border 2 lc rgb ink
set ytics nomirror out scale 0.6 font ",9" textcolor rgb ink
set ytics ("40.5°" row(40.5), "41.0°" row(41.0), "41.5°" row(41.5), "42.0°" row(42.0), "42.5°" row(42.5))
plot rendered binary filetype=png with rgbimage notitle
unset border; unset ytics
unset label 30

# The glint of each drop enlarged, from the top drop down. The drops are 0.3 deg apart; a glint is near the lower
# edge, 0.866 of
# the radius below the center, or slightly less.
first_drop = 42.6; step = 0.3; below = 0.127
half_width = 14; half_height = 4.5
centre_of(i) = i % 3 == 0 ? 221 : i % 3 == 1 ? 150 : 79
set title ""
do for [i=0:8] {
    seen = first_drop - i*step - below
    set lmargin at screen 0.845
    set rmargin at screen 0.955
    set tmargin at screen 0.445 - i*0.0425
    set bmargin at screen 0.445 - i*0.0425 - 0.0395
    set label 1 sprintf("%.1f°", seen) at screen 0.838, 0.445 - i*0.0425 - 0.02 right font ",9"
    set xrange [centre_of(i) - half_width:centre_of(i) + half_width]
    set yrange [row(seen) + 0.7 - half_height:row(seen) + 0.7 + half_height]
    plot rendered binary filetype=png with rgbimage notitle
}
unset multiplot
