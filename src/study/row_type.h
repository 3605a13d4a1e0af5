/* The types of columns, for rows without a check: every value must be one that this or an earlier version could have
 * written. Ownership: row_types_create allocates, row_types_free releases. */
#pragma once

#include "study/row_files.h"

typedef struct row_types {
    unsigned char *type; /* of each column; private */
    size_t count;
} row_types;

status row_types_create(char *const *names, size_t count, row_kind kind, row_types *out, diagnostic *why);
void row_types_free(row_types *t);
/* Whether all fields have the type of their column; otherwise *column is the first that has not. */
bool row_types_fit(const row_types *t, char *const *fields, size_t *column);
