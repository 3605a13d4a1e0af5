# Access of figures and paper to the measured rows. Input: results, a folder as described in results/README.md.
set datafile missing "NA"
set datafile separator tab
set fit quiet nolog errorvariables

table(study) = results."/tables/".study.".tsv"
image(study, cell) = sprintf("%s/%s/images/%04d.png", results, study, int(cell))
readable(path) = int(system("test -r '".path."' && echo 1 || echo 0"))

# The lines of a table or of rows whose columns have the given values, as tab separated numbers; see select.awk.
select(file, where, columns) = sprintf("< awk -f plots/select.awk -v where='%s' -v columns='%s' '%s'", where, columns, file)
# text(): the first value as text; first(): as a number; largest(): the largest value.
text(file, where, column) = system(select(file, where, column)[3:*]." | head -n 1")
largest(file, column) = number(system(select(file, "", column)[3:*]." | sort -g | tail -n 1"))
number(text) = text eq "" ? NaN : real(text)
first(file, where, column) = number(text(file, where, column))
# Fraction of the machine that other processes used during the measurement, mean over the cells; figures of a
# disturbed run show it.
others(study) = number(system(select(table(study), "", "others_share")[3:*]." | awk '{ sum += $1 } END { if (NR) print sum/NR }'"))
disturbed(study) = others(study) > 0.05 ? sprintf("other processes used %.0f %% of the machine during this run", others(study)*100) : ""

# PFM: three lines of text, then little-endian floats from the bottom row up.
pfm_start(path) = int(system("head -n 3 '".path."' | wc -c"))
pfm_line(path) = system("head -n 2 '".path."' | tail -n 1")
pfm_channels(path) = system("head -c 2 '".path."'") eq "PF" ? 3 : 1
pfm(path) = sprintf("binary skip=%d array=(%s,%s) format='%s' endian=little", pfm_start(path), \
    word(pfm_line(path), 1), word(pfm_line(path), 2), pfm_channels(path) == 3 ? "%float%float%float" : "%float")
