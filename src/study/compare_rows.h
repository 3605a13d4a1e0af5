/* The rows of compare.csv: how far each cell's picture lies from its reference. Pictures depend on their scenes alone,
 * so there is one row a cell. results/README.md lists every column. Pure but for memory; a csv_line that ran out of it
 * has failed set. */
#pragma once

#include "image/compare.h"
#include "render/core/renderer.h"
#include "study/reference.h"
#include "study/rows.h"

row_columns compare_each_column;
/* Those that a summary shows beside a cell's times, by name. */
extern const char *const compare_shown[];
extern const size_t compare_shown_count;

/* One cell. Everything is borrowed. */
typedef struct compare_row {
    const study *of;
    size_t cell;
    const scene *setting; /* the cell's scene */
    const reference *against;
    uint64_t film_hash;
    double noise_rms; /* of the cell's frame */
    image_comparison lies;
    double error_rms;
} compare_row;

/* Measures how far the frame's picture lies from row->against: fills film_hash, noise_rms, lies and error_rms. */
status compare_row_measure(compare_row *row, const render_result *frame, diagnostic *why);

void compare_row_write(csv_line *line, const compare_row *r);
