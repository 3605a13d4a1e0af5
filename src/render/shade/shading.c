/* Shading of rays that hit a surface: groups of rays are gathered, their points and colours computed, and the
 * integrator called, material by material; branches at interfaces, and their children. */
#include "render/shade/shading.h"

#include "geometry/primitives/primitive.h"
#include "render/shade/footprints.h"
#include "render/shade/kernels.h"
#include "render/shade/polarisation.h"
#include "render/shade/rough.h"
#include <string.h>

void intersect_nearest(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays)
{
    const scene_geometry *g = t->target.frame_plan->geometry;
    batch_cover *cover = &t->batch.cover;
    if (g->partial) {
        cover->sample_keys = q->sample_key + first, cover->depth = depth;
        memset(cover->crossings, 0, (size_t)rays->count * sizeof cover->crossings[0]);
    }
    t->geometry->nearest(g, rays, &t->batch.scratch, &t->batch.hits);
    cover->sample_keys = NULL;
}

/* --- partial surfaces --- */

static cover_use cover_use_of(const tracer *t)
{
    const cover_use use = t->frame_integrator->cover;
    return use == COVER_SPLIT && t->target.frame_plan->render.lighting != LIGHTING_WHITTED ? COVER_CUT : use;
}

/* The material of the surface that a ray crosses. */
static const shading_material *material_crossed(const plan *p, const ray_crossing *x)
{
    const region_materials *m = &p->shading_materials[p->geometry->primitives[x->primitive].priority_index];
    if (m->count == 1 || x->mesh.face == FACE_NONE)
        return m->mat;
    const instance_set *f = p->geometry->meshes;
    const mesh *triangles = f->parts[f->by_primitive[x->primitive]].triangles;
    const int slot = triangles->slots ? triangles->slots[mesh_face_triangle(x->mesh.face)] : 0;
    return &m->mat[slot < m->count ? slot : 0];
}

static surface_mapping mapping_crossed(const cover_source *from, const ray_batch *rays, const ray_crossing *x,
                                       double size)
{
    const scene_geometry *g = from->frame_plan->geometry;
    if (x->mesh.face != FACE_NONE)
        return instance_set_mapping(g->meshes, &x->mesh);
    const int i = x->ray;
    const vec3 along = vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]);
    const double length = vec3_length(along), dx = along.x / length, dy = along.y / length, dz = along.z / length,
                 far = x->t * length;
    const ray_batch one = {1, &rays->ox[i], &rays->oy[i], &rays->oz[i], &dx, &dy, &dz, &rays->start[i], &x->inside};
    surface_batch at;
    from->geometry->surface(g, x->primitive, &one, &far, &at);
    return primitive_mapping(&g->primitives[x->primitive], at.face[0], vec3_make(at.px[0], at.py[0], at.pz[0]), size);
}

/* The fraction of the surface that is there. */
static double part_crossed(const cover_source *from, const ray_batch *rays, const ray_crossing *x)
{
    const shading_material *m = material_crossed(from->frame_plan, x);
    if (!shading_material_is_partial(m))
        return 1.0;
    const surface_mapping at =
        m->covered ? mapping_crossed(from, rays, x, m->surface.texture_size) : (surface_mapping){0};
    return shading_material_cover(m, at.u, at.v);
}

double cover_cut(void *context, const ray_batch *rays, const ray_crossing *x)
{
    return part_crossed(context, rays, x) >= 0.5 ? 1.0 : 0.0;
}

static double cover_of(void *context, const ray_batch *rays, const ray_crossing *x)
{
    tracer *t = context;
    const double part = part_crossed(&(cover_source){t->target.frame_plan, t->geometry}, rays, x);
    batch_cover *batch = &t->batch.cover;
    if (!batch->sample_keys || part == 0.0 || part == 1.0 || cover_use_of(t) == COVER_SPLIT)
        return part;
    if (cover_use_of(t) == COVER_CUT)
        return part >= 0.5 ? 1.0 : 0.0;
    const int purpose = DRAW_COVER + (batch->crossings[x->ray]++ << 16);
    const random_words drawn =
        draw(t->target.frame_plan->draws.seed, batch->sample_keys[x->ray], batch->depth, purpose);
    return random_unit(drawn.word[0]) < part ? 1.0 : 0.0;
}

