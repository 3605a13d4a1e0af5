/* The probe's interface: pixels, free rays, paths, media and names. */
#include "render/inspect/probe.h"

#include "geometry/shapes/shape.h"
#include "render/inspect/probe_private.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

status probe_create(const scene *s, isa level, probe **out, diagnostic *why)
{
    probe *p = calloc(1, sizeof *p);
    if (!p)
        return out_of_memory(why);
    p->remedy = "lower render.depth, or raise render.min_weight";
    p->setting = scene_clone(s);
    p->rays = tracer_create(level);
    status code = p->setting && p->rays ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        render_settings *r = &p->setting->render;
        p->spectral = r->spectrum == SPECTRUM_SPECTRAL;
        p->setting->camera.aperture = 0.0;
        if (integrator_traits_of(r)->by_chance || integrator_traits_of(r)->drawn || integrator_traits_of(r)->unlit)
            use_whitted(r); /* trace all branches, not a random one or none */
        code = scene_check(p->setting, why);
        r->spectrum = SPECTRUM_RGB; /* a tree has one wavelength: render.lambda_nm */
    }
    THEN(code, plan_build(p->setting, &p->frame_plan, why));
    THEN(code, film_create(1, 1, 1, FILM_RGB, &p->img, why));
    if (code != STATUS_OK) {
        probe_destroy(p);
        return code;
    }
    if (p->spectral)
        probe_use_one_wavelength(p);
    *out = p;
    return STATUS_OK;
}

/* The tint's absorption by channel, or at the tree's wavelength for a spectral film. */
static vec3 tint_of(const probe *p, const material *m)
{
    vec3 fraction = m->color;
    if (!material_tints(m))
        return vec3_make(0.0, 0.0, 0.0);
    if (p->spectral) {
        const upsampled_spectrum color = upsample_reflectance((const double[3]){fraction.x, fraction.y, fraction.z});
        fraction.x = fraction.y = fraction.z = upsampled_reflectance(&color, p->frame_plan->render.lambda_nm);
    }
    return vec3_make(material_tint(m, fraction.x), material_tint(m, fraction.y), material_tint(m, fraction.z));
}

void probe_use_one_wavelength(probe *p)
{
    const render_settings *r = &p->frame_plan->render;
    if (p->frame_plan->layered)
        p->frame_plan->layered->one_wavelength = true;
    if (p->spectral) {
        const double a = surrounding_absorption_at(&p->setting->background, r->lambda_nm) * r->unit_m;
        p->frame_plan->absorption[0] = vec3_make(a, a, a);
    }
    for (int priority_index = 1; priority_index <= p->frame_plan->geometry->region_count; priority_index++) {
        const material *m = p->frame_plan->materials[priority_index];
        const bool has_k = m->medium == MEDIUM_DATA && m->index_data && optical_data_has_k(m->index_data);
        if (m->absorb_spectrum.count == 0 && !m->absorb_values && !has_k && !p->spectral)
            continue;
        const double a = material_absorption_at(m, r->lambda_nm) * r->unit_m;
        p->frame_plan->absorption[priority_index] = vec3_add(vec3_make(a, a, a), tint_of(p, m));
    }
}

void probe_limit_depth(probe *p, int depth, const char *remedy)
{
    p->frame_plan->render.depth = depth;
    p->remedy = remedy;
}

void probe_destroy(probe *p)
{
    if (!p)
        return;
    plan_destroy(p->frame_plan);
    tracer_destroy(p->rays);
    film_destroy(p->img);
    scene_destroy(p->setting);
    free(p);
}

void ray_tree_release(ray_tree *tree)
{
    free(tree->node);
    memset(tree, 0, sizeof *tree);
}

static status begin(probe *p, ray_tree *tree, diagnostic *why)
{
    const tracer_target target = {.frame_plan = p->frame_plan, .img = p->img};
    memset(p->img->sum, 0, 3 * sizeof *p->img->sum);
    tree->count = 0;
    tree->depth_limit = (int)p->frame_plan->render.depth;
    tree->lambda_nm = p->frame_plan->render.lambda_nm;
    p->frame_plan->camera_priority_index =
        scene_geometry_priority_index(p->frame_plan->geometry, p->frame_plan->eye_inside);
    return tracer_begin(p->rays, &target) ? STATUS_OK : out_of_memory(why);
}

