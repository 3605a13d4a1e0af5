/* Closes open meshes, such as scans: joins vertices, drops triangles that are not needed, turns triangles so that they
 * agree, and fills holes. Every choice is by the order of vertices and triangles, so that equal meshes give equal
 * results. */
#include "base/array.h"
#include "base/cancel.h"
#include "geometry/mesh/mesh_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGULATED_MAX = 400 }; /* corners: the time is cubic */
#define CRAMPED "use fewer triangles"

typedef struct repair {
    const mesh *given;
    mesh *m; /* the copy, which is not finished */
    mesh_repairs *counts;
    mesh_neighbours n;
    uint64_t *edges; /* a hash table of the edges: lower position << 32 | higher one, plus 1 */
    size_t edge_room, edge_count;
    uint32_t *loop; /* corners of a hole: vertices, in the order of the new triangles */
    size_t loop_room;
    vec3 *centres; /* new vertices, after those of the mesh */
    uint32_t *rim; /* by new vertex: a corner of its hole */
    size_t centre_count, centre_room, rim_room;
    uint32_t (*added)[4]; /* new triangles: corners, and the hole */
    size_t added_room;
    uint8_t *slots; /* by hole */
    size_t slot_room, fill_room;
    uint32_t *visits; /* by position: its place on the path, plus 1 */
    double *least;    /* of the triangulation: areas, and where they divide */
    uint16_t *split;
} repair;

static uint64_t mix(uint64_t h)
{
    h = (h ^ h >> 32) * UINT64_C(0xd6e8feb86659fd93); /* a step of Jon Maiga's mixer */
    return h ^ h >> 32;
}

/* --- joining vertices: a grid of cells as large as the distance --- */

static int64_t cell_of(double x, double size)
{
    return (int64_t)fmax(fmin(floor(x / size), 0x1p60), -0x1p60);
}

static uint64_t cell_hash(int64_t x, int64_t y, int64_t z)
{
    return mix(mix(mix((uint64_t)x) + (uint64_t)y) + (uint64_t)z);
}

/* The first of the vertices kept so far within the distance, or v. heads and next are lists of these by cell. */
static uint32_t near_vertex(const mesh *m, uint32_t v, double weld, const uint32_t *heads, const uint32_t *next,
                            uint64_t mask)
{
    const vec3 p = m->vertices[v];
    uint32_t found = v;
    for (int i = 0; i < 27; i++) {
        const uint64_t hash = cell_hash(cell_of(p.x, weld) + i % 3 - 1, cell_of(p.y, weld) + i / 3 % 3 - 1,
                                        cell_of(p.z, weld) + i / 9 - 1);
        for (uint32_t at = heads[hash & mask]; at != UINT32_MAX; at = next[at])
            if (at < found && vec3_length(vec3_sub(m->vertices[at], p)) <= weld)
                found = at;
    }
    return found;
}

/* Moves vertices in place. */
static status weld_vertices(mesh *m, double weld, size_t *welded, diagnostic *why)
{
    size_t size = 16;
    while (size < m->vertex_count)
        size *= 2;
    uint32_t *heads = malloc(size * sizeof *heads), *next = malloc((m->vertex_count + 1) * sizeof *next);
    status code = heads && next ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK)
        memset(heads, 0xff, size * sizeof *heads);
    for (size_t v = 0; code == STATUS_OK && v < m->vertex_count && !cancel_asked_at(v); v++) {
        const vec3 p = m->vertices[v];
        const uint32_t found = near_vertex(m, (uint32_t)v, weld, heads, next, size - 1), at = (uint32_t)v;
        if (found == at) {
            uint32_t *head = &heads[cell_hash(cell_of(p.x, weld), cell_of(p.y, weld), cell_of(p.z, weld)) & (size - 1)];
            next[v] = *head;
            *head = at;
        }
        const vec3 q = m->vertices[found];
        *welded += p.x != q.x || p.y != q.y || p.z != q.z;
        m->vertices[v] = q;
    }
    free(heads);
    free(next);
    THEN(code, cancel_check(why));
    return code;
}

