/* Beer and Lambert: light falls by exp(-a d) over a length d of a medium with absorption coefficient a. */
#include "render/shade/shading.h"

#include <stdlib.h>

vec3 absorption_coefficients(const plan *p, int priority_index, int64_t sample_key)
{
    if (!p->spectral)
        return p->absorption[priority_index];
    const double a = spectra_region(p->spectral, sample_key, priority_index)->absorption;
    return vec3_make(a, a, a);
}

/* Extinction by scattering, of rays that do not scatter themselves. */
static void add_scattering(tracer *t)
{
    const region_scatter *of = t->target.frame_plan->scatter->region;
    for (int k = 0; k < t->batch.scratch.segments->count; k++) {
        const medium_segment *s = &t->batch.scratch.segments->segment[k];
        for (int c = 0; c < 3; c++)
            t->media->transmittance[c][s->ray] += of[s->priority_index].per_unit * s->length;
    }
}

/* Adds the optical depths of the segments to transmittance. */
static void add_depths(tracer *t)
{
    const plan *p = t->target.frame_plan;
    const int64_t *sample_keys = t->media->sample_keys;
    if (p->scatter && !t->media->flights.flies)
        add_scattering(t);
    for (int k = 0; p->sheets && k < t->batch.scratch.segments->count; k++)
        sheets_segment(t, &t->media->sheets, &t->batch.scratch.segments->segment[k]);
    for (int k = 0; k < t->batch.scratch.segments->count; k++) {
        const medium_segment *s = &t->batch.scratch.segments->segment[k];
        if (!p->geometry->regions[s->priority_index].attenuates)
            continue;
        const vec3 a = absorption_coefficients(p, s->priority_index, sample_keys[s->ray]);
        t->media->transmittance[0][s->ray] += a.x * s->length;
        t->media->transmittance[1][s->ray] += a.y * s->length;
        t->media->transmittance[2][s->ray] += a.z * s->length;
    }
    t->batch.scratch.segments->count = 0;
}

/* Removes absorption by the surrounding medium from segments of more than that length. */
static void exempt(tracer *t, double length)
{
    for (int k = 0; k < t->batch.scratch.segments->count; k++) {
        medium_segment *s = &t->batch.scratch.segments->segment[k];
        if (s->priority_index == 0 && s->length > length)
            s->length = 0.0;
    }
}

/* What only the last segment to a sun exceeds. */
static double sun_leg(const tracer *t)
{
    return 0.5 * t->target.frame_plan->sun_distance;
}

/* Called when the list is full. Paths to the sky are exempt here too; they are recognised by their length. */
static void make_room(void *context)
{
    tracer *t = context;
    exempt(t, t->media->to_lamps ? sun_leg(t) : 1e100); /* paths that leave the scene have 1e120 (medium_segment) */
    if (t->media->flights.flying)
        scattering_take(t);
    add_depths(t);
}

bool absorption_begin(tracer *t, bool absorbs)
{
    if (absorbs && !t->media && !(t->media = malloc(sizeof *t->media)))
        return false;
    t->batch.scratch.segments = absorbs ? &t->media->segments : NULL;
    return true;
}

void absorption_end(tracer *t)
{
    free(t->media);
}

void absorption_announce(tracer *t, const ray_queue *q, int first, int count)
{
    t->media->sample_keys = q->sample_key + first;
    t->media->to_lamps = q == &t->queues.shadows;
    t->media->flights.flies = t->media->flights.flying = false;
    t->batch.scratch.segments->full = make_room;
    t->batch.scratch.segments->context = t;
    /* optical depths at first */
    for (int i = 0; i < count; i++)
        t->media->transmittance[0][i] = t->media->transmittance[1][i] = t->media->transmittance[2][i] = 0.0;
    sheets_announce(t, q, first, count);
}

static void absorption_shares(tracer *t, int count)
{
    add_depths(t);
    for (int c = 0; c < 3; c++)
        t->shade->absorb(t->media->transmittance[c], count);
    if (t->target.frame_plan->sheets)
        sheets_leave(t, count, t->media->transmittance);
}

/* A path to the sky has no finite length: its light is taken to arrive unattenuated at the surface where the path
 * starts. */
void absorption_exempt_sky(tracer *t)
{
    const plan *p = t->target.frame_plan;
    for (int k = 0; p->geometry->regions[0].attenuates && k < t->batch.scratch.segments->count; k++) {
        medium_segment *s = &t->batch.scratch.segments->segment[k];
        if (s->priority_index == 0 && t->batch.hits.hit_primitive[s->ray] == -1)
            s->length = 0.0;
    }
}

void absorption_exempt_suns(tracer *t)
{
    if (t->target.frame_plan->has_sun && t->target.frame_plan->geometry->regions[0].attenuates)
        exempt(t, sun_leg(t));
}

void absorption_dim(tracer *t, ray_queue *q, int first, int count)
{
    absorption_shares(t, count);
    for (int i = 0; i < count; i++) {
        q->wr[first + i] *= t->media->transmittance[0][i];
        q->wg[first + i] *= t->media->transmittance[1][i];
        q->wb[first + i] *= t->media->transmittance[2][i];
    }
    if (t->target.frame_plan->sheets)
        sheets_store(t, q, first, count);
}
