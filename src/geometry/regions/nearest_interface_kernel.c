/* The entry points of the geometry kernels (nearest, shadow, surface), and the second pass over a batch: it finds the
 * nearest interface of each ray from the intervals that the first pass (intervals_kernel.c) computes for all
 * primitives.
 *
 * While a ray is in the region of priority index b, the medium can change at two kinds of points only: where the ray
 * leaves that region, and where it enters one of higher priority. The nearest of these is the next change; nothing
 * below priority index b before it has an effect. So one pass over the regions finds it.
 *
 * If the media on both sides are equal, it is no interface: the intervals are advanced past the crossing (the ray is
 * not restarted) and the next change is searched, for those rays only. If another boundary is near the crossing,
 * contact_kernel.c decides whether they coincide. */
#include "geometry/regions/kernels.h"

#include "base/lanes.h"
#include "geometry/primitives/primitive.h"
#include "geometry/regions/instance_set.h"
#include <math.h>

ALWAYS_INLINE int64_t set_mask(uint64_t set, int bit)
{
    return -(int64_t)((set & (uint64_t)1 << bit) != 0);
}

/* The highest priority index among the regions in the set. */
static void priority_indices_of(const scene_geometry *g, int n, const uint64_t *restrict set,
                                int64_t *restrict priority_index)
{
    for (int i = 0; i < n; i++)
        priority_index[i] = 0;
    for (int k = 0; k < g->direct_region_count; k++) {
        const int r = g->direct_regions[k];
        const int outside = g->regions[r].outside, hollow = g->regions[r].hollow;
        const uint64_t wanted = (uint64_t)1 << outside, both = wanted | (hollow < 0 ? 0 : (uint64_t)1 << hollow);
        /* VECTORISE */
        for (int i = 0; i < n; i++)
            priority_index[i] = blend_int(-(int64_t)((set[i] & both) == wanted), r, priority_index[i]);
    }
}

/* Next change by a region without a hollow. */
static void next_of_plain(int n, int64_t priority_index, int64_t hit_primitive, const double *restrict in,
                          const double *restrict out, const ray_scratch *restrict s, hit_batch *restrict hits)
{
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        int64_t within = set_mask(s->inside[i], (int)hit_primitive);
        double t = next_of_convex(within, in[i], out[i]);
        int64_t nearer = mask_less(t, hits->t[i]) & -(int64_t)(hits->before[i] <= priority_index);
        hits->t[i] = blend(nearer, t, hits->t[i]);
        hits->hit_primitive[i] = blend_int(nearer, hit_primitive, hits->hit_primitive[i]);
    }
}

/* Next change by a region with a hollow. */
static void next_of_hollow(int n, int64_t priority_index, int64_t outside, int64_t hollow, const double *restrict in,
                           const double *restrict out, const double *restrict hollow_in,
                           const double *restrict hollow_out, const ray_scratch *restrict s, hit_batch *restrict hits)
{
    const uint64_t wanted = (uint64_t)1 << outside, both = wanted | (uint64_t)1 << hollow;
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        int64_t within = -(int64_t)((s->inside[i] & both) == wanted);
        next_change next = next_of_hollowed(within, in[i], out[i], hollow_in[i], hollow_out[i]);
        int64_t nearer = mask_less(next.t, hits->t[i]) & -(int64_t)(hits->before[i] <= priority_index);
        hits->t[i] = blend(nearer, next.t, hits->t[i]);
        hits->hit_primitive[i] =
            blend_int(nearer, blend_int(next.through_hollow, hollow, outside), hits->hit_primitive[i]);
    }
}

/* Adds `many` primitives, from number `first` on, to the sets just before and just after t, and to the set of
 * primitives whose interval overlaps the range in between; the first call initialises the sets. */
ALWAYS_INLINE void sets_around(int n, int first, int many, ray_scratch *restrict s, hit_batch *restrict hits)
{
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        int64_t before = first == 0 ? 0 : (int64_t)hits->inside_before[i],
                after = first == 0 ? 0 : (int64_t)hits->inside_after[i];
        int64_t between = first == 0 ? 0 : (int64_t)s->near[i];
        for (int k = 0; k < many; k++) {
            const int64_t bit = (int64_t)((uint64_t)1 << (first + k));
            double in = s->in[first + k][i], out = s->out[first + k][i];
            before |= -(int64_t)((in <= s->low[i]) & (s->low[i] < out)) & bit;
            after |= -(int64_t)((in <= s->high[i]) & (s->high[i] < out)) & bit;
            between |= -(int64_t)((in <= s->high[i]) & (s->low[i] < out)) & bit;
        }
        hits->inside_before[i] = (uint64_t)before;
        hits->inside_after[i] = (uint64_t)after;
        s->near[i] = (uint64_t)between;
    }
}

