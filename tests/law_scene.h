/* Random scenes for the laws (test_laws.c): solids of all shapes that overlap, touch, are nested, or are separated by
 * tiny gaps, as values that can be changed, and as scene files. Ownership: values. */
#pragma once

#include "asphere_fixture.h"
#include "random_scene.h"

enum {
    LAW_SOLIDS_MAX = 12,
    LAW_LIGHTS_MAX = 2,
    LAW_WIDTH = 10,
    LAW_HEIGHT = 8,
    LAW_ADDED = 100 /* numbers from here on were added by a law */
};

typedef struct law_solid {
    int number;        /* its name, whatever its index */
    solid_shape shape; /* a mesh's frame and scale; its triangles are given by its name */
    const char *mesh;  /* "cube", "ball", "ring", "hills"; NULL for all other shapes */
    int64_t priority;
    bool opaque;
    double ior, transparency, reflectivity, specular, checker;
    vec3 absorb_per_m, tint; /* for a transparent solid, light's color after tint_distance inside */
    double tint_distance;
    bool gold;                 /* an opaque solid is a metal */
    double film_nm, roughness; /* 0: none */
    double scatter_per_m, asymmetry;
    double extraordinary_ior; /* of a crystal, else 0 */
    vec3 optic_axis;          /* in the solid's frame */
    const char *sheet;        /* NULL: none */
    vec3 sheet_axis;          /* in the solid's frame */
} law_solid;

typedef struct law_light {
    vec3 position;
    double reach;
    const char *kind; /* NULL: a point */
    vec3 target;      /* of a disc or a rectangle */
    double size;      /* radius, width and height */
    double polarised, polarisation_deg;
} law_light;

typedef struct law_beam {
    const char *kind, *profile; /* kind NULL: there is no beam */
    vec3 position, target;
    double angle_deg, width;
} law_beam;

typedef struct law_scene {
    const char *settings;
    double outside_ior;
    vec3 outside_absorb_per_m;
    double sky;
    bool flat; /* meshes are shaded flat */
    vec3 eye, target;
    double roll_deg;
    int light_count, solid_count;
    law_light light[LAW_LIGHTS_MAX];
    law_beam beam; /* a lamp for photons */
    law_solid solid[LAW_SOLIDS_MAX];
    int material_order[LAW_SOLIDS_MAX]; /* the order in which the materials of solid[0], solid[1] .. are declared */
} law_scene;

static const struct {
    const char *name, *text;
    double reach;
} law_meshes[] = {
    {"cube", "{generate: box, size: [1, 1, 1]}", 0.87},
    {"ball", "{generate: icosphere, level: 1}", 1.0},
    {"ring", "{generate: torus, around: 8, tube: 6}", 1.4},
    {"hills", "{generate: terrain, around: 3, tube: 3, size: [1, 0.3, 1]}", 0.8}, /* open: a surface without a volume */
};

/* 1e-12 .. 1, log-uniform; sometimes 0. */
static inline double random_gap(uint64_t *seed)
{
    const double exponent = random_real(seed, -12.0, 0.0);
    return random_below(seed, 3) == 0 ? 0.0 : pow(10.0, exponent);
}

static inline vec3 in_frame_of(const solid_shape *s, double x, double y, double z)
{
    return vec3_add(s->position, mat3_apply(rotation_from_deg(s->rotation_deg), vec3_make(x, y, z)));
}

static inline bool is_mesh_named(const law_solid *s, const char *name)
{
    return s->mesh && strcmp(s->mesh, name) == 0;
}

static inline double mesh_size(const law_solid *s)
{
    for (size_t k = 0; k < COUNT(law_meshes); k++)
        if (is_mesh_named(s, law_meshes[k].name))
            return 2.0 * law_meshes[k].reach;
    return 0.0;
}