void cover_begin(tracer *t)
{
    t->batch.scratch.cover = (surface_cover){cover_of, t};
    t->batch.cover.sample_keys = NULL;
}

void cover_weigh(tracer *t, cover_saved *saved)
{
    group *g = &t->surface.gathered;
    const size_t bytes = (size_t)g->padded * sizeof(double);
    if (!t->surface.blended)
        return;
    memcpy(saved->r, g->wr, bytes), memcpy(saved->g, g->wg, bytes), memcpy(saved->b, g->wb, bytes);
    for (int k = 0; k < g->padded; k++)
        g->wr[k] *= t->surface.cover[k], g->wg[k] *= t->surface.cover[k], g->wb[k] *= t->surface.cover[k];
}

void cover_weigh_back(tracer *t, const cover_saved *saved)
{
    group *g = &t->surface.gathered;
    const size_t bytes = (size_t)g->padded * sizeof(double);
    if (t->surface.blended)
        memcpy(g->wr, saved->r, bytes), memcpy(g->wg, saved->g, bytes), memcpy(g->wb, saved->b, bytes);
}

void cover_branches(tracer *t, bool reflects)
{
    const group *g = &t->surface.gathered;
    branch_group *b = &t->surface.branches;
    polar_group *p = &t->surface.polar;
    const size_t bytes = (size_t)g->padded * sizeof(double);
    if (!reflects)
        memcpy(b->rx, g->dx, bytes), memcpy(b->ry, g->dy, bytes), memcpy(b->rz, g->dz, bytes);
    memcpy(b->tx, g->dx, bytes), memcpy(b->ty, g->dy, bytes), memcpy(b->tz, g->dz, bytes);
    for (int k = 0; k < g->padded; k++) {
        b->reflect[k] = reflects ? t->surface.cover[k] * b->reflect[k] : 0.0;
        b->refract[k] = 1.0 - t->surface.cover[k];
    }
    if (t->target.frame_plan->render.polarisation) {
        memcpy(p->tq, p->q, bytes), memcpy(p->tu, p->u, bytes), memcpy(p->tv, p->v, bytes);
        if (!reflects)
            memcpy(p->rq, p->q, bytes), memcpy(p->ru, p->u, bytes), memcpy(p->rv, p->v, bytes);
    }
}

/* --- colours --- */

/* Width of a pixel at the point, across the ray: camera rays spread by the pixel's angle, unless they are parallel. For
 * deeper rays the path from the camera is treated as straight, which ignores magnification by mirrors and lenses. */
static double pixel_width(const plan *p, vec3 point)
{
    return 2.0 * p->view.half_height / (double)p->render.height *
           camera_spread(&p->view, vec3_length(vec3_sub(point, p->view.eye)));
}

/* Texture coordinates of the group's points, and the width of a pixel in them. */
typedef struct texture_points {
    double u[ROW], v[ROW], footprint[ROW];
} texture_points;

static void find_texture_points(const tracer *t, const primitive *surface, texture_points *at)
{
    const group *g = &t->surface.gathered;
    const double size = t->surface.mat->surface.texture_size;
    for (int k = 0; k < g->count; k++) {
        const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]);
        const surface_mapping m =
            t->surface.on_mesh ? t->meshes->mapping[k]
                               : primitive_mapping(surface, g->points.face[k],
                                                   t->surface.texture_at ? t->surface.texture_at[k] : point, size);
        /* An isotropic filter: at grazing incidence the footprint is limited to 20 pixel widths, or all would blur. */
        const double cosine = g->points.cos_i[k] > 0.05 ? g->points.cos_i[k] : 0.05;
        at->u[k] = m.u, at->v[k] = m.v;
        at->footprint[k] = pixel_width(t->target.frame_plan, point) / cosine * m.per_length;
    }
}

