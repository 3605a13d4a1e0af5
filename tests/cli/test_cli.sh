#!/bin/bash
# Black-box checks of the program: test_cli.sh [PROGRAM]. One line per check ("ok ..." or "not ok ...", as
# tests/run counts them), then "N passed, N failed". CC compiles tests/tools/json_get.c, which reads the program's JSON.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
scene=$root/experiments/scenes/rod.yaml
manual=$(realpath "${BUILD:-$root/build}/man")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-cli.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CUVETTE_ISA NO_COLOR

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
# shellcheck source=tests/shell/await.sh
source "$root/tests/shell/await.sh"
check() { # WHAT COMMAND...: passes when the command succeeds
    local what=$1
    shift
    "$@" >check.log 2>&1
    verdict $? "$what"
}
run() { # ARGUMENT...: runs the program; its results are in out, err and code
    "$program" "$@" >out 2>err
    code=$?
}
into_closed_pipe() { # ARGUMENT...: the same, with an output whose reader has ended; out is not written
    local pipe
    exec {pipe}> >(:)
    wait $!
    "$program" "$@" >&"$pipe" 2>err
    code=$?
    exec {pipe}>&-
}
small=(--set render.width=80 --set render.height=60)
is() { [[ $1 == "$2" ]]; }
matches() { [[ $1 =~ $2 ]]; }
silent_success() { ((code == 0)) && [[ ! -s err ]]; }
# Notes of a study on this machine, and on what disturbs it now, are not the same everywhere.
other_notes() { # but those about this machine
    grep -vE '^cuvette: note: (this machine|other processes|the (hypervisor|clock|machine|program)) ?' err
}
# The only note on the rod scene is that its depth of 4 is too small.
depth_noted() { ((code == 0)) && [[ $(wc -l <err) == 1 && $(<err) == 'cuvette: note: render.depth: '* ]]; }
json() { ./json_get out "$@"; } # PATH...: prints the values of out at these paths
lines() { printf '%s\n' "$@"; }
sum() { awk '{s += $1} END {printf "%.17g", s}'; }
holds() { awk "BEGIN {exit !($1)}"; } # CONDITION on numbers
magic() { is "$(od -An -tx1 -N"${#2}" "$1" | tr -d ' \n' | cut -c1-"${#2}")" "$2"; }

check "tests/tools/json_get.c compiles" bash -c \
    '"$1" -std=gnu17 -Wall -Werror -o json_get "$2" $(pkg-config --cflags --libs jansson)' - "${CC:-gcc}" \
    "$root/tests/tools/json_get.c"

# --- help and version
run --version
check "--version names the version and the build" matches "$(<out)" \
    '^cuvette [0-9]+\.[0-9]+\.[0-9]+ \(build [0-9a-f]{16}(, commit [0-9a-f]+\+?)?\)$'
run --help
check "--help succeeds on standard output" silent_success
for command in render animate scene trace fan section params media mesh study fit compare realism motion lab \
    machine help; do
    check "--help names $command" grep -q "^  $command " out
done
for command in render animate scene trace fan section params media mesh study fit compare realism motion lab machine \
    "study run" "study new" "study list" "study status" "study merge" "study verify" \
    "study summary" "study exclude" "study compare" "study power" "study plot" "study submit"; do
    # shellcheck disable=SC2086
    run help $command
    check "help $command" matches "$(head -1 out)" "^Usage: cuvette $command"
done
run render --he
check "unambiguous abbreviations of long options are accepted" silent_success

# --- render
run render "$scene" -o a.png "${small[@]}"
check "render writes an image" depth_noted
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
run render "$scene" -o a.html "${small[@]}" --set 'liquid.ior=1.4'
page_hash=$(grep -o 'film [0-9a-f]\{16\}' out)
check "a .html is a page with the film's hash" grep -q "$page_hash" a.html
check "a page shows its command" grep -qF -- "--set liquid.ior=1.4 -o a.html</pre>" a.html
run render a.html -o page.png
check "a page's scene gives the same film" is "$(grep -o 'film [0-9a-f]\{16\}' out)" "$page_hash"
run render "$scene" -o a.html --beams
check "a page needs no --beams" matches "$(<err)" 'a page shows the beams anyway'
check "a page has no script" is "$(grep -c '<script>' a.html)" 0
echo '<!doctype html><html><head></head><body></body></html>' >mine.html
CUVETTE_LIVE=mine.html run render "$scene" -o live.html "${small[@]}" --set 'liquid.ior=1.4' --live
check "--live puts the laboratory into the page" grep -q 'id="cuvette-live">eN[+/=0-9A-Za-z]*</script>' \
    live.html
check "the laboratory may run, but request nothing" grep -q "default-src 'none'.*script-src.*worker-src blob:" live.html
check "a live page shows its command" grep -qF -- "-o live.html --live</pre>" live.html
run render live.html -o page.png
check "a live page's scene gives the same film" is "$(grep -o 'film [0-9a-f]\{16\}' out)" "$page_hash"
rm live.html
CUVETTE_LIVE=none.html run render "$scene" -o live.html --live
check "--live without the laboratory" is "$(<err)" "cuvette: --live: cannot find the laboratory in one file, \
none.html; build it with 'make setup-wasm setup-site site', or set CUVETTE_LIVE to its path"
CUVETTE_LIVE=mine.html run render "$scene" -o a.png --live
check "--live is for pages" matches "$(<err)" 'only a page can hold the laboratory; add -o FILE.html'
CUVETTE_LIVE=mine.html run render "${scene%/*}/chequer.yaml" -o live.html --live
check "--live of a scene that reads files" matches "$(<err)" 'cannot name files, but tiles reads chequer.png'
rm mine.html
check "no other files are left" is "$(find . -type f -printf '%f\n' | LC_ALL=C sort | tr '\n' ' ')" \
    "a.html a.jpg a.pfm a.png b.png c.png check.log err json_get out page.png "

# --- the JSON output of render
run render "$scene" --json "${small[@]}" --set render.depth=3 --set lamp.position.x=2 --set render.threads=3
check "--json needs no -o" silent_success
check "--json prints one JSON object" is "$(json @type)" object
check "the schema version, and that the frame is complete" is "$(json schema complete)" "$(lines 1 true)"
check "film_hash is 16 hexadecimal digits" matches "$(json film_hash)" '^[0-9a-f]{16}$'
check "there is one camera ray per pixel" is "$(json rays.camera)" 4800
total=$(json rays.total)
check "the kinds of rays add up to the total" is \
    "$(json rays.camera rays.reflect rays.refract rays.shadow | sum)" "$total"
check "rays by depth and shadow rays add up to the total" is "$(json 'rays_by_depth[]' rays.shadow | sum)" "$total"
check "rays_by_depth has one number per depth" is "$(json rays_by_depth@length)" 4
check "first hits by solid" is "$(json first_hits@keys)" "$(lines ground vessel liquid rod)"
check "first hits of the vessel" holds "$(json first_hits.vessel) > 0"
check "hits and tests by solid" holds "0 < $(json hits.rod) && $(json hits.rod) <= $(json tests.rod)"
check "cut rays" holds "$(json cut.depth.rays) > 0 && $(json cut.weight.rays) == 0 && $(json \
    cut.depth.throughput@length) == 3"
check "cut_throughput is the mean of the channels" \
    holds "($(json 'cut.depth.throughput[]' | sum) / 3 - $(json cut_throughput)) ^ 2 < 1e-18"
check "there is one record per worker" is "$(json 'threads[].worker')" "$(lines 0 1 2)"
check "the workers' rays add up" is "$(json 'threads[].rays.total' | sum)" "$total"
check "the workers' shadow rays add up" is "$(json 'threads[].rays.shadow' | sum)" "$(json rays.shadow)"
check "keys of a worker" is "$(json 'threads[0]@keys' | sort | tr '\n' ' ')" \
    "$(lines blocked_s busy_s cpu_s involuntary_switches pu rank rays runnable_s running_s start_s tiles visibility_s \
        voluntary_switches waiting_s wall_s worker | tr '\n' ' ')"
check "times and process" holds "$(json wall_s) > 0 && $(json cpu_s) > 0 && $(json peak_rss_bytes) > 0"
check "context switches and the share of other processes" json voluntary_switches involuntary_switches others_fraction
check "noise is null without random samples" is "$(json noise@type)" null
check "hardware counters are numbers or null" is "$(json hardware@keys | sort | tr '\n' ' ')" \
    "branch_misses cache_misses cycles instructions "
check "parameters have types" is "$(json 'params["render.depth"]@type' 'params["render.weights"]')" \
    "$(lines integer fresnel)"
check "vectors are lists" is "$(json 'params["lamp.position"][]')" "$(lines 2.0 7.0 -5.0)"
check "a real number round-trips" is "$(json 'params["liquid.ior"]')" 1.33
check "isa and version" matches "$(json isa version | tr '\n' ' ')" '^(sse2|avx2|avx512) [0-9.]+ $'
run params "$scene" --json
json 'params[].path' | sort >all.txt
run render "$scene" --json "${small[@]}"
check "the JSON output has every parameter" is "$(json params@keys | sort | comm -13 - all.txt)" ""
check "the summary and the JSON output have the same hash" is "$(json film_hash)" "$hash"
run render "$scene" --json "${small[@]}" --set render.threads=7 --set render.schedule=rows
check "threads and schedule do not change the film" is "$(json film_hash)" "$hash"
run render "$scene" --json "${small[@]}" --set render.threads=auto
check "threads: auto does not change the film, and the account keeps the word" is \
    "$(json film_hash 'params["render.threads"]')" "$(lines "$hash" auto)"
check "threads: auto starts one worker per unit of the process" is "$(json workers)" "$(nproc)"
CUVETTE_ISA=sse2 run render "$scene" --json "${small[@]}"
check "CUVETTE_ISA is used and does not change the film" is "$(json isa film_hash)" "$(lines sse2 "$hash")"
run render "$scene" --json "${small[@]}" --repeat 5
check "--repeat gives all times" is "$(json wall_s_all@length cpu_s_all@length)" "$(lines 5 5)"
check "--repeat: fewer than six frames have no interval" is \
    "$(json 'wall_s_interval[0]' 'wall_s_interval[1]')" "$(lines null null)"
run render "$scene" "${small[@]}" -o repeat.png --repeat 6
check "--repeat prints median, interval, range and number" grep -qE \
    '^wall time: median [0-9.]+ s, 95% interval [0-9.]+ to [0-9.]+ s, range [0-9.]+ to [0-9.]+ s, n = 6$' out
run render "$scene" "${small[@]}" -o repeat.png --repeat 3
check "--repeat of few frames prints the range" grep -qE \
    '^CPU time: median [0-9.]+ s, range [0-9.]+ to [0-9.]+ s, n = 3$' out
run render "$scene" --json "${small[@]}" --repeat 5
check "--repeat gives the medians" is "$(json wall_s cpu_s)" \
    "$(lines "$(json 'wall_s_all[]' | sort -g | sed -n 3p)" "$(json 'cpu_s_all[]' | sort -g | sed -n 3p)")"
check "--repeat does not change the film" is "$(json film_hash rays.camera)" "$(lines "$hash" 4800)"
run render "$scene" --json "${small[@]}" --set render.depth=2 --set render.depth=0
check "the last --set wins" is "$(json 'params["render.depth"]' rays.reflect)" "$(lines 0 0)"
run render "$scene" --json "${small[@]}" --set liquid.visible=no --set render.pool=false
check "switches take no and false" is "$(json 'params["liquid.visible"]' 'params["render.pool"]')" "$(lines off off)"
if locale -a 2>/dev/null | grep -qi '^de_DE'; then
    LC_ALL=de_DE.UTF-8 run render "$scene" --json "${small[@]}"
    check "a locale with a decimal comma changes nothing" is "$(json film_hash 'params["liquid.ior"]')" \
        "$(lines "$hash" 1.33)"
fi

# --- maps and timeline
run render "$scene" "${small[@]}" --rays rays.png --time time.png --timeline line.json --set render.threads=2
check "maps and a timeline without an image" depth_noted
check "maps and timeline do not change the film" grep -q "film $hash" out
check "the map of rays is a PNG with a colour scale" \
    is "$(($(od -An -tu1 -j22 -N2 rays.png | awk '{print $1*256+$2}') > 60))" 1
check "the map of time is a PNG" magic time.png 89504e47
check "the timeline is JSON with events" holds "$(./json_get line.json traceEvents@length) > 3"
check "the timeline has one named row per worker" \
    is "$(./json_get line.json 'traceEvents[name=thread_name].args.name')" "$(lines "worker 0" "worker 1")"
tiles() { ./json_get line.json "traceEvents[ph=X].$1"; }
check "the tiles of the timeline cover the image" is 4800 \
    "$(paste <(tiles args.x0) <(tiles args.x1) <(tiles args.y0) <(tiles args.y1) |
        awk '{s += ($2 - $1) * ($4 - $3)} END {print s}')"
check "no tile ends before it begins" is "$( (
    tiles dur
    tiles ts
) | grep -c '^-')" 0
run render "$scene" "${small[@]}" --rays rays.pfm --json
# One channel of the PFM sums to the number of rays.
sum=$(tail -c $((80 * 60 * 12)) rays.pfm | od -An -v -tf4 -w12 | awk '{s += $1} END {printf "%d", s}')
check "the map of rays sums to the number of rays" is "$sum" "$(json rays.total)"
run render "$scene" "${small[@]}" --rays again.pfm --repeat 2 --json
check "maps do not depend on --repeat" cmp rays.pfm again.pfm
run render "$scene" "${small[@]}" --layers once --set render.integrator=aov
check "layers of the first hits, one file each" is "$(ls once-*)" \
    "$(printf 'once-%s.pfm\n' albedo depth material normal position solid)"
