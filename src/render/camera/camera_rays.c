/* Where the rays of the camera go through the picture. */
#include "render/core/tracer_private.h"

int64_t camera_rays_a_pixel(const render_settings *r)
{
    if (integrator_of(r)->by_chance)
        return r->paths;
    return r->spectrum == SPECTRUM_SPECTRAL ? r->samples * r->wavelengths : r->samples;
}

/* The point of a pixel that a ray goes through: the middle of one of its k x k cells, line by line. */
static int64_t point_of(const render_settings *r, int64_t cells, int64_t ray)
{
    const bool wavelengths_inside = !integrator_of(r)->by_chance && r->spectrum == SPECTRUM_SPECTRAL;
    return wavelengths_inside ? ray / r->wavelengths : ray % (cells * cells);
}

/* k: how many cells a pixel has across. Fewer where there are fewer paths than samples: the first lines of cells alone
 * would move the picture. */
static int64_t cells_across(const render_settings *r)
{
    const int64_t most = integrator_of(r)->by_chance && r->paths < r->samples ? r->paths : r->samples;
    int64_t k = 1;
    while ((k + 1) * (k + 1) <= most)
        k++;
    return k;
}

void camera_rays_put_in_line(tracer *t, int y, int x0, int64_t first, int count)
{
    const plan *p = t->target.scene;
    const render_settings *r = &p->render;
    ray_queue *q = &t->waiting[0];
    double u[ROW], v[ROW];
    const double across = 2.0 * p->view.half_width / (double)r->width,
                 down = 2.0 * p->view.half_height / (double)r->height;
    const int64_t each = camera_rays_a_pixel(r), flag = integrator_of(r)->by_chance ? TICKET_SEES_LIGHTS : 0;
    const int64_t cells = cells_across(r);
    const int at = q->count;
    for (int k = 0; k < count; k++) {
        int64_t x = x0 + first + k, ray = 0;
        double sx = 0.5, sy = 0.5;
        if (each > 1) { /* else nothing needs to be divided */
            x = x0 + (first + k) / each, ray = (first + k) % each;
            const int64_t s = point_of(r, cells, ray);
            sx = ((double)(s % cells) + 0.5) / (double)cells, sy = ((double)(s / cells) + 0.5) / (double)cells;
        }
        u[k] = ((double)x + sx) * across - p->view.half_width;
        v[k] = p->view.half_height - (y + sy) * down;
        const int i = at + k;
        q->ox[i] = p->view.eye.x, q->oy[i] = p->view.eye.y, q->oz[i] = p->view.eye.z;
        q->wr[i] = q->wg[i] = q->wb[i] = 1.0 / (double)each;
        q->start[i] = FACE_NONE;
        q->ticket[i] = ticket_make((int64_t)y * r->width + x, t->by_ticket ? ray : 0);
        if (p->spectral) {
            const double *white;
            q->ticket[i] = spectra_choose(p->spectral, r, q->ticket[i], &white);
            q->wr[i] *= white[0], q->wg[i] *= white[1], q->wb[i] *= white[2];
        }
        q->ticket[i] |= flag;
        q->inside[i] = p->eye_inside;
        q->sq[i] = q->su[i] = q->sv[i] = 0.0;
    }
    t->shade->camera(&p->view, count, u, v, q->dx + at, q->dy + at, q->dz + at);
    q->count += count;
}
