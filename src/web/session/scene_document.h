/* The scene that all pages work at, and how it came to be: each change makes a new generation of it; undo and redo go
 * through them. For any number of threads. A change is done to a copy, which is checked as a whole and against the
 * bounds below before it takes the place of the scene, so that nobody ever sees a half of one. Ownership:
 * scene_document_create gives, scene_document_destroy releases; scenes that go in or come out belong to the receiver,
 * but for the desk's own copy in a change. Errors: STATUS_BAD_INPUT with the reason; the scene is then as it was. */
#pragma once

#include "web/session/folder.h"
#include <stdint.h>

typedef struct scene_document scene_document;

/* Of what is on the desk: a render must be bounded, in memory and so that it ends. */
enum { DOCUMENT_PIXELS_MAX = 16777216, DOCUMENT_TRIANGLES_MAX = 4000000, DOCUMENT_UNDO_MAX = 200 };
#define DOCUMENT_WORK_MAX 1e12 /* pixels * (samples or paths) * wavelengths */

/* What may lie on the desk: scenes that are right, name nothing outside of the folder, and ask for a bounded amount of
 * memory and work. The check looks at what a scene names; the limits hold while it is loaded, for what its files name
 * in turn and for triangles, which only files themselves know. files: NULL for anywhere. */
status scene_document_check(const scene *s, const folder *files, diagnostic *why);
status scene_document_limit(scene *s, const folder *files, diagnostic *why);

/* Takes the scene, also after an error. changed is called, with the desk unlocked, after each change. file: its name as
 * pages see it, NULL for a new one. files is borrowed: what a scene names must lie in it, and nothing else is opened
 * when a copy of it is loaded. */
status scene_document_create(scene *first, const char *file, const folder *files, void (*changed)(void *context),
                             void *context, scene_document **out, diagnostic *why);
void scene_document_destroy(scene_document *d); /* NULL is allowed */

/* Does something to a copy of the scene. */
typedef status scene_document_change(void *context, scene *s, diagnostic *why);

/* what: a few words for undo ("set liquid.ior"), copied. gesture: NULL, or a text; changes of one gesture in a row are
 * one step of undo. generation may be NULL. */
status scene_document_apply(scene_document *d, const char *what, const char *gesture, scene_document_change *change,
                            void *context, uint64_t *generation, diagnostic *why);

/* Another scene takes its place, from a file or new (file NULL): a change like others, to which resets go back from now
 * on. Takes s, also after an error. */
status scene_document_open(scene_document *d, scene *s, const char *file, uint64_t *generation, diagnostic *why);

/* STATUS_BAD_INPUT when there is nothing to undo (or redo). */
status scene_document_undo(scene_document *d, bool redo, uint64_t *generation, diagnostic *why);

/* To the values at which the scene was opened: of these paths, or of all and of the objects themselves (count 0). */
status scene_document_reset(scene_document *d, const char *const *paths, size_t count, uint64_t *generation,
                            diagnostic *why);

/* A copy with what is loaded of it (triangles, textures); NULL when memory is out. generation may be NULL. */
scene *scene_document_take(scene_document *d, uint64_t *generation);
/* The same of the scene as it was opened. */
scene *scene_document_take_opened(scene_document *d);
uint64_t scene_document_generation(scene_document *d);

/* What was loaded for a copy of that generation is kept for the copies to come. loaded is borrowed. */
void scene_document_lend(scene_document *d, const scene *loaded, uint64_t generation);

/* It was written to that file. */
void scene_document_saved(scene_document *d, const char *file, uint64_t generation);

/* Adds generation, file, title, saved, undo, redo; false when memory is out. */
bool scene_document_json(scene_document *d, json_t *state);
