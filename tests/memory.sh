#!/bin/bash
# Commands with a failing allocation, for each allocation in turn. tests/memory.sh [PROGRAM]; needs the compiler (CC)
# for tests/fail_allocation.c. The command either exits with 1, one line on standard error and no file, or its file is
# correct to the byte (glibc's streams and its printf can do without some allocations). One line per check ("ok ...",
# "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-memory.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CUVETTE_ISA
case ${CONFIG:-release}${CC:-gcc} in
tsan* | fuzz* | coverage* | sanitize*clang*)
    echo "# the instrumented program allocates by itself, in spite of a preloaded library"
    exit 77
    ;;
esac
export LC_ALL=C ASAN_OPTIONS=verify_asan_link_order=0

"${CC:-gcc}" -std=c17 -D_GNU_SOURCE -shared -fPIC -O1 -o fail.so "$root/tests/fail_allocation.c" -ldl ||
    {
        echo "# the compiler cannot build a shared library"
        exit 77
    }

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
failing() { # NUMBER KINDS COMMAND...
    FAIL_AT=$1 FAIL_KINDS=$2 FAIL_COUNT=$work/count LD_PRELOAD=$work/fail.so "${@:3}" >out 2>err
}

# The errors of the last run; empty if there are none.
wrongs() { # CODE OUTPUT
    if (($1 == 0)); then
        cmp -s "$2" right || echo "exit 0 with a wrong file"
    elif (($1 != 1)); then
        echo "exit $1"
    elif ! grep -qE '^cuvette: (.*: )?out of memory' err || (($(wc -l <err) != 1)); then
        echo "exit 1 with the message: $(head -c 200 err)"
    elif [[ -e $2 ]]; then
        echo "exit 1 with a file"
    fi
}

# walk WHAT KINDS STEP OUTPUT ARGUMENT...: fails every STEP-th allocation of these kinds, one per run
walk() {
    local what=$1 kinds=$2 step=$3 output=$4 sites tried=0 reported=0 bad=0 wrong at code
    shift 4
    rm -f "$output" count
    failing 0 "$kinds" "$program" "$@"
    mv "$output" right 2>/dev/null && sites=$(cat count) && ((sites > 0))
    local ready=$?
    for ((at = 1; ready == 0 && at <= sites; at += step)); do
        rm -f "$output"
        failing "$at" "$kinds" "$program" "$@" 2>/dev/null
        code=$?
        wrong=$(wrongs "$code" "$output")
        tried=$((tried + 1)) reported=$((reported + (code == 1)))
        if [[ $wrong ]]; then
            bad=$((bad + 1))
            ((bad > 5)) || echo "# $what, $kinds, allocation $at of $sites: $wrong"
        fi
    done
    ((ready == 0 && bad == 0 && reported > 0))
    verdict $? "$what, kinds $kinds: $tried of ${sites:-0} allocations failed, $reported reported, $bad errors"
}

# Otherwise the following checks would pass trivially.
cat >all.c <<'EOF'
#include <stdlib.h>
int main(void) { void *volatile memory = malloc(10); return memory ? 0 : 7; }
EOF
"${CC:-gcc}" -O0 -o all all.c
failing 1 m ./all
(($? == 7))
verdict $? "an allocation fails on request"

mkdir -p deep/below
cp "$root/experiments/scenes/chequer.png" deep/below/
cat >deep/below/scene.yaml <<'EOF'
title: 'words: "quoted"'
render: {width: 8, height: 6}
textures: {tiles: {file: chequer.png}}
meshes: {ring: {generate: torus, around: 8, tube: 6}}
solids:
  one: {shape: mesh, mesh: ring, texture: tiles}
EOF
write=(scene deep/below/scene.yaml -o moved.yaml)
walk "scene -o" cgp 1 moved.yaml "${write[@]}"
walk "scene -o" mcgsp 23 moved.yaml "${write[@]}"

cat >rod.yaml <<'EOF'
lights: {lamp: {position: [3, 6, -4]}}
solids:
  vessel: {shape: cylinder, radius: 1, height: 3, transparency: 1, ior: 1.5}
  liquid: {shape: cylinder, radius: 0.9, height: 2, position: [0, 0.1, 0], transparency: 1, ior: 1.33, priority: 1}
EOF
trace=(trace rod.yaml --ray=-3,1.5,0.6,1,0,0 --depth 2 -o drawing.svg)
walk "trace -o" cgp 1 drawing.svg "${trace[@]}"
walk "trace -o" mcgsp 23 drawing.svg "${trace[@]}"
fan=(fan rod.yaml --from=-3,1.5,0 --to=3,1.5,0 --width 1.5 --rays 5 -o drawing.svg)
walk "fan -o" cgp 1 drawing.svg "${fan[@]}"
walk "fan -o" mcgsp 23 drawing.svg "${fan[@]}"

# An image that is decoded, a mesh that is bisected, a slime whose parameters are kept as text.
walk "trace -o of a slime" cgp 3 tree.json trace "$root/experiments/scenes/slime.yaml" --pixel 400,300 --depth 1 \
    --set toy.level=1 --set toy.time_s=0.01 -o tree.json

conclude
