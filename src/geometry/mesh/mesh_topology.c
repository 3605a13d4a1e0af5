/* The volume and area of a mesh, and whether it is closed. Vertices at equal positions are joined; the two half-edges
 * of each edge are found; of two neighbouring triangles that run along their common edge in the same direction, one is
 * flipped. */
#include "base/array.h"
#include "base/cancel.h"
#include "geometry/mesh/mesh_private.h"
#include <stdlib.h>
#include <string.h>

/* --- volume and area --- */

/* Six times the volume between a triangle and a point. */
static double volume6_of_triangle(const mesh *m, size_t triangle, vec3 origin)
{
    const uint32_t *corner = m->triangles[triangle].corner;
    vec3 a = vec3_sub(m->vertices[corner[0]], origin), b = vec3_sub(m->vertices[corner[1]], origin);
    return vec3_dot(a, vec3_cross(b, vec3_sub(m->vertices[corner[2]], origin)));
}

/* Sum of the signed tetrahedra over the triangles (divergence theorem), from the centre of the bounds, where
 * cancellation is least. */
double mesh_volume(const mesh *m)
{
    const vec3 middle =
        m->triangle_count ? vec3_scale(vec3_add(m->bounds.low, m->bounds.high), 0.5) : vec3_make(0, 0, 0);
    double sum = 0.0;
    for (size_t t = 0; t < m->triangle_count; t++)
        sum += volume6_of_triangle(m, t, middle);
    return sum / 6.0;
}

double mesh_area(const mesh *m)
{
    double sum = 0.0;
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *corner = m->triangles[t].corner;
        const vec3 a = m->vertices[corner[0]];
        sum += vec3_length(vec3_cross(vec3_sub(m->vertices[corner[1]], a), vec3_sub(m->vertices[corner[2]], a)));
    }
    return 0.5 * sum;
}

/* --- vertices at equal positions: a hash table of their numbers with open addressing --- */

#define NO_MEMORY "out of memory for the vertices of a mesh"
#define NO_EDGES "out of memory for the edges of a mesh"

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

/* The list of the numbers 0 to count - 1, with room for one more. */
static status number_all(size_t count, const char *no_memory, uint32_t **out, diagnostic *why)
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
        return number_all(m->vertex_count, NO_MEMORY, same, why);
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
 * A half-edge is an edge of one triangle, from one corner to the next. Half-edges are sorted by the lower and the
 * higher of their two positions: first by counting, into a list for each lower position, then within each list, which
 * is short. Linear time in practice. */

/* The position where a half-edge begins. */
static uint32_t begins(const mesh *m, const uint32_t *same, uint32_t half)
{
    return same[m->triangles[half / 3].corner[half % 3]];
}

typedef struct half_edge {
    uint32_t higher, half;
} half_edge;

/* edges[start[v]] .. edges[start[v + 1] - 1] are the half-edges whose lower position is v. */
typedef struct edge_lists {
    uint32_t *same, *start;
    half_edge *edges;
} edge_lists;

static void edge_lists_free(edge_lists *lists)
{
    free(lists->same);
    free(lists->start);
    free(lists->edges);
}

