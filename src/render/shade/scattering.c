/* Free flights in media that scatter. */
#include "render/shade/scattering.h"

#include "geometry/shapes/shape.h"
#include "render/shade/airlight.h"
#include "render/shade/path_kernels.h"
#include "render/shade/shading.h"
#include "scene/model/scene.h"

#include <stdlib.h>

static void find_lamps(const scene *s, scatter_plan *of)
{
    if (s->render.light_sampling == LIGHT_SAMPLING_ONE && s->light_count > 1)
        return;
    for (size_t i = 0; i < s->light_count && of->lamp_count < AIRLIGHTS_MAX; i++)
        if (light_extent(&s->lights[i]) == 0.0 && s->lights[i].kind != LIGHT_SUN && s->lights[i].intensity > 0.0)
            of->lamps[of->lamp_count++] = (int)i;
}

static void join(bounds3 *a, bounds3 b)
{
    a->low = vec3_make(fmin(a->low.x, b.low.x), fmin(a->low.y, b.low.y), fmin(a->low.z, b.low.z));
    a->high = vec3_make(fmax(a->high.x, b.high.x), fmax(a->high.y, b.high.y), fmax(a->high.z, b.high.z));
}

static void add_box(scatter_plan *of, bounds3 around, bool many)
{
    if (of->box_count == 0 || !many)
        of->boxes[of->box_count++] = around;
    else
        join(&of->boxes[0], around);
}

static int media_that_scatter(const scene *s, const scene_geometry *geometry)
{
    int count = 0;
    for (int r = 1; r <= geometry->region_count; r++)
        count += !geometry->regions[r].opaque &&
                 material_scattering(&s->solids[geometry->regions[r].solid].surface, &s->render) > 0.0;
    return count;
}

bool scatter_plan_create(const scene *s, const scene_geometry *geometry, scatter_plan **out)
{
    const int count = media_that_scatter(s, geometry);
    *out = NULL;
    if (count == 0)
        return true;
    scatter_plan *of = calloc(1, sizeof *of + ((size_t)geometry->region_count + 1) * sizeof of->region[0]);
    if (!of)
        return false;
    for (int r = 1; r <= geometry->region_count; r++) {
        const material *m = &s->solids[geometry->regions[r].solid].surface;
        const double per_m = geometry->regions[r].opaque ? 0.0 : material_scattering(m, &s->render);
        if (per_m == 0.0)
            continue;
        of->region[r] = (region_scatter){.per_unit = per_m * s->render.unit_m, .asymmetry = m->asymmetry};
        add_box(of, shape_world_box(&geometry->shapes[r]), count > SCATTER_BOXES_MAX);
    }
    find_lamps(s, of);
    *out = of;
    return true;
}

void scattering_begin(tracer *t, const ray_queue *q, int first, int depth, int count)
{
    const double ln_2 = 0.69314718055994530942;
    flight_work *w = &t->media->flights;
    double unused[ROW];
    t->path->draw(&t->target.frame_plan->draws, count, q->sample_key + first, depth, DRAW_FLIGHT, w->u, unused);
    for (int i = 0; i < count; i++) {
        w->left[i] = -ln_2 * elementary_log2_inline(w->u[i]);
        w->passed[i] = 0.0;
        w->end[i] = (double)INFINITY;
        w->region[i] = 0;
        for (int c = 0; c < 4; c++)
            w->depth[c][i] = 0.0;
    }
    if (t->target.frame_plan->sheets)
        sheets_begin(t, &w->sheets, q, first, count);
    airlight_choose(t, q, first, depth, count);
    w->flies = w->flying = true;
}

/* A segment of a ray, up to where it scatters. */
static void fly(flight_work *w, double per_unit, medium_segment *s)
{
    const int i = s->ray;
    const double thickness = per_unit * s->length;
    if (thickness > w->left[i]) {
        s->length = w->left[i] / per_unit;
        w->end[i] = w->passed[i] + s->length;
        w->region[i] = s->priority_index;
    }
    w->left[i] -= thickness;
}

void scattering_take(tracer *t)
{
    const scatter_plan *of = t->target.frame_plan->scatter;
    flight_work *w = &t->media->flights;
    medium_segments *list = &t->media->segments;
    int kept = 0;
    for (int k = 0; k < list->count; k++) {
        medium_segment s = list->segment[k];
        const double passed = w->passed[s.ray], length = s.length;
        const bool over = w->end[s.ray] < (double)INFINITY;
        airlight_follow(t, &s);
        if (!over) {
            fly(w, of->region[s.priority_index].per_unit, &s);
            list->segment[kept++] = s;
        }
        w->passed[s.ray] = passed + length;
    }
    list->count = kept;
}

void scattering_end(tracer *t)
{
    scattering_take(t);
    t->media->flights.flying = false;
}
