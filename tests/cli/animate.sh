#!/bin/bash
# `cuvette animate`: equal frames for any number of threads and after an interruption; progress index, rows, frame
# names, YUV4MPEG2. animate.sh [PROGRAM]; needs the compiler (CC) for tests/tools/json_get.c. One line per check
# ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-animate.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CUVETTE_ISA NO_COLOR
export LC_ALL=C

# shellcheck source=tests/shell/await.sh
source "$root/tests/shell/await.sh"

passed=0 failed=0
verdict() { # STATUS WHAT
    if (($1 == 0)); then
        passed=$((passed + 1))
        echo "ok $((passed + failed)) - $2"
    else
        failed=$((failed + 1))
        echo "not ok $((passed + failed)) - $2"
        sed 's/^/# /' err 2>/dev/null | head -5
    fi
}
check() { # WHAT COMMAND...: passes when the command succeeds
    local what=$1
    shift
    "$@" >check.log 2>&1
    verdict $? "$what"
}
animate() { # ARGUMENT...: renders the animation; its results are in out, err and code
    "$program" animate slime.yaml "$@" >out 2>err
    code=$?
}
refused() { # WHAT PATTERN ARGUMENT...: exit 2 and one line that matches
    local what=$1 pattern=$2
    animate "${@:3}"
    check "$what" eval '((code == 2)) && [[ ! -s out && $(wc -l <err) == 1 ]] && LC_ALL=C grep -qE -- "$pattern" err'
}
is() { [[ $1 == "$2" ]]; }
done_well() { ((code == 0)) && [[ ! -s err ]]; }
summary() { grep -q -- "$1" out; }
frames() { find "$1" -name '*.png' | wc -l; }
same_frames() { diff <(cd "$1" && sha256sum -- *.png) <(cd "$2" && sha256sum -- *.png); } # FOLDER FOLDER

cat >slime.yaml <<'END'
render: {width: 64, height: 48, depth: 2}
camera: {position: [0, 1.5, -6], target: [0, 1, 0]}
lights:
  lamp: {position: [4, 7, -5]}
meshes:
  toy: {generate: slime, level: 2}
solids:
  body: {shape: mesh, mesh: toy, color: [0.3, 0.8, 0.3], diffuse: 0.7, specular: 0.5}
END
cat >tug.yaml <<'END'
title: A tug
hands:
  left:
    - {time_s: 0.1, grab: [0, 1, -6], towards: [0, 0, 1], reach: 0.5}
    - {time_s: 0.3, move: [-0.6, 0.4, 0]}
    - {time_s: 0.4, release: on}
END
check "tests/tools/json_get.c compiles" bash -c \
    '"$1" -std=gnu17 -Wall -Werror -o json_get "$2" $(pkg-config --cflags --libs jansson)' - "${CC:-gcc}" \
    "$root/tests/tools/json_get.c"

# --- frames
animate -o one/%05d.png --duration 0.6
check "an animation succeeds" done_well
check "the number of frames is duration times rate, numbered from 0" is "$(cd one && echo *)" \
    "%05d.png.json $(printf '%05d.png ' {0..14} | sed 's/ $//')"
check "the summary is one line" is "$(wc -l <out)" 1
check "all frames are rendered" summary '15 rendered.* 0 kept'
check "the slime moves: all frames differ" is "$(sha256sum one/*.png | cut -c1-64 | sort -u | wc -l)" 15
for threads in 2 7; do
    animate -o "threads-$threads/%05d.png" --duration 0.6 --set render.threads=$threads --set toy.threads=$threads
    check "$threads threads give the same frames" same_frames one "threads-$threads"
done
"$program" render slime.yaml --set toy.time_s=0.32 -o still.png >/dev/null
# Without what comes before the pixels: a rendered image holds its scene too.
pixels() { tail -c "+$(grep -abom1 IDAT "$1" | head -n 1 | cut -d: -f1)" "$1"; }
check "a frame equals a render at its time" cmp <(pixels still.png) <(pixels one/00008.png)
film_of() { "$program" render "$1" --json 2>film.err | ./json_get - film_hash; }
check "a frame holds its scene at its time" eval \
    '[[ $(film_of one/00008.png) =~ ^[0-9a-f]{16}$ ]] && is "$(film_of one/00008.png)" "$(film_of still.png)"'
check "which is not that of another frame" eval '! is "$(film_of one/00008.png)" "$(film_of one/00003.png)"'

