/* Points, normals and texture coordinates where rays hit meshes. */
#include "geometry/instance_set.h"

#include "base/lanes.h"

typedef struct corner_set {
    vec3 a, b, c;
} corner_set; /* a triangle's corners, scaled and rotated to the world's axes */

static vec3 turned(const instanced_mesh *p, vec3 v)
{
    const vec3 scaled = p->scaled ? vec3_make(v.x * p->scale.x, v.y * p->scale.y, v.z * p->scale.z) : v;
    return p->turned ? mat3_apply(p->rotation, scaled) : scaled;
}

static vec3 mix(vec3 a, vec3 b, vec3 c, double u, double v)
{
    return vec3_add(a, vec3_add(vec3_scale(vec3_sub(b, a), u), vec3_scale(vec3_sub(c, a), v)));
}

/* The interpolated normal, bent towards the geometric normal where necessary so that a mirror reflects the ray out of
 * the surface: the halfway vector of the ray and the outgoing direction raised to just above the surface (Keller et
 * al., "The Iray light transport simulation and rendering system", 2017, A.3). All are unit vectors; d . g < 0. */
static vec3 bent_normal(vec3 n, vec3 g, vec3 d)
{
    const double least = 0.01; /* sine of the least angle of a reflected ray with the triangle, 0.6 degrees */
    const vec3 mirrored = vec3_sub(d, vec3_scale(n, 2.0 * vec3_dot(d, n)));
    const double above = vec3_dot(mirrored, g);
    if (above >= least)
        return n;
    const vec3 raised = vec3_normalize(vec3_add(mirrored, vec3_scale(g, least - above)));
    const vec3 half = vec3_sub(raised, d);
    const double length = vec3_length(half);
    return length > 0.0 ? vec3_scale(half, 1.0 / length) : g;
}

static vec3 smooth_normal(const instanced_mesh *p, mesh_triangle tri, double u, double v, vec3 g, vec3 d)
{
    const vec3 a = instance_set_vertex_normal(p, tri.corner[0]), b = instance_set_vertex_normal(p, tri.corner[1]),
               c = instance_set_vertex_normal(p, tri.corner[2]);
    vec3 n = mix(a, b, c, u, v);
    const double length = vec3_length(n), side = vec3_dot(n, g);
    /* Unit normals at the corners that cancel give no direction. */
    if (!(length > 1e-12) || side == 0.0)
        return g;
    n = vec3_scale(n, (side < 0.0 ? -1.0 : 1.0) / length); /* on the ray's side, like the geometric normal */
    return bent_normal(n, g, d);
}

/* A triangle's edges from its first corner, its normal, and the length of their cross product. */
typedef struct edge_pair {
    vec3 b, c, n;
    double area2;
} edge_pair;

/* Length of the gradient across the triangle of a value that is 0 at the first corner, and at_b and at_c at the
 * others. */
static double steepness(const edge_pair *e, double at_b, double at_c)
{
    const vec3 along = vec3_add(vec3_scale(vec3_cross(e->c, e->n), at_b), vec3_scale(vec3_cross(e->n, e->b), at_c));
    return vec3_length(along) / e->area2;
}

/* Texture coordinates, and the larger gradient of u and v per scene unit. */
static void texture_at(const mesh *m, mesh_triangle tri, double u, double v, const edge_pair *e, mesh_points *more,
                       int i)
{
    more->tu[i] = more->tv[i] = more->uv_per_length[i] = 0.0;
    if (!m->uvs)
        return;
    const mesh_uv a = m->uvs[tri.corner[0]], b = m->uvs[tri.corner[1]], c = m->uvs[tri.corner[2]];
    const double bu = b.u - a.u, bv = b.v - a.v, cu = c.u - a.u, cv = c.v - a.v;
    more->tu[i] = a.u + bu * u + cu * v;
    more->tv[i] = a.v + bv * u + cv * v;
    more->uv_per_length[i] = e->area2 > 0.0 ? greater(steepness(e, bu, cu), steepness(e, bv, cv)) : 0.0;
}

static void surface_at(const instance_set *f, const ray_batch *rays, const instance_hit *hit, bool smooth, int i,
                       surface_batch *s, mesh_points *more)
{
    const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(hit->face)]];
    const uint32_t number = mesh_face_triangle(hit->face);
    const mesh_triangle tri = p->triangles->triangles[number];
    const vec3 *vertex = p->triangles->vertices, d = vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]);
    const vec3 a = turned(p, vertex[tri.corner[0]]), b = turned(p, vertex[tri.corner[1]]),
               c = turned(p, vertex[tri.corner[2]]);
    const vec3 o = instance_set_origin(p, mesh_face_copy(hit->face)), at = vec3_add(o, mix(a, b, c, hit->u, hit->v));
    vec3 g = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    const double area2 = vec3_length(g);
    g = area2 > 0.0 ? vec3_scale(g, 1.0 / area2) : vec3_scale(d, -1.0);
    g = vec3_dot(g, d) > 0.0 ? vec3_scale(g, -1.0) : g;
    const vec3 n = smooth && p->triangles->normals ? smooth_normal(p, tri, hit->u, hit->v, g, d) : g;
    s->px[i] = at.x, s->py[i] = at.y, s->pz[i] = at.z;
    s->nx[i] = n.x, s->ny[i] = n.y, s->nz[i] = n.z;
    s->cos_i[i] = greater(-vec3_dot(d, n), 1e-12); /* above 0, also if rounding reverses its sign */
    s->error[i] = POINT_ERROR * (fabs(o.x) + fabs(o.y) + fabs(o.z) + p->reach);
    s->face[i] = hit->face;
    if (!more)
        return;
    more->gx[i] = g.x, more->gy[i] = g.y, more->gz[i] = g.z;
    more->slot[i] = p->triangles->slots ? p->triangles->slots[number] : 0;
    const double weight[3] = {1.0 - hit->u - hit->v, hit->u, hit->v};
    for (int k = 0; k < 3; k++) {
        more->weight[k][i] = weight[k];
        more->corner[k][i] = tri.corner[k];
    }
    const edge_pair edges = {vec3_sub(b, a), vec3_sub(c, a), g, area2};
    texture_at(p->triangles, tri, hit->u, hit->v, &edges, more, i);
}

void instance_set_surface(const instance_set *f, const ray_batch *rays, const instance_hit *hits, bool smooth,
                          surface_batch *points, mesh_points *more)
{
    for (int i = 0; i < rays->count; i++)
        surface_at(f, rays, &hits[i], smooth, i, points, more);
}
