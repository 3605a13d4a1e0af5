#!/bin/bash
# Black-box checks of the program: tests/test_cli.sh [PROGRAM]. One line a check ("ok ..." or "not ok ...", as tests/run
# counts them), then "N passed, N failed".
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
scene=$root/experiments/scenes/rod.yaml
page=$root/src/cli/cuvette.1
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-cli.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CUVETTE_ISA NO_COLOR

passed=0 failed=0
verdict() # STATUS WHAT
{
    if (($1 == 0)); then
        passed=$((passed + 1))
        echo "ok $((passed + failed)) - $2"
    else
        failed=$((failed + 1))
        echo "not ok $((passed + failed)) - $2"
    fi
}
check() # WHAT COMMAND...: passes when the command succeeds
{
    local what=$1
    shift
    "$@" >check.log 2>&1
    verdict $? "$what"
}
run() # ARGUMENT...: the program, small; its results in out, err, code
{
    "$program" "$@" >out 2>err
    code=$?
}
small=(--set render.width=80 --set render.height=60)
is() { [[ $1 == "$2" ]]; }
matches() { [[ $1 =~ $2 ]]; }
silent_success() { ((code == 0)) && [[ ! -s err ]]; }
json_is() { jq -e "$1" out >/dev/null; }
magic() { is "$(od -An -tx1 -N"${#2}" "$1" | tr -d ' \n' | cut -c1-"${#2}")" "$2"; }

# --- help and version
run --version
check "--version names the version" matches "$(<out)" '^cuvette [0-9]+\.[0-9]+\.[0-9]+$'
run --help
check "--help succeeds on standard output" silent_success
for command in render params study machine help; do
    check "--help names $command" grep -q "^  $command " out
done
for command in render params study machine "study run" "study list" "study status" "study merge" "study summary"; do
    # shellcheck disable=SC2086
    run help $command
    check "help $command" matches "$(head -1 out)" "^Usage: cuvette $command"
done
run render --he
check "long options may be shortened" silent_success

# --- render
run render "$scene" -o a.png "${small[@]}"
check "render writes a picture" silent_success
check "a .png is a PNG" magic a.png 89504e47
check "the summary is one line" is "$(wc -l <out)" 1
hash=$(grep -o 'film [0-9a-f]\{16\}' out | cut -d' ' -f2)
run render "$scene" --output=a.jpg "${small[@]}"
check "a .jpg is a JPEG" magic a.jpg ffd8ff
run render "$scene" -o a.pfm "${small[@]}"
check "a .pfm is a PFM of the right size" is "$(head -c 9 a.pfm | tr '\n' ' ')" "PF 80 60 "
run render "$scene" -o b.png "${small[@]}"
check "the same scene gives the same bytes" cmp a.png b.png
run render "$scene" -o c.png --bits 16 "${small[@]}"
check "--bits 16 gives a PNG of 16 bits" is "$(od -An -tu1 -j24 -N1 c.png | tr -d ' ')" 16
check "no other files are left" is "$(find . -type f -printf '%f\n' | LC_ALL=C sort | tr '\n' ' ')" "a.jpg a.pfm a.png b.png c.png check.log err out "

# --- the JSON account
run render "$scene" --json "${small[@]}" --set render.depth=3 --set lamp.position.x=2 --set render.threads=3
check "--json needs no -o" silent_success
check "the account is one JSON object" json_is 'type == "object"'
check "schema" json_is '.schema == 1 and .whole == true'
check "film_hash is 16 hexadecimal digits" json_is '.film_hash | test("^[0-9a-f]{16}$")'
check "camera rays are the pixels" json_is '.rays.camera == 4800'
check "the kinds add up to the total" json_is '.rays | .camera + .reflect + .refract + .shadow == .total'
check "the depths add up to all but the shadow rays" json_is '(.rays_by_depth | add) == .rays.total - .rays.shadow'
check "one number a depth" json_is '.rays_by_depth | length == 4'
check "first hits by solid" json_is '(.first_hits | keys) == ["ground","liquid","rod","vessel"] and .first_hits.vessel > 0'
check "hits and tests by solid" json_is '.hits.rod > 0 and .tests.rod >= .hits.rod'
check "cut rays and throughput" json_is '.cut.depth.rays > 0 and (.cut.depth.throughput | length) == 3 and .cut.weight.rays == 0'
check "cut_throughput is the mean of the channels" \
    json_is '(.cut.depth.throughput | add / 3) - .cut_throughput | fabs < 1e-9'
check "one account a worker" json_is '(.threads | length) == 3 and ([.threads[].worker] == [0,1,2])'
check "the workers' rays add up" json_is '([.threads[].rays] | add) == .rays.total'
check "keys of a worker" \
    json_is '.threads[0] | keys == ["busy_s","cpu_s","pu","rays","start_s","tiles","waiting_s","wall_s","worker"]'
check "times and process" \
    json_is '.wall_s > 0 and .cpu_s > 0 and .peak_rss_bytes > 0 and has("voluntary_switches") and has("others_share")'
check "hardware counters are there or null" \
    json_is '.hardware | keys == ["branch_misses","cache_misses","cycles","instructions"]'
check "parameters have types" json_is '.params["render.depth"] == 3 and .params["render.weights"] == "fresnel"'
check "vectors are lists" json_is '.params["lamp.position"] == [2,7,-5]'
check "a real reads back" json_is '.params["liquid.ior"] == 1.33'
check "isa and version" json_is '(.isa | test("^(sse2|avx2|avx512)$")) and .version != ""'
run params "$scene" --json
jq -r '.params[].path' out | sort >all.txt
run render "$scene" --json "${small[@]}"
check "the account has every parameter" is "$(jq -r '.params | keys_unsorted[]' out | sort)" "$(<all.txt)"
check "the summary's hash is the account's" is "$(jq -r .film_hash out)" "$hash"
run render "$scene" --json "${small[@]}" --set render.threads=7 --set render.schedule=rows
check "threads and schedule leave the film alone" is "$(jq -r .film_hash out)" "$hash"
CUVETTE_ISA=sse2 run render "$scene" --json "${small[@]}"
check "CUVETTE_ISA is used, and leaves the film alone" json_is ".isa == \"sse2\" and .film_hash == \"$hash\""
run render "$scene" --json "${small[@]}" --repeat 5
check "--repeat gives all times, and the medians" \
    json_is '(.wall_s_all | length) == 5 and .wall_s == (.wall_s_all | sort | .[2]) and .cpu_s == (.cpu_s_all | sort | .[2])'
check "--repeat leaves the film alone" json_is ".film_hash == \"$hash\" and .rays.camera == 4800"
run render "$scene" --json "${small[@]}" --set render.depth=2 --set render.depth=0
check "the last --set wins" json_is '.params["render.depth"] == 0 and .rays.reflect == 0'
if locale -a 2>/dev/null | grep -qi '^de_DE'; then
    LC_ALL=de_DE.UTF-8 run render "$scene" --json "${small[@]}"
    check "a locale with a decimal comma changes nothing" json_is ".film_hash == \"$hash\" and .params[\"liquid.ior\"] == 1.33"
fi

# --- maps and timeline
run render "$scene" "${small[@]}" --rays rays.png --time time.png --timeline line.json --set render.threads=2
check "maps and a timeline without a picture" silent_success
check "looking leaves the film alone" grep -q "film $hash" out
check "the map of rays is a PNG with a key" is "$(($(od -An -tu1 -j22 -N2 rays.png | awk '{print $1*256+$2}') > 60))" 1
check "the map of time is a PNG" magic time.png 89504e47
check "the timeline is JSON with events" jq -e '.traceEvents | length > 3' line.json
check "one named row a worker" \
    jq -e '[.traceEvents[] | select(.ph == "M" and .name == "thread_name") | .args.name] == ["worker 0","worker 1"]' line.json
check "the tiles cover the picture" \
    jq -e '[.traceEvents[] | select(.ph == "X") | (.args.x1 - .args.x0) * (.args.y1 - .args.y0)] | add == 4800' line.json
check "no tile ends before it begins" jq -e 'all(.traceEvents[] | select(.ph == "X"); .dur >= 0 and .ts >= 0)' line.json
run render "$scene" "${small[@]}" --rays rays.pfm --json
# The last pixels of a PFM's payload sum to nothing by themselves: compare the sum of one channel with the count.
sum=$(tail -c $((80 * 60 * 12)) rays.pfm | od -An -v -tf4 -w12 | awk '{s += $1} END {printf "%d", s}')
check "the map of rays sums to the rays" is "$sum" "$(jq .rays.total out)"
run render "$scene" "${small[@]}" --rays again.pfm --repeat 2 --json
check "maps go with --repeat" cmp rays.pfm again.pfm

# --- parameters
run params
check "params prints a table" silent_success
check "params names range, unit, default and meaning" grep -q '^render.depth .*4 .*0\.\.64.*recursion depth' out
run params --json
check "params --json lists the table" json_is '.params | length > 40 and all(.[]; has("path") and has("default") and has("range"))'
run params "$scene"
check "params of a scene has its values" grep -q '^liquid.ior  *1\.33 ' out
run params --man
check "params --man is roff" grep -q '^\.SS ' out
sed '/^\.\\" begin parameters/,/^\.\\" end parameters/!d' "$page" | sed '1d;$d' >page.txt
check "cuvette.1 has these parameters (to renew: put 'cuvette params --man' between its begin and end marks)" cmp out page.txt
missing=0
while read -r path _; do
    grep -qF -- "$path" "$page" || missing=$((missing + 1))
done < <("$program" params | tail -n +2)
check "cuvette.1 names every parameter" is "$missing" 0
if command -v groff >/dev/null; then
    check "cuvette.1 is clean roff" is "$(groff -man -Tutf8 -ww -z "$page" 2>&1)" ""
fi
for option in $("$program" render --help | grep -o '^ .*--[a-z]*' | grep -o -- '--[a-z]*'); do
    check "cuvette.1 explains render $option" grep -qF -- "${option/--/\\-\\-}" "$page"
done

# --- machine
run machine
check "machine prints what it is" grep -q '^wall clock ' out
run machine --json
check "machine --json" json_is '.units >= 1 and .wall_clock.tick_s > 0 and (.disturbances | type) == "array"'

# --- studies
mkdir studies
cat >studies/tiny.study <<END
study: tiny
title: A small one
scene: $scene
set: {render.width: 40, render.height: 30}
grid:
  - {render.depth: [0, 1, 2]}
repetitions: 2
warmups: 1
order: {shuffle: on, seed: 3}
END
run study list studies
check "study list shows name, cells and title" matches "$(<out)" 'tiny\.study +3 cells +A small one'
run study status studies/tiny.study --results res
check "study status before the run" matches "$(<out)" '0 of 3 cells'
run study run studies/tiny.study --results res
check "study run" silent_success
lines=$(wc -l <res/tiny/rows.csv)
check "one row a repetition" is "$lines" 10
run study run studies/tiny.study --results res
check "a second run finds nothing to do" matches "$(<out)" 'nothing to do'
check "and writes nothing" is "$(wc -l <res/tiny/rows.csv)" "$lines"
run study status studies/tiny.study --results res
check "study status after the run" matches "$(<out)" '3 of 3 cells done, 9 rows, 0 marked'
run study summary studies/tiny.study --results res
check "study summary has one line a cell" is "$(wc -l <out)" 4
check "study summary is separated by tabs" is "$(head -1 out | cut -f1,2)" "$(printf 'cell\trender.depth')"
run study run --quiet studies/tiny.study --results parts --shard 0/2
check "--quiet says nothing" is "$(cat out err)" ""
run study run studies/tiny.study --results parts --shard 1/2
run study merge studies/tiny.study --results parts
check "study merge joins the shards" is "$(wc -l <parts/tiny/rows.csv)" "$lines"

# --- broken pipes, full disks, closed descriptors, signals
"$program" params --json 2>err | head -1 >/dev/null
check "a reader who leaves is no drama" is "$(<err)" ""
# shellcheck disable=SC2216
(sleep 0.3; "$program" render "$scene" --json "${small[@]}" 2>err; echo $? >code) | true
check "a closed pipe exits 1 without words" is "$(cat code err)" 1
if [[ -w /dev/full ]]; then
    for words in params "params --json" machine --help "render --help" "render $scene --json --set render.width=8"; do
        # shellcheck disable=SC2086
        "$program" $words >/dev/full 2>err
        check "a full disk is exit 1 and one line: ${words%% /*}" is "$? $(wc -l <err)" "1 1"
    done
fi
"$program" params >&- 2>err
check "a closed standard output is exit 1" is $? 1
"$program" render "$scene" -o shut.png "${small[@]}" >&- 2>err
check "a picture does not go into a closed standard output" magic shut.png 89504e47
for signal in INT TERM; do
    rm -f part.png
    "$program" render "$scene" -o part.png --json --set render.width=4000 --set render.height=3000 --set render.depth=12 \
        --set render.tile=8 >out 2>err &
    job=$!
    sleep 0.4
    kill -"$signal" $job
    wait $job
    check "SIG$signal ends a render with 130" is $? 130
    check "SIG$signal: the picture so far is there" magic part.png 89504e47
    check "SIG$signal: one line says so" is "$(grep -c interrupted err)" 1
    check "SIG$signal: the account says that it is a part" json_is '.whole == false'
done
sed -e 's/^study: .*/study: long/' -e 's/render.width: 40, render.height: 30/render.width: 1000, render.height: 750/' \
    -e 's/repetitions: 2/repetitions: 500/' studies/tiny.study >studies/long.study
"$program" study run studies/long.study --results res >out 2>err &
job=$!
for _ in {1..100}; do # until two rows are there
    [[ -e res/long/rows.csv ]] && (($(wc -l <res/long/rows.csv) > 2)) && break
    sleep 0.1
done
kill -INT $job
wait $job
check "SIGINT ends a study with 130" is $? 130
check "SIGINT: one line says so, and how to go on" is "$(grep -c 'interrupted.*run it again' err) $(wc -l <err)" "1 1"
check "SIGINT: its rows are whole" awk -F, 'NR == 1 {n = NF} NF < n {bad = 1} END {exit bad || NR < 3}' res/long/rows.csv
if command -v script >/dev/null; then
    script -qec "'$program' rendr" /dev/null >tty.txt 2>&1
    check "errors have colour on a terminal" grep -q $'\033\[' tty.txt
    NO_COLOR=1 script -qec "'$program' rendr" /dev/null >tty.txt 2>&1
    check "NO_COLOR takes it off" is "$(grep -c $'\033' tty.txt)" 0
    TERM=dumb script -qec "'$program' rendr" /dev/null >tty.txt 2>&1
    check "TERM=dumb takes it off" is "$(grep -c $'\033' tty.txt)" 0
    script -qec "'$program' render '$scene' --json --set render.width=3000 --set render.height=2250 --set render.depth=10 \
        >/dev/null" /dev/null >tty.txt 2>&1
    check "progress on a terminal ends in an erased line" matches "$(tail -c 3 tty.txt)" $'^ +\r$'
    check "progress has a share and the time left" grep -q 'rendering: .*%, .* left' tty.txt
fi

# --- completion
check "the completion is sound bash" bash -n "$root/src/cli/cuvette.bash"
complete_line() # WORD...: what is offered for the last one
{
    bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); compopt() { :; }; _cuvette
        printf "%s\n" "${COMPREPLY[@]}"' - "$root/src/cli/cuvette.bash" "$@"
}
check "completion offers commands" is "$(complete_line cuvette ren)" render
check "completion offers options" matches "$(complete_line cuvette render --t)" '--time.*--timeline'
check "completion offers parameters of the scene" \
    is "$(complete_line "$program" render "$scene" --set liquid.io)" "liquid.ior="
check "completion offers study verbs" is "$(complete_line cuvette study mer)" merge

echo "$passed passed, $failed failed"
((failed == 0))