/* Multiplies the group's colours by the material's texture, and finds how much of a blended surface is there. */
static void texture_colors(tracer *t, int priority_index, const texture_points *at)
{
    const plan *p = t->target.frame_plan;
    group *g = &t->surface.gathered;
    for (int k = 0; t->surface.blended && k < g->count; k++)
        t->surface.cover[k] = shading_material_cover(t->surface.mat, at->u[k], at->v[k]);
    const bool weighted = t->surface.mat->covered && shading_material_is_partial(t->surface.mat) &&
                          p->geometry->regions[priority_index].partial;
    t->shade->tint(weighted ? t->surface.mat->covered : t->surface.mat->img, g->count, at->u, at->v, at->footprint,
                   g->cr, g->cg, g->cb);
}

/* Finds the light that the group's points emit. */
static void glow(tracer *t, const texture_points *at)
{
    const shading_material *m = t->surface.mat;
    const vec3 sent = vec3_scale(m->glow, m->surface.emission);
    mesh_work *w = t->meshes;
    const int count = t->surface.gathered.count;
    for (int k = 0; k < count; k++)
        w->glow_r[k] = sent.x, w->glow_g[k] = sent.y, w->glow_b[k] = sent.z;
    if (m->glow_img)
        t->shade->tint(m->glow_img, count, at->u, at->v, at->footprint, w->glow_r, w->glow_g, w->glow_b);
}

static void textured_colors(tracer *t, int priority_index, const primitive *surface)
{
    const shading_material *m = t->surface.mat;
    texture_points at;
    if (m->img || m->glow_img)
        find_texture_points(t, surface, &at);
    if (m->img)
        texture_colors(t, priority_index, &at);
    if (m->glows)
        glow(t, &at);
}

/* Replaces the group's colours, (1, 0, 0) for the material's first colour, else (0, 1, 0), by spectral values. */
static void spectral_colors(tracer *t, int key)
{
    group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        const region_spectrum *here = spectra_region(t->target.frame_plan->spectral, g->sample_key[k], key);
        g->cr[k] = g->cg[k] = g->cb[k] = g->cr[k] > 0.5 ? here->color : here->checker_color;
    }
}

/* A checker's cells are in the frame of the solid whose surface it is, even if another solid's face exposes it. */
static void color(tracer *t, int priority_index, const primitive *surface)
{
    const plan *p = t->target.frame_plan;
    const primitive *frame = surface->priority_index == priority_index
                                 ? surface
                                 : &p->geometry->primitives[p->geometry->regions[priority_index].outside];
    t->surface.blended = t->surface.mat->surface.alpha == ALPHA_BLEND && shading_material_is_partial(t->surface.mat) &&
                         p->geometry->regions[priority_index].partial && cover_use_of(t) == COVER_SPLIT;
    for (int k = 0; t->surface.blended && k < t->surface.gathered.padded; k++)
        t->surface.cover[k] = t->surface.mat->opacity;
    if (p->spectral) {
        /* First find which of the two colours applies, then its spectrum. */
        material marked = t->surface.mat->surface;
        marked.color = vec3_make(1.0, 0.0, 0.0);
        marked.checker_color = vec3_make(0.0, 1.0, 0.0);
        t->shade->color(&marked, frame, &t->surface.gathered);
        spectral_colors(t, t->surface.key);
    } else {
        t->shade->color(&t->surface.mat->surface, frame, &t->surface.gathered);
        if (t->surface.mat->img || t->surface.mat->glows)
            textured_colors(t, priority_index, surface);
    }
    if (t->surface.mat->vertex_colors && t->surface.on_mesh)
        mesh_tint(t);
}

/* --- a group --- */