/* A few copies: cubes touch, others are separated by a gap. */
static inline void copy_mesh(law_solid *s, uint64_t *seed)
{
    const double gap = random_gap(seed), step = is_mesh_named(s, "cube") ? 1.0 : mesh_size(s) + 1e-12;
    s->shape.copies = vec3_make(1.0 + random_below(seed, 3), 1.0 + random_below(seed, 2), 1.0 + random_below(seed, 2));
    s->shape.spacing = vec3_add(vec3_scale(s->shape.scale, step), vec3_make(gap, gap, gap));
}

static inline void place_mesh(law_solid *s, uint64_t *seed)
{
    s->mesh = law_meshes[random_below(seed, (int)COUNT(law_meshes))].name;
    s->shape =
        (solid_shape){.kind = SHAPE_MESH, .position = random_point(seed, 0.8), .copies = vec3_make(1.0, 1.0, 1.0)};
    s->shape.rotation_deg = random_below(seed, 3) ? random_point(seed, 180.0) : vec3_make(0.0, 0.0, 0.0);
    s->shape.scale.x = random_real(seed, 0.2, 1.2);
    s->shape.scale.y = random_below(seed, 2) ? s->shape.scale.x : random_real(seed, 0.2, 1.2);
    s->shape.scale.z = s->shape.scale.x;
    const int size = random_below(seed, 8);
    if (is_mesh_named(s, "cube") && size < 2) { /* a thin plate, or a large block below everything */
        const double power = size ? random_real(seed, -12.0, 0.0) : random_real(seed, 0.0, 4.0);
        s->shape.scale.y = pow(10.0, power);
        if (size == 0) {
            s->shape.scale.x = s->shape.scale.z = s->shape.scale.y;
            s->shape.position.y = -0.5 * s->shape.scale.y - 0.3;
            s->shape.rotation_deg = vec3_make(0.0, 0.0, 0.0);
        }
    } else if (size == 2)
        copy_mesh(s, seed);
}

/* Half the height of a solid along its own y, and its centre; 0 for solids without a flat top. */
static inline double flat_half(const law_solid *s, double *middle)
{
    *middle = s->shape.kind == SHAPE_CYLINDER || s->shape.kind == SHAPE_CUP || s->shape.kind == SHAPE_CONE ||
                      s->shape.kind == SHAPE_PRISM
                  ? 0.5 * s->shape.height
                  : 0.0;
    if (s->mesh)
        return is_mesh_named(s, "cube") ? 0.5 * s->shape.scale.y : 0.0;
    return s->shape.kind == SHAPE_BOX ? 0.5 * s->shape.size.y : *middle;
}

/* Places the solid on another one with a flat top: at a gap, or as a film. */
static inline void stack_on(law_solid *s, const law_solid *base, uint64_t *seed)
{
    double middle, gap = random_gap(seed);
    const double top = flat_half(base, &middle) + middle;
    solid_shape *shape = &s->shape;
    const bool thin = random_below(seed, 3) == 0;
    *shape = random_shape(seed);
    s->mesh = NULL;
    shape->rotation_deg = base->shape.rotation_deg;
    if (random_below(seed, 4) == 0 && !thin) {
        place_mesh(s, seed);
        s->mesh = "cube";
        shape->rotation_deg = base->shape.rotation_deg;
        shape->position = in_frame_of(&base->shape, 0.1, top + gap + 0.5 * shape->scale.y, 0.0);
        return;
    }
    if (shape->kind == SHAPE_PLANE || shape->kind == SHAPE_SPHERE || shape->kind == SHAPE_TORUS || thin)
        shape->kind = SHAPE_BOX;
    if (thin) {
        const double thickness = gap > 0.0 ? gap : 0.125;
        shape->size.y = thickness;
        shape->position = in_frame_of(&base->shape, 0.0, top + 0.5 * thickness, 0.05);
        return;
    }
    const double half = shape->kind == SHAPE_BOX ? 0.5 * shape->size.y : 0.0;
    shape->position = in_frame_of(&base->shape, 0.0, top + gap + half, -0.1);
}

