#!/bin/bash
# Invalid command lines, environment variables, scenes, studies, environment images and comparisons: bad_input.sh
# [PROGRAM]. Each must end with exit 2, nothing on standard output, and exactly one line on standard
# error with the place, the error and (for a user's mistake) the remedy. One line per check, then "N passed, N failed".
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
scene=$root/experiments/scenes/rod.yaml
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-bad.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
unset CUVETTE_ISA

passed=0 failed=0 as=()
located='^cuvette: [^:]+(:[0-9]+(:[0-9]+)?)?: [^;]+(; .+)?$'
refused() { # WHAT PATTERN ARGUMENT...: the line must also match PATTERN
    local what=$1 pattern=$2 wrong=
    shift 2
    "${as[@]}" "$program" "$@" >out 2>err </dev/null
    local code=$?
    ((code == 2)) || wrong+=" exit $code;"
    [[ -s out ]] && wrong+=" something on standard output;"
    (($(wc -l <err) == 1)) || wrong+=" $(wc -l <err) lines;"
    LC_ALL=C grep -qE "$located" err || wrong+=" not located;"
    LC_ALL=C grep -qE -- "$pattern" err || wrong+=" does not match '$pattern';"
    if [[ -z $wrong ]]; then
        passed=$((passed + 1))
        echo "ok $((passed + failed)) - $what"
    else
        failed=$((failed + 1))
        echo "not ok $((passed + failed)) - $what:$wrong $(head -c 400 err)"
    fi
}
render() { # WHAT PATTERN ARGUMENT...
    refused "$1" "$2" render "$scene" --json --set render.width=8 --set render.height=6 "${@:3}"
}

# --- command lines
refused "no command" "no command is given"
printf 'meshes: {toy: {generate: slime, dt_s: 1e-300}}\n' >tiny.yaml
refused "a tiny time step" "tiny.yaml:1:.*dt_s" render tiny.yaml --json
refused "misspelt command" "did you mean 'render'" rendr
refused "unknown command" "give one of: render" frobnicate
refused "unknown option of the program" "unknown option '--bogus'" --bogus
refused "no scene" "no scene" render
refused "no output" "no output is given; add -o FILE" render "$scene"
refused "two scenes" "unexpected argument" render "$scene" "$scene" --json
refused "an image without -o" "use -o FILE" render "$scene" x.png
refused "a second scene of a command without outputs" "scene; use --set PATH=VALUE" realism "$scene" x.yaml
refused "a scene without a command" "cuvette render rod.yaml -o image.png" rod.yaml
refused "misspelt option" "did you mean '--output'" render "$scene" --outptu x.png
refused "unknown short option" "unknown option '-z'" render "$scene" -z
refused "ambiguous option" "'--ti' is ambiguous" render "$scene" --ti x.png
refused "option that only argp knows" "unknown option '--program-name'" render "$scene" --program-name x.png
refused "abbreviation of such an option" "unknown option '--progr'" render "$scene" --progr x.png
refused "option without its value" "requires a value" render "$scene" -o
refused "value for an option that takes none" "takes no value" render "$scene" --json=yes
refused "missing scene" "nowhere.yaml: cannot open: [^;]*; check the path$" render nowhere.yaml --json
for name in experiments/scenes/rod.yaml scenes/rod.yaml rod.yaml rod.yml rod; do
    refused "installed scene, as $name" \
        "; use /[^ ]*/experiments/scenes/rod.yaml, or copy all: cp -r /[^ ]*/experiments \.$" \
        render $name --json
done
refused "installed scene in the laboratory" "; use /[^ ]*/scenes/rod.yaml, or copy" lab scenes/rod.yaml --no-browser
refused "a path in an origin" "'https://lms.example/x' is not [^;]*; use scheme, host" \
    lab --embed-origin https://lms.example/x --no-browser
