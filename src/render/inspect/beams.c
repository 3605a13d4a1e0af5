/* The rays of beams, with a probe per wavelength; their crossings of a screen; and their drawing as lines with soft
 * edges, with a depth test per pixel against opaque surfaces. */
#include "render/inspect/beams.h"

#include "base/budget.h"
#include "optics/spectrum.h"
#include "render/inspect/ray_line.h"
#include "render/plan/sampling.h"
#include "scene/model/camera.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>

static const char smaller_tree[] = "use a smaller depth or a larger min_fraction";

/* A probe traces the beams of one wavelength and smallest fraction. It costs milliseconds, more than most rays, so that
 * those last used are kept. */
enum { PROBES_KEPT = 64 };

typedef struct kept_probe {
    probe *tracer; /* NULL: none yet */
    double lambda_nm, min_fraction;
} kept_probe;

typedef struct beam_work {
    const scene *s;
    scene *unlit; /* without lights, so that no shadow rays are traced, and without beams */
    isa level;
    kept_probe kept[PROBES_KEPT];
    size_t next; /* the kept probe that is replaced next */
    beam_visit *visit;
    void *context;
    ray_tree tree;
    diagnostic *why;
} beam_work;

static status scene_without_light(const scene *s, scene **out, diagnostic *why)
{
    scene bare = *s;
    bare.light_count = bare.beam_count = 0;
    *out = scene_clone(&bare);
    return *out ? STATUS_OK : out_of_memory(why);
}

static status probe_of_beam(beam_work *w, const beam *b, double lambda_nm, probe **out)
{
    kept_probe *k = w->kept;
    while (k < w->kept + PROBES_KEPT && k->tracer && (k->lambda_nm != lambda_nm || k->min_fraction != b->min_fraction))
        k++;
    if (k == w->kept + PROBES_KEPT) {
        k = &w->kept[w->next++ % PROBES_KEPT];
        probe_destroy(k->tracer);
        k->tracer = NULL;
    }
    if (!k->tracer) {
        w->unlit->render.lambda_nm = k->lambda_nm = lambda_nm;
        w->unlit->render.min_weight = k->min_fraction = b->min_fraction;
        TRY(probe_create(w->unlit, w->level, &k->tracer, w->why));
        probe_use_one_wavelength(k->tracer);
    }
    probe_limit_depth(k->tracer, (int)b->depth, smaller_tree);
    *out = k->tracer;
    return STATUS_OK;
}

/* A beam's rays from one of its field points. */
typedef struct field_rays {
    const beam *b;
    ray_axes axes;
    ray_pattern pattern;
} field_rays;

static void start_of(const field_rays *f, const beam_ray *ray, vec3 *origin, vec3 *direction)
{
    const beam *b = f->b;
    const bool spreads = !beam_is_parallel(b);
    const double size = spreads ? b->angle_deg : b->width;
    if (beam_is_flat(b))
        ray_axes_in_plane(&f->axes, spreads, size, ray->number, ray->rays, origin, direction);
    else
        ray_axes_round(&f->axes, &f->pattern, spreads, size, ray->number, origin, direction);
}

static status visit_ray(beam_work *w, const field_rays *f, const beam_ray *ray, probe *p)
{
    const beam *b = f->b;
    vec3 origin, direction;
    start_of(f, ray, &origin, &direction);
    const status code = b->branches ? probe_ray(p, origin, direction, &w->tree, w->why)
                                    : probe_path(p, origin, direction, -1, &w->tree, w->why);
    if (code == STATUS_BAD_INPUT && w->tree.count >= PROBE_NODES_MAX)
        return diagnose(w->why, code, smaller_tree, "a ray of beam '%s' has more than %d segments", b->name,
                        (int)PROBE_NODES_MAX);
    return code == STATUS_OK ? w->visit(w->context, ray, &w->tree, p, w->why) : code;
}

/* Moves or turns the axes to a field point. The disc of parallel rays stays, so that all field points fill it; rays
 * from a point are aimed at the target, if the beam has one. */
