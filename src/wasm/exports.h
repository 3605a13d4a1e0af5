/* What a WebAssembly module offers the scripts of src/wasm, and what it calls of them (imports.js). A module is
 * either a laboratory or a tile worker; each runs in a worker of the browser, on one thread. Pointers are addresses
 * in the module's memory; texts end in 0. Ownership: arguments are borrowed for the call; a script frees what it
 * allocated for one (malloc, free). Errors: functions return a status of base/status.h as a number; wasm_why has
 * the text. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The last error, as "file:line:column: what; remedy". */
const char *wasm_why(void);
/* The name of the instruction set: simd128 or plain. */
const char *wasm_isa(void);

/* --- a laboratory (web/lab.h) --- */

/* Starts it on a folder of the module's files. scene: a path in the folder, or "" for an empty room. workers: the
 * number of tile workers, 0 for none. Once. */
int wasm_lab_start(const char *folder, const char *scene, int workers);

/* Handles a request; body: size bytes of JSON. The reply comes by host_reply, now or, if the request has to wait
 * for an image, in one of the next turns. target: path and query, as in a request line. */
void wasm_lab_request(int id, const char *method, const char *target, const char *body, size_t size);

/* Does what is due: a pass of the image, a step of the slime, a request that waits. Returns the milliseconds until
 * the next turn is due: 0 for at once, negative for none until something arrives. */
double wasm_lab_turn(void);

/* Takes what a tile worker sent (wasm_tiles_trace). */
void wasm_lab_traced(int worker, const void *bytes, size_t size);

/* --- a tile worker --- */

/* Takes a scene that the laboratory sent. */
int wasm_tiles_scene(const void *bytes, size_t size);
/* Traces the tiles of an order. Returns the address of the answer, and its size in *size; valid until the next
 * call. */
const void *wasm_tiles_trace(const void *bytes, size_t size, size_t *answer_size);

/* --- imports --- */

void host_reply(int id, int status, const char *headers, const void *bytes, size_t size); /* headers: a JSON object */
void host_event(const char *name, const char *value);                                     /* value: JSON */
/* Sends a scene (kind 0) or an order (kind 1) to a tile worker. */
void host_send(int worker, int kind, const void *bytes, size_t size);
