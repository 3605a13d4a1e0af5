/* A closed mesh whose shells overlap or touch as the union of operands in which they do not. A ray knows of each solid
 * only whether it is inside, so that the tracer needs a winding number of 0 or 1 everywhere in a mesh. Shells are put
 * into operands, the largest first, so that this holds in each of these: the sum of their winding numbers is that of
 * the mesh, and is 0 where all of them are. Operands are solids of one medium, between which there is no interface.
 *
 * Two shells whose boxes overlap cross if an edge of one meets a triangle of the other; of two that do not cross, one
 * contains the other if the winding number around a corner says so. Both are found with rays (hierarchy.h). */
#include "base/array.h"
#include "base/cancel.h"
#include "geometry/hierarchy/hierarchy.h"
#include "geometry/mesh/mesh_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OPERANDS_MAX = 32, PAIRS_MAX = 1 << 24 };
#define REMEDY "unite the shells in a modeller, or make the solid opaque"

typedef struct shell {
    bounds3 box;
    double volume6; /* six times the enclosed volume; negative: a hollow, or inside out */
    uint32_t first; /* its first triangle */
    int operand;    /* -1: none yet */
    bool turned;    /* its triangles are turned over */
    size_t pairs;   /* its pairs begin here, and end where those of the next shell begin */
} shell;

/* Two shells whose boxes overlap, in both orders. */
typedef struct shell_pair {
    uint32_t one, other;
    int winding; /* of the other around a corner of the one */
    bool cross;
    vec3 place; /* where they cross */
} shell_pair;

typedef struct shell_room {
    const mesh *m;
    const hierarchy *tree;
    uint32_t *shell_of; /* by triangle; UINT32_MAX: it is in none */
    shell *shells;      /* shell_count and one more, for the end of the pairs */
    shell_pair *pairs;
    size_t count, pair_count, pair_room;
    uint32_t *order;
    uint32_t at; /* the shell for which rays are searched */
    vec3 origin, direction;
    int winding; /* of shell `at` around the origin */
    int operand_count;
    bool turns;
} shell_room;

/* --- shells and their boxes --- */

static void widen(bounds3 *b, vec3 p)
{
    b->low = vec3_make(fmin(b->low.x, p.x), fmin(b->low.y, p.y), fmin(b->low.z, p.z));
    b->high = vec3_make(fmax(b->high.x, p.x), fmax(b->high.y, p.y), fmax(b->high.z, p.z));
}

static const vec3 *corner_of(const mesh *m, size_t t, int k)
{
    return &m->vertices[m->triangles[t].corner[k]];
}

/* Numbers the shells, and measures them. */
static status measure_shells(shell_room *r, diagnostic *why)
{
    const mesh *m = r->m;
    TRY(mesh_shells(m, &r->shell_of, why));
    r->shells = calloc(m->shell_count + 1, sizeof *r->shells);
    r->order = malloc((m->shell_count + 1) * sizeof *r->order);
    if (!r->shells || !r->order)
        return out_of_memory(why);
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t first = r->shell_of[t];
        if (first == UINT32_MAX)
            continue;
        if (first == t && r->count == m->shell_count)
            return diagnose(why, STATUS_FAILURE, "report this as a bug", "the shells of a mesh are miscounted");
        if (first == t) {
            const vec3 p = *corner_of(m, t, 0);
            r->shells[r->count] = (shell){.box = {p, p}, .first = first, .operand = -1};
            r->order[r->count] = (uint32_t)r->count;
            r->shell_of[t] = (uint32_t)r->count++;
        } else {
            r->shell_of[t] = r->shell_of[first];
        }
        shell *s = &r->shells[r->shell_of[t]];
        const vec3 from = *corner_of(m, s->first, 0), a = vec3_sub(*corner_of(m, t, 0), from),
                   b = vec3_sub(*corner_of(m, t, 1), from), c = vec3_sub(*corner_of(m, t, 2), from);
        s->volume6 += vec3_dot(a, vec3_cross(b, c));
        for (int k = 0; k < 3; k++)
            widen(&s->box, *corner_of(m, t, k));
    }
    return STATUS_OK;
}

/* --- pairs whose boxes overlap, by a sweep along x --- */

static bool overlap(const bounds3 *a, const bounds3 *b)
{
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y &&
           a->low.z <= b->high.z && b->low.z <= a->high.z;
}

/* qsort has no context. Shells are few, and the room of a thread is its own. */
static _Thread_local const shell *sorted;

