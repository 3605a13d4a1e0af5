# Print TeX numbers of a row of pixels through a ball's centre (plots/chord.sh): the rms difference of the path length of green light,
# absorbed by 1/m, and the chord; and the deviation of the light from share^2 e^-d.
#   plots/chord.sh ... | awk -v level=7 -v share=1 -f scientific.awk -f ball.awk
{
    off = -log($3 / share ^ 2) - $1
    sum += off * off
    relative = $3 / (share ^ 2 * exp(-$1)) - 1
    if (relative < 0) relative = -relative
    if (relative > worst) worst = relative
}
END {
    key = "slime-light/" level "/" share
    printf "\\setval{%s/off}{%s}\n", key, scientific(sqrt(sum / NR))
    printf "\\setval{%s/worst}{%s}\n", key, scientific(worst + 0)
    printf "\\setval{%s/pixels}{%d}\n", key, NR
}
