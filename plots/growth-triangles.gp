# Time of a ray and memory by the number of triangles, 10^3 to 10^7.
# needs: tables/growth-triangles.tsv cpu_s_median
# needs: tables/growth.tsv peak_rss_bytes_median
width = 1000; height = 430
load "plots/style.gp"

study = "growth-triangles"
rows = table(study)
series = "soup.generate=sparse soup.generate=sphere"
names = "'small separate triangles' 'a ball'"
column = "triangles"
memories = "sparse sphere"
memory_names = names
hierarchies = 2
set logscale x
set format x "10^{%T}"
set xlabel "triangles n"
load "plots/growth_panels.gp"
