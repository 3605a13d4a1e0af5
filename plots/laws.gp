# A law of speed-up fitted to the threads study for each schedule. The figure draws it, the paper prints its parameters.
#   Gunther 1993:  S = p / (1 + σ (p - 1) + κ n (n - 1)),   σ: the serial share, κ: the cost of coherence between each
#                                                           pair of threads
# n threads on u processing units run p = min(n, u) at a time, so the serial share acts on p, while all n threads
# exchange data. For n <= u it is the law as published. κ is stored in millionths.
# Requires at least two units, and more rows than parameters; `gunther_fits` is 1 if that holds.
rows = table("threads")
schedules = "columns rows tiles dynamic"
times(schedule) = select(rows, "render.schedule=".schedule, "render.threads wall_s_median wall_s_low wall_s_high")
wall_1(schedule) = first(rows, "render.threads=1 render.schedule=".schedule, "wall_s_median")

together(n) = units > 0 && n > units ? units : n
gunther(n, s, k) = together(n) / (1 + s*(together(n) - 1) + k*1e-6*n*(n - 1))

array gunther_fits[4]; array gunther_s[4]; array gunther_s_error[4]; array gunther_k[4]; array gunther_k_error[4]
do for [i=1:4] {
    schedule = word(schedules, i)
    lines = int(system(times(schedule)[3:*]." | wc -l"))
    one = wall_1(schedule)
    gunther_fits[i] = units > 1 && one > 0 && lines >= 4
    s = 0.01; k = 0.01
    if (gunther_fits[i]) {
        fit gunther(x, s, k) times(schedule) using 1:(one/$2) via s, k
        gunther_s[i] = s; gunther_s_error[i] = s_err; gunther_k[i] = k; gunther_k_error[i] = k_err
    }
}
