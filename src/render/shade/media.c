/* Airlight points along rays, free flights, and absorption along medium segments. */
#include "render/shade/media.h"

#include "base/elementary.h"
#include "render/shade/kernels.h"
#include <stdlib.h>

/* Absorption coefficients of a medium in 1 / scene unit, by channel; in a spectral film at the ray's wavelength. */
static vec3 absorption_coefficients(const plan *p, int priority_index, int64_t sample_key)
{
    if (!p->spectral)
        return p->absorption[priority_index];
    const double a = spectra_region(p->spectral, sample_key, priority_index)->absorption;
    return vec3_make(a, a, a);
}

/* Scattering coefficients, likewise. */
static vec3 scattering_coefficients(const plan *p, int priority_index, int64_t sample_key)
{
    if (!p->spectral)
        return p->scatter->region[priority_index].per_unit;
    const double s = spectra_region(p->spectral, sample_key, priority_index)->scattering;
    return vec3_make(s, s, s);
}

/* --- airlight: points along rays, chosen for each lamp --- */

/* An interval of distances along a ray. */
typedef struct ray_interval {
    double low, high; /* empty if high <= low */
} ray_interval;

static void clip_axis(double o, double d, double low, double high, ray_interval *s)
{
    const double a = (low - o) / d, b = (high - o) / d;
    if (d != 0.0) {
        s->low = fmax(s->low, fmin(a, b));
        s->high = fmin(s->high, fmax(a, b));
    } else if (o < low || o > high) {
        s->high = 0.0;
    }
}

/* The interval from a ray's first to its last point in any of the boxes around media that scatter. */
static ray_interval within_boxes(const scatter_plan *scatter, vec3 o, vec3 d)
{
    ray_interval all = {(double)INFINITY, 0.0};
    for (int k = 0; k < scatter->box_count; k++) {
        const bounds3 *b = &scatter->boxes[k];
        ray_interval s = {0.0, (double)INFINITY};
        clip_axis(o.x, d.x, b->low.x, b->high.x, &s);
        clip_axis(o.y, d.y, b->low.y, b->high.y, &s);
        clip_axis(o.z, d.z, b->low.z, b->high.z, &s);
        if (s.high > s.low)
            all = (ray_interval){fmin(all.low, s.low), fmax(all.high, s.high)};
    }
    return all;
}

/* Clips the interval to a cone of half angle below 90 degrees, in which (x.a)^2 >= cos^2 |x|^2 and x.a > 0 for the
 * vector x from the lamp: a quadratic in the distance. */
static void clip_cone(const light_cone *c, vec3 from, vec3 d, ray_interval *s)
{
    const double cosine = 1.0 - c->opening, cos2 = cosine * cosine, along = vec3_dot(d, c->axis),
                 start = vec3_dot(from, c->axis);
    const double a = along * along - cos2, b = start * along - cos2 * vec3_dot(from, d),
                 e = start * start - cos2 * vec3_dot(from, from), discriminant = b * b - a * e;
    if (!(cosine > 0.0) || a == 0.0)
        return;
    if (!(discriminant > 0.0)) { /* outside the cone, or through its tip */
        s->high = a < 0.0 ? 0.0 : s->high;
        return;
    }
    const double far = -(b + (b < 0.0 ? -sqrt(discriminant) : sqrt(discriminant))), one = far / a, other = e / far;
    const double low = fmin(one, other), high = fmax(one, other);
    if (a > 0.0) { /* one root is in the opposite cone */
        s->low = along > 0.0 ? fmax(s->low, high) : s->low;
        s->high = along > 0.0 ? s->high : fmin(s->high, low);
    } else {
        s->low = fmax(s->low, low);
        s->high = start + 0.5 * (low + high) * along > 0.0 ? fmin(s->high, high) : 0.0;
    }
}

/* The interval of a ray that is sampled for a lamp, and how. */
typedef struct line_sampling {
    ray_interval interval;
    double nearest, across;    /* where the ray is nearest to the lamp, and its distance there */
    double from_deg, size_deg; /* angles at the lamp, from the nearest point: the interval's start, and its size */
    bool even;                 /* uniform in length, because the lamp sees the interval under a tiny angle */
} line_sampling;

static bool sampling_of(const plan *p, int lamp, vec3 origin, vec3 d, line_sampling *out)
{
    const double tiny_deg = 1e-6;
    const light *l = &p->lights[lamp];
    const vec3 from = vec3_sub(origin, l->position);
    ray_interval s = within_boxes(p->scatter, origin, d);
    if (l->kind != LIGHT_POINT && s.high > s.low)
        clip_cone(&p->cones[lamp], from, d, &s);
    if (!(s.high > s.low))
        return false;
    const double nearest = -vec3_dot(from, d), across = vec3_length(vec3_cross(from, d));
    if (!(across > 0.0))
        return false;
    *out = (line_sampling){.interval = s, .nearest = nearest, .across = across};
    out->from_deg = elementary_atan2_deg(s.low - nearest, across);
    out->size_deg = (s.high < (double)INFINITY ? elementary_atan2_deg(s.high - nearest, across) : 90.0) - out->from_deg;
    out->even = out->size_deg < tiny_deg;
    return !out->even || s.high < (double)INFINITY;
}

