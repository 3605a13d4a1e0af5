/* The parameters of materials: surfaces and media. Plain values. */
#pragma once

#include "base/vec3.h"
#include "optics/optical_data.h"
#include <stdbool.h>
#include <stdint.h>

/* A list of numbers, stored by value. */
enum { NUMBER_LIST_MAX = 32 };
typedef struct number_list {
    int64_t count;
    double value[NUMBER_LIST_MAX];
} number_list;

/* Maximum length of names in scene files, in bytes. */
enum { SCENE_NAME_MAX = 63 };

/* Maximum length of the text of a coating (optics/coating.h), in bytes. */
enum { COATING_MAX = 255 };

enum { SCENE_MATERIALS_MAX = 256 };

/* What the alpha of a texture means (glTF 2.0, 3.9.4), on an opaque solid:
 *   opaque  nothing: the colour is as the file stores it;
 *   mask    where alpha is below alpha_cutoff, the surface is not there, for rays of every kind: it has holes;
 *   blend   the surface is there with the fraction alpha: it shades with that weight, and a ray goes straight on with
 *           the rest (Porter and Duff's `over`). In ray trees it is divided, and the part that goes on is one deeper;
 *           random paths and photons meet the surface with that probability; a shadow ray keeps the rest.
 * Integrators whose rays do not branch (lighting other than whitted, maps) cut a blended surface at alpha 1/2. Such a
 * solid is an open surface: the surrounding medium is behind it, too; light that passes is not deflected. */
typedef enum material_alpha { ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND } material_alpha;

/* The fields of Phong's equation I = k_e C + k_a I_a C + k_d I_L C max(0, N.L) + k_s I_L max(0, R.V)^n, and of the
 * weights rule. */
typedef struct material {
    vec3 color; /* C, linear RGB; for transparent solids also the transmittance of the medium over tint_distance */
    double ambient, diffuse, specular, shininess; /* k_a, k_d, k_s, n */
    double emission;                              /* k_e: the surface emits k_e C in all directions */
    double reflectivity;      /* for constant weights, simple transmission and opaque materials; under Fresnel weights a
                            transparent surface is a half mirror */
    double transparency;      /* 0: opaque; else the fraction of the refracted light that crosses an interface (constant
                            weights: of the incident) */
    double ior;               /* relative to vacuum, if medium is MEDIUM_IOR */
    double extraordinary_ior; /* of a uniaxial crystal, for the field along its optic axis; 0: isotropic */
    vec3 optic_axis;          /* in the solid's own frame, of any length */
    double extinction;        /* of an opaque material with medium MEDIUM_IOR: k of its complex index ior - i k */
    double film_thickness_nm, film_ior;    /* of a film on the surface; thickness 0: none */
    char coating[COATING_MAX + 1];         /* layers below the film, or a design (optics/coating.h); "" for none */
    char coating_data[SCENE_NAME_MAX + 1]; /* data of its layers `data`; "" for none */
    const optical_data *coating_values;    /* as index_data */
    bool coating_in_air;
    double roughness;                     /* alpha of optics/microfacet.h, for random paths; 0: smooth */
    int64_t sheet;                        /* see scene/model/medium.h; of a transparent solid */
    vec3 sheet_axis;                      /* in the solid's own frame, of any length */
    double sheet_pass, sheet_block;       /* a polariser's transmittances */
    double retardance_deg, birefringence; /* of a retarder: fixed, and along the path */
    int64_t medium;                       /* see scene/model/medium.h */
    number_list coefficients;             /* coefficients of the medium's dispersion law */
    char medium_data[SCENE_NAME_MAX + 1]; /* data of the index, if medium is MEDIUM_DATA; "" for none */
    const optical_data *index_data;       /* that of medium_data, borrowed from the scene's entry; NULL until loaded */
    bool index_in_air;                    /* that index is relative to air */
    char color_data[SCENE_NAME_MAX + 1], absorb_data[SCENE_NAME_MAX + 1],
        scatter_data[SCENE_NAME_MAX + 1]; /* replace color, absorption and scatter_per_m; "" for none */
    const optical_data *color_values, *absorb_values, *scatter_values; /* as index_data */
    vec3 absorb_per_m; /* absorption coefficient of the Beer-Lambert law, by channel */
    number_list
        absorb_spectrum;  /* absorption by wavelength: nm, 1/m, nm, 1/m ...; replaces absorb_per_m unless empty */
    double scatter_per_m; /* scattering coefficient of the medium, for random paths */
    double asymmetry;     /* g, the mean cosine of the scattering angle, optics/phase_function.h */
    double tint_distance; /* scene units; tint and absorption are added */
    char texture[SCENE_NAME_MAX + 1]; /* its values are multiplied by color; "" for none */
    double texture_size;              /* scene units per repetition on solids without texture coordinates; 0: one per
                                         face */
    int64_t alpha;                    /* material_alpha */
    double alpha_cutoff;
    double checker;     /* edge of the checker cells in the solid's own frame; 0 = none */
    vec3 checker_color; /* colour of the other cells */
} material;

typedef struct named_material {
    char *name;
    material value;
} named_material;
