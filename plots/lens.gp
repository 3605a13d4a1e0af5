# The page of `cuvette lens report --figure`, which writes this script with the style and these: rows, the report as
# CSV; lens, its title; fields, their number; field_unit; waves, the wavelengths in nm; first, the lens in a line; $sides,
# $axial and $slanting, the lens and paraxial rays as points z, y.
set datafile separator comma
set datafile missing NaN
set termoption noenhanced

across = fields < 5 ? fields : 5
pick(section, field, nm, quantity) = strcol(1) eq section && (field == 0 || column(3) == field) && \
    (nm == 0 || abs(column(4) - nm) < 1e-6) && strcol(6) eq quantity
curve(section, field, nm, quantity) = pick(section, field, nm, quantity) ? column(5) : NaN
nm(i) = real(word(waves, i))
colour(i) = i == 1 ? green : i == 2 ? blue : i == 3 ? vermillion : i == 4 ? purple : i == 5 ? orange : sky
field_value(f) = real(system(sprintf("awk -F, '$1 == \"fields\" && $3 == %d { s += $7*$7 } END { print sqrt(s) }' '%s'", f, rows)))
label_of(f) = sprintf("field %d: %.4g %s", f, field_value(f), field_unit)

left(i, n) = 0.088 + (i - 1)*0.917/n
right(i, n) = left(i, n) + 0.917/n - 0.075
place(i, n, top, bottom) = sprintf("set lmargin at screen %.4f; set rmargin at screen %.4f; set tmargin at screen %.4f; set bmargin at screen %.4f", left(i, n), right(i, n), top, bottom)

set label 1 lens at screen 0.5,0.985 center font ",12" textcolor rgb ink
set label 2 first at screen 0.5,0.967 center font ",8" textcolor rgb grey
set tics font ",7"
set title font ",8"
set xlabel font ",7" offset 0,0.6
set ylabel font ",7" offset 0.8,0
unset key
# Keeps the range of a panel without a value, where no ray arrives.
$origin << END
0,0
END
set multiplot

# Rows of panels, from the top.
top(r) = word("0.945 0.795 0.660 0.520 0.375 0.245 0.115", r) + 0.0
bottom(r) = word("0.850 0.695 0.565 0.405 0.285 0.155 0.030", r) + 0.0
panel(i, n, r) = place(i, n, top(r), bottom(r))

# The lens, and which colour is which wavelength.
eval panel(1, 1, 1)
set size ratio -1
set autoscale fix
unset border
unset tics
set key at screen 0.985,0.945 right top font ",7" samplen 1.5
plot $sides using 1:2 with lines lw 1.2 lc rgb ink notitle, \
    $axial using 1:2 with lines lw 0.7 lc rgb grey notitle, \
    $slanting using 1:2 with lines lw 0.7 lc rgb blue notitle, \
    for [i=1:words(waves)] NaN with lines lw 1.4 lc rgb colour(i) title word(waves, i)." nm", \
    NaN with lines lw 1.4 dt (4,3) lc rgb ink title "sagittal", \
    for [f=1:across] NaN with lines lt f title sprintf("by field: %d", f)
unset key
unset label 1
unset label 2
set border
set tics font ",7"
set size noratio
set autoscale

# Ray fans and wavefronts by field.
set xrange [-1:1]
set xtics -1,0.5,1
set xzeroaxis lt 8
set yrange [*<-1e-6:1e-6<*]
do for [f=1:across] {
    eval panel(f, across, 2)
    set title label_of(f)
    set ylabel f == 1 ? "ray aberration, mm" : ""
    set xlabel ""
    plot $origin using 1:2 with dots lc rgb "white" notitle, \
        for [i=1:words(waves)] rows using (curve("fan-tangential", f, nm(i), "e_tangential")):7 with lines lw 1.4 lc rgb colour(i), \
        for [i=1:words(waves)] rows using (curve("fan-sagittal", f, nm(i), "e_sagittal")):7 with lines lw 1.4 dt (4,3) lc rgb colour(i)
    eval panel(f, across, 3)
    set title ""
    set ylabel f == 1 ? "wavefront, waves" : ""
    set xlabel "pupil"
    plot $origin using 1:2 with dots lc rgb "white" notitle, \
        for [i=1:words(waves)] rows using (curve("fan-tangential", f, nm(i), "opd")):7 with lines lw 1.4 lc rgb colour(i), \
        for [i=1:words(waves)] rows using (curve("fan-sagittal", f, nm(i), "opd")):7 with lines lw 1.4 dt (4,3) lc rgb colour(i)
}