static double density_at(const line_sampling *s, double distance)
{
    const double deg_per_rad = 57.295779513082320877, off = distance - s->nearest;
    if (!(distance >= s->interval.low && distance <= s->interval.high))
        return 0.0;
    if (s->even)
        return 1.0 / (s->interval.high - s->interval.low);
    return deg_per_rad * s->across / (s->size_deg * (s->across * s->across + off * off));
}

static double distance_at(const line_sampling *s, double u)
{
    double sine, cosine;
    if (s->even)
        return s->interval.low + u * (s->interval.high - s->interval.low);
    elementary_sincos_deg(s->from_deg + u * s->size_deg, &sine, &cosine);
    return fmin(fmax(s->nearest + s->across * sine / cosine, s->interval.low), s->interval.high);
}

double airlight_density(const plan *p, int lamp, vec3 origin, vec3 direction, double distance)
{
    line_sampling s;
    bool chosen = false;
    for (int k = 0; k < p->scatter->lamp_count; k++)
        chosen |= p->scatter->lamps[k] == lamp;
    return chosen && sampling_of(p, lamp, origin, direction, &s) ? density_at(&s, distance) : 0.0;
}

static void choose_for(tracer *t, int lamp, const ray_queue *q, int first, int count, const double *u, airlight *out)
{
    for (int i = 0; i < count; i++) {
        const int k = first + i;
        line_sampling s;
        out->at[i] = (double)INFINITY;
        out->region[i] = 0;
        out->sheet_transmittance[i] = 1.0;
        if (!sampling_of(t->target.frame_plan, lamp, vec3_make(q->ox[k], q->oy[k], q->oz[k]),
                         vec3_make(q->dx[k], q->dy[k], q->dz[k]), &s))
            continue;
        out->at[i] = distance_at(&s, u[i]);
        out->density[i] = density_at(&s, out->at[i]);
    }
}

/* Chooses the points of a batch of rays, before the search for their interfaces. */
static void airlight_choose(tracer *t, const ray_queue *q, int first, int depth, int count)
{
    const plan *p = t->target.frame_plan;
    double u[ROW], unused[ROW];
    for (int k = 0; k < p->scatter->lamp_count; k++) {
        t->sampling->draw(&p->draws, count, q->sample_key + first, depth, DRAW_AIRLIGHT + p->scatter->lamps[k], u,
                          unused);
        choose_for(t, p->scatter->lamps[k], q, first, count, u, &t->media->flights.lamps[k]);
    }
}

/* Adds a medium segment to the optical depths, and to the points within it. */
static void airlight_follow(tracer *t, const medium_segment *s)
{
    const plan *p = t->target.frame_plan;
    flight_work *w = &t->media->flights;
    const int i = s->ray;
    const vec3 a = absorption_coefficients(p, s->priority_index, t->media->sample_keys[i]),
               b = scattering_coefficients(p, s->priority_index, t->media->sample_keys[i]);
    const double coefficient[MEDIA_DEPTHS] = {a.x, a.y, a.z, b.x, b.y, b.z};
    const bool scatters = b.x > 0.0 || b.y > 0.0 || b.z > 0.0;
    for (int k = 0; k < p->scatter->lamp_count; k++) {
        airlight *l = &w->lamps[k];
        const double length = l->at[i] - w->passed[i];
        if (!(scatters && length >= 0.0 && length < s->length))
            continue;
        l->region[i] = s->priority_index;
        for (int c = 0; c < MEDIA_DEPTHS; c++)
            l->depth[c][i] = w->depth[c][i] + coefficient[c] * length;
        if (p->sheets)
            l->sheet_transmittance[i] = sheets_fraction_within(t, &w->sheets, s, length);
    }
    if (p->sheets)
        sheets_segment(t, &w->sheets, s);
    for (int c = 0; c < MEDIA_DEPTHS; c++)
        w->depth[c][i] += coefficient[c] * s->length;
}

/* --- free flights --- */

