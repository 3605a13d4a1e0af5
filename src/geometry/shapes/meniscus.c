/* The meniscus of a cylinder of liquid. */
#include "geometry/shapes/meniscus.h"

#include "base/elementary.h"
#include "geometry/shapes/parts.h"
#include <stdio.h>

static double tube_radius(const solid_shape *shape)
{
    return shape->contact_radius > 0.0 ? shape->contact_radius : shape->radius;
}

/* Solving takes about a millisecond, and the same shape is needed many times: so each thread keeps its last one. */
const capillary_profile *meniscus_of(const solid_shape *shape)
{
    static _Thread_local capillary_profile kept;
    static _Thread_local double of[4];
    const double key[4] = {tube_radius(shape), shape->capillary_length, shape->contact_angle_deg, shape->height};
    if (key[0] != of[0] || key[1] != of[1] || key[2] != of[2] || key[3] != of[3]) {
        capillary_solve(key[0], key[1], key[2], key[3], &kept);
        for (int k = 0; k < 4; k++)
            of[k] = key[k];
    }
    return &kept;
}

status meniscus_check(const solid_shape *s, diagnostic *why)
{
    if (!has_meniscus(s))
        return STATUS_OK;
    if (!isfinite(s->capillary_length) || !(s->contact_angle_deg >= 1.0 && s->contact_angle_deg <= 179.0))
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 179 degrees, and a finite length",
                        "contact_angle_deg %g or capillary_length %g is out of range", s->contact_angle_deg,
                        s->capillary_length);
    if (s->m != 1.0)
        return diagnose(why, STATUS_BAD_INPUT, "set m to 1, or capillary_length to 0",
                        "a meniscus needs a round cylinder, and m is %g", s->m);
    char remedy[160];
    if (!(s->contact_radius >= 0.0 && s->contact_radius <= s->radius)) {
        snprintf(remedy, sizeof remedy, "use at most the radius, %g; 0 is the radius", s->radius);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "contact_radius is %g", s->contact_radius);
    }
    if (tube_radius(s) > CAPILLARY_WIDEST * s->capillary_length) {
        snprintf(remedy, sizeof remedy, "use at least %g, or 0 for no meniscus", tube_radius(s) / CAPILLARY_WIDEST);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "capillary_length %g is less than 1/%g of the radius",
                        s->capillary_length, CAPILLARY_WIDEST);
    }
    const capillary_profile *p = meniscus_of(s);
    if (p->low > 0.0)
        return STATUS_OK;
    snprintf(remedy, sizeof remedy, "use a height above %.9g, or a smaller capillary_length", s->height - p->low);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "the meniscus reaches the bottom: height %g is too small",
                    s->height);
}

double meniscus_wall(const solid_shape *shape)
{
    return has_meniscus(shape) ? meniscus_of(shape)->wall : shape->height;
}

double meniscus_low(const solid_shape *shape)
{
    return has_meniscus(shape) ? meniscus_of(shape)->low : shape->height;
}

double meniscus_high(const solid_shape *shape)
{
    return has_meniscus(shape) ? meniscus_of(shape)->high : shape->height;
}

/* At the point of a falling surface whose normal is the direction; otherwise at the wall. */
double meniscus_farthest(const solid_shape *shape, vec3 d)
{
    const capillary_profile *p = meniscus_of(shape);
    const double out = hypot(d.x, d.z);
    double low = 0.0, high = p->radius;
    for (int step = 0; step < 60 && !p->rises && d.y > 0.0; step++) {
        const double rho = 0.5 * (low + high);
        double slope;
        capillary_rise(p, rho * rho, &slope);
        if (out + 2.0 * rho * slope * d.y > 0.0)
            low = rho;
        else
            high = rho;
    }
    return high * out + capillary_height(p, high * high) * d.y;
}

void meniscus_points(const solid_shape *shape, int count, profile_point *out)
{
    const capillary_profile *p = meniscus_of(shape);
    for (int i = 0; i < count; i++) {
        double sine, cosine;
        elementary_sincos_deg(90.0 * i / (count - 1), &sine, &cosine);
        /* the distance from the wall grows as the square of the angle, and faster where the wall's layer is thin */
        const double share = (1.0 - cosine) * (i + 1.0) / count, rho = i == count - 1 ? 0.0 : p->radius * (1.0 - share);
        out[i] = (profile_point){rho, capillary_height(p, rho * rho)};
    }
}
