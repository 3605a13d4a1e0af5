/* Convergence with depth: a slab of the vessel's medium in front of a surface that emits radiance 1. A ray at 40
 * degrees sees (1 - R)^2 (1 + R^2 + R^4 + ...), and a recursion depth truncates that series: the first term needs depth
 * 2, each further one two more. For unpolarised light this is the series of the mean R if each interface uses the mean,
 * and the mean of the two series if rays carry their polarisation, which is physically correct.
 *
 * Tolerance: some film units, 5.7e-14 each, and a few rounding errors. */
#include "realism/metrics.h"
#include "scene/model/scene.h"

#include <math.h>

#define SLAB_ANGLE (40.0 * M_PI / 180.0)
#define SLAB_TOLERANCE 1e-11
enum { DEPTH_MAX = 12 };

static scene *slab_scene(const scene *s, const setup *at, int depth, bool polarised)
{
    scene *copy = arrange_shining(s, at, box_at(vec3_make(0.0, 0.0, 0.0), vec3_make(10.0, 0.1, 10.0)), -1.0);
    if (!copy)
        return NULL;
    copy->render.depth = depth;
    copy->render.polarisation = polarised;
    return copy;
}

status slab_measure(const metrics *m, int depth, bool polarised, double *transmitted, diagnostic *why)
{
    trial t;
    status code = trial_start(&t, slab_scene(m->traced, &m->at, depth, polarised), m->level, why);
    if (code == STATUS_OK)
        code =
            probe_ray(t.p, vec3_make(0.0, 1.0, 0.0), vec3_make(sin(SLAB_ANGLE), -cos(SLAB_ANGLE), 0.0), &t.tree, why);
    if (code == STATUS_OK)
        *transmitted = t.tree.radiance[0];
    trial_end(&t);
    return code;
}

double slab_theory(const metrics *m, int depth, bool polarised)
{
    const double n_from = m->theory_at.n[SETUP_OUTSIDE], n_to = m->theory_at.n[SETUP_VESSEL];
    if (n_from == n_to)
        return 1.0; /* without an interface no depth is needed */
    const double R_s = theory_fresnel_s(SLAB_ANGLE, n_from, n_to), R_p = theory_fresnel_p(SLAB_ANGLE, n_from, n_to);
    return polarised ? (theory_slab(R_s, depth / 2) + theory_slab(R_p, depth / 2)) / 2.0
                     : theory_slab((R_s + R_p) / 2.0, depth / 2);
}

status realism_slab(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"slab.depth", "slab.depth_polarised"};
    static const char *const what[] = {
        "radiance behind a slab at 40 degrees; largest error for depths 0 to 12",
        "radiance behind a slab at 40 degrees with render.polarisation=on; largest error for depths 0 to 12"};
    status code = STATUS_OK;
    for (int polarised = 0; polarised < 2 && code == STATUS_OK; polarised++) {
        const bool exists = !polarised || !scene_has_constant_shares(&m->traced->render);
        worst_pair worst = {NAN, NAN, false};
        for (int depth = 0; depth <= DEPTH_MAX && code == STATUS_OK && exists; depth++) {
            double measured = NAN;
            code = slab_measure(m, depth, polarised, &measured, why);
            worst_take(&worst, measured, slab_theory(m, depth, polarised));
        }
        metrics_add(m, (realism_value){names[polarised],
                                       exists ? what[polarised] : "constant weights have no polarisation", "",
                                       worst.measured, worst.theory, SLAB_TOLERANCE});
    }
    return code;
}