void scattering_begin(tracer *t, const ray_queue *q, int first, int depth, int count)
{
    const double ln_2 = 0.69314718055994530942;
    flight_work *w = &t->media->flights;
    const bool by_channel = t->target.frame_plan->scatter->by_channel;
    double v[ROW];
    t->sampling->draw(&t->target.frame_plan->draws, count, q->sample_key + first, depth, DRAW_FLIGHT, w->u, v);
    for (int i = 0; i < count; i++) {
        w->left[i] = -ln_2 * elementary_log2_inline(w->u[i]);
        w->channel[i] = by_channel ? (int)fmin(3.0 * v[i], 2.0) : 0;
        for (int c = 0; c < 3; c++)
            w->weight[c][i] = 1.0;
        w->passed[i] = 0.0;
        w->end[i] = (double)INFINITY;
        w->region[i] = 0;
        for (int c = 0; c < MEDIA_DEPTHS; c++)
            w->depth[c][i] = 0.0;
    }
    if (t->target.frame_plan->sheets)
        sheets_begin(t, &w->sheets, q, first, count);
    airlight_choose(t, q, first, depth, count);
    w->flies = w->flying = true;
}

/* Densities of flights that end behind an optical depth, by channel, where the medium has these coefficients; returns
 * the mean. */
static double flight_density(const double coefficient[3], const double depth[3], double by_channel[3])
{
    for (int c = 0; c < 3; c++)
        by_channel[c] = coefficient[c] * absorption_left(depth[c]);
    return (by_channel[0] + by_channel[1] + by_channel[2]) / 3.0;
}

double airlight_flights(const tracer *t, const airlight *l, int i, double by_channel[3])
{
    const plan *p = t->target.frame_plan;
    const vec3 b = scattering_coefficients(p, l->region[i], t->media->sample_keys[i]);
    const double coefficient[3] = {b.x, b.y, b.z}, depth[3] = {l->depth[3][i], l->depth[4][i], l->depth[5][i]};
    const double mean = flight_density(coefficient, depth, by_channel);
    return p->scatter->by_channel ? mean : by_channel[0];
}

/* Weights the channels of a ray by their densities of having passed `length` beyond the depths in w without scattering,
 * and of then scattering if its coefficients b are not NULL. */
static void weigh(flight_work *w, int i, const vec3 *b, double length)
{
    const double one[3] = {1.0, 1.0, 1.0}, own[3] = {b ? b->x : 0.0, b ? b->y : 0.0, b ? b->z : 0.0};
    double depth[3], density[3];
    for (int c = 0; c < 3; c++)
        depth[c] = w->depth[3 + c][i] + own[c] * length;
    w->density[i] = flight_density(b ? own : one, depth, density);
    for (int c = 0; c < 3; c++)
        w->weight[c][i] = density[c] / w->density[i];
}

/* Shortens a segment to the point at which the ray scatters, if it is within. */
static void fly(const plan *p, flight_work *w, int64_t sample_key, medium_segment *s)
{
    const int i = s->ray;
    const vec3 b = scattering_coefficients(p, s->priority_index, sample_key);
    const double per_unit = w->channel[i] == 0 ? b.x : w->channel[i] == 1 ? b.y : b.z;
    const double thickness = per_unit * s->length;
    if (thickness > w->left[i]) {
        s->length = w->left[i] / per_unit;
        w->end[i] = w->passed[i] + s->length;
        w->region[i] = s->priority_index;
        w->density[i] = per_unit * w->u[i];
        if (p->scatter->by_channel)
            weigh(w, i, &b, s->length);
    }
    w->left[i] -= thickness;
}

/* Applies the recorded medium segments to flights and airlights, and removes the part beyond the point at which a ray
 * scatters; called before absorption uses them. */
static void follow_segments(tracer *t)
{
    const plan *p = t->target.frame_plan;
    flight_work *w = &t->media->flights;
    medium_segments *list = &t->media->segments;
    int kept = 0;
    for (int k = 0; k < list->count; k++) {
        medium_segment s = list->segment[k];
        const double passed = w->passed[s.ray], length = s.length;
        const bool has_ended = w->end[s.ray] < (double)INFINITY;
        const medium_segment whole = s;
        if (!has_ended) {
            fly(p, w, t->media->sample_keys[s.ray], &s);
            list->segment[kept++] = s;
        }
        airlight_follow(t, &whole);
        w->passed[s.ray] = passed + length;
    }
    list->count = kept;
}

void scattering_end(tracer *t)
{
    follow_segments(t);
    t->media->flights.flying = false;
}

void scattering_weigh(tracer *t, ray_queue *q, int first, int count)
{
    flight_work *w = &t->media->flights;
    for (int i = 0; t->target.frame_plan->scatter->by_channel && i < count; i++) {
        if (!(w->end[i] < (double)INFINITY))
            weigh(w, i, NULL, 0.0);
        q->wr[first + i] *= w->weight[0][i];
        q->wg[first + i] *= w->weight[1][i];
        q->wb[first + i] *= w->weight[2][i];
    }
}

/* --- absorption --- */

