#!/bin/bash
# Ctrl-C at random moments of commands that take seconds: the command ends with exit code 130 and one line that says so,
# leaves no temporary file, no part of a file, and keeps what the manual promises.
#
# interrupt.sh [WORKLOAD... | all]: some of them by default. MOMENTS is the number for each (1), SIGNALS the
# signals in turn ("INT TERM"), SEED that of the moments. LATENCY=FILE appends a line for each moment: workload, signal,
# seconds into the command, milliseconds until its end, milliseconds of its CPU time meanwhile, exit code; a table of
# them is printed at the end. No time is asserted. Needs the compiler (CC) for tests/tools/moment.c.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${CUVETTE:-$root/build/cuvette}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-interrupt.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export LC_ALL=C
unset CUVETTE_ISA
moments=${MOMENTS:-1}
read -ra signals <<<"${SIGNALS:-INT TERM}"
RANDOM=${SEED:-$RANDOM}
scenes=$root/experiments/scenes
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
"${CC:-gcc}" -std=c17 -O1 -o moment "$root/tests/tools/moment.c" || {
    echo "# the compiler cannot build tests/tools/moment.c"
    exit 77
}

# The workloads: a function each that sets `line` (the command), `files` (what it may not leave behind), `kept` (what it
# keeps) and `longest` (latest moment, s, for a fast machine); and perhaps makes its inputs.
image() { # FILE WIDTH HEIGHT
    [[ -e $1 ]] || "$program" render "$scenes/rod.yaml" -o "$1" --set render.width="$2" --set render.height="$3" \
        --set render.depth=1 --set render.lighting=ambient >made 2>&1 || "$program" render "$scenes/rod.yaml" -o "$1" \
        --set render.width="$2" --set render.height="$3" --set render.depth=1 >made 2>&1
}
soup() { # KIND COUNT ACCEL
    cat <<END >"soup-$3.yaml"
render: {width: 80, height: 60, accel: $3}
meshes: {soup: {generate: $1, count: $2}}
lights: {lamp: {position: [0, 4, -4]}}
solids: {body: {shape: mesh, mesh: soup}}
END
}
fan=(fan "$scenes/rod.yaml" "--from=-3,1.5,0" "--to=3,1.5,0" --width 1.6)
w_fan() { line=("${fan[@]}" --rays 100000 --depth 12 -o fan.csv) files=fan.csv longest=2; }
w_fan_tree() { line=("${fan[@]}" --rays 100000 --tree --depth 8 -o fan.svg) files=fan.svg longest=3; }
w_trace() {
    line=(trace "$scenes/rod.yaml" --pixel "400,300" --depth 24 --json -o tree.json)
    files=tree.json longest=2
}
w_motion() { line=(motion "$scenes/slime.yaml" --set toy.level=5 --set toy.dt_s=1e-4) longest=2; }
w_fit() { line=(fit "$root/experiments/fits/index_of_water.study") kept=results/index_of_water/fit.csv longest=2; }
w_lesson() { line=(lesson check) longest=1; }
w_check() { line=(scene soup-bvh.yaml --check) longest=2 && soup sparse 3000000 bvh; }
w_octant() { line=(render soup-octant.yaml -o s.png) files=s.png longest=2 && soup sparse 2000000 octant; }
w_slime() {
    line=(render "$scenes/slime.yaml" -o s.png --set toy.level=6 --set toy.dt_s=2e-5 --set toy.time_s=3)
    files=s.png longest=2
}
w_terrain() { line=(mesh --generate terrain --around 4000 --tube 3000) longest=5; }
w_sphere() { line=(mesh --generate sphere --count 9000000) longest=4; }
w_icosphere() { line=(mesh --generate icosphere --level 9) longest=1; }
w_torus() { line=(mesh --generate torus --around 3000 --tube 2000) longest=3; }
w_mesh_obj() { line=(mesh --generate sparse --count 3000000 -o m.obj) files=m.obj longest=4; }
w_mesh_print() { line=(mesh --generate dense --count 3000000 -f ply) longest=3; }
w_import() {
    line=(mesh big.obj) longest=2
    [[ -e big.obj ]] || "$program" mesh --generate torus --around 1500 --tube 1000 -o big.obj
}
w_import_ply() {
    line=(render ply.yaml -o p.png) files=p.png longest=2
    [[ -e big.ply ]] || "$program" mesh --generate torus --around 1500 --tube 1000 -o big.ply
    printf 'meshes: {m: {file: big.ply}}\nsolids: {s: {shape: mesh, mesh: m}}\n' >ply.yaml
}
w_texture() {
    line=(render texture.yaml -o t.png) files=t.png longest=0.5
    image big.png 6000 4000
    printf 'textures: {t: {file: big.png}}\nsolids: {s: {shape: sphere, radius: 1, texture: t}}\n' >texture.yaml
}
w_sky() {
    line=(render sky.yaml -o t.png --set render.integrator=path) kept=t.png longest=0.5
    image big.png 6000 4000
    printf 'background: {kind: image, image: big.png}\nsolids: {s: {shape: sphere, radius: 1}}\n' >sky.yaml
}
w_compare() {
    line=(compare small.png other.png --diff diff.png) files=diff.png longest=2
    image small.png 2400 1800 && cp small.png other.png
}
w_render() {
    line=(render "$scenes/rod.yaml" -o r.png --set render.width=1600 --set render.height=1200 --set render.samples=16)
    kept=r.png longest=3
}
w_paths() {
    line=(render "$scenes/rod.yaml" -o r.png --set render.integrator=path --set render.samples=64)
    line+=(--set render.width=800 --set render.height=600)
    line+=(--set render.depth=16) kept=r.png longest=3
}
w_repeat() { line=(render "$scenes/rod.yaml" --json --repeat 1000) longest=3; }
w_encode() {
    line=(render "$scenes/rod.yaml" -o r.png --bits 16 --set render.width=4000 --set render.height=3000)
    line+=(--set render.integrator=raycast) kept=r.png longest=4
}
w_encode_jpeg() {
    line=(render "$scenes/rod.yaml" -o r.jpg --set render.width=4000 --set render.height=3000)
    line+=(--set render.integrator=raycast) kept=r.jpg longest=4
}
w_layers() {
    line=(render "$scenes/rod.yaml" --layers l --set render.integrator=aov --set render.width=4000)
    line+=(--set render.height=3000) longest=4
}
w_animate() { line=(animate "$scenes/slime.yaml" -o frame-%03d.png --duration 3) longest=3; }
w_study() {
    line=(study run long.study -r results) kept=results/long/rows.csv longest=3
    printf 'study: long\nscene: %s\ngrid: [{render.depth: [1, 2, 3]}]\nrepetitions: 500\n' "$scenes/rod.yaml" \
        >long.study
}
w_processes() {
    line=(study run processes.study -r results) kept=results/processes/rows.csv longest=3
    printf 'study: processes\nscene: %s\ngrid: [{render.depth: [1, 2, 3]}]\nrepetitions: 500\nprocesses: 5\n' \
        "$scenes/rod.yaml" >processes.study
}
w_study_motion() {
    line=(study run motion.study -r results) longest=4
    printf 'study: motion\nscene: %s\nset: {%s, render.width: 40, render.height: 30}\ngrid: %s\n%s' \
        "$scenes/slime.yaml" 'toy.level: 5, toy.dt_s: 1e-4' \
        '[{render.depth: [1, 2]}]' 'keep: {motion: on}' >motion.study
}

