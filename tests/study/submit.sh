#!/bin/bash
# `cuvette study submit --slurm` with programs that take the place of squeue and sbatch: submit.sh [PROGRAM]. They
# note their arguments and run the jobs at once. tests/study/slurm.sh uses Slurm itself.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-submit.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CUVETTE_ISA CUVETTE_NODE_TYPE CUVETTE_MACHINE

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

mkdir slurm "a folder"
cat >slurm/squeue <<'END'
#!/bin/bash
[[ ! -e queue ]] || cat queue
END
# Job 11 is the array, 12 the one that merges. The parts named in the file "lost" are not run.
cat >slurm/sbatch <<'END'
#!/bin/bash
printf '%s\n' "$*" >>calls
[[ ! -e refusal ]] || { cat refusal >&2; exit 1; }
while [[ $1 == -* ]]; do
    [[ $1 != --array=* ]] || array=${1#*=}
    shift
done
export SLURM_JOB_ID=1
if [[ ${2-} == merge ]]; then
    bash "$@" >merge.out 2>&1
    echo 12
    exit
fi
[[ -n ${array-} ]] || exit 1
IFS=, read -ra ranges <<<"$array"
for range in "${ranges[@]}"; do
    for part in $(seq "${range%-*}" "${range#*-}"); do
        grep -sqx "$part" lost || SLURM_ARRAY_TASK_ID=$part bash "$1" >part.out 2>&1
    done
done
echo 'sbatch: warning: the weather is bad' >&2
echo '11;cluster'
END
chmod +x slurm/*
cat >small.study <<END
study: small
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 20, render.height: 15}
grid:
  - {render.depth: [0, 1, 2, 3, 4]}
repetitions: 2
warmups: 0
END

submit() { # ARGUMENT...: its results are in out, err and code
    rm -f calls
    PATH=$work/slurm:$PATH "$program" study submit "$@" >out 2>err
    code=$?
}
fails() { # WHAT LINE: the last submission failed with this one line
    [[ $code != 0 && ! -s out && $(wc -l <err) == 1 ]] && grep -qF -- "$2" err
    verdict $? "$1" "$(cat out err)"
}
same() { # WHAT FILE LINE...
    local what=$1 file=$2
    shift 2
    empty "$what" "$(diff "$file" <(printf '%s\n' "$@"))"
}

# --- dry run
PATH=$work/none "$program" study submit --slurm --dry-run small.study --partition long --tasks 3 --time 90 \
    --sbatch=--exclusive --node-type "the thin ones" >out 2>err
same "a dry run prints what it would submit, without Slurm" <(head -3 out) \
    "small: 3 of 3 parts to run, 10 rows to measure" \
    "sbatch --exclusive --parsable --array=0-2 results/small/slurm/study.slurm" \
    "sbatch --exclusive --parsable --dependency=afterany:JOB --output=merge.log results/small/slurm/study.slurm merge"
same "the script has what was asked" <(grep -E '^#SBATCH --(job|part|cons|cpus|mem|time)|^[a-z]*=|NODE_TYPE' out) \
    "#SBATCH --job-name=cuvette-small" "#SBATCH --partition=long" "#SBATCH --cpus-per-task=1" "#SBATCH --mem=1G" \
    "#SBATCH --time=90" "program=$program" "study=small.study" "results=results" "parts=3" "by=cell" \
    "export CUVETTE_NODE_TYPE='the thin ones'"
tail -n +5 out | bash -n
verdict $? "the script is valid bash"
[[ ! -e results && ! -s err ]]
verdict $? "a dry run writes nothing"

# --- submission, resubmission
echo 1 >lost
rows="a folder/rows"
submit --slurm small.study --results "$rows" --tasks 3
same "all parts are submitted, then the job that merges" calls \
    "--parsable --array=0-2 a folder/rows/small/slurm/study.slurm" \
    "--parsable --dependency=afterany:11 --output=merge.log a folder/rows/small/slurm/study.slurm merge"
same "the jobs are named" out "small: 3 of 3 parts to run, 10 rows to measure" \
    "$(grep -E '^small: time limit 00:10:00 for each: 3 times the estimate of the longest, .* s, at least' out)" \
    "small: job 11 measures, then job 12 merges and verifies the rows; script and logs are in $rows/small/slurm" \
    "small: run the same command again when they have ended: it submits the parts that are then missing"
grep -q "^small: 3 of 5 cells done" merge.out
verdict $? "the rows of the parts that ran are merged" "$(<merge.out)"
rm lost
submit --slurm small.study --results "$rows" --tasks 3
same "only the part that is missing is submitted again" <(head -1 calls) \
    "--parsable --array=1 a folder/rows/small/slurm/study.slurm"
grep -q "^small: 10 rows, 0 faults" merge.out && grep -q "^small: 5 of 5 cells done" merge.out
verdict $? "all rows are merged and verified" "$(<merge.out)"
submit --slurm small.study --results "$rows" --tasks 3
[[ $code == 0 && ! -e calls ]] && grep -q '^small: complete, nothing to submit' out
verdict $? "a complete study submits nothing" "$(cat out err)"
submit --slurm small.study --results "$rows" --tasks 3 --partition other
same "nodes of another type measure all" <(head -1 calls) "--parsable --array=0-2 a folder/rows/small/slurm/study.slurm"
grep -q "note: small: 10 rows of other machines or builds do not count for nodes of type 'other'" err
verdict $? "and a note says that the rows of the first type do not count" "$(cat out err)"
submit --slurm small.study --results "$rows" --tasks 3 --partition other
[[ ! -s err ]]
verdict $? "once they have rows, no note" "$(cat out err)"
submit --slurm small.study --results by --by repetition
same "repetitions can be divided" <(head -1 calls) "--parsable --array=0-1 by/small/slurm/study.slurm"
submit --slurm small.study --results by --by repetition
[[ $code == 0 && ! -e calls ]]
verdict $? "merged repetitions are complete" "$(cat out err)"

# --- errors, one line each
printf '40_[1-9%%2] %s\n' "$work/by/small/slurm/study.slurm" >queue
submit --slurm small.study --results by --partition other
fails "a study in the queue is not submitted twice" \
    "by/small/slurm/study.slurm: job 40 of this study is still in the queue; wait for its end, or end it with scancel"
rm queue
echo 'sbatch: error: invalid partition specified: nope
sbatch: error: Batch job submission failed: Invalid partition name specified' >refusal
submit --slurm small.study --partition nope
fails "sbatch's own message" "cuvette: sbatch: invalid partition specified: nope; nothing is submitted"
rm refusal
PATH=$work/none "$program" study submit --slurm small.study >out 2>err
code=$?
fails "no Slurm" "cuvette: squeue: the program is not found; submit on a machine with Slurm's commands"
submit small.study
fails "no cluster" "study submit: no cluster is named; add --slurm"
submit --slurm small.study --sbatch exclusive
fails "no option of sbatch" "--sbatch exclusive: this is not an option"
submit --slurm small.study --by part
fails "an unknown division" "--by: unknown division 'part'"
sed 's/depth/dehpt/' small.study >bad.study
submit --slurm bad.study
fails "a bad study is located" "bad.study:5:6: "
printf '#!/bin/bash\n#SBATCH --time=@tiem@\n' >own.slurm
submit --slurm small.study --template own.slurm
fails "a bad template is located" "own.slurm:2:16: unknown word @tiem@; use one of name, partition"
slow='{render.integrator: path, render.paths: 1048576, render.width: 800, render.height: 600}'
sed "s/^set: .*/set: $slow/" small.study >slow.study
submit --slurm slow.study
fails "an unknown time" "slow.study: the time of a part is unknown"

conclude
