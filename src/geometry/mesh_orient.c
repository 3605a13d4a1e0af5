/* Consistent winding of a mesh by flood fill: neighbouring triangles agree if they run along their common edge in
 * opposite directions. */
#include "base/cancel.h"
#include "geometry/mesh_parts.h"

enum { UNSEEN = 2 }; /* in mesh_neighbours.turned: not reached yet; otherwise 1 if flipped, else 0 */

void mesh_turn(mesh *m, size_t triangle)
{
    uint32_t *corner = m->triangles[triangle].corner;
    const uint32_t second = corner[1];
    corner[1] = corner[2];
    corner[2] = second;
}

static uint32_t begins(const mesh *m, const mesh_neighbours *n, uint32_t half)
{
    return n->same[m->triangles[half / 3].corner[half % 3]];
}

/* Fills the connected part of triangle n->queue[first]. Returns the end of its range of the queue, 0 if neighbours
 * cannot agree. */
static size_t flood(const mesh *m, mesh_neighbours *n, size_t first, size_t *at)
{
    size_t end = first + 1;
    for (size_t i = first; i < end && !cancel_asked_at(i); i++) {
        const uint32_t t = n->queue[i];
        for (uint32_t half = 3 * t; half < 3 * t + 3; half++) {
            const uint32_t mate = n->mates[half], other = mate / 3;
            const bool against = begins(m, n, half) == begins(m, n, mate);
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
static void choose_direction(const mesh *m, mesh_neighbours *n, size_t first, size_t end)
{
    const vec3 middle = m->vertices[m->triangles[n->queue[first]].corner[0]];
    size_t turned = 0;
    double volume6 = 0.0;
    for (size_t i = first; i < end; i++) {
        const uint32_t t = n->queue[i];
        turned += n->turned[t];
        volume6 += (n->turned[t] ? -1.0 : 1.0) * mesh_triangle_volume6(m, t, middle);
    }
    const size_t all = end - first;
    const bool inward = 4 * turned >= 3 * all || (4 * turned > all && volume6 < 0.0);
    for (size_t i = first; inward && i < end; i++)
        n->turned[n->queue[i]] ^= 1;
}

bool mesh_orient(mesh *m, mesh_neighbours *n, size_t *at)
{
    for (size_t t = 0; t < m->triangle_count; t++)
        n->turned[t] = n->mates[3 * t] == UINT32_MAX ? 0 : UNSEEN;
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
            mesh_turn(m, t);
    return true;
}
