#!/bin/bash
# Figures of cuvette-validation(7): figures.sh CUVETTE FOLDER writes ball.svg (the caustic of a ball lens) and
# calcite.svg (the tree of one ray in calcite).
set -euo pipefail

program=$(realpath "$1") folder=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat >ball.yaml <<'END'
solids:
  ball: {shape: sphere, transparency: 1, ior: 1.8, radius: 1}
  screen: {shape: box, size: [0.02, 1, 1], position: [1.6, 0, 0]}
END
cat >calcite.yaml <<'END'
camera: {position: [0, 3, -9], target: [0, 0, 0]}
solids:
  calcite: {shape: box, size: [3, 1, 3], transparency: 1, ior: 1.6584, extraordinary_ior: 1.4864, optic_axis: [1, 1, 0]}
END
"$program" fan ball.yaml --from=-2,0,0 --to=0,0,0 --width=1.8 --rays=41 -o "$folder/ball.svg" >/dev/null
"$program" trace calcite.yaml --ray=-1,1.5,0,0.4,-1,0 --depth 2 -o "$folder/calcite.svg"
