#!/bin/bash
# A lens of catalogue glasses through files, scenes and reports: one index for all rays, what a scene keeps of a lens,
# and transmission. Wanted values are those of lens_design.py: lens_design.sh [PROGRAM].
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-design.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
lens() { "$program" lens "$@"; }
wanted() { python3 "$root/tests/cli/lens_design.py" "$@"; }
quick=(--spot 8 --wave 16 --fan 4 --csv)
wanted write

# --- one index for paraxial and real rays, from each form of the lens
axial() { awk -F, '$1 == "axial-colour" && $6 == "efl" { efl[$4] = $7 }
    $1 == "axial-colour" && $6 == "focus" { f[$4] = $7 }
    END { for (nm in f) printf "%.4f %.7f %.7f\n", nm, efl[nm], f[nm] }' | sort; }
lens gauss.zmx -g glass.agf -o gauss.yaml >/dev/null && lens gauss.zmx -g glass.agf -o gauss.csv >/dev/null
lens report gauss.zmx -g glass.agf "${quick[@]}" >zmx.rows
equal "paraxial foci of a .zmx file are those of its catalogue's formulas" "$(axial <zmx.rows)" "$(wanted paraxial)"
equal "and those of a .csv file" "$(lens report gauss.csv -g glass.agf "${quick[@]}" | axial)" "$(wanted paraxial)"
# Near the axis real rays go to the paraxial focus, by the square of their height.
awk -F, '$1 == "longitudinal" { f[$4, $5 + 0] = $7; at[$4] } END {
    for (nm in at) { a = f[nm, 0.05] - f[nm, 0]; b = f[nm, 0.1] - f[nm, 0]; worse += b / a < 3.95 || b / a > 4.05 }
    exit worse > 0 || length(at) != 3 }' zmx.rows
verdict $? "real rays go on where paraxial ones begin" "$(grep '^longitudinal' zmx.rows | head -n 4)"
focal() { lens "$@" | awk '/focal length/ { printf "%.7f", $3 }'; }
d=$(wanted paraxial | awk 'NR == 2 { print $2 }')
equal "the table of a file" "$(focal gauss.zmx -g glass.agf)" "$(printf '%.6f0' "$d")"
equal "the table of a scene" "$(focal gauss.yaml)" "$(focal gauss.zmx -g glass.agf)"
lens gauss.yaml -o again.yaml >/dev/null && lens again.yaml -o again.zmx >/dev/null
equal "a scene of the scene, and a file of that" "$(focal again.yaml) $(focal again.zmx -g glass.agf)" \
    "$(focal gauss.yaml) $(focal gauss.yaml)"

# --- a scene keeps fields, wavelengths with their weights, the primary one and the aperture
lens report gauss.yaml "${quick[@]}" >yaml.rows
differ() { # FILE FILE: the largest relative difference of values, and the number of rows that one of them lacks
    awk -F, 'FNR == 1 { file++; next } { key = $1 FS $2 FS $3 FS sprintf("%.7f", $4) FS sprintf("%.9f", $5) FS $6 }
        file == 1 { of[key] = $7; next } !(key in of) { lacks++; next }
        { d = $7 - of[key]; s = $7 * $7 + of[key] * of[key] + 1e-6
          if (d * d / s > most) most = d * d / s
          delete of[key] }
        END { print (sqrt(most) < 1e-6 ? "same" : sqrt(most)), lacks + length(of) }' "$1" "$2"
}
equal "the report of a scene is that of its file" "$(differ zmx.rows yaml.rows)" "same 0"
facts() {
    awk '/^(ENPD|OBNA|FTYP|XFLN|YFLN|WAVM|PWAV)/ { if ($1 == "WAVM") $3 = sprintf("%.7f", $3); $1 = $1; print }' "$1"
}
equal "a file of the scene has them all" "$(facts again.zmx)" "ENPD 33.33 0
FTYP 0 0 3 3 0 0 0
XFLN 0 0 0
YFLN 0 10 14
WAVM 1 0.4861327 0.7
WAVM 2 0.5875618 1
WAVM 3 0.6562725 0.4
PWAV 2"
printf 'object_distance,200\npupil,20\nfield_height,0,10,20\n' >near.csv
grep -vE '^(pupil|field|title)' gauss.csv >>near.csv
lens near.csv -g glass.agf -o near.yaml >/dev/null && lens near.yaml -o back.csv
equal "also of a near object" "$(grep -E '^(object|pupil|field)' back.csv)" "object_distance,200
pupil,20
field_height,0,10,20"