refused "installed study" "; use /[^ ]*/experiments/depth.study, or copy all" study run experiments/depth.study
refused "installed study by its name" "; use /[^ ]*/experiments/depth.study, or copy all" study summary depth
printf 'study: own\nscene: scenes/rod.yaml\n' >own.study
refused "installed scene in a study" "own.study:2:8: .*; use /[^ ]*/experiments/scenes/rod.yaml" study run own.study
refused "study without its ending" "; did you mean 'own.study'\?" study run own
mkdir experiments
refused "installed scene, next to a copy" "; use /[^ ]*/experiments/scenes/rod.yaml$" \
    render experiments/scenes/rod.yaml --json
rmdir experiments
refused "scene is a folder" "folder" render . --json
refused "image to standard output" "-o -" render "$scene" -o -
refused "unknown ending" "x.gif" render "$scene" -o x.gif
refused "no ending" "x: " render "$scene" -o x
refused "empty name of an image" "-o" render "$scene" -o ""
refused "missing folder" "folder does not exist" render "$scene" -o nowhere/x.png
mkdir -m 555 closed
chmod 755 .
((EUID)) || as=(setpriv --reuid=65534 --clear-groups) # root may write anywhere
if "${as[@]}" test -x "$program" -a ! -w closed 2>/dev/null; then
    refused "closed folder" "may not write in the folder; give" render "$scene" -o closed/x.png
fi
as=()
mkdir folder.png
refused "image is a folder" "is a folder" render "$scene" -o folder.png
refused "JPEG with 16 bits" "only PNG" render "$scene" -o x.jpg --bits 16
refused "12 bits" "8 or 16" render "$scene" -o x.png --bits 12
refused "bits are not a number" "integer" render "$scene" -o x.png --bits many
refused "map as JPEG" "unsupported format of a map" render "$scene" --rays x.jpg
refused "timeline without .json" "json" render "$scene" --timeline x.png
refused "two outputs into one file" "two outputs have the same file" \
    render "$scene" -o x.png --rays ./../"${work##*/}"/x.png
