/* The targets of photons: bounding balls of solids that deflect light, each lamp's cones around the balls, and the
 * division of the photons. */
#include "render/caustics/emission.h"

#include "geometry/shapes/shape.h"
#include "optics/mueller.h"
#include "optics/spectrum.h"

#include <stdlib.h>

#define PI 3.14159265358979323846

/* --- what deflects light --- */

static bool deflects(const plan *p, int priority_index)
{
    const region_materials *m = &p->shading_materials[priority_index];
    const region *b = &p->geometry->regions[priority_index];
    bool any = !b->opaque && !b->partial;
    for (int k = 0; k < m->count; k++)
        any |= m->mat[k].surface.reflectivity > 0.0 || m->mat[k].surface.transparency > 0.0 ||
               material_is_layered(&m->mat[k].surface, &p->render);
    return any;
}

static ball ball_of(const plan *p, int priority_index)
{
    const solid_shape shape = scene_geometry_shape(p->geometry, priority_index);
    const bounds3 box = shape_world_box(&shape);
    const vec3 half = vec3_scale(vec3_sub(box.high, box.low), 0.5);
    const bool bounded = vec3_is_finite(half);
    return (ball){bounded ? vec3_add(box.low, half) : vec3_make(0.0, 0.0, 0.0), half,
                  bounded ? vec3_length(half) : (double)INFINITY, p->geometry->regions[priority_index].solid};
}

/* A ball around the boxes of two balls. */
static ball joined(ball a, ball b)
{
    if (isinf(a.radius) || isinf(b.radius))
        return (ball){.radius = (double)INFINITY, .solid = -1};
    const vec3 a_low = vec3_sub(a.centre, a.half), a_high = vec3_add(a.centre, a.half);
    const vec3 b_low = vec3_sub(b.centre, b.half), b_high = vec3_add(b.centre, b.half);
    const vec3 low = vec3_make(fmin(a_low.x, b_low.x), fmin(a_low.y, b_low.y), fmin(a_low.z, b_low.z)),
               high = vec3_make(fmax(a_high.x, b_high.x), fmax(a_high.y, b_high.y), fmax(a_high.z, b_high.z));
    const vec3 half = vec3_scale(vec3_sub(high, low), 0.5);
    return (ball){vec3_add(low, half), half, vec3_length(half), -1};
}

