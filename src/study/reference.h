/* The reference images of cells: the scene of a cell with the study's reference parameters applied. A reference that
 * serves several cells is rendered once and stored as linear floats in results/<study>/references/, named by the hash
 * of its scene, with a JSON file that records its film. Ownership: reference_load or the renderer of a reference gives
 * the image, reference_release releases it. */
#pragma once

#include "image/image.h"
#include "study/study.h"

typedef struct reference {
    uint64_t scene_hash; /* of everything that determines its image; also its file name, 16 hex digits */
    uint64_t film_hash;
    double noise_rms; /* of path tracing, as in rows.csv; otherwise NaN */
    image *img;       /* NULL: not loaded */
} reference;

/* Checks every cell's reference: a valid scene with the size of the cell's image. Errors are located in the study file.
 * */
status reference_check(const study *s, diagnostic *why);

/* The scene of the cell's reference; image files are not loaded. */
status reference_scene(const study *s, size_t cell, scene **out, diagnostic *why);
/* Its hash, equal for scenes that differ only in performance parameters. Image files must be loaded. */
status reference_scene_hash(const scene *setting, uint64_t *hash);

/* The reference with that scene_hash from the study's folder, below root (base/file.h); out->img is NULL if it does
 * not exist. STATUS_BAD_INPUT if a file was changed. */
status reference_load(const char *folder, const char *root, uint64_t scene_hash, reference *out, diagnostic *why);
/* Stores it there, with the parameters of its scene; also as PNG if the study keeps images. */
status reference_save(const study *s, const char *folder, const reference *of, const scene *setting, diagnostic *why);
void reference_release(reference *of);
