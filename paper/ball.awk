# A row of pixels through a ball's middle (plots/chord.sh) as TeX numbers: rms of the way that the green light went, absorbed by 1/m, less the
# chord; and the light in units of share^2 e^-d.
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
