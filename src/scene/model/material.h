/* What surfaces and media are like: the parameters of materials. Values. */
#pragma once

#include "base/vec3.h"
#include <stdint.h>

/* Numbers, as many as one gives. */
enum { NUMBER_LIST_MAX = 32 };
typedef struct number_list {
    int64_t count;
    double value[NUMBER_LIST_MAX];
} number_list;

/* Of names in scene files, in bytes. */
enum { SCENE_NAME_MAX = 63 };

enum { SCENE_MATERIALS_MAX = 256 };

/* Fields mean what Phong's sum I = k_e C + k_a I_a C + k_d I_L C max(0, N.L) + k_s I_L max(0, R.V)^n and the weights
 * rule say. */
typedef struct material {
    vec3 color; /* C, linear RGB; of a clear solid also the share of light left after tint_distance inside */
    double ambient, diffuse, specular, shininess; /* k_a, k_d, k_s, n */
    double emission;                              /* k_e: the surface sends out k_e C by itself, to all sides */
    double reflectivity; /* constant weights, simple transmission, and opaque materials; a clear one's coating under
                            fresnel weights */
    double transparency; /* 0 = opaque; else share of the refracted light that passes an interface */
    double ior;          /* relative to vacuum, where medium is MEDIUM_IOR */
    int64_t medium;      /* see scene/model/medium.h */
    number_list coefficients;    /* of the medium's own law of dispersion */
    vec3 absorb_per_m;           /* Beer and Lambert's coefficient by channel */
    number_list absorb_spectrum; /* the same by wavelength: nm, 1/m, nm, 1/m ...; takes the place of absorb_per_m unless
                                    empty */
    double tint_distance;        /* scene units; tint and absorption add up */
    char texture[SCENE_NAME_MAX + 1]; /* its colour is times color; "" for none */
    double texture_size;              /* scene units of one repetition on solids that are no meshes; 0: one a face */
    double checker;                   /* edge of the checker cells in the solid's own frame; 0 = none */
    vec3 checker_color;               /* colour of the other cells */
} material;

typedef struct named_material {
    char *name;
    material value;
} named_material;
