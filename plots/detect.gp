# What the metrics of optics detect: the power of ten of the smallest injected error that a family of metrics detects in
# every scene in which it detects any, by the kind of error; experiments/detect.sh.
# needs: detect/rows.csv
width = 318; height = 300
load "plots/style.gp"

families = "edges water_line lens dispersion critical fresnel balance slab gap radiance absorption reversal ".\
    "stack prism rainbow"
kinds = "index.vessel index.liquid index.around index directions reflectances wrong-side swapped total normal ".\
    "transparency absorption"
titles = "vessel's index|liquid's index|surroundings' index|denser index|… in directions|… in reflectances|".\
    "wrong side's index|s and p swapped|total reflection lost|normal tilted|transparency|absorption"
title(i) = system("echo \"".titles."\" | cut -d '|' -f ".i)
place(list, name) = words((" ".list." ")[1:strstrt(" ".list." ", " ".name." ")])
rows = "< awk -F , 'NR > 1 && $2 ~ /\\.any$/ { sub(/\\.any$/, \"\", $2); print $3, $2, $4, $5, $8 }' '".results."/detect/rows.csv'"
shown(text) = text eq "NA" ? "·" : sprintf("%.0f", power(text))
# Dark on bright colours, bright on dark ones; less contrast where some scenes detect nothing.
number_color(text, some) = text eq "NA" ? ink : power(text) > -6 ? (some ? 0x555555 : 0x000000) : (some ? 0xBBBBBB : 0xFFFFFF)
power(text) = text eq "NA" ? NaN : real(text) > 0 ? log10(real(text)) : NaN

unset key; unset grid
set border 0
set lmargin at screen 0.2
set rmargin at screen 0.99
set tmargin at screen 0.71
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
set label 1 "cell: power of ten of the smallest error detected; · none; grey: no such scene" at screen 0.01,0.055 left font ",6.5"
set label 2 "pale number: some scenes detect no size" at screen 0.01,0.02 left font ",6.5"
set object 1 rectangle from graph 0,0 to graph 1,1 fc rgb pale fillstyle solid noborder behind
across = "place(kinds, strcol(1))"; down = "place(families, strcol(2))"
plot rows using (@across):(@down):(0.47):(0.46) with boxxyerror lc rgb "white" fs solid noborder, \
     rows using (@across):(@down):(0.47):(0.46):(power(strcol(5))) with boxxyerror fs solid noborder lc palette, \
     rows using (@across):(@down):(shown(strcol(5))):(number_color(strcol(5), $4 < $3)) with labels font ",6.5" tc rgb variable
