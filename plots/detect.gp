# What the metrics of optics detect: the power of ten of the smallest injected error that a family of metrics detects in
# the median of the scenes in which it detects any, by the kind of error; experiments/detect.sh.
# needs: detect/rows.csv metric
width = 318; height = 300
load "plots/style.gp"

families = "edges water_line lens dispersion critical fresnel balance slab gap radiance absorption reversal ".\
    "stack prism rainbow"
kinds = "index.vessel index.liquid index.around index directions reflectances wrong-side swapped leak normal ".\
    "transparency absorption"
titles = "vessel's index|liquid's index|surroundings' index|denser index|… in directions|… in reflectances|".\
    "wrong side's index|s and p swapped|total reflection leaks|normal tilted|transparency|absorption"
title(i) = system("echo \"".titles."\" | cut -d '|' -f ".i)
# Column, row, power of ten (1 for none), whether some scenes detect nothing.
rows = select(results."/detect/rows.csv", "", "metric error_kind size_median? cells cells_detected")." | awk -F '\t' -v kinds='".\
    kinds."' -v families='".families."' '".\
    "BEGIN { OFS = \"\t\"; for (i = split(kinds, k, \" \"); i > 0; i--) x[k[i]] = i; ".\
    "for (i = split(families, f, \" \"); i > 0; i--) y[f[i]] = i } ".\
    "sub(/\\.any$/, \"\", $1) { print x[$2], y[$1], $3 == \"NaN\" ? 1 : substr($3, 3), $5 < $4 }'"
shown(power) = power > 0 ? "·" : sprintf("%.0f", power)
# Dark on bright colours, bright on dark ones; less contrast where some scenes detect nothing.
number_color(power, some) = power > 0 ? ink : power > -6 ? \
    (some > 0 ? 0x555555 : 0x000000) : (some > 0 ? 0xBBBBBB : 0xFFFFFF)

unset key; unset grid
set border 0
set lmargin at screen 0.2
set rmargin at screen 0.925
set tmargin at screen 0.76
set bmargin at screen 0.105
set xrange [0.5:words(kinds) + 0.5]
set yrange [words(families) + 0.5:0.5]
set xtics scale 0 rotate by 55 left offset 0,0 format "" noenhanced
set x2tics scale 0 rotate by 55 left offset -0.5,0 noenhanced font ",6.5"
set x2range [0.5:words(kinds) + 0.5]
unset xtics
set for [i=1:words(kinds)] x2tics add (title(i) i)
set ytics scale 0 noenhanced font ",7" offset 0.6,0
set for [i=1:words(families)] ytics add (word(families, i) i)
set palette defined @viridis
set cbrange [-14:0]
unset colorbox
set label 1 "cell: power of ten of the smallest error detected; · none; grey: no such scene" \
    at screen 0.01,0.055 left font ",6.5"
set label 2 "pale number: some scenes detect no size" at screen 0.01,0.02 left font ",6.5"
set object 1 rectangle from graph 0,0 to graph 1,1 fc rgb pale fillstyle solid noborder behind
plot rows using 1:2:(0.47):(0.46) with boxxyerror lc rgb "white" fs solid noborder, \
     rows using 1:2:(0.47):(0.46):($3 > 0 ? NaN : $3) with boxxyerror fs solid noborder lc palette, \
     rows using 1:2:(shown($3)):(number_color($3, $4)) with labels font ",6.5" tc rgb variable