# Sky, ground, vessel and rod; no camera ray hits the liquid, the third solid, first.
check "the layer of solids has their numbers" is "0 1 2 4 " \
    "$(tail -c $((80 * 60 * 12)) once-solid.pfm | od -An -v -tf4 -w12 | awk '{print $1}' | sort -nu | tr '\n' ' ')"
run render "$scene" "${small[@]}" --layers again --repeat 2 --json --set render.integrator=aov
check "layers do not depend on --repeat" cmp once-position.pfm again-position.pfm

# --- parameters
run params
check "params prints a table" silent_success
check "params names range, unit, default and meaning" grep -q '^render.depth .*4 .*0\.\.64.*recursion depth' out
run params --json
check "params --json lists the table" holds "$(json params@length) > 40"
check "params --json has path, default and range of each" is \
    "$(json 'params[].path' 'params[].default' 'params[].range' | wc -l)" \
    $((3 * $(json params@length)))
run params "$scene"
check "params of a scene has its values" grep -q '^liquid.ior  *1\.33 ' out
run params "$scene" liquid.ior
check "params of a scene and a path prints that parameter" is "$(tail -n +2 out | cut -d' ' -f1)" liquid.ior
run params "${scene%/*}/slime.yaml"
check "params of a scene with a slime prints slime parameters" grep -q '^toy.stiffness  *10 ' out
run params "${scene%/*}/models.yaml"
check "params prints no slime parameters for other meshes" is "$(grep -c stiffness out)" 0
run params checker
check "params of a word prints the parameters with that name" is "$(tail -n +2 out | cut -d' ' -f1)" MATERIAL.checker
run params highlight
check "params of a word prints the parameters with the word in their meaning" is \
    "$(tail -n +2 out | cut -d' ' -f1)" MATERIAL.shininess
run params --man
check "params --man is roff" grep -q '^\.SS ' out
page=$manual/man5/cuvette-scene.5
missing=0
while read -r path _; do
    grep -qF -- "$path" "$page" || missing=$((missing + 1))
done < <("$program" params | tail -n +2)
check "cuvette-scene(5) names every parameter" is "$missing" 0
example() { # PAGE: its first example
    awk '/^\.EE/ {exit} on {print} /^\.EX/ {on = 1}' "$manual/$1" | sed 's/\\-/-/g'
}
example man5/cuvette-scene.5 >page.yaml
run render page.yaml -o page.png "${small[@]}"
check "the scene of cuvette-scene(5) renders without a note" silent_success
check "every solid of the scene of cuvette-scene(5) is hit" is \
    "$("$program" render page.yaml --json "${small[@]}" | ./json_get - hits | grep -c ':0[,}]')" 0
mkdir page
cp -r "$root/experiments/scenes" page/
example man5/cuvette-study.5 >page/page.study
run study status page/page.study
check "the study of cuvette-study(5) can be run" silent_success

# --- comparison
pfm() { # WIDTH HEIGHT CHANNEL...: bytes of little-endian floats, rows from the bottom
    printf 'PF\n%d %d\n-1.0\n' "$1" "$2"
    printf '%b' "${@:3}"
}
zero='\x00\x00\x00\x00' one='\x00\x00\x80\x3f'
pfm 2 1 $zero $zero $zero $one $one $one >left.pfm
pfm 2 1 $zero $zero $zero $one $zero $one >right.pfm
run compare left.pfm right.pfm
check "compare succeeds for different images" silent_success
check "compare prints a table" is "$(cut -c1-12 out | tr -d ' ' | tr '\n' ' ')" \
    "size mse psnr ssim flip largest differing "
check "one channel of six: mse 1/6, psnr 10 log10 6" is "$(sed -n 's/^\(mse\|psnr\) *//p' out)" \
    "$(lines 0.166667 "7.78 dB")"
check "compare prints the largest difference and its pixel" grep -q '^largest     1 at 1,0$' out
check "compare prints the fraction of differing pixels" grep -q '^differing   50% of the pixels' out
run compare left.pfm right.pfm --json
check "compare --json" is "$(json schema width height mse 'largest_at[]' differing_fraction 'bits[]')" \
    "$(lines 1 2 1 0.16666666666666666 1 0 0.5 32 32)"
check "keys of compare --json" is "$(json @keys | sort | tr '\n' ' ')" \
    "bits differing_fraction files flip height largest largest_at mse psnr_db schema ssim width "
run compare a.png b.png --diff where.png
check "compare of equal images" is "$(sed -n '/^size/d; s/  */ /p' out | tr '\n' ';')" \
    "mse 0;psnr identical;ssim 1.000000;flip 0.000000;largest 0;differing 0% of the pixels, at 8 bits;"
check "--diff writes a PNG" magic where.png 89504e47
check "--diff writes an image of the same size" is "$(od -An -tu1 -j16 -N8 where.png | tr -s ' ')" " 0 0 0 80 0 0 0 60"
run compare a.png b.png --json
check "equal images have no psnr" is "$(json psnr_db@type largest_at@type flip)" "$(lines null null 0.0)"
run compare a.png a.pfm --json
check "8 bits differ by at most half a step" holds "$(json largest) <= 0.5 / 255 + 1e-6 && $(json largest) > 0.4 / 255"
check "half a step is no difference at 8 bits" is "$(json differing_fraction)" 0.0
run compare a.jpg a.png --diff where.jpg
check "a JPEG can be compared with a PNG" silent_success
check "--diff writes a JPEG" magic where.jpg ffd8ff
run compare a.jpg a.png --diff where.pfm
check "--diff writes a PFM" is "$(head -c 9 where.pfm | tr '\n' ' ')" "PF 80 60 "

# --- media
run media
check "media prints the catalogue" silent_success
check "media has n_d, n_F, n_C, Abbe's number, range, temperature, reference and source" \
    grep -qE '^bk7 +1\.51680 +1\.52238 +1\.51432 +64\.17 +300\.\.2500 +20 +air +Schott' out
check "media marks extrapolated indices" grep -qE '^glycerol +1\.47227\* +1\.47683\* +1\.46991 +68\.30\* ' out
check "media has no Abbe's number without dispersion" grep -qE '^olive-oil .* - +589\.3 ' out
check "media: one line each, a blank one before metals and coatings" is \
    "$(wc -l <out) $(cut -d' ' -f1 out | sort -u | wc -l)" "98 96"
check "media has n, k and reflectance of metals, range and source" \
    grep -qE '^gold +0\.2774 +2\.9274 +1\.1476 +1\.8394 .* 0\.891 +367\.9\.\.821\.1 +Johnson' out
check "media has the reflectance of coatings" grep -qE '^ar-550 +0\.0162 .* one quarter-wave layer' out
run media mirror-550 --json
check "media of a coating has its layers" \
    is "$(json 'coatings[0].layers' media@length)" "$(lines '10x(tio2 550/4, fused-silica 550/4)' 0)"
run media --at 500
check "media --at has one more column" is "$(awk 'NR == 1 || $1 == "bk7" {print $6}' out)" "$(lines n_at 1.52141)"
check "media --at leaves out media that were not measured there" grep -qE '^glycerol .* - +589' out
run media fused-silica --at 632.8
check "media of a name prints its coefficients" grep -qE \
    '^coefficients +0\.6961663 0\.0684043 0\.4079426 0\.1162414 0\.8974794 9\.896161$' out
check "media of a name prints its formula" grep -qE '^law .*n\^2 = 1 \+ .*L\^2 - C\^2' out
check "media of a name with --at prints the index relative to vacuum as well" \
    grep -qE '^n_at +1\.4570[0-9]* at 632\.8 nm, relative to vacuum 1\.4574' out
run media glycerol
check "media of a name prints its caveats" grep -qE '^note .*extrapolated' out
run media gold --at 548.6
check "media of a metal prints its index and its table" is \
    "$(grep -cE '^n_at +0\.4300 \+ i 2\.4550|^ +548\.6 +0\.43 ' out)" 2
run media gold --json
check "media --json of a metal has that metal only" is \
    "$(json media@length metals@length 'metals[0].name' 'metals[0].points@length')" "$(lines 0 1 gold 16)"
