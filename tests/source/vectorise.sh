#!/bin/bash
# The loops of the kernels that gcc and clang vectorised, for each instruction set. Every copy of a loop under the
# comment VECTORISE (functions are inlined) must be vectorised for AVX2 and AVX-512; with SSE2 it may stay scalar.
# Only with CHECK=1: compiling all kernels anew takes long.
# KERNEL_FLAGS and KERNEL_FLAGS_<isa> come from the Makefile.
set -uo pipefail
cd "$(dirname "$0")/../.."
gcc=${KERNEL_CC:-gcc} clang=${KERNEL_CLANG:-clang}
if ! command -v "$gcc" >/dev/null; then
    echo "# $gcc is not installed, whose report is required"
    exit 77
fi
if [[ -z ${KERNEL_FLAGS:-} ]]; then
    exec make --no-print-directory vectorise # run by hand, without the Makefile's flags
fi
if [[ -z ${CHECK:-} ]]; then
    echo "# kernels are compiled anew only with CHECK=1"
    exit 77
fi
compilers=(gcc clang) kinds=(sse2 avx2 avx512)
if ! command -v "$clang" >/dev/null; then
    echo "# $clang is not installed: its loops are not checked"
    compilers=(gcc)
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
case_number=0 failed=0
read -ra flags <<<"$KERNEL_FLAGS"

# compile_with CC ISA FILE FLAG...: compiles FILE with its flags for ISA.
compile_with() {
    local isa_flags=KERNEL_FLAGS_$2
    read -ra isa_flags <<<"${!isa_flags}"
    "$1" "${flags[@]}" "${isa_flags[@]}" -DKERNEL_ISA="$2" "${@:4}" -c -o "$folder/object" "$3"
}

# report_gcc FILE ISA and report_clang FILE ISA compile, and write
#   vectorised: "file:line width" for every loop that was vectorised,
#   scalar:     "file:line reason" for every loop of which a copy was not.
report_gcc() {
    rm -f "$folder/all" # gcc appends
    compile_with "$gcc" "$2" "$1" -fopt-info-vec="$folder/all" -fdump-tree-vect-details="$folder/details" || return
    awk -F: '/loop vectorized using/ {
        match($0, /using [0-9]+/); bytes = substr($0, RSTART + 6, RLENGTH - 6) + 0
        if (bytes > width[$1 ":" $2]) width[$1 ":" $2] = bytes }
        END { for (line in width) print line, width[line] }' "$folder/all" |
        sort -t: -k1,1 -k2n >"$folder/vectorised"
    # The first reason is for the widest vectors.
    awk 'function finish() { if (loop != "" && !done) print loop, reason }
        /^Analyzing loop at / { finish(); loop = $4; done = 0; reason = ""; next }
        /optimized: loop vectorized using/ { done = 1 }
        reason == "" && sub(/.*not vectorized: /, "") { reason = $0 }
        END { finish() }' "$folder/details" | sort -u >"$folder/scalar"
}
report_clang() {
    compile_with "$clang" "$2" "$1" -Wno-everything -Rpass-missed=loop-vectorize -Rpass-analysis=loop-vectorize \
        '-Rpass=loop-vectorize|slp-vectorizer|loop-unroll' 2>"$folder/all" || return
    # A short loop is unrolled first; then its body is vectorised as straight code.
    awk -F: 'function last_line(file, first, n, text, indent) {
            for (n = 1; (getline text < file) > 0; n++) {
                if (n == first) { match(text, /^ */); indent = substr(text, 1, RLENGTH)
                    if (text !~ /\{$/) { n += 2; break } }
                if (n > first && text == indent "}") break }
            close(file)
            return n }
        /remark: vectorized loop/ {
            match($0, /width: [0-9]+/); lanes = substr($0, RSTART + 7, RLENGTH - 7) + 0
            if (lanes > width[$1 ":" $2]) width[$1 ":" $2] = lanes }
        /remark: completely unrolled/ { unrolled[$1 ":" $2] = 1 }
        /remark: .*SLP vectorized/ { straight[$1 ":" $2] = 1 }
        END {
            for (line in width) print line, width[line]
            for (line in unrolled) {
                split(line, at, ":"); end = last_line(at[1], at[2])
                for (n = at[2] + 1; n < end; n++) if (at[1] ":" n in straight) { print line, "unrolled"; break } } }' \
        "$folder/all" | sort -t: -k1,1 -k2n >"$folder/vectorised"
    # The reason comes before the verdict, for the same loop.
    awk -F: '/remark: loop not vectorized: / {
            reason = $0; sub(/.*not vectorized: /, "", reason); sub(/(;| \[-R).*/, "", reason) }
        /remark: loop not vectorized \[/ { print $1 ":" $2, reason; reason = "" }' "$folder/all" |
        sort -u >"$folder/scalar"
}

# with_headers FILE: the file and the headers with marked loops that it includes.
with_headers() {
    echo "$1"
    "$gcc" "${flags[@]}" -DKERNEL_ISA=sse2 -MM "$1" | grep -o 'src/[^ ]*\.h' | sort -u |
        xargs grep -l '/\* VECTORISE \*/'
}

# check COMPILER FILE ISA: one case, for the loops in $marks.
check() {
    local line scalar=() summary
    case_number=$((case_number + 1))
    if ! "report_$1" "$2" "$3"; then
        echo "not ok $case_number - $2 for $3 does not compile with $1"
        failed=1
        return
    fi
    for line in $marks; do
        if grep -q "^$line " "$folder/scalar"; then
            scalar+=("$line: scalar, $(sed -n "s|^$line ||p" "$folder/scalar" | paste -sd '|')")
        # a header's loop that this file does not use is not compiled
        elif [[ $line == "$2":* ]] && ! grep -q "^$line " "$folder/vectorised"; then
            scalar+=("${line%!}: $([[ $line == *! ]] && echo 'no for loop follows' || echo 'not in the report')")
        fi
    done
    summary=$(awk -v own="$2:" '{ sub(own, ""); printf " %s(%s)", $1, $2 }' "$folder/vectorised")
    if ((${#scalar[@]})) && [[ $3 != sse2 ]]; then
        echo "not ok $case_number - $2 for $3 with $1"
        failed=1
    else
        echo "ok $case_number - $2 for $3 with $1"
    fi
    echo "# $1 $3: $2: lines ($([[ $1 == gcc ]] && echo bytes || echo lanes) of a vector):${summary:- none}"
    for line in "${scalar[@]}"; do
        echo "# $1 $3: $line"
    done
}

while read -r file; do
    # A mark applies to the next for loop; pragmas may come between.
    marks=$(with_headers "$file" | xargs awk '/\/\* VECTORISE \*\// { marked = 1; next }
        marked && /^ *INDEPENDENT_LANES$/ { next }
        marked { print FILENAME ":" FNR ($0 ~ /for *\(/ ? "" : "!"); marked = 0 }')
    for compiler in "${compilers[@]}"; do
        for isa in "${kinds[@]}"; do
            check "$compiler" "$file" "$isa"
        done
    done
done < <(find src -name '*_kernel.c' | sort)
exit $failed
