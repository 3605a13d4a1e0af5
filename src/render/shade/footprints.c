/* Ray differentials, Igehy's equations 10 to 18, for the grid of samples. */
#include "render/shade/footprints.h"

#include "render/shade/shading.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Curved surfaces can shrink the view so much that a sample would sum thousands of photons. Beyond this reach, in
 * samples' cells as the camera sees the point without deflection, photons close together are merged. */
#define REACH_BENT 4.0
/* Behind curved surfaces two neighbouring samples place a photon between them differently, since each is exact only to
 * first order: too far away or too close, by e. Both or neither would receive all the light of a narrow disc in the
 * middle. With a density of this half width, in samples, each receives at most 1/2 +- 15 e / 8, where 15 / 8 is the
 * biweight's value at its middle. */
#define BLUR_BENT 0.5
/* Normals are compared at this fraction of the distance to the neighbour's hit. */
#define NEAR 0x1p-10

bool footprints_are_followed(const render_settings *r)
{
    return scene_has_caustics(r) && !integrator_traits_of(r)->by_chance;
}

bool footprints_begin(tracer *t)
{
    const bool follows = footprints_are_followed(&t->target.frame_plan->render) && !t->target.integrator_override;
    if (!follows) {
        footprints_end(t);
        return true;
    }
    if (!t->footprints && !(t->footprints = malloc(sizeof *t->footprints)))
        return false;
    for (int d = 0; d <= t->queues.depth_limit; d++)
        if (!queue_add_footprints(&t->queues.waiting[d]))
            return false;
    return true;
}

void footprints_end(tracer *t)
{
    free(t->footprints);
    t->footprints = NULL;
}

/* The vector to the image plane at distance 1 is d / depth (depth: d times the forward axis), so that a step of one
 * sample changes d by depth times the plane's vectors. */
void footprints_of_camera(tracer *t, ray_queue *q, int first, int count)
{
    const plan *p = t->target.frame_plan;
    const camera_frame *view = &p->view;
    const camera_pixel pixel = camera_pixel_of(view, &p->render);
    const double per_side = (double)cells_across(p->render.samples);
    const vec3 zero = {0.0, 0.0, 0.0}, x = vec3_scale(view->right, pixel.across / per_side),
               y = vec3_scale(view->up, pixel.down / per_side);
    for (int i = first; i < first + count; i++) {
        const double depth = vec3_dot(vec3_make(q->dx[i], q->dy[i], q->dz[i]), view->forward);
        q->footprint[i] =
            view->parallel ? (ray_footprint){{x, y}, {zero, zero}, false, false}
                           : (ray_footprint){{zero, zero}, {vec3_scale(x, depth), vec3_scale(y, depth)}, false, false};
    }
}

void footprints_gather(tracer *t, const ray_queue *q, int first, const int *list)
{
    const group *g = &t->surface.gathered;
    footprint_work *w = t->footprints;
    w->ready = false;
    for (int k = 0; k < g->count; k++) {
        const ray_footprint *f = &q->footprint[first + list[k]];
        w->at[k].toward = vec3_make(g->dx[k], g->dy[k], g->dz[k]);
        for (int axis = 0; axis < 2; axis++) {
            w->at[k].across[axis] = vec3_add(f->shift[axis], vec3_scale(f->turn[axis], g->t[k]));
            w->at[k].turn[axis] = f->turn[axis];
        }
        w->bent[k] = f->bent, w->rough_guess[k] = f->rough_guess;
        w->at[k].reach = 0.0;
        w->primitive[k] = t->batch.hits.hit_primitive[list[k]];
    }
}

/* --- the surface's curvature --- */

static vec3 normal_of(const surface_batch *s, int k)
{
    return vec3_make(s->nx[k], s->ny[k], s->nz[k]);
}

/* The change of the normal from each hit to the neighbour's hit, `step` away, of rays from .. to - 1, which hit one
 * primitive. It is extrapolated from the normal at the fraction NEAR of the step, projected onto the primitive; 0 if
 * that point is on another face. */