run media water --json
check "media --json of a name has that medium only" is "$(json schema media@length 'media[0].name' 'media[0].law')" \
    "$(lines 1 1 water sellmeier)"
check "media --json: absolute is n_d of a law relative to vacuum" is "$(json 'media[0].n_d')" \
    "$(json 'media[0].absolute.n_d')"
run media --json --at 500
check "media --json has all media" is "$(json media@length metals@length coatings@length)" "$(lines 77 4 12)"
check "media --json: relative to air and absolute" holds \
    "($(json 'media[name=bk7].absolute.n_d') / $(json 'media[name=bk7].n_d') - 1.00027717) ^ 2 < 1e-16"
check "media --json --at" holds "($(json 'media[name=bk7].at.n') - 1.52141) ^ 2 < 1e-10"
check "media --json --at is null where it was not measured" is \
    "$(json 'media[name=glycerol].at.n' 'media[name=glycerol].extrapolated')" \
    "$(lines null '["n_d","n_F"]')"
check "media --json: room temperature and no Abbe's number are null" \
    is "$(json 'media[name=diamond].temperature_c' 'media[name=olive-oil].V_d')" "$(lines null null)"

# --- mesh
run mesh --generate box --size 1,2,3
check "mesh describes a box" is "$code $(grep -E '^(triangles|area|closed|volume)' out | tr -s ' ' | tr '\n' ' ')" \
    "0 triangles 12 area 22 closed yes volume 6 "
run mesh --generate lathe --profile 1,0,1,1 --around 4
check "mesh locates a hole" grep -qE \
    '^closed +no: the edge from vertex [0-9]+ to [0-9]+ of triangle [0-9]+ is shared by 1, not 2$' out
run mesh --generate sphere --count 20 --json
check "mesh --json" is "$(json schema triangles vertices closed hole single)" "$(lines 1 20 60 true null true)"
run mesh --generate sparse --count 3 --json
check "mesh --json: no volume, but the hole" is "$(json closed volume hole.triangle hole.sharing)" \
    "$(lines false null 0 1)"
boxes() { # boxes FROM,TO,SIGN...: along x, as OBJ; SIGN -1: inside out
    local from to sign count=0
    for box; do
        IFS=, read -r from to sign <<<"$box"
        for x in "$from" "$to"; do printf 'v %s 0 0\nv %s 1 0\nv %s 1 1\nv %s 0 1\n' "$x" "$x" "$x" "$x"; done
        for face in '1 4 3 2' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8'; do
            # shellcheck disable=SC2086
            set -- $face
            [[ $sign == 1 ]] || set -- "$3" "$2" "$1" "$4"
            echo "f $(($1 + count)) $(($2 + count)) $(($3 + count)) $(($4 + count))"
        done
        count=$((count + 8))
    done
}
said() { tr -s ' ' <out | grep -E '^(closed|volume|shells|solid)' | tr '\n' ' '; }
boxes 0,1,1 1,3,1 >glued.obj
run mesh glued.obj
check "mesh: glued boxes are one shell" is "$code $(said)" "0 closed yes volume 3 shells 1 "
boxes 0,2,1 1,3,-1 >crossing.obj
run mesh crossing.obj
check "mesh: what a transparent solid would be refused for" is "$code $(said | cut -d, -f1)" \
    "0 closed yes volume 0 shells 2 solid no: shells of the mesh overlap"
run mesh crossing.obj --json
check "mesh --json: the refusal" is "$(json closed shells) $(json refusal | grep -c 'shells of the mesh overlap')" \
    "$(lines true 2) 1"
boxes 0,1,1 0,1,-1 >twosided.obj
run mesh twosided.obj
check "mesh: faces to both sides bound nothing" grep -q '^closed  *no: each triangle lies on one that faces the' out
# checksums of the dumps of these triangles by the peers' program embree_bench, whose axes are the world's
run mesh --generate sparse --count 100 -f obj
check "mesh -f obj equals the dump of embree_bench in right-handed axes" is "$(awk '
    $1 == "v" && !sub(/^-/, "", $4) { $4 = "-" $4 }
    $1 == "f" { corner = $3; $3 = $4; $4 = corner }
    1' out | cksum)" "894476047 13145"
run mesh --generate torus --around 5 --tube 4 -f obj -o torus.obj
check "mesh -o writes a file and prints nothing" is \
    "$code $(cat out err | wc -c) $(grep -c ^v torus.obj) $(grep -c ^f torus.obj)" "0 0 30 40"
triangles() { # triangles FILE.obj: a checksum of their corners, whatever the order of vertices and the sign of 0
    awk '{ for (i = 2; i <= NF; i++) if ($i == 0) $i = 0 }
        $1 == "v" { at[++n] = $2 " " $3 " " $4 }
        $1 == "f" { print at[$2], at[$3], at[$4] }' "$1" | cksum
}
run mesh torus.obj -o again.obj
check "mesh reads and writes a file in its own axes" is "$code $(triangles again.obj)" "0 $(triangles torus.obj)"
run mesh --generate terrain --around 5 --tube 4 -f obj
hills=$(<out)
run mesh --generate terrain --around 5 --tube 4 -f ply -o hills.ply
printf '%s\n' 'render: {width: 40, height: 30, depth: 2}' 'meshes: {hills: {generate: terrain, around: 5, tube: 4}}' \
    'camera: {position: [0.5, 1, -2], target: [0, 0.3, 0]}' 'lights: {lamp: {position: [3, 5, -4]}}' \
    'solids: {s: {shape: mesh, mesh: hills, shading: SHADING}}' >hills.yaml
for pair in obj:flat ply:smooth; do
    printf '%s\n' "$hills" >hills.obj
    sed "s/SHADING/${pair#*:}/" hills.yaml >one.yaml
    sed "s/{generate: .*/{file: hills.${pair%:*}}}/" one.yaml >two.yaml
    run render one.yaml --json -o one.png
    once=$(json film_hash)
    run render two.yaml --json -o two.png
    check "a generated mesh and its ${pair%:*} file have one film" is "$code $(json film_hash)" "0 $once"
done
# A GLB file by an independent reader: every number, index and offset.
cat >glb.py <<'END'
import json, struct, sys
b = open(sys.argv[1], 'rb').read()
magic, version, length, size, kind = struct.unpack('<4sIII4s', b[:20])
assert (magic, version, length, kind) == (b'glTF', 2, len(b), b'JSON') and size % 4 == 0
j = json.loads(b[20:20 + size])
rest, kind = struct.unpack('<I4s', b[20 + size:28 + size])
data = b[28 + size:]
assert kind == b'BIN\0' and rest == len(data) == j['buffers'][0]['byteLength'] and rest % 4 == 0
def read(index):
    a = j['accessors'][index]
    v = j['bufferViews'][a['bufferView']]
    n = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3}[a['type']]
    assert v['byteOffset'] % 4 == 0 and v['byteLength'] == 4 * n * a['count']
    assert v['byteOffset'] + v['byteLength'] <= rest
    all = struct.unpack_from('<%d%s' % (n * a['count'], {5126: 'f', 5125: 'I'}[a['componentType']]), data,
                             v['byteOffset'])
    rows = [all[i:i + n] for i in range(0, len(all), n)]
    if 'min' in a:
        assert [list(map(f, zip(*rows))) for f in (min, max)] == \
            [[struct.unpack('f', struct.pack('f', x))[0] for x in a[k]] for k in ('min', 'max')]
    return rows
for p in j['meshes'][0]['primitives']:
    at = {name: read(index) for name, index in p['attributes'].items()}
    assert len({len(rows) for rows in at.values()}) == 1
    for n in at.get('NORMAL', []):
        assert abs(sum(x * x for x in n) - 1) < 1e-6
    corners = [i for i, in read(p['indices'])]
    m = j['materials'][p['material']] if 'material' in p else {}
    pbr = m.get('pbrMetallicRoughness', {'baseColorFactor': []})
    image = 'baseColorTexture' in pbr and j['images'][j['textures'][pbr['baseColorTexture']['index']]['source']]['uri']
    print(m.get('name'), [round(c, 6) for c in pbr['baseColorFactor']], image, m.get('alphaMode'))
    for t in range(0, len(corners), 3):
        print(*('%g,%g,%g' % at['POSITION'][i] for i in corners[t:t + 3]),
              *('%g,%g' % at['TEXCOORD_0'][i] for i in corners[t:t + 3] if 'TEXCOORD_0' in at))
END
printf '%s\n' 'newmtl red' 'Kd 1 0.25 0.5' 'map_Kd my%20paint.png' 'newmtl glass' 'Kd 0 1 0' 'd 0.25' >two.mtl
printf 'x' >'my paint.png'
printf '%s\n' 'mtllib two.mtl' 'v 0 0 0' 'v 1 0 0' 'v 1 2 0' 'v 0 2 -0.5' 'vt 0 0' 'vt 1 0' 'vt 1 0.75' 'usemtl red' \
    'f 1/1 2/2 3/3' 'usemtl glass' 'f 1/1 3/3 4/2' >two.obj
run mesh two.obj -o two.glb
check "mesh -o x.glb" is "$code $(cat err) $(python3 glb.py two.glb)" "0  $(lines \
    "red [1.0, 0.25, 0.5, 1.0] my%20paint.png None" '0,0,0 1,0,0 1,2,0 0,1 1,1 1,0.25' \
    'glass [0.0, 1.0, 0.0, 0.25] False BLEND' '0,0,0 1,2,0 0,2,-0.5 0,1 1,0.25 1,1')"
# The looks of a GLB file by its film: images inside it and files of their own, each kind of alpha, emission and glass.
cat >looks.py <<'END'
import json, struct, zlib
def png(*rows):
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 2, len(rows), 8, 6, 0, 0, 0)) + \
        chunk(b'IDAT', zlib.compress(b''.join(b'\0' + bytes(r) for r in rows))) + chunk(b'IEND', b'')
image = png([255, 40, 40, 255, 40, 255, 40, 60], [40, 40, 255, 140, 255, 255, 40, 220])
open('f g.png', 'wb').write(image)
corners = [(x, y) for x in range(6) for y in (0, 1)]
data = b''.join(struct.pack('<3f', x, y, 0.25 * y) for x, y in corners) + \
    b''.join(struct.pack('<2f', 2.5 * x, 1.75 * y) for x, y in corners) + \
    b''.join(struct.pack('<6I', *(2 * k + i for i in (0, 2, 3, 0, 3, 1))) for k in range(5)) + \
    image + bytes(-len(image) % 4)
def accessor(view, kind, type, count, **more):
    return {'bufferView': view, 'componentType': kind, 'type': type, 'count': count, **more}
def look(texture, alpha, **more):
    pbr = {'baseColorFactor': [0.9, 0.7, 0.8, alpha]}
    return {'pbrMetallicRoughness': pbr if texture is None else {**pbr, 'baseColorTexture': {'index': texture}}, **more}
j = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
     'buffers': [{'byteLength': len(data)}],
     'bufferViews': [{'buffer': 0, 'byteOffset': at, 'byteLength': n}
                     for at, n in ((0, 144), (144, 96), (240, 120), (360, len(image)))],
     'accessors': [accessor(0, 5126, 'VEC3', 12, min=[0, 0, 0], max=[5, 1, 0.25]), accessor(1, 5126, 'VEC2', 12)] +
                  [accessor(2, 5125, 'SCALAR', 6, byteOffset=24 * k) for k in range(5)],
     'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'TEXCOORD_0': 1}, 'indices': 2 + k, 'material': k}
                                for k in range(5)]}],
     'images': [{'bufferView': 3, 'mimeType': 'image/png'}, {'uri': 'f%20g.png'}],
     'samplers': [{'wrapS': 33071, 'wrapT': 33648, 'magFilter': 9728, 'minFilter': 9728}, {'minFilter': 9729}],
     'textures': [{'source': 0, 'sampler': 0}, {'source': 1, 'sampler': 1}, {'source': 0}],
     'extensionsUsed': ['KHR_materials_emissive_strength', 'KHR_materials_transmission'],
     'materials': [look(0, 1, alphaMode='MASK', alphaCutoff=0.45), look(1, 0.6, alphaMode='BLEND'), look(2, 1),
                   look(None, 1, emissiveFactor=[1, 0.5, 0.1],
                        extensions={'KHR_materials_emissive_strength': {'emissiveStrength': 3}}),
                   look(None, 1, extensions={'KHR_materials_transmission': {'transmissionFactor': 0.7}})]}
text = json.dumps(j).encode()
text += b' ' * (-len(text) % 4)
open('looks.glb', 'wb').write(struct.pack('<4sIII4s', b'glTF', 2, 28 + len(text) + len(data), len(text), b'JSON') +
                              text + struct.pack('<I4s', len(data), b'BIN\0') + data)
END
python3 looks.py
look_film() { # look_film MESH
    printf '%s\n' 'render: {width: 120, height: 40, depth: 4, transmission: simple}' "meshes: {m: {file: $1}}" \
        'camera: {position: [2.5, 0.8, -5], target: [2.5, 0.5, 0]}' 'lights: {lamp: {position: [3, 5, -4]}}' \
        'background: {color: [0.2, 0.3, 0.4]}' 'solids: {s: {shape: mesh, mesh: m}}' >looks.yaml
    run render looks.yaml --json -o looks.png
    echo "$code $(json film_hash)"
}
mkdir -p 'a b'
run mesh looks.glb -o 'a b/looks.glb'
check "mesh -o x.glb keeps the looks of a GLB file" is "$(look_film 'a b/looks.glb')" \
    "0 $(look_film looks.glb | cut -c 3-)"
check "mesh -o x.glb names an image from its own folder" grep -qaF '"uri":"../f%20g.png"' 'a b/looks.glb'
for part in 'alphaMode":"MASK' 'alphaMode":"BLEND' 'mimeType":"image/png' 'wrapS":33071' 'emissiveStrength":3' \
    'transmissionFactor":'; do
    check "mesh -o x.glb writes $part" grep -qaF "$part" 'a b/looks.glb'
done
run mesh looks.glb -f glb
check "mesh -f glb to standard output starts paths in the working folder" grep -qaF '"uri":"f%20g.png"' out
run mesh --generate torus --around 5 --tube 4 -o torus.glb
check "mesh -o x.glb says how far positions change" grep -qE \
    '^cuvette: note: GLB files have single precision: positions change by up to [1-9](\.[0-9])?e-0[78]' err
check "mesh -o x.glb of a torus" is "$code $(python3 glb.py torus.glb | wc -l)" "0 41"
run mesh --generate sphere --count 80 -f glb -o ball.glb
run mesh --generate sphere --count 80 -f ply -o ball.ply
gzip -k ball.ply torus.obj
for file in ball.glb ball.ply ball.ply.gz; do
    printf '%s\n' 'render: {width: 40, height: 30, depth: 2}' "meshes: {ball: {file: $file}}" \
        'camera: {position: [0.5, 1, -2], target: [0, 0.3, 0]}' 'lights: {lamp: {position: [3, 5, -4]}}' \
        'solids: {s: {shape: mesh, mesh: ball, shading: flat, transparency: 1, ior: 1.5}}' >ball.yaml
    run render ball.yaml --json -o ball.png
    echo "$code $(json film_hash)"
done | sort -u | wc -l >films
check "a scene reads GLB, PLY and PLY.gz alike" is "$(cat films)" 1
run mesh torus.obj.gz -o again.obj
check "mesh reads a compressed OBJ" is "$code $(triangles again.obj)" "0 $(triangles torus.obj)"
{ head -c 100 torus.obj | gzip && tail -c +101 torus.obj | head -c -1 | gzip; } >members.OBJ.GZ
run mesh members.OBJ.GZ -o again.obj
check "mesh reads two members, to the last byte" is "$code $(triangles again.obj)" "0 $(triangles torus.obj)"
head -c 200 torus.obj.gz >cut.obj.gz
run mesh cut.obj.gz
check "mesh refuses a compressed file that is cut short, by its name" is "$code $(cat err)" \
    "2 cuvette: cut.obj.gz: the compressed file is damaged; check that the file is complete, or compress it again"
yes 'v 0 0 0' | head -c 40000000 | gzip >bomb.obj.gz
size=$(python3 -c 'import os; print("%.3g" % (os.path.getsize("bomb.obj.gz") / 1e6))')
said=$("$(dirname "$program")/cuvette-import" --memory=100 bomb.obj.gz 2>&1 >/dev/null)
check "the importer refuses a small file with a large text" is "$? ${said%%;*}" \
    "2 cuvette-import: bomb.obj.gz: its $size MB expand to more than 26 MB, a quarter of the memory that \
reading it may take"
rm bomb.obj.gz
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'f 1 2 x' >bad.obj
run mesh bad.obj
check "mesh names the file and the line" is "$code $(cut -c 1-19 err)" "2 cuvette: bad.obj:3:"
# --- mesh --close
head -n -2 torus.obj >open.obj
run mesh open.obj --close -o closed.obj
check "mesh --close says what it did" is "$code $(cat err)" "0 cuvette: note: welded 0 vertices; dropped 0 degenerate \
and 0 double triangles; swapped 0 diagonals; turned 0 over; filled 1 hole with 2 triangles: 4 edges, 0.951 wide"
run mesh closed.obj
check "mesh --close closes" is "$(grep -cE '^closed +yes' out) $(grep -cE '^triangles +40' out)" "1 1"
run mesh closed.obj --close -o same.obj
check "mesh --close leaves a closed mesh as it is" is "$code $(cat err) $(cmp closed.obj same.obj && echo same)" \
    "0 cuvette: note: the mesh is closed already; nothing was changed same"
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0.1 0.1 0' 'f 1 2 3' >flat.obj
run mesh flat.obj --close --weld 0.5
check "mesh --close refuses a distance that leaves no triangle" is "$code $(cat err)" "2 cuvette: flat.obj: the mesh \
cannot be closed: all triangles have two equal corners; use a smaller distance to weld"
run mesh torus.obj --weld=0.1
check "--weld needs --close" is "$code $(cat err)" "2 cuvette: mesh: --weld has no effect without --close; add --close"
run mesh torus.obj --close --weld=9
check "mesh --close refuses a distance that joins everything, by the file's name" is "$code $(cut -d';' -f1 err)" \
    "2 cuvette: torus.obj: vertices of a mesh of size 2.66296 cannot be welded within 9"
run mesh --generate box -f ply
check "mesh -f ply: header and bytes" is \
    "$(head -c 35 out | tr '\n' ' ') $(($(wc -c <out) - $(grep -am1 -bo end_header out | cut -d: -f1) - 11))" \
    "ply format binary_little_endian 1.0 $((24 * 32 + 12 * 13))"
run mesh --generate sparse --count 100 -f obj
check "peers/mesh_scene.awk writes the scene for POV-Ray" is \
    "$(awk -v peer=povray -f "$root/experiments/peers/mesh_scene.awk" out | cksum)" "3555543625 13831"
check "peers/mesh_scene.awk writes the scene for Tachyon" is \
    "$(awk -v peer=tachyon -f "$root/experiments/peers/mesh_scene.awk" out | grep -c '^TRI V0 ')" 100
run mesh --generate toru
check "an unknown body is refused with the nearest" matches "$code $(<err)" \
    "^2 cuvette: --generate: .*'toru'.*; did you mean 'torus'"
run mesh --generate torus --minor 2
check "wrong radii are refused with the remedy" matches "$code $(<err)" \
    "^2 cuvette: --generate: invalid torus radii 1 and 2; use radii"
run mesh --generate lathe --profile 0,0,1
check "a profile needs pairs" matches "$code $(<err)" \
    "^2 cuvette: --generate: body: the profile has an odd number of values; "
run mesh --generate box -f obj -o nowhere/box.obj
check "a missing folder is refused" matches "$code $(<err)" "^[12] cuvette: .*nowhere/box.obj"
run mesh torus.obj
check "mesh reads a file" is "$code $(grep -E "^(triangles|closed)" out | tr -s " " | tr "\n" " ")" \
    "0 triangles 40 closed yes "
printf 'mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 .5\nusemtl a\nf 1 2 3\n' >lacking.obj
run mesh lacking.obj
check "mesh notes a library that does not exist" is "$code $(<err)" \
    "0 cuvette: note: the material library 'no.mtl' does not exist: its materials are grey"
printf 'meshes: {m: {file: lacking.obj}}\nlights: {l: {position: [1, 1, -1]}}\nsolids: {s: {shape: mesh, mesh: m}}\n' \
    >lacking.yaml
run render lacking.yaml -o lacking.png --set render.width=8 --set render.height=6
check "render notes it, too" grep -q \
    "^cuvette: note: m.file: the material library 'no.mtl' does not exist: its materials are grey$" err
run mesh nothing.obj
check "a missing mesh file" matches "$code $(<err)" "^2 cuvette: .*nothing.obj.*cannot open"
run mesh
check "mesh needs a mesh" matches "$code $(<err)" "^2 cuvette: mesh: no mesh is given; "

# --- realism
run realism "$scene"
check "realism succeeds" silent_success
check "realism passes on the rod scene" is "$(tail -1 out)" "35 of 35 pass"
run realism "$scene" --set liquid.visible=off --csv
check "realism --csv has one line per metric" is "$(wc -l <out)" 36
check "an undefined metric is NA, with its reason" grep -q '^absorption.slope,none,NA,NA,NA,.*"there is no liquid"$' out
run realism "$scene" --set render.weights=constant --set clear.reflectivity=0.1 --set clear.transparency=0.9
check "failed metrics are not an error" silent_success
check "failed metrics are marked" grep -q '^FAIL  fresnel.vessel ' out
run realism "$scene" --json
check "realism --json" is "$(json schema defined passed)" "$(lines 1 35 35)"
run realism "$scene" --curve depth
check "a curve is CSV of three columns" is "$(awk -F'","|,' 'END {print NR, NF}' out)" "18 3"
run realism "$scene" --curve dept
check "an unknown curve is refused with the nearest" matches "$code $(<err)" "^2 cuvette: --curve: .*depth"
run realism "$root/experiments/scenes/solids.yaml"
check "a scene without a vessel is refused" matches "$code $(<err)" \
    "^2 cuvette: .*solids.yaml: there is no visible cup named 'vessel'; "
