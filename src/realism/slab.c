/* Convergence with depth: a slab of the vessel's medium in front of a surface that emits radiance 1. A ray at 40
 * degrees sees (1 - R)^2 (1 + R^2 + R^4 + ...), and a recursion depth truncates that series: the first term needs depth
 * 2, each further one two more. For unpolarised light this is the series of the mean R if each interface uses the mean,
 * and the mean of the two series if rays carry their polarisation, which is physically correct.
 *
 * Tolerance: half a unit of the film for each term, the rounding of its factors, and the bound of R times the largest
 * derivative of the series by R, 2, at both faces. */
#include "realism/metrics.h"
#include "scene/model/scene.h"

#include <math.h>

#define SLAB_ANGLE (40.0 * M_PI / 180.0)
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

static double tolerance_at(const metrics *m, int depth)
{
    const double n_from = m->theory_at.n[SETUP_OUTSIDE], n_to = m->theory_at.n[SETUP_VESSEL];
    const share_bound off = bound_shares(SLAB_ANGLE, bound_difference(BOUND_TURN), n_from, n_to);
    return (depth / 2 + 1) * BOUND_FILM + bound_difference(BOUND_FORM * (depth + 1)) +
           2.0 * 2.0 * fmax(off.R, fmax(off.R_s, off.R_p));
}

status realism_slab(const metrics *m, diagnostic *why)
{
    static const char *const names[] = {"slab.depth", "slab.depth_polarised"};
    static const char *const what[] = {
        "radiance behind a slab at 40 degrees; largest error for depths 0 to 12",
        "radiance behind a slab at 40 degrees with render.polarisation=on; largest error for depths 0 to 12"};
    status code = STATUS_OK;
    for (int polarised = 0; polarised < 2 && code == STATUS_OK; polarised++) {
        const bool exists = !polarised || !scene_has_constant_weights(&m->traced->render);
        worst_pair worst = WORST_NONE;
        for (int depth = 0; depth <= DEPTH_MAX && code == STATUS_OK && exists; depth++) {
            double measured = NAN;
            code = slab_measure(m, depth, polarised, &measured, why);
            worst_take(&worst, measured, slab_theory(m, depth, polarised), tolerance_at(m, depth));
        }
        metrics_add(m, (realism_value){names[polarised],
                                       exists ? what[polarised] : "constant weights have no polarisation", "",
                                       worst.measured, worst.theory, worst.tolerance});
    }
    return code;
}