/* Moves the bit of a further row to its primitive's bit. */
static void fold_row(const scene_geometry *g, int row, int n, ray_scratch *restrict s, hit_batch *restrict hits)
{
    int p = row;
    while (g->further >> p & 1)
        p--;
    const uint64_t bit = (uint64_t)1 << row, others = ~bit;
    const int down = row - p;
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        hits->inside_before[i] = (hits->inside_before[i] & others) | (hits->inside_before[i] & bit) >> down;
        hits->inside_after[i] = (hits->inside_after[i] & others) | (hits->inside_after[i] & bit) >> down;
        s->near[i] = (s->near[i] & others) | (s->near[i] & bit) >> down;
    }
}

static void clear_sets(int n, ray_scratch *s, hit_batch *hits)
{
    for (int i = 0; i < n; i++)
        hits->inside_before[i] = hits->inside_after[i] = s->near[i] = 0;
}

/* Calls sets_around for all rows, with constant counts, so that its inner loop unrolls. */
static void all_sets_around(const scene_geometry *g, int n, ray_scratch *s, hit_batch *hits)
{
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        double close = BOUNDARY_CLOSE * (hits->t[i] + s->slack[i]);
        s->low[i] = hits->t[i] - close;
        s->high[i] = hits->t[i] + close;
    }
    if (g->direct_count == 0)
        clear_sets(n, s, hits);
    int k = 0;
    for (; k < 1 && k < g->direct_count; k++)
        sets_around(n, k, 1, s, hits);
    for (; k + 4 <= g->direct_count; k += 4)
        sets_around(n, k, 4, s, hits);
    for (; k < g->direct_count; k++)
        sets_around(n, k, 1, s, hits);
    /* An interval that overlaps the range and does not contain both its ends has a boundary in it. */
    /* VECTORISE */
    for (int i = 0; i < n; i++)
        s->near[i] &= ~(hits->inside_before[i] & hits->inside_after[i]);
    for (uint64_t left = g->further; left; left &= left - 1)
        fold_row(g, __builtin_ctzll(left), n, s, hits);
}

/* -1 if the region of that priority index is opaque (bit priority_index - 1 of the set), else 0. */
ALWAYS_INLINE int64_t opaque_mask(uint64_t opaque_regions, int64_t priority_index)
{
    const int64_t some = -(int64_t)(priority_index > 0);
    return -(int64_t)(opaque_regions >> (uint64_t)(priority_index + some) & 1) & some;
}

/* The region that owns each interface: scene_geometry_surface. */
static void surfaces(uint64_t opaque_regions, int n, const int64_t *restrict before, const int64_t *restrict after,
                     int64_t *restrict surface)
{
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        const int64_t opaque_after = opaque_mask(opaque_regions, after[i]),
                      opaque_before = opaque_mask(opaque_regions, before[i]);
        const int64_t higher = blend_int(-(int64_t)(after[i] > before[i]), after[i], before[i]);
        surface[i] = blend_int(opaque_after, after[i], blend_int(opaque_before, before[i], higher));
    }
}

/* Marks the rays (columns of the batch) that need a second, exact test: another boundary is near, or the media may be
 * equal. */
static void mark_attention(const scene_geometry *g, int n, const ray_scratch *restrict s,
                           const hit_batch *restrict hits, int64_t *restrict attention)
{
    const int64_t doubt = -(int64_t)!g->distinct;
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        const int64_t hit = -(int64_t)(hits->hit_primitive[i] >= 0);
        const uint64_t changed = hits->inside_before[i] ^ hits->inside_after[i];
        /* `others` is 0 if `changed` and near are the hit primitive's bit; gcc vectorises variable shifts to the right
         * only */
        const uint64_t shifted = changed >> (uint64_t)(hits->hit_primitive[i] & hit);
        const uint64_t others = (s->near[i] ^ changed) | (changed & (changed - 1)) | (shifted ^ 1);
        attention[i] = (~mask_same((int64_t)others, 0) | mask_same(hits->before[i], hits->after[i]) | doubt) & hit;
    }
}

/* The higher of the priority indices of the direct primitives and of the tree's, for each column. */
static void raise_priority_indices(const scene_geometry *g, int n, const uint64_t *others, int64_t *priority_index)
{
    for (int k = 0; k < n; k++) {
        const int64_t r = others[k] ? solid_tree_priority_index(g->tree, others[k]) : 0;
        priority_index[k] = r > priority_index[k] ? r : priority_index[k];
    }
}

