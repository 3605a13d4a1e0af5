/* An empty gap between the vessel's medium and an opaque surface of radiance 1, seen from within the medium: the
 * radiance is 1 - R below the critical angle and 0 above it, however narrow the gap (in contact it would be 1). A
 * distant solid that no ray hits changes neither.
 *
 * Depth 1, so that nothing returns from the medium's other face. Tolerance: half a unit of the film, and the bound of R
 * at that angle. */
#include "realism/metrics.h"
#include "scene/model/scene.h"

#include <math.h>

static const double narrow = 1e-7, wide = 1e-3; /* scene units */

static scene *gap_scene(const scene *s, const setup *at, double gap, bool far_solid)
{
    scene *copy = arrange_shining(s, at, box_at(vec3_make(0.0, 0.5, 0.0), vec3_make(100.0, 1.0, 100.0)), -gap);
    if (!copy)
        return NULL;
    copy->solids[at->vessel].priority = 2, copy->solids[at->rod].priority = 0;
    if (far_solid) {
        solid *far = &copy->solids[at->liquid];
        far->visible = 1;
        far->priority = 9;
        far->shape = ball_at(vec3_make(0.0, 1e5, 0.0), 1.0);
    }
    copy->render.depth = 1;
    return copy;
}

/* With basic radiance the camera, inside the vessel's medium, also sees a factor of the square of the index. */
static double gap_theory(const metrics *m, double angle, double *tolerance)
{
    const double n_from = m->theory_at.n[SETUP_VESSEL], n_to = m->theory_at.n[SETUP_OUTSIDE], ratio = n_from / n_to;
    const double gain = scene_has_basic_radiance(&m->supposed->render) ? ratio * ratio : 1.0,
                 off = bound_shares(angle, 0.0, n_from, n_to).R;
    *tolerance = BOUND_FILM + gain * (off + bound_difference(BOUND_FORM));
    return gain * (n_from == n_to ? 1.0 : 1.0 - theory_fresnel(angle, n_from, n_to));
}

static status measure(const metrics *m, double gap, bool far_solid, worst_pair *worst, diagnostic *why)
{
    trial t;
    status code = trial_start(&t, gap_scene(m->traced, &m->at, gap, far_solid), m->level, why);
    for (int degrees = 0; degrees <= 85 && code == STATUS_OK; degrees += 5) {
        const double angle = degrees * M_PI / 180.0;
        code = probe_ray(t.p, vec3_make(0.0, 0.5, 0.0), vec3_make(sin(angle), -cos(angle), 0.0), &t.tree, why);
        double tolerance;
        const double theory = gap_theory(m, angle, &tolerance);
        worst_take(worst, code == STATUS_OK ? t.tree.radiance[0] : NAN, theory, tolerance);
    }
    trial_end(&t);
    return code;
}

status realism_gap(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"gap.empty", "gap.far_solid"};
    static const char *const what[] = {
        "radiance through an empty gap of 1e-7; largest error for 0 to 85 degrees",
        "radiance through a gap of 0.001, with a solid at distance 100000 that no ray hits"};
    const bool fresnel =
        !scene_has_constant_weights(&m->traced->render) && m->traced->render.transmission == TRANSMISSION_REFRACT;
    status code = STATUS_OK;
    for (int far_solid = 0; far_solid < 2 && code == STATUS_OK; far_solid++) {
        const bool third = !far_solid || m->at.liquid >= 0;
        worst_pair worst = WORST_NONE;
        if (fresnel && third)
            code = measure(m, far_solid ? wide : narrow, far_solid, &worst, why);
        const char *line = !fresnel ? "constant weights have no critical angle"
                           : !third ? "an empty vessel's scene has no third solid"
                                    : what[far_solid];
        metrics_add(m, (realism_value){names[far_solid], line, "", worst.measured, worst.theory, worst.tolerance});
    }
    return code;
}