# --- resuming
animate -o part/%05d.png --duration 0.24
animate -o part/%05d.png --duration 0.6
check "an animation can be extended" summary '9 rendered.* 6 kept'
check "the frames of an extended animation equal those of the long one" same_frames one part
rm part/00003.png part/00011.png
animate -o part/%05d.png --duration 0.6
check "missing frames are rendered" summary '2 rendered.* 13 kept'
check "rendered frames equal the removed ones" same_frames one part
animate -o part/%05d.png --duration 0.6 --set render.threads=3 --set render.accel=octant
check "parameters of performance do not change the animation" summary '0 rendered.* 15 kept'

interrupted() { # SIGNAL FRAME: renders a long animation and sends the signal once that frame exists
    "$program" animate slime.yaml -o long/%04d.png --fps 50 --duration 4 --set render.samples=9 --rows long.csv >out \
        2>err &
    local child=$!
    await $child test -e "long/$2.png"
    kill -"$1" $child 2>/dev/null
    wait $child
    code=$?
}
animate -o calm/%04d.png --fps 50 --duration 4 --set render.samples=9 --rows calm.csv
check "an uninterrupted animation has all frames" is "$(frames calm)" 200
interrupted INT 0010
check "SIGINT ends an animation with status 130 and one line" eval \
    '((code == 130)) && [[ $(wc -l <err) == 1 && ! -s out ]]'
check "the line counts frames from 1" grep -q "interrupted at frame $(($(frames long) + 1)) of 200" err
check "complete frames exist after SIGINT" eval '(($(frames long) >= 11 && $(frames long) < 200))'
check "no partial file exists after SIGINT" is "$(find long -type f ! -name '[0-9]*.png' -printf '%f ')" \
    "%04d.png.json "
interrupted TERM 0060
check "SIGTERM ends an animation with status 130" is $code 130
animate -o long/%04d.png --fps 50 --duration 4 --set render.samples=9 --rows long.csv
check "an interrupted animation resumes" done_well
check "the frames equal those of the uninterrupted animation" same_frames calm long
columns='definition|frame|time_s|film_hash|rays_total|triangles|steps|kinetic|elastic|compression|gravity|volume'
columns+='|center_[xyz]|low|high|speed_max|held'
of_the_film() { # FILE: prints the columns that do not depend on the machine
    awk -F, -v wanted="^($columns)\$" 'NR == 1 {for (i = 1; i <= NF; i++) take[i] = $i ~ wanted}
        {for (i = 1; i <= NF; i++) if (take[i]) printf "%s,", $i; print ""}' "$1"
}
check "the rows equal those of the uninterrupted animation, one per frame" \
    diff <(of_the_film calm.csv) <(of_the_film long.csv)
check "the first row is frame 0 at time 0" is "$(of_the_film calm.csv | sed -n 2p | cut -d, -f2,3)" 0,0

# --- the progress index
refused "frames of another scene are refused" 'toy.level was 2 and is now 3; .*--restart' -o part/%05d.png --set \
    toy.level=3
refused "frames of another rate are refused" 'fps was 25/1 and is now 30/1' -o part/%05d.png --fps 30
refused "frames of another script are refused" 'a file that the scene reads' -o part/%05d.png --script tug.yaml
refused "frames of another start are refused" 'start was 0 and is now 1' -o part/%05d.png --start 1
sed -i.whole '/^lights:/,/lamp:/d' slime.yaml
animate -o part/%05d.png
check "frames of a scene with another lamp are refused" eval \
    '((code == 2)) && grep -q "belong to another animation, with lamp\..*--restart" err'
