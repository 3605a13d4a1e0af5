#!/bin/bash
# Lamps out of focus behind a lens: the light of their discs in the image is that of the part of the pupil that passes,
# as the report on the lens has it (bokeh.py). bokeh.sh [PROGRAM]
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-bokeh.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
export LC_ALL=C
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

found=$(python3 -B "$root/tests/cli/bokeh.py" "$program" "$root/experiments/lenses" "$work")
echo "${found:-nothing was measured}"
empty "discs have the light of the vignetted pupil" \
    "$(awk '/^lamp/ {seen++; if (!($4 > 0.97 * $6 && $4 < 1.03 * $6)) print} END {if (seen != 3) print seen " lamps"}' \
        <<<"$found")"
conclude
