#!/bin/bash
# experiments/detect.sh [OUT]: the smallest known error that each metric of `cuvette realism` detects. Copies the
# sources to build/detect, puts errors of a chosen size into the copy (tests/faults/detect.tsv), and measures scenes
# with them against the theory without: the pairs of indices of realism.study, stacks of plates, prisms and drops.
# Writes OUT/rows.csv (results/detect): a line a scene, metric and kind of error. About ten minutes.
set -euo pipefail
export LC_ALL=C
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
out=${1:-results/detect} copy=build/detect
mkdir -p "$out"
rm -rf "$copy/src" "$copy/tests"
mkdir -p "$copy"
cp -r Makefile mk README.md CHANGELOG.md .ci src tests experiments plots paper "$copy"
cp tests/faults/injected.h tests/faults/injected.c "$copy/src/base"
while IFS=$'\t' read -r file old new; do
    [[ $file == \#* ]] && continue
    text=$(<"$copy/$file")
    [[ $text == *"$old"* ]] || {
        echo "detect.sh: $file has no '$old' any more; correct tests/faults/detect.tsv" >&2
        exit 1
    }
    [[ $text == *base/injected.h* ]] || text=${text/'#include'/$'#include "base/injected.h"\n#include'}
    printf '%s\n' "${text/"$old"/"$new"}" >"$copy/$file"
done <tests/faults/detect.tsv
cp tests/faults/detect.c "$copy/tests/bench/bench_detect.c" # a name that the Makefile has a rule for
echo '#include "base/injected.h"' >"$copy/tests/bench/injected.h"
make -s -j2 -C "$copy" warnings= build/tests/bench_detect >"$copy/log" 2>&1 || {
    cat "$copy/log" >&2
    exit 1
}
detect=$copy/build/tests/bench_detect
# shellcheck disable=SC2016 # expanded by the inner bash
{
    for vessel in 1.0 1.3 1.5 1.8; do
        for liquid in 1.0 1.2 1.33 1.47 1.6; do echo "rod experiments/scenes/rod.yaml $vessel $liquid"; done
    done
    for angle in 20 50 85; do
        for light in on off; do
            echo "plates experiments/scenes/plates.yaml render.polarisation=$light plate1.rotation.y=$angle" \
                "plate2.rotation.y=$angle"
        done
    done
    for glass in sf11 bk7 fused-silica; do echo "prism experiments/scenes/prism.yaml glass.medium=$glass"; done
    for liquid in water ethanol; do echo "rainbow experiments/scenes/rainbow.yaml water.medium=$liquid"; done
} | awk '{ print "cell" NR + 100, $0 }' |
    xargs -L 1 -P "$(nproc)" bash -c '"$0" "${@:2}" >"${0%/*}/$1.csv"' "$detect"
cat "${detect%/*}"/cell*.csv >"$copy/all.csv"
awk -f experiments/detect.awk "$copy/all.csv" | sort -t , -k 1,1 -k 3,3 -k 2,2 |
    sed '1i scene,metric,error_kind,cells,cells_detected,size_least,size_median,size_most,error,tolerance,size_missed' \
        >"$out/rows.csv"