static inline double smallest(vec3 v)
{
    return fmin(v.x, fmin(v.y, v.z));
}

/* Places the solid around another, or inside it, with a wall of uniform thickness, which may be zero. */
static inline void nest_in(law_solid *s, const law_solid *base, uint64_t *seed)
{
    s->shape = base->shape;
    s->mesh = base->mesh;
    solid_shape *shape = &s->shape;
    const double wall = random_gap(seed), least = fmin(fmin(shape->radius, shape->height),
                                                       shape->kind == SHAPE_BOX ? smallest(shape->size) : 1.0);
    double step = random_below(seed, 2) && wall < 0.05 * least ? -wall : wall;
    if (shape->kind == SHAPE_CONE && fabs(step) < 1e-9)
        step = 0.0; /* its slant moves by another length: the wall is wide or zero, or the sides intersect */
    if (shape->kind == SHAPE_TORUS)
        shape->tube_radius = fmin(shape->tube_radius + step, 0.99 * shape->radius);
    else
        shape->radius += step;
    shape->top_radius = fmax(shape->top_radius + step, 0.0);
    shape->inner_radius += 0.5 * step;
    shape->size = vec3_add(shape->size, vec3_make(2.0 * step, 2.0 * step, 2.0 * step));
    if (shape->kind == SHAPE_CYLINDER || shape->kind == SHAPE_CUP || shape->kind == SHAPE_CONE ||
        shape->kind == SHAPE_PRISM) {
        shape->position = in_frame_of(&base->shape, 0.0, -step, 0.0);
        shape->height += 2.0 * step;
    }
    if (shape->kind == SHAPE_PLANE)
        shape->position = in_frame_of(&base->shape, 0.0, step, 0.0);
    if (is_mesh_named(s, "cube")) {
        shape->scale = vec3_add(shape->scale, vec3_make(2.0 * step, 2.0 * step, 2.0 * step));
        shape->spacing = vec3_add(shape->spacing, vec3_make(2.0 * step, 2.0 * step, 2.0 * step));
    } else if (is_mesh_named(s, "ball") && step > 1e-9) { /* scaled, its wall is not uniform: wide or zero */
        shape->scale = vec3_scale(shape->scale, 1.0 + step);
        shape->spacing = vec3_scale(shape->spacing, 1.0 + step);
    }
}

/* For transparent solids; constant shares must add up to at most 1. */
static inline void random_coat(law_solid *s, const law_scene *w, uint64_t *seed)
{
    const bool constant = strstr(w->settings, "constant") != NULL;
    s->tint = vec3_make(1.0, 1.0, 1.0);
    s->tint_distance = 1.0;
    if (random_below(seed, 4) == 0) {
        s->tint = vec3_make(random_real(seed, 0.2, 1.0), 1.0, random_real(seed, 0.2, 1.0));
        s->tint_distance = random_real(seed, 0.3, 3.0);
    }
    if (random_below(seed, 4) == 0)
        s->reflectivity = random_real(seed, 0.0, constant ? 1.0 - s->transparency : 0.6);
}

static inline void random_surface(law_solid *s, const law_scene *w, uint64_t *seed)
{
    const double indices[] = {w->outside_ior, 1.33, 1.5, random_real(seed, 1.0, 2.5)};
    s->opaque = random_below(seed, 5) == 0 || is_mesh_named(s, "hills"); /* an open surface has no medium */
    s->priority = random_below(seed, 6) - 2;
    s->ior = indices[random_below(seed, 4)];
    s->transparency = random_below(seed, 3) ? 1.0 : random_real(seed, 0.2, 1.0);
    s->reflectivity = s->opaque && random_below(seed, 2) ? random_real(seed, 0.0, 1.0) : 0.0;
    s->specular = random_below(seed, 2) ? 0.5 : 0.0;
    s->checker = random_below(seed, 4) == 0 && !s->mesh ? random_real(seed, 0.1, 0.6) : 0.0;
    s->absorb_per_m = vec3_make(0.0, 0.0, 0.0);
    if (random_below(seed, 3) == 0)
        s->absorb_per_m = vec3_make(random_real(seed, 0.0, 0.8), 0.0, random_real(seed, 0.0, 0.8));
    if (!s->opaque)
        random_coat(s, w, seed);
}

