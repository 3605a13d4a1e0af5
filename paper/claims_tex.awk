# The verdicts (claims.awk) for TeX: \setclaim{id}{sentence} for each claim that is not reproduced, or whose sentence in the
# paper has a number that the rows do not give, with the sentence that the paper prints instead; the numbers of claims; and
# \claimtable, the lines of the table of claims.
#   awk -v environments='HEX ...' -f claims_tex.awk numbers.tex VERDICTS.tsv paper.tex supplement.tex
function plain(text) {
    gsub(/[\\{}~^]/, " ", text)
    gsub(/[_%$#&]/, "\\\\&", text)
    return text
}
# The text within the braces that start the global rest; what follows stays in rest.
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
# Sets lacking[id] to a number that a sentence of the claim has, and the rows do not give.
function look_for_numbers(   id, body, key) {
    rest = paper
    while (match(rest, /\\claim[{]/)) {
        rest = substr(rest, RSTART + RLENGTH - 1)
        id = braces()
        body = braces()
        while (match(body, /\\val[{][^}]*[}]/)) {
            key = substr(body, RSTART + 5, RLENGTH - 6)
            body = substr(body, RSTART + RLENGTH)
            if (!(key in known)) lacking[id] = key
        }
    }
}
# A sentence starts with a capital letter, except if it starts with a name in lower case, which none does.
function capital(text) { return toupper(substr(text, 1, 1)) substr(text, 2) }
function measured(   text) {
    text = $3 == "-" ? "" : "measured: " $3
    if ($4 != "-") text = text (text == "" ? "" : "; ") $4
    return plain(text)
}
function judge(line,   id, verdict) {
    $0 = line
    id = $1
    verdict = $2
    number[verdict]++
    if ($4 ~ /^no rows say it/) tests++
    if (verdict == "reproduced" && (id in lacking))
        printf "\\setclaim{%s}{\\emph{Reproduced, but without all numbers of this sentence:} %s (%s).}\n", id, plain($5), measured()
    if (verdict == "not reproduced")
        printf "\\setclaim{%s}{\\emph{Not reproduced on these rows:} %s (%s).}\n", id, plain($5), measured()
    if (verdict == "underpowered")
        printf "\\setclaim{%s}{\\emph{These rows cannot establish whether} %s (%s).}\n", id, plain($5), measured()
    return sprintf("%s & %s & %s \\\\", plain(capital($5)), verdict, plain($3 == "-" ? "" : $3))
}
BEGIN { FS = "\t" }
FILENAME == ARGV[1] {
    if (match($0, /^\\setval[{][^}]*[}]/)) known[substr($0, 9, RLENGTH - 9)] = 1
    next
}
FILENAME == ARGV[2] { verdict_of[++claims] = $0; next }
!/^\\newcommand|^%/ { paper = paper $0 "\n" }
END {
    look_for_numbers()
    for (i = 1; i <= claims; i++) line_of[i] = judge(verdict_of[i])
    printf "\\setval{claims/all}{%d}\n\\setval{claims/reproduced}{%d}\n", claims, number["reproduced"]
    printf "\\setval{claims/not-reproduced}{%d}\n\\setval{claims/tests}{%d}\n", number["not reproduced"], tests
    printf "\\setval{claims/underpowered}{%d}\n", number["underpowered"] - tests
    sub(/ +$/, "", environments)
    gsub(/ /, ", ", environments)
    printf "\\setval{claims/environments}{%s}\n", environments
    print "\\newcommand{\\claimtable}{%"
    for (i = 1; i <= claims; i++) print line_of[i]
    print "}"
}
