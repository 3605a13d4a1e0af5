/* Shading of layered surfaces (layered_table.h): the branches' weights, by channel in an rgb film. Ownership:
 * layered_begin allocates the tracer's memory, layered_end frees it. */
#pragma once

#include "render/tracer/tracer.h"

/* The layered surface of the gathered group, and its branches' weights. */
typedef struct layered_work {
    const layered_surface *surface; /* NULL: an ordinary surface */
    bool colored;     /* the branches have weights by channel; otherwise only the weights of branch_group */
    bool inward[ROW]; /* the ray meets the layers from outside of the solid */
    const layered_curves *curves[ROW];
    /* Weights of reflection and refraction by channel; their means are the weights of branch_group. */
    double rr[ROW], rg[ROW], rb[ROW], tr[ROW], tg[ROW], tb[ROW];
} layered_work;

bool layered_begin(tracer *t); /* begins a frame; false when out of memory */
void layered_end(tracer *t);

/* Records the surface of the gathered group, rays list[0 ..] of the batch, by its surface key (plan.h). */
void layered_gather(tracer *t, const int *list, int priority_index, int key);

/* Replaces the weights of the branches, whose directions are computed, and with polarisation their Stokes vectors. */
void layered_branches(tracer *t, const material *m);

/* Sends the refracted light of ray k back, as in total reflection. */
void layered_turn_back(tracer *t, int k);

/* The weight of a branch of ray k by channel. */
vec3 layered_weight(const tracer *t, int k, bool reflected);

/* The mean reflectance of the surface of ray k by channel: twice the integral over cosines of R times cosine. */
vec3 layered_mean(const tracer *t, int k);

/* Sets the throughputs by channel of children first .. of the queue, which were appended with mean weights; list: their
 * lanes in the gathered group. */
void layered_color_children(tracer *t, ray_queue *q, int first, bool reflected, const int *list, int count);
