/* Single interfaces between the scene's media: critical angles and reflectances.
 *
 * Tolerances: an error e of sin i or cos i moves the critical angle by e tan i or e cot i, to which half of the
 * bisection's last interval is added. Those of reflectances are bound_shares. */
#include "realism/metrics.h"

#include <math.h>

#define CRITICAL_WIDTH 1e-14 /* of the bisection's last interval */
#define DEGREE (M_PI / 180.0)
enum { ANGLES = 900 }; /* steps of 0.1 degrees */

status interface_measure(probe *p, ray_tree *tree, double start_y, double angle, interface_shares *out, diagnostic *why)
{
    const vec3 down = vec3_make(sin(angle), start_y > 0.0 ? -cos(angle) : cos(angle), 0.0);
    const status code = probe_path(p, vec3_make(0.0, start_y, 0.0), down, 0, tree, why);
    const ray_hit *hit = &tree->node[0].hit;
    *out = (interface_shares){0.0, 0.0, 0.0};
    /* Between media with equal indices there is no interface: the ray continues to the next surface. */
    if (code != STATUS_OK || tree->node[0].end != RAY_END_HIT || fabs(hit->point.y) > 0.5)
        return code;
    const bool reflected = tree->count > 1 && tree->node[1].kind == RAY_REFLECT;
    const double arrived = tree->node[0].throughput[0] * hit->transmittance[0];
    *out = (interface_shares){hit->R_s, hit->R_p, reflected ? tree->node[1].throughput[0] / arrived : 0.0};
    return STATUS_OK;
}

typedef struct crossing {
    const char *critical, *s, *p, *mean;
    setup_medium from, to;
} crossing;
static const crossing crossings[] = {
    {"critical.vessel", "fresnel.vessel.s", "fresnel.vessel.p", "fresnel.vessel", SETUP_OUTSIDE, SETUP_VESSEL},
    {"critical.liquid", "fresnel.liquid.s", "fresnel.liquid.p", "fresnel.liquid", SETUP_OUTSIDE, SETUP_LIQUID},
    {"critical.wall", "fresnel.wall.s", "fresnel.wall.p", "fresnel.wall", SETUP_VESSEL, SETUP_LIQUID},
};
static const char *const critical_what[] = {"critical angle between vessel and surroundings",
                                            "critical angle between liquid and surroundings",
                                            "critical angle between the vessel's wall and liquid"};

static status bisect_critical(trial *t, double start_y, double *angle, diagnostic *why)
{
    double low = 0.0, high = M_PI / 2.0 - 1e-9;
    while (high - low > CRITICAL_WIDTH) {
        const double middle = (low + high) / 2.0;
        const vec3 d = vec3_make(sin(middle), start_y > 0.0 ? -cos(middle) : cos(middle), 0.0);
        TRY(probe_path(t->p, vec3_make(0.0, start_y, 0.0), d, -1, &t->tree, why));
        if (t->tree.node[0].end == RAY_END_HIT && t->tree.node[0].hit.tir)
            high = middle;
        else
            low = middle;
    }
    *angle = (low + high) / 2.0;
    return STATUS_OK;
}

static bool has_media(const metrics *m, const crossing *at)
{
    return at->to != SETUP_LIQUID || (m->theory_at.liquid >= 0 && m->at.liquid >= 0);
}

static double critical_tolerance(double angle)
{
    return 0.5 * CRITICAL_WIDTH + bound_difference(BOUND_SHARES) * (tan(angle) + 1.0 / tan(angle)) +
           bound_difference(BOUND_FORM) * angle;
}

/* From the optically denser side. */
static status add_critical(const metrics *m, int which, diagnostic *why)
{
    setup_medium from = crossings[which].from, to = crossings[which].to;
    const double *n = m->theory_at.n;
    if (n[from] < n[to]) {
        from = crossings[which].to;
        to = crossings[which].from;
    }
    const bool filled = has_media(m, &crossings[which]);
    const double theory = filled ? theory_critical_angle(n[from], n[to]) : NAN;
    const bool exists = !isnan(theory);
    const char *const none =
        filled ? "the media have equal refractive indices: there is no total reflection" : "there is no liquid";
    double measured = NAN, start_y;
    status code = STATUS_OK;
    if (exists) {
        trial t;
        scene *s = arrange_interface(m->traced, &m->at, from, to, &start_y);
        code = trial_start(&t, s, m->level, why);
        THEN(code, bisect_critical(&t, start_y, &measured, why));
        trial_end(&t);
    }
    metrics_add(m, (realism_value){crossings[which].critical, exists ? critical_what[which] : none, "rad", measured,
                                   theory, critical_tolerance(theory)});
    return code;
}

static status compare_shares(const metrics *m, const crossing *at, worst_pair worst[3], diagnostic *why)
{
    trial t;
    double start_y = 0.0;
    const double *n = m->theory_at.n;
    scene *s = arrange_interface(m->traced, &m->at, at->from, at->to, &start_y);
    status code = trial_start(&t, s, m->level, why);
    for (int i = 0; i < ANGLES && code == STATUS_OK; i++) {
        const double angle = 0.1 * i * DEGREE;
        interface_shares seen;
        code = interface_measure(t.p, &t.tree, start_y, angle, &seen, why);
        const share_bound off = bound_shares(angle, 0.0, n[at->from], n[at->to]);
        worst_take(&worst[0], seen.R_s, theory_fresnel_s(angle, n[at->from], n[at->to]), off.R_s);
        worst_take(&worst[1], seen.R_p, theory_fresnel_p(angle, n[at->from], n[at->to]), off.R_p);
        worst_take(&worst[2], seen.R, theory_fresnel(angle, n[at->from], n[at->to]), off.R);
    }
    trial_end(&t);
    return code;
}

static status add_fresnel(const metrics *m, int which, diagnostic *why)
{
    const crossing *at = &crossings[which];
    const bool exists = has_media(m, at);
    worst_pair worst[3] = {WORST_NONE, WORST_NONE, WORST_NONE};
    const status code = exists ? compare_shares(m, at, worst, why) : STATUS_OK;
    const char *const none = exists ? NULL : "there is no liquid";
    metrics_add(m, (realism_value){at->s, none ? none : "reflectance, s-polarised; largest error for 0 to 89.9 degrees",
                                   "", worst[0].measured, worst[0].theory, worst[0].tolerance});
    metrics_add(m, (realism_value){at->p, none ? none : "reflectance, p-polarised", "", worst[1].measured,
                                   worst[1].theory, worst[1].tolerance});
    metrics_add(m, (realism_value){at->mean, none ? none : "reflectance, unpolarised", "", worst[2].measured,
                                   worst[2].theory, worst[2].tolerance});
    return code;
}

status realism_interfaces(const metrics *m, diagnostic *why)
{
    for (int i = 0; i < 3; i++)
        TRY(add_critical(m, i, why));
    for (int i = 0; i < 3; i++)
        TRY(add_fresnel(m, i, why));
    return STATUS_OK;
}
