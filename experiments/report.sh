#!/bin/sh
# Print the closing page of a run from RESULTS/tables, and save it as RESULTS/report.txt.
#   experiments/report.sh RESULTS [FAILED]     FAILED: what went wrong, for the page
set -eu
export LC_ALL=C
[ $# -ge 1 ] && [ -d "$1/tables" ] || {
    echo "report.sh: no tables in '${1:-}'; usage: experiments/report.sh RESULTS, after make tables" >&2
    exit 2
}
here=$(cd "$(dirname "$0")" && pwd)
awk -v tables="$(cd "$1/tables" && ls | sed -n 's/\.tsv$//p' | tr '\n' ' ')" \
    -v results="$1" -v shown="${1#"${here%/experiments}"/}" -v published="$here/published" -v failed="${2:-}" \
    -f "$here/report.awk" </dev/null >"$1/report.txt.new"
mv "$1/report.txt.new" "$1/report.txt"
cat "$1/report.txt"
