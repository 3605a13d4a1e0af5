/* The scene document: the scene that all pages edit, with its undo history. Each change makes a new generation; undo
 * and redo do too. Thread-safe. A change edits a copy, which is validated, also against the limits below,
 * before it replaces the scene, so that no reader sees a partial change. Ownership: scene_document_create creates,
 * scene_document_destroy releases; scenes passed in or returned belong to the receiver, except the document's own
 * copy during a change. Errors: STATUS_BAD_INPUT, or STATUS_FAILURE if memory runs out; the scene is then unchanged. */
#pragma once

#include "scene/model/camera.h"
#include "web/document/folder.h"

#include <stdint.h>

typedef struct scene_document scene_document;

/* Limits of the scene document, so that every render is bounded in memory and time. DOCUMENT_PIXELS_MAX is 4096 * 4096,
 * DOCUMENT_UNDO_MAX the number of undo steps. */
enum { DOCUMENT_PIXELS_MAX = 16777216, DOCUMENT_TRIANGLES_MAX = 4000000, DOCUMENT_UNDO_MAX = 200 };
#define DOCUMENT_WORK_MAX 1e12 /* pixels * (samples or paths) * wavelengths */

/* scene_document_check: whether a scene is valid, refers to no file outside the folder, and has at most the pixels,
 * camera rays and generated triangles above. scene_document_limit sets limits that loading observes, because only
 * loading shows what the files contain: files that the scene's files refer to must be in the folder, too, and all
 * triangles count, also those of mesh files. files: NULL for no confinement. */
status scene_document_check(const scene *s, const folder *files, diagnostic *why);
status scene_document_limit(scene *s, const folder *files, diagnostic *why);

/* Takes ownership of the scene, also after an error. changed is called without the lock after each change. file: name
 * of the scene's file, NULL for a new scene. files is borrowed; loading a copy opens no file outside this folder. */
status scene_document_create(scene *first, const char *file, const folder *files, void (*changed)(void *context),
                             void *context, scene_document **out, diagnostic *why);
void scene_document_destroy(scene_document *d); /* NULL is allowed */

/* Edits a copy of the scene. */
typedef status scene_document_change(void *context, scene *s, diagnostic *why);

/* what: a few words for undo ("set liquid.ior"), copied. gesture: NULL, or a string; consecutive changes with the
 * same gesture are one undo step. generation may be NULL. */
status scene_document_apply(scene_document *d, const char *what, const char *gesture, scene_document_change *change,
                            void *context, uint64_t *generation, diagnostic *why);

/* Like scene_document_apply, for a change of the camera's parameters: the view becomes the scene's own camera even if
 * the parameters equal those of the view. */
status scene_document_apply_to_camera(scene_document *d, const char *what, const char *gesture,
                                      scene_document_change *change, void *context, uint64_t *generation,
                                      diagnostic *why);

/* Replaces the scene by one from a file, or a new one (file NULL): a change like others; resets return to this scene
 * from now on. Takes ownership of s, also after an error. */
status scene_document_open(scene_document *d, scene *s, const char *file, uint64_t *generation, diagnostic *why);
/* Like scene_document_open, for a scene with unsaved changes; file: where they can be saved, NULL for none. */
status scene_document_rescue(scene_document *d, scene *s, const char *file, uint64_t *generation, diagnostic *why);

/* Moves the camera, which changes the view, not the scene: there is a new generation, but no undo step, and the scene
 * stays saved; views have a separate history. The document keeps the move's pivot. gesture: NULL, or a string;
 * consecutive moves with the same gesture are one view of the history. */
status scene_document_move_view(scene_document *d, camera_move *move, const char *gesture, uint64_t *generation,
                                diagnostic *why);

/* back, forward: through the history of views. home: the scene's own camera. keep: makes the view the scene's own
 * camera, which is a change of the scene. STATUS_BAD_INPUT when there is nothing to do. */
typedef enum view_command { VIEW_BACK, VIEW_FORWARD, VIEW_HOME, VIEW_KEEP } view_command;
status scene_document_view(scene_document *d, view_command order, uint64_t *generation, diagnostic *why);

/* STATUS_BAD_INPUT when there is nothing to undo (or redo). The view stays, unless the two versions differ in the
 * scene's own camera, or are of two opened scenes. */
status scene_document_undo(scene_document *d, bool redo, uint64_t *generation, diagnostic *why);

/* Resets these paths to the values that they had when the scene was opened; if count is 0, resets the complete scene,
 * including its list of objects. */
status scene_document_reset(scene_document *d, const char *const *paths, size_t count, uint64_t *generation,
                            diagnostic *why);

/* A copy of the scene with its loaded data (triangles, textures); NULL when out of memory. generation may be NULL. */
scene *scene_document_copy(scene_document *d, uint64_t *generation);
/* Like scene_document_copy, with the scene's own camera instead of the view, as for a file. number: the number of the
 * version, which moves of the camera do not change. */
scene *scene_document_copy_to_save(scene_document *d, uint64_t *generation, uint64_t *number);
/* Copies of the scene and of the scene as it was opened, with the generation and the number of the version, which moves
 * of the camera do not change; false when out of memory. */
bool scene_document_copies(scene_document *d, scene **now, scene **opened, uint64_t *generation, uint64_t *number);
uint64_t scene_document_generation(scene_document *d);

/* Lets later copies share the data that was loaded for a copy of this generation; does nothing if the document has a
 * newer one. loaded is borrowed. */
void scene_document_reuse_loaded(scene_document *d, const scene *loaded, uint64_t generation);

/* Records that the version of that number, which scene_document_copy_to_save returned, was written to the file. */
void scene_document_saved(scene_document *d, const char *file, uint64_t number);

/* Whether the scene has changes that would be lost with the program. number: as for scene_document_copy_to_save.
 * *file: a copy of the name of the scene's file, NULL for none (or out of memory); file may be NULL. */
bool scene_document_unsaved(scene_document *d, uint64_t *number, char **file);

/* Adds generation, file, title, saved, unsaved, undo, redo and view; false when out of memory. */
bool scene_document_json(scene_document *d, json_t *state);
