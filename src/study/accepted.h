/* Which definitions in a study's rows mean what the study means. The study's own does; so does the one that it had
 * before version 2 of the definition (study/definition_v1.h); and so does the one that the folder's manifest records,
 * when the texts of study and scene that it records too, read by this program, mean the same, and the files that they
 * name held the same. What cannot be verified is not accepted. Ownership: borrows study and folder. Errors: none;
 * accepted_why_not says what is amiss. */
#pragma once

#include "study/study.h"

typedef struct accepted {
    const study *s;
    const char *folder;
    bool looked; /* for older ones, which is done only when a row has another than the study's */
    uint64_t older[2];
    size_t count;
    char why_not[400];
} accepted;

void accepted_start(accepted *a, const study *s, const char *folder);
/* definition: as it stands in the row; of a comparison it includes the study's reference. */
bool accepted_has(accepted *a, const char *definition, bool of_comparison);
/* What was found out about rows that are not: "render.width is 800 there, and 640 here". */
const char *accepted_why_not(const accepted *a);
