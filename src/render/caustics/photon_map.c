/* The photon map: a tree over photons in Morton order, eight to a leaf and eight children to a node. */
#include "render/caustics/photon_map.h"

#include "base/cancel.h"
#include "base/grow.h"
#include "base/large_pages.h"
#include "base/status.h"
#include "render/caustics/photon_even.h"
#include "render/caustics/photon_tree.h"
#include <stdlib.h>
#include <string.h>

bool photon_list_add(photon_list *l, const photon *one)
{
    if (!GROW(l->list, l->room, l->count + 1))
        return false;
    l->list[l->count++] = *one;
    return true;
}

static bool of_one_wavelength(const photon_map *m)
{
    for (size_t i = 1; i < m->count; i++)
        if (m->photons[i].wavelength != m->photons->wavelength)
            return false;
    return true;
}

status photon_map_create(const photon_list *lists, size_t count, photon_map **out, diagnostic *why)
{
    const size_t n = photon_lists_total(lists, count);
    photon_map *m = calloc(1, sizeof *m);
    *out = NULL;
    if (m) {
        m->count = n;
        m->photons = large_calloc(n + 1, sizeof *m->photons);
    }
    if (!m || !m->photons || !photon_order(lists, count, m->photons) || !photon_tree_make(m) ||
        !photon_tree_fit(m, false))
        goto failed;
    if (of_one_wavelength(m) && !(m->sums = photon_sums_make(m)))
        goto failed;
    *out = m;
    return STATUS_OK;
failed:
    photon_map_destroy(m);
    return cancelled_or_out_of_memory(why);
}

void photon_map_destroy(photon_map *m)
{
    if (!m)
        return;
    for (int k = 0; k < PHOTON_LEVELS_MAX; k++)
        free(m->level[k]);
    photon_sums_free(m->sums);
    free(m->photons);
    free(m);
}

size_t photon_map_count(const photon_map *m)
{
    return m->count;
}

const photon *photon_map_at(const photon_map *m, size_t i)
{
    return &m->photons[i];
}

/* A photon in a list, then in the map, with its key and its part of the tree. */
size_t photon_map_bytes(void)
{
    return 3 * sizeof(photon) + 2 * sizeof(void *) + (sizeof(photon_box) + photon_sums_bytes()) / 7;
}

/* --- irradiance --- */

/* Photons of a spectral map count for wavelengths up to this far from their own, 0.1 nm each. */
#define BAND 250.0
#define RANGE 4000.0 /* of wavelengths, over which the photons are spread evenly */

typedef struct irradiance_sum {
    vec3 point, normal, sum;
    int wavelength;
} irradiance_sum;

/* Adds a photon's share at the point. Its disc's weight is (3 / (pi r^2)) (1 - d^2 / r^2)^2, of integral 1 (biweight
 * kernel, Silverman, 4.2.1). Surfaces that turn away, and those in front or behind, are other surfaces. */
static void add(const photon *one, void *context)
{
    irradiance_sum *s = context;
    const vec3 off = vec3_sub(s->point, one->position),
               n = vec3_make((double)one->normal[0], (double)one->normal[1], (double)one->normal[2]);
    const double r = (double)one->radius, r2 = r * r, height = vec3_dot(off, n),
                 d2 = vec3_dot(off, off) - height * height;
    if (!(d2 < r2) || fabs(height) > 0.5 * r || vec3_dot(n, s->normal) < PHOTON_FACING)
        return;
    double share = 1.0 - d2 / r2;
    share = share * share * (3.0 / (PHOTON_PI * r2));
    if (s->wavelength >= 0 && one->wavelength < 0) {
        if (one->wavelength != photon_of_line(s->wavelength))
            return;
        share *= RANGE;
    } else if (s->wavelength >= 0) {
        const double away = fabs((double)(s->wavelength - one->wavelength)) / BAND;
        if (!(away < 1.0))
            return;
        share *= (1.0 - away) * (RANGE / BAND);
    }
    s->sum.x += share * (double)one->flux[0];
    s->sum.y += share * (double)one->flux[1];
    s->sum.z += share * (double)one->flux[2];
}

vec3 photon_map_irradiance(const photon_map *m, vec3 point, vec3 normal, int wavelength)
{
    irradiance_sum s = {point, normal, {0.0, 0.0, 0.0}, wavelength};
    photon_tree_around(m, point, add, &s);
    return s.sum;
}
