#!/bin/bash
# The tables of rows (experiments/tables.sh) and the claims of the paper (paper/claims.tsv): each has a verdict on the
# committed rows; wrong rows turn exactly the claims about them to "not reproduced"; few, disturbed or missing rows make
# them "underpowered"; the paper's sentences follow, and no number in them is nonsense. claims.sh [PROGRAM].
# One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
CUVETTE=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
export CUVETTE
build=$(realpath "${BUILD:-$root/build}")
unset ENVIRONMENT RESULTS
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-claims.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$root" || exit 1

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
same() { # WHAT HAVE WANT
    [[ $2 == "$3" ]]
    verdict $? "$1" "have '$2', expected '$3'"
}

reference=results/reference
[[ -d $reference ]] || {
    echo "ok 1 # SKIP there is no reference run"
    exit 0
}
command -v python3 >/dev/null || {
    echo "ok 1 # SKIP python3 is not installed"
    exit 77
}

# A folder with the committed rows, whose studies and tables can be replaced: tables of cells, or all if there are any.
mirror() { # NAME
    mkdir -p "$work/$1/tables"
    local entry
    for entry in "$root/$reference"/*; do
        [[ ${entry##*/} == tables ]] || ln -s "$entry" "$work/$1/"
    done
    if [[ -d $work/rows/tables && $1 != rows ]]; then
        cp -p "$work/rows/tables"/* "$work/$1/tables/"
    else
        cp -p "$root/$reference"/tables/*-{metrics,curve-errors,motion}.tsv "$work/$1/tables/"
    fi
}
copy() { # NAME STUDY...: these studies of a mirror are copies that can be edited
    local folder=$work/$1 study
    mirror "$1"
    shift
    for study; do
        rm "$folder/$study"
        cp -r "$root/$reference/$study" "$folder/$study"
    done
}
tables() { # FOLDER [STUDY...]
    experiments/tables.sh "$@" 2>"$work/tables-said"
}
judge() { # RESULTS OUT: the verdicts in OUT/claims.tsv; sets code
    paper/claims.py "$1" "$2" >"$work/said" 2>&1
    code=$?
}
with() { # OUT VERDICT: ids with that verdict, in one line
    awk -F'\t' -v verdict="$2" '$2 == verdict { printf "%s%s", space, $1; space = " " }' "$1/claims.tsv"
}
of() { # OUT ID FIELD
    awk -F'\t' -v id="$2" -v field="$3" '$1 == id { print $field }' "$1/claims.tsv"
}
# Claims whose verdict is another one than on the reference, as "id: verdict".
changed() { # OUT
    join -t "$(printf '\t')" <(cut -f 1,2 "$work/reference/claims.tsv" | sort) <(cut -f 1,2 "$1/claims.tsv" | sort) |
        awk -F'\t' '$2 != $3 { printf "%s%s: %s", comma, $1, $3; comma = ", " }'
}
recheck() { "$build/tests/recheck" "$1" "$(dirname "$1")/runs.json"; } # FILE: of edited rows
# Sets a column of the rows where an awk condition over the function f("column") holds.
edit() { # FILE CONDITION COLUMN VALUE (awk expressions)
    awk -F, -v OFS=, 'function f(name) { return $at[name] }
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; print; next }
        '"$2"' { $at["'"$3"'"] = '"$4"' } { print }' "$1" >"$1.new" && mv "$1.new" "$1"
    recheck "$1"
}

# --- the list
claims() { grep -v '^#' paper/claims.tsv | tail -n +2; }
empty "ids of claims are unique" "$(claims | cut -f 1 | sort | uniq -d)"
empty "every claim has a sentence, numbers and a predicate" "$(claims | awk -F'\t' '
    NF != 9 || length($2) < 20 || $5 !~ /^[0-9]+$/ || $6 $7 !~ /^[0-9.]+$/ || $9 == "" { print $1 }')"
needs=$(claims | while IFS=$'\t' read -r id _ _ needs _ _ _ _ predicate; do
    if [[ $predicate == - ]]; then
        [[ $needs == make\ * || -x $needs ]] || echo "$id: $needs"
        continue
    fi
    for study in $needs; do
        [[ -r experiments/$study.study || -r experiments/full/$study.study || -x experiments/$study.sh ||
            $study == published ]] || echo "$id: $study"
    done
done)
empty "every claim needs studies or a command that exist" "$needs"
in_paper() { grep -hv '^%' paper/{paper,supplement}.tex | grep -o '\\claim{[a-z-]*}' | sed 's/.*{//; s/}//' | sort -u; }
empty "paper and supplement state every claim that rows decide, and no other" \
    "$(diff <(claims | awk -F'\t' '$9 != "-" { print $1 }' | sort) <(in_paper))"

empty "the tables, figures and sections that a claim names exist" "$(comm -23 \
    <(claims | cut -f 3 | tr ' ' '\n' | grep -v '^-$' | sort -u) \
    <(grep -oh '\\label{[^}]*}' paper/{paper,supplement}.tex | sed 's/.*{//; s/}//' | sort -u))"
for text in paper supplement; do
    empty "every measured number of a sentence of the $text is in a claim" \
        "$(awk -f tests/experiments/unclaimed.awk "paper/$text.tex")"
done
# The check itself: a number after a claim, within a macro, in a caption, and published.
cat >"$work/unclaimed.tex" <<'END'
\newcommand{\row}[2][x]{\val{in/#1}
  \val{a/macro}}
\claim{c}{With \val{in/a-claim}.} It takes \val{depth/8/cpu_s_median}\,ms and
\valor{--}{b/c}.\caption{\val{in/a-caption}}\val{published/depth/4/cpu}
END
same "a number outside a claim would be found" \
    "$(awk -f tests/experiments/unclaimed.awk "$work/unclaimed.tex" | tr '\n' ' ')" \
    "3: depth/8/cpu_s_median 4: b/c "

# --- the tables
mirror rows
rows=$work/rows
tables "$rows"
same "the committed rows have tables" "$?$(<"$work/tables-said")" 0
empty "one for each study" "$(for file in "$rows"/*/rows.csv; do
    study=$(basename "$(dirname "$file")")
    [[ ! -r experiments/$study.study || -s $rows/tables/$study.tsv ]] || echo "$study"
