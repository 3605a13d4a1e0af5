/* The rows of compare.csv: the error of each cell's image against its reference. Images depend only on their scenes, so
 * there is one row per cell. results/README.md lists every column. Pure except for memory; a csv_line that ran out of
 * memory has failed set. */
#pragma once

#include "image/compare.h"
#include "render/frame/renderer.h"
#include "study/reference.h"
#include "study/rows.h"

row_columns compare_each_column;
/* The columns that a summary shows in addition to a cell's times. */
extern const char *const compare_shown[];
extern const size_t compare_shown_count;

/* One cell. Everything is borrowed. */
typedef struct compare_row {
    const study *of;
    size_t cell;
    const scene *setting; /* the cell's scene */
    const reference *against;
    uint64_t film_hash;
    double noise_rms; /* the account of the cell's frame */
    image_comparison difference;
    double error_rms;
    const char *run; /* as in study/rows.h */
    int process;
} compare_row;

/* Compares the frame's image with row->against: fills film_hash, noise_rms, error and error_rms. */
status compare_row_measure(compare_row *row, const render_result *frame, diagnostic *why);

void compare_row_write(csv_line *line, const compare_row *r);
