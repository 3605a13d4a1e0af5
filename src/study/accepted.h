/* Decides which definition hashes in a study's rows have the same meaning as the study: its current hash; the hash of
 * version 1 (study/definition_v1.h); and the hash recorded in the folder's manifest, if the recorded texts of study and
 * scene, parsed by this program, have the same meaning and the scene's files had the same contents. A definition that
 * cannot be verified is not accepted. Ownership: borrows study and folder. Errors: none; accepted_why_not describes the
 * reason. */
#pragma once

#include "study/study.h"

typedef struct accepted {
    const study *s;
    const char *folder;
    bool looked; /* older definitions were looked up, at the first row whose hash differs from the study's */
    uint64_t older[2];
    size_t count;
    char why_not[400];
} accepted;

void accepted_start(accepted *a, const study *s, const char *folder);
/* definition: the hash in the row; in compare.csv it includes the study's reference. */
bool accepted_has(accepted *a, const char *definition, bool of_comparison);
/* Why rows are not accepted: "render.width is 800 there, and 640 here". */
const char *accepted_why_not(const accepted *a);