static status finish(probe *p, ray_tree *tree, status code, diagnostic *why)
{
    for (int c = 0; c < 3; c++)
        tree->radiance[c] = film_value(p->img, 0, 0, c);
    if (code == STATUS_OK && tracer_overflowed(p->rays))
        return diagnose(why, STATUS_BAD_INPUT, "lower the lights' intensity, the colours or the sky",
                        "the ray's radiance exceeds the film's range");
    return code;
}

status probe_pixel(probe *p, int x, int y, ray_tree *tree, diagnostic *why)
{
    const render_settings *r = &p->frame_plan->render;
    if (x < 0 || y < 0 || x >= r->width || y >= r->height)
        return diagnose(why, STATUS_BAD_INPUT, "count pixels from 0,0 at the top left",
                        "pixel %d,%d is outside the image of %lld x %lld", x, y, (long long)r->width,
                        (long long)r->height);
    TRY(begin(p, tree, why));
    status code = STATUS_OK;
    ray_record roots[SCENE_SAMPLES_MAX];
    const int count = tracer_camera_rays(p->rays, x, y);
    for (int i = 0; i < count; i++)
        probe_read_ray(p, 0, i, &roots[i]);
    p->rays->queues.waiting[0].count = 0;
    size_t last = 0;
    for (int i = 0; i < count && code == STATUS_OK; i++) {
        size_t root;
        code = probe_build(p, tree, &roots[i], RAY_CAMERA, RAY_NONE, &root, why);
        if (code == STATUS_OK && i > 0)
            tree->node[last].next = (int)root;
        last = root;
    }
    return finish(p, tree, code, why);
}

/* Begins a tree with the caller's ray. */
static status begin_free(probe *p, vec3 origin, vec3 direction, ray_tree *tree, ray_record *root, diagnostic *why)
{
    TRY(probe_check_ray(origin, direction, why));
    TRY(begin(p, tree, why));
    *root = probe_free_ray(p, origin, direction);
    p->frame_plan->camera_priority_index = root->medium_priority_index; /* the camera is at the ray's origin */
    return STATUS_OK;
}

status probe_ray(probe *p, vec3 origin, vec3 direction, ray_tree *tree, diagnostic *why)
{
    ray_record root;
    size_t unused;
    TRY(begin_free(p, origin, direction, tree, &root, why));
    status code = probe_build(p, tree, &root, RAY_CAMERA, RAY_NONE, &unused, why);
    return finish(p, tree, code, why);
}

status probe_path(probe *p, vec3 origin, vec3 direction, int reflect_at, ray_tree *tree, diagnostic *why)
{
    ray_record root;
    TRY(begin_free(p, origin, direction, tree, &root, why));
    status code = probe_follow(p, tree, &root, reflect_at, why);
    return finish(p, tree, code, why);
}

const char *probe_medium_name(const probe *p, int at)
{
    const scene *s = p->setting;
    if (at == RAY_OUTSIDE) {
        const char *name = surrounding_medium_name(&s->background);
        return name ? name : s->background.ior == 1.0 ? "air" : "surroundings";
    }
    const char *name = material_medium_name(&s->solids[at].surface);
    return name ? name : s->solids[at].name;
}

/* Whether only the scene geometry can test points: against meshes and the copies of a solid. */
static bool needs_geometry(const probe *p)
{
    const scene *s = p->setting;
    for (size_t i = 0; i < s->solid_count; i++)
        if (scene_points_of(s, &s->solids[i]))
            return true;
    return p->frame_plan->geometry->meshes;
}

int probe_medium_at(const probe *p, vec3 point)
{
    const scene *s = p->setting;
    const scene_geometry *g = p->frame_plan->geometry;
    int best = RAY_OUTSIDE;
    if (needs_geometry(p))
        return g->regions[scene_geometry_priority_index(g, scene_geometry_inside(g, point))].solid;
    for (int i = 0; i < (int)s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (one->visible && solid_shape_contains(&one->shape, point) &&
            (best < 0 || one->priority > s->solids[best].priority))
            best = i;
    }
    return best;
}

vec3 probe_camera_direction(const probe *p, double x, double y)
{
    return camera_chief_ray(&p->frame_plan->view, &p->frame_plan->render, x, y).direction;
}

const char *probe_face_name(const probe *p, const ray_hit *hit)
{
    return shape_face_name(shape_of(&p->setting->solids[hit->face_solid].shape), hit->face);
}
