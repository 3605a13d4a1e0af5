# Columns by name from a table with a header line (tab separated .tsv, or .csv after RFC 4180, one line per row), for the
# lines where other columns have given values; tab separated, lines with NA are left out.
#   awk -f select.awk -v where='render.schedule=rows warmup=0' -v columns='render.threads wall_s_median' FILE
# A column that the table lacks counts as NA. Numbers are compared as numbers.
function same(a, b) {
    return a == b || (a ~ number && b ~ number && a + 0 == b + 0)
}
# Splits a line of CSV: within quotes a comma is text, and a quote is doubled.
function cut_csv(line, field,   n, text) {
    if (line !~ /"/) return split(line, field, ",")
    split("", field)
    for (;;) {
        if (match(line, /^"([^"]|"")*"/)) {
            text = substr(line, 2, RLENGTH - 2)
            gsub(/""/, "\"", text)
        } else {
            match(line, /^[^,]*/)
            text = substr(line, 1, RLENGTH)
        }
        line = substr(line, RLENGTH + 1)
        field[++n] = text
        if (line == "") return n
        line = substr(line, 2)
    }
}
BEGIN {
    number = "^[-+]?[0-9]+[.]?[0-9]*([eE][-+]?[0-9]+)?$"
    conditions = split(where, condition, " ")
    wanted = split(columns, name, " ")
}
{
    gsub(/\r/, "")
    if (FILENAME ~ /\.csv$/) fields = cut_csv($0, field)
    else {
        gsub(/"/, "")
        fields = split($0, field, "\t")
    }
}
FNR == 1 {
    for (i = 1; i <= fields; i++) place[field[i]] = i
    next
}
{
    for (i = 1; i <= conditions; i++) {
        cut = index(condition[i], "=")
        key = substr(condition[i], 1, cut - 1)
        if (!(key in place) || !same(field[place[key]], substr(condition[i], cut + 1))) next
    }
    line = ""
    for (i = 1; i <= wanted; i++) {
        value = (name[i] in place) ? field[place[name[i]]] : "NA"
        if (value == "NA" || value == "") next
        line = line (i > 1 ? "\t" : "") value
    }
    print line
}
