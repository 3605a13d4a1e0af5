# A ground of two triangles with affine and perspective-correct interpolation and each filter, compared with 64
# samples per pixel; with
# the time of a frame and the error against the last.
# needs: tables/texture.tsv cpu_s_median
# needs: texture/images/*.png
# needs: texture/references/*.png
width = 1000; height = 625
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("texture")
about(i) = caption(sprintf("%.0f ms", cell_value(rows, i, "cpu_s_median")*1e3)). \
    caption(sprintf(", FLIP %.3f, PSNR %.1f dB", cell_value(rows, i, "flip"), cell_value(rows, i, "psnr_db")))
names = "'affine, nearest' 'affine, trilinear' 'perspective-correct, nearest' " \
    ."'perspective-correct, bilinear' 'perspective-correct, trilinear' '64 samples a pixel: the reference'"
set title offset 0,-0.7
set multiplot layout 2,3 margins 0.005,0.995,0.055,0.955 spacing 0.01,0.11
do for [i=0:5] {
    file = i < 5 ? image("texture", i) : results."/texture/references/".text(rows, "cell=0", "reference").".png"
    set title word(names, i + 1)
    set label 1 (i < 5 ? about(i) : "") at graph 0.5, -0.06 center textcolor rgb ink
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
