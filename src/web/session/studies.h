/* The one study that runs in the laboratory, in a thread of its own; while it measures, the painter waits. How far it
 * is goes to all pages as event `study` and stands in the state. Ownership: studies_create gives, studies_destroy
 * releases. Errors: STATUS_INTERRUPTED for what does not go together with what is there now (409). */
#pragma once

#include "study/study.h"
#include "web/lab_private.h"
#include <stdatomic.h>

status studies_create(lab *l, studies **out, diagnostic *why);
/* Stops what runs, waits for it, and lets nothing begin any more. While server, painter and desk are still there;
 * handlers may come in until http_stop. */
void studies_end(studies *st);
/* After http_stop. NULL is allowed; ends it too. */
void studies_destroy(studies *st);

/* Takes s, also after an error. */
status studies_start(studies *st, study *s, diagnostic *why);
/* The rows so far are kept. Returns at once. */
status studies_stop(studies *st, const char *name, diagnostic *why);
bool studies_runs(studies *st, const char *name); /* NULL: does any? */

/* The state's part, null before the first study; NULL when memory is out. */
json_t *studies_tell(studies *st);

/* Set when the laboratory ends: for what takes long. And one at a time may draw figures: false where another does. */
const atomic_bool *studies_ending(const studies *st);
bool studies_begin_drawing(studies *st);
void studies_end_drawing(studies *st);
