/* Exposure: the film's sums, the sky's light, shadow rays that arrive, and branches that the depth limit cuts off. */
#include "render/shade/exposure.h"

#include "render/shade/shading.h"

/* The place of a sample key's pixel and replicate in the film. */
static inline int64_t place_of(const tracer *t, int64_t sample_key)
{
    const film *f = t->target.img;
    const int64_t replicate = f->replicates == 1 ? 0 : path_replicate(&t->target.frame_plan->draws, sample_key);
    return film_pixel_index(f, sample_key_pixel(sample_key)) + replicate * f->width * f->height;
}

__attribute__((noinline)) void expose_by_sample_key(tracer *t, int64_t sample_key, double r, double g, double b)
{
    const plan *p = t->target.frame_plan;
    if (p->spectral) {
        const double *eye = spectra_row(p->spectral, sample_key)->eye;
        r *= eye[0], g *= eye[1], b *= eye[2];
    }
    expose_at(t, place_of(t, sample_key), r, g, b);
}

void expose_all(tracer *t, const film_light *sent, int count, const int64_t *sample_key)
{
    const film *f = t->target.img;
    film_sum *sums = f->sum;
    int64_t overflow = sent->out_of_range;
    if (f->image_width == 0 && !t->by_sample_key)
        for (int i = 0; i < count; i++)
            overflow |= add_units(&sums[sample_key[i] * 3], sent->r[i], sent->g[i], sent->b[i]);
    else
        for (int i = 0; i < count; i++)
            overflow |= add_units(&sums[place_of(t, sample_key[i]) * 3], sent->r[i], sent->g[i], sent->b[i]);
    t->account.overflow |= overflow;
}

/* A rainbow's colours are outside the gamut; their sum with the sky's is clamped at 0. */
static vec3 sky_and_rain(const plan *p, vec3 direction)
{
    const vec3 l = sky_radiance(p->sky, direction);
    if (!p->rain)
        return l;
    const vec3 sum = vec3_add(l, rain_color(p->rain, direction));
    return vec3_make(greater(sum.x, 0.0), greater(sum.y, 0.0), greater(sum.z, 0.0));
}

static double spectral_sky_and_rain(const plan *p, int64_t sample_key, vec3 direction)
{
    const spectral_row *row = spectra_row(p->spectral, sample_key);
    const double l = spectra_sky(row, p->sky, direction);
    const double lambda_nm = spectra_lambda(sample_key_wavelength(sample_key));
    return p->rain ? l + row->basis[SKY_BASIS_WHITE] * rain_radiance(p->rain, lambda_nm, direction) : l;
}

static double spectral_mean(const plan *p, int64_t sample_key)
{
    const spectral_row *row = spectra_row(p->spectral, sample_key);
    const double l = spectra_sky_mean(row, p->sky, p->sky_mean);
    const double lambda_nm = spectra_lambda(sample_key_wavelength(sample_key));
    return p->rain ? l + row->basis[SKY_BASIS_WHITE] * rain_radiance_mean(p->rain, lambda_nm) : l;
}

static __attribute__((noinline)) void expose_sky_by_sample_key(tracer *t, int64_t sample_key, vec3 direction, double wr,
                                                               double wg, double wb)
{
    const plan *p = t->target.frame_plan;
    vec3 l;
    if (p->spectral)
        l.x = l.y = l.z = spectral_sky_and_rain(p, sample_key, direction);
    else
        l = sky_and_rain(p, direction);
    if (p->basic) /* the sky is in the surrounding medium, wherever the ray ends */
        l = vec3_scale(l, radiance_scale(p, sample_key, 0));
    expose_by_sample_key(t, sample_key, wr * l.x, wg * l.y, wb * l.z);
}

static inline void expose_sky(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb)
{
    const plan *p = t->target.frame_plan;
    if (t->by_sample_key) {
        expose_sky_by_sample_key(t, sample_key, direction, wr, wg, wb);
        return;
    }
    const vec3 l = p->sky->kind == BACKGROUND_UNIFORM ? p->sky->color : sky_and_rain(p, direction);
    expose_at(t, film_pixel_index(t->target.img, sample_key), wr * l.x, wg * l.y, wb * l.z);
}

void shading_expose_shadow_rays(tracer *t, const ray_queue *q, int first, int count, const double *fraction)
{
    if (!t->target.frame_plan->spectral) {
        film_light sent;
        t->shade->arrived(count, fraction, q->wr + first, q->wg + first, q->wb + first, &sent);
        expose_all(t, &sent, count, q->sample_key + first);
        return;
    }
    for (int i = 0; i < count; i++) {
        const int at = first + i;
        if (fraction[i] > 0.0)
            shading_expose(t, q->sample_key[at], fraction[i] * q->wr[at], fraction[i] * q->wg[at],
                           fraction[i] * q->wb[at]);
    }
}

void shading_expose_sky(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb)
{
    expose_sky(t, sample_key, direction, wr, wg, wb);
}

/* Adds the fallback radiance of a branch that the depth limit cuts off. */
static inline void expose_at_depth_limit(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb)
{
    const plan *p = t->target.frame_plan;
    if (p->render.beyond != DEPTH_LIMIT_MEAN) {
        expose_sky(t, sample_key, direction, wr, wg, wb);
        return;
    }
    vec3 l = p->sky_mean;
    if (p->spectral)
        l.x = l.y = l.z = spectral_mean(p, sample_key);
    if (p->basic)
        l = vec3_scale(l, radiance_scale(p, sample_key, 0));
    shading_expose(t, sample_key, wr * l.x, wg * l.y, wb * l.z);
}

