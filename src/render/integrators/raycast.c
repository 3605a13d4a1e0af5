/* Ray casting (Appel, "Some techniques for shading machine renderings of solids", AFIPS 1968): the local light of what
 * camera rays meet, with its shadows. No ray goes on. */
#include "render/shade/shading.h"

static void shade(tracer *t, int depth, int priority_index)
{
    (void)depth;
    local_light(t, priority_index, light_terms_of(&t->target.frame_plan->render));
}

const integrator integrator_of_raycast = {
    .traced = true, .sampling = camera_samples, .meet = meet_nearest, .background = background_sky, .shade = shade};
