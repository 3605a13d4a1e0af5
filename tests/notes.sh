#!/bin/bash
# Scenes that a student would write, each with one mistake: `cuvette scene --check` has one note for each, at the place that the scene's second
# line names, and a remedy. `bash tests/notes.sh` prints what it says of them. CUVETTE: the program.
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
        echo "not ok $number - $name: wanted one note on $place"
        failed=1
    fi
    sed -n '1s/^# /#   /p' "$scene"
    sed "s/^cuvette: note: /#   -> /" <<<"$notes"
done
echo "1..$number"
exit $failed