/* --- dropping triangles --- */

static void sort_three(uint32_t c[3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++)
            if (c[k] > c[k + 1]) {
                const uint32_t swapped = c[k];
                c[k] = c[k + 1];
                c[k + 1] = swapped;
            }
}

/* Whether an earlier triangle has the corners; enters them into the table of size mask + 1 if not. */
static bool has_been(uint32_t (*table)[3], uint64_t mask, const uint32_t c[3])
{
    uint64_t at = mix(mix(mix(c[0]) + c[1]) + c[2]) & mask;
    while (table[at][1]) { /* the middle one of three different numbers is not 0 */
        if (memcmp(table[at], c, sizeof table[at]) == 0)
            return true;
        at = (at + 1) & mask;
    }
    memcpy(table[at], c, sizeof table[at]);
    return false;
}

static status drop_triangles(repair *r, diagnostic *why)
{
    mesh *m = r->m;
    size_t size = 16, kept = 0;
    while (size < 2 * m->triangle_count)
        size *= 2;
    uint32_t *same, (*table)[3] = large_calloc(size, sizeof *table);
    if (!table)
        return diagnose(why, STATUS_FAILURE, CRAMPED, "out of memory for a mesh");
    status code = mesh_weld(m, &same, why);
    for (size_t t = 0; code == STATUS_OK && t < m->triangle_count && !cancel_asked_at(t); t++) {
        const mesh_triangle one = m->triangles[t];
        uint32_t c[3] = {same[one.corner[0]], same[one.corner[1]], same[one.corner[2]]};
        sort_three(c);
        const bool degenerate = c[0] == c[1] || c[1] == c[2], twice = !degenerate && has_been(table, size - 1, c);
        r->counts->degenerate += degenerate;
        r->counts->duplicate += twice;
        if (degenerate || twice)
            continue;
        if (m->slots)
            m->slots[kept] = m->slots[t];
        m->triangles[kept++] = one;
    }
    free(table);
    free(same);
    THEN(code, cancel_check(why));
    m->triangle_count = code == STATUS_OK ? kept : m->triangle_count;
    return code;
}

/* --- edges where more than two triangles meet: readers divide two quadrilaterals between two corners alike --- */

enum { SHARING_MAX = 16, SWAPS_MAX = 64 };

static uint32_t begin_of(const repair *r, size_t half)
{
    return r->n.same[r->m->triangles[half / 3].corner[half % 3]];
}

static uint32_t next_half(uint32_t half)
{
    return half % 3 == 2 ? half - 2 : half + 1;
}

/* The half-edges between two positions, at most SHARING_MAX. */
static size_t halves_between(const repair *r, uint32_t a, uint32_t b, uint32_t *found)
{
    size_t count = 0;
    for (uint32_t h = 0; h < 3 * r->m->triangle_count && count < SHARING_MAX; h++) {
        const uint32_t from = begin_of(r, h), to = begin_of(r, next_half(h));
        if ((from == a && to == b) || (from == b && to == a))
            found[count++] = h;
    }
    return count;
}

/* Divides the quadrilateral of two triangles on both sides of an edge by its other diagonal, unless that is an edge. */
static bool swap_diagonal(repair *r, uint32_t one, uint32_t other)
{
    const uint32_t far[2] = {next_half(next_half(one)), next_half(next_half(other))};
    uint32_t unused[SHARING_MAX];
    if (begin_of(r, one) == begin_of(r, other) || begin_of(r, far[0]) == begin_of(r, far[1]) ||
        halves_between(r, begin_of(r, far[0]), begin_of(r, far[1]), unused) > 0)
        return false;
    mesh_triangle *t = &r->m->triangles[one / 3], *u = &r->m->triangles[other / 3];
    const uint32_t a = t->corner[one % 3], b = u->corner[other % 3], c = t->corner[far[0] % 3],
                   d = u->corner[far[1] % 3];
    *t = (mesh_triangle){{c, a, d}};
    *u = (mesh_triangle){{d, b, c}};
    r->counts->swapped++;
    return true;
}

