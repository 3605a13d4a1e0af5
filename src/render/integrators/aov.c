/* Layers of camera rays' first hits ("arbitrary output variables", AOVs): one ray through the middle of each pixel, to
 * the nearest interface, with these values of the hit point:
 *   normal    the unit normal towards the ray, interpolated on a smooth mesh
 *   albedo    the surface's colour C, with its checker and texture; linear RGB
 *   depth     the distance along the ray, scene units
 *   solid     the solid whose surface was hit: 1 for the first of the scene
 *   material  1 for the scene's first; a solid's own surface has the number of materials plus the solid's number
 *   position  the point, scene units
 * and 0 in all of them for a miss. The film shows one of them, render.layer, as an image: normals as (n + 1) / 2, as
 * normal maps do; depths d as s / (s + d), with s the mean distance of the solids, and positions likewise, 1/2 at 0;
 * numbers as distinct colours. */
#include "geometry/shapes/shape.h"
#include "image/image.h"
#include "render/shade/exposure.h"
#include "render/shade/shading.h"
#include "render/tracer/tracer.h"
#include <math.h>
#include <stdlib.h>

static camera_sampling one_ray(const render_settings *r)
{
    (void)r;
    return (camera_sampling){.rays = 1, .points = 1, .rays_per_point = 1};
}

/* --- state of a frame: the length scale of depth and position views --- */

static status prepare(const plan *p, void **frame, diagnostic *why)
{
    double *scale = malloc(sizeof *scale), sum = 0.0;
    int count = 0;
    if (!scale)
        return out_of_memory(why);
    for (int i = 0; i < p->geometry->primitive_count; i += p->geometry->primitives[i].rows) {
        const primitive *one = &p->geometry->primitives[i];
        if (shape_of(&p->geometry->shapes[p->geometry->origins[one->priority_index].source])->unbounded)
            continue;
        sum += vec3_length(vec3_sub(one->origin, p->view.eye));
        count++;
    }
    *scale = sum > 0.0 ? sum / count : 1.0;
    *frame = scale;
    return STATUS_OK;
}

/* --- views: linear light whose sRGB encoding is the intended value --- */

static double shown(double fraction)
{
    return srgb_decode(fmin(fmax(fraction, 0.0), 1.0));
}

/* Hues that differ by a golden section of the circle: numbers close to each other get distinct colours. */
static vec3 color_of(double number)
{
    const double turns = 0.618033988749895 * number, hue = 6.0 * (turns - floor(turns));
    double rgb[3];
    for (int c = 0; c < 3; c++) {
        const double from = fabs(fmod(hue + 2.0 * c, 6.0) - 3.0) - 1.0;
        rgb[c] = shown(0.25 + 0.7 * (from < 0.0 ? 0.0 : from > 1.0 ? 1.0 : from));
    }
    return vec3_make(rgb[0], rgb[1], rgb[2]);
}

static double signed_fraction(double x, double scale)
{
    return shown(0.5 + 0.5 * x / (scale + fabs(x)));
}

static vec3 view_of(layer_rule layer, vec3 v, double scale)
{
    switch (layer) {
    case LAYER_NORMAL: return vec3_make(shown(0.5 + 0.5 * v.x), shown(0.5 + 0.5 * v.y), shown(0.5 + 0.5 * v.z));
    case LAYER_DEPTH: {
        const double near = shown(scale / (scale + v.x));
        return vec3_make(near, near, near);
    }
    case LAYER_SOLID:
    case LAYER_MATERIAL: return color_of(v.x);
    case LAYER_POSITION:
        return vec3_make(signed_fraction(v.x, scale), signed_fraction(v.y, scale), signed_fraction(v.z, scale));
    case LAYER_ALBEDO:
    case LAYER_COUNT: break;
    }
    return v;
}

/* --- a batch --- */

static vec3 value_of(const tracer *t, layer_rule layer, int priority_index, int k)
{
    const group *g = &t->surface.gathered;
    const surface_batch *s = &g->points;
    switch (layer) {
    case LAYER_NORMAL: return vec3_make(s->nx[k], s->ny[k], s->nz[k]);
    case LAYER_ALBEDO: return vec3_make(g->cr[k], g->cg[k], g->cb[k]);
    case LAYER_DEPTH: return vec3_make(g->t[k], 0.0, 0.0);
    case LAYER_SOLID: return vec3_make(t->target.frame_plan->geometry->regions[priority_index].solid + 1.0, 0.0, 0.0);
    case LAYER_MATERIAL: return vec3_make(t->surface.mat->number, 0.0, 0.0);
    case LAYER_POSITION: return vec3_make(s->px[k], s->py[k], s->pz[k]);
    case LAYER_COUNT: break;
    }
    return vec3_make(0.0, 0.0, 0.0);
}

static void shade(tracer *t, int depth, int priority_index)
{
    const group *g = &t->surface.gathered;
    const layer_rule show = (layer_rule)t->target.frame_plan->render.layer;
    const double *scale = t->target.state;
    (void)depth;
    for (int layer = 0; layer < LAYER_COUNT; layer++) {
        if (!t->target.layers && layer != (int)show)
            continue;
        for (int k = 0; k < g->count; k++) {
            const vec3 value = value_of(t, (layer_rule)layer, priority_index, k);
            if (t->target.layers)
                layers_put(t->target.layers, (layer_rule)layer, sample_key_pixel(g->sample_key[k]), value);
            if (layer != (int)show)
                continue;
            const vec3 view = view_of(show, value, *scale);
            shading_expose(t, g->sample_key[k], view.x, view.y, view.z);
        }
    }
}

/* A miss: all values stay 0. */
static void leave_empty(tracer *t, const ray_queue *q, int first, const int *list, int count)
{
    (void)t, (void)q, (void)first, (void)list, (void)count;
}

const integrator integrator_of_aov = {.traced = true,
                                      .by_solid = true,
                                      .sampling = one_ray,
                                      .prepare = prepare,
                                      .release = free,
                                      .intersect = intersect_nearest,
                                      .background = leave_empty,
                                      .shade = shade};