refused "repeat 0" "integer from 1" render "$scene" --json --repeat 0
refused "repeat is not an integer" "integer from 1" render "$scene" --json --repeat 2.5
refused "repeat too large for 64 bits" "integer from 1" render "$scene" --json --repeat 99999999999999999999
cp "$scene" same.yaml
ln -s same.yaml same.png
refused "image over the scene" "the scene reads this file" render same.yaml -o same.png
CUVETTE_ISA=mmx render "unknown instruction set" "CUVETTE_ISA"
CUVETTE_ISA=mmx refused "unknown instruction set, machine" "CUVETTE_ISA" machine
printf '%s\n' 'study: isa' "scene: $scene" 'grid: [{render.depth: [0]}]' 'repetitions: 1' >isa.study
CUVETTE_ISA=mmx refused "unknown instruction set, study" "CUVETTE_ISA" study run isa.study --results isa-results
refused "mesh of two files" "unexpected argument 'b.obj'; see 'cuvette mesh --help'" mesh a.obj b.obj
refused "machine with an argument" "unexpected argument 'now'" machine now
refused "media of an unknown name" "did you mean 'pmma'" media pmna
refused "media of two names" "unexpected argument 'air'" media water air
printf '10 5 1.5 8\n-10 5 1 x\n' >bad.dat
printf '10 5 1.5 8\n-10 0 1 8\n' >good.dat
printf 'radius,thickness,medium\n10,5,unobtainium\n' >bad.csv
printf 'NM GLASS 2 0 1.5 60\n' >empty.agf
refused "lens without a file" "give a lens file" lens
refused "lens of two files" "unexpected argument" lens good.dat good.dat
refused "lens of a missing file" "nowhere.zmx: cannot open" lens nowhere.zmx
refused "lens with a bad number" "bad.dat:2:9: the diameter: 'x' is not a number" lens bad.dat
refused "lens of an unknown glass" "bad.csv:2:6: the glass 'unobtainium'.*-g FILE.agf" lens bad.csv
refused "lens with a catalogue that lacks the glass" "the glass 'unobtainium'" lens bad.csv --glasses empty.agf
refused "lens with a missing catalogue" "none.agf: cannot open" lens bad.csv --glasses none.agf
refused "lens to an unknown format" "ends in .yaml, .zmx, .dat or .csv" lens good.dat -o lens.txt
refused "lens onto its own file" "it is the file that is read" lens good.dat -o good.dat
refused "a system of a lens file" "a lens file holds one system" lens good.dat --system a
refused "lens of a scene without lenses" "the scene has no lens" lens "$scene"
refused "a lens system that a scene lacks" "no lens has a name that begins with tele-" lens "$scene" --system tele
refused "media at no wavelength" "nanometres" media --at 5,5
refused "media at wavelength 0" "nanometres" media water --at 0
refused "media at infinity" "nanometres" media water --at 1e999
refused "media outside the range" "was not measured at 500 nm; .* 589\.3\.\.1050 nm" media glycerol --at 500
refused "media outside the one wavelength" "give its only wavelength, 589.3 nm" media olive-oil --at 589
refused "params of two scenes" "only one scene" params "$scene" "$scene"
echo 'render: [' >text.yaml
refused "params of a file that is not a scene" "text.yaml:[0-9]" params text.yaml
refused "params of a misspelt path" "did you mean 'render.depth'" params render.dpth
refused "params of a word without a match" "no parameter matches 'zzz'" params "$scene" zzz
refused "params of two words" "unexpected argument 'vessel'" params "$scene" liquid vessel
refused "params --man of a scene" "takes no other argument" params --man "$scene"
refused "help for a misspelt command" "did you mean 'study'" help studdy
refused "study without a command" "no command is given" study
refused "misspelt study command" "did you mean 'merge'" study merg
refused "study run without a file" "no study" study run
refused "a missing study file" "nowhere.study" study run nowhere.study
refused "study list of a missing folder" "nowhere" study list nowhere
refused "shard out of range" "0 <= I < N" study run --shard 2/2 x.study
refused "shard without N" "0 <= I < N" study run --shard 1 x.study
refused "shard of words" "0 <= I < N" study run --shard a/b x.study
refused "shard of a huge number" "0 <= I < N" study run --shard 0/99999999999999999999999 x.study
refused "summary of two studies" "more than one study" study summary a.study b.study
new_study() { # WHAT PATTERN ARGUMENT...
    refused "study new: $1" "$2" study new "${@:3}"
}
new_study "no scene" "no scene is given"
new_study "no axis" "study new: no axis is given" "$scene"
new_study "two scenes" "unexpected argument" "$scene" "$scene" --axis render.depth=1
new_study "a missing scene" "nowhere.yaml" nowhere.yaml --axis render.depth=1
new_study "an axis without values" "^cuvette: --axis render.depth: this is not an axis" "$scene" --axis render.depth
new_study "an axis with an empty value" "--axis render.depth=1,,2: a value is empty" "$scene" --axis render.depth=1,,2
new_study "an unknown parameter" "--axis render.dpth=1: .*did you mean 'render.depth'" "$scene" --axis render.dpth=1
new_study "a value out of range" "--axis render.depth=1,65: .*give an integer 0..64" "$scene" --axis render.depth=1,65
new_study "a decimal comma in brackets" "--axis" "$scene" --axis 'render.depth=[1,2'
new_study "a range without steps" "such as 1..2:5" "$scene" --axis liquid.ior=1..2
new_study "a range of words" "not a range of numbers" "$scene" --axis liquid.ior=1..two:3
new_study "a range with one step" "--axis liquid.ior=1..2:1: steps" "$scene" --axis liquid.ior=1..2:1
new_study "a flat range" "--axis liquid.ior=2..2:3: from and to are equal" "$scene" --axis liquid.ior=2..2:3
new_study "a range between integers" "--axis render.depth=0..4:4: .*is not an integer" \
    "$scene" --axis render.depth=0..4:4
new_study "a value twice" "--axis render.depth=1,1: value 2 equals value 1" \
    "$scene" --axis liquid.ior=1,2 --axis render.depth=1,1
new_study "a parameter twice" "--axis render.depth=2: .*already on axis 1" \
    "$scene" --axis render.depth=1 --axis render.depth=2
new_study "a parameter in set and axis" "--axis render.depth=2: .*already set for all cells" \
    "$scene" --axis render.depth=2 --set render.depth=3
