/* Rasterisation: the grid points that each triangle covers, and the nearest triangle at each point. */
#include "render/zbuffer/zbuffer_private.h"

#include "base/lanes.h"
#include <math.h>

typedef struct window {
    int x0, y0, x1, y1;
} window; /* grid points, x0 <= x < x1 */

/* An edge function: dx (y - ya) - dy (x - xa), in steps; not negative inside. */
typedef struct edge {
    int64_t along_x, along_y, at;
} edge; /* increments per unit of the grid, and the value at the first point */

/* A point on an edge belongs to the triangle whose top or left edge it is. */
static edge edge_between(const screen_triangle *t, int from, int to, int x, int y)
{
    const int64_t dx = t->x[to] - t->x[from], dy = t->y[to] - t->y[from];
    const int64_t px = (int64_t)x * SUBPIXEL + SUBPIXEL / 2 - t->x[from],
                  py = (int64_t)y * SUBPIXEL + SUBPIXEL / 2 - t->y[from];
    const bool owns = dy < 0 || (dy == 0 && dx > 0);
    return (edge){-dy * SUBPIXEL, dx * SUBPIXEL, dx * py - dy * px - (owns ? 0 : 1)};
}

static int64_t floor_divide(int64_t a, int64_t b) /* b > 0 */
{
    return a / b - (a % b < 0);
}

/* Narrows a row's range of points, first + from .. first + to, to those inside the edge. */
static void narrow(const edge *e, int64_t *from, int64_t *to)
{
    if (e->along_x == 0 && e->at < 0) {
        *to = *from - 1;
    } else if (e->along_x < 0) {
        const int64_t last = floor_divide(e->at, -e->along_x);
        *to = last < *to ? last : *to;
    } else if (e->along_x > 0) {
        const int64_t first = -floor_divide(e->at, e->along_x);
        *from = first > *from ? first : *from;
    }
}

static window box_of(const screen_triangle *t, const window *w)
{
    window b = {t->x[0], t->y[0], t->x[0], t->y[0]};
    for (int k = 1; k < 3; k++) {
        b.x0 = t->x[k] < b.x0 ? t->x[k] : b.x0, b.x1 = t->x[k] > b.x1 ? t->x[k] : b.x1;
        b.y0 = t->y[k] < b.y0 ? t->y[k] : b.y0, b.y1 = t->y[k] > b.y1 ? t->y[k] : b.y1;
    }
    const int half = SUBPIXEL / 2;
    b = (window){(b.x0 + half - 1) >> 12, (b.y0 + half - 1) >> 12, ((b.x1 - half) >> 12) + 1,
                 ((b.y1 - half) >> 12) + 1};
    return (window){b.x0 > w->x0 ? b.x0 : w->x0, b.y0 > w->y0 ? b.y0 : w->y0, b.x1 < w->x1 ? b.x1 : w->x1,
                    b.y1 < w->y1 ? b.y1 : w->y1};
}

static void draw_triangle(zbuffer *z, uint32_t number, const window *w, zbuffer_square *square)
{
    const screen_triangle *t = &z->triangles[number];
    const window b = box_of(t, w);
    if (b.x0 >= b.x1 || b.y0 >= b.y1)
        return;
    edge e[3] = {edge_between(t, 0, 1, b.x0, b.y0), edge_between(t, 1, 2, b.x0, b.y0),
                 edge_between(t, 2, 0, b.x0, b.y0)};
    const double a = t->a, least = t->least, most = t->most;
    const bool layered = number >= z->first_layered;
    for (int y = b.y0; y < b.y1; y++) {
        int64_t from = 0, to = b.x1 - b.x0 - 1;
        for (int k = 0; k < 3; k++)
            narrow(&e[k], &from, &to);
        const double row = t->b * (y + 0.5) + t->c;
        const int row_at = (y - w->y0) * (w->x1 - w->x0) - w->x0 + b.x0;
        double *nearness = square->nearness + row_at;
        uint32_t *seen = z->seen + (size_t)y * (size_t)z->width + b.x0;
        for (int64_t k = from; k <= to && layered; k++) {
            const double near = lesser(greater(a * ((double)(b.x0 + k) + 0.5) + row, least), most);
            if (near >= nearness[k])
                zbuffer_add_fragment(z, square, row_at + (int)k, near, number);
        }
        for (int64_t k = from; k <= to && !layered; k++) {
            const double near = lesser(greater(a * ((double)(b.x0 + k) + 0.5) + row, least), most);
            if (near > nearness[k]) {
                nearness[k] = near;
                seen[k] = number + 1;
            }
        }
        for (int k = 0; k < 3; k++)
            e[k].at += e[k].along_y;
    }
}

static void draw_square(zbuffer *z, int x, int y, const window *w, zbuffer_square *square)
{
    const size_t at = (size_t)y * (size_t)z->across + (size_t)x;
    const int points = (w->x1 - w->x0) * (w->y1 - w->y0);
    for (int k = 0; k < points; k++)
        square->nearness[k] = -HUGE_VAL; /* points at infinity still count as visible */
    for (int k = 0; k < points && z->layered; k++)
        square->newest[k] = -1;
    square->count = 0;
    for (int row = w->y0; row < w->y1; row++)
        for (int k = w->x0; k < w->x1; k++)
            z->seen[(size_t)row * (size_t)z->width + (size_t)k] = 0;
    for (size_t k = z->first[at]; k < z->first[at + 1]; k++)
        draw_triangle(z, z->listed[k], w, square);
    if (z->layered)
        zbuffer_resolve(z, w->x0, w->y0, w->x1, w->y1, square);
}

void zbuffer_draw(zbuffer *z, const image_tile *tile, zbuffer_square *square)
{
    const int side = z->side, n = z->points;
    for (int y = tile->y0 / side; y * side < tile->y1; y++) {
        for (int x = tile->x0 / side; x * side < tile->x1; x++) {
            const int x0 = x * side > tile->x0 ? x * side : tile->x0,
                      x1 = (x + 1) * side < tile->x1 ? (x + 1) * side : tile->x1;
            const int y0 = y * side > tile->y0 ? y * side : tile->y0,
                      y1 = (y + 1) * side < tile->y1 ? (y + 1) * side : tile->y1;
            draw_square(z, x, y, &(window){x0 * n, y0 * n, x1 * n, y1 * n}, square);
        }
    }
}
