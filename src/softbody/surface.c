/* The toy's surface as a mesh, and ray intersection with it. */
#include "geometry/mesh_generators.h"
#include "softbody/softbody_private.h"

#include <stdlib.h>

/* The doubled sum of the area vectors of the faces around each mass: area weighting needs no angles. */
static void sum_areas(const softbody *b, vec3 *area)
{
    for (size_t i = 0; i < b->face_count; i++) {
        const uint32_t *corner = b->faces[i].corner;
        const vec3 a = vectors_at(b->at, corner[0]);
        const vec3 n = vec3_cross(vec3_sub(vectors_at(b->at, corner[1]), a), vec3_sub(vectors_at(b->at, corner[2]), a));
        for (int k = 0; k < 3; k++)
            area[corner[k]] = vec3_add(area[corner[k]], n);
    }
}

status softbody_move_surface(const softbody *b, mesh *surface, diagnostic *why)
{
    vec3 *area = calloc(b->net.count, sizeof *area), *vertices = malloc(surface->vertex_count * sizeof *vertices);
    vec3 *normals = malloc(surface->vertex_count * sizeof *normals);
    status code = STATUS_FAILURE;
    if (area && vertices && normals) {
        sum_areas(b, area);
        for (size_t v = 0; v < surface->vertex_count; v++) {
            vertices[v] = vectors_at(b->at, b->mass_of[v]);
            normals[v] = area[b->mass_of[v]];
        }
        code = mesh_move(surface, vertices, normals, why);
    } else {
        diagnose(why, code, "use a lower level", "out of memory for a slime's surface");
    }
    free(area);
    free(vertices);
    free(normals);
    return code;
}

status softbody_surface(const softbody *b, mesh **out, diagnostic *why)
{
    *out = NULL;
    if (b->surface_level < 0)
        return diagnose(why, STATUS_BAD_INPUT, "use a slime toy", "a net of masses and springs has no surface");
    mesh *surface;
    status code = generate_icosphere(b->surface_level, &surface, why);
    if (code == STATUS_OK && (code = softbody_move_surface(b, surface, why)) != STATUS_OK)
        mesh_release(surface);
    *out = code == STATUS_OK ? surface : NULL;
    return code;
}

/* Moller and Trumbore, "Fast, minimum storage ray/triangle intersection", JGT 2(1), 1997; front faces only. slack:
 * tolerance beyond an edge, as a fraction of the face. */
static bool meets(const softbody *b, const mesh_triangle *face, double slack, vec3 origin, vec3 direction, double *t)
{
    const vec3 a = vectors_at(b->at, face->corner[0]);
    const vec3 p = vec3_sub(vectors_at(b->at, face->corner[1]), a), q = vec3_sub(vectors_at(b->at, face->corner[2]), a);
    const vec3 across = vec3_cross(direction, q);
    const double det = vec3_dot(p, across);
    if (!(det > 0.0))
        return false;
    const vec3 away = vec3_sub(origin, a);
    const double u = vec3_dot(away, across);
    const vec3 turned = vec3_cross(away, p);
    const double v = vec3_dot(direction, turned);
    *t = vec3_dot(q, turned) / det;
    const double beyond = slack * det;
    return u >= -beyond && v >= -beyond && u + v <= det + beyond && *t >= 0.0;
}

static double nearest_front(const softbody *b, double slack, vec3 origin, vec3 direction)
{
    double nearest = INFINITY, t;
    for (size_t i = 0; i < b->face_count; i++)
        if (meets(b, &b->faces[i], slack, origin, direction, &t) && t < nearest)
            nearest = t;
    return nearest;
}

bool softbody_pick(const softbody *b, vec3 origin, vec3 direction, vec3 *where)
{
    double nearest = nearest_front(b, 0.0, origin, direction);
    if (!(nearest < INFINITY)) /* along an edge rounding can miss both faces */
        nearest = nearest_front(b, 1e-9, origin, direction);
    if (nearest < INFINITY)
        *where = vec3_add(origin, vec3_scale(direction, nearest));
    return nearest < INFINITY;
}