/* The two triangles of a quadrilateral follow each other in the file. */
static bool swap_at(repair *r, uint32_t crowded)
{
    uint32_t halves[SHARING_MAX];
    const size_t count = halves_between(r, begin_of(r, crowded), begin_of(r, next_half(crowded)), halves);
    for (size_t i = count; i-- > 1;)
        if (halves[i] / 3 == halves[i - 1] / 3 + 1 && swap_diagonal(r, halves[i - 1], halves[i]))
            return true;
    return false;
}

static status find_neighbours(repair *r, diagnostic *why)
{
    TRY(mesh_neighbours_make(r->m, &r->n, why));
    for (int i = 0; i < SWAPS_MAX && r->n.crowded != SIZE_MAX && swap_at(r, (uint32_t)r->n.crowded); i++) {
        mesh_neighbours_free(&r->n);
        TRY(mesh_neighbours_make(r->m, &r->n, why));
    }
    return STATUS_OK;
}

/* --- edges --- */

static uint64_t edge_key(const repair *r, uint32_t a, uint32_t b)
{
    const uint64_t one = r->n.same[a], other = r->n.same[b];
    return one < other ? one << 32 | other : other << 32 | one; /* not 0: the two differ */
}

static bool has_edge(const repair *r, uint64_t key)
{
    uint64_t at = mix(key) & (r->edge_room - 1);
    while (r->edges[at] && r->edges[at] != key)
        at = (at + 1) & (r->edge_room - 1);
    return r->edges[at];
}

/* The table has room for every edge of the result: see list_edges. */
static void add_edge(repair *r, uint64_t key)
{
    uint64_t at = mix(key) & (r->edge_room - 1);
    while (r->edges[at] && r->edges[at] != key)
        at = (at + 1) & (r->edge_room - 1);
    r->edges[at] = key;
}

static status list_edges(repair *r, diagnostic *why)
{
    r->edge_room = 16;
    while (r->edge_room < 12 * r->m->triangle_count) /* a hole has less diagonals than edges */
        r->edge_room *= 2;
    if (!(r->edges = large_calloc(r->edge_room, sizeof *r->edges)))
        return diagnose(why, STATUS_FAILURE, CRAMPED, "out of memory for the edges of a mesh");
    for (size_t t = 0; t < r->m->triangle_count && !cancel_asked_at(t); t++)
        for (int k = 0; k < 3; k++)
            add_edge(r, edge_key(r, r->m->triangles[t].corner[k], r->m->triangles[t].corner[(k + 1) % 3]));
    return cancel_check(why);
}

/* --- filling a hole --- */

static double area_of(const mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    const vec3 from = m->vertices[a];
    return vec3_length(vec3_cross(vec3_sub(m->vertices[b], from), vec3_sub(m->vertices[c], from)));
}

static status add_triangle(repair *r, uint32_t a, uint32_t b, uint32_t c, diagnostic *why)
{
    if (!GROW(r->added, r->added_room, r->counts->triangles + 1))
        return out_of_memory(why);
    memcpy(r->added[r->counts->triangles++], (uint32_t[4]){a, b, c, (uint32_t)r->counts->holes - 1}, sizeof *r->added);
    return STATUS_OK;
}

/* least[i n + j]: the least area of a triangulation of corners i to j, by their number in rising order. Returns whether
 * there is one without an edge that the mesh has. */
static bool triangulate(repair *r, const uint32_t *c, size_t n)
{
    for (size_t length = 1; length < n && !cancel_asked(); length++)
        for (size_t i = 0; i + length < n; i++) {
            const size_t j = i + length;
            const bool inner = length > 1 && length < n - 1;
            double best = length == 1 ? 0.0 : INFINITY;
            size_t at = i;
            if (!inner || !has_edge(r, edge_key(r, c[i], c[j])))
                for (size_t k = i + 1; k < j; k++) {
                    const double sum = r->least[i * n + k] + r->least[k * n + j] + area_of(r->m, c[i], c[k], c[j]);
                    if (sum < best)
                        best = sum, at = k;
                }
            r->least[i * n + j] = best;
            r->split[i * n + j] = (uint16_t)at;
        }
    return r->least[n - 1] < INFINITY && !cancel_asked();
}

