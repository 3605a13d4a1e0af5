/* Camera rays: their number per pixel, sample positions and directions. */
#include "render/shade/shading.h"

camera_sampling camera_samples(const render_settings *r)
{
    const int64_t together = r->spectrum == SPECTRUM_SPECTRAL ? r->wavelengths : 1;
    return (camera_sampling){.rays = r->samples * together, .points = r->samples, .together = together};
}

/* Cells along one side of the largest square grid with at most `points` cells. */
static int64_t cells_across(int64_t points)
{
    int64_t k = 1;
    while ((k + 1) * (k + 1) <= points)
        k++;
    return k;
}

void camera_rays_enqueue(tracer *t, int y, int x0, int64_t first, int count)
{
    const plan *p = t->target.frame_plan;
    const render_settings *r = &p->render;
    ray_queue *q = &t->queues.waiting[0];
    double u[ROW], v[ROW];
    const camera_pixel pixel = camera_pixel_of(&p->view, r);
    const camera_sampling need = t->rule->sampling(r);
    /* If pixels have their own numbers of rays, all of these are in pixel x0. */
    const int64_t each = p->draws.by_pixel ? path_count(&p->draws, (int64_t)y * r->width + x0) : need.rays,
                  cells = cells_across(need.points);
    const int at = q->count;
    for (int k = 0; k < count; k++) {
        int64_t x = x0 + first + k, ray = 0;
        double sx = 0.5, sy = 0.5;
        if (each > 1) { /* avoids divisions with one ray per pixel */
            x = x0 + (first + k) / each, ray = (first + k) % each;
            const int64_t s = ray / need.together % (cells * cells); /* row by row */
            sx = ((double)(s % cells) + 0.5) / (double)cells, sy = ((double)(s / cells) + 0.5) / (double)cells;
        }
        const int i = at + k;
        q->ox[i] = p->view.eye.x, q->oy[i] = p->view.eye.y, q->oz[i] = p->view.eye.z;
        q->wr[i] = q->wg[i] = q->wb[i] = 1.0 / (double)each;
        q->start[i] = FACE_NONE;
        q->sample_key[i] = sample_key_make((int64_t)y * r->width + x, t->by_sample_key ? ray : 0);
        if (need.jittered) {
            const unit_pair point = path_draw(&p->draws, q->sample_key[i], 0, DRAW_PIXEL);
            sx = point.u, sy = point.v;
        }
        u[k] = camera_u(&p->view, pixel, (double)x + sx);
        v[k] = camera_v(&p->view, pixel, y + sy);
        if (p->spectral) {
            const double *white;
            q->sample_key[i] = spectra_choose(p->spectral, r, q->sample_key[i], &white);
            q->wr[i] *= white[0], q->wg[i] *= white[1], q->wb[i] *= white[2];
        }
        q->sample_key[i] |= need.marks;
        q->inside[i] = p->eye_inside;
        q->sq[i] = q->su[i] = q->sv[i] = 0.0;
    }
    t->shade->camera(&p->view, count, u, v, q->dx + at, q->dy + at, q->dz + at);
    q->count += count;
}
