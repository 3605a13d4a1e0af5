#!/bin/bash
# Requests that need more memory than allowed: refused with exit code 2, one line with the estimate and the remedy, no
# file, and less than 20 MB beyond what the program needs for nothing. budget.sh [PROGRAM]; needs the compiler
# (CC) for tests/tools/moment.c, which measures the peak.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-budget.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export LC_ALL=C
unset CUVETTE_ISA
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
"${CC:-gcc}" -std=c17 -O1 -o moment "$root/tests/tools/moment.c" || {
    echo "# the compiler cannot build tests/tools/moment.c"
    exit 77
}
case ${CONFIG:-release} in
sanitize* | tsan*) allowed=1000000 ;; # its own memory
*) allowed=20480 ;;
esac

peak() { # COMMAND...: KiB; the exit code in `code`
    read -r _ _ code _ kib _ < <(./moment 0 0 "$@" 2>err)
}
peak "$program" --version
none=$kib
worst=0

refused() { # WHAT PATTERN ARGUMENT...
    local what=$1 pattern=$2 wrong=
    shift 2
    rm -f out.*
    peak "$program" "$@"
    ((code == 2)) || wrong="exit $code; "
    grep -qE "^cuvette: .*$pattern" err || wrong+="the message: $(head -c 300 err); "
    (($(grep -vc '^cuvette: note: ' err) == 1)) || wrong+="$(wc -l <err) lines; "
    [[ -z $(find . -name 'out.*' -o -name '.cuvette*') ]] || wrong+="a file; "
    ((kib - none < allowed)) || wrong+="$((kib - none)) KiB; "
    ((kib - none <= worst || allowed > 20480)) || worst=$((kib - none))
    empty "refused: $what" "$wrong"
}
needs='needs about [0-9.]+ [KMGT]iB of memory, more than the [0-9.]+ ([KMGT]iB|bytes) '
needs+='that --memory-limit leaves; .*--memory-limit$'
scenes=$root/experiments/scenes

refused "a terrain of 16384 x 16384 cells" 'a mesh of 536870912 triangles is too large' \
    mesh --generate terrain --around 16384 --tube 16384
for mesh in "sparse --count 100000000" "dense --count 100000000" "sphere --count 100000000" "icosphere --level 11" \
    "torus --around 10000 --tube 10000" "terrain --around 10000 --tube 10000"; do
    # shellcheck disable=SC2086 # several words
    refused "$mesh" "a mesh of [0-9]+ triangles $needs" mesh --generate $mesh --memory-limit=1G -o out.obj
done
printf 'meshes: {m: {generate: sparse, count: 90000000}}\nsolids: {s: {shape: mesh, mesh: m}}\n' >mesh.yaml
refused "a mesh of a scene" "mesh.yaml.*a mesh of 90000000 triangles $needs" scene mesh.yaml --check --memory-limit=1G
refused "a film" "a frame of 16000 x 16000 pixels $needs" render "$scenes/rod.yaml" -o out.png --memory-limit=1G \
    --set render.width=16000 --set render.height=16000
refused "layers" "a frame of 2000 x 2000 pixels $needs" render "$scenes/rod.yaml" --layers out.l --memory-limit=200M \
    --set render.width=2000 --set render.height=2000 --set render.integrator=aov
refused "maps" "a frame of 2000 x 2000 pixels $needs" render "$scenes/rod.yaml" --time out.png --memory-limit=120M \
    --set render.width=2000 --set render.height=2000
refused "waiting rays" "a frame of 80 x 60 pixels $needs" render "$scenes/rod.yaml" -o out.png --memory-limit=100M \
    --set render.width=80 --set render.height=60 --set render.threads=1024 --set render.depth=60
# Its mesh has room, and is there when its hierarchy is refused.
printf 'meshes: {m: {generate: icosphere, level: 7}}\nsolids: {s: {shape: mesh, mesh: m}}\n' >sphere.yaml
allowed=$((allowed + 60 * 1024)) refused "a hierarchy" "the hierarchy of 327680 triangles $needs" render sphere.yaml \
    -o out.png --memory-limit=60M
printf 'meshes: {m: {generate: icosphere, level: 0}}\nsolids: {s: {shape: mesh, mesh: m, copies: [2048, 2048, 1]}}\n' \
    >copies.yaml
refused "copies" "the bounds of 4194304 copies of meshes $needs" render copies.yaml -o out.png --memory-limit=200M
"$program" render "$scenes/rod.yaml" -o big.png --set render.width=2400 --set render.height=1800 \
    --set render.integrator=raycast >made 2>&1
printf 'textures: {t: {file: big.png}}\nsolids: {s: {shape: sphere, radius: 1, texture: t}}\n' >texture.yaml
printf 'background: {kind: image, image: big.png}\nsolids: {s: {shape: sphere, radius: 1}}\n' >sky.yaml
refused "a texture's image" "texture.yaml.*an image of 2400 x 1800 pixels $needs" scene texture.yaml --check \
    --memory-limit=40M
refused "a background" "sky.yaml.*an image of 2400 x 1800 pixels $needs" render sky.yaml -o out.png --memory-limit=40M
refused "images to compare" "an image of 2400 x 1800 pixels $needs" compare big.png big.png --memory-limit=40M
refused "a size that is none" "--memory-limit 5Q: invalid size; give a size such as 500M or 4G" \
    render "$scenes/rod.yaml" -o out.png --memory-limit 5Q

# The address space of the process, without the option.
rm -f out.png
(ulimit -v 2000000 && "$program" mesh --generate sparse --count 50000000 >out.txt 2>err)
(($? == 2)) && grep -qE 'a mesh of 50000000 triangles needs about .* three quarters of what is free' err
verdict $? "ulimit -v limits too" "$(cat err)"

# The film does not depend on the limit.
film() { "$program" render "$scenes/rod.yaml" -o out.png "$@" 2>/dev/null | sed 's/.*film \([0-9a-f]*\).*/\1/'; }
[[ $(film) == "$(film --memory-limit=200M)" && $(film --memory-limit=900G) == "$(film)" ]]
verdict $? "the film does not depend on the limit"
echo "# the most memory of a refused request beyond the program's own: $worst KiB"
conclude
