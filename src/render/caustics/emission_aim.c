/* Where photons start towards: balls around what deflects light, the cones of each lamp around these, and the lamps'
 * shares of the photons. */
#include "render/caustics/emission_parts.h"

#include "geometry/shapes/shape.h"

#include <stdlib.h>

/* --- what deflects light --- */

static bool deflects(const plan *p, int priority_index)
{
    const region_materials *m = &p->shading_materials[priority_index];
    bool any = !p->geometry->regions[priority_index].opaque;
    for (int k = 0; k < m->count; k++)
        any |= m->mat[k].surface.reflectivity > 0.0 || m->mat[k].surface.transparency > 0.0 ||
               material_is_layered(&m->mat[k].surface, &p->render);
    return any;
}

static ball ball_of(const solid_shape *shape)
{
    const bounds3 box = shape_world_box(shape);
    const vec3 half = vec3_scale(vec3_sub(box.high, box.low), 0.5);
    const bool bounded = vec3_is_finite(half);
    return (ball){bounded ? vec3_add(box.low, half) : vec3_make(0.0, 0.0, 0.0),
                  bounded ? vec3_length(half) : (double)INFINITY};
}

/* A ball that holds two. */
static ball joined(ball a, ball b)
{
    const vec3 off = vec3_sub(b.centre, a.centre);
    const double d = vec3_length(off);
    if (d + b.radius <= a.radius || isinf(a.radius))
        return a;
    if (d + a.radius <= b.radius || isinf(b.radius))
        return b;
    const double radius = 0.5 * (d + a.radius + b.radius);
    return (ball){vec3_add(a.centre, vec3_scale(off, (radius - a.radius) / d)), radius};
}

static void find_balls(emission *e)
{
    const plan *p = e->p;
    bool many = false;
    for (int r = 1; r <= p->geometry->region_count; r++) {
        if (!deflects(p, r))
            continue;
        const ball one = ball_of(&p->geometry->shapes[r]);
        many |= e->ball_count == CONES_MAX;
        if (many) /* from now on all are in the first */
            for (; e->ball_count > 1; e->ball_count--)
                e->balls[0] = joined(e->balls[0], e->balls[e->ball_count - 1]);
        if (many)
            e->balls[0] = joined(e->balls[0], one);
        else
            e->balls[e->ball_count++] = one;
    }
    for (int k = 0; k < e->ball_count; k++)
        e->extent = fmax(e->extent, isinf(e->balls[k].radius) ? p->geometry->extent : e->balls[k].radius);
}

/* --- lamps --- */

/* Around all directions from the lamp's points to the ball's. */
static cone cone_to(vec3 from, double lamp_radius, ball b)
{
    const vec3 to = vec3_sub(b.centre, from);
    const double d = vec3_length(to), sine = (b.radius + lamp_radius) / d;
    if (!(sine < 1.0))
        return (cone){vec3_make(0.0, 1.0, 0.0), 2.0, 0.0};
    /* 1 - cos = sin^2 / (1 + cos), without cancellation; widened beyond its rounding */
    return (cone){vec3_scale(to, 1.0 / d), (1.0 + 1e-9) * sine * sine / (1.0 + sqrt(1.0 - sine * sine)), 0.0};
}

/* The flux of a sun through these discs, over that of a lamp of intensity 1 and reach 1 into a unit of solid angle: the
 * discs' area. As aim below. */
static double aim_sun(emission *e, int lamp)
{
    const light *l = &e->p->lights[lamp];
    const light_cone *c = &e->p->cones[lamp];
    lamp_emission *out = &e->lamps[lamp];
    double sum = 0.0;
    for (int k = 0; k < e->ball_count; k++) {
        const double radius = sunlit_ball(e, k).radius;
        sum += radius * radius;
        out->cones[k] = (cone){c->axis, e->sizes ? c->opening : 0.0, radius * radius};
    }
    for (int k = 0; k < e->ball_count; k++)
        out->cones[k].share /= sum;
    return l->intensity * fmax(l->color.x, fmax(l->color.y, l->color.z)) * 0.5 * sum; /* over 2 pi, as there */
}

/* The lamp's brightness times the solid angle of its cones: its photons are in proportion. */
static double aim(emission *e, int lamp)
{
    const light *l = &e->p->lights[lamp];
    lamp_emission *out = &e->lamps[lamp];
    double sum = 0.0;
    if (is_sun(e, lamp))
        return aim_sun(e, lamp);
    for (int k = 0; k < e->ball_count; k++)
        sum += (out->cones[k] = cone_to(l->position, e->sizes ? light_extent(l) : 0.0, e->balls[k])).cap;
    for (int k = 0; k < e->ball_count; k++)
        out->cones[k].share = out->cones[k].cap / sum;
    out->inside = scene_geometry_inside(e->p->geometry, l->position);
    const double distance2 =
                     vec3_dot(vec3_sub(l->position, e->balls[0].centre), vec3_sub(l->position, e->balls[0].centre)),
                 extent = e->p->geometry->extent,
                 falloff = l->reach > 0.0              ? l->reach * l->reach
                           : isinf(e->balls[0].radius) ? extent * extent
                                                       : distance2;
    return l->intensity * fmax(l->color.x, fmax(l->color.y, l->color.z)) * falloff * sum;
}

/* power: of lamps, then of beams. */
static void divide(emission *e, const double *power, int64_t photons)
{
    const int lamps = e->p->light_count, sources = lamps + e->p->beam_count;
    double all = 0.0, so_far = 0.0;
    for (int k = 0; k < sources; k++)
        all += power[k];
    for (int k = 0; k < sources && all > 0.0; k++) {
        int64_t *first = k < lamps ? &e->lamps[k].first : &e->beams[k - lamps].first,
                *count = k < lamps ? &e->lamps[k].count : &e->beams[k - lamps].count;
        so_far += power[k];
        *first = e->count;
        e->count = (int64_t)(so_far / all * (double)photons + 0.5);
        *count = e->count - *first;
    }
}

status emission_create(const plan *p, int64_t photons, bool sizes, emission **out, diagnostic *why)
{
    emission *e = calloc(1, sizeof *e);
    double *power = calloc((size_t)p->light_count + (size_t)p->beam_count + 1, sizeof *power);
    *out = e;
    if (e) {
        e->p = p; /* which emission_destroy needs */
        e->lamps = calloc((size_t)p->light_count + 1, sizeof *e->lamps);
        e->beams = calloc((size_t)p->beam_count + 1, sizeof *e->beams);
    }
    if (!e || !power || !e->lamps || !e->beams)
        goto failed;
    e->sizes = sizes;
    find_balls(e);
    for (int k = 0; k < p->light_count && e->ball_count > 0; k++) {
        if (!(e->lamps[k].cones = calloc((size_t)e->ball_count, sizeof(cone))))
            goto failed;
        power[k] = aim(e, k);
    }
    status code = emission_prepare_beams(e, power + p->light_count, why);
    if (code == STATUS_OK)
        divide(e, power, photons);
    free(power);
    if (code != STATUS_OK) {
        emission_destroy(e);
        *out = NULL;
    }
    return code;
failed:
    free(power);
    emission_destroy(e);
    *out = NULL;
    return out_of_memory(why);
}

void emission_destroy(emission *e)
{
    if (!e)
        return;
    for (int k = 0; e->lamps && k < e->p->light_count; k++)
        free(e->lamps[k].cones);
    free(e->lamps);
    free(e->beams);
    free(e);
}

int64_t emission_count(const emission *e)
{
    return e->count;
}

double emission_extent(const emission *e)
{
    return e->extent;
}