new_study "a wrong setting" "--set render.tile=0: .*out of range" "$scene" --axis render.depth=1 --set render.tile=0
new_study "a setting without a value" "--set render.tile" "$scene" --axis render.depth=1 --set render.tile
new_study "a control character" "--axis .*control characters" "$scene" --axis $'background.image=a\tb'
new_study "a name with a slash" "--name a/b: invalid name" "$scene" --axis render.depth=1 --name a/b
new_study "a reserved name" "--name tables: invalid name" "$scene" --axis render.depth=1 --name tables
new_study "no repetitions" "integer from 1" "$scene" --axis render.depth=1 --repetitions 0
new_study "no number of warm-ups" "integer from 0" "$scene" --axis render.depth=1 --warmups=-1
new_study "another ending" "end it with .study" "$scene" --axis render.depth=1 -o x.yaml
new_study "a missing folder" "folder does not exist" "$scene" --axis render.depth=1 -o nowhere/x.study
echo 'kept' >kept.study
new_study "an existing file" "already exists; .*--force" "$scene" --axis render.depth=1 -o kept.study
new_study "an invalid study over an existing file" "value 2 equals" \
    "$scene" --axis render.depth=1,1 -o kept.study --force
refused "study new did not write" "no command" study
[[ $(<kept.study) == kept && ! -e x.study && ! -e x.yaml ]] || {
    failed=$((failed + 1))
    echo "not ok - study new wrote a file after an error"
}
printf 'cell,process,wall_s\n0,1,2\n0,2,2\n' >values.csv
printf 'cell,process,wall_s\n0,1,NA\n' >empty-values.csv
refused "study power without rows" "no rows are given" study power
refused "study power of a missing file" "nowhere.csv: there is no such file" study power nowhere.csv
refused "study power without a column" "there is no column 'cpu_s'" study power values.csv --column cpu_s
refused "study power without values" "no row has a value" study power empty-values.csv
refused "study power of too few processes" "too few processes or repetitions" study power values.csv --designs=2
sed 's/^0/5/' values.csv >other-cells.csv
refused "study power of files without a common cell" "no cell of the same name; .*--cells" \
    study power values.csv other-cells.csv --designs=1
refused "study power of an unknown cell" "no cell '7'" study power values.csv --cells=0,7
refused "study power of one cell" "two cells are necessary" study power values.csv --cells=0
refused "study power with an unknown truth" "unknown truth 'slow'" study power values.csv --cells=0,0 --truth=slow
refused "study power with a truth of each cell" "compares two cells" study power values.csv --truth=same
refused "study power with a wrong design" "invalid designs" study power values.csv --designs=1,3y1
refused "study power of three files" "too many arguments" study power values.csv values.csv values.csv
refused "study exclude without a file" "no study" study exclude
refused "study exclude without a row" "no row is given" study exclude x.study --reason x
refused "study exclude without a reason" "no reason is given" study exclude x.study --row 0:1
refused "study exclude of two studies" "unexpected argument" study exclude x.study y.study --row 0:1 --reason x
refused "study exclude without rows" "--row 0:1: there is no such row" \
    study exclude isa.study --row 0:1 --reason x --results isa-results
refused "study exclude with an empty reason" "--reason: this is not a reason" \
    study exclude isa.study --row 0:1 --reason '' --results isa-results
refused "study exclude with an empty folder" "--results is empty" \
    study exclude isa.study --row 0:1 --reason x --results ""
refused "study run: a value for --dry-run" "takes no value" study run --dry-run=1 x.study
refused "empty results folder" "empty" study status --results "" x.study

