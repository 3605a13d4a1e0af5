#!/bin/bash
# `cuvette lens report`: random lenses against the independent sequential trace of lens_report.py, ghosts
# against lens_ghosts.py, the forms of its output, the page of figures, and what it refuses: lens_report.sh [PROGRAM].
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-lens.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
report() { "$program" lens report "$@"; }

# --- random lenses: mm and waves of the largest difference, compared rays, lenses that were refused
mkdir random
lenses=5
[[ -z ${CHECK:-} ]] || lenses=30
found=$(python3 "$root/tests/cli/lens_report.py" "$program" random $lenses 1 2>&1)
awk '{ exit !(NF == 4 && $1 < 1e-9 && $2 < 1e-8 && $3 > 400) }' <<<"$found"
verdict $? "rays, wavefronts and spots are those of an independent trace" "mm, waves, rays, refused: $found"

# --- ghosts of coated lenses
found=$(python3 "$root/tests/cli/lens_ghosts.py" "$program" random 2>&1)
awk '{ exit !(NF == 2 && $1 == 36 && $2 < 1e-10) }' <<<"$found"
verdict $? "ghosts have the powers of characteristic matrices" "ghosts, relative difference: $found"

# --- output
cat >triplet.csv <<'END'
title, Cooke triplet
f_number, 5
field_deg, 0, 14, 20
wavelength_nm, 550, 480, 650
radius, thickness, medium, diameter, stop
22.01359, 3.258956, 1.6204/60.32, 19,
-435.7604, 6.007551, , 19,
-22.21328, 0.9999746, 1.6200/36.37, 10,
20.29192, 4.750409, , 10, 1
79.6836, 2.952076, 1.6204/60.32, 15,
-18.39533, 42.20778, , 15,
END
quick=(--spot 8 --wave 16 --fan 4)
report triplet.csv "${quick[@]}" >text && grep -q 'efl  *50.0005' text && grep -q '^wavefront: ' text
verdict $? "the text has its tables" "$(head -n 3 text)"
report triplet.csv "${quick[@]}" --csv >rows.csv
equal "CSV has one row for each number" "$(
    awk -F, 'NF != 8' rows.csv | wc -l
    sed -n 1p rows.csv
)" \
    "0
section,surface,field,lambda_nm,x,quantity,value,unit"
report triplet.csv "${quick[@]}" --csv >again.csv
cmp -s rows.csv again.csv
verdict $? "the same lens has the same rows" "rows.csv and again.csv differ"
report triplet.csv "${quick[@]}" --json >report.json
equal "JSON has the numbers of the rows" \
    "$(python3 -c 'import json
print(repr(json.load(open("report.json"))["sections"]["first-order"]["values"]["efl"]))')" \
    "$(awk -F, '$1 == "first-order" && $6 == "efl" { print $7 }' rows.csv | python3 -c 'print(float(input()))')"
"$program" lens triplet.csv -o triplet.yaml >/dev/null &&
    report triplet.yaml "${quick[@]}" --csv | awk -F, '$1 == "field-curves"' >scene.rows
equal "a scene of the lens has its foci" "$(awk -F, '{ printf "%.6f\n", $7 }' scene.rows)" \
    "$(awk -F, '$1 == "field-curves" { printf "%.6f\n", $7 }' rows.csv)"
if command -v gnuplot >/dev/null; then
    report triplet.csv "${quick[@]}" --figure page.svg >said && grep -q 'Cooke triplet' page.svg &&
        [[ -s page.rows.csv ]]
    verdict $? "a page of figures is drawn" "$(<said)"
    report "$root/experiments/lenses/hubble.csv" "${quick[@]}" --figure hubble.png >said 2>&1 && [[ -s hubble.png ]]
    verdict $? "where an obstruction takes the chief rays, too" "$(<said)"
fi

# --- vignetting factors: the ellipse that they leave of the pupil, and its MTF, of a lens without aberrations
cat >slow.csv <<'END'
pupil, 10
field_deg, 0
vdx, 0.1
vdy, -0.25
vcx, 0.2
vcy, 0.5
radius, thickness, medium, diameter, stop
1000, 3, 1.5, 40, 1
-1000, 0, , 40,
END
report slow.csv --spot 16 --wave 64 --fan 4 --csv >slow.rows
equal "rays within the ellipse pass" \
    "$(awk -F, '$1 == "vignetting" && $6 == "passes" { printf "%.12f", $7 }' slow.rows)" \
    "$(awk 'BEGIN { for (i = 0.5; i < 16; i++) for (j = 0.5; j < 16; j++) {
        x = i / 8 - 1; y = j / 8 - 1
        all += x * x + y * y <= 1; in_it += ((x - 0.1) / 0.8) ^ 2 + ((y + 0.25) / 0.5) ^ 2 <= 1 && x * x + y * y <= 1 }
        printf "%.12f", in_it / all }')"
awk -F, '$1 == "mtf-diffraction" { m[$6, $5] = $7; if ($6 == "limit") f[$5] }
    function limit(v) { return v < 1 ? (atan2(sqrt(1 - v * v), v) - v * sqrt(1 - v * v)) * 2 / 3.14159265358979 : 0 }
    END { fc = 1e6 / 587.5618 * 10 / 1000.5
        for (i in f) {
            t = m["tangential", i] - limit(i / fc / 0.5); s = m["sagittal", i] - limit(i / fc / 0.8); n++
            if (t * t > 4e-4 || s * s > 4e-4) { print i, t, s; bad++ } }
        exit bad > 0 || n < 20 }' slow.rows >said
verdict $? "the MTF is that of the ellipse" "$(head -n 5 said)"

# --- what it refuses
refuses() { # WHAT WORDS ARGUMENT...
    local what=$1 words=$2 code
    shift 2
    report "$@" >out 2>err
    code=$?
    [[ $code == 2 && $(wc -l <err) == 1 ]] && grep -qF -- "$words" err
    verdict $? "$what" "$code: $(<err)"
}
refuses "nothing to report on" "no lens is given"
refuses "a file that is not there" "nowhere.csv" nowhere.csv
refuses "two forms at once" "exclude each other" triplet.csv --csv --json
refuses "a figure of another format" "use a name that ends in .png, .svg or .pdf" triplet.csv --figure page.gif
refuses "samples that are no power of two" "8, 16, 32" triplet.csv --wave 40
refuses "a field that is no number" "--field" triplet.csv --field 0,x
report triplet.csv "${quick[@]}" --csv >own
sed 's/^wavelength_nm.*/wavelength_nm, 500/' triplet.csv >green.csv
report green.csv "${quick[@]}" --wavelength 550,480,650 --csv >given
cmp -s own given && ! cmp -s own <(report green.csv "${quick[@]}" --csv)
verdict $? "wavelengths of an option are as those of the file" "$(diff own given | head -n 4)"
refuses "a wavelength of radio" "200 to 2000" triplet.csv --wavelength 1e9
refuses "a frequency of 0" "above 0" triplet.csv --frequency 0
printf 'radius, thickness, medium, diameter\n0, 5, 1.5, 20\n0, 50, , 20\n' >flat.csv
refuses "a lens without a focus" "afocal" flat.csv
conclude
