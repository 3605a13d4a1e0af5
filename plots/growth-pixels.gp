# Time of a ray and memory by the number of pixels.
# needs: tables/growth-pixels.tsv cpu_s_median
# needs: tables/growth.tsv peak_rss_bytes_median
width = 1000; height = 430
load "plots/style.gp"

study = "growth-pixels"
rows = table(study)
series = "render.depth=0 render.depth=4"
names = "'depth 0' 'depth 4'"
column = "rays_camera"
memories = "pixels"
memory_names = "'depth 4'"
hierarchies = 0
set logscale x
set format x "10^{%T}"
set xlabel "pixels"
load "plots/growth_panels.gp"
