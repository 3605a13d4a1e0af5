/* The JSON account of a render, made from the list of job/quantities.h: what `cuvette render --json` prints, and what
 * the page shows of an image. The manual page names the keys. Ownership: new references, NULL when memory is out. */
#pragma once

#include "image/compare.h"
#include "job/quantities.h"
#include "scene/model/params.h"
#include <jansson.h>
#include <stdbool.h>

enum { REPORT_SCHEMA = 1 }; /* goes up when a key changes its meaning or goes away */

/* The account of measured frames, with at least one result; NULL when memory is out. repeated: asked for by
 * --repeat. */
json_t *report_create(const job_account *a, bool repeated);

/* One quantity of it. worker: as for its read. */
json_t *report_quantity(const quantity *q, const job_account *a, int worker);

/* The numbers of an image that the laboratory's page shows. They reach it as part of `picture` in the state and in
 * events: web/live/render_worker_pass.c, shared_image.c, web/lab.c, page/store.js. */
json_t *report_page(const job_account *a);

/* Each parameter of the scene under its path, as number, list or word; NULL when memory is out. */
json_t *report_params(const scene *s);

/* Adds how far two pictures lie apart; false when memory is out. */
bool report_comparison(json_t *o, const image_comparison *c);

/* The value of one parameter from its text. */
json_t *report_value(const param *row, const char *text);
