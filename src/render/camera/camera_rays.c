/* Camera rays: their number per pixel, sample positions, origins and directions. */
#include "render/shade/kernels.h"
#include "render/tracer/tracer.h"

#include "optics/mueller.h"
#include "render/shade/footprints.h"

camera_sampling camera_samples(const render_settings *r)
{
    const int64_t rays_per_point = r->spectrum == SPECTRUM_SPECTRAL ? r->wavelengths : 1;
    return (camera_sampling){
        .rays = r->samples * rays_per_point, .points = r->samples, .rays_per_point = rays_per_point};
}

/* Pixels and sample keys of consecutive rays of a row, and their points within the pixels if these form a grid. */
typedef struct camera_places {
    double x[ROW], sx[ROW], sy[ROW];
    int64_t key[ROW]; /* of pixel and sample, whether the film uses the sample or not */
} camera_places;

static void place(const tracer *t, camera_sampling sampling, int64_t rays_per_pixel, int y, int x0, int64_t first,
                  int count, int64_t *sample_key, camera_places *places)
{
    const int64_t row = (int64_t)y * t->target.frame_plan->render.width, cells = cells_across(sampling.points);
    int64_t x = x0 + first / rays_per_pixel, ray = first % rays_per_pixel;
    for (int k = 0; k < count; k++) {
        places->x[k] = (double)x, places->sx[k] = 0.5, places->sy[k] = 0.5;
        places->key[k] = sample_key_make(row + x, ray);
        sample_key[k] = t->by_sample_key ? places->key[k] : sample_key_make(row + x, 0);
        if (rays_per_pixel > 1 && !sampling.jittered) { /* avoids divisions with one ray per pixel */
            const int64_t s = ray / sampling.rays_per_point % (cells * cells); /* row by row */
            places->sx[k] = ((double)(s % cells) + 0.5) / (double)cells;
            places->sy[k] = ((double)(s / cells) + 0.5) / (double)cells;
        }
        if (++ray == rays_per_pixel)
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

/* Sets the rays of a camera with a lens or with parallel rays. A single ray per pixel, and the rays of a depth buffer,
 * pass through the centre of the lens. */
static void set_lens_rays(const tracer *t, int64_t rays_per_pixel, int count, const camera_places *places,
                          const double *u, const double *v, ray_queue *q, int start)
{
    const plan *p = t->target.frame_plan;
    const camera_rays_out out = {q->ox + start, q->oy + start, q->oz + start,
                                 q->dx + start, q->dy + start, q->dz + start};
    double area[ROW], turn[ROW];
    if (p->view.lens_radius > 0.0 && rays_per_pixel > 1 && t->frame_integrator->traced) {
        t->sampling->draw(&p->draws, count, places->key, 0, DRAW_LENS, area, turn);
        t->sampling->camera_rays(&p->view, count, u, v, (lens_points){area, turn}, out);
    } else {
        camera_chief_rays(t, count, u, v, out);
    }
    for (int i = start; i < start + count && p->starts_vary; i++)
        q->inside[i] = scene_geometry_inside(p->geometry, vec3_make(q->ox[i], q->oy[i], q->oz[i]));
}

/* The row of an ideal analyser, which transmits half of unpolarised light. A left-handed analyser has a positive v
 * (optics/mueller.h). */
static stokes analyser_row(const plan *p, vec3 d)
{
    if (p->analyser == ANALYSER_LINEAR)
        return stokes_linear(d, polarisation_across_ray(p->analyser_axis, p->view.forward, d));
    return (stokes){1.0, 0.0, 0.0, p->analyser == ANALYSER_CIRCULAR_LEFT ? 1.0 : -1.0};
}

static void apply_analyser(const plan *p, int count, ray_queue *q, int start)
{
    for (int i = start; i < start + count; i++) {
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
    const camera_sampling sampling = t->frame_integrator->sampling(r);
    /* If numbers of rays differ between pixels, all of these rays are in pixel x0. */
    const int64_t rays_per_pixel =
        p->draws.by_pixel ? path_count(&p->draws, (int64_t)y * r->width + x0) : sampling.rays;
    const int start = q->count;
    place(t, sampling, rays_per_pixel, y, x0, first, count, q->sample_key + start, &places);
    if (sampling.jittered)
        t->sampling->draw(&p->draws, count, q->sample_key + start, 0, DRAW_PIXEL, places.sx, places.sy);
    for (int k = 0; k < count; k++) {
        const int i = start + k;
        q->ox[i] = p->view.eye.x, q->oy[i] = p->view.eye.y, q->oz[i] = p->view.eye.z;
        q->wr[i] = q->wg[i] = q->wb[i] = 1.0 / (double)rays_per_pixel;
        q->start[i] = FACE_NONE;
        u[k] = camera_u(&p->view, pixel, places.x[k] + places.sx[k]);
        v[k] = camera_v(&p->view, pixel, y + places.sy[k]);
        if (p->spectral) {
            const double *white;
            q->sample_key[i] = spectra_choose(p->spectral, r, q->sample_key[i], &white);
            q->wr[i] *= white[0], q->wg[i] *= white[1], q->wb[i] *= white[2];
        }
        q->sample_key[i] |= sampling.marks;
        q->inside[i] = p->eye_inside;
        q->sq[i] = q->su[i] = q->sv[i] = 0.0;
    }
    if (p->view.parallel || p->view.lens_radius > 0.0)
        set_lens_rays(t, rays_per_pixel, count, &places, u, v, q, start);
    else
        t->sampling->camera_directions(&p->view, count, u, v, q->dx + start, q->dy + start, q->dz + start);
    if (p->analyser != ANALYSER_NONE)
        apply_analyser(p, count, q, start);
    if (t->footprints)
        footprints_of_camera(t, q, start, count);
    q->count += count;
}