static inline bool law_settings_have(const law_scene *w, const char *word)
{
    return strstr(w->settings, word) != NULL;
}

/* Metals, films, rough surfaces and media that scatter, where the settings allow them. A separate stream of numbers, so
 * that scenes stay as they are otherwise. */
static inline void random_layers(law_solid *s, const law_scene *w, uint64_t seed)
{
    uint64_t own = seed ^ 0x676f6c64u; /* "gold" */
    if (law_settings_have(w, "constant"))
        return;
    const bool polarised = law_settings_have(w, "polarisation"); /* in an rgb film: no metals, and no films */
    s->gold = s->opaque && !polarised && random_below(&own, 3) == 0;
    const bool coated = !polarised && random_below(&own, 3) == 0, without = law_settings_have(w, "basic") ||
                                                                            law_settings_have(w, "zbuffer") ||
                                                                            law_settings_have(w, "caustics");
    if (coated &&
        (s->opaque || !without)) /* basic radiance and the depth buffer do not support films on clear solids */
        s->film_nm = random_real(&own, 50.0, 900.0);
    s->roughness = random_below(&own, 3) == 0 && law_settings_have(w, "path") ? random_real(&own, 0.02, 0.8) : 0.0;
    if (!s->opaque && law_settings_have(w, "path") && random_below(&own, 3) == 0)
        s->scatter_per_m = random_real(&own, 0.1, 3.0), s->asymmetry = random_real(&own, -0.9, 0.9);
}

/* Some clear solids are uniaxial crystals, by a separate stream too. */
static inline void random_crystal(law_solid *s, uint64_t seed)
{
    uint64_t own = seed ^ 0x737061u; /* "spa" */
    if (s->opaque || s->reflectivity > 0.0 || s->film_nm > 0.0 || random_below(&own, 6) != 0)
        return;
    s->extraordinary_ior = s->ior * random_real(&own, 0.85, 1.15);
    s->optic_axis = random_direction(&own);
}

/* A meniscus on some round cylinders, by a separate stream too. A solid around another one has none: the walls between
 * two menisci are not uniform. */
static inline void random_meniscus(law_solid *s, uint64_t seed)
{
    uint64_t own = seed ^ 0x636170u; /* "cap" */
    solid_shape *shape = &s->shape;
    shape->capillary_length = 0.0;
    if (s->mesh || shape->kind != SHAPE_CYLINDER || random_below(&own, 3) != 0)
        return;
    solid_shape liquid = *shape;
    liquid.m = 1.0;
    liquid.capillary_length = shape->radius * exp(random_real(&own, -4.0, -0.5));
    liquid.contact_angle_deg = random_below(&own, 3) ? random_real(&own, 3.0, 88.0) : random_real(&own, 92.0, 177.0);
    liquid.contact_radius = random_below(&own, 2) ? 0.0 : shape->radius * random_real(&own, 0.7, 1.0);
    if (solid_shape_check(&liquid, NULL) == STATUS_OK) /* its surface is above the bottom */
        *shape = liquid;
}

/* Every other lens has aspheric sides, by a separate stream; its thickness stays. */
static inline void random_sides(solid_shape *shape, uint64_t seed)
{
    uint64_t own = seed ^ 0x617370u; /* "asp" */
    solid_shape lens = *shape;
    if (shape->kind != SHAPE_LENS || random_below(&own, 2))
        return;
    make_aspheric(&lens, &own);
    lens.thickness = shape->thickness;
    if (solid_shape_check(&lens, NULL) == STATUS_OK)
        *shape = lens;
}