/* The refractive indices at each ray's wavelength. */
static void spectral_indices(tracer *t, const int *list)
{
    group *g = &t->surface.gathered;
    const spectra *s = t->target.frame_plan->spectral;
    for (int k = 0; k < g->count; k++) {
        g->n_from[k] = spectra_region(s, g->sample_key[k], t->batch.hits.before[list[k]])->index;
        g->n_to[k] = spectra_region(s, g->sample_key[k], t->batch.hits.after[list[k]])->index;
    }
    for (int k = g->count; k < g->padded; k++)
        g->n_from[k] = g->n_from[g->count - 1], g->n_to[k] = g->n_to[g->count - 1];
}

/* Computes the points at which rays from .. to - 1 of the group hit a primitive. */
static void surface_points(tracer *t, int hit_primitive, int from, int to, surface_batch *points)
{
    const group *g = &t->surface.gathered;
    const ray_batch rays = {to - from,    g->ox + from, g->oy + from,    g->oz + from,           g->dx + from,
                            g->dy + from, g->dz + from, g->start + from, g->inside_before + from};
    t->geometry->surface(t->target.frame_plan->geometry, hit_primitive, &rays, g->t + from, points);
}

static void copy_points(const surface_batch *from, int count, surface_batch *to, int at)
{
    const size_t bytes = (size_t)count * sizeof(double);
    memcpy(to->px + at, from->px, bytes), memcpy(to->py + at, from->py, bytes), memcpy(to->pz + at, from->pz, bytes);
    memcpy(to->nx + at, from->nx, bytes), memcpy(to->ny + at, from->ny, bytes), memcpy(to->nz + at, from->nz, bytes);
    memcpy(to->cos_i + at, from->cos_i, bytes), memcpy(to->error + at, from->error, bytes);
    memcpy(to->face + at, from->face, bytes);
}

/* Computes the points on several analytic primitives; the points of the last group include the padding. */
static void points_of_groups(tracer *t, const hit_group *groups, int count)
{
    group *g = &t->surface.gathered;
    surface_batch some;
    for (int k = 0, from = 0; k < count; k++) {
        const int to = k + 1 < count ? from + groups[k].count : g->padded;
        surface_points(t, groups[k].hit_primitive, from, to, &some);
        copy_points(&some, to - from, &g->points, from);
        from = to;
    }
}

static void count_hits(tracer *t, int depth, int priority_index, int count)
{
    const int owner = t->target.frame_plan->geometry->regions[priority_index].solid;
    if (owner >= COUNTERS_SOLID_MAX)
        return;
    COUNT(t->account.counters.hits[owner] += (uint64_t)count);
    if (depth == 0)
        COUNT(t->account.counters.first_hits[owner] += (uint64_t)count);
}

/* Shades list[0 .. count - 1], the rays of these groups, which hit one material. */
static void shade_one_material(tracer *t, int depth, int first, const hit_group *groups, int group_count,
                               const int *list, int count)
{
    const plan *p = t->target.frame_plan;
    const int priority_index = groups->priority_index;
    const primitive *surface = &p->geometry->primitives[groups->hit_primitive];
    group *g = &t->surface.gathered;
    t->grouping->gather(tracer_queue_at(t, depth), first, &t->batch.hits, p->ior, list, count, group_count == 1, g);
    if (p->spectral)
        spectral_indices(t, list);
    if (t->layered)
        layered_gather(t, list, priority_index, t->surface.key);
    if (t->crystals)
        crystals_gather(t, tracer_queue_at(t, depth), first, list);
    if (p->render.polarisation)
        polarised_gather(t, tracer_queue_at(t, depth), first, list);
    t->surface.on_mesh = !surface->rule;
    if (t->surface.on_mesh)
        mesh_surface(t, priority_index, list);
    else if (group_count == 1)
        surface_points(t, groups->hit_primitive, 0, g->padded, &g->points);
    else
        points_of_groups(t, groups, group_count);
    if (t->footprints)
        footprints_gather(t, tracer_queue_at(t, depth), first, list);
    t->surface.texture_at = NULL;
    if (t->frame_integrator->place)
        t->frame_integrator->place(t, list);
    if (group_count == 1)
        count_hits(t, depth, priority_index, count);
    for (int k = 0; group_count > 1 && k < group_count; k++)
        count_hits(t, depth, groups[k].priority_index, groups[k].count);
    color(t, priority_index, surface);
    t->frame_integrator->shade(t, depth, priority_index);
}