run realism
check "realism needs a scene" matches "$code $(<err)" "^2 cuvette: realism: no scene is given; "

# --- motion
slime=$root/experiments/scenes/slime.yaml
run motion "$slime" --set toy.level=1
check "motion succeeds" silent_success
check "motion names the slime, its integrator and its step" is "$(head -1 out)" "toy: level 1, euler, steps of 0.001 s"
check "motion has one line per value" is "$(grep -c '^  [a-z_.]* ' out)" 20
run motion "$slime" --set toy.level=1 --set toy.integrator=implicit --csv
check "motion --csv has one line per value" is "$(wc -l <out)" 20
check "an undefined value is NA" grep -q '^toy,stable_dt.spring_s,NA,NA,NA,s,"' out
run motion "$slime" --set toy.level=1 --json
check "motion --json" is "$(json schema 'slimes[].name' 'slimes[].integrator')" "$(lines 1 toy euler)"
check "motion --json has all values" is "$(json 'slimes[].values[].name' | sort -u | wc -l)" 19
run motion "$scene"
check "a scene without a slime is refused" matches "$code $(<err)" \
    "^2 cuvette: .*rod.yaml: nothing moves in this scene: it has no slime; "
run motion "$slime" --json --csv
check "motion takes JSON or CSV" matches "$code $(<err)" "^2 cuvette: motion: --json and --csv exclude each other"

# --- trace and fan
pixel() { # FILE X Y: the three floats of a pixel of an 80 x 60 PFM, whose rows go upwards
    tail -c $((80 * 60 * 12)) "$1" | od -An -v -tf4 -w12 -j$((((59 - $3) * 80 + $2) * 12)) -N12
}
same_floats() { # a radiance of a.pfm and one printed with 17 digits
    paste <(printf '%s\n' $1) <(printf '%s\n' $2) |
        awk '{d = $1 - $2; if (d < 0) d = -d; if (d > 2e-7 * ($2 + 1e-30)) bad = 1} END {exit bad || NR != 3}'
}
for at in 40,30 37,41 5,3 44,22; do
    run trace "$scene" --pixel $at --json "${small[@]}"
    check "trace --json of pixel $at" silent_success
    check "the radiance of pixel $at equals the image" same_floats "$(pixel a.pfm ${at/,/ })" "$(json 'radiance[]')"
done
run trace "$scene" --pixel 40,30 --depth 3 --json "${small[@]}"
check "keys of a tree, in order" is "$(json @keys | tr '\n' ' ')" \
    "schema scene depth radiance root lambda_nm carries cut_depth cut_weight "
check "schema, scene and depth" is "$(json schema scene depth)" "$(lines 1 "$scene" 3)"
check "keys of a ray, in order" is "$(json root@keys | tr '\n' ' ')" \
    "kind depth origin direction throughput medium n hit children end contribution far_end "
check "keys of a hit, in order" is "$(json root.hit@keys | tr '\n' ' ')" \
    "solid surface t point normal from to cos_i cos_t R_s R_p R tir path_length transmittance error_bound opaque $(
    )T radiance_factor "
check "the factors of radiance at a refraction: T, and T (n1 / n2)^2" \
    holds "($(json root.hit.radiance_factor.classic) - (1 - $(json root.hit.R))) ^ 2 < 1e-30 &&
        ($(json root.hit.radiance_factor.basic) * 2.25 - (1 - $(json root.hit.R))) ^ 2 < 1e-30"
check "the tree names the kind of radiance that rays carry" is "$(json carries)" classic
check "the first ray" is "$(json root.kind root.depth root.medium root.n root.end root.hit.solid root.hit.surface \
    root.hit.tir)" \
    "$(lines camera 0 air 1 hit vessel "outer side" false)"
check "media on both sides" is "$(json root.hit.from.medium root.hit.to.medium root.hit.to.n)" "$(lines air vessel 1.5)"
check "the children of the first ray" is "$(json 'root.children[].kind')" "$(lines reflect refract)"
check "shares: reflectance and the rest" \
    holds "($(json 'root.children[kind=reflect].throughput[0]') - $(json root.hit.R)) ^ 2 < 1e-30"
check "numbers have 17 significant digits" grep -qE '"cos_i":0\.[0-9]{16,18},' out
check "a ray beyond the depth limit is marked as cut" \
    grep -q '"depth":4,.*"hit":null,"children":\[\],"end":"cut_depth"' out
check "a shadow ray has its light" grep -q \
    '"kind":"shadow".*"end":"\(lit\|blocked\)".*"light":"lamp","light_distance":' out
count=$(grep -c '"kind"' out)
run trace "$scene" --pixel 40,30 --depth 3 "${small[@]}"
check "trace prints one line per ray, what is cut, and the radiance" is "$(wc -l <out)" $((count + 2))
check "the rays that are cut" matches "$(tail -2 out)" \
    "cut by depth: $(grep -c 'cut_depth' out) rays, weight [0-9.]+; by least weight: 0 rays, weight 0"
run trace "$scene" --pixel 40,30 --depth 30 --min-weight 1e-3 --json "${small[@]}"
check "a deep tree by --min-weight has few rays" holds "$(grep -c '"kind"' out) < 200 && $(json cut_weight.rays) > 5"
run trace "$scene" --pixel 40,30 --depth 3 "${small[@]}"
check "kinds and ends in the text" matches "$(<out)" '^camera .*hit.*refract .*R_s .*cut_depth.*radiance '
run trace "$scene" --ray=0,1.6,-0.5,0,0.6,1 --depth 2 --set rod.visible=off
check "trace of a ray under water: total internal reflection" matches "$(head -1 out)" \
    '^camera  depth 0  in liquid n 1\.33 .* none, TIR '
# beams: the film stays the same, the image does not
run scene "$scene" --add beam:laser,position=-2.5,1.6,-0.4,target=0,1.4,-0.4 -o beams.yaml
check "a beam is added to a scene" is "$code" 0
run trace beams.yaml --beams
check "trace --beams names beam and ray" matches "$(head -1 out)" 'laser: pencil, ray 0 \(of 1\), 587\.562 nm, power 1'
run trace beams.yaml --beams --json
check "trace --beams --json" silent_success
run trace beams.yaml --beams --json
rays=$(grep -c '"kind":"[a-z]*","depth"' out)
run trace beams.yaml --beams -o beams.csv
check "trace --beams as CSV: a row for each ray" is "$(($(wc -l <beams.csv) - 1))" "$rays"
check "each row has all columns" is "$(awk -F, '{ print NF }' beams.csv | sort -u)" 32
check "rows obey Snell's law" is "$(awk -F, 'function sine(deg) { return sin(deg * atan2(0, -1) / 180) }
    $29 != "NA" && NR > 1 { n++; off += ($11 * sine($28) - $27 * sine($29)) ^ 2 > 1e-18 }
    END { print (n > 3), off + 0 }' beams.csv)" "1 0"
check "each row goes to the next: length times direction" is "$(awk -F, 'NR > 1 && $19 == "hit" { n++
    off += ($12 + $22 * $15 - $23) ^ 2 + ($13 + $22 * $16 - $24) ^ 2 + ($14 + $22 * $17 - $25) ^ 2 > 1e-18 }
    END { print (n > 3), off + 0 }' beams.csv)" "1 0"
run trace "$scene" --pixel 40,30 --depth 2 --csv "${small[@]}"
check "trace --csv names no beam for a pixel" matches "$(sed -n 2p out)" '^NA,NA,NA,587\.[0-9]+,NA,0,NA,camera,0,'
check "a shadow ray's row ends at its light" matches "$(grep -m1 ',shadow,' out)" \
    ',(lit|blocked),[a-z_0-9]+,NA,[0-9.]+,NA'
run trace beams.yaml --beams --min-weight 0.1
check "beams have their own least fraction" matches "$(<err)" \
    "--min-weight does not act on beams; use --set BEAM.min_fraction=VALUE"
run trace "$scene" --beams
check "trace --beams without beams" matches "$(<err)" "has no beams; add one: cuvette scene SCENE --add beam:laser"
run render beams.yaml --beams --json
check "render --beams without an image" matches "$(<err)" "no image is written; add -o FILE.png or -o FILE.jpg"
run render beams.yaml "${small[@]}" --json -o plain.png
plain_hash=$(./json_get out film_hash)
run render beams.yaml "${small[@]}" --json -o drawn.png --beams
check "beams leave the film's hash" is "$(./json_get out film_hash)" "$plain_hash"
check "beams are drawn into the image" eval '! cmp -s plain.png drawn.png'

run trace "$scene" --pixel 40,30 --json "${small[@]}" --set render.samples=4
check "four samples are four roots" is "$(json roots@length 'roots[0].throughput[]')" "$(lines 4 0.25 0.25 0.25)"
run trace "$scene" --pixel 40,30 --json "${small[@]}" --set render.polarisation=on
check "polarised rays have their Stokes vectors" is "$(json root.stokes@length 'root.stokes[0]')" "$(lines 4 1)"
run trace "$scene" --pixel 40,30 --set render.spectrum=spectral --lambda 486.1
check "a spectral scene is noted: one wavelength" matches "$(<err)" '^cuvette: note: .*spectral.*486\.1$'
check "a spectral scene is traced" is "$code" 0
run trace "$scene" --pixel 40,30 --set render.integrator=path
check "random paths are noted" matches "$(<err)" '^cuvette: note: .*random paths'
run trace "$scene" --pixel 40,30 --set render.integrator=zbuffer
check "a depth buffer is noted" matches "$(<err)" '^cuvette: note: .*with a depth buffer'
run render "$scene" -o drawn.png --json "${small[@]}" --set render.integrator=zbuffer
check "a depth buffer renders the scene without shadow rays" is "$code $(json rays.shadow)" "0 0"
run render "$scene" -o drawn.png "${small[@]}" --set render.integrator=zbuffer --set render.spectrum=spectral
check "a depth buffer refuses a spectral scene" matches \
    "$code $(<err)" '^2 cuvette: .*depth buffer.*; set render.integrator'
run trace "$scene" --pixel 40,30 --lambda 1200 --set liquid.medium=water "${small[@]}"
check "a medium that was not measured there is noted" matches "$(<err)" \
    '^cuvette: note: liquid\.medium: water was measured only from 182 to 1129 nm'