static int compare_low(const void *one, const void *other)
{
    const uint32_t a = *(const uint32_t *)one, b = *(const uint32_t *)other;
    const double x = sorted[a].box.low.x, y = sorted[b].box.low.x;
    return x != y ? (x < y ? -1 : 1) : a < b ? -1 : a > b;
}

static int compare_pairs(const void *one, const void *other)
{
    const shell_pair *a = one, *b = other;
    if (a->one != b->one)
        return a->one < b->one ? -1 : 1;
    return a->other < b->other ? -1 : a->other > b->other;
}

static status find_pairs(shell_room *r, diagnostic *why)
{
    sorted = r->shells;
    qsort(r->order, r->count, sizeof *r->order, compare_low);
    for (size_t i = 0; i < r->count && !cancel_asked_at(i); i++) {
        const uint32_t a = r->order[i];
        for (size_t j = i + 1; j < r->count; j++) {
            const uint32_t b = r->order[j];
            if (r->shells[b].box.low.x > r->shells[a].box.high.x)
                break;
            if (!overlap(&r->shells[a].box, &r->shells[b].box))
                continue;
            if (r->pair_count >= PAIRS_MAX)
                return diagnose(why, STATUS_BAD_INPUT, REMEDY, "the mesh has %zu shells, and too many overlap",
                                r->count);
            if (!GROW(r->pairs, r->pair_room, r->pair_count + 2))
                return out_of_memory(why);
            r->pairs[r->pair_count++] = (shell_pair){.one = a, .other = b};
            r->pairs[r->pair_count++] = (shell_pair){.one = b, .other = a};
        }
    }
    TRY(cancel_check(why));
    if (r->pair_count)
        qsort(r->pairs, r->pair_count, sizeof *r->pairs, compare_pairs);
    for (size_t s = 0, p = 0; s <= r->count; s++) {
        while (p < r->pair_count && r->pairs[p].one < s)
            p++;
        r->shells[s].pairs = p;
    }
    return STATUS_OK;
}

static shell_pair *pair_with(shell_room *r, uint32_t one, uint32_t other)
{
    const size_t begin = r->shells[one].pairs, count = r->shells[one + 1].pairs - begin;
    const shell_pair wanted = {.one = one, .other = other};
    return count ? bsearch(&wanted, r->pairs + begin, count, sizeof wanted, compare_pairs) : NULL;
}

/* --- crossings and winding numbers, by rays --- */

static void meet(void *context, const mesh_hit *hit)
{
    shell_room *r = context;
    const uint32_t other = r->shell_of[hit->triangle];
    shell_pair *p = other != r->at && other != UINT32_MAX ? pair_with(r, r->at, other) : NULL;
    if (!p || p->cross)
        return;
    shell_pair *q = pair_with(r, other, r->at);
    p->cross = q->cross = true;
    p->place = q->place = vec3_add(r->origin, vec3_scale(r->direction, hit->t));
}

/* Whether the box meets that of a shell which is not known to cross shell r->at. */
static bool may_meet(const shell_room *r, const bounds3 *box)
{
    for (size_t p = r->shells[r->at].pairs; p < r->shells[r->at + 1].pairs; p++)
        if (!r->pairs[p].cross && overlap(box, &r->shells[r->pairs[p].other].box))
            return true;
    return false;
}

/* The front normal, as long as the triangle's largest coordinate; 0 without an area. */
static vec3 front_of(const mesh *m, size_t t)
{
    const vec3 a = *corner_of(m, t, 0), b = *corner_of(m, t, 1), c = *corner_of(m, t, 2);
    const vec3 n = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    const double length = vec3_length(n), far = fmax(fmax(vec3_length(a), vec3_length(b)), vec3_length(c));
    return length > 0.0 ? vec3_scale(n, far / length) : vec3_make(0.0, 0.0, 0.0);
}

/* Edges are lengthened, and moved a little to both sides of their triangle, so that a touch is a crossing, also where
 * faces of both shells lie in one plane. */
