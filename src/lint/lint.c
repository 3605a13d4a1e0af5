/* The linter of a loaded scene: the hints, the camera's position, overlaps and gaps of solids, and light that is
 * cut. */
#include "lint/lint.h"
#include "geometry/shapes/shape.h"
#include "lint/inert.h"
#include "scene/model/scene.h"

#include <math.h>

/* --- the camera --- */

#define CAMERA_CLOSE 1e-9 /* fraction of the camera's coordinates: closer to a surface, it does not count as inside */

/* The priority index of the medium around the camera; -1 if a surface is close. */
static int medium_about(const plan *made)
{
    const vec3 eye = made->view.eye;
    const double far = CAMERA_CLOSE * fmax(1.0, fmax(fabs(eye.x), fmax(fabs(eye.y), fabs(eye.z))));
    const int priority_index =
        scene_geometry_priority_index(made->geometry, scene_geometry_inside(made->geometry, eye));
    for (int i = 0; i < 6; i++) {
        const double by = i % 2 ? far : -far;
        const vec3 at = vec3_add(eye, vec3_make(i / 2 == 0 ? by : 0.0, i / 2 == 1 ? by : 0.0, i / 2 == 2 ? by : 0.0));
        if (scene_geometry_priority_index(made->geometry, scene_geometry_inside(made->geometry, at)) != priority_index)
            return -1;
    }
    return priority_index;
}

/* Notes an orthographic camera whose image plane cuts an opaque solid, found by a lattice of its rays. Often it is the
 * ground, in a wide image from a low camera. */
static void lint_parallel(const lint_input *input)
{
    enum { ACROSS = 16 };
    const plan *made = input->probe;
    int inside = 0, found = 0;
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        const double u = (2.0 * (i % ACROSS) + 1.0) / ACROSS - 1.0, v = (2.0 * (i / ACROSS) + 1.0) / ACROSS - 1.0;
        const camera_ray r =
            camera_ray_through(&made->view, u * made->view.half_width, v * made->view.half_height, 0.0, 0.0);
        const int at = scene_geometry_priority_index(made->geometry, scene_geometry_inside(made->geometry, r.origin));
        if (made->geometry->regions[at].opaque)
            inside++, found = at;
    }
    if (inside > 0)
        note_report(input->taker, "camera", "position", "move the camera away from it, or lower camera.view_height",
                    "%d%% of the orthographic camera's rays start inside %s, which is opaque",
                    (100 * inside + ACROSS * ACROSS - 1) / (ACROSS * ACROSS), lint_solid(input, found)->name);
}

/* Notes a camera that sees nothing: in an opaque solid, under the ground, in the wall of a cup. True if the image is
 * useless, so that the light that it lacks does not matter. */
static bool lint_camera(const lint_input *input)
{
    if (input->probe->view.parallel) {
        lint_parallel(input);
        return false;
    }
    const int priority_index = medium_about(input->probe);
    if (priority_index <= 0)
        return false;
    const solid *around = lint_solid(input, priority_index);
    const bool opaque = input->probe->geometry->regions[priority_index].opaque,
               in_wall = !opaque && shape_of(&around->shape)->hollow;
    if (opaque && shape_of(&around->shape)->unbounded)
        note_report(input->taker, "camera", "position", "move the camera to the other side of the plane",
                    "the camera is below the surface of %s, which is opaque", around->name);
    else if (opaque)
        note_report(input->taker, "camera", "position", "move the camera out of it",
                    "the camera is inside %s, which is opaque", around->name);
    else if (in_wall)
        note_report(input->taker, "camera", "position",
                    "move the camera out of the wall, into the vessel or away from it",
                    "the camera is inside the wall of %s", around->name);
    return opaque || in_wall;
}

/* --- the scene --- */

enum { PROBE_PIXELS = 2400, PROBE_PIXELS_MESHES = 800, PROBE_DEPTH = 32 };
#define PROBE_RAYS 300000.0 /* of all images together: about ten milliseconds */
#define MESH_RAY 10.0       /* cost of a ray in a scene with triangles, relative to a scene without */

static bool has_meshes(const scene *s)
{
    bool any = false;
    for (size_t i = 0; i < s->solid_count; i++)
        any |= s->solids[i].visible && shape_of(&s->solids[i].shape)->triangles;
    return any;
}

