/* Stokes vectors at surfaces, and on passages through sheets. */
#include "render/shade/polarisation.h"

#include "base/elementary.h"
#include "render/shade/media.h"
#include "scene/model/medium.h"
#include <math.h>

void polarised_gather(tracer *t, const ray_queue *q, int first, const int *list)
{
    polar_group *p = &t->surface.polar;
    for (int k = 0; k < t->surface.gathered.count; k++) {
        const int at = first + list[k];
        p->q[k] = q->sq[at], p->u[k] = q->su[at], p->v[k] = q->sv[at];
    }
}

static stokes stokes_add(stokes a, stokes b, double times)
{
    return (stokes){a.i + times * b.i, a.q + times * b.q, a.u + times * b.u, a.v + times * b.v};
}

/* Splits a Stokes vector into the fraction of unpolarised light, at least 0, and the other elements relative to it. */
static double split_stokes(stokes s, double *q, double *u, double *v)
{
    const double fraction = s.i > 0.0 ? s.i : 0.0, inverse = s.i > 0.0 ? 1.0 / s.i : 0.0;
    *q = s.q * inverse, *u = s.u * inverse, *v = s.v * inverse;
    return fraction;
}

void polarised_layered(tracer *t, int k, sp_response reflected, sp_response transmitted, double reflectivity,
                       double transparency)
{
    const group *g = &t->surface.gathered;
    branch_group *b = &t->surface.branches;
    polar_group *p = &t->surface.polar;
    const stokes row = {1.0, p->q[k], p->u[k], p->v[k]}, intensity = {1.0, 0.0, 0.0, 0.0};
    const vec3 d = vec3_make(g->dx[k], g->dy[k], g->dz[k]);
    const vec3 n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]);
    const vec3 back = vec3_make(b->rx[k], b->ry[k], b->rz[k]), ahead = vec3_make(b->tx[k], b->ty[k], b->tz[k]);
    stokes r = analyser_across(row, d, n, back, reflected);
    if (reflectivity > 0.0) /* as analyser_half_mirror */
        r = stokes_add(r, analyser_across(intensity, d, n, back, transmitted), reflectivity);
    b->reflect[k] = split_stokes(r, &p->rq[k], &p->ru[k], &p->rv[k]);
    if (b->refract[k] == 0.0)
        return;
    const stokes s = analyser_across(row, d, n, ahead, transmitted);
    b->refract[k] = transparency * (1.0 - reflectivity) * split_stokes(s, &p->tq[k], &p->tu[k], &p->tv[k]);
}

/* Called after the branches' directions and unpolarised weights are computed. */
void polarised_branches(tracer *t, const material *m, bool opaque)
{
    const group *g = &t->surface.gathered;
    branch_group *b = &t->surface.branches;
    polar_group *p = &t->surface.polar;
    const double reflectivity = material_reflectivity(m, &t->target.frame_plan->render);
    for (int k = 0; k < g->count; k++) {
        const stokes row = {1.0, p->q[k], p->u[k], p->v[k]};
        const vec3 d = vec3_make(g->dx[k], g->dy[k], g->dz[k]);
        const vec3 n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]);
        const vec3 reflected = vec3_make(b->rx[k], b->ry[k], b->rz[k]),
                   refracted = vec3_make(b->tx[k], b->ty[k], b->tz[k]);
        const double cos_i = g->points.cos_i[k];
        if (opaque) {
            b->reflect[k] =
                m->reflectivity * split_stokes(analyser_mirror(row, d, n, reflected), &p->rq[k], &p->ru[k], &p->rv[k]);
            continue;
        }
        stokes r = analyser_reflect(row, d, n, cos_i, g->n_from[k], g->n_to[k], reflected);
        if (reflectivity > 0.0)
            r = stokes_add(r, analyser_half_mirror(row, d, n, cos_i, g->n_from[k], g->n_to[k], reflected),
                           reflectivity);
        b->reflect[k] = split_stokes(r, &p->rq[k], &p->ru[k], &p->rv[k]);
        if (b->refract[k] == 0.0) /* total reflection: there is no refracted direction */
            continue;
        const stokes s = analyser_refract(row, d, n, cos_i, g->n_from[k], g->n_to[k], refracted);
        b->refract[k] = m->transparency * (1.0 - reflectivity) * split_stokes(s, &p->tq[k], &p->tu[k], &p->tv[k]);
    }
}

