#!/bin/bash
# One film everywhere: the rows of other machines (results/machines) have the film hashes and ray counts of the
# reference run, cell for cell.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh

# Identity of each cell with the hashes and counts of its rows, which must be one.
cells() {
    awk -F, '
        /^#/ { next }
        !column["identity"] { for (i = 1; i <= NF; i++) column[$i] = i; next }
        { print $column["identity"], $column["cell"], $column["film_hash"], $column["rays_total"] }' "$1" | sort -u
}
for rows in results/machines/*/*/rows.csv; do
    study=$(basename "$(dirname "$rows")") machine=$(basename "$(dirname "$(dirname "$rows")")")
    reference=results/reference/$study/rows.csv
    [[ -f $reference ]] || continue
    common=$(join <(cells "$rows") <(cells "$reference"))
    different=$(awk '$2 == $5 && ($3 != $6 || $4 != $7)' <<<"$common")
    same=$(awk '$2 == $5' <<<"$common" | wc -l)
    [[ -z $different && $same -gt 0 ]]
    verdict $? "$machine, $study: films and counts of $same cells" "$different"
done
((cases > 0)) || skip 'there are no rows of other machines'
conclude
