# Access of figures and paper to the measured rows. Input: results, a folder as described in results/README.md.
set datafile missing "NA"
set datafile separator tab

table(study) = results."/tables/".study.".tsv"
image(study, cell) = sprintf("%s/%s/images/%04d.png", results, study, int(cell))
readable(path) = int(system("test -r '".path."' && echo 1 || echo 0"))

# The lines of a table or of rows whose columns have the given values, as tab separated numbers; see select.awk.
query(file, where, columns) = sprintf("-v where='%s' -v columns='%s' '%s'", where, columns, file)
select(file, where, columns) = "< awk -f plots/select.awk ".query(file, where, columns)
# text(): the first value as text; first(): as a number; largest(): the largest value. has_rows(): whether a
# command prints a line.
text(file, where, column) = system("awk -f plots/select.awk -v most=1 ".query(file, where, column))
largest(file, column) = number(system(select(file, "", column)[3:*]." | sort -g | tail -n 1"))
has_rows(command) = int(system(command[3:*]." | sed -n 1p | wc -l")) > 0
number(text) = text eq "" ? NaN : real(text)
first(file, where, column) = number(text(file, where, column))
# What a reader must know about the cells of a study: what fraction of the machine other processes used, in the mean,
# and that few repetitions give no intervals.
others(study) = number(system(select(table(study), "", "others_fraction")[3:*]." | awk '{ sum += $1 } END { if (NR) print sum/NR }'"))
fewest(study) = number(system(select(table(study), "", "n")[3:*]." | sort -g | awk '$1 > 0 { print $1; exit }'"))
noisy(fraction) = fraction > 0.05 ? sprintf("other processes used %.0f %% of the machine during this run", fraction*100) : ""
counted(n) = n < 6 ? sprintf("%d repetition%s a cell: no intervals", n, n > 1 ? "s" : "") : ""
joined(a, b) = a.(a ne "" && b ne "" ? "; " : "").b
remarks(study) = joined(noisy(others(study)), counted(fewest(study)))
# The upper end of a quotient; no end where the divisor has none.
over(high, low) = low > 0 ? high/low : low <= 0 ? 1e3 : NaN

# A panel without an image or a row.
empty = "set label 9998 'no data' at graph 0.5,0.5 center textcolor rgb grey; plot [1:2] [1:2] NaN notitle; unset label 9998"

# PFM: three lines of text, then little-endian floats from the bottom row up.
pfm_start(path) = int(system("head -n 3 '".path."' | wc -c"))
pfm_line(path) = system("head -n 2 '".path."' | tail -n 1")
pfm_channels(path) = system("head -c 2 '".path."'") eq "PF" ? 3 : 1
pfm(path) = sprintf("binary skip=%d array=(%s,%s) format='%s' endian=little", pfm_start(path), \
    word(pfm_line(path), 1), word(pfm_line(path), 2), pfm_channels(path) == 3 ? "%float%float%float" : "%float")
