/* Contact: the test whether boundaries coincide.
 *
 * Two boundaries that a ray crosses at t1 and t2 are in contact if these distances are equal within the boundaries' own
 * error bounds at these crossings: |t1 - t2| <= e1 / cos1 + e2 / cos2. e bounds a point's error across its surface
 * (primitives/kind.h); the cosine converts it into an error along the ray. Neither other solids nor the extent of the
 * scene have an effect. The narrowest gap that is resolved is therefore e1 + e2, the sum of both surfaces' 16
 * DBL_EPSILON (|start| + |path| + extent): 2e-14 to 1.4e-13 scene units in the scene of the rod.
 *
 * Crossings in contact count as one, with the set before the first of them and the set after the last. Faces whose
 * coordinates coincide up to rounding enclose no layer of another medium. */
#include "geometry/regions/kernels.h"

#include "base/lanes.h"
#include "geometry/primitives/primitive.h"

/* A crossing of column k: its primitive, its error bound along the ray, and the extent of the solid or copy. */
typedef struct crossing {
    int primitive;
    double t, bound, extent;
} crossing;

/* -d . n at the point: the cosine of incidence (for a shadow ray times its length), which converts a distance across
 * the surface into one in t. */
static double facing(const surface_batch *point, const ray_batch *one)
{
    const double along = one->dx[0] * point->nx[0] + one->dy[0] * point->ny[0] + one->dz[0] * point->nz[0];
    return greater(-along, DBL_MIN);
}

static crossing crossing_of(const scene_geometry *g, const ray_batch *rays, int i, int p, double t, bool leaving)
{
    const uint64_t inside = leaving;
    const ray_batch one = ray_batch_one(rays, i, &inside);
    surface_batch point;
    g->primitives[p].rule->KERNEL_ISA->points(&g->primitives[p], &one, &t, 0, &point);
    return (crossing){p, t, point.error[0] / facing(&point, &one), g->primitives[p].extent};
}

/* A point on a mesh is as exact as its triangle; the distance along the ray also depends on the ray's start and
 * length. */
static crossing mesh_crossing_of(const scene_geometry *g, const ray_batch *rays, int i, const instance_hit *hit)
{
    const uint64_t inside = 0;
    const ray_batch one = ray_batch_one(rays, i, &inside);
    surface_batch point;
    KERNEL(mesh_surface)(g->meshes, &one, hit, false, &point, NULL);
    const instanced_mesh *part = &g->meshes->parts[g->meshes->by_primitive[mesh_face_primitive(hit->face)]];
    const vec3 o = instance_set_origin(part, mesh_face_copy(hit->face));
    const double start = magnitude(rays->ox[i] - o.x) + magnitude(rays->oy[i] - o.y) + magnitude(rays->oz[i] - o.z);
    const double step = magnitude(rays->dx[i]) + magnitude(rays->dy[i]) + magnitude(rays->dz[i]);
    const double error = point.error[0] + POINT_ERROR * (start + magnitude(hit->t) * step);
    return (crossing){part->primitive, hit->t, error / facing(&point, &one), instance_set_extent(g->meshes, hit->face)};
}

/* Upper limit of a contact: at most half the filter's window, independent of the rest of the scene. It matters only if
 * a ray grazes a surface within 1e-7 rad. */
static double widest_contact(const ray_batch *rays, int i, const crossing *c, double extent)
{
    return 0.5 * BOUNDARY_CLOSE * (c->t + greater(c->extent, extent) * steps_per_unit(rays, i));
}

static bool in_contact(const ray_batch *rays, int i, const crossing *c, const crossing *other)
{
    const double apart = magnitude(other->t - c->t);
    return apart <= widest_contact(rays, i, c, other->extent) && apart <= c->bound + other->bound;
}

/* The position of a primitive's boundary at t: -1 before the crossing, 0 in contact with it, 1 after it. */
static int side_of(const scene_geometry *g, const ray_batch *rays, int i, const crossing *c, int p, double t,
                   bool leaving)
{
    if (p == c->primitive && t == c->t)
        return 0;
    if (magnitude(t - c->t) <= widest_contact(rays, i, c, g->primitives[p].extent)) {
        const crossing other = crossing_of(g, rays, i, p, t, leaving);
        if (in_contact(rays, i, c, &other))
            return 0;
    }
    return t < c->t ? -1 : 1;
}

