/* Ray casting (Appel, "Some techniques for shading machine renderings of solids", AFIPS 1968): the local light of
 * camera rays' hits, with shadows. No secondary rays. */
#include "render/shade/shading.h"

static void shade(tracer *t, int depth, int priority_index)
{
    (void)depth;
    local_light(t, priority_index, light_terms_of(&t->target.frame_plan->render));
}

const integrator integrator_of_raycast = {.traced = true,
                                          .sampling = camera_samples,
                                          .intersect = intersect_nearest,
                                          .background = background_sky,
                                          .shade = shade};