/* Whether column k's crossing needs no exact test, apart from the media. */
static bool is_simple(const scene_geometry *g, int k, const ray_scratch *s, const hit_batch *hits)
{
    const uint64_t only = direct_bit(g, hits->hit_primitive[k]);
    return s->near[k] == only && (hits->inside_before[k] ^ hits->inside_after[k]) == only &&
           (!g->tree || s->tree.simple[k]);
}

/* surfaces and mark_attention for a geometry with a solid tree, whose priority indices have no bits. */
static void surfaces_and_attention(const scene_geometry *g, int n, ray_scratch *s, hit_batch *hits)
{
    for (int k = 0; k < n; k++) {
        hits->surface[k] = scene_geometry_surface(g, (int)hits->before[k], (int)hits->after[k]);
        s->attention[k] = mask_of(
            hits->hit_primitive[k] >= 0 &&
            (!is_simple(g, k, s, hits) || g->regions[hits->before[k]].medium == g->regions[hits->after[k]].medium));
    }
}

/* The next change of medium for the first n columns. */
static void next_changes(const scene_geometry *g, const ray_batch *rays, int n, ray_scratch *s, hit_batch *hits,
                         instance_hit *mesh_hits)
{
    priority_indices_of(g, n, s->inside, hits->before);
    if (g->tree)
        raise_priority_indices(g, n, s->tree.within, hits->before);
    for (int i = 0; i < n; i++) {
        hits->t[i] = NEVER;
        hits->hit_primitive[i] = -1;
    }
    for (int k = 0; k < g->direct_region_count; k++) {
        const int r = g->direct_regions[k], o = g->regions[r].outside, h = g->regions[r].hollow;
        if (is_mesh(g, o))
            continue;
        if (h < 0)
            next_of_plain(n, r, o, s->in[o], s->out[o], s, hits);
        else
            next_of_hollow(n, r, o, h, s->in[o], s->out[o], s->in[h], s->out[h], s, hits);
    }
    if (g->meshes)
        KERNEL(mesh_changes)(g, rays, n, s, hits, mesh_hits);
    if (g->tree)
        KERNEL(tree_changes)(g, rays, n, s, hits, mesh_hits);
    all_sets_around(g, n, s, hits);
    if (g->meshes)
        KERNEL(mesh_sets)(g, rays, n, s, hits, mesh_hits);
    priority_indices_of(g, n, hits->inside_after, hits->after);
    if (g->tree) {
        raise_priority_indices(g, n, s->tree.after, hits->after);
        surfaces_and_attention(g, n, s, hits);
    } else {
        surfaces(g->opaque_regions, n, hits->before, hits->after, hits->surface);
        mark_attention(g, n, s, hits, s->attention);
    }
    for (int k = 0; g->partial && k < n; k++)
        s->attention[k] |= mask_of(hits->hit_primitive[k] >= 0 && g->regions[hits->surface[k]].partial);
    for (int k = 0; g->meshes && k < n; k++) {
        s->attention[k] |= -(int64_t)(hits->hit_primitive[k] >= 0 && s->meshes->near[k]);
        s->meshes->until[k] = greater(hits->t[k], s->meshes->from[k]);
        /* At an edge a front and a back coincide: the second crossing there is the last; otherwise the two would
         * alternate without end. */
        if (hits->hit_primitive[k] >= 0 && hits->t[k] <= s->meshes->from[k]) {
            const bool on_mesh = is_mesh(g, (int)hits->hit_primitive[k]);
            const double extent = on_mesh ? instance_set_extent(g->meshes, mesh_hits[k].face)
                                          : g->primitives[hits->hit_primitive[k]].extent;
            s->meshes->until[k] += POINT_ERROR * (hits->t[k] + extent * steps_per_unit(rays, s->ray[k]));
        }
    }
}

/* Whether the medium changes at column k's crossing. */
static bool is_change(const scene_geometry *g, const ray_batch *rays, int k, ray_scratch *s, hit_batch *hits,
                      instance_hit *mesh_hits)
{
    if (!is_simple(g, k, s, hits) || (g->meshes && s->meshes->near[k]))
        KERNEL(merge_contacts)(g, rays, k, s, hits, mesh_hits);
    return g->regions[hits->before[k]].medium != g->regions[hits->after[k]].medium;
}

/* The priority index in the whole scene. */
static int outer_region(const scene_geometry *g, int64_t r)
{
    return g->outer ? g->outer->outer_region[r] : (int)r;
}

