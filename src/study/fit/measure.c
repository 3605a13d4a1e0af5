/* Measures the quantities of a fit: one scene for each different setting of the targets, with one frame, one tracing of
 * beams and one measurement of metrics at most. */
#include "base/array.h"
#include "base/number.h"
#include "realism/realism.h"
#include "render/inspect/beams.h"
#include "render/plan/film.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/fit/fit.h"
#include "study/plan/grid.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- the scene at a point --- */

static status drive(scene *s, const fit_parameter *p, const fit_drive *d, double x, diagnostic *why)
{
    char text[NUMBER_TEXT_MAX];
    double value = d->offset + d->factor * x;
    if (p->reciprocal) {
        param_place at;
        TRY(param_place_find(s, d->path, &at, why));
        const bool flat = !(fabs(1.0 / value) <= fmin(at.row->highest, -at.row->lowest));
        value = flat ? 0.0 : 1.0 / value;
    }
    return scene_set(s, d->path, number_format(value, text), why);
}

status fit_scene(const fit *f, const double *x, size_t setting, scene **out, diagnostic *why)
{
    scene *s = scene_clone(f->s->base);
    status code = s ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; i < f->parameter_count; i++)
        for (size_t k = 0; k < f->parameters[i].drive_count; k++)
            THEN(code, drive(s, &f->parameters[i], &f->parameters[i].drives[k], x[i], why));
    THEN(code, study_point_apply(&f->settings[setting], s, why));
    if (code != STATUS_OK) {
        scene_destroy(s);
        s = NULL;
    }
    *out = s;
    return code;
}

/* --- beams --- */

/* The line of a ray's last segment, which meets the screen at u, v with the slopes du, dv along its normal; and the
 * offset of its start from the beam's. */
typedef struct spot_ray {
    double weight, u, v, du, dv, start_u, start_v;
} spot_ray;

typedef struct spot {
    const fit_measure *m;
    vec3 e_u, e_v;
    spot_ray *rays;
    size_t count, room;
    double power, received;
} spot;

typedef struct spots {
    const scene *s;
    spot *spot;
    size_t count;
} spots;

/* The end of the refracted path; of the reflected one at a mirror. */
static const ray_node *last_segment(const ray_tree *tree)
{
    int at = 0;
    for (;;) {
        int next = RAY_NONE;
        for (int child = tree->node[at].first_child; child != RAY_NONE; child = tree->node[child].next)
            if (tree->node[child].kind == RAY_REFRACT || (tree->node[child].kind == RAY_REFLECT && next == RAY_NONE))
                next = child;
        if (next == RAY_NONE)
            return &tree->node[at];
        at = next;
    }
}

static bool is_chosen(const fit_measure *m, const beam_ray *ray)
{
    return (m->beams[ray->beam / 64] >> ray->beam % 64 & 1) &&
           (m->lambda_nm == 0.0 || fabs(ray->lambda_nm - m->lambda_nm) < 1e-6);
}

static status add_ray(spot *to, const scene *s, const beam_ray *ray, const ray_tree *tree, diagnostic *why)
{
    const ray_node *last = last_segment(tree);
    const fit_measure *m = to->m;
    const vec3 from = vec3_sub(last->origin, m->at);
    const vec3 start = vec3_sub(tree->node[0].origin, s->beams[ray->beam].position);
    const double along = vec3_dot(last->direction, m->normal), t = -vec3_dot(from, m->normal) / along;
    const bool arrives = last->end == RAY_END_SKY || (last->end == RAY_END_HIT && t <= last->hit.t);
    to->power += ray->power;
    if (!arrives || along == 0.0 || !isfinite(t))
        return STATUS_OK;
    if (!GROW(to->rays, to->room, to->count + 1))
        return out_of_memory(why);
    const vec3 at = vec3_add(from, vec3_scale(last->direction, t));
    to->rays[to->count++] = (spot_ray){.weight = ray->power,
                                       .u = vec3_dot(at, to->e_u),
                                       .v = vec3_dot(at, to->e_v),
                                       .du = vec3_dot(last->direction, to->e_u) / along,
                                       .dv = vec3_dot(last->direction, to->e_v) / along,
                                       .start_u = vec3_dot(start, to->e_u),
                                       .start_v = vec3_dot(start, to->e_v)};
    to->received += ray->power * beam_fraction(last);
    return STATUS_OK;
}

static status visit_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    const spots *all = context;
    (void)p;
    for (size_t i = 0; i < all->count; i++)
        if (is_chosen(all->spot[i].m, ray))
            TRY(add_ray(&all->spot[i], all->s, ray, tree, why));
    return STATUS_OK;
}

/* The mean ray, which is then subtracted from all: squares of differences from the mean lose no digits. */
static spot_ray centre(spot *s)
{
    spot_ray mean = {.weight = 0};
    for (size_t i = 0; i < s->count; i++)
        mean.weight += s->rays[i].weight;
    for (size_t i = 0; i < s->count; i++) {
        const spot_ray *r = &s->rays[i];
        const double w = r->weight / mean.weight;
        mean.u += w * r->u, mean.v += w * r->v, mean.du += w * r->du, mean.dv += w * r->dv;
        mean.start_u += w * r->start_u, mean.start_v += w * r->start_v;
    }
    for (size_t i = 0; i < s->count; i++) {
        spot_ray *r = &s->rays[i];
        r->weight /= mean.weight;
        r->u -= mean.u, r->v -= mean.v, r->du -= mean.du, r->dv -= mean.dv;
        r->start_u -= mean.start_u, r->start_v -= mean.start_v;
    }
    return mean;
}

