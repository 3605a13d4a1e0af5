# The filled vessel, BK7 and water, with the indices of one wavelength and of each wavelength, and their difference.
# needs: tables/spectral.tsv render.spectrum=rgb cell
# needs: tables/spectral.tsv render.spectrum=spectral cell
# needs: spectral/images/0000.png
# needs: spectral/images/0001.png
# needs: spectral/images/0000.pfm
# needs: spectral/images/0001.pfm
width = 1000; height = 790
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("spectral")
with_all(name) = first(rows, "render.spectrum=spectral", name)
single = first(rows, "render.spectrum=rgb", "cell")
spectral = first(rows, "render.spectrum=spectral", "cell")
float_image(cell) = sprintf("%s/spectral/images/%04d.pfm", results, int(cell))
amplified = 3
channel(difference) = difference*amplified > 1 ? 255 : difference*amplified < -1 ? 0 : 127.5*(1 + difference*amplified)

# Crops of the image, in pixels from the left and from the bottom: the vessel, and a place of visible dispersion.
part = "set xrange [120:280]; set yrange [32:252]"
crop_a = "set xrange [148:204]; set yrange [84:126]"
crop_b = "set xrange [214:270]; set yrange [134:176]"
set object 1 rectangle from 148,84 to 204,126 front fs empty border lc rgb ink lw 1
set object 2 rectangle from 214,134 to 270,176 front fs empty border lc rgb ink lw 1
set style textbox opaque noborder fillcolor rgb "white" margins 0.4,0.2
set label 1 "A" at 153,88.5 center font ",11" boxed textcolor rgb ink front
set label 2 "B" at 265,138.5 center font ",11" boxed textcolor rgb ink front

set multiplot
set tmargin at screen 0.955
set bmargin at screen 0.383
panel(i) = sprintf("set lmargin at screen %.4f; set rmargin at screen %.4f", 0.005 + i*0.3325, 0.005 + i*0.3325 + 0.3245)
do for [i=0:2] {
    eval panel(i)
    eval part
    if (i < 2) {
        set title i ? "the index of each wavelength" : "one wavelength, 587.6 nm"
        plot image("spectral", i ? spectral : single) binary filetype=png with rgbimage notitle
    } else {
        set title sprintf("their difference; grey: 0, black and white: ±%.2f", 1.0/amplified)
        set datafile separator whitespace
        plot sprintf("< plots/difference.sh '%s' '%s'", float_image(spectral), float_image(single)) \
            using 1:2:(channel($4)):(channel($5)):(channel($6)) with rgbimage notitle
        set datafile separator tab
    }
}
unset object; unset label
ratio(name) = with_all(name)/first(rows, "render.spectrum=rgb", name)
said = sprintf("FLIP %.4f, PSNR %.1f dB, SSIM %.4f between the two; %.0f %% of the pixels differ in 8 bits. ", \
    with_all("flip"), with_all("psnr_db"), with_all("ssim"), with_all("differing_fraction")*100)
set label 1 said.sprintf("48 wavelengths: %.0f times the rays.", ratio("rays_total")) at screen 0.5,0.045 center font ",10" textcolor rgb ink
set tmargin at screen 0.333
set bmargin at screen 0.098
do for [i=0:3] {
    set lmargin at screen 0.005 + i*0.2492
    set rmargin at screen 0.005 + i*0.2492 + 0.2425
    eval i < 2 ? crop_a : crop_b
    set title (i < 2 ? "A" : "B").(i % 2 ? ", each wavelength" : ", one wavelength")
    plot image("spectral", i % 2 ? spectral : single) binary filetype=png with rgbimage notitle
    unset label
}
unset multiplot
