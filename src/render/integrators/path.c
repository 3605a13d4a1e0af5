/* Path tracing (Kajiya, "The Rendering Equation", SIGGRAPH 1986): at each surface one continuation is sampled at
 * random, weighted so that the mean over all paths equals the light of the full ray tree. Sampling by surface:
 *   a clear surface  reflects or refracts with Fresnel's weights as probabilities, so the throughput stays the same;
 *   a matte surface  is lit by every light, from a random point of a light with a size (render/shade/light_sampling.h),
 *                    and continues the path by the cosine law, or like a mirror with its reflectivity;
 *   a rough surface  acts as a smooth one with the normal of one of its facets, and samples the lamps (path_rough.c);
 *   a medium that scatters ends a ray's flight, lights the point by every lamp, and continues the path by its phase
 *                    function (path_scatter.c).
 * Only rays from the camera and from specular surfaces hit lights: matte surfaces have sampled them directly. These
 * rays form caustics, light through clear solids; with render.caustics photons supply it instead, and rays hit lights
 * only if all surfaces from the camera on are specular. In a scene with lights of a size, clear solids block point
 * lights too. A light's radiance is such that a matte surface at its reach is as bright as in Phong's model. There is
 * no ambient term: light from the sky and from other surfaces replaces it.
 *
 * With polarisation a path carries the analyser's row (optics/mueller.h) backwards from the eye, as a ray of a tree
 * does: the eye sees s_out = M_1 M_2 .. s, and only the first row of the product of Mueller matrices is needed, the
 * adjoint of a Stokes vector (Mojzik and others, "Bi-directional Polarised Light Transport", EGSR 2016; Jarabo and
 * Arellano, "Bidirectional Rendering of Vector Light Transport", 2018). Its first element is part of the throughput,
 * and the weights of branches, by which they are chosen, are computed with the row. Matte surfaces and media that
 * scatter see only the intensity. */
#include "render/integrators/path.h"

#include "geometry/rays.h"
#include "render/shade/exposure.h"
#include "render/shade/media.h"
#include "render/shade/polarisation.h"
#include "render/shade/rough.h"
#include "render/shade/shading.h"

/* Clips the medium segments of a ray at the light. */
static void clip_segments(medium_segments *segments, int ray, double end)
{
    double start = 0.0;
    for (int k = 0; segments && k < segments->count; k++) {
        medium_segment *one = &segments->segment[k];
        if (one->ray != ray)
            continue;
        const double length = one->length;
        one->length = start + length <= end ? length : start < end ? end - start : 0.0;
        start += length;
    }
}

/* Rays that end at a light have its number encoded in hits.hit_primitive. */
static int64_t mark_of(int lamp)
{
    return -2 - lamp;
}

static int lamp_of(int64_t hit_primitive)
{
    return (int)(-2 - hit_primitive);
}

/* Finds the nearest light with a size in front of each ray's surface, light by light, since few rays of a batch pass
 * near one. */
static void intersect_lights(tracer *t, const ray_queue *q, int first, const ray_batch *rays)
{
    const plan *p = t->target.frame_plan;
    hit_batch *hits = &t->batch.hits;
    double nearest[ROW];
    int lamp[ROW];
    int64_t near[ROW];
    int64_t seen = 0; /* not 0: some ray may hit a light; the other rays left surfaces that sampled the lights */
    for (int i = 0; i < rays->count; i++) {
        nearest[i] = hits->t[i], lamp[i] = -1;
        seen |= q->sample_key[first + i] & SAMPLE_KEY_SPECULAR_BOUNCE;
    }
    for (int k = 0; seen && k < p->light_count; k++) {
        const light *l = &p->lights[k];
        const double extent = light_extent(l);
        if (extent == 0.0 || !t->sampling->near_sphere(rays, l->position, extent, near))
            continue;
        for (int i = 0; i < rays->count; i++) {
            if (!near[i] || !(q->sample_key[first + i] & SAMPLE_KEY_SPECULAR_BOUNCE))
                continue;
            const double distance = area_light_distance(p, k, vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]),
                                                        vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]));
            if (distance < nearest[i])
                nearest[i] = distance, lamp[i] = k;
        }
    }
    for (int i = 0; i < rays->count; i++)
        if (lamp[i] >= 0) {
            hits->hit_primitive[i] = mark_of(lamp[i]);
            clip_segments(t->batch.scratch.segments, i, nearest[i]);
        }
}

static void intersect(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays)
{
    const bool scatters = t->target.frame_plan->scatter != NULL;
    if (scatters)
        scattering_begin(t, q, first, depth, rays->count);
    intersect_nearest(t, q, first, depth, rays);
    intersect_lights(t, q, first, rays);
    if (scatters) {
        scattering_end(t);
        path_scatter_mark(t, q, first, rays->count);
    }
}

