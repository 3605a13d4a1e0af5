#!/bin/bash
# A file under src/ includes only from its own room and from floors below it, written from src/. Reads the #include
# lines; then plants bad ones in a copy, to see that they are caught.
#
# One door leads sideways: cli/lab.c includes web/lab.h, since `cuvette lab` starts the laboratory, which is next to
# the program's other commands. No other file of cli may look into web, and none of web into cli.
set -uo pipefail
cd "$(dirname "$0")/.."

# Prints one line an include that breaks the rule; silence is good.
check() {
    (cd "$1" && find . -name '*.[ch]' -printf '%P\n' | sort | xargs awk '
        BEGIN {
            split("base 0 optics 1 geometry 1 measure 1 image 1 import 1 softbody 2 scene 3 render 4 " \
                  "realism 5 lint 5 job 6 study 7 report 7 engine 8 web 9 cli 9 mpi 9 python 9", word)
            for (i = 1; i in word; i += 2) floor[word[i]] = word[i + 1]
        }
        function room(path) { return path ~ /\// ? substr(path, 1, index(path, "/") - 1) : "engine" }
        function complain(what) { printf "%s:%d: %s\n", FILENAME, FNR, what }
        FNR == 1 { own = room(FILENAME); if (!(own in floor)) complain("room " own " stands on no floor") }
        /^[ \t]*#[ \t]*include[ \t]*"/ {
            split($0, part, "\""); target = part[2]; other = room(target)
            if (target ~ /(^|\/)\.\.?\//) complain("\"" target "\" is not written from src/")
            else if (target !~ /\// && target != "cuvette.h") complain("\"" target "\" is not written from src/")
            else if (!(other in floor)) complain("\"" target "\" leads to a room that stands on no floor")
            else if (other != own && floor[other] > floor[own]) complain("\"" target "\" climbs from " own " to " other)
            else if (other != own && floor[other] == floor[own] && FILENAME " " target != "cli/lab.c web/lab.h")
                complain("\"" target "\" goes sideways from " own " to " other)
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

plant() { # plant FILE INCLUDE EXPECTED: a copy with that line must be refused with that word
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
report 'includes stay on their floors' "$(check src)"
callers=$(grep -rl --include='*.c' 'renderer_render(' src | grep -vx -e src/render/core/renderer.c -e src/job/job.c)
report 'frames are rendered by the job alone' "${callers#src/}"
plant base/a.h '"optics/interface.h"' climbs
plant render/a.c '"cuvette.h"' climbs
plant geometry/a.c '"measure/clock.h"' sideways
plant cli/a.c '"web/page.h"' sideways
plant cli/lab.c '"web/lab.h"' ''
plant cli/lab.c '"web/http/http.h"' sideways
plant cli/a.c '"job/job.h"' ''
plant job/a.c '"study/study.h"' climbs
plant job/a.c '"render/core/renderer.h"' ''
plant render/a.c '"job/job.h"' climbs
plant cli/a.c '"mpi/shards.h"' sideways
plant web/a.c '"cli/cli.h"' sideways
plant web/a.c '"report/json.h"' ''
plant report/a.c '"cuvette.h"' climbs
plant study/a.c '"report/json.h"' sideways
plant web/a.c '"cuvette.h"' ''
plant cuvette.c '"web/http/http.h"' climbs
plant scene/a.c '"params.h"' 'not written from src/'
plant scene/a.c '"../base/status.h"' 'not written from src/'
plant scene/a.c '"scene/../render/film.h"' 'not written from src/'
plant scene/a.c '"attic/old.h"' 'no floor'
plant realism/a.c '"study/study.h"' climbs
plant study/a.c '"realism/realism.h"' ''
plant cuvette.c '"cli/cli.h"' climbs
plant cuvette.c '"study/study.h"' ''
plant cli/a.c '"cuvette.h"' ''
plant scene/a.c '"scene/model/scene.h"' ''
plant scene/a.c '"import/mesh_wire.h"' ''
plant import/a.c '"scene/assets/mesh_stream.h"' climbs
exit $failed