static bool has_distinct_corners(const uint32_t *same, const uint32_t *corner)
{
    const uint32_t a = same[corner[0]], b = same[corner[1]], c = same[corner[2]];
    return a != b && b != c && c != a;
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

static status edge_lists_make(const mesh *m, edge_lists *lists, diagnostic *why)
{
    TRY(mesh_weld(m, &lists->same, why));
    const size_t all = (3 * m->triangle_count + 1) * sizeof(half_edge);
    uint32_t *start = lists->start = large_calloc(m->vertex_count + 2, sizeof *start);
    half_edge *edges = lists->edges = large_pages(malloc(all), all);
    if (!start || !edges)
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", NO_EDGES);
    if (!touch_pages(start, (m->vertex_count + 2) * sizeof *start) || !touch_pages(edges, all))
        return cancel_check(why);
    /* Two passes over the half-edges. The first counts those of v in start[v + 2]. After the summation start[v + 1] is
     * the beginning of v's list; the second pass advances it to the end of the list as it writes. */
    for (int writing = 0; writing < 2; writing++) {
        for (size_t t = 0; t < m->triangle_count && !cancel_asked_at(t); t++) {
            const uint32_t *corner = m->triangles[t].corner;
            for (int k = 0; k < 3 && has_distinct_corners(lists->same, corner); k++) {
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

typedef struct edge_findings {
    size_t odd;     /* lowest half-edge whose edge is not shared by two triangles; SIZE_MAX: none */
    int sharing;    /* triangles that share its edge */
    size_t crowded; /* the lowest half-edge whose edge more than two triangles share; SIZE_MAX: none */
    size_t edges;   /* edges shared by two */
    size_t against; /* of these, edges with the same direction in both triangles */
    size_t joined;  /* of these, edges that joined two parts */
} edge_findings;

/* The first triangle of a connected part, in an array where a triangle points to an earlier one of its part. */
static uint32_t part_of(uint32_t *parts, uint32_t triangle)
{
    for (; parts[triangle] != triangle; triangle = parts[triangle])
        parts[triangle] = parts[parts[triangle]];
    return triangle;
}

static bool join_parts(uint32_t *parts, uint32_t one, uint32_t other)
{
    const uint32_t a = part_of(parts, one), b = part_of(parts, other);
    parts[a > b ? a : b] = a > b ? b : a;
    return a != b;
}

/* Classifies each edge; mates and parts may be NULL. */
static edge_findings find_pairs(const mesh *m, const edge_lists *lists, uint32_t *mates, uint32_t *parts)
{
    edge_findings found = {.odd = SIZE_MAX, .crowded = SIZE_MAX};
    const size_t count = lists->start[m->vertex_count];
    const half_edge *edges = lists->edges;
    size_t end = 0, lower = 0;
    for (size_t i = 0, edge = 0; i < count && !cancel_asked_at(edge); i = end, edge++) {
        while (lists->start[lower + 1] <= i)
            lower++;
        const size_t list_end = lists->start[lower + 1];
        for (end = i + 1; end < list_end && edges[end].higher == edges[i].higher;)
            end++;
        const uint32_t first = edges[i].half, second = edges[end - 1].half;
        if (end - i != 2) {
            if (first < found.odd) {
                found.odd = first;
                found.sharing = (int)(end - i);
            }
            if (end - i > 2 && first < found.crowded)
                found.crowded = first;
            continue;
        }
        found.edges++;
        found.against += begins(m, lists->same, first) == begins(m, lists->same, second);
        found.joined += parts && join_parts(parts, first / 3, second / 3);
        if (mates) {
            mates[first] = second;
            mates[second] = first;
        }
    }
    return found;
}

/* --- consistent winding, by flood fill --- */

/* Flips a triangle: swaps its second and third corner. */
static void flip(mesh *m, size_t triangle)
{
    uint32_t *corner = m->triangles[triangle].corner;
    const uint32_t second = corner[1];
    corner[1] = corner[2];
    corner[2] = second;
}

/* Half-edge 3 t + k runs from corner k of triangle t to the next corner; mates[] is the half-edge on its other side,
 * UINT32_MAX if there is none. queue and turned have room for each triangle. */
typedef struct neighbours {
    const uint32_t *same, *mates;
    uint32_t *queue;
    uint8_t *turned;
} neighbours;

enum { UNSEEN = 2 }; /* in neighbours.turned: not reached yet; otherwise 1 if flipped, else 0 */

/* Fills the connected part of triangle n->queue[first]. Returns the end of its range of the queue, 0 if neighbours
 * cannot agree. */
static size_t flood(const mesh *m, neighbours *n, size_t first, size_t *at)
{
    size_t end = first + 1;
    for (size_t i = first; i < end && !cancel_asked_at(i); i++) {
        const uint32_t t = n->queue[i];
        for (uint32_t half = 3 * t; half < 3 * t + 3; half++) {
            const uint32_t mate = n->mates[half], other = mate / 3;
            if (mate == UINT32_MAX)
                continue;
            const bool against = begins(m, n->same, half) == begins(m, n->same, mate);
            const uint8_t wanted = n->turned[t] ^ (uint8_t)against;
            if (n->turned[other] == UNSEEN) {
                n->turned[other] = wanted;
                n->queue[end++] = other;
            } else if (n->turned[other] != wanted) {
                *at = half;
                return 0;
            }
        }
    }
    return end;
}

/* Chooses one of the two directions of a connected part. */
static void choose_direction(const mesh *m, neighbours *n, size_t first, size_t end)
{
    const vec3 middle = m->vertices[m->triangles[n->queue[first]].corner[0]];
    size_t turned = 0;
    double volume6 = 0.0;
    for (size_t i = first; i < end; i++) {
        const uint32_t t = n->queue[i];
        turned += n->turned[t];
        volume6 += (n->turned[t] ? -1.0 : 1.0) * volume6_of_triangle(m, t, middle);
    }
    const size_t all = end - first;
    const bool inward = 4 * turned >= 3 * all || (4 * turned > all && volume6 < 0.0);
    for (size_t i = first; inward && i < end; i++)
        n->turned[n->queue[i]] ^= 1;
}

/* Flips triangles so that neighbours agree. False for a one-sided surface: *at is then a half-edge where two neighbours
 * cannot agree, and nothing is flipped. A connected part of which three quarters agree keeps their direction; any other
 * part is made to face outwards. */
static bool orient(mesh *m, neighbours *n, size_t *at)
{
    memset(n->turned, UNSEEN, m->triangle_count);
    size_t end = 0;
    for (size_t t = 0; t < m->triangle_count && !cancel_asked_at(t); t++) {
        if (n->turned[t] != UNSEEN)
            continue;
        const size_t first = end;
        n->turned[t] = 0;
        n->queue[first] = (uint32_t)t;
        end = flood(m, n, first, at);
        if (end == 0)
            return false;
        choose_direction(m, n, first, end);
    }
    for (size_t t = 0; t < m->triangle_count; t++)
        if (n->turned[t])
            flip(m, t);
    return true;
}

/* --- mesh_close --- */

static void record_hole(mesh *m, size_t half, int sharing)
{
    const uint32_t *corner = m->triangles[half / 3].corner;
    const size_t k = half % 3;
    m->closed = false;
    m->hole = (mesh_hole){corner[k], corner[k == 2 ? 0 : k + 1], half / 3, sharing};
}

/* Sets *mates to those of each half-edge. */
static status mates_make(const mesh *m, const edge_lists *lists, uint32_t **mates, edge_findings *found,
                         diagnostic *why)
{
    uint32_t *list = *mates = allocate_numbers(3 * m->triangle_count + 1);
    if (!list)
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", NO_EDGES);
    for (size_t h = 0; h < 3 * m->triangle_count && !cancel_asked_at(h); h++)
        list[h] = UINT32_MAX;
    *found = find_pairs(m, lists, list, NULL);
    return cancel_check(why);
}

status mesh_neighbours_make(const mesh *m, mesh_neighbours *out, diagnostic *why)
{
    edge_lists lists = {0};
    edge_findings found;
    *out = (mesh_neighbours){.crowded = SIZE_MAX};
    status result = edge_lists_make(m, &lists, why);
    THEN(result, mates_make(m, &lists, &out->mates, &found, why));
    if (result == STATUS_OK) {
        out->crowded = found.crowded;
        out->same = lists.same;
        lists.same = NULL;
    }
    edge_lists_free(&lists);
    return result;
}

void mesh_neighbours_free(mesh_neighbours *n)
{
    free(n->same);
    free(n->mates);
    *n = (mesh_neighbours){0};
}

status mesh_turn_alike(mesh *m, const uint32_t *same, const uint32_t *mates, size_t *turned, size_t *against,
                       diagnostic *why)
{
    neighbours n = {same, mates, malloc((m->triangle_count + 1) * sizeof *n.queue), malloc(m->triangle_count + 1)};
    status result = STATUS_OK;
    *turned = 0;
    *against = SIZE_MAX;
    if (!n.queue || !n.turned)
        result = diagnose(why, STATUS_FAILURE, "use fewer triangles", NO_EDGES);
    else if (orient(m, &n, against))
        *against = SIZE_MAX;
    for (size_t t = 0; result == STATUS_OK && *against == SIZE_MAX && t < m->triangle_count; t++)
        *turned += n.turned[t] == 1;
    THEN(result, cancel_check(why));
    free(n.queue);
    free(n.turned);
    return result;
}

static status orient_all(mesh *m, const edge_lists *lists, diagnostic *why)
{
    uint32_t *mates;
    edge_findings found;
    size_t turned, against;
    status result = mates_make(m, lists, &mates, &found, why);
    THEN(result, mesh_turn_alike(m, lists->same, mates, &turned, &against, why));
    if (result == STATUS_OK && against != SIZE_MAX)
        record_hole(m, against, 2);
    free(mates);
    return result;
}

status mesh_shells(const mesh *m, uint32_t **first, diagnostic *why)
{
    edge_lists lists = {0};
    *first = NULL;
    status result = edge_lists_make(m, &lists, why);
    THEN(result, number_all(m->triangle_count, NO_EDGES, first, why)); /* each triangle is a part */
    if (result == STATUS_OK) {
        find_pairs(m, &lists, NULL, *first);
        result = cancel_check(why);
    }
    for (size_t t = 0; result == STATUS_OK && t < m->triangle_count; t++)
        (*first)[t] =
            has_distinct_corners(lists.same, m->triangles[t].corner) ? part_of(*first, (uint32_t)t) : UINT32_MAX;
    edge_lists_free(&lists);
    if (result != STATUS_OK) {
        free(*first);
        *first = NULL;
    }
    return result;
}

status mesh_close(mesh *m, diagnostic *why)
{
    edge_lists lists = {0};
    uint32_t *parts = NULL;
    m->closed = false;
    m->hole = (mesh_hole){0};
    status result = edge_lists_make(m, &lists, why);
    THEN(result, number_all(m->triangle_count, NO_EDGES, &parts, why));
    if (result == STATUS_OK) {
        const edge_findings found = find_pairs(m, &lists, NULL, parts);
        result = cancel_check(why);
        m->closed = found.odd == SIZE_MAX && found.edges > 0;
        m->shell_count = m->closed ? lists.start[m->vertex_count] / 3 - found.joined : 0;
        if (found.odd != SIZE_MAX)
            record_hole(m, found.odd, found.sharing);
        else if (result == STATUS_OK && found.against)
            result = orient_all(m, &lists, why);
    }
    edge_lists_free(&lists);
    free(parts);
    if (result != STATUS_OK || !m->closed || !(mesh_volume(m) < 0.0))
        return result;
    for (size_t t = 0; t < m->triangle_count; t++)
        flip(m, t);
    return STATUS_OK;
}