# --- the Strehl ratio on the axis, from the default number of rays; at 486 nm the peak is not on the axis
lens report gauss.zmx -g glass.agf --spot 8 --fan 4 --field 0 --csv >full.rows
awk -F, 'NR == FNR { split($0, a, " "); of[a[1]] = a[2]; next }
    $1 == "wavefront" && $6 == "strehl_diffraction" && $4 > 500 {
        k = sprintf("%.4f", $4); worse += ($7 / of[k] - 1) ^ 2 > 4e-6; n++ }
    END { exit n != 2 || worse }' <(wanted strehl) full.rows
verdict $? "Strehl ratios are those of an integral along the radius" "$(
    wanted strehl
    grep strehl_diff full.rows
)"

# --- transmission: at full aperture of a slow lens close to that of the axis
sed 's/^pupil.*/pupil,0.2/' gauss.csv >slow.csv
lens report slow.csv -g glass.agf "${quick[@]}" --field 0 >slow.rows
equal "surfaces pass on what Fresnel's formulas say" \
    "$(awk -F, '$1 == "transmission" && $6 == "surfaces" { printf "%.4f %.6f\n", $4, $7 }' slow.rows | sort)" \
    "$(wanted transmission)"
# At 400 nm every glass passes 0.9 in 10 mm: the elements on the axis are 46.85 mm thick.
sed 's/^wavelength_nm.*/wavelength_nm,400/' slow.csv >violet.csv
equal "and media what Beer's law does" \
    "$(lens report violet.csv -g glass.agf "${quick[@]}" --field 0 |
        awk -F, '$1 == "transmission" && $6 == "media" { printf "%.5f", $7 }')" \
    "$(python3 -c 'print(f"{0.9 ** 4.685:.5f}")')"
equal "the illuminance of field 1 is 1" "$(awk -F, '$1 == "illumination" && $6 == "relative" { print $7 }' slow.rows)" 1

# --- a coating of all faces in air: the cemented ones, nearly without reflection, have none
(
    echo coating,ar-broad
    cat slow.csv
) >coated.csv
lens coated.csv -g glass.agf -o coated.yaml >/dev/null
equal "eight faces are coated" "$(grep -cE 'material_[12]: .*-coated' coated.yaml)" 8
lens report coated.csv -g glass.agf "${quick[@]}" --field 0 |
    awk -F, '$1 == "transmission" && $6 == "surfaces" && $4 > 587 && $4 < 588 { good = $7 > 0.97 && $7 < 1 }
        END { exit !good }'
verdict $? "and pass more" "$(lens report coated.csv -g glass.agf "${quick[@]}" --field 0 | grep ^transm)"

# --- a missing stop: one rule, in one note
wanted write '' && sed -i 's/ENPD.*/ENPD 20/' nostop.zmx
lens nostop.zmx -g glass.agf >table 2>said
lens report nostop.zmx -g glass.agf "${quick[@]}" >rows 2>said.report
cmp -s said said.report && grep -q 'no stop is stated: it is surface 6,' said && (($(wc -l <said) == 1))
verdict $? "both commands name the surface that is taken" "$(cat said said.report)"
row() { awk -F, -v q="$1" '$1 == "first-order" && $6 == q { printf "%.6f", $7 }' "$2"; }
equal "and take the same" "$(awk '/entrance pupil/ { printf "%.6f %.6f", $3, $5 }' table)" \
    "$(row z_entrance_pupil rows) $(row entrance_pupil rows)"
lens nostop.zmx -g glass.agf -o nostop.yaml 2>said.scene >/dev/null
lens nostop.yaml 2>said.again | sed -n '/^paraxial/,$p' >again
equal "a scene has that stop, and says no more" \
    "$(cat said.again)$(awk '/entrance pupil/ { printf "%.6f %.6f", $3, $5 }' again)" \
    "$(awk '/entrance pupil/ { printf "%.6f %.6f", $3, $5 }' table)"
conclude
