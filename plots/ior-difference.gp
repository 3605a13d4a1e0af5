# Effect of the refractive indices: luminance of each pair's image minus that of pair 1, which has no interface.
# needs: tables/ior.tsv liquid.ior
# needs: ior/images/0000.pfm
# needs: ior/images/*.pfm
width = 1000; height = 345
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("ior")
float_image(cell) = sprintf("%s/ior/images/%04d.pfm", results, cell)
side(axis) = real(word(pfm_line(float_image(0)), axis))
amplified = 4

set palette defined @signed
set cbrange [-1.0/amplified:1.0/amplified]
set cbtics 1.0/amplified/2 format "%+.3f" scale 0.4 textcolor rgb ink
unset colorbox
# Crop of each image, the vessel and its shadow: fractions of the width from the left and of the height from the bottom.
set xrange [0.12*side(1):0.74*side(1)]
set yrange [0.10*side(2):0.98*side(2)]
set border 15 lc rgb pale
set datafile separator whitespace
set multiplot layout 1,3 margins 0.005,0.885,0.02,0.92 spacing 0.006,0
do for [i=1:3] {
    set title caption(sprintf("vessel %.2f, liquid %.2f", cell_value(rows, i, "vessel.ior"), cell_value(rows, i, "liquid.ior")))
    if (i == 3) {
        set colorbox user origin 0.9,0.08 size 0.013,0.76
        set cblabel "luminance minus that of pair 1\n(white = 1)" offset 1.2,0
    }
    if (readable(float_image(i))) {
        plot sprintf("< plots/difference.sh '%s' '%s'", float_image(i), float_image(0)) using 1:2:3 with image notitle
    } else {
        @empty
    }
}
unset multiplot