/* The set, in the whole scene, of the primitives that contain the ray just before column k's crossing. */
static uint64_t set_before(const scene_geometry *g, int k, const ray_scratch *s, const hit_batch *hits)
{
    if (g->outer)
        return KERNEL(view_outer_set)(g->outer, hits->inside_before[k]);
    return g->tree ? solid_tree_join(g->tree, (split_set){hits->inside_before[k], s->tree.before[k]})
                   : hits->inside_before[k];
}

static ray_crossing crossing_of(const scene_geometry *g, int k, const ray_scratch *s, const hit_batch *hits,
                                const instance_hit *mesh_hits)
{
    const int p = (int)hits->hit_primitive[k];
    return (ray_crossing){.ray = s->ray[k],
                          .primitive = g->outer ? g->outer->outer_primitive[p] : p,
                          .before = outer_region(g, hits->before[k]),
                          .after = outer_region(g, hits->after[k]),
                          .t = hits->t[k],
                          .inside = set_before(g, k, s, hits),
                          .mesh = is_mesh(g, p) ? mesh_hits[k] : (instance_hit){.face = FACE_NONE}};
}

/* How much of the surface is there at column k's crossing. */
static double covered(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                      const hit_batch *hits, const instance_hit *mesh_hits)
{
    if (!g->partial || !g->regions[hits->surface[k]].partial)
        return 1.0;
    const ray_crossing x = crossing_of(g, k, s, hits, mesh_hits);
    return s->cover.of(s->cover.context, rays, &x);
}

/* Removes an open surface that is not there from column k's crossing; false if it is none. What is in contact with it
 * remains: a leaf lies on a table. */
static bool remove_open_surface(const scene_geometry *g, int k, const ray_scratch *s, hit_batch *hits)
{
    const uint64_t bit =
        direct_bit(g, g->regions[hits->surface[k]].outside) & (g->meshes ? g->meshes->open_surfaces : 0);
    if (!(hits->inside_after[k] & bit))
        return false;
    hits->inside_after[k] &= ~bit;
    const uint64_t set = g->tree ? solid_tree_join(g->tree, (split_set){hits->inside_after[k], s->tree.after[k]})
                                 : hits->inside_after[k];
    hits->after[k] = scene_geometry_priority_index(g, set);
    hits->surface[k] = scene_geometry_surface(g, (int)hits->before[k], (int)hits->after[k]);
    return true;
}

/* Whether column k's crossing is an interface. */
static bool is_interface(const scene_geometry *g, const ray_batch *rays, int k, ray_scratch *s, hit_batch *hits,
                         instance_hit *mesh_hits)
{
    bool changes = is_change(g, rays, k, s, hits, mesh_hits);
    while (changes && !(covered(g, rays, k, s, hits, mesh_hits) > 0.0))
        changes = remove_open_surface(g, k, s, hits) &&
                  g->regions[hits->before[k]].medium != g->regions[hits->after[k]].medium;
    return changes;
}

/* Advances the rows of a primitive past t: those of column k become those of column m. */
static void advance_rows(int first, int rows, bool inside, int k, int m, double t, ray_scratch *s)
{
    interval found[CHORDS_MAX];
    for (int j = 0; j < rows; j++)
        found[j] = (interval){s->in[first + j][k], s->out[first + j][k]};
    intervals_advance(found, rows, inside, t);
    for (int j = 0; j < rows; j++)
        s->in[first + j][m] = found[j].in, s->out[first + j][m] = found[j].out;
}

/* Continues past column k's crossing: the ray after it becomes column m, for another search. */
static void skip_crossing(const scene_geometry *g, int k, int m, ray_scratch *s, const hit_batch *hits,
                          const instance_hit *mesh_hits)
{
    const uint64_t set = hits->inside_after[k] & ~(g->meshes ? g->meshes->open_surfaces : 0);
    const double t = hits->t[k];
    for (int p = 0; p < g->direct_count; p += g->primitives[p].rows) {
        const bool inside = set >> p & 1;
        if (is_mesh(g, p))
            s->in[p][m] = inside ? -HUGE_VAL : HUGE_VAL, s->out[p][m] = -s->in[p][m];
        else
            advance_rows(p, g->primitives[p].rows, inside, k, m, t, s);
    }
    if (g->tree)
        KERNEL(tree_advance)(k, m, t, s);
    if (g->meshes) {
        s->meshes->from[m] = s->meshes->until[k];
        s->meshes->last[m] = is_mesh(g, (int)hits->hit_primitive[k]) ? mesh_hits[k].face : s->meshes->last[k];
    }
    s->inside[m] = set;
    s->slack[m] = s->slack[k];
    s->ray[m] = s->ray[k];
    if (s->segments) {
        s->segments->passed[m] = t;
        s->segments->unit[m] = s->segments->unit[k];
    }
}

