/* The oracle: what a command may do when something fails. Either it ends as if nothing had happened, with the right
 * output; or with 1, one line on standard error that names the cause and a remedy, and its folder as it was. */
#pragma once

#include "folder.h"
#include "run.h"

typedef enum verdict {
    UNHARMED, /* exit 0, output right */
    REPORTED, /* exit 1, one good line */
    CRASH,    /* or hang */
    SILENT,   /* exit 0 with a wrong or missing output */
    MESSAGE,  /* no, a double or a misleading message, or a wrong exit status */
    LEFTOVER, /* files that a failed command leaves, or cannot go on from */
    LEAK,     /* descriptors or memory */
    VERDICTS
} verdict;

/* What a run without a fault leaves. */
typedef struct reference {
    char *out, *err;
    bool out_varies;
    unsigned char *file_varies; /* by entry of after: 0 no, 1 in numbers, 2 otherwise: only its existence is checked */
    listing before, after;
    long live;
    int descriptors;
} reference;

/* Two runs; false, with a message, when they fail. Each begins with a copy of the template. */
bool reference_make(reference *ref, const run *r, const char *template);
void reference_free(reference *ref);

/* why: text of at least 400 bytes. Restores the folder to the template if it has changed. resumes: the command goes on
 * where it stopped; it is run again. */
verdict judge(const reference *ref, const run *r, const fault *f, const outcome *o, bool resumes, const char *template,
              char *why);