void shading_expose_at_depth_limit(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb)
{
    if (t->target.frame_plan->render.beyond != DEPTH_LIMIT_BLACK)
        expose_at_depth_limit(t, sample_key, direction, wr, wg, wb);
}

void background_sky(tracer *t, const ray_queue *q, int first, const int *list, int count)
{
    const plan *p = t->target.frame_plan;
    const bool one_by_one = p->spectral || p->basic || !t->by_sample_key, /* the last is faster so */
        uniform = p->sky->kind == BACKGROUND_UNIFORM;
    double whole[ROW], r[ROW], g[ROW], b[ROW];
    int64_t sample_key[ROW];
    film_light sent;
    for (int k = 0; k < count; k++) {
        const int at = first + list[k];
        const vec3 direction = vec3_make(q->dx[at], q->dy[at], q->dz[at]);
        if (one_by_one) {
            expose_sky(t, q->sample_key[at], direction, q->wr[at], q->wg[at], q->wb[at]);
            continue;
        }
        const vec3 l = uniform ? p->sky->color : sky_and_rain(p, direction);
        r[k] = q->wr[at] * l.x, g[k] = q->wg[at] * l.y, b[k] = q->wb[at] * l.z;
        whole[k] = 1.0, sample_key[k] = q->sample_key[at];
    }
    if (one_by_one)
        return;
    t->shade->arrived(count, whole, r, g, b, &sent);
    expose_all(t, &sent, count, sample_key);
}

/* --- branches that the depth limit cuts off --- */

/* Cuts off a branch whose weight differs by channel. */
static void cut_colored(tracer *t, int k, bool reflected)
{
    const group *g = &t->surface.gathered;
    const branch_group *b = &t->surface.branches;
    const vec3 weight = layered_weight(t, k, reflected), direction = reflected
                                                                         ? vec3_make(b->rx[k], b->ry[k], b->rz[k])
                                                                         : vec3_make(b->tx[k], b->ty[k], b->tz[k]);
    const double wr = g->wr[k] * weight.x, wg = g->wg[k] * weight.y, wb = g->wb[k] * weight.z;
    if (!((reflected ? b->reflect[k] : b->refract[k]) > 0.0))
        return;
    count_cut_by_depth(t, g->sample_key[k], wr, wg, wb);
    if (t->target.frame_plan->render.beyond != DEPTH_LIMIT_BLACK)
        expose_at_depth_limit(t, g->sample_key[k], direction, wr, wg, wb);
}

/* Adds the group's branches to the map of cut rays, as the kernel adds them to the counters. */
static void map_cut_branches(tracer *t)
{
    const group *g = &t->surface.gathered;
    const branch_group *b = &t->surface.branches;
    for (int i = 0; i < g->count; i++) {
        map_cut(t, g->sample_key[i], g->wr[i] * b->reflect[i], g->wg[i] * b->reflect[i], g->wb[i] * b->reflect[i]);
        map_cut(t, g->sample_key[i], g->wr[i] * b->refract[i], g->wg[i] * b->refract[i], g->wb[i] * b->refract[i]);
    }
}

void cut_branches(tracer *t)
{
    const group *g = &t->surface.gathered;
    const branch_group *b = &t->surface.branches;
    const plan *p = t->target.frame_plan;
    if (surface_is_layered(t) && t->layered->colored) {
        for (int k = 0; k < g->count; k++)
            cut_colored(t, k, true), cut_colored(t, k, false);
        return;
    }
    if (CUVETTE_COUNTERS) {
        cut_sum sum;
        t->shade->cut(g, b, &sum);
        t->account.counters.cut_depth += (uint64_t)sum.branches;
        for (int c = 0; c < 3; c++)
            t->account.counters.cut_depth_throughput[c] += sum.throughput[c];
    }
    if (t->target.pixel_cut)
        map_cut_branches(t);
    if (p->render.beyond == DEPTH_LIMIT_BLACK)
        return;
    const bool uniform =
        p->sky->kind == BACKGROUND_UNIFORM || p->render.beyond == DEPTH_LIMIT_MEAN; /* then directions do not matter */
    if (uniform && !p->spectral && !p->basic) {
        film_light sent;
        t->shade->cut_light(g, b, p->render.beyond == DEPTH_LIMIT_MEAN ? p->sky_mean : p->sky->color, &sent);
        expose_all(t, &sent, g->count, g->sample_key);
        return;
    }
    for (int i = 0; i < g->count; i++) {
        const double first = uniform ? b->reflect[i] + b->refract[i] : b->reflect[i],
                     second = uniform ? 0.0 : b->refract[i];
        if (first > 0.0)
            expose_at_depth_limit(t, g->sample_key[i], vec3_make(b->rx[i], b->ry[i], b->rz[i]), g->wr[i] * first,
                                  g->wg[i] * first, g->wb[i] * first);
        if (second > 0.0)
            expose_at_depth_limit(t, g->sample_key[i], vec3_make(b->tx[i], b->ty[i], b->tz[i]), g->wr[i] * second,
                                  g->wg[i] * second, g->wb[i] * second);
    }
}
