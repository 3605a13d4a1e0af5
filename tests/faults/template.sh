#!/bin/bash
# template.sh FOLDER: the files that the commands of tests/faults/commands.txt use: small scenes, images,
# rows. CUVETTE names the program.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$1"
cd "$1"
cuvette() { "${CUVETTE:-$root/build/cuvette}" "$@" >/dev/null; }

cp "$root/experiments/scenes/chequer.png" tiles.png
cp "$root/experiments/hands/tug.yaml" tug.yaml
cp "$root/experiments/cluster/study.slurm" study.slurm
small() { # SCENE OPTION...: a shipped scene with 8 x 6 pixels; its files are in this folder
    sed 's,file: chequer.png,file: tiles.png,; s,script: .*/,script: ,' "$root/experiments/scenes/$1" >whole.yaml
    cuvette scene whole.yaml --set render.width=8 --set render.height=6 --set render.threads=1 -o "$1" "${@:2}"
    rm whole.yaml
}

small rod.yaml --set render.depth=8
small slime.yaml --set toy.level=1 --set toy.time_s=0.01
small prism.yaml --set render.wavelengths=4
cat >things.yaml <<'END'
title: 'words: "quoted"'
render: {width: 8, height: 6, depth: 2, threads: 2}
textures: {tiles: {file: tiles.png}}
meshes: {ring: {generate: torus, around: 8, tube: 6}, read: {file: box.obj}}
lights: {lamp: {position: [3, 6, -4]}}
solids:
  one: {shape: mesh, mesh: ring, texture: tiles, diffuse: 0.8}
  two: {shape: mesh, mesh: read, diffuse: 0.5, position: [2, 0, 0]}
END
cat >optics.yaml <<'END'
title: Photons, metal, film, lens
render: {width: 8, height: 6, depth: 4, threads: 2, samples: 4, caustics: photons, photons: 400, wavelengths: 4}
camera: {position: [0, 3, -6], target: [0, 0.5, 0], aperture: 0.2, focus: 6}
lights: {lamp: {position: [3, 6, -4]}}
solids:
  ground: {shape: plane, diffuse: 0.8}
  ball: {shape: sphere, medium: gold, radius: 0.5, position: [-1.2, 0.6, 0]}
  bubble: {shape: sphere, transparency: 1, film_thickness_nm: 400, film_ior: 1.33, radius: 0.4, position: [0, 0.5, -1]}
  glass:
    {shape: lens, medium: bk7, transparency: 1, diameter: 1, position: [1.2, 0.8, 0], radius_1: 1.5, radius_2: -1.5}
END
printf '%s\n' 'pupil, 10' 'field_deg, 0, 5' 'radius, thickness, medium, diameter' '50, 4, bk7, 14' \
    '-50, 46, , 14' >lens.csv
cuvette mesh --generate box -o box.obj
cuvette mesh --generate box -f ply -o box.ply
mkdir lessons
cat >lessons/rod.lesson <<'END'
lesson: rod
title: The broken rod
question: Why does it look wider?
scene: ../rod.yaml
controls:
  - {parameter: liquid.ior, label: Index, from: 1, to: 1.6}
prediction: {ask: It is, choices: [shifted, not shifted], right: shifted}
measure: {curve: edges, tolerance: 1e-9, reading: Shift, unit: px, metric: edges.left_shift}
answer: It is a lens.
END
cat >lessons/critical.lesson <<'END'
lesson: critical
title: The critical angle
language: en
question: When does it turn to a mirror?
scene: ../rod.yaml
set: {liquid.ior: 1.4, liquid.color: [0.9, 0.95, 1]}
controls:
  - {parameter: liquid.ior, label: Index, choices: [1.2, 1.3, 1.4, 1.5]}
  - {parameter: rod.size.x, label: Colour, from: 0.1, to: 0.3}
prediction: {ask: How many degrees?, within: 3}
measure: {over: liquid.ior, tolerance: 1e-9, reading: Angle, unit: deg, metric: critical.liquid}
answer: It is the critical angle.
END
cuvette render rod.yaml -o a.png
cuvette render rod.yaml -o b.png --set liquid.ior=1.4
cuvette render rod.yaml -o a.jpg
cuvette render rod.yaml -o a.pfm
cuvette render rod.yaml -o a.exr
cat >fit.study <<'END'
study: fit
scene: rod.yaml
fit:
  parameters: {liquid.ior: {from: 1.2, to: 1.6}, vessel.ior: {from: 1.4, to: 1.6}}
  targets: {radiance: {value: 0.4, sigma: 0.1}, hits.rod: {set: {rod.position.x: 0.3}, value: 20}}
  method: [bobyqa, damped]
  evaluations: 6
END
cat >small.study <<'END'
study: small
scene: rod.yaml
grid:
  - {render.depth: [0, 8]}
repetitions: 2
warmups: 0
keep: {image: on}
END
sed 's/study: small/study: done/' small.study >done.study
sed 's/study: small/study: parts/' small.study >parts.study
cuvette study run -q done.study
printf '%s\n' depth,wall_s,source 0,0.1,one 1,0.2,two >published.csv
cuvette study run -q --shard 0/2 parts.study
cuvette study run -q --shard 1/2 parts.study