static status axes_of_field(const beam *b, const ray_axes *middle, int field, ray_axes *out, diagnostic *why)
{
    const bool spreads = !beam_is_parallel(b), has_target = vec3_dot(b->direction, b->direction) == 0.0;
    vec3 from, axis;
    *out = *middle;
    if (beam_fields(b) == 1)
        return STATUS_OK;
    ray_axes_field(middle, spreads, spreads ? b->field_width : b->field_deg, field, (int)b->field_columns,
                   (int)b->field_rows, &from, &axis);
    if (spreads)
        return ray_axes_set(out, from, has_target ? vec3_sub(b->target, from) : axis, &middle->normal, why);
    out->axis = axis;
    return STATUS_OK;
}

static status visit_wavelength(beam_work *w, const field_rays *f, beam_ray ray)
{
    probe *p = NULL;
    TRY(probe_of_beam(w, f->b, ray.lambda_nm, &p));
    status code = STATUS_OK;
    for (; ray.number < ray.rays && code == STATUS_OK; ray.number++)
        code = visit_ray(w, f, &ray, p);
    return code;
}

static status visit_field(beam_work *w, const field_rays *f, int index, int field)
{
    const beam *b = f->b;
    const int waves = beam_wavelengths(b), fields = beam_fields(b), count = f->pattern.count;
    status code = STATUS_OK;
    for (int i = 0; i < waves && code == STATUS_OK; i++) {
        const beam_ray first = {index, field, 0, count, beam_lambda(b, i), b->power / count / waves / fields};
        code = visit_wavelength(w, f, first);
    }
    return code;
}

static status visit_beam(beam_work *w, int index, int rays)
{
    const beam *b = &w->s->beams[index];
    const bool has_normal = beam_is_flat(b) && vec3_dot(b->normal, b->normal) > 0.0;
    const beam_pattern pattern = beam_is_flat(b) ? PATTERN_SPIRAL : (beam_pattern)b->pattern;
    field_rays f = {.b = b, .pattern = ray_pattern_of(pattern, rays > 0 ? rays : (int)b->rays)};
    ray_axes middle;
    status code = ray_axes_set(&middle, b->position, beam_axis(b), has_normal ? &b->normal : NULL, w->why);
    for (int field = 0; field < beam_fields(b) && code == STATUS_OK; field++) {
        code = axes_of_field(b, &middle, field, &f.axes, w->why);
        THEN(code, visit_field(w, &f, index, field));
    }
    return code;
}

status beams_each_ray(const scene *s, isa level, int rays, beam_visit *visit, void *context, diagnostic *why)
{
    beam_work w = {.s = s, .level = level, .visit = visit, .context = context, .why = why};
    status code = scene_without_light(s, &w.unlit, why);
    for (size_t i = 0; i < s->beam_count && code == STATUS_OK; i++)
        if (s->beams[i].visible)
            code = visit_beam(&w, (int)i, rays);
    for (size_t i = 0; i < PROBES_KEPT; i++)
        probe_destroy(w.kept[i].tracer);
    ray_tree_release(&w.tree);
    scene_destroy(w.unlit);
    return code;
}

static int64_t ray_count_of(const beam *b, int rays)
{
    const int asked = rays > 0 ? rays : (int)b->rays;
    const int count = beam_is_flat(b) ? asked : ray_pattern_of((beam_pattern)b->pattern, asked).count;
    return (int64_t)beam_wavelengths(b) * beam_fields(b) * count;
}

