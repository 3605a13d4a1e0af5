/* Normals by vertex, weighted by angle: Thurmer and Wuthrich, "Computing vertex normals from polygonal facets", JGT
 * 3(1), 1998. */
#include "base/elementary.h"
#include "geometry/mesh_parts.h"

#include <stdlib.h>

/* Angle at a corner between its two edges, in degrees: the unit of the weights does not matter. */
static double angle_deg(const mesh *m, const uint32_t *corner, int k)
{
    const vec3 at = m->vertices[corner[k]];
    const vec3 a = vec3_sub(m->vertices[corner[(k + 1) % 3]], at), b = vec3_sub(m->vertices[corner[(k + 2) % 3]], at);
    return elementary_atan2_deg(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

status mesh_smooth(mesh *m, diagnostic *why)
{
    if (m->normals)
        return STATUS_OK;
    status result = mesh_check(m, why);
    uint32_t *same = NULL;
    if (result == STATUS_OK)
        result = mesh_weld(m, &same, why);
    if (result != STATUS_OK)
        return result;
    vec3 *normals = calloc(m->vertex_count + 1, sizeof *normals);
    if (!normals) {
        free(same);
        return diagnose(why, STATUS_FAILURE, "use fewer triangles", "out of memory for the normals of a mesh");
    }
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *corner = m->triangles[t].corner;
        vec3 normal;
        for (int k = 0; k < 3 && mesh_triangle_normal(m, t, &normal); k++) {
            vec3 *sum = &normals[same[corner[k]]];
            *sum = vec3_add(*sum, vec3_scale(normal, angle_deg(m, corner, k)));
        }
    }
    for (size_t v = 0; v < m->vertex_count; v++)
        normals[v] = normals[same[v]];
    free(same);
    m->normals = normals;
    mesh_normalize(m);
    return STATUS_OK;
}
