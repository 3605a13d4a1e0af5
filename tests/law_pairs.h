/* The laws: changes of a scene that must not be visible, each as a pair of scenes whose images are compared. Ownership:
 * values. */
#pragma once

#include "law_lamps.h"

typedef enum law {
    LAW_UNMET,    /* 1: a solid that no ray hits */
    LAW_ORDER,    /* 2: the order of declarations, and priorities of separate solids */
    LAW_SCALE,    /* 3: all lengths times a power of two */
    LAW_MOTION,   /* 3: translation, rotation, mirror */
    LAW_CUT,      /* 4: one solid, or two that touch */
    LAW_SAME,     /* 5: a solid of the surrounding medium */
    LAW_REVERSAL, /* 6: a path and its reverse */
    LAW_FILL,     /* 7: an empty gap, or one filled with the surrounding medium */
    LAW_COUNT
} law;

static const char *const law_names[] = {
    "1 a solid that no ray meets", "2 order and priorities",
    "3 scale by a power of two",   "3 translation, rotation, mirror",
    "4 a solid cut into two",      "5 the surroundings' medium",
    "6 a path reversed",           "7 a gap filled",
};

/* Each point p becomes turn p + shift; if mirrored, its x is negated first. */
typedef struct motion {
    bool mirrored;
    vec3 turn_deg, shift;
} motion;

typedef struct law_pair {
    law which;
    law_scene a, b;
    int exponent;  /* for LAW_SCALE */
    motion moved;  /* for LAW_MOTION */
    uint64_t seed; /* of the traced rays */
} law_pair;

static inline void insert_solid(law_scene *w, int at, law_solid s)
{
    add_solid(w, s);
    for (int i = w->solid_count - 1; i > at; i--)
        w->solid[i] = w->solid[i - 1];
    w->solid[at] = s;
}

static inline int lowest_priority(const law_scene *w)
{
    int lowest = 0;
    for (int i = 0; i < w->solid_count; i++)
        lowest = w->solid[i].priority < lowest ? (int)w->solid[i].priority : lowest;
    return lowest;
}

/* Far away, or small among the others, or inside one of them. */
static inline void add_unmet(law_scene *w, uint64_t *seed)
{
    law_solid s = {.number = LAW_ADDED, .shape = random_shape(seed)};
    if (random_below(seed, 5) == 0)
        place_mesh(&s, seed);
    if (s.shape.kind == SHAPE_PLANE)
        s.shape.kind = SHAPE_SPHERE;
    random_surface(&s, w, seed);
    s.priority = random_below(seed, 12) - 4;
    const bool far = random_below(seed, 3) != 0;
    const double power = far ? random_real(seed, 1.0, 5.9) : random_real(seed, -6.0, -3.0);
    const double distance = pow(10.0, power), largest = fmax(s.shape.scale.x, s.shape.scale.y),
                 expected = far ? fmin(0.002 * distance, pow(10.0, random_real(seed, -3.0, 3.0))) : distance,
                 size = fmin(expected, 1e6 / largest); /* the limit of a mesh's scale */
    s.shape.position = far ? vec3_scale(random_direction(seed), distance) : random_point(seed, 1.5);
    s.shape.radius *= size, s.shape.inner_radius *= size, s.shape.height *= size, s.shape.floor *= size;
    s.shape.tube_radius *= size, s.shape.top_radius *= size;
    s.shape.radius_1 *= size, s.shape.radius_2 *= size, s.shape.thickness *= size, s.shape.diameter *= size;
    for (int k = 0; k < 3; k++)
        s.shape.even_1[k] /= pow(size, 3 + 2 * k), s.shape.even_2[k] /= pow(size, 3 + 2 * k);
    s.shape.capillary_length *= size, s.shape.contact_radius *= size;
    s.shape.size = vec3_scale(s.shape.size, size);
    s.shape.scale = vec3_scale(s.shape.scale, size);
    s.shape.spacing = vec3_scale(s.shape.spacing, size);
    insert_solid(w, random_below(seed, w->solid_count + 1), s);
}

/* Does a come before b where they overlap, in ascending priority index? */
static inline bool has_lower_priority_index(const law_scene *w, int a, int b)
{
    return w->solid[a].priority != w->solid[b].priority ? w->solid[a].priority < w->solid[b].priority : a > b;
}

/* Keeps the order of solids that may touch: of all pairs, or only of pairs with equal priority. `order` is a random
 * order under this constraint. */
