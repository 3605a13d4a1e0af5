/* The photon map: a tree over photons in Morton order, eight to a leaf and eight children to a node. */
#include "render/caustics/photon_map.h"

#include "base/grow.h"
#include "base/large_pages.h"
#include "base/status.h"
#include "render/caustics/photon_tree.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

static_assert(sizeof(photon) == sizeof(vec3) + 8 * 4, "no padding: records are compared byte by byte");

bool photon_list_add(photon_list *l, const photon *one)
{
    if (!GROW(l->list, l->room, l->count + 1))
        return false;
    l->list[l->count++] = *one;
    return true;
}

/* --- order --- */

typedef struct photon_key {
    uint64_t code;
    const photon *of;
} photon_key;

/* The 21 bits of x at every third place (Morton, "A computer oriented geodetic data base", IBM, 1966). */
static uint64_t apart(uint64_t x)
{
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

static uint64_t cell(double x, double low, double step)
{
    const double c = (x - low) * step;
    return c < 0.0 ? 0 : c > 2097151.0 ? 2097151 : (uint64_t)c;
}

static uint64_t code_of(vec3 at, const photon_box *all)
{
    const double edge = fmax(all->high[0] - all->low[0], fmax(all->high[1] - all->low[1], all->high[2] - all->low[2])),
                 step = edge > 0.0 ? 2097151.0 / edge : 0.0;
    return apart(cell(at.x, all->low[0], step)) | apart(cell(at.y, all->low[1], step)) << 1 |
           apart(cell(at.z, all->low[2], step)) << 2;
}

/* A total order: photons that compare equal are the same. */
static int compare(const void *a, const void *b)
{
    const photon_key *x = a, *y = b;
    if (x->code != y->code)
        return x->code < y->code ? -1 : 1;
    return memcmp(x->of, y->of, sizeof(photon));
}

static size_t total(const photon_list *lists, size_t count)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += lists[i].count;
    return sum;
}

static photon_box box_of_lists(const photon_list *lists, size_t count)
{
    photon_box all = PHOTON_BOX_EMPTY;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < lists[i].count; k++)
            photon_box_add(&all, lists[i].list[k].position, 0.0);
    return all;
}

/* Writes the photons in order. */
static bool sort(const photon_list *lists, size_t count, photon *out)
{
    const size_t n = total(lists, count);
    photon_key *keys = malloc((n + 1) * sizeof *keys);
    if (!keys)
        return false;
    const photon_box all = box_of_lists(lists, count);
    size_t at = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < lists[i].count; k++)
            keys[at++] = (photon_key){code_of(lists[i].list[k].position, &all), &lists[i].list[k]};
    qsort(keys, n, sizeof *keys, compare);
    for (size_t i = 0; i < n; i++)
        out[i] = *keys[i].of;
    free(keys);
    return true;
}

status photon_map_create(const photon_list *lists, size_t count, photon_map **out, diagnostic *why)
{
    const size_t n = total(lists, count);
    photon_map *m = calloc(1, sizeof *m);
    *out = NULL;
    if (m) {
        m->count = n;
        m->photons = large_calloc(n + 1, sizeof *m->photons);
    }
    if (!m || !m->photons || !sort(lists, count, m->photons) || !photon_tree_make(m)) {
        photon_map_destroy(m);
        return out_of_memory(why);
    }
    photon_tree_fit(m);
    *out = m;
    return STATUS_OK;
}

void photon_map_destroy(photon_map *m)
{
    if (!m)
        return;
    for (int k = 0; k < m->levels; k++)
        free(m->level[k]);
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
    return 3 * sizeof(photon) + sizeof(photon_key) + sizeof(photon_box) / 7;
}

/* --- radii --- */

/* Photons of a leaf that are close to its middle one have the radius of that one. */
static void spread_leaf(photon_map *m, size_t first, size_t end, double widest)
{
    const size_t middle = (first + end) / 2;
    const photon *leader = &m->photons[middle];
    const double r = photon_tree_reach(m, middle, PHOTON_NEIGHBOURS, widest);
    for (size_t i = first; i < end; i++) {
        photon *one = &m->photons[i];
        const vec3 off = vec3_sub(one->position, leader->position);
        const bool close = vec3_dot(off, off) < 0.5 * r * r && photon_cosine(one, leader) >= PHOTON_FACING;
        one->radius = (float)(close ? r : photon_tree_reach(m, i, PHOTON_NEIGHBOURS, widest));
    }
}

void photon_map_spread(photon_map *m, size_t first, double widest)
{
    const size_t end = first + PHOTON_BLOCK < m->count ? first + PHOTON_BLOCK : m->count;
    for (size_t i = first; i < end; i += PHOTON_WIDE)
        spread_leaf(m, i, i + PHOTON_WIDE < end ? i + PHOTON_WIDE : end, widest);
}

void photon_map_finish(photon_map *m)
{
    photon_tree_fit(m);
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
    if (s->wavelength >= 0) {
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
