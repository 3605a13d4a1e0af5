#!/bin/bash
# Checks that every header under src/ compiles alone: as C17, and as C++17 if there is a C++ compiler and the header has
# no C11 atomics. Without CHECK=1 only src/cuvette.h, which other programs include.
set -uo pipefail
cd "$(dirname "$0")/../.."
cc=${CC:-gcc}
case $cc in *clang*) cxx=${CXX:-clang++} ;; *) cxx=${CXX:-g++} ;; esac
read -ra libraries <<<"$(pkg-config --cflags libpng libjpeg OpenEXR hwloc yaml-0.1 jansson libmicrohttpd 2>/dev/null)"
warnings=(-Wall -Wextra -Werror)
case_number=0 failed=0

compile() { # compile HEADER LANGUAGE COMPILER FLAG...
    local header=$1 language=$2 found
    shift 2
    case_number=$((case_number + 1))
    if found=$(printf '#include "%s"\nextern int end_of_header;\n' "${header#src/}" |
        "$@" "${warnings[@]}" -D_GNU_SOURCE -Isrc "${libraries[@]}" -fsyntax-only - 2>&1); then
        echo "ok $case_number - $header as $language"
    else
        echo "not ok $case_number - $header as $language"
        sed 's/^/# /' <<<"$found" | head -5
        failed=1
    fi
}

headers=(src/cuvette.h)
[[ -z ${CHECK:-} ]] || mapfile -t headers < <(find src -name '*.h' | sort)
for header in "${headers[@]}"; do
    compile "$header" C17 "$cc" -std=c17 -Wpedantic -x c
    if ! command -v "$cxx" >/dev/null; then
        continue
    elif [[ $("$cc" -D_GNU_SOURCE -Isrc "${libraries[@]}" -M -x c "$header" 2>/dev/null) == */stdatomic.h* ]]; then
        case_number=$((case_number + 1)) # such headers are private to their folder
        echo "ok $case_number # SKIP $header as C++17, which has no C11 atomics"
    else
        compile "$header" C++17 "$cxx" -std=c++17 -x c++
    fi
done
command -v "$cxx" >/dev/null || echo "# $cxx is not installed: C++ was skipped"
exit $failed