static inline void shuffle(const law_scene *w, bool all_pairs, uint64_t *seed, int *order)
{
    bool taken[LAW_SOLIDS_MAX] = {false};
    for (int k = 0; k < w->solid_count; k++) {
        int allowed[LAW_SOLIDS_MAX], count = 0;
        for (int i = 0; i < w->solid_count; i++) {
            bool first = !taken[i];
            for (int j = 0; j < w->solid_count; j++)
                if (j != i && !taken[j] && (all_pairs || w->solid[i].priority == w->solid[j].priority) &&
                    may_touch(&w->solid[i], &w->solid[j]))
                    first &= has_lower_priority_index(w, i, j);
            if (first)
                allowed[count++] = i;
        }
        order[k] = allowed[random_below(seed, count)];
        taken[order[k]] = true;
    }
}

static inline void permute(law_scene *w, uint64_t *seed)
{
    const law_scene old = *w;
    const bool new_priorities = random_below(seed, 2);
    int order[LAW_SOLIDS_MAX], place[LAW_SOLIDS_MAX];
    shuffle(&old, new_priorities, seed, order);
    for (int k = 0; k < w->solid_count;
         k++) /* ascending priority index: of equal priorities the last declared comes first */
        w->solid[w->solid_count - 1 - k] = old.solid[order[k]];
    int priority = -10;
    for (int k = 0; k < w->solid_count && new_priorities; k++)
        w->solid[w->solid_count - 1 - k].priority = priority += 1 + random_below(seed, 3);
    for (int i = 0; i < w->solid_count; i++)
        place[i] = i;
    for (int i = w->solid_count - 1; i > 0; i--) { /* Fisher and Yates */
        const int other = random_below(seed, i + 1), swap = place[i];
        place[i] = place[other], place[other] = swap;
    }
    memcpy(w->material_order, place, sizeof place);
    if (!new_priorities)
        return;
    const law_scene ranked = *w; /* priorities differ, so declarations may be in any order */
    for (int i = 0; i < w->solid_count; i++)
        w->solid[i] = ranked.solid[place[w->solid_count - 1 - i]];
}

static inline vec3 move_direction(const motion *m, vec3 v)
{
    return mat3_apply(rotation_from_deg(m->turn_deg), vec3_make(m->mirrored ? -v.x : v.x, v.y, v.z));
}

static inline vec3 move_point(const motion *m, vec3 v)
{
    return vec3_add(move_direction(m, v), m->shift);
}

/* The angles of a rotation R_z R_y R_x, about z, y and x; inexact if y is near 90 degrees. */
static inline vec3 angles_of(mat3 r)
{
    const double steep = hypot(r.row[2].y, r.row[2].z);
    return vec3_make(atan2(r.row[2].y, r.row[2].z) / DEGREE, atan2(-r.row[2].x, steep) / DEGREE,
                     atan2(r.row[1].x, r.row[0].x) / DEGREE);
}

static inline mat3 product(mat3 a, mat3 b)
{
    mat3 c;
    for (int i = 0; i < 3; i++)
        c.row[i] = mat3_apply_transposed(b, a.row[i]);
    return c;
}

/* false if the angles of a moved solid are not known accurately enough. */
static inline bool move_solid(const motion *m, solid_shape *s)
{
    s->position = move_point(m, s->position);
    if (m->mirrored) /* M R_z R_y R_x M, in a mirrored frame, which changes no shape */
        s->rotation_deg = vec3_make(s->rotation_deg.x, -s->rotation_deg.y, -s->rotation_deg.z);
    if (vec3_dot(m->turn_deg, m->turn_deg) == 0.0)
        return true;
    const mat3 both = product(rotation_from_deg(m->turn_deg), rotation_from_deg(s->rotation_deg));
    s->rotation_deg = angles_of(both);
    return hypot(both.row[2].y, both.row[2].z) > 0.05;
}

/* right and up of a camera without roll that looks along forward: right is level, up is perpendicular to both. */
static inline void level_frame(vec3 forward, vec3 *right, vec3 *up)
{
    *right = vec3_normalize(vec3_cross(vec3_make(0.0, 1.0, 0.0), forward));
    *up = vec3_cross(forward, *right);
}

/* The frame of the camera moves with the scene; its roll is the rotation from the level frame to it. In a mirrored
 * scene the image is mirrored too: the moved right is the camera's left. */
static inline void move_camera(law_scene *w, const motion *m)
{
    const double roll = w->roll_deg * DEGREE;
    vec3 right, up;
    level_frame(vec3_normalize(vec3_sub(w->target, w->eye)), &right, &up);
    const vec3 moved = move_direction(m, vec3_add(vec3_scale(right, sin(roll)), vec3_scale(up, cos(roll))));
    w->eye = move_point(m, w->eye);
    w->target = move_point(m, w->target);
    level_frame(vec3_normalize(vec3_sub(w->target, w->eye)), &right, &up);
    w->roll_deg = atan2(vec3_dot(moved, right), vec3_dot(moved, up)) / DEGREE;
}