done)"
empty "none is left half-written" "$(find "$rows/tables" -mindepth 1 ! -name '*.tsv')"
lines() { awk -F'\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "n") n = i } NR > 1 && $n > 0' "$1" | wc -l; }
copy some depth
rm "$work/some/tables/threads.tsv"
touch -d '2001-01-01' "$work/some/tables/depth.tsv"
tables "$work/some" depth
[[ ! $work/some/tables/depth.tsv -nt $reference/depth/rows.csv && ! -e $work/some/tables/threads.tsv ]]
verdict $? "a table that did not change stays as it is, and only the studies that are named have new ones"
environment=$(awk -F'\t' 'NR == 2 { print $NF }' "$rows/tables/depth.tsv")
ENVIRONMENT=$environment tables "$work/some" depth
cmp -s "$rows/tables/depth.tsv" "$work/some/tables/depth.tsv"
verdict $? "ENVIRONMENT chooses one"
ENVIRONMENT=0123abcd tables "$work/some" depth
same "of another one there are no rows" "$(lines "$work/some/tables/depth.tsv")" 0
judge "$work/some" "$work/out"
same "and they decide nothing" "$(of "$work/out" depth-cut 2)" underpowered
ENVIRONMENT=loud tables "$work/some"
same "a wrong environment is an error" "$? $(<"$work/tables-said")" \
    "2 tables: invalid environment 'loud'; give the 8 hex digits of one, as in the last column of a summary"
sed -i 's/,/;/' "$work/some/depth/rows.csv"
tables "$work/some" depth
same "rows that give no table are an error" "$? $(tail -n 1 "$work/tables-said")" \
    "1 tables: no table of depth, for the reasons above"
[[ ! -e $work/some/tables/depth.tsv ]]
verdict $? "and the old table is gone"

# --- the committed rows
judge "$rows" "$work/reference"
same "make claims succeeds on the committed rows" "$code" 0
same "every claim has a verdict" "$(cut -f 1 "$work/reference/claims.tsv" | sort | tr '\n' ' ')" \
    "$(claims | cut -f 1 | sort | tr '\n' ' ')"
empty "each is reproduced or underpowered" \
    "$(awk -F'\t' '$2 != "reproduced" && $2 != "underpowered" { print $1 ": " $2 }' "$work/reference/claims.tsv")"
