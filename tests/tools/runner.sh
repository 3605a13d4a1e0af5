#!/bin/bash
# tests/run with small tests of its own: its limits of CPU time and of idleness end a whole tree of processes and are
# named, signals keep their meaning, and nothing stays behind. One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-runner.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset TEST_LIMIT_S TEST_IDLE_S RUNNER CONFIG
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

run() { # [VARIABLE=VALUE...] NAME: runs NAME.sh, which the caller gives on standard input, by tests/run
    local name=${*: -1}
    cat >"$name.sh"
    env "${@:1:$#-1}" "$root/tests/run" "$name.sh" >out 2>&1
    code=$?
}
reports() { # WHAT STATUS PATTERN...: its status, and a line for each pattern
    local what=$1 wanted=$2 lost=
    for pattern in "${@:3}"; do grep -qxE -- "$pattern" out || lost+="no line $pattern; "; done
    [[ $code == "$wanted" && -z $lost ]]
    verdict $? "$what" "$lost status $code: $(<out)"
}
runs() { grep -qs '^State:.[^ZX]' "/proc/$1/status"; }
parent() { awk '/^PPid:/ { print $2 }' "/proc/$1/status"; }
gone() { # WHAT FILE...: the processes whose numbers are in the files have ended
    local what=$1 left=
    for file in "${@:2}"; do runs "$(<"$file")" && left+="$file "; done
    empty "$what" "$left"
}

run sound <<<'echo "ok 1 - a"; echo "ok 2 # SKIP b"; sh -c "while test \$((n += 1)) -lt 200000; do :; done"'
reports "a test that passes: one line, with its wall and CPU time" 0 \
    'pass  sound +1, 1 skipped, [0-9]+ s, [0-9]+\.[0-9] s of CPU' '1 passed, 0 failed'
run wrong <<<'exit 3'
reports "a test that fails" 1 'FAIL  wrong +1 of 1, [0-9]+ s, [0-9]+\.[0-9] s of CPU' ' +wrong ended with status 3'

run TEST_IDLE_S=1 hangs <<<'sleep 100000 & echo $! >child; echo $$ >own; echo "ok 1 - begun"; wait'
reports "a test that hangs is stopped, and says so" 1 'FAIL  hangs .*' \
    ' +hangs\.sh: stopped: no CPU time used for 1 s \(less than 2%\)' '1 passed, 1 failed'
gone "with all its processes" child own

run TEST_LIMIT_S=0.5 spins <<<'setsid -f bash -c "echo \$\$ >child; while :; do :; done"; echo $$ >own; sleep 100000'
reports "a process that a test started uses CPU time without end" 1 \
    ' +spins\.sh: stopped: used more than 0\.5 s of CPU time'
gone "it is stopped, though it is in a session of its own" child own
run TEST_LIMIT_S=0.5 repeats <<<'while :; do bash -c "for ((i = 0; i < 30000; i++)); do :; done"; done'
reports "the CPU time of processes that have ended counts" 1 \
    ' +repeats\.sh: stopped: used more than 0\.5 s of CPU time'

run leaves <<<'setsid sleep 100000 & echo $! >child; while [[ $(<"/proc/$!/comm") != sleep ]]; do :; done'
reports "a process that outlives its test is named" 0 'pass  leaves .*' ' +# sleep outlived the test, and was killed'
gone "and killed" child

run interrupts <<<'sleep 100000 & kill -INT $$; exit 0'
reports "a test does not ignore SIGINT" 1 ' +interrupts ended with status 130'
run group <<<'trap "exit 5" TERM; kill -TERM 0; exit 0'
reports "a signal to a test's group does not reach the runner" 1 ' +group ended with status 5' '0 passed, 1 failed'

# The runner itself ends: what it runs must not go on. The test waits on a FIFO until its process is known.
mkfifo begun
echo 'setsid sleep 100000 & echo $! >child; echo $$ >own; echo >begun; wait' >lost.sh
"$root/tests/run" lost.sh >out 2>&1 &
read -r _ <begun
limit=$(parent "$(<own)")
kill -KILL "$(parent "$limit")" # the shell that waits for the test
wait $!
while runs "$limit"; do sleep 0.1; done
gone "a test does not outlive the runner" child own

conclude