static void find_balls(emission *e)
{
    const plan *p = e->p;
    bool many = false;
    for (int r = 1; r <= p->geometry->region_count; r++) {
        if (!deflects(p, r))
            continue;
        const ball one = ball_of(p, r);
        many |= e->ball_count == CONES_MAX;
        if (many) /* from now on the first ball holds all */
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

/* The cone of all directions from points of the lamp to points of the ball. */
static cone cone_to(vec3 from, double lamp_radius, const ball *b)
{
    const vec3 to = vec3_sub(b->centre, from);
    const double d = vec3_length(to), sine = (b->radius + lamp_radius) / d;
    if (!(sine < 1.0))
        return (cone){.axis = vec3_make(0.0, 1.0, 0.0), .cap = 2.0};
    /* 1 - cos = sin^2 / (1 + cos), without cancellation; widened by more than the rounding error */
    return (cone){.axis = vec3_scale(to, 1.0 / d), .cap = (1.0 + 1e-9) * sine * sine / (1.0 + sqrt(1.0 - sine * sine))};
}

/* Whether two cones have a common direction: c <= a + b, with half angles a and b, and c between the axes. */
static bool overlap(const cone *a, const light_cone *b)
{
    const double cos_a = 1.0 - a->cap, cos_b = 1.0 - b->opening;
    const double sum = cos_a * cos_b - sqrt(fmax(0.0, (1.0 - cos_a * cos_a) * (1.0 - cos_b * cos_b)));
    const bool all = cos_a + cos_b <= 0.0; /* a + b is at least 180 degrees */
    return all || light_cone_off(b, a->axis) <= (1.0 - sum) * (1.0 + 1e-9) + 1e-12;
}

/* The directions of a cone in which the lamp shines: the narrower of both cones. */
static cone lit_part(cone c, const light *l, const light_cone *lamp)
{
    if (!light_has_cone(l) || lamp->opening > 2.0)
        return c;
    if (!overlap(&c, lamp))
        return (cone){.axis = c.axis, .cap = c.cap, .flux = 0.0};
    const double opening = (1.0 + 1e-9) * lamp->opening;
    return opening < c.cap ? (cone){.axis = lamp->axis, .cap = opening, .flux = 1.0} : c;
}

sunlit_area sunlit_area_of(const emission *e, int k, vec3 direction)
{
    const ball *b = &e->balls[k];
    sunlit_area a = {.centre = b->centre};
    if (isinf(b->radius)) {
        polarisation_frame(direction, &a.u, &a.v);
        a.across = a.up = 2.0 * fmax(e->p->geometry->extent, vec3_length(e->p->view.eye));
        return a;
    }
    const vec3 edges[3] = {{b->half.x, 0.0, 0.0}, {0.0, b->half.y, 0.0}, {0.0, 0.0, b->half.z}};
    vec3 longest = {0.0, 0.0, 0.0};
    for (int i = 0; i < 3; i++) {
        const vec3 seen = vec3_sub(edges[i], vec3_scale(direction, vec3_dot(edges[i], direction)));
        longest = vec3_dot(seen, seen) > vec3_dot(longest, longest) ? seen : longest;
    }
    a.u = vec3_normalize(longest);
    a.v = vec3_cross(direction, a.u);
    for (int i = 0; i < 3; i++)
        a.across += fabs(vec3_dot(edges[i], a.u)), a.up += fabs(vec3_dot(edges[i], a.v));
    a.across *= 1.0 + 1e-9, a.up *= 1.0 + 1e-9; /* by more than the rounding error */
    return a;
}

/* A light's brightness in its strongest channel. */
static double brightness(const light *l)
{
    return l->intensity * fmax(l->color.x, fmax(l->color.y, l->color.z));
}

/* Sets the cones of a sun, and the flux through its areas, relative to the flux of a lamp of intensity 1 and reach 1
 * into the solid angle 2 pi, as in aim. */
static void aim_sun(emission *e, int lamp)
{
    const light_cone *c = &e->p->cones[lamp];
    for (int k = 0; k < e->ball_count; k++) {
        const sunlit_area a = sunlit_area_of(e, k, c->axis);
        e->lamps[lamp].cones[k] = (cone){.axis = c->axis,
                                         .cap = e->sizes ? c->opening : 0.0,
                                         .flux = brightness(&e->p->lights[lamp]) * 4.0 * a.across * a.up / (2.0 * PI)};
    }
}

/* Sets the lamp's cones and the flux in each: the brightness times the squared reach times the solid angle over 2 pi.
 * The light of a lamp without reach does not fall off: the distance of the ball, or for an unbounded solid the extent
 * of the scene, replaces the reach. */
static void aim(emission *e, int lamp)
{
    const light *l = &e->p->lights[lamp];
    lamp_emission *out = &e->lamps[lamp];
    out->inside = scene_geometry_inside(e->p->geometry, l->position);
    if (is_sun(e, lamp)) {
        aim_sun(e, lamp);
        return;
    }
    for (int k = 0; k < e->ball_count; k++) {
        const ball *b = &e->balls[k];
        cone c = cone_to(l->position, e->sizes ? light_extent(l) : 0.0, b);
        c.flux = 1.0;
        out->cones[k] = c = lit_part(c, l, &e->p->cones[lamp]);
        const vec3 to = vec3_sub(l->position, b->centre);
        const double extent = e->p->geometry->extent, falloff = l->reach > 0.0     ? l->reach * l->reach
                                                                : isinf(b->radius) ? extent * extent
                                                                                   : vec3_dot(to, to);
        out->cones[k].flux *= brightness(l) * falloff * c.cap;
    }
}

/* --- beams --- */

static vec3 color_of(const beam *b)
{
    double rgb[3];
    if (b->white)
        return vec3_make(1.0, 1.0, 1.0);
    lamp_rgb(LAMP_LINE, 0.0, b->lambda_nm, rgb);
    return vec3_make(rgb[0], rgb[1], rgb[2]);
}

/* Sets the axes, colours and fluxes of beams. A photon's flux is its power over pi; the flux of a lamp of intensity 1
 * and reach 1 into the solid angle 2 pi is 2 pi (see aim). */
static status prepare_beams(emission *e, diagnostic *why)
{
    for (int k = 0; k < e->p->beam_count; k++) {
        const beam *b = &e->p->beams[k];
        const bool has_normal = beam_is_flat(b) && vec3_dot(b->normal, b->normal) > 0.0;
        TRY(ray_axes_set(&e->beams[k].axes, b->position, beam_axis(b), has_normal ? &b->normal : NULL, why));
        const vec3 color = e->beams[k].color = color_of(b);
        e->beams[k].flux = b->power * fmax(color.x, fmax(color.y, color.z)) / (2.0 * PI * PI);
        e->extent = fmax(e->extent, beam_is_parallel(b) ? 0.5 * b->width : e->p->geometry->extent);
    }
    return STATUS_OK;
}

/* --- fractions --- */

/* Divides the photons among the targets in proportion to `wanted`: each lamp's cones, then the beams. */
static void divide(emission *e, int64_t photons)
{
    const double *wanted = e->wanted;
    const int lamps = e->p->light_count, sources = lamps + e->p->beam_count;
    double all = 0.0, so_far = 0.0;
    for (int k = 0; k < emission_target_count(e); k++)
        all += wanted[k];
    e->count = 0;
    for (int k = 0, at = 0; k < sources; k++) {
        int64_t *first = k < lamps ? &e->lamps[k].first : &e->beams[k - lamps].first,
                *count = k < lamps ? &e->lamps[k].count : &e->beams[k - lamps].count;
        const int targets = k < lamps ? e->ball_count : 1;
        double source_wanted = 0.0;
        for (int i = 0; i < targets; i++)
            source_wanted += wanted[at + i];
        for (int i = 0; k < lamps && i < targets; i++)
            e->lamps[k].cones[i].fraction = source_wanted > 0.0 ? wanted[at + i] / source_wanted : 0.0;
        at += targets;
        so_far += source_wanted;
        *first = e->count;
        e->count = all > 0.0 ? (int64_t)(so_far / all * (double)photons + 0.5) : 0;
        *count = e->count - *first;
    }
}

int emission_target_count(const emission *e)
{
    return e->p->light_count * e->ball_count + e->p->beam_count;
}

int emission_target_solid(const emission *e, int target)
{
    return target < e->p->light_count * e->ball_count ? e->balls[target % e->ball_count].solid : -1;
}

static double flux_of(const emission *e, int target)
{
    const int cones = e->p->light_count * e->ball_count;
    return target < cones ? e->lamps[target / e->ball_count].cones[target % e->ball_count].flux
                          : e->beams[target - cones].flux;
}

double emission_light(const emission *e, int target, int64_t arrived)
{
    const int cones = e->p->light_count * e->ball_count;
    const double emitted = target < cones ? (double)e->lamps[target / e->ball_count].count *
                                                e->lamps[target / e->ball_count].cones[target % e->ball_count].fraction
                                          : (double)e->beams[target - cones].count;
    return arrived > 0 && emitted > 0.0 ? flux_of(e, target) * (double)arrived / emitted : 0.0;
}

/* The fraction of its photons that a target keeps if nothing arrived from it. */
#define SILENT_FRACTION 0.02

void emission_end_pilot(emission *e, const bool *delivers)
{
    for (int k = 0; k < emission_target_count(e); k++)
        e->wanted[k] = sqrt(flux_of(e, k)) * (!delivers || delivers[k] ? 1.0 : SILENT_FRACTION);
    divide(e, e->photons);
    e->is_pilot = false;
}

/* Photons per target of a pilot, which in all has at most 1 / PILOT_PART of the photons. */
enum { PILOT_EACH_MOST = 256, PILOT_EACH_LEAST = 32, PILOT_PART = 16 };

bool emission_begin_pilot(emission *e)
{
    int shining = 0;
    for (int k = 0; k < emission_target_count(e); k++) {
        e->wanted[k] = flux_of(e, k) > 0.0 ? 1.0 : 0.0;
        shining += flux_of(e, k) > 0.0;
    }
    const int64_t per_target = e->photons / (PILOT_PART * (shining > 0 ? shining : 1));
    if (shining < 2 || per_target < PILOT_EACH_LEAST)
        return false;
    divide(e, shining * (per_target < PILOT_EACH_MOST ? per_target : PILOT_EACH_MOST));
    e->is_pilot = true;
    return true;
}

status emission_create(const plan *p, int64_t photons, bool sizes, emission **out, diagnostic *why)
{
    emission *e = calloc(1, sizeof *e);
    *out = e;
    if (e) {
        e->p = p; /* emission_destroy needs it */
        e->lamps = calloc((size_t)p->light_count + 1, sizeof *e->lamps);
        e->beams = calloc((size_t)p->beam_count + 1, sizeof *e->beams);
    }
    if (!e || !e->lamps || !e->beams)
        goto failed;
    e->sizes = sizes;
    e->photons = photons;
    find_balls(e);
    if (!(e->wanted = calloc((size_t)emission_target_count(e) + 1, sizeof *e->wanted)))
        goto failed;
    for (int k = 0; k < p->light_count && e->ball_count > 0; k++) {
        if (!(e->lamps[k].cones = calloc((size_t)e->ball_count, sizeof(cone))))
            goto failed;
        aim(e, k);
    }
    status code = prepare_beams(e, why);
    if (code == STATUS_OK) {
        emission_end_pilot(e, NULL);
        return STATUS_OK;
    }
    emission_destroy(e);
    *out = NULL;
    return code;
failed:
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
    free(e->wanted);
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
