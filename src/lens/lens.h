/* The report of a lens: what an optical designer asks of a prescription (scene/lens/lens_prescription.h). First-order
 * data, Seidel sums and ghosts come from paraxial formulas; fans, spots, colour, vignetting, wavefronts, MTF and point
 * images come from real rays, which the one tracer follows through the solids that the prescription stands for. Each
 * result is a row of one table, from which text, CSV, JSON, the figure and Python's arrays are made.
 *
 * Coordinates: Z along the light from the first vertex, Y and X across; fields along +Y are above the axis. Lengths are
 * mm, wavefronts waves of their own wavelength in vacuum, frequencies cycles per mm in the image.
 *
 * Ownership: lens_report_make fills a table that lens_report_release frees; the prescription is borrowed. Errors:
 * STATUS_BAD_INPUT for a prescription without surfaces, focus or passing light. */
#pragma once

#include "base/isa.h"
#include "scene/lens/lens_prescription.h"
#include "scene/model/open.h"

/* NaN, or 0 for surface and field, where a row has no such key. Texts are constants. */
typedef struct lens_row {
    const char *section;
    int surface, field;   /* from 1 */
    double lambda_nm;     /* 0: all wavelengths, by their weights */
    double x;             /* the abscissa; the section says which */
    const char *quantity; /* "rms_centroid" */
    const char *unit;     /* "mm"; "" for a ratio */
    double value;
} lens_row;

typedef struct lens_report {
    lens_row *row;
    size_t count, room;
    bool failed; /* out of memory */
} lens_report;

typedef struct lens_options {
    int fan_rays;            /* of a half fan, 2 .. 500 */
    int spot_grid;           /* rays across the pupil of a spot, 4 .. 256 */
    int wave_grid;           /* samples across the pupil of a wavefront, a power of two, 8 .. 256 */
    double frequency_per_mm; /* the highest of the MTF; 0: 100, or the cutoff if that is lower */
    bool psf;                /* also point images */
} lens_options;

extern const lens_options lens_options_usual;

/* A section: its name, the meaning of x ("": none) and of its rows; whether it has one record without keys; of text,
 * every so manieth record is written (0: each; -1: none). The name is NULL after the last. */
typedef struct lens_section {
    const char *name, *x, *meaning;
    bool single;
    int every;
} lens_section;
const lens_section *lens_section_at(size_t i);

/* A prescription in the world: the scene that holds its solids, and a frame. A point (X, Y, Z) of the lens, mm, is at
 * origin + scale (X across + Y up + Z along). */
typedef struct lens_place {
    const scene *s; /* borrowed, loaded */
    vec3 origin, across, up, along;
    double scale; /* scene units per mm */
} lens_place;

/* Makes a scene of nothing but the lens, in mm, that the caller destroys. Its stop has no solid: rays are aimed at
 * it. */
status lens_place_alone(const lens_prescription *p, const lens_glasses *glasses, scene **out, lens_place *place,
                        diagnostic *why);

/* Reads the lens of a loaded scene, of the solids whose names begin with `system` (NULL: of all its lenses), and places
 * it where they are, with all that surrounds them; the solid of the stop becomes invisible, since rays are aimed at its
 * edge. */
status lens_place_in_scene(scene *s, const char *system, lens_prescription *p, lens_place *place, diagnostic *why);

/* The same for a scene file, and lens_place_alone for a file of prescriptions. The caller releases p, also after an
 * error, and destroys *s, which is NULL then. */
status lens_open(const char *path, const char *system, const lens_glasses *glasses, lens_prescription *p, scene **s,
                 lens_place *place, diagnostic *why);

/* Light instead of that of the lens: fields along +Y, in the prescription's own unit, and wavelengths, the primary one
 * first. A list of 0 keeps the lens's own. */
typedef struct lens_light {
    double field[LENS_LIST_MAX], lambda_nm[LENS_LIST_MAX]; /* wavelengths: 200 .. 2000 */
    size_t fields, wavelengths;
} lens_light;
status lens_set_light(lens_prescription *p, const lens_light *with, diagnostic *why);

status lens_report_make(const lens_prescription *p, const lens_place *at, isa level, const lens_options *options,
                        lens_report *out, diagnostic *why);
/* The report on a loaded scene's lens (lens_place_in_scene). */
status lens_report_of_scene(scene *s, const char *system, const lens_light *with, isa level,
                            const lens_options *options, lens_report *out, diagnostic *why);
void lens_report_release(lens_report *r);
