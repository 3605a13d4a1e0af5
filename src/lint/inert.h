/* Rules on when a parameter of a scene has no effect, and the table that lists them. The renderer makes the same
 * decisions: see render/shade/shading.c, render/integrators/path.c and render/plan/plan.c. Private to src/lint.
 * Ownership: values; everything is borrowed for the call. */
#pragma once

#include "base/counters.h"
#include "lint/lint.h"
#include "render/plan/plan.h"
#include "scene/model/lights.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "scene/model/solids.h"

typedef struct inert_case {
    const scene *s;
    param_place at;
    const char *name;             /* name of the path's object: "render", "lamp", "glass" */
    const ray_counters *frame;    /* counters of a frame of the scene, or NULL */
    const inert_witness *witness; /* never NULL */
    const solid *owner;           /* the solid of the parameter, or a visible solid with the material */
    const material *m;            /* the owner's surface */
    inert_answer *out;
} inert_case;

/* --- notes --- */

/* A rule of the table (needs.c). True: the parameter has NO effect, and c->out has the note that says why. */
typedef bool inert_rule(const inert_case *c);

/* Writes the note to c->out and returns true. */
bool inert_say(const inert_case *c, const char *rule, const char *remedy, const char *text, ...)
    __attribute__((format(printf, 4, 5)));

/* Whether the witness reports that the assignment ("glass.specular=1") leaves the film unchanged; false without a
 * witness. */
