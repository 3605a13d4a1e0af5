# Efficiency on simulated clusters by the edge of the tiles, and with unequal hosts. Random paths, 8k frame, 100 Gbit/s.
# needs: cluster.csv study=tile efficiency
width = 1000; height = 430
load "plots/style.gp"

file = results."/cluster.csv"
set multiplot layout 1,2 margins 0.07,0.98,0.14,0.92 spacing 0.09,0
set yrange [0:1.05]
set ylabel "efficiency"
set key bottom left
tiles(ranks) = select(file, sprintf("study=tile ranks=%d", ranks), "tile efficiency")." | sort -n"
set logscale x 2
set xrange [6:80]
set xtics (8, 16, 32, 64)
set xlabel "edge of a tile (pixels)"
set title "size of the tiles"
plot 0.9 lt 8 title "0.9", tiles(1024) using 1:2 with linespoints lt 1 title "1024 ranks", \
     tiles(4096) using 1:2 with linespoints lt 2 title "4096 ranks"
rows_of(study, platform) = select(file, sprintf("study=%s platform=%s", study, platform), "ranks efficiency"). \
    " | awk '$1 >= 64' | sort -n"
set logscale x 4
set xrange [50:5200]
set xtics (64, 256, 1024, 4096)
set xlabel "ranks"
set title "unequal hosts"
plot 0.9 lt 8 title "0.9", rows_of("strong-path", "switch-100g") using 1:2 with linespoints lt 1 title "equal", \
     rows_of("stragglers", "spread-100g") using 1:2 with linespoints lt 3 title "speeds from 0.9 to 1.1", \
     rows_of("stragglers", "stragglers-100g") using 1:2 with linespoints lt 2 title "one of 64 at half the speed"
unset multiplot