/* Records the medium segment of column k up to its crossing, or up to `end`. */
static void record_segment(const scene_geometry *g, int k, double end, ray_scratch *s, const hit_batch *hits)
{
    medium_segments *w = s->segments;
    if (!w->all && !g->regions[hits->before[k]].attenuates)
        return;
    const double length = (lesser(hits->t[k], end) - w->passed[k]) * w->unit[k];
    if (w->count == SEGMENTS_MAX)
        w->full(w->context);
    w->segment[w->count++] = (medium_segment){s->ray[k], outer_region(g, hits->before[k]), length};
}

static void begin(const scene_geometry *g, const ray_batch *rays, ray_scratch *s)
{
    for (int i = 0; i < rays->count; i++) {
        s->inside[i] = rays->inside[i];
        s->ray[i] = i;
    }
    for (int i = 0; g->tree && i < rays->count; i++)
        KERNEL(tree_begin)(i, i, s);
    for (int i = 0; g->meshes && i < rays->count; i++) {
        s->meshes->from[i] = 0.0;
        s->meshes->last[i] = rays->start[i];
    }
    if (s->segments)
        s->segments->count = 0;
}

/* Records the media up to each ray's first crossing. */
static void record_first_segments(const scene_geometry *g, int n, ray_scratch *s, const hit_batch *hits)
{
    for (int i = 0; i < n; i++) {
        s->segments->passed[i] = 0.0;
        s->segments->unit[i] = 1.0;
        record_segment(g, i, HUGE_VAL, s, hits);
    }
}

static void copy_hit(const hit_batch *from, int k, hit_batch *to, int i)
{
    to->t[i] = from->t[k];
    to->hit_primitive[i] = from->hit_primitive[k];
    to->before[i] = from->before[k];
    to->after[i] = from->after[k];
    to->surface[i] = from->surface[k];
    to->inside_before[i] = from->inside_before[k];
    to->inside_after[i] = from->inside_after[k];
}

/* The batch with sets of the direct primitives only, which are stored in `direct`. */
static ray_batch with_direct_sets(const scene_geometry *g, const ray_batch *rays, ray_scratch *s, uint64_t *direct)
{
    ray_batch view = *rays;
    if (g->tree) {
        KERNEL(tree_split)(g, rays, s, direct);
        view.inside = direct;
    }
    return view;
}

/* Joins the two parts of each set of ray i: the direct primitives and, from column k, those of the solid tree. */
static void join_sets(const scene_geometry *g, int k, const ray_scratch *s, hit_batch *hits, int i)
{
    const uint64_t open = g->meshes ? g->meshes->open_surfaces : 0;
    hits->inside_before[i] = solid_tree_join(g->tree, (split_set){hits->inside_before[i], s->tree.before[k]});
    hits->inside_after[i] = solid_tree_join(g->tree, (split_set){hits->inside_after[i] & ~open, s->tree.after[k]});
}

static void nearest_among(const scene_geometry *g, const ray_batch *given, ray_scratch *s, hit_batch *hits)
{
    uint64_t direct[ROW];
    const ray_batch view = with_direct_sets(g, given, s, direct), *rays = &view;
    KERNEL(intervals_of)(g, rays, UINT64_MAX, s);
    instance_hit *mesh_hits = g->meshes ? s->meshes->hit : NULL, *again = g->meshes ? s->meshes->again : NULL;
    begin(g, rays, s);
    for (int i = 0; i < rays->count; i++)
        s->slack[i] = g->extent;
    next_changes(g, rays, rays->count, s, hits, mesh_hits);
    if (s->segments)
        record_first_segments(g, rays->count, s, hits);
    int left = 0;
    for (int i = 0; i < rays->count; i++)
        if (s->attention[i] && !is_interface(g, rays, i, s, hits, mesh_hits))
            skip_crossing(g, i, left++, s, hits, mesh_hits);
        else if (g->tree)
            join_sets(g, i, s, hits, i);
    while (left > 0) {
        const int n = left;
        next_changes(g, rays, n, s, &s->again, again);
        left = 0;
        for (int k = 0; k < n; k++) {
            if (s->segments)
                record_segment(g, k, HUGE_VAL, s, &s->again);
            if (s->attention[k] && !is_interface(g, rays, k, s, &s->again, again)) {
                skip_crossing(g, k, left++, s, &s->again, again);
                continue;
            }
            copy_hit(&s->again, k, hits, s->ray[k]);
            if (g->tree)
                join_sets(g, k, s, hits, s->ray[k]);
            if (again)
                mesh_hits[s->ray[k]] = again[k];
        }
    }
    for (int i = 0; g->meshes && !g->tree && i < rays->count; i++)
        hits->inside_after[i] &= ~g->meshes->open_surfaces; /* a set never contains open surfaces */
}

