#!/bin/bash
# The manual against the program: every command has a page with its options, the pages are clean roff, refer to pages
# that exist, and their examples work. manual.sh [PROGRAM]. One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
manual=$(realpath "${BUILD:-$root/build}/man")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-manual.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset CUVETTE_ISA NO_COLOR

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

has() { # PROGRAM WHAT: whether it is installed; a check without it is skipped
    command -v "$1" >/dev/null && return
    skip "$2: $1 is not installed"
    return 1
}

commands() { # WORD...: the commands that `cuvette WORD... --help` lists
    "$program" "$@" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p'
}
# --help, --usage and --version are those of every command; cuvette(1) describes them.
help_options() { # WORD...: the options of a command and of its subcommands, such as "-o, --output=FILE"
    "$program" "$@" --help | grep -E '^(  -., |      )--' | grep -vE -- '--(help|usage|version) ' |
        sed -E 's/^ *//; s/(--[^ ]*).*/\1/'
    local word
    if [[ $1 != help ]]; then
        for word in $(commands "$@"); do help_options "$@" "$word"; done
    fi
}
section() { # TITLE PAGE: the lines of that section, or all lines without a title
    awk -v title="$1" '/^\.SH / {on = title == "" || $0 == ".SH " title; next} on' "$2"
}
page_options() { # PAGE: the tags of its section OPTIONS
    section OPTIONS "$1" | awk '/^\.T[PQ]/ {getline; print}' | plain
}
plain() { sed "s/\\\\f[BIR]//g; s/\\\\-/-/g; s/\\\\&//g; s/\\\\(aq/'/g"; } # without fonts and escapes

# --- one page per command, with the purpose and the options of its help
"$program" --help >"$work/help"
for command in $(commands); do
    page=$manual/man1/cuvette-$command.1
    [[ -f $page ]]
    verdict $? "cuvette-$command(1) exists" || continue
    [[ -f $page ]] || continue
    purpose=$(sed -n "s/^  $command  *//p" "$work/help")
    empty "cuvette-$command(1) has the purpose of the help" \
        "$(diff <(echo "cuvette-$command - $purpose") <(section NAME "$page" | plain))"
    empty "cuvette-$command(1) has the options of the help" \
        "$(diff <(help_options "$command" | sort -u) <(page_options "$page" | sort -u))"
    "$program" "$command" --help | grep -E "cuvette(-$command)?\(1\)" >/dev/null
    verdict $? "cuvette $command --help names its page"
    for title in SYNOPSIS DESCRIPTION EXAMPLES "EXIT STATUS" "SEE ALSO"; do
        grep -qx "\.SH $title" "$page"
        verdict $? "cuvette-$command(1) has the section $title"
    done
done
for page in "$manual"/man1/cuvette-*.1; do
    command=$(basename "$page" .1)
    # a program, and a second word, with a page of its own
    [[ $command == cuvette-mpi || $command == cuvette-lens-report ]] ||
        commands | grep -x "${command#cuvette-}" >/dev/null
    verdict $? "$command(1) is the page of a command"
done
listed() { # the commands of cuvette(1) with their purposes
    section COMMANDS "$manual/man1/cuvette.1" | plain |
        awk '/^\.TP/ {getline tag; getline; gsub(/^cuvette-|\(1\)$/, "", tag); print tag, $0}'
}
empty "cuvette(1) lists the commands and their purposes" \
    "$(diff <(sed -n '/^Commands:/,/^$/s/^  \([a-z]*\)  */\1 /p' "$work/help") <(listed))"

# --- every page: clean roff, the program's version, references to existing pages
version=$("$program" --version | cut -d' ' -f2)
for page in "$manual"/man?/*; do
    file=$(basename "$page")
    name=${file%.*}
    label="$name(${file##*.})"
    title="^\.TH ${name^^} ${file##*.} [0-9-]{10} \"Cuvette ${version//./\\.}\" \"Cuvette Manual\"$"
    empty "$label has a title with its name, section and the version" \
        "$(grep -qE "$title" "$page" || grep '^\.TH' "$page")"
    if has groff "$label is clean for groff"; then
        empty "$label is clean for groff" "$(groff -man -Tutf8 -ww -z "$page" 2>&1)"
    fi
    if has mandoc "$label is clean for mandoc"; then
        empty "$label is clean for mandoc" "$(mandoc -Tlint -Wwarning "$page" 2>&1 | grep -v 'mandoc: outdated')"
    fi
    empty "the pages that $label names exist" "$(plain <"$page" | grep -oE 'cuvette(-[a-z]+)?\([1-8]\)' | sort -u |
        while IFS='()' read -r other number; do
            [[ -f $manual/man$number/$other.$number ]] || echo "$other($number)"
        done)"
    empty "$label has no line over 120 columns" \
        "$(plain <"$page" | awk '/^\.\\" begin/ {made = 1} /^\.\\" end/ {made = 0} !made && length > 120')"
done

# --- the examples, in a reader's folder, with small images and short studies
mkdir -p "$work/bin" "$work/lab"
ln -s "$program" "$work/bin/cuvette"
cp -r "$root/experiments" "$work/lab/"
export PATH=$work/bin:$PATH
cd "$work/lab" || exit 1
cat >experiments/depth.study <<'END'
study: depth
scene: scenes/rod.yaml
set: {render.width: 16, render.height: 12}
grid: [{render.depth: [0, 1]}]
repetitions: 6
keep: {image: on}
END
blocks() { # FILE: the lines of its examples, continued lines joined
    awk '/^\.EE/ {on = 0} on; /^\.EX/ {on = 1}' | plain | sed 's/\\e$/\\/' |
        sed -e ':a' -e '/\\$/{N; s/ *\\\n */ /; ba' -e '}'
}
small() { # a command line with small images of few paths and photons
    local less='--set=render.width=40 --set=render.height=30 --set=render.paths=2 --set=render.photons=2000'
    sed -E "s/^cuvette (render|animate) /cuvette \1 $less /
        s/^(cuvette animate .*)/\1 --duration 0.08/; s/ \| (jq|ffmpeg) .*//
        s/soup.count=[0-9]*/soup.count=20000/"
}
try() { # COMMAND LINE
    bash -c "set -e -o pipefail; $1" >said 2>&1 </dev/null
    verdict $? "$1" "$(<said)"
}
# --- cuvette(1) names every page
named=$(plain <"$manual/man1/cuvette.1")
empty "cuvette(1) names every page" "$(for page in "$manual"/man?/cuvette-*; do
    file=$(basename "$page")
    [[ $named == *"${file%.*}(${file##*.})"* ]] || echo "$file"
done)"

# The study in cuvette-tour(7).
sed 's/\\-/-/g' "$manual/man7/cuvette-tour.7" | awk '/^study: / {on = 1} /^\.EE/ {on = 0} on' >experiments/oils.study
tried=()
for page in "$manual"/man[157]/*; do
    title=EXAMPLES
    [[ $page == */cuvette-tour.7 ]] && title=
    while read -r line; do
        [[ " ${tried[*]} " != *" $line; "* ]] || continue
        tried+=("$line;")
        [[ $line != "cuvette lesson check" || ${CHECK:-} ]] || continue # tests/lesson/test_lesson.c measures them
        try "$line"
    done < <(section "$title" "$page" | blocks | grep -E '^(cuvette|cat|awk) ' | grep -v '^cuvette lab' | small)
done
empty "the study of cuvette-tour(7) kept an image of each of its eight cells" \
    "$(tail -n +2 results/oils/images/index.tsv | wc -l | grep -vx 8)"

conclude
