#!/bin/bash
# Checks that the compilation database is JSON with one entry for every C file of src and tests, but for those of
# src/wasm, which only emscripten compiles, and that its commands compile, for one file of each kind. CC compiles
# tests/tools/json_get.c, which reads the database.
set -uo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-commands.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset MAKEFLAGS MFLAGS MAKELEVEL

count=0 failed=0
empty() { # WHAT TEXT: passes when the text, the list of errors, is empty
    count=$((count + 1))
    if [[ -z $2 ]]; then
        echo "ok $count - $1"
    else
        echo "not ok $count - $1"
        head -20 <<<"$2" | sed 's/^/# /'
        failed=1
    fi
}
get() { "$work/json_get" "$work/all.json" "$1"; }

empty "tests/tools/json_get.c compiles" "$("${CC:-gcc}" -std=gnu17 -o "$work/json_get" tests/tools/json_get.c \
    $(pkg-config --cflags --libs jansson) 2>&1)"
empty "the database is written" \
    "$(.ci/compile_commands "$work/all.json" CC=gcc config=release build="$work/build" compiled 2>&1)"
empty "one entry for every C file of src and tests" \
    "$(diff <(find src tests -name '*.c' ! -path 'src/wasm/*' | sort) \
        <(get '[].file' | grep -v '^experiments/' | sort) 2>&1)"
empty "all paths are relative to the repository" "$(get '[].directory' | grep -vxF "$PWD")"
for file in src/render/shade/shade_kernel.c src/web/lab.c src/import/main.c tests/base/test_base.c \
    tests/tools/json_get.c; do
    empty "the command of $file compiles it" "$(bash -c "$(get "[file=$file].command") -fsyntax-only" 2>&1)"
done
exit $failed