/* Rays from .. from + count - 1 of the batch. */
static ray_batch part_of(const ray_batch *rays, int from, int count)
{
    return (ray_batch){count,           rays->ox + from, rays->oy + from,    rays->oz + from,    rays->dx + from,
                       rays->dy + from, rays->dz + from, rays->start + from, rays->inside + from};
}

/* Finds the nearest interfaces in the view of the few solids that the rays may meet; false if there is no view. */
static bool nearest_in_view(const scene_geometry *g, const ray_batch *rays, ray_scratch *s, hit_batch *hits)
{
    uint64_t inside[ROW];
    if (!KERNEL(view_make)(g, rays, HUGE_VAL, &s->view))
        return false;
    ray_batch view = *rays;
    view.inside = inside;
    KERNEL(view_sets)(&s->view, rays, inside);
    nearest_among(&s->view.inner, &view, s, hits);
    KERNEL(view_hits)(&s->view, rays->count, hits);
    return true;
}

/* Finds the nearest interfaces part by part, each part in a separate view if it has one: fewer rays meet fewer
 * solids. */
static void nearest_by_parts(const scene_geometry *g, const ray_batch *rays, ray_scratch *s, hit_batch *hits)
{
    enum { PART = 16 };
    hit_batch found;
    for (int from = 0; from < rays->count; from += PART) {
        const int count = rays->count - from < PART ? rays->count - from : PART;
        const ray_batch part = part_of(rays, from, count);
        if (!nearest_in_view(g, &part, s, &found))
            nearest_among(g, &part, s, &found);
        for (int k = 0; k < count; k++)
            copy_hit(&found, k, hits, from + k);
    }
}

static void nearest(const scene_geometry *g, const ray_batch *rays, ray_scratch *s, hit_batch *hits)
{
    if (g->tree && nearest_in_view(g, rays, s, hits))
        return;
    /* segments, mesh hits and crossings of partial surfaces are numbered by ray of the full batch */
    if (g->tree && !g->meshes && !s->segments && !g->partial)
        nearest_by_parts(g, rays, s, hits);
    else
        nearest_among(g, rays, s, hits);
}

/* Marks the rays whose range 0..1 overlaps the region in the interval of that row, whatever hides it: as undecided, and
 * as blocked unless `doubtful`, or unless the ends of the overlap are so close that they may be in contact. */
static void mark_overlap(const scene_geometry *g, const region *b, int row, bool doubtful, int n,
                         const double *restrict steps, const ray_scratch *restrict s, int64_t *restrict blocked,
                         int64_t *restrict undecided)
{
    const double *restrict in = s->in[row], *restrict out = s->out[row];
    const double extent = g->primitives[b->outside].extent;
    const int64_t certain = ~mask_of(doubtful);
    if (b->hollow < 0) {
        /* VECTORISE */
        for (int i = 0; i < n; i++) {
            const overlap o = overlap_of_convex(in[i], out[i], BOUNDARY_CLOSE * (1.0 + extent * steps[i]));
            blocked[i] |= o.thick & certain;
            undecided[i] |= o.any;
        }
        return;
    }
    const double *restrict hollow_in = s->in[b->hollow], *restrict hollow_out = s->out[b->hollow];
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        const overlap o =
            overlap_of_hollowed(in[i], out[i], hollow_in[i], hollow_out[i], BOUNDARY_CLOSE * (1.0 + extent * steps[i]));
        blocked[i] |= o.thick & certain;
        undecided[i] |= o.any;
    }
}

/* The direct primitives of the regions that cast shadows. */
static uint64_t shadow_casting_primitives(const scene_geometry *g, int solid_shadows)
{
    uint64_t wanted = 0;
    for (int k = 0; k < g->direct_region_count; k++) {
        const region *b = &g->regions[g->direct_regions[k]];
        if (region_casts_shadow(b, solid_shadows))
            wanted |= (uint64_t)1 << b->outside | (b->hollow < 0 ? 0 : (uint64_t)1 << b->hollow);
    }
    return wanted;
}

static bool any_undecided(int n, const ray_scratch *s)
{
    int64_t any = 0;
    for (int i = 0; i < n; i++)
        any |= s->undecided[i] & ~s->blocked[i];
    return any != 0;
}

