#!/bin/bash
# acts_notes.sh FOLDER: whether the twelve slices of test_acts, whose notes are in FOLDER, have proved each
# note (tests/lint/test_acts.c). The status is 77 if not all of them have run.
set -euo pipefail
notes=("$1"/acts-*.notes)
((${#notes[@]} == 12)) || {
    echo 'acts-notes: runs after the other slices of acts'
    exit 77
}
cat "${notes[@]}" >"$1/acts.notes"
ACTS_SLICE=notes ACTS_NOTES=$PWD/$1/acts.notes exec make -s test only=acts
