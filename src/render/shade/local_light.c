/* Local light of surfaces: ambient and emitted light, photons' light, and direct light of lamps, for which shadow rays
 * are enqueued. */
#include "render/shade/shading.h"

#include "render/photons/photon_map.h"
#include "render/shade/exposure.h"
#include "render/shade/footprints.h"
#include "render/shade/kernels.h"
#include "render/shade/polarisation.h"

/* Adds the light that the material of a mesh file emits. Only RGB films have such materials. */
static void expose_glow(tracer *t)
{
    const group *g = &t->surface.gathered;
    const mesh_work *w = t->meshes;
    for (int i = 0; i < g->count; i++)
        shading_expose(t, g->sample_key[i], g->wr[i] * w->glow_r[i], g->wg[i] * w->glow_g[i], g->wb[i] * w->glow_b[i]);
}

/* Adds ambient and emitted light; in a spectral film, emission has the spectrum of daylight. */
static void expose_own_light(tracer *t, const material *m, bool ambient)
{
    const group *g = &t->surface.gathered;
    const plan *p = t->target.frame_plan;
    const double k_a = ambient ? m->ambient : 0.0, k_e = t->surface.mat->glows ? 0.0 : m->emission;
    if (t->surface.mat->glows && !p->spectral)
        expose_glow(t);
    if (k_a == 0.0 && k_e == 0.0)
        return;
    if (p->spectral) {
        for (int i = 0; i < g->count; i++) {
            const spectral_row *row = spectra_row(p->spectral, g->sample_key[i]);
            const double a = (k_a * row->ambient + k_e * row->basis[SKY_BASIS_WHITE]) * g->cr[i];
            shading_expose(t, g->sample_key[i], g->wr[i] * a, g->wg[i] * a, g->wb[i] * a);
        }
        return;
    }
    const vec3 a = vec3_add(vec3_scale(p->sky->ambient, k_a), vec3_make(k_e, k_e, k_e));
    film_light sent;
    t->shade->own_light(g, a, &sent);
    expose_all(t, &sent, g->count, g->sample_key);
}

/* The fraction of diffuse light at ray i's point that reaches the film, including the surface's colour, as a mean over
 * channels. */
static double fraction_in_film(const tracer *t, int i)
{
    const group *g = &t->surface.gathered;
    const spectra *s = t->target.frame_plan->spectral;
    const double *eye = s ? spectra_row(s, g->sample_key[i])->eye : NULL;
    return eye ? g->wr[i] * g->cr[i] * (eye[0] + eye[1] + eye[2]) / 3.0
               : (g->wr[i] * g->cr[i] + g->wg[i] * g->cg[i] + g->wb[i] * g->cb[i]) / 3.0;
}

/* Adds the photons' light that a matte surface reflects. */
static void caustic_light(tracer *t, const material *m)
{
    const group *g = &t->surface.gathered;
    const plan *p = t->target.frame_plan;
    for (int i = 0; i < g->count; i++) {
        const int wavelength = p->spectral ? (int)sample_key_wavelength(g->sample_key[i]) : -1;
        const vec3 e =
            t->footprints
                ? footprint_irradiance(t, i, wavelength, m->diffuse * fraction_in_film(t, i))
                : photon_map_irradiance(p->photons, vec3_make(g->points.px[i], g->points.py[i], g->points.pz[i]),
                                        vec3_make(g->points.nx[i], g->points.ny[i], g->points.nz[i]), wavelength);
        if (e.x > 0.0 || e.y > 0.0 || e.z > 0.0)
            shading_expose(t, g->sample_key[i], g->wr[i] * m->diffuse * g->cr[i] * e.x,
                           g->wg[i] * m->diffuse * g->cg[i] * e.y, g->wb[i] * m->diffuse * g->cb[i] * e.z);
    }
}

/* Enqueues shadow rays to a lamp from the points where its light can change the film. */
static void enqueue_shadow_rays(tracer *t, int lamp)
{
    ray_queue *q = &t->queues.shadows;
    const group *g = &t->surface.gathered;
    const lit_group *l = &t->surface.lit;
    const new_rays rays = {l->lx,         l->ly,         l->lz, l->r, l->g, l->b, NULL, g->inside_before,
                           g->sample_key, l->contributes};
    const int first = q->count;
    int list[ROW];
    t->grouping->append(g, &rays, list, q);
    for (int at = first; t->target.frame_plan->sheets && at < q->count; at++)
        sheets_shadow_ray(t, lamp, at);
}

/* Multiplies the group's light, computed for a lamp of radiance 1, by the lamp's spectrum. */
static void spectral_light(tracer *t, int lamp)
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

/* Computes the light of one lamp on the gathered group, with its spectrum in a spectral film. */
static void direct_light(tracer *t, const material *m, int lamp, int priority_index)
{
    const plan *p = t->target.frame_plan;
    light l = p->lights[lamp];
    if (p->spectral)
        l.color = vec3_make(1.0, 1.0, 1.0), l.intensity = 1.0;
    if (mesh_has_corner_light(t, priority_index))
        mesh_corner_light(t, m, &l, priority_index);
    else
        t->shade->direct(m, &l, &t->surface.gathered, &t->surface.lit);
    if (light_has_cone(&l))
        t->shade->spot(&p->cones[lamp], l.kind != LIGHT_CONE, &t->surface.gathered, &t->surface.lit);
    if (t->surface.on_mesh)
        mesh_bound_light(t);
    if (p->spectral)
        spectral_light(t, lamp);
}

/* Adds the weighted emission and direct light of the surface. */
static void send_out(tracer *t, int priority_index, light_terms terms)
{
    const plan *p = t->target.frame_plan;
    const material *m = &t->surface.mat->surface;
    material dull;
    if (!terms.highlights) {
        dull = *m;
        dull.specular = 0.0;
        m = &dull;
    }
    expose_own_light(t, m, terms.ambient);
    if (p->photons && m->diffuse > 0.0 && surface_is_opaque(t, priority_index))
        caustic_light(t, m);
    if (terms.emission_only || (m->diffuse == 0.0 && m->specular == 0.0))
        return;
    for (int k = 0; k < p->light_count; k++) {
        if (!terms.as_points && light_has_size(&p->lights[k]))
            continue;
        direct_light(t, m, k, priority_index);
        if (p->render.shadows != SHADOWS_OFF) {
            enqueue_shadow_rays(t, k);
            continue;
        }
        for (int i = 0; i < t->surface.gathered.count; i++)
            if (t->surface.lit.contributes[i])
                shading_expose(t, t->surface.gathered.sample_key[i], t->surface.lit.r[i], t->surface.lit.g[i],
                               t->surface.lit.b[i]);
    }
}

void local_light(tracer *t, int priority_index, light_terms terms)
{
    radiance_weigh(t);
    send_out(t, priority_index, terms);
    radiance_weigh_back(t);
}
