/* The cells of rows that have a definition instead of an identity, written by versions without identities. A definition
 * is a hash of a whole study. Known are the study's own; that of version 1 (study/definition_v1.h); and the one
 * recorded in the folder's manifest.json, if the scene's files had the same contents: the recorded texts of study and
 * scene then give the identity of each of its cells. Ownership: borrows study and folder until accepted_end. Errors:
 * STATUS_FAILURE if the machine lacks memory or cannot read a file. */
#pragma once

#include "study/study.h"

typedef struct accepted {
    const study *s;
    const char *folder;
    bool looked; /* older definitions were looked up, at the first row whose hash differs from the study's */
    bool has_v1;
    uint64_t v1;
    study *recorded; /* read from the manifest's texts, or NULL */
    uint64_t recorded_definition, *recorded_identity;
    char why_not[400];
} accepted;

void accepted_start(accepted *a, const study *s, const char *folder);
void accepted_end(accepted *a);
/* The identity of the row with that definition, as in the row, and number of its cell; of_comparison: in compare.csv,
 * where the definition includes the study's reference. *known: whether there is one; else accepted_why_not. */
status accepted_identity(accepted *a, const char *definition, size_t cell, bool of_comparison, uint64_t *identity,
                         bool *known, diagnostic *why);
/* Why a definition is not known. */
const char *accepted_why_not(const accepted *a);