static inline law_solid random_solid(const law_scene *w, int number, uint64_t *seed)
{
    law_solid s = {.number = number, .shape = random_shape(seed)};
    random_sides(&s.shape, *seed);
    double middle;
    const law_solid *base = w->solid_count ? &w->solid[random_below(seed, w->solid_count)] : NULL;
    const int relation = random_below(seed, 8);
    if (base && relation < 3 && flat_half(base, &middle) > 0.0)
        stack_on(&s, base, seed);
    else if (base && relation < 5 &&
             !is_mesh_named(base, "hills")) /* of two coincident open surfaces either may be visible */
        nest_in(&s, base, seed);
    else if (random_below(seed, 8) == 0)
        place_mesh(&s, seed);
    random_surface(&s, w, seed);
    random_layers(&s, w, *seed);
    random_meniscus(&s, *seed);
    random_crystal(&s, *seed);
    return s;
}

static inline bool is_sun(const law_light *l)
{
    return l->kind && strcmp(l->kind, "sun") == 0;
}

/* Suns, and lights with a size, which need a reach. */
static inline void random_lights(law_scene *w, uint64_t seed)
{
    static const char *const kinds[] = {NULL, "point", "disc", "rectangle"};
    uint64_t own = seed ^ 0x6c616d70u; /* "lamp" */
    for (int i = 0; i < w->light_count; i++) {
        law_light *l = &w->light[i];
        if (l->reach > 0.0)
            l->kind = kinds[random_below(&own, 4)];
        else
            l->kind = random_below(&own, 2) ? "sun" : NULL;
        l->size = random_real(&own, 0.1, 0.8);
        l->target = vec3_add(l->position, random_direction(&own));
    }
}

static inline void add_solid(law_scene *w, law_solid s)
{
    assert_true(w->solid_count < LAW_SOLIDS_MAX);
    w->material_order[w->solid_count] = w->solid_count;
    w->solid[w->solid_count++] = s;
}

static inline law_scene random_law_scene(uint64_t *seed, const char *settings)
{
    law_scene w = {
        .settings = settings, .sky = 1.0, .outside_ior = random_below(seed, 3) ? 1.0 : random_real(seed, 1.0, 2.0)};
    if (random_below(seed, 8) == 0)
        w.outside_absorb_per_m = vec3_make(0.1, 0.02, 0.0);
    w.light_count = random_below(seed, LAW_LIGHTS_MAX + 1);
    for (int i = 0; i < w.light_count; i++)
        w.light[i] = (law_light){.position = random_point(seed, 5.0), .reach = 2.0 * i};
    random_lights(&w, *seed);
    uint64_t own = *seed ^ 0x726f6c6cu; /* "roll": a separate stream, so that it changes nothing else in the scene */
    w.roll_deg = random_below(&own, 3) == 0 ? random_real(&own, -180.0, 180.0) : 0.0;
    const int count = 1 + random_below(seed, 9);
    for (int i = 0; i < count; i++)
        add_solid(&w, random_solid(&w, i, seed));
    const law_solid *within = &w.solid[random_below(seed, count)];
    const vec3 near = random_point(seed, 0.2);
    w.eye = random_below(seed, 4) ? random_point(seed, 3.0) : vec3_add(within->shape.position, near);
    w.target = random_point(seed, 0.5);
    for (int i = 0; i < count; i++) /* a camera in a crystal is refused */
        if (w.solid[i].mesh || solid_shape_contains(&w.solid[i].shape, w.eye))
            w.solid[i].extraordinary_ior = 0.0;
    return w;
}

static inline void add_vector(scene_text *t, const char *key, vec3 v)
{
    add(t, "%s: [%.17g, %.17g, %.17g], ", key, v.x, v.y, v.z);
}