mv slime.yaml.whole slime.yaml
check "the refused commands changed nothing" same_frames one part
sed -i 's/"version": "[^"]*"/"version": "0.0.0"/' part/*.json
refused "frames of another version are refused" 'version 0.0.0' -o part/%05d.png
rm part/*.json
refused "frames without an index are refused" 'part: .*without a progress index' -o part/%05d.png
refused "frames without an index are not removed by --restart" 'part: .*without a progress index.*yourself' \
    -o part/%05d.png --restart
check "the frames still exist" same_frames one part
rm part/*.png
animate -o part/%05d.png --duration 0.6
touch part/123456.png
for restart in '' --restart; do
    refused "a frame beyond the animation is refused $restart" 'part/123456.png: .*has only 15' -o \
        part/%05d.png --duration 0.6 $restart
done
rm part/123456.png
touch part/other.png part/1.png part/000012.png part/00012.png.bak
animate -o part/%05d.png --duration 0.24 --set toy.level=1 --restart
check "--restart renders all frames again" summary '6 rendered.* 0 kept'
check "--restart removes only the frames of the animation" is "$(cd part && echo *)" \
    "%05d.png.json 00000.png 00001.png 000012.png 00002.png 00003.png 00004.png 00005.png 00012.png.bak 1.png other.png"
animate -o part/side-%d.png --duration 0.1
check "two animations can share a folder" eval 'done_well && cmp part/side-2.png one/00002.png'
animate -o over/a%d.png --duration 0.12
animate -o over/a1%d.png --duration 0.12 --set toy.level=1
check "two animations with similar names can share a folder" done_well
refused "two animations with equal names of frames are refused" 'over/a1[012].png: .*has only 3' \
    -o over/a%d.png --duration 0.6
rm over/a1?.png
refused "two animations with equal names of future frames are refused" 'over/a1%d.png.json: another animation' \
    -o over/a%d.png --duration 0.6
rm over/a2.png
mkdir over/a2.png
for restart in '' --restart; do
    refused "a folder with the name of a frame is refused $restart" 'over/a2.png: is a folder' \
        -o over/a%d.png --duration 0.12 $restart
done

# --- files that the scene reads
animate -o read/%05d.png --duration 0.2
sed 's/^solids:/textures:\n  skin: {file: read\/00003.png}\nsolids:/; s/mesh: toy,/mesh: toy, texture: skin,/' \
    slime.yaml >textured.yaml
mkdir links
ln -s ../read/00003.png links/skin.png
sed 's/read.00003/links\/skin/' textured.yaml >linked.yaml
for from in textured linked; do
    "$program" animate $from.yaml -o read/%05d.png --duration 0.2 --restart >out 2>err
    code=$?
    check "an image that the scene reads is not replaced by a frame, $from" eval \
        '((code == 2)) && [[ -e read/00003.png ]] && grep -q "the scene reads" err'
done
"$program" render textured.yaml -o read/00003.png >out 2>err
code=$?
check "an image that the scene reads is not replaced by render" \
    eval '((code == 2)) && cmp read/00003.png one/00003.png && grep -q "the scene reads" err'
cp slime.yaml '%d.png.json'
"$program" animate %d.png.json -o ./%d.png --duration 0 >out 2>err
code=$?
check "the scene file is not replaced by the progress index" eval \
    '((code == 2)) && cmp slime.yaml %d.png.json && grep -q "the scene reads" err'
rm '%d.png.json'

animate -o "part/50%%-%03d.pfm" --duration 0
check "%% is a percent sign in names, and a duration of 0 gives one frame" eval \
    'done_well && [[ -s part/50%-000.pfm && ! -e part/50%-001.pfm ]]'

# --- rows
refused "rows of another animation are refused" 'another animation' -o three/%d.png --duration 0.1 --rows calm.csv
echo a,b >foreign.csv
refused "rows with other columns are refused, and nothing is removed" 'other columns' -o one/%05d.png --duration 0.1 \
    --rows foreign.csv --restart
check "the frames still exist" is "$(frames one)" 15
described() {
    awk '/^## / {on = $0 == "## Rows of an animation"} on && /^\| `/' "$root/results/README.md" |
        sed -n 's/^| \(`[^|]*\) |.*/\1/p' | tr -d '` ' | tr ',' '\n'
}
check "results/README.md has the columns" diff <(described) <(head -1 calm.csv | tr , '\n')
animate -o one/%05d.png --duration 0.6 --rows late.csv
check "frames without a row are rendered again" eval 'summary "15 rendered.* 0 kept" && [[ $(wc -l <late.csv) == 16 ]]'

rm one/00003.png
cp late.csv before.csv
animate -o one/%05d.png --duration 0.6 --rows late.csv
check "a frame whose image was removed keeps its one row" \
    eval 'summary "1 rendered.* 14 kept" && cmp before.csv late.csv'
for film in one/%05d.png\ --restart film.y4m; do
    refused "an animation with existing rows does not start again: $film" 'late.csv: already has rows' \
        -o $film --duration 0.6 --rows late.csv
done
check "a refused restart removes no frame" is "$(frames one)" 15
rm one/00014.png
sed '$ s/,0.56[0-9]*,[0-9a-f]*,/,0.56,0123456789abcdef,/' late.csv >wrong.csv
refused "a row with another film hash is refused" 'wrong.csv: frame 14 ' -o one/%05d.png --duration 0.6 --rows wrong.csv
animate -o one/%05d.png --duration 0.6
exec 9>>late.csv
flock 9
refused "rows that another process writes are refused" 'another process.*another file with --rows' \
    -o one/%05d.png --duration 0.6 --rows late.csv
exec 9>&-

# --- scripts
animate -o tug/%05d.png --script tug.yaml --rows tug.csv
check "an animation is 2 s longer than its script" is "$(frames tug)" 60
animate -o tug-2/%05d.png --set toy.script=tug.yaml --duration 1
check "--script sets script= of the slime" eval 'done_well && cmp tug/00012.png tug-2/00012.png'
same_pixels() { cmp <(pixels "$1") <(pixels "$2"); }
check "the hand changes the image" eval \
    '! same_pixels tug/00008.png one/00008.png && same_pixels tug/00002.png one/00002.png'
held() { awk -F, -v frame="$1" \
    'NR == 1 {for (i = 1; i <= NF; i++) if ($i == "held") at = i} $2 == frame {print ($at > 0)}' tug.csv; }
check "rows have the number of held vertices" is "$(held 2)$(held 5)$(held 12)" 010
mkdir elsewhere && cp slime.yaml elsewhere/
"$program" animate elsewhere/slime.yaml --script tug.yaml -o elsewhere/%05d.png --duration 0.4 >out 2>err
check "--script is relative to the working folder" cmp elsewhere/00009.png tug/00009.png
refused "a missing script is refused" '--script nowhere.yaml: .*No such file' -o three/%d.png --script nowhere.yaml
refused "a script in a pipe is refused" 'regular file' -o three/%d.png --script <(cat tug.yaml)
refused "a missing script of the scene is refused" 'nowhere.yaml' -o three/%d.png --set toy.script=nowhere.yaml
sed 's/grab: \[0, 1, -6\]/grab: [0, 9, -6]/' tug.yaml >miss.yaml
refused "a grab that misses is an error" 'miss.yaml:4' -o miss/%05d.png --script miss.yaml
check "frames before the failed grab are kept" eval \
    '(($(frames miss) >= 2 && $(frames miss) <= 4)) && same_pixels miss/00001.png one/00001.png'

# --- an unstable slime
refused "an unstable slime is an error" 'toy|slime' -o blown/%05d.png --set toy.stiffness=1e9 --duration 4
check "frames before the divergence are kept" eval '(($(frames blown) >= 1 && $(frames blown) < 100))'
"$program" compare blown/00000.png one/00000.png --json >out 2>err
check "the kept frames are complete" is "$(./json_get out largest 2>&1)" 0.0

# --- long simulations
# stopped ARGUMENT...: runs the program, and sends SIGINT when it works; its status is in code
stopped() {
    "$program" "$@" >out 2>err &
    local child=$!
    await $child works $child
    kill -INT $child
    wait $child
    code=$?
}
# A study may also note what disturbs the machine.
messages() { grep -vE '^cuvette: note: (this machine|other processes|the (hypervisor|clock|machine)) ?' err; }
heard() { ((code == 130)) && [[ $(messages | wc -l) == 1 && ! -s out ]] && grep -q -- "$1" err; } # PATTERN
animate -o short/%d.png --duration 0.04 --set toy.time_s=86400 --set toy.dt_s=1e-5
check "time_s of the slime is ignored" done_well
refused "too many steps to the end of the animation are refused" 'toy: 2 s with time steps of 1e-09 s' \
    -o steps/%d.png --set toy.dt_s=1e-9 --duration 2
refused "too many steps to a late start are refused" 'toy: 2000 s with time steps' -o steps/%d.png --set toy.dt_s=1e-6 \
    --start 1999.96 --duration 0.04
refused "too many steps to the end of the script are refused" 'toy: 2.4 s with time steps' -o steps/%d.png \
    --set toy.dt_s=1e-9 --script tug.yaml
refused "a tiny time step is refused" 'toy.dt_s' -o steps/%d.png --set toy.dt_s=1e-300
stopped animate slime.yaml -o steps/%d.png --set toy.time_s=0 --set toy.dt_s=1e-9 --duration 0.1
check "SIGINT ends a simulation with short steps" heard 'interrupted at frame 2 of 3'
stopped animate slime.yaml -o late/%d.png --start 80000 --duration 0.1
check "SIGINT ends a simulation up to a late start" heard 'interrupted at frame 1 of 3'
for command in render\ --json trace\ --pixel=3,3 realism\ --json scene\ --check; do
    sed 's/generate: slime,/generate: slime, time_s: 86400,/' slime.yaml >day.yaml
    stopped ${command%% *} day.yaml ${command#* }
    check "SIGINT ends a simulation of a day: $command" heard 'toy: interrupted at'
done
printf '%s\n' 'study: day' 'scene: day.yaml' 'grid: [{camera.fov_deg: [40]}]' 'repetitions: 1' >day.study
stopped study run day.study --results day-results
check "SIGINT ends a simulation in a study" heard 'interrupted; its 0 new rows'

# --- YUV4MPEG2
animate -o - --duration 0.2 --fps 30000/1001
check "a video is written to standard output" done_well
header='YUV4MPEG2 W64 H48 F30000:1001 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED'
check "the video has the YUV4MPEG2 header" is "$(head -1 out)" "$header"
check "the video has 6 frames of 6 + 64 * 48 * 3 / 2 bytes, nothing else" is "$(stat -c %s out)" \
    $((${#header} + 1 + 6 * (6 + 64 * 48 * 3 / 2)))
cp out stdout.y4m
animate -o film.y4m --duration 0.2 --fps 30000/1001
check "a video file has the same bytes" eval 'done_well && cmp film.y4m stdout.y4m'
animate -o blown.y4m --set toy.stiffness=1e9 --duration 4
check "a video file is written atomically" eval \
    '((code == 2)) && [[ ! -e blown.y4m && -z $(ls -A | grep part$ | grep cuvette) ]]'
"$program" animate slime.yaml -o - --duration 9 2>err | head -c 6000 >/dev/null
check "a closed pipe ends an animation without a message" eval \
    '[[ ${PIPESTATUS[0]} != 0 || ! -s err ]] && [[ ! -s err ]]'

# --- the account
animate -o one/%05d.png --duration 0.6 --json
check "--json is one object" eval '[[ $(./json_get out @type) == object && ! -s err ]]'
check "--json has frames, kept frames and rate" is "$(./json_get out frames kept rendered 'fps[]' | tr '\n' ' ')" \
    "15 15 0 25 1 "
check "--json has the steps, simulated time and mean time of a frame" is \
    "$(./json_get out steps simulated_s wall_s_mean | tr '\n' ' ')" "560 0.56 null "
check "--json has the definition of the rows" is "$(./json_get out definition)" "$(sed -n 2p late.csv | cut -d, -f1)"

# --- invalid command lines
touch elsewhere/00000.jpg
for pattern in x.png a%%.png %s.png %n%d.png %x.png '%5d.png' '%-5d.png' '%+d.png' '%lld.png' '%*d.png' '%1$d.png' \
    '%0d.png' '%099d.png' \
    '%0999999999999d.png' '%d%d.png' '%05d%s.png' '%.3d.png'; do
    refused "-o $pattern" 'number' -o "$pattern"
done
refused "a number in the name of the folder" 'folder' -o '%d/a.png'
for pattern in %d.gif %d '' %d.y4; do
    refused "no format: -o '$pattern'" 'ending' -o "$pattern"
done
refused "rows of a refused animation" 'without a progress index' -o elsewhere/%05d.jpg --rows new.csv
check "refused animations leave no row file" eval '[[ ! -e new.csv ]]'
refused "no output" 'add -o'
for rate in 0 -1 1.5 25/0 /1 25/ x 1000001 30/1/2; do
    refused "--fps $rate" '--fps' -o %d.png --fps="$rate"
done
refused "a negative duration" '--duration -1' -o %d.png --duration=-1
refused "a duration that is not a number" '--duration nan' -o %d.png --duration nan
refused "too many frames" 'too long' -o %d.png --duration 86400 --fps 1000
refused "a start that is too late" 'too long' -o %d.png --duration 10 --start 86399
refused "--restart of a video file" '--restart' -o x.y4m --restart
refused "video and JSON on standard output" '--json' -o - --json
refused "rows that are not .csv" '.csv' -o %d.png --rows rows.txt
refused "rows into the scene" 'slime.yaml' -o %d.png --rows slime.yaml
refused "a video in a missing folder" 'folder' -o nowhere/x.y4m
"$program" animate "$root/experiments/scenes/rod.yaml" -o %d.png >out 2>err
code=$?
check "a scene without a slime" eval \
    '((code == 2)) && [[ $(wc -l <err) == 1 ]] && grep -q "rod.yaml: nothing moves.*generate: slime" err'
check "invalid command lines write nothing" is "$(find . -maxdepth 1 -name '*.png' ! -name still.png | wc -l)" 0

echo "$passed passed, $failed failed"
((failed == 0))