# What is wrong with the state that a command left: exit code $1, its latency $2.
wrongs() {
    (($1 == 130)) || echo "exit $1: $(tail -1 err | head -c 200)"
    (($(grep -c '^cuvette: .*interrupted' err) == 1)) || echo "no line that it was interrupted"
    (($(grep -vc '^cuvette: note: ' err) <= 1)) || echo "$(wc -l <err) lines of errors"
    for name in $files; do
        [[ ! -e $name ]] || echo "$name exists"
    done
    [[ -z $(find . -name '.cuvette-*') ]] || echo "a temporary file is left"
    for name in $kept; do
        if [[ -e $name && $name == *.png ]]; then
            printf 'background: {kind: image, image: %s}\n' "$name" >decoded.yaml
            "$program" scene decoded.yaml --check >made 2>&1 || echo "$name is damaged: $(head -1 made)"
        elif [[ -e $name && $name == *rows.csv ]]; then
            "$program" study verify "${line[2]}" -r results >made 2>&1 || echo "rows are damaged: $(head -1 made)"
        fi
    done
}

# Is that about the CPU time that the command takes without a signal? Then a signal near its end changed nothing.
is_whole() { # SECONDS
    [[ $whole ]] || read -r _ _ _ _ _ whole < <(./moment 0 0 "$program" "${line[@]}" 2>whole.err)
    awk -v used="$1" -v whole="$whole" 'BEGIN {exit !(used > 0.6 * whole)}'
}

# One moment: prints what is wrong. ran: seconds of a run that ended before its signal; whole: of CPU of one without.
interrupt() { # WORKLOAD SIGNAL
    local files='' kept='' longest=1 line=() after ms cpu code rest
    "w_$1"
    # shellcheck disable=SC2086 # several names
    rm -rf $files $kept results frame-*.png
    after=$(awk -v r="$RANDOM" -v most="$longest" -v ran="${ran:-}" \
        'BEGIN {if (ran != "" && ran < most) most = ran; printf "%.3f", 0.03 + most * r / 32768}')
    read -r ms cpu code rest < <(./moment "$(kill -l "$2")" "$after" "$program" "${line[@]}" 2>err)
    if [[ $ms == - ]] || { ((code == 0)) && is_whole "${rest##* }"; }; then # it had ended, or was about to
        ((code == 0)) || echo "without a signal: exit $code: $(tail -1 err | head -c 200)"
        ran=${rest%% *}
        return
    fi
    if [[ $code == -* && ! -s err ]] && awk -v used="${rest##* }" 'BEGIN {exit !(used + 0 < 1)}'; then
        return # main had not begun
    fi
    [[ -z ${LATENCY:-} ]] || echo "$1 $2 $after $ms $cpu $code" >>"$LATENCY"
    wrongs "$code" "$ms" | sed "s/^/$2 at $after s: /"
}

if (($# == 0)); then # the others take longer, or differ little
    set -- fan trace motion check terrain mesh_obj import texture compare render animate study
elif [[ $1 == all ]]; then
    mapfile -t every < <(declare -F | sed -n 's/^declare -f w_//p')
    set -- "${every[@]}"
fi
for workload; do
    seed=$RANDOM # a subshell would begin with one of its own
    bad=$(
        RANDOM=$seed ran='' whole=''
        for ((i = 0; i < moments; i++)); do
            interrupt "$workload" "${signals[i % ${#signals[@]}]}"
        done
    )
    empty "$workload: $moments moments" "$bad"
done
if [[ -s ${LATENCY:-} ]]; then
    echo "# workload        moments   median ms    worst ms   worst CPU ms"
    sort -k1,1 -k4,4n "$LATENCY" | awk '
        function put() {if (n) printf "# %-14s %8d %11.1f %11.1f %14.1f\n", name, n, ms[int((n + 1) / 2)], ms[n], cpu}
        $1 != name {put(); name = $1; n = 0; cpu = 0}
        {ms[++n] = $4; if ($5 > cpu) cpu = $5; all++}
        END {put(); print "# " all " moments"}'
fi
conclude
