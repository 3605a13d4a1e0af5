#!/bin/bash
# films.sh - the film hash and ray counts of every shipped scene, small, on one machine: one row a scene. The rows of
# all machines must agree (tests/experiments/machines.sh).
#   experiments/films.sh --cuvette PROGRAM --name NAME --out FILE [--isas "sse2 avx2"] [--compiler NAME]
#                        [--processor NAME] [--emulated qemu] [--run "qemu-s390x -L SYSTEM"]
#   experiments/films.sh --wasm MODULES --name NAME --out FILE     the modules of make wasm, in node
# One set of rows for each instruction set that the processor has. CUVETTE_IMPORT names the importer. Films are 80 x 60,
# and what takes long under emulation has fewer samples or photons: the same for all.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
cuvette='' name='' out='' isas='' compiler='' processor='' emulated=no run=() wasm=''
while (($# > 1)); do
    case $1 in
    --cuvette) cuvette=$2 ;;
    --name) name=$2 ;;
    --out) out=$2 ;;
    --isas) isas=$2 ;;
    --compiler) compiler=$2 ;;
    --processor) processor=$2 ;;
    --emulated) emulated=$2 ;;
    --run) read -ra run <<<"$2" ;;
    --wasm) wasm=$2 ;;
    *) break ;;
    esac
    shift 2
done
[[ $# == 0 && $name && $out && $cuvette$wasm ]] || {
    sed -n 's/^#   //p' "$0" >&2
    exit 2
}

# What a scene's frame is shortened by: --set arguments, a line each.
shorter() { # SCENE
    printf '%s\n' render.width=80 render.height=60 render.threads=1
    case $1 in
    slime) echo toy.time_s=0.25 ;;
    caustic) echo render.photons=40000 ;;
    laser) echo render.photons=20000 ;;
    sunlit-glass | window) printf '%s\n' render.photons=40000 render.paths=8 render.samples=1 ;;
    spectroscope) printf '%s\n' render.photons=40000 render.samples=1 render.wavelengths=8 ;;
    milky | frosted) echo render.paths=8 ;;
    polarisers) printf '%s\n' render.samples=1 render.wavelengths=8 ;;
    esac
}

# Every scene by one instruction set: the fields of a row after `scene`.
native() { # ISA FACTS
    local file scene sets counts
    for file in "$here"/scenes/*.yaml; do
        scene=$(basename "$file" .yaml)
        mapfile -t sets < <(shorter "$scene")
        counts=$(CUVETTE_ISA=$1 "${run[@]}" "$cuvette" render "$file" --json "${sets[@]/#/--set=}" |
            "$here/json_value.py" film_hash rays.{camera,reflect,refract,shadow,photon} total_internal | paste -sd ,)
        echo "$scene,$counts,80x60,$2"
    done
}

quoted() { [[ $1 == *[,\ ]* ]] && echo "\"${1//\"/}\"" || echo "$1"; }

mkdir -p "$(dirname "$out")"
header='scene,film_hash,rays_camera,rays_reflect,rays_refract,rays_shadow,rays_photon,total_internal,size,name'
header+=',architecture,processor,emulated,compiler,isa,version'
# Of the films of shipped scenes: one more when the film or the ray counts of any of them change. Rows of machines that
# are gone keep theirs, and are compared within it; rows without it are of version 1.
version=2
[[ $processor ]] || processor=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1)
if [[ $wasm ]]; then
    for scene in "$here"/scenes/*.yaml; do
        shorter "$(basename "$scene" .yaml)" | sed "s/^/$(basename "$scene" .yaml) /"
    done | node "$here/films.mjs" "$wasm" >"$out.new.rows"
    while IFS= read -r row; do
        echo "${row%,*},80x60,$name,wasm32,$(quoted "${processor:-unknown}"),no,${compiler:-emcc},${row##*,},$version"
    done <"$out.new.rows" | cat <(echo "$header") - >"$out.new"
    rm "$out.new.rows"
else
    machine=$("${run[@]}" "$cuvette" machine --json)
    architecture=$("$here/json_value.py" kernel.2 <<<"$machine") # system, version, architecture
    compiler=${compiler:-$("$here/json_value.py" compiler <<<"$machine")}
    {
        echo "$header"
        for isa in ${isas:-sse2 avx2 avx512 neon plain}; do
            CUVETTE_ISA=$isa "${run[@]}" "$cuvette" machine --json >/dev/null 2>&1 || continue
            facts="$name,$architecture,$(quoted "${processor:-unknown}"),$emulated,$(quoted "$compiler"),$isa,$version"
            native "$isa" "$facts"
        done
    } >"$out.new"
fi
mv "$out.new" "$out"
