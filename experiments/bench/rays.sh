# shellcheck shell=bash
# rays: camera and shadow rays a second through triangles, with Cuvette's mesh hierarchies and with Embree's
# SETS="sparse:10000 ...", ACCEL=bvh. On processor 0 alone, by tests/bench_mesh next to CUVETTE (make
# build/tests/bench_mesh) and peers/embree: make setup-peers installs Embree, make peers builds the bench; without it
# the table has only our columns. Rates are per CPU time, medians; ratios are computed for each round: median (lowest
# to highest). The hits of the two differ for rays along edges, because Embree uses single precision.
accel=${ACCEL:-bvh} sets=${SETS:-$(echo {sparse,dense,sphere}:{10000,50000,1000000})}
mesh=$build/tests/bench_mesh embree=$build/peers/embree

prepare() {
    need "$mesh" "make $mesh builds it"
    [ -x "$embree" ] || {
        embree=
        echo "$name: Embree is not installed and is left out; make setup-peers peers installs it" >&2
    }
}
round() { # rows of "round set contestant cpu_ms hits blocked"
    local set
    for set in $sets; do
        taskset -c 0 "$mesh" -m "${set%:*}" -n "${set#*:}" -a "$accel" -r 1 -k 1,128 |
            awk -F'\t' -v set="$set" -v round="$round" 'NR > 1 {print round, set, "ours" $5, $9, $7, $8}'
        [ -z "$embree" ] || taskset -c 0 "$embree" -m "${set%:*}" -n "${set#*:}" -k 1,16 |
            awk -F'\t' -v set="$set" -v round="$round" 'NR > 1 {print round, set, "embree" $5, $8, $6, $7}'
    done >>"$work/rows"
}

report() {
    awk -v sets="$sets" -v with="$embree" "$order"'
        { ms[$2, $3] = ms[$2, $3] " " $4; at[$1, $2, $3] = $4; hits[$2, $3] = $5; blocked[$2, $3] = $6
          rounds = $1 + 1 }
        function rate(set, who) { return (480000 + hits[set, who]) / median(ms[set, who]) / 1000 }
        function ratio(set, a, b,   i, list) {
            for (i = 0; i < rounds; i++) list = list " " at[i, set, a] / at[i, set, b]
            return spread(list, "%.2f")
        }
        END {
            n = split(sets, set, " ")
            printf "%-16s %9s %9s", "M rays/s", "ours", "batches"
            if (with != "")
                printf " %9s %9s  %-21s %-21s %-21s %s",
                    "Embree 1", "Embree 16", "ours/E1", "batches/E1", "batches/E16", "hits (shadows) that differ"
            print ""
            for (i = 1; i <= n; i++) {
                s = set[i]
                printf "%-16s %9.2f %9.2f", s, rate(s, "ours1"), rate(s, "ours128")
                if (with != "") printf " %9.2f %9.2f  %-21s %-21s %-21s %d (%d)",
                    rate(s, "embree1"), rate(s, "embree16"),
                    ratio(s, "embree1", "ours1"), ratio(s, "embree1", "ours128"), ratio(s, "embree16", "ours128"),
                    hits[s, "ours1"] - hits[s, "embree1"], blocked[s, "ours1"] - blocked[s, "embree1"]
                print ""
            }
            if (with != "") printf "%d rounds; a ratio above 1: ours is faster\n", rounds
        }' "$work/rows"
}
