#!/bin/bash
# The engine library in other programs: installation, pkg-config, shared and static linking, from C and C++; its
# exported names and version; the example programs' images and memory. BUILD names the build folder, CONFIG its
# configuration.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build} config=${CONFIG:-release} cc=${CC:-gcc}
case $cc in *clang*) cxx=${CXX:-clang++} ;; *) cxx=${CXX:-g++} ;; esac
case $config in sanitize | tsan | fuzz | coverage)
    echo "# instrumented libraries cannot be linked with other programs"
    exit 77
    ;;
esac
[[ -f $build/libcuvette.a ]] || {
    echo "# $build/libcuvette.a is not built"
    exit 77
}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-engine-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset CUVETTE_ISA

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
have() { command -v "$1" >/dev/null; }
run_make() { make -s --no-print-directory config="$config" build="$build" CC="$cc" "$@" 2>&1 |
    grep -v -i -e jobserver -e '^ ' -e '^installed: '; }

# --- installation, with and without DESTDIR
prefix=$work/prefix staged=$work/destination/opt/cuvette
run_make install DESTDIR="$work/destination" PREFIX=/opt/cuvette
run_make install PREFIX="$prefix"
empty "DESTDIR is prepended to PREFIX and is not in an installed file" \
    "$(
        diff <(cd "$prefix" && find . | sort) <(cd "$staged" && find . |
            sort)
        grep -l "$work" -r "$staged/lib/pkgconfig"
    )"
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
flags() { pkg-config "$@" cuvette; }
version=$(sed -n 's/^#define CUVETTE_VERSION_[A-Z]* //p' src/cuvette.h | paste -sd.)
empty "pkg-config reports the version of the header" \
    "$([[ $(flags --modversion) == "$version" ]] || flags --modversion 2>&1)"

# --- exported names
library=$prefix/lib/libcuvette.so.0
declared=$(grep -o '\bcuvette_[a-z0-9_]*(' "$prefix/include/cuvette.h" | tr -d '(' | sort -u)
empty "the shared library exports exactly the functions of the header" \
    "$(diff <(echo "$declared") <(nm -D --defined-only "$library" | awk '{print $3}' | sort))"
empty "the exported names are those of engine_symbols.txt: one that is gone breaks programs; add new ones there" \
    "$(diff tests/engine/engine_symbols.txt <(echo "$declared"))"
empty "the static library exports exactly the functions of the header" \
    "$(diff <(echo "$declared") <(nm -g --defined-only "$prefix/lib/libcuvette.a" | awk 'NF == 3 {print $3}' | sort))"
empty "the soname is libcuvette.so.0" "$(readelf -d "$library" | grep SONAME | grep -v '\[libcuvette.so.0\]')"
empty "the library requires no executable stack" "$(readelf -lW "$library" | awk '/GNU_STACK/ && /RWE/')"
# topology_discover.o ends the child process that it makes.
empty "the library neither prints nor calls exit" \
    "$(nm -D --undefined-only "$library" | awk '{print $2}' | sed 's/@.*//' |
        grep -x -e exit -e abort -e printf -e puts -e putchar -e perror -e stderr)"
empty "only the child process of the topology calls _exit" \
    "$(cd "$build/obj" && grep -rlE '\b_exit\b' --include='*.o' base geometry image job measure optics realism render \
        report scene softbody study engine | grep -v measure/topology_discover.o)"

