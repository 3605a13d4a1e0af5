#!/bin/bash
# tests/check/rotate.sh STATE SECONDS COMMAND NAME...: runs COMMAND for the names that ran longest ago, one after
# another, until SECONDS have passed; none is started after that. The command finds the name in the variable only.
# STATE is the file that remembers when each ran; a run that fails is tried first the next time. The status is 1 if
# any fails. The last line says how many of how many ran.
set -uo pipefail
state=${1:?} seconds=${2:?} command=${3:?}
shift 3
mkdir -p "$(dirname "$state")"
touch "$state"
begun=$SECONDS ran=0 failed=()

# Names in the order of their last run; those that never ran, and those that failed, first.
mapfile -t order < <(
    awk -v names="$*" '
        { last[$2] = $1 }
        END { n = split(names, name, " "); for (i = 1; i <= n; i++) print last[name[i]] + 0, i, name[i] }' "$state" |
        sort -k1,1n -k2,2n | cut -d ' ' -f 3
)
for name in "${order[@]}"; do
    ((SECONDS - begun < seconds)) || break
    ran=$((ran + 1)) when=$(date +%s%N)
    # shellcheck disable=SC2086 # the command has words
    only=$name $command </dev/null || {
        failed+=("$name")
        when=0
    }
    echo "$when $name" >>"$state"
done
# One line for each name.
awk '{ last[$2] = $1 } END { for (name in last) print last[name], name }' "$state" | sort -k2 >"$state.new"
mv "$state.new" "$state"
echo "$ran of $# ran, ${#failed[@]} failed${failed[*]:+: ${failed[*]}}"
((${#failed[@]} == 0))
