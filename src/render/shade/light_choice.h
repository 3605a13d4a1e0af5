/* The choice of one light for each ray of the gathered group, for random paths in a scene of several lights
 * (render.light_sampling=one): light k is chosen with a probability p_k that is proportional to an estimate of its
 * light at the point, and what it contributes is divided by p_k, so that the mean stays the same (Shirley, Wang and
 * Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations", TOG 15(1), 1996, section 3). The estimate is
 * Lambert's law without shadows, and above 0 wherever the light can contribute. Plain values; nothing fails. */
#pragma once

#include "render/core/tracer_private.h"

/* Whether the frame chooses a light for each ray. */
static inline bool light_choice_applies(const plan *p)
{
    return p->render.light_sampling == LIGHT_SAMPLING_ONE && p->light_count > 1;
}

/* For the gathered group, whose surface has material m: the light of each ray, -1 if none reaches the point; the weight
 * 1 / p_k; and what the choice left of the random numbers u and v: uniform, for a point of the light. */
void light_choice_make(const tracer *t, const material *m, int depth, int *lamp, double *weight, double *u, double *v);
