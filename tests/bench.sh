#!/bin/bash
# The benches run in sizes too small to mean anything, with and without the programs that they compare with, and print
# every ratio. What the report's algorithm counts is compared with what must come out: Cuvette's own first hits, and the
# sums that the recursion implies.
set -uo pipefail
cuvette=${CUVETTE:-build/cuvette} build=${BUILD:-build}
report=$build/peers/report
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-bench.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

count=0 failed=0
verdict() { # STATUS WHAT [WHY]
    count=$((count + 1))
    if (($1 == 0)); then
        echo "ok $count - $2"
    else
        failed=1
        echo "not ok $count - $2"
        [[ -z ${3:-} ]] || sed 's/^/# /' <<<"$3"
    fi
}
equal() { # WHAT GOT WANTED
    [[ $2 == "$3" ]]
    verdict $? "$1" "got $2, not $3"
}
has_ratio() { # TEXT NAME: the ratio, its rounds and its range
    grep -qE "^$2.* [0-9]+\.[0-9]{3}   \(1 rounds, [0-9.]+ to [0-9.]+\)" <<<"$1"
    verdict $? "a ratio: $2" "$1"
}

# --- frames
ours=('counters, depth 4' 'counters, depth 8' 'two threads' '1024 threads, depth 8: wall / wall of two'
    "the report's algorithm / ours, depth 0" "the report's algorithm / ours, depth 4"
    "the report's algorithm / ours, depth 8")
theirs=('POV-Ray / ours, depth 8, both pruned' 'POV-Ray / ours, depth 8, whole tree')

# A path without POV-Ray, whether it is installed or not.
mkdir "$work/bin"
IFS=: read -ra folders <<<"$PATH"
for folder in "${folders[@]}"; do ln -s "$folder"/* "$work/bin/" 2>/dev/null; done
rm -f "$work/bin/povray"
text=$(PATH=$work/bin REPS=1 SIZE=32x24 experiments/bench.sh "$cuvette" "$cuvette" 2>&1)
verdict $? 'the bench of frames runs without POV-Ray' "$text"
for want in "${ours[@]}"; do has_ratio "$text" "$want"; done
[[ $(grep -c 'bench.sh: POV-Ray is not installed.*make setup-peers' <<<"$text") == 1 && $text != *'POV-Ray /'* ]]
verdict $? 'it says how to get POV-Ray, and leaves it out' "$text"
if command -v povray >/dev/null; then
    text=$(REPS=1 SIZE=32x24 experiments/bench.sh "$cuvette" "$cuvette" 2>&1)
    verdict $? 'the bench of frames runs with POV-Ray' "$text"
    for want in "${ours[@]}" "${theirs[@]}"; do has_ratio "$text" "$want"; done
else
    count=$((count + 1))
    echo "ok $count # SKIP POV-Ray is not installed (make setup-peers)"
fi

# --- the report's algorithm: what it counts
rows=$("$report" -s 160x120 -d 0,1,2,3 -t 1,7 2>&1)
verdict $? "the report's algorithm runs" "$rows"
value() { # DEPTH THREADS NAME: from a row
    awk -F'\t' -v depth="$1" -v threads="$2" -v name="$3" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
        $at["depth"] == depth && $at["threads"] == threads { print $at[name] }' <<<"$rows"
}
first() { # SOLID: camera rays that meet it first, by Cuvette
    sed -n '/"first_hits"/,/}/s/^ *"'"$1"'": *\([0-9]*\),*$/\1/p' "$work/ours.json"
}
"$cuvette" render experiments/scenes/rod.yaml --json --set render.depth=0 \
    --set render.width=160 --set render.height=120 >"$work/ours.json"
camera=$((160 * 120)) glass=$(($(first vessel) + $(first liquid)))
met=$((glass + $(first ground) + $(first rod)))
equal 'depth 0: camera rays are pixels' "$(value 0 1 camera)" "$camera"
equal 'depth 0: the glass is met first as often as by Cuvette' $(($(value 0 1 vessel) + $(value 0 1 liquid))) "$glass"
equal 'depth 0: the ground is met first as often as by Cuvette' "$(value 0 1 ground)" "$(first ground)"
equal 'depth 0: the rod is met first as often as by Cuvette' "$(value 0 1 rod)" "$(first rod)"
equal 'depth 0: no other rays, as listed' "$(value 0 1 secondary) $(value 0 1 shadow)" '0 0'
equal 'depth 1: two rays from each first hit' "$(value 1 1 secondary)" $((2 * met))
# Branches end with the sky's colour, and a hit makes one branch two: colours of the sky are pixels and hits.
equal 'depth 1: one shadow ray from each hit' "$(value 1 1 shadow)" $(($(value 1 1 sky) - camera))
equal 'depth 3: two rays from each hit to depth 2' "$(value 3 1 secondary)" $((2 * ($(value 2 1 sky) - camera)))
for name in rays camera secondary shadow sky mean; do
    equal "depth 3: $name with seven threads as with one" "$(value 3 7 $name)" "$(value 3 1 $name)"
done
for wrong in '-d x' '-d 25' '-t 0' '-s 32' '-z' '-d' 'more'; do
    # shellcheck disable=SC2086
    text=$("$report" $wrong 2>&1 >"$work/out")
    [[ $? == 2 && $(wc -l <<<"$text") == 1 && $text == *usage:* && ! -s $work/out ]]
    verdict $? "report $wrong: refused with exit status 2 and one line" "$text"
done
text=$(REPS=1 SIZE=32x24 FOVS=45 THREADS='1 4' experiments/peers/growth.sh "$report" 2>&1) &&
    grep -qE '^ *8 .* \| +24\.7554 +9\.14$' <<<"$text" && grep -qE '^ *4 .* \| +2\.2734 +2\.25$' <<<"$text"
verdict $? 'its growth is compared with the published tables' "$text"

# --- triangles
text=$(REPS=1 SETS=sphere:320 experiments/mesh_bench.sh "$build/tests/bench_mesh" 2>&1)
verdict $? 'the bench of meshes runs' "$text"
if [[ -x $build/peers/embree ]]; then
    # Along edges single precision may decide otherwise; rays and triangles are the same. Triangles that reach over the
    # image's border tell rays apart.
    text=$(paste <("$build/tests/bench_mesh" -m dense -n 100 -k 1 -r 1 | awk 'NR > 1 { print $7, $12 }') \
        <("$build/peers/embree" -m dense -n 100 -k 1 | awk 'NR > 1 { print $6, $9 }'))
    awk 'function off(a, b) { return a > b ? a - b : b - a }
        { exit !(NF == 4 && $1 > 100000 && off($1, $3) <= 3 && off($2, $4) < 1e-5) }' <<<"$text"
    verdict $? "Embree's hits are Cuvette's but for single ones" "hits and mean distance of both: $text"
    text=$("$build/peers/embree" -m dense -n 100 | awk 'NR > 1 { print $6, $7 }' | sort -u)
    equal 'Embree: packets hit what single rays hit' "$(wc -l <<<"$text")" 1
    text=$("$build/peers/embree" -k 8 2>&1)
    equal 'embree -k 8: refused with exit status 2' $? 2
else
    grep -q 'mesh_bench.sh: Embree is not installed.*make setup-peers' <<<"$text"
    verdict $? 'it says how to get Embree' "$text"
fi
exit "$failed"