static void curve(const tracer *t, int from, int to, const vec3 *step, vec3 *change)
{
    const group *g = &t->surface.gathered;
    double ox[ROW], oy[ROW], oz[ROW];
    int64_t start[ROW];
    surface_batch near;
    const int count = to - from;
    for (int i = 0; i < count; i++) {
        const int k = from + i;
        ox[i] = g->ox[k] + NEAR * step[k].x, oy[i] = g->oy[k] + NEAR * step[k].y, oz[i] = g->oz[k] + NEAR * step[k].z;
        start[i] = FACE_NONE;
    }
    const ray_batch rays = {
        count, ox, oy, oz, g->dx + from, g->dy + from, g->dz + from, start, g->inside_before + from};
    t->geometry->surface(t->target.frame_plan->geometry, (int)t->footprints->primitive[from], &rays, g->t + from,
                         &near);
    for (int i = 0; i < count; i++) {
        const bool same = near.face[i] == g->points.face[from + i];
        const vec3 off = vec3_sub(normal_of(&near, i), normal_of(&g->points, from + i));
        change[from + i] = same ? vec3_scale(off, 1.0 / NEAR) : vec3_make(0.0, 0.0, 0.0);
    }
}

/* Applies `curve` to the gathered group. Triangles are flat; the curvature of interpolated normals is ignored, and
 * noted as rough_guess. */
static void curve_all(tracer *t, vec3 step[2][ROW], vec3 change[2][ROW])
{
    const group *g = &t->surface.gathered;
    footprint_work *w = t->footprints;
    if (t->surface.on_mesh) {
        memset(change, 0, 2 * sizeof *change);
        for (int k = 0; k < g->count; k++) {
            const vec3 off = vec3_sub(mesh_face_normal(t, k), normal_of(&g->points, k));
            w->rough_guess[k] |= vec3_dot(off, off) > 1e-20;
        }
        return;
    }
    for (int from = 0, to; from < g->count; from = to) {
        for (to = from + 1; to < g->count && w->primitive[to] == w->primitive[from]; to++)
            ;
        curve(t, from, to, step[0], change[0]);
        curve(t, from, to, step[1], change[1]);
    }
}

/* --- branches --- */

/* The change of the reflected direction d - 2 (d.n) n, if d changes by `turn` and n by `bend`. */
static vec3 turn_reflected(vec3 turn, vec3 d, vec3 n, vec3 bend)
{
    const double change = vec3_dot(turn, n) + vec3_dot(d, bend);
    return vec3_sub(turn, vec3_scale(vec3_add(vec3_scale(n, change), vec3_scale(bend, vec3_dot(d, n))), 2.0));
}

/* The change of the refracted direction, from Snell's law in vector form, out = eta d + (eta cos_i - cos_t) n for a
 * unit vector d. The neighbour's direction keeps the length of its vector to the image plane, since samples are evenly
 * spaced in the plane, not in angle. */
static vec3 turn_refracted(vec3 turn, vec3 d, vec3 n, vec3 bend, double eta, vec3 out)
{
    const double longer = vec3_dot(d, turn), cos_i = -vec3_dot(d, n),
                 cos_t = sqrt(1.0 - eta * eta * (1.0 - cos_i * cos_i)), along = eta * cos_i - cos_t;
    const vec3 unit_turn = vec3_sub(turn, vec3_scale(d, longer));
    const double change = -(vec3_dot(unit_turn, n) + vec3_dot(d, bend)),
                 change_along = (eta - eta * eta * cos_i / cos_t) * change;
    const vec3 unit =
        vec3_add(vec3_scale(unit_turn, eta), vec3_add(vec3_scale(n, change_along), vec3_scale(bend, along)));
    return vec3_add(unit, vec3_scale(out, longer));
}

/* Moves the shift along the direction d until it is as parallel to the turn as possible, so that rays through one point
 * remain so. */
static vec3 shift_along_turn(vec3 shift, vec3 turn, vec3 d)
{
    const double longer = vec3_dot(turn, d);
    const vec3 aside = vec3_sub(turn, vec3_scale(d, longer));
    const double aside2 = vec3_dot(aside, aside), times = aside2 > 0.0 ? vec3_dot(shift, aside) / aside2 : 0.0;
    return vec3_add(shift, vec3_scale(d, times * longer - vec3_dot(shift, d)));
}

