# The pictures of the four pairs of refractive indices.
# needs: tables/ior.tsv ior/images/*.png
width = 1000; height = 800
load "plots/style.gp"

load "plots/picture.gp"
rows = table("ior")
set multiplot layout 2,2 margins 0.01,0.99,0.01,0.96 spacing 0.015,0.045
do for [i=0:3] {
    file = image("ior", i)
    set title sprintf("pair %d: vessel %.2f, liquid %.2f", i + 1, cell_value(rows, i, "vessel.ior"), cell_value(rows, i, "liquid.ior"))
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
