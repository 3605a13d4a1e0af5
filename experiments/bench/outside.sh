# shellcheck shell=bash
# outside: CPU time of whole programs, where most of the work is not the tracing
# SOLIDS="1000 8000 100000 1000000" (spheres, named or above 100000 a cloud, at depth 0, to PNG), CELLS=200 (of a study
# of 64x48), TRIANGLES=1000000 (of OBJ and PLY files), SIDES="1024 4096" (of a square image, to PNG and PFM; the largest
# is 16384). One thread. User and system time together; outside the tracing: the program's less that of its frames.
solids=${SOLIDS:-1000 8000 100000 1000000} cells=${CELLS:-200} triangles=${TRIANGLES:-1000000} sides=${SIDES:-1024 4096}
rod=$here/scenes/rod.yaml

spent() { # spent CONTESTANT TRACED COMMAND...: notes the CPU seconds of a command, and those without TRACED seconds
    local TIMEFORMAT='%U %S' user system
    read -r user system < <({ time "${@:3}" >"$work/out" 2>"$work/err"; } 2>&1)
    note "$1" "$(awk -v u="$user" -v s="$system" 'BEGIN { print u + s }')" "$2"
}
plain() { # plain CONTESTANT SCENE [SET...]: a PNG alone; the JSON would list all parameters of all solids
    local sets=(--set render.threads=1)
    for one in "${@:3}"; do sets+=(--set "$one"); done
    spent "$1" 0 "$ours" render "$2" -o "$work/image.png" "${sets[@]}"
    [ -s "$work/image.png" ] || failed "$1" "$work/err"
    rm -f "$work/image.png"
}
image() { # image CONTESTANT SCENE FILE [SET...]
    local sets=(--set render.threads=1)
    for one in "${@:4}"; do sets+=(--set "$one"); done
    spent "$1" 0 "$ours" render "$2" -o "$work/$3" --json "${sets[@]}"
    grep -q '"film_hash"' "$work/out" || failed "$1" "$work/err"
    sed -i "\$s/\t0\$/\t$(field cpu_s <"$work/out")/" "$work/$1"
    rm -f "$work/$3"
}
prepare() {
    local kind
    for kind in obj ply; do
        "$ours" mesh --generate dense --count "$triangles" -f $kind -o "$work/soup.$kind"
        sed "s|soup: {.*|soup: {file: soup.$kind}|" "$here/scenes/soup.yaml" >"$work/soup-$kind.yaml"
    done
    awk -v cells="$cells" 'BEGIN {
        print "study: cells\nscene: rod.yaml\nwarmups: 0\nrepetitions: 1"
        print "set: {render.width: 64, render.height: 48, render.threads: 1}\ngrid:"
        printf "  - {liquid.ior: ["
        for (i = 0; i < cells; i++) printf "%s%.4f", i ? ", " : "", 1.2 + 0.5 * i / cells
        print "]}" }' >"$work/cells.study"
    cp "$rod" "$work/rod.yaml"
}
round() {
    local n kind
    for n in $solids; do
        plain "solids $n" "$(spheres 1 "$n" 1)" render.depth=0 render.width=160 render.height=120
    done
    image small "$rod" image.png render.width=16 render.height=16
    image rod "$rod" image.png render.width=400 render.height=300
    for kind in obj ply; do
        image "mesh $kind" "$work/soup-$kind.yaml" image.png render.width=16 render.height=16
    done
    for n in $sides; do
        for kind in png pfm; do
            image "$kind $n" "$rod" "image.$kind" render.depth=0 render.width="$n" render.height="$n"
        done
    done
    rm -rf "$work/results"
    (cd "$work" && spent cells 0 "$OLDPWD/$ours" study run cells.study)
    [ -s "$work/results/cells/rows.csv" ] || failed 'the study' "$work/err"
    sed -i "\$s/\t0\$/\t$(column cpu_s "$work/results/cells/rows.csv")/" "$work/cells"
}
column() { # column NAME FILE.csv: the sum of a column, all to the left of quoted text
    awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; next } { sum += $at }
        END { print sum }' "$2"
}
report() {
    local n kind
    for n in $solids; do
        kind=$( ((n > 100000)) && echo solids of a cloud || echo named solids)
        row "solids $n" '$1' "$n $kind to PNG: CPU s"
    done
    row small '1000 * $1' 'rod, 16x16, to PNG: CPU ms'
    row rod '1000 * $1' 'rod, 400x300, to PNG: CPU ms'
    row rod '1000 * ($1 - $2)' '  outside the tracing: CPU ms'
    row cells "1000 * \$1 / $cells" "a cell of $cells, 64x48: CPU ms"
    row cells "1000 * (\$1 - \$2) / $cells" '  outside the tracing: CPU ms'
    for kind in obj ply; do row "mesh $kind" '$1' "$triangles triangles, ${kind^^}, to an image: CPU s"; done
    ratio 'mesh ply' 'mesh obj' 'PLY over OBJ'
    for n in $sides; do
        for kind in png pfm; do row "$kind $n" '$1' "${n}x$n at depth 0 to ${kind^^}: CPU s"; done
    done
}
