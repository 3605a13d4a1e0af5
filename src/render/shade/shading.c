/* Shading of rays that hit a surface: local light, shadow rays, reflected and refracted children, and contributions to
 * the film. */
#include "render/shade/shading.h"

#include "render/caustics/photon_map.h"
#include "render/shade/sky.h"
#include <string.h>

/* Negative if a sum left the film's range. */
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

/* Exposes the share and pixel of a sample key; in a spectral film with the observer's weights at its wavelength. Never
 * inlined, so that the rgb film's code path keeps its registers. */
static __attribute__((noinline)) void expose_by_sample_key(tracer *t, int64_t sample_key, double r, double g, double b)
{
    const plan *p = t->target.frame_plan;
    const film *f = t->target.img;
    const int64_t share = f->shares == 1 ? 0 : path_replicate(&p->draws, sample_key);
    const int64_t place = film_place(f, sample_key_pixel(sample_key)) + share * f->width * f->height;
    if (p->spectral) {
        const double *eye = spectra_row(p->spectral, sample_key)->eye;
        r *= eye[0], g *= eye[1], b *= eye[2];
    }
    expose_at(t, place, r, g, b);
}

static inline void expose(tracer *t, int64_t sample_key, double r, double g, double b)
{
    if (t->by_sample_key)
        expose_by_sample_key(t, sample_key, r, g, b);
    else
        expose_at(t, film_place(t->target.img, sample_key), r, g, b);
}

void shading_expose(tracer *t, int64_t sample_key, double r, double g, double b)
{
    expose(t, sample_key, r, g, b);
}

/* Adds the light of many rays, whose sample keys are pixels. */
static void expose_all(tracer *t, const film_light *sent, int count, const int64_t *pixel)
{
    const film *f = t->target.img;
    film_sum *sums = f->sum;
    int64_t overflow = sent->out_of_range;
    if (f->image_width == 0)
        for (int i = 0; i < count; i++)
            overflow |= add_units(&sums[pixel[i] * 3], sent->r[i], sent->g[i], sent->b[i]);
    else
        for (int i = 0; i < count; i++)
            overflow |= add_units(&sums[film_place(f, pixel[i]) * 3], sent->r[i], sent->g[i], sent->b[i]);
    t->account.overflow |= overflow;
}

/* Colours of a rainbow are outside the gamut, those of the sky behind it are not. */
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
    return p->rain ? l + row->basis[SKY_BASIS_WHITE] * rain_share(p->rain, lambda_nm, direction) : l;
}

static double spectral_mean(const plan *p, int64_t sample_key)
{
    const spectral_row *row = spectra_row(p->spectral, sample_key);
    const double l = spectra_sky_mean(row, p->sky, p->sky_mean);
    const double lambda_nm = spectra_lambda(sample_key_wavelength(sample_key));
    return p->rain ? l + row->basis[SKY_BASIS_WHITE] * rain_share_mean(p->rain, lambda_nm) : l;
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
        l = vec3_scale(l, radiance_share(p, sample_key, 0));
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
    expose_at(t, film_place(t->target.img, sample_key), wr * l.x, wg * l.y, wb * l.z);
}

