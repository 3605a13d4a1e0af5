# Columns by name from a table with a header line (tab separated .tsv, or .csv after RFC 4180, one line per row), for
# the lines where other columns have given values; tab separated, lines with NA are left out. Numbers are compared as
# numbers. A column that the file lacks is an error, a line on stderr.
#   awk -f select.awk -v where='render.schedule=rows warmup=0' -v columns='render.threads wall_s_median wall_s_low?' \
#       [-v most=1] FILE
# NaN stands for an NA in a column with a question mark. most: print only the first ones.
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
function in_place(name) {
    if (name in place) return place[name]
    print FILENAME " has no column " name >"/dev/stderr"
    exit 1
}
BEGIN {
    number = "^[-+]?[0-9]+[.]?[0-9]*([eE][-+]?[0-9]+)?$"
    conditions = split(where, condition, " ")
    wanted = split(columns, name, " ")
    for (i = 1; i <= conditions; i++) {
        cut = index(condition[i], "=")
        key[i] = substr(condition[i], 1, cut - 1)
        asked[i] = substr(condition[i], cut + 1)
    }
    for (i = 1; i <= wanted; i++) unknown[i] = sub(/\?$/, "", name[i]) ? "NaN" : ""
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
    for (i = 1; i <= conditions; i++) key[i] = in_place(key[i])
    for (i = 1; i <= wanted; i++) name[i] = in_place(name[i])
    next
}
{
    for (i = 1; i <= conditions; i++)
        if (!same(field[key[i]], asked[i])) next
    line = ""
    for (i = 1; i <= wanted; i++) {
        value = field[name[i]]
        if (value == "NA" || value == "") value = unknown[i]
        if (value == "") next
        line = line (i > 1 ? "\t" : "") value
    }
    print line
    if (++printed == most) exit
}
