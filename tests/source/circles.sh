#!/bin/bash
# No circles among the objects of the build, by the symbols that they need (circles.py). Also that circles made for the
# purpose are found. BUILD names the build folder; circles.py --why src build/obj build/plain says which symbols close
# a circle.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-circles.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
for tool in python3 nm; do
    command -v "$tool" >/dev/null || {
        echo "# $tool is not installed"
        exit 77
    }
done

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh

# Circles made for the purpose: a and b need each other, c only a; of two instruction sets k needs b, and b needs k.
mkdir -p "$work/src/x" "$work/obj/x"
make_object() { # NAME INSTRUCTION_SET DEFINED NEEDED...
    local needed
    {
        for needed in "${@:4}"; do echo "void $needed(void);"; done
        echo "void $3(void); void $3(void) {"
        for needed in "${@:4}"; do echo "$needed();"; done
        echo '}'
    } >"$work/src/x/$1.c"
    "${CC:-gcc}" -c -o "$work/obj/x/$1$2.o" "$work/src/x/$1.c"
}
make_object a '' of_a of_b
make_object b '' of_b of_a elsewhere
make_object c '' of_c of_a
equal 'two objects that need each other' "$(python3 -B tests/source/circles.py "$work/src" "$work/obj")" 'x/a x/b'
make_object a '' of_a elsewhere
equal 'no circle' "$(python3 -B tests/source/circles.py "$work/src" "$work/obj")" ''
make_object b '' of_b of_k_avx2
make_object k .sse2 of_k_sse2 of_b
make_object k .avx2 of_k_avx2 elsewhere
equal 'the objects of a kernel are one' "$(python3 -B tests/source/circles.py "$work/src" "$work/obj")" 'x/b x/k'
rm "$work/src/x/k.c"
equal 'an object without a source is left out' "$(python3 -B tests/source/circles.py "$work/src" "$work/obj")" ''

# cuvette-mpi and the WebAssembly module are not part of make test; account_keys.c is a program of its own.
empty "every source has an object in $build" "$(comm -23 \
    <(find src -name '*.c' ! -path 'src/wasm/*' ! -path 'src/mpi/*' ! -path 'src/manual/*' -printf '%P\n' |
        sed 's/\.c$//' | sort) \
    <(find "$build/obj" "$build/plain" -name '*.o' -printf '%P\n' | sed 's/\.[^/]*$//' | sort -u))"
found=$(python3 -B tests/source/circles.py src "$build/obj" "$build/plain")
verdict $? 'the symbols of the objects are read'
empty 'no circles' "$found"
conclude
