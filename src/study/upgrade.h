/* `study upgrade`: rows of versions before identities, runs and checks, written in the present form to another results
 * folder. The old folder does not change. */
#pragma once

#include "study/study.h"

/* Reads results/<name> and writes to/<name>: all rows of the study's cells, in the order of their files, one run for
 * each environment, and copies of the kept files. *rows: of rows.csv. STATUS_BAD_INPUT if the target has rows, or
 * nothing is old. */
status study_upgrade(const study *s, const char *results, const char *to, size_t *rows, diagnostic *why);
