# Written by `cuvette study plot` for the study test. Edit it, and redraw it from any folder:
#   gnuplot fig.gp                          writes fig.png next to this script
#   gnuplot -e "format = 'svg'" fig.gp     writes fig.svg; also 'pdf'
here = ARG0
while (strlen(here) > 0 && here[strlen(here):strlen(here)] ne "/") { here = here[1:strlen(here)-1] }
if (!exists("format")) { format = "png" }
if (!exists("output")) { output = here.'fig' }
rows = here.'fig.tsv'
width = 772; height = 472

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
set label 2 'Medians, n = 10; bars: 95 % interval of the median.' at screen 0.012953,0.050847 left font ",8" textcolor rgb grey
set label 3 'Rows marked and left out: 0. Other processes: at most 3 % of the machine.' at screen 0.012953,0.023305 left font ",8" textcolor rgb grey
set xrange [-0.2:4.2]
set yrange [0:435.5]
set key at screen 0.839378,0.923729 left top Left reverse vertical maxrows 40
set key title 'render.seed' left font ",9"
eval "set palette defined ".viridis
unset colorbox
set multiplot

set lmargin at screen 0.095855; set rmargin at screen 0.821244
set bmargin at screen 0.182203; set tmargin at screen 0.923729
set title ''
set xlabel 'render.depth'
set ylabel 'wall time / ms'
set format x '%h'
set format y '%h'
set xtics 1
plot \
    NaN with linespoints lt 1 pt 7 lc palette frac 0.000 title '1', \
    NaN with linespoints lt 1 pt 5 lc palette frac 0.131 title '2', \
    NaN with linespoints lt 1 pt 9 lc palette frac 0.263 title '3', \
    NaN with linespoints lt 1 pt 13 lc palette frac 0.394 title '4', \
    NaN with linespoints lt 1 pt 11 lc palette frac 0.526 title '5', \
    NaN with linespoints lt 1 pt 3 lc palette frac 0.657 title '6', \
    NaN with linespoints lt 1 pt 2 lc palette frac 0.789 title '7', \
    NaN with linespoints lt 1 pt 1 lc palette frac 0.920 title '8', \
    rows index 0 using 2:3:4:5 with yerrorlines lt 1 pt 7 lc palette frac 0.000 notitle, \
    rows index 1 using 2:3:4:5 with yerrorlines lt 1 pt 5 lc palette frac 0.131 notitle, \
    rows index 2 using 2:3:4:5 with yerrorlines lt 1 pt 9 lc palette frac 0.263 notitle, \
    rows index 3 using 2:3:4:5 with yerrorlines lt 1 pt 13 lc palette frac 0.394 notitle, \
    rows index 4 using 2:3:4:5 with yerrorlines lt 1 pt 11 lc palette frac 0.526 notitle, \
    rows index 5 using 2:3:4:5 with yerrorlines lt 1 pt 3 lc palette frac 0.657 notitle, \
    rows index 6 using 2:3:4:5 with yerrorlines lt 1 pt 2 lc palette frac 0.789 notitle, \
    rows index 7 using 2:3:4:5 with yerrorlines lt 1 pt 1 lc palette frac 0.920 notitle
unset label
unset colorbox
unset key
unset multiplot
