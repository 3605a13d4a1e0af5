/* Studies of the laboratory: their files in the chosen folder, the running study, and figures of their results.
 * Ownership: results belong to the caller. Errors: STATUS_BAD_INPUT with the reason; STATUS_INTERRUPTED for a conflict
 * with the current state (409). */
#pragma once

#include "study/study.h"
#include "web/session/session.h"

/* --- files, and the folders of their rows (study_files.c) --- */

/* A study is identified by the name in its file, or by the file's name if the file has no name or cannot be read. No
 * file outside the folder is opened. */

/* Calls visit for the study files that GET /api/files lists, in the same order; stops when visit returns false. name
 * and file are borrowed. */
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
/* The names of the folders that contain rows of the study, three levels deep. STATUS_FAILURE: a folder cannot be listed
 * now. */
status study_runs(const lab *l, const char *name, json_t **out, diagnostic *why);

/* --- the study that runs, in a thread (studies.c) --- */

/* The render worker is suspended while a study measures. The study's progress goes to all pages as event `study` and is
 * part of the state. studies_create creates, studies_destroy releases. */

/* ended: called by the thread after each study. */
status studies_create(lab *l, void (*ended)(lab *l), studies **out, diagnostic *why);
/* Stops the running study, waits for it, and prevents later ones. Call it while the server, render worker and scene
 * document still exist; handlers may run until http_stop. */
void studies_end(studies *st);
/* Call it after http_stop. NULL is allowed; includes studies_end. */
void studies_destroy(studies *st);

/* Takes ownership of s, also after an error. */
status studies_start(studies *st, study *s, diagnostic *why);
/* Stops the study without waiting; the rows so far are kept. */
status studies_stop(studies *st, const char *name, diagnostic *why);
bool studies_runs(studies *st, const char *name); /* name NULL: whether any study runs */

/* The study in the state JSON, null before the first study; NULL when out of memory. */
json_t *studies_json(studies *st);

/* studies_ending: the ask of a cancel token, for long work: whether the laboratory ends; st is a studies *. At most one
 * thread draws figures: studies_begin_drawing returns false while another does. */
bool studies_ending(void *st);
bool studies_begin_drawing(studies *st);
void studies_end_drawing(studies *st);

/* --- figures of results (figures.c) --- */

/* SVG files that scripts in plots/ of the chosen folder draw from the rows of studies (plots/draw.sh). The head of a
 * script lists its input files (`# needs: tables/NAME.tsv`); a figure without that line belongs to the study that its
 * name begins with. Names of figures consist of lower-case letters, digits and '-'. */

/* Reads the figure as last drawn; STATUS_BAD_INPUT if it does not exist. */
status figure_read(const lab *l, const char *name, char **svg, size_t *size, diagnostic *why);

/* Names of the existing figures of a study. STATUS_FAILURE: a folder or script that is there cannot be read now. */
status figures_of(const lab *l, const char *name, json_t **out, diagnostic *why);
/* Names of the figures that can be drawn of the study; empty without plots/draw.sh. */
status figures_drawable(const lab *l, const char *name, json_t **out, diagnostic *why);

/* Writes the tables of the study (results/tables/) and draws its figures; limited to less than a minute, the time
 * that a page waits for a reply. *output: the script's output, one line per figure, or NULL. *complete: no figure
 * failed; figures of an incomplete study often cannot be drawn. */
status figures_draw(const lab *l, const study *s, char **output, bool *complete, diagnostic *why);
