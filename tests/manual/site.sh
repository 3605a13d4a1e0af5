#!/bin/bash
# The laboratory of the static site (make site): what src/web/site/build.py makes of a small module in the place of the
# engine: complete, relative addresses only, and refused above the bound of bytes. Skipped without esbuild.
# tests/web/site.test.mjs opens the real one.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
for tool in python3 esbuild; do
    command -v "$tool" >/dev/null || {
        echo "# skipped: $tool is not installed; run: make setup-site"
        exit 77
    }
done
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-site.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
build() { python3 -B "$root/src/web/site/build.py" "$work/wasm" "$1" 2>&1; }

said=$(build "$work/none")
grep -q 'worker.js does not exist; run: make wasm' <<<"$said"
verdict $? 'without the engine it says how to make it' "$said"

for set in simd128 plain; do
    mkdir -p "$work/wasm/$set"
    echo 'onmessage = () => {};' >"$work/wasm/$set/worker.js"
    printf '\0asm\1\0\0\0' >"$work/wasm/$set/cuvette.wasm"
done
site=$work/site
said=$(cd "$work" && build "$site")
verdict $? 'the laboratory is built, from any folder' "$said"
grep -qE '^  laboratory/engine/plain/cuvette.wasm.packed +[0-9]+ +[0-9]+$' <<<"$said"
verdict $? 'the sizes are printed' "$said"
build "$work/again" >/dev/null
empty 'the same sources give the same bytes' "$(diff -r "$site" "$work/again" 2>&1)"
empty 'no file names a folder of this machine' "$(grep -rlF -e "$root" -e "$work" "$site")"
empty 'addresses are relative' "$(grep -oE '<(script|link|img|a|iframe) [^>]*(src|href)="(/|[a-z]+:)[^"]*"' \
    "$site/laboratory/index.html" "$site/laboratory.html" | grep -vE '(src|href)="data:image/')"
empty 'one file loads nothing' "$(grep -oE '<(script|link)[^>]* (src|href)="[^"]*"' "$site/laboratory.html" |
    grep -v 'href="data:')"
empty 'the files are those of the experiments' "$(
    python3 - "$site" "$root/experiments" <<'END'
import base64, json, pathlib, sys
packed = json.loads((pathlib.Path(sys.argv[1]) / "laboratory/engine/files.json").read_text())
root = pathlib.Path(sys.argv[2])
for name, content in packed.items():
    text = content.encode() if isinstance(content, str) else base64.b64decode(content["base64"])
    if text != (root / name).read_bytes():
        print(name, "differs")
wanted = [*root.glob("scenes/*.yaml"), *root.glob("lessons/*.lesson"), *root.glob("hands/*.yaml")]
wanted.append(root / "scenes/chequer.png")
print(*(path.name for path in wanted if str(path.relative_to(root)) not in packed), sep="\n", end="")
END
)"
empty 'every style sheet of the page is in it' "$(for sheet in "$root"/src/web/page/{,*/}*.css; do
    name=$(grep -om1 -- '^\.[a-z-]*' "$sheet" | head -n 1)
    grep -qF -- "$name" "$site/laboratory/index.html" || echo "${sheet##*/}"
done)"

head -c 4000000 /dev/urandom >"$work/wasm/plain/cuvette.wasm"
said=$(build "$work/large")
[[ $? == 1 && $said == *'bytes are loaded before the first image, more than 3,000,000'* ]]
verdict $? 'too many bytes are refused' "$said"

conclude
