/* Studies as files of the chosen folder, and where their rows lie. A study is known by the name that stands in it; one
 * that cannot be read by its file's. Nothing is opened that lies outside of the folder, whatever names it. Ownership:
 * what is given is the caller's. Errors: STATUS_BAD_INPUT with the reason. */
#pragma once

#include "study/study.h"
#include "web/lab_private.h"

/* Calls visit for the studies of the folder, three folders deep, in the order of their names; false ends it. name and
 * file are borrowed. */
status study_each(const lab *l, bool (*visit)(void *context, const char *name, const char *file), void *context,
                  diagnostic *why);
/* Reads it; file is relative to the folder. */
status study_open(const lab *l, const char *file, study **out, diagnostic *why);
/* The file of the study of that name, fresh memory; NULL with STATUS_OK where there is none. */
status study_find(const lab *l, const char *name, char **file, diagnostic *why);

/* Do the rows in that folder of results, in the program's own terms, and what is written beside them lie in the chosen
 * folder? */
status study_check_results(const lab *l, const char *results, const char *name, diagnostic *why);
/* The names of folders that hold rows of it, three folders deep; NULL when memory is out. */
json_t *study_runs(const lab *l, const char *name);