run trace "$scene" --pixel 40,30 -o tree.json "${small[@]}"
check "-o tree.json writes JSON, and nothing else" is "$(./json_get tree.json schema) $(cat out err)" "1 "
run trace "$scene" --pixel 40,30 -o tree.svg "${small[@]}"
check "-o tree.svg draws" matches "$(head -2 tree.svg | tail -1)" \
    '^<svg xmlns="http://www.w3.org/2000/svg" version="1.1"'
run trace "$scene" --pixel 40,30 --svg "${small[@]}"
check "--svg: the same bytes" cmp out tree.svg
check "the drawing has total reflection, media and axes" is \
    "$(grep -c 'total internal\|liquid, n = 1.33\|from above' tree.svg)" 3
into_closed_pipe trace "$scene" --pixel 400,300 --depth 9 --json
check "a tree into a closed pipe exits with 1 and no message" is "$code $(<err)" "1 "
run fan "$scene" --from -3,1,0 --to 3,1,0 -o fan.csv --set render.spectrum=spectral
check "fan prints the note on a spectral scene" matches "$(<err)" '^cuvette: note: .*spectral'
pencil=(--from -3,1.5,0 --to 3,1.5,0 --width 1.6 --set rod.visible=off)
run section "$scene" --view top --at 0,1,0 --cells 60 -o section.json
check "section writes JSON" silent_success
check "section writes JSON: areas" matches "$(<section.json)" '"areas":\[\{"solid":.*"rings":\[\[\['
run section "$scene" -o section.svg
check "section draws an SVG" silent_success
run section "$scene" --through nothing -o section.svg
check "section names a solid" matches "$(<err)" "there is no solid 'nothing'"
run section "$scene" --extent 1,0,0,1 -o section.svg
check "section needs an extent" matches "$(<err)" 'extent is empty'
run fan "$scene" "${pencil[@]}" --rays 41 -o fan.svg
check "fan draws an SVG" silent_success
check "fan prints the focus" matches "$(<out)" \
    '^41 rays, 41 followed to the end, 40 crossings of adjacent rays, mean focus 1\.7[0-9]*,1\.5,0 '
cp fan.svg first.svg
run fan "$scene" "${pencil[@]}" --rays 41 -o fan.svg
check "fan writes the same bytes again" cmp fan.svg first.svg
run fan "$scene" "${pencil[@]}" --rays 41 --tree -o tree.svg
check "fan --tree draws more lines" holds "$(wc -l <tree.svg) > $(wc -l <fan.svg) + 40"
run fan "$scene" "${pencil[@]}" --rays 5 -o fan.csv
check "fan writes one CSV row per ray" is "$(cut -d, -f1-4 fan.csv | tr '\n' ' ')" \
    "ray,offset,interfaces,end 0,-0.8,4,sky 1,-0.4,4,sky 2,0,4,sky 3,0.4,4,sky 4,0.8,4,sky "
check "the central ray is not deviated and is the axis" is "$(sed -n 4p fan.csv | cut -d, -f11,13-)" 0,NA,NA,NA,NA
run fan "$scene" --from -3,1.5,0 --to 3,1.5,0 --spread 10 --rays 3 -o fan.csv
check "a fan has angles and ends on opaque solids" is "$(cut -d, -f2,4 fan.csv | tr '\n' ' ')" \
    "offset_deg,end -5,sky 0,rod 5,sky "

# --- machine
run machine
check "machine prints its clocks" grep -q '^wall clock ' out
run machine --json
check "machine --json" holds "$(json units) >= 1 && $(json wall_clock.tick_s) > 0"
check "machine --json lists disturbances" is "$(json disturbances@type)" array

