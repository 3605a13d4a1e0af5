/* Real rays: the tracer's path through the scene, read as the sequence of the prescription's surfaces. */
#include "lens/lens_private.h"

#include "scene/model/medium.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include <math.h>

/* A hit belongs to a surface if it is this close to it, mm per mm of its distance from the vertex. */
#define ON_SURFACE 1e-8

/* --- the bench --- */

status lens_bench_open(const lens_model *m, const lens_place *at, isa level, lens_bench *out, diagnostic *why)
{
    *out = (lens_bench){.m = m, .at = at};
    scene *copy = scene_clone(at->s);
    if (!copy)
        return out_of_memory(why);
    use_whitted(&copy->render);
    copy->render.lambda_nm = m->lambda_nm;
    copy->render.min_weight = 0.0;
    copy->render.spectrum = SPECTRUM_RGB;
    copy->render.polarisation = 0;
    const index_law around = surrounding_index_law(&copy->background);
    out->around = index_law_at(&around, m->lambda_nm);
    const status code = probe_create(copy, level, &out->p, why);
    scene_destroy(copy);
    if (code == STATUS_OK)
        probe_use_one_wavelength(out->p);
    if (code == STATUS_OK)
        probe_limit_depth(out->p, 4 * m->count + 16, "give a lens of fewer surfaces");
    return code;
}

void lens_bench_close(lens_bench *b)
{
    ray_tree_release(&b->tree);
    probe_destroy(b->p);
    *b = (lens_bench){0};
}

static vec3 turned(const lens_place *at, vec3 v)
{
    return vec3_add(vec3_add(vec3_scale(at->across, v.x), vec3_scale(at->up, v.y)), vec3_scale(at->along, v.z));
}

static vec3 turned_back(const lens_place *at, vec3 v)
{
    return vec3_make(vec3_dot(v, at->across), vec3_dot(v, at->up), vec3_dot(v, at->along));
}

static vec3 local_point(const lens_place *at, vec3 p)
{
    return vec3_scale(turned_back(at, vec3_sub(p, at->origin)), 1.0 / at->scale);
}

/* --- surfaces --- */

/* The distance along a line to a surface: that to its conic, by the quadratic's root near the vertex (Spencer and
 * Murty, J. Opt. Soc. Am. 52, 672, 1962), then Newton's method for its coefficients; NaN if there is none. */
static double meet(const lens_step *s, vec3 o, vec3 d)
{
    const double k = 1.0 + s->k, z = o.z - s->z;
    const double A = s->c * (d.x * d.x + d.y * d.y + k * d.z * d.z);
    const double B = d.z - s->c * (o.x * d.x + o.y * d.y + k * z * d.z);
    const double C = s->c * (o.x * o.x + o.y * o.y + k * z * z) - 2.0 * z;
    double t = C / (B + copysign(sqrt(B * B - A * C), d.z));
    const bool aspheric = asphere_has_terms(&s->shape);
    if (!isfinite(t))
        t = aspheric ? -(o.z - s->z) / d.z : t; /* the conic does not reach there */
    for (int i = 0; i < 50 && aspheric; i++) {
        const vec3 p = vec3_add(o, vec3_scale(d, t));
        double by_x, by_y;
        const double off = p.z - s->z - lens_height(s, p.x, p.y, &by_x, &by_y);
        const double step = off / (d.z - (by_x * d.x + by_y * d.y));
        t -= step;
        if (!(fabs(step) > 1e-15 * (1.0 + fabs(t))))
            break;
    }
    return t;
}

static bool is_on(const lens_step *s, vec3 p)
{
    const vec3 way = vec3_sub(p, vec3_make(0.0, 0.0, s->z));
    if (s->folds)
        return fabs(vec3_dot(way, s->normal)) <= ON_SURFACE * (1.0 + vec3_length(way)) &&
               vec3_length(way) <= s->clear * (1.0 + 1e-12);
    const double rho = hypot(p.x, p.y);
    double by_x, by_y;
    const double off = p.z - s->z - lens_height(s, p.x, p.y, &by_x, &by_y);
    return fabs(off) <= ON_SURFACE * (1.0 + rho) && rho <= s->clear * (1.0 + 1e-12);
}

/* --- the path --- */

typedef struct walk {
    const lens_bench *b;
    lens_place at; /* of the part of the axis behind the last fold */
    size_t node;
    lens_ray *out;
} walk;

static vec3 node_origin(const walk *w)
{
    return local_point(&w->at, w->b->tree.node[w->node].origin);
}

/* Moves to the next node, which must continue as expected. */
static bool go_on(walk *w, bool mirror)
{
    const ray_node *now = &w->b->tree.node[w->node];
    w->out->path += now->n / w->b->around * (now->hit.t / w->b->at->scale);
    w->out->media *= now->hit.transmittance[0];
    w->node++;
    if (w->node >= w->b->tree.count)
        return false;
    const ray_node *next = &w->b->tree.node[w->node];
    return next->kind == (mirror ? RAY_REFLECT : RAY_REFRACT) && (next->end == RAY_END_HIT || next->end == RAY_END_SKY);
}

