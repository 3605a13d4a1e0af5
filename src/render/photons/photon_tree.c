/* The tree of a photon map: boxes, groups, and searches in it. */
#include "render/photons/photon_map.h"

#include "base/cancel.h"
#include <stdlib.h>

void photon_box_add(photon_box *b, vec3 at, double radius)
{
    const double p[3] = {at.x, at.y, at.z};
    for (int a = 0; a < 3; a++) {
        b->low[a] = p[a] - radius < b->low[a] ? p[a] - radius : b->low[a];
        b->high[a] = p[a] + radius > b->high[a] ? p[a] + radius : b->high[a];
    }
}

static void add_box(photon_box *b, const photon_box *other)
{
    for (int a = 0; a < 3; a++) {
        b->low[a] = other->low[a] < b->low[a] ? other->low[a] : b->low[a];
        b->high[a] = other->high[a] > b->high[a] ? other->high[a] : b->high[a];
    }
}

void photon_tree_count(photon_map *m)
{
    m->levels = 0;
    for (size_t below = m->count; below > 0;) {
        const size_t boxes = (below + PHOTON_WIDE - 1) / PHOTON_WIDE;
        m->boxes[m->levels++] = boxes;
        below = boxes > 1 ? boxes : 0;
    }
}

bool photon_tree_make(photon_map *m)
{
    photon_tree_count(m);
    for (int k = 0; k < m->levels; k++)
        if (!(m->level[k] = malloc(m->boxes[k] * sizeof(photon_box))))
            return false;
    return true;
}

bool photon_tree_fit(photon_map *m, bool discs)
{
    for (int k = 0; k < m->levels; k++) {
        for (size_t b = 0; b < m->boxes[k]; b++) {
            if (cancel_asked_at(b))
                return false;
            photon_box box = PHOTON_BOX_EMPTY;
            for (size_t i = photon_box_first(b); i < photon_box_end(m, k, b); i++)
                if (k == 0)
                    photon_box_add(&box, m->photons[i].position, discs ? (double)m->photons[i].radius : 0.0);
                else
                    add_box(&box, &m->level[k - 1][i]);
            m->level[k][b] = box;
        }
    }
    return true;
}

double photon_box_distance2(const photon_box *b, vec3 at)
{
    const double p[3] = {at.x, at.y, at.z};
    double sum = 0.0;
    for (int a = 0; a < 3; a++) {
        const double under = b->low[a] - p[a], over = p[a] - b->high[a];
        const double off = under > over ? under : over;
        sum += off > 0.0 ? off * off : 0.0;
    }
    return sum;
}

/* --- groups --- */

/* Photons that are close together in a sample's cell of the image are evaluated as one, so that a cell with thousands
 * costs much less (lightcuts do so for lamps: Walter and others, SIGGRAPH 2005). A group has the flux, centre and
 * variance of its photons. A disc of radius r has the variance r^2 / 8 in each direction, and a photon at a distance d
 * from the centre adds d^2 / 2. */

/* The least cosine between normals of a group. */
#define FLAT 0.98

static double power_of(const photon *one)
{
    return (double)one->flux[0] + (double)one->flux[1] + (double)one->flux[2];
}

static bool are_a_group(const photon_group *list, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (!(list[k].one.radius > 0.0F) || list[k].one.wavelength != list->one.wavelength ||
            photon_cosine(&list[k].one, &list->one) < FLAT)
            return false;
    return true;
}

