#!/bin/bash
# `cuvette scene --export`: every shipped scene in every format; what is refused; files that appear complete or not at
# all. With POV-Ray installed it reads the scenes, too; without it, brackets and texts are counted. export.sh [PROGRAM]
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-export.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export LC_ALL=C
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
scenes=$root/experiments/scenes

# Brackets that do not match, outside of comments and texts.
unbalanced() { # FILE
    awk '{ sub(/\/\/.*/, ""); gsub(/"([^"\\]|\\.)*"/, "")
            while (match($0, /[][{}()<>]/)) {
                c = substr($0, RSTART, 1); $0 = substr($0, RSTART + 1)
                if (c ~ /[[{(<]/) open[++depth] = c
                else if (depth < 1 || open[depth--] != substr("[{(<", index("]})>", c), 1)) { bad = 1; exit }
            } }
        END { exit !(bad || depth) }' "$1"
}
reads() { # FILE.pov: by POV-Ray, in a small image
    (cd "$(dirname "$1")" && povray "+I$(basename "$1")" +Onone.png +W16 +H12 -D -A -J -V) >povray.log 2>&1 ||
        grep -iE 'error' povray.log | head -n 3
}

for scene in "$scenes"/*.yaml; do
    name=$(basename "$scene" .yaml) wrong=
    for ending in pov gltf glb; do
        "$program" scene "$scene" --set render.width=80 --set render.height=60 --export "$name.$ending" 2>notes
        code=$?
        ((code == 0)) || wrong+="$ending: exit $code, $(grep -v note: notes | head -c 200); "
        ! grep -qv '^cuvette: note: ' notes || wrong+="$ending: $(grep -v '^cuvette: note: ' notes | head -n 1); "
        [[ -s $name.$ending ]] || wrong+="$ending: no file; "
    done
    # each note is in the file
    while read -r note; do
        grep -qF "// - ${note#cuvette: note: }" "$name.pov" || wrong+="not in the file: $note; "
    done < <("$program" scene "$scene" --export "$name.pov" 2>&1)
    ! unbalanced "$name.pov" || wrong+="brackets; "
    ! command -v povray >/dev/null || wrong+=$(reads "$name.pov")
    python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$name.gltf" || wrong+="no JSON; "
    empty "exported: $name" "$wrong"
    rm -f "$name".*
done
command -v povray >/dev/null || skip "POV-Ray, which is not installed (make setup-peers), has not read the scenes"

refused() { # WHAT PATTERN ARGUMENT...
    local what=$1 pattern=$2 wrong=
    shift 2
    "$program" scene "$@" >out 2>err
    code=$?
    ((code == 2)) || wrong="exit $code; "
    grep -qE "$pattern" err || wrong+=$(head -c 300 err)
    [[ ! -s out && $(wc -l <err) == 1 ]] || wrong+="$(wc -l <err) lines"
    empty "refused: $what" "$wrong"
}
cp "$scenes/rod.yaml" rod.yaml
refused "another ending" 'use a name that ends in .pov, .gltf or .glb' rod.yaml --export rod.obj
refused "standard output" 'use a name that ends in .pov, .gltf or .glb' rod.yaml --export -
refused "a folder that does not exist" 'the folder does not exist' rod.yaml --export no/rod.pov
refused "together with -o" 'remove -o FILE' rod.yaml --export rod.pov -o a.yaml
refused "together with --list" 'use only one of them' rod.yaml --export rod.pov --list
"$program" mesh --generate icosphere --level 1 -o ball.glb 2>/dev/null
printf 'meshes: {b: {file: ball.glb}}\nsolids: {a: {shape: mesh, mesh: b}}\n' >mesh.yaml
refused "a file that the scene reads" 'the scene reads this file' mesh.yaml --export ball.glb
empty "nothing is written" "$(find . -name 'rod.[pg]*' -o -name '.cuvette*')"
cmp -s ball.glb <("$program" mesh --generate icosphere --level 1 -f glb 2>/dev/null)
verdict $? "the scene's own file is as it was"
printf 'solids: {a: {shape: sphere}\n' >broken.yaml
refused "a scene that cannot be read" 'broken.yaml:[0-9]+:[0-9]+' broken.yaml --export a.pov
if [[ -w /dev/full ]]; then
    ln -s /dev/full full.pov
    "$program" scene rod.yaml --export full.pov 2>err
    equal "a full disk is an error of the system" $? 1
fi
conclude
