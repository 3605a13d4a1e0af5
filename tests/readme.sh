#!/bin/bash
# The documents against the project: linked files exist, the commands of README.md work as printed, and
# results/README.md describes every column that a study writes. tests/readme.sh [PROGRAM]; needs the compiler (CC) for
# tests/json_get.c. One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-readme.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
unset CUVETTE_ISA NO_COLOR

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

# --- named files: links and images relative to the page's folder, `src/...` and similar paths relative to the root
links() { # PAGE: targets of links, except on the web and within the page
    grep -o '](\([^)]*\))' "$1" | sed 's/^](//; s/[)#].*$//' | grep -v -e '^[a-z]*:' -e '^$' | sort -u
}
words() { # PAGE
    # shellcheck disable=SC2016
    grep -oE '`(src|experiments|plots|tests|paper)(/[A-Za-z0-9_./-]*)?`' "$1" | tr -d '`' | sort -u
}
has_reference=0
for file in "$root"/results/reference/*; do [[ -e $file ]] && has_reference=1; done
pages=(README.md CONTRIBUTING.md src/web/README.md results/README.md experiments/published/README.md
    src/manual/site/gallery.md)
for page in "${pages[@]}"; do
    lost=
    while read -r target; do
        [[ -e $root/$(dirname "$page")/$target ]] && continue
        if [[ $target == *reference/* ]] && ((!has_reference)); then
            skip "$page: $target, there is no reference run yet"
        else
            lost+="${lost:+$'\n'}$target"
        fi
    done < <(links "$root/$page")
    empty "the linked files of $page exist" "$lost"
    lost=
    while read -r target; do
        [[ -e $root/$target ]] || lost+="${lost:+$'\n'}$target"
    done < <(words "$root/$page")
    empty "the files named by $page exist" "$lost"
done
# shellcheck disable=SC2016
empty "the README names the two commands" \
    "$(for line in 'make setup experiments' 'make setup test'; do grep -qE "^    $line( |$)" "$root/README.md" ||
        echo "$line"; done)"

# --- a reader's folder: studies and scenes, with the program in PATH
mkdir -p "$work/bin" "$work/lab"
ln -s "$program" "$work/bin/cuvette"
cp -r "$root/experiments" "$work/lab/"
"${CC:-gcc}" -std=gnu17 -o "$work/bin/json_get" "$root/tests/json_get.c" $(pkg-config --cflags --libs jansson)
verdict $? "tests/json_get.c compiles"
export PATH=$work/bin:$PATH
export CUVETTE_LIVE=$work/live.html # the laboratory in one file, which the build need not have
echo '<!doctype html><html><head></head><body></body></html>' >"$CUVETTE_LIVE"
cd "$work/lab" || exit 1

try() { # COMMAND LINE: passes when it succeeds; its output is in said
    bash -c "set -e -o pipefail; $1" >said 2>&1 </dev/null
    verdict $? "$1" "$(<said)"
}
# The fast commands of README.md and the gallery, without the part after a |, whose program may be missing.
while read -r line; do
    try "${line%% | *}"
done < <(sed -n \
    's/^    \(cuvette \(render\|fan\|trace\|realism\).*\)/\1/p' \
    "$root/README.md" "$root/src/manual/site/gallery.md" | sed 's/ *#.*//' | awk '!seen[$0]++' |
    sed "s/ render / render --set=render.width=160 --set=render.height=120 /")

# --- the dictionary against the files of a study; a name with <...> represents several columns
cat >experiments/columns.study <<'END'
study: columns
scene: scenes/rod.yaml
set: {render.width: 16, render.height: 12}
grid: [{render.depth: [0, 1]}]
repetitions: 1
keep: {image: on, workers: on}
END
cuvette study run --quiet experiments/columns.study
cuvette study summary experiments/columns.study >summary.tsv
described() { # SECTION: first column of its table
    awk -v title="## $1" '/^## / {on = $0 == title} on && /^\| `/' "$root/results/README.md" |
        sed -n 's/^| \(`[^|]*\) |.*/\1/p' | sed 's/^| *//' | cut -d'|' -f1 | tr -d '` ' | tr ',' '\n'
}
written() { # FILE SEPARATOR: the columns of its header, one per line, with the dictionary's <...> names
    head -1 "$1" | tr "$2" '\n' | sed \
        's/^render\.depth$/<axis>/; s/hits\.\(ground\|vessel\|liquid\|rod\)$/hits.<solid>/' | uniq
}
compare() { # SECTION NAMES: the dictionary has the same columns in the same order
    empty "results/README.md has the columns of $1" "$(diff <(described "$1") <(echo "$2"))"
}
folder=results/columns
compare rows.csv "$(written $folder/rows.csv ,)"
compare workers.csv "$(written $folder/workers.csv ,)"
compare 'tables/<study>.tsv' "$(written summary.tsv '\t')"
compare images/index.tsv "$(written $folder/images/index.tsv '\t')"
recorded() { json_get $folder/runs.json "$1@keys" | sed "s/^/$2/"; }
compare runs.json "$(
    echo schema
    recorded study study.
    recorded machine machine.
    recorded 'runs[0]' 'runs[].'
)"
empty "runs.json has no other part" \
    "$(json_get $folder/runs.json @keys | grep -vx -e schema -e study -e machine -e runs)"

conclude