static inline void write_material(scene_text *t, const law_solid *s)
{
    add(t, "  m%d: {", s->number);
    if (s->opaque)
        add(t, "%sambient: 0.2, diffuse: 0.5, color: [0.9, 0.5, 0.2], ", s->gold ? "medium: gold, " : "");
    else
        add(t, "ior: %.17g, transparency: %.17g, ", s->ior, s->transparency);
    if (s->tint.x < 1.0 && !s->opaque)
        add(t, "color: [%.17g, %.17g, %.17g], tint_distance: %.17g, ", s->tint.x, s->tint.y, s->tint.z,
            s->tint_distance);
    if (s->checker > 0.0)
        add(t, "checker: %.17g, checker_color: [0.1, 0.3, 0.9], ", s->checker);
    if (vec3_dot(s->absorb_per_m, s->absorb_per_m) > 0.0 && !s->opaque)
        add_vector(t, "absorb_per_m", s->absorb_per_m);
    if (s->film_nm > 0.0)
        add(t, "film_thickness_nm: %.17g, ", s->film_nm);
    if (s->roughness > 0.0)
        add(t, "roughness: %.17g, ", s->roughness);
    if (s->scatter_per_m > 0.0)
        add(t, "scatter_per_m: %.17g, asymmetry: %.17g, ", s->scatter_per_m, s->asymmetry);
    if (s->extraordinary_ior > 0.0) {
        add(t, "extraordinary_ior: %.17g, ", s->extraordinary_ior);
        add_vector(t, "optic_axis", s->optic_axis);
    }
    if (s->sheet) {
        add(t, "sheet: %s, retardance_deg: 77, ", s->sheet);
        add_vector(t, "sheet_axis", s->sheet_axis);
    }
    add(t, "reflectivity: %.17g, specular: %.17g, shininess: 20}\n", s->reflectivity, s->specular);
}

static inline void write_solid(scene_text *t, const law_solid *s, bool flat)
{
    add(t, "  s%d: {material: m%d, priority: %d, ", s->number, s->number, (int)s->priority);
    if (s->mesh) {
        add(t, "shape: mesh, mesh: %s, %s", s->mesh, flat ? "shading: flat, " : "");
        add_vector(t, "scale", s->shape.scale);
        add_vector(t, "position", s->shape.position);
        add_vector(t, "rotation", s->shape.rotation_deg);
        add_vector(t, "copies", s->shape.copies);
        add_vector(t, "spacing", s->shape.spacing);
    } else
        add_shape(t, &s->shape);
    add(t, "}\n");
}

static inline bool has_mesh(const law_scene *w, const char *name)
{
    for (int i = 0; i < w->solid_count; i++)
        if (is_mesh_named(&w->solid[i], name))
            return true;
    return false;
}

static inline void write_meshes(scene_text *t, const law_scene *w)
{
    bool any = false;
    for (size_t k = 0; k < COUNT(law_meshes); k++) {
        if (!has_mesh(w, law_meshes[k].name))
            continue;
        add(t, "%s  %s: %s\n", any ? "" : "meshes:\n", law_meshes[k].name, law_meshes[k].text);
        any = true;
    }
}

static inline void write_beam(scene_text *t, const law_beam *b)
{
    if (!b->kind)
        return;
    add(t, "beams:\n  beam: {kind: %s, profile: %s, lights: on, ", b->kind, b->profile);
    add_vector(t, "position", b->position);
    add_vector(t, "target", b->target);
    add(t, "angle_deg: %.17g, width: %.17g, power: 3}\n", b->angle_deg, b->width);
}