static inline bool move_scene(law_scene *w, uint64_t *seed, motion *m)
{
    *m = (motion){.shift = random_point(seed, 2.0)};
    const int kind = random_below(seed, 3);
    m->mirrored = kind == 2;
    if (kind > 0)
        m->turn_deg = random_point(seed, 180.0);
    bool known = true;
    for (int i = 0; i < w->solid_count; i++) {
        law_solid *s = &w->solid[i];
        s->checker = 0.0; /* its cells are not mirrored, and have edges */
        if (m->mirrored)
            s->shape.spacing.x = -s->shape.spacing.x, s->optic_axis.x = -s->optic_axis.x;
        known &=
            move_solid(m, &s->shape) &&
            !(m->mirrored && (is_mesh_named(s, "ring") || is_mesh_named(s, "hills"))); /* quads have one diagonal */
    }
    for (int i = 0; i < w->light_count; i++) {
        w->light[i].position = move_point(m, w->light[i].position);
        w->light[i].target = move_point(m, w->light[i].target);
    }
    move_camera(w, m);
    return known;
}

static inline double *component(vec3 *v, int axis)
{
    return axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z;
}

static inline law_solid clear_box(const law_scene *w, int number, uint64_t *seed)
{
    law_solid s = {.number = number, .shape = random_shape(seed)};
    s.shape.kind = random_below(seed, 2) ? SHAPE_BOX : SHAPE_CYLINDER;
    do
        random_surface(&s, w, seed);
    while (s.opaque);
    s.checker = 0.0;
    return s;
}

/* Cuts a transparent box or cylinder of a, existing or put in the last solid's place, into two parts. */
static inline void cut(law_pair *p, uint64_t *seed)
{
    law_scene *w = &p->b;
    int at = random_below(seed, w->solid_count);
    law_solid *s = &p->a.solid[at];
    if (s->opaque || s->checker > 0.0 || (s->shape.kind != SHAPE_BOX && s->shape.kind != SHAPE_CYLINDER))
        *s = clear_box(w, s->number, seed);
    s->number = LAW_ADDED + 1; /* so that shrinking keeps it */
    s->reflectivity = 0.0;     /* where coated parts touch, their coating is visible, and so are films */
    s->film_nm = 0.0;
    s->shape.capillary_length = 0.0; /* the top of a part would curve too */
    w->solid[at] = *s;
    insert_solid(w, at + 1, *s);
    law_solid *first = &w->solid[at], *second = &w->solid[at + 1];
    second->number = LAW_ADDED;
    const double share = random_real(seed, 0.1, 0.9);
    if (s->shape.kind == SHAPE_CYLINDER) {
        first->shape.height = share * s->shape.height;
        second->shape.height = s->shape.height - first->shape.height;
        second->shape.position = in_frame_of(&s->shape, 0.0, first->shape.height, 0.0);
        return;
    }
    const int axis = random_below(seed, 3);
    const double whole = *component(&s->shape.size, axis), part = share * whole;
    vec3 offset[2] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    *component(&offset[0], axis) = 0.5 * (part - whole);
    *component(&offset[1], axis) = 0.5 * part;
    *component(&first->shape.size, axis) = part;
    *component(&second->shape.size, axis) = whole - part;
    first->shape.position = in_frame_of(&s->shape, offset[0].x, offset[0].y, offset[0].z);
    second->shape.position = in_frame_of(&s->shape, offset[1].x, offset[1].y, offset[1].z);
}

/* A lower bound of the distance to the nearest solid; negative inside one. */
static inline double room_around(const law_scene *w, vec3 at)
{
    double least = HUGE_VAL;
    for (int i = 0; i < w->solid_count; i++) {
        const law_solid *s = &w->solid[i];
        const ball around = ball_around(s);
        /* a lens's reference is no distance: it has only the sign of one */
        const bool exact = !s->mesh && s->shape.kind != SHAPE_LENS && s->shape.capillary_length == 0.0 &&
                           !((s->shape.kind == SHAPE_CYLINDER || s->shape.kind == SHAPE_CUP) && s->shape.m != 1.0);
        const double distance = exact ? (double)reference_distance(&s->shape, quad3_from(at))
                                      : vec3_length(vec3_sub(at, around.middle)) - around.radius;
        least = fmin(least, distance);
    }
    return least;
}

