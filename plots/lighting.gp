# One scene with three lighting models and by path tracing, for table 2 of the rod's report (Gouraud shading is in
# shading.gp); each image with its time and its error against the last.
# needs: tables/lighting.tsv wall_s_median
# needs: lighting/images/*.png
# needs: lighting/references/*.png
width = 1000; height = 880
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("lighting")
names = "'Lambert: diffuse light' 'Phong: highlights too' 'Whitted: reflection and refraction too' 'path tracing: the reference'"
set title offset 0,-0.7
about(i) = caption(sprintf("%.3f s / frame", cell_value(rows, i, "wall_s_median"))). \
    caption(sprintf(", FLIP %.3f, PSNR %.1f dB", cell_value(rows, i, "flip"), cell_value(rows, i, "psnr_db")))
set multiplot layout 2,2 margins 0.01,0.99,0.045,0.965 spacing 0.015,0.085
do for [i=0:3] {
    file = i < 3 ? image("lighting", i) : results."/lighting/references/".text(rows, "cell=0", "reference").".png"
    set title word(names, i + 1)
    set label 1 (i < 3 ? about(i) : caption(sprintf("noise %.2g rms, linear", first(rows, "cell=0", "reference_noise_rms")))) \
        at graph 0.5, -0.04 center textcolor rgb ink
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
