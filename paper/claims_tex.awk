# The verdicts (claims.awk) for TeX: \setclaim{id}{sentence} for each claim that is not reproduced, with the sentence that
# the paper prints instead; the numbers of claims; and \claimtable, the lines of the table of claims.
#   awk -v environments='HEX ...' -f claims_tex.awk VERDICTS.tsv
function plain(text) {
    gsub(/[\\{}~^]/, " ", text)
    gsub(/[_%$#&]/, "\\\\&", text)
    return text
}
# A sentence starts with a capital letter, except if it starts with a name in lower case, which none does.
function capital(text) { return toupper(substr(text, 1, 1)) substr(text, 2) }
function measured(   text) {
    text = $3 == "-" ? "" : "measured: " $3
    if ($4 != "-") text = text (text == "" ? "" : "; ") $4
    return plain(text)
}
BEGIN { FS = "\t" }
{
    number[$2]++
    if ($2 == "not reproduced")
        printf "\\setclaim{%s}{\\emph{Not reproduced on these rows:} %s (%s).}\n", $1, plain($5), measured()
    if ($2 == "underpowered")
        printf "\\setclaim{%s}{\\emph{These rows cannot establish whether} %s (%s).}\n", $1, plain($5), measured()
    line[NR] = sprintf("%s & %s & %s \\\\", plain(capital($5)), $2, plain($3 == "-" ? "" : $3))
}
END {
    printf "\\setval{claims/all}{%d}\n\\setval{claims/reproduced}{%d}\n", NR, number["reproduced"]
    printf "\\setval{claims/not-reproduced}{%d}\n\\setval{claims/underpowered}{%d}\n", number["not reproduced"], number["underpowered"]
    sub(/ +$/, "", environments)
    gsub(/ /, ", ", environments)
    printf "\\setval{claims/environments}{%s}\n", environments
    print "\\newcommand{\\claimtable}{%"
    for (i = 1; i <= NR; i++) print line[i]
    print "}"
}
