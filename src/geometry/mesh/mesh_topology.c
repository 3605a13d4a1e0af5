/* The volume and area of a mesh, whether it is closed, and its shells. Of two neighbouring triangles that run along
 * their common edge in the same direction, one is flipped. */
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
            const bool against = mesh_half_begins(m, n->same, half) == mesh_half_begins(m, n->same, mate);
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

static void record_hole(mesh *m, size_t half, int sharing, mesh_fault fault)
{
    const uint32_t *corner = m->triangles[half / 3].corner;
    const size_t k = half % 3;
    m->hole = (mesh_hole){corner[k], corner[k == 2 ? 0 : k + 1], half / 3, sharing, fault};
}

/* Sets *mates to those of each half-edge. */
static status mates_make(const mesh *m, const edge_lists *lists, uint32_t **mates, edge_findings *found,
                         diagnostic *why)
{
    const size_t count = 3 * m->triangle_count;
    uint32_t *list = *mates = large_pages(malloc((count + 1) * sizeof *list), (count + 1) * sizeof *list);
    if (!list)
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", MESH_NO_EDGES);
    for (size_t h = 0; h < count && !cancel_asked_at(h); h++)
        list[h] = UINT32_MAX;
    *found = edge_lists_pair(m, lists, list, NULL);
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
        result = diagnose(why, STATUS_FAILURE, "use fewer triangles", MESH_NO_EDGES);
    else if (orient(m, &n, against))
        *against = SIZE_MAX;
    for (size_t t = 0; result == STATUS_OK && *against == SIZE_MAX && t < m->triangle_count; t++)
        *turned += n.turned[t] == 1;
    THEN(result, cancel_check(why));
    free(n.queue);
    free(n.turned);
    return result;
}

/* *agree: whether neighbours do now; otherwise the hole is where they cannot. */
static status orient_all(mesh *m, const edge_lists *lists, bool *agree, diagnostic *why)
{
    uint32_t *mates;
    edge_findings found;
    size_t turned, against = SIZE_MAX;
    status result = mates_make(m, lists, &mates, &found, why);
    THEN(result, mesh_turn_alike(m, lists->same, mates, &turned, &against, why));
    *agree = against == SIZE_MAX;
    if (!*agree)
        record_hole(m, against, 2, MESH_ONE_SIDED);
    free(mates);
    return result;
}

/* Replaces parts, of triangles of one shell, by the first triangle of each one's shell, and counts these. twins: see
 * mesh_crowds; or NULL. A shell is left out if all of its triangles have twins, in one other shell. */
static status list_shells(const mesh *m, const uint32_t *same, uint32_t *parts, const uint32_t *twins, size_t *count,
                          diagnostic *why)
{
    enum { NONE, MIXED, FIRST }; /* of the twins of a shell, by its first triangle; FIRST + s: all are in shell s */
    uint64_t *shells = twins ? calloc(m->triangle_count + 1, sizeof *shells) : NULL;
    if (twins && !shells)
        return out_of_memory(why);
    for (size_t t = 0; t < m->triangle_count; t++)
        parts[t] = mesh_part_of(parts, (uint32_t)t);
    for (size_t t = 0; shells && t < m->triangle_count; t++) {
        if (twins[t] == UINT32_MAX)
            continue;
        const uint32_t shell = parts[t], other = parts[twins[t]];
        const uint64_t found = shells[shell];
        shells[shell] = other == shell || (found != NONE && found != FIRST + (uint64_t)other) ? MIXED : FIRST + other;
    }
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t shell = parts[t];
        const bool none = !mesh_has_distinct_corners(same, m->triangles[t].corner) ||
                          (twins && (twins[t] == UINT32_MAX || shells[shell] >= FIRST));
        *count += !none && shell == t;
        parts[t] = none ? UINT32_MAX : shell;
    }
    free(shells);
    return STATUS_OK;
}

