/* Contact: which boundaries lie at one place.
 *
 * Two boundaries that a ray crosses at t1 and t2 are in contact when these distances are equal within the boundaries'
 * own error bounds at these crossings: |t1 - t2| <= e1 / cos1 + e2 / cos2. e is the bound on a point's error across its
 * surface (surface_kernel.c); the cosine carries it over to the ray. Nothing else enters: no other solid, no extent of
 * the scene. The narrowest gap that is seen is therefore e1 + e2, the sum of both surfaces' 16 DBL_EPSILON (|start| +
 * |path| + extent): 2e-14 to 1.4e-13 scene units in the scene of the rod.
 *
 * Crossings in contact are one crossing: the sets before and behind it are those before the first and behind the last
 * of them. Faces that coincide by their numbers, whatever rounding made of these, enclose no film of another medium. */
#include "geometry/kernels.h"

#include "base/lanes.h"

/* What column k crosses, and how far along the ray that crossing may be wrong. */
typedef struct crossing {
    int of; /* a primitive */
    double t, bound, cosine;
} crossing;

static ray_batch ray_of(const ray_batch *rays, int i, const uint64_t *inside)
{
    return (ray_batch){
        1, &rays->ox[i], &rays->oy[i], &rays->oz[i], &rays->dx[i], &rays->dy[i], &rays->dz[i], &rays->start[i], inside};
}

/* -d . n at the point: the cosine of incidence, for a shadow ray times its length, so that a distance divided by it is
 * one in t. */
static double facing(const surface_batch *point, const ray_batch *one)
{
    const double along = one->dx[0] * point->nx[0] + one->dy[0] * point->ny[0] + one->dz[0] * point->nz[0];
    return greater(-along, DBL_MIN);
}

static crossing crossing_of(const arrangement *a, const ray_batch *rays, int i, int p, double t, bool leaving)
{
    const uint64_t inside = (uint64_t)leaving << p;
    const ray_batch one = ray_of(rays, i, &inside);
    surface_batch point;
    KERNEL(surface_points)(&a->primitives[p], &one, &t, p, &point);
    const double cosine = facing(&point, &one);
    return (crossing){p, t, point.error[0] / cosine, cosine};
}

/* A point on a mesh is as exact as its triangle; the distance along the ray depends on the ray's start and length, too.
 */
static double mesh_error(const arrangement *a, const ray_batch *rays, int i, int p, double t)
{
    const double start = magnitude(rays->ox[i]) + magnitude(rays->oy[i]) + magnitude(rays->oz[i]);
    const double step = magnitude(rays->dx[i]) + magnitude(rays->dy[i]) + magnitude(rays->dz[i]);
    return POINT_ERROR * (start + magnitude(t) * step + a->primitives[p].extent);
}

static crossing mesh_crossing_of(const arrangement *a, const ray_batch *rays, int i, const forest_hit *hit)
{
    const uint64_t inside = 0;
    const ray_batch one = ray_of(rays, i, &inside);
    surface_batch point;
    forest_surface(a->meshes, &one, hit, false, &point, NULL);
    const int p = mesh_face_primitive(hit->face);
    const double cosine = facing(&point, &one);
    return (crossing){p, hit->t, mesh_error(a, rays, i, p, hit->t) / cosine, cosine};
}

/* The widest contact: half of the filter, which is never narrower, whatever else is in the scene. It acts where a ray
 * grazes within 1e-7 rad. */
static double widest_contact(const arrangement *a, const ray_batch *rays, int i, const crossing *c, int other)
{
    const double extent = greater(a->primitives[c->of].extent, a->primitives[other].extent);
    return 0.5 * BOUNDARY_CLOSE * (c->t + extent * steps_per_unit(rays, i));
}

/* Where a primitive's boundary at t lies: -1 before the crossing, 0 in contact with it, 1 behind it. */
static int side_of(const arrangement *a, const ray_batch *rays, int i, const crossing *c, int p, double t, bool leaving)
{
    if (p == c->of && t == c->t)
        return 0;
    const double apart = magnitude(t - c->t);
    if (apart <= widest_contact(a, rays, i, c, p)) {
        const crossing other = crossing_of(a, rays, i, p, t, leaving);
        if (apart <= c->bound + other.bound)
            return 0;
    }
    return t < c->t ? -1 : 1;
}