/* The slots of the rays of a group on a solid whose faces have materials: the faces are those of their points. */
static void end_slots(tracer *t, int depth, int first, const hit_group *at, const int *list, int count, int *slots)
{
    const plan *p = t->target.frame_plan;
    const primitive *hit = &p->geometry->primitives[at->hit_primitive];
    const region_materials *materials = &p->shading_materials[at->priority_index];
    const bool own = hit->rule && hit->priority_index == at->priority_index;
    group *g = &t->surface.gathered;
    if (own) {
        t->grouping->gather(tracer_queue_at(t, depth), first, &t->batch.hits, p->ior, list, count, true, g);
        surface_points(t, at->hit_primitive, 0, g->padded, &g->points);
    }
    for (int k = 0; k < count; k++)
        slots[k] = own ? materials->end_slots[g->points.face[k] - hit->first_face] : 0;
}

/* Moves the rays with the slot of the first one to the front, in order; returns their number. */
static int next_end(int *list, int *slots, int count, int *slot)
{
    int others[BATCH], other_slots[BATCH], matching = 0, left = 0;
    *slot = slots[0];
    for (int k = 0; k < count; k++) {
        if (slots[k] == *slot) {
            list[matching++] = list[k];
            continue;
        }
        others[left] = list[k];
        other_slots[left++] = slots[k];
    }
    memcpy(list + matching, others, (size_t)left * sizeof *list);
    memcpy(slots + matching, other_slots, (size_t)left * sizeof *slots);
    return matching;
}

/* Shades groups that can be combined, or one group, divided by material slot. */
static void shade_combined(tracer *t, int depth, int first, const hit_group *groups, int count)
{
    const region_materials *materials = &t->target.frame_plan->shading_materials[groups->priority_index];
    const int *list = &t->batch.groups.list[groups->first];
    int rays = 0;
    for (int k = 0; k < count; k++)
        rays += groups[k].count;
    t->surface.mat = materials->mat;
    t->surface.key = groups->priority_index;
    if (materials->count == 1) {
        shade_one_material(t, depth, first, groups, count, list, rays);
        return;
    }
    int left[BATCH];
    memcpy(left, list, (size_t)rays * sizeof left[0]);
    int slots[BATCH];
    if (materials->end_slots)
        end_slots(t, depth, first, groups, list, rays, slots);
    for (int begin = 0; begin < rays;) {
        int slot;
        const int matching = materials->end_slots ? next_end(left + begin, slots + begin, rays - begin, &slot)
                                                  : mesh_next_material(t, left + begin, rays - begin, &slot);
        t->surface.mat = &materials->mat[slot < materials->count ? slot : 0];
        t->surface.key = plan_surface_key(t->target.frame_plan, groups->priority_index, slot);
        shade_one_material(t, depth, first, groups, 1, left + begin, matching);
        begin += matching;
    }
}

/* Whether a group can be combined with others of its class: not on a mesh, not if the material's values depend on the
 * primitive's frame, and not for an integrator that distinguishes solids. */
static bool can_be_combined(const tracer *t, const hit_group *g)
{
    const plan *p = t->target.frame_plan;
    /* the first region of the class, whose materials are in the caches */
    const int first_region = p->shading_class[g->priority_index];
    return !t->frame_integrator->by_solid && p->geometry->primitives[g->hit_primitive].rule &&
           plan_is_plain(p, first_region);
}