bool inert_unchanged(const inert_case *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A remedy that starts with "set ". */
typedef struct inert_remedy {
    char text[NOTE_TEXT_MAX];
} inert_remedy;
inert_remedy inert_set(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Remedies that set a parameter of a solid ("diffuse=0.7"), or make the solid transparent; NULL: "add a solid". */
inert_remedy inert_set_on(const solid *one, const char *assignment);
inert_remedy inert_set_clear(const solid *one);
/* Remedies that make the colour of the surface of object `name` visible, or make a light shine. */
inert_remedy color_remedy(const scene *s, const material *m, const char *name);
inert_remedy lamp_remedy(const scene *s);

/* --- facts about the scene: inert_facts.c --- */

/* Whether the parameter has this name, or one of a list that ends with NULL. */
bool is_named(const inert_case *c, const char *name);
bool is_among(const inert_case *c, const char *const *names);

bool is_black(vec3 color);
bool is_path(const scene *s);
bool is_drawn(const scene *s);
bool is_unlit(const scene *s);
/* Secondary rays are traced. */
bool follows_rays(const scene *s);
/* The depth buffer shows what is behind transparent solids. */
bool draws_through(const scene *s);
/* Neither rays, nor the depth buffer's view, nor light cross a transparent surface. */
bool nothing_passes(const scene *s);
/* Radiance beyond the depth limit is black. */
bool is_dark_at_depth_limit(const scene *s);
/* shining_lights: the number of lights that shine. only_spheres_shine: random paths are used, and every light that
 * shines has a size, so that they can hit it. */
size_t shining_lights(const scene *s);
bool only_spheres_shine(const scene *s);
/* Whether photons carry the light of a beam. */
bool beams_light(const scene *s);

/* The first visible solid with the property (NULL: any); NULL if there is none. */
typedef bool solid_is(const scene *s, const solid *one);
const solid *first_visible(const scene *s, solid_is *is);
bool is_clear(const scene *s, const solid *one);
/* Lights light the solid, or may light its faces. */
bool shows_lamps(const scene *s, const solid *one);
/* Faces may have materials from the mesh file instead of the solid's: unknown until the mesh is loaded. */
bool may_have_face_materials(const scene *s, const solid *owner);

/* Phong terms that are not 0, and their equivalent in path tracing. */
bool shows_ambient(const scene *s, const material *m);
bool shows_specular(const scene *s, const material *m);
bool shows_color(const scene *s, const material *m);
/* A light or a beam lights the surface. */
bool is_lit_by_lamps(const scene *s, const material *m);
/* A ray that hits the solid has secondary rays. */
bool sends_rays_on(const scene *s, const solid *owner);

/* --- rules of several groups --- */

inert_rule no_lamp,     /* no light shines */
    nothing_lit,        /* no light shines, or no visible surface is lit by one */
    no_clear,           /* no visible solid is transparent */
    no_tree,            /* no secondary rays are traced, or no surface has any */
    unpolarised,        /* light is traced without its polarisation */
    inert_polarisation; /* nothing polarises light */
/* Always true, with the note that no secondary ray is traced, or that no ray is bent. */
inert_rule say_no_tree, say_not_bent;

/* --- rules of the image: inert_render.c --- */

inert_rule path_samples, one_light, no_roughness, no_random_numbers, no_highlights, nothing_beyond, some_face_materials,
    same_when_drawn, lit_by_hits, no_size, no_photons, same_photons, polarisation_unseen, no_dispersion, no_absorption,
    untextured, lens_unsampled;
/* Basic and classic radiance are equal. */
inert_rule inert_radiance;

/* --- rules of lights, beams and the sky: inert_objects.c --- */

inert_rule moves_sky, black_lamp, depolarised, size_unsampled, lights_nothing, unseen_beam, thin_beam, shows_no_light,
    flat_sky, no_own_sun, no_ambient, nothing_refracts, not_bent_outside;

/* --- rules of solids, meshes and textures: inert_objects.c --- */

inert_rule overlaps_unseen, flat_side, looks_the_same, unshaded, one_mesh, no_point_files, unused_mesh, at_rest,
    unused_texture, of_floats, unused_data, not_of_file, by_data, not_turbid, no_data_layer;

/* --- rules of a surface, c->m on c->owner: inert_material.c --- */

inert_rule no_color_or_tint, is_black_surface, unlit, no_highlight, no_reflectivity, no_law, no_index, no_medium,
    nothing_reflected, opaque_rule, mirror_rule, constant_weights, film_unseen, sheet_unpassed, axis_unseen,
    nothing_rough, unpassed, no_texture, no_alpha, no_color, one_color, covered, no_interface, unseen;

/* --- the table: needs.c ---
 *
 * What a parameter needs to have an effect: each row is a condition on another parameter, or a rule. The first row that
 * leaves the parameter without effect makes the note: "no effect with lamp.kind=point; set lamp.kind=sun". */

typedef struct needs_row {
    param_group group; /* the parameters' group; rows of PARAM_MATERIAL apply to a solid's surface, too */
    const char *names; /* the parameters, separated by spaces; "*": all of the group */
    /* A condition on a parameter of the same object ("spectrum=black_body", "kind=cone|soft_cone", "kind!=sun",
     * "intensity>0"), or of render, camera or background with a full path. It does not apply to the parameter that it
     * names. NULL: the row has a rule. */
    const char *needs;
    const char *remedy; /* the assignment that meets the condition, % for the object's name; NULL: the first value */
    inert_rule *fact;   /* if needs is NULL: true if the parameter has no effect */
    bool acts;          /* reversed: if the fact is true, the parameter has an effect, and later rows are skipped */
} needs_row;

/* Whether a row of the group leaves c's parameter without effect. */
bool needs_ask(const inert_case *c, param_group group);
/* Whether the parameter needs light, and the integrator shows none. */
bool needs_light(const inert_case *c);
/* The table, for its test. */
const needs_row *needs_rows(size_t *count);

/* The parts of the linter, each of which examines a plan and reports notes. Private to src/lint. */

typedef struct lint_input {
    const scene *original; /* the caller's scene */
    plan *probe;           /* plan of a copy of the scene with a small image */
    isa level;
    const note_sink *taker;
} lint_input;

/* Notes overlapping solids of equal priority, and narrow gaps. */
status lint_neighbours(const lint_input *input, diagnostic *why);

/* Notes a depth limit or a minimum weight of ray trees that cuts much light, or may do so. rays: of all small images
 * together, at most. */
status lint_depth(const lint_input *input, double rays, diagnostic *why);

/* Notes a depth limit of random paths; the plan must be of the path integrator. */
status lint_path_depth(const lint_input *input, diagnostic *why);

/* The solid with the given priority index. */
static inline const solid *lint_solid(const lint_input *input, int priority_index)
{
    return &input->original->solids[input->probe->geometry->regions[priority_index].solid];
}