static void find_crossings(shell_room *r)
{
    static const double more = 0x1p-30, aside = 0x1p-36;
    for (size_t t = 0; t < r->m->triangle_count && !cancel_asked_at(t); t++) {
        r->at = r->shell_of[t];
        for (int k = 0; r->at != UINT32_MAX && k < 3; k++) {
            const vec3 a = *corner_of(r->m, t, k), b = *corner_of(r->m, t, (k + 1) % 3), out = front_of(r->m, t);
            bounds3 box = {a, a};
            widen(&box, b);
            r->direction = vec3_sub(b, a);
            r->origin = vec3_sub(a, vec3_scale(r->direction, more));
            for (int side = -1; side <= 1 && may_meet(r, &box); side += 2) {
                const mesh_ray ray = {.origin = vec3_add(r->origin, vec3_scale(out, side * aside)),
                                      .direction = r->direction,
                                      .t_max = 1.0 + 2.0 * more,
                                      .skip = (uint32_t)t,
                                      .facing = FACING_ANY};
                ISA_BASE_OF(hierarchy_kernels).all(r->tree, &ray, meet, r);
            }
        }
    }
}

/* At the place where they cross; of two that do not, at the first corner of the one. */
static status refuse(const shell_room *r, const shell_pair *p, const char *what, diagnostic *why)
{
    const vec3 place = p->cross ? p->place : *corner_of(r->m, r->shells[p->one].first, 0);
    return diagnose(why, STATUS_BAD_INPUT, REMEDY,
                    "shells of the mesh overlap, those of triangles %lu and %lu at (%.9g, %.9g, %.9g), %s",
                    (unsigned long)r->shells[p->one].first, (unsigned long)r->shells[p->other].first, place.x, place.y,
                    place.z, what);
}

static void wind(void *context, const mesh_hit *hit)
{
    shell_room *r = context;
    const uint32_t other = r->shell_of[hit->triangle];
    const int turn = hit->facing == FACING_BACK ? 1 : -1;
    shell_pair *p = other != r->at && other != UINT32_MAX ? pair_with(r, r->at, other) : NULL;
    if (p)
        p->winding += turn;
    r->winding += other == r->at ? turn : 0;
}

/* Directions that seldom hit an edge. */
enum { DIRECTIONS = 3 };
static const vec3 directions[DIRECTIONS] = {
    {0.5396, 0.6180, 0.5716}, {-0.4142, 0.7321, 0.5408}, {0.3679, -0.5403, 0.7568}};

/* Around a corner of each shell; a direction that hits an edge gives a number that a shell cannot have, and the next
 * one is tried. None is good around which a shell winds twice. */
static status find_windings(shell_room *r, diagnostic *why)
{
    for (r->at = 0; r->at < r->count && !cancel_asked_at(r->at); r->at++) {
        const size_t begin = r->shells[r->at].pairs, end = r->shells[r->at + 1].pairs;
        const shell_pair *bad = NULL;
        for (int k = 0; k < DIRECTIONS && begin < end && (k == 0 || bad); k++) {
            bad = NULL;
            for (size_t p = begin; p < end; p++)
                r->pairs[p].winding = 0;
            const mesh_ray ray = {.origin = *corner_of(r->m, r->shells[r->at].first, 0),
                                  .direction = directions[k],
                                  .t_max = HUGE_VAL,
                                  .skip = TRIANGLE_NONE,
                                  .facing = FACING_ANY};
            ISA_BASE_OF(hierarchy_kernels).all(r->tree, &ray, wind, r);
            for (size_t p = begin; p < end; p++) {
                const int turned = r->shells[r->pairs[p].other].volume6 < 0.0 ? -1 : 1;
                if (!r->pairs[p].cross && r->pairs[p].winding != 0 && r->pairs[p].winding != turned)
                    bad = &r->pairs[p];
            }
        }
        if (bad && !cancel_asked())
            return refuse(r, bad, "and it is not clear whether one lies in the other", why);
    }
    return cancel_check(why);
}

/* Whether the winding number of the shell of triangle t next to its centre is as an inside and an outside have it. */
static bool is_sound(shell_room *r, size_t t)
{
    const vec3 a = *corner_of(r->m, t, 0), b = *corner_of(r->m, t, 1), c = *corner_of(r->m, t, 2),
               out = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    const int outside = r->shells[r->at].volume6 < 0.0 ? -1 : 0;
    bool sound = !(vec3_length(out) > 0.0);
    for (int k = 0; k < DIRECTIONS && !sound; k++) {
        const mesh_ray ray = {.origin = vec3_scale(vec3_add(a, vec3_add(b, c)), 1.0 / 3.0),
                              .direction = directions[k],
                              .t_max = HUGE_VAL,
                              .skip = (uint32_t)t,
                              .facing = FACING_ANY};
        r->winding = 0;
        ISA_BASE_OF(hierarchy_kernels).all(r->tree, &ray, wind, r);
        sound = r->winding == outside + !(vec3_dot(out, directions[k]) > 0.0);
    }
    return sound;
}

