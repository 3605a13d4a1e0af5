/* The study that runs in the laboratory, in a thread of its own; the render worker is suspended while it measures.
 * Its progress goes to all pages as event `study` and is part of the state. Ownership: studies_create creates,
 * studies_destroy releases. Errors: STATUS_INTERRUPTED for a conflict with the current state (409). */
#pragma once

#include "study/study.h"
#include "web/lab_private.h"

status studies_create(lab *l, studies **out, diagnostic *why);
/* Stops the running study, waits for it, and lets no other start. Call it while the server, render worker and scene
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

/* Whether the laboratory ends; st: studies. As the ask of a token, for long work. At most one thread draws figures:
 * studies_begin_drawing returns false while another does. */
bool studies_ending(void *st);
bool studies_begin_drawing(studies *st);
void studies_end_drawing(studies *st);
