/* The test whether a mesh is closed. Half-edges (a triangle's, from one corner to the next) are sorted by the lower and
 * the higher of their two positions: first by counting, into a list for each lower position, then within each list,
 * which is short. Linear time in practice. */
#include "base/cancel.h"
#include "base/array.h"
#include "geometry/mesh_parts.h"

#include <stdlib.h>

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

static bool joins(const uint32_t *same, const uint32_t *corner)
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

/* Takes the pages of new memory in order, which a cancellation ends: a loop that then writes at random places does not
 * wait for hundreds of new pages before it asks. False if cancelled. */
static bool take_pages(void *memory, size_t bytes)
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
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", "out of memory for the edges of a mesh");
    if (!take_pages(start, (m->vertex_count + 2) * sizeof *start) || !take_pages(edges, all))
        return cancel_check(why);
    /* two passes over the half-edges: count them two entries ahead, then place each at the end of the list before */
    for (int writing = 0; writing < 2; writing++) {
        for (size_t t = 0; t < m->triangle_count && !cancel_asked_at(t); t++) {
            const uint32_t *corner = m->triangles[t].corner;
            for (int k = 0; k < 3 && joins(lists->same, corner); k++) {
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
        TRY(cancel_check(why)); /* before the counts of a part of the edges are used */
    }
    for (size_t v = 0; v < m->vertex_count && !cancel_asked_at(v); v++)
        sort(edges + start[v], start[v + 1] - start[v]);
    return cancel_check(why);
}

/* The position where a half-edge begins. */
static uint32_t begins(const mesh *m, const uint32_t *same, uint32_t half)
{
    return same[m->triangles[half / 3].corner[half % 3]];
}

typedef struct edge_findings {
    size_t odd;     /* lowest half-edge whose edge is not shared by two triangles; SIZE_MAX: none */
    int sharing;    /* triangles that share its edge */
    size_t edges;   /* edges shared by two */
    size_t against; /* of these, edges with the same direction in both triangles */
} edge_findings;

/* Classifies each edge; mates may be NULL. */
static edge_findings find_pairs(const mesh *m, const edge_lists *lists, uint32_t *mates)
{
    edge_findings found = {.odd = SIZE_MAX};
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
            continue;
        }
        found.edges++;
        found.against += begins(m, lists->same, first) == begins(m, lists->same, second);
        if (mates) {
            mates[first] = second;
            mates[second] = first;
        }
    }
    return found;
}

static void name_hole(mesh *m, size_t half, int sharing)
{
    const uint32_t *corner = m->triangles[half / 3].corner;
    const size_t k = half % 3;
    m->closed = false;
    m->hole = (mesh_hole){corner[k], corner[k == 2 ? 0 : k + 1], half / 3, sharing};
}

static status orient(mesh *m, const edge_lists *lists, diagnostic *why)
{
    uint32_t *mates = malloc(3 * m->triangle_count * sizeof *mates);
    mesh_neighbours n = {lists->same, mates, malloc(m->triangle_count * sizeof *n.queue), malloc(m->triangle_count)};
    status result = STATUS_OK;
    if (mates && n.queue && n.turned) {
        for (size_t h = 0; h < 3 * m->triangle_count && !cancel_asked_at(h); h++)
            mates[h] = UINT32_MAX;
        find_pairs(m, lists, mates);
        result = cancel_check(why);
        size_t at = 0;
        if (result == STATUS_OK && !mesh_orient(m, &n, &at))
            name_hole(m, at, 2);
    } else {
        result = diagnose(why, STATUS_FAILURE, "use fewer triangles", "out of memory for the edges of a mesh");
    }
    free(mates);
    free(n.queue);
    free(n.turned);
    return result;
}

status mesh_close(mesh *m, diagnostic *why)
{
    edge_lists lists = {0};
    m->closed = false;
    m->hole = (mesh_hole){0};
    status result = edge_lists_make(m, &lists, why);
    if (result == STATUS_OK) {
        const edge_findings found = find_pairs(m, &lists, NULL);
        result = cancel_check(why);
        m->closed = found.odd == SIZE_MAX && found.edges > 0;
        if (found.odd != SIZE_MAX)
            name_hole(m, found.odd, found.sharing);
        else if (result == STATUS_OK && found.against)
            result = orient(m, &lists, why);
    }
    edge_lists_free(&lists);
    if (result != STATUS_OK || !m->closed || !(mesh_volume(m) < 0.0))
        return result;
    for (size_t t = 0; t < m->triangle_count; t++)
        mesh_turn(m, t);
    return STATUS_OK;
}