/* The directions are equal up to rounding, but their polarisation frames may differ, because frames are
 * discontinuous. */
void polarised_shadow(tracer *t, int k, bool refracted, int at)
{
    const branch_group *b = &t->surface.branches;
    const polar_group *p = &t->surface.polar;
    ray_queue *q = &t->queues.shadows;
    const stokes row =
        refracted ? (stokes){1.0, p->tq[k], p->tu[k], p->tv[k]} : (stokes){1.0, p->rq[k], p->ru[k], p->rv[k]};
    const vec3 branch = refracted ? vec3_make(b->tx[k], b->ty[k], b->tz[k]) : vec3_make(b->rx[k], b->ry[k], b->rz[k]);
    vec3 x, y, branch_x, branch_y;
    polarisation_frame(branch, &branch_x, &branch_y);
    polarisation_frame(vec3_normalize(vec3_make(q->dx[at], q->dy[at], q->dz[at])), &x, &y);
    const frame_turn from = frame_turn_to(x, y, branch_x);
    const stokes turned = stokes_rotate(row, from.cos_2a, -from.sin_2a);
    q->sq[at] = turned.q, q->su[at] = turned.u, q->sv[at] = turned.v;
}

/* --- sheets --- */

/* The retardance along a path. For a direction at an angle a to its axis, a weakly birefringent crystal has the
 * difference of indices (n_e - n_o) sin^2 a: Born and Wolf, Principles of Optics, 7th ed., 15.4.2. */
static double retardance_deg(const region_sheet *sheet, vec3 d, double length_m, double lambda_nm)
{
    const vec3 across = vec3_sub(sheet->axis, vec3_scale(d, vec3_dot(sheet->axis, d)));
    const double sine2 = vec3_dot(across, across) / vec3_dot(sheet->axis, sheet->axis);
    const double waves = sheet->birefringence * sine2 * length_m * 1e9 / lambda_nm;
    return sheet->retardance_deg + 360.0 * (waves - floor(waves));
}

/* The row after a passage of length_m metres along d. */
static stokes sheet_row(const region_sheet *sheet, stokes row, vec3 d, double length_m, double lambda_nm)
{
    double sine, cosine;
    switch (sheet->kind) {
    case SHEET_POLARISER: return analyser_element(row, d, sheet->axis, sp_polariser(sheet->pass, sheet->block));
    case SHEET_CIRCULAR_LEFT: return analyser_circular_polariser(row, sheet->pass, sheet->block);
    case SHEET_CIRCULAR_RIGHT: return analyser_circular_polariser(row, sheet->block, sheet->pass);
    case SHEET_RETARDER:
        elementary_sincos_deg(retardance_deg(sheet, d, length_m, lambda_nm), &sine, &cosine);
        return analyser_element(row, d, sheet->axis, sp_retarder(sine, cosine));
    case SHEET_NONE: break;
    }
    return row;
}

/* Shadow rays have rows, too: from a rough surface, the facet's. */
void sheets_begin(const tracer *t, sheet_work *w, const ray_queue *q, int first, int count)
{
    const bool polarised = t->target.frame_plan->render.polarisation, lights = q == &t->queues.shadows;
    w->to_lamps = lights && t->target.frame_plan->polarised_shadows;
    for (int i = 0; i < count; i++) {
        const int at = first + i;
        w->passage[i] = (sheet_passage){.row = {1.0, 0.0, 0.0, 0.0}, .region = -1};
        if (polarised)
            w->passage[i].row.q = q->sq[at], w->passage[i].row.u = q->su[at], w->passage[i].row.v = q->sv[at];
        w->direction[i] = vec3_make(q->dx[at], q->dy[at], q->dz[at]);
        if (lights)
            w->direction[i] = vec3_normalize(w->direction[i]);
        if (w->to_lamps)
            w->lamp[i] = (stokes){1.0, q->lamp_q[at], q->lamp_u[at], 0.0};
    }
}

