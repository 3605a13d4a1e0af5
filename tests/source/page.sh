#!/bin/bash
# The layers of the page (src/web/page): a module imports only from its own folder and those before it in `order`, the
# modules have no circle, and no folder has more than 60 files. Violations in a copy are detected. No browser.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit

order='shared view edit bench lessons studies .' # . is the page itself
most=60

# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-page.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# One line per import of a module: FILE TARGET, paths in the folder.
edges() {
    find . -name '*.js' -printf '%P\n' | sort | xargs awk "
        /^(import|\} from) .*'|^ *\(\) => import\('/ {
            split(\$0, part, \"'\")
            folder = FILENAME ~ /\\// ? FILENAME : \"\"
            sub(/[^\\/]*\$/, \"\", folder)
            target = part[2]
            if (!sub(/^\\.\\//, folder, target) && !(folder && sub(/^\\.\\.\\//, \"\", target)))
                target = \"not-relative:\" target
            print FILENAME, target
        }"
}

# Prints what violates the rules in the folder of a page.
violations() (
    cd "$1" || exit
    edges >"$work/edges"
    while read -r file target; do
        [[ -f $target ]] || echo "$file imports $target, which is not a file of the page"
    done <"$work/edges"
    awk -v order="$order" '
        function folder(path) { return path ~ /\// ? substr(path, 1, index(path, "/") - 1) : "." }
        BEGIN { for (i = split(order, name, " "); i; i--) place[name[i]] = i }
        {
            a = folder($1); b = folder($2)
            if (!(a in place)) print $1 " is in a folder without a place in the order of tests/source/page.sh"
            else if (b in place && place[b] > place[a])
                print $1 " imports " $2 ": " b " comes after " a
        }' "$work/edges"
    tsort "$work/edges" 2>&1 >/dev/null | sed -n 's/^tsort: \([^ ]*\.js\)$/\1 is in a circle of imports/p'
    for folder in $order; do
        count=$(find "$folder" -maxdepth 1 -type f | wc -l)
        ((count <= most)) || echo "$folder has $count files, more than $most"
    done
)

# planted FILE LINE EXPECTED: a copy of the page in which FILE begins with LINE is refused with that text.
planted() {
    rm -rf "$work/page"
    cp -r src/web/page "$work/page"
    sed -i "1i $2" "$work/page/$1" 2>/dev/null || echo "$2" >"$work/page/$1"
    local found
    found=$(violations "$work/page")
    [[ $found == *"$3"* ]]
    verdict $? "refused: $3" "$found"
}

empty 'each module imports only from its folder and those before it, without circles' "$(violations src/web/page)"
planted shared/vectors.js "import { x } from '../view/view.js';" \
    'shared/vectors.js imports view/view.js: view comes after'
planted bench/fan.js "import { x } from '../main.js';" 'bench/fan.js imports main.js: . comes after bench'
planted shared/numbers.js "import { x } from './ui.js';" 'shared/numbers.js is in a circle of imports'
planted view/view.js "} from '../shared/none.js';" \
    'view/view.js imports shared/none.js, which is not a file of the page'
planted head.js "import { x } from 'https://x.org/x.js';" \
    'head.js imports not-relative:https://x.org/x.js, which is not'
for number in {1..60}; do echo >"$work/file$number"; done
rm -rf "$work/page" && cp -r src/web/page "$work/page" && cp "$work"/file* "$work/page/lessons"
found=$(violations "$work/page")
[[ $found == "lessons has "*" files, more than 60" ]]
verdict $? 'refused: a folder of more than 60 files' "$found"
conclude
