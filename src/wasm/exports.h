/* The functions that a WebAssembly module exports to the scripts of src/wasm, and those that it imports from them
 * (imports.js). A module serves as a laboratory or a tile worker, each in a worker of the browser, or as the JavaScript
 * API, in a page, a worker or node; it has one thread. Pointers are addresses in the module's memory; texts end in 0.
 * Ownership: arguments are borrowed for the call; a script frees what it allocated for a call (malloc, free). Errors:
 * functions return a status of base/status.h as a number; wasm_why has the text, wasm_error_json that of the JavaScript
 * API. */
#pragma once

#include <stddef.h>
#include <stdint.h>

struct cuvette_scene;
struct cuvette_query;
struct cuvette_motion;
struct cuvette_diagnostic;

/* The last error, as "file:line:column: what; remedy". */
const char *wasm_why(void);
/* The name of the instruction set: simd128 or plain. */
const char *wasm_isa(void);

/* --- a laboratory (web/lab.h) --- */

/* Starts the laboratory on a folder of the module's files; call it once. scene: a path in the folder, or "" for an
 * empty room. workers: the number of tile workers, which may be 0. */
int wasm_lab_start(const char *folder, const char *scene, int workers);

/* Handles a request; target: path and query, as in a request line; body: size bytes of JSON. The reply is passed to
 * host_reply now or, if the request must wait for an image, in one of the next turns. */
void wasm_lab_request(int id, const char *method, const char *target, const char *body, size_t size);

/* Does the work that is due: a pass of the image, a step of the slime, a waiting request. Returns the milliseconds
 * until the next turn; 0 means at once, a negative value not before a message arrives. */
double wasm_lab_turn(void);

/* Reports that a tile worker could not start, or failed: the laboratory continues without it. */
void wasm_lab_lost(int worker);
/* Merges the answer of a tile worker (wasm_tiles_trace). */
void wasm_lab_traced(int worker, const void *bytes, size_t size);

/* --- a tile worker --- */

/* Unpacks a scene that the laboratory sent. */
int wasm_tiles_scene(const void *bytes, size_t size);
/* Renders the tiles of an order. Returns the address of the answer, and its size in *answer_size; valid until the next
 * call. */
const void *wasm_tiles_trace(const void *bytes, size_t size, size_t *answer_size);

/* --- the JavaScript API (api/cuvette.js), next to the functions of cuvette.h ---
 *
 * A function that returns char * returns JSON (wasm_scene_text and wasm_scene_get: plain text), which the script frees;
 * NULL after an error. A ray is 7 numbers: origin, direction, reach. */

struct cuvette_diagnostic *wasm_error(void); /* the last error, for the parameter `why` of cuvette.h */
char *wasm_error_json(void);                 /* {status, text, what, remedy, file, line, column} */

char *wasm_scene_text(const struct cuvette_scene *scene);                    /* the scene file */
char *wasm_scene_get(const struct cuvette_scene *scene, const char *path);   /* the value */
char *wasm_scene_parameters(const struct cuvette_scene *scene);              /* [{path, value, unit, ..}] */
char *wasm_scene_hints(const struct cuvette_scene *scene);                   /* [text] */
char *wasm_scene_names(const struct cuvette_scene *scene);                   /* {lights: [name], ..} */
char *wasm_scene_realism(const struct cuvette_scene *scene);                 /* {metrics: [..], curves: [..]} */
char *wasm_scene_curve(const struct cuvette_scene *scene, const char *name); /* [[x, measured, theory]] */

/* The object of `cuvette lens report --json`, without the name of a file; system: "" for all lenses. */
char *wasm_scene_lens(const struct cuvette_scene *scene, const char *system);

/* A render in turns. coarse: the divisor of width and height, 1 for the full image. Until the last turn, or until
 * wasm_render_destroy, the scene refuses changes. A turn returns a status; it ends after budget_s or somewhat later. */
typedef struct wasm_render wasm_render;
wasm_render *wasm_render_create(struct cuvette_scene *of, int coarse);
void wasm_render_destroy(wasm_render *r);
int wasm_render_turn(wasm_render *r, double budget_s);
double wasm_render_fraction(const wasm_render *r); /* the fraction that is rendered; 1: complete */
char *wasm_render_tiles(wasm_render *r);           /* [[x0, y0, x1, y1]]: the tiles since the last call */
char *wasm_render_result(const wasm_render *r);    /* {width, height, hash, counters, wall_s} */
/* wasm_render_srgb writes RGBA with alpha 255, 4 bytes per pixel of the rectangle; wasm_render_rgb writes linear RGB,
 * 3 floats per pixel of the image. */
void wasm_render_srgb(const wasm_render *r, int x0, int y0, int x1, int y1, unsigned char *rgba);
void wasm_render_rgb(const wasm_render *r, float *rgb);

char *wasm_query_camera_ray(const struct cuvette_query *query, double x, double y); /* {origin, direction} */
char *wasm_query_nearest(const struct cuvette_query *query, const double *rays, size_t count);
char *wasm_query_medium(const struct cuvette_query *query, const double *point); /* {solid: a name or null} */
char *wasm_query_trace(const struct cuvette_query *query, const double *ray);
char *wasm_query_trace_pixel(const struct cuvette_query *query, int x, int y);
/* rule: from, to, normal, rays, width, spread_deg as 12 numbers (cuvette_fan_rule). */
char *wasm_query_fan(const struct cuvette_query *query, const double *rule);

char *wasm_motion_names(const struct cuvette_motion *motion);
char *wasm_motion_state(const struct cuvette_motion *motion, const char *name);
/* pick: {distance, where}; grab: {hand, where}; null if the ray misses. */
char *wasm_motion_pick(const struct cuvette_motion *motion, const char *name, const double *ray);
char *wasm_motion_grab(struct cuvette_motion *motion, const char *name, const double *ray, double reach);

/* The four words of random_at (base/random.h). */
void wasm_random(uint32_t key_low, uint32_t key_high, uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint32_t *words);

/* --- imports --- */

void host_reply(int id, int status, const char *headers, const void *bytes, size_t size); /* headers: a JSON object */
void host_event(const char *name, const char *value);                                     /* value: JSON */
/* Sends a scene (kind 0) or an order (kind 1) to a tile worker. */
void host_send(int worker, int kind, const void *bytes, size_t size);
