/* Crossings of segments with a rectangle. */
#include "render/inspect/beam_screen.h"

#include <math.h>
#include <stdlib.h>

void beam_screen_release(beam_screen *screen)
{
    free(screen->bin);
    free(screen->color);
    screen->bin = screen->color = NULL;
}

static status prepare(beam_screen *screen, diagnostic *why)
{
    const double length = vec3_length(screen->normal);
    if (!(length > 0.0 && isfinite(length)))
        return diagnose(why, STATUS_BAD_INPUT, "give a vector that is not zero", "the screen's normal is zero");
    if (!(screen->width > 0.0 && screen->width <= 1e6 && screen->height > 0.0 && screen->height <= 1e6))
        return diagnose(why, STATUS_BAD_INPUT, "give a width and a height above 0, at most 1e6",
                        "the size of the screen is out of range");
    if (screen->columns < 1 || screen->columns > SCREEN_BINS_MAX || screen->rows < 1 || screen->rows > SCREEN_BINS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "give 1 to 512 columns and rows", "the number of bins is out of range");
    if (screen->rays_of_beam < 0 || screen->rays_of_beam > SCREEN_RAYS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "give 1 to 100000, or 0 for the beams' own number",
                        "the number of rays is out of range");
    screen->normal = vec3_scale(screen->normal, 1.0 / length);
    const vec3 level = vec3_cross(vec3_make(0, 1, 0), screen->normal);
    screen->e_u = vec3_length(level) > 1e-9 ? vec3_normalize(level) : vec3_make(1, 0, 0);
    screen->e_v = vec3_cross(screen->normal, screen->e_u);
    const size_t bins = (size_t)screen->columns * (size_t)screen->rows;
    screen->bin = calloc(bins, sizeof *screen->bin);
    screen->color = calloc(3 * bins, sizeof *screen->color);
    return screen->bin && screen->color ? STATUS_OK : out_of_memory(why);
}

/* The bin of a coordinate in -half..half; -1 outside. */
static int bin_of(double at, double size, int count)
{
    const double share = at / size + 0.5;
    return share >= 0.0 && share < 1.0 ? (int)fmin(share * count, count - 1) : -1;
}

static void expose(beam_screen *screen, const beam_ray *ray, const ray_node *node, const double rgb[3])
{
    const double slope = vec3_dot(node->direction, screen->normal);
    const double t = vec3_dot(vec3_sub(screen->centre, node->origin), screen->normal) / slope;
    const bool traced = node->end == RAY_END_HIT || node->end == RAY_END_SKY;
    if (!traced || slope == 0.0 || !(t > 0.0) || (node->end == RAY_END_HIT && t > node->hit.t))
        return;
    const vec3 at = vec3_sub(vec3_add(node->origin, vec3_scale(node->direction, t)), screen->centre);
    const int column = bin_of(vec3_dot(at, screen->e_u), screen->width, screen->columns);
    const int row = bin_of(-vec3_dot(at, screen->e_v), screen->height, screen->rows);
    if (column < 0 || row < 0)
        return;
    const double power = ray->power * beam_share_at(node, t);
    const int bin = row * screen->columns + column;
    screen->hit_count++;
    screen->received += power;
    screen->bin[bin] += power;
    for (int k = 0; k < 3; k++)
        screen->color[3 * bin + k] += power * rgb[k];
}

static status visit(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    beam_screen *screen = context;
    double rgb[3];
    (void)p;
    (void)why;
    beam_wavelength_color(ray->lambda_nm, rgb);
    screen->ray_count++;
    screen->power += ray->power;
    for (size_t i = 0; i < tree->count; i++)
        expose(screen, ray, &tree->node[i], rgb);
    return STATUS_OK;
}

status beam_screen_expose(const scene *s, isa level, beam_screen *screen, diagnostic *why)
{
    TRY(prepare(screen, why));
    return beams_each_ray(s, level, screen->rays_of_beam, visit, screen, why);
}
