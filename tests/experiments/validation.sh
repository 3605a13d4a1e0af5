#!/bin/bash
# Published values next to the program's (experiments/validate.py): all cases are within their tolerances and equal the
# rows of the manual's page; a wrong expected value, a missing value of the program and a file that is
# wrong are found. validation.sh [PROGRAM].
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
command -v python3 >/dev/null || {
    skip 'python3 is not installed'
    exit 77
}
program=${1:-${BUILD:-build}/cuvette}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-validation.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
validate() { # FILE.cases...: the output and the status, in "out" and "code"; rows in rows.csv
    out=$(experiments/validate.py "$program" "$work/rows.csv" "$@" 2>&1)
    code=$?
}
rows=experiments/validation/cases.csv

validate
equal "all cases are within their tolerances" $code 0
[[ $out =~ ^([0-9]+)\ of\ ([0-9]+)\ cases\ of\ ([0-9]+)\ kinds ]] &&
    ((BASH_REMATCH[1] >= 60 && BASH_REMATCH[1] == BASH_REMATCH[2] && BASH_REMATCH[3] >= 10))
verdict $? "there are at least 60 cases of ten kinds" "$out"
empty "the rows of the manual's page are these; make validate RENEW=1 renews them" "$(
    python3 -B - "$work/rows.csv" $rows <<'END'
import csv, sys
new, old = (list(csv.DictReader(open(path, newline="", encoding="utf-8"))) for path in sys.argv[1:])
numbers = ("expected", "ours", "deviation", "tolerance", "nature")  # libm's last digits differ between systems
if len(new) != len(old):
    print(len(new), "rows, not", len(old))
for a, b in zip(new, old):
    same = all(a[key] == b[key] for key in a if key not in numbers)
    if not same or abs(float(a["ours"]) - float(b["ours"])) > 1e-9 * max(1, abs(float(b["ours"]))):
        print(a["kind"], a["case"], "differs")
END
)"

# Every case of a kind, with an expected value that is off by 0.001.
awk '/^tolerance: / { sub(/^tolerance: /, ""); print "tolerance: " $0; next }
    /^expected: / { sub(/^expected: /, ""); print "expected: (" $0; open = 1; next }
    open && !/^ / { print "  ) + 1e-3"; open = 0 } { print }' experiments/validation/films.cases |
    grep -v '^#' >"$work/wrong.cases"
validate "$work/wrong.cases"
equal "a wrong expected value is found: the status" $code 1
equal "a wrong expected value is found: each case" "$(grep -c ',fail$' "$work/rows.csv")" \
    "$(grep -c '^films,' "$work/rows.csv")"
[[ $out == *"wrong.cases:"*"black-soap-film: "*" differs from "*"more than 1e-14"* ]]
verdict $? "the message has file, line, case, both values and the tolerance" "$out"

# --- values that are missing
printf '%s\n' '[kind]' 'title: Kind' '[case]' 'what: an index' 'source: none' 'expected: 1.5168' 'command: media bk7' \
    'read: out.media[0].n_d' 'tolerance: 1e-5' 'because: a test' >"$work/good.cases"
validate "$work/good.cases"
equal "a small file of cases" "$code" 0
missing() { # WHAT SED MESSAGE
    sed "$2" "$work/good.cases" >"$work/bad.cases"
    validate "$work/bad.cases"
    equal "$1: the status" $code 1
    [[ $out == *"$3"* && $(tail -1 "$work/rows.csv") == *,error ]]
    verdict $? "$1: an error, not a pass" "$out"
}
missing "a key that the output lacks" 's/n_d/n_x/' "KeyError: 'n_x'"
missing "a command that fails" 's/media bk7/media bk77/' "bk77"
missing "a value that is no number" 's/^read: .*/read: None/' "TypeError"
missing "an image that was not written" 's/^read: .*/read: image.mean()[0]/' "NameError"
sed 's/^read: .*/read: float("nan")/' "$work/good.cases" >"$work/bad.cases"
validate "$work/bad.cases"
equal "a value that is not finite fails" $code 1
sed 's/^tolerance: .*/tolerance: inf/' "$work/good.cases" >"$work/bad.cases"
validate "$work/bad.cases"
equal "an infinite tolerance fails" $code 1

# --- files that are wrong
wrong() { # WHAT SED MESSAGE
    sed "$2" "$work/good.cases" >"$work/bad.cases"
    validate "$work/bad.cases"
    equal "$1" "$code ${out#validate: }" "2 $3"
}
wrong "a case without a source" '/^source/d' "bad.cases:3: the case has no 'source'; add it"
wrong "an unknown key" 's/^because/why/' "bad.cases:3: unknown key 'why'; the keys are what source given \
expected nature unit scene files command read tolerance because"
wrong "a line that is none" 's/^title.*/title/' "bad.cases:2: not a section, a new key or a line that continues; see \
experiments/validation/README.md"
conclude
