# A liquid of five concentrations, and the transmittance of a slab compared with the Beer-Lambert law.
# needs: tables/absorption.tsv liquid.absorb_per_m
# needs: absorption/images/*.png
# needs: tables/absorber.tsv liquid.size.z
# needs: absorber/images/*.pfm
width = 1000; height = 640
load "plots/style.gp"

rows = table("absorption")
slab = table("absorber")
set multiplot
set xlabel "thickness d of the slab / mm"
set ylabel "transmittance"
set lmargin at screen 0.075
set rmargin at screen 0.74
set bmargin at screen 0.085
set tmargin at screen 0.5
set xrange [0:20.4]
set yrange [0:1.03]
set title "Light through a slab, n = 1.33"
set key at screen 0.765,0.5 left top Left reverse samplen 2 spacing 1.25
# thickness, red, green, blue of the pixel in the middle.
measured = "< awk -f plots/select.awk -v columns='cell liquid.size.z' '".slab."' | while read -r cell d; do " \
    ."image=$(printf '".results."/absorber/images/%04d.pfm' $cell); ".'[ -r "$image" ]'." || continue; " \
    ."printf '%s\t' $d; plots/pixel.sh $image; done"
# Reflectance of a face at normal incidence (Fresnel), and the transmittance of a slab with all its inner reflections.
R = (0.33/2.33)**2
through(a, d) = (1 - R)**2*exp(-a*d*1e-3)/(1 - R**2*exp(-2*a*d*1e-3))
worst = number(system(measured[3:*].sprintf(" | awk -f plots/slab.awk -v R=%.17g -v absorb='200 60 10'", R)))
set label 1 sprintf("largest deviation from the\nslab's law: %.0e", worst) at screen 0.77,0.125 left font ",9" textcolor rgb ink
plot through(200, x) with lines lt 2 notitle, through(60, x) with lines lt 3 notitle, through(10, x) with lines lt 1 notitle, \
     exp(-0.2*x) with lines lt 7 title "exp(-ad), without faces", exp(-0.06*x) with lines lt 7 notitle, exp(-0.01*x) with lines lt 7 notitle, \
     measured using 1:4 with points lt 1 title "blue, a = 10 / m", \
     measured using 1:3 with points lt 3 title "green, a = 60 / m", \
     measured using 1:2 with points lt 2 title "red, a = 200 / m", \
     NaN with lines lc rgb ink lw 1.6 title "exp(-ad), with both faces"

unset xlabel; unset ylabel; unset label 1
set xrange [*:*]
set yrange [*:*]
load "plots/image_panels.gp"
do for [i=0:4] {
    file = image("absorption", i)
    set lmargin at screen 0.005 + i*0.199
    set rmargin at screen 0.005 + i*0.199 + 0.194
    set bmargin at screen 0.57
    set tmargin at screen 0.95
    a = text(rows, sprintf("cell=%d", i), "liquid.absorb_per_m")
    set title i == 0 ? "clear" : system("echo '".a."' | sed 's/,/, /g; s/.*/a = (&) \\/ m/'")
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
