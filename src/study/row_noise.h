/* What disturbed a row: the noise that it recorded, judged by the study's present rule. Rows of other versions may
 * lack some of its values. */
#pragma once

#include "study/row_files.h"

/* The columns of one table; looked up again when the table changes. Start with zeros. */
typedef struct row_noise_columns {
    const csv *table;
    int others, steal, drop, stalled;
} row_noise_columns;
noise_verdict row_noise_judge(const noise_rule *rule, row_noise_columns *at, const row_ref *ref);
