#!/bin/bash
# The engine as other programs meet it: installed, found by pkg-config, linked shared and statically, from C and C++; its names, its
# version; the example program's picture and memory. BUILD names the build folder, CONFIG its configuration.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
build=${BUILD:-build} config=${CONFIG:-release} cc=${CC:-gcc}
case $cc in *clang*) cxx=${CXX:-clang++} ;; *) cxx=${CXX:-g++} ;; esac
case $config in sanitize | tsan | fuzz) echo "# instrumented libraries are not for other programs"; exit 77 ;; esac
[[ -f $build/libcuvette.a ]] || { echo "# $build/libcuvette.a is not built"; exit 77; }
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-engine-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset CUVETTE_ISA

case_number=0 failed=0
verdict() { # STATUS WHAT [WHY]
    case_number=$((case_number + 1))
    if (($1 == 0)); then
        echo "ok $case_number - $2"
    else
        failed=1
        echo "not ok $case_number - $2"
        [[ -z ${3:-} ]] || sed 's/^/# /' <<<"$3" | head -20
    fi
}
empty() { # WHAT TEXT: passes when the text, what is wrong, is empty
    [[ -z $2 ]]
    verdict $? "$1" "$2"
}
skip() { case_number=$((case_number + 1)); echo "ok $case_number # SKIP $1"; }
have() { command -v "$1" >/dev/null; }
run_make() { make -s --no-print-directory config="$config" build="$build" CC="$cc" "$@" 2>&1 | grep -v -i -e jobserver -e '^ '; }

# --- installed, under DESTDIR and without it
prefix=$work/prefix staged=$work/destination/opt/cuvette
run_make install DESTDIR="$work/destination" PREFIX=/opt/cuvette
run_make install PREFIX="$prefix"
empty "DESTDIR goes before PREFIX, and is in no file" \
    "$(diff <(cd "$prefix" && find . | sort) <(cd "$staged" && find . | sort); grep -l "$work" -r "$staged/lib/pkgconfig")"
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
flags() { pkg-config "$@" cuvette; }
version=$(sed -n 's/^#define CUVETTE_VERSION_[A-Z]* //p' src/cuvette.h | paste -sd.)
empty "pkg-config says the header's version" "$([[ $(flags --modversion) == "$version" ]] || flags --modversion 2>&1)"

# --- what is seen of it
library=$prefix/lib/libcuvette.so.0
declared=$(grep -o '\bcuvette_[a-z0-9_]*(' "$prefix/include/cuvette.h" | tr -d '(' | sort -u)
empty "the shared library shows what the header declares, and nothing else" \
    "$(diff <(echo "$declared") <(nm -D --defined-only "$library" | awk '{print $3}' | sort))"
empty "so does the static one" \
    "$(diff <(echo "$declared") <(nm -g --defined-only "$prefix/lib/libcuvette.a" | awk 'NF == 3 {print $3}' | sort))"
empty "its soname is libcuvette.so.0" "$(readelf -d "$library" | grep SONAME | grep -v '\[libcuvette.so.0\]')"
empty "it asks for no stack that runs code" "$(readelf -lW "$library" | awk '/GNU_STACK/ && /RWE/')"
empty "it neither prints nor ends the program" \
    "$(nm -D --undefined-only "$library" | awk '{print $2}' | sed 's/@.*//' | grep -x -e exit -e _exit -e abort -e printf -e puts -e putchar -e perror -e stderr)"

# --- the example, in four ways
warnings=(-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
source=experiments/engine/glass_ball.c
empty "the example has fewer than 100 lines" "$(awk 'END {if (NR >= 100) print NR}' $source)"
read -ra shared <<<"$(flags --cflags --libs)"
read -ra static <<<"$(flags --cflags --static --libs)"
static=("${static[@]/#-lcuvette/-l:libcuvette.a}")
build_and_run() { # NAME COMPILER FLAG...
    local name=$1
    shift
    local said
    said=$("$@" "${warnings[@]}" -g -o "$work/$name" 2>&1)
    verdict $? "the example builds: $name" "$said"
    said=$({ "$work/$name" >"$work/$name.ppm"; } 2>&1)
    verdict $? "and runs" "$said"
    grep -o 'film.*preview\|rays:.*' <<<"$said" >"$work/$name.said"
}
LD_LIBRARY_PATH=$prefix/lib build_and_run shared-c "$cc" -std=c17 $source "${shared[@]}"
build_and_run static-c "$cc" -std=c17 $source "${static[@]}"
ways=(shared-c static-c)
if have "$cxx"; then
    LD_LIBRARY_PATH=$prefix/lib build_and_run shared-c++ "$cxx" -std=c++17 -x c++ $source "${shared[@]}"
    build_and_run static-c++ "$cxx" -std=c++17 -x c++ $source "${static[@]}"
    ways+=(shared-c++ static-c++)
else
    skip "the example as C++: no $cxx"
fi
empty "the shared one needs libcuvette.so.0, the static one none" \
    "$(readelf -d "$work/shared-c" | grep -q 'NEEDED.*libcuvette\.so\.0\]' || echo shared; readelf -d "$work/static-c" | grep 'NEEDED.*libcuvette')"
for way in "${ways[@]:1}"; do
    empty "$way makes the same picture, film and counts" \
        "$(cmp "$work/shared-c.ppm" "$work/$way.ppm" 2>&1; diff "$work/shared-c.said" "$work/$way.said")"
done
empty "the picture is a PPM of 320 x 240" "$([[ $(head -c 15 "$work/shared-c.ppm" | tr '\n' ' ') == "P6 320 240 255 " && $(wc -c <"$work/shared-c.ppm") == $((15 + 3 * 320 * 240)) ]] || wc -c <"$work/shared-c.ppm")"

if have valgrind; then
    said=$(LD_LIBRARY_PATH=$prefix/lib valgrind -q --error-exitcode=9 --leak-check=full --show-leak-kinds=definite,indirect,possible \
        --errors-for-leak-kinds=definite,indirect,possible "$work/shared-c" 2>&1 >"$work/valgrind.ppm")
    verdict $? "valgrind finds no fault in it, and no leak" "$(grep '^==' <<<"$said")"
    empty "and it sees the same picture" "$(cmp "$work/shared-c.ppm" "$work/valgrind.ppm" 2>&1)"
else
    skip "valgrind is not installed"
fi

# --- gone again
run_make uninstall PREFIX="$prefix"
empty "uninstall leaves no file" "$(find "$prefix" -type f -o -type l)"
exit $failed
