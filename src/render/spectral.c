/* What a group of rays of different wavelengths sees: each its own index, reflectance and light. */
#include "render/tracer_private.h"

#include "render/film.h"

static double lambda_of(const tracer *t, int64_t ticket)
{
    return spectra_lambda(&t->target.scene->render, ticket);
}

void spectral_indices(tracer *t, const int *list)
{
    group *g = &t->gathered;
    const index_law *laws = t->target.scene->laws;
    for (int k = 0; k < g->count; k++) {
        const double lambda_nm = lambda_of(t, g->ticket[k]);
        g->n_from[k] = index_law_at(&laws[t->hits.before[list[k]]], lambda_nm);
        g->n_to[k] = index_law_at(&laws[t->hits.after[list[k]]], lambda_nm);
    }
    for (int k = g->count; k < g->padded; k++)
        g->n_from[k] = g->n_from[g->count - 1], g->n_to[k] = g->n_to[g->count - 1];
}

/* The group's colours are (1, 0, 0) where the material's first colour is, else (0, 1, 0). */
void spectral_colors(tracer *t, int rank)
{
    group *g = &t->gathered;
    const spectra *s = t->target.scene->spectral;
    for (int k = 0; k < g->count; k++) {
        const lifted *color = g->cr[k] > 0.5 ? &s->color[rank] : &s->checker_color[rank];
        g->cr[k] = g->cg[k] = g->cb[k] = lifted_reflectance(color, lambda_of(t, g->ticket[k]));
    }
}

/* The group's light was reckoned for a lamp of radiance 1. */
void spectral_light(tracer *t, int lamp)
{
    const group *g = &t->gathered;
    lit_group *l = &t->lit;
    const double least = 0.5 / FILM_ONE;
    for (int k = 0; k < g->count; k++) {
        const double radiance = lifted_emission(&t->target.scene->spectral->light[lamp], lambda_of(t, g->ticket[k]));
        l->r[k] *= radiance, l->g[k] *= radiance, l->b[k] *= radiance;
        l->shows[k] = -(int64_t)!(l->r[k] < least);
    }
}