static inline scene_text law_text(const law_scene *w)
{
    scene_text t = {.length = 0};
    add(&t, "render: {width: %d, height: %d, %s}\n", LAW_WIDTH, LAW_HEIGHT, w->settings);
    add(&t, "background: {color: [%g, %g, %g], ambient: [1, 1, 1], ior: %.17g, ", 0.5 * w->sky, 0.75 * w->sky, w->sky,
        w->outside_ior);
    add_vector(&t, "absorb_per_m", w->outside_absorb_per_m);
    add(&t, "}\ncamera: {");
    add_vector(&t, "position", w->eye);
    add_vector(&t, "target", w->target);
    add(&t, "roll_deg: %.17g, fov_deg: 50}\n", w->roll_deg);
    for (int i = 0; i < w->light_count; i++) {
        add(&t, "%s  lamp%d: {", i ? "" : "lights:\n", i);
        add_vector(&t, "position", w->light[i].position);
        if (is_sun(&w->light[i])) {
            add(&t, "kind: sun, angular_diameter_deg: %.17g, ", 20.0 * w->light[i].size);
            add_vector(&t, "target", w->light[i].target);
        } else if (w->light[i].kind) {
            add(&t, "kind: %s, radius: %.17g, width: %.17g, height: %.17g, ", w->light[i].kind, w->light[i].size,
                w->light[i].size, 0.7 * w->light[i].size);
            add_vector(&t, "target", w->light[i].target);
        }
        if (w->light[i].polarised > 0.0)
            add(&t, "polarised: %.17g, polarisation_deg: %.17g, ", w->light[i].polarised, w->light[i].polarisation_deg);
        add(&t, "reach: %.17g}\n", w->light[i].reach);
    }
    write_beam(&t, &w->beam);
    write_meshes(&t, w);
    add(&t, "materials:\n");
    for (int i = 0; i < w->solid_count; i++)
        write_material(&t, &w->solid[w->material_order[i]]);
    add(&t, "solids:\n");
    for (int i = 0; i < w->solid_count; i++)
        write_solid(&t, &w->solid[i], w->flat);
    return t;
}

/* A sphere around a solid; infinite around a plane. */
typedef struct ball {
    vec3 middle;
    double radius;
} ball;

static inline ball ball_around(const law_solid *s)
{
    const solid_shape *shape = &s->shape;
    const double wide = shape->radius * fmax(1.0, 1.0 / shape->m);
    switch (shape->kind) {
    case SHAPE_SPHERE: return (ball){shape->position, shape->radius};
    case SHAPE_BOX: return (ball){shape->position, 0.5 * vec3_length(shape->size)};
    case SHAPE_PRISM:
    case SHAPE_CONE:
        return (ball){in_frame_of(shape, 0.0, 0.5 * shape->height, 0.0),
                      hypot(0.5 * shape->height, fmax(shape->radius, shape->top_radius))};
    case SHAPE_TORUS: return (ball){shape->position, shape->radius + shape->tube_radius};
    case SHAPE_LENS: /* no sag exceeds half the diameter */
        return (ball){in_frame_of(shape, 0.0, 0.5 * shape->thickness, 0.0), shape->diameter + shape->thickness};
    case SHAPE_CYLINDER: /* no meniscus rises by more than 1.5 capillary lengths */
        return (ball){in_frame_of(shape, 0.0, 0.5 * shape->height, 0.0),
                      hypot(0.5 * shape->height + 1.5 * shape->capillary_length, wide)};
    case SHAPE_CUP: return (ball){in_frame_of(shape, 0.0, 0.5 * shape->height, 0.0), hypot(0.5 * shape->height, wide)};
    case SHAPE_MESH: {
        const vec3 n = shape->copies, step = shape->spacing;
        const vec3 far = vec3_make((n.x - 1.0) * step.x, (n.y - 1.0) * step.y, (n.z - 1.0) * step.z);
        const vec3 half = vec3_scale(shape->scale, 0.5 * mesh_size(s));
        return (ball){shape->position, 1.01 * vec3_length(half) + vec3_length(far)};
    }
    case SHAPE_PLANE:
    case SHAPE_COUNT: break;
    }
    return (ball){shape->position, HUGE_VAL};
}

/* May two solids overlap or touch? False is always right. */
static inline bool may_touch(const law_solid *a, const law_solid *b)
{
    const ball p = ball_around(a), q = ball_around(b);
    return !(vec3_length(vec3_sub(p.middle, q.middle)) > 1.0001 * (p.radius + q.radius));
}