/* Adds the triangles of corners i to j. */
static status add_part(repair *r, const uint32_t *c, size_t n, size_t i, size_t j, diagnostic *why)
{
    if (j - i < 2)
        return STATUS_OK;
    const size_t k = r->split[i * n + j];
    if (j - i < n - 1)
        add_edge(r, edge_key(r, c[i], c[j]));
    TRY(add_triangle(r, c[i], c[k], c[j], why));
    TRY(add_part(r, c, n, i, k, why));
    return add_part(r, c, n, k, j, why);
}

static status add_fan(repair *r, const uint32_t *c, size_t n, diagnostic *why)
{
    if (!GROW(r->centres, r->centre_room, r->centre_count + 1) || !GROW(r->rim, r->rim_room, r->centre_count + 1))
        return out_of_memory(why);
    vec3 sum = vec3_make(0.0, 0.0, 0.0);
    for (size_t i = 0; i < n; i++)
        sum = vec3_add(sum, r->m->vertices[c[i]]);
    r->centres[r->centre_count] = vec3_scale(sum, 1.0 / (double)n);
    r->rim[r->centre_count] = c[0];
    const uint32_t centre = (uint32_t)(r->m->vertex_count + r->centre_count++);
    for (size_t i = 0; i < n; i++)
        TRY(add_triangle(r, c[i], c[(i + 1) % n], centre, why));
    return STATUS_OK;
}

