#!/bin/sh
# Write all numbers of the paper, computed only from rows: OUT/numbers.tex (\setval lines that \val reads), from the
# tables of experiments/tables.sh, RESULTS/tables.
#   paper/numbers.sh RESULTS OUT
# Without gnuplot the laws fitted to the studies of triangles and area are missing.
export LC_ALL=C.UTF-8
set -eu

results=$(cd "$1" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
tables=$results/tables
here=$(cd "$(dirname "$0")" && pwd)
published=$here/../experiments/published

fact() { # the first text or number of that name in the study's list of runs
    cat "$results/$1"/runs.json "$results/$1"/manifest.json 2>/dev/null |
        sed -n "s/^ *\"$2\": *\"\\{0,1\\}\\([^\"]*[^\",]\\)\"\\{0,1\\},\\{0,1\\}\$/\\1/p" |
        head -n 1
}

# Escapes characters that TeX would interpret.
plain() { sed 's/[\\{}~^]/ /g; s/[_%$#&]/\\&/g'; }

machine() {
    for study in threads depth profile ior pool; do
        [ -r "$results/$study/runs.json" ] || [ -r "$results/$study/manifest.json" ] || continue
        for name in processing_units topology compiler flags isa version; do
            text=$(fact "$study" "$name" | plain)
            [ -z "$text" ] || [ "$text" = null ] || echo "\\setval{machine/$name}{$text}"
        done
        return
    done
}

# Laws fitted to the studies of many triangles and of the area that they cover.
polygons() {
    command -v gnuplot >/dev/null || return 0
    for study in triangles coverage; do
        [ -r "$tables/$study.tsv" ] || continue
        (cd "$here/.." && gnuplot -e "results = '$results'" "paper/$study.gp")
    done
}

# The tests of a ray, and the time of a test.
queries() {
    [ -r "$tables/queries.tsv" ] || return 0
    set -- "$tables/queries.tsv"
    [ ! -r "$tables/triangles.tsv" ] || set -- "$@" "$tables/triangles.tsv"
    awk -v show=numbers -v topology="$(fact triangles topology)" -f "$here/queries.awk" "$@"
}

# Columns of a published series, tab separated.
series() { awk -f "$here/../plots/select.awk" -v columns="$2" "$published/$1.csv"; }

# The published numbers, and numbers derived from them.
published() {
    series triangles 'triangles time_s' | awk '{ printf "\\setval{published/triangles/%d}{%s}\n", $1, $2 }'
    series coverage 'pixels time_s' | awk '{ printf "\\setval{published/coverage/%d}{%s}\n", $1, $2 }'
    series crowding 'triangles time_s' | awk '{ printf "\\setval{published/crowding/%d}{%s}\n", $1, $2 }'
    {
        series triangles 'triangles time_s'
        series crowding 'triangles time_s'
    } |
        awk '!($1 in sparse) { sparse[$1] = $2; next }
            $1 > 0 { printf "\\setval{published/crowding/%d/slower}{%.0f}\n", $1, $2 / sparse[$1] }'
    series depth 'depth cpu_s' | awk 'NR == 1 { first = $2 }
        { printf "\\setval{published/depth/%s/cpu}{%.3f}\n", $1, $2
          printf "\\setval{published/depth/%s/growth}{%.2f}\n", $1, $2 / first }'
    series threads 'threads wall_s' | awk 'NR == 1 { first = $2 }
        { printf "\\setval{published/threads/%s/wall}{%.3f}\n", $1, $2
          printf "\\setval{published/threads/%s/speedup}{%.2f}\n", $1, first / $2 }
        !best || $2 < best { best = $2; count = $1 }
        END { printf "\\setval{published/threads/best}{%s}\n", count }'
}

# Light through a slab: the middle pixel of each thickness, the value of the slab's law, and the largest deviation.
# Index
# and coefficients are those of experiments/scenes/absorber.yaml, in 1/m; the law's R is Fresnel's at normal incidence.
slab() {
    [ -r "$tables/absorber.tsv" ] || return 0
    lines=$(awk -f "$here/../plots/select.awk" -v columns='cell liquid.size.z' "$tables/absorber.tsv" |
        while read -r cell thickness; do
            picture=$(printf '%s/absorber/images/%04d.pfm' "$results" "$cell")
            [ ! -r "$picture" ] || printf '%s\t%s\n' "$thickness" "$("$here/../plots/pixel.sh" "$picture")"
        done)
    [ -n "$lines" ] || return 0
    printf '%s\n' "$lines" | awk -v R="$(awk 'BEGIN { printf "%.17g", (0.33 / 2.33) ^ 2 }')" -v absorb='200 60 10' '
        BEGIN { split(absorb, a, " "); split("red green blue", name, " ") }
        {
            for (i = 1; i <= 3; i++) {
                e = exp(-a[i] * $1 / 1000)
                printf "\\setval{absorber/%s/%s}{%.5f}\n", $1, name[i], $(i + 1)
                printf "\\setval{absorber/%s/%s-alone}{%.5f}\n", $1, name[i], e
                off = $(i + 1) - (1 - R) ^ 2 * e / (1 - R ^ 2 * e ^ 2)
                if (off < 0) off = -off
                if (off > worst) worst = off
            }
        }
        END {
            while (worst && worst < 1) { worst *= 10; exponent-- }
            printf "\\setval{absorber/worst}{\\ensuremath{%.1f\\cdot 10^{%d}}}\n", worst, exponent
            printf "\\setval{absorber/points}{%d}\n", 3 * NR
        }'
}

# Light through a ball of slime: the difference of the path length of green light inside, absorbed by 1/m, from the
# ball's
# chord (rms over a row of pixels), and the light left by a surface that transmits a share, relative to its square.
ball() {
    [ -r "$tables/slime-light.tsv" ] || return 0
    awk -f "$here/../plots/select.awk" -v columns='cell toy.level jelly.transparency' \
        "$tables/slime-light.tsv" |
        while read -r cell level share; do
            picture=$(printf '%s/slime-light/images/%04d.pfm' "$results" "$cell")
            [ ! -r "$picture" ] || "$here/../plots/chord.sh" "$picture" 6 0.493 |
                awk -v level="$level" -v share="$share" -f "$here/scientific.awk" -f "$here/ball.awk"
        done
}

# The design of each study that has rows: processes that share its repetitions, and frames before the first row.
designs() {
    for file in "$here"/../experiments/*.study "$here"/../experiments/full/*.study; do
        study=$(basename "$file" .study)
        [ -r "$tables/$study.tsv" ] || continue
        awk -v study="$study" 'BEGIN { of["processes"] = 1 }
            /^(processes|warmups): *[0-9]+$/ { sub(/:/, "", $1); of[$1] = $2 }
            END { for (name in of) printf "\\setval{%s/%s}{%d}\n", study, name, of[name] }' "$file"
    done
}

{
    echo "% made by paper/numbers.sh; change rows or scripts, not this"
    published
    for table in "$tables"/*.tsv; do
        [ -r "$table" ] || continue
        study=$(basename "$table" .tsv)
        case $study in
        published-* | growth* | paths) ;; # not in the paper
        visible-grid*) ;;                 # too large for numbers of each cell
        *-metrics) awk -v study="${study%-metrics}" -f "$here/scientific.awk" -f "$here/metrics.awk" "$table" ;;
        *-curves) awk -v study="${study%-curves}" -f "$here/scientific.awk" -f "$here/curves.awk" "$table" ;;
        *-motion) awk -v study="${study%-motion}" -f "$here/scientific.awk" -f "$here/motion.awk" "$table" ;;
        determinism* | films | machines)
            awk -v table="$study" -f "$here/interval.awk" -f "$here/scientific.awk" -f "$here/determinism.awk" "$table"
            ;;
        *) awk -v study="$study" -f "$here/interval.awk" -f "$here/numbers.awk" "$table" ;;
        esac
    done | sort
    designs
    slab
    ball
    [ ! -r "$results/detect/rows.csv" ] || awk -f "$here/detect.awk" "$results/detect/rows.csv" | sort
    machine
    polygons
    queries
} >"$out/numbers.tex"
