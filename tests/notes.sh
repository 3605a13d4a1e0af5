#!/bin/bash
# Scenes with one typical mistake each: `cuvette scene --check` prints one note with a remedy, at the place in the
# second line of the scene. Prints the notes as well. CUVETTE names the program.
set -uo pipefail
cd "$(dirname "$0")/.."
cuvette=${CUVETTE:-build/cuvette}
number=0 failed=0

for scene in tests/data/lint/*.yaml; do
    number=$((number + 1))
    name=$(basename "$scene" .yaml)
    place=$(sed -n '2s/^# note: //p' "$scene")
    notes=$("$cuvette" scene --check "$scene" 2>&1 >/dev/null)
    if [[ $place && $(wc -l <<<"$notes") == 1 && $notes == "cuvette: note: $place: "*"; "* ]]; then
        echo "ok $number - $name"
    else
        echo "not ok $number - $name: expected one note on $place"
        failed=1
    fi
    sed -n '1s/^# /#   /p' "$scene"
    sed "s/^cuvette: note: /#   -> /" <<<"$notes"
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
expect() { # expect NAME COUNT OUTPUT: the number of notes on the depth in the output
    number=$((number + 1))
    if [[ $(grep -c '^cuvette: note: render\.depth: ' <<<"$3") == "$2" ]]; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1: expected $2 notes"
        sed 's/^/# /' <<<"$3"
        failed=1
    fi
}
study() { # study GRID [OPTION]: the output of the study
    printf 'study: t\nscene: %s\ngrid:\n  - {%s}\nrepetitions: 1\n' "$PWD/tests/data/lint/shallow.yaml" "$1" \
        >"$folder/t.study"
    "$cuvette" study run --results "$folder/$RANDOM" "$folder/t.study" ${2-} 2>&1
}
expect 'a render prints the note on the depth' 1 \
    "$("$cuvette" render tests/data/lint/shallow.yaml -o "$folder/a.png" 2>&1)"
expect 'a render with --json prints no note' 0 "$("$cuvette" render tests/data/lint/shallow.yaml --json 2>&1)"
expect 'a study prints the note once' 1 "$(study 'render.threads: [1, 2]')"
expect 'a study that varies the depth prints no note' 0 "$(study 'render.depth: [1, 2]')"
expect 'a study with -q prints no note' 0 "$(study 'render.threads: [1, 2]' -q)"
echo "1..$number"
exit $failed
