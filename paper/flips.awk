# The rates of experiments/repeat.sh as one table and as numbers of the paper. One file a call: power.tsv of a folder.
#   awk -v machine=here -v load=found -v others=0.83 -v table=flips.tsv -f flips.awk power.tsv
# Appends to the table: machine, load, others (share of the machine that other processes used, mean of the rows),
# contrast, work (ratio of the rays), order, design (processes x repetitions of each), processes, repetitions, rule, n
# (studies that share no process), the ratio of all rows, and the shares of studies with a wrong claim and without
# one, with their intervals.
# Prints \setval{flips/MACHINE/LOAD/CONTRAST/ORDER/DESIGN/RULE} in per cent, and .../silent.
BEGIN {
    FS = OFS = "\t"
    count = split(works, word, "[ \n]+") # name and ratio, of each
    for (i = 1; i < count; i += 2) work[word[i]] = word[i + 1]
}
NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
function field(name) { return (name in at) ? $at[name] : "NA" }
function per_cent(share) { return sprintf("%.0f", 100 * share) }
function set_share(key, name) {
    printf "\\setval{%s}{%s\\within{%s}{%s}}\n", key, per_cent(field(name)), per_cent(field(name "_low")),
        per_cent(field(name "_high"))
}
{
    design = field("processes") "x" field("repetitions")
    print machine, load, others, $1, ($1 in work) ? work[$1] : 1, field("order"), design,
        field("processes"), field("repetitions"), field("rule"),
        field("independent"), field("ratio"), field("ratio_low"), field("ratio_high"), field("wrong"),
        field("wrong_low"), field("wrong_high"), field("silent"), field("silent_low"), field("silent_high") >>table
    key = "flips/" machine "/" load "/" $1
    if (!($1 in seen) && field("ratio_low") != "NA") {
        seen[$1] = 1
        printf "\\setval{%s/ratio}{%.2f\\within{%.2f}{%.2f}}\n", key, field("ratio"), field("ratio_low"),
            field("ratio_high")
    }
    # Of two cells only the order of our own studies is quoted: both in the same processes.
    if (field("cell_a") != field("cell_b") && field("order") != "together") next
    key = key "/" field("order") "/" design
    if (!(key in seen)) printf "\\setval{%s/n}{%d}\n", key, field("independent")
    seen[key] = 1
    set_share(key "/" field("rule"), "wrong")
    set_share(key "/" field("rule") "/silent", "silent")
}
