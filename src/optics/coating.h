/* Coatings as they are made: stacks of layers on a surface, each with a thickness and an index that may depend on the
 * wavelength and absorb; as text, by name, and as films for optics/multilayer.h.
 *
 * The text is the name of a design (coating_design_at), or a list of layers from the outside of the solid to its inside
 *     LAYER, LAYER, ...     LAYER: INDEX THICKNESS, or TIMESx(LAYER, LAYER, ...)
 * INDEX is a number (1.38), a complex number n + i k (2.4+0.01i), a name of the catalogues of media and metals
 * (optics/media.h), or `data`: the data that the material names. THICKNESS is in nm (99.7), or optical: 550/4 is a
 * quarter of the wavelength 550 nm in the layer, 550 / (4 n(550 nm)). Brackets around the whole are ignored.
 *
 * Ownership: plain values; data are borrowed. Errors: only coating_parse reports errors. */
#pragma once

#include "optics/multilayer.h"
#include "optics/optical_data.h"

enum { COATING_LAYERS_MAX = 64, COATING_MEDIA_MAX = 12, COATING_TEXT_MAX = 255 };

/* What a layer consists of: the first of metal, of, measured that is set, else a constant index. */
typedef struct layer_medium {
    complex_pair constant;
    const struct medium *of; /* optics/media.h */
    const struct metal *metal;
    bool measured; /* the material's data */
} layer_medium;

typedef struct coating_layer {
    int medium;       /* index in coating_layers.media */
    double thickness; /* nm; if wave_nm > 0, the divisor of the wavelength */
    double wave_nm;   /* 0: a geometrical thickness */
} coating_layer;

/* Layers from the outside of the solid to its inside. */
typedef struct coating_layers {
    int media_count, count;
    layer_medium media[COATING_MEDIA_MAX + 1]; /* the last ones: for a film above them (film_stack_make) */
    coating_layer layer[COATING_LAYERS_MAX + 1];
} coating_layers;

/* Named designs. */
typedef struct coating_design {
    const char *name, *layers; /* "ar-550", "mgf2 550/4" */
    const char *title;         /* "one quarter-wave layer" */
    const char *source;
} coating_design;

size_t coating_designs_count(void);
const coating_design *coating_design_at(size_t i);           /* i < coating_designs_count() */
const coating_design *coating_design_find(const char *name); /* NULL: none */

/* STATUS_BAD_INPUT for a text that is neither; why->remedy says what would be right. */
status coating_parse(const char *text, coating_layers *out, diagnostic *why);

/* Whether some layer's index is `data`. */
bool coating_needs_data(const coating_layers *c);

/* --- films --- */

/* A coating that is ready for evaluation: thicknesses are geometrical. */
typedef struct film_stack {
    coating_layers layers;
    double thickness_nm[COATING_LAYERS_MAX + 1];
    const optical_data *data; /* borrowed; NULL: none, an index of 1 */
    bool data_in_air;         /* their index is relative to air */
    bool absorbs;             /* some layer does: reflectance and transmittance do not add up to 1 */
} film_stack;

/* thin: a transparent film on the outside of the coating; thickness 0: none. c: NULL for no layers below it. */
void film_stack_make(thin_film thin, const coating_layers *c, const optical_data *data, bool data_in_air,
                     film_stack *out);
/* n + i k of a medium of the stack. */
complex_pair film_stack_index(const film_stack *s, int number, double lambda_nm);
double film_stack_thickness_nm(const film_stack *s);
/* Its films in the order of a ray from outside or, if inward is false, from inside; returns their number. */
enum { FILMS_MAX = COATING_LAYERS_MAX + 1 };
int film_stack_films(const film_stack *s, double lambda_nm, bool inward, thin_film films[FILMS_MAX]);
