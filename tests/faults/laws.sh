#!/bin/bash
# laws.sh [N...]: puts each fault of laws.tsv (or those of the numbers given) into a copy of the sources,
# builds tests/test_laws there and expects it to fail. A fault that no law catches is reported, and the status is 1.
# LAWS_SCENES=10000 is how many scenes each law may use, of each of eight seeds: some faults show once in 40 000 scenes.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$root/Makefile" "$root/mk" "$root/src" "$root/tests" "$root/.ci" "$root/plots" "$work"
mkdir -p "$work/experiments"
cp -r "$root/experiments/cluster" "$work/experiments"
missed=0 number=0
build() {
    make -s -j2 -C "$work" warnings= build/tests/test_laws >"$work/log" 2>&1 || {
        cat "$work/log" >&2
        exit 2
    }
}
# laws SEED SCENES SECONDS, of CPU time: 0 when all laws hold
laws() { (ulimit -t "$3" && LAWS_SEED=$1 LAWS_SCENES=$2 exec "$work/build/tests/test_laws") >"$work/out" 2>&1; }
all_seeds() { for seed in 1 2 3 4 5 6 7 8; do laws "$seed" "${LAWS_SCENES:-10000}" 1800 || return; done; }
build
laws 1 500 600 || {
    cat "$work/out" >&2
    echo "laws.sh: the laws do not hold without a fault" >&2
    exit 2
}
while IFS=$'\t' read -r file old new; do
    [[ $file == \#* ]] && continue
    number=$((number + 1))
    [[ $# -eq 0 || " $* " == *" $number "* ]] || continue
    text=$(<"$root/$file")
    [[ $text == *"$old"* ]] || {
        echo "laws.sh: fault $number: $file has no '$old' any more" >&2
        exit 2
    }
    printf '%s\n' "${text/"$old"/"$new"}" >"$work/$file"
    build
    # Fewer scenes first: most faults show at once, or never come to an end.
    laws 1 500 120 && all_seeds && status=0 || status=$?
    broken=$(sed -n 's/^law \([0-9]\).*, \([1-9][0-9]*\) broken.*/law \1/p' "$work/out" | sort -u | paste -s -d ',')
    case $status in
    0) echo "not ok $number - $file: $new: not caught" && missed=1 ;;
    137 | 152) echo "ok $number - $file: $new: never ends" ;;
    *) echo "ok $number - $file: $new: caught by ${broken:-a crash}" ;;
    esac
    cp "$root/$file" "$work/$file"
done <"$root/tests/faults/laws.tsv"
exit $missed
