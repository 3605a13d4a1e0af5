/* Comparison of each cell's image with its reference: the scene of the cell with the study's reference parameters
 * applied. A reference that serves several cells is rendered once and stored as linear floats in
 * results/<study>/references/, named by the hash of its scene, with a JSON file that records its film. Images depend
 * only on their scenes, so compare.csv has one row per cell; results/README.md lists every column. Ownership:
 * reference_release releases the image of a reference; a csv_buffer that ran out of memory has failed set. */
#pragma once

#include "image/compare.h"
#include "image/image.h"
#include "render/frame/renderer.h"
#include "study/rows/rows.h"
#include "study/study.h"

typedef struct reference {
    uint64_t scene_hash; /* hash of everything that determines its image; also its file name, 16 hex digits */
    uint64_t film_hash;
    double noise_rms; /* as in rows.csv; NaN without random paths */
    image *img;       /* NULL: not loaded */
} reference;

/* Loads the reference with that scene_hash from the study's folder, below root (base/file.h); out->img is NULL if it
 * does not exist. STATUS_BAD_INPUT if a file was changed. */
status reference_load(const char *folder, const char *root, uint64_t scene_hash, reference *out, diagnostic *why);
/* Stores a reference in the study's folder, with the parameters of its scene; also as PNG if the study keeps images. */
status reference_save(const study *s, const char *folder, const reference *stored, const scene *setting,
                      diagnostic *why);
void reference_release(reference *stored);

row_columns compare_each_column;
/* The columns that a summary shows in addition to a cell's times. */
extern const char *const compare_summary_columns[];
extern const size_t compare_summary_column_count;

/* One cell. Everything is borrowed. */
typedef struct compare_row {
    const study *s;
    size_t cell;
    const scene *setting; /* the cell's scene */
    const reference *cell_reference;
    uint64_t film_hash;
    double noise_rms; /* of the cell's frame */
    image_comparison difference;
    double error_rms;
    const char *run; /* as in study/rows/rows.h */
    int process;
} compare_row;

/* Compares the frame's image with row->cell_reference: fills film_hash, noise_rms, difference and error_rms. */
status compare_row_measure(compare_row *row, const render_result *frame, diagnostic *why);

void compare_row_write(csv_buffer *line, const compare_row *r);