/* Quick shadow test: a ray is blocked for certain by an opaque region that no transparent one can hide, and undecided
 * if order or attenuation matters, as for all rays if the surroundings absorb. */
static void quick_shadow_test(const scene_geometry *g, const ray_batch *rays, int solid_shadows, ray_scratch *s)
{
    const int n = rays->count;
    const int64_t everywhere = mask_of(g->regions[0].attenuates);
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        s->blocked[i] = 0, s->undecided[i] = everywhere;
        s->low[i] = steps_per_unit(rays, i);
    }
    uint64_t sure = 0, unsure = 0; /* meshes */
    for (int j = 0; j < g->direct_region_count; j++) {
        const int r = g->direct_regions[j];
        const region *b = &g->regions[r];
        /* a transparent region of higher priority may hide it */
        const bool doubtful = r < g->highest_transparent || !b->opaque || b->partial,
                   casts = region_casts_shadow(b, solid_shadows);
        if (casts && is_mesh(g, b->outside))
            *(doubtful ? &unsure : &sure) |= (uint64_t)1 << b->outside;
        else if (casts)
            for (int k = 0; k < g->primitives[b->outside].rows; k++)
                mark_overlap(g, b, b->outside + k, doubtful, n, s->low, s, s->blocked, s->undecided);
    }
    if (g->tree)
        KERNEL(tree_shadows)(g, rays, solid_shadows, s);
    if (sure)
        KERNEL(mesh_shadows)(g, rays, sure, true, s->meshes->counts, s->blocked, s->blocked);
    if (unsure)
        KERNEL(mesh_shadows)(g, rays, unsure, false, s->meshes->counts, s->undecided, s->blocked);
}

/* The slot of the primitive's face that column k crosses. */
static int crossed_face_slot(const scene_geometry *g, const region *owner, const ray_batch *rays, const ray_scratch *s,
                             const hit_batch *hits, int k)
{
    const primitive *p = &g->primitives[owner->outside];
    const uint64_t leaving = owner == &g->regions[hits->before[k]];
    const ray_batch one = ray_batch_one(rays, s->ray[k], &leaving);
    surface_batch point;
    p->rule->KERNEL_ISA->points(p, &one, &hits->t[k], 0, &point);
    return owner->face_slots[point.face[0] - p->first_face];
}

/* The material slot of the face that column k crosses; 0 if the surface is another region's. */
static int crossed_slot(const scene_geometry *g, const region *owner, const ray_batch *rays, const ray_scratch *s,
                        const hit_batch *hits, const instance_hit *mesh_hits, int k)
{
    if (owner->face_slots)
        return hits->hit_primitive[k] == owner->outside ? crossed_face_slot(g, owner, rays, s, hits, k) : 0;
    if (hits->hit_primitive[k] != owner->outside || mesh_hits[k].face == FACE_NONE)
        return 0;
    const mesh *m = g->meshes->parts[g->meshes->by_primitive[owner->outside]].triangles;
    return m->slots ? m->slots[mesh_face_triangle(mesh_hits[k].face)] : 0;
}

/* The transmittance of the interface that the shadow ray in column k crosses. */
static double interface_transmittance(const scene_geometry *g, const ray_batch *rays, int solid_shadows,
                                      const ray_scratch *s, const hit_batch *hits, const instance_hit *mesh_hits, int k)
{
    const region *before = &g->regions[hits->before[k]], *after = &g->regions[hits->after[k]];
    if (solid_shadows || after->opaque || before->opaque)
        return 0.0;
    const region *owner = hits->before[k] > hits->after[k] ? before : after;
    return owner->face_shadow_transmittance
               ? owner->face_shadow_transmittance[crossed_slot(g, owner, rays, s, hits, mesh_hits, k)]
               : owner->shadow_transmittance;
}

/* Records the interface that the shadow ray in column k crosses. */
static void record_crossing(const scene_geometry *g, int k, ray_scratch *s, const hit_batch *hits,
                            const instance_hit *mesh_hits)
{
    ray_crossings *x = s->crossings;
    if (x->count == CROSSINGS_MAX)
        x->full(x->context);
    x->crossings[x->count++] = crossing_of(g, k, s, hits, mesh_hits);
}

