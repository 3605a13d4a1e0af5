# The image by recursion depth.
# needs: depth/images/*.png
# needs: tables/depth.tsv rays_total
width = 1000; height = 790
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("depth")
set multiplot layout 3,3 margins 0.005,0.995,0.005,0.97 spacing 0.008,0.035
do for [i=0:8] {
    file = image("depth", i)
    depth = cell_value(rows, i, "render.depth")
    million = cell_value(rows, i, "rays_total")/1e6
    set title sprintf("depth %d", depth == depth ? depth : i).(million == million ? sprintf(", %.2f million rays", million) : "")
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