# --- parameters
render "--set of an unknown group" "rendr" --set rendr.depth=3
render "--set of a misspelt parameter" "did you mean 'render.depth'" --set render.dpth=3
render "--set without =" "path=value" --set render.depth
render "--set without a path" "--set" --set =3
render "--set without a value" "render.depth" --set render.depth=
render "--set out of range" "0\.\.64" --set render.depth=65
render "--set of a word for a number" "render.depth" --set render.depth=deep
render "--set of a real for an integer" "render.depth" --set render.depth=4.5
render "--set of NaN" "vessel.ior" --set vessel.ior=nan
render "--set of infinity" "vessel.ior" --set vessel.ior=inf
render "--set of a decimal comma" "vessel.ior" --set vessel.ior=1,5
render "--set of hexadecimal" "vessel.ior" --set vessel.ior=0x1p1
render "--set of an overflow" "vessel.ior" --set vessel.ior=1e999
render "--set of an unknown word" "fresnel" --set render.weights=frenel
render "--set of two numbers for three" "lamp.position" --set lamp.position=1,2
render "--set of four numbers for three" "lamp.position" --set lamp.position=1,2,3,4
render "--set of an unknown element" "lamp.position" --set lamp.position.w=1
render "--set of an unknown solid" "vesel" --set vesel.ior=1.5
render "--set of a parameter that the shape lacks" "ground" --set ground.radius=1
render "--set of control characters" "--set" --set $'render.depth=\e[31m4'
render "--set that gives an invalid shape" "vessel" --set vessel.inner_radius=2
render "a camera at its own target" "camera" --set camera.target=0,2.75,-6
render "an environment without an image" "image" --set background.kind=image

# --- environment images
printf '%s\n' 'background: {kind: image, image: sky.png}' 'render: {width: 8, height: 6}' >sky.yaml
sky() { # WHAT: the file sky.png is invalid
    refused "sky: $1" "sky\." render sky.yaml --json
}
rm -f sky.png
sky "missing"
mkdir sky.png
sky "a folder"
rmdir sky.png
: >sky.png
sky "empty"
head -c 3000 /dev/urandom >sky.png
sky "noise"
echo "a text" >sky.png
sky "text"
"$program" render "$scene" -o good.png --set render.width=40 --set render.height=20 >/dev/null
"$program" render "$scene" -o good.jpg --set render.width=40 --set render.height=20 >/dev/null
"$program" render "$scene" -o good.pfm --set render.width=40 --set render.height=20 >/dev/null
"$program" render "$scene" -o good.exr --set render.width=40 --set render.height=20 >/dev/null
for kind in png jpg pfm exr; do
    head -c $(($(wc -c <good.$kind) / 2)) good.$kind >sky.png
    sky "truncated $kind"
done
head -c 20 good.png >sky.png
sky "PNG cut in its header"
# Width and height 2^31 - 1, the CRC of the header wrong as well.
{
    head -c 16 good.png
    printf '\x7f\xff\xff\xff\x7f\xff\xff\xff'
    tail -c +25 good.png
} >sky.png
sky "PNG of a huge size"
{
    head -c 60 good.png
    printf '\xde\xad\xbe\xef'
    tail -c +65 good.png
} >sky.png
sky "PNG with damaged data"
printf 'PF\n99999 99999\n-1.0\nabcd' >sky.png
sky "PFM of a huge size"
printf 'PF\n2 -2\n-1.0\n' >sky.png
sky "PFM of a negative size"
{
    printf 'PF\n1 1\n-1.0\n'
    printf '\x00\x00\xc0\x7f\x00\x00\xc0\x7f\x00\x00\xc0\x7f'
} >sky.png
sky "PFM with NaN"
{
    printf 'BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x08\0'
    head -c 28 /dev/zero
} >sky.png
sky "BMP without a palette"
{
    printf 'BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\2\0\0\0\2\0\0\0\1\0\x18\0'
    head -c 28 /dev/zero
} >sky.png
sky "truncated BMP"
printf 'GIF89a\1\0\1\0\0\0\0;' >sky.png
sky "a GIF"
rm sky.png
cp good.jpg sky.jpg
printf '%s\n' 'background: {kind: image, image: sky.jpg}' 'render: {width: 8, height: 6}' >sky.yaml
refused "image over the environment image" "the scene reads this file" render sky.yaml -o sky.jpg

# --- scripts of slimes; tests/bad/scripts covers the messages of their reader
mkdir slimes
printf '%s\n' 'render: {width: 8, height: 6}' 'meshes:' \
    '  toy: {generate: slime, level: 1, time_s: 0.02, script: tug.yaml}' 'solids:' \
    '  body: {shape: mesh, mesh: toy, diffuse: 1}' >slimes/toy.yaml
