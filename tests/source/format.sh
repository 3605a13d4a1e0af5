#!/bin/bash
# The layout of every source file: C by clang-format (.clang-format), shell by shfmt, Python by black, the page and its
# tests by prettier (.prettierrc.json) of FOLDER/node_modules. A check without its tool is skipped.
# format.sh [--check|--write] [FOLDER]
set -uo pipefail
cd "$(dirname "$0")/../.."
write=
[[ ${1:-} == --write ]] && write=1
prettier=${2:-build/web-tests}/node_modules/.bin/prettier
case_number=0 failed=0

mapfile -t c < <(find src tests experiments -name '*.[ch]' | sort)
mapfile -t shell < <(find .ci src tests plots experiments paper -type f -print0 |
    xargs -0 grep -lE '^#!/bin/(ba)?sh' | sort)
mapfile -t page < <(find src/web tests/web -name '*.js' -o -name '*.mjs' -o -name '*.css' -o -name '*.html' | sort)

mapfile -t python < <(find src/python tests/python experiments paper plots -name '*.py' | sort)

# check WHAT TOOL COMMAND...: the command prints the lines with another layout, and fails if there are any
check() {
    local what=$1 tool=$2 found
    shift 2
    case_number=$((case_number + 1))
    if ! command -v "$tool" >/dev/null; then
        echo "ok $case_number # SKIP $what: no $tool"
    elif found=$("$@" 2>&1); then
        echo "ok $case_number - $what"
    else
        echo "not ok $case_number - $what; run make format, and break long texts by hand"
        head -20 <<<"$found" | sed 's/^/# /'
        failed=1
    fi
}

if [[ $write ]]; then
    clang-format -i "${c[@]}"
    ! command -v black >/dev/null || black -q -l 120 "${python[@]}"
    shfmt -i 4 -w "${shell[@]}"
    ! command -v "$prettier" >/dev/null || "$prettier" --log-level warn --write "${page[@]}"
    exit
fi
check "${#c[@]} files of C" clang-format clang-format --dry-run -Werror "${c[@]}"
check "${#shell[@]} shell scripts" shfmt shfmt -i 4 -d "${shell[@]}"
check "${#page[@]} files of the page and its tests" "$prettier" "$prettier" --log-level warn --check "${page[@]}"
check "${#python[@]} files of Python" black black -q -l 120 --check "${python[@]}"
exit $failed
