# Time of a ray and memory by the recursion depth.
# needs: tables/growth-depth.tsv cpu_s_median
# needs: tables/growth.tsv series=depth peak_rss_bytes_median
width = 1000; height = 430
load "plots/style.gp"

study = "growth-depth"
rows = table(study)
series = "render.min_weight=0 render.min_weight=0.00392156862745098"
names = "'the whole tree' 'branches above 1/255'"
column = "render.depth"
memories = "depth"
memory_names = "'the whole tree'"
hierarchies = 0
set xrange [0:64]
set xlabel "recursion depth"
load "plots/growth_panels.gp"
