/* Study files in the chosen folder, and the folders of their rows. A study is identified by the name in its file, or
 * by the file's name if the file cannot be read. No file outside the folder is opened. Ownership: results belong to
 * the caller. Errors: STATUS_BAD_INPUT with the reason. */
#pragma once

#include "study/study.h"
#include "web/lab_private.h"

/* Calls visit for the studies of the folder, three levels deep, sorted by file name; stops when visit returns false.
 * name and file are borrowed. */
status study_each(const lab *l, bool (*visit)(void *context, const char *name, const char *file), void *context,
                  diagnostic *why);
/* Reads a study; file is relative to the folder. */
status study_open(const lab *l, const char *file, study **out, diagnostic *why);
/* Permits only what is in the folder; for readers of studies. Valid as long as the lab. */
study_guard study_guard_of(const lab *l);
/* The file of the study with that name, allocated memory; NULL with STATUS_OK if there is none. */
status study_find(const lab *l, const char *name, char **file, diagnostic *why);

/* Checks that the rows in that results folder (relative to the working directory) and the files written next to them
 * are in the chosen folder. */
status study_check_results(const lab *l, const char *results, const char *name, diagnostic *why);
/* The names of the folders that contain rows of it, three levels deep. STATUS_FAILURE: one cannot be listed now. */
status study_runs(const lab *l, const char *name, json_t **out, diagnostic *why);
