#!/bin/bash
# `cuvette fit` as a person runs it: the report, JSON, the fitted scene, notes and errors; the same rows twice and for
# any number of threads; and a fit that is killed or interrupted goes on to the rows of an unbroken one. CUVETTE names
# the program.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${CUVETTE:-$root/build/cuvette}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-fit.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export LC_ALL=C
unset CUVETTE_ISA
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

fit() { # ARGUMENT...: its output in out and err, its exit status in code
    "$program" fit "$@" >out 2>err </dev/null
    code=$?
}

# --- the best form of a lens
fits=$root/experiments/fits
fit "$fits/least_spot.study" -o best.yaml
equal 'a fit ends well and in silence' "$code $(<err)" '0 '
grep -qE '^shape +0\.71[0-9]+ ' out
verdict $? 'the report has the shape of least spot' "$(<out)"
"$program" scene best.yaml --check >out 2>&1
verdict $? 'the fitted scene is valid' "$(<out)"
grep -qE 'radius_1: 58\.[0-9]+' best.yaml
verdict $? 'the fitted scene has the radius of that shape' "$(<best.yaml)"
before=$(<results/least_spot/fit.csv)
fit "$fits/least_spot.study" --json
equal 'nothing is measured again' "$before" "$(<results/least_spot/fit.csv)"
equal 'the JSON is an object with a value' "$(python3 -c '
import json, sys
r = json.load(open("out"))
p = r["parameters"][0]
print(r["schema"], r["goal"], round(p["value"], 2), p["interval"], r["targets"][0]["quantity"])')" \
    '1 minimise 0.71 none focus_rms'
fit "$fits/least_spot.study" --quiet
equal '--quiet prints nothing' "$code$(<out)$(<err)" 0

# --- intervals
"$program" fit "$fits/index_of_water.study" --results out_water >out 2>err
grep -qE '^liquid\.ior +1\.33[0-9]+ +1\.3[0-9]+ \.\. 1\.3[0-9]+  ' out && [[ ! -s err ]]
verdict $? 'the index has an interval of its profile' "$(<out)$(<err)"
grep -q ',profile,' out_water/index_of_water/fit.csv
verdict $? 'evaluations of a profile are rows'
# One of six positions is off by 10 px: the interval is narrow, and wrong.
sed 's|scene: ../scenes|scene: '"$root"'/experiments/scenes|; s/value: 427.1/value: 437.1/' \
    "$fits/index_of_water.study" >outlier.study
fit outlier.study
grep -qE 'chi-squared is [0-9.e+]+ with 5 degrees of freedom, far too large.* left_3 is off by [0-9.]+ sigma' err
verdict $? 'a merit far too large is noted, with the worst target' "$(<err)"
sed 's|scene: ../scenes|scene: '"$root"'/experiments/scenes|; s/to: 1.6, start: 1.45/to: 1.334/' \
    "$fits/index_of_water.study" >bound.study
fit bound.study
grep -qE '^liquid\.ior .* \.\. \[1\.33[0-9]*\] ' out && grep -q '^\[ \]: the parameter.s bound, at which' out
verdict $? 'an end at the bound is in brackets' "$(<out)"
fit bound.study --json
equal 'JSON marks the end at the bound' "$(python3 -c '
import json
p = json.load(open("out"))["parameters"][0]
print(p["interval"], p["low_at_bound"], p["high_at_bound"], p["high"])')" 'profile, 95% False True 1.334'
echo '  interval: linear' >>bound.study
fit bound.study
grep -qE '^liquid\.ior .* linear  ' out
verdict $? 'linear intervals are named' "$(<out)"

# --- a parameter without effect
cat >idle.study <<END
study: idle
scene: $fits/singlet.yaml
fit:
  parameters: {glass.ior: {from: 1.4, to: 1.6}, lamp.position.x: {from: 50, to: 150}}
  targets: {power: {value: 0.01}}
  screen: {position: [0, 100, 0]}
END
fit idle.study
grep -q '^cuvette: note: idle: lamp.position.x changes nothing that is measured' err && (($(grep -c '' err) == 1))
verdict $? 'a parameter without effect is noted' "$(<err)"

# --- mistakes
fit
grep -q '^cuvette: fit: no study is given; give a study file' err
verdict $? 'fit needs a study' "$(<err)"
fit "$root/experiments/depth.study"
grep -q 'depth.study:[0-9]*:1: the study has no section fit; ' err && ((code == 2))
verdict $? 'a study without a fit is refused' "$(<err)"
sed 's/edges.left, set/edges.lft, set/' bound.study >typo.study
fit typo.study
grep -qE 'typo.study:[0-9]+:24: the scene has no metric .edges.lft.; list the metrics' err && ((code == 2))
verdict $? 'a misspelt metric has its place' "$(<err)"
"$program" study run "$fits/achromat.study" >out 2>err
equal 'study run refuses a fit' "$? $(sed 's/.*: this/this/' err)" "2 this study is a fit; run it with 'cuvette fit'"

# --- the same rows, whatever happens; frames of a tenth of a second
cat >slow.study <<END
study: slow
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 320, render.height: 240, render.threads: THREADS}
fit:
  parameters: {liquid.ior: {from: 1.2, to: 1.6, start: 1.5}, camera.fov_deg: {from: 30, to: 60}}
  targets: {radiance: {value: 0.4}, rays_total: {value: 300000, weight: 1e-10}}
  evaluations: 25
END
sed s/THREADS/1/ slow.study >one.study
sed s/THREADS/3/ slow.study >three.study
fit one.study --results one --quiet
verdict "$code" 'a fit of frames ends well' "$(<err)"
fit three.study --results three --quiet
cmp -s one/slow/fit.csv three/slow/fit.csv
verdict $? 'the rows are the same for any number of threads'
rows() { # FOLDER: its complete rows
    [[ -e $1/slow/fit.csv ]] && grep -c '' "$1/slow/fit.csv" || echo 0
}
for signal in KILL INT TERM KILL; do
    "$program" fit one.study --results broken >out 2>err </dev/null &
    pid=$!
    had=$(rows broken)
    while (($(rows broken) < had + 4)) && kill -0 "$pid" 2>/dev/null; do sleep 0.02; done
    kill -s "$signal" "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
    code=$?
    if [[ $signal != KILL ]] && ((code != 0)); then
        [[ $code == 130 && $(<err) == *'interrupted; its '*' new rows are kept; run it again to resume' ]]
        verdict $? "a fit that is interrupted says so, with exit status 130" "$code $(<err)"
    fi
    cmp -s -n "$(stat -c %s broken/slow/fit.csv)" broken/slow/fit.csv one/slow/fit.csv
    verdict $? "after $signal the rows are the first ones of the unbroken fit"
done
fit one.study --results broken --quiet
cmp -s broken/slow/fit.csv one/slow/fit.csv
verdict $? 'the broken fit has gone on to the rows of the unbroken one' "$(<err)"
sed -i 's/start: 1.5/start: 1.4/' one.study
fit one.study --results broken --json
((code == 0)) && [[ ! -s err ]]
verdict $? 'another start uses rows of the same scene, without a note' "$(<err)"
sed -i 's/render.height: 240/render.height: 160/' one.study
fit one.study --results broken --json
grep -q '^cuvette: note: slow: [0-9]* rows of broken/slow/fit.csv are of another scene' err
verdict $? 'rows of another scene are noted' "$(<err)"

conclude