static void set_bit(uint64_t *set, int bit, bool on)
{
    *set = (*set & ~((uint64_t)1 << bit)) | (uint64_t)on << bit;
}

static void cross_mesh_of_owner(const arrangement *a, const ray_batch *rays, int k, const ray_scratch *s, hit_batch *c,
                                forest_hit *mesh_hits, double low, double high)
{
    const int primitive_of_owner = a->bodies[c->surface[k]].outside;
    const forest_hit own = KERNEL(mesh_hit_between)(a, rays, k, s, primitive_of_owner, c->inside_before[k], low, high);
    if (own.face == FACE_NONE)
        return;
    mesh_hits[k] = own;
    c->t[k] = own.t;
    c->crossed[k] = primitive_of_owner;
}

/* Of several boundaries in contact at column k's crossing, the one of the body that owns the surface is crossed: its
 * normal, frame and colours are seen. A mesh's lies within `reach`. */
static void cross_the_owners(const arrangement *a, const ray_batch *rays, int k, const ray_scratch *s, hit_batch *c,
                             forest_hit *mesh_hits, const crossing *at, double reach)
{
    const body *owner = &a->bodies[c->surface[k]];
    const int pieces[2] = {owner->outside, owner->hollow};
    if (c->surface[k] == 0 || at->of == owner->outside || at->of == owner->hollow)
        return;
    if (is_mesh(a, owner->outside)) {
        if (reach > 0.0)
            cross_mesh_of_owner(a, rays, k, s, c, mesh_hits, at->t - reach, at->t + reach);
        return;
    }
    for (int piece = 0; piece < 2 && pieces[piece] >= 0; piece++) {
        const int p = pieces[piece];
        for (int leaving = 0; leaving < 2; leaving++) {
            const double t = leaving ? s->out[p][k] : s->in[p][k];
            if (side_of(a, rays, s->ray[k], at, p, t, leaving) == 0) {
                c->t[k] = t;
                c->crossed[k] = p;
                return;
            }
        }
    }
}

/* Merges the near meshes' boundaries within one distance, the one of the least exact of them, and returns it. */
static double merge_meshes(const arrangement *a, const ray_batch *rays, int k, ray_scratch *s, hit_batch *c,
                           const crossing *at)
{
    const int i = s->ray[k];
    const uint64_t near = s->near[k] & a->meshes->primitives;
    double reach = 0.0;
    for (int p = 0; p < a->primitive_count; p++)
        if (near >> p & 1)
            reach = greater(reach, lesser(at->bound + mesh_error(a, rays, i, p, at->t) / at->cosine,
                                          widest_contact(a, rays, i, at, p)));
    const double low = at->t - reach, high = at->t + reach;
    KERNEL(mesh_sets_closely)(a, rays, k, s, c->before[k], near, low, high, &c->inside_before[k], &c->inside_after[k]);
    s->meshes->until[k] = greater(s->meshes->until[k], high);
    return reach;
}

void KERNEL(merge_contacts)(const arrangement *a, const ray_batch *rays, int k, ray_scratch *s, hit_batch *c,
                            forest_hit *mesh_hits)
{
    const int i = s->ray[k], crossed = (int)c->crossed[k];
    const crossing at = is_mesh(a, crossed) ? mesh_crossing_of(a, rays, i, &mesh_hits[k])
                                            : crossing_of(a, rays, i, crossed, c->t[k], c->t[k] != s->in[crossed][k]);
    const uint64_t meshes = a->meshes ? a->meshes->primitives : 0;
    for (int p = 0; p < a->primitive_count; p++) {
        if (!((s->near[k] & ~meshes) >> p & 1))
            continue;
        const int entry = side_of(a, rays, i, &at, p, s->in[p][k], false),
                  exit = side_of(a, rays, i, &at, p, s->out[p][k], true);
        set_bit(&c->inside_before[k], p, entry < 0 && exit >= 0);
        set_bit(&c->inside_after[k], p, entry <= 0 && exit > 0);
    }
    const double reach = s->near[k] & meshes ? merge_meshes(a, rays, k, s, c, &at) : 0.0;
    c->after[k] = arrangement_rank(a, c->inside_after[k]);
    c->surface[k] = arrangement_surface(a, (int)c->before[k], (int)c->after[k]);
    cross_the_owners(a, rays, k, s, c, mesh_hits, &at, reach);
}