refused "a script that is not there" "^cuvette: slimes/toy.yaml:3:58: toy: slimes/tug.yaml" render slimes/toy.yaml \
    --json
printf '%s\n' 'hands:' '  left:' '    - {time_s: 0, move: [0, 0, 0]}' >slimes/tug.yaml
refused "a wrong script" "^cuvette: slimes/tug.yaml:3:7: left: .*add a grab" render slimes/toy.yaml --json
refused "a wrong script, checked" "^cuvette: slimes/tug.yaml:3:7: " scene slimes/toy.yaml --check
printf '%s\n' 'hands:' '  left:' '    - {time_s: 0.01, grab: [9, 9, 9], towards: [0, 1, 0], reach: 1}' >slimes/tug.yaml
refused "a hand that misses" "^cuvette: slimes/tug.yaml:3:7: .*nothing" render slimes/toy.yaml --json
refused "trace over the script" "the scene reads this file" \
    trace slimes/toy.yaml --pixel 1,1 --text -o slimes/tug.yaml
refused "scene over the script" "this file is a script that the scene uses" scene slimes/toy.yaml -o slimes/tug.yaml
refused "a diverging slime" "^cuvette: slimes/toy.yaml:3:19: toy: " render slimes/toy.yaml --json --set \
    toy.script= --set toy.stiffness=1e9
refused "too fine a slime" "toy: .*level" render slimes/toy.yaml --json --set toy.level=8
refused "a scene as a script" "unknown key 'render'" render slimes/toy.yaml --json --set toy.script=toy.yaml

# --- images to compare
refused "compare of nothing" "no images are given" compare
refused "compare of one image" "only one image" compare good.png
refused "compare of three images" "unexpected argument 'good.pfm'" compare good.png good.jpg good.pfm
refused "compare of a missing image" "nowhere.png" compare good.png nowhere.png
refused "compare of a folder" "folder.png" compare folder.png good.png
refused "compare of a scene" "unknown image format" compare "$scene" good.png
"$program" render "$scene" -o other.png --set render.width=20 --set render.height=40 >/dev/null
refused "compare of two sizes" "40 x 20 .* 20 x 40.*same size" compare good.png other.png
head -c $(($(wc -c <good.png) / 2)) good.png >half.png
refused "compare of a truncated PNG" "half.png" compare good.png half.png
{
    printf 'PF\n1 1\n-1.0\n'
    printf '\x00\x00\xc0\x7f\x00\x00\xc0\x7f\x00\x00\xc0\x7f'
} >nan.pfm
refused "compare of a PFM with NaN" "nan.pfm" compare nan.pfm nan.pfm
refused "misspelt option of compare" "did you mean '--diff'" compare good.png good.jpg --dif-f x.png
refused "--diff without a file" "requires a value" compare good.png good.jpg --diff
refused "--diff with an unknown ending" "x.gif.*\.png" compare good.png good.jpg --diff x.gif
refused "--diff without a name" "unknown image format" compare good.png good.jpg --diff ""
refused "--diff to standard output" "--diff -: " compare good.png good.jpg --diff -
refused "--diff into a missing folder" "folder does not exist" compare good.png good.jpg --diff nowhere/x.png
refused "--diff onto a folder" "is a folder" compare good.png good.jpg --diff folder.png
refused "--diff over an image" "is read from this file" compare good.png good.jpg --diff ./good.jpg
refused "--diff is checked before the images" "x.gif" compare nowhere.png nowhere.png --diff x.gif

# --- trace and fan
printf '%s\n' 'render: {shadows: off}' 'solids:' \
    '  outer: {shape: box, transparency: 1, ior: 1.2, size: [4, 4, 4], priority: 0}' \
    '  inner: {shape: box, transparency: 1, ior: 1.3, size: [1, 2, 3], rotation: [10, 20, 30], priority: 1}' >glass.yaml
