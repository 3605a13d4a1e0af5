# The tables of cuvette-validation(7), as roff: awk -f src/manual/validation.awk experiments/validation/*.cases
# experiments/validation/cases.csv (the build does). The files of cases have the title of each kind and what it is about,
# the rows all else.

function escaped(text) {
    gsub(/\\/, "\\e", text)
    gsub(/\^/, "\\(ha", text)
    gsub(/~/, "\\(ti", text)
    gsub(/-/, "\\-", text)
    return text ~ /^[.']/ ? "\\&" text : text
}

# Splits a line of CSV into field[1], field[2], ...
function split_line(line, count, at, text) {
    count = 0
    for (line = line ","; line != ""; line = substr(line, at + 1)) {
        text = ""
        while (substr(line, 1, 1) == "\"") {
            at = index(substr(line, 2), "\"")
            text = text (text != "" || again ? "\"" : "") substr(line, 2, at - 1)
            again = 1
            line = substr(line, at + 2)
        }
        again = 0
        at = index(line, ",")
        field[++count] = text substr(line, 1, at - 1)
    }
    return count
}

# Six digits, or the exponent of a small number.
function number(text) {
    return escaped(sprintf("%.9g", text))
}

function small(text) {
    return escaped(sprintf("%.2g", text))
}

FNR == 1 { heads = FILENAME ~ /\.cases$/; kind = key = "" }
heads && /^\[/ { kind = kind == "" ? substr($0, 2, length($0) - 2) : "no kind"; next }
heads && kind != "no kind" && /^(title|about): / { key = substr($1, 1, length($1) - 1); sub(/^[a-z]+: */, "") }
heads && kind != "no kind" && key != "" && NF { sub(/^ +/, ""); head[kind, key] = head[kind, key] ($0 ? $0 "\n" : "") }
heads { next }
FNR == 1 {
    for (i = split_line($0); i > 0; i--)
        column[field[i]] = i
    next
}
{
    split_line($0)
    is_limit = field[column["nature"]] != ""
    total += !is_limit
    limits += is_limit
    passed += !is_limit && field[column["verdict"]] == "pass"
    if (field[column["kind"]] != kind) {
        kind = field[column["kind"]]
        printf ".SS %s%s", escaped(head[kind, "title"]), escaped(head[kind, "about"])
    }
    unit = field[column["unit"]] == "" ? "" : " " escaped(field[column["unit"]])
    print ".TP\n\\fB" escaped(field[column["case"]]) "\\fR"
    print escaped(field[column["what"]]) "."
    if (is_limit)
        print "Nature " number(field[column["nature"]]) unit ", the program " number(field[column["ours"]]) unit \
            ": it is off by " number(field[column["ours"]] - field[column["nature"]]) unit "."
    print (is_limit ? "By rays " : "Expected ") number(field[column["expected"]]) unit ", computed " number(field[column["ours"]]) unit \
        "; deviation " small(field[column["deviation"]]) ", tolerance " small(field[column["tolerance"]]) ": " \
        escaped(field[column["reason"]]) "."
    print "Source: " escaped(field[column["source"]]) "."
}
END {
    print ".SS Summary\n" passed " of " total " cases are within their tolerances."
    print "There are " limits " further cases, limits of rays, where nature differs from the program."
}
