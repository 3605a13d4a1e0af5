#!/bin/bash
# Words of words.tsv that the project does not use, because the field has standard ones, and where each is allowed.
# A line of the table: pattern (grep -E, whole words, any case), what to say instead. A line of words_allowed.tsv:
# file (a glob; * for any), a part of the line, the reason. Read: sources, tests, documents.
set -uo pipefail
cd "$(dirname "$0")/../.."
mapfile -t files < <(git ls-files -- src tests experiments plots '*.md' 'paper/*.tex' .ci Makefile mk |
    grep -vE '\.(png|jpg|pfm|csv|obj|mtl|ply|glb|gltf|stl|tsv|svg|txt)$|^tests/(data|golden|fuzz/corpus)/')
((${#files[@]} > 100)) || {
    echo "not ok 1 - git ls-files finds ${#files[@]} files only"
    exit 1
}

allowed() { # FILE LINE: does a line of the list of exceptions fit?
    local glob part reason
    while IFS=$'\t' read -r glob part reason; do
        [[ -z $glob || $glob == \#* ]] && continue
        # shellcheck disable=SC2053 # a glob is meant
        [[ $1 == $glob && ($part == "*" || $2 == *"$part"*) && -n $reason ]] && return 0
    done <tests/source/words_allowed.tsv
    return 1
}

count=0 failed=0
while IFS=$'\t' read -r pattern instead; do
    [[ -z $pattern || $pattern == \#* ]] && continue
    count=$((count + 1))
    found=()
    while IFS= read -r use; do
        file=${use%%:*} line=${use#*:*:}
        allowed "$file" "$line" || found+=("$use")
    done < <(grep -nwiE -- "($pattern)" "${files[@]}")
    if ((${#found[@]} == 0)); then
        echo "ok $count - $pattern"
    else
        failed=1
        echo "not ok $count - $pattern: ${#found[@]} uses; say $instead"
        printf '%s\n' "${found[@]:0:${WORDS_SHOWN:-5}}" | cut -c 1-150 | sed 's/^/# /'
    fi
done <tests/source/words.tsv
((count > 0)) || failed=1
exit $failed
