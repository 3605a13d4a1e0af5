/* What the rules of inert.c share. A rule looks at one parameter and either says why it is inert, or returns false.
 * Ownership: values; everything is borrowed for the call. */
#pragma once

#include "scene/model/inert/inert.h"
#include "scene/model/params_path.h"
#include "scene/model/light.h"
#include "scene/model/solids.h"

typedef struct inert_case {
    const scene *s;
    param_place at;
    const char *name;             /* of the path's object: "render", "lamp", "glass" */
    const ray_counters *frame;    /* or NULL */
    const inert_witness *witness; /* never NULL */
    const solid *owner;           /* of a surface: the solid that has it, visible */
    const material *m;            /* its surface */
    inert_answer *out;
} inert_case;

typedef bool inert_rule(const inert_case *c);
typedef struct inert_row {
    const char *name;
    inert_rule *rule;
} inert_row;

/* The rule of the parameter in a list that ends with a NULL name; false where it has none. */
bool inert_by_name(const inert_row *rows, const inert_case *c);

/* The witness says that the film stays as it is. */
bool inert_same(const inert_case *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Fills the answer and returns true. */
bool inert_say(const inert_case *c, const char *rule, const char *remedy, const char *text, ...)
    __attribute__((format(printf, 4, 5)));

/* A remedy that begins with "set ". */
typedef struct inert_remedy {
    char text[NOTE_TEXT_MAX];
} inert_remedy;
inert_remedy inert_set(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* One that sets a parameter of a solid ("diffuse=0.7"), or makes it clear; or adds a solid where there is none. */
inert_remedy inert_set_on(const solid *one, const char *assignment);
inert_remedy inert_set_clear(const solid *one);

bool inert_render(const inert_case *c);
bool inert_background(const inert_case *c);
/* Of render.radiance. */
bool inert_radiance(const inert_case *c);
/* Light that an integrator with layers does not follow. */
bool inert_layers(const inert_case *c);
/* A parameter without which camera rays meet the same first. */
bool inert_unmet(const inert_case *c, const char *path);
bool inert_mesh(const inert_case *c);
bool inert_texture(const inert_case *c);
bool inert_light(const inert_case *c);
bool inert_material(const inert_case *c);
bool inert_solid(const inert_case *c);
/* A row of a material on c->owner. */
bool inert_surface(const inert_case *c);
/* The same where all of it looks as c->m; where its faces look as a mesh's file says; and a row of the scene's material
 * that c is about on those of its faces that are named so (true without an answer where there are none). */
bool inert_appearance(const inert_case *c);
bool inert_faces(const inert_case *c);
bool inert_named_faces(const inert_case *c);
/* Is the row's name one of a list that ends with NULL? */
bool is_among(const inert_case *c, const char *const *names);

/* --- what the scene does (inert_facts.c) --- */

bool is_black(vec3 color);
bool is_path(const scene *s);
/* Rays go on from surfaces. */
bool follows_rays(const scene *s);
/* The depth buffer shows what lies behind clear solids. */
bool draws_through(const scene *s);
/* Neither rays nor the depth buffer's view nor a lamp's light pass a clear surface. */
bool nothing_passes(const scene *s);
/* Answers that several parameters share; false where they are not so. */
bool no_lamp(const inert_case *c);
bool no_ambient_on_paths(const inert_case *c);
bool goes_straight(const inert_case *c);
bool say_not_bent(const inert_case *c);
/* The word of render that stops rays at surfaces, and what to set. */
bool say_no_tree(const inert_case *c);
/* Light from beyond the depth limit is black. */
bool is_dark_at_depth_limit(const scene *s);
/* Lights that shine; all of them spheres, which the path integrator alone knows. */
size_t shining_lights(const scene *s);
bool only_spheres_shine(const scene *s);

/* The faces may look as the mesh's file says, and not as the solid's surface does. */
bool may_have_face_materials(const scene *s, const solid *owner);
/* The first visible solid that is so (NULL: any); NULL if there is none. */
typedef bool solid_is(const scene *s, const solid *one);
const solid *first_visible(const scene *s, solid_is *is);
bool is_clear(const scene *s, const solid *one);
/* Light of a lamp shows on it, or may on its faces. */
bool shows_lamps(const scene *s, const solid *one);

/* Terms of Phong's sum, and what stands for them on random paths, that are not 0. */
bool shows_ambient(const scene *s, const material *m);
bool shows_specular(const scene *s, const material *m);
bool shows_color(const scene *s, const material *m);
/* Light of a lamp falls on it. */
bool is_lit_by_lamps(const scene *s, const material *m);
/* A ray that meets it goes on. */
bool sends_rays_on(const scene *s, const solid *owner);
/* An assignment that makes the surface's colour show, the object's name in place of the solid's. */
inert_remedy color_remedy(const scene *s, const material *m, const char *name);
/* And one that makes a lamp shine. */
inert_remedy lamp_remedy(const scene *s);
