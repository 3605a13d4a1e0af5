/* Metals and thin films in the tracer: exact at each ray's wavelength, or with the colours of a table in an rgb
 * film. */
#include "render/shade/rough.h"

#include "render/shade/polarisation.h"
#include <math.h>
#include <stdlib.h>

bool layered_begin(tracer *t)
{
    if (t->target.frame_plan->layered && !t->layered && !(t->layered = malloc(sizeof *t->layered)))
        return false;
    if (t->layered)
        t->layered->surface = NULL;
    return true;
}

void layered_end(tracer *t)
{
    free(t->layered);
}

void layered_gather(tracer *t, const int *list, int priority_index, int key)
{
    const plan *p = t->target.frame_plan;
    layered_plan *layered = p->layered;
    layered_work *w = t->layered;
    w->surface = layered ? layered->surface[key] : NULL;
    if (!w->surface)
        return;
    w->colored = layered->curves && !layered->one_wavelength;
    const int inner = layered->medium[priority_index];
    for (int k = 0; k < t->surface.gathered.count; k++)
        w->inward[k] = w->surface->opaque || t->batch.hits.after[list[k]] == t->batch.hits.surface[list[k]];
    for (int k = 0; w->colored && k < t->surface.gathered.count; k++) {
        const int before = layered->medium[t->batch.hits.before[list[k]]],
                  after = layered->medium[t->batch.hits.after[list[k]]];
        w->curves[k] = layered_curves_of(layered, key, w->surface->opaque || before != inner ? before : after);
    }
}

static double wavelength_of(const tracer *t, int k)
{
    const plan *p = t->target.frame_plan;
    return p->spectral ? spectra_lambda(sample_key_wavelength(t->surface.gathered.sample_key[k])) : p->render.lambda_nm;
}

/* Weights from the surface's table of colours; under total reflection, all light is reflected. */
static void branch_by_color(tracer *t, const material *m, double reflectivity, int k)
{
    const group *g = &t->surface.gathered;
    layered_work *w = t->layered;
    branch_group *b = &t->surface.branches;
    const double cos_i = g->points.cos_i[k];
    const bool opaque = w->surface->opaque;
    const layered_colors c = layered_colors_at(w->surface, w->curves[k], w->inward[k], cos_i, g->n_from[k], g->n_to[k]);
    const vec3 R = c.reflected, rest = c.transmitted,
               T = opaque ? rest : vec3_scale(rest, m->transparency * (1.0 - reflectivity));
    const double back = opaque ? 0.0 : reflectivity;
    w->rr[k] = R.x + rest.x * back, w->rg[k] = R.y + rest.y * back, w->rb[k] = R.z + rest.z * back;
    w->tr[k] = T.x, w->tg[k] = T.y, w->tb[k] = T.z;
    b->reflect[k] = (w->rr[k] + w->rg[k] + w->rb[k]) / 3.0;
    b->refract[k] = (T.x + T.y + T.z) / 3.0;
}

static void branch_at_wavelength(tracer *t, const material *m, double reflectivity, int k)
{
    const group *g = &t->surface.gathered;
    const layered_surface *s = t->layered->surface;
    branch_group *b = &t->surface.branches;
    const double cos_i = g->points.cos_i[k];
    const sp_amplitudes a =
        layered_amplitudes(s, t->layered->inward[k], cos_i, g->n_from[k], g->n_to[k], wavelength_of(t, k));
    const bool absorbs = s->stack && s->stack->absorbs,
               total = !s->opaque && fresnel_dielectric(cos_i, g->n_from[k], g->n_to[k]).total;
    const sp_response r = sp_response_of(a.r_s, a.r_p), through = sp_response_of(a.t_s, a.t_p);
    const double R = total && !absorbs ? 1.0 : lesser(r.mean, 1.0), T = absorbs ? through.mean : 1.0 - R;
    b->reflect[k] = s->opaque ? R : R + T * reflectivity;
    b->refract[k] = s->opaque ? 0.0 : m->transparency * T * (1.0 - reflectivity);
    if (t->target.frame_plan->render.polarisation)
        polarised_layered(t, k, r, through, reflectivity, m->transparency);
}

void layered_branches(tracer *t, const material *m)
{
    const double reflectivity = material_reflectivity(m, &t->target.frame_plan->render);
    for (int k = 0; k < t->surface.gathered.count; k++)
        if (t->layered->colored)
            branch_by_color(t, m, reflectivity, k);
        else
            branch_at_wavelength(t, m, reflectivity, k);
}

void layered_turn_back(tracer *t, int k)
{
    layered_work *w = t->layered;
    if (!w || !w->surface || !w->colored)
        return;
    w->rr[k] += w->tr[k], w->rg[k] += w->tg[k], w->rb[k] += w->tb[k];
    w->tr[k] = w->tg[k] = w->tb[k] = 0.0;
}

vec3 layered_weight(const tracer *t, int k, bool reflected)
{
    const layered_work *w = t->layered;
    const branch_group *b = &t->surface.branches;
    const double weight = reflected ? b->reflect[k] : b->refract[k];
    if (!w || !w->surface || !w->colored)
        return vec3_make(weight, weight, weight);
    return reflected ? vec3_make(w->rr[k], w->rg[k], w->rb[k]) : vec3_make(w->tr[k], w->tg[k], w->tb[k]);
}

vec3 layered_mean(const tracer *t, int k)
{
    enum { SQUARES = 8 };
    const group *g = &t->surface.gathered;
    const layered_work *w = t->layered;
    const layered_surface *s = w->surface;
    const double n_from = g->n_from[k], n_to = g->n_to[k];
    vec3 sum = vec3_make(0.0, 0.0, 0.0);
    for (int i = 0; i < SQUARES; i++) { /* uniform steps of the squared cosine */
        const double cosine = sqrt((i + 0.5) / SQUARES);
        vec3 R;
        if (w->colored)
            R = layered_colors_at(s, w->curves[k], w->inward[k], cosine, n_from, n_to).reflected;
        else {
            const sp_amplitudes a = layered_amplitudes(s, w->inward[k], cosine, n_from, n_to, wavelength_of(t, k));
            const double mean = lesser(sp_response_of(a.r_s, a.r_p).mean, 1.0);
            R = vec3_make(mean, mean, mean);
        }
        sum = vec3_add(sum, vec3_scale(R, 1.0 / SQUARES));
    }
    return sum;
}

void layered_color_children(tracer *t, ray_queue *q, int first, bool reflected, const int *list, int count)
{
    const group *g = &t->surface.gathered;
    for (int k = 0; k < count; k++) {
        const int i = list[k];
        const vec3 weight = layered_weight(t, i, reflected);
        q->wr[first + k] = g->wr[i] * weight.x;
        q->wg[first + k] = g->wg[i] * weight.y;
        q->wb[first + k] = g->wb[i] * weight.z;
    }
}
