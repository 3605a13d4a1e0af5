# The fitted law of plots/laws.gp as TeX numbers.
load "plots/rows.gp"
load "plots/laws.gp"
set print "-"
do for [i=1:4] {
    key = "law/".word(schedules, i)
    if (gunther_fits[i]) {
        print sprintf('\setval{%s/sigma}{\ensuremath{%.4f \pm %.4f}}', key, gunther_s[i], gunther_s_error[i])
        print sprintf('\setval{%s/kappa}{\ensuremath{(%.2f \pm %.2f)\cdot 10^{-6}}}', key, gunther_k[i], gunther_k_error[i])
    }
}
