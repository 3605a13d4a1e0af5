/* Lines with soft edges, tested by pixel against the distance of opaque surfaces. */
#include "render/inspect/beam_drawing.h"

#include "render/inspect/ray_line.h"
#include "scene/model/camera.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>

/* Share of a line's colour where it is hidden. */
#define HIDDEN 0.15
/* A segment starts or ends on the surface that would hide it. */
#define ON_SURFACE 1e-3

typedef struct beam_canvas {
    const scene *s;
    const float *distance;
    image *img;
    camera_frame view;
    image_frame frame;
    double half_width; /* of a line, px */
} beam_canvas;

status beams_hiding_scene(const scene *s, scene **out, diagnostic *why)
{
    scene *only = scene_clone(s);
    if (!only)
        return out_of_memory(why);
    render_settings *r = &only->render;
    for (size_t i = 0; i < only->solid_count; i++)
        only->solids[i].visible = only->solids[i].visible && material_is_opaque(&only->solids[i].surface);
    r->polarisation = 0;
    r->spectrum = SPECTRUM_RGB;
    r->samples = 1;
    *out = only;
    return scene_set(only, "render.integrator", "aov", why);
}

static void blend(beam_canvas *c, int x, int y, double distance, double cover, const double rgb[3])
{
    const size_t pixel = (size_t)y * (size_t)c->img->width + (size_t)x;
    const double surface = c->distance[pixel];
    const double share = surface > 0.0 && distance > surface * (1.0 + ON_SURFACE) ? HIDDEN * cover : cover;
    float *at = c->img->pixel + 3 * pixel;
    for (int k = 0; k < 3; k++)
        at[k] = (float)(at[k] * (1.0 - share) + rgb[k] * share);
}

/* The distance from the camera in a pixel at a share of the line a .. b in the image, whose z are depths: along it
 * 1 / z is linear in perspective, and z under parallel rays. */
static double distance_at(const beam_canvas *c, int x, int y, vec3 a, vec3 b, double t)
{
    if (c->view.parallel)
        return t > 0.0 ? (1.0 - t) * a.z + t * b.z : a.z;
    const double u = ((x + 0.5) / c->img->width * 2.0 - 1.0) * c->view.half_width;
    const double v = (1.0 - (y + 0.5) / c->img->height * 2.0) * c->view.half_height;
    return sqrt(1.0 + u * u + v * v) / ((1.0 - t) / a.z + t / b.z);
}

/* The pixels near a line a .. b. */
static void draw_line(beam_canvas *c, vec3 a, vec3 b, double strength, const double rgb[3])
{
    const double dx = b.x - a.x, dy = b.y - a.y, size = dx * dx + dy * dy, reach = c->half_width + 1.0;
    const int x0 = (int)fmax(0.0, floor(fmin(a.x, b.x) - reach)), y0 = (int)fmax(0.0, floor(fmin(a.y, b.y) - reach));
    const int x1 = (int)fmin(c->img->width, ceil(fmax(a.x, b.x) + reach));
    const int y1 = (int)fmin(c->img->height, ceil(fmax(a.y, b.y) + reach));
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
            const double t = size > 0.0 ? fmin(1.0, fmax(0.0, (px * dx + py * dy) / size)) : 0.0;
            const double away = hypot(px - t * dx, py - t * dy), cover = fmin(1.0, c->half_width + 0.5 - away);
            if (cover > 0.0)
                blend(c, x, y, distance_at(c, x, y, a, b, t), cover * strength, rgb);
        }
}

static status draw_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    beam_canvas *c = context;
    const beam *b = &c->s->beams[ray->beam];
    double rgb[3];
    (void)p;
    (void)why;
    beam_line_color(b, ray->lambda_nm, rgb);
    const double start = beam_share(&tree->node[0]);
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (node->end != RAY_END_HIT && node->end != RAY_END_SKY)
            continue;
        const ray_line line = ray_line_of(node);
        vec3 ends[2];
        if (ray_line_seen(&line, &c->view, &c->frame, ends))
            draw_line(c, ends[0], ends[1], 0.25 + 0.75 * sqrt(fmin(1.0, beam_share(node) / start)), rgb);
    }
    return STATUS_OK;
}

status beams_draw(const scene *s, isa level, const float *distance, image *img, diagnostic *why)
{
    beam_canvas c = {.s = s, .distance = distance, .img = img, .view = camera_frame_of(s)};
    c.half_width = fmax(0.6, img->height / 800.0);
    /* A line whose middle is just outside the image still covers pixels. */
    c.frame = image_frame_of(img->width, img->height, c.half_width + 1.0);
    return beams_each_ray(s, level, 0, draw_ray, &c, why);
}
