/* The JSON account of a render, built from the list of job/quantities.h: the output of `cuvette render --json`, and the
 * numbers of an image on the laboratory's page. cuvette-account(5) documents the keys. Ownership: new references, NULL
 * when out of memory. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "image/compare.h"
#include "job/quantities.h"
#include "lesson/lesson.h"
#include "measure/clock.h"
#include "measure/topology.h"
#include "scene/model/params.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/utsname.h>

enum { REPORT_SCHEMA = 1 }; /* increases when a key changes its meaning or is removed */

/* The JSON report of measured frames; `a` has at least one result. repeated: --repeat was given, and the report
 * includes the times of all repetitions. */
json_t *report_create(const job_account *a, bool repeated);

/* A note as an object of place, text and remedy. */
json_t *report_note(const char *place, const char *text, const char *remedy);

/* One quantity of the account. worker: as for quantity.read. */
json_t *report_quantity(const quantity *q, const job_account *a, int worker);

/* The numbers of an image that the laboratory's page shows, and the notes on it. They reach it as part of `image` in
 * the state and in events: web/live/render_worker_snapshot.c and shared_image.c, web/lab.c,
 * web/page/shared/store.js. */
json_t *report_image_numbers(const job_account *a);

/* Each parameter of the scene under its path, as a number, list or word. */
json_t *report_params(const scene *s);

/* Adds the difference of two images; false when out of memory. */
bool report_comparison(json_t *o, const image_comparison *c);

/* The JSON value of a parameter, parsed from its text. */
json_t *report_value(const param *row, const char *text);

/* Lessons and their results, for `cuvette lesson show` and the laboratory (lesson_rows.c). */
json_t *lesson_json(const lesson *l);
json_t *lesson_result_json(const lesson *l, const lesson_result *r);

/* --- tables for a terminal (wrap.c) ---
 *
 * Rows of a table wrapped to the width of a terminal. Widths count the characters of UTF-8. Ownership: everything is
 * borrowed. Errors of the stream stay in the stream, where the caller checks them. */

/* Writes start, the aligned cells of a row with the blanks after them, then the text of its last column, which may have
 * any length, and a newline. columns is the width of the terminal: the text is wrapped under itself, or, if fewer than
 * 24 columns are left for it, below the cells with an indent of 4. columns 0, for a pipe or a file: one line, nothing
 * is wrapped. */
void wrap_row(FILE *stream, int columns, const char *start, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* A report on this machine for measurements: processors, clocks, vector instruction sets, and current disturbances.
 * Ownership: machine_measure allocates, machine_release frees, also after an error. */

typedef struct machine_report {
    topology *machine;
    isa best, chosen;
    clock_quality wall, cpu;
    struct utsname kernel;
    bool has_hardware_counters;
    json_t *disturbances; /* list of texts */
} machine_report;

/* Takes half a second to measure the load of other processes. STATUS_BAD_INPUT for an invalid instruction set in the
 * environment (CUVETTE_ISA). */
status machine_measure(machine_report *a, diagnostic *why);
void machine_release(machine_report *a);

/* The output of `cuvette machine --json`; NULL when out of memory. */
json_t *machine_json(const machine_report *a);
