#!/bin/bash
# Counts of the source tree that must not get worse: each has a limit in the table below, which is lowered (a median:
# raised) with its count. Checks also that each count finds what is planted in a small tree.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-counts.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh

# Function below, at most or at least, limit, what it counts.
limits='
integrators  most   4    files of src that name an integrator
shapes       most   7    files of src that name a kind of shape
renderers    most   1    files that call renderer_render besides its own: the job
wide_lines   most   0    lines of more than 120 columns
src_folders  most   60   files in a folder of src
test_folders most   60   files in a folder of tests
c_files      most   723  files of C in src
median       least  136  lines of a file of C in src, the median
test_lines   most   700  lines of a test program
'

# Each prints its number, then what it consists of, one per line. In the folder of a tree.
number_of() { # lines of standard input, which are shown after their number
    local lines
    mapfile -t lines
    echo "${#lines[@]}"
    printf '%s\n' "${lines[@]}"
}
naming() { # PREFIX OTHER|OTHER: names of this prefix that are no kinds
    grep -rlP --include='*.[ch]' "\b$1_(?!($2)\b)[A-Z]+\b" src | sort | number_of
}
integrators() { naming INTEGRATOR 'NUMBER|COUNT'; }
shapes() { naming SHAPE 'COUNT|KIND|RULE|PRIMITIVES|DECLARED'; }
renderers() {
    grep -rl --include='*.c' 'renderer_render(' src | xargs -r grep -L '^status renderer_render(' | sort | number_of
}
wide_lines() {
    find src tests experiments mk .ci Makefile -type f ! -path 'tests/bad/*' ! -path 'tests/fuzz/corpus/*' \( \
        -name '*.[ch]' -o -name '*.sh' -o -name '*.py' -o -name '*.js' -o -name '*.mjs' -o -name '*.css' \
        -o -name '*.html' -o -name '*.mk' -o -name Makefile \) -print0 2>/dev/null |
        LC_ALL=C.UTF-8 xargs -0 -r grep -nHE '^.{121,}' | cut -c 1-100 | number_of
}
largest_folders() { # FOLDER: what tests read, many small files, stands apart
    find "$1" -type f ! -path 'tests/bad/*' ! -path 'tests/data/*' ! -path 'tests/golden/*' \
        ! -path 'tests/fuzz/corpus/*' -printf '%h\n' | sort | uniq -c | sort -rn |
        awk 'NR == 1 { print $1 } NR <= 5 { print $2 ": " $1 }'
}
src_folders() { largest_folders src; }
test_folders() { largest_folders tests; }
c_files() { find src -name '*.[ch]' | wc -l; }
median() {
    find src -name '*.[ch]' -exec grep -c '' {} + | sed 's/.*://' | sort -n |
        awk '{ lines[NR] = $1 } END { print lines[int((NR + 1) / 2)] }'
}
test_lines() {
    find tests -name 'test_*.c' -exec grep -cH '' {} + | tr : ' ' | sort -k 2nr |
        awk 'NR == 1 { print $2 } NR <= 5 { print $1 ": " $2 }'
}

while read -r name bound limit what; do
    [[ $name ]] || continue
    found=$("$name")
    count=$(head -n 1 <<<"$found")
    if [[ $bound == most ]]; then ((count <= limit)); else ((count >= limit)); fi
    verdict $? "$what: $count, at $bound $limit" "$(tail -n +2 <<<"$found")"
done <<<"$limits"

planted() { # NAME COUNT: what is planted counts as much
    equal "planted: $1" "$(cd "$work" && "$1" | head -n 1)" "$2"
    clear_tree
}
clear_tree() {
    rm -rf "${work:?}"/*
    mkdir -p "$work"/{src/x,tests/x,tests/bad/x}
}
plant() { # FILE LINE...
    printf '%s\n' "${@:2}" >"$work/$1"
}
clear_tree
plant src/x/a.c 'return INTEGRATOR_PATH;'
plant src/x/b.h 'INTEGRATOR_COUNT' 'MY_INTEGRATOR_PATH'
planted integrators 1
plant src/x/a.c 'case SHAPE_TORUS:' 'case SHAPE_COUNT:'
plant src/x/b.c 'SHAPE_RULE' 'SHAPE_PRIMITIVES(x)'
planted shapes 1
plant src/x/a.c 'status renderer_render(renderer *r)' 'renderer_render(r)'
plant src/x/b.c '    return renderer_render(r);'
plant src/x/c.c '    return renderer_render(r);'
planted renderers 2
plant src/x/a.c "$(printf 'ü%.0s' {1..120})" "$(printf 'ü%.0s' {1..121})"
planted wide_lines 1
for i in {1..7}; do plant "src/x/$i.js" && plant "tests/x/$i.sh" && plant "tests/bad/x/$i.yaml"; done
plant tests/bad/x/8.yaml
equal 'planted: src_folders' "$(cd "$work" && src_folders | head -n 1)" 7
planted test_folders 7
plant src/x/a.c 1 2 3
plant src/x/b.h 1
plant src/x/c.c 1 2 3 4 5 6
plant src/x/d.js 1
planted median 3
plant src/x/a.c 1
plant src/x/a.js 1
planted c_files 1
plant tests/x/test_a.c 1 2 3
plant tests/x/a.h 1 2 3 4
planted test_lines 3
conclude
