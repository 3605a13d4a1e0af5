#!/bin/bash
# The instructions that the program executes for the frames of frames.txt, counted by valgrind: the same number within
# 0.03 %, whatever else the machine does, so that a loss of 1 % is seen which no clock shows (make instructions).
#   instructions.sh            compare with table.tsv; status 1 if a frame needs over 1 % more
#   instructions.sh --renew    write the numbers of this compiler and C library into table.tsv
# table.tsv has lines of compiler and C library, frame, instructions. With others, the program of the commit before
# (PARENT, default HEAD^) is built and counted instead. A commit that raises a number of the table by over 1 % says why,
# in a line of its body that begins with "Instructions:".
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$(realpath "${CUVETTE:-build/cuvette}") cc=${CC:-gcc} parent=${PARENT:-HEAD^}
table=tests/instructions/table.tsv most=1.01
command -v valgrind >/dev/null || {
    echo 'instructions: valgrind is not installed; run: make setup-instructions' >&2
    exit 2
}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-instructions.XXXXXX")
trap 'rm -rf "$work"; git worktree prune' EXIT
key="$($cc --version | sed -n '1s/ (.*) / /p') glibc-$(ldd --version | sed -n '1s/.* //p')"

# A cube of a thousand balls of glass and clay.
awk 'BEGIN {
    print "render: {width: 160, height: 120, depth: 4}"
    print "camera: {position: [-6, 7, -16], target: [0, 0, 0], fov_deg: 45}"
    print "materials: {glass: {transparency: 1, ior: 1.5}, clay: {color: [0.8, 0.5, 0.3], diffuse: 0.8}}"
    print "lights: {lamp: {position: [10, 20, -10]}}"
    print "solids:"
    for (i = 0; i < 1000; i++)
        printf "  ball%d: {shape: sphere, radius: 0.35, position: [%d, %d, %d], material: %s}\n", i, i % 10 - 5,
            int(i / 10) % 10 - 5, int(i / 100) - 5, i % 3 ? "clay" : "glass" }' >"$work/spheres.yaml"

# count PROGRAM: lines of frame and instructions, two frames at a time.
count() {
    local name arguments
    grep -v '^#' tests/instructions/frames.txt | while read -r name arguments; do
        printf '%s\0%s\0' "$name" "${arguments//SPHERES/$work/spheres.yaml}"
    done | PROGRAM=$1 WORK=$work xargs -0 -n 2 -P "$(nproc)" bash -c '
        read -ra words <<<"$2"
        export CUVETTE_ISA=avx2 CUVETTE_CALLGRIND=$WORK/none
        said=$(valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null \
            "$PROGRAM" render "${words[@]}" --set render.threads=1 -o "$WORK/$1.pfm" 2>&1 >/dev/null) || {
            echo "$said" >&2
            exit 1
        }
        printf "%s\t%s\n" "$1" "$(sed -n "s/,//g; s/.*I *refs: *//p" <<<"$said")"' count | sort
}
known() { awk -F '\t' -v OFS='\t' -v key="$key" '$1 == key { print $2, $3 }' "$1" | sort; }

count "$program" >"$work/now"
[[ $(wc -l <"$work/now") == $(grep -cv '^#' tests/instructions/frames.txt) ]] || {
    echo 'instructions: a frame of frames.txt has no count' >&2
    exit 1
}
if [[ ${1:-} == --renew ]]; then
    {
        grep -vF "$key"$'\t' "$table" 2>/dev/null || true
        sed "s/^/$key\t/" "$work/now"
    } >"$work/table"
    mv "$work/table" "$table"
    echo "$table has the numbers of $key"
    exit
fi
known "$table" >"$work/before"
what="table.tsv, $key"
if [[ ! -s $work/before ]]; then
    what="the program of $parent: table.tsv has no numbers of $key"
    git worktree add -q --detach "$work/parent" "$parent"
    make -s -C "$work/parent" build/cuvette
    count "$work/parent/build/cuvette" >"$work/before"
    git worktree remove --force "$work/parent"
elif ! git diff --quiet HEAD -- "$table" 2>/dev/null || git diff --quiet "$parent" HEAD -- "$table" 2>/dev/null; then
    : # not changed by the last commit
else
    git show "$parent:$table" >"$work/older" 2>/dev/null && known "$work/older" >"$work/old" || : >"$work/old"
    raised=$(join -t $'\t' "$work/old" "$work/before" | awk -F '\t' -v most=$most '$3 > most * $2 { print $1 }')
    if [[ $raised ]] && ! git log -1 --format=%b | grep -q '^Instructions: '; then
        echo "instructions: table.tsv raises ${raised//$'\n'/, }: say why in the commit's body," \
            "in a line 'Instructions: ...'" >&2
        exit 1
    fi
fi
new=$(join -t $'\t' -v 2 "$work/before" "$work/now" | cut -f 1)
[[ ! $new ]] || {
    echo "instructions: there is no number of ${new//$'\n'/, } to compare with; write it (--renew)" >&2
    exit 1
}
echo "Instructions, compared with $what"
join -t $'\t' "$work/before" "$work/now" | awk -F '\t' -v most=$most '
    { worse = $3 > most * $2
      printf "%-8s %14.0f %14.0f  %+.2f %%%s\n", $1, $2, $3, 100 * ($3 / $2 - 1), worse ? "  more than 1 %" : ""
      bad += worse }
    END { exit bad > 0 || !NR }' || {
    echo 'instructions: a frame needs over 1 % more; make the program faster, or renew the table and say why' \
        '(tests/instructions/instructions.sh --renew)' >&2
    exit 1
}
