# shellcheck shell=bash
# await.sh - sourced by check scripts: they wait for events, not for a while. There is no limit of time here; tests/run
# stops a test that hangs.

await() { # PROCESS COMMAND...: until the command succeeds; fails if the process has ended before
    until "${@:2}"; do
        kill -0 "$1" 2>/dev/null || return 1
        sleep 0.1
    done
}
has_lines() { [[ -e $1 ]] && (($(wc -l <"$1") >= $2)); } # FILE COUNT
works() { # PROCESS: it handles SIGINT (signal 2), and has computed for 0.2 s: its start-up is over
    local caught fields
    caught=$(sed -n 's/^SigCgt:[^0-9a-f]*//p' "/proc/$1/status" 2>/dev/null)
    ((16#${caught:-0} & 2)) && read -ra fields <"/proc/$1/stat" && ((fields[13] + fields[14] >= 20))
}
