/* The rays of beams, with a probe per wavelength; their crossings of a screen; and their drawing as lines with soft
 * edges, with a depth test per pixel against opaque surfaces. */
#include "render/inspect/beams.h"

#include "optics/spectrum.h"
#include "render/inspect/ray_line.h"
#include "render/plan/ray_axes.h"
#include "scene/model/camera.h"
#include "scene/model/edit/edit.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>

static const char smaller_tree[] = "use a smaller depth or a larger min_fraction";

/* Creates a probe without lights, so that no shadow rays are traced. */
static status probe_of_beam(const scene *s, const beam *b, double lambda_nm, isa level, probe **out, diagnostic *why)
{
    scene *unlit = scene_clone(s);
    status code = unlit ? STATUS_OK : out_of_memory(why);
    while (code == STATUS_OK && unlit->light_count > 0)
        code = scene_remove(unlit, unlit->lights[unlit->light_count - 1].name, why);
    if (code == STATUS_OK) {
        unlit->render.lambda_nm = lambda_nm;
        unlit->render.min_weight = b->min_fraction;
        code = probe_create(unlit, level, out, why);
    }
    if (code == STATUS_OK) {
        probe_limit_depth(*out, (int)b->depth, smaller_tree);
        probe_use_one_wavelength(*out);
    }
    scene_destroy(unlit);
    return code;
}

static void start_of(const beam *b, const ray_axes *a, const beam_ray *ray, vec3 *origin, vec3 *direction)
{
    const bool spreads = !beam_is_parallel(b);
    const double size = spreads ? b->angle_deg : b->width;
    if (b->kind == BEAM_FAN || b->kind == BEAM_SHEET)
        ray_axes_in_plane(a, spreads, size, ray->number, ray->rays, origin, direction);
    else
        ray_axes_round(a, spreads, size, ray->number, ray->rays, origin, direction);
}

typedef struct beam_work {
    beam_visit *visit;
    void *context;
    ray_tree tree;
    size_t segments; /* of all rays so far */
    diagnostic *why;
} beam_work;

static status visit_ray(beam_work *w, const beam *b, const ray_axes *a, const beam_ray *ray, probe *p)
{
    vec3 origin, direction;
    start_of(b, a, ray, &origin, &direction);
    const status code = b->branches ? probe_ray(p, origin, direction, &w->tree, w->why)
                                    : probe_path(p, origin, direction, -1, &w->tree, w->why);
    if (code == STATUS_BAD_INPUT && w->tree.count >= PROBE_NODES_MAX)
        return diagnose(w->why, code, smaller_tree, "a ray of beam '%s' has more than %d segments", b->name,
                        (int)PROBE_NODES_MAX);
    if (code != STATUS_OK)
        return code;
    w->segments += w->tree.count;
    if (w->segments > BEAMS_SEGMENTS_MAX)
        return diagnose(w->why, STATUS_BAD_INPUT, "use fewer rays, a smaller depth or a larger min_fraction",
                        "the beams have more than %d segments", BEAMS_SEGMENTS_MAX);
    return w->visit(w->context, ray, &w->tree, p, w->why);
}

static status visit_wavelength(beam_work *w, const scene *s, isa level, const beam *b, const ray_axes *a, beam_ray ray)
{
    probe *p = NULL;
    status code = probe_of_beam(s, b, ray.lambda_nm, level, &p, w->why);
    for (; ray.number < ray.rays && code == STATUS_OK; ray.number++)
        code = visit_ray(w, b, a, &ray, p);
    probe_destroy(p);
    return code;
}

static status visit_beam(beam_work *w, const scene *s, isa level, int index, int rays)
{
    const beam *b = &s->beams[index];
    const int waves = beam_wavelengths(b), count = rays > 0 ? rays : (int)b->rays;
    const bool is_flat = b->kind == BEAM_FAN || b->kind == BEAM_SHEET;
    const bool has_normal = is_flat && vec3_dot(b->normal, b->normal) > 0.0;
    ray_axes a;
    status code = ray_axes_set(&a, b->position, beam_axis(b), has_normal ? &b->normal : NULL, w->why);
    for (int i = 0; i < waves && code == STATUS_OK; i++) {
        const beam_ray first = {index, 0, count, beam_lambda(b, i), b->power / count / waves};
        code = visit_wavelength(w, s, level, b, &a, first);
    }
    return code;
}

/* The number of rays is checked before the first is traced. */
static status check_rays(const scene *s, int rays, diagnostic *why)
{
    int64_t all = 0;
    for (size_t i = 0; i < s->beam_count; i++)
        if (s->beams[i].visible)
            all += (int64_t)beam_wavelengths(&s->beams[i]) * (rays > 0 ? rays : s->beams[i].rays);
    if (all <= BEAMS_RAYS_MAX)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "use fewer rays, wavelengths or beams",
                    "the beams have %lld rays, more than %d", (long long)all, BEAMS_RAYS_MAX);
}

status beams_each_ray(const scene *s, isa level, int rays, beam_visit *visit, void *context, diagnostic *why)
{
    TRY(check_rays(s, rays, why));
    beam_work w = {.visit = visit, .context = context, .why = why};
    status code = STATUS_OK;
    for (size_t i = 0; i < s->beam_count && code == STATUS_OK; i++)
        if (s->beams[i].visible)
            code = visit_beam(&w, s, level, (int)i, rays);
    ray_tree_release(&w.tree);
    return code;
}