static void set_bit(uint64_t *set, int bit, bool on)
{
    *set = (*set & ~((uint64_t)1 << bit)) | (uint64_t)on << bit;
}

/* The intervals of a primitive ahead of column k; those of a direct primitive are in its rows. */
static void intervals_in_column(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, int p,
                                interval found[CHORDS_MAX])
{
    if (p >= g->direct_count) {
        KERNEL(tree_intervals)(g, rays, k, s, p, found);
        return;
    }
    for (int row = 0; row < g->primitives[p].rows; row++)
        found[row] = (interval){s->in[p + row][k], s->out[p + row][k]};
}

/* Whether a primitive contains the ray just before and just after a crossing: before all boundaries in contact with it,
 * and after all of them. */
typedef struct sides {
    bool before, after;
} sides;

static sides sides_of(const scene_geometry *g, const ray_batch *rays, int i, const crossing *c, int p,
                      const interval *found)
{
    sides in = {false, false};
    for (int row = 0; row < g->primitives[p].rows; row++) {
        const int entry = side_of(g, rays, i, c, p, found[row].in, false),
                  exit = side_of(g, rays, i, c, p, found[row].out, true);
        in.before |= entry < 0 && exit >= 0;
        in.after |= entry <= 0 && exit > 0;
    }
    return in;
}

/* The primitives of the solid tree on both sides of a crossing. */
typedef struct tree_contact {
    const scene_geometry *g;
    const ray_batch *rays;
    ray_scratch *s;
    int column;
    const crossing *at;
} tree_contact;

static void merge_tree_primitive(void *context, int p, const interval *found)
{
    const tree_contact *m = context;
    const sides in = sides_of(m->g, m->rays, m->s->ray[m->column], m->at, p, found);
    uint64_t *before = &m->s->tree.before[m->column], *after = &m->s->tree.after[m->column];
    *before = set_table_put(m->g->tree->sets, *before, p, in.before);
    *after = set_table_put(m->g->tree->sets, *after, p, in.after);
}

static void merge_tree(const scene_geometry *g, const ray_batch *rays, int k, ray_scratch *s, const crossing *at)
{
    tree_contact m = {g, rays, s, k, at};
    KERNEL(tree_each_near)(g, rays, k, s, at->t, merge_tree_primitive, &m);
}

/* The boundaries of a mesh in contact with a crossing, and the distance of the farthest of them; negative for none. */
typedef struct mesh_contact {
    const scene_geometry *g;
    const ray_batch *rays;
    int ray;
    const crossing *at;
    double reach;
} mesh_contact;

static void collect_contact(void *context, const instance_hit *hit)
{
    mesh_contact *m = context;
    const crossing other = mesh_crossing_of(m->g, m->rays, m->ray, hit);
    if (in_contact(m->rays, m->ray, m->at, &other))
        m->reach = greater(m->reach, magnitude(hit->t - m->at->t));
}

/* The largest distance of mesh p's boundaries in contact with the crossing from it, plus a margin; negative for
 * none. */
static double mesh_reach(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                         const crossing *at, int p)
{
    mesh_contact m = {g, rays, s->ray[k], at, -1.0};
    KERNEL(mesh_each_near)(g, rays, k, s, p, at->t, collect_contact, &m);
    return m.reach < 0.0 ? m.reach : m.reach + 0.5 * at->bound;
}