refused "trace of nothing" "no scene is given" trace
refused "trace without a ray" "give --pixel" trace "$scene"
refused "trace of a pixel and a ray" "exclude each other" trace "$scene" --pixel 1,1 --ray 0,0,0,1,0,0
refused "trace of two scenes" "unexpected argument" trace "$scene" "$scene" --pixel 1,1
refused "trace of a pixel outside" "--pixel: .*800 x 600" trace "$scene" --pixel 800,0
refused "trace of a negative pixel" "--pixel: .*outside" trace "$scene" --pixel=-1,0
refused "trace of half a pixel" "invalid pixel.*integers" trace "$scene" --pixel 1.5,2
refused "trace of one number" "fewer than 2" trace "$scene" --pixel 7
refused "trace of a pixel of words" "'x' is not a number" trace "$scene" --pixel 1,x
refused "trace of a ray with five numbers" "fewer than 6" trace "$scene" --ray 0,0,0,1,0
refused "trace of a ray with seven numbers" "more than 6" trace "$scene" --ray 0,0,0,1,0,0,0
refused "trace of a ray with NaN" "'nan' is not a number" trace "$scene" --ray 0,0,0,nan,0,1
refused "trace of a ray with an overflow" "'1e999' is not a number" trace "$scene" --ray 0,0,0,1e999,0,1
refused "trace of a ray without direction" "--ray: .*no direction" trace "$scene" --ray 0,1,0,0,0,0
refused "trace of a ray from far away" "--ray: .*too far" trace "$scene" --ray 1e7,1,0,1,0,0
refused "trace of a wrong depth" "--depth 65: " trace "$scene" --pixel 1,1 --depth 65
refused "trace at a wrong wavelength" "--lambda nan: " trace "$scene" --pixel 1,1 --lambda nan
refused "trace with a wrong --set" "--set" trace "$scene" --pixel 1,1 --set render.dpth=3
refused "trace in two formats" "more than one format" trace "$scene" --pixel 1,1 --json --svg
refused "trace into an unknown ending" "x.gif: .*\.svg" trace "$scene" --pixel 1,1 -o x.gif
refused "trace into a missing folder" "folder does not exist" trace "$scene" --pixel 1,1 -o nowhere/x.svg
refused "trace onto a folder" "is a folder" trace "$scene" --pixel 1,1 --json -o folder.png
refused "trace over the scene" "the scene reads this file" trace same.yaml --pixel 1,1 --text -o same.yaml
# Two million rays: seconds, and a minute with sanitizers.
[[ ${CONFIG:-release} != release ]] ||
    refused "a tree too large" "--ray: .*more than .* rays.*render.depth" trace glass.yaml --ray 0.1,0.2,0.3,1,0.7,0.4 \
        --depth 64
refused "misspelt option of trace" "did you mean '--pixel'" trace "$scene" --pixle 1,1
refused "fan of nothing" "no scene is given" fan
refused "fan without an axis" "axis of the fan is not given" fan "$scene" -o x.svg
refused "fan without a file" "no output is given" fan "$scene" --from 0,0,0 --to 1,0,0
fan() { # WHAT PATTERN ARGUMENT...
    refused "$1" "$2" fan "$scene" --from -3,1,0 -o x.svg "${@:3}"
}
fan "fan to its own start" "same point" --to -3,1,0
fan "fan with NaN" "'nan' is not a number" --to 3,nan,0
fan "fan of no rays" "integer from 1" --to 3,1,0 --rays 0
fan "fan of too many rays" "integer from 1" --to 3,1,0 --rays 100001
fan "fan with width and spread" "exclude each other" --to 3,1,0 --width 1 --spread 10
fan "fan of a negative width" "out of range" --to 3,1,0 --width=-1
fan "fan of a half circle" "out of range" --to 3,1,0 --spread 180
fan "fan in a plane across its axis" "zero or parallel to the axis" --to 3,1,0 --plane 1,0,0
fan "fan in no plane" "zero or parallel to the axis" --to 3,1,0 --plane 0,0,0
fan "fan into an unknown ending" "x.png: .*\.csv" --to 3,1,0 -o x.png
fan "fan to standard output" "-o -: " --to 3,1,0 -o -
fan "fan of a wrong depth" "--depth deep: " --to 3,1,0 --depth deep

