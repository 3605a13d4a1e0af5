/* Exposure: light that reaches the film. Functions that add radiance to a sample key's pixel, inline where a loop
 * adds the light of each ray of a group. In a spectral film the three channels are equal: radiance at the sample
 * key's wavelength. A value out of the film's range sets the tracer's overflow flag. */
#pragma once

#include "render/shade/kernels.h"
#include "render/tracer/tracer.h"

/* Adds to the sums of one pixel; negative if a sum leaves the film's range. */
static inline int64_t add_units(film_sum *sum, film_sum r, film_sum g, film_sum b)
{
    const film_sum red = film_add(sum[0], r), green = film_add(sum[1], g), blue = film_add(sum[2], b);
    sum[0] = red, sum[1] = green, sum[2] = blue;
    return film_overflow(red) | film_overflow(green) | film_overflow(blue);
}

static inline void expose_at(tracer *t, int64_t place, double r, double g, double b)
{
    if (!((int)film_accepts(r) & (int)film_accepts(g) & (int)film_accepts(b))) {
        t->account.overflow = -1;
        return;
    }
    t->account.overflow |= add_units(&t->target.img->sum[place * 3], film_units(r), film_units(g), film_units(b));
}

/* Exposes the replicate and pixel of a sample key; in a spectral film with the observer's weights at its wavelength.
 * Never inlined, so that the rgb film's code path keeps its registers. */
__attribute__((noinline)) void expose_by_sample_key(tracer *t, int64_t sample_key, double r, double g, double b);

/* Adds radiance to a sample key's pixel. */
static inline void shading_expose(tracer *t, int64_t sample_key, double r, double g, double b)
{
    if (t->by_sample_key)
        expose_by_sample_key(t, sample_key, r, g, b);
    else
        expose_at(t, film_pixel_index(t->target.img, sample_key), r, g, b);
}

/* Adds the light of many rays to their pixels; not for spectral films. */
void expose_all(tracer *t, const film_light *sent, int count, const int64_t *sample_key);

/* Adds the radiance of rays first .. first + count - 1 of a queue; fraction: the fraction of each that arrives. */
void shading_expose_shadow_rays(tracer *t, const ray_queue *q, int first, int count, const double *fraction);

/* Adds the weighted sky radiance of a direction, or the fallback radiance (render.beyond) of a branch that the depth
 * limit cuts off. */
void shading_expose_sky(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb);
void shading_expose_at_depth_limit(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb);

/* The sky for rays that hit nothing: the default of most integrators. */
void background_sky(tracer *t, const ray_queue *q, int first, const int *list, int count);

/* Counts the gathered group's branches that the depth limit cuts off, and adds their fallback radiance
 * (render.beyond). */
void cut_branches(tracer *t);
