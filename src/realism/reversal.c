/* Reversed paths: light returns along the path that it came, and an interface has the same transmittance from both
 * sides (Stokes relations; Hecht, Optics, 5th ed., 4.10). Random paths through the vessel, refracted or reflected once,
 * are traced to their end and back. The reversed path ends on the origin ray of the path, and has the same throughput.
 * (Radiance has an additional factor n^2 in a medium; both ends are outside, where it cancels, and the tracer's
 * throughput omits it.) Paths near grazing incidence are excluded: errors grow there as 1 / cos.
 *
 * Tolerance: the bound of the reversed path, to whose errors at each surface those of the path itself add. */
#include "realism/metrics.h"

#include "base/random.h"
#include <math.h>

#define LEAST_COSINE 0.1
enum { PATHS = 2000, HITS_MAX = 12 };

typedef struct test_path {
    vec3 from, along;
    int reflect_at;
} test_path;

static test_path random_path(const setup *at, uint32_t number)
{
    const random_words a = random_at(10, number, 0, 0, 0), b = random_at(10, number, 1, 0, 0);
    const double turn = 2.0 * M_PI * random_unit(a.word[0]), middle = (at->low + at->high) / 2.0;
    const vec3 from =
        vec3_make(at->x + 3.0 * at->outer * cos(turn), middle + (random_unit(a.word[1]) - 0.3) * 3.0 * at->outer,
                  at->z + 3.0 * at->outer * sin(turn));
    const double aside = at->outer * (2.0 * random_unit(a.word[2]) - 1.0);
    const vec3 to = vec3_make(at->x - aside * sin(turn), at->low + (at->high - at->low) * random_unit(a.word[3]),
                              at->z + aside * cos(turn));
    const test_path w = {from, vec3_normalize(vec3_sub(to, from)), (int)(b.word[0] % 4) - 1};
    return w;
}

/* The number of surfaces of the path; -1 if it does not leave the vessel or grazes a surface. There are no surfaces
 * between media with equal indices. */
static int surfaces(const ray_tree *tree)
{
    const int hits = (int)tree->count - 1;
    if (hits > HITS_MAX || tree->node[hits].end != RAY_END_SKY)
        return -1;
    for (int i = 0; i < hits; i++) {
        const ray_hit *h = &tree->node[i].hit;
        if (h->cos_i < LEAST_COSINE || (!h->tir && h->cos_t < LEAST_COSINE))
            return -1;
    }
    return hits;
}

/* A reflection requested after the last surface of the path would be at another surface on the reversed path. */
static int reflected_at(const ray_tree *tree, int asked)
{
    return asked >= 0 && asked + 1 < (int)tree->count && tree->node[asked + 1].kind == RAY_REFLECT ? asked : -1;
}

/* Of the reversed path: its throughput, and its distance from the origin of the path. */
typedef struct round_trip {
    double forth, back, miss;
    path_bound off;
    bool done;
} round_trip;

static status trace_back(trial *forth, trial *back, const setup *at, uint32_t number, round_trip *out, diagnostic *why)
{
    const test_path w = random_path(at, number);
    *out = (round_trip){NAN, NAN, NAN, {0.0, 0.0, 0.0}, false};
    status code = probe_path(forth->p, w.from, w.along, w.reflect_at, &forth->tree, why);
    const int hits = code == STATUS_OK ? surfaces(&forth->tree) : -1;
    if (hits < 0)
        return code;
    const ray_node *last = &forth->tree.node[hits];
    const int asked = reflected_at(&forth->tree, w.reflect_at);
    const vec3 start = vec3_add(last->origin, vec3_scale(last->direction, 3.0 * at->outer));
    TRY(probe_path(back->p, start, vec3_scale(last->direction, -1.0), asked < 0 ? -1 : hits - 1 - asked, &back->tree,
                   why));
    const ray_node *home = &back->tree.node[back->tree.count - 1];
    const vec3 away = vec3_sub(w.from, home->origin);
    out->done = true;
    out->forth = last->throughput[0];
    if ((int)back->tree.count - 1 != hits || home->end != RAY_END_SKY)
        return STATUS_OK; /* another path: nothing agrees */
    out->back = home->throughput[0];
    out->miss = vec3_length(vec3_cross(away, home->direction));
    out->off = bound_path(&back->tree, 1.0 / at->inner);
    out->off.across += out->off.heading * vec3_length(away);
    return STATUS_OK;
}

status realism_reversal(const metrics *m, diagnostic *why)
{
    trial forth, back = {0};
    worst_pair ratio = WORST_NONE, miss = WORST_NONE;
    status code = trial_start(&forth, arrange_vessel(m->supposed, &m->theory_at), m->level, why);
    THEN(code, trial_start(&back, arrange_vessel(m->traced, &m->at), m->level, why));
    for (uint32_t i = 0; i < PATHS && code == STATUS_OK; i++) {
        round_trip r;
        code = trace_back(&forth, &back, &m->theory_at, i, &r, why);
        if (r.done && r.forth > 0.0) {
            worst_take(&ratio, r.back / r.forth, 1.0, r.off.weight);
            worst_take(&miss, r.miss, 0.0, r.off.across);
        }
    }
    trial_end(&forth);
    trial_end(&back);
    metrics_add(m, (realism_value){"reversal.throughput",
                                   "throughput of a reversed path over that of the path; largest error of about 1000",
                                   "", ratio.measured, ratio.theory, ratio.tolerance});
    metrics_add(m, (realism_value){"reversal.way", "distance of the reversed path from the origin of the path",
                                   "scene units", miss.measured, miss.theory, miss.tolerance});
    return code;
}