/* Combines consecutive groups, because in a scene of many solids small groups would leave most vector lanes empty. */
void shading_groups(tracer *t, int depth, int first, const hit_group *groups, int count)
{
    for (int k = 0, combined; k < count; k += combined) {
        combined = 1;
        while (k + combined < count && can_be_combined(t, &groups[k]) && can_be_combined(t, &groups[k + combined]))
            combined++;
        shade_combined(t, depth, first, &groups[k], combined);
    }
}

/* --- branches and children --- */

/* Sets weights to 0 that are too small, and counts their branches. */
static void cut_faint(tracer *t, bool colored, bool reflected, double *weight)
{
    const group *g = &t->surface.gathered;
    const double least = t->least_weight;
    for (int k = 0; k < g->count; k++) {
        const vec3 w = colored ? layered_weight(t, k, reflected) : vec3_make(weight[k], weight[k], weight[k]);
        const double r = g->wr[k] * w.x, gr = g->wg[k] * w.y, b = g->wb[k] * w.z;
        if (weight[k] == 0.0 || r >= least || gr >= least || b >= least)
            continue;
        count_cut_by_weight(t, g->sample_key[k], r, gr, b);
        weight[k] = 0.0;
    }
}

static void polarise_children(const tracer *t, ray_queue *q, int first, bool reflected, const int *list, int count)
{
    const polar_group *p = &t->surface.polar;
    const double *sq = reflected ? p->rq : p->tq, *su = reflected ? p->ru : p->tu, *sv = reflected ? p->rv : p->tv;
    for (int k = 0; k < count; k++)
        q->sq[first + k] = sq[list[k]], q->su[first + k] = su[list[k]], q->sv[first + k] = sv[list[k]];
}

int enqueue_children(tracer *t, int depth, const double *dx, const double *dy, const double *dz, const double *weight,
                     const uint64_t *inside)
{
    ray_queue *q = tracer_queue_at(t, depth);
    const bool reflected = weight == t->surface.branches.reflect,
               colored = surface_is_layered(t) && t->layered->colored;
    const int first = q->count;
    const group *g = &t->surface.gathered;
    int list[ROW];
    double kept[ROW]; /* a probe reads the weights of the branches that are cut */
    if (t->least_weight > 0.0) {
        memcpy(kept, weight, (size_t)g->count * sizeof *kept);
        cut_faint(t, colored, reflected, kept);
        weight = kept;
    }
    const new_rays children = {dx, dy, dz, g->wr, g->wg, g->wb, weight, inside, g->sample_key, NULL};
    const int count = t->grouping->append(g, &children, list, q);
    if (colored)
        layered_color_children(t, q, first, reflected, list, count);
    if (t->footprints)
        footprints_of_children(t, q, first, reflected, list, count);
    if (t->target.frame_plan->render.polarisation)
        polarise_children(t, q, first, reflected, list, count);
    return count;
}

void shading_branches_at_facets(tracer *t, bool opaque)
{
    const plan *p = t->target.frame_plan;
    const material *m = &t->surface.mat->surface;
    if (!opaque && p->render.transmission == TRANSMISSION_SIMPLE)
        t->shade->straight_branches(m, &t->surface.gathered, &t->surface.branches);
    else if (opaque || p->render.weights == WEIGHTS_CONSTANT)
        t->shade->constant_branches(m, opaque, &t->surface.gathered, &t->surface.branches);
    else
        t->shade->fresnel_branches(m, &t->surface.gathered, &t->surface.branches);
    if (surface_is_layered(t))
        layered_branches(t, m);
    else if (p->render.polarisation)
        polarised_branches(t, m, opaque);
}

void shading_branches(tracer *t, bool opaque)
{
    shading_branches_at_facets(t, opaque);
    if (t->surface.on_mesh)
        mesh_bound_branches(t);
    if (!opaque)
        COUNT(t->account.counters.total_internal += (uint64_t)t->surface.branches.total);
}
