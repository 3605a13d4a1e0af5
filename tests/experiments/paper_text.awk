# The text of the paper as TeX would read it after \val and \claim: numbers filled in, and for each claim the sentence
# that its verdict chooses. n/a for a missing number; nothing for a parameter of a macro.
#   awk -f paper_text.awk numbers.tex claims.tex paper.tex supplement.tex
# The text within the braces that start at rest; what follows stays in rest.
function braces(   depth, i, c) {
    for (i = 1; i <= length(rest); i++) {
        c = substr(rest, i, 1)
        if (c == "\\") { i++; continue }
        depth += (c == "{") - (c == "}")
        if (depth == 0) break
    }
    c = substr(rest, 2, i - 2)
    rest = substr(rest, i + 1)
    return c
}
function expand(text,   out, key, keep, inner) {
    out = ""
    while (match(text, /\\(val|claim)[{]/)) {
        keep = substr(text, RSTART, RLENGTH)
        out = out substr(text, 1, RSTART - 1)
        rest = substr(text, RSTART + RLENGTH - 1)
        key = braces()
        if (keep ~ /val/) { text = rest; out = out ((key in value) ? value[key] : key ~ /#/ ? "" : "n/a"); continue }
        inner = braces()
        text = rest
        out = out expand((key in instead) ? instead[key] : inner)
    }
    return out text
}
FILENAME ~ /(numbers|claims)[.]tex$/ && /^\\setval[{]/ { rest = substr($0, 8); key = braces(); value[key] = braces(); next }
FILENAME ~ /(numbers|claims)[.]tex$/ && /^\\setclaim[{]/ { rest = substr($0, 10); key = braces(); instead[key] = braces(); next }
FILENAME ~ /(numbers|claims)[.]tex$/ { next }
/^\\newcommand|^%/ { next }
{ all = all $0 "\n" }
END { printf "%s", expand(all) }
