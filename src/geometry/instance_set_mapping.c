/* Texture coordinates where rays hit meshes. */
#include "geometry/instance_set.h"

#include "base/lanes.h"

/* A triangle's edges from its first corner, its normal, and the length of their cross product. */
typedef struct edge_pair {
    vec3 b, c, n;
    double area2;
} edge_pair;

static edge_pair edges_of(const instanced_mesh *p, mesh_triangle tri)
{
    const vec3 o = instance_set_vertex_offset(p, tri.corner[0]);
    edge_pair e = {.b = vec3_sub(instance_set_vertex_offset(p, tri.corner[1]), o),
                   .c = vec3_sub(instance_set_vertex_offset(p, tri.corner[2]), o)};
    const vec3 across = vec3_cross(e.b, e.c);
    e.area2 = vec3_length(across);
    e.n = e.area2 > 0.0 ? vec3_scale(across, 1.0 / e.area2) : across;
    return e;
}

/* Length of the gradient across the triangle of a value that is 0 at the first corner, and at_b and at_c at the
 * others. */
static double steepness(const edge_pair *e, double at_b, double at_c)
{
    const vec3 along = vec3_add(vec3_scale(vec3_cross(e->c, e->n), at_b), vec3_scale(vec3_cross(e->n, e->b), at_c));
    return vec3_length(along) / e->area2;
}

surface_mapping instance_set_mapping(const instance_set *f, const instance_hit *hit)
{
    const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(hit->face)]];
    const mesh *m = p->triangles;
    if (!m->uvs)
        return (surface_mapping){0.0, 0.0, 0.0};
    const mesh_triangle tri = m->triangles[mesh_face_triangle(hit->face)];
    const edge_pair e = edges_of(p, tri);
    const mesh_uv a = m->uvs[tri.corner[0]], b = m->uvs[tri.corner[1]], c = m->uvs[tri.corner[2]];
    const double bu = b.u - a.u, bv = b.v - a.v, cu = c.u - a.u, cv = c.v - a.v;
    return (surface_mapping){a.u + bu * hit->u + cu * hit->v, a.v + bv * hit->u + cv * hit->v,
                             e.area2 > 0.0 ? greater(steepness(&e, bu, cu), steepness(&e, bv, cv)) : 0.0};
}
