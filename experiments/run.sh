#!/bin/bash
# Run studies one after the other; after each, make its tables and draw the figures whose tables and files are then
# there. Prints a line per study, with the time left, and the closing page. A run that was stopped goes on when it is
# started again.
#   experiments/run.sh [--quick] [--results DIR] [STUDY.study...]
# Without studies: those of this folder, in the order below. --quick: `cuvette study run --quick`, for a look.
# CUVETTE: the program (default: build/cuvette). Status 130 after Ctrl-C; 1 if anything failed, the other studies are
# run all the same.
set -uo pipefail
export LC_ALL=C.UTF-8
root=$(cd "$(dirname "$0")/.." && pwd)
first='portrait depth ior threads profile ior-images methods lighting realism visible-grid triangles coverage crowding'

fail() {
    echo "run.sh: $*" >&2
    exit 2
}

quick=()
results=
given=()
while [[ $# -gt 0 ]]; do
    case $1 in
    --quick) quick=(--quick) ;;
    --results)
        results=${2:-}
        [[ -n $results ]] || fail '--results is empty; give a folder'
        shift
        ;;
    -*) fail "unknown option $1; usage: experiments/run.sh [--quick] [--results DIR] [STUDY.study...]" ;;
    *) given+=("$1") ;;
    esac
    shift
done
program=${CUVETTE:-$root/build/cuvette}
[[ -x $program ]] || fail "there is no program $program; run make"
committed=$root/results/reference${quick:+/quick}
results=${results:-$root/results${quick:+/quick}}
mkdir -p "$results/tables" || fail "$results cannot be made; give --results another folder"
results=$(cd "$results" && pwd)

# Those that give the first figures come first.
rank=()
[[ ${#given[@]} -gt 0 ]] || given=("$root"/experiments/*.study)
for file in "${given[@]}"; do
    [[ -r $file ]] || fail "there is no study $file"
    name=${file##*/}
    name=${name%.study}
    before=" $first "
    before=${before%% "$name" *}
    rank+=("${#before}	$file")
done
mapfile -t files < <(printf '%s\n' "${rank[@]}" | sort -sn -k 1,1 | cut -f 2-)

# Seconds that the committed run of each study took, a line each; 1 where it is unknown.
committed_s() { # STUDY...
    if ! command -v python3 >/dev/null; then
        printf '1%.0s\n' "$@"
        return
    fi
    python3 - "$committed" "$@" <<'END'
import datetime, json, pathlib, sys

def moment(text):
    return datetime.datetime.strptime(text, "%Y-%m-%dT%H:%M:%S.%fZ")

for study in sys.argv[2:]:
    path = pathlib.Path(sys.argv[1], study, "runs.json")
    runs = json.loads(path.read_text(encoding="utf-8"))["runs"] if path.is_file() else []
    took = [moment(run["ended_utc"]) - moment(run["started_utc"]) for run in runs if run.get("ended_utc")]
    print(sum(took, datetime.timedelta()).total_seconds() if runs else 1)
END
}

# The figures that need a file of the study and have all files that they need (the `# needs:` lines of their scripts).
figures_of() { # STUDY
    local script need own
    for script in "$root"/plots/*.gp; do
        own=
        while read -r need _; do
            case $need in
            tables/"$1".tsv | tables/"$1"-metrics.tsv | tables/"$1"-curves.tsv | tables/"$1"-motion.tsv) own=1 ;;
            tables/"$1"[[]* | "$1"/*) own=1 ;;
            esac
            compgen -G "$results/$need" >/dev/null || continue 2
        done < <(sed -n 's/^# needs: *//p' "$script")
        [[ -z $own ]] || basename "$script" .gp
    done
}

failed=()
wrong() { # WHAT
    failed+=("$1")
    echo "run.sh: $1 failed; see above" >&2
}
interrupted() {
    echo "run.sh: interrupted; all rows are kept, run it again to go on" >&2
    exit 130
}
trap interrupted INT TERM HUP

minutes() { # SECONDS
    awk -v s="$1" 'BEGIN {
        if (s < 90) printf "%d s", s
        else printf "%d min", s / 60 + 0.5
    }'
}

# The time left: what the committed run took for the rest, by how much longer the studies so far took than there.
names=("${files[@]##*/}")
names=("${names[@]%.study}")
mapfile -t expected < <(committed_s "${names[@]}")
expected_done=0 took_done=0
time_left() { # INDEX of the next study
    awk -v done="$expected_done" -v took="$took_done" -v rest="${expected[*]:$1}" 'BEGIN {
        for (n = split(rest, s, " "); n > 0; n--) sum += s[n]
        print sum * (took + 20) / (done + 20)
    }'
}

log=$(mktemp "${TMPDIR:-/tmp}/cuvette-run.XXXXXX")
trap 'rm -f "$log"' EXIT
quiet=()
for i in "${!files[@]}"; do
    name=${names[i]}
    place=$(printf '[%2d/%d]' "$((i + 1))" "${#files[@]}")
    [[ ! -t 2 ]] || echo "$place $name: about $(minutes "$(time_left "$i")") left" >&2
    start=$EPOCHREALTIME
    "$program" study run "${quiet[@]}" "${quick[@]}" --results "$results" "${files[i]}" >"$log"
    status=$?
    [[ $status != 130 ]] || interrupted
    quiet=(--quiet --progress) # notes on the machine once
    if [[ $status != 0 ]]; then
        wrong "$name"
        continue
    fi
    "$root/experiments/tables.sh" "$results" "$name" >"$log" 2>&1 || { cat "$log" >&2 && wrong "the tables of $name"; }
    mapfile -t figures < <(figures_of "$name")
    : >"$log"
    [[ ${#figures[@]} -eq 0 ]] ||
        "$root/plots/draw.sh" --results "$results" "${figures[@]}" >"$log" 2>&1 || {
        cat "$log" >&2
        wrong "a figure of $name"
    }
    drawn=$(sed -n 's/: drawn.*//p' "$log" | paste -sd ' ')
    took=$(awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN { print b - a }')
    expected_done=$(awk -v a="$expected_done" -v b="${expected[i]}" 'BEGIN { print a + b }')
    took_done=$(awk -v a="$took_done" -v b="$took" 'BEGIN { print a + b }')
    printf '%s %s: %s%s; about %s left\n' "$place" "$name" "$(minutes "$took")" \
        "${drawn:+, figures $drawn}" "$(minutes "$(time_left $((i + 1)))")"
done

if [[ -d $committed ]]; then
    "$program" study films --results "$results" --against "$committed" "${files[@]}" \
        >"$results/tables/reproduced.tsv.new" ||
        wrong 'the comparison of films'
    mv "$results/tables/reproduced.tsv.new" "$results/tables/reproduced.tsv"
fi
echo
printf -v list '%s, ' "${failed[@]}"
"$root/experiments/report.sh" "$results" "${failed:+${list%, }}" || exit 1
[[ ${#failed[@]} -eq 0 ]]