double beam_fraction(const ray_node *node)
{
    return (node->throughput[0] + node->throughput[1] + node->throughput[2]) / 3.0;
}

/* Beer and Lambert: if a segment transmits T, the fraction f of the segment transmits T^f. */
double beam_fraction_at(const ray_node *node, double t)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
        sum += node->throughput[k] *
               (node->end == RAY_END_HIT && node->hit.t > 0.0 ? pow(node->hit.transmittance[k], t / node->hit.t) : 1.0);
    return sum / 3.0;
}

void beam_wavelength_color(double lambda_nm, double rgb[3])
{
    double xyz[3], most = 0.0;
    observer_xyz(lambda_nm, xyz);
    xyz_to_linear_srgb(xyz, rgb);
    for (int k = 0; k < 3; k++) {
        rgb[k] = fmax(rgb[k], 0.0);
        most = fmax(most, rgb[k]);
    }
    for (int k = 0; k < 3; k++)
        rgb[k] = most > 0.0 ? rgb[k] / most : 0.5;
}

void beam_line_color(const beam *b, double lambda_nm, double rgb[3])
{
    rgb[0] = b->color.x, rgb[1] = b->color.y, rgb[2] = b->color.z;
    if (rgb[0] == 0.0 && rgb[1] == 0.0 && rgb[2] == 0.0)
        beam_wavelength_color(lambda_nm, rgb);
}

/* --- screens --- */

void beam_screen_release(beam_screen *screen)
{
    free(screen->bin);
    free(screen->color);
    screen->bin = screen->color = NULL;
}

static status prepare_screen(beam_screen *screen, diagnostic *why)
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
    const double fraction = at / size + 0.5;
    return fraction >= 0.0 && fraction < 1.0 ? (int)fmin(fraction * count, count - 1) : -1;
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
    const double power = ray->power * beam_fraction_at(node, t);
    const int bin = row * screen->columns + column;
    screen->hit_count++;
    screen->received += power;
    screen->bin[bin] += power;
    for (int k = 0; k < 3; k++)
        screen->color[3 * bin + k] += power * rgb[k];
}

static status cross_screen(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
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
    TRY(prepare_screen(screen, why));
    return beams_each_ray(s, level, screen->rays_of_beam, cross_screen, screen, why);
}

/* --- drawing --- */

/* Fraction of a line's colour that shows where it is hidden. */
#define HIDDEN 0.15
/* Tolerance of the depth test, relative: a segment starts or ends on a surface that must not hide it. */
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
    scene *opaque_scene = scene_clone(s);
    if (!opaque_scene)
        return out_of_memory(why);
    render_settings *r = &opaque_scene->render;
    for (size_t i = 0; i < opaque_scene->solid_count; i++)
        opaque_scene->solids[i].visible =
            opaque_scene->solids[i].visible && material_is_opaque(&opaque_scene->solids[i].surface);
    r->polarisation = 0;
    r->spectrum = SPECTRUM_RGB;
    r->samples = 1;
    *out = opaque_scene;
    return scene_set(opaque_scene, "render.integrator", integrator_with_layers(), why);
}

static void blend_pixel(beam_canvas *c, int x, int y, double distance, double cover, const double rgb[3])
{
    const size_t pixel = (size_t)y * (size_t)c->img->width + (size_t)x;
    const double surface = c->distance[pixel];
    const double fraction = surface > 0.0 && distance > surface * (1.0 + ON_SURFACE) ? HIDDEN * cover : cover;
    float *at = c->img->pixel + 3 * pixel;
    for (int k = 0; k < 3; k++)
        at[k] = (float)(at[k] * (1.0 - fraction) + rgb[k] * fraction);
}

/* The distance from the camera, in a pixel, of the point at the fraction t of the image's line a .. b. The ends' z are
 * depths; along the line 1 / z is linear in perspective, and z with parallel rays. */
static double distance_at(const beam_canvas *c, int x, int y, vec3 a, vec3 b, double t)
{
    if (c->view.parallel)
        return t > 0.0 ? (1.0 - t) * a.z + t * b.z : a.z;
    const double u = ((x + 0.5) / c->img->width * 2.0 - 1.0) * c->view.half_width;
    const double v = (1.0 - (y + 0.5) / c->img->height * 2.0) * c->view.half_height;
    return sqrt(1.0 + u * u + v * v) / ((1.0 - t) / a.z + t / b.z);
}

/* Draws the pixels near a line a .. b. */
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
                blend_pixel(c, x, y, distance_at(c, x, y, a, b, t), cover * strength, rgb);
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
    const double start = beam_fraction(&tree->node[0]);
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (node->end != RAY_END_HIT && node->end != RAY_END_SKY)
            continue;
        const ray_line line = ray_line_of(node);
        vec3 ends[2];
        if (ray_line_seen(&line, &c->view, &c->frame, ends))
            draw_line(c, ends[0], ends[1], 0.25 + 0.75 * sqrt(fmin(1.0, beam_fraction(node) / start)), rgb);
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
