#!/bin/bash
# Measure the cost of each pixel of a scene, for simulated clusters: a grey image in text (cost_map.h) on the standard
# output.
#   measure.sh PATHS WIDTH HEIGHT SCENE [-s PATH=VALUE]...     PATHS 1: without random paths
# The scene is rendered with FACTOR (4) times the width and the height by one thread, REPEAT (15) times. Each of its
# pixels has the least of its times: a pixel's clock runs on while other programs have the processor. A pixel of the map
# has the mean of its FACTOR x FACTOR pixels. Of several frames by one process, whose number varies, so that it is not
# interrupted at the same pixels each time, the last one counts: the first one's time contains its memory's. All are
# scaled so that their sum is the median processor time of as many renders without the pixels' clock.
set -euo pipefail
export LC_ALL=C.UTF-8

cuvette=${CUVETTE:-$(dirname "$0")/../../../build/cuvette} repeat=${REPEAT:-15} factor=${FACTOR:-4}
paths=${1:?PATHS is missing} width=${2:?WIDTH is missing} height=${3:?HEIGHT is missing}
shift 3
scratch=$(mktemp -d "${TMPDIR:-/tmp}/measure.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
across=$((width * factor)) down=$((height * factor))
settings=(-s "render.width=$across" -s "render.height=$down" -s render.threads=1 -s "render.paths=$paths")

# The values of a map, from the top row to the lowest: a PFM file starts at the lowest.
values() {
    tail -c $((4 * across * down)) "$1" | od -An -v -tf4 -w$((4 * across)) | tac | tr -s ' ' '\n' | sed '/^$/d'
}
for ((i = 0; i < repeat; i++)); do
    "$cuvette" render "$@" "${settings[@]}" --repeat $((2 + i % 4)) --time "$scratch/$i.pfm" \
        -o "$scratch/image.png" >/dev/null 2>&1
    values "$scratch/$i.pfm" >"$scratch/$i.values"
done
cpu_s=$("$cuvette" render "$@" "${settings[@]}" --json --repeat "$repeat" 2>/dev/null |
    "$(dirname "$0")/../../json_value.py" cpu_s)
paste "$scratch"/*.values | awk -v factor="$factor" -v across="$across" -v paths="$paths" -v cpu_s="${cpu_s:?}" '
    {
        least = $1 + 0
        for (i = 2; i <= NF; i++) if ($i + 0 < least) least = $i + 0
        x = int((NR - 1) % across / factor)
        y = int(int((NR - 1) / across) / factor)
        cost[y, x] += least
        sum += least
        if (cost[y, x] > most) most = cost[y, x]
    }
    END {
        unit = most / 9999
        scale = cpu_s * 1e9 / sum / factor ^ 2
        printf "P2\n# unit %.6g\n# paths %d\n%d %d\n9999\n", unit * scale, paths, x + 1, y + 1
        for (j = 0; j <= y; j++)
            for (i = 0; i <= x; i++) printf "%d%s", cost[j, i] / unit + 0.5, i < x ? " " : "\n"
    }'
