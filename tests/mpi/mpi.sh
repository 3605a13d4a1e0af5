#!/bin/bash
# mpi.sh, run by `make test-mpi`: cuvette-mpi with real ranks of OpenMPI on this machine. Film, counts and noise
# are those of one process for any number of ranks; a rank that is killed ends the others with an error, what was
# written remains, and the same command goes on from there.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
cuvette=${CUVETTE:?} mpi=$(dirname "$CUVETTE")/cuvette-mpi
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-mpi.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 # root, as in a container
on_ranks() {                                                     # N ARGUMENT...
    local n=$1
    shift
    mpirun --oversubscribe --bind-to none -n "$n" "$mpi" "$@"
}

numbers() { # what must not depend on the ranks, of an account on standard input
    python3 -c '
import json, sys
o = json.load(sys.stdin)
n = o["noise"] or {}
print(o["film_hash"], o["rays"], o["rays_by_depth"], o["hits"], o["total_internal"], o["cut"], n.get("rms"))'
}

small=(--set render.width=203 --set render.height=151 --json)
for scene in rod models 'rod --set render.integrator=path --set render.paths=16' 'rod --set render.spectrum=spectral' \
    'rod --set render.polarisation=on' 'rod --set render.integrator=zbuffer' 'slime --set time_s=0.1' chequer; do
    read -ra words <<<"${scene/time_s/toy.time_s}"
    words[0]=experiments/scenes/${words[0]}.yaml
    expected=$("$cuvette" render "${words[@]}" "${small[@]}" | numbers)
    wrong=$([[ $expected ]] || echo 'one process failed')
    for n in 1 2 3 8; do
        found=$(on_ranks $n render "${words[@]}" "${small[@]}" 2>"$work/errors" | numbers 2>&1)
        [[ $found == "$expected" ]] || wrong+="$n ranks: $found instead of $expected $(cat "$work/errors")"$'\n'
    done
    empty "1, 2, 3 and 8 ranks: film, counts and noise of $scene" "$wrong"
done

notes=$(mpirun --oversubscribe -n 2 "$cuvette" render experiments/scenes/rod.yaml "${small[@]}" \
    2>&1 >/dev/null)
[[ $(grep -c 'cuvette-mpi divides' <<<"$notes") == 1 ]]
verdict $? 'cuvette itself under mpirun says once that each process does all the work' "$notes"

on_ranks 2 render experiments/scenes/rod.yaml "${small[@]}" --set render.threads=2 --set render.tile=16 \
    >"$work/account.json" 2>"$work/errors"
wrong=$(
    python3 - "$work/account.json" <<'PYTHON'
import json, sys
o = json.load(open(sys.argv[1]))
ranks, threads = o["ranks"], o["threads"]
if len(ranks) != 2 or [t["rank"] for t in threads] != [0, 0, 1, 1]:
    print("ranks", len(ranks), "threads of", [t["rank"] for t in threads])
if sum(t["tiles"] for t in threads) != 13 * 10:
    print("tiles", [t["tiles"] for t in threads])
sent = ranks[1]["tiles_sent"]
if sent != sum(t["tiles"] for t in threads if t["rank"] == 1) or ranks[0]["tiles_sent"] != 0:
    print("sent", [r["tiles_sent"] for r in ranks])
if sent and not 16 * 7 * 24 <= ranks[1]["bytes_sent"] / sent <= 16 * 16 * 24 + 16:
    print("bytes of a tile", ranks[1]["bytes_sent"] / sent)
PYTHON
)
empty 'the account has the work of each rank and each thread' "$wrong"

bad=()
refused() { # TEXT ARGUMENT...: exit 2, one line with that text, no file
    local text=$1 code
    shift
    on_ranks 2 "$@" >"$work/out" 2>"$work/errors"
    code=$?
    [[ $code == 2 && $(grep '^cuvette' "$work/errors" | grep -vc ': note:') == 1 ]] &&
        grep -q -- "$text" "$work/errors" || bad+=("$*: $code $(grep '^cuvette' "$work/errors")")
}
refused 'cannot open' render "$work/no.yaml" -o "$work/no.png"
refused 'did you mean' render experiments/scenes/rod.yaml -o "$work/no.png" --set render.dept=3
refused 'not sent between ranks' render experiments/scenes/rod.yaml --rays "$work/no.png"
refused 'the whole image' render experiments/scenes/rod.yaml -o "$work/no.png" --set render.integrator=path \
    --set render.paths=64 --set render.error=0.1
