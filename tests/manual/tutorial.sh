#!/bin/bash
# The exercises of cuvette-tutorial(7): every command of the page is run and prints what the page shows, and every value
# that the page computes by hand follows from its formula and is in that output. tutorial.sh [PROGRAM].
# A line '.\" expect VALUE FORMULA' before an example gives the value as the text has it (in bold), and its closed form.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
page=$root/src/manual/man7/cuvette-tutorial.7
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-tutorial.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset CUVETTE_ISA NO_COLOR

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
plain() { sed "s/\\\\-/-/g; s/\\\\(aq/'/g; s/\\\\(ha/^/g; s/\\\\(ti/~/g; s/\\\\e/\\\\/g"; }

functions='function asin(x) {return atan2(x, sqrt(1 - x * x))}
    function deg(x) {return x * 45 / atan2(1, 1)}
    function rad(x) {return x * atan2(1, 1) / 45}'
decimals() { # NUMBER: its number of decimals
    local digits=${1#*.}
    echo ${#digits}
}
is_closed_form() { # VALUE FORMULA
    [[ $(awk "$functions BEGIN {printf \"%.$(decimals "$1")f\", $2}") == "$1" ]]
}
is_printed() { # VALUE TEXT: a number of the text, or its magnitude, rounds to the value
    local number
    for number in $(grep -oE '[0-9]+(\.[0-9]+)?' <<<"$2"); do
        [[ $(printf "%.$(decimals "$1")f" "$number") == "$1" ]] && return
    done
    return 1
}

mkdir "$work/bin" "$work/lab"
ln -s "$program" "$work/bin/cuvette"
ln -s "$root/experiments" "$work/lab/experiments"
export PATH=$work/bin:$PATH LC_ALL=C
cd "$work/lab" || exit 1

# The commands start in a locale with a decimal comma, if it can be made.
mkdir "$work/locales"
foreign=C
localedef -i de_DE -f UTF-8 "$work/locales/de_DE.UTF-8" 2>/dev/null && foreign=de_DE.UTF-8
export LOCPATH=$work/locales
expected=() command='' shown='' printed='' exports=''
finish() { # runs the command and compares its output with the lines below it
    [[ -n $command ]] || return
    local output
    [[ $command != export* ]] || exports+="$command;"
    output=$(LC_ALL=$foreign bash -o pipefail -c "$exports$command" 2>&1 </dev/null)
    verdict $? "$command" "$output"
    [[ $output == "${shown%$'\n'}" ]]
    verdict $? "$command prints the output on the page" "$(diff <(echo "${shown%$'\n'}") <(echo "$output"))"
    printed+=$output$'\n'
    command='' shown=''
}
inside=0 commands=0
while IFS= read -r line; do
    case $line in
    '.\" expect '*) expected+=("${line#'.\" expect '}") ;;
    .EX) inside=1 printed='' ;;
    .EE)
        finish
        inside=0
        for value in "${expected[@]}"; do
            is_closed_form "${value%% *}" "${value#* }"
            verdict $? "${value%% *} is ${value#* }"
            grep -qF -- "\\fB${value%% *}\\fR" "$page"
            verdict $? "the page has ${value%% *} as a value computed by hand"
            is_printed "${value%% *}" "$printed"
            verdict $? "${value%% *} is traced" "$printed"
        done
        expected=()
        ;;
    '$ '*)
        ((inside)) || continue
        finish
        commands=$((commands + 1))
        command=$(plain <<<"${line#'$ '}")
        ;;
    *) ((inside)) && shown+=$(plain <<<"$line")$'\n' ;;
    esac
done <"$page"
((commands > 0))
verdict $? "the page has commands"
by_hand=$(grep -oE '\\fB[0-9]+\.[0-9]+\\fR' "$page" | sort -u | wc -l)
checked=$(sed -n 's/^\.\\" expect \([^ ]*\) .*/\1/p' "$page" | sort -u | wc -l)
((by_hand == checked))
verdict $? "every value computed by hand has a formula" "$by_hand values, $checked formulas"

conclude
