/* The steps of a z-buffer frame: chunks of triangles, the grid, sorting triangles into squares. */
#include "render/zbuffer/zbuffer_private.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static status no_room(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "render a smaller image or fewer triangles",
                    "out of memory for the depth buffer");
}

static uint64_t triangles_of(const rasterised_part *p)
{
    return (uint64_t)zbuffer_part_triangles(p) * p->at.copies[0] * p->at.copies[1] * p->at.copies[2];
}

static bool make_chunks(zbuffer *z)
{
    for (int k = 0; k < z->part_count; k++)
        z->chunk_count += (triangles_of(&z->parts[k]) + CHUNK_TRIANGLES - 1) / CHUNK_TRIANGLES;
    z->chunks = calloc(z->chunk_count + 1, sizeof *z->chunks);
    if (!z->chunks)
        return false;
    size_t at = 0;
    for (int k = 0; k < z->part_count; k++) {
        const uint64_t all = triangles_of(&z->parts[k]);
        for (uint64_t first = 0; first < all; first += CHUNK_TRIANGLES)
            z->chunks[at++] = (chunk){.part = k,
                                      .count = (int)(all - first < CHUNK_TRIANGLES ? all - first : CHUNK_TRIANGLES),
                                      .first = first};
    }
    return true;
}

static void make_grid(zbuffer *z)
{
    const plan *p = z->frame_plan;
    z->points = (int)cells_across(p->render.samples);
    z->side = SQUARE_POINTS / z->points < SQUARE_PIXELS ? SQUARE_POINTS / z->points : SQUARE_PIXELS;
    z->width = (int)p->render.width * z->points;
    z->height = (int)p->render.height * z->points;
    z->units_x = 0.5 * z->width / p->view.half_width;
    z->units_y = 0.5 * z->height / p->view.half_height;
    z->reach_x = REACH / z->units_x;
    z->reach_y = REACH / z->units_y;
    z->across = ((int)p->render.width + z->side - 1) / z->side;
    z->down = ((int)p->render.height + z->side - 1) / z->side;
}

status zbuffer_create(const plan *p, zbuffer **out, diagnostic *why)
{
    zbuffer *z = calloc(1, sizeof *z);
    if (!z)
        return no_room(why);
    z->frame_plan = p;
    make_grid(z);
    if (z->width > 2 * REACH || z->height > 2 * REACH) {
        zbuffer_destroy(z);
        return diagnose(why, STATUS_BAD_INPUT, "use fewer samples or a smaller image",
                        "the depth buffer is limited to %d points per side", 2 * REACH);
    }
    z->seen = malloc((size_t)z->width * (size_t)z->height * sizeof *z->seen);
    z->first = calloc((size_t)z->across * (size_t)z->down + 1, sizeof *z->first);
    zbuffer_find_layers(z);
    if (z->layered)
        z->blocks = calloc(BLOCKS_MAX, sizeof(rasterised_layer *));
    status code = z->seen && z->first && (z->blocks || !z->layered) ? zbuffer_cut(z, why) : no_room(why);
    if (code == STATUS_OK && !make_chunks(z))
        code = no_room(why);
    if (code != STATUS_OK) {
        zbuffer_destroy(z);
        return code;
    }
    *out = z;
    return STATUS_OK;
}

void zbuffer_destroy(zbuffer *z)
{
    if (!z)
        return;
    for (size_t k = 0; z->chunks && k < z->chunk_count; k++)
        free(z->chunks[k].screen);
    for (int k = 0; k < z->part_count; k++)
        mesh_release(z->parts[k].tessellation);
    for (size_t k = 0; z->blocks && k < BLOCKS_MAX; k++)
        free(z->blocks[k]);
    free(z->blocks);
    free(z->chunks);
    free(z->triangles);
    free(z->first);
    free(z->listed);
    free(z->seen);
    free(z);
}

/* Concatenates the triangles of all chunks, in the chunks' order. */
static bool join_chunks(zbuffer *z)
{
    for (size_t k = 0; k < z->chunk_count; k++)
        z->triangle_count += z->chunks[k].screen_count;
    z->triangles = malloc((z->triangle_count + 1) * sizeof *z->triangles);
    if (!z->triangles || z->triangle_count >= SEEN_LAYERS - 1)
        return false;
    size_t at = 0;
    z->first_layered = z->triangle_count;
    for (size_t k = 0; k < z->chunk_count; k++) {
        chunk *c = &z->chunks[k];
        if (c->part == z->first_layered_part && at < z->first_layered)
            z->first_layered = at;
        if (c->screen_count)
            memcpy(z->triangles + at, c->screen, c->screen_count * sizeof *c->screen);
        at += c->screen_count;
        free(c->screen);
        c->screen = NULL;
    }
    return true;
}

typedef struct box {
    int x0, y0, x1, y1;
} box; /* of squares, inclusive */

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v < most ? v : most;
}

static box squares_of(const zbuffer *z, const screen_triangle *t)
{
    const int steps = SUBPIXEL * z->side * z->points;
    int x0 = INT_MAX, y0 = INT_MAX, x1 = INT_MIN, y1 = INT_MIN;
    for (int k = 0; k < 3; k++) {
        x0 = t->x[k] < x0 ? t->x[k] : x0, x1 = t->x[k] > x1 ? t->x[k] : x1;
        y0 = t->y[k] < y0 ? t->y[k] : y0, y1 = t->y[k] > y1 ? t->y[k] : y1;
    }
    return (box){clamp(x0 / steps, z->across - 1), clamp(y0 / steps, z->down - 1), clamp(x1 / steps, z->across - 1),
                 clamp(y1 / steps, z->down - 1)};
}

status zbuffer_sort(zbuffer *z, diagnostic *why)
{
    if (atomic_load(&z->out_of_memory) || !join_chunks(z))
        return no_room(why);
    const size_t squares = (size_t)z->across * (size_t)z->down;
    for (size_t i = 0; i < z->triangle_count; i++) {
        const box b = squares_of(z, &z->triangles[i]);
        for (int y = b.y0; y <= b.y1; y++)
            for (int x = b.x0; x <= b.x1; x++)
                z->first[(size_t)y * (size_t)z->across + (size_t)x]++;
    }
    size_t sum = 0;
    for (size_t k = 0; k <= squares; k++) { /* for now, the end of each square's list */
        sum += k < squares ? z->first[k] : 0;
        z->first[k] = sum;
    }
    z->listed = malloc((sum + 1) * sizeof *z->listed);
    if (!z->listed)
        return no_room(why);
    for (size_t i = z->triangle_count; i-- > 0;) {
        const box b = squares_of(z, &z->triangles[i]);
        for (int y = b.y0; y <= b.y1; y++)
            for (int x = b.x0; x <= b.x1; x++)
                z->listed[--z->first[(size_t)y * (size_t)z->across + (size_t)x]] = (uint32_t)i;
    }
    return STATUS_OK;
}

size_t zbuffer_triangles(const zbuffer *z)
{
    return z->triangle_count;
}

size_t zbuffer_bytes(const zbuffer *z)
{
    const size_t squares = (size_t)z->across * (size_t)z->down;
    return (size_t)z->width * (size_t)z->height * sizeof *z->seen +
           atomic_load(&z->layer_count) * sizeof(rasterised_layer) + z->triangle_count * sizeof *z->triangles +
           z->first[squares] * sizeof *z->listed + (squares + 1) * sizeof *z->first;
}

bool zbuffer_failed(const zbuffer *z)
{
    return atomic_load(&z->out_of_memory);
}
