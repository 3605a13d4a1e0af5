#!/bin/bash
# The documentation as HTML (make doc): complete, well formed, every link and anchor leads somewhere, nothing is loaded
# from elsewhere; with CHECK=1 also the same bytes twice, and next to a laboratory. doc.sh [PROGRAM]; skipped
# without the tools of make setup-doc.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
pages=$(realpath "${BUILD:-$root/build}/man")
for tool in python3 mandoc cmark-gfm; do
    command -v "$tool" >/dev/null || {
        echo "# skipped: $tool is not installed; run: make setup-doc"
        exit 77
    }
done
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-doc.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
site=$work/site

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
build() { python3 -B "$root/src/manual/site/build.py" "$program" "$pages" "$1" 2>&1; }
check() { python3 -B "$root/tests/source/doc_check.py" "$1" 2>&1; }

said=$(cd "$work" && TZ=Asia/Tokyo LC_ALL=C build "$site")
verdict $? 'the site is built, from any folder' "$said"
empty 'pages are well formed and complete, links and anchors resolve' "$(check "$site")"

# --- complete: every source has a page that says what it says
missing() { # FILE...: those that are not in the site
    local file
    for file in "$@"; do [[ -s $site/$file ]] || echo "$file"; done
}
mapfile -t manual < <(cd "$root/src/manual" && basename -a man?/*)
empty "each of ${#manual[@]} manual pages has a page" "$(missing "${manual[@]/%/.html}")"
mapfile -t commands < <("$program" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/cuvette-\1.1.html/p')
empty "each of ${#commands[@]} commands of the program has a page" "$(missing "${commands[@]}")"
mapfile -t lessons < <(sed -n 's/^lesson: *\(.*\)/lesson-\1.html/p' "$root"/experiments/lessons/*.lesson)
empty "each of ${#lessons[@]} lessons has a page" "$(missing "${lessons[@]}")"
empty 'each function and type of cuvette.h has an anchor' "$(grep -oE \
    '^(CUVETTE_API .*|typedef (struct|enum) )cuvette_[a-z0-9_]+' "$root/src/cuvette.h" | grep -oE '[a-z0-9_]+$' |
    sort -u | while read -r name; do grep -qF "id=\"$name\"" "$site/engine-api.html" || echo "$name"; done)"
gallery=$site/gallery.html
empty 'the gallery has every image of the README, every view and every figure' "$(
    cd "$root" && {
        grep -o '](\([^)]*\.\(png\|jpg\|svg\)\))' README.md | sed 's/^](//; s/)$//'
        printf '%s\n' src/web/views/* results/reference/figures/*.{png,svg}
    } | tr / - | sort -u | while read -r name; do grep -qF "images/$name" "$gallery" || echo "$name"; done
)"
grep -qF 'href="cuvette-scene.5.html"><b>cuvette-scene</b>(5)</a>' "$site/cuvette-render.1.html"
verdict $? 'a manual page that is named is a link'
grep -qF 'href="engine-api.html#cuvette_scene_get"' "$site/engine-api.html"
verdict $? 'a function that is named is a link'
empty 'no page names a folder of this machine' "$(grep -rlF -e "$root" -e "$work" "$site")"

if [[ ${CHECK:-} ]]; then
    # --- reproducible
    build "$work/again" >/dev/null
    empty 'the same sources give the same bytes' "$(diff -r "$site" "$work/again" 2>&1)"

    # --- with a laboratory: lessons and scenes of the gallery open in it
    with=$work/with
    mkdir "$with.laboratory" && touch "$with.laboratory/index.html"
    python3 -B "$root/src/manual/site/build.py" "$program" "$pages" "$with" laboratory/ >/dev/null
    mv "$with.laboratory" "$with/laboratory"
    empty 'with a laboratory, links and anchors resolve' "$(check "$with")"
    empty 'each lesson opens in the laboratory' "$(for lesson in "${lessons[@]}"; do
        name=${lesson#lesson-}
        grep -qF "href=\"laboratory/#lesson=${name%.html}\"" "$with/$lesson" || echo "$lesson"
    done)"
    grep -qF 'href="laboratory/?scene=scenes/rod.yaml"' "$with/gallery.html"
    verdict $? 'a scene of the gallery opens in the laboratory'
    code=$(grep -A3 'rod.yaml -o tea.png' "$with/gallery.html" | grep -o '#scene=[A-Za-z0-9_-]*')
    "$program" scene "$code" 2>/dev/null | grep -q 'ior: 1.47'
    verdict $? 'a scene with changed parameters opens with them' "$code"
    grep -qF 'class="open" href="laboratory/"' "$with/index.html"
    verdict $? 'the first page leads to the laboratory'
fi
empty 'without a laboratory no page leads to one' "$(grep -l 'href="laboratory/' "$site"/*.html)"

# --- the checks find what they look for
broken=$work/broken
cp -rl "$site" "$broken" # sed -i makes files of its own

breakage() { # FILE SCRIPT FAULT: after sed SCRIPT, FAULT is to be reported
    sed -i -E "$2" "$broken/$1"
    faults+=("$1: $3")
}
faults=()
breakage index.html 's|href="cuvette-lab.1.html"|href="lost.html"|' 'the link lost.html leads nowhere'
breakage engine-api.html 's|href="#errors"|href="#lost"|' 'the anchor #lost does not exist'
breakage first-steps.html 's|src="images/[^"]*rod.png"|src="/usr/x.png"|' '/usr/x.png is not in this folder'
breakage lessons.html 's|href="style.css"|href="https://x.org/x.css"|' 'https://x.org/x.css is not in this folder'
breakage changelog.html 's|<h1>|<h1><img src="images/src-web-views-gallery.jpg" alt="">|' \
    'the image images/src-web-views-gallery.jpg has no alternative text'
breakage cuvette.1.html '0,/<\/b>/s|</b>||' '</nav> closes <b>'
breakage LICENSE.html 's|href="LICENSE.html"||' 'no page links to it'
sed -i 's|href="LICENSE.html"|href="first-steps.html"|' "$broken"/*.html
said=$(check "$broken")
for fault in "${faults[@]}"; do
    grep -qF -- "${fault#*: }" <<<"$(grep -F "${fault%%: *}: " <<<"$said")"
    verdict $? "a fault is found: $fault" "$said"
done

mkdir "$work/full" && touch "$work/full/mine"
said=$(build "$work/full")
[[ $? == 1 && $said == "doc: $work/full is not empty; give a new folder" && -e $work/full/mine ]]
verdict $? 'a folder with files is not overwritten' "$said"

conclude
