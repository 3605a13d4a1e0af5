/* Exports of scenes for other programs: POV-Ray 3.7's scene language, and glTF 2.0, as JSON with its numbers inside or
 * binary. What a format cannot say is a note, one line each, which is also in the file: at the head of a .pov, in
 * asset.extras of a glTF file. export_notes.c has the decision for every parameter. Ownership: the caller frees an
 * export with scene_export_release. Errors: STATUS_BAD_INPUT for a scene that no renderer would accept, or that is too
 * large for a GLB file; STATUS_FAILURE if memory runs out. */
#pragma once

#include "render/plan/plan.h"
#include "scene/model/params.h"
#include <stdio.h>

typedef enum export_format { EXPORT_POV, EXPORT_GLTF, EXPORT_GLB, EXPORT_FORMAT_COUNT } export_format;
extern const char *const export_endings[EXPORT_FORMAT_COUNT]; /* ".pov" */

typedef struct scene_export {
    char *bytes;
    size_t size;
    char **notes; /* without a final full stop */
    size_t note_count;
} scene_export;

/* s: checked and loaded. path: of the written file, where paths in it start. */
status scene_export_make(const scene *s, export_format format, const char *path, scene_export *out, diagnostic *why);
void scene_export_release(scene_export *e);

/* Why the format does not say a parameter: NULL if it does, or the writer notes what it does not; "" if the image
 * does not depend on it. *known: the parameter has a decision. */
const char *export_reason(const param *row, export_format format, bool *known);

/* --- for the writers --- */

typedef struct export_notes {
    struct export_note *list;
    size_t count;
    bool failed; /* out of memory */
} export_notes;

/* Adds a reason at a place: a parameter's path or an object's name, or NULL for the scene. Equal reasons become one
 * note, with their places before it. */
void export_note(export_notes *n, const char *where, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* "PLACE, PLACE and 2 more: reason"; newly allocated, NULL if memory runs out. */
char *export_note_text(const export_notes *all, size_t at, diagnostic *why);
void export_notes_release(export_notes *n);

typedef struct export_work {
    const scene *s;
    const plan *p;
    const char *path;
    export_notes *notes;
} export_work;

/* The file's text or bytes, without the notes at the head of a .pov. */
status pov_scene_write(const export_work *w, FILE *out, diagnostic *why);
status gltf_scene_write(const export_work *w, bool binary, FILE *out, diagnostic *why);

/* The name of a region's solid; its shape; whether light goes through it. */
const char *export_name(const export_work *w, int r);
bool export_is_clear(const export_work *w, int r);
/* Whether rays branch at surfaces: render.lighting is whitted, of an integrator that traces ray trees or paths. */
bool export_has_branches(const scene *s);
/* The distance between two solids along the directions of their axes and of the world, below 0 where they overlap in
 * all of these. */
double export_gap(const solid_shape *a, const solid_shape *b);
/* The colour of a surface that reflects as a metal or a film, at normal incidence from the surroundings. */
vec3 export_layered_color(const export_work *w, int r);

/* --- for POV-Ray: scene_pov.c, pov_solids.c, pov_shapes.c --- */

typedef struct pov {
    const export_work *w;
    const scene_geometry *g;
    double gain; /* of all light: the exposure */
    FILE *out;
    diagnostic *why;
} pov;

/* The margin in which media meet: above the least distance at which POV-Ray sees a surface, 1e-4 (MIN_ISECT_DEPTH); if
 * media absorb, also above that of its shadow rays, 1e-3 (SHADOW_TOLERANCE), so that they know which media they are
 * in. */
#define POV_MARGIN 0.00025
#define POV_MARGIN_ABSORBING 0.00125
static inline double pov_margin(const plan *p)
{
    return p->geometry->attenuates ? POV_MARGIN_ABSORBING : POV_MARGIN;
}

status pov_solids_write(const pov *to);

void pov_number(FILE *out, double value);
void pov_vector(FILE *out, vec3 v);
/* "rgb <..>"; pov_light: times the gain. */
void pov_color(const pov *v, vec3 c);
void pov_light(const pov *v, vec3 c);
void pov_named(const pov *v, const char *name, double value); /* " NAME VALUE" */

/* POV-Ray's word for the format of an image file, or NULL. */
const char *pov_image_word(const char *path);
/* A pigment: the colour of the declared image `name` at u and v, functions of x, y, z, times a factor; most: its
 * largest value. */
void pov_image_pigment(const pov *v, const char *name, const char *at_u, const char *at_v, vec3 factor, double most);

/* Writes the shape as an object in its own frame, with its surface moved inwards by `inset`; outwards if below 0.
 * *exact: set to false if curved sides became triangles. Not for meshes. */
status pov_shape_write(const solid_shape *shape, double inset, FILE *out, bool *exact, diagnostic *why);
/* Whether pov_shape_write can move the shape's surface. */
bool pov_shape_can_inset(const solid_shape *shape);
/* Writes the turn and position of a shape. */
void pov_placement_write(const solid_shape *shape, FILE *out);
/* Writes triangles as a mesh2; smooth: with the normals. head: its texture_list, or "". by_slot, by_vertex: each
 * triangle has the texture of its slot, or each corner that of its vertex. */
void pov_mesh_write(const mesh *m, bool smooth, const char *head, bool by_slot, bool by_vertex, FILE *out);
/* Texture coordinates as two functions of x, y, z in the shape's frame; size: as texture_size. False: not said. */
bool pov_mapping(const solid_shape *shape, double size, FILE *u, FILE *v);
