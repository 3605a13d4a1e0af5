# What the same bits everywhere cost: CPU time of the program as it is over that of builds without a part of it, by
# instruction set and compiler; geometric mean of three scenes, median of the rounds with its 95% interval.
# needs: tables/determinism.tsv machine=this scene=all price_median
width = 318; height = 300
load "plots/style.gp"

rows = table("determinism")
isas = "sse2 avx2 avx512"
names = "SSE2 AVX2 AVX-512"
compilers = "gcc clang"
parts = "both film contraction"
part_names = "'both' 'fixed-point film' 'no contraction'"
of(part, isa, compiler) = select(rows, sprintf("machine=this scene=all part=%s isa=%s compiler=%s", part, isa, compiler), \
    "price_median price_low? price_high?")
# A band an instruction set, in it a line a compiler, in it a dot a part.
at(i, c, p) = -(3*(i - 1) + 1.35*(c - 1) + 0.33*(p - 1))

unset key
unset border
set border 1 lc rgb ink lw 0.8
unset grid
set grid xtics lc rgb pale lw 0.5 dt solid
set xlabel "CPU time with / without" offset 0,0.3
unset ytics
set yrange [-8.35:0.5]
set xrange [*:*] noextend
set offsets graph 0.06, graph 0.04, 0, 0
set arrow 1 from 1, graph 0 to 1, graph 1 nohead lc rgb ink lw 0.8 front
do for [i=1:3] {
    set label 10 + i word(names, i) at graph -0.30, first at(i, 1, 1) - 1.0 left textcolor rgb ink
    do for [c=1:2] {
        set label 20 + 3*i + c word(compilers, c) at graph -0.02, first at(i, c, 2) right textcolor rgb grey
    }
}
set lmargin at screen 0.24
set rmargin at screen 0.975
set bmargin at screen 0.13
set tmargin at screen 0.92
starts = "0.03 0.17 0.50"
do for [p=1:3] {
    set label 40 + p word(part_names, p) at screen real(word(starts, p)), screen 0.965 left point lt p ps 0.7 textcolor lt p offset 1,0
}
plot for [p=1:3] for [i=1:3] for [c=1:2] of(word(parts, p), word(isas, i), word(compilers, c)) \
    using 1:(at(i, c, p)):2:3 with xerrorbars lt p ps 0.7