static void expose_light(tracer *t, const ray_queue *q, int at, int lamp, int priority_index)
{
    const plan *p = t->target.frame_plan;
    const int64_t sample_key = q->sample_key[at];
    const vec3 direction = vec3_make(q->dx[at], q->dy[at], q->dz[at]);
    double radiance =
        area_light_radiance(p, lamp, direction) * (p->basic ? radiance_scale(p, sample_key, priority_index) : 1.0);
    if (p->render.polarisation && p->lights[lamp].polarised > 0.0)
        radiance *= lamp_seen(p, lamp, (stokes){1.0, q->sq[at], q->su[at], q->sv[at]}, direction);
    const vec3 l = vec3_scale(light_color_of(t, lamp, sample_key), radiance);
    shading_expose(t, sample_key, q->wr[at] * l.x, q->wg[at] * l.y, q->wb[at] * l.z);
}

/* Adds the suns in the sky. */
static void expose_suns(tracer *t, const ray_queue *q, int at)
{
    const plan *p = t->target.frame_plan;
    const vec3 direction = vec3_make(q->dx[at], q->dy[at], q->dz[at]);
    if (!p->has_sun || !(q->sample_key[at] & SAMPLE_KEY_SPECULAR_BOUNCE))
        return;
    for (int k = 0; k < p->light_count; k++)
        if (p->lights[k].kind == LIGHT_SUN && light_has_area(p, k) &&
            area_light_distance(p, k, vec3_make(q->ox[at], q->oy[at], q->oz[at]), direction) < (double)HUGE_VAL)
            expose_light(t, q, at, k, 0);
}

static void expose_background(tracer *t, const ray_queue *q, int first, const int *list, int count)
{
    int scattered[ROW], scattered_count = 0, sky[ROW], sky_count = 0;
    for (int k = 0; k < count; k++) {
        const int i = list[k];
        const int64_t hit = t->batch.hits.hit_primitive[i];
        if (hit == -1)
            sky[sky_count++] = i;
        else if (hit == PATH_SCATTERED)
            scattered[scattered_count++] = i;
        else
            expose_light(t, q, first + i, lamp_of(hit), (int)t->batch.hits.before[i]);
    }
    if (sky_count > 0)
        background_sky(t, q, first, sky, sky_count);
    for (int k = 0; k < sky_count; k++)
        expose_suns(t, q, first + sky[k]);
    if (scattered_count > 0)
        path_scatter(t, q, first, scattered, scattered_count);
}

/* Copies a branch's Stokes vector to the continuation; a matte surface sees only the intensity. */
static void keep_polarisation(const tracer *t, int k, continuation *c)
{
    const polar_group *p = &t->surface.polar;
    if (!t->target.frame_plan->render.polarisation)
        return;
    c->q = c->refracted ? p->tq[k] : p->rq[k];
    c->u = c->refracted ? p->tu[k] : p->ru[k];
    c->v = c->refracted ? p->tv[k] : p->rv[k];
}

static bool draw_clear(const tracer *t, int k, double chance, continuation *c)
{
    const branch_group *b = &t->surface.branches;
    const double both = b->reflect[k] + b->refract[k];
    if (!(both > 0.0))
        return false;
    c->refracted = chance * both >= b->reflect[k] && b->refract[k] > 0.0;
    c->direction = c->refracted ? vec3_make(b->tx[k], b->ty[k], b->tz[k]) : vec3_make(b->rx[k], b->ry[k], b->rz[k]);
    c->inside = c->refracted ? t->surface.gathered.inside_after[k] : t->surface.gathered.inside_before[k];
    c->factor = vec3_make(both, both, both);
    if (surface_is_layered(t)) /* relative to the mean over channels, by which the branch was chosen */
        c->factor =
            vec3_scale(layered_weight(t, k, !c->refracted), both / (c->refracted ? b->refract[k] : b->reflect[k]));
    c->specular_bounce = true;
    keep_polarisation(t, k, c);
    return true;
}

/* Random numbers and directions for the continuations of a group. */
typedef struct path_choices {
    double branch[ROW]; /* in (0, 1); set only where there is a choice */
    double x[ROW], y[ROW], z[ROW];
} path_choices;

static void choose(tracer *t, const material *m, bool opaque, int depth, path_choices *c)
{
    const path_sampling *draws = &t->target.frame_plan->draws;
    const group *g = &t->surface.gathered;
    double u[ROW], v[ROW];
    if (!opaque || surface_reflects(t))
        t->sampling->draw(draws, g->count, g->sample_key, depth, DRAW_BRANCH, c->branch, v);
    if (!opaque || !(m->diffuse > 0.0))
        return;
    t->sampling->draw(draws, g->count, g->sample_key, depth, DRAW_DIRECTION, u, v);
    t->sampling->cosine(g, u, v, c->x, c->y, c->z);
}

