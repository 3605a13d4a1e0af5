#include "lint/lint.h"

#include "geometry/shapes/shape.h"
#include "lint/parts.h"
#include "scene/model/scene.h"
#include <math.h>

enum { PROBE_PIXELS = 2400, PROBE_PIXELS_MESHES = 800 };

static bool has_meshes(const scene *s)
{
    bool any = false;
    for (size_t i = 0; i < s->solid_count; i++)
        any |= s->solids[i].visible && shape_of(&s->solids[i].shape)->triangles;
    return any;
}

/* The size of the small probe image, with the aspect ratio of the scene's. */
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
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].visible && shape_of(&s->solids[i].shape)->triangles) {
            const mesh_entry *m = scene_find_mesh(s, s->solids[i].mesh);
            if (!m || !m->data)
                return false;
        }
    return s->background.kind != BACKGROUND_IMAGE || s->background.img;
}

/* Few: the share of the paths that are cut needs no more. */
enum { PROBE_PATHS = 2 };

/* A persistent hierarchy is the one that a frame would build at its first use; otherwise the linter builds its own. */
static scene *small_copy(const scene *s, bool by_chance)
{
    scene *copy = scene_clone(s);
    if (!copy)
        return NULL;
    render_settings *r = &copy->render;
    shrink(r, has_meshes(s) ? PROBE_PIXELS_MESHES : PROBE_PIXELS);
    r->samples = 1;
    r->spectrum = SPECTRUM_RGB;
    r->polarisation = 0;
    r->radiance = integrator_traits_of(r)->drawn ? RADIANCE_CLASSIC : r->radiance;
    if (by_chance)
        r->paths = PROBE_PATHS, r->error = 0.0;
    else
        trace_trees(r);
    if (r->accel != HIERARCHY_BVH) {
        r->accel = HIERARCHY_BVH;
        r->keep = 0;
    }
    return copy;
}

/* A scene whose paths cannot be planned is refused when it is rendered. */
static status lint_paths(const scene *s, isa level, const note_taker *taker, diagnostic *why)
{
    scene *copy = small_copy(s, true);
    lint_room room = {.of = s, .level = level, .taker = taker};
    status code = copy ? STATUS_OK : out_of_memory(why);
    if (copy && plan_build(copy, &room.made, NULL) == STATUS_OK)
        code = lint_path_depth(&room, why);
    plan_destroy(room.made);
    scene_destroy(copy);
    return code;
}

static status lint_cut_light(const lint_room *room, diagnostic *why)
{
    const render_settings *r = &room->of->render;
    if (integrator_traits_of(r)->by_chance)
        return lint_paths(room->of, room->level, room->taker, why);
    return follows_trees(r) ? lint_depth(room, why) : STATUS_OK;
}

static status lint_traced(const scene *s, isa level, const note_taker *taker, diagnostic *why)
{
    scene *copy = small_copy(s, false);
    lint_room room = {.of = s, .level = level, .taker = taker};
    status code = copy ? plan_build(copy, &room.made, why) : out_of_memory(why);
    THEN(code, lint_neighbours(&room, why));
    if (code == STATUS_OK && !lint_camera(&room))
        code = lint_cut_light(&room, why);
    plan_destroy(room.made);
    scene_destroy(copy);
    return code;
}

status lint_scene(const scene *s, isa level, const note_taker *taker, diagnostic *why)
{
    scene_hints(s, taker);
    return is_loaded(s) ? lint_traced(s, level, taker, why) : STATUS_OK;
}
