/* The radii of a photon map's discs, and the merging of photons.
 *
 * A radius begins as the distance to the PHOTON_NEIGHBOURS-th neighbour. It is doubled while light within the wider
 * disc is uniform within its noise, after Lepski's rule for the width of kernels (Theory of Probability and its
 * Applications 35, 1990): the largest width whose estimate agrees with the estimates of all smaller widths. */
#include "render/photons/photon_map.h"

#include "base/cancel.h"
#include <stdlib.h>

/* --- whether light is uniform in a disc --- */

/* If n photons are distributed uniformly over a disc of radius R, their mean offset from its centre has a standard
 * deviation of R / (2 sqrt n) in each direction, and the squared distance over R^2 has the mean 1/2, with a standard
 * deviation of 1 / sqrt(12 n). Edges, lines and peaks of light differ by more. */

/* The number of standard deviations within which light counts as uniform. */
#define AGREES 4.0
/* The least cosine between normals of a box whose sums are used. */
#define FLAT 0.9999

/* Sums over photons by channel: power, its square, and power times the offset from a point and times the squared
 * distance. */
typedef struct moments {
    float power[3], power2[3], offset[3][3], distance2[3];
    bool flat; /* all photons of the box face like the first one, and the sums are valid, with offsets from it */
} moments;

struct photon_sums {
    moments *level[PHOTON_LEVELS_MAX];
};

typedef struct moment_sum {
    double power[3], power2[3], distance2[3];
    vec3 offset[3];
} moment_sum;

static void add_photon(moment_sum *s, const photon *one, vec3 from)
{
    const vec3 off = vec3_sub(one->position, from);
    const double d2 = vec3_dot(off, off);
    for (int c = 0; c < 3; c++) {
        const double w = (double)one->flux[c];
        s->power[c] += w, s->power2[c] += w * w, s->distance2[c] += w * d2;
        s->offset[c] = vec3_add(s->offset[c], vec3_scale(off, w));
    }
}

/* Adds moments about `origin`, converted to moments about `from`. */
static void add_moments(moment_sum *s, const moments *b, vec3 origin, vec3 from)
{
    const vec3 move = vec3_sub(origin, from);
    for (int c = 0; c < 3; c++) {
        const double w = (double)b->power[c];
        const vec3 off = vec3_make((double)b->offset[c][0], (double)b->offset[c][1], (double)b->offset[c][2]);
        s->power[c] += w, s->power2[c] += (double)b->power2[c];
        s->distance2[c] += (double)b->distance2[c] + 2.0 * vec3_dot(off, move) + w * vec3_dot(move, move);
        s->offset[c] = vec3_add(s->offset[c], vec3_add(off, vec3_scale(move, w)));
    }
}

static const photon *first_of(const photon_map *m, int level, size_t box)
{
    size_t i = box;
    for (int k = 0; k <= level; k++)
        i *= PHOTON_WIDE;
    return &m->photons[i];
}

static moments moments_of(const photon_sums *s, const photon_map *m, int level, size_t box)
{
    const photon *first = first_of(m, level, box);
    moment_sum sum = {{0.0}, {0.0}, {0.0}, {{0.0, 0.0, 0.0}}};
    moments out = {.flat = true};
    const size_t end = photon_box_end(m, level, box);
    for (size_t i = photon_box_first(box); i < end; i++) {
        const photon *one = level == 0 ? &m->photons[i] : first_of(m, level - 1, i);
        out.flat &= photon_cosine(one, first) >= FLAT && (level == 0 || s->level[level - 1][i].flat);
        if (level == 0)
            add_photon(&sum, one, first->position);
        else
            add_moments(&sum, &s->level[level - 1][i], one->position, first->position);
    }
    for (int c = 0; c < 3; c++) {
        out.power[c] = (float)sum.power[c], out.power2[c] = (float)sum.power2[c];
        out.distance2[c] = (float)sum.distance2[c];
        out.offset[c][0] = (float)sum.offset[c].x, out.offset[c][1] = (float)sum.offset[c].y;
        out.offset[c][2] = (float)sum.offset[c].z;
    }
    return out;
}

photon_sums *photon_sums_make(const photon_map *m)
{
    photon_sums *s = calloc(1, sizeof *s);
    for (int k = 0; s && k < m->levels; k++) {
        bool done = (s->level[k] = malloc(m->boxes[k] * sizeof(moments))) != NULL;
        for (size_t b = 0; done && b < m->boxes[k]; b++) {
            s->level[k][b] = moments_of(s, m, k, b);
            done = !cancel_asked_at(b);
        }
        if (!done) {
            photon_sums_free(s);
            return NULL;
        }
    }
    return s;
}

void photon_sums_free(photon_sums *s)
{
    for (int k = 0; s && k < PHOTON_LEVELS_MAX; k++)
        free(s->level[k]);
    free(s);
}

size_t photon_sums_bytes(void)
{
    return sizeof(moments);
}

