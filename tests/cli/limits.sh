#!/bin/bash
# The program at its limits: of file size, of the stack; a lost terminal; killed while it writes. The signals have their
# usual meaning, as for a user. limits.sh; CUVETTE names the program. One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-limits.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export LC_ALL=C
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
# shellcheck source=tests/shell/await.sh
source "$root/tests/shell/await.sh"

scene=$root/experiments/scenes/rod.yaml
cat >tiny.study <<END
study: tiny
scene: $scene
set: {render.width: 40, render.height: 30}
grid: [{render.depth: [1, 2]}]
repetitions: 3
warmups: 0
keep: {image: on}
END
left() { find . -name '.cuvette-*' | head -3; } # files that an interrupted writer has left
# Runs the program with a limit of file size, in KiB; no signal is ignored.
limited() { # KIB ARGUMENT...
    (
        ulimit -f "$1"
        exec "$program" "${@:2}"
    ) >out 2>err
}

# --- a limit of file size, which is a signal (SIGXFSZ) unless the program ignores it
limit_check() { # WHAT KIB ARGUMENT...
    limited "${@:2}"
    equal "file size, $1: exit 1" $? 1
    equal "file size, $1: one line on it, with the remedy" \
        "$(grep -c 'File too large.*limit on file size' err) $(grep -vc 'note:' err)" "1 1"
    equal "file size, $1: nothing unfinished is left" "$(left)" ""
}
limit_check "render" 4 render "$scene" -o big.png --set render.width=300 --set render.height=200
limit_check "render to PFM" 4 render "$scene" -o big.pfm --set render.width=300 --set render.height=200
equal "file size: no part of an image" "$(ls ./*.p?? 2>/dev/null)" ""
limit_check "scene" 1 scene "$root/experiments/scenes/shapes.yaml" -o big.yaml
limit_check "trace" 1 trace "$scene" --pixel 400,300 --depth 6 -o big.json
limit_check "animate to a stream" 4 animate "$root/experiments/scenes/slime.yaml" -o big.y4m --duration 0.1 --fps 20 \
    --set render.width=64 --set render.height=48 --set toy.level=1
limit_check "animate to images" 4 animate "$root/experiments/scenes/slime.yaml" -o f-%02d.pfm --duration 0.1 --fps 20 \
    --set render.width=64 --set render.height=48 --set toy.level=1
sed 's/repetitions: 3/repetitions: 40/' tiny.study >many.study # more rows than the list of runs is long
"$program" study run --quiet many.study --results whole
size=$(stat -c %s whole/tiny/runs.json)
limit_check "study" $((size / 1024 + 3)) study run --quiet many.study --results res
rows=$(wc -l <res/tiny/rows.csv)
((rows > 1 && rows < 81))
verdict $? "file size, study: the limit was met by its rows" "$rows lines"
"$program" study run --quiet many.study --results res
equal "file size, study: it goes on without the limit" "$? $(wc -l <res/tiny/rows.csv)" "0 81"

# --- a small stack
case ${CONFIG:-release} in
release | debug)
    for kib in 64 32; do
        (
            ulimit -s $kib
            exec "$program" render "$root/experiments/scenes/vessel-mesh.yaml" -o stack-$kib.pfm \
                --set render.width=40 --set render.height=30
        ) >out 2>err
        equal "a stack of $kib kB" $? 0
    done
    "$program" render "$root/experiments/scenes/vessel-mesh.yaml" -o stack.pfm \
        --set render.width=40 --set render.height=30 >out 2>err
    cmp stack.pfm stack-64.pfm && cmp stack.pfm stack-32.pfm
    verdict $? "the image does not depend on the limit of the stack"
    # A mirror cavity: the tree of its beam has 10 002 levels.
    cat >cavity.yaml <<END
render: {width: 8, height: 6}
solids:
  left: {shape: box, size: [1, 2, 2], position: [-1.5, 0, 0], reflectivity: 1}
  right: {shape: box, size: [1, 2, 2], position: [1.5, 0, 0], reflectivity: 1}
beams:
  laser: {position: [0, 0, 0], target: [1, 0, 0], branches: off, depth: 10000, min_fraction: 0}
