/* Facts of a scene that parameters need, and how a fact says its note. The renderer makes the same decisions: see
 * render/shade/shading.c, render/integrators/path.c and render/plan/plan.c. Private to src/lint. Ownership: values;
 * everything is borrowed for the call. */
#pragma once

#include "base/counters.h"
#include "lint/lint.h"
#include "scene/model/lights.h"
#include "scene/model/params.h"
#include "scene/model/solids.h"

typedef struct inert_case {
    const scene *s;
    param_place at;
    const char *name;             /* name of the path's object: "render", "lamp", "glass" */
    const ray_counters *frame;    /* or NULL */
    const inert_witness *witness; /* never NULL */
    const solid *owner; /* for a surface: a visible solid that has it; for a solid's own parameter: the solid */
    const material *m;  /* its surface */
    inert_answer *out;
} inert_case;

/* --- notes --- */

/* A fact of the table (lint/needs.c): if it leaves the parameter without effect, says so and returns true. */
typedef bool inert_rule(const inert_case *c);

/* Fills the result and returns true. */
bool inert_say(const inert_case *c, const char *rule, const char *remedy, const char *text, ...)
    __attribute__((format(printf, 4, 5)));

/* Whether the witness reports an unchanged film. */
bool inert_unchanged(const inert_case *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A remedy that starts with "set ". */
typedef struct inert_remedy {
    char text[NOTE_TEXT_MAX];
} inert_remedy;
inert_remedy inert_set(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* A remedy that sets a parameter of a solid ("diffuse=0.7"), or makes it transparent; or adds a solid if there is none.
 * */
inert_remedy inert_set_on(const solid *one, const char *assignment);
inert_remedy inert_set_clear(const solid *one);
/* An assignment that makes the surface's colour visible, with the object's name in place of the solid's; one that gives
 * a light an intensity. */
inert_remedy color_remedy(const scene *s, const material *m, const char *name);
inert_remedy lamp_remedy(const scene *s);

/* --- facts about the scene: inert_facts.c --- */

/* Whether the parameter's name is this one, or in a list that ends with NULL. */
bool is_named(const inert_case *c, const char *name);
bool is_among(const inert_case *c, const char *const *names);

bool is_black(vec3 color);
bool is_path(const scene *s);
bool is_drawn(const scene *s);
bool has_layers(const scene *s);
/* Secondary rays are traced. */
bool follows_rays(const scene *s);
/* The depth buffer shows what is behind transparent solids. */
bool draws_through(const scene *s);
/* Neither rays, nor the depth buffer's view, nor light cross a transparent surface. */
bool nothing_passes(const scene *s);
/* Radiance beyond the depth limit is black. */
bool is_dark_at_depth_limit(const scene *s);
/* Whether any light has an intensity; whether all of those are spheres, which only the path integrator supports. */
size_t shining_lights(const scene *s);
bool only_spheres_shine(const scene *s);
/* Whether photons carry the light of a beam. */
bool beams_light(const scene *s);

/* The first visible solid with the property (NULL: any); NULL if there is none. */
typedef bool solid_is(const scene *s, const solid *one);
const solid *first_visible(const scene *s, solid_is *is);
bool is_clear(const scene *s, const solid *one);
/* It is lit by lights, or its faces may be. */
bool shows_lamps(const scene *s, const solid *one);
/* Faces may have materials from the mesh file instead of the solid's: unknown until the mesh is loaded. */
bool may_have_face_materials(const scene *s, const solid *owner);

/* Phong terms that are not 0, and their equivalent in path tracing. */
bool shows_ambient(const scene *s, const material *m);
bool shows_specular(const scene *s, const material *m);
bool shows_color(const scene *s, const material *m);
/* It is lit by a light. */
bool is_lit_by_lamps(const scene *s, const material *m);
/* A ray that hits it has secondary rays. */
bool sends_rays_on(const scene *s, const solid *owner);

/* --- facts of several groups --- */

/* No light has an intensity; no visible surface is lit by one. No visible solid is transparent. No secondary rays: that
 * none are traced, and that no surface has any. Light is traced without its polarisation, or is nowhere polarised. */
inert_rule no_lamp, nothing_lit, no_clear, say_no_tree, no_tree, unpolarised, inert_polarisation;
/* No ray is bent. */
inert_rule say_not_bent;

/* --- facts of the image: inert_render.c --- */

inert_rule path_samples, one_light, no_roughness, no_random_numbers, no_highlights, nothing_beyond, some_face_materials,
    same_when_drawn, lit_by_hits, no_size, no_photons, same_photons, polarisation_unseen, no_dispersion, no_absorption,
    untextured, chief_rays;
/* Basic and classic radiance are equal. */
inert_rule inert_radiance;

/* --- facts of lights, beams and the sky: inert_objects.c --- */

inert_rule moves_sky, black_lamp, depolarised, size_unsampled, lights_nothing, unseen_beam, thin_beam, shows_no_light,
    flat_sky, no_own_sun, no_ambient, nothing_refracts, not_bent_outside;

/* --- facts of solids, meshes and textures: inert_objects.c --- */

inert_rule overlaps_unseen, looks_the_same, unshaded, one_mesh, unused_mesh, at_rest, unused_texture, of_floats;

/* --- facts of a surface, c->m on c->owner: inert_material.c --- */

inert_rule no_color_or_tint, is_black_surface, unlit, no_highlight, no_reflectivity, no_law, no_index, no_medium,
    nothing_reflected, opaque_rule, mirror_rule, constant_weights, film_unseen, sheet_unpassed, axis_unseen,
    nothing_rough, unpassed, no_texture, no_color, one_color, covered, no_interface, unseen;

/* --- the table: needs.c ---
 *
 * What a parameter needs to have an effect: a table of conditions, each on another parameter or on a fact of the scene.
 * The note of the first condition that does not hold follows from its row: "no effect with lamp.kind=point; set
 * lamp.kind=sun". */

typedef struct needs_row {
    param_group group; /* of the parameters; rows of PARAM_MATERIAL apply to a solid's surface, too */
    const char *names; /* of the parameters, separated by spaces; "*": all of the group */
    /* "spectrum=black_body", "kind=cone|soft_cone", "kind!=sun", "intensity>0": of the same object, or with a full
     * path, of render, camera or background. A parameter does not need itself. NULL: the fact alone. */
    const char *needs;
    const char *remedy; /* what to set, % for the object's name; NULL: the first word after '=' */
    inert_rule *fact;   /* a condition that is code, and says the note */
    bool acts;          /* where the fact holds, the parameter has an effect: later rows do not count */
} needs_row;

/* Whether a row of the group says that c's parameter has no effect. */
bool needs_ask(const inert_case *c, param_group group);
/* The same of what integrators with layers, which trace no light, do not use. */
bool needs_light(const inert_case *c);
/* The table, for its test. */
const needs_row *needs_rows(size_t *count);
