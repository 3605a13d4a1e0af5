/* Light that a medium scatters out of a lamp's beam towards a ray. A free flight rarely ends within a narrow beam. So
 * for lamps that are points each ray has a further point, which is chosen by the lamp: in the part of the ray that is
 * in the lamp's cone and in the boxes around the media that scatter, with equal angles seen from the lamp (Kulla and
 * Fajardo, "Importance Sampling Techniques for Path Tracing in Participating Media", Computer Graphics Forum 31, 2012,
 * 4.1). The points and the ends of flights are weighted by the balance heuristic, so that the mean stays the same,
 * whatever the part covers. Functions of the tracer's flights; nothing fails. */
#pragma once

#include "render/core/tracer.h"
#include "render/shade/scattering.h"

/* The points of a batch of rays: chosen before their interfaces are searched; and a segment of a ray's media. */
void airlight_choose(tracer *t, const ray_queue *q, int first, int depth, int count);
void airlight_follow(tracer *t, const medium_segment *s);

/* The density, per length, with which a point at a distance on a ray along a unit vector is chosen for a lamp; 0 for
 * one that is not chosen along rays. */
double airlight_density(const plan *p, int lamp, vec3 origin, vec3 direction, double distance);
