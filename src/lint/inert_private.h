/* Shared code of the rules of inert.c. A rule examines one parameter and either gives the reason why it has no effect,
 * or returns false. Ownership: values; everything is borrowed for the call. */
#pragma once

#include "base/counters.h"
#include "lint/lint.h"
#include "scene/model/params_path.h"
#include "scene/model/light.h"
#include "scene/model/solids.h"

typedef struct inert_case {
    const scene *s;
    param_place at;
    const char *name;             /* name of the path's object: "render", "lamp", "glass" */
    const ray_counters *frame;    /* or NULL */
    const inert_witness *witness; /* never NULL */
    const solid *owner;           /* for a surface: a visible solid that has it */
    const material *m;            /* its surface */
    inert_answer *out;
} inert_case;

typedef bool inert_rule(const inert_case *c);
typedef struct inert_row {
    const char *name;
    inert_rule *rule;
} inert_row;

/* Applies the parameter's rule from a list that ends with a NULL name; false if it has none. */
bool inert_by_name(const inert_row *rows, const inert_case *c);

/* Whether the witness reports an unchanged film. */
bool inert_same(const inert_case *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Fills the result and returns true. */
bool inert_say(const inert_case *c, const char *rule, const char *remedy, const char *text, ...)
    __attribute__((format(printf, 4, 5)));

/* A remedy that starts with "set ". */
typedef struct inert_remedy {
    char text[NOTE_TEXT_MAX];
} inert_remedy;
inert_remedy inert_set(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* A remedy that sets a parameter of a solid ("diffuse=0.7"), or makes it transparent; or adds a solid if there is none.
 * */
inert_remedy inert_set_on(const solid *one, const char *assignment);
inert_remedy inert_set_clear(const solid *one);

bool inert_render(const inert_case *c);
bool inert_camera(const inert_case *c);
/* Light is nowhere polarised. */
bool inert_polarisation(const inert_case *c);
bool inert_background(const inert_case *c);
/* For render.radiance. */
bool inert_radiance(const inert_case *c);
/* Parameters of light, which integrators with layers do not trace. */
bool inert_layers(const inert_case *c);
/* A parameter that does not affect the first hits of camera rays. */
bool inert_unmet(const inert_case *c, const char *path);
bool inert_mesh(const inert_case *c);
bool inert_texture(const inert_case *c);
bool inert_light(const inert_case *c);
bool inert_beam(const inert_case *c);
bool inert_material(const inert_case *c);
bool inert_solid(const inert_case *c);
/* A row of a material on c->owner. */
bool inert_surface(const inert_case *c);
/* The same for a uniform surface c->m; for faces with materials from a mesh file; and a row of the scene's material of
 * c on the faces with its name (true without a result if there are none). */
bool inert_appearance(const inert_case *c);
bool inert_faces(const inert_case *c);
bool inert_named_faces(const inert_case *c);
/* The solid is opaque; it is a perfect mirror; no light passes it. */
inert_rule opaque_rule, mirror_rule, unpassed;
/* Rules of metals and films (inert_layered.c): no ray brings what the surface reflects; of their parameters; and of the
 * reflectivity that they replace. */
inert_rule mirrors_black, nothing_reflected, extinction_rule, film_rule, film_index_rule, layered_reflectivity;
/* Light is traced without its polarisation, and the assignments that change this. */
inert_rule unpolarised;
inert_remedy polarised_remedy(const scene *s);
/* Rules of polarisers and wave plates (inert_sheet.c). */
inert_rule sheet_rule, sheet_axis_rule, sheet_share_rule, retardance_rule;
/* Of crystals (inert_crystal.c). */
inert_rule crystal_rule, optic_axis_rule;
/* Of rough surfaces, and of what reflects nothing because rays end there. */
inert_rule roughness_rule, nothing_at_depth_0;
/* Whether the row's name is in a list that ends with NULL. */
bool is_among(const inert_case *c, const char *const *names);

/* --- facts about the scene (inert_facts.c) --- */

bool is_black(vec3 color);
bool is_path(const scene *s);
/* Secondary rays are traced. */
bool follows_rays(const scene *s);
/* The depth buffer shows what is behind transparent solids. */
bool draws_through(const scene *s);
/* Neither rays, nor the depth buffer's view, nor light cross a transparent surface. */
bool nothing_passes(const scene *s);
/* Results shared by several parameters; false if they do not apply. */
bool no_lamp(const inert_case *c);
bool no_ambient_on_paths(const inert_case *c);
bool goes_straight(const inert_case *c);
bool say_not_bent(const inert_case *c);
/* The word of render that excludes secondary rays, and the remedy. */
bool say_no_tree(const inert_case *c);
/* Radiance beyond the depth limit is black. */
bool is_dark_at_depth_limit(const scene *s);
/* Whether any light has an intensity; whether all of those are spheres, which only the path integrator supports. */
size_t shining_lights(const scene *s);
/* Whether photons bring the light of a beam. */
bool beams_light(const scene *s);
bool only_spheres_shine(const scene *s);

/* Faces may have materials from the mesh file instead of the solid's: unknown until the mesh is loaded. */
bool may_have_face_materials(const scene *s, const solid *owner);
/* The first visible solid with the property (NULL: any); NULL if there is none. */
typedef bool solid_is(const scene *s, const solid *one);
const solid *first_visible(const scene *s, solid_is *is);
bool is_clear(const scene *s, const solid *one);
/* It is lit by lights, or its faces may be. */
bool shows_lamps(const scene *s, const solid *one);

/* Phong terms that are not 0, and their equivalent in path tracing. */
bool shows_ambient(const scene *s, const material *m);
bool shows_specular(const scene *s, const material *m);
bool shows_color(const scene *s, const material *m);
/* It is lit by a light. */
bool is_lit_by_lamps(const scene *s, const material *m);
/* A ray that hits it has secondary rays. */
bool sends_rays_on(const scene *s, const solid *owner);
/* An assignment that makes the surface's colour visible, with the object's name in place of the solid's. */
inert_remedy color_remedy(const scene *s, const material *m, const char *name);
/* An assignment that gives a light an intensity. */
inert_remedy lamp_remedy(const scene *s);
