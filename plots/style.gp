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
load "plots/rows.gp"

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

published = "experiments/published/"
published_name = "published (4 cores, 8 logical)"
viridis = "(0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', 6 '#5ec962', 7 '#addc30', 8 '#fde725')"
signed = "(-3 '#003a5c', -2 '#0072b2', -1 '#8fc3e0', 0 '#ffffff', 1 '#f0b48a', 2 '#d55e00', 3 '#7a3000')"

if (exists("environment") && environment ne "") {
    set label 9999 "environment ".environment at screen 0.995, screen 0.012 right font ",6" textcolor rgb grey
}
