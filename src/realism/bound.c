/* Bounds of the rounding errors of reflectances and of paths, to first order in the unit roundoff. */
#include "realism/metrics.h"

#include <math.h>

double bound_gamma(int operations)
{
    const double error = operations * 0x1p-53;
    return error / (1.0 - error);
}

double bound_difference(int operations)
{
    return 2.0 * bound_gamma(operations);
}

/* The error of ((a - b) / (a + b))^2, if a and b are off by up to da and db. */
static double square_bound(double a, double b, double da, double db)
{
    const double sum = a + b, r = fabs(a - b) / sum, off = 2.0 * (a * db + b * da) / (sum * sum);
    return off * (2.0 * r + off) + bound_difference(BOUND_FORM) * r * r;
}

reflectance_bound bound_reflectances(double angle, double aside, double n_from, double n_to)
{
    const double rounding = bound_difference(BOUND_REFLECTANCES), eta = n_from / n_to;
    const double cos_i = cos(angle), sin_t = eta * sin(angle), square = 1.0 - sin_t * sin_t;
    /* The errors of cos i and of cos^2 t = 1 - eta^2 (1 - cos^2 i). */
    const double off_i = rounding + sin(angle) * aside, off = rounding + 2.0 * eta * eta * cos_i * off_i;
    if (square < -off)
        return (reflectance_bound){0.0, 0.0, 0.0}; /* total reflection: exactly 1 in the tracer and the closed form */
    const double cos_t = sqrt(fmax(square, 0.0)), off_t = fmin(cos_t > 0.0 ? off / cos_t : INFINITY, sqrt(off));
    const reflectance_bound b = {
        .R_s = square_bound(n_from * cos_i, n_to * cos_t, n_from * off_i, n_to * off_t),
        .R_p = square_bound(n_to * cos_i, n_from * cos_t, n_to * off_i, n_from * off_t),
    };
    return (reflectance_bound){b.R_s, b.R_p, 0.5 * (b.R_s + b.R_p) + bound_difference(BOUND_FORM)};
}

/* The relative error of the weight of the ray after a hit: of its fraction of the light, and of the medium's
 * transmittance exp(-a t). */
static double weight_at(const ray_hit *h, bool reflected, double aside, double slide)
{
    const double fractions = bound_reflectances(acos(fmin(h->cos_i, 1.0)), aside, h->n_from, h->n_to).R,
                 fraction = reflected ? h->R : 1.0 - h->R;
    const double through = h->transmittance[0], per_length = through > 0.0 && h->t > 0.0 ? -log(through) / h->t : 0.0;
    return (fraction > 0.0 ? fractions / fraction : 0.0) + per_length * slide + bound_difference(BOUND_FORM);
}

/* The error of a hit point: the distance along the ray is at most the sum of both lengths. */
static double place_of(const ray_node *n)
{
    return bound_difference(BOUND_HIT) * (vec3_length(n->origin) + vec3_length(n->hit.point));
}

path_bound bound_path(const ray_tree *tree, double curvature)
{
    if (tree->count == 0) /* the trace failed */
        return (path_bound){NAN, NAN, NAN};
    const double hit = bound_difference(BOUND_HIT), turn = bound_difference(BOUND_TURN);
    path_bound b = {bound_difference(1) * vec3_length(tree->node[0].origin), turn, 0.0};
    for (size_t i = 0; i < tree->count && tree->node[i].end == RAY_END_HIT; i++) {
        const ray_hit *h = &tree->node[i].hit;
        b.across += h->t * b.heading + place_of(&tree->node[i]);
        if (i + 1 == tree->count || h->opaque)
            break;
        const bool reflected = tree->node[i + 1].kind == RAY_REFLECT;
        /* The point slides along the surface, to another normal. */
        const double slide = b.across / h->cos_i, tilt = curvature * slide + hit, aside = b.heading + tilt;
        b.weight += weight_at(h, reflected, aside, slide);
        if (reflected) {
            b.heading += 2.0 * tilt + turn;
            continue;
        }
        /* In the plane of incidence, n cos i di = n' cos t dt; across it the factor is n / n'. */
        const double eta = h->n_from / h->n_to;
        b.heading = eta * fmax(1.0, h->cos_i / h->cos_t) * aside + tilt + turn / h->cos_t;
        b.across *= fmax(1.0, h->cos_t / h->cos_i);
    }
    return b;
}

double bound_around(const ray_tree *tree, vec3 center)
{
    if (tree->count == 0) /* the trace failed */
        return NAN;
    const double hit = bound_difference(BOUND_HIT), turn = bound_difference(BOUND_TURN);
    double heading = 0.0, invariant = tree->node[0].n * bound_difference(1) * vec3_length(tree->node[0].origin);
    for (size_t i = 0; i + 1 < tree->count && tree->node[i].end == RAY_END_HIT; i++) {
        const ray_hit *h = &tree->node[i].hit;
        const double radius = vec3_length(vec3_sub(h->point, center)), place = place_of(&tree->node[i]),
                     normal = place / radius + hit, from = 1.0 / (h->n_from * radius * h->cos_i);
        double added = 2.0 * normal + turn, n = h->n_from, slope = 2.0 * from;
        if (tree->node[i + 1].kind != RAY_REFLECT) {
            const double eta = h->n_from / h->n_to;
            added = (eta * fmax(1.0, h->cos_i / h->cos_t) + 1.0) * normal + turn / h->cos_t;
            n = h->n_to, slope = fabs(from - 1.0 / (h->n_to * radius * h->cos_t));
        }
        heading += slope * invariant + added;
        invariant += n * (place + radius * added);
    }
    return heading;
}
