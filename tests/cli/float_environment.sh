#!/bin/bash
# Checks that the output does not depend on the floating-point environment at program start, byte for byte: a preloaded
# library sets the environment before main, like the start-up code of a library linked with -ffast-math.
# float_environment.sh [PROGRAM]; needs the compiler (CC). One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
[[ -z ${CUVETTE_IMPORT:-} ]] || export CUVETTE_IMPORT
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-float.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CUVETTE_ISA
export LC_ALL=C
# The preloaded library may precede the sanitizers' because it allocates nothing.
export ASAN_OPTIONS=verify_asan_link_order=0

cat >strange.c <<'EOF'
#define _GNU_SOURCE
#include <fenv.h>
#include <stdlib.h>

/* STRANGE=ROUNDING,MXCSR BITS,NARROW,TRAPS */
__attribute__((constructor)) static void make_strange(void)
{
    const char *text = getenv("STRANGE");
    if (!text)
        return;
    char *rest;
    const int rounding = (int)strtol(text, &rest, 0);
    const unsigned flushing = (unsigned)strtoul(rest + 1, &rest, 0);
    const int narrow = (int)strtol(rest + 1, &rest, 0), traps = (int)strtol(rest + 1, &rest, 0);
#if defined(__x86_64__) && defined(__GLIBC__)
    fenv_t now;
    fegetenv(&now);
    now.__mxcsr |= flushing;
    if (narrow)
        now.__control_word &= 0xfcff;
    fesetenv(&now);
#endif
    fesetround(rounding);
    if (traps)
        feenableexcept(FE_ALL_EXCEPT);
}
EOF
cat >names.c <<'EOF'
#include <fenv.h>
#include <stdio.h>
int main(void)
{
    printf("%d %d %d %d; %d\n", FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, fegetround());
    return 0;
}
EOF
"${CC:-gcc}" -shared -fPIC -O1 -o strange.so strange.c -lm && "${CC:-gcc}" -o names names.c -lm ||
    {
        echo "# the compiler cannot build a shared library"
        exit 77
    }
read -r nearest up down zero < <(./names | tr -d ';' | cut -d' ' -f1-4)

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
environment= # the value of STRANGE for the following commands; empty: none
strange() {  # PROGRAM ARGUMENT...
    if [[ $environment ]]; then STRANGE=$environment LD_PRELOAD=$work/strange.so "$@"; else "$@"; fi
}
cuvette() { strange "$program" "$@"; }

# Otherwise the following checks would pass trivially.
[[ $(environment=$up,0,0,0 && strange ./names) == *"; $up" ]]
verdict $? "the preloaded library sets the environment"

# Covers functions added to the engine later. One that only calls another leaves it to that.
bare=$(awk '/^cuvette_status cuvette_/ {name = $2; sub(/\(.*/, "", name); n++}
            name && open {
                if ($0 !~ /^ *(ENGINE_(ENTER|CALL|CHANGE)|return cuvette_[a-z_]*)\(.*\);$/) print name
                name = ""
            }
            {open = /^{$/} END {if (n < 50) print "only", n, "functions"}' "$root"/src/engine/*.c)
[[ -z $bare ]]
verdict $? "every function of cuvette.h that can fail sets the default environment${bare:+, except }$bare"

scenes=$root/experiments/scenes
"$program" mesh --generate torus --around 24 --tube 12 -o ring.ply >/dev/null || exit 1
cat >ring.yaml <<'EOF'
render: {width: 48, height: 36, depth: 4, threads: 2}
camera: {position: [0.3, 2.1, -4.7], target: [0, 0.1, 0]}
lights: {lamp: {position: [3.1, 6.2, -4.3]}}
meshes: {circle: {file: ring.ply}}
solids:
  ground: {shape: plane, diffuse: 0.7, checker: 0.7, position: [0, -0.41, 0]}
  ring: {shape: mesh, mesh: circle, transparency: 0.9, ior: 1.31, priority: 1, rotation: [10.1, 20.3, 0]}
EOF
small=(--set render.width=48 --set render.height=36 --set render.depth=4 --set render.threads=2)
hash_of() { cuvette render "$@" --json | grep -o '"film_hash": *"[0-9a-f]*"'; }

run_all() { # prints the output and the files of the program
    hash_of "$scenes/rod.yaml" "${small[@]}"
    hash_of "$scenes/rod.yaml" "${small[@]}" --set render.integrator=path --set render.samples=4
    hash_of "$scenes/prism.yaml" "${small[@]}" --set render.wavelengths=16
    hash_of "$scenes/plates.yaml" "${small[@]}" --set render.polarisation=on
    hash_of "$scenes/slime.yaml" "${small[@]}" --set toy.level=2 --set toy.time_s=0.2
    hash_of "$scenes/models.yaml" "${small[@]}" --set ball.level=2 --set render.integrator=zbuffer
    hash_of ring.yaml
    cuvette trace "$scenes/rod.yaml" --pixel 400,300 --depth 4 --json
    for file in fan.csv fan.svg; do
        cuvette fan "$scenes/rod.yaml" --from -3,1.5,0 --to 3,1.5,0 --width 1.7 --rays 9 --set rod.visible=off -o $file
        cat $file
    done
    cuvette scene "$scenes/rod.yaml" --set liquid.ior=1.234567890123456789 --set camera.fov_deg=33.3 -o -
    cuvette realism "$scenes/rod.yaml" "${small[@]}" --csv
    cuvette media
}
run_all >expected 2>&1
(($(grep -c film_hash expected) == 7)) && ! grep -q '^cuvette: ' expected
verdict $? "every command succeeds in the default environment: $(wc -l <expected) lines"
expect() { # WHAT ENVIRONMENT
    environment=$2
    run_all >found 2>&1
    cmp -s expected found
    local same=$?
    verdict "$same" "the output is the same with $1"
    ((same == 0)) || diff expected found | sed 's/^/# /' | head -10
}
ftz=0x8000 daz=0x0040 both=0x8040
expect "rounding up" "$up,0,0,0"
expect "rounding down" "$down,0,0,0"
expect "rounding toward zero" "$zero,0,0,0"
expect "flush to zero (FTZ)" "$nearest,$ftz,0,0"
expect "denormals are zero (DAZ)" "$nearest,$daz,0,0"
expect "rounding up, FTZ and DAZ" "$up,$both,0,0"
expect "rounding down, FTZ and DAZ, x87 in single precision" "$down,$both,1,0"
expect "rounding toward zero, FTZ and DAZ, traps" "$zero,$both,0,1"

conclude
