#!/bin/bash
# The loops of the kernels that gcc vectorised, for each instruction set. A loop under the comment VECTORISE must be
# vectorised for AVX2 and AVX-512; with SSE2 it may stay scalar. KERNEL_FLAGS and KERNEL_FLAGS_<isa> come from the
# Makefile.
set -uo pipefail
cd "$(dirname "$0")/.."
cc=${KERNEL_CC:-gcc}
if ! command -v "$cc" >/dev/null; then
    echo "# $cc is not installed, whose report is required"
    exit 77
fi
if [[ -z ${KERNEL_FLAGS:-} ]]; then
    exec make --no-print-directory vectorise # run by hand, without the Makefile's flags
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
case_number=0 failed=0
read -ra flags <<<"$KERNEL_FLAGS"

# report FILE ISA: compiles, and writes "file:line bytes" for every loop that was vectorised.
report() {
    local isa_flags=KERNEL_FLAGS_$2
    read -ra isa_flags <<<"${!isa_flags}"
    rm -f "$folder/all" # gcc appends
    "$cc" "${flags[@]}" "${isa_flags[@]}" -DKERNEL_ISA="$2" -fopt-info-vec="$folder/all" \
        -fdump-tree-vect-details="$folder/details" -c -o "$folder/object" "$1" || return
    awk -F: '/loop vectorized using/ {
        match($0, /using [0-9]+/); bytes = substr($0, RSTART + 6, RLENGTH - 6) + 0
        if (bytes > width[$1 ":" $2]) width[$1 ":" $2] = bytes }
        END { for (line in width) print line, width[line] }' "$folder/all" | sort -t: -k1,1 -k2n >"$folder/vectorised"
}

# The reason for a scalar loop: the first one in gcc's detailed report, which is for the widest vectors. The short
# report has only the last.
reason() { # reason FILE:LINE
    awk -v loop="Analyzing loop at $1" '/Analyzing loop at/ { mine = $0 == loop }
        mine && sub(/.*not vectorized: /, "") { print; exit }' "$folder/details"
}

# with_headers FILE: the file and the headers with marked loops that it includes.
with_headers() {
    echo "$1"
    "$cc" "${flags[@]}" -DKERNEL_ISA=sse2 -MM "$1" | grep -o 'src/[^ ]*\.h' | sort -u |
        xargs grep -l '/\* VECTORISE \*/'
}

while read -r file; do
    marks=$(with_headers "$file" | xargs awk '/\/\* VECTORISE \*\// { marked = 1; next }
        marked { print FILENAME ":" FNR ($0 ~ /for *\(/ ? "" : "!"); marked = 0 }')
    for isa in sse2 avx2 avx512; do
        case_number=$((case_number + 1))
        if ! report "$file" "$isa"; then
            echo "not ok $case_number - $file for $isa does not compile"
            failed=1
            continue
        fi
        scalar=()
        for line in $marks; do
            # a header's loop that this file does not use is not compiled
            [[ $line == "$file":* ]] || grep -q "Analyzing loop at $line$" "$folder/details" || continue
            grep -q "^$line " "$folder/vectorised" || scalar+=("$line")
        done
        summary=$(awk -v own="$file:" '{ sub(own, ""); printf " %s(%s)", $1, $2 }' "$folder/vectorised")
        if ((${#scalar[@]})) && [[ $isa != sse2 ]]; then
            echo "not ok $case_number - $file for $isa"
            failed=1
        else
            echo "ok $case_number - $file for $isa"
        fi
        echo "# $isa: $file: lines (bytes of a vector):${summary:- none}"
        for line in "${scalar[@]}"; do
            echo "# $isa: ${line%!}: scalar, $([[ $line == *! ]] && echo 'no for loop follows the mark' ||
                reason "$line")"
        done
    done
done < <(find src -name '*_kernel.c' | sort)
exit $failed