/* Where triangles meet at edges, a shell may be in one with another one that lies partly in its faces. */
static status check_shells(shell_room *r, diagnostic *why)
{
    for (size_t t = 0; t < r->m->triangle_count && !cancel_asked_at(t); t++) {
        r->at = r->shell_of[t];
        if (r->at == UINT32_MAX || is_sound(r, t) || cancel_asked())
            continue;
        const vec3 a = *corner_of(r->m, t, 0);
        return diagnose(why, STATUS_BAD_INPUT, REMEDY,
                        "parts of the mesh that share edges lie in each other in a way that has no inside, at triangle "
                        "%zu, from (%.9g, %.9g, %.9g)",
                        t, a.x, a.y, a.z);
    }
    return cancel_check(why);
}

/* --- operands --- */

static int compare_sizes(const void *one, const void *other)
{
    const uint32_t a = *(const uint32_t *)one, b = *(const uint32_t *)other;
    const double x = fabs(sorted[a].volume6), y = fabs(sorted[b].volume6);
    return x != y ? (x > y ? -1 : 1) : a < b ? -1 : a > b;
}

/* The winding number of the operand's shells so far around the shell; *across: one that the shell crosses, or NULL. */
static int winding_in(const shell_room *r, uint32_t at, int operand, const shell_pair **across)
{
    int sum = 0;
    *across = NULL;
    for (size_t p = r->shells[at].pairs; p < r->shells[at + 1].pairs; p++) {
        const shell *other = &r->shells[r->pairs[p].other];
        if (other->operand != operand)
            continue;
        sum += other->turned ? -r->pairs[p].winding : r->pairs[p].winding;
        if (r->pairs[p].cross)
            *across = &r->pairs[p];
    }
    return sum;
}

/* The first operand that has the winding number around the shell, and no shell that it crosses; -1: none. *across: one
 * of those that it crosses. */
static int operand_with(const shell_room *r, uint32_t at, int winding, const shell_pair **across)
{
    const shell_pair *found;
    *across = NULL;
    for (int operand = 0; operand < r->operand_count; operand++) {
        const int sum = winding_in(r, at, operand, &found);
        if (!found && sum == winding)
            return operand;
        *across = found ? found : *across;
    }
    return -1;
}

/* A pair of the shell with one around it. There is one: each operand crosses it or has a winding number around it. */
static const shell_pair *pair_around(const shell_room *r, uint32_t at)
{
    const shell_pair *p = &r->pairs[r->shells[at].pairs];
    while (p + 1 < &r->pairs[r->shells[at + 1].pairs] && p->winding == 0)
        p++;
    return p;
}

/* A hollow goes into an operand that is solid around it. One that has none is inside out. */
static status place_shell(shell_room *r, uint32_t at, diagnostic *why)
{
    shell *s = &r->shells[at];
    const shell_pair *across;
    if (s->volume6 < 0.0) {
        s->operand = operand_with(r, at, 1, &across);
        if (s->operand < 0 && across)
            return refuse(r, across, "and one is a hollow", why);
        s->turned = s->operand < 0;
        r->turns |= s->turned;
    }
    if (s->operand < 0)
        s->operand = operand_with(r, at, 0, &across);
    if (s->operand >= 0)
        return STATUS_OK;
    if (r->operand_count == OPERANDS_MAX)
        return refuse(r, across ? across : pair_around(r, at), "and are nested more than 32 deep", why);
    s->operand = r->operand_count++;
    return STATUS_OK;
}

static status place_shells(shell_room *r, diagnostic *why)
{
    sorted = r->shells;
    qsort(r->order, r->count, sizeof *r->order, compare_sizes);
    for (size_t i = 0; i < r->count; i++)
        TRY(place_shell(r, r->order[i], why));
    return STATUS_OK;
}

static void copy_vertex(const mesh *from, uint32_t v, mesh *to, uint32_t at)
{
    to->vertices[at] = from->vertices[v];
    if (to->normals)
        to->normals[at] = from->normals[v];
    if (to->uvs)
        to->uvs[at] = from->uvs[v];
    if (to->colors)
        memcpy(to->colors[at], from->colors[v], sizeof *to->colors);
}

static bool is_in(const shell_room *r, size_t t, int operand)
{
    return r->shell_of[t] != UINT32_MAX && r->shells[r->shell_of[t]].operand == operand;
}

