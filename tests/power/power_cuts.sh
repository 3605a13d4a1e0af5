#!/bin/bash
# Power cuts: what a cut at any moment can leave of the files that the program writes must hold all that it promised
# (cuvette-study(1), POWER CUTS). tests/power/power_cuts.py does it; one line per case. CUVETTE names the program, BUILD
# the folder of the tools. POWER_STATES: trees to judge of each case, POWER_RESUMED: trees to resume, POWER_SEED,
# POWER_CASE: one case alone.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
tools=${BUILD:-build}/tests/power
case ${CONFIG:-release} in
release | debug) ;;
*)
    echo "# the recorder cannot be loaded before an instrumented program's own library"
    exit 77
    ;;
esac
command -v python3 >/dev/null || {
    echo "# python3 is not installed"
    exit 77
}
[[ -x $tools/reader && -e $tools/record.so ]] || {
    echo "# $tools/reader is not built"
    exit 77
}
exec python3 -B tests/power/power_cuts.py "${CUVETTE:-build/cuvette}" "$tools/record.so" "$tools/reader" \
    --states "${POWER_STATES:-600}" --states-per-cut "${POWER_STATES_PER_CUT:-300}" --resumed "${POWER_RESUMED:-2}" \
    --started "${POWER_STARTED:-0.05}" --seed "${POWER_SEED:-1}" ${POWER_CASE:+--only "$POWER_CASE"}