/* The weighted mean square distance at the distance z from the screen; of the centred rays. */
static double mean_square(const spot *s, double z)
{
    double sum = 0.0;
    for (size_t i = 0; i < s->count; i++) {
        const double u = s->rays[i].u + z * s->rays[i].du, v = s->rays[i].v + z * s->rays[i].dv;
        sum += s->rays[i].weight * (u * u + v * v);
    }
    return sum;
}

static double spot_value(spot *s)
{
    double slopes = 0.0, crossed = 0.0, started = 0.0, heights = 0.0, largest = 0.0;
    if (s->m->beam_quantity == FIT_RECEIVED)
        return s->received / s->power;
    if (s->count == 0)
        return NAN;
    const spot_ray mean = centre(s);
    for (size_t i = 0; i < s->count; i++) {
        const spot_ray *r = &s->rays[i];
        slopes += r->weight * (r->du * r->du + r->dv * r->dv);
        crossed += r->weight * (r->u * r->du + r->v * r->dv);
        started += r->weight * (r->start_u * r->du + r->start_v * r->dv);
        heights += r->weight * (r->start_u * r->start_u + r->start_v * r->start_v);
        largest = fmax(largest, hypot(r->u, r->v));
    }
    switch (s->m->beam_quantity) {
    case FIT_FOCUS: return slopes > 0.0 ? -crossed / slopes : NAN; /* where the mean square has its minimum */
    case FIT_FOCUS_RMS: return sqrt(mean_square(s, slopes > 0.0 ? -crossed / slopes : 0.0));
    case FIT_FOCAL_LENGTH: return slopes > 0.0 ? -started / slopes : NAN;
    case FIT_POWER: return heights > 0.0 ? 0.0 - started / heights : NAN;
    case FIT_SPOT_RMS: return sqrt(mean_square(s, 0.0));
    case FIT_SPOT_RADIUS: return largest;
    case FIT_SPOT_U: return mean.u;
    case FIT_SPOT_V: return mean.v;
    case FIT_RECEIVED:
    case FIT_BEAM_QUANTITY_COUNT: break;
    }
    return NAN;
}

/* --- one setting --- */

/* A measure, and where its value goes. */
typedef struct wanted {
    const fit_measure *m;
    double *value;
} wanted;

typedef struct wanted_list {
    wanted at[2 * FIT_TARGETS_MAX];
    size_t count;
} wanted_list;

static size_t count_of(const wanted_list *w, fit_source source)
{
    size_t count = 0;
    for (size_t i = 0; i < w->count; i++)
        count += w->at[i].m->source == source;
    return count;
}

static status measure_beams(const wanted_list *w, scene *s, isa level, diagnostic *why)
{
    spots all = {.s = s, .spot = calloc(w->count, sizeof(spot))};
    double *places[2 * FIT_TARGETS_MAX];
    status code = all.spot ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; i < s->beam_count; i++)
        s->beams[i].visible = 0;
    for (size_t i = 0; i < w->count && code == STATUS_OK; i++) {
        const fit_measure *m = w->at[i].m;
        if (m->source != FIT_BEAMS)
            continue;
        for (size_t b = 0; b < s->beam_count; b++)
            s->beams[b].visible |= (int64_t)(m->beams[b / 64] >> b % 64 & 1);
        const vec3 level_axis = vec3_cross(vec3_make(0, 1, 0), m->normal); /* as of a beam_screen */
        const vec3 e_u = vec3_length(level_axis) > 1e-9 ? vec3_normalize(level_axis) : vec3_make(1, 0, 0);
        places[all.count] = w->at[i].value;
        all.spot[all.count++] = (spot){.m = m, .e_u = e_u, .e_v = vec3_cross(m->normal, e_u)};
    }
    THEN(code, beams_each_ray(s, level, 0, visit_ray, &all, why));
    for (size_t i = 0; i < all.count; i++) {
        *places[i] = code == STATUS_OK ? spot_value(&all.spot[i]) : NAN;
        free(all.spot[i].rays);
    }
    free(all.spot);
    return code;
}

/* Measured one by one, since that ends with the metric; several metrics cost less together. */
enum { METRICS_ALONE = 4 };

/* The status of measuring a quantity; an error gets the place of its name. */
static status at_quantity(const fit *f, const fit_measure *m, status code, diagnostic *why)
{
    if (code == STATUS_BAD_INPUT)
        diagnostic_locate(why, f->s->path, m->line, m->column);
    return code;
}