# --- the examples, with four combinations of library and language
warnings=(-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
read -ra shared <<<"$(flags --cflags --libs)"
read -ra static <<<"$(flags --cflags --static --libs)"
static=("${static[@]/#-lcuvette/-l:libcuvette.a}")
build_and_run() { # NAME COMPILER FLAG...
    local name=$1
    shift
    local output
    output=$("$@" "${warnings[@]}" -g -o "$work/$name" 2>&1)
    verdict $? "$name: the example compiles" "$output"
    output=$({ "$work/$name" >"$work/$name.ppm"; } 2>&1)
    verdict $? "$name: the example runs" "$output"
    grep -o "$stable_output" <<<"$output" >"$work/$name.output"
}
under_valgrind() { # NAME
    local output
    if ! have valgrind; then
        skip "valgrind is not installed"
        return
    fi
    output=$(LD_LIBRARY_PATH=$prefix/lib valgrind -q --error-exitcode=9 --leak-check=full \
        --show-leak-kinds=definite,indirect,possible \
        --errors-for-leak-kinds=definite,indirect,possible "$work/$1" 2>&1 >"$work/valgrind.ppm")
    verdict $? "$1: valgrind reports no error and no leak" "$(grep '^==' <<<"$output")"
    empty "$1: the image under valgrind is the same" "$(cmp "$work/$1.ppm" "$work/valgrind.ppm" 2>&1)"
}
try_example() { # NAME WIDTH HEIGHT PATTERN: the part of its output that is the same in every run
    local name=$1 width=$2 height=$3 stable_output=$4 source=experiments/engine/$1.c
    empty "$name has fewer than 100 lines" "$(awk 'END {if (NR >= 100) print NR}' "$source")"
    LD_LIBRARY_PATH=$prefix/lib build_and_run "$name-shared-c" "$cc" -std=c17 "$source" "${shared[@]}"
    build_and_run "$name-static-c" "$cc" -std=c17 "$source" "${static[@]}"
    local variants=(static-c)
    if have "$cxx"; then
        LD_LIBRARY_PATH=$prefix/lib build_and_run "$name-shared-c++" "$cxx" -std=c++17 -x c++ "$source" "${shared[@]}"
        build_and_run "$name-static-c++" "$cxx" -std=c++17 -x c++ "$source" "${static[@]}"
        variants+=(shared-c++ static-c++)
    else
        skip "$name as C++: no $cxx"
    fi
    empty "$name needs libcuvette.so.0 if linked shared, and not if linked statically" \
        "$(
            readelf -d "$work/$name-shared-c" | grep 'NEEDED.*libcuvette\.so\.0\]' >/dev/null ||
                echo shared
            readelf -d "$work/$name-static-c" | grep 'NEEDED.*libcuvette'
        )"
    empty "$name prints its result" "$([[ -s $work/$name-shared-c.output ]] || echo nothing)"
    for variant in "${variants[@]}"; do
        empty "$name-$variant has the same image, films and counts" \
            "$(
                cmp "$work/$name-shared-c.ppm" "$work/$name-$variant.ppm" 2>&1
                diff "$work/$name-shared-c.output" \
                    "$work/$name-$variant.output"
            )"
    done
    local head="P6 $width $height 255 "
    empty "the image of $name is a PPM of $width x $height" \
        "$([[ $(head -c ${#head} "$work/$name-shared-c.ppm" | tr '\n' ' ') == "$head" &&
        $(wc -c <"$work/$name-shared-c.ppm") == $((${#head} + 3 * width * height)) ]] ||
            wc -c <"$work/$name-shared-c.ppm")"
    [[ $name == slime && ! ${CHECK:-} ]] || under_valgrind "$name-shared-c" # slow; CHECK=1 has it
}
try_example glass_ball 320 240 'film.*preview\|rays:.*'
try_example slime 800 120 'film.*'

# --- the installed program, from elsewhere
empty "studies and scenes of the installation are listed anywhere" \
    "$(
        list=$(cd "$work" && "$prefix/bin/cuvette" study list 2>&1)
        for file in depth.study scenes/rod.yaml; do
            grep -q "^$prefix/share/cuvette/experiments/$file " <<<"$list" || head -n 3 <<<"$list"
        done
    )"
empty "the installed program finds its importer" \
    "$(cd "$work" && env -u CUVETTE_IMPORT "$prefix/bin/cuvette" render -o models.png \
        "$prefix/share/cuvette/experiments/scenes/models.yaml" 2>&1 >/dev/null)"

# --- uninstallation
echo "a user's file" >"$prefix/share/cuvette/plots/mine.gp"
sed -i 's|/share/man/man1/cuvette.1$|/share/man/man1/cuvette-formerly.1|' "$prefix/share/cuvette/installed-files"
mv "$prefix/share/man/man1/cuvette.1" "$prefix/share/man/man1/cuvette-formerly.1"
run_make install PREFIX="$prefix"
run_make uninstall PREFIX="$prefix"
empty "make uninstall removes what this and earlier installations installed, and nothing else" \
    "$(diff <(find "$prefix" -type f -o -type l) <(echo "$prefix/share/cuvette/plots/mine.gp"))"
conclude
