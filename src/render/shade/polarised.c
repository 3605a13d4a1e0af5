/* Polarised light, traced from the camera: each ray carries the analyser's Stokes vector (optics/mueller.h), whose
 * first element is part of its throughput; the others, relative to the first, are in the queue. Light from the sky and
 * from matte surfaces is unpolarised, so that only the first element weights it; that of polarised lamps meets the
 * shadow rays' own vectors (render/shade/sheets.h). */
#include "render/shade/shading.h"

#include "optics/mueller.h"
#include "scene/model/medium.h"

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

/* Splits a Stokes vector into the share of unpolarised light, at least 0, and the other elements relative to it. */
static double split_stokes(stokes s, double *q, double *u, double *v)
{
    const double share = s.i > 0.0 ? s.i : 0.0, inverse = s.i > 0.0 ? 1.0 / s.i : 0.0;
    *q = s.q * inverse, *u = s.u * inverse, *v = s.v * inverse;
    return share;
}

void polarised_layered(tracer *t, int k, sp_response reflected, sp_response transmitted, double coating,
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
    if (coating > 0.0) /* as analyser_coating */
        r = stokes_add(r, analyser_across(intensity, d, n, back, transmitted), coating);
    b->reflect[k] = split_stokes(r, &p->rq[k], &p->ru[k], &p->rv[k]);
    if (b->refract[k] == 0.0)
        return;
    const stokes s = analyser_across(row, d, n, ahead, transmitted);
    b->refract[k] = transparency * (1.0 - coating) * split_stokes(s, &p->tq[k], &p->tu[k], &p->tv[k]);
}

/* Called after the branches' directions and unpolarised weights are computed. */
void polarised_branches(tracer *t, const material *m, bool opaque)
{
    const group *g = &t->surface.gathered;
    branch_group *b = &t->surface.branches;
    polar_group *p = &t->surface.polar;
    const double coating = material_coating(m, &t->target.frame_plan->render);
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
        if (coating > 0.0)
            r = stokes_add(r, analyser_coating(row, d, n, cos_i, g->n_from[k], g->n_to[k], reflected), coating);
        b->reflect[k] = split_stokes(r, &p->rq[k], &p->ru[k], &p->rv[k]);
        if (b->refract[k] == 0.0) /* total reflection: there is no direction */
            continue;
        const stokes s = analyser_refract(row, d, n, cos_i, g->n_from[k], g->n_to[k], refracted);
        b->refract[k] = m->transparency * (1.0 - coating) * split_stokes(s, &p->tq[k], &p->tu[k], &p->tv[k]);
    }
}

/* The directions are the same up to rounding, but the frames may not be: they are discontinuous. */
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
