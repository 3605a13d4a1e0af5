# The sentences of a paper that have a measured number (\val) outside of every \claim, one line each: number of the line,
# key.
#   awk -f unclaimed.awk paper.tex
# Not measured here, and so allowed: published numbers, which published.sh checks, facts of the machine, and the
# numbers of claims themselves. Tables, captions and macros are no sentences. In them alone stands how often a study
# measured each cell (STUDY/n, STUDY/bars).
# Skips a group in brackets that starts at position at; returns the position after it.
function after_group(at, opening, closing,   depth, c) {
    for (; at <= length(text); at++) {
        c = substr(text, at, 1)
        if (c == "\\") { at++; continue }
        if (c == "\n") line++
        depth += (c == opening) - (c == closing)
        if (depth == 0) return at + 1
    }
    return at
}
function after_braces(at) { return after_group(at, "{", "}") }
# \newcommand{\name}[arguments][default]{text}: the position after it, from that of its first brace on.
function after_macro(at) {
    at = after_braces(at)
    while (starts(at, "[")) at = after_group(at, "[", "]")
    return after_braces(at)
}
function starts(at, what) { return substr(text, at, length(what)) == what }
function key_at(at,   rest) {
    rest = substr(text, at, 120)
    if (!match(rest, /^\\val[{][^}]*[}]|^\\valor[{][^}]*[}][{][^}]*[}]|^\\interval[{][^}]*[}]/)) return ""
    rest = substr(rest, 1, RLENGTH - 1)
    sub(/.*[{]/, "", rest)
    return rest
}
{ text = text ($0 ~ /^[ \t]*%/ ? "" : $0) "\n" }
END {
    line = 1
    for (at = 1; at <= length(text); at++) {
        if (starts(at, "\n")) line++
        if (starts(at, "\\claim{")) { at = after_braces(after_braces(at + 6)) - 1; continue }
        if (starts(at, "\\caption{")) { at = after_braces(at + 8) - 1; continue }
        if (starts(at, "\\newcommand{")) { at = after_macro(at + 11) - 1; continue }
        if (starts(at, "\\renewcommand{")) { at = after_macro(at + 13) - 1; continue }
        if (starts(at, "\\begin{tabular}") || starts(at, "\\begin{longtable}")) table = 1
        if (starts(at, "\\end{tabular}") || starts(at, "\\end{longtable}")) table = 0
        if (table || substr(text, at, 1) != "\\") continue
        key = key_at(at)
        if (key != "" && key !~ /^(published|claims|machine)\//) printf "%d: %s\n", line, key
    }
}