# Spots, all to one scale, with the circle of Airy's first zero.
unset xzeroaxis
unset grid
set xlabel ""
largest(quantity) = real(system(sprintf("awk -F, '$1 == \"spot\" && $6 == \"%s\" && $7 > most { most = $7 } END { print most + 0 }' '%s'", quantity, rows)))
airy = largest("airy_radius")
geo = largest("geo")
most = 1.1*(geo > airy ? geo : airy)
set xrange [-most:most]
set yrange [-most:most]
set xtics auto
set xtics -most/1.1,most/1.1,most/1.1 format "%.2g"
set ytics -most/1.1,most/1.1,most/1.1 format "%.2g"
set size ratio -1
do for [f=1:across] {
    eval panel(f, across, 4)
    set ylabel f == 1 ? "spot, mm from the chief ray" : ""
    set object 1 circle at 0,0 size airy front fs empty border lc rgb ink lw 0.8
    # dx and dy are rows in turn: x is kept until its y comes.
    plot $origin using 1:2 with dots lc rgb "white", for [i=1:words(waves)] keep = 0.0 rows using \
        (strcol(1) eq "spot-points" && strcol(6) eq "dx" ? (keep = column(7), NaN) : pick("spot-points", f, nm(i), "dy") ? keep : NaN):7 \
        with points pt 7 ps 0.12 lc rgb colour(i)
}
unset object 1
set size noratio
set format "%h"
set grid ytics lc rgb pale lw 0.5 dt solid

# Along the field, and along the pupil. Rounding errors do not fill a panel.
set autoscale
set yrange [*<-1e-6:1e-6<*]
set xtics auto
set ytics auto
eval panel(1, 3, 5)
set title "foci of narrow pencils: tangential, sagittal dashed"
set xlabel sprintf("field, %s", field_unit)
set ylabel "from the image, mm"
plot $origin using 1:2 with dots lc rgb "white" notitle, \
    rows using (curve("field-curves", 0, 0, "tangential")):7 with lines lt 1, \
    rows using (curve("field-curves", 0, 0, "sagittal")):7 with lines lt 1 dt (4,3)
eval panel(2, 3, 5)
set title "distortion"
set ylabel "%"
unset key
plot $origin using 1:2 with dots lc rgb "white" notitle, \
    rows using (curve("field-curves", 0, 0, "distortion")):7 with lines lt 1
eval panel(3, 3, 5)
set title "focus by height in the pupil"
set xlabel "pupil"
set ylabel "from the image, mm"
plot $origin using 1:2 with dots lc rgb "white" notitle, \
    for [i=1:words(waves)] rows using (curve("longitudinal", 0, nm(i), "focus")):7 with lines lw 1.4 lc rgb colour(i)

# By field: lateral colour from the primary wavelength, illuminance and transmission.
set xrange [*:*]
by_field(section, nm, quantity) = strcol(1) eq section && (nm == 0 || abs(column(4) - nm) < 1e-6) && \
    strcol(6) eq quantity ? field_value(int(column(3))) : NaN
eval panel(1, 3, 6)
set title "lateral colour"
set xlabel sprintf("field, %s", field_unit)
set ylabel "from the primary wavelength, mm"
plot $origin using 1:2 with dots lc rgb "white", \
    for [i=1:words(waves)] rows using (by_field("chief", nm(i), "lateral_colour")):7 with linespoints pt 7 ps 0.4 lw 1.4 lc rgb colour(i)
eval panel(2, 3, 6)
set title "illuminance, relative to field 1"
set ylabel ""
set yrange [0:1.05]
plot $origin using 1:2 with dots lc rgb "white", \
    rows using (by_field("illumination", 0, "relative")):7 with linespoints pt 7 ps 0.4 lt 1
eval panel(3, 3, 6)
set title "transmission of surfaces and media"
set yrange [*:*]
set offsets 0,0,graph 0.1,graph 0.1
plot for [i=1:words(waves)] rows using (by_field("transmission", nm(i), "transmission")):7 with linespoints pt 7 ps 0.4 lw 1.4 lc rgb colour(i)
set offsets 0,0,0,0

# A curve for each field.
set autoscale
eval panel(1, 3, 7)
set title "MTF with diffraction, by field; limit grey"
set xlabel "cycles/mm"
set ylabel ""
set yrange [0:1]
plot $origin using 1:2 with dots lc rgb "white" notitle, \
    for [f=1:across] rows using (curve("mtf-diffraction", f, 0, "tangential")):7 with lines lt f notitle, \
    for [f=1:across] rows using (curve("mtf-diffraction", f, 0, "sagittal")):7 with lines lt f dt (4,3) notitle, \
    rows using (curve("mtf-diffraction", 1, 0, "limit")):7 with lines lt 8 notitle
eval panel(2, 3, 7)
set title "light within a circle, with diffraction"
set xlabel "radius, mm"
unset key
plot $origin using 1:2 with dots lc rgb "white" notitle, \
    for [f=1:across] rows using (curve("encircled", f, nm(1), "fraction")):7 with lines lt f
eval panel(3, 3, 7)
set title "Seidel sums by surface"
set autoscale y
set offsets 0,0,graph 0.25,0
set xlabel "surface"
set ylabel "mm"
set style fill solid 1.0 noborder
set boxwidth 0.15
set xtics 1
set key at graph 1.02,1.0 left top Left reverse font ",6" samplen 0.6
kinds = "S_I S_II S_III S_IV S_V"
plot for [k=1:5] rows using (strcol(1) eq "seidel" && strcol(6) eq word(kinds, k) ? column(2) + 0.16*(k - 3) : NaN):7 \
    with boxes lc rgb colour(k) title word(kinds, k)
unset multiplot
