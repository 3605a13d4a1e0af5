/* The environments of a study's rows. Ownership: row_environments_find gives an array for free. */
#pragma once

#include "study/row_files.h"

typedef struct row_environment_count {
    char key[ENVIRONMENT_KEY];
    size_t rows;          /* without warm-ups */
    const run_entry *run; /* its last run in row_files.runs, or NULL */
} row_environment_count;

/* In the order of the first row of each. */
status row_environments_find(const row_files *files, row_environment_count **out, size_t *count, diagnostic *why);
/* The key that an option chooses: "" for NULL; of "main", as row_environments_main; or the text. STATUS_BAD_INPUT if no
 * row is of that environment. */
status row_environments_choose(const row_files *files, const char *text, char key[ENVIRONMENT_KEY], diagnostic *why);
/* The one with most rows, of equal ones the last; "" without rows. */
status row_environments_main(const row_files *files, char key[ENVIRONMENT_KEY], diagnostic *why);