/* Surroundings absorb on paths to surfaces and lights, not to the sky, which is infinitely far
 * (background.absorb_per_m); a solid of the same medium absorbs on all. If the surroundings absorb, the sky is
 * therefore black. */
static inline double sky_of(const law_scene *w)
{
    return vec3_dot(w->outside_absorb_per_m, w->outside_absorb_per_m) > 0.0 ? 0.0 : w->sky;
}

/* Suns and sky, which are beyond what the surroundings absorb, are dark where these absorb: a solid of the same medium
 * absorbs their light. */
static inline void leave_what_is_absorbed(law_scene *w)
{
    w->sky = sky_of(w);
    for (int i = 0; i < w->light_count; i++)
        if (w->sky == 0.0 && is_sun(&w->light[i]))
            w->light[i].kind = NULL;
}

static inline law_solid of_the_surroundings(const law_scene *w, uint64_t *seed)
{
    law_solid s = {.number = LAW_ADDED, .shape = random_shape(seed)};
    random_surface(&s, w, seed);
    s.opaque = false;
    s.ior = w->outside_ior;
    s.absorb_per_m = w->outside_absorb_per_m;
    s.tint = vec3_make(1.0, 1.0, 1.0);
    s.reflectivity = s.checker = 0.0;
    return s;
}

/* false if there is no room for it. */
static inline bool add_same(law_scene *w, uint64_t *seed)
{
    law_solid s = of_the_surroundings(w, seed);
    vec3 best = {0.0, 0.0, 0.0};
    double space = 0.0;
    for (int k = 0; k < 400 && space < (k < 40 ? 0.4 : 0.02); k++) {
        const vec3 at = random_point(seed, k < 8 ? 1.0 : k < 100 ? 3.0 : k < 250 ? 12.0 : 2e4);
        const double around = room_around(w, at);
        if (around > space)
            best = at, space = around;
    }
    if (!(space > 1e-6))
        return false;
    const double r = (random_below(seed, 2) ? 1.0 : 0.9) * fmin(space, 2.0); /* it may touch */
    const int kind = random_below(seed, 4);
    if (kind == 3)
        do
            place_mesh(&s, seed);
        while (is_mesh_named(&s, "hills"));
    else
        s.shape.kind = kind == 0 ? SHAPE_SPHERE : kind == 1 ? SHAPE_BOX : SHAPE_CYLINDER;
    s.shape.position = best;
    s.shape.radius = s.shape.kind == SHAPE_SPHERE ? r : 0.5 * r;
    s.shape.height = 0.5 * r;
    s.shape.m = 1.0;
    s.shape.size = vec3_make(r, r, r);
    s.shape.scale = vec3_make(0.6 * r, 0.6 * r, 0.6 * r);
    s.shape.copies = vec3_make(1.0, 1.0, 1.0);
    insert_solid(w, random_below(seed, w->solid_count + 1), s);
    return true;
}

/* A solid with a flat top, a box above it at a gap, and in b a solid that fills the gap: flush with both, or
 * overlapping both. */
static inline void fill(law_pair *p, uint64_t *seed)
{
    law_scene *w = &p->a;
    const int at = random_below(seed, w->solid_count);
    double middle;
    if (!(flat_half(&w->solid[at], &middle) > 0.0))
        w->solid[at] = clear_box(w, w->solid[at].number, seed);
    law_solid *lower = &w->solid[at];
    lower->number = LAW_ADDED + 1;
    law_solid upper = clear_box(w, LAW_ADDED + 2, seed), filler = of_the_surroundings(w, seed);
    const double top = flat_half(lower, &middle) + middle, gap = pow(10.0, random_real(seed, -12.0, 0.0));
    const double overlap = random_below(seed, 2) ? 0.0 : 0.03;
    upper.shape.kind = filler.shape.kind = SHAPE_BOX;
    upper.shape.rotation_deg = filler.shape.rotation_deg = lower->shape.rotation_deg;
    upper.shape.position = in_frame_of(&lower->shape, 0.1, top + gap + 0.5 * upper.shape.size.y, 0.0);
    filler.shape.size.y = gap + 2.0 * overlap;
    filler.shape.position = in_frame_of(&lower->shape, 0.05, top + 0.5 * gap, 0.0);
    filler.priority = lowest_priority(w) - 4;
    filler.specular = lower->specular;
    filler.transparency = lower->opaque ? 1.0 : lower->transparency;
    insert_solid(w, random_below(seed, w->solid_count + 1), upper);
    leave_what_is_absorbed(w);
    p->b = *w;
    insert_solid(&p->b, p->b.solid_count, filler);
}

