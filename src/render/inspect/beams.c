/* The rays of beams: each wavelength has a probe, since a probe has one wavelength. */
#include "render/inspect/beams.h"

#include "optics/spectrum.h"
#include "render/inspect/ray_axes.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"
#include <math.h>

/* A probe without lights, whose shadow rays would be traced for nothing. */
static status probe_of_beam(const scene *s, const beam *b, double lambda_nm, isa level, probe **out, diagnostic *why)
{
    scene *alone = scene_clone(s);
    status code = alone ? STATUS_OK : out_of_memory(why);
    while (code == STATUS_OK && alone->light_count > 0)
        code = scene_remove(alone, alone->lights[alone->light_count - 1].name, why);
    if (code == STATUS_OK) {
        alone->render.lambda_nm = lambda_nm;
        alone->render.min_weight = b->min_share;
        code = probe_create(alone, level, out, why);
    }
    if (code == STATUS_OK) {
        probe_limit_depth(*out, (int)b->depth);
        probe_one_wavelength(*out);
    }
    scene_destroy(alone);
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
    if (b->branches)
        TRY(probe_ray(p, origin, direction, &w->tree, w->why));
    else
        TRY(probe_path(p, origin, direction, -1, &w->tree, w->why));
    w->segments += w->tree.count;
    if (w->segments > BEAMS_SEGMENTS_MAX)
        return diagnose(w->why, STATUS_BAD_INPUT, "use fewer rays, a smaller depth or a larger min_share",
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

double beam_share(const ray_node *node)
{
    return (node->throughput[0] + node->throughput[1] + node->throughput[2]) / 3.0;
}

/* Beer and Lambert: the transmittance over a part of the length is a power of that over the whole. */
double beam_share_at(const ray_node *node, double t)
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
