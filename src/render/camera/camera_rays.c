/* Camera rays: their number per pixel, sample positions, origins and directions. */
#include "render/camera/camera_rays.h"

#include "optics/mueller.h"
#include "render/shade/footprints.h"

camera_sampling camera_samples(const render_settings *r)
{
    const int64_t rays_per_point = r->spectrum == SPECTRUM_SPECTRAL ? r->wavelengths : 1;
    return (camera_sampling){
        .rays = r->samples * rays_per_point, .points = r->samples, .rays_per_point = rays_per_point};
}

/* Pixels and sample keys of consecutive rays of a row, and the points within the pixels where these are a grid. */
typedef struct camera_places {
    double x[ROW], sx[ROW], sy[ROW];
    int64_t key[ROW]; /* of pixel and sample, whether the film uses the sample or not */
} camera_places;

static void place(const tracer *t, camera_sampling need, int64_t each, int y, int x0, int64_t first, int count,
                  int64_t *sample_key, camera_places *at)
{
    const int64_t row = (int64_t)y * t->target.frame_plan->render.width, cells = cells_across(need.points);
    int64_t x = x0 + first / each, ray = first % each;
    for (int k = 0; k < count; k++) {
        at->x[k] = (double)x, at->sx[k] = 0.5, at->sy[k] = 0.5;
        at->key[k] = sample_key_make(row + x, ray);
        sample_key[k] = t->by_sample_key ? at->key[k] : sample_key_make(row + x, 0);
        if (each > 1 && !need.jittered) {                                  /* avoids divisions with one ray per pixel */
            const int64_t s = ray / need.rays_per_point % (cells * cells); /* row by row */
            at->sx[k] = ((double)(s % cells) + 0.5) / (double)cells;
            at->sy[k] = ((double)(s / cells) + 0.5) / (double)cells;
        }
        if (++ray == each)
            ray = 0, x++;
    }
}

void camera_chief_rays(const tracer *t, int count, const double *u, const double *v, camera_rays_out out)
{
    camera_frame view = t->target.frame_plan->view;
    double centre[ROW];
    view.lens_radius = 0.0;
    for (int k = 0; k < count; k++)
        centre[k] = 0.0;
    t->sampling->camera_rays(&view, count, u, v, (lens_points){centre, centre}, out);
}

/* Rays of a camera that is no pinhole in perspective. One ray per pixel, and those of a depth buffer or of layers, pass
 * through the centre of the lens. */
static void leave_lens(const tracer *t, int64_t each, int count, const camera_places *places, const double *u,
                       const double *v, ray_queue *q, int at)
{
    const plan *p = t->target.frame_plan;
    const camera_rays_out out = {q->ox + at, q->oy + at, q->oz + at, q->dx + at, q->dy + at, q->dz + at};
    double area[ROW], turn[ROW];
    if (p->view.lens_radius > 0.0 && each > 1 && t->rule->traced) {
        t->sampling->draw(&p->draws, count, places->key, 0, DRAW_LENS, area, turn);
        t->sampling->camera_rays(&p->view, count, u, v, (lens_points){area, turn}, out);
    } else {
        camera_chief_rays(t, count, u, v, out);
    }
    for (int i = at; i < at + count && p->starts_vary; i++)
        q->inside[i] = scene_geometry_inside(p->geometry, vec3_make(q->ox[i], q->oy[i], q->oz[i]));
}

/* The row of an ideal analyser: it transmits half of unpolarised light. A left-handed one's v is positive
 * (optics/mueller.h). */
static stokes analyser_row(const plan *p, vec3 d)
{
    if (p->analyser == ANALYSER_LINEAR)
        return stokes_linear(d, polarisation_across_ray(p->analyser_axis, p->view.forward, d));
    return (stokes){1.0, 0.0, 0.0, p->analyser == ANALYSER_CIRCULAR_LEFT ? 1.0 : -1.0};
}

static void put_analyser(const plan *p, int count, ray_queue *q, int at)
{
    for (int i = at; i < at + count; i++) {
        const stokes row = analyser_row(p, vec3_make(q->dx[i], q->dy[i], q->dz[i]));
        q->wr[i] *= 0.5, q->wg[i] *= 0.5, q->wb[i] *= 0.5;
        q->sq[i] = row.q, q->su[i] = row.u, q->sv[i] = row.v;
    }
}

void camera_rays_enqueue(tracer *t, int y, int x0, int64_t first, int count)
{
    const plan *p = t->target.frame_plan;
    const render_settings *r = &p->render;
    ray_queue *q = &t->queues.waiting[0];
    camera_places places;
    double u[ROW], v[ROW];
    const camera_pixel pixel = camera_pixel_of(&p->view, r);
    const camera_sampling need = t->rule->sampling(r);
    /* If pixels have their own numbers of rays, all of these are in pixel x0. */
    const int64_t each = p->draws.by_pixel ? path_count(&p->draws, (int64_t)y * r->width + x0) : need.rays;
    const int at = q->count;
    place(t, need, each, y, x0, first, count, q->sample_key + at, &places);
    if (need.jittered)
        t->sampling->draw(&p->draws, count, q->sample_key + at, 0, DRAW_PIXEL, places.sx, places.sy);
    for (int k = 0; k < count; k++) {
        const int i = at + k;
        q->ox[i] = p->view.eye.x, q->oy[i] = p->view.eye.y, q->oz[i] = p->view.eye.z;
        q->wr[i] = q->wg[i] = q->wb[i] = 1.0 / (double)each;
        q->start[i] = FACE_NONE;
        u[k] = camera_u(&p->view, pixel, places.x[k] + places.sx[k]);
        v[k] = camera_v(&p->view, pixel, y + places.sy[k]);
        if (p->spectral) {
            const double *white;
            q->sample_key[i] = spectra_choose(p->spectral, r, q->sample_key[i], &white);
            q->wr[i] *= white[0], q->wg[i] *= white[1], q->wb[i] *= white[2];
        }
        q->sample_key[i] |= need.marks;
        q->inside[i] = p->eye_inside;
        q->sq[i] = q->su[i] = q->sv[i] = 0.0;
    }
    if (p->view.parallel || p->view.lens_radius > 0.0)
        leave_lens(t, each, count, &places, u, v, q, at);
    else
        t->sampling->camera_directions(&p->view, count, u, v, q->dx + at, q->dy + at, q->dz + at);
    if (p->analyser != ANALYSER_NONE)
        put_analyser(p, count, q, at);
    if (t->footprints)
        footprints_of_camera(t, q, at, count);
    q->count += count;
}
