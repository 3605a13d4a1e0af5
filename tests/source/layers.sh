#!/bin/bash
# The layers of src/: a file includes only headers of its own folder and of lower layers, with paths from src/; the
# folders of a room have an order, too. Checks the #include lines, and that violations inserted into a copy are
# detected.
#
# The one exception within a layer is cli/lab.c, which includes web/lab.h because `cuvette lab` starts the laboratory.
# No other file of cli may include from web, and none of web from cli.
set -uo pipefail
cd "$(dirname "$0")/../.."

# The order of the folders within a folder of src, lowest first; "." is that folder itself. A file includes from its own
# folder and from those before it.
folder_order='
geometry  mesh hierarchy . primitives shapes regions
render    plan photons tracer shade camera zbuffer integrators caustics frame inspect
scene     model data lens file assets motion package
study     . plan rows fit run summary plot
wasm      . api
web       http document live session api .
'

# Prints one line per include that violates the rule.
check() {
    (cd "$1" && find . -name '*.[ch]' -printf '%P\n' | sort | xargs awk -v order="$folder_order" '
        BEGIN {
            for (i = split(order, line, "\n"); i > 0; i--) {
                n = split(line[i], word, " ")
                for (j = 2; j <= n; j++) place[word[1], word[j]] = j
            }
            split("base 0 optics 1 geometry 1 measure 1 image 1 import 1 softbody 2 scene 3 render 4 " \
                  "realism 5 lens 5 lint 5 job 6 lesson 7 study 8 report 8 engine 9 web 10 cli 10 python 10 " \
                  "mpi 11 wasm 11 manual 11", word)
            for (i = 1; i in word; i += 2) layer[word[i]] = word[i + 1]
        }
        function folder(path) { return path ~ /\// ? substr(path, 1, index(path, "/") - 1) : "engine" }
        function below(path, part) { return split(path, part, "/") > 2 ? part[2] : "." } # of the folder
        function complain(what) { printf "%s:%d: %s\n", FILENAME, FNR, what }
        FNR == 1 {
            own = folder(FILENAME); within = below(FILENAME)
            if (!(own in layer)) complain("folder " own " has no layer")
            if (within != "." && !((own, within) in place))
                complain("folder " own "/" within " has no place in the order of " own)
        }
        /^[ \t]*#[ \t]*include[ \t]*"/ {
            split($0, part, "\""); target = part[2]; other = folder(target)
            if (target ~ /(^|\/)\.\.?\//) complain("\"" target "\" is not a path from src/")
            else if (target !~ /\// && target != "cuvette.h") complain("\"" target "\" is not a path from src/")
            else if (!(other in layer)) complain("\"" target "\" is in a folder that has no layer")
            else if (other != own && layer[other] > layer[own])
                complain("\"" target "\" is in a higher layer: " own " includes from " other)
            else if (other != own && layer[other] == layer[own] && FILENAME " " target != "cli/lab.c web/lab.h")
                complain("\"" target "\" is in the same layer: " own " includes from " other)
            else if (other == own && place[own, below(target)] > place[own, within])
                complain("\"" target "\" is in a later folder of " own)
        }' /dev/null)
}

case_number=0
report() { # report NAME FINDINGS: passes when there are none
    case_number=$((case_number + 1))
    if [[ -z $2 ]]; then
        echo "ok $case_number - $1"
    else
        echo "not ok $case_number - $1"
        sed 's/^/# src\//' <<<"$2"
        failed=1
    fi
}

plant() { # plant FILE INCLUDE EXPECTED: a copy with that line must be refused with that text, or accepted without one
    local copy=$folder/planted
    mkdir -p "$copy/$(dirname "$1")"
    printf '#include <stdio.h>\n  #  include %s\n' "$2" >"$copy/$1"
    local found
    found=$(check "$copy")
    rm -r "$copy"
    if [[ -z $3 ]]; then
        report "$1 may include $2" "$found"
    elif [[ $found == "$1:2: "*"$3"* ]]; then
        report "$1 may not include $2" ''
    else
        report "$1 may not include $2" "$1: not refused with '$3': $found"
    fi
}

failed=0
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
report 'includes are from the own folder or lower layers' "$(check src)"
plant base/a.h '"optics/interface.h"' 'higher layer'
plant render/a.c '"cuvette.h"' 'higher layer'
plant geometry/a.c '"measure/clock.h"' 'same layer'
plant cli/a.c '"web/lab.h"' 'same layer'
plant cli/lab.c '"web/lab.h"' ''
plant cli/lab.c '"web/http/http.h"' 'same layer'
plant cli/a.c '"job/job.h"' ''
plant job/a.c '"study/study.h"' 'higher layer'
plant job/a.c '"render/frame/renderer.h"' ''
plant render/a.c '"job/job.h"' 'higher layer'
plant cli/a.c '"mpi/shards.h"' 'higher layer'
plant web/a.c '"cli/cli.h"' 'same layer'
plant web/a.c '"report/json.h"' ''
plant report/a.c '"cuvette.h"' 'higher layer'
plant study/a.c '"report/json.h"' 'same layer'
plant web/a.c '"cuvette.h"' ''
plant cuvette.c '"web/http/http.h"' 'higher layer'
plant scene/a.c '"params.h"' 'not a path from src/'
plant scene/a.c '"../base/status.h"' 'not a path from src/'
plant scene/a.c '"scene/../render/film.h"' 'not a path from src/'
plant scene/a.c '"attic/old.h"' 'no layer'
plant realism/a.c '"study/study.h"' 'higher layer'
plant study/a.c '"realism/realism.h"' ''
plant cuvette.c '"cli/cli.h"' 'higher layer'
plant cuvette.c '"study/study.h"' ''
plant cli/a.c '"cuvette.h"' ''
plant scene/file/a.c '"scene/model/scene.h"' ''
plant scene/a.c '"import/mesh_wire.h"' ''
plant import/a.c '"scene/assets/mesh_stream.h"' 'higher layer'
plant wasm/a.c '"wasm/api/api.h"' 'later folder'
plant render/plan/a.c '"render/shade/rough.h"' 'later folder'
plant render/frame/a.c '"render/shade/rough.h"' ''
plant wasm/api/a.c '"wasm/api/exports.h"' ''
plant wasm/api/deep/a.c '"wasm/api/exports.h"' ''
mkdir -p "$folder/planted/wasm/attic"
echo 'int a;' >"$folder/planted/wasm/attic/a.c"
found=$(check "$folder/planted")
[[ $found == wasm/attic/a.c:1:*'no place in the order'* ]]
report 'a folder without a place in the order is refused' "$( (($? == 0)) || echo "not refused: $found")"
exit $failed