END
    for kib in 1024 64; do
        (
            ulimit -s $kib
            exec "$program" trace cavity.yaml --beams -o cavity-$kib.json
        ) >out 2>err
        equal "a deep beam with a stack of $kib kB" \
            "$? $(grep -o '"kind"' cavity-$kib.json | wc -l) \
$(grep -o '"segments":[0-9]*' cavity-$kib.json)" '0 10003 "segments":10002'
    done
    "$program" trace cavity.yaml --beams -o cavity.txt
    bytes=$(wc -c <cavity.txt)
    verdict $((bytes > 4000000)) "the text of a deep beam is not mostly indentation" "$bytes bytes"
    (
        ulimit -s 64
        exec "$program" fan "$root/experiments/scenes/slime.yaml" --from=-3,1.5,0 --to=3,1.5,0 --tree -o fan.csv \
            --set toy.time_s=86400 # a simulation of hours
    ) >out 2>err &
    job=$!
    await $job works $job
    kill -INT $job
    wait $job
    equal "Ctrl-C with a small stack: interrupted, and no table" \
        "$? $(grep -c '^cuvette: .*: interrupted' err) $(wc -l <err) $(ls fan.csv 2>/dev/null)" "130 1 1 "
    ;;
*) skip "an instrumented program needs a large stack" ;;
esac

# --- the terminal is closed: SIGHUP
sed 's/^study: .*/study: long/; s/repetitions: 3/repetitions: 100000/' tiny.study >long.study
start_long() { # PREFIX...: in the background, until two rows are there
    rm -rf long
    "$@" "$program" study run --quiet long.study --results long >out 2>err &
    job=$!
    await "$job" has_lines long/long/rows.csv 3
}
start_long env
kill -HUP "$job"
wait "$job"
equal "SIGHUP ends a study with 130" $? 130
equal "SIGHUP: one line on it" "$(grep -c 'interrupted' err) $(wc -l <err)" "1 1"
awk -F, 'NR == 1 {n = NF} NF != n {bad = 1} END {exit bad || NR < 3}' long/long/rows.csv
verdict $? "SIGHUP: its rows are kept, and complete"
"$program" study verify long.study --results long >out 2>err
equal "SIGHUP: the run is sealed" "$? $(<err)" "0 "
start_long env # timeout(1) sends its signal twice: to the process, and to its group
kill -TERM "$job"
kill -TERM "$job" 2>/dev/null
wait "$job"
equal "a signal that comes twice is one: 130, and one line" "$? $(grep -c 'interrupted' err)" "130 1"
start_long nohup
kill -HUP "$job"
await "$job" has_lines long/long/rows.csv $(($(wc -l <long/long/rows.csv) + 3)) # one may have been on its way
verdict $? "nohup: SIGHUP does not end a study"
kill -TERM "$job"
wait "$job"
equal "nohup: SIGTERM ends it with 130" $? 130

# --- killed while it writes a file
mkdir stream
wrote_a_part() { # PROCESS: it has written to a file in the folder; the file may have no name yet
    for file in "/proc/$1/fd"/*; do [[ $(readlink "$file") == */stream/* && -s $file ]] && return; done
    return 1
}
for _ in 1 2 3; do
    "$program" animate "$root/experiments/scenes/slime.yaml" -o stream/film.y4m --duration 2000 --fps 50 \
        --set render.width=64 --set render.height=48 --set toy.level=1 >out 2>err &
    job=$!
    await $job wrote_a_part $job
    verdict $? "a video is being written"
    kill -KILL "$job"
    wait "$job" 2>/dev/null
done
"$program" render "$scene" -o stream/next.png --set render.width=40 --set render.height=30 >out 2>err
"$program" render "$scene" -o stream/next.png --set render.width=40 --set render.height=30 >out 2>err
equal "a killed writer leaves nothing that stays" "$(ls -A stream)" next.png

# --- a list with a file that cannot be read
mkdir studies
cp tiny.study studies/b.study
cp tiny.study studies/c.study
echo 'study: [' >studies/a.study
"$program" study list studies >out 2>err
equal "study list: one broken file is one error" "$? $(wc -l <err) $(wc -l <out)" "2 1 2"
echo 'study: [' >studies/d.study
"$program" study list studies >out 2>err
equal "study list: two broken files are two errors" "$? $(sort -u err | wc -l) $(wc -l <err)" "2 2 2"

conclude
