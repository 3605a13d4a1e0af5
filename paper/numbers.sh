#!/bin/sh
# All numbers of the paper, from rows alone: writes OUT/numbers.tex (\setval lines that \val reads) and the tables.
#   paper/numbers.sh RESULTS OUT        run from the repository's root
export LC_ALL=C.UTF-8
set -eu

results=$(cd "$1" && pwd)
out=$2
here=$(dirname "$0")
published=$here/../experiments/published

fact() { # the first text or number of that name in the study's manifest
    sed -n "s/^ *\"$2\": *\"\\{0,1\\}\\([^\"]*[^\",]\\)\"\\{0,1\\},\\{0,1\\}\$/\\1/p" "$results/$1/manifest.json" | head -n 1
}

# What TeX reads as commands, as text.
plain() { sed 's/[\\{}~^]/ /g; s/[_%$#&]/\\&/g'; }

machine() {
    for study in threads depth profile ior pool; do
        [ -r "$results/$study/manifest.json" ] || continue
        for name in processing_units topology compiler flags isa version; do
            text=$(fact "$study" "$name" | plain)
            [ -z "$text" ] || [ "$text" = null ] || echo "\\setval{machine/$name}{$text}"
        done
        return
    done
}

units() {
    count=$(fact threads processing_units 2>/dev/null || true)
    echo "${count:-0}"
}

laws() {
    [ -r "$results/tables/threads.tsv" ] || return 0
    (cd "$here/.." && gnuplot -e "results = '$results'; units = $(units)" paper/laws.gp)
}

published() {
    awk -F, 'NR == 2 { first = $2 } NR > 1 { printf "\\setval{published/depth/%s/cpu}{%.3f}\n\\setval{published/depth/%s/growth}{%.2f}\n",
        $1, $2, $1, $2 / first }' "$published/depth.csv"
    awk -F, 'NR == 2 { first = $2 } NR > 1 { printf "\\setval{published/threads/%s/wall}{%.3f}\n\\setval{published/threads/%s/speedup}{%.2f}\n",
        $1, $2, $1, first / $2 }
        NR > 1 { if (!best || $2 < best) { best = $2; count = $1 } }
        END { printf "\\setval{published/threads/best}{%s}\n", count }' "$published/threads.csv"
}

mkdir -p "$out"
{
    echo "% made by paper/numbers.sh; change rows or scripts, not this"
    published
    for table in "$results"/tables/*.tsv; do
        [ -r "$table" ] || continue
        awk -v study="$(basename "$table" .tsv)" -f "$here/numbers.awk" "$table"
    done | sort
    machine
    laws
    # Rays by pixel are the same for every schedule.
    for map in "$results"/maps/images/*-rays.pfm; do
        [ ! -r "$map" ] || "$here/blocks.sh" "$map"
        break
    done
} >"$out/numbers.tex"
