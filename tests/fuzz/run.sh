#!/bin/bash
# run.sh BUILD [NAME...] runs the fuzzers of BUILD/tests, the one that has waited longest first, each for
# FUZZ_SECONDS (60) and all for FUZZ_TOTAL seconds (without it: each once). New inputs are kept in BUILD/corpus/NAME,
# the time of the last run is that of BUILD/corpus/NAME.ran, and an input that fails is BUILD/corpus/NAME-crash-...
#   run.sh --merge BUILD [NAME...]   renews tests/fuzz/corpus/NAME: the fewest and shortest inputs that
#                                               reach the same code. SEEDS: a folder of further inputs, SEEDS/NAME
# Status: 0; 1 if a fuzzer found something.
set -uo pipefail
asan=${ASAN_OPTIONS:-allocator_may_return_null=1}

declare -A options=([http]='-timeout=60' [films]='-max_len=52')
# The longest inputs of the committed corpus.
declare -A longest=([films]=52 [package]=64 [rows]=6000 [lesson]=4096)

merge=
if [[ ${1:-} == --merge ]]; then
    merge=1
    shift
fi
build=$1
shift
names=("$@")
if ((${#names[@]} == 0)); then
    mapfile -t names < <(for file in tests/fuzz/*.c; do basename "$file" .c; done)
fi

# folders NAME: where its inputs come from.
folders() {
    local folder
    for folder in "tests/fuzz/corpus/$1" "${SEEDS:+$SEEDS/$1}"; do
        [[ -n $folder && -d $folder ]] && printf '%s\n' "$folder"
    done
    case $1 in
    scene | script | shared | study | lesson) find experiments tests/bad -type d ;;
    esac
}

# run NAME SECONDS
run() {
    local name=$1 extra=() inputs=()
    read -ra extra <<<"${options[$name]:-}"
    mapfile -t inputs < <(folders "$name")
    [[ -f tests/fuzz/$name.dict ]] && extra+=("-dict=tests/fuzz/$name.dict")
    mkdir -p "$build/corpus/$name"
    touch "$build/corpus/$name.ran"
    case $name in http) export ASAN_OPTIONS=$asan:detect_leaks=0 ;; *) export ASAN_OPTIONS=$asan ;; esac
    echo "$name, $2 s"
    "$build/tests/fuzz_$name" -max_total_time="$2" -timeout=25 -rss_limit_mb=2560 \
        -max_len=65536 -print_final_stats=1 \
        -artifact_prefix="$build/corpus/$name-" -verbosity=0 "${extra[@]}" "$build/corpus/$name" "${inputs[@]}" 2>&1 |
        sed '/Recommended dictionary/,/End of recommended/d'
}

# renew NAME
renew() {
    local name=$1 extra=() inputs=() new=$build/corpus/$1.new
    read -ra extra <<<"${options[$name]:-}"
    mapfile -t inputs < <(folders "$name")
    rm -rf "$new"
    mkdir -p "$new" "$build/corpus/$name"
    ASAN_OPTIONS=$asan:detect_leaks=0 "$build/tests/fuzz_$name" -merge=1 -use_counters=0 -timeout=25 \
        -rss_limit_mb=2560 -max_len="${longest[$name]:-2048}" \
        "$new" "$build/corpus/$name" "${inputs[@]}" >"$build/corpus/$name.merge" 2>&1 || {
        tail -20 "$build/corpus/$name.merge"
        return 1
    }
    mkdir -p "tests/fuzz/corpus/$name"
    find "tests/fuzz/corpus/$name" -type f ! -name 'found-*' -delete
    # Longer files than that are cut by the merge, but copied whole.
    find "$new" -type f -size "-$((${longest[$name]:-2048} + 1))c" -exec cp -t "tests/fuzz/corpus/$name" {} +
    echo "$name: $(find "tests/fuzz/corpus/$name" -type f | wc -l) inputs," \
        "$(du -bs "tests/fuzz/corpus/$name" | cut -f 1) bytes"
}

if [[ $merge ]]; then
    for name in "${names[@]}"; do
        renew "$name" || exit 1
    done
    exit 0
fi

# waited: the names, those that never ran first, then by the time of their last run.
waited() {
    local name
    for name in "${names[@]}"; do
        printf '%s %s\n' "$(stat -c %Y "$build/corpus/$name.ran" 2>/dev/null || echo 0)" "$name"
    done | sort -s -n | cut -d ' ' -f 2
}

seconds=${FUZZ_SECONDS:-60}
left=${FUZZ_TOTAL:-$((seconds * ${#names[@]}))}
bad=()
mkdir -p "$build/corpus"
mapfile -t order < <(waited)
for name in "${order[@]}"; do
    ((left > 0)) || break
    run "$name" "$((left < seconds ? left : seconds))" || bad+=("$name")
    left=$((left - seconds))
done
if ((${#bad[@]})); then
    echo "fuzz: found by: ${bad[*]}; the inputs are $build/corpus/NAME-*" >&2
    exit 1
fi