/* *first and *count are set unless there is a fault. */
static status find_crowded_shells(const mesh *m, const edge_lists *lists, uint32_t **first, size_t *count,
                                  struct edge_fault *fault, diagnostic *why)
{
    mesh_crowds crowds;
    status result = mesh_crowds_make(m, lists, &crowds, why);
    *fault = crowds.fault;
    if (result == STATUS_OK && fault->half == SIZE_MAX)
        result = list_shells(m, lists->same, crowds.parts, crowds.twins, count, why);
    *first = crowds.parts;
    crowds.parts = NULL;
    mesh_crowds_free(&crowds);
    return result;
}

status mesh_shells(const mesh *m, uint32_t **first, diagnostic *why)
{
    edge_lists lists = {0};
    struct edge_fault fault;
    size_t count = 0;
    *first = NULL;
    status result = edge_lists_make(m, &lists, why);
    if (m->crowded) {
        THEN(result, find_crowded_shells(m, &lists, first, &count, &fault, why));
    } else {
        THEN(result, mesh_number_all(m->triangle_count, MESH_NO_EDGES, first, why)); /* each triangle is a part */
        if (result == STATUS_OK) {
            edge_lists_pair(m, &lists, NULL, *first);
            result = cancel_check(why);
        }
        THEN(result, list_shells(m, lists.same, *first, NULL, &count, why));
    }
    edge_lists_free(&lists);
    if (result != STATUS_OK) {
        free(*first);
        *first = NULL;
    }
    return result;
}

static void flip_all(mesh *m)
{
    for (size_t t = 0; t < m->triangle_count; t++)
        flip(m, t);
}

/* Counts the shells of a mesh in which an even number of triangles share each edge, and neighbours at an edge of two
 * agree. */
static status count_shells(mesh *m, diagnostic *why)
{
    edge_lists lists = {0};
    struct edge_fault fault = {.half = SIZE_MAX};
    uint32_t *first = NULL;
    m->shell_count = 0;
    status result = edge_lists_make(m, &lists, why);
    THEN(result, find_crowded_shells(m, &lists, &first, &m->shell_count, &fault, why));
    edge_lists_free(&lists);
    free(first);
    m->closed = m->crowded = result == STATUS_OK && fault.half == SIZE_MAX;
    if (result == STATUS_OK && !m->closed)
        record_hole(m, fault.half, fault.sharing, fault.kind);
    return result;
}

/* Shells depend on which side is the inside, so that they are found again in a mesh that was inside out. */
static status close_crowded(mesh *m, diagnostic *why)
{
    TRY(count_shells(m, why));
    if (!m->closed || !(mesh_volume(m) < 0.0))
        return STATUS_OK;
    flip_all(m);
    return count_shells(m, why);
}

status mesh_close(mesh *m, diagnostic *why)
{
    edge_lists lists = {0};
    uint32_t *parts = NULL;
    edge_findings found = {0};
    bool agree = true;
    m->closed = m->crowded = false;
    m->hole = (mesh_hole){0};
    status result = edge_lists_make(m, &lists, why);
    THEN(result, mesh_number_all(m->triangle_count, MESH_NO_EDGES, &parts, why));
    if (result == STATUS_OK) {
        found = edge_lists_pair(m, &lists, NULL, parts);
        result = cancel_check(why);
    }
    if (result == STATUS_OK && found.odd != SIZE_MAX)
        record_hole(m, found.odd, found.sharing, MESH_ODD);
    else if (result == STATUS_OK && found.against)
        result = orient_all(m, &lists, &agree, why);
    const size_t count = result == STATUS_OK ? lists.start[m->vertex_count] / 3 : 0;
    edge_lists_free(&lists);
    free(parts);
    m->closed = count > 0 && agree && found.odd == SIZE_MAX && found.crowded == SIZE_MAX;
    m->shell_count = m->closed ? count - found.joined : 0;
    if (count > 0 && agree && found.odd == SIZE_MAX && !m->closed)
        return close_crowded(m, why);
    if (m->closed && mesh_volume(m) < 0.0)
        flip_all(m);
    return result;
}