refused "use 'cuvette study'" study list
refused 'no study was given' study run
refused 'unknown command' paint
mkdir "$work/alone"
cp "$mpi" "$work/alone"
alone() { mpirun -n 1 "$work/alone/cuvette-mpi" study run "$work/x.study" 2>&1; }
[[ $(alone) == *'install cuvette next to cuvette-mpi'* ]] || bad+=('no remedy without cuvette')
: >"$work/alone/cuvette" # it is there, but cannot be started
[[ $(alone) == *'cannot start cuvette: Permission denied; change the permissions'* ]] || bad+=('a wrong remedy')
[[ ! -e $work/no.png ]] || bad+=('a file was written')
empty 'bad input gets one line, whatever the number of ranks' "${bad[*]:-}"

[[ $(on_ranks 3 --help | grep -c '^Usage') == 1 ]]
verdict $? 'help is printed once'

# A rank that dies: OpenMPI ends the others. The child that is not rank 0.
kill_a_rank() { # COUNT COMMAND...: once there are at least COUNT lines in the output; killed says whether it was
    local count=$1 pid
    shift
    rm -f "$work/killed"
    while :; do
        until (($("$@" 2>/dev/null | wc -l) >= count)); do sleep 0.05; done
        for pid in $(pgrep -f "^$mpi"); do
            if tr '\0' '\n' <"/proc/$pid/environ" 2>/dev/null | grep -q '^OMPI_COMM_WORLD_RANK=1$'; then
                : >"$work/killed"
                kill -KILL "$pid" && return
                rm "$work/killed"
            fi
        done
    done
}
no_more_kills() { # the ranks have ended
    kill $! 2>/dev/null
    wait
}

echo old >"$work/long.pfm"
kill_a_rank 3 pgrep -f "^$mpi" & # all have started
on_ranks 3 render experiments/scenes/rod.yaml --set render.integrator=path --set render.paths=4096 -o "$work/long.pfm" \
    >"$work/out" 2>"$work/errors"
code=$?
no_more_kills
[[ $code != 0 && $(cat "$work/long.pfm") == old ]] && grep -q 'signal 9' "$work/errors"
verdict $? 'a killed rank ends the frame with an error; no file is half-written' "$code $(cat "$work/errors")"

film=(animate experiments/scenes/slime.yaml --duration 1 --fps 20 --set render.width=240 --set render.height=180)
"$cuvette" "${film[@]}" -o "$work/one/%03d.png" >/dev/null 2>&1
kill_a_rank 3 find "$work/many" -name '*.png' &
on_ranks 3 "${film[@]}" -o "$work/many/%03d.png" >/dev/null 2>"$work/errors"
code=$?
no_more_kills
before=$(find "$work/many" -name '*.png' | wc -l)
on_ranks 2 "${film[@]}" -o "$work/many/%03d.png" >"$work/out" 2>&1
again=$?
if [[ ! -e $work/killed ]]; then
    skip 'the animation ended before a rank could be killed'
else
    [[ $code != 0 && $again == 0 ]] && ((before < 20)) && diff -r -x "*.json" "$work/one" "$work/many" >"$work/diff"
    verdict $? "an animation whose rank was killed after $before frames goes on with other ranks, with the same bytes" \
        "$code $again $(cat "$work/diff")"
fi

cat >"$work/many.study" <<STUDY
study: many
scene: $PWD/experiments/scenes/rod.yaml
set: {render.width: 800, render.height: 600}
grid:
  - {render.depth: [1, 2, 3, 4, 5, 6, 7, 8]}
  - {render.tile: [8, 16, 32, 64]}
repetitions: 6
warmups: 0
STUDY
all_rows() { cat "$work"/results/many/rows*.csv; }
kill_a_rank 40 all_rows &
on_ranks 3 study run --results "$work/results" "$work/many.study" >/dev/null 2>"$work/errors"
code=$?
no_more_kills
rows=$(all_rows | grep -vc '^study')
on_ranks 2 study run --results "$work/results" "$work/many.study" >"$work/out" 2>&1
again=$?
checked=$("$cuvette" study verify --results "$work/results" "$work/many.study" 2>&1)
if [[ ! -e $work/killed ]]; then
    skip 'the study ended before a rank could be killed'
else
    [[ $code != 0 && $again == 0 ]] && ((rows > 0 && rows < 192)) && grep -q '192 rows, 0 faults' <<<"$checked"
    verdict $? "a study whose rank was killed after $rows rows goes on with other ranks; no row is lost or doubled" \
        "$code $again $checked $(cat "$work/out")"
fi

conclude
