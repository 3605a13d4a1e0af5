# Images of a ball of slime over the grid of transparency and absorption.
# needs: tables/slime-optics.tsv jelly.transparency
# needs: slime-optics/images/*.png
width = 1000; height = 800
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("slime-optics")
fractions = system(select(rows, "", "jelly.transparency")[3:*]." | sort -gu | tr '\\n' ' '")
absorbs = system(select(rows, "", "jelly.absorb_per_m")[3:*]." | awk '!seen[$0]++' | tr '\\n' ' '")
set multiplot layout words(fractions),words(absorbs) margins 0.06,0.995,0.005,0.93 spacing 0.006,0.006
set label 1 "absorption of red, green, blue / (1/m)" at screen 0.53,0.983 center font ",12"
set label 2 "transparency" at screen 0.015,0.47 center rotate font ",12"
do for [i=1:words(fractions)] {
    do for [k=1:words(absorbs)] {
        cell = first(rows, sprintf("jelly.transparency=%s jelly.absorb_per_m=%s", word(fractions, i), word(absorbs, k)), "cell")
        file = cell >= 0 ? image("slime-optics", cell) : ""
        set title (i == 1 ? system("echo '".word(absorbs, k)."' | sed 's/,/, /g'") : "")
        set ylabel (k == 1 ? word(fractions, i) : "") rotate by 0
        if (readable(file)) {
            plot file binary filetype=png with rgbimage notitle
        } else {
            @empty
        }
        unset label 1
        unset label 2
    }
}
unset multiplot