/* number: by vertex, its number in the operand plus 1. */
static status copy_operand(const shell_room *r, int operand, uint32_t *number, const mesh **out, diagnostic *why)
{
    const mesh *m = r->m;
    size_t triangles = 0, vertices = 0;
    memset(number, 0, m->vertex_count * sizeof *number);
    for (size_t t = 0; t < m->triangle_count; t++)
        for (int k = 0; is_in(r, t, operand) && k < 3; k++) {
            uint32_t *one = &number[m->triangles[t].corner[k]];
            *one = *one ? *one : (uint32_t)++vertices;
            triangles += k == 0;
        }
    mesh *part;
    TRY(mesh_create(vertices, triangles, m->normals, m->uvs, m->slots, &part, why));
    *out = part;
    if (m->colors)
        TRY(mesh_add_colors(part, why));
    part->slot_count = m->slot_count;
    if (!(part->numbers = malloc((triangles + 1) * sizeof *part->numbers)))
        return out_of_memory(why);
    for (size_t v = 0; v < m->vertex_count; v++)
        if (number[v])
            copy_vertex(m, (uint32_t)v, part, number[v] - 1);
    for (size_t t = 0, to = 0; t < m->triangle_count; t++) {
        if (!is_in(r, t, operand))
            continue;
        const bool turned = r->shells[r->shell_of[t]].turned;
        for (int k = 0; k < 3; k++)
            part->triangles[to].corner[turned && k ? 3 - k : k] = number[m->triangles[t].corner[k]] - 1;
        if (m->slots)
            part->slots[to] = m->slots[t];
        part->numbers[to++] = (uint32_t)t;
    }
    return mesh_finish(part, why);
}

static status copy_operands(const shell_room *r, const mesh **operands, diagnostic *why)
{
    uint32_t *number = malloc((r->m->vertex_count + 1) * sizeof *number);
    status code = number ? STATUS_OK : out_of_memory(why);
    for (int i = 0; i < r->operand_count && code == STATUS_OK; i++)
        code = copy_operand(r, i, number, &operands[i], why);
    free(number);
    return code;
}

/* Most meshes of many shells have boxes that do not overlap, no hollow, and no triangle that is in no shell. */
static bool is_plain(const shell_room *r)
{
    bool plain = r->pair_count == 0 && !r->m->crowded;
    for (size_t s = 0; s < r->count; s++)
        plain &= !(r->shells[s].volume6 < 0.0);
    return plain;
}

static status divide(shell_room *r, int threads, diagnostic *why)
{
    TRY(measure_shells(r, why));
    TRY(find_pairs(r, why));
    r->operand_count = 0;
    if (is_plain(r)) {
        r->operand_count = 1;
        return STATUS_OK;
    }
    hierarchy *tree = NULL;
    status code = hierarchy_build(r->m, HIERARCHY_BVH, threads, &tree, why);
    if (code == STATUS_OK) {
        r->tree = tree;
        if (r->m->crowded)
            code = check_shells(r, why);
        if (code == STATUS_OK)
            find_crossings(r);
        THEN(code, find_windings(r, why));
    }
    THEN(code, place_shells(r, why));
    hierarchy_destroy(tree);
    return code;
}

static status make_operands(mesh *m, int threads, diagnostic *why)
{
    shell_room r = {.m = m, .operand_count = 1};
    status code = m->shell_count > 1 || m->crowded ? divide(&r, threads, why) : STATUS_OK;
    struct mesh_shared *shared = m->shared;
    if (code == STATUS_OK && !(shared->operands = calloc((size_t)r.operand_count, sizeof *shared->operands)))
        code = out_of_memory(why);
    if (code == STATUS_OK) {
        shared->operand_count = r.operand_count;
        shared->operands[0] = m;
        if (r.operand_count > 1 || r.turns || m->crowded) {
            shared->operands[0] = NULL;
            code = copy_operands(&r, shared->operands, why);
        }
    }
    if (code != STATUS_OK)
        mesh_forget_operands(m);
    free(r.shell_of);
    free(r.shells);
    free(r.order);
    free(r.pairs);
    return code;
}

status hierarchy_operands(const mesh *m, int threads, const mesh *const **operands, int *count, diagnostic *why)
{
    status code = STATUS_OK;
    pthread_mutex_lock(&m->shared->mutex);
    if (!m->shared->operands)
        code = make_operands((mesh *)m, threads, why);
    *operands = m->shared->operands;
    *count = m->shared->operand_count;
    pthread_mutex_unlock(&m->shared->mutex);
    return code;
}