# --- lab
run_lab() {    # ARGUMENT...: starts a laboratory in the background; its address is in `address`
    : >lab.out # remove the address of the previous laboratory
    "$program" lab --no-browser "$@" >lab.out 2>lab.err &
    lab=$!
    await $lab test -s lab.out
    address=$(<lab.out)
}
ask() { # PATH [JSON]: prints the whole reply, read through bash's /dev/tcp
    local port=${address#http://127.0.0.1:} method=GET body=${2-}
    [[ $body ]] && method=POST
    exec 9<>"/dev/tcp/127.0.0.1/${port%%/*}"
    printf '%s %s HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nAuthorization: Bearer %s\r\nConnection: close\r\n' $method "$1" \
        "${port%%/*}" "${address##*token=}" >&9
    printf 'Content-Type: application/json\r\nContent-Length: %d\r\n\r\n%s' ${#body} "$body" >&9
    cat <&9
    exec 9>&-
}
export XDG_STATE_HOME=$PWD/state
cp "$scene" here.yaml
run_lab here.yaml
check "lab prints its address, and nothing else" matches "$address $(wc -l <lab.out) $(wc -c <lab.err)" \
    '^http://127\.0\.0\.1:[0-9]+/\?token=[0-9a-f]{32} 1 0$'
check "lab serves its page" grep -q '<title>' <(ask /)
check "lab's image is the film of render" grep -q '"film_hash":"b92bb012fd9c5f71"' <(
    ask '/api/image.png?wait=1' \
        >/dev/null
    ask /api/state
)
kill -INT $lab
wait $lab
check "SIGINT ends lab with status 0" is "$? $(wc -c <lab.err)" "0 0"
mkdir -p browser
cat >browser/xdg-open <<'EOF'
#!/bin/bash
read -r _ _ _ _ _ session _ </proc/$$/stat
echo "$session $1" >browser/seen.part && cp "$1" browser/page && mv browser/seen.part browser/seen
EOF
chmod +x browser/xdg-open
PATH=$PWD/browser:$PATH "$program" lab here.yaml >lab.out 2>lab.err &
lab=$!
await $lab test -s browser/seen
read -r _ _ _ _ _ session _ </proc/$lab/stat
page=$(cut -d' ' -f2 browser/seen)
check "lab opens a page that leads to its address" grep -qF "url=$(<lab.out)\"" browser/page
check "only its owner can read that page" is "$(stat -c %a "$page")" 600
arguments=$(cat /proc/[0-9]*/cmdline 2>/dev/null | tr '\0' '\n')
token=$(sed 's/.*token=//' lab.out)
check "no program has the token as an argument" is "${#token} $([[ $arguments == *"$token"* ]] || echo hidden)" \
    "32 hidden"
check "the browser has its own session, so that Ctrl-C does not end it" holds \
    "$(cut -d' ' -f1 browser/seen) != $session"
kill -INT $lab
wait $lab
check "the page is removed at the end" is "$(ls "$page" 2>/dev/null)" ""
run_lab --folder . --results . --port 0
check "lab needs no scene" matches "$address" '^http'
kill -TERM $lab
wait $lab
check "SIGTERM ends lab with status 0" is $? 0

change_and_end() { # SIGNAL: a laboratory with an unsaved change ends
    run_lab here.yaml
    ask /api/set '{"set": {"liquid.ior": 1.5}}' >lab.reply
    kill "-$1" $lab
    wait $lab
}
change_and_end INT
check "Ctrl-C ends lab and leaves no unsaved scene" is "$? $(find state -type f 2>/dev/null | wc -l)" "0 0"
change_and_end TERM
check "SIGTERM leaves the unsaved scene for its owner alone" is \
    "$? $(stat -c '%a' state/cuvette) $(stat -c '%a' state/cuvette/unsaved-*)" "0 700 600"
check "an unsaved scene is a scene file" grep -q 'ior: 1.5' <("$program" scene state/cuvette/unsaved-*)
check "it has no token" is "$(grep -c "${address##*token=}" state/cuvette/unsaved-*)" 0
run_lab here.yaml
check "the next lab offers it" grep -q '"rescued":\[{"id":"[0-9a-f]*","time":.*"file":"here.yaml"' <(ask /api/state)
kill -INT $lab
wait $lab
check "what was offered only stays" is "$(find state -name 'unsaved-*' | wc -l)" 1
XDG_STATE_HOME=relative HOME=$PWD/home change_and_end TERM
check "without XDG_STATE_HOME it is below HOME" is "$(find home -name 'unsaved-*' | cut -d/ -f1-4)" \
    home/.local/state/cuvette
check "a relative XDG_STATE_HOME is ignored" is "$(ls -d relative 2>/dev/null)" ""
rm -r state home
refused_lab() { # WHAT ERROR ARGUMENT...
    local what=$1 error=$2
    shift 2
    run lab --no-browser "$@"
    check "lab refuses $what" matches "$code $(wc -l <err) $(wc -c <out) $(<err)" "^2 1 0 cuvette: $error"
}
mkdir -p elsewhere
refused_lab "two scenes" "lab: unexpected argument 'here.yaml'; give at most one SCENE" here.yaml here.yaml
refused_lab "a missing scene" 'nowhere.yaml: ' nowhere.yaml
refused_lab "a scene outside of its folder" 'here.yaml: is not in the folder' --folder elsewhere here.yaml
refused_lab "a missing folder" "'nowhere' is not a folder" --folder nowhere
refused_lab "an invalid port" '--port 70000' --port 70000
refused_lab "results elsewhere" '.*results' --folder elsewhere --results results

# --- notes
echo 'solids: {ball: {shape: sphere, ior: 1.5}}' >odd.yaml
run render odd.yaml -o odd.png "${small[@]}"
check "a likely mistake is noted" grep -q '^cuvette: note: ball\.ior: ball ' err
check "a scene with a note is rendered" is "$code" 0
run render odd.yaml --json "${small[@]}"
check "--json leaves notes out" silent_success

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
run study new "$scene" --axis render.depth=0..4:5 --axis render.threads=1,auto --axis 'lamp.position=[0,5,1],[2,5,1]' \
    --set render.width=16 --set render.height=12 --set lamp.color=1,0.5,1 --repetitions 2 -o studies/made.study
check "study new writes a study" is "$(<out)" \
    "studies/made.study: 20 cells of 2 repetitions; cuvette study run studies/made.study"
check "study new explains the parameters" eval \
    'grep -q "# recursion depth" studies/made.study && grep -q "^scene: .*rod.yaml # relative" studies/made.study'
check "study new writes at most 100 columns" holds "$(wc -L <studies/made.study) <= 110"
run study run --dry-run studies/made.study --results none
check "a new study can be run" is "$(head -1 out)" "made: 20 of 20 cells lack rows: 40 rows and 20 warm-ups to measure"
run study new "$scene" --axis liquid.ior=1.3,1,4 --name decimal -o studies/made.study --force
check "study new notes a decimal comma at its line" matches "$(<err)" \
    '^cuvette: note: studies/made\.study:[0-9]+:[0-9]+: liquid\.ior: 1 and 4 are two values; did you mean 1\.4\?$'
check "study new --force replaces a file, and --name its name" grep -q '^study: decimal ' studies/made.study
run study new "$scene" --axis liquid.ior=1.3,1,4
check "study new prints without -o, and the note too" eval \
    'grep -q "^study: rod-ior " out && grep -q "^cuvette: note: liquid.ior: 1 and 4" err'
rm studies/made.study
run study list studies
check "study list shows name, cells and title" matches "$(<out)" 'tiny\.study +3 cells +A small one'
run study run --dry-run studies/tiny.study --results res
check "study run --dry-run counts the missing rows" is "$(head -1 out)" \
    "tiny: 3 of 3 cells lack rows: 6 rows and 3 warm-ups to measure"
check "study run --dry-run estimates the time" matches "$(sed -n 2p out)" \
    '^tiny: (about|less than) [0-9.]+ s, from trial frames of 3 cells, extrapolated in pixels$'
check "study run --dry-run writes nothing" eval '[[ $(wc -l <out) == 3 && ! -e res ]]'
run study status studies/tiny.study --results res
check "study status before the run" matches "$(<out)" '0 of 3 cells'
run study run studies/tiny.study --results res
check "study run" is "$code $(other_notes)" "0 "
lines=$(wc -l <res/tiny/rows.csv)
check "one row per repetition" is "$lines" 10
run study run studies/tiny.study --results res
check "a second run finds nothing to do" matches "$(<out)" 'nothing to do'
check "a second run adds no rows" is "$(wc -l <res/tiny/rows.csv)" "$lines"
run study status studies/tiny.study --results res
check "study status after the run" matches "$(<out)" '3 of 3 cells done, 6 rows and 3 warm-ups in res/tiny, 0 marked'
run study summary studies/tiny.study --results res
check "study summary has one line per cell" is "$(wc -l <out)" 4
check "study summary is separated by tabs" is "$(head -1 out | cut -f1,2)" "$(printf 'cell\trender.depth')"
check "study summary: no interval of fewer than six" is "$(awk -F'\t' 'NR == 2 {print $3, $5, $6}' out)" "2 NA NA"
if command -v script >/dev/null; then
    script -qec "'$program' study summary studies/tiny.study --results res" /dev/null >tty.txt 2>&1
    check "study summary on a terminal is short" grep -q '^cell .*interval.* marked' tty.txt
fi
sed -e 's/repetitions: 2/repetitions: 4/' -e '$a keep: {image: on}' studies/tiny.study >studies/more.study
run study run -n studies/more.study --results res
sed -Ei 's/(about|less than) [0-9.]+ s/about T s/' out
check "study run --dry-run prints what it writes and what is free" matches "$(grep 'free' out)" \
    '^tiny: [0-9.]+( [kMG]?B)?( to [0-9.]+ [kMG]?B)? to write, [0-9.]+ [kMGT]?B free in res$'
sed -i '/ to write, /d' out
check "study run --dry-run uses existing rows and lists files" is "$(<out)" "$(lines \
    "tiny: 3 of 3 cells lack rows: 6 rows and 3 warm-ups to measure" \
    "tiny: about T s, from the rows of 3 cells" \
    "tiny: 3 files to keep in res/tiny/images: CELL.png")"
run study run --dry-run studies/tiny.study --results res
check "study run --dry-run of a complete study" is "$(<out)" "tiny: complete, nothing to do"
cp -r res kept-res
run study exclude studies/tiny.study --row 0:1 --reason 'the lid was open' --results res
check "study exclude" is "$(<out)" "tiny: row 0:1 is excluded in res/tiny/excluded.csv"
run study summary studies/tiny.study --results res
check "study summary leaves an excluded row out, and counts it" is "$(awk -F'\t' 'NR == 1 {
    for (i = 1; i <= NF; i++) if ($i == "excluded") e = i} NR > 1 {print $3, $e}' out | tr '\n' ' ')" "1 1 2 0 2 0 "
run study status studies/tiny.study --results res
check "study status reports an excluded row" grep -qx \
    "tiny: 1 row is excluded from summaries, by res/tiny/excluded.csv" out
run study run studies/tiny.study --results res
check "an excluded row is not measured again" is "$(<out)" "tiny: complete, nothing to do"
check "an excluded row stays" cmp res/tiny/rows.csv kept-res/tiny/rows.csv
rm -r kept-res res/tiny/excluded.csv
run study run --quiet studies/tiny.study --results parts --shard 0/2
check "--quiet prints nothing" is "$(cat out err)" ""
run study run studies/tiny.study --results parts --shard 1/2
run study merge studies/tiny.study --results parts
check "study merge merges the shards" is "$(wc -l <parts/tiny/rows.csv)" "$lines"
sed -e 's/^study: .*/study: against/' -e '$a reference: {render.depth: 2}' studies/tiny.study >studies/against.study
run study run --quiet studies/against.study --results res
check "a study with a reference compares each cell" is \
    "$(awk -F, 'NR > 1 && $8 == 0' res/against/compare.csv | wc -l)" 1
run study summary studies/against.study --results res
check "study summary has error and time" is "$(awk -F'\t' 'NR == 4 {print $(NF - 13), $(NF - 12)}' out)" "0 NA"
sed -i 's/^reference: .*/reference: {render.depht: 2}/' studies/against.study
run study run studies/against.study --results res
check "a misspelt parameter in the reference is located" matches "$(<err)" 'against\.study:10:13: .*depht'

# --- studies drawn from rows: two groups of equal processes; a warm-up and a row of a wrong film do not count
printf '%s\n' cell,run,warmup,marked,wall_s 0,a,1,0,9 0,a,0,0,1 0,a,0,1,9 0,b,0,0,1 1,a,0,0,2 1,b,0,0,2 >power.csv
run study power power.csv --designs=1 --tsv
check "study power draws from rows" silent_success
check "equal rows make no claim" is "$(awk -F'\t' '$1 == "all" && $6 == "effect" { print $3, $7, $8, $14 }' out)" \
    "$(lines 'apart 800 1 0' 'turns 800 1 0')"
run study power power.csv --designs=1 --tsv --cells=0,1 --truth=smaller
check "claims against the truth are wrong" is \
    "$(awk -F'\t' '$6 == "effect" { print $3, $8, $9, $14, $17 }' out)" \
    "$(lines 'apart 1 2 1 0' 'turns 1 2 1 0' 'together 2 2 1 0')"
run study power power.csv --designs=1 --cells=0,1
check "study power prints a table" matches "$(cat out)" "together .* 0 / 0"

# --- broken pipes, full disks, closed descriptors, signals
"$program" params --json 2>err | head -1 >/dev/null
check "a pipe closed by its reader is not an error" is "$(<err)" ""
into_closed_pipe render "$scene" --json "${small[@]}"
check "a closed pipe exits with 1 and no message" is "$code $(<err)" "1 "
if [[ -w /dev/full ]]; then
    for words in params "params --json" media "media --json" "mesh --generate box" machine --help "render --help" \
        "render $scene --json --set render.width=8"; do
        # shellcheck disable=SC2086
        "$program" $words >/dev/full 2>err
        check "a full disk is exit 1 and one line: ${words%% /*}" is "$? $(wc -l <err)" "1 1"
    done
fi
"$program" params >&- 2>err
check "a closed standard output is exit 1" is $? 1
"$program" render "$scene" -o shut.png "${small[@]}" >&- 2>err
check "an image is not written into a closed standard output" magic shut.png 89504e47
for signal in INT TERM; do
    rm -f part.png
    "$program" render "$scene" -o part.png --json --set render.width=4000 --set render.height=3000 \
        --set render.depth=40 --set render.samples=64 --set render.tile=8 >out 2>err &
    job=$!
    await $job works $job
    kill -"$signal" $job
    wait $job
    check "SIG$signal ends a render with 130" is $? 130
    check "SIG$signal: the partial image is written" magic part.png 89504e47
    check "SIG$signal: one line reports it" is "$(grep -c interrupted err)" 1
    check "SIG$signal: the JSON output is marked as incomplete" is "$(json complete)" false
done
# A huge ray tree, and a mesh that takes long to generate: the program reacts to signals in every phase.
{
    echo 'meshes: {many: {generate: icosphere, level: 9}}'
    echo 'solids: {ball: {shape: mesh, mesh: many, transparency: 1, ior: 1.5}}'
} >many.yaml
for signal in INT TERM; do
    for words in "$scene" many.yaml; do
        rm -f part.png
        "$program" render "$words" --set render.depth=40 --set render.samples=64 --set render.width=1600 \
            --set render.height=1200 -o part.png >out 2>err &
        job=$!
        await $job works $job
        kill -"$signal" $job
        wait $job
        check "SIG$signal ends ${words##*/} with 130" is $? 130
        check "SIG$signal: ${words##*/} leaves a complete image or none" \
            eval '[[ ! -e part.png ]] || "$program" compare part.png part.png'
        check "SIG$signal: no other file is left of ${words##*/}" is "$(find . -name '.cuvette-*.part*')" ""
    done
done
sed -e 's/^study: .*/study: long/' -e 's/render.width: 40, render.height: 30/render.width: 1000, render.height: 750/' \
    -e 's/repetitions: 2/repetitions: 100000/' studies/tiny.study >studies/long.study
"$program" study run studies/long.study --results res >out 2>err &
job=$!
await $job has_lines res/long/rows.csv 3
kill -INT $job
wait $job
check "SIGINT ends a study with 130" is $? 130
check "SIGINT: one line reports it, and how to resume" \
    is "$(grep -c 'interrupted.*run it again' err) $(other_notes | wc -l)" "1 1"
check "SIGINT: the rows of the study are complete" \
    awk -F, 'NR == 1 {n = NF} NF < n {bad = 1} END {exit bad || NR < 3}' \
    res/long/rows.csv
if command -v script >/dev/null; then
    script -qec "'$program' rendr" /dev/null >tty.txt 2>&1
    check "errors have colour on a terminal" grep -q $'\033\[' tty.txt
    NO_COLOR=1 script -qec "'$program' rendr" /dev/null >tty.txt 2>&1
    check "NO_COLOR turns colour off" is "$(grep -c $'\033' tty.txt)" 0
    TERM=dumb script -qec "'$program' rendr" /dev/null >tty.txt 2>&1
    check "TERM=dumb turns colour off" is "$(grep -c $'\033' tty.txt)" 0
    # Longer than half a second on any machine, or there is no progress line.
    lasting=(--set render.width=1600 --set render.height=1200 --set render.depth=8 --set render.threads=1)
    [[ ${CONFIG:-release} == release ]] || lasting=(--set render.depth=6 --set render.threads=1)
    script -qec "'$program' render '$scene' --json ${lasting[*]} >/dev/null" /dev/null >tty.txt 2>&1
    check "the progress line is erased at the end" matches "$(tail -c 3 tty.txt)" $'^ +\r$'
    check "progress has a percentage and the time left" grep -q 'rendering: .*%, .* left' tty.txt
fi

# --- tables are wrapped to the width of a terminal, and not in a pipe
widest() { awk '{if (length > w) w = length} END {print w + 0}' "$1"; }
words() { tr -d ';' <"$1" | tr -s ' \t' '\n' | sed '/^-*$/d' | sort; } # FILE: its words in any order
# on_terminal COLUMNS ARGUMENT...: runs the program on a terminal of that width; its output is in tty.txt
on_terminal() {
    local shell
    printf -v shell '%q ' "$program" "${@:2}"
    script -qec "stty cols $1 rows 24; $shell" /dev/null </dev/null 2>&1 | tr -d '\r' >tty.txt
}
tables=(params "params $scene" "params ${scene%/*}/slime.yaml toy" media "media --at 500" "media glycerol --at 600"
    "realism $scene" machine)
if command -v script >/dev/null; then
    for words in "${tables[@]}"; do
        # shellcheck disable=SC2086
        "$program" $words >pipe.txt
        for columns in 24 40 79 80 100 132 200; do
            # shellcheck disable=SC2086
            on_terminal $columns $words
            check "${words%% *} fits $columns columns: ${words##*/}" \
                holds "$(wc -l <tty.txt) > 1 && $(widest tty.txt) <= $columns"
        done
        [[ $words == machine ]] && continue # its clocks differ from run to run
        # shellcheck disable=SC2086
        on_terminal 80 $words
        check "80 columns have every word: ${words##*/}" cmp <(words pipe.txt) <(words tty.txt)
        # shellcheck disable=SC2086
        on_terminal 1200 $words
        check "1200 columns need no wrapping: ${words##*/}" cmp pipe.txt tty.txt
    done
    on_terminal 80 params
    check "no line of a table ends in a blank" is "$(grep -c ' $' tty.txt)" 0
    check "a meaning that does not fit is below its row" is "$(grep -A1 '^render.depth ' tty.txt | tail -1)" \
        "    integer 0..64, or unlimited; recursion depth; 0: camera rays only;"
    on_terminal 80 realism "$scene" --csv
    check "CSV is not wrapped" holds "$(widest tty.txt) > 80"
    COLUMNS=60 on_terminal 0 media
    check "COLUMNS is the width of a terminal that does not report it" holds "$(widest tty.txt) <= 60"
    COLUMNS=60 on_terminal 200 media
    check "the reported width of a terminal overrides COLUMNS" holds "$(widest tty.txt) > 100"
    COLUMNS=wide on_terminal 0 media
    check "the width is 80 without both" holds "$(widest tty.txt) > 70 && $(widest tty.txt) <= 80"
    COLUMNS=40 run media
    check "COLUMNS does not wrap a pipe" holds "$(widest out) > 100"
fi

# --- scene
run scene "$scene"
check "scene writes to standard output" silent_success
cp out first.yaml
run scene first.yaml
check "write, read, write gives the same bytes" cmp out first.yaml
run scene "$scene" --all -o all.yaml
check "scene -o prints nothing" is "$code $(cat out err | wc -c)" "0 0"
check "--all also writes defaults" grep -q '^  polarisation: off' all.yaml
for file in first.yaml all.yaml; do
    run render "$file" -o b.png "${small[@]}"
    check "$file gives the same film" matches "$(<out)" "film $hash"
done
run scene --new --title "Rod in a vessel" --set camera.position=0,2.75,-6 --set camera.target=0,1.5,0 \
    --add material:clear,transparency=1,specular=0.6,shininess=80 \
    --add material:tiles,color=0.85,0.85,0.85,checker_color=0.25,0.30,0.35,checker=0.5,ambient=0.1,diffuse=0.7 \
    --add material:plastic,color=0.85,0.15,0.10,ambient=0.1,diffuse=0.7,specular=0.5,shininess=40 \
    --add light:lamp --move lamp=4,-3,-5 --add solid:ground=plane,material=tiles \
    --add solid:vessel=cup,ior=1.5,material=clear,position=0,0.001,0,height=3,priority=2 \
    --add solid:liquid=sphere --set liquid.shape=cylinder --set liquid.material=clear --set liquid.ior=1.33 --set \
    liquid.priority=1 \
    --set liquid.position=0,0.051,0 --set liquid.radius=0.95 --set liquid.height=1.95 --add solid:wrong=box --delete \
    wrong \
    --add solid:stick=box,material=plastic,size=0.25,3,0.25,priority=3 --rename stick=rod --turn rod=0,0,45 --turn \
    rod=0,0,-45 \
    --move rod=0.2,2.101,0 -o built.yaml
check "a scene is built by options alone" silent_success
check "the built scene equals the original, byte for byte" cmp built.yaml first.yaml
run scene built.yaml --list
check "--list has one line per object" is "$(head -1 out) $(wc -l <out) $(tail -1 out)" \
    "material clear 8 solid rod box plastic"
run scene built.yaml --check
check "--check reports a valid scene" is "$code $(<out)" \
    "0 built.yaml: valid; meshes 0, textures 0, materials 3, lights 1, solids 4"
run scene built.yaml --move rod=0,0.5,0 -o built.yaml
check "a scene can be changed in place" matches "$(grep -A3 '  rod:' built.yaml | tail -1)" \
    'position: \[0.2, 2.601, 0\]'
run scene built.yaml --turn all+camera=0,90,0 --scale all+camera=2 --move all+camera=1,0,0 -o whole.yaml
check "a whole scene is rotated, scaled and moved" matches \
    "$(
        grep -A6 '^camera:' whole.yaml | head -3 | tr -s '\n ' ' '
        grep unit_m whole.yaml
    )" \
    'position: \[-11, 5.5, .*unit_m: 0.5'
run render built.yaml "${small[@]}" -o before.png
run render whole.yaml "${small[@]}" -o after.png
run compare before.png after.png
check "transformed with its camera it gives the same image" matches "$(<out)" 'flip  *0\.0000'
run render built.yaml "${small[@]}" --set camera.roll_deg=180 -o after.png
run compare before.png after.png
check "a roll changes the image" matches "$(<out)" 'flip  *0\.[0-9]*[1-9]'
mkdir -p images/scenes
cp a.png images/sky.png
run scene built.yaml --set background.image=images/sky.png -o images/scenes/moved.yaml
check "relative paths are adjusted to the folder of the file" grep -q '  image: ../sky.png' images/scenes/moved.yaml
run scene images/scenes/moved.yaml --check
check "the adjusted path leads to the image" depth_noted
refused() { # WHAT ERROR ARGUMENT...: exit 2, one line, nothing written
    local what=$1 error=$2
    shift 2
    run scene "$@" -o refused.yaml
    check "scene refuses $what" is "$code $(wc -l <err) $(cat out refused.yaml 2>/dev/null | wc -c) $(<err)" \
        "2 1 0 cuvette: $error"
}
in_use="clear is the material of vessel and 1 more; assign another material to them first, or remove them"
refused "to delete a material in use" "--delete clear: $in_use" \
    built.yaml --delete clear
refused "an unknown name" "--move rood=1,2,3: the scene has no object 'rood'; did you mean 'rod'?" \
    built.yaml --move rood=1,2,3
refused "to scale the camera" \
    "--scale camera=2: camera cannot be scaled; scale a solid, a light, or a group: all, solids or lights" built.yaml \
    --scale camera=2
refused "a factor of zero" "--scale all=0: all cannot be scaled by 0; give a factor above 0, at most 1e9" \
    built.yaml --scale all=0
refused "two numbers" "--move rod=1,2: fewer than 3 numbers; give NAME=DX,DY,DZ" built.yaml --move rod=1,2
refused "an unknown shape" "--add solid:x=bax: 'bax' is not a shape; did you mean 'box'?" built.yaml --add solid:x=bax
refused "a solid without a shape" \
    "--add solid:x: x has no shape; write solid:NAME=SHAPE, such as solid:rod=box" built.yaml --add solid:x
refused "an unknown kind" \
    "--add ball:x: unknown kind of object 'ball'; give one of: solid, light, beam, material, mesh, texture, data" \
    built.yaml --add ball:x
refused "a scene that is invalid as a whole" \
    "built.yaml: vessel: inner_radius 2 is not smaller than radius 1; make inner_radius smaller than radius, or the \
cup has no wall" \
    built.yaml --set vessel.inner_radius=2
refused "a file and --new" "scene: a scene file, --new and --from exclude each other; use only one of them" \
    built.yaml --new
run scene built.yaml -o rod.png
check "scene writes no image" is "$code $(wc -l <err)" "2 1"
run scene
check "scene needs a file or --new" is "$code $(<err)" \
    "2 cuvette: scene: no scene is given; give a scene file, such as experiments/scenes/rod.yaml, or --new"

# --- completion
check "the completion is valid bash" bash -n "$root/src/cli/cuvette.bash"
complete_line() { # WORD...: prints the completions of the last word
    bash -O extglob -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); compopt() { :; }; _cuvette
        printf "%s\n" "${COMPREPLY[@]}"' - "$root/src/cli/cuvette.bash" "$@"
}
check "completion offers commands" is "$(complete_line cuvette ren)" render
check "completion offers options" matches "$(complete_line cuvette render --t)" '--time.*--timeline'
check "completion offers parameters of the scene" \
    is "$(complete_line "$program" render "$scene" --set liquid.io)" "liquid.ior="
