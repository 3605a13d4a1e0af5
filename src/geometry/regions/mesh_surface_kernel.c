/* Points and normals where rays hit meshes. One source for all instruction sets, with bit-identical results. */
#include "base/lanes.h"
#include "geometry/regions/instance_set.h"
#include "geometry/regions/kernels.h"

enum { STRIP = 32 };

typedef struct column3 {
    double x[STRIP], y[STRIP], z[STRIP];
} column3;

/* Part of the hits of a batch, padded to full vectors by repeating the last hit. */
typedef struct strip {
    int count;       /* including the padding */
    column3 a, b, c; /* the triangles' corners, scaled and rotated to the world's axes */
    column3 normal_a, normal_b, normal_c;
    column3 origin, d, g, n; /* the copy's origin; the ray's direction; geometric and shading normal */
    double u[STRIP], v[STRIP], reach[STRIP];
    int64_t has_normals[STRIP], bends[STRIP]; /* masks */
} strip;

ALWAYS_INLINE vec3 column_at(const column3 *c, int i)
{
    return vec3_make(c->x[i], c->y[i], c->z[i]);
}
ALWAYS_INLINE void column_put(column3 *c, int i, vec3 v)
{
    c->x[i] = v.x, c->y[i] = v.y, c->z[i] = v.z;
}

static vec3 normal_of(const instanced_mesh *p, uint32_t vertex)
{
    return p->scaled || p->turned ? instance_set_vertex_normal(p, vertex) : p->triangles->normals[vertex];
}

/* Fills the strip from `count` hits, from number `first` on. Returns whether any of them has normals at its corners. */
static bool gather(const instance_set *f, const ray_batch *rays, const instance_hit *hits, bool smooth, int first,
                   int count, strip *s)
{
    bool any = false;
    s->count = (count + LANES_MAX - 1) / LANES_MAX * LANES_MAX;
    for (int k = 0; k < s->count; k++) {
        const int i = first + (k < count ? k : count - 1);
        const instance_hit *hit = &hits[i];
        const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(hit->face)]];
        const uint32_t *corner = p->triangles->triangles[mesh_face_triangle(hit->face)].corner;
        column_put(&s->a, k, instance_set_vertex_offset(p, corner[0]));
        column_put(&s->b, k, instance_set_vertex_offset(p, corner[1]));
        column_put(&s->c, k, instance_set_vertex_offset(p, corner[2]));
        column_put(&s->origin, k, instance_set_origin(p, mesh_face_copy(hit->face)));
        column_put(&s->d, k, vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]));
        s->u[k] = hit->u, s->v[k] = hit->v, s->reach[k] = p->reach;
        const bool has_normals = smooth && p->triangles->normals;
        s->has_normals[k] = mask_of(has_normals);
        any |= has_normals;
        column_put(&s->normal_a, k, has_normals ? normal_of(p, corner[0]) : vec3_make(0.0, 0.0, 0.0));
        column_put(&s->normal_b, k, has_normals ? normal_of(p, corner[1]) : vec3_make(0.0, 0.0, 0.0));
        column_put(&s->normal_c, k, has_normals ? normal_of(p, corner[2]) : vec3_make(0.0, 0.0, 0.0));
    }
    return any;
}

ALWAYS_INLINE vec3 mix(vec3 a, vec3 b, vec3 c, double u, double v)
{
    return vec3_add(a, vec3_add(vec3_scale(vec3_sub(b, a), u), vec3_scale(vec3_sub(c, a), v)));
}

ALWAYS_INLINE vec3 blend3(int64_t mask, vec3 a, vec3 b)
{
    return vec3_make(blend(mask, a.x, b.x), blend(mask, a.y, b.y), blend(mask, a.z, b.z));
}

/* Points and their error bounds, and geometric normals against the rays. */
static void find_points(strip *restrict s, int first, surface_batch *restrict to)
{
    double *restrict px = to->px + first, *restrict py = to->py + first, *restrict pz = to->pz + first,
                     *restrict error = to->error + first;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < s->count; i++) {
        const vec3 a = column_at(&s->a, i), b = column_at(&s->b, i), c = column_at(&s->c, i);
        const vec3 o = column_at(&s->origin, i), d = column_at(&s->d, i);
        const vec3 at = vec3_add(o, mix(a, b, c, s->u[i], s->v[i]));
        px[i] = at.x, py[i] = at.y, pz[i] = at.z;
        error[i] = POINT_ERROR * (magnitude(o.x) + magnitude(o.y) + magnitude(o.z) + s->reach[i]);
        const vec3 across = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
        const double area2 = vec3_length(across);
        const int64_t flat = mask_less(0.0, area2);
        const vec3 unit = blend3(flat, vec3_scale(across, 1.0 / blend(flat, area2, 1.0)), vec3_scale(d, -1.0));
        const vec3 g = blend3(mask_less(0.0, vec3_dot(unit, d)), vec3_scale(unit, -1.0), unit);
        s->g.x[i] = s->n.x[i] = g.x, s->g.y[i] = s->n.y[i] = g.y, s->g.z[i] = s->n.z[i] = g.z;
    }
}

