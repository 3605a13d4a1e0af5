/* Sums of the map up to every corner, so that a tile's cost takes four of them. */
#include "cost_map.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static status not_a_map(const char *path, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "make it with experiments/cluster/simulated/measure.sh",
                    "%s is not a map of costs", path);
}

static bool read_head(FILE *f, cost_map *m, double *unit)
{
    int most = 0;
    return fscanf(f, "P2 # unit %lf # paths %lf %d %d %d", unit, &m->paths, &m->width, &m->height, &most) == 5 &&
           most > 0 && m->width > 0 && m->height > 0 && m->width <= 8192 && m->height <= 8192 && *unit > 0.0 &&
           m->paths >= 1.0;
}

static double *corner(const cost_map *m, int x, int y)
{
    return &m->before[(size_t)y * (size_t)(m->width + 1) + (size_t)x];
}

static bool read_values(FILE *f, cost_map *m, double unit)
{
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            int value = 0;
            if (fscanf(f, "%d", &value) != 1 || value < 0)
                return false;
            *corner(m, x + 1, y + 1) = unit * value + *corner(m, x, y + 1) + *corner(m, x + 1, y) - *corner(m, x, y);
        }
    return true;
}

status cost_map_read(const char *path, cost_map *m, diagnostic *why)
{
    double unit = 0.0;
    *m = (cost_map){0};
    FILE *f = fopen(path, "r");
    if (!f)
        return diagnose(why, STATUS_BAD_INPUT, "name an existing map of costs", "%s cannot be opened", path);
    bool good = read_head(f, m, &unit);
    m->before = good ? calloc((size_t)(m->width + 1) * (size_t)(m->height + 1), sizeof *m->before) : NULL;
    good = m->before && read_values(f, m, unit);
    fclose(f);
    return good ? STATUS_OK : not_a_map(path, why);
}

void cost_map_release(cost_map *m)
{
    free(m->before);
    m->before = NULL;
}

/* The sum above and left of a point, which is linear in each coordinate inside a pixel. */
static double before(const cost_map *m, double x, double y)
{
    const double across = x * m->width, down = y * m->height;
    const int i = (int)fmin(across, m->width - 1), j = (int)fmin(down, m->height - 1);
    const double u = across - i, v = down - j;
    return (1 - v) * ((1 - u) * *corner(m, i, j) + u * *corner(m, i + 1, j)) +
           v * ((1 - u) * *corner(m, i, j + 1) + u * *corner(m, i + 1, j + 1));
}

double cost_map_mean_ns(const cost_map *m, double x0, double y0, double x1, double y1)
{
    const double sum = before(m, x1, y1) - before(m, x0, y1) - before(m, x1, y0) + before(m, x0, y0);
    return sum / ((x1 - x0) * (y1 - y0) * m->width * m->height);
}