/* A surface that does nothing: the scene may have an interface there, between equal media, or none. */
static bool pass_silent(walk *w, int i)
{
    const ray_node *now = &w->b->tree.node[w->node];
    const vec3 o = node_origin(w), d = w->out->along[i];
    const double t = meet(&w->b->m->step[i], o, d);
    w->out->hit[i] = vec3_add(o, vec3_scale(d, t));
    if (!isfinite(t))
        return false;
    if (now->end != RAY_END_HIT)
        return true;
    const double reach = now->hit.t / w->b->at->scale;
    if (fabs(reach - t) > ON_SURFACE * (1.0 + fabs(t)))
        return reach > t; /* else a mount is before it */
    return !now->hit.opaque && go_on(w, false);
}

/* The rest of the system, as if the mirror was not tilted. */
static void fold(walk *w, const lens_step *s)
{
    lens_place *at = &w->at;
    const lens_place before = *at;
    const mat3 *q = &s->turn;
    const vec3 vertex = vec3_add(before.origin, vec3_scale(before.along, before.scale * s->z));
    at->across = turned(&before, vec3_make(q->row[0].x, q->row[1].x, q->row[2].x));
    at->up = turned(&before, vec3_make(q->row[0].y, q->row[1].y, q->row[2].y));
    at->along = turned(&before, vec3_make(q->row[0].z, q->row[1].z, q->row[2].z));
    at->origin = vec3_sub(vertex, vec3_scale(at->along, at->scale * s->z));
}

/* After its reflection in the unfolded plane a ray is where the tilted mirror sends it: both are the same isometry. */
static bool pass_fold(walk *w, int i)
{
    const lens_step *s = &w->b->m->step[i];
    const vec3 o = node_origin(w), d = w->out->along[i], p = local_point(&w->at, w->b->tree.node[w->node].hit.point);
    const double t = meet(s, o, d);
    w->out->hit[i] = vec3_add(o, vec3_scale(d, t));
    if (!is_on(s, p) || !go_on(w, true))
        return false;
    fold(w, s);
    return true;
}

static bool pass(walk *w, int i)
{
    const lens_step *s = &w->b->m->step[i];
    const ray_node *now = &w->b->tree.node[w->node];
    w->out->along[i] = turned_back(&w->at, now->direction);
    if (s->silent)
        return pass_silent(w, i);
    if (now->end != RAY_END_HIT)
        return false;
    if (s->folds)
        return pass_fold(w, i);
    w->out->hit[i] = local_point(&w->at, now->hit.point);
    return is_on(s, w->out->hit[i]) && go_on(w, s->mirror);
}

static bool reach_image(walk *w)
{
    const lens_model *m = w->b->m;
    const ray_node *now = &w->b->tree.node[w->node];
    const lens_step screen = {.c = m->image_c, .z = m->z_image, .shape = asphere_of(m->image_c, 0.0, NULL)};
    const vec3 o = node_origin(w), d = turned_back(&w->at, now->direction);
    const double t = meet(&screen, o, d);
    w->out->along[m->count] = w->out->direction = d;
    w->out->image = vec3_add(o, vec3_scale(d, t));
    w->out->path += now->n / w->b->around * t;
    const double reach = now->end == RAY_END_HIT ? now->hit.t / w->b->at->scale : INFINITY;
    return isfinite(t) && reach >= t - 1e-6 * (1.0 + fabs(t));
}

status lens_ray_trace(lens_bench *b, vec3 from, vec3 along, lens_ray *out, diagnostic *why)
{
    const lens_model *m = b->m;
    out->start = from, out->launched = along, out->path = 0.0, out->loss = LENS_LOST_EARLY;
    out->surfaces = out->media = 1.0;
    out->stop_x = out->stop_y = NAN;
    TRY(probe_path(b->p, vec3_add(b->at->origin, turned(b->at, vec3_scale(from, b->at->scale))), turned(b->at, along),
                   -1, &b->tree, why));
    walk w = {b, *b->at, 0, out};
    for (int i = 0; i < m->count; i++) {
        const ray_hit *hit = &b->tree.node[w.node].hit;
        b->R[i] = m->step[i].silent ? 0.0 : hit->R;
        b->T[i] = m->step[i].silent ? 1.0 : hit->T;
        out->surfaces *= m->step[i].mirror ? b->R[i] : b->T[i];
        const bool passes = pass(&w, i);
        if (i == m->stop && (passes || m->step[i].silent))
            out->stop_x = out->hit[i].x, out->stop_y = out->hit[i].y, out->loss = LENS_LOST;
        out->lost_at = i;
        if (!passes)
            return STATUS_OK;
    }
    out->lost_at = m->count;
    if (reach_image(&w))
        out->loss = LENS_PASSES;
    return STATUS_OK;
}

status lens_reflectances_back(lens_bench *b, double R[LENS_SURFACES_MAX], diagnostic *why)
{
    const lens_model *m = b->m;
    const double last = m->step[m->count - 1].z, start = last + 0.5 * (m->z_image - last);
    const vec3 from = vec3_scale(b->at->along, b->at->scale * start), back = vec3_scale(b->at->along, -1.0);
    TRY(probe_path(b->p, vec3_add(b->at->origin, from), back, -1, &b->tree, why));
    size_t node = 0;
    for (int i = m->count - 1; i >= 0; i--) {
        R[i] = 0.0;
        for (; node < b->tree.count && b->tree.node[node].end == RAY_END_HIT; node++) {
            const ray_hit *hit = &b->tree.node[node].hit;
            const double off = local_point(b->at, hit->point).z - m->step[i].z;
            if (off < -ON_SURFACE)
                break;
            if (off <= ON_SURFACE && !m->step[i].silent)
                R[i] = hit->R;
        }
    }
    return STATUS_OK;
}
