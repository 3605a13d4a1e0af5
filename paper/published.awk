# A published series (CSV) as a tab separated table of its columns before the quotation: awk -f published.awk FILE.csv
BEGIN { OFS = "\t" }
{
    # The first columns are numbers and plain words, without quotes or commas.
    count = split($0, field, ",")
    line = ""
    for (i = 1; i <= count && (NR == 1 || field[i] ~ /^[-+0-9.eE]+$/); i++) {
        if (NR == 1 && field[i] == "source") break
        line = line (i > 1 ? OFS : "") field[i]
    }
    print line
}
