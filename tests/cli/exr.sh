#!/bin/bash
# Checks the OpenEXR files of the program, with a reader of our own that shares nothing with it (tests/tools/exr.py):
# exr.sh [PROGRAM].
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
scene=$root/experiments/scenes/rod.yaml
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-exr.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
small=(--set render.width=50 --set render.height=37)
exr() { python3 "$root/tests/tools/exr.py" "$@"; }
render() { "$program" render "$scene" "${small[@]}" "$@" >out 2>err; }
hash_of() { grep -o 'film [0-9a-f]*' out; }
same() { # WHAT FILE CHANNELS PFM
    exr same "${@:2}"
    verdict $? "$1" "the channels $3 of $2 are not those of $4"
}

# --- the image
render -o a.exr && hash_of >film
equal "a film has three channels" "$(exr names a.exr)" "B G R"
equal "the attributes name the primaries, the program and the scene" \
    "$(exr attributes a.exr | tr ' ' '\n' | grep -cE '^(chromaticities:chromaticities|Software:string)$')" 2
render -o a.pfm
same "the values are those of PFM" a.exr R,G,B a.pfm
render -o again.exr --set render.threads=2
cmp -s a.exr again.exr
verdict $? "the same film has the same file" "a.exr and again.exr differ"
"$program" render a.exr --json >/dev/null 2>&1 && "$program" render a.exr -o b.pfm >out 2>err
equal "the scene in the metadata has the same film" "$(hash_of)" "$(<film)"
equal "compare sees no difference to PFM" \
    "$("$program" compare a.exr a.pfm --json | grep -cE '"mse": 0(\.0)?,')" 1
render --set background.image="$work/a.exr" -o sky.pfm && hash_of >film
render --set background.image="$work/a.pfm" -o sky.pfm
equal "a sky of OpenEXR gives the film of PFM" "$(hash_of)" "$(<film)"
head -c 1000 a.exr >cut.exr
"$program" compare cut.exr a.pfm >out 2>err
equal "a cut file is refused in one line" "$? $(wc -l <err)" "2 1"

# --- channels by name
render -o maps.exr --rays maps.exr --cut ./maps.exr && render -o a.png --rays rays.pfm --cut cut.pfm
equal "maps of the image's file are its channels" "$(exr names maps.exr)" "B G R cut.V rays.V"
same "rays" maps.exr rays.V rays.pfm
same "cut light" maps.exr cut.V cut.pfm
render -o a.exr --time time.exr --rays rays.exr
equal "maps of their own are grey images" "$(exr names time.exr) $(exr names rays.exr) $(exr names a.exr)" "Y Y B G R"
same "a map of rays" rays.exr Y rays.pfm
render -o a.png --rays a.png
equal "other formats hold no maps" "$?" 2

paths=(--set render.integrator=path --set render.paths=16)
render "${paths[@]}" -o noisy.exr --noise noise.exr && render "${paths[@]}" -o noisy.pfm --noise noise.pfm
equal "random paths have a noise" "$(exr names noisy.exr)" "B G R noise.B noise.G noise.R"
same "the film of random paths" noisy.exr R,G,B noisy.pfm
same "its noise" noise.exr Y noise.pfm
equal "a spectral film's noise is that of XYZ" \
    "$(render "${paths[@]}" --set render.spectrum=spectral -o spectral.exr && exr names spectral.exr)" \
    "B G R noise.X noise.Y noise.Z"

render --set render.integrator=aov -o aov.exr && render --set render.integrator=aov --layers layer -o aov.pfm
equal "layers" "$(exr names aov.exr)" "B G R albedo.B albedo.G albedo.R depth.Z material.V normal.X normal.Y normal.Z \
position.X position.Y position.Z solid.V"
same "albedo" aov.exr albedo.R,albedo.G,albedo.B layer-albedo.pfm
same "normals" aov.exr normal.X,normal.Y,normal.Z layer-normal.pfm
same "positions" aov.exr position.X,position.Y,position.Z layer-position.pfm
same "depth" aov.exr depth.Z layer-depth.pfm
same "solids" aov.exr solid.V layer-solid.pfm
same "materials" aov.exr material.V layer-material.pfm

# --- frames of their own
light=(--set render.polarisation=on)
through() { render "${light[@]}" --set "camera.analyser=$2" --set "camera.analyser_angle_deg=$3" -o "$1.pfm"; }
render "${light[@]}" -o stokes.exr --stokes
equal "Stokes vectors" "$(exr names stokes.exr)" "B G R S1.B S1.G S1.R S2.B S2.G S2.R S3.B S3.G S3.R"
through right linear 0 && through up linear 90 && through rising linear 45 && through falling linear -45 &&
    through left circular_left 0 && through clockwise circular_right 0
opposite() { # CHANNEL PFM PFM: whether it is the difference of what two analysers pass
    exr near stokes.exr "$1.R,$1.G,$1.B" 1e-6 1 "$2.pfm" -1 "$3.pfm" >worst
    verdict $? "$1 is the light through an analyser less that through the opposite one" "off by $(<worst)"
}
opposite S1 right up
opposite S2 rising falling
opposite S3 left clockwise
exr near stokes.exr S1.R,S1.G,S1.B 1e-3 0 up.pfm >worst
verdict $((!$?)) "S1 is not 0 on this scene"

cat >white.yaml <<'END'
render: {width: 32, height: 32, spectrum: spectral, wavelengths: 40}
background: {kind: uniform, color: [1, 1, 1]}
END
"$program" render white.yaml -o white.exr --bands 40 >out 2>err
equal "bands of wavelengths are named by their middle" \
    "$(exr names white.exr | cut -d ' ' -f 1-5) $(exr names white.exr | wc -w)" \
    "B G R S0.385,000nm S0.395,000nm 43"
# CIE 15: D65 is 98.1671 at 565 nm, 100 at 560, and linear in between; 1.0112 of Y = 1 at 560 nm.
equal "a white sky has the spectrum of D65" \
    "$(exr sum white.exr S0.565,000nm | awk '{v = $1 / 1024 / 1.0112 / 0.981671; print (v > 0.999 && v < 1.001)}')" 1
render --stokes -o a.exr
equal "Stokes vectors need polarised light" "$? $(wc -l <err)" "2 1"
"$program" render white.yaml -o white.exr --bands 7 >out 2>err
equal "bands need equal shares of the wavelengths" "$? $(wc -l <err)" "2 1"

# --- other programs, where they are installed
if command -v exrheader >/dev/null; then
    equal "exrheader reads it" "$(exrheader aov.exr | grep -c '32-bit floating-point, sampling 1 1')" 15
else
    skip "exrheader is not installed (openexr)"
fi
conclude
