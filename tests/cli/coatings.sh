#!/bin/bash
# Coatings in traced rays against an independent program in Python (coatings.py). coatings.sh [PROGRAM]
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-coatings.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
export LC_ALL=C
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

found=$(python3 -B "$root/tests/cli/coatings.py" "$program" "$work")
empty "coatings have the powers of an independent program ($found)" \
    "$(awk '$1 < 500 || !($2 < 1e-12) {print "compared " $1 ", largest difference " $2}' <<<"${found:-0 1}")"
conclude
