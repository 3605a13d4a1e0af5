/* The handlers of the laboratory's HTTP API. All routes are in one table in web/api/routes.c; web/README.md
 * describes them. A handler fills the call and returns a status; routes.c sends the JSON after STATUS_OK, otherwise
 * the diagnostic. */
#pragma once

#include "scene/lens/lens_prescription.h"
#include "study/study.h"
#include "web/session/session.h"

typedef struct call {
    lab *l;
    const http_request *request;
    http_reply *reply;
    json_t *body; /* NULL for a route without a body */
    diagnostic why;
    json_t *json; /* the reply, owned; NULL sends 500 */
    bool sent;    /* the handler has already sent a reply that is not JSON */
    int refused;  /* HTTP code of errors other than STATUS_FAILURE; 0: 400 or 409 by the status */
} call;

typedef status api_handler(call *c);

api_handler api_state, api_scene, api_find, api_set, api_reset, api_undo, api_redo, api_camera, api_view,
    api_scene_file, api_command, api_image_png, api_image_jpeg, api_display, api_trace_json, api_trace_text,
    api_trace_drawing, api_set_reference, api_clear_reference, api_reference_image, api_compare, api_compare_map,
    api_maps, api_map_of_rays, api_map_of_time, api_map_of_cut, api_add, api_remove, api_move, api_turn, api_scale,
    api_rename, api_material, api_copy, api_contents, api_files, api_open, api_save, api_media, api_slime, api_grab,
    api_move_hand, api_release, api_studies, api_study, api_study_run, api_study_stop, api_study_rows,
    api_study_rows_csv, api_study_summary_tsv, api_study_compare, api_study_draw, api_study_figure, api_figure,
    api_machine, api_notes, api_link, api_page, api_beams, api_beam_screen, api_lessons, api_lesson_open,
    api_lesson_measure, api_lesson_thumbnail, api_thumbnail, api_study_new, api_fan, api_fan_csv, api_fan_drawing,
    api_realism, api_realism_csv, api_realism_curve, api_realism_curve_csv, api_motion, api_motion_stop, api_rescue,
    api_lens, api_lens_csv, api_section, api_section_drawing;

/* Fills l->routes with all routes, bound to the lab. */
status api_bind(lab *l, size_t *count, diagnostic *why);

/* --- replies; each returns the status that the handler returns --- */

status api_reply_json(call *c, json_t *json);                         /* owns json */
status api_send(call *c, const char *type, void *bytes, size_t size); /* owns the bytes */
status api_refuse(call *c, int code, const char *what, const char *remedy);
/* Replies {"generation": N} after a change. */
status api_changed(call *c, status code, uint64_t generation);

/* The scenes that were sent recently, for GET /api/scene?since=GENERATION. Thread-safe. */
typedef struct sent_scenes sent_scenes;
sent_scenes *sent_scenes_create(void);    /* NULL when out of memory */
void sent_scenes_destroy(sent_scenes *s); /* NULL is allowed */

/* [{"path", "a", "b"}]: the parameters in which two scenes differ, with their values in both: numbers, lists or words;
 * null if a scene lacks the parameter or does not use it. First b's parameters in their order, then those only in a.
 * Values that a solid inherits from its material in both scenes are listed under the material only. NULL when out of
 * memory. */
json_t *changed_params(const scene *a, const scene *b);

/* The command line that renders the same film as the scene document. file: name of the document's file, NULL for none.
 * *complete is false if the file cannot be read or has other objects than the scene, which no --set can reproduce.
 * threads: the laboratory's default of render.threads, which does not count as a difference; 0 for none. *text is
 * allocated memory. */
status command_line(const folder *files, const char *file, const scene *s, int threads, char **text, bool *complete,
                    diagnostic *why);

/* The settings of that command line as a list of PATH=VALUE, and *path, the path of the scene's file; NULL if it cannot
 * be read. The caller releases both. */
status command_settings(const folder *files, const char *file, const scene *s, int threads, char **path,
                        json_t **settings, bool *complete, diagnostic *why);

/* The scene of a lens file (scene/lens/lens_prescription.h), which must be inside the folder root, or of its text if
 * that is not NULL; note: what of the file was not read, "" for nothing. */
status api_lens_file(const char *name, const char *text, const char *root, scene **out, char note[LENS_NOTE_MAX],
                     diagnostic *why);

/* --- reading a request --- */

/* Read one value of the body. Each returns false and sets the diagnostic if the value is not valid; a missing
 * key is an error only if needed, and leaves value unchanged. */
bool api_read_number(call *c, const char *key, bool needed, double *value);
bool api_read_vector(call *c, const char *key, bool needed, double value[3]);
bool api_read_text(call *c, const char *key, bool needed, const char **value);
bool api_read_flag(call *c, const char *key, bool *value);
/* A parameter's value in the syntax of scene_set, in allocated memory; place: its name in messages. STATUS_BAD_INPUT
 * for unsupported JSON. */
status api_value_text(const json_t *value, const char *place, char **text, diagnostic *why);
/* Reads the gesture; NULL for none. */
bool api_read_gesture(call *c, const char **gesture);

/* Whether the query contains the key with a value other than "0". */
bool api_query_flag(const call *c, const char *key);
/* Reads the `count` numbers of a query's key, separated by commas; remedy: of the diagnostic if they are not valid. */
bool api_query_numbers(call *c, const char *key, int count, double *out, const char *remedy);
/* Reads ?bits, the bit depth of a PNG; 8 by default. Returns false for values other than 8 and 16. */
bool api_read_bits(const call *c, int *bits);

/* The most rows of a study's summary or comparison in one reply. */
enum { STUDY_JSON_CELLS_MAX = 5000 };

/* Reads the study {name} of the path, and checks that its results are inside the folder; the caller destroys it. */
status api_read_study(call *c, study **s);

/* Waits for the final image of the current scene document. */
status api_wait_for_final(call *c, const shared_image **out);

/* A final image whose scene is rendered once more; the ask of a cancel token, whether nobody can use that any more: the
 * scene changed, a study began, or the laboratory ends. */
typedef struct final_question {
    lab *l;
    const shared_image *final;
} final_question;
bool api_is_obsolete(void *final_question);
/* The file name of the scene document, "" for none; allocated memory, NULL when out of memory. */
char *api_document_file(const call *c);
