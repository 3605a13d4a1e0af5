# A ground of two triangles under each filter, with the cost of a frame and its distance from 64 samples a pixel.
# needs: tables/texture.tsv texture/images/*.png texture/references/*.png
width = 1000; height = 880
load "plots/style.gp"

load "plots/picture.gp"
rows = table("texture")
about(i) = sprintf("%.1f ms, FLIP %.3f, rms error %.3f, PSNR %.1f dB", cell_value(rows, i, "cpu_s_median")*1e3, cell_value(rows, i, "flip"), \
    cell_value(rows, i, "error_rms"), cell_value(rows, i, "psnr_db"))
set title offset 0,-0.7
set multiplot layout 2,2 margins 0.01,0.99,0.045,0.965 spacing 0.015,0.085
do for [i=0:3] {
    file = i < 3 ? image("texture", i) : results."/texture/references/".text(rows, "cell=0", "reference").".png"
    set title i < 3 ? text(rows, sprintf("cell=%d", i), "tiles.filter") : "64 samples a pixel: the reference"
    set label 1 (i < 3 ? about(i) : "") at graph 0.5, -0.04 center textcolor rgb ink
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
