# shellcheck shell=bash
# rows: study status, summary and merge on 100000 rows
# By tests/bench_rows next to CUVETTE (make build/tests/bench_rows), which repeats and takes medians itself.
reps=1
prepare() { need "$build/tests/bench_rows" "make $build/tests/bench_rows builds it"; }
round() { "$build/tests/bench_rows"; }
