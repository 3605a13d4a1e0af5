/* The pictures that cells are compared with: the scene of a cell with the study's reference parameters set on top. One
 * that serves several cells is rendered once and kept, as linear floats, in results/<study>/references/, named by the
 * fingerprint of its scene, with a JSON file that says which film it was. Ownership: reference_load and whoever renders
 * one give the picture, reference_release takes it. */
#pragma once

#include "image/image.h"
#include "study/study.h"

typedef struct reference {
    uint64_t scene_hash; /* of all that makes its picture; its file's name, 16 hex digits */
    uint64_t film_hash;
    double noise_rms; /* of random paths, as in rows.csv; NaN without */
    image *img;       /* NULL: none is held */
} reference;

/* Checks every cell's reference: a scene that can be rendered, as large as the cell's. Errors are located in the study
 * file. */
status reference_check(const study *s, diagnostic *why);

/* The fingerprint of a definition of the study and of its reference. */
uint64_t reference_definition(const study *s, uint64_t definition);

/* The scene of the cell's reference; pictures are not loaded. */
status reference_scene(const study *s, size_t cell, scene **out, diagnostic *why);
/* Its fingerprint: scenes that differ only in how they are computed have one. Pictures must have been loaded. */
status reference_scene_hash(const scene *setting, uint64_t *hash);

/* The reference with that scene_hash from the study's folder, below root (base/below.h); out->img is NULL when it
 * is not there. A file that is not what was written is STATUS_BAD_INPUT. */
status reference_load(const char *folder, const char *root, uint64_t scene_hash, reference *out, diagnostic *why);
/* Keeps it there, with the parameters of its scene; as a PNG for the eye too when the study keeps images. */
status reference_save(const study *s, const char *folder, const reference *of, const scene *setting, diagnostic *why);
void reference_release(reference *of);
