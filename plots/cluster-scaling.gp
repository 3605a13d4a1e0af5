# Efficiency on simulated clusters by ranks: strong and weak scaling of random paths, and Whitted's method.
# needs: cluster.csv study=strong-path efficiency
width = 1000; height = 430
load "plots/style.gp"

rows_of(study, platform, variant) = select(results."/cluster.csv", \
    sprintf("study=%s platform=%s variant=%s", study, platform, variant), "ranks ideal_s time_s efficiency")." | sort -n"
set multiplot layout 1,2 margins 0.07,0.98,0.14,0.92 spacing 0.09,0
set logscale x 4
set xrange [0.8:5200]
set xtics (1, 4, 16, 64, 256, 1024, 4096)
set yrange [0:1.05]
set xlabel "ranks"
set ylabel "efficiency"
set key bottom left
set title "random paths, 1024 a pixel"
plot 0.9 lt 8 title "0.9", \
     rows_of("strong-path", "switch-100g", "tile-32") using 1:4 with linespoints lt 1 title "8k frame, 100 Gbit/s", \
     rows_of("strong-path", "ethernet-10g", "tile-32") using 1:4 with linespoints lt 2 title "8k frame, 10 Gbit/s", \
     rows_of("weak-path", "switch-100g", "tile-32") using 1:4 with linespoints lt 3 \
         title "120 × 68 pixels a rank, 100 Gbit/s"
set title "Whitted's method, 8k frame"
set ylabel "frames per second"
set logscale y
set xrange [0.8:1300]
set yrange [0.02:40]
set key bottom right
set format y "%g"
plot rows_of("strong-whitted", "switch-100g", "tile-32") using 1:(1/$2) with lines lt 8 title "ideal", \
     rows_of("strong-whitted", "switch-100g", "link-only") using 1:(1/$3) with linespoints lt 3 \
         title "100 Gbit/s, 1 µs per tile at rank 0", \
     rows_of("strong-whitted", "switch-100g", "tile-32") using 1:(1/$3) with linespoints lt 1 title "100 Gbit/s", \
     rows_of("strong-whitted", "ethernet-10g", "eager-64k") using 1:(1/$3) with linespoints lt 4 \
         title "10 Gbit/s, tiles sent at once", \
     rows_of("strong-whitted", "ethernet-10g", "tile-32") using 1:(1/$3) with linespoints lt 2 title "10 Gbit/s"
unset multiplot