static photon_group joined(const photon_group *list, size_t count)
{
    photon_group sum = list[0];
    double flux[3] = {0.0, 0.0, 0.0}, all = 0.0, disc2 = 0.0, spread2 = 0.0;
    vec3 off = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < count; k++) {
        const photon *one = &list[k].one;
        const double power = power_of(one);
        const vec3 from_first = vec3_sub(one->position, list->one.position);
        all += power, disc2 += power * (double)list[k].disc2;
        off = vec3_add(off, vec3_scale(from_first, power));
        spread2 += power * ((double)list[k].spread2 + vec3_dot(from_first, from_first));
        for (int c = 0; c < 3; c++)
            flux[c] += (double)one->flux[c];
    }
    sum.one.radius = 0.0F;
    if (!(all > 0.0) || !are_a_group(list, count))
        return sum;
    off = vec3_scale(off, 1.0 / all);
    sum.one.position = vec3_add(list->one.position, off);
    sum.disc2 = (float)(disc2 / all);
    sum.spread2 = (float)fmax(spread2 / all - vec3_dot(off, off), 0.0);
    sum.one.radius = sqrtf(sum.disc2 + 4.0F * sum.spread2);
    for (int c = 0; c < 3; c++)
        sum.one.flux[c] = (float)flux[c];
    return sum;
}

static photon_group group_of(const photon_map *m, int level, size_t box)
{
    photon_group children[PHOTON_WIDE] = {{{{0.0, 0.0, 0.0}, {0.0F}, {0.0F}, 0.0F, 0}, 0.0F, 0.0F}};
    const size_t first = photon_box_first(box), count = photon_box_end(m, level, box) - first;
    for (size_t k = 0; k < count; k++) {
        const photon *one = &m->photons[level > 0 ? 0 : first + k];
        children[k] =
            level > 0 ? m->group[level - 1][first + k] : (photon_group){*one, one->radius * one->radius, 0.0F};
    }
    return joined(children, count);
}

bool photon_groups_make(photon_map *m)
{
    for (int k = 0; k < m->levels; k++) {
        if (!(m->group[k] = calloc(m->boxes[k], sizeof(photon_group))))
            return false;
        for (size_t b = 0; b < m->boxes[k]; b++) {
            if (cancel_asked_at(b))
                return false;
            m->group[k][b] = group_of(m, k, b);
        }
    }
    return true;
}

/* --- the nearest neighbours --- */

enum { NEIGHBOURS_MAX = 128 };
/* The least radius as a fraction of the widest, since many photons may meet in one point. */
#define LEAST_DISC 1e-4

/* The k least squared distances so far, as a heap with the largest first. */
typedef struct nearest {
    const photon_map *map;
    const photon *from;
    int k, count;
    double limit2, heap[NEIGHBOURS_MAX];
} nearest;

static void sift_down(nearest *s)
{
    int at = 0;
    const double value = s->heap[0];
    for (int child = 1; child < s->count; child = 2 * at + 1) {
        if (child + 1 < s->count && s->heap[child + 1] > s->heap[child])
            child++;
        if (s->heap[child] <= value)
            break;
        s->heap[at] = s->heap[child], at = child;
    }
    s->heap[at] = value;
}

static void sift_up(nearest *s, double value)
{
    int at = s->count++;
    for (; at > 0 && s->heap[(at - 1) / 2] < value; at = (at - 1) / 2)
        s->heap[at] = s->heap[(at - 1) / 2];
    s->heap[at] = value;
}

static void consider(nearest *s, const photon *other)
{
    const vec3 off = vec3_sub(other->position, s->from->position);
    const double d2 = vec3_dot(off, off);
    if (!(d2 < s->limit2))
        return;
    if (photon_cosine(s->from, other) < PHOTON_FACING)
        return;
    if (s->count < s->k)
        sift_up(s, d2);
    else
        s->heap[0] = d2, sift_down(s);
    if (s->count == s->k)
        s->limit2 = s->heap[0];
}

static void search(nearest *s, int level, size_t box)
{
    const photon_map *m = s->map;
    const size_t end = photon_box_end(m, level, box);
    for (size_t i = photon_box_first(box); i < end; i++)
        if (level == 0)
            consider(s, &m->photons[i]);
        else if (photon_box_distance2(&m->level[level - 1][i], s->from->position) < s->limit2)
            search(s, level - 1, i);
}

