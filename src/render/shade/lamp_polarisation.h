/* Linearly polarised light of lamps. A polarised lamp is one behind an ideal polariser of that degree, whose axis is
 * across the lamp's own; of a point light, which has no axis, across each ray, so that at 0 degrees its field is
 * everywhere horizontal. What an analyser sees of it is its row times the lamp's Stokes vector (optics/mueller.h). A
 * matte surface depolarises light, so that only what is between lamp and surface can tell: sheets in shadow rays, all
 * surfaces on the paths of photons, and those that a random path meets last before the lamp. Pure; plain values. */
#pragma once

#include "optics/mueller.h"
#include "render/core/plan.h"

/* Stokes vector, of intensity 1, of the light that a lamp emits along a unit vector, in the canonical frame of `ray`,
 * which is that vector or its opposite: of linear polarisation it is the same for both directions of travel. */
static inline stokes lamp_stokes(const plan *p, int lamp, vec3 emitted, vec3 ray)
{
    const light *l = &p->lights[lamp];
    const bool has_axis = l->kind != LIGHT_POINT;
    const vec3 axis = has_axis ? p->cones[lamp].axis : emitted;
    const vec3 right = lamp_right(axis), up = vec3_cross(axis, right);
    double sine, cosine;
    elementary_sincos_deg(l->polarisation_deg, &sine, &cosine);
    vec3 field = vec3_add(vec3_scale(right, cosine), vec3_scale(up, sine));
    if (has_axis && vec3_dot(axis, emitted) > -1.0 + 1e-12)
        field = polarisation_across_ray(field, axis, emitted);
    const stokes s = stokes_linear(ray, field);
    return (stokes){1.0, l->polarised * s.q, l->polarised * s.u, 0.0};
}

/* The lamp's light, relative to unpolarised light, that a row sees of it along a unit vector towards the lamp. */
static inline double lamp_seen(const plan *p, int lamp, stokes row, vec3 to_lamp)
{
    return greater(analyser_sees(row, lamp_stokes(p, lamp, vec3_scale(to_lamp, -1.0), to_lamp)), 0.0);
}
