# Two panels of a growth study: CPU time of a ray, and memory of a fresh process with that of its hierarchies. Before it
# loads this file, the figure sets study, rows, series (conditions on rows, one a line of the plot), names, column, the
# axis of x; memories (series of growth.tsv), memory_names, and the number of lines of hierarchies.
of(i, columns) = select(rows, word(series, i), column." ".columns)
memory(i) = select(table("growth"), "series=".word(memories, i), \
    "count peak_rss_bytes_median peak_rss_bytes_low? peak_rss_bytes_high?")
set label 100 remarks(study) at screen 0.5,0.02 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.075,0.985,0.15,0.93 spacing 0.1
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set logscale y
set format y "10^{%T}"
set title "CPU time of a ray, median and range"
set ylabel "ns / ray"
plot for [i=1:words(series)] of(i, "cpu_s_median cpu_s_min cpu_s_max rays_total") \
         using 1:($2/$5*1e9):($3/$5*1e9):($4/$5*1e9) with yerrorlines lt i title word(names, i)
unset label 100
set title "Memory"
set ylabel "MiB"
plot for [i=1:words(memories)] memory(i) using 1:($2/2**20):($3/2**20):($4/2**20) with yerrorlines lt i \
         title "the process, ".word(memory_names, i), \
     for [i=1:hierarchies] of(i, "accel_bytes") using 1:($2/2**20) with lines lt i dt (6,3) \
         title "its hierarchy, ".word(names, i)
unset multiplot
