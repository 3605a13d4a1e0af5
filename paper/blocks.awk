# The bound on the speed-up of fixed blocks, as \setval{blocks/...} lines: all rays of the image divided by the rays of
# its largest block, for columns and rows divided among n threads as in the renderer; and for columns if at most four or
# eight threads run at a time.
#   awk -f share.awk -f blocks.awk maps-cost.tsv        (paper/cost.sh)
function gain(cost, pieces, threads,   load, count, largest) {
    for (count = loads_of_blocks(cost, pieces, threads, load); count > 0; count--)
        if (load[count] > largest) largest = load[count]
    return all / largest
}
$1 == "column" { column[width++] = $2; all += $2 }
$1 == "row" { row[height++] = $2 }
END {
    for (n = 1; n <= 1024; n *= 2) {
        bound = gain(column, width, n)
        printf "\\setval{blocks/columns/%d}{%.2f}\n", n, bound
        printf "\\setval{blocks/rows/%d}{%.2f}\n", n, gain(row, height, n)
        printf "\\setval{blocks/four/%d}{%.2f}\n", n, bound < 4 ? bound : 4
        printf "\\setval{blocks/eight/%d}{%.2f}\n", n, bound < 8 ? bound : 8
    }
}
