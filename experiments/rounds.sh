# shellcheck shell=bash
# rounds.sh - sourced by bench.sh: a folder for the work of benches, the values of contestants that take turns, and
# lines of medians and ratios over the rounds.
export LC_ALL=C
name=${0##*/}
order=$(<"$(dirname "${BASH_SOURCE[0]}")/order.awk")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

need() { # need PROGRAM HOW-TO-GET-IT
    command -v "$1" >/dev/null || {
        echo "$name: no program $1; $2" >&2
        exit 2
    }
}
failed() { # failed WHAT LOG
    echo "$name: $1 failed: $(tail -n 1 "$2")" >&2
    exit 1
}
# field NAME < JSON: the first number with that name
field() { sed -e "s/^ *\"$1\": *\([-0-9.eE+]*\),*$/\1/" -e 't found' -e d -e ':found' -e q; }
note() { # note CONTESTANT VALUE...: a line of values, one a round
    local IFS=$'\t'
    printf '%s\n' "${*:2}" >>"$work/$1"
}
# traced CONTESTANT CLOCK PROGRAM SCENE [ARGUMENT...]: notes seconds and rays of a frame of $size
traced() {
    "$3" render "$4" --json --set "render.width=${size%x*}" --set "render.height=${size#*x}" "${@:5}" >"$work/json"
    note "$1" "$(field "$2" <"$work/json")" "$(field total <"$work/json")"
}
seconds() { # seconds COMMAND...: wall time of a whole process
    local from=$EPOCHREALTIME
    "$@" >"$work/out" 2>"$work/err" || failed "$1" "$work/err"
    awk -v from="$from" -v to="$EPOCHREALTIME" 'BEGIN { printf "%.6f\n", to - from }'
}
# median CONTESTANT COLUMN
median() { awk -F'\t' -v c="$2" "$order"'{ list = list " " $c } END { print median(list) }' "$work/$1"; }
# row CONTESTANT EXPRESSION WHAT: median and range, over the rounds, of an awk expression of a line's values
row() {
    [ -s "$work/$1" ] || return 0
    awk -F'\t' -v what="$3" "$order"'{ list = list " " ('"$2"') } END { summary(what, list) }' "$work/$1"
}
# ratio A B WHAT [EXPRESSION]: the same of the ratio of two contestants, of their first values or of an expression
ratio() {
    [ -s "$work/$1" ] && [ -s "$work/$2" ] || return 0
    paste <(awk -F'\t' "{ print ${4:-\$1} }" "$work/$1") <(awk -F'\t' "{ print ${4:-\$1} }" "$work/$2") |
        awk -F'\t' -v what="$3" "$order"'$1 != "" && $2 != "" { list = list " " $1 / $2 } END { summary(what, list) }'
}
# random_scenes WORST < LINES: median and worst of a line of row or ratio a random scene; WORST is low or high
random_scenes() {
    awk -v worst="$1" "$order"'{ sub(/ *\(.*/, ""); list = list " " $NF }
        END { n = sorted(list, v); if (n) printf "%66s %8.3f   (%d scenes, worst %.3f)\n", "random scenes, median",
            median(list), n, v[worst == "low" ? 1 : n] }'
}
# spheres SEED SOLIDS LIGHTS: the path of a random scene (random_scene.awk); seed 1 is the one that has a name. Over
# 10^5 equal spheres are a cloud, because a solid that is written by itself takes ten times the memory.
spheres() {
    local scene=$work/scene-$1-$2-$3.yaml cloud=
    (($1 != 1 || $2 <= 100000)) || cloud=${scene%.yaml}.xyz
    [ -s "$scene" ] || awk -v seed="$1" -v solids="$2" -v lights="$3" -v cloud="$cloud" \
        -f "$here/random_scene.awk" >"$scene"
    echo "$scene"
}
