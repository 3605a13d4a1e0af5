/* Spectral shading: refractive indices, reflectances and light of a group of rays with different wavelengths. */
#include "render/shade/shading.h"

#include "render/core/film.h"

void spectral_indices(tracer *t, const int *list)
{
    group *g = &t->surface.gathered;
    const spectra *s = t->target.frame_plan->spectral;
    for (int k = 0; k < g->count; k++) {
        g->n_from[k] = spectra_region(s, g->sample_key[k], t->batch.hits.before[list[k]])->index;
        g->n_to[k] = spectra_region(s, g->sample_key[k], t->batch.hits.after[list[k]])->index;
    }
    for (int k = g->count; k < g->padded; k++)
        g->n_from[k] = g->n_from[g->count - 1], g->n_to[k] = g->n_to[g->count - 1];
}

/* On entry the group's colours are (1, 0, 0) for the material's first colour, else (0, 1, 0). */
void spectral_colors(tracer *t, int priority_index)
{
    group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        const region_spectrum *here = spectra_region(t->target.frame_plan->spectral, g->sample_key[k], priority_index);
        g->cr[k] = g->cg[k] = g->cb[k] = g->cr[k] > 0.5 ? here->color : here->checker_color;
    }
}

/* On entry the group's light is that of a lamp of radiance 1. */
void spectral_light(tracer *t, int lamp)
{
    const group *g = &t->surface.gathered;
    lit_group *l = &t->surface.lit;
    const double least = 0.5 / FILM_ONE;
    for (int k = 0; k < g->count; k++) {
        const double radiance = spectra_light(t->target.frame_plan->spectral, g->sample_key[k], lamp);
        l->r[k] *= radiance, l->g[k] *= radiance, l->b[k] *= radiance;
        l->contributes[k] = -(int64_t) !(l->r[k] < least);
    }
}
