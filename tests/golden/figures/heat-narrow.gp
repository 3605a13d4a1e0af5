# Written by `cuvette study plot` for the study test. Edit it, and redraw it from any folder:
#   gnuplot fig.gp                          writes fig.png next to this script
#   gnuplot -e "format = 'svg'" fig.gp     writes fig.svg; also 'pdf'
here = ARG0
while (strlen(here) > 0 && here[strlen(here):strlen(here)] ne "/") { here = here[1:strlen(here)-1] }
if (!exists("format")) { format = "png" }
if (!exists("output")) { output = here.'fig' }
rows = here.'fig.tsv'
width = 1471; height = 295

# --- style: plots/style.gp ---
# Common style of all figures. A figure sets `width` and `height` (CSS pixels)
# and loads this file. draw.sh sets: results, output (a path without its ending), format (png, svg or pdf), units,
# environment (the keys of the environments whose rows it shows, or nothing).
#
# Colors: the eight of Okabe and Ito, distinguishable with any color vision; each has its own point type or dash as
# well.
# Heat maps: viridis (van der Walt and Smith 2015), perceptually uniform. Signed maps: blue, white, vermillion.

if (format eq "png") {
    set terminal pngcairo size 2*width,2*height font "DejaVu Sans,10" fontscale 2 linewidth 2 pointscale 1.6
}
if (format eq "svg") {
    set terminal svg size width,height font "DejaVu Sans,10" background "#ffffff" linewidth 1 fontscale 1
}
if (format eq "pdf") {
    set terminal pdfcairo size width/96.0,height/96.0 font "DejaVu Sans,7.5" linewidth 1 pointscale 0.8
}
set output output.".".format

set encoding utf8
set decimalsign "."

blue = 0x0072B2; vermillion = 0xD55E00; green = 0x009E73; purple = 0xCC79A7; orange = 0xE69F00; sky = 0x56B4E9
ink = 0x222222; grey = 0x777777; pale = 0xD9D9D9
set linetype 1 lc rgb blue       pt 7  ps 1 lw 1.6
set linetype 2 lc rgb vermillion pt 5  ps 1 lw 1.6
set linetype 3 lc rgb green      pt 9  ps 1 lw 1.6
set linetype 4 lc rgb purple     pt 13 ps 1 lw 1.6
set linetype 5 lc rgb orange     pt 11 ps 1 lw 1.6
set linetype 6 lc rgb sky        pt 3  ps 1 lw 1.6
# Published numbers and references never have the colour of a measured series.
set linetype 7 lc rgb grey       pt 6  ps 1 lw 1.6 dt (6,3)
set linetype 8 lc rgb ink        pt 1  ps 1 lw 1.0 dt (2,3)

set format "%h"
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid ytics lc rgb pale lw 0.5 dt solid
set key top left Left reverse samplen 2 spacing 1.15 textcolor rgb ink
set title font ",11" textcolor rgb ink offset 0,-0.4
set bars small
set style fill solid 1.0 noborder

viridis = "(0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', 6 '#5ec962', 7 '#addc30', 8 '#fde725')"
signed = "(-3 '#003a5c', -2 '#0072b2', -1 '#8fc3e0', 0 '#ffffff', 1 '#f0b48a', 2 '#d55e00', 3 '#7a3000')"

if (exists("environment") && environment ne "") {
    set label 9999 "environment ".environment at screen 0.995, screen 0.012 right font ",6" textcolor rgb grey
}

# --- figure ---
set datafile separator tab
set datafile missing "NA"
set termoption noenhanced
set label 1 'test' at screen 0.5,1 offset 0,-0.9 center font ",11" textcolor rgb ink
set label 2 'Medians, n = 10; 95 % interval of the median, at most ±0 % of the value.' at screen 0.006798,0.081356 left font ",8" textcolor rgb grey
set label 3 'Rows marked and left out: 0. Other processes: at most 3 % of the machine.' at screen 0.006798,0.037288 left font ",8" textcolor rgb grey
set xrange [-0.5:40.5]
set yrange [-0.5:2.5]
eval "set palette defined ".viridis
set cbrange [-0.0125:2.6825]
set cblabel 'wall time / s' offset 2.2,0
set colorbox user origin 0.932019,0.416949 size 0.009517,0.372881
unset key
unset grid
set multiplot

set lmargin at screen 0.036030; set rmargin at screen 0.471108
set bmargin at screen 0.416949; set tmargin at screen 0.789831
set title 'render.integrator = whitted'
set xlabel 'ball.ior'
set ylabel 'render.depth'
set format x '%h'
set format y '%h'
set xtics rotate by 90 right
set xtics ('1' 0, '1.025' 1, '1.05' 2, '1.075' 3, '1.1' 4, '1.125' 5, '1.15' 6, '1.175' 7, '1.2' 8, '1.225' 9, '1.25' 10, '1.275' 11, '1.3' 12, '1.325' 13, '1.35' 14, '1.375' 15, '1.4' 16, '1.425' 17, '1.45' 18, '1.475' 19, '1.5' 20, '1.525' 21, '1.55' 22, '1.575' 23, '1.6' 24, '1.625' 25, '1.65' 26, '1.675' 27, '1.7' 28, '1.725' 29, '1.75' 30, '1.775' 31, '1.8' 32, '1.825' 33, '1.85' 34, '1.875' 35, '1.9' 36, '1.925' 37, '1.95' 38, '1.975' 39, '2' 40)
set ytics ('0' 0, '2' 1, '4' 2)
plot rows index 0 using 2:3:($2-0.5):($2+0.5):($3-0.5):($3+0.5):4 with boxxyerror lc palette notitle
unset label
unset colorbox
unset key

set lmargin at screen 0.487424; set rmargin at screen 0.922502
set bmargin at screen 0.416949; set tmargin at screen 0.789831
set title 'render.integrator = raycast'
set xlabel 'ball.ior'
set ylabel ''
set format x '%h'
set format y ''
set xtics rotate by 90 right
set xtics ('1' 0, '1.025' 1, '1.05' 2, '1.075' 3, '1.1' 4, '1.125' 5, '1.15' 6, '1.175' 7, '1.2' 8, '1.225' 9, '1.25' 10, '1.275' 11, '1.3' 12, '1.325' 13, '1.35' 14, '1.375' 15, '1.4' 16, '1.425' 17, '1.45' 18, '1.475' 19, '1.5' 20, '1.525' 21, '1.55' 22, '1.575' 23, '1.6' 24, '1.625' 25, '1.65' 26, '1.675' 27, '1.7' 28, '1.725' 29, '1.75' 30, '1.775' 31, '1.8' 32, '1.825' 33, '1.85' 34, '1.875' 35, '1.9' 36, '1.925' 37, '1.95' 38, '1.975' 39, '2' 40)
set ytics ('' 0, '' 1, '' 2)
plot rows index 1 using 2:3:($2-0.5):($2+0.5):($3-0.5):($3+0.5):4 with boxxyerror lc palette notitle
unset multiplot
