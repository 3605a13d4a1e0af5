# Order statistics for the tables of the benches. A list is a text of numbers separated by spaces; sorted() stores them
# in out in ascending order, from index 1, and returns their count.
function sorted(list, out,   n, i, j, t) {
    n = split(list, out, " ")
    for (i = 2; i <= n; i++)
        for (j = i; j > 1 && out[j - 1] + 0 > out[j] + 0; j--) {
            t = out[j]; out[j] = out[j - 1]; out[j - 1] = t
        }
    return n
}
function median(list,   n, v) {
    n = sorted(list, v)
    return n ? (v[int((n + 1) / 2)] + v[int((n + 2) / 2)]) / 2 : 0
}
# "median (lowest to highest)"; form is the format of one number, such as "%.2f"
function spread(list, form,   n, v) {
    n = sorted(list, v)
    return sprintf(form " (" form " to " form ")", median(list), v[1], v[n])
}
# The same of the ratios of two lists, round by round.
function spread_of_ratios(above, below, form,   n, a, b, i, list) {
    n = split(above, a, " ")
    split(below, b, " ")
    for (i = 1; i <= n; i++) list = list " " a[i] / b[i]
    return spread(list, form)
}
# A line of a table: what, the median, and in how many rounds and what range.
function summary(what, list,   n, v) {
    n = sorted(list, v)
    printf "%-66s %8.3f   (%d rounds, %.3f to %.3f)\n", what, median(list), n, v[1], v[n]
}