/* Moves the undecided columns to the front; returns their number. */
static int compact_undecided(const scene_geometry *g, const ray_batch *rays, ray_scratch *s)
{
    int n = 0;
    for (int i = 0; i < rays->count; i++) {
        if (s->blocked[i] || !s->undecided[i])
            continue;
        double length = sqrt(rays->dx[i] * rays->dx[i] + rays->dy[i] * rays->dy[i] + rays->dz[i] * rays->dz[i]);
        s->slack[n] = g->extent / length;
        s->inside[n] = rays->inside[i];
        s->ray[n] = i;
        if (g->tree)
            KERNEL(tree_begin)(i, n, s);
        if (g->meshes) {
            s->meshes->from[n] = 0.0;
            s->meshes->last[n] = rays->start[i];
        }
        if (s->segments) {
            s->segments->passed[n] = 0.0;
            s->segments->unit[n] = length;
        }
        for (int p = 0; p < g->direct_count; p++) {
            s->in[p][n] = s->in[p][i];
            s->out[p][n] = s->out[p][i];
        }
        n++;
    }
    return n;
}

static void shadow_among(const scene_geometry *g, const ray_batch *given, int solid_shadows, ray_scratch *s,
                         double *transmitted)
{
    uint64_t direct[ROW];
    const ray_batch view = with_direct_sets(g, given, s, direct), *rays = &view;
    const uint64_t wanted = shadow_casting_primitives(g, solid_shadows);
    if (s->segments)
        s->segments->count = 0;
    if (s->crossings)
        s->crossings->count = 0;
    KERNEL(intervals_of)(g, rays, wanted, s);
    quick_shadow_test(g, rays, solid_shadows, s);
    for (int i = 0; i < rays->count; i++)
        transmitted[i] = s->blocked[i] ? 0.0 : 1.0;
    if (!any_undecided(rays->count, s))
        return;
    KERNEL(intervals_of)(g, rays, ~wanted, s);
    for (int left = compact_undecided(g, rays, s); left > 0;) {
        const int n = left;
        hit_batch *hits = &s->again;
        instance_hit *again = g->meshes ? s->meshes->again : NULL;
        next_changes(g, rays, n, s, hits, again);
        left = 0;
        for (int k = 0; k < n; k++) {
            if (s->segments)
                record_segment(g, k, 1.0, s, hits);
            if (g->regions[hits->before[k]].opaque) /* the ray starts in an opaque solid */
                transmitted[s->ray[k]] = 0.0;
            if (hits->hit_primitive[k] < 0 || hits->t[k] >= 1.0)
                continue;
            if (!s->attention[k] || is_change(g, rays, k, s, hits, again)) {
                const bool partial = g->partial && g->regions[hits->surface[k]].partial;
                transmitted[s->ray[k]] *= partial ? 1.0 - covered(g, rays, k, s, hits, again)
                                                  : interface_transmittance(g, rays, solid_shadows, s, hits, again, k);
                if (s->crossings && !partial && transmitted[s->ray[k]] > 0.0)
                    record_crossing(g, k, s, hits, again);
            }
            if (transmitted[s->ray[k]] > 0.0)
                skip_crossing(g, k, left++, s, hits, again);
        }
    }
}

/* Whether one walk of a batch through the tree finds its shadows faster than a view: the quick shadow test decides on
 * nearly all rays, and there are more solids than a view was measured to be faster for. */
static bool is_walk_faster(const scene_geometry *g)
{
    enum { MANY = 64 };
    return g->highest_transparent == 0 && !g->regions[0].attenuates && g->tree->count > MANY;
}

static void shadow(const scene_geometry *g, const ray_batch *rays, int solid_shadows, ray_scratch *s,
                   double *transmitted)
{
    if (!g->tree || is_walk_faster(g) || !KERNEL(view_make)(g, rays, 1.0, &s->view)) {
        shadow_among(g, rays, solid_shadows, s, transmitted);
        return;
    }
    uint64_t inside[ROW];
    ray_batch view = *rays;
    view.inside = inside;
    KERNEL(view_sets)(&s->view, rays, inside);
    shadow_among(&s->view.inner, &view, solid_shadows, s, transmitted);
}

static void surface(const scene_geometry *g, int hit_primitive, const ray_batch *rays, const double *t,
                    surface_batch *points)
{
    const primitive *p = &g->primitives[hit_primitive];
    if (!g->tree) {
        p->rule->KERNEL_ISA->points(p, rays, t, hit_primitive, points);
        return;
    }
    uint64_t inside[ROW];
    for (int i = 0; i < rays->count; i++)
        inside[i] = set_table_has(g->tree->sets, rays->inside[i], hit_primitive);
    ray_batch view = *rays;
    view.inside = inside;
    p->rule->KERNEL_ISA->points(p, &view, t, 0, points);
}

const geometry_kernels KERNEL(geometry_kernels) = {nearest, shadow, surface, KERNEL(mesh_surface)};
