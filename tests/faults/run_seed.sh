#!/bin/bash
# run_seed.sh PROGRAM SEED: one run of tests/test_laws; what it says of each law behind its seed, and all
# of it when a law is broken.
output=$(LAWS_SEED=$2 nice "$1" 2>&1)
status=$?
((status)) && printf '%s\n' "$output" || sed -n "s/^law /seed $2: law /p" <<<"$output"
exit $status