/* The search starts with the photon's leaf, and continues in each larger box with the boxes not yet searched. */
double photon_tree_reach(const photon_map *m, size_t i, int k, double widest)
{
    nearest s = {m, &m->photons[i], k + 1, 0, widest * widest, {0.0}}; /* the photon itself is the first */
    size_t box = i / PHOTON_WIDE;
    search(&s, 0, box);
    for (int level = 1; level < m->levels; level++) {
        const size_t done = box;
        box /= PHOTON_WIDE;
        for (size_t b = photon_box_first(box); b < photon_box_end(m, level, box); b++)
            if (b != done && photon_box_distance2(&m->level[level - 1][b], s.from->position) < s.limit2)
                search(&s, level - 1, b);
    }
    const double reach = sqrt(s.limit2);
    return reach > LEAST_DISC * widest ? reach : LEAST_DISC * widest;
}

/* --- the discs around a point --- */

typedef struct visit_around {
    const photon_map *map;
    vec3 point, low, high;     /* boxes that end before low, or begin after high, are too far away */
    const photon_reach *reach; /* or NULL */
    photon_visit *visit;
    void *context;
} visit_around;

static double extent_along(const photon_box *b, vec3 d)
{
    return fabs(d.x) * (b->high[0] - b->low[0]) + fabs(d.y) * (b->high[1] - b->low[1]) +
           fabs(d.z) * (b->high[2] - b->low[2]);
}

static bool is_near(const photon_box *b, const visit_around *v)
{
    return (int)(v->high.x >= b->low[0]) & (int)(v->low.x <= b->high[0]) & (int)(v->high.y >= b->low[1]) &
           (int)(v->low.y <= b->high[1]) & (int)(v->high.z >= b->low[2]) & (int)(v->low.z <= b->high[2]);
}

/* Whether the box, which holds its discs entirely, meets the reach. */
static bool is_in_cell(const photon_box *b, const visit_around *v)
{
    const photon_reach *reach = v->reach;
    const vec3 off = {b->low[0] + b->high[0] - 2.0 * v->point.x, b->low[1] + b->high[1] - 2.0 * v->point.y,
                      b->low[2] + b->high[2] - 2.0 * v->point.z};
    for (int k = 0; k < REACH_SLABS; k++)
        if (fabs(vec3_dot(off, reach->slab[k])) > 2.0 * reach->within[k] + extent_along(b, reach->slab[k]))
            return false;
    return true;
}

/* Whether the photons of a box are close enough, in cells of the sample, to be evaluated as one. */
static bool is_one_group(const visit_around *v, int level, size_t box)
{
    const photon_group *g = &v->map->group[level][box];
    if (!(g->one.radius > 0.0F))
        return false;
    bool all = true;
    for (int k = 0; k < REACH_HEIGHT; k++) {
        const double per_unit2 = v->reach->length[k] * v->reach->length[k];
        all &= (double)g->spread2 * per_unit2 <= PHOTON_ONE * (1.0 + (double)g->disc2 * per_unit2);
    }
    return all;
}

static void visit_box(const visit_around *v, int level, size_t box)
{
    const photon_map *m = v->map;
    const photon_box *b = &m->level[level][box];
    if (!is_near(b, v) || (v->reach && !is_in_cell(b, v)))
        return;
    if (v->reach && v->reach->groups && is_one_group(v, level, box)) {
        v->visit(&m->group[level][box].one, sqrt((double)m->group[level][box].disc2), v->context);
        return;
    }
    const size_t end = photon_box_end(m, level, box);
    for (size_t i = photon_box_first(box); i < end; i++)
        if (level == 0)
            v->visit(&m->photons[i], (double)m->photons[i].radius, v->context);
        else
            visit_box(v, level - 1, i);
}

void photon_tree_around(const photon_map *m, vec3 point, const photon_reach *reach, photon_visit *visit, void *context)
{
    const double within = reach ? reach->beyond : 0.0;
    const vec3 off = vec3_make(within, within, within);
    const visit_around v = {m, point, vec3_sub(point, off), vec3_add(point, off), reach, visit, context};
    if (m->levels > 0)
        visit_box(&v, m->levels - 1, 0);
}