static const char *const all_settings[] = {
    "depth: 5",
    "depth: 5, beyond: black, polarisation: on",
    "depth: 4, weights: constant",
    "depth: 6, min_weight: 0.01, beyond: black",
    "depth: 3, shadows: opaque, samples: 4",
    "depth: 4, spectrum: spectral, wavelengths: 3",
    "integrator: raycast",
    "depth: 6, integrator: path, paths: 3",
    "integrator: zbuffer",
    "depth: 5, radiance: basic",
    "depth: 4, spectrum: spectral, wavelengths: 3, radiance: basic",
    "depth: 6, integrator: path, paths: 3, radiance: basic",
    "depth: 6, integrator: path, paths: 3, polarisation: on",
    "depth: 4, soft_shadows: on, samples: 4",
    "integrator: raycast, soft_shadows: on, samples: 4, spectrum: spectral, wavelengths: 2",
};

/* Photons start towards every solid that deflects light, in the order of priorities: one that no camera ray hits takes
 * some of them, and another order draws others. Only the scale leaves each of them as it is. */
static const char *const photon_settings[] = {
    "depth: 5, caustics: photons, photons: 500, soft_shadows: on, samples: 4",
    "depth: 5, caustics: photons, photons: 500, polarisation: on",
    "depth: 5, caustics: photons, photons: 500, spectrum: spectral, wavelengths: 2",
};

/* For surfaces that reflect only by Fresnel's equations: a crossing between equal media is no interface then. */
static const char *const fresnel_settings[] = {
    "depth: 5",
    "depth: 5, beyond: black, polarisation: on",
    "depth: 6, shadows: off",
    "depth: 3, shadows: opaque, samples: 4",
    "depth: 5, radiance: basic",
    "depth: 4, beyond: black, polarisation: on, radiance: basic",
};

/* Is there a large block? Gaps of 1e-12 near it are not resolved, or only from some positions, and 2^20 times as large
 * it exceeds MESH_FAR. */
static inline bool has_block(const law_scene *w)
{
    for (int i = 0; i < w->solid_count; i++)
        if (w->solid[i].mesh && w->solid[i].shape.scale.x > 2.0)
            return true;
    return false;
}

/* false if the law cannot be applied to such a scene. */
static inline bool law_pair_make(law which, uint64_t seed, int number, law_pair *p)
{
    const bool any = which == LAW_UNMET || which == LAW_ORDER || which == LAW_SCALE;
    const char *settings =
        any ? all_settings[number % (int)COUNT(all_settings)] : fresnel_settings[number % (int)COUNT(fresnel_settings)];
    if (which == LAW_SCALE && number % 8 == 0)
        settings = photon_settings[number / 8 % (int)COUNT(photon_settings)];
    if (which == LAW_MOTION && number % 8 == 0)
        settings = "integrator: raycast";
    if (which == LAW_REVERSAL)
        settings = "depth: 16";
    const bool without_blocks = which == LAW_MOTION || which == LAW_REVERSAL || which == LAW_SCALE;
    *p = (law_pair){.which = which};
    do
        p->a = random_law_scene(&seed, settings);
    while (without_blocks && has_block(&p->a));
    if (any)
        polarise(&p->a, seed), add_beam(&p->a, seed);
    for (int i = 0; i < p->a.solid_count && which == LAW_REVERSAL; i++) {
        p->a.solid[i].transparency = 1.0;
        p->a.solid[i].extraordinary_ior = 0.0; /* test_crystal reverses one */
        p->a.solid[i].film_nm = 0.0;           /* see test_multilayer: their rounding is larger than this law's bound */
    }
    p->a.flat =
        which == LAW_REVERSAL; /* interpolated normals do not belong to a surface: such a path cannot be reversed */
    p->b = p->a;
    p->seed = random_bits(&seed);
    switch (which) {
    case LAW_UNMET: add_unmet(&p->b, &seed); break;
    case LAW_ORDER: permute(&p->b, &seed); break;
    case LAW_SCALE: p->exponent = random_below(&seed, 41) - 20; break;
    case LAW_MOTION:
        for (int i = 0; i < p->a.solid_count; i++)
            p->a.solid[i].checker = 0.0;
        return move_scene(&p->b, &seed, &p->moved);
    case LAW_CUT: cut(p, &seed); break;
    case LAW_SAME:
        leave_what_is_absorbed(&p->a);
        p->b = p->a;
        return add_same(&p->b, &seed);
    case LAW_FILL: fill(p, &seed); break;
    case LAW_REVERSAL:
    case LAW_COUNT: break;
    }
    return true;
}