void shading_expose_shares(tracer *t, const ray_queue *q, int first, int count, const double *share)
{
    if (!t->by_sample_key) {
        film_light sent;
        t->shade->arrived(count, share, q->wr + first, q->wg + first, q->wb + first, &sent);
        expose_all(t, &sent, count, q->sample_key + first);
        return;
    }
    for (int i = 0; i < count; i++) {
        const int at = first + i;
        if (share[i] > 0.0)
            expose(t, q->sample_key[at], share[i] * q->wr[at], share[i] * q->wg[at], share[i] * q->wb[at]);
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
        l = vec3_scale(l, radiance_share(p, sample_key, 0));
    expose(t, sample_key, wr * l.x, wg * l.y, wb * l.z);
}

void shading_expose_at_depth_limit(tracer *t, int64_t sample_key, vec3 direction, double wr, double wg, double wb)
{
    if (t->target.frame_plan->render.beyond != DEPTH_LIMIT_BLACK)
        expose_at_depth_limit(t, sample_key, direction, wr, wg, wb);
}

/* Ambient and emitted light; in a spectral film with the spectrum of white, daylight. */
static void expose_own_light(tracer *t, const material *m, bool ambient)
{
    const group *g = &t->surface.gathered;
    const plan *p = t->target.frame_plan;
    const double k_a = ambient ? m->ambient : 0.0, k_e = m->emission;
    if (k_a == 0.0 && k_e == 0.0)
        return;
    if (p->spectral) {
        for (int i = 0; i < g->count; i++) {
            const spectral_row *row = spectra_row(p->spectral, g->sample_key[i]);
            const double a = (k_a * row->ambient + k_e * row->basis[SKY_BASIS_WHITE]) * g->cr[i];
            expose(t, g->sample_key[i], g->wr[i] * a, g->wg[i] * a, g->wb[i] * a);
        }
        return;
    }
    const vec3 a = vec3_add(vec3_scale(p->sky->ambient, k_a), vec3_make(k_e, k_e, k_e));
    if (!t->by_sample_key) {
        film_light sent;
        t->shade->own_light(g, a, &sent);
        expose_all(t, &sent, g->count, g->sample_key);
        return;
    }
    for (int i = 0; i < g->count; i++)
        expose(t, g->sample_key[i], g->wr[i] * a.x * g->cr[i], g->wg[i] * a.y * g->cg[i], g->wb[i] * a.z * g->cb[i]);
}

/* The share of light in the film, by its mean over channels, that ray i of the group brings from a white matte surface.
 * */
static double share_in_film(const tracer *t, int i)
{
    const group *g = &t->surface.gathered;
    const spectra *s = t->target.frame_plan->spectral;
    const double *eye = s ? spectra_row(s, g->sample_key[i])->eye : NULL;
    return eye ? g->wr[i] * g->cr[i] * (eye[0] + eye[1] + eye[2]) / 3.0
               : (g->wr[i] * g->cr[i] + g->wg[i] * g->cg[i] + g->wb[i] * g->cb[i]) / 3.0;
}

/* Adds the photons' light, which matte surfaces reflect. */
static void caustic_light(tracer *t, const material *m)
{
    const group *g = &t->surface.gathered;
    const plan *p = t->target.frame_plan;
    for (int i = 0; i < g->count; i++) {
        const int wavelength = p->spectral ? (int)sample_key_wavelength(g->sample_key[i]) : -1;
        const vec3 e =
            t->footprints
                ? footprint_irradiance(t, i, wavelength, m->diffuse * share_in_film(t, i))
                : photon_map_irradiance(p->photons, vec3_make(g->points.px[i], g->points.py[i], g->points.pz[i]),
                                        vec3_make(g->points.nx[i], g->points.ny[i], g->points.nz[i]), wavelength);
        if (e.x > 0.0 || e.y > 0.0 || e.z > 0.0)
            expose(t, g->sample_key[i], g->wr[i] * m->diffuse * g->cr[i] * e.x, g->wg[i] * m->diffuse * g->cg[i] * e.y,
                   g->wb[i] * m->diffuse * g->cb[i] * e.z);
    }
}

/* Enqueues shadow rays to lights that can change the film. */
static void enqueue_shadow_rays(tracer *t, int lamp)
{
    const group *g = &t->surface.gathered;
    const lit_group *l = &t->surface.lit;
    ray_queue *q = &t->queues.shadows;
    int worth[ROW], count = 0;
    for (int i = 0; i < g->count; i++) {
        worth[count] = i;
        count -= (int)l->contributes[i];
    }
    for (int k = 0; k < count; k++) {
        const int i = worth[k], at = q->count++;
        q->ox[at] = g->points.px[i], q->oy[at] = g->points.py[i], q->oz[at] = g->points.pz[i];
        q->dx[at] = l->lx[i], q->dy[at] = l->ly[i], q->dz[at] = l->lz[i];
        q->wr[at] = l->r[i], q->wg[at] = l->g[i], q->wb[at] = l->b[i];
        q->start[at] = g->points.face[i], q->sample_key[at] = g->sample_key[i], q->inside[at] = g->inside_before[i];
        if (t->target.frame_plan->sheets)
            sheets_shadow_ray(t, lamp, at);
    }
}

/* The light of one lamp on the gathered group, with its spectrum in a spectral film. */
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
                expose(t, t->surface.gathered.sample_key[i], t->surface.lit.r[i], t->surface.lit.g[i],
                       t->surface.lit.b[i]);
    }
}

