/* Paths of a ray in closed form, to compare with probe_path: through plane layers, and through coaxial cylinders or
 * concentric spheres. Ownership: values. */
#pragma once

#include "probe_fixture.h"

enum { CROSSINGS_MAX = 64 };

/* An interface: the point, the angle of incidence, the indices on both sides, and the direction of the refracted
 * ray. */
typedef struct crossing {
    vec3 point, direction;
    double angle_i, n_from, n_to;
} crossing;
typedef struct known_way {
    vec3 origin, direction;
    int count;
    crossing at[CROSSINGS_MAX];
} known_way;

/* The largest error of a path: of positions relative to `length`, of weights relative to themselves. */
static inline double way_error(const ray_tree *tree, const known_way *k, double length)
{
    double worst = 0.0, weight = 1.0;
    assert_int_equal((int)tree->count, k->count + 1);
    for (int j = 0; j < k->count; j++) {
        const crossing *c = &k->at[j];
        const ray_node *node = &tree->node[j], *next = &tree->node[j + 1];
        assert_int_equal(node->end, RAY_END_HIT);
        assert_int_equal(next->kind, RAY_REFRACT);
        const reflectance r = reflectance_of_angles(c->angle_i, c->n_from, c->n_to);
        weight *= 1.0 - r.mean;
        worst = fmax(worst, apart(node->hit.point, c->point) / length);
        worst = fmax(worst, apart(next->direction, c->direction));
        worst = fmax(worst, fabs(node->hit.cos_i - cos(c->angle_i)));
        worst = fmax(worst, fmax(fabs(node->hit.R_s - r.s), fabs(node->hit.R_p - r.p)));
        worst = fmax(worst, fabs(node->hit.n_from - c->n_from) + fabs(node->hit.n_to - c->n_to));
        for (int channel = 0; channel < 3; channel++)
            worst = fmax(worst, fabs(next->throughput[channel] / weight - 1.0));
    }
    assert_int_equal(tree->node[k->count].end, RAY_END_SKY);
    return worst;
}

/* --- plane layers --- */

/* Layers stacked downwards from y = 0 of a frame, in surroundings of index `outside`. */
typedef struct layers {
    int count;
    double outside, n[32], thickness[32];
} layers;

/* A ray that hits the top layer at the frame's origin at angle_i, towards +x: each layer displaces it by d tan(angle),
 * and n sin(angle) is invariant (Hecht, 4.4.1; Born and Wolf, Principles of Optics, 7th ed., 1.6). */
static inline known_way way_through_layers(const layers *l, double angle_i, vec3 position, vec3 rotation_deg)
{
    const double invariant = l->outside * sin(angle_i);
    known_way w = {.count = l->count + 1};
    w.direction = turned(vec3_make(sin(angle_i), -cos(angle_i), 0.0), rotation_deg);
    w.origin = vec3_sub(position, w.direction);
    double x = 0.0, y = 0.0, n_from = l->outside;
    for (int j = 0; j <= l->count; j++) {
        const double n_to = j < l->count ? l->n[j] : l->outside, sine = invariant / n_to,
                     cosine = sqrt(1.0 - sine * sine);
        w.at[j] = (crossing){.point = vec3_add(position, turned(vec3_make(x, y, 0.0), rotation_deg)),
                             .direction = turned(vec3_make(sine, -cosine, 0.0), rotation_deg),
                             .angle_i = asin(invariant / n_from),
                             .n_from = n_from,
                             .n_to = n_to};
        if (j < l->count)
            x += l->thickness[j] * sine / cosine, y -= l->thickness[j];
        n_from = n_to;
    }
    return w;
}

/* --- shells --- */

/* radius[0] is the outermost; n[0] the surroundings' index, n[k + 1] that inside radius[k]. */
typedef struct shells {
    int count;
    double radius[16], n[17];
} shells;

/* A ray towards +x of a rotated frame at z = offset, with slope d_y along the axis y: for cylinders about y, and with
 * d_y = 0 for spheres. Projected across the axis it is a plane ray in media of index sqrt(n^2 - (n_0 d_y)^2), because n
 * d_y is invariant (Bravais's law of oblique rays: Tricker, Introduction to Meteorological Optics, 1970, 4; Marcuse,
 * Applied Optics 13, 1974); there the index times the distance from the axis is invariant (Bouguer: Born and Wolf, 7th
 * ed., 3.2.1, eq. 7). */
static inline known_way way_through_shells(const shells *s, double offset, double d_y, vec3 position, vec3 rotation_deg)
{
    const int m = s->count;
    const double start = 2.0 * s->radius[0], rise = s->n[0] * d_y, across = sqrt(1.0 - d_y * d_y);
    double n[17];
    for (int k = 0; k <= m; k++)
        n[k] = sqrt(s->n[k] * s->n[k] - rise * rise);
    const double bouguer = n[0] * offset;
    known_way w = {.count = 2 * m};
    w.origin = vec3_add(position, turned(vec3_make(-start, 0.0, offset), rotation_deg));
    w.direction = turned(vec3_make(across, d_y, 0.0), rotation_deg);
    /* the polar angle, from x towards z, and the heading both decrease */
    double polar = acos(-1.0) - asin(offset / s->radius[0]), heading = 0.0;
    double y = (start - sqrt(s->radius[0] * s->radius[0] - offset * offset)) * rise / n[0];
    for (int j = 0; j < 2 * m; j++) {
        const bool inwards = j < m;
        const int from = inwards ? j : 2 * m - j, to = inwards ? j + 1 : from - 1, edge = inwards ? j : 2 * m - 1 - j;
        const double radius = s->radius[edge], angle_from = asin(bouguer / (n[from] * radius)),
                     angle_to = asin(bouguer / (n[to] * radius));
        heading -= inwards ? angle_from - angle_to : angle_to - angle_from;
        const double along = n[to] / s->n[to];
        w.at[j] = (crossing){
            .point = vec3_add(position, turned(vec3_make(radius * cos(polar), y, radius * sin(polar)), rotation_deg)),
            .direction = turned(vec3_make(along * cos(heading), rise / s->n[to], along * sin(heading)), rotation_deg),
            .angle_i = acos(n[from] / s->n[from] * cos(angle_from)),
            .n_from = s->n[from],
            .n_to = s->n[to]};
        if (j == 2 * m - 1)
            break;
        const double next = s->radius[j + 1 < m ? j + 1 : 2 * m - 2 - j], foot = bouguer / n[to];
        const double here = sqrt(radius * radius - foot * foot), there = sqrt(next * next - foot * foot);
        const bool innermost = to == m;
        polar -= innermost ? acos(-1.0) - 2.0 * angle_to
                 : inwards ? asin(foot / next) - angle_to
                           : angle_to - asin(foot / next);
        y += (innermost ? here + there : fabs(here - there)) * rise / n[to];
    }
    return w;
}