#define LEAST_SINE 0.01 /* sine of the least angle between a reflected ray and the triangle, 0.6 degrees */

/* Interpolates normals, on the ray's side like the geometric normal, which replaces them if the corners' normals
 * cancel; and marks those that must be bent. */
static void interpolate(strip *restrict s)
{
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < s->count; i++) {
        const vec3 g = column_at(&s->g, i), d = column_at(&s->d, i);
        const vec3 m =
            mix(column_at(&s->normal_a, i), column_at(&s->normal_b, i), column_at(&s->normal_c, i), s->u[i], s->v[i]);
        const double length = vec3_length(m), side = vec3_dot(m, g);
        const int64_t usable = s->has_normals[i] & mask_less(1e-12, length) & ~mask_of(side == 0.0);
        const double scale = blend(mask_less(side, 0.0), -1.0, 1.0) / blend(usable, length, 1.0);
        const vec3 n = blend3(usable, vec3_scale(m, scale), g);
        const vec3 mirrored = vec3_sub(d, vec3_scale(n, 2.0 * vec3_dot(d, n)));
        s->bends[i] = usable & ~mask_less_equal(LEAST_SINE, vec3_dot(mirrored, g));
        s->n.x[i] = n.x, s->n.y[i] = n.y, s->n.z[i] = n.z;
    }
}

/* The interpolated normal, bent towards the geometric normal so that a mirror reflects the ray out of the surface: the
 * halfway vector of the ray and the outgoing direction raised to just above the surface (Keller et al., "The Iray light
 * transport simulation and rendering system", 2017, A.3). All are unit vectors; d . g < 0. */
static vec3 bent_normal(vec3 n, vec3 g, vec3 d)
{
    const vec3 mirrored = vec3_sub(d, vec3_scale(n, 2.0 * vec3_dot(d, n)));
    const vec3 raised = vec3_normalize(vec3_add(mirrored, vec3_scale(g, LEAST_SINE - vec3_dot(mirrored, g))));
    const vec3 half = vec3_sub(raised, d);
    const double length = vec3_length(half);
    return length > 0.0 ? vec3_scale(half, 1.0 / length) : g;
}

static void bend(strip *s)
{
    for (int i = 0; i < s->count; i++)
        if (s->bends[i])
            column_put(&s->n, i, bent_normal(column_at(&s->n, i), column_at(&s->g, i), column_at(&s->d, i)));
}

static void store_normals(const strip *restrict s, int first, surface_batch *restrict to)
{
    double *restrict nx = to->nx + first, *restrict ny = to->ny + first, *restrict nz = to->nz + first,
                     *restrict cos_i = to->cos_i + first;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < s->count; i++) {
        const vec3 n = column_at(&s->n, i);
        nx[i] = n.x, ny[i] = n.y, nz[i] = n.z;
        /* above 0, also if rounding reverses its sign */
        cos_i[i] = greater(-vec3_dot(column_at(&s->d, i), n), 1e-12);
    }
}

static void store_more(const instance_set *f, const strip *s, const instance_hit *hits, int first, int count,
                       mesh_points *to)
{
    const size_t bytes = (size_t)s->count * sizeof(double);
    memcpy(to->gx + first, s->g.x, bytes), memcpy(to->gy + first, s->g.y, bytes), memcpy(to->gz + first, s->g.z, bytes);
    for (int i = first; i < first + count; i++) {
        const instance_hit *hit = &hits[i];
        const mesh *m = f->parts[f->by_primitive[mesh_face_primitive(hit->face)]].triangles;
        const uint32_t number = mesh_face_triangle(hit->face);
        to->slot[i] = m->slots ? m->slots[number] : 0;
        to->weight[0][i] = 1.0 - hit->u - hit->v, to->weight[1][i] = hit->u, to->weight[2][i] = hit->v;
        for (int k = 0; k < 3; k++)
            to->corner[k][i] = m->triangles[number].corner[k];
    }
}

void KERNEL(mesh_surface)(const instance_set *f, const ray_batch *rays, const instance_hit *hits, bool smooth,
                          surface_batch *points, mesh_points *more)
{
    strip s;
    for (int first = 0; first < rays->count; first += STRIP) {
        const int count = rays->count - first < STRIP ? rays->count - first : STRIP;
        const bool has_normals = gather(f, rays, hits, smooth, first, count, &s);
        find_points(&s, first, points);
        if (has_normals) {
            interpolate(&s);
            bend(&s);
        }
        store_normals(&s, first, points);
        for (int k = 0; k < s.count; k++)
            points->face[first + k] = hits[first + (k < count ? k : count - 1)].face;
        if (more)
            store_more(f, &s, hits, first, count, more);
    }
}
