/* A light path traced in both directions, for tests. Ownership as in probe_fixture.h. */
#pragma once

#include "probe_fixture.h"
#include "scene/model/scene.h"

/* A light path is the same in both directions (Hecht, 4.5: Fermat's principle and reversibility; 4.10: Stokes's
 * relations), and so is its share of power: R and T = n_t cos_t / (n_i cos_i) |t|^2 of an interface are the same from
 * either side. Radiance is not: it grows by (n_t / n_i)^2 on entering a medium, and L / n^2 is invariant (Nicodemus,
 * Applied Optics 2, 1963; Veach 1997, 5.2). The tracer's throughput is that of power: between an eye in a medium a and
 * a sky in a medium b it omits the factor (n_a / n_b)^2, which is 1 if both are in one medium. With the factor, the two
 * directions would differ by its square. */

/* Limits of the comparison. Reflections between curved surfaces form a billiard, where a rounding error grows with
 * every bounce (to 1e-7 after sixty), and near grazing incidence with the square of 1/cos. A reflectance close to zero
 * is a difference of almost equal numbers. */
static const double STEEP = 0.1;
enum { BOUNCES_MAX = 12 };
/* A displaced hit point rotates the normal and so changes the angles and the reflectances: relative change of
 * throughput per unit of length. */
static const double SWAY = 100.0;

static inline bool is_tame(const ray_tree *tree)
{
    if (tree->count > BOUNCES_MAX + 1)
        return false;
    for (size_t j = 0; j + 1 < tree->count; j++) {
        const ray_hit *h = &tree->node[j].hit;
        const double sine = h->n_from / h->n_to * sqrt(1.0 - h->cos_i * h->cos_i);
        if (h->cos_i < STEEP || (h->tir ? sine * sine - 1.0 < STEEP * STEEP : h->cos_t < STEEP))
            return false;
        if (tree->node[j + 1].kind == RAY_REFLECT && h->R < 1e-4)
            return false;
    }
    return tree->node[tree->count - 1].end == RAY_END_SKY;
}

/* The transmittance of power by Hecht's eqs. 4.61, 4.32 and 4.38, the mean of both polarisations, times the share that
 * a coating transmits; R for a reflection. */
static inline double share_of(const ray_hit *h, double coating, ray_kind next)
{
    const double a = h->n_from * h->cos_i, b = h->n_to * h->cos_t;
    const double t_s = 2.0 * a / (a + b), t_p = 2.0 * a / (h->n_to * h->cos_i + h->n_from * h->cos_t);
    const double T = h->tir ? 0.0 : 0.5 * b / a * (t_s * t_s + t_p * t_p) * (1.0 - coating);
    return next == RAY_REFRACT ? T : 1.0 - T;
}

/* The result for one path: whether it was usable, whether the reverse path hit the same surfaces, the largest distance
 * between the hit points of both, the difference of their throughputs beyond what that distance explains, and the
 * difference between the forward throughput and the closed form. */
typedef struct reversal {
    bool used, same_surfaces, reflected, other_media;
    int crossings;
    double farthest, unequal, from_closed_form, direction;
} reversal;

static inline double unequal_throughput(const ray_node *there, const ray_node *back, int n)
{
    double worst = 0.0;
    for (int c = 0; c < 3; c++) {
        /* the first segment of either path is not part of the other; absorption between is */
        const double forth = there[n].throughput[c] / there[0].hit.transmittance[c];
        const double other = back[n].throughput[c] / back[0].hit.transmittance[c];
        worst = fabs(forth / other - 1.0) <= worst ? worst : fabs(forth / other - 1.0); /* also true for NaN */
    }
    return worst;
}

/* Traces one path, and its reverse from 3 units beyond its last interface. */
static inline reversal there_and_back(stage *g, vec3 origin, vec3 direction, int reflect_at)
{
    reversal r = {.used = false};
    const ray_tree *path = stage_way(g, origin, direction, reflect_at);
    const int n = (int)path->count - 1;
    if (n == 0 || !is_tame(path))
        return r;
    ray_node there[BOUNCES_MAX + 1];
    memcpy(there, path->node, (size_t)(n + 1) * sizeof *there);
    const ray_node *last = &there[n];
    r = (reversal){.used = true, .same_surfaces = true, .crossings = n, .other_media = there[0].n != last->n};
    r.reflected = reflect_at >= 0 && reflect_at < n &&
                  there[reflect_at + 1].kind == RAY_REFLECT; /* equal indices reflect nothing */
    const vec3 end = vec3_add(last->origin, vec3_scale(last->direction, 3.0));
    path = stage_way(g, end, vec3_scale(last->direction, -1.0), r.reflected ? n - 1 - reflect_at : -1);
    r.same_surfaces = (int)path->count > n;
    double known = 1.0, transmittance = 1.0;
    for (int j = 0; j < n && r.same_surfaces; j++) {
        const ray_hit *h = &there[j].hit, *same = &path->node[n - 1 - j].hit;
        r.farthest = fmax(r.farthest, apart(h->point, same->point));
        r.same_surfaces = h->face_solid == same->face_solid && there[j + 1].kind == path->node[n - j].kind;
        known *= share_of(h, g->setting->solids[h->solid].surface.reflectivity, there[j + 1].kind);
        transmittance *= h->transmittance[1];
    }
    if (!r.same_surfaces)
        return r;
    r.unequal = unequal_throughput(there, path->node, n) - SWAY * r.farthest;
    r.from_closed_form = fabs(there[n].throughput[1] / (transmittance * known) - 1.0);
    r.direction = apart(path->node[n].direction, vec3_scale(there[0].direction, -1.0));
    return r;
}
