/* Camera rays: their number per pixel, sample positions and directions. */
#include "render/shade/path_kernels.h"
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

/* Pixels and sample keys of consecutive rays of a row, and the points within the pixels where these are a grid. */
typedef struct camera_places {
    double x[ROW], sx[ROW], sy[ROW];
} camera_places;

static void place(const tracer *t, camera_sampling need, int64_t each, int y, int x0, int64_t first, int count,
                  int64_t *sample_key, camera_places *at)
{
    const int64_t row = (int64_t)y * t->target.frame_plan->render.width, cells = cells_across(need.points);
    int64_t x = x0 + first / each, ray = first % each;
    for (int k = 0; k < count; k++) {
        at->x[k] = (double)x, at->sx[k] = 0.5, at->sy[k] = 0.5;
        sample_key[k] = sample_key_make(row + x, t->by_sample_key ? ray : 0);
        if (each > 1 && !need.jittered) {                            /* avoids divisions with one ray per pixel */
            const int64_t s = ray / need.together % (cells * cells); /* row by row */
            at->sx[k] = ((double)(s % cells) + 0.5) / (double)cells;
            at->sy[k] = ((double)(s / cells) + 0.5) / (double)cells;
        }
        if (++ray == each)
            ray = 0, x++;
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
        t->path->draw(&p->draws, count, q->sample_key + at, 0, DRAW_PIXEL, places.sx, places.sy);
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
    t->shade->camera(&p->view, count, u, v, q->dx + at, q->dy + at, q->dz + at);
    q->count += count;
}