static double span_of(const mesh *m, const uint32_t *c, size_t n)
{
    vec3 low = m->vertices[c[0]], high = low;
    for (size_t i = 1; i < n; i++) {
        const vec3 p = m->vertices[c[i]];
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    return fmax(fmax(high.x - low.x, high.y - low.y), high.z - low.z);
}

/* Fills the hole with corners c, at a triangle of that slot. */
static status fill(repair *r, const uint32_t *c, size_t n, uint8_t slot, diagnostic *why)
{
    mesh_repairs *counts = r->counts;
    if (!GROW(counts->fills, r->fill_room, counts->holes + 1) || !GROW(r->slots, r->slot_room, counts->holes + 1))
        return out_of_memory(why);
    counts->fills[counts->holes] = (struct mesh_fill){n, span_of(r->m, c, n)};
    r->slots[counts->holes++] = slot;
    if (n <= TRIANGULATED_MAX && triangulate(r, c, n))
        return add_part(r, c, n, 0, n - 1, why);
    TRY(cancel_check(why));
    return add_fan(r, c, n, why);
}

/* --- finding holes --- */

/* The boundary's half-edge that begins where this one ends: the last of the triangles around that corner. */
static uint32_t next_on_boundary(const repair *r, uint32_t half)
{
    uint32_t at = next_half(half);
    while (r->n.mates[at] != UINT32_MAX)
        at = next_half(r->n.mates[at]);
    return at;
}

/* Fills what a path around a hole encloses. Where the path comes to a position again, the loop since then is a hole of
 * its own. The new triangles run against the path: corners are stored from the end of the array. */
static status fill_along(repair *r, uint32_t first, uint8_t *seen, diagnostic *why)
{
    const mesh *m = r->m;
    size_t length = 0;
    status code = STATUS_OK;
    uint32_t half = first, *path = r->loop, *reversed = r->loop + r->loop_room / 2;
    do {
        const uint32_t v = m->triangles[half / 3].corner[half % 3];
        uint32_t *visit = &r->visits[r->n.same[v]];
        if (*visit) {
            const size_t begin = *visit - 1, n = length - begin;
            for (size_t i = 0; i < n; i++) {
                reversed[i] = path[length - 1 - i];
                r->visits[r->n.same[path[length - 1 - i]]] = 0;
            }
            THEN(code, fill(r, reversed, n, m->slots ? m->slots[half / 3] : 0, why));
            length = begin;
        }
        seen[half] = 1;
        path[length++] = v;
        *visit = (uint32_t)length;
        half = next_on_boundary(r, half);
    } while (half != first && code == STATUS_OK);
    for (size_t i = 0; i < length; i++) {
        reversed[i] = path[length - 1 - i];
        r->visits[r->n.same[path[i]]] = 0;
    }
    THEN(code, fill(r, reversed, length, m->slots ? m->slots[first / 3] : 0, why));
    return code;
}

static status fill_holes(repair *r, diagnostic *why)
{
    const size_t halves = 3 * r->m->triangle_count;
    size_t open = 0;
    for (size_t h = 0; h < halves; h++)
        open += r->n.mates[h] == UINT32_MAX;
    if (open == 0)
        return STATUS_OK;
    enum { SQUARE = TRIANGULATED_MAX * TRIANGULATED_MAX };
    r->loop_room = 2 * (open + 1);
    r->loop = malloc(r->loop_room * sizeof *r->loop);
    r->visits = calloc(r->m->vertex_count + 1, sizeof *r->visits);
    r->least = malloc(SQUARE * sizeof *r->least);
    r->split = malloc(SQUARE * sizeof *r->split);
    uint8_t *seen = calloc(halves, 1);
    status code = r->loop && r->visits && r->least && r->split && seen ? list_edges(r, why) : out_of_memory(why);
    for (size_t h = 0; h < halves && code == STATUS_OK && !cancel_asked_at(h); h++)
        if (r->n.mates[h] == UINT32_MAX && !seen[h])
            code = fill_along(r, (uint32_t)h, seen, why);
    free(seen);
    THEN(code, cancel_check(why));
    return code;
}

/* --- the result --- */

static status refuse(const mesh *m, size_t half, const char *what, const char *remedy, diagnostic *why)
{
    const uint32_t *corner = m->triangles[half / 3].corner;
    const vec3 a = m->vertices[corner[half % 3]], b = m->vertices[corner[(half + 1) % 3]];
    return diagnose(why, STATUS_BAD_INPUT, remedy,
                    "the mesh cannot be closed: at the edge from (%g, %g, %g) to (%g, %g, "
                    "%g) %s",
                    a.x, a.y, a.z, b.x, b.y, b.z, what);
}

/* A vertex of the result from one of the repaired mesh. */
typedef struct vertex_copy {
    uint32_t from;
    bool flat; /* without its normal */
} vertex_copy;

/* The copies of the vertices that triangles use, and the corners of all triangles in these; copies and corners have
 * room. Returns the number of copies. */
static size_t number_vertices(const repair *r, uint32_t *number, vertex_copy *copies, mesh_triangle *corners)
{
    const mesh *m = r->m;
    const size_t all = m->triangle_count + r->counts->triangles;
    size_t count = 0;
    size_t begin = 0; /* of the copies that can be used again */
    uint32_t hole = UINT32_MAX;
    for (size_t t = 0; t < all; t++) {
        const uint32_t *added = t < m->triangle_count ? NULL : r->added[t - m->triangle_count];
        if (added && m->normals && added[3] != hole) { /* vertices of its own for each hole */
            for (; begin < count; begin++)
                number[copies[begin].from] = 0;
            hole = added[3];
        }
        for (int k = 0; k < 3; k++) {
            const uint32_t v = added ? added[k] : m->triangles[t].corner[k],
                           from = m->normals || m->uvs || m->colors || v >= m->vertex_count ? v : r->n.same[v];
            if (!number[from]) {
                copies[count] = (vertex_copy){from, added};
                number[from] = (uint32_t)++count;
            }
            corners[t].corner[k] = number[from] - 1;
        }
    }
    return count;
}

static void fill_vertices(const repair *r, const vertex_copy *copies, mesh *out)
{
    const mesh *m = r->m;
    for (size_t v = 0; v < out->vertex_count; v++) {
        const uint32_t from = copies[v].from;
        const bool centre = from >= m->vertex_count;
        const uint32_t like = centre ? r->rim[from - m->vertex_count] : from;
        out->vertices[v] = centre ? r->centres[from - m->vertex_count] : m->vertices[from];
        if (out->normals && !copies[v].flat) /* a zero normal becomes the triangle's */
            out->normals[v] = m->normals[from];
        if (out->uvs)
            out->uvs[v] = m->uvs[like];
        if (out->colors)
            memcpy(out->colors[v], m->colors[like], sizeof *out->colors);
    }
}

static status assemble(const repair *r, mesh **out, diagnostic *why)
{
    const mesh *m = r->m;
    const size_t all = m->triangle_count + r->counts->triangles, most = m->vertex_count + r->centre_count;
    uint32_t *number = calloc(most + 1, sizeof *number);
    vertex_copy *copies = malloc((most + 3 * r->counts->triangles + 1) * sizeof *copies);
    mesh_triangle *corners = malloc((all + 1) * sizeof *corners);
    status code = number && copies && corners ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK)
        code = mesh_create(number_vertices(r, number, copies, corners), all, m->normals, m->uvs, m->slots, out, why);
    if (code == STATUS_OK && m->colors)
        code = mesh_add_colors(*out, why);
    if (code == STATUS_OK) {
        memcpy((*out)->triangles, corners, all * sizeof *corners);
        fill_vertices(r, copies, *out);
        (*out)->slot_count = m->slot_count;
        for (size_t t = 0; m->slots && t < all; t++)
            (*out)->slots[t] = t < m->triangle_count ? m->slots[t] : r->slots[r->added[t - m->triangle_count][3]];
        for (int i = 0; i < m->slot_count && code == STATUS_OK; i++)
            if (m->slot_names[i] && !((*out)->slot_names[i] = strdup(m->slot_names[i])))
                code = out_of_memory(why);
    }
    free(number);
    free(copies);
    THEN(code, mesh_finish(*out, why));
    if (code == STATUS_OK && (*out)->triangles[0].corner[1] != corners[0].corner[1]) /* all were turned over */
        r->counts->turned = m->triangle_count - r->counts->turned;
    free(corners);
    return code;
}

