/* The tiles of a shared frame and their sum. */
#include "render/core/shared_frame.h"

#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

render_settings tiles_settings(const render_settings *r, int side)
{
    render_settings settings = *r;
    settings.schedule = SCHEDULE_DYNAMIC;
    settings.tile = side;
    settings.pieces = 0;
    settings.threads = 1;
    return settings;
}

status shared_frame_begin(const scene *s, int side, shared_frame *out, diagnostic *why)
{
    const render_settings settings = tiles_settings(&s->render, side);
    schedule_start(&out->places, &settings);
    return renderer_film(s, &out->img, &out->variance, why);
}

void shared_frame_release(shared_frame *f)
{
    film_destroy(f->img);
    free(f->variance);
    f->img = NULL;
    f->variance = NULL;
}

static size_t sums_of(const span *at)
{
    return 3 * (size_t)(at->x1 - at->x0) * (size_t)(at->y1 - at->y0);
}

size_t shared_frame_values(const shared_frame *f, int64_t tile)
{
    span at;
    return schedule_tile(&f->places, tile, &at) ? sums_of(&at) * (f->variance ? 2 : 1) : 0;
}

static void put_variance(const shared_frame *f, const span *at, const int64_t *values)
{
    const size_t length = 3 * (size_t)(at->x1 - at->x0);
    for (int y = at->y0; y < at->y1; y++, values += length)
        memcpy(&f->variance[3 * ((size_t)y * (size_t)f->img->width + (size_t)at->x0)], values,
               length * sizeof *f->variance);
}

void shared_frame_put(shared_frame *f, int64_t tile, const int64_t *values)
{
    span at;
    if (!schedule_tile(&f->places, tile, &at))
        return;
    film_put_piece(f->img, at.x0, at.y0, at.x1, at.y1, values);
    if (f->variance)
        put_variance(f, &at, values + sums_of(&at));
}
