#!/bin/bash
# The catalogues of the page's languages have each text that the page shows and no others, with the same holes and the
# plural forms of the language; texts with values are whole ones; errors in a copy are found. No browser.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit
program=${CUVETTE:-$PWD/build/cuvette}

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-texts.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

empty 'the catalogues have the texts of page, parameters, shapes and lessons' \
    "$(python3 -B tests/source/texts.py check "$program" 2>&1)"

mkdir -p "$work/tests/source" "$work/experiments" "$work/src/geometry" "$work/src/realism" "$work/src/web"
cp tests/source/texts.py "$work/tests/source"
cp -r experiments/lessons "$work/experiments"
cp -r src/geometry/shapes "$work/src/geometry"
cp src/realism/realism.c "$work/src/realism"
cp -r src/web/page "$work/src/web"
cat >>"$work/src/web/page/keys.js" <<'END'
button('A planted label', act);
const planted = `The text of ${name} is planted`;
END
sed -i -e 's/^{$/{\n"Nothing shows this": "x",/' -e 's/"Undo": "\([^"]*\)"/"Undo": "\1 {hole}"/' \
    "$work/src/web/page/languages/de.json"
found=$(python3 -B "$work/tests/source/texts.py" check "$program")
for expected in "de.json has no translation of 'A planted label'" "'The text of {} is planted' is not one text" \
    "nothing shows: 'Nothing shows this'" "'Undo' is empty or has other holes"; do
    [[ $found == *"$expected"* ]]
    verdict $? "found: $expected" "$found"
done
conclude