check "completion offers options of compare" is "$(complete_line cuvette compare --d)" --diff
check "completion offers mesh's options and bodies" is \
    "$(
        complete_line "$program" mesh --gen
        complete_line "$program" mesh --generate to
    )" \
    "$(lines --generate torus)"
check "completion offers every mesh that can be generated" is "$(complete_line "$program" mesh --generate te)" terrain
check "completion without a scene offers no groups of objects" is \
    "$(complete_line "$program" render --set '' | grep '^[A-Z]')" ""
: >figure.svg
check "completion of a figure's file" is "$(complete_line "$program" study plot -o figure)" figure.svg
rm figure.svg
offered=
for verb in render animate scene trace fan params media mesh fit compare realism motion lab machine \
    "study "{new,run,submit,status,list,merge,verify,summary,compare,films,power,exclude,plot}; do
    # shellcheck disable=SC2086
    offered+=$(comm -13 <(complete_line "$program" $verb -- | sort) \
        <("$program" $verb --help | grep -oE '^  (    |-., )--[a-z-]+' | grep -oE -- '--.*' | sort) | sed "s/^/$verb /")
done
check "completion offers every option" is "$offered" ""
check "completion offers media" is "$(complete_line "$program" media fused)" fused-silica
check "completion offers options of trace" is "$(complete_line cuvette trace --p)" --pixel
check "completion offers options of fan" is "$(complete_line cuvette fan --sp)" --spread
check "completion offers options of section" is "$(complete_line cuvette section --ex)" --extent
check "completion offers objects of the scene" is \
    "$(
        complete_line "$program" scene "$scene" --delete ve
        complete_line "$program" scene "$scene" --move ro
    )" \
    "$(lines vessel rod=)"
check "completion offers groups of objects" is "$(complete_line "$program" scene "$scene" --scale al)" "all="
check "completion offers options of lab" is "$(complete_line cuvette lab --no)" --no-browser
check "completion offers study verbs" is "$(complete_line cuvette study mer)" merge

conclude
