/* Whitted's recursion ("An improved illumination model for shaded display", CACM 23(6), 1980): Phong's local light,
 * and, if render.lighting enables them, both branches of each ray, reflected and refracted, with their weights. Ray
 * casting (Appel, "Some techniques for shading machine renderings of solids", AFIPS 1968) is its first level: the
 * local light of camera rays' hits, with shadows, and no secondary rays. */
#include "render/camera/camera_rays.h"
#include "render/shade/crystals.h"
#include "render/shade/exposure.h"
#include "render/shade/radiance.h"
#include "render/shade/light_sampling.h"
#include "render/shade/shading.h"

static void branch(tracer *t, int depth, bool opaque)
{
    const group *g = &t->surface.gathered;
    const branch_group *b = &t->surface.branches;
    if (opaque && !surface_reflects(t))
        return;
    shading_branches(t, opaque);
    if (t->crystals && t->crystals->any) {
        crystals_branches(t, opaque);
        crystals_follow(t, depth);
    }
    if (depth == t->queues.depth_limit) {
        cut_branches(t);
        return;
    }
    const int reflected = enqueue_children(t, depth + 1, b->rx, b->ry, b->rz, b->reflect, g->inside_before);
    const int refracted = enqueue_children(t, depth + 1, b->tx, b->ty, b->tz, b->refract, g->inside_after);
    COUNT(t->account.counters.reflect += (uint64_t)reflected);
    COUNT(t->account.counters.refract += (uint64_t)refracted);
}

static void shade(tracer *t, int depth, int priority_index)
{
    const render_settings *r = &t->target.frame_plan->render;
    local_light(t, priority_index, light_terms_of(r));
    if (scene_has_soft_shadows(r))
        area_lights_soften(t, depth);
    if (r->lighting == LIGHTING_WHITTED)
        branch(t, depth, surface_is_opaque(t, priority_index));
}

const integrator integrator_of_whitted = {.traced = true,
                                          .sampling = camera_samples,
                                          .intersect = intersect_nearest,
                                          .background = background_sky,
                                          .shade = shade};

/* --- ray casting --- */

static void shade_first(tracer *t, int depth, int priority_index)
{
    const render_settings *r = &t->target.frame_plan->render;
    local_light(t, priority_index, light_terms_of(r));
    if (scene_has_soft_shadows(r))
        area_lights_soften(t, depth);
}

const integrator integrator_of_raycast = {.traced = true,
                                          .sampling = camera_samples,
                                          .intersect = intersect_nearest,
                                          .background = background_sky,
                                          .shade = shade_first};
