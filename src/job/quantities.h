/* The list of measured quantities: name, unit, type and meaning of each, how the values of several frames are combined,
 * where the quantity is shown, and how it is read from an account. The outputs are generated from the list: the columns
 * of rows.csv and workers.csv (study/rows/rows.c), `cuvette render --json` and the page's numbers (report/report.c),
 * the dictionary in results/README.md (make dictionary renews it) and cuvette-account(5). A new quantity is one new
 * line in quantities.c. Only summaries of studies and the page name the quantities that they show
 * (study/summary/summary.c, web/page/status.js, view/panel_compare.js, studies/data.js). Ownership: constant; values
 * borrow from the account. Cannot fail. */
#pragma once

#include "job/account.h"

typedef enum quantity_type {
    QUANTITY_COUNT,  /* value.count; below 0: unknown */
    QUANTITY_NUMBER, /* value.count; unknown values are -1 in JSON */
    QUANTITY_TRUTH,  /* value.count, 0 or 1 */
    QUANTITY_REAL,   /* value.real[0]; NaN: unknown */
    QUANTITY_COLOR,  /* value.real */
    QUANTITY_HASH,   /* value.hash */
    QUANTITY_WORD,   /* value.word */
    QUANTITY_DEPTHS, /* value.list: a count for each depth from 0 to render.depth, at most COUNTERS_DEPTH_MAX */
    QUANTITY_SOLIDS  /* value.list: a count for each of the scene's first COUNTERS_SOLID_MAX solids, each in a column
                        NAME.<solid> */
} quantity_type;

/* How the values of several frames of one scene are combined. */
typedef enum quantity_merge {
    QUANTITY_SAME,   /* equal in all frames */
    QUANTITY_MEDIAN, /* the median over all frames */
    QUANTITY_OVER,   /* measured from the start of the first frame to the end of the last */
    QUANTITY_LAST    /* the value of the last frame */
} quantity_merge;

typedef struct quantity_value {
    int64_t count;
    double real[3];
    uint64_t hash;
    const uint64_t *list;
    size_t size;
    char word[32];
} quantity_value;

typedef struct quantity {
    const char *name, *unit, *meaning;
    quantity_type type;
    quantity_merge merge;
    bool column;      /* in rows.csv or workers.csv, under its name */
    const char *json; /* key in the JSON account, "rays.camera" for one in an object; NULL: none */
    const char *page; /* key in the page's numbers of an image; NULL: none */
    quantity_value (*read)(const job_account *a, int worker);
} quantity;

/* Quantities of a frame; their read function ignores worker. In the order of the columns, the film's hash first. */
extern const quantity frame_quantities[];
extern const size_t frame_quantity_count;
/* Quantities of one worker; read receives the worker's number. In JSON they are members of the objects in `threads`. */
extern const quantity worker_quantities[];
extern const size_t worker_quantity_count;

/* The frame quantity with that name, or NULL. */
const quantity *frame_quantity(const char *name);
