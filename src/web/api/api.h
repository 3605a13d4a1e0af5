/* The laboratory's API: a request, what answers it, and what is read of it. All routes stand in one table, in
 * web/api/routes.c; web/README.md describes them. A handler fills the call and returns a status, and api.c answers:
 * with told where that is STATUS_OK, else with the diagnostic. */
#pragma once

#include "web/lab_private.h"

typedef struct call {
    lab *l;
    const http_request *request;
    http_reply *reply;
    json_t *body; /* NULL for a route without one */
    diagnostic why;
    json_t *told; /* taken; NULL is a 500 */
    bool sent;    /* there is a reply already, of other than JSON */
    int refused;  /* what errors other than STATUS_FAILURE are answered with, rather than 400 or 409; 0: those */
} call;

typedef status api_handler(call *c);

api_handler api_state, api_scene, api_set, api_reset, api_undo, api_redo, api_camera, api_scene_file, api_command,
    api_image_png, api_image_jpeg, api_trace_json, api_trace_text, api_trace_drawing, api_set_reference,
    api_clear_reference, api_reference_image, api_compare, api_compare_map, api_add, api_remove, api_move, api_turn,
    api_scale, api_rename, api_material, api_copy, api_files, api_open, api_save, api_media, api_slime, api_grab,
    api_move_hand, api_release, api_studies, api_study, api_study_run, api_study_stop, api_study_rows,
    api_study_compare, api_study_draw, api_figure, api_machine, api_notes;

/* All of a table's routes with the lab as their context, in l->routes. */
status api_bind(lab *l, size_t *count, diagnostic *why);

/* --- answers; each returns what the handler is to return --- */

status api_tell(call *c, json_t *told);                               /* takes it */
status api_send(call *c, const char *type, void *bytes, size_t size); /* takes them */
status api_refuse(call *c, int code, const char *what, const char *remedy);
/* {"generation": N} of a change. */
status api_changed(call *c, status code, uint64_t generation);

/* What a note on the scene says; NULL when memory is out. */
json_t *api_note(const char *place, const char *text, const char *remedy);

/* The scene as pages see it: its objects, and a row for each of its parameters; what GET /api/scene answers. opened:
 * where `initial` comes from. NULL when memory is out. */
json_t *scene_json(const scene *s, const scene *opened, uint64_t generation);

/* [{"path", "a", "b"}], where two scenes differ: values as number, list or word, null where that scene has no such
 * parameter or it is out of use there; b's in their order, then those that only a has. What a solid has from its
 * material in both is said of the material alone. NULL when memory is out. */
json_t *changed_params(const scene *a, const scene *b);

/* The scene on the desk as the command that renders the same film. file: its name in the folder, NULL for none.
 * *complete is false where the file is not there, or has other objects than the scene: no --set can make up for that.
 * threads: what the laboratory gives to scenes that do not say how many they want, and does not count as a difference;
 * 0 for none. text is fresh memory. */
status command_line(const folder *files, const char *file, const scene *s, int threads, char **text, bool *complete,
                    diagnostic *why);

/* --- what is read of a request --- */

/* Numbers and words of a body. Each is false, with the diagnostic set, where the key is of another kind; a missing one
 * is an error only where needed. value is left alone where it is missing. */
bool api_take_number(call *c, const char *key, bool needed, double *value);
bool api_take_vector(call *c, const char *key, bool needed, double value[3]);
bool api_take_text(call *c, const char *key, bool needed, const char **value);
bool api_take_flag(call *c, const char *key, bool *value);
/* The gesture; NULL for none. */
bool api_take_gesture(call *c, const char **gesture);

/* Is it in the query, and not "0"? */
bool api_asks_for(const call *c, const char *key);
/* Of a PNG, as ?bits says; 8 without it. False for other than 8 and 16. */
bool api_take_bits(const call *c, int *bits);

/* The final picture of what is on the desk, waited for. */
status api_wait_for_final(call *c, const shared_image **out);
/* The desk's scene, and its file's name, "" for none; fresh memory, NULL when that is out. */
char *api_document_file(const call *c);