empty "a claim without a figure has a reason" \
    "$(awk -F'\t' '$4 == "-" && ($3 == "-" || $2 == "underpowered") { print $1 }' "$work/reference/claims.tsv")"
grep -qE '^environment [0-9a-z]+: [0-9]+ studies$' "$work/said"
verdict $? "the environment is printed" "$(<"$work/said")"
empty "a claim with rows is undecided only if its interval is too wide or others disturbed them" "$(awk -F'\t' '
    NR == FNR { if ($9 == "-") unmeasured[$1] = 1; next }
    $2 == "underpowered" && !($1 in unmeasured) &&
        $4 !~ /^the interval is too wide|rows are disturbed|with processors>=2$/ { print $1 ": " $4 }
    $2 != "underpowered" && $1 in unmeasured { print $1 }' <(claims) "$work/reference/claims.tsv")"
empty "and no sentence of a reproduced claim lacks a number" \
    "$(grep -F 'without all numbers' "$work/reference/claims.tex")"
# Only times have such intervals: counts, errors and films are exact.
empty "and those are claims about times" "$(awk -F'\t' '
    NR == FNR { about[$1] = $9; next }
    $4 == "the interval is too wide to decide" &&
        about[$1] !~ /_s[^a-z_]|_s$|[.]price/ { print $1 ": " about[$1] }' \
    <(claims) "$work/reference/claims.tsv")"

