# Two laws of speed-up fitted to the threads study, for each schedule; the figure draws them, the paper prints them.
#   Amdahl 1967:   S = p / (1 + σ (p - 1)),                 σ: the serial share
#   Gunther 1993:  S = p / (1 + σ (p - 1) + κ n (n - 1)),   κ: the cost of the exchange of each thread with each other
# Of n threads on u processing units p = min(n, u) run at a time; so the serial share acts on p, while every thread
# takes part in the exchange. For n <= u both are the laws as published. κ is stored in millionths.
# A fit requires at least two units, and one row more than parameters; `amdahl_fits` and `gunther_fits` are 1 if there were enough.
rows = table("threads")
schedules = "columns rows tiles dynamic"
times(schedule) = select(rows, "render.schedule=".schedule, "render.threads wall_s_median wall_s_low wall_s_high")
wall_1(schedule) = first(rows, "render.threads=1 render.schedule=".schedule, "wall_s_median")

together(n) = units > 0 && n > units ? units : n
amdahl(n, s) = together(n) / (1 + s*(together(n) - 1))
gunther(n, s, k) = together(n) / (1 + s*(together(n) - 1) + k*1e-6*n*(n - 1))

array amdahl_fits[4]; array amdahl_s[4]; array amdahl_s_error[4]
array gunther_fits[4]; array gunther_s[4]; array gunther_s_error[4]; array gunther_k[4]; array gunther_k_error[4]
do for [i=1:4] {
    schedule = word(schedules, i)
    lines = int(system(times(schedule)[3:*]." | wc -l"))
    one = wall_1(schedule)
    amdahl_fits[i] = units > 1 && one > 0 && lines >= 3
    gunther_fits[i] = units > 1 && one > 0 && lines >= 4
    s = 0.01
    if (amdahl_fits[i]) {
        fit amdahl(x, s) times(schedule) using 1:(one/$2) via s
        amdahl_s[i] = s; amdahl_s_error[i] = s_err
    }
    s = 0.01; k = 0.01
    if (gunther_fits[i]) {
        fit gunther(x, s, k) times(schedule) using 1:(one/$2) via s, k
        gunther_s[i] = s; gunther_s_error[i] = s_err; gunther_k[i] = k; gunther_k_error[i] = k_err
    }
}
