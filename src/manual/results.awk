# The part of cuvette-results(5) that results/README.md holds, as roff: awk -f src/manual/results.awk results/README.md
# (the build does). A row of a table becomes a tagged paragraph, a section a .SS.

function escaped(text, hyphens) {
    gsub(/\\/, "\\e", text)
    gsub(/\^/, "\\(ha", text)
    gsub(/~/, "\\(ti", text)
    if (hyphens)
        gsub(/-/, "\\-", text)
    return text
}

# `code` in bold, **words** in italics, a link without its address.
function inline(text, out, i, part, count, bold, word, piece, j) {
    while (match(text, /\[[^]]*\]\([^)]*\)/)) {
        word = substr(text, RSTART + 1, index(substr(text, RSTART), "](") - 2)
        text = substr(text, 1, RSTART - 1) word substr(text, RSTART + RLENGTH)
    }
    count = split(text, part, "`")
    for (i = 1; i <= count; i++) {
        if (i % 2 == 0) {
            out = out "\\fB" escaped(part[i], 1) "\\fR"
            continue
        }
        bold = split(escaped(part[i], 0), piece, /\*\*/)
        for (j = 1; j <= bold; j++)
            out = out (j > 1 ? (j % 2 == 0 ? "\\fI" : "\\fR") : "") piece[j]
    }
    return out ~ /^[.']/ ? "\\&" out : out
}

function row(line, cell, count, unit, meaning) {
    count = split(line, cell, / *\| */)
    unit = count > 4 ? cell[3] : ""
    meaning = count > 4 ? cell[4] : cell[3]
    print ".TP\n" inline(cell[2]) (unit != "" ? " (" inline(unit) ")" : "")
    print meaning != "" ? inline(meaning) "." : "\\&"
}

NR == 1 { next } # the title
/^## / { print ".SS " inline(substr($0, 4)); head = 1; blank = 0; next }
/^$/ { blank = 1; next }
/^\|/ {
    if (!table)
        table = 2 # the header; the line below it is the next
    else
        table++
    if (table > 3)
        row($0)
    head = blank = 0
    next
}
{ table = 0 }
/^- / { print ".IP \\(bu 2\n" inline(substr($0, 3)); head = blank = 0; next }
{
    sub(/^ +/, "")
    if (blank && !head && NR > 3)
        print ".PP"
    print inline($0)
    head = blank = 0
}