static void branch(tracer *t)
{
    const group *g = &t->surface.gathered;
    footprint_work *w = t->footprints;
    vec3 step[2][ROW], bend[2][ROW];
    for (int axis = 0; axis < 2; axis++)
        for (int k = 0; k < g->count; k++) { /* along the surface */
            const vec3 across = w->at[k].across[axis];
            const double along = vec3_dot(across, normal_of(&g->points, k)) / g->points.cos_i[k];
            step[axis][k] = vec3_add(across, vec3_scale(w->at[k].toward, along));
        }
    curve_all(t, step, bend);
    const bool straight = t->target.frame_plan->render.transmission == TRANSMISSION_SIMPLE || t->surface.blended;
    for (int k = 0; k < g->count; k++) {
        const vec3 d = w->at[k].toward, n = normal_of(&g->points, k);
        const double eta = straight ? 1.0 : g->n_from[k] / g->n_to[k];
        const branch_group *b = &t->surface.branches;
        const vec3 back = vec3_make(b->rx[k], b->ry[k], b->rz[k]), out = vec3_make(b->tx[k], b->ty[k], b->tz[k]);
        ray_footprint *r = &w->reflected[k], *f = &w->refracted[k];
        r->rough_guess = f->rough_guess = w->rough_guess[k];
        r->bent = f->bent = w->bent[k] || vec3_dot(bend[0][k], bend[0][k]) + vec3_dot(bend[1][k], bend[1][k]) > 0.0;
        for (int axis = 0; axis < 2; axis++) {
            const vec3 across = w->at[k].across[axis], turn = w->at[k].turn[axis];
            r->shift[axis] = vec3_sub(across, vec3_scale(n, 2.0 * vec3_dot(across, n)));
            r->turn[axis] = turn_reflected(turn, d, n, bend[axis][k]);
            f->shift[axis] = eta == 1.0 ? across : step[axis][k];
            f->turn[axis] = eta == 1.0 ? turn : turn_refracted(turn, d, n, bend[axis][k], eta, out);
            r->shift[axis] = shift_along_turn(r->shift[axis], r->turn[axis], back);
            if (eta != 1.0)
                f->shift[axis] = shift_along_turn(f->shift[axis], f->turn[axis], out);
        }
    }
    w->ready = true;
}

void footprints_of_children(tracer *t, ray_queue *q, int first, bool reflected, const int *list, int count)
{
    if (!t->footprints->ready)
        branch(t);
    const ray_footprint *from = reflected ? t->footprints->reflected : t->footprints->refracted;
    for (int k = 0; k < count; k++)
        q->footprint[first + k] = from[list[k]];
}

void footprint_straight(tracer *t, ray_queue *q, int at, int k)
{
    const photon_footprint *f = &t->footprints->at[k];
    q->footprint[at] =
        (ray_footprint){{f->across[0], f->across[1]}, {f->turn[0], f->turn[1]}, t->footprints->bent[k], true};
}

/* --- light --- */

static double cell_at(const plan *p, vec3 point)
{
    const camera_pixel pixel = camera_pixel_of(&p->view, &p->render);
    const double cell = fmax(pixel.across, pixel.down) / (double)cells_across(p->render.samples);
    return p->view.parallel ? cell : cell * vec3_length(vec3_sub(point, p->view.eye));
}

vec3 footprint_irradiance(tracer *t, int k, int wavelength, double seen)
{
    const group *g = &t->surface.gathered;
    footprint_work *w = t->footprints;
    const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]);
    const bool guessed = w->rough_guess[k] || w->bent[k];
    double narrow[PHOTON_FACTORS];
    const vec3 both = vec3_cross(w->at[k].across[0], w->at[k].across[1]);
    w->at[k].along = vec3_scale(both, 1.0 / vec3_dot(w->at[k].toward, both));
    w->at[k].reach = w->bent[k] ? REACH_BENT * cell_at(t->target.frame_plan, point) : DBL_MAX;
    w->at[k].blur = w->bent[k] ? BLUR_BENT : 0.0;
    const vec3 e = photon_map_seen(t->target.frame_plan->photons, point, normal_of(&g->points, k), wavelength,
                                   &w->at[k], guessed ? narrow : NULL);
    for (int i = 0; i < PHOTON_FACTORS && guessed; i++)
        COUNT(t->account.counters.undersampled[i] += counters_cut_units(fmin(narrow[i] * seen, 1024.0)));
    return e;
}
