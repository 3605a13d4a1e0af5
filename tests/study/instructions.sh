#!/bin/bash
# cuvette study run --instructions: counts of valgrind, in rows and an environment of their own, that agree with each
# other and can be compared. instructions.sh. One line per check ("ok ...", "not ok ...").
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${CUVETTE:-$root/build/cuvette}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-counted.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
case ${CONFIG:-release} in
release) ;;
*)
    echo "# instrumented programs do not run under valgrind"
    exit 77
    ;;
esac
cd "$work" || exit 1
export TMPDIR=$work/temporary
mkdir "$TMPDIR" bin
cat >small.study <<END
study: small
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 40, render.height: 30}
grid: [{render.depth: [1, 4]}]
repetitions: 6
processes: 3
warmups: 1
END
for name in env bash rm; do ln -s "$(command -v $name)" bin/; done
said=$(PATH=$work/bin "$program" study run -q small.study --instructions 2>&1)
equal "without valgrind: what to install" "$? $said" \
    "2 cuvette: --instructions: valgrind is not installed; install it: apt-get install --no-install-recommends valgrind"
command -v valgrind >/dev/null || {
    skip "valgrind is not installed"
    conclude
    exit
}
"$program" study run -q small.study >said 2>&1 && "$program" study run -q small.study --instructions >>said 2>&1
verdict $? "a study is measured, and counted" "$(<said)"
rows=results-instructions/small/rows.csv
column() { # FILE NAME
    awk -F , -v name="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; next } { print $at }' "$1"
}
equal "each row has a count" "$(column $rows instructions | grep -cE '^[0-9]{6,}$')" 18
for cell in 0 1; do
    empty "the counts of cell $cell agree within 1 %" "$(paste <(column $rows cell) <(column $rows instructions) \
        <(column $rows warmup) |
        awk -v cell=$cell '
            $1 == cell && $3 == 0 { if (!least || $2 < least) least = $2; if ($2 > most) most = $2 }
            END { if (most > 1.01 * least) print least " to " most }')"
done
equal "films are those of the measured rows" "$(column $rows film_hash | sort -u)" \
    "$(column results/small/rows.csv film_hash | sort -u)"
environment() { "$program" study summary -r "$1" small.study | awk 'END { print $NF }'; }
[[ $(environment results) != "$(environment results-instructions)" ]]
verdict $? "they are of another environment"
gate() { "$program" study compare small.study -r results-instructions "$@" --column instructions --fail-if-slower 1; }
said=$(gate render.depth=1 render.depth=4 2>&1)
equal "a gate on instructions: status" $? 1
[[ $said == *" slower"* ]]
verdict $? "and its verdict" "$said"
gate render.depth=4 render.depth=1 >said 2>&1
verdict $? "the other way round it passes" "$(<said)"
empty "nothing is left in TMPDIR" "$(ls "$TMPDIR")"
conclude
