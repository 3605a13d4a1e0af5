#include "render/shade/sheets.h"

#include "base/elementary.h"
#include "geometry/solid.h"
#include "render/shade/lamp_polarisation.h"
#include "render/shade/shading.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>

bool sheet_list_create(const scene *s, const scene_geometry *geometry, region_sheet **out)
{
    region_sheet *list = NULL;
    *out = NULL;
    for (int r = 1; r <= geometry->region_count; r++) {
        const solid *one = &s->solids[geometry->regions[r].solid];
        const material *m = &one->surface;
        if (geometry->regions[r].opaque || !sheet_acts(m, &s->render))
            continue;
        if (!list && !(list = calloc((size_t)geometry->region_count + 1, sizeof *list)))
            return false;
        const mat3 turn = rotation_from_deg(one->shape.rotation_deg);
        list[r] = (region_sheet){.kind = (sheet_kind)m->sheet,
                                 .axis = mat3_apply(turn, vec3_normalize(m->sheet_axis)),
                                 .pass = m->sheet_pass,
                                 .block = m->sheet_block,
                                 .retardance_deg = m->retardance_deg,
                                 .birefringence = m->birefringence};
    }
    *out = list;
    return true;
}

/* The retardance along a path. A weakly birefringent crystal has for a direction at an angle a to its axis the
 * difference of indices (n_e - n_o) sin^2 a: Born and Wolf, Principles of Optics, 7th ed., 15.4.2. */
static double retardance_deg(const region_sheet *sheet, vec3 d, double length_m, double lambda_nm)
{
    const vec3 across = vec3_sub(sheet->axis, vec3_scale(d, vec3_dot(sheet->axis, d)));
    const double sine2 = vec3_dot(across, across) / vec3_dot(sheet->axis, sheet->axis);
    const double waves = sheet->birefringence * sine2 * length_m * 1e9 / lambda_nm;
    return sheet->retardance_deg + 360.0 * (waves - floor(waves));
}

stokes sheet_row(const region_sheet *sheet, stokes row, vec3 d, double length_m, double lambda_nm)
{
    double sine, cosine;
    switch (sheet->kind) {
    case SHEET_POLARISER: return analyser_through(row, d, sheet->axis, sp_polariser(sheet->pass, sheet->block));
    case SHEET_CIRCULAR_LEFT: return analyser_through_circular(row, sheet->pass, sheet->block);
    case SHEET_CIRCULAR_RIGHT: return analyser_through_circular(row, sheet->block, sheet->pass);
    case SHEET_RETARDER:
        elementary_sincos_deg(retardance_deg(sheet, d, length_m, lambda_nm), &sine, &cosine);
        return analyser_through(row, d, sheet->axis, sp_retarder(sine, cosine));
    case SHEET_NONE: break;
    }
    return row;
}

void sheets_announce(tracer *t, const ray_queue *q, int first, int count)
{
    const plan *p = t->target.frame_plan;
    if (!p->sheets)
        return;
    sheet_work *w = &t->media->sheets;
    w->lights = q == &t->queues.shadows;
    const bool polarised = p->render.polarisation && !w->lights;
    for (int i = 0; i < count; i++) {
        const int at = first + i;
        w->row[i] = (stokes){1.0, 0.0, 0.0, 0.0};
        if (polarised)
            w->row[i].q = q->sq[at], w->row[i].u = q->su[at], w->row[i].v = q->sv[at];
        w->direction[i] = vec3_make(q->dx[at], q->dy[at], q->dz[at]);
        if (w->lights)
            w->direction[i] = vec3_normalize(w->direction[i]);
        if (w->lights && p->polarised_shadows)
            w->lamp[i] = (stokes){1.0, q->sq[at], q->su[at], q->sv[at]};
        w->region[i] = -1;
    }
}

void sheets_shadow_ray(tracer *t, int lamp, int at)
{
    ray_queue *q = &t->queues.shadows;
    const vec3 to_lamp = vec3_normalize(vec3_make(q->dx[at], q->dy[at], q->dz[at]));
    const stokes s = lamp_stokes(t->target.frame_plan, lamp, vec3_scale(to_lamp, -1.0), to_lamp);
    q->sq[at] = s.q, q->su[at] = s.u, q->sv[at] = s.v;
}

static double lambda_of(const tracer *t, int64_t sample_key)
{
    const plan *p = t->target.frame_plan;
    return p->spectral ? spectra_lambda(sample_key_wavelength(sample_key)) : p->render.lambda_nm;
}

/* Ends ray i's passage. A path that leaves the scene has no length, as for absorption. */
static void leave(tracer *t, int i)
{
    const double infinite_length = 1e100;
    const plan *p = t->target.frame_plan;
    sheet_work *w = &t->media->sheets;
    const region_sheet *sheet = w->region[i] >= 0 ? &p->sheets[w->region[i]] : NULL;
    w->region[i] = -1;
    if (!sheet || !(w->length[i] > 0.0) || w->length[i] > infinite_length)
        return;
    if (!p->render.polarisation) /* polarisers alone */
        w->row[i].i *= 0.5 * (sheet->pass + sheet->block);
    else
        w->row[i] = sheet_row(sheet, w->row[i], w->direction[i], w->length[i] * p->render.unit_m,
                              lambda_of(t, t->media->sample_keys[i]));
}

/* The search of interfaces may divide a passage into several segments. */
void sheets_segment(tracer *t, const medium_segment *s)
{
    const region_sheet *sheets = t->target.frame_plan->sheets;
    sheet_work *w = &t->media->sheets;
    const int i = s->ray;
    if (w->region[i] == s->priority_index) {
        w->length[i] += s->length;
        return;
    }
    leave(t, i);
    if (sheets[s->priority_index].kind == SHEET_NONE)
        return;
    w->region[i] = s->priority_index;
    w->length[i] = s->length;
}

void sheets_leave(tracer *t, int count, double share[3][ROW])
{
    const sheet_work *w = &t->media->sheets;
    const bool polarised = w->lights && t->target.frame_plan->polarised_shadows;
    for (int i = 0; i < count; i++) {
        leave(t, i);
        const double seen = polarised ? analyser_sees(w->row[i], w->lamp[i]) : w->row[i].i;
        const double left = greater(seen, 0.0); /* of two crossed polarisers, up to rounding 0 */
        share[0][i] *= left, share[1][i] *= left, share[2][i] *= left;
    }
}

void sheets_store(tracer *t, ray_queue *q, int first, int count)
{
    const sheet_work *w = &t->media->sheets;
    if (!t->target.frame_plan->render.polarisation || w->lights)
        return;
    for (int i = 0; i < count; i++) {
        const stokes s = w->row[i];
        const double over = s.i > 0.0 ? 1.0 / s.i : 0.0;
        q->sq[first + i] = s.q * over, q->su[first + i] = s.u * over, q->sv[first + i] = s.v * over;
    }
}
