/* Keeps the unsaved scene on disk, and offers scenes of laboratories that died. A thread writes the document's own
 * scene while no file has it: at the first change, then at most once a second, and not while a study runs, which it
 * would disturb. The file is removed when the scene is saved. If the disk cannot be written, the state reports it
 * and all else continues. Thread-safe. Ownership: rescue_create creates, rescue_destroy releases. Errors:
 * STATUS_BAD_INPUT for unknown scenes and those that cannot be opened. */
#pragma once

#include "web/session/session.h"

typedef struct rescue rescue;

/* Claims the scenes without an owner in the settings' folder. Call it when the document and the studies exist. */
status rescue_create(lab *l, rescue **out, diagnostic *why);
/* Call it after http_stop. leave: an unsaved scene stays on disk; otherwise it is removed. Scenes that were offered
 * stay. NULL is allowed. */
void rescue_destroy(rescue *r, bool leave);

/* The document has changed, or a study has ended. NULL is allowed. */
void rescue_wake(rescue *r);

/* Opens an offered scene, which is a change of the document; its file stays until the thread has written the
 * document. discard removes the file. The state is published. */
status rescue_open(rescue *r, const char *id, uint64_t *generation, diagnostic *why);
status rescue_discard(rescue *r, const char *id, diagnostic *why);

/* Adds rescued (the offers) and unkept (why changes cannot be kept); false when out of memory. */
bool rescue_json(rescue *r, json_t *state);