typedef struct search {
    const photon_sums *sums;
    const photon_map *map;
    const photon *from;
    double radius2;
    moment_sum sum;
} search;

/* The square of the distance to the farthest corner of a box. */
static double farthest2(const photon_box *b, vec3 at)
{
    const double p[3] = {at.x, at.y, at.z};
    double sum = 0.0;
    for (int a = 0; a < 3; a++) {
        const double off = fmax(p[a] - b->low[a], b->high[a] - p[a]);
        sum += off * off;
    }
    return sum;
}

static void sum_box(search *s, int level, size_t box)
{
    const photon_map *m = s->map;
    const photon_box *b = &m->level[level][box];
    const moments *box_sums = &s->sums->level[level][box];
    const vec3 from = s->from->position;
    if (!(photon_box_distance2(b, from) < s->radius2))
        return;
    if (box_sums->flat && farthest2(b, from) < s->radius2) {
        const photon *first = first_of(m, level, box);
        if (photon_cosine(first, s->from) >= PHOTON_FACING)
            add_moments(&s->sum, box_sums, first->position, from);
        return;
    }
    const size_t end = photon_box_end(m, level, box);
    for (size_t i = photon_box_first(box); i < end; i++) {
        if (level > 0) {
            sum_box(s, level - 1, i);
            continue;
        }
        const vec3 off = vec3_sub(m->photons[i].position, from);
        if (vec3_dot(off, off) < s->radius2 && photon_cosine(s->from, &m->photons[i]) >= PHOTON_FACING)
            add_photon(&s->sum, &m->photons[i], from);
    }
}

/* Whether light within that distance of photon i, on the same surface, is uniform within its noise. */
static bool light_is_uniform(const photon_sums *sums, const photon_map *m, size_t i, double radius)
{
    search s = {sums, m, &m->photons[i], radius * radius, {{0.0}, {0.0}, {0.0}, {{0.0, 0.0, 0.0}}}};
    sum_box(&s, m->levels - 1, 0);
    for (int c = 0; c < 3; c++) {
        const double power = s.sum.power[c];
        if (!(power > 0.0))
            continue;
        /* 1 / n for photons of unequal power (Kish, Survey Sampling, 1965, 11.7) */
        const double variance = s.sum.power2[c] / (power * power),
                     mean = s.sum.distance2[c] / (power * s.radius2) - 0.5,
                     off2 = vec3_dot(s.sum.offset[c], s.sum.offset[c]) / (power * power * s.radius2);
        if (off2 > AGREES * AGREES / 2.0 * variance || mean * mean > AGREES * AGREES / 12.0 * variance)
            return false;
    }
    return true;
}

/* --- radii --- */

enum { DOUBLINGS = 2 };

/* The radius before blur and limits. It is not doubled for photons of several wavelengths (sums is NULL): photons of
 * one wavelength are few, and their light may vary where the sum is uniform. */
static double reach(const photon_map *m, size_t i, double widest)
{
    double r = photon_tree_reach(m, i, PHOTON_NEIGHBOURS, widest);
    for (int k = 0; k < DOUBLINGS && m->sums && 2.0 * r < widest && light_is_uniform(m->sums, m, i, 2.0 * r); k++)
        r *= 2.0;
    return r;
}

static double least_at(const photon_limits *limits, vec3 point)
{
    return limits->least + limits->least_at_1 * vec3_length(vec3_sub(point, limits->eye));
}

/* Photons of a leaf that are close to its middle photon have that photon's radius. */
static void spread_leaf(photon_map *m, size_t first, size_t end, const photon_limits *limits)
{
    const size_t half = (first + end) / 2;
    const photon *leader = &m->photons[half];
    const double r = reach(m, half, limits->widest);
    for (size_t i = first; i < end; i++) {
        photon *one = &m->photons[i];
        const vec3 off = vec3_sub(one->position, leader->position);
        const bool close = vec3_dot(off, off) < 0.5 * r * r && photon_cosine(one, leader) >= PHOTON_FACING;
        const double reach_here = close ? r : reach(m, i, limits->widest),
                     blurred = fmin(fmax(reach_here, (double)one->radius), PHOTON_WIDER * reach_here);
        one->radius = (float)fmax(blurred, least_at(limits, one->position));
    }
}

void photon_map_spread(photon_map *m, size_t first, const photon_limits *limits)
{
    const size_t end = first + PHOTON_BLOCK < m->count ? first + PHOTON_BLOCK : m->count;
    for (size_t i = first; i < end; i += PHOTON_WIDE)
        spread_leaf(m, i, i + PHOTON_WIDE < end ? i + PHOTON_WIDE : end, limits);
}

/* --- merging photons --- */

/* Limits of merging: the photons' extent as a fraction of their discs' radius, and the ratio of their radii. */
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

/* The sum of photons, at their centre of power. */
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

/* Merges groups of eight, four or two neighbours in the map's order. False when cancelled. */
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