void sheets_shadow_ray(tracer *t, int lamp, int at)
{
    const plan *p = t->target.frame_plan;
    ray_queue *q = &t->queues.shadows;
    q->sq[at] = q->su[at] = q->sv[at] = 0.0;
    if (!p->polarised_shadows)
        return;
    const vec3 to_lamp = vec3_normalize(vec3_make(q->dx[at], q->dy[at], q->dz[at]));
    const stokes s = lamp_stokes(p, lamp, vec3_scale(to_lamp, -1.0), to_lamp);
    q->lamp_q[at] = s.q, q->lamp_u[at] = s.u;
}

void sheets_announce(tracer *t, const ray_queue *q, int first, int count)
{
    if (t->target.frame_plan->sheets)
        sheets_begin(t, &t->media->sheets, q, first, count);
}

static double lambda_of(const tracer *t, int64_t sample_key)
{
    const plan *p = t->target.frame_plan;
    return p->spectral ? spectra_lambda(sample_key_wavelength(sample_key)) : p->render.lambda_nm;
}

/* Ends ray i's passage. A path that leaves the scene is exempt, as for absorption. */
static void leave(const tracer *t, vec3 direction, int i, sheet_passage *passage)
{
    const double infinite_length = 1e100;
    const plan *p = t->target.frame_plan;
    const region_sheet *sheet = passage->region >= 0 ? &p->sheets[passage->region] : NULL;
    passage->region = -1;
    if (!sheet || !(passage->length > 0.0) || passage->length > infinite_length)
        return;
    if (!p->render.polarisation) /* only polarisers act */
        passage->row.i *= 0.5 * (sheet->pass + sheet->block);
    else
        passage->row = sheet_row(sheet, passage->row, direction, passage->length * p->render.unit_m,
                                 lambda_of(t, t->media->sample_keys[i]));
}

/* Adds a segment to ray i's passage, since the search for interfaces may divide a passage into several. */
static void pass(const tracer *t, vec3 direction, int i, int priority_index, double length, sheet_passage *passage)
{
    if (passage->region == priority_index) {
        passage->length += length;
        return;
    }
    leave(t, direction, i, passage);
    if (t->target.frame_plan->sheets[priority_index].kind == SHEET_NONE)
        return;
    passage->region = priority_index;
    passage->length = length;
}

void sheets_segment(const tracer *t, sheet_work *w, const medium_segment *s)
{
    pass(t, w->direction[s->ray], s->ray, s->priority_index, s->length, &w->passage[s->ray]);
}

double sheets_fraction_within(const tracer *t, const sheet_work *w, const medium_segment *s, double length)
{
    sheet_passage passage = w->passage[s->ray];
    pass(t, w->direction[s->ray], s->ray, s->priority_index, length, &passage);
    leave(t, w->direction[s->ray], s->ray, &passage);
    return greater(passage.row.i, 0.0);
}

void sheets_leave(tracer *t, int count, double fraction[3][ROW])
{
    sheet_work *w = &t->media->sheets;
    for (int i = 0; i < count; i++) {
        leave(t, w->direction[i], i, &w->passage[i]);
        const stokes row = w->passage[i].row;
        const double seen = w->to_lamps ? analyser_intensity(row, w->lamp[i]) : row.i;
        const double left = greater(seen, 0.0); /* 0 up to rounding behind two crossed polarisers */
        fraction[0][i] *= left, fraction[1][i] *= left, fraction[2][i] *= left;
    }
}

void sheets_store(tracer *t, ray_queue *q, int first, int count)
{
    const sheet_work *w = &t->media->sheets;
    if (!t->target.frame_plan->render.polarisation || q == &t->queues.shadows)
        return;
    for (int i = 0; i < count; i++) {
        const stokes s = w->passage[i].row;
        const double over = s.i > 0.0 ? 1.0 / s.i : 0.0;
        q->sq[first + i] = s.q * over, q->su[first + i] = s.u * over, q->sv[first + i] = s.v * over;
    }
}
