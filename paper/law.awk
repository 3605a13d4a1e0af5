# Laws of speed-up fitted by least squares of relative deviations, for comparison with share.awk.
#   Amdahl 1967       S = p / (1 + s (p - 1))
#   Gunther 1993      S = p / (1 + s (p - 1) + k n (n - 1))      the universal scalability law
# n threads, p of which run at a time: p = n as published, or p = min(n, units) (as in plots/laws.gp).
function law(n, s, k, units,   p) {
    p = units && n > units ? units : n
    return p / (1 + s * (p - 1) + k * n * (n - 1))
}
# The sum of squares of ln(law / speed) over the counts 1..many.
function misfit(n, speed, many, s, k, units,   i, d, sum) {
    for (i = 1; i <= many; i++) {
        d = log(law(n[i], s, k, units) / speed[i])
        sum += d * d
    }
    return sum
}
# The least misfit over s for one k, by golden sections of ln s; sets law_s.
function profile(n, speed, many, k, units,   low, high, a, b, ma, mb, none, step) {
    low = -14
    high = 0
    a = high - golden * (high - low)
    b = low + golden * (high - low)
    ma = misfit(n, speed, many, exp(a), k, units)
    mb = misfit(n, speed, many, exp(b), k, units)
    for (step = 0; step < 50; step++)
        if (ma < mb) {
            high = b; b = a; mb = ma
            a = high - golden * (high - low)
            ma = misfit(n, speed, many, exp(a), k, units)
        } else {
            low = a; a = b; ma = mb
            b = low + golden * (high - low)
            mb = misfit(n, speed, many, exp(b), k, units)
        }
    law_s = exp((low + high) / 2)
    none = misfit(n, speed, many, 0, k, units)
    if (none > ma) return ma
    law_s = 0
    return none
}
# Fits law_s, and law_k if two is not 0: k is 0 or a power of ten of a grid, refined around its best point.
function fit_law(n, speed, many, two, units,   best, sum, middle, step, from, round, i) {
    golden = (sqrt(5) - 1) / 2
    law_k = 0
    best = profile(n, speed, many, 0, units)
    middle = -6
    step = 0.25
    for (round = 0; two && round < 6; round++) {
        from = middle
        for (i = -20; i <= 20; i++) {
            sum = profile(n, speed, many, 10 ^ (from + i * step), units)
            if (sum < best) {
                best = sum
                middle = from + i * step
                law_k = 10 ^ middle
            }
        }
        step /= 10
    }
    profile(n, speed, many, law_k, units)
}
