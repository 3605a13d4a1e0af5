/* Whitted's recursion ("An improved illumination model for shaded display", CACM 23(6), 1980): Phong's local light,
 * and, if render.lighting enables them, both branches of each ray, reflected and refracted, with their weights. Ray
 * casting (Appel, "Some techniques for shading machine renderings of solids", AFIPS 1968) is its first level: the
 * local light of camera rays' hits, with shadows, and no secondary rays. */
#include "render/shade/exposure.h"
#include "render/shade/kernels.h"
#include "render/shade/light_sampling.h"
#include "render/shade/shading.h"
#include "render/tracer/tracer.h"

/* Computes the branches of the gathered group; false if it has none. */
static bool make_branches(tracer *t, bool opaque)
{
    const bool reflects = !opaque || surface_reflects(t);
    if (!reflects && !t->surface.blended)
        return false;
    if (reflects)
        shading_branches(t, opaque);
    if (t->surface.blended)
        cover_branches(t, reflects);
    if (t->crystals && t->crystals->any)
        crystals_branches(t, opaque);
    return true;
}

/* Enqueues the branches, or cuts them off at the depth limit. */
static void follow_branches(tracer *t, int depth)
{
    const group *g = &t->surface.gathered;
    branch_group *b = &t->surface.branches;
    if (t->crystals && t->crystals->any)
        crystals_follow(t, depth);
    if (depth == t->queues.depth_limit) {
        cut_branches(t);
        return;
    }
    const int reflected = enqueue_children(t, depth + 1, b->rx, b->ry, b->rz, b->reflect, g->inside_before);
    const int refracted = enqueue_children(t, depth + 1, b->tx, b->ty, b->tz, b->refract, g->inside_after);
    COUNT(t->account.counters.reflect += (uint64_t)reflected);
    COUNT(t->account.counters.refract += (uint64_t)refracted);
}

static void light_of_hits(tracer *t, int depth, int priority_index)
{
    cover_saved saved;
    cover_weigh(t, &saved);
    local_light(t, priority_index, light_terms_of(&t->target.frame_plan->render));
    if (scene_has_soft_shadows(&t->target.frame_plan->render))
        area_lights_soften(t, depth);
    cover_weigh_back(t, &saved);
}

static void shade(tracer *t, int depth, int priority_index)
{
    light_of_hits(t, depth, priority_index);
    if (t->target.frame_plan->render.lighting == LIGHTING_WHITTED &&
        make_branches(t, surface_is_opaque(t, priority_index)))
        follow_branches(t, depth);
}

const integrator integrator_of_whitted = {.cover = COVER_SPLIT,
                                          .traced = true,
                                          .sampling = camera_samples,
                                          .intersect = intersect_nearest,
                                          .background = background_sky,
                                          .shade = shade};

/* --- ray casting --- */

const integrator integrator_of_raycast = {.traced = true,
                                          .sampling = camera_samples,
                                          .intersect = intersect_nearest,
                                          .background = background_sky,
                                          .shade = light_of_hits};

/* --- all depth limits at once --- */

static void move_to_layer(tracer *t, int layers)
{
    group *g = &t->surface.gathered;
    const render_settings *r = &t->target.frame_plan->render;
    for (int k = 0; k < g->count; k++)
        g->sample_key[k] += (int64_t)layers * r->width * r->height;
}

/* The rays of depth k are in layer 2 k: first they are cut, into the next layer, then followed, into the one after. */
static void shade_levels(tracer *t, int depth, int priority_index)
{
    const int limit = t->queues.depth_limit;
    light_of_hits(t, depth, priority_index);
    if (!make_branches(t, surface_is_opaque(t, priority_index)))
        return;
    move_to_layer(t, 1);
    t->queues.depth_limit = depth;
    follow_branches(t, depth);
    t->queues.depth_limit = limit;
    if (depth == limit)
        return;
    move_to_layer(t, 1);
    follow_branches(t, depth);
}

const integrator integrator_of_levels = {.cover = COVER_SPLIT,
                                         .traced = true,
                                         .sampling = camera_samples,
                                         .intersect = intersect_nearest,
                                         .background = background_sky,
                                         .shade = shade_levels};
