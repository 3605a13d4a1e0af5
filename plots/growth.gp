# Time of a ray and memory by the number of analytic spheres and of lights.
# needs: tables/growth.tsv series=solids ray_ns_median
width = 1000; height = 760
load "plots/style.gp"

rows = table("growth")
times(series, kind) = select(rows, "series=".series, sprintf("count %s_median %s_low? %s_high?", kind, kind, kind))
rays(series) = times(series, "ray_ns")
camera_rays(series) = times(series, "camera_ray_ns")
memory(series) = times(series, "peak_rss_bytes")
at64 = first(rows, "series=solids count=64", "ray_ns_median")
set multiplot layout 2,2 margins 0.075,0.985,0.075,0.96 spacing 0.1,0.12
set grid xtics ytics lc rgb pale lw 0.5 dt solid
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set xlabel "spheres"
set title "Spheres: CPU time of a ray, median and range"
set ylabel "ns / ray"
plot rays("solids") using 1:2:3:4 with yerrorlines lt 1 title "measured", \
     (at64) with lines lt 8 title "that of 64 spheres", 3*at64 with lines lt 7 title "three times that"
set title "Spheres: memory of the process (over 10^5: a cloud)"
set ylabel "MiB"
plot memory("solids") using 1:($2/2**20):($3/2**20):($4/2**20) with yerrorlines lt 1 notitle
set xlabel "lights"
set title "Lights: CPU time of a camera ray with all that follow"
set ylabel "ns / camera ray"
plot camera_rays("lights") using 1:2:3:4 with yerrorlines lt 2 title "Whitted: all lights", \
     camera_rays("lights-path") using 1:2:3:4 with yerrorlines lt 3 title "paths: one light a surface"
set title "Lights: CPU time of a ray"
set ylabel "ns / ray"
plot rays("lights") using 1:2:3:4 with yerrorlines lt 2 title "Whitted: all lights", \
     rays("lights-path") using 1:2:3:4 with yerrorlines lt 3 title "paths: one light a surface"
unset multiplot
