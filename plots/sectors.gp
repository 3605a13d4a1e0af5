# Wall time and imbalance by tile size, for static and dynamic tiles, and for blocks of columns and rows.
# needs: tables/sectors.tsv wall_s_median imbalance_median
width = 1000; height = 470
load "plots/style.gp"

rows = table("sectors")
values(schedule, threads, columns) = select(rows, sprintf("render.schedule=%s render.threads=%d", schedule, threads), "render.tile ".columns)
block(schedule, threads, column) = first(rows, sprintf("render.schedule=%s render.threads=%d", schedule, threads), column)
counts = "1 2 4"
label_blocks = "columns rows"

set label 100 remarks("sectors") at screen 0.5,0.012 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.08,0.985,0.13,0.92 spacing 0.11
set logscale x 2
set xrange [6:1700]
set xtics (8, 16, 32, 64, 128, 256, "columns" 500, "rows" 1200)
set xlabel "tile size / px"
set title "Wall time of a frame"
set ylabel "wall time / ms"
set yrange [0:*]
set key top left maxrows 3
set offsets 0, 0, graph 0.3, 0
plot for [i=1:3] values("tiles", word(counts, i) + 0, "wall_s_median wall_s_min wall_s_max") using 1:($2*1e3):($3*1e3):($4*1e3) \
         with yerrorlines lt i pt 6 dt (6,3) title "static tiles, ".word(counts, i).(i == 1 ? " thread" : " threads"), \
     for [i=1:3] values("dynamic", word(counts, i) + 0, "wall_s_median wall_s_min wall_s_max") using 1:($2*1e3):($3*1e3):($4*1e3) \
         with yerrorlines lt i title "dynamic tiles, ".word(counts, i).(i == 1 ? " thread" : " threads"), \
     for [i=1:3] for [j=1:2] '+' using (j == 1 ? 500 : 1200):(block(word(label_blocks, j), word(counts, i) + 0, "wall_s_median")*1e3) every ::0::0 \
         with points lt i pt 2 ps 1.2 notitle
unset label 100
set title "Imbalance: longest busy time / mean busy time - 1"
unset offsets
set yrange [0:*]
set ylabel "imbalance / %"
set key top left maxrows 4
plot for [i=2:3] values("tiles", word(counts, i) + 0, "imbalance_median") using 1:($2*100) \
         with linespoints lt i pt 6 dt (6,3) title "static tiles, ".word(counts, i)." threads", \
     for [i=2:3] values("dynamic", word(counts, i) + 0, "imbalance_median") using 1:($2*100) \
         with linespoints lt i title "dynamic tiles, ".word(counts, i)." threads", \
     for [i=2:3] for [j=1:2] '+' using (j == 1 ? 500 : 1200):(block(word(label_blocks, j), word(counts, i) + 0, "imbalance_median")*100) every ::0::0 \
         with points lt i pt 2 ps 1.2 notitle
unset multiplot
