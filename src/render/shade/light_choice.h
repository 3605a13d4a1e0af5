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

/* What the estimate assumes of a surface. */
typedef struct light_estimate {
    float k_d, k_s; /* shares of the light with and without Lambert's cosine */
    double side;    /* 1: light of the ray's side; -1: of the other side; 0: from everywhere, without k_d */
    int purpose;    /* of the random numbers, draw.h */
} light_estimate;

/* Of a matte surface with Phong's highlight. */
light_estimate light_estimate_of(const material *m);

/* For the gathered group: the light of each ray, -1 if none reaches the point; the weight 1 / p_k; and what the choice
 * left of the random numbers u and v: uniform, for a point of the light. */
void light_choice_make(const tracer *t, const light_estimate *by, int depth, int *lamp, double *weight, double *u,
                       double *v);
/* p_k of a light for ray i of the group. */
double light_choice_chance(const tracer *t, const light_estimate *by, int i, int lamp);