# LaTeX may not be installed: what it reads is well formed.
empty "numbers.tex and claims.tex have balanced braces and no special characters" "$(awk '
    { line = $0; gsub(/\\./, "", line); open = gsub(/[{]/, "", line); close_ = gsub(/[}]/, "", line) }
    /^\\setval|^\\setclaim/ && (open != close_ || line ~ /[&#_%]/) && $0 !~ /^\\setval[{][^}]*_/ { print }
    /^\\setval[{][^}]*_/ && open != close_ { print }' "$work/reference/numbers.tex" "$work/reference/claims.tex")"
empty "every \\begin of the paper has its \\end, and braces are balanced" "$(awk '
    /^[ \t]*%/ { next }
    { line = $0; gsub(/\\\\/, "", line); gsub(/\\[{}%]/, "", line); sub(/%.*/, "", line)
      text = line; depth += gsub(/[{]/, "", text) - gsub(/[}]/, "", text)
      # Those of \newenvironment are in two parts.
      if (line ~ /newenvironment/) next
      while (match(line, /\\(begin|end)[{][a-z*]+[}]/)) {
          name = substr(line, RSTART, RLENGTH)
          line = substr(line, RSTART + RLENGTH)
          kind = name ~ /begin/ ? 1 : -1
          gsub(/.*[{]|[}]/, "", name)
          if (kind > 0) stack[++top] = name
          else if (stack[top--] != name) print FNR ": \\end{" name "}"
      } }
    END { if (depth) print "braces: " depth; if (top) print "open: " stack[top] }' paper/{paper,supplement}.tex)"

# --- wrong rows: exactly the claims about them turn
copy wrong profile lighting polarised pool shading
edit "$work/wrong/profile/rows.csv" 'NR == 9' film_hash '"00000000000000aa"'
edit "$work/wrong/profile/rows.csv" 'NR == 9' marked 1
edit "$work/wrong/lighting/compare.csv" 'f("render.lighting") == "whitted"' flip 0.5
edit "$work/wrong/polarised/rows.csv" 'f("render.polarisation") == "on"' cpu_s 'f("cpu_s") * 10'
edit "$work/wrong/pool/rows.csv" 'f("render.pool") == "off" && f("render.threads") > 1' wall_s 'f("wall_s") * 0.3'
# A cost that is lost in noise is no number, though its claim is reproduced.
edit "$work/wrong/shading/rows.csv" \
    'f("model.shading") == "smooth" && f("render.integrator") == "whitted" && f("render.shadows") == "off"' \
    cpu_s 'f("cpu_s") * (f("process") == 1 ? 0.8 : f("process") == 2 ? 1 : 1.25)'
tables "$work/wrong" profile lighting polarised pool shading
grep -q '^profile: ' "$work/tables-said"
verdict $? "a marked row is named" "$(<"$work/tables-said")"
awk -F'\t' -v OFS='\t' 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
    NR > 1 && !done && $at["passes"] == 1 { $at["passes"] = 0; done = 1 } { print }' \
    "$rows/tables/realism-metrics.tsv" >"$work/wrong/tables/realism-metrics.tsv"
judge "$work/wrong" "$work/wrong-out"
turned="film-marked: not reproduced, film-threads: not reproduced, lighting: not reproduced"
turned+=", polarised-cost: not reproduced, pool-few: not reproduced, pool-many: not reproduced"
turned+=", pool-some: not reproduced, theory: not reproduced"
same "another film, a larger error, slower and faster rows, a failed metric: not reproduced" \
    "$(changed "$work/wrong-out")" "$turned"
same "a claim that is not reproduced gives status 1" "$code" 1
[[ $(of "$work/wrong-out" polarised-cost 3) =~ ^2[01]\.[0-9]\ \[[0-9.]+,\ [0-9.]+\]$ ]]
verdict $? "the figure has its interval" "$(of "$work/wrong-out" polarised-cost 3)"

# --- rows that cannot decide: few, disturbed, of a wide spread, none
copy few polarised profile pool lighting
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i } NR == 1 || $at["repetition"] < 5' \
    "$reference/polarised/rows.csv" >"$work/few/polarised/rows.csv"
recheck "$work/few/polarised/rows.csv"
edit "$work/few/profile/rows.csv" 'NR > 1' others_fraction 0.7
edit "$work/few/pool/rows.csv" 'NR % 2' wall_s 'f("wall_s") * 4'
rm -r "$work/few/lighting"
tables "$work/few" polarised profile pool lighting
judge "$work/few" "$work/out"
turned="film-marked: underpowered, lighting: underpowered, lighting-highlights: underpowered"
turned+=", polarised-cost: underpowered, pool-many: underpowered, profile-blocks: underpowered"
turned+=", rows-quiet: not reproduced"
same "they are underpowered, and the claim about disturbed rows is not reproduced" "$(changed "$work/out")" "$turned"
[[ $(of "$work/out" polarised-cost 4) == "3 rows of a cell, 6 are needed" ]]
verdict $? "the reason says how many are needed" "$(of "$work/out" polarised-cost 4)"
grep -q 'disturbed or marked' <<<"$(of "$work/out" profile-blocks 4)"
verdict $? "or that they are disturbed" "$(of "$work/out" profile-blocks 4)"
same "or that the interval is too wide" "$(of "$work/out" pool-many 4)" "the interval is too wide to decide"
grep -q '^for the missing rows: cuvette study run experiments/lighting.study$' "$work/said"
verdict $? "the command that measures missing rows is printed" "$(tail -n 3 "$work/said")"
mkdir "$work/empty"
judge "$work/empty" "$work/out"
same "a folder without tables of rows is an error" "$code" 2
grep -q 'make experiments' "$work/said"
verdict $? "with a remedy" "$(<"$work/said")"
tables "$work/empty"
same "a folder without rows too, in which nothing is written" "$? $(<"$work/tables-said")$(ls "$work/empty")" \
    "2 tables: there are no rows in $work/empty; run make experiments, or give another folder"

# --- the paper: its text with the sentences that it chooses, the numbers filled in
# A claim is a sentence or several: what is printed in its place is one, too, and nothing of it may be left over.
# shellcheck disable=SC2016
empty "each claim in the paper is whole sentences" "$(perl -0777 -ne '
    while (/\\claim\{([^}]*)\}(\{(?:[^{}\\]|\\.|(?2))*\})(.?\s*.?)/gs) {
        my ($id, $text, $after) = ($1, $2, $3);
        my $whole = $text =~ /^\{["\\A-Z0-9]/ && $text =~ /[.)]\}$/;
        print "$ARGV: $id\n" unless $whole && $after =~ /^\s*[A-Z0-9\\(%\x27]?$/;
    }' paper/paper.tex paper/supplement.tex)"
text() { # OUT
    awk -f tests/experiments/paper_text.awk "$1/numbers.tex" "$1/claims.tex" paper/paper.tex paper/supplement.tex
}
# Numbers that say nothing: costs that are negative, and none at all. Tables may have n/a.
nonsense() { # OUT
    local ends='(~|\\(within|ranging)\{[^}]*\}\{[^}]*\})?'
    text "$1" | tr '\n' ' ' |
        grep -oE ".{0,60}(n/a|[^a-z](nan|inf)[^a-z]|ensuremath\{-\}[0-9.]+$ends\\\\,(ms|\\\\%|s|MiB)).{0,20}"
}
# The check itself: one negative cost in numbers.tex, where no claim protects it.
mkdir -p "$work/bad"
sed 's/^\\setval{pool\/1024\/added}.*/\\setval{pool\/1024\/added}{\\ensuremath{-}35.57}/' \
    "$work/reference/numbers.tex" >"$work/bad/numbers.tex"
touch "$work/bad/claims.tex"
nonsense "$work/bad" | grep -q -- '-}35.57'
verdict $? "a negative cost would be noticed" "$(nonsense "$work/bad")"
empty "the paper has every number, and no negative cost" "$(nonsense "$work/reference")"
text "$work/reference" >"$work/plain"
grep -q 'These rows cannot establish whether} new threads for every frame cost time with 2 threads' "$work/plain"
verdict $? "an undecided sentence is replaced" "$(grep -n 'New threads add' "$work/plain")"
tr '\n' ' ' <"$work/plain" | grep -qE '[0-9]\\within\{[0-9.]+\}\{[0-9.]+\}\\,ms to a frame with 1024 threads'
verdict $? "a reproduced one is kept, with its interval" "$(grep -n 'frame with 1024' "$work/plain")"

text "$work/wrong-out" >"$work/plain"
instead='Not reproduced on these rows:} new threads for every frame cost time with 1024 threads'
grep -q "$instead (measured: -[0-9.]* \[-[0-9., -]*\] ms)" "$work/plain"
verdict $? "the paper says so instead of adding negative times" "$(grep -n '1024 threads' "$work/plain")"
empty "and has no negative cost anywhere" "$(nonsense "$work/wrong-out")"
grep -q 'Reproduced, but without all numbers of this sentence:} Phong shading takes more' "$work/plain"
verdict $? "a sentence does not print a cost that is lost in noise" "$(grep -n 'Phong shading' "$work/plain")"

# --- intervals of any column agree with those of the summary
spread=$("$CUVETTE" study summary --results "$reference" --interval wall_s,wall_s/wall_s experiments/depth.study)
summary=$("$CUVETTE" study summary --results "$reference" experiments/depth.study)
columns='$1, $at["n"]'
for part in median low high min max; do columns+=", \$at[\"wall_s_$part\"]"; done
named() { # PROGRAM: awk with the columns of the header line in at
    awk -F'\t' "NR == 1 { for (i = 1; i <= NF; i++) at[\$i] = i; next } $1"
}
of_column() { # COLUMN: cell, n, median, low, high, min, max
    named "\$at[\"column\"] == \"$1\" { print ${columns//wall_s_/} }" <<<"$spread"
}
same "summary --interval wall_s is the summary's interval" "$(of_column wall_s)" \
    "$(named "{ print $columns }" <<<"$summary")"
empty "a quotient is formed row by row" "$(of_column wall_s/wall_s | grep -vE ' [0-9]+ 1 1 1 1 1$')"
refuses() { # WHAT ARGUMENT PART
    local said
    said=$("$CUVETTE" study summary --results "$reference" --interval "$2" experiments/depth.study 2>&1)
    (($? == 2)) && [[ $said == *"$3"* ]]
    verdict $? "$1" "$said"
}
refuses "an unknown column is an error" wall_z "no column 'wall_z'"
refuses "an empty column is an error" wall_s, "invalid list"
refuses "a quotient without a divisor is an error" wall_s/ "invalid list"

# --- the language of predicates
tabs() { tr ' ' '\t'; }
mkdir -p "$work/small/tables"
tabs >"$work/small/tables/t.tsv" <<'END'
cell a.b kind n cpu_s_median cpu_s_low cpu_s_high rays marked
0 1 x 9 1 0.9 1.1 100 0
1 2 x 9 2 1.9 2.1 200 0
2 3 y 9 2.05 1.95 2.15 300 1
END
# The cell with the larger median has the narrower interval; the other way round for the smaller one.
tabs >"$work/small/tables/wide.tsv" <<'END'
cell a.b n wall_s_median wall_s_low wall_s_high slow_s_median slow_s_low slow_s_high rays marked
0 1 12 0.90 0.89 0.91 2 1.9 2.1 1 0
1 2 12 0.85 0.60 1.30 3 0.5 4 1 0
END
cat >"$work/predicates.py" <<'END'
"""Prints the verdict and the figure of each predicate of standard input, or why it is malformed."""
import pathlib
import sys

sys.path.insert(0, "paper")
import claims
from paper_numbers import Numbers, scientific, signed

numbers = Numbers()
numbers.put("fit/a", scientific(0.0025))
numbers.put("fit/b", signed("-0.5"))
tables = claims.Tables(pathlib.Path(sys.argv[1]))
claim = {"id": "c", "sentence": "s", "needs": "t", "rows": "6", "disturbed": "0.5", "tolerance": "0.2", "unit": "-"}
for line in sys.stdin:
    try:
        verdict = claims.judge(claim | {"predicate": line.rstrip("\n")}, tables, numbers, {})
        print(verdict.verdict, verdict.figure)
    except claims.Malformed as wrong:
        print("malformed:", wrong)
END
predicates() { python3 -B "$work/predicates.py" "$work/small/tables"; }
cat >"$work/predicates" <<'END'
t[b=1].cpu_s < 1.2|reproduced 1.00 [0.90, 1.10]
t[b=1].cpu_s > 1.2|not reproduced 1.00 [0.90, 1.10]
t[b=1].cpu_s > 1|underpowered 1.00 [0.90, 1.10]
t[b=2].cpu_s / t[b=1].cpu_s > 1|reproduced 2.00 [1.73, 2.33]
t[b=2].cpu_s - t[b=1].cpu_s > 0.5|reproduced 1.00 [0.80, 1.20]
t[b=2].cpu_s / t[b=3].cpu_s ~ 1|reproduced 0.976 [0.884, 1.077]
t[b=2].cpu_s / t[b=1].cpu_s ~ 1|not reproduced 2.00 [1.73, 2.33]
t[b=2].cpu_s / t[b=1].cpu_s ~ 1.9|underpowered 2.00 [1.73, 2.33]
1 / (t[b=3].cpu_s - t[b=2].cpu_s) > 0|underpowered 20 (unknown error)
t[b=2].rays = 200 and t[b=3].rays >= 300|reproduced 200; 300
t[b=2].rays = 200 and t[b=3].rays < 300|not reproduced 200; 300
sum(t[kind=x].rays) = 300|reproduced 300
most(t[].rays) - least(t[b>1].rays) = 100|reproduced 100
count(t[b<=2 kind!=y].rays) = 2|reproduced 2
most(wide[].wall_s) < 1|underpowered 0.90 [0.89, 1.30]
most(wide[].wall_s) < 1.31|reproduced 0.90 [0.89, 1.30]
most(wide[b=1].wall_s) < 1|reproduced 0.900 [0.890, 0.910]
least(wide[].slow_s) > 1|underpowered 2.00 [0.50, 2.10]
least(wide[].slow_s) > 0.4|reproduced 2.00 [0.50, 2.10]
least(wide[].wall_s) > 0.7|underpowered 0.85 [0.60, 0.91]
distinct(t[].kind) = 2|reproduced 2
rises(t[].rays) = 1|reproduced 1
falls(t[].rays) = 1|not reproduced 0
rises(t[].cpu_s) = 1|underpowered 0.50 [0.00, 1.00]
rises(t[kind=x].cpu_s) = 1|reproduced 1
{fit/a} * 2 = 0.005 and -{fit/b} = 0.5|reproduced 0.005; 0.5
t[b=4].rays = 1|underpowered -
u[].rays = 1|underpowered -
{fit/c} = 1|underpowered -
t[b=1].none = 1|underpowered -
t[none=1].rays = 1|underpowered -
END
while IFS='|' read -r text wanted have; do
    same "$text" "$have" "$wanted"
done < <(cut -d '|' -f 1 "$work/predicates" | predicates 2>&1 | paste -d '|' "$work/predicates" -)
for text in 't[b=1].rays' 't[].rays = 1' 't[b=1].rays = ' 't[b=1].rays = 1 or 2' 't[b~1].rays = 1' 'x = 1'; do
    have=$(predicates <<<"$text")
    [[ $have == malformed:* ]]
    verdict $? "malformed: $text" "$have"
done
conclude
