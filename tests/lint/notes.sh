#!/bin/bash
# Scenes with one typical mistake each: `cuvette scene --check` prints one note with a remedy, at the place in the
# second line of the scene. Prints the notes as well. CUVETTE names the program.
set -uo pipefail
cd "$(dirname "$0")/../.."
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
holds() { # holds NAME PATTERN OUTPUT: one line of the output is a note that matches the pattern, and no other is one
    number=$((number + 1))
    if [[ $(grep -c '^cuvette: note: ' <<<"$3") == 1 ]] && grep -qE "^cuvette: note: $2" <<<"$3"; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        sed 's/^/# /' <<<"$3"
        failed=1
    fi
}
none() { # none NAME OUTPUT: no line of the output is a note
    number=$((number + 1))
    if ! grep -q '^cuvette: note: ' <<<"$2"; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        sed 's/^/# /' <<<"$2"
        failed=1
    fi
}
cat >"$folder/glass.yaml" <<'END'
render: {width: 32, height: 24, depth: 6}
camera: {position: [0, 1, -5], target: [0, 1, 0]}
lights: {lamp: {position: [4, 7, -5]}}
solids:
  ground: {shape: plane, ambient: 0.1, diffuse: 0.7}
  ball: {shape: sphere, position: [0, 1, 0], transparency: 1, medium: ethanol}
END
cells() { # cells LINE...: the output of a dry run of a study with these lines
    printf '%s\n' 'study: t' "scene: $folder/glass.yaml" 'repetitions: 1' "$@" >"$folder/t.study"
    "$cuvette" study run --dry-run --results "$folder/none" "$folder/t.study" 2>&1
}
holds 'a note on one cell has its number and values' \
    'in cell 3 \(render\.lambda_nm=900\): ball\.medium: ethanol was measured only from 476\.5 to 830 nm' \
    "$(cells 'grid: [{render.lambda_nm: [500, 550, 600, 900]}]')"
holds 'a note on some cells has their number' \
    'in 4 of 8 cells, such as cell 4 \(render\.lambda_nm=850, render\.depth=5\): ball\.medium: ' \
    "$(cells 'grid: [{render.lambda_nm: [500, 550, 850, 900]}, {render.depth: [5, 6]}]')"
holds 'a note on all cells has neither' 'ball\.medium: ethanol was measured' \
    "$(cells 'grid: [{render.lambda_nm: [300, 400]}]')"
holds 'a note on a medium that varies' 'in cell 1 \(ball\.medium=ethanol\): ball\.medium: ethanol was measured' \
    "$(cells 'set: {render.lambda_nm: 400}' 'grid: [{ball.medium: [water, ethanol]}]')"
none 'a sweep through unusual values has none' "$(cells 'grid: [{ball.ior: [1.0, 1.5]}]')"
holds 'an axis without effect in some cells' \
    'in 2 of 4 cells, such as cell 0 \(render\.integrator=whitted, render\.paths=1\): render\.paths: ' \
    "$(cells 'grid: [{render.integrator: [whitted, path]}, {render.paths: [1, 2]}]' \
        'set: {lamp.radius: 1, lamp.reach: 1}' | grep -v lamp.radius)"
none 'a fixed parameter that acts in some cells' \
    "$(cells 'grid: [{render.integrator: [whitted, path]}]' 'set: {render.paths: 2, lamp.radius: 1, lamp.reach: 1}' |
        grep -v lamp.radius)"
holds 'a fixed parameter that acts in none' 'render\.paths: ' \
    "$(cells 'grid: [{render.depth: [5, 6]}]' 'set: {render.paths: 2}')"
holds 'a camera inside a solid in one cell' 'in cell 1 \(camera\.position\.y=-1\): camera\.position: ' \
    "$(cells 'grid: [{camera.position.y: [1, -1]}]')"
cells 'grid: [{ball.ior: [1.3, 1,4, 1.5]}]' >/dev/null
holds 'a decimal comma has a note with line and column' \
    "$folder/t\\.study:4:25: ball\\.ior: 1 and 4 are two values; did you mean 1\\.4\\?" \
    "$(cells 'grid: [{ball.ior: [1.3, 1,4, 1.5]}]')"
cat >"$folder/spot.yaml" <<'END'
background: {color: [0, 0, 0], ambient: [0, 0, 0]}
render: {width: 40, height: 30, caustics: photons, photons: 2000}
camera: {position: [0, 0, -5], target: [0, 0, 0]}
beams: {spot: {position: [-2, 0, -2], target: [0.3, 0.1, 0], lights: on, kind: bundle, width: 0.5}}
solids: {wall: {shape: box, diffuse: 1, size: [6, 5, 1], position: [0, 0, 0.5]}}
END
spot() { # spot PATH=VALUE: the notes of a render on the beam, which lights a wall
    "$cuvette" render "$folder/spot.yaml" -o "$folder/a.png" --set "$1" 2>&1 | grep '^cuvette: note: spot'
}
none 'a beam that is made invisible' "$(spot spot.visible=off)"
none 'a beam that is made dark' "$(spot spot.power=0)"
none 'a beam that is made infrared' "$(spot spot.lambda_nm=900)"
holds 'a beam that misses the wall' 'spot\.target: no sample of the image shows its light; aim it' \
    "$(spot spot.target=0,0,-5)"
echo "1..$number"
exit $failed
