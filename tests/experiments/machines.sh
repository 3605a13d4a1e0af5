#!/bin/bash
# One film everywhere: the rows of other machines (results/machines) have the film hashes and ray counts of the
# reference run, cell for cell; and each shipped scene has one film and one set of ray counts in the rows of all
# machines, architectures, instruction sets and compilers (results/films).
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
command -v python3 >/dev/null || {
    skip 'python3 is not installed'
    exit 77
}

tables=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-machines.XXXXXX") || exit 1
trap 'rm -rf "$tables"' EXIT
experiments/tables.py results/reference "$tables" || exit 1
while IFS=$'\t' read -r machine study _ cells same _ _ _ different; do
    [[ $different == none && $cells -gt 0 && $same == "$cells" ]]
    verdict $? "$machine, $study: films and counts of $cells cells" "cells that differ: $different"
done < <(tail -n +2 "$tables/machines.tsv")
((cases > 0)) || skip 'there are no rows of other machines'

while IFS=$'\t' read -r scene rows _ names _ _ _ isas _ _ different; do
    [[ $different == 0 && $rows -gt 1 ]]
    verdict $? "$scene: one film and one set of counts in $rows rows of $names builds, $isas instruction sets" \
        "$(grep -h "^$scene," results/films/*.csv)"
done < <(tail -n +2 "$tables/films.tsv")
shipped=$(cd experiments/scenes && printf '%s\n' *.yaml | sed 's/.yaml$//' | sort)
for rows in results/films/*.csv; do
    [[ -r $rows ]] || continue
    empty "$rows has a row of every shipped scene" \
        "$(comm -3 <(tail -n +2 "$rows" | cut -d , -f 1 | sort -u) <(echo "$shipped"))"
done
conclude