# --- scenes and studies; the tests of the modules cover more
bad_scene() { # WHAT PATTERN TEXT
    printf '%b' "$3" >bad.yaml
    refused "scene: $1" "^cuvette: bad\.yaml.*$2" render bad.yaml --json
}
bad_scene "unknown key" ":2:.*did you mean" 'title: a\nrendr: {depth: 1}\n'
bad_scene "wrong type" ":1:" 'render: {width: [1, 2]}\n'
bad_scene "out of range" ":1:" 'render: {width: 0}\n'
bad_scene "NaN" ":2:" 'lights:\n  lamp: {intensity: .nan}\n'
bad_scene "an alias" ":1:" 'render: &a {width: 8}\ncamera: *a\n'
bad_scene "binary" "" '\x00\x01\x02\xff'
bad_scene "not closed" ":" 'render: {width: 8\n'
bad_scene "a key twice" ":1:" 'render: {width: 8, width: 9}\n'
bad_scene "unknown shape" ":2:" 'solids:\n  a: {shape: moebius}\n'
bad_scene "a missing material" ":2:" 'solids:\n  a: {shape: box, material: gold}\n'
bad_scene "a list instead of a map" ":1:" '- a\n- b\n'
bad_study() { # WHAT PATTERN TEXT
    printf '%b' "$3" >bad.study
    refused "study: $1" "^cuvette: bad\.study.*$2" study run bad.study --results results
}
bad_study "unknown key" ":2:" "study: a\nscen: $scene\n"
bad_study "a missing scene" ":2:" 'study: a\nscene: nowhere.yaml\n'
bad_study "unknown parameter" ":3:" "study: a\nscene: $scene\ngrid: [{render.dpth: [1, 2]}]\nrepetitions: 1\n"
bad_study "value out of range" ":3:" "study: a\nscene: $scene\ngrid: [{render.depth: [1, 200]}]\nrepetitions: 1\n"
bad_study "no repetitions" ":" "study: a\nscene: $scene\ngrid: [{render.depth: [1]}]\nrepetitions: 0\n"
bad_study "a range without steps" ":3:.*steps: 5" "study: a\nscene: $scene\ngrid: [{liquid.ior: {from: 1, to: 2}}]\n"
bad_study "a range of one value" ":3:" "study: a\nscene: $scene\ngrid: [{liquid.ior: {from: 2, to: 2, steps: 3}}]\n"
bad_study "a minimum of repetitions above the maximum" ":3:.*less than" \
    "study: a\nscene: $scene\nrepetitions: {min: 9, max: 3, relative_width: 0.1}\n"
[[ -e results ]] && echo "# a refused study has created results/"
# Rows of a version without identities.
printf '%s\n' 'study: unknown' "scene: $scene" 'set: {render.width: 8, render.height: 6}' 'repetitions: 1' \
    >unknown.study
"$program" study run unknown.study --results unknown-results >/dev/null
sed -i '1s/,identity,/,definition,/' unknown-results/unknown/rows.csv
for verb in run status summary verify; do
    refused "study $verb: rows without identities" "rows\.csv.*lack the column identity.*run the study again" \
        study "$verb" unknown.study --results unknown-results
done

# --- files of points
printf 'meshes:\n  p: {file: p.xyz}\nsolids:\n  a: {shape: sphere, points: p}\n' >points.yaml
points() { # WHAT PATTERN TEXT
    printf '%b' "$3" >p.xyz
    refused "points: $1" "$2" render points.yaml --json
    refused "points, checked: $1" "$2" scene points.yaml --check
}
points "a missing number" '[^;]*p\.xyz:2:4: .*missing; give three numbers' '1 2 3\n1 2\n'
points "a word" '[^;]*p\.xyz:1:3: this is not a finite number; give' '1 two 3\n'
points "a fourth number" '[^;]*p\.xyz:1:7: .*follows' '1 2 3 -4\n'
points "a coordinate that is too large" '[^;]*p\.xyz:1:5: .*too large' '1 2 1e7\n'
points "binary" '[^;]*p\.xyz:1:1: .*' '\0\1\2\3'
points "empty" '[^;]*p\.xyz:1:1: .*no points' ''
rm p.xyz
refused "points: no file" 'points\.yaml:2:13: p: p\.xyz: cannot open' render points.yaml --json

echo "$passed passed, $failed failed"
((failed == 0))
