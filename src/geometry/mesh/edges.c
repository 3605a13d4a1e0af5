/* Vertices at equal positions, the half-edges between them, and how these pair up: two of each edge, or, where more
 * triangles meet, by their angles around it. */
#include "base/array.h"
#include "base/cancel.h"
#include "geometry/mesh/mesh_private.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- vertices at equal positions: a hash table of their numbers with open addressing --- */

#define NO_MEMORY "out of memory for the vertices of a mesh"

static uint64_t bits_of(double x)
{
    uint64_t bits;
    x += 0.0; /* -0 becomes 0 */
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Coordinates that are floats differ in their high bits only: each step mixes these into the low bits. */
static uint64_t position_hash(vec3 p)
{
    uint64_t h = bits_of(p.x) * UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ h >> 32 ^ bits_of(p.y)) * UINT64_C(0xd6e8feb86659fd93);
    h = (h ^ h >> 32 ^ bits_of(p.z)) * UINT64_C(0xd6e8feb86659fd93);
    return h ^ h >> 32;
}

static bool same_place(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static uint32_t *allocate_numbers(size_t count)
{
    return large_pages(malloc(count * sizeof(uint32_t)), count * sizeof(uint32_t));
}

status mesh_number_all(size_t count, const char *no_memory, uint32_t **out, diagnostic *why)
{
    uint32_t *list = *out = allocate_numbers(count + 1);
    for (size_t k = 0; list && k < count; k++)
        list[k] = (uint32_t)k;
    return list ? STATUS_OK : diagnose(why, STATUS_FAILURE, "use fewer triangles", "%s", no_memory);
}

status mesh_weld(const mesh *m, uint32_t **same, diagnostic *why)
{
    *same = NULL;
    if (m->distinct) /* no two vertices have the same position */
        return mesh_number_all(m->vertex_count, NO_MEMORY, same, why);
    enum { AHEAD = 16 }; /* the table exceeds the caches: prefetch its lines */
    size_t size = 16;
    while (size < 2 * m->vertex_count)
        size *= 2;
    uint32_t *table = allocate_numbers(size), *found = allocate_numbers(m->vertex_count + 1);
    if (!table || !found) {
        free(table);
        free(found);
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", NO_MEMORY);
    }
    for (size_t at = 0; at < size; at++) {
        if (cancel_asked_at(at))
            break;
        table[at] = UINT32_MAX;
    }
    uint64_t hashes[AHEAD];
    for (size_t v = 0; v < m->vertex_count + AHEAD && !cancel_asked_at(v); v++) {
        if (v >= AHEAD) {
            const size_t at = v - AHEAD;
            size_t place = hashes[at % AHEAD] & (size - 1);
            while (table[place] != UINT32_MAX && !same_place(m->vertices[table[place]], m->vertices[at]))
                place = (place + 1) & (size - 1);
            if (table[place] == UINT32_MAX)
                table[place] = (uint32_t)at;
            found[at] = table[place];
        }
        if (v < m->vertex_count) {
            hashes[v % AHEAD] = position_hash(m->vertices[v]);
            __builtin_prefetch(&table[hashes[v % AHEAD] & (size - 1)]);
        }
    }
    free(table);
    const status code = cancel_check(why);
    if (code == STATUS_OK)
        *same = found;
    else
        free(found);
    return code;
}

/* --- half-edges ---
 *
 * They are sorted by the lower and the higher of their two positions: first by counting, into a list for each lower
 * position, then within each list, which is short. Linear time in practice. */

void edge_lists_free(edge_lists *lists)
{
    free(lists->same);
    free(lists->start);
    free(lists->edges);
}

static int compare(const void *a, const void *b)
{
    const half_edge *x = a, *y = b;
    if (x->higher != y->higher)
        return x->higher < y->higher ? -1 : 1;
    return x->half < y->half ? -1 : x->half > y->half;
}

static void sort(half_edge *edges, size_t count)
{
    enum { SHORT = 24 }; /* up to this length insertion sort; a vertex usually has about six edges */
    if (count > SHORT) {
        qsort(edges, count, sizeof *edges, compare);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const half_edge edge = edges[i];
        size_t j = i;
        for (; j > 0 && compare(&edge, &edges[j - 1]) < 0; j--)
            edges[j] = edges[j - 1];
        edges[j] = edge;
    }
}

/* Touches the pages of new memory in order, so that a loop that then writes at random places does not wait for hundreds
 * of new pages before it notices a cancellation. False if cancelled. */
static bool touch_pages(void *memory, size_t bytes)
{
    enum { PAGE = 4096 };
    volatile char *first = memory;
    for (size_t at = 0; at < bytes; at += PAGE) {
        if (at % LARGE_PAGE == 0 && cancel_asked())
            return false;
        first[at] = 0;
    }
    return true;
}

status edge_lists_make(const mesh *m, edge_lists *lists, diagnostic *why)
{
    TRY(mesh_weld(m, &lists->same, why));
    const size_t all = (3 * m->triangle_count + 1) * sizeof(half_edge);
    uint32_t *start = lists->start = large_calloc(m->vertex_count + 2, sizeof *start);
    half_edge *edges = lists->edges = large_pages(malloc(all), all);
    if (!start || !edges)
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", MESH_NO_EDGES);
    if (!touch_pages(start, (m->vertex_count + 2) * sizeof *start) || !touch_pages(edges, all))
        return cancel_check(why);
    /* Two passes over the half-edges. The first counts those of v in start[v + 2]. After the summation start[v + 1] is
     * the beginning of v's list; the second pass advances it to the end of the list as it writes. */
    for (int writing = 0; writing < 2; writing++) {
        for (size_t t = 0; t < m->triangle_count && !cancel_asked_at(t); t++) {
            const uint32_t *corner = m->triangles[t].corner;
            for (int k = 0; k < 3 && mesh_has_distinct_corners(lists->same, corner); k++) {
                const uint32_t a = lists->same[corner[k]], b = lists->same[corner[k == 2 ? 0 : k + 1]];
                const uint32_t lower = a < b ? a : b, higher = a < b ? b : a;
                if (writing)
                    edges[start[lower + 1]++] = (half_edge){higher, (uint32_t)(3 * t) + (uint32_t)k};
                else
                    start[lower + 2]++;
            }
        }
        for (size_t v = 2; !writing && v < m->vertex_count + 2; v++)
            start[v] += start[v - 1];
        TRY(cancel_check(why)); /* incomplete counts must not be used */
    }
    for (size_t v = 0; v < m->vertex_count && !cancel_asked_at(v); v++)
        sort(edges + start[v], start[v + 1] - start[v]);
    return cancel_check(why);
}

static bool join_parts(uint32_t *parts, uint32_t one, uint32_t other)
{
    const uint32_t a = mesh_part_of(parts, one), b = mesh_part_of(parts, other);
    parts[a > b ? a : b] = a > b ? b : a;
    return a != b;
}

/* An edge: its half-edges are edges[begin] .. edges[end - 1] of the lists, in the order of triangles. */
typedef struct edge_range {
    size_t begin, end;
    uint32_t lower; /* the lower of its two positions */
} edge_range;

/* The next edge; false after the last one. Begins with zeros. */
static inline bool next_edge(const mesh *m, const edge_lists *lists, edge_range *e)
{
    const size_t begin = e->begin = e->end;
    if (begin == lists->start[m->vertex_count])
        return false;
    while (lists->start[e->lower + 1] <= begin)
        e->lower++;
    const size_t list_end = lists->start[e->lower + 1];
    const uint32_t higher = lists->edges[begin].higher;
    size_t end = begin + 1;
    while (end < list_end && lists->edges[end].higher == higher)
        end++;
    e->end = end;
    return true;
}

edge_findings edge_lists_pair(const mesh *m, const edge_lists *lists, uint32_t *mates, uint32_t *parts)
{
    edge_findings found = {.odd = SIZE_MAX, .crowded = SIZE_MAX};
    edge_range e = {0};
    for (size_t edge = 0; !cancel_asked_at(edge) && next_edge(m, lists, &e); edge++) {
        const uint32_t first = lists->edges[e.begin].half, second = lists->edges[e.end - 1].half;
        const size_t sharing = e.end - e.begin;
        if (sharing != 2) {
            if (sharing % 2 == 1 && first < found.odd) {
                found.odd = first;
                found.sharing = (int)sharing;
            }
            if (sharing > 2 && first < found.crowded)
                found.crowded = first;
            continue;
        }
        found.edges++;
        found.against += mesh_half_begins(m, lists->same, first) == mesh_half_begins(m, lists->same, second);
        found.joined += parts && join_parts(parts, first / 3, second / 3);
        if (mates) {
            mates[first] = second;
            mates[second] = first;
        }
    }
    return found;
}

/* --- edges that more than two triangles share ---
 *
 * Around such an edge a solid lies between a triangle that opens it and one that closes it, as between parentheses, and
 * as these they are matched: each pair then bounds a wedge of one shell. Where the winding number rises to 2, the inner
 * pair is one in the other. Of triangles with the same corners, two with opposite fronts are inside the solid, and
 * cancel. In one plane solids close before others open, so that two that touch there stay two shells. */

#define IN_ONE_PLANE 0x1p-20 /* radians: positions may be rounded to floats */

typedef struct spoke {
    uint32_t half, apex; /* the position of the corner that is not on the edge */
    bool opens;          /* the solid is at larger angles */
    double angle;        /* around the edge */
    int plane;           /* spokes of one plane have one number */
} spoke;

typedef struct spoke_room {
    spoke *spokes;
    size_t count, room;
    size_t *open; /* a stack of the spokes that are not closed yet */
    size_t open_room;
} spoke_room;

static status list_spokes(const mesh *m, const edge_lists *lists, const edge_range *e, const uint32_t *twins,
                          spoke_room *r, diagnostic *why)
{
    r->count = 0;
    if (!GROW(r->spokes, r->room, e->end - e->begin) || !GROW(r->open, r->open_room, e->end - e->begin))
        return out_of_memory(why);
    for (size_t i = e->begin; i < e->end; i++) {
        const uint32_t half = lists->edges[i].half;
        if (twins[half / 3] != UINT32_MAX)
            r->spokes[r->count++] = (spoke){.half = half,
                                            .apex = lists->same[m->triangles[half / 3].corner[(half % 3 + 2) % 3]],
                                            .opens = mesh_half_begins(m, lists->same, half) != e->lower};
    }
    return STATUS_OK;
}

static int compare_corners(const void *one, const void *other)
{
    const spoke *a = one, *b = other;
    if (a->apex != b->apex)
        return a->apex < b->apex ? -1 : 1;
    return a->half < b->half ? -1 : a->half > b->half;
}

/* Of triangles with the same corners, cancels as many that face one way as the other, the first ones; of the rest, the
 * first is the twin of all. Each of their edges gives the same. */
static void find_twins(spoke_room *r, uint32_t *twins)
{
    qsort(r->spokes, r->count, sizeof *r->spokes, compare_corners);
    for (size_t i = 0, end; i < r->count; i = end) {
        size_t facing[2] = {0, 0}, seen[2] = {0, 0};
        for (end = i; end < r->count && r->spokes[end].apex == r->spokes[i].apex; end++)
            facing[r->spokes[end].opens]++;
        const size_t cancelled = facing[0] < facing[1] ? facing[0] : facing[1];
        for (size_t k = i, first = SIZE_MAX; k < end; k++) {
            const uint32_t t = r->spokes[k].half / 3;
            if (seen[r->spokes[k].opens]++ < cancelled) {
                twins[t] = UINT32_MAX;
                continue;
            }
            first = first == SIZE_MAX ? t : first;
            twins[t] = (uint32_t)first;
        }
    }
}

/* In one plane, solids close before others open; of two that coincide, the first triangle is the outer one. */
static int compare_planes(const void *one, const void *other)
{
    const spoke *a = one, *b = other;
    if (a->plane != b->plane || a->opens != b->opens)
        return a->plane != b->plane ? (a->plane < b->plane ? -1 : 1) : a->opens ? 1 : -1;
    return (a->half < b->half ? -1 : a->half > b->half) * (a->opens ? 1 : -1);
}

static int compare_angles(const void *one, const void *other)
{
    const spoke *a = one, *b = other;
    return a->angle != b->angle ? (a->angle < b->angle ? -1 : 1) : a->half < b->half ? -1 : a->half > b->half;
}

/* Angles grow around the edge from its lower to its higher position by the rule of the right hand; a triangle that runs
 * along it in this direction has its front at larger angles. */
static void sort_spokes(const mesh *m, uint32_t lower, uint32_t higher, spoke_room *r)
{
    const vec3 from = m->vertices[lower], along = vec3_normalize(vec3_sub(m->vertices[higher], from));
    vec3 x = vec3_make(0.0, 0.0, 0.0), y = x;
    for (size_t i = 0; i < r->count; i++) {
        spoke *s = &r->spokes[i];
        const vec3 across = vec3_cross(along, vec3_sub(m->vertices[s->apex], from));
        if (i == 0) {
            x = across;
            y = vec3_cross(along, x);
        }
        s->angle = atan2(vec3_dot(across, y), vec3_dot(across, x));
        s->angle += s->angle < -IN_ONE_PLANE ? 2.0 * M_PI : 0.0;
    }
    qsort(r->spokes, r->count, sizeof *r->spokes, compare_angles);
    for (size_t i = 1; i < r->count; i++)
        r->spokes[i].plane = r->spokes[i - 1].plane + (r->spokes[i].angle - r->spokes[i - 1].angle > IN_ONE_PLANE);
    qsort(r->spokes, r->count, sizeof *r->spokes, compare_planes);
}

/* Joins the triangles of each wedge. It begins where most spokes are closed that were not open. */
static void match_spokes(spoke_room *r, mesh_crowds *c)
{
    size_t start = 0, depth = 0;
    long sum = 0, least = 0;
    for (size_t i = 0; i < r->count; i++) {
        sum += r->spokes[i].opens ? 1 : -1;
        if (sum < least)
            least = sum, start = i + 1;
    }
    for (size_t i = 0; i < r->count; i++) {
        const size_t at = (start + i) % r->count;
        if (r->spokes[at].opens)
            r->open[depth++] = at;
        else
            join_parts(c->parts, r->spokes[r->open[--depth]].half / 3, r->spokes[at].half / 3);
    }
}

static status pair_edge(const mesh *m, const edge_lists *lists, const edge_range *e, spoke_room *r, mesh_crowds *c,
                        diagnostic *why)
{
    size_t opens = 0;
    TRY(list_spokes(m, lists, e, c->twins, r, why));
    for (size_t i = 0; i < r->count; i++)
        opens += r->spokes[i].opens;
    if (2 * opens != r->count) {
        const size_t first = lists->edges[e->begin].half;
        if (first < c->fault.half)
            c->fault = (struct edge_fault){first, (int)(e->end - e->begin), MESH_UNBALANCED};
        return STATUS_OK;
    }
    if (r->count > 2)
        sort_spokes(m, e->lower, lists->edges[e->begin].higher, r);
    match_spokes(r, c);
    return STATUS_OK;
}

/* That something is left of each part of the mesh. */
static status check_parts(const mesh *m, const edge_lists *lists, mesh_crowds *c, diagnostic *why)
{
    uint32_t *whole;
    TRY(mesh_number_all(m->triangle_count, MESH_NO_EDGES, &whole, why));
    uint8_t *left = calloc(m->triangle_count + 1, 1);
    edge_range e = {0};
    for (size_t edge = 0; left && !cancel_asked_at(edge) && next_edge(m, lists, &e); edge++)
        for (size_t i = e.begin + 1; i < e.end; i++)
            join_parts(whole, lists->edges[e.begin].half / 3, lists->edges[i].half / 3);
    for (size_t t = 0; left && t < m->triangle_count; t++)
        left[mesh_part_of(whole, (uint32_t)t)] |= c->twins[t] != UINT32_MAX;
    e = (edge_range){0};
    for (size_t edge = 0; left && !cancel_asked_at(edge) && next_edge(m, lists, &e); edge++) {
        const uint32_t first = lists->edges[e.begin].half;
        if (first < c->fault.half && !left[mesh_part_of(whole, first / 3)])
            c->fault = (struct edge_fault){first, (int)(e.end - e.begin), MESH_CANCELLED};
    }
    free(whole);
    free(left);
    return left ? cancel_check(why) : out_of_memory(why);
}

static status pair_crowds(const mesh *m, const edge_lists *lists, spoke_room *r, mesh_crowds *c, diagnostic *why)
{
    TRY(mesh_number_all(m->triangle_count, MESH_NO_EDGES, &c->parts, why));
    TRY(mesh_number_all(m->triangle_count, MESH_NO_EDGES, &c->twins, why));
    uint32_t *all = c->parts; /* no triangle is cancelled while twins are searched */
    edge_range e = {0};
    for (size_t edge = 0; !cancel_asked_at(edge) && next_edge(m, lists, &e); edge++)
        if (e.end - e.begin > 2) {
            TRY(list_spokes(m, lists, &e, all, r, why));
            find_twins(r, c->twins);
        }
    TRY(check_parts(m, lists, c, why));
    e = (edge_range){0};
    for (size_t edge = 0; !cancel_asked_at(edge) && next_edge(m, lists, &e); edge++)
        TRY(pair_edge(m, lists, &e, r, c, why));
    return cancel_check(why);
}

status mesh_crowds_make(const mesh *m, const edge_lists *lists, mesh_crowds *out, diagnostic *why)
{
    spoke_room r = {0};
    *out = (mesh_crowds){.fault.half = SIZE_MAX};
    const status code = pair_crowds(m, lists, &r, out, why);
    free(r.spokes);
    free(r.open);
    return code;
}

void mesh_crowds_free(mesh_crowds *c)
{
    free(c->parts);
    free(c->twins);
    *c = (mesh_crowds){0};
}
