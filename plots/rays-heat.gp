# Distribution of the work: rays of all kinds and time per pixel of one frame.
# The color scale excludes 1 % of the pixels at either end.
# needs: maps/images/0000-rays.pfm
# needs: maps/images/0000-ns.pfm
width = 1000; height = 338
load "plots/style.gp"

load "plots/image_panels.gp"
values(kind) = sprintf("%s/maps/images/0000-%s.pfm", results, kind)
set palette defined @viridis
set logscale cb 10
set cbtics ("1" 1, "2" 2, "5" 5, "10" 10, "20" 20, "50" 50, "100" 100, "200" 200, "500" 500, "1000" 1000, "2000" 2000, \
    "5000" 5000, "10^4" 1e4, "2·10^4" 2e4, "5·10^4" 5e4, "10^5" 1e5) textcolor rgb ink scale 0.4
set border 15 lc rgb pale
set multiplot layout 1,2 margins 0.01,0.92,0.02,0.93 spacing 0.1,0
do for [kind in "rays ns"] {
    set title kind eq "rays" ? "rays / pixel" : "time per pixel / ns"
    set colorbox user origin (kind eq "rays" ? 0.425 : 0.93),0.03 size 0.013,0.87
    ends = system("plots/range.sh '".values(kind)."'")
    set cbrange [real(word(ends, 1)):real(word(ends, 2))]
    eval sprintf("plot values(kind) %s using ($1 > 0 ? $1 : NaN) with image notitle", pfm(values(kind)))
}
unset multiplot