static status copy_of(const mesh *m, mesh **out, diagnostic *why)
{
    TRY(mesh_create(m->vertex_count, m->triangle_count, m->normals, m->uvs, m->slots, out, why));
    memcpy((*out)->vertices, m->vertices, m->vertex_count * sizeof *m->vertices);
    memcpy((*out)->triangles, m->triangles, m->triangle_count * sizeof *m->triangles);
    if (m->normals)
        memcpy((*out)->normals, m->normals, m->vertex_count * sizeof *m->normals);
    if (m->uvs)
        memcpy((*out)->uvs, m->uvs, m->vertex_count * sizeof *m->uvs);
    if (m->colors) {
        TRY(mesh_add_colors(*out, why));
        memcpy((*out)->colors, m->colors, m->vertex_count * sizeof *m->colors);
    }
    if (m->slots)
        memcpy((*out)->slots, m->slots, m->triangle_count);
    (*out)->slot_count = m->slot_count;
    for (int i = 0; i < m->slot_count; i++)
        if (m->slot_names[i] && !((*out)->slot_names[i] = strdup(m->slot_names[i])))
            return out_of_memory(why);
    return STATUS_OK;
}

/* Whether welding moved an end of the edge in one of its triangles. */
static bool is_welded(const repair *r, size_t half)
{
    uint32_t halves[SHARING_MAX];
    const size_t count = halves_between(r, begin_of(r, half), begin_of(r, next_half((uint32_t)half)), halves);
    bool moved = false;
    for (size_t i = 0; i < 2 * count; i++) {
        const uint32_t at = i % 2 ? next_half(halves[i / 2]) : halves[i / 2],
                       v = r->m->triangles[at / 3].corner[at % 3];
        moved |= vec3_length(vec3_sub(r->m->vertices[v], r->given->vertices[v])) > 0.0;
    }
    return moved;
}

