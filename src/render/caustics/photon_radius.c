/* The radii of a photon map's discs, and photons that become one.
 *
 * A radius begins as the distance to the PHOTON_NEIGHBOURS-th neighbour. It is doubled as long as light within the
 * wider disc is even as far as its noise lets see, after Lepski's rule for the width of kernels (Theory of Probability
 * and its Applications 35, 1990): the largest whose result agrees with those of the narrower ones. */
#include "render/caustics/photon_even.h"
#include "render/caustics/photon_tree.h"

#include "base/cancel.h"

enum { DOUBLINGS = 2 };

/* Photons of one wavelength are few among many, and their light may be uneven where the sum is even. */
static double reach(const photon_map *m, size_t i, double widest)
{
    double r = photon_tree_reach(m, i, PHOTON_NEIGHBOURS, widest);
    for (int k = 0; k < DOUBLINGS && m->sums && 2.0 * r < widest && photon_sums_even(m->sums, m, i, 2.0 * r); k++)
        r *= 2.0;
    return r;
}

static double least_at(const photon_limits *limits, vec3 point)
{
    return limits->least + limits->least_at_1 * vec3_length(vec3_sub(point, limits->eye));
}

/* Photons of a leaf that are close to its middle one have the radius of that one. */
static void spread_leaf(photon_map *m, size_t first, size_t end, const photon_limits *limits)
{
    const size_t half = (first + end) / 2;
    const photon *leader = &m->photons[half];
    const double r = reach(m, half, limits->widest);
    for (size_t i = first; i < end; i++) {
        photon *one = &m->photons[i];
        const vec3 off = vec3_sub(one->position, leader->position);
        const bool close = vec3_dot(off, off) < 0.5 * r * r && photon_cosine(one, leader) >= PHOTON_FACING;
        const double own = close ? r : reach(m, i, limits->widest),
                     blurred = fmin(fmax(own, (double)one->radius), PHOTON_WIDER * own);
        one->radius = (float)fmax(blurred, least_at(limits, one->position));
    }
}

void photon_map_spread(photon_map *m, size_t first, const photon_limits *limits)
{
    const size_t end = first + PHOTON_BLOCK < m->count ? first + PHOTON_BLOCK : m->count;
    for (size_t i = first; i < end; i += PHOTON_WIDE)
        spread_leaf(m, i, i + PHOTON_WIDE < end ? i + PHOTON_WIDE : end, limits);
}

/* --- photons that become one --- */

/* The largest extent of photons that become one, as a share of their discs' radius, and that of their radii. */
#define MERGED_EXTENT 0.3
#define MERGED_RADII 1.1

static bool can_merge(const photon *list, int count)
{
    photon_box box = PHOTON_BOX_EMPTY;
    double least = (double)list->radius, most = least;
    for (int k = 0; k < count; k++) {
        if (list[k].wavelength != list->wavelength || photon_cosine(&list[k], list) < PHOTON_FACING)
            return false;
        photon_box_add(&box, list[k].position, 0.0);
        least = fmin(least, (double)list[k].radius), most = fmax(most, (double)list[k].radius);
    }
    double extent2 = 0.0;
    for (int a = 0; a < 3; a++)
        extent2 += (box.high[a] - box.low[a]) * (box.high[a] - box.low[a]);
    return most <= MERGED_RADII * least && extent2 <= MERGED_EXTENT * MERGED_EXTENT * least * least;
}

/* Their sum, at their centre of power. */
static photon merged(const photon *list, int count)
{
    photon sum = *list;
    double flux[3] = {0.0}, all = 0.0, radius = 0.0;
    vec3 off = {0.0, 0.0, 0.0};
    for (int k = 0; k < count; k++) {
        double power = 0.0;
        for (int c = 0; c < 3; c++)
            flux[c] += (double)list[k].flux[c], power += (double)list[k].flux[c];
        all += power, radius += (double)list[k].radius / count;
        off = vec3_add(off, vec3_scale(vec3_sub(list[k].position, list->position), power));
    }
    for (int c = 0; c < 3; c++)
        sum.flux[c] = (float)flux[c];
    if (all > 0.0)
        sum.position = vec3_add(list->position, vec3_scale(off, 1.0 / all));
    sum.radius = (float)radius;
    return sum;
}

/* Groups of eight, four or two neighbours in the map's order. False when cancelled. */
static bool merge(photon_map *m)
{
    size_t kept = 0;
    for (size_t i = 0, next; i < m->count; i = next) {
        if (cancel_asked_at(i))
            return false;
        int size = PHOTON_WIDE;
        while (size > 1 && (i % (size_t)size != 0 || i + (size_t)size > m->count || !can_merge(&m->photons[i], size)))
            size /= 2;
        next = i + (size_t)size;
        m->photons[kept++] = size > 1 ? merged(&m->photons[i], size) : m->photons[i];
    }
    m->count = kept;
    return true;
}

bool photon_map_finish(photon_map *m)
{
    size_t before;
    do {
        before = m->count;
        if (!merge(m))
            return false;
    } while (m->count < before - before / 8);
    photon_sums_free(m->sums);
    m->sums = NULL;
    photon_tree_count(m);
    return photon_tree_fit(m, true) && photon_groups_make(m);
}
