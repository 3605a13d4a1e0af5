/* The test whether light is even in a disc. Where n photons are spread evenly over a disc of radius R, their mean
 * offset from its centre has a standard deviation of R / (2 sqrt n) in each direction, and the squared distance over
 * R^2 has the mean 1/2, with a standard deviation of 1 / sqrt(12 n). Edges, lines and peaks of light differ by more. */
#include "render/caustics/photon_even.h"

#include "base/cancel.h"
#include "render/caustics/photon_tree.h"
#include <stdlib.h>

/* How many standard deviations off is still even. */
#define AGREES 4.0
/* The least cosine of normals in a box that is summed up whole. */
#define FLAT 0.9999

/* Sums over photons by channel: of power, its square, its offsets from a point, and its squared distances. */
typedef struct moments {
    float power[3], power2[3], offset[3][3], distance2[3];
    bool flat; /* all photons of the box face as the first one, and the sums hold, with offsets from that one */
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

/* Moments about `origin`, moved to `from`. */
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
    const moments *whole = &s->sums->level[level][box];
    const vec3 from = s->from->position;
    if (!(photon_box_distance2(b, from) < s->radius2))
        return;
    if (whole->flat && farthest2(b, from) < s->radius2) {
        const photon *first = first_of(m, level, box);
        if (photon_cosine(first, s->from) >= PHOTON_FACING)
            add_moments(&s->sum, whole, first->position, from);
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

bool photon_sums_even(const photon_sums *sums, const photon_map *m, size_t i, double radius)
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
