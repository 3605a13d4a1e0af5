/* The mipmap of a texture: each level is the box filter of the one before, with the exact area fractions of texels if a
 * side is odd (Guthe and Heckbert, "Non-power-of-two mipmap creation", NVIDIA TR-01838-001, 2005). */
#include "base/cancel.h"
#include "image/texture_parts.h"

/* The texels of a row of `from` that one texel of the next smaller row covers, and their fractions: a texel of the
 * smaller row is n/m = 2 + 1/m texels wide if n = 2m + 1. */
typedef struct cover {
    int first, count;
    double share[3];
} cover;

static cover cover_of(int texel_index, int from, int to)
{
    if (from == to)
        return (cover){.first = texel_index, .count = 1, .share = {1.0, 0.0, 0.0}};
    if (from % 2 == 0)
        return (cover){.first = 2 * texel_index, .count = 2, .share = {0.5, 0.5, 0.0}};
    double n = from;
    return (cover){
        .first = 2 * texel_index, .count = 3, .share = {(to - texel_index) / n, to / n, (texel_index + 1) / n}};
}

static texel mean_of(const texture_level *from, cover columns, cover rows)
{
    double r = 0.0, g = 0.0, b = 0.0;
    for (int y = 0; y < rows.count; y++) {
        const texel *row = from->texels + (size_t)(rows.first + y) * (size_t)from->width + columns.first;
        for (int x = 0; x < columns.count; x++) {
            double share = rows.share[y] * columns.share[x];
            r += share * (double)row[x].r;
            g += share * (double)row[x].g;
            b += share * (double)row[x].b;
        }
    }
    return (texel){.r = (float)r, .g = (float)g, .b = (float)b};
}

void texture_build_pyramid(texture *t)
{
    for (int level = 1; level < t->levels; level++) {
        const texture_level *from = &t->level[level - 1], *to = &t->level[level];
        for (int y = 0; y < to->height && !cancel_asked(); y++) {
            cover rows = cover_of(y, from->height, to->height);
            for (int x = 0; x < to->width; x++)
                to->texels[(size_t)y * (size_t)to->width + (size_t)x] =
                    mean_of(from, cover_of(x, from->width, to->width), rows);
        }
    }
}