static status find_metric(const realism_report *report, const char *name, double *out, diagnostic *why)
{
    for (int k = 0; k < report->count; k++)
        if (strcmp(report->value[k].metric, name) == 0) {
            *out = report->value[k].measured;
            return STATUS_OK;
        }
    return diagnose(why, STATUS_BAD_INPUT, "list the metrics with 'cuvette realism SCENE'",
                    "the scene has no metric '%.64s'", name);
}

static status measure_metrics(const fit *f, const wanted_list *w, const scene *s, isa level, diagnostic *why)
{
    const bool together = count_of(w, FIT_REALISM) > METRICS_ALONE;
    realism_report report = {.count = 1};
    if (together)
        TRY(realism_measure(s, level, &report, why));
    for (size_t i = 0; i < w->count; i++) {
        const fit_measure *m = w->at[i].m;
        if (m->source != FIT_REALISM)
            continue;
        if (!together)
            TRY(at_quantity(f, m, realism_measure_one(s, level, m->name, &report.value[0], why), why));
        TRY(at_quantity(f, m, find_metric(&report, m->name, w->at[i].value, why), why));
    }
    return STATUS_OK;
}

static double film_mean(const film *img, int x0, int y0, int x1, int y1, int channel)
{
    double sum = 0.0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            for (int k = channel < 0 ? 0 : channel; k <= (channel < 0 ? 2 : channel); k++)
                sum += film_value(img, x, y, k);
    return sum / ((double)(x1 - x0) * (y1 - y0) * (channel < 0 ? 3.0 : 1.0));
}

static status read_frame(const fit_measure *m, const job_account *a, double *out, diagnostic *why)
{
    const film *img = a->result->img;
    if (m->source == FIT_FRAME) {
        const quantity_value v = m->frame->read(a, -1);
        const bool listed = m->frame->type == QUANTITY_SOLIDS;
        const int64_t count = !listed ? v.count : (size_t)m->solid < v.size ? (int64_t)v.list[m->solid] : -1;
        *out = m->frame->type == QUANTITY_REAL ? v.real[0] : count < 0 ? NAN : (double)count;
        return STATUS_OK;
    }
    const int x = m->pixel[0], y = m->pixel[1];
    if (x >= img->width || y >= img->height)
        return diagnose(why, STATUS_BAD_INPUT, "choose a pixel of the image", "pixel %d,%d is outside the image", x, y);
    *out = x < 0 ? film_mean(img, 0, 0, img->width, img->height, m->channel)
                 : film_mean(img, x, y, x + 1, y + 1, m->channel);
    return STATUS_OK;
}

static status measure_frame(const fit *f, const wanted_list *w, const scene *s, job *frames, diagnostic *why)
{
    job_account a = {.result = NULL};
    status code = job_render(frames, s, NULL, &a, why);
    for (size_t i = 0; i < w->count; i++)
        if (w->at[i].m->source == FIT_FRAME || w->at[i].m->source == FIT_RADIANCE)
            THEN(code, at_quantity(f, w->at[i].m, read_frame(w->at[i].m, &a, w->at[i].value, why), why));
    job_account_release(&a);
    return code;
}

static status measure_setting(const fit *f, job *frames, const double *x, size_t setting, const wanted_list *w,
                              diagnostic *why)
{
    scene *s = NULL;
    status code = fit_scene(f, x, setting, &s, why);
    THEN(code, scene_check(s, why));
    THEN(code, job_load(frames, s, NULL, why));
    if (count_of(w, FIT_FRAME) + count_of(w, FIT_RADIANCE) > 0)
        THEN(code, measure_frame(f, w, s, frames, why));
    if (count_of(w, FIT_REALISM) > 0)
        THEN(code, measure_metrics(f, w, s, job_isa(frames), why));
    if (count_of(w, FIT_BEAMS) > 0)
        THEN(code, measure_beams(w, s, job_isa(frames), why)); /* last: it hides beams, which may light the scene */
    scene_destroy(s);
    return code;
}

/* --- all targets --- */

status fit_measure_at(const fit *f, job *frames, const double *x, double *values, diagnostic *why)
{
    double parts[2 * FIT_TARGETS_MAX];
    for (size_t setting = 0; setting < f->setting_count; setting++) {
        wanted_list w = {.count = 0};
        for (size_t i = 0; i < f->target_count; i++) {
            const fit_target *t = &f->targets[i];
            if (t->of.setting == setting)
                w.at[w.count++] = (wanted){&t->of, &parts[2 * i]};
            if (t->has_minus && t->minus.setting == setting)
                w.at[w.count++] = (wanted){&t->minus, &parts[2 * i + 1]};
        }
        if (w.count > 0)
            TRY(measure_setting(f, frames, x, setting, &w, why));
    }
    for (size_t i = 0; i < f->target_count; i++)
        values[i] = f->targets[i].has_minus ? parts[2 * i] - parts[2 * i + 1] : parts[2 * i];
    return STATUS_OK;
}

double fit_merit(const fit *f, const double *values)
{
    double sum = 0.0;
    for (size_t i = 0; i < f->target_count; i++) {
        const double off = values[i] - f->targets[i].value;
        sum += f->targets[i].weight * off * off;
    }
    return f->goal == FIT_TARGETS ? sum : f->goal == FIT_MINIMISE ? values[0] : -values[0];
}