/* Reduces the image to about `most` pixels, and keeps its aspect ratio. */
static void shrink(render_settings *r, double most)
{
    const double pixels = (double)r->width * (double)r->height;
    if (pixels <= most)
        return;
    const double scale = sqrt(most / pixels);
    r->width = (int64_t)fmax(1.0, round((double)r->width * scale));
    r->height = (int64_t)fmax(1.0, round((double)r->height * scale));
}

static bool is_loaded(const scene *s)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        const mesh_entry *m = scene_mesh_of(s, one), *points = scene_points_of(s, one);
        if (one->visible && ((shape_of(&one->shape)->triangles && (!m || !m->data)) || (points && !points->data)))
            return false;
    }
    return s->background.kind != BACKGROUND_IMAGE || s->background.img;
}

/* In a scene that traces the whole tree, the small images do not trace rays with less throughput, so that the number of
 * rays does not grow by a factor with each depth; lint_depth sees how much light they carry. */
#define PROBE_WEIGHT 1e-4

/* Paths per pixel: few suffice to estimate the fraction that is cut. */
enum { PROBE_PATHS = 2 };

/* The scene with a small, cheap image, for plans; it borrows everything but its settings. A hierarchy that frames use
 * again (render.keep) is the one that the first frame would build; if render.accel is not bvh, the linter builds a
 * hierarchy of its own. */
static scene small_view(const scene *s, bool by_chance)
{
    scene view = *s;
    render_settings *r = &view.render;
    /* lint_depth keeps an image for each depth: with many, smaller ones. */
    const double depths = fmin(fmax((double)r->depth, PROBE_DEPTH), DEPTH_TREE_MAX);
    shrink(r, (has_meshes(s) ? PROBE_PIXELS_MESHES : PROBE_PIXELS) * PROBE_DEPTH / depths);
    r->samples = 1;
    r->spectrum = SPECTRUM_RGB;
    r->polarisation = 0;
    r->radiance = integrator_traits_of(r)->drawn ? RADIANCE_CLASSIC : r->radiance;
    if (by_chance)
        r->paths = PROBE_PATHS, r->error = 0.0;
    else
        use_whitted(r), r->min_weight = r->min_weight > 0.0 ? r->min_weight : PROBE_WEIGHT;
    if (r->accel != HIERARCHY_BVH) {
        r->accel = HIERARCHY_BVH;
        r->keep = 0;
    }
    return view;
}

/* If the plan fails, there is no note: the frame will report the error. */
static status lint_paths(const scene *s, isa level, const note_sink *taker, diagnostic *why)
{
    const scene view = small_view(s, true);
    lint_input input = {.original = s, .level = level, .taker = taker};
    const status code = plan_build(&view, &input.probe, NULL) == STATUS_OK ? lint_path_depth(&input, why) : STATUS_OK;
    plan_destroy(input.probe);
    return code;
}

/* The rays that all small images of the scene may take. */
static double image_rays(const scene *s)
{
    return has_meshes(s) ? PROBE_RAYS / MESH_RAY : PROBE_RAYS;
}

static status lint_cut_light(const lint_input *input, diagnostic *why)
{
    const render_settings *r = &input->original->render;
    if (integrator_traits_of(r)->by_chance)
        return lint_paths(input->original, input->level, input->taker, why);
    return traces_ray_trees(r) ? lint_depth(input, image_rays(input->original), why) : STATUS_OK;
}

static status lint_planned(const scene *s, isa level, const note_sink *taker, diagnostic *why)
{
    const scene view = small_view(s, false);
    lint_input input = {.original = s, .level = level, .taker = taker};
    status code = plan_build(&view, &input.probe, why);
    THEN(code, lint_neighbours(&input, why));
    if (code == STATUS_OK && !lint_camera(&input))
        code = lint_cut_light(&input, why);
    plan_destroy(input.probe);
    return code;
}

status lint_scene(const scene *s, isa level, const note_sink *taker, diagnostic *why)
{
    scene_hints(s, taker);
    return is_loaded(s) ? lint_planned(s, level, taker, why) : STATUS_OK;
}