/* Adds extinction by scattering, for rays without free flights. */
static void add_scattering(tracer *t)
{
    for (int k = 0; k < t->batch.scratch.segments->count; k++) {
        const medium_segment *s = &t->batch.scratch.segments->segment[k];
        const vec3 b = scattering_coefficients(t->target.frame_plan, s->priority_index, t->media->sample_keys[s->ray]);
        t->media->transmittance[0][s->ray] += b.x * s->length;
        t->media->transmittance[1][s->ray] += b.y * s->length;
        t->media->transmittance[2][s->ray] += b.z * s->length;
    }
}

/* Adds the optical depths of the segments to `transmittance`, which holds optical depths until apply_transmittances. */
static void add_depths(tracer *t)
{
    const plan *p = t->target.frame_plan;
    const int64_t *sample_keys = t->media->sample_keys;
    t->media->dims |= p->scatter || p->sheets;
    if (p->scatter && !t->media->flights.flies)
        add_scattering(t);
    for (int k = 0; p->sheets && k < t->batch.scratch.segments->count; k++)
        sheets_segment(t, &t->media->sheets, &t->batch.scratch.segments->segment[k]);
    for (int k = 0; k < t->batch.scratch.segments->count; k++) {
        const medium_segment *s = &t->batch.scratch.segments->segment[k];
        if (!p->geometry->regions[s->priority_index].attenuates)
            continue;
        t->media->dims = true;
        const vec3 a = absorption_coefficients(p, s->priority_index, sample_keys[s->ray]);
        t->media->transmittance[0][s->ray] += a.x * s->length;
        t->media->transmittance[1][s->ray] += a.y * s->length;
        t->media->transmittance[2][s->ray] += a.z * s->length;
    }
    t->batch.scratch.segments->count = 0;
}

/* Removes absorption by the surrounding medium from segments longer than `length`. */
static void exempt(tracer *t, double length)
{
    for (int k = 0; k < t->batch.scratch.segments->count; k++) {
        medium_segment *s = &t->batch.scratch.segments->segment[k];
        if (s->priority_index == 0 && s->length > length)
            s->length = 0.0;
    }
}

/* A length that only the last segment to a sun exceeds. */
static double sun_leg(const tracer *t)
{
    return 0.5 * t->target.frame_plan->sun_distance;
}

/* Empties the list of segments when it is full. Segments to the sky and to suns are exempt, as at the end of the
 * search; they are recognised by their length. */
static void make_room(void *context)
{
    tracer *t = context;
    exempt(t, t->media->to_lamps ? sun_leg(t) : 1e100); /* paths that leave the scene have 1e120 (medium_segment) */
    if (t->media->flights.flying)
        follow_segments(t);
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
    const plan *p = t->target.frame_plan;
    t->media->sample_keys = q->sample_key + first;
    t->media->to_lamps = q == &t->queues.shadows;
    t->media->dims = false;
    /* distances along a ray are sums of its segments where free flights, sheets, and lights with a size end it */
    t->media->segments.all = p->scatter || p->sheets || integrator_traits_of(&p->render)->by_chance;
    t->media->flights.flies = t->media->flights.flying = false;
    t->batch.scratch.segments->full = make_room;
    t->batch.scratch.segments->context = t;
    /* optical depths at first */
    for (int i = 0; i < count; i++)
        t->media->transmittance[0][i] = t->media->transmittance[1][i] = t->media->transmittance[2][i] = 0.0;
    sheets_announce(t, q, first, count);
}

/* A depth of 0 becomes a transmittance of exactly 1. */
static void apply_transmittances(tracer *t, int count)
{
    add_depths(t);
    for (int c = 0; c < 3; c++) {
        if (t->media->dims)
            t->shade->absorb(t->media->transmittance[c], count);
        else
            for (int i = 0; i < count; i++)
                t->media->transmittance[c][i] = 1.0;
    }
    if (t->target.frame_plan->sheets)
        sheets_leave(t, count, t->media->transmittance);
}

/* A path to the sky has no finite length: its light is assumed to arrive unattenuated at the surface where the path
 * starts. */
void absorption_exempt_sky(tracer *t)
{
    const plan *p = t->target.frame_plan;
    for (int k = 0; p->geometry->regions[0].attenuates && k < t->batch.scratch.segments->count; k++) {
        medium_segment *s = &t->batch.scratch.segments->segment[k];
        const bool surrounding = s->priority_index == 0 || p->geometry->regions[s->priority_index].partial;
        if (surrounding && t->batch.hits.hit_primitive[s->ray] == -1)
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
    apply_transmittances(t, count);
    for (int i = 0; t->media->dims && i < count; i++) {
        q->wr[first + i] *= t->media->transmittance[0][i];
        q->wg[first + i] *= t->media->transmittance[1][i];
        q->wb[first + i] *= t->media->transmittance[2][i];
    }
    if (t->target.frame_plan->sheets)
        sheets_store(t, q, first, count);
}
