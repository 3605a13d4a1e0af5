#!/bin/bash
# Room on the disk: a study or an animation that cannot fit is refused before it begins, with both numbers; one that may
# not fit gets a note. The file system's free space is replaced by that of free_space.c; on a small file system of
# memory, where root may mount one, it is the real one. CUVETTE names the program.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-room.XXXXXX") || exit 1
mounted=
trap '[[ $mounted ]] && umount "$work/small"; rm -rf "$work"' EXIT
cd "$work" || exit 1
export LC_ALL=C
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
case ${CONFIG:-release} in
release | debug) ;;
*)
    echo "# a library cannot be loaded before an instrumented program's own"
    exit 77
    ;;
esac
"${CC:-gcc}" -std=c17 -D_GNU_SOURCE -shared -fPIC -O1 -o free.so "$root/tests/tools/free_space.c" || exit 77

says() { # WHAT FILE REGEX
    grep -qE "$3" "$2"
    verdict $? "$1" "$(cat "$2")"
}
with() { # BYTES ARGUMENT...: with that number of bytes left
    FREE_BYTES=$1 LD_PRELOAD=$work/free.so "$program" "${@:2}" >out 2>err
}

# 2 cells of 100 x 80 pixels: PFM of 96 kB each.
cat >keep.study <<END
study: keep
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 100, render.height: 80}
grid: [{render.depth: [1, 2]}]
repetitions: 2
warmups: 0
keep: {pfm: on}
END
with 150000 study run keep.study --results res
equal "a study that cannot fit is refused" "$? $(ls)" "1 $(printf 'err\nfree.so\nkeep.study\nout')"
says "the refusal has both numbers and a remedy" err \
    '^cuvette: res/keep: the run writes at least 19[0-9] kB, but only 150 kB are free there; free some space'
equal "it is one line" "$(grep -vc 'note:' err)" 1
with 150000 study run --dry-run keep.study --results res
equal "a dry run is refused likewise" "$? $(grep -c 'at least 19. kB, but only 150 kB' err)" "1 1"
says "and prints what would be written" out \
    '^keep: 19[0-9]( kB)? to [0-9]+ kB to write, 150 kB free in res$'
with 250000 study run keep.study --results res
equal "a study that may not fit runs" $? 0
says "with a note" err '^cuvette: note: res/keep: the run may write up to [0-9]+ kB, and only 250 kB are free there$'
"$program" study run --dry-run keep.study --results res >out 2>err
equal "a complete study has nothing to write" "$? $(<out)" "0 keep: complete, nothing to do"
with 10 study run keep.study --results res
equal "and needs no room" $? 0
written=$(du -sb res/keep | cut -f 1)
((written >= 190000))
verdict $? "the study has written what the refusal said" "$written"
sed 's/^study: .*/study: parts/; $aprocesses: 2' keep.study >parts.study
with 150000 study run parts.study --results res
equal "a study in several processes is refused once" "$? $(grep -c 'at least' err)" "1 1"

animate() { # BYTES ARGUMENT...
    with "$1" animate "$root/experiments/scenes/slime.yaml" --duration 0.2 --fps 20 --set render.width=64 \
        --set render.height=48 --set toy.level=1 "${@:2}"
}
animate 100000 -o f%d.pfm
equal "an animation that cannot fit is refused" "$? $(ls f* | tr '\n' ' ')" "1 free.so "
says "with both numbers" err 'the animation writes at least 147 kB, but only 100 kB are free there'
animate 18000 -o film.y4m
equal "a stream that cannot fit is refused" "$? $(ls film.y4m 2>/dev/null)" "1 "
animate 1000000 -o f%d.pfm
equal "one that fits is rendered" "$? $(grep -c ' free ' err) $(ls f?.pfm | wc -l)" "0 0 4"
animate 40 -o f%d.pfm
equal "one that exists needs no room" $? 0
animate 40 -o /dev/null --json
animate 10 -o - </dev/null
equal "standard output needs no room" $? 0

if mkdir small && mount -t tmpfs -o size=160k none small 2>/dev/null; then
    mounted=yes
    "$program" study run keep.study --results small/res >out 2>err
    equal "a full file system: refused before it begins" "$? $(ls small)" "1 "
else
    skip "no file system can be mounted"
fi
conclude