ray_cut ray_tree_cut(const ray_tree *tree, ray_end end)
{
    ray_cut cut = {0};
    for (size_t i = 0; i < tree->count; i++)
        if (tree->node[i].end == end) {
            cut.rays++;
            cut.weight += beam_fraction(&tree->node[i]);
        }
    return cut;
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

/* The number of rays is checked before the first is traced. */
static status check_rays(const scene *s, int rays, diagnostic *why)
{
    int64_t all = 0;
    for (size_t i = 0; i < s->beam_count && all <= SCREEN_ALL_RAYS_MAX; i++)
        all += s->beams[i].visible ? ray_count_of(&s->beams[i], rays) : 0;
    if (all <= SCREEN_ALL_RAYS_MAX)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "use fewer rays, wavelengths, field points or beams",
                    "the beams have more than %d rays", SCREEN_ALL_RAYS_MAX);
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
    screen->segment_count += tree->count;
    if (screen->segment_count > SCREEN_SEGMENTS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use fewer rays, a smaller depth or a larger min_fraction",
                        "the beams have more than %d segments", SCREEN_SEGMENTS_MAX);
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
    TRY(check_rays(s, screen->rays_of_beam, why));
    return beams_each_ray(s, level, screen->rays_of_beam, cross_screen, screen, why);
}

/* --- drawing --- */

/* Fraction of a line's colour that shows where it is hidden. */
#define HIDDEN 0.15
/* Tolerance of the depth test, relative: a segment starts or ends on a surface that must not hide it. */
#define ON_SURFACE 1e-3

/* What the lines bring to a pixel. Lines of several colours at one place mix as lights do: white light stays white. */
typedef struct lines_at {
    float rgb[3];     /* sum of the colours, weighted by cover */
    float weight;     /* sum of the covers */
    float brightness; /* sum of cover times the colour's largest channel */
    float cover;      /* the largest of one line */
} lines_at;

typedef struct beam_canvas {
    const scene *s;
    const float *distance;
    image *img;
    lines_at *lines; /* by pixel */
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

static void cover_pixel(beam_canvas *c, int x, int y, double distance, double cover, const double rgb[3])
{
    const size_t pixel = (size_t)y * (size_t)c->img->width + (size_t)x;
    const double surface = c->distance[pixel];
    const double fraction = surface > 0.0 && distance > surface * (1.0 + ON_SURFACE) ? HIDDEN * cover : cover;
    lines_at *at = &c->lines[pixel];
    for (int k = 0; k < 3; k++)
        at->rgb[k] += (float)(fraction * rgb[k]);
    at->weight += (float)fraction;
    at->brightness += (float)(fraction * fmax(rgb[0], fmax(rgb[1], rgb[2])));
    at->cover = fmaxf(at->cover, (float)fraction);
}

/* The mixed colour is as bright as its lines are in the mean. */
static void blend_pixel(const lines_at *lines, float rgb[3])
{
    const double most = fmax((double)lines->rgb[0], fmax((double)lines->rgb[1], (double)lines->rgb[2]));
    const double scale = most > 0.0 ? (double)lines->brightness / ((double)lines->weight * most) : 0.0;
    const double cover = (double)lines->cover;
    for (int k = 0; k < 3; k++)
        rgb[k] = (float)((double)rgb[k] * (1.0 - cover) + (double)lines->rgb[k] * scale * cover);
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
                cover_pixel(c, x, y, distance_at(c, x, y, a, b, t), cover * strength, rgb);
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
    const size_t pixels = (size_t)img->width * (size_t)img->height;
    TRY(memory_budget_check(pixels * sizeof *c.lines, "use a smaller image", why,
                            "the lines of beams in %d x %d pixels", img->width, img->height));
    c.lines = calloc(pixels, sizeof *c.lines);
    if (!c.lines)
        return out_of_memory(why);
    c.half_width = fmax(0.6, img->height / 800.0);
    /* A line whose middle is just outside the image still covers pixels. */
    c.frame = image_frame_of(img->width, img->height, c.half_width + 1.0);
    const status code = beams_each_ray(s, level, 0, draw_ray, &c, why);
    for (size_t i = 0; i < pixels && code == STATUS_OK; i++)
        if (c.lines[i].cover > 0.0F)
            blend_pixel(&c.lines[i], img->pixel + 3 * i);
    free(c.lines);
    return code;
}
