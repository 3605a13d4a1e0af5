/* Ray casting (Appel, "Some techniques for shading machine renderings of solids", AFIPS 1968): the local light of
 * camera rays' hits, with shadows. No secondary rays. */
#include "render/shade/area_lights.h"

static void shade(tracer *t, int depth, int priority_index)
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
                                          .shade = shade};