/* Updates the sets on both sides of the crossing for the meshes with other boundaries near it. */
static void merge_meshes(const scene_geometry *g, const ray_batch *rays, int k, ray_scratch *s, hit_batch *c,
                         const crossing *at)
{
    for (int p = 0; p < g->direct_count; p++) {
        const uint64_t bit = (uint64_t)1 << p;
        if (!(s->meshes->near[k] & bit))
            continue;
        const double contact = mesh_reach(g, rays, k, s, at, p), reach = greater(contact, 0.5 * at->bound);
        KERNEL(mesh_sets_closely)
        (g, rays, k, s, c->before[k], bit, at->t - reach, at->t + reach, &c->inside_before[k], &c->inside_after[k]);
        if (contact >= 0.0) /* otherwise one of two coincident boundaries would be hit again without the other */
            s->meshes->until[k] = greater(s->meshes->until[k], at->t + reach);
    }
}

static void cross_mesh_of_owner(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                                hit_batch *c, instance_hit *mesh_hits, const crossing *at)
{
    const int p = g->regions[c->surface[k]].outside;
    const double reach = s->meshes->near[k] >> p & 1 ? mesh_reach(g, rays, k, s, at, p) : -1.0;
    if (reach < 0.0)
        return;
    const instance_hit owner_hit =
        KERNEL(mesh_hit_between)(g, rays, k, s, p, c->inside_before[k], at->t - reach, at->t + reach);
    if (owner_hit.face == FACE_NONE)
        return;
    mesh_hits[k] = owner_hit;
    c->t[k] = owner_hit.t;
    c->hit_primitive[k] = p;
}

/* Selects, among the boundaries in contact at column k's crossing, the boundary of the region that owns the surface:
 * its normal, frame and material are used for shading. */
static void select_owner(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, hit_batch *c,
                         instance_hit *mesh_hits, const crossing *at)
{
    const region *owner = &g->regions[c->surface[k]];
    const int pieces[2] = {owner->outside, owner->hollow};
    if (c->surface[k] == 0 || at->primitive == owner->outside || at->primitive == owner->hollow)
        return;
    if (is_mesh(g, owner->outside)) {
        cross_mesh_of_owner(g, rays, k, s, c, mesh_hits, at);
        return;
    }
    for (int piece = 0; piece < 2 && pieces[piece] >= 0; piece++) {
        const int p = pieces[piece];
        interval found[CHORDS_MAX];
        intervals_in_column(g, rays, k, s, p, found);
        for (int end = 0; end < 2 * g->primitives[p].rows; end++) {
            const bool leaving = end % 2;
            const double t = leaving ? found[end / 2].out : found[end / 2].in;
            if (side_of(g, rays, s->ray[k], at, p, t, leaving) == 0) {
                c->t[k] = t;
                c->hit_primitive[k] = p;
                return;
            }
        }
    }
}

void KERNEL(merge_contacts)(const scene_geometry *g, const ray_batch *rays, int k, ray_scratch *s, hit_batch *c,
                            instance_hit *mesh_hits)
{
    const int i = s->ray[k], hit_primitive = (int)c->hit_primitive[k];
    interval found[CHORDS_MAX];
    if (!is_mesh(g, hit_primitive))
        intervals_in_column(g, rays, k, s, hit_primitive, found);
    const crossing at = is_mesh(g, hit_primitive)
                            ? mesh_crossing_of(g, rays, i, &mesh_hits[k])
                            : crossing_of(g, rays, i, hit_primitive, c->t[k], c->t[k] != found[0].in);
    for (uint64_t left = s->near[k] & ~(g->meshes ? g->meshes->primitives : 0); left; left &= left - 1) {
        const int p = __builtin_ctzll(left);
        intervals_in_column(g, rays, k, s, p, found);
        const sides in = sides_of(g, rays, i, &at, p, found);
        set_bit(&c->inside_before[k], p, in.before);
        set_bit(&c->inside_after[k], p, in.after);
    }
    if (g->tree)
        merge_tree(g, rays, k, s, &at);
    if (g->meshes)
        merge_meshes(g, rays, k, s, c, &at);
    const uint64_t after = c->inside_after[k];
    c->after[k] = scene_geometry_priority_index(
        g, g->tree ? solid_tree_join(g->tree, (split_set){after, s->tree.after[k]}) : after);
    c->surface[k] = scene_geometry_surface(g, (int)c->before[k], (int)c->after[k]);
    select_owner(g, rays, k, s, c, mesh_hits, &at);
}