/* That triangles are left, and an edge belongs to at most two of them. */
static status check_triangles(const repair *r, diagnostic *why)
{
    if (r->m->triangle_count == 0)
        return diagnose(why, STATUS_BAD_INPUT,
                        r->counts->welded ? "use a smaller distance to weld"
                                          : "give a mesh with triangles that have an area",
                        "the mesh cannot be closed: all triangles have two equal corners");
    if (r->n.crowded == SIZE_MAX)
        return STATUS_OK;
    return refuse(r->m, r->n.crowded, "more than two triangles meet",
                  is_welded(r, r->n.crowded)
                      ? "separate the parts, or remove the faces that they share, or use another distance to weld"
                      : "separate the parts, or remove the faces that they share",
                  why);
}

/* A flat piece is filled by its own triangles turned over. Its volume is 0 but for rounding. */
static status check_volume(const repair *r, const mesh *m, diagnostic *why)
{
    const vec3 size = vec3_sub(m->bounds.high, m->bounds.low);
    if (r->counts->holes == 0 || fabs(mesh_volume(m)) > 0x1p-44 * mesh_area(m) * vec3_length(size))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "give a mesh that is not flat",
                    "the mesh cannot be closed: the result has a volume of 0");
}

/* A mesh whose shells touch is closed as it is: *out is a copy then, otherwise NULL. */
static status keep_crowded(const repair *r, mesh **out, diagnostic *why)
{
    mesh *one = NULL;
    status code = copy_of(r->m, &one, why);
    THEN(code, mesh_finish(one, why));
    if (code == STATUS_OK && one->crowded) {
        *out = one;
        return STATUS_OK;
    }
    mesh_release(one);
    return code;
}

/* The steps on the copy. */
static status make_whole(repair *r, double weld, mesh **out, diagnostic *why)
{
    size_t against;
    if (weld > 0.0)
        TRY(weld_vertices(r->m, weld, &r->counts->welded, why));
    if (weld > 0.0 || r->given->crowded)
        TRY(keep_crowded(r, out, why));
    if (*out)
        return STATUS_OK;
    TRY(drop_triangles(r, why));
    TRY(find_neighbours(r, why));
    TRY(check_triangles(r, why));
    TRY(mesh_turn_alike(r->m, r->n.same, r->n.mates, &r->counts->turned, &against, why));
    if (against != SIZE_MAX)
        return refuse(r->m, against, "the surface turns its other side, as a Moebius strip does", "cut it", why);
    mesh_neighbours_free(&r->n);
    TRY(mesh_neighbours_make(r->m, &r->n, why));
    TRY(fill_holes(r, why));
    TRY(assemble(r, out, why));
    const mesh_hole *hole = &(*out)->hole;
    return (*out)->closed
               ? check_volume(r, *out, why)
               : refuse(*out, 3 * hole->triangle, "it remains open", "report this as a bug, with the file", why);
}

status mesh_repair(const mesh *m, double weld, mesh_repairs *repairs, mesh **out, diagnostic *why)
{
    *repairs = (mesh_repairs){0};
    *out = NULL;
    const vec3 low = m->bounds.low, high = m->bounds.high;
    const double extent = fmax(fmax(high.x - low.x, high.y - low.y), high.z - low.z),
                 far = fmax(fmax(fmax(fabs(low.x), fabs(high.x)), fmax(fabs(low.y), fabs(high.y))),
                            fmax(fabs(low.z), fabs(high.z)));
    if (m->triangle_count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh with triangles", "the mesh has no triangles");
    if (weld > 0.0 && !(weld < extent && far / weld < 0x1p50))
        return diagnose(why, STATUS_BAD_INPUT, "use a distance well below the size of the mesh, or 0",
                        "vertices of a mesh of size %g cannot be welded within %g", extent, weld);
    repair r = {.given = m, .counts = repairs};
    status code = copy_of(m, &r.m, why);
    THEN(code, make_whole(&r, weld, out, why));
    mesh_release(r.m);
    mesh_neighbours_free(&r.n);
    free(r.edges);
    free(r.loop);
    free(r.centres);
    free(r.rim);
    free(r.added);
    free(r.slots);
    free(r.visits);
    free(r.least);
    free(r.split);
    if (code != STATUS_OK) {
        mesh_release(*out);
        *out = NULL;
    }
    return code;
}
