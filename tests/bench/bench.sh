#!/bin/bash
# The benchmarks, in sizes too small for meaningful times: they run with and without the programs of the comparison and
# print every ratio. The ray counts of the report's algorithm must equal Cuvette's first hits and the sums that the
# recursion implies. CUVETTE names the program, BUILD the build folder.
set -uo pipefail
cuvette=${CUVETTE:-build/cuvette} build=${BUILD:-build}
report=$build/peers/report
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-bench.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
has_ratio() { # TEXT NAME: the ratio, its rounds and its range
    grep -qE "^$2.* [0-9]+\.[0-9]{3}   \(1 rounds, [0-9.]+ to [0-9.]+\)" <<<"$1"
    verdict $? "a ratio: $2" "$1"
}

# --- frames
ours=('counters, depth 4' 'counters, depth 8' 'two threads' '1024 threads, depth 8: wall / wall of two'
    "the report's algorithm / ours, depth 0" "the report's algorithm / ours, depth 4"
    "the report's algorithm / ours, depth 8")
theirs=('POV-Ray / ours, depth 8, both pruned' 'POV-Ray / ours, depth 8, whole tree')

# A PATH without POV-Ray, installed or not.
mkdir "$work/bin"
IFS=: read -ra folders <<<"$PATH"
for folder in "${folders[@]}"; do ln -s "$folder"/* "$work/bin/" 2>/dev/null; done
rm -f "$work/bin/povray"
export CUVETTE=$cuvette
text=$(PATH=$work/bin REPS=1 SIZE=32x24 NOCOUNTERS=$cuvette experiments/bench.sh frames 2>&1)
verdict $? 'the benchmark of frames runs without POV-Ray' "$text"
for want in "${ours[@]}"; do has_ratio "$text" "$want"; done
[[ $(grep -c 'bench.sh frames: POV-Ray is not installed.*make setup-peers' <<<"$text") == 1 && $text != *'POV-Ray /'* ]]
verdict $? 'a missing POV-Ray is skipped with a note on how to install it' "$text"
if command -v povray >/dev/null; then
    text=$(REPS=1 SIZE=32x24 NOCOUNTERS=$cuvette experiments/bench.sh frames 2>&1)
    verdict $? 'the benchmark of frames runs with POV-Ray' "$text"
    for want in "${ours[@]}" "${theirs[@]}"; do has_ratio "$text" "$want"; done
else
    skip "POV-Ray is not installed (make setup-peers)"
fi

# --- solids, lights, slimes, processes, growth
text=$(
    source experiments/rounds.sh
    for pair in '2 1' '9 3' '4 4'; do note a "${pair% *}" 5 && note b "${pair#* }" 10; done
    ratio a b 'of three'
    ratio a b 'of expressions' '$1 * $2'
    row a '$1 / $2' 'alone'
    { ratio a b '' && echo 'x 4.5 (1 rounds)'; } | random_scenes low
)
equal 'medians and ranges of rounds and of random scenes' "$(tr -s ' ' <<<"$text")" \
    'of three 2.000 (3 rounds, 1.000 to 3.000)
of expressions 1.000 (3 rounds, 0.500 to 1.500)
alone 0.800 (3 rounds, 0.400 to 1.800)
 random scenes, median 3.250 (2 scenes, worst 2.000)'
spheres() { awk -v seed="$1" -v solids="$2" -v lights="${3:-1}" -f experiments/random_scene.awk; }
area() { spheres "$@" | awk '/radius/ { sub(/.*radius: /, ""); s += $1 * $1 } END { printf "%.3f", s }'; }
equal 'spheres of the named scene: the same cross-section for any number' "$(area 1 1) $(area 1 1000)" '0.810 0.810'
equal 'and of a random one' "$(area 7 10)" "$(area 7 1000)"
equal 'lights share one intensity' "$(spheres 1 3 64 |
    awk '/ l[0-9]+:/ { n++; sub(/.*intensity: /, ""); s += $1 } END { printf "%d %.3f", n, s }')" '64 1.000'
small() { # small NAME [VARIABLE=VALUE...]: one round in a small size
    text=$(env REPS=1 SIZE=32x24 SCENES=2 COUNTS='64 100' DURATION=0.04 LEVEL=1 TRIANGLES=320 CLANG="$cuvette" \
        "${@:2}" experiments/bench.sh "$1" 2>&1)
    verdict $? "the benchmark of $1 runs" "$text"
}
small solids
for want in 'rod, depth 8: M rays/s' '100 spheres: time a ray / that of 64'; do has_ratio "$text" "$want"; done
equal 'a median and a worst of the random scenes for each line' "$(grep -c '(2 scenes, worst ' <<<"$text")" 4
small lights
for want in whitted path; do has_ratio "$text" "$want: frame with 64 lights / with one"; done
small slime
for want in 'slime film 32x24, whole program' 'slime step, level 1: times real time'; do has_ratio "$text" "$want"; done
small processes
for want in 'rod.yaml to a PNG of 8 bits' 'rod.yaml to a PNG of 16 bits' 'OBJ of 320 triangles' \
    'rod, depth 8: speed of the build by clang'; do has_ratio "$text" "$want"; done
small growth SOLIDS='1 100' LIGHTS='1 2' SIZES='8x6 16x12' DEPTHS='0 1' LEVELS='0 1'
rows=$(awk -F'\t' 'NR > 1 && NF == 14 && $3 == 1 && $4 >= $5 && $6 > 0 && $12 > 1e6' <<<"$text" | cut -f 1,2)
wanted='solids 1;solids 100;lights 1;lights 2;lights-path 1;lights-path 2;sparse 320;sphere 320;pixels 48;pixels 192;'
equal 'growth: a row for every size, each with its rays, times and memory' "$(tr '\t\n' ' ;' <<<"$rows")" \
    "${wanted}depth 0;depth 1;depth-path 0;depth-path 1;"
equal 'growth: a camera ray a pixel' "$(awk -F'\t' '$1 == "pixels" { print $5 - $2 }' <<<"$text" | tr '\n' ' ')" '0 0 '
text=$(CUVETTE=$work/nowhere experiments/bench.sh solids 2>&1)
[[ $? == 2 && $text == "bench.sh solids: no program $work/nowhere; make builds it" ]]
verdict $? "bench.sh without a program: exit status 2 and one line" "$text"
text=$(experiments/bench.sh solids "$cuvette" 2>&1)
[[ $? == 2 && $text == "bench.sh: no bench $cuvette; there are: "*' solids'* ]]
verdict $? "a bench that does not exist: exit status 2 and those that do" "$text"
text=$(experiments/bench.sh 2>&1)
[[ $? == 2 && $(grep -c '^  [a-z]*: ' <<<"$text") == $(ls experiments/bench/*.sh | wc -l) ]]
verdict $? "bench.sh without a name: a line for each" "$text"

# --- the report's algorithm: its counts of rays
rows=$("$report" -s 160x120 -d 0,1,2,3 -t 1,7 2>&1)
verdict $? "the report's algorithm runs" "$rows"
value() { # DEPTH THREADS NAME: from a row
    awk -F'\t' -v depth="$1" -v threads="$2" -v name="$3" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
        $at["depth"] == depth && $at["threads"] == threads { print $at[name] }' <<<"$rows"
}
first() { # SOLID: Cuvette's number of camera rays that hit it first
    experiments/json_value.py "first_hits.$1" <"$work/ours.json"
}
"$cuvette" render experiments/scenes/rod.yaml --json --set render.depth=0 \
    --set render.width=160 --set render.height=120 >"$work/ours.json"
camera=$((160 * 120)) glass=$(($(first vessel) + $(first liquid)))
hits=$((glass + $(first ground) + $(first rod)))
equal 'depth 0: one camera ray per pixel' "$(value 0 1 camera)" "$camera"
equal 'depth 0: the first hits of glass equal those of Cuvette' $(($(value 0 1 vessel) + $(value 0 1 liquid))) "$glass"
equal 'depth 0: the first hits of the ground equal those of Cuvette' "$(value 0 1 ground)" "$(first ground)"
equal 'depth 0: the first hits of the rod equal those of Cuvette' "$(value 0 1 rod)" "$(first rod)"
equal 'depth 0: no secondary or shadow rays' "$(value 0 1 secondary) $(value 0 1 shadow)" '0 0'
equal 'depth 1: two rays from each first hit' "$(value 1 1 secondary)" $((2 * hits))
# Every branch ends in the sky, and every hit splits one branch into two: sky colours = pixels + hits.
equal 'depth 1: one shadow ray from each hit' "$(value 1 1 shadow)" $(($(value 1 1 sky) - camera))
equal 'depth 3: two rays from each hit to depth 2' "$(value 3 1 secondary)" $((2 * ($(value 2 1 sky) - camera)))
for name in rays camera secondary shadow sky mean; do
    equal "depth 3: $name is the same with seven threads" "$(value 3 7 $name)" "$(value 3 1 $name)"
done
for wrong in '-d x' '-d 25' '-t 0' '-s 32' '-z' '-d' 'more'; do
    # shellcheck disable=SC2086
    text=$("$report" $wrong 2>&1 >"$work/out")
    [[ $? == 2 && $(wc -l <<<"$text") == 1 && $text == *usage:* && ! -s $work/out ]]
    verdict $? "report $wrong is refused with exit status 2 and one line" "$text"
done
text=$(REPS=1 SIZE=32x24 FOVS=45 THREADS='1 4' experiments/peers/growth.sh "$report" 2>&1) &&
    grep -qE '^ *8 .* \| +24\.7554 +9\.14$' <<<"$text" && grep -qE '^ *4 .* \| +2\.2734 +2\.25$' <<<"$text"
verdict $? 'growth.sh compares its growth with the published tables' "$text"

# --- triangles
text=$(CUVETTE=$build/cuvette REPS=1 SETS=sphere:320 experiments/bench.sh rays 2>&1)
verdict $? 'the benchmark of rays runs' "$text"
if [[ -x $build/peers/embree ]]; then
    # Rays and triangles are the same; at edges single precision may give other hits. Triangles across the border of the
    # image distinguish different rays.
    text=$(paste <("$build/tests/bench_mesh" -m dense -n 100 -k 1 -r 1 | awk 'NR > 1 { print $7, $12 }') \
        <("$build/peers/embree" -m dense -n 100 -k 1 | awk 'NR > 1 { print $6, $9 }'))
    awk 'function off(a, b) { return a > b ? a - b : b - a }
        { exit !(NF == 4 && $1 > 100000 && off($1, $3) <= 3 && off($2, $4) < 1e-5) }' <<<"$text"
    verdict $? "Embree has Cuvette's number of hits up to three, and its mean distance" \
        "hits and mean distance of both: $text"
    text=$("$build/peers/embree" -m dense -n 100 | awk 'NR > 1 { print $6, $7 }' | sort -u)
    equal 'Embree: packets and single rays have the same hits' "$(wc -l <<<"$text")" 1
    text=$("$build/peers/embree" -k 8 2>&1)
    equal 'embree -k 8 is refused with exit status 2' $? 2
else
    grep -q 'bench.sh rays: Embree is not installed.*make setup-peers' <<<"$text"
    verdict $? 'a missing Embree is skipped with a note on how to install it' "$text"
fi
conclude