void local_light(tracer *t, int priority_index, light_terms terms)
{
    radiance_weigh(t);
    send_out(t, priority_index, terms);
    radiance_weigh_back(t);
}

/* A branch whose weight differs by channel. */
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

/* The group's branches in the map, as the kernel below adds them to the counters. */
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
    if (uniform && !t->by_sample_key) {
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

static bool is_below_least_weight(tracer *t, const ray_queue *q, int i, double least)
{
    if (q->wr[i] >= least || q->wg[i] >= least || q->wb[i] >= least)
        return false;
    count_cut_by_weight(t, q->sample_key[i], q->wr[i], q->wg[i], q->wb[i]);
    return true;
}

/* The compaction below, including the Stokes vectors. */
static int keep_polarised(tracer *t, ray_queue *q, int first, bool reflected, const double *weight, double least)
{
    const polar_group *p = &t->surface.polar;
    const size_t bytes = (size_t)t->surface.gathered.count * sizeof(double);
    memcpy(q->sq + first, reflected ? p->rq : p->tq, bytes);
    memcpy(q->su + first, reflected ? p->ru : p->tu, bytes);
    memcpy(q->sv + first, reflected ? p->rv : p->tv, bytes);
    for (int i = t->surface.gathered.count - 1; i >= 0; i--)
        if (weight[i] == 0.0 || (least > 0.0 && is_below_least_weight(t, q, first + i, least)))
            queue_move_polarised(q, first + i, --q->count);
    return q->count - first;
}

/* The same with the footprints, which go with the ray that fills the place. */
static int keep_footprints(tracer *t, ray_queue *q, int first, bool reflected, const double *weight, double least)
{
    footprints_of_children(t, q, first, reflected);
    if (t->target.frame_plan->render.polarisation) {
        const polar_group *p = &t->surface.polar;
        const size_t bytes = (size_t)t->surface.gathered.count * sizeof(double);
        memcpy(q->sq + first, reflected ? p->rq : p->tq, bytes);
        memcpy(q->su + first, reflected ? p->ru : p->tu, bytes);
        memcpy(q->sv + first, reflected ? p->rv : p->tv, bytes);
    }
    for (int i = t->surface.gathered.count - 1; i >= 0; i--)
        if (weight[i] == 0.0 || (least > 0.0 && is_below_least_weight(t, q, first + i, least))) {
            queue_move_polarised(q, first + i, --q->count);
            q->footprint[first + i] = q->footprint[q->count];
        }
    return q->count - first;
}

/* Enqueues children of one kind: appends all of them at once, then fills the place of each one that does not exist or
 * has too small a weight with the last one. Returns their number. */
int enqueue_children(tracer *t, int depth, const double *dx, const double *dy, const double *dz, const double *weight,
                     const uint64_t *inside)
{
    ray_queue *q = tracer_queue_at(t, depth);
    const double least = t->least_weight;
    const int first = q->count;
    t->shade->append(&t->surface.gathered, dx, dy, dz, weight, inside, q);
    if (surface_is_layered(t) && t->layered->colored)
        layered_color_children(t, q, first, weight == t->surface.branches.reflect);
    if (t->footprints)
        return keep_footprints(t, q, first, dx == t->surface.branches.rx, weight, least);
    if (t->target.frame_plan->render.polarisation)
        return keep_polarised(t, q, first, dx == t->surface.branches.rx, weight, least);
    for (int i = t->surface.gathered.count - 1; i >= 0; i--)
        if (weight[i] == 0.0 || (least > 0.0 && is_below_least_weight(t, q, first + i, least)))
            queue_move(q, first + i, --q->count);
    return q->count - first;
}

void shading_branches_at_facets(tracer *t, bool opaque)
{
    const plan *p = t->target.frame_plan;
    const material *m = &t->surface.mat->surface;
    if (!opaque && p->render.transmission == TRANSMISSION_SIMPLE)
        t->shade->straight_branches(m, &t->surface.gathered, &t->surface.branches);
    else if (opaque || p->render.weights == WEIGHTS_CONSTANT)
        t->shade->constant_branches(m, opaque, &t->surface.gathered, &t->surface.branches);
    else
        t->shade->fresnel_branches(m, &t->surface.gathered, &t->surface.branches);
    if (surface_is_layered(t))
        layered_branches(t, m);
    else if (p->render.polarisation)
        polarised_branches(t, m, opaque);
}

void shading_branches(tracer *t, bool opaque)
{
    shading_branches_at_facets(t, opaque);
    if (t->surface.on_mesh)
        mesh_bound_branches(t);
    if (!opaque)
        COUNT(t->account.counters.total_internal += (uint64_t)t->surface.branches.total);
}

void intersect_nearest(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays)
{
    (void)q, (void)first, (void)depth;
    t->geometry->nearest(t->target.frame_plan->geometry, rays, &t->batch.scratch, &t->batch.hits);
}

void background_sky(tracer *t, const ray_queue *q, int first, const int *list, int count)
{
    for (int k = 0; k < count; k++) {
        const int at = first + list[k];
        expose_sky(t, q->sample_key[at], vec3_make(q->dx[at], q->dy[at], q->dz[at]), q->wr[at], q->wg[at], q->wb[at]);
    }
}

/* A checker's cells are in the frame of the solid whose surface it is, even where another solid's face exposes it. */
static void color(tracer *t, int priority_index, const primitive *surface)
{
    const plan *p = t->target.frame_plan;
    const primitive *frame = surface->priority_index == priority_index
                                 ? surface
                                 : &p->geometry->primitives[p->geometry->regions[priority_index].outside];
    if (!p->spectral) {
        t->shade->color(&t->surface.mat->surface, frame, &t->surface.gathered);
        if (t->surface.mat->img)
            texture_colors(t, surface);
        return;
    }
    /* First find which of the two colours applies, then its spectrum. */
    material marked = t->surface.mat->surface;
    marked.color = vec3_make(1.0, 0.0, 0.0);
    marked.checker_color = vec3_make(0.0, 1.0, 0.0);
    t->shade->color(&marked, frame, &t->surface.gathered);
    spectral_colors(t, priority_index);
}

/* The points of the gathered rays where they hit a primitive: rays from .. to - 1 of the group. */
static void surface_points(tracer *t, int hit_primitive, int from, int to, surface_batch *points)
{
    const group *g = &t->surface.gathered;
    const ray_batch rays = {to - from,    g->ox + from, g->oy + from,    g->oz + from,           g->dx + from,
                            g->dy + from, g->dz + from, g->start + from, g->inside_before + from};
    t->geometry->surface(t->target.frame_plan->geometry, hit_primitive, &rays, g->t + from, points);
}

static void copy_points(const surface_batch *from, int count, surface_batch *to, int at)
{
    const size_t bytes = (size_t)count * sizeof(double);
    memcpy(to->px + at, from->px, bytes), memcpy(to->py + at, from->py, bytes), memcpy(to->pz + at, from->pz, bytes);
    memcpy(to->nx + at, from->nx, bytes), memcpy(to->ny + at, from->ny, bytes), memcpy(to->nz + at, from->nz, bytes);
    memcpy(to->cos_i + at, from->cos_i, bytes), memcpy(to->error + at, from->error, bytes);
    memcpy(to->face + at, from->face, bytes);
}

/* The points on several analytic primitives; the last group's include the padding. */
static void points_of_groups(tracer *t, const hit_group *groups, int count)
{
    group *g = &t->surface.gathered;
    surface_batch some;
    for (int k = 0, from = 0; k < count; k++) {
        const int to = k + 1 < count ? from + groups[k].count : g->padded;
        surface_points(t, groups[k].hit_primitive, from, to, &some);
        copy_points(&some, to - from, &g->points, from);
        from = to;
    }
}

static void count_hits(tracer *t, int depth, int priority_index, int count)
{
    const int owner = t->target.frame_plan->geometry->regions[priority_index].solid;
    if (owner >= COUNTERS_SOLID_MAX)
        return;
    COUNT(t->account.counters.hits[owner] += (uint64_t)count);
    if (depth == 0)
        COUNT(t->account.counters.first_hits[owner] += (uint64_t)count);
}

/* Shades rays on one material: list[0 .. count - 1], of these groups. */
static void shade_one_material(tracer *t, int depth, int first, const hit_group *groups, int group_count,
                               const int *list, int count)
{
    const plan *p = t->target.frame_plan;
    const int priority_index = groups->priority_index;
    const primitive *surface = &p->geometry->primitives[groups->hit_primitive];
    group *g = &t->surface.gathered;
    group_gather(tracer_queue_at(t, depth), first, &t->batch.hits, p->ior, list, count, group_count == 1, g);
    if (p->spectral)
        spectral_indices(t, list);
    if (t->layered)
        layered_gather(t, list, priority_index);
    if (t->crystals)
        crystals_gather(t, tracer_queue_at(t, depth), first, list);
    if (p->render.polarisation)
        polarised_gather(t, tracer_queue_at(t, depth), first, list);
    t->surface.on_mesh = !surface->rule;
    if (t->surface.on_mesh)
        mesh_surface(t, priority_index, list);
    else if (group_count == 1)
        surface_points(t, groups->hit_primitive, 0, g->padded, &g->points);
    else
        points_of_groups(t, groups, group_count);
    if (t->footprints)
        footprints_gather(t, tracer_queue_at(t, depth), first, list);
    t->surface.texture_at = NULL;
    if (t->rule->place)
        t->rule->place(t, list);
    if (group_count == 1)
        count_hits(t, depth, priority_index, count);
    for (int k = 0; group_count > 1 && k < group_count; k++)
        count_hits(t, depth, groups[k].priority_index, groups[k].count);
    color(t, priority_index, surface);
    t->rule->shade(t, depth, priority_index);
}

/* Shades groups whose hits may be shaded together, as far as they fit. */
static void shade_alike(tracer *t, int depth, int first, const hit_group *groups, int count)
{
    const region_materials *materials = &t->target.frame_plan->shading_materials[groups->priority_index];
    const int *list = &t->batch.groups.list[groups->first];
    int rays = 0;
    for (int k = 0; k < count; k++)
        rays += groups[k].count;
    t->surface.mat = materials->mat;
    if (materials->count == 1) {
        shade_one_material(t, depth, first, groups, count, list, rays);
        return;
    }
    int left[BATCH];
    memcpy(left, list, (size_t)rays * sizeof left[0]);
    for (int begin = 0; begin < rays;) {
        int slot;
        const int alike = mesh_next_material(t, left + begin, rays - begin, &slot);
        t->surface.mat = &materials->mat[slot < materials->count ? slot : 0];
        shade_one_material(t, depth, first, groups, 1, left + begin, alike);
        begin += alike;
    }
}

/* Can these hits be shaded with others? Not on a mesh's surface, not where a material's values are found in the
 * frame of the primitive, and not by an integrator that distinguishes solids. */
static bool can_be_together(const tracer *t, const hit_group *g)
{
    const plan *p = t->target.frame_plan;
    /* of the regions that look alike the materials of one, which the caches hold */
    const int looks = p->alike[g->priority_index];
    return !t->rule->by_solid && p->geometry->primitives[g->hit_primitive].rule && plan_is_plain(p, looks);
}

void shading_groups(tracer *t, int depth, int first, const hit_group *groups, int count)
{
    for (int k = 0, together; k < count; k += together) {
        together = 1;
        while (k + together < count && can_be_together(t, &groups[k]) && can_be_together(t, &groups[k + together]))
            together++;
        shade_alike(t, depth, first, &groups[k], together);
    }
}