static bool draw_matte(const tracer *t, const material *m, int k, const path_choices *chosen, continuation *c)
{
    const group *g = &t->surface.gathered;
    const double matte = path_matte_weight(g, m, k),
                 mirror = surface_is_layered(t) ? t->surface.branches.reflect[k] : m->reflectivity;
    if (!(matte + mirror > 0.0))
        return false;
    /* matte is tested first: without it, the product with a subnormal mirror may be rounded to mirror */
    const bool mirrored = mirror > 0.0 && (!(matte > 0.0) || chosen->branch[k] * (matte + mirror) < mirror);
    const double odds = (mirrored ? mirror : matte) / (matte + mirror);
    c->inside = g->inside_before[k];
    c->refracted = false;
    c->specular_bounce = mirrored;
    c->matte = !mirrored;
    if (mirrored) {
        c->direction = vec3_make(t->surface.branches.rx[k], t->surface.branches.ry[k], t->surface.branches.rz[k]);
        c->factor = surface_is_layered(t) ? vec3_scale(layered_weight(t, k, true), 1.0 / odds)
                                          : vec3_make(mirror / odds, mirror / odds, mirror / odds);
        keep_polarisation(t, k, c);
        return true;
    }
    c->direction = vec3_make(chosen->x[k], chosen->y[k], chosen->z[k]);
    c->factor = vec3_scale(vec3_make(g->cr[k], g->cg[k], g->cb[k]), m->diffuse / odds);
    return mesh_lets_out(t, k, c->direction);
}

/* Draws and enqueues the continuation of ray k. rough: NULL for a smooth surface. */
static void continue_one(tracer *t, const material *m, bool opaque, int k, int depth, const path_choices *chosen,
                         const rough_surface *rough)
{
    continuation c = {.refracted = false};
    if (!(opaque ? draw_matte(t, m, k, chosen, &c) : draw_clear(t, k, chosen->branch[k], &c)))
        return;
    if (rough && !c.matte && !path_rough_scatter(t, rough, k, &c))
        return;
    path_continue(t, k, depth, &c);
}

/* Whether a surface's continuations need no more than path_continue_all. */
static bool is_plain_surface(const tracer *t, const material *m, bool opaque, int depth)
{
    const plan *p = t->target.frame_plan;
    return depth < t->queues.depth_limit && rough_alpha(t) == 0.0 && !surface_is_layered(t) && !t->surface.on_mesh &&
           !p->render.polarisation && !p->photons && (!opaque || m->reflectivity == 0.0);
}

static void continue_plain(tracer *t, const material *m, bool opaque, int depth)
{
    const path_sampling *draws = &t->target.frame_plan->draws;
    const group *g = &t->surface.gathered;
    continuations c;
    double u[ROW], v[ROW];
    if (opaque && !(m->diffuse > 0.0))
        return;
    t->sampling->draw(draws, g->count, g->sample_key, depth, opaque ? DRAW_DIRECTION : DRAW_BRANCH, u, v);
    if (opaque) {
        t->sampling->cosine(g, u, v, c.dx, c.dy, c.dz);
        t->sampling->leave_matte(g, m->diffuse, &c);
    } else {
        shading_branches(t, false);
        t->sampling->choose_branches(g, &t->surface.branches, u, &c);
    }
    path_continue_all(t, depth, &c);
}

static void shade(tracer *t, int depth, int priority_index)
{
    const material *m = &t->surface.mat->surface;
    const bool opaque = surface_is_opaque(t, priority_index);
    const double alpha = rough_alpha(t);
    rough_surface rough;
    path_choices chosen;
    path_sample_lights(t, priority_index, depth);
    if (is_plain_surface(t, m, opaque, depth)) {
        continue_plain(t, m, opaque, depth);
        return;
    }
    if (alpha > 0.0)
        path_rough_begin(t, alpha, opaque, depth, &rough);
    else
        shading_branches(t, opaque);
    choose(t, m, opaque, depth, &chosen);
    for (int k = 0; k < t->surface.gathered.count; k++)
        continue_one(t, m, opaque, k, depth, &chosen, alpha > 0.0 ? &rough : NULL);
}

/* Camera rays through the centres of cells: with fewer paths than samples there are fewer cells, because with only the
 * first rows of the grid the image would shift. */
static camera_sampling paths_of(const render_settings *r)
{
    const int64_t points = r->paths < r->samples ? r->paths : r->samples;
    return (camera_sampling){.rays = r->paths,
                             .points = points,
                             .rays_per_point = 1,
                             .jittered = r->filter == PIXEL_FILTER_BOX,
                             .marks = SAMPLE_KEY_SPECULAR_BOUNCE};
}

static int replicates(const render_settings *r)
{
    return (int)path_sampling_of(r).replicates;
}

const integrator integrator_of_path = {.cover = COVER_CHANCE,
                                       .traced = true,
                                       .needs_sample_number = true,
                                       .sampling = paths_of,
                                       .replicates = replicates,
                                       .intersect = intersect,
                                       .background = expose_background,
                                       .shade = shade};
