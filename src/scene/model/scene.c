#include "scene/model/open.h"
#include "scene/model/objects.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

#include "base/thread_team.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

scene *scene_create(void)
{
    scene *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->path = strdup("");
    s->title = strdup("");
    s->camera.aimed = 1;
    if (!s->path || !s->title || param_set_defaults(PARAM_RENDER, &s->render, NULL) != STATUS_OK ||
        param_set_defaults(PARAM_CAMERA, &s->camera, NULL) != STATUS_OK ||
        param_set_defaults(PARAM_BACKGROUND, &s->background, NULL) != STATUS_OK) {
        scene_destroy(s);
        return NULL;
    }
    return s;
}

void scene_destroy(scene *s)
{
    if (!s)
        return;
    objects_release(s);
    free(s->background.image_path);
    image_destroy(s->background.img);
    free(s->path);
    free(s->title);
    free(s->limits.root);
    free(s);
}

static bool clone_texture(background *to, const background *from)
{
    to->img = NULL;
    to->image_path = strdup(from->image_path);
    if (!to->image_path)
        return false;
    if (from->img)
        to->img = image_retain(from->img); /* not modified after loading */
    return true;
}

scene *scene_clone(const scene *original)
{
    scene *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->render = original->render;
    s->camera = original->camera;
    s->background = original->background;
    s->path = strdup(original->path);
    s->title = strdup(original->title);
    bool whole = clone_texture(&s->background, &original->background);
    whole = objects_clone(s, original) && whole;
    whole = scene_limit(s, original->limits.root, original->limits.triangles, NULL) == STATUS_OK && whole;
    if (!whole || !s->path || !s->title) {
        scene_destroy(s);
        return NULL;
    }
    return s;
}

const char *scene_path(const scene *s)
{
    return s->path;
}

const char *scene_root(const scene *s)
{
    return s->limits.root ? s->limits.root : "";
}

const render_settings *scene_settings(const scene *s)
{
    return &s->render;
}

const struct camera *scene_camera(const scene *s)
{
    return &s->camera;
}

const struct background *scene_background(const scene *s)
{
    return &s->background;
}

size_t scene_solid_count(const scene *s)
{
    return s->solid_count;
}

const char *scene_solid_name(const scene *s, int index)
{
    return s->solids[index].name;
}

const char *scene_light_name(const scene *s, int index)
{
    return s->lights[index].name;
}

status scene_limit(scene *s, const char *root, size_t triangles, diagnostic *why)
{
    char *copy = root ? strdup(root) : NULL;
    if (root && !copy)
        return out_of_memory(why);
    free(s->limits.root);
    s->limits = (load_limits){.root = copy, .triangles = triangles};
    return STATUS_OK;
}

int scene_find_solid(const scene *s, const char *name)
{
    return object_find(s, PARAM_SOLID, name);
}

int scene_threads(const render_settings *r)
{
    enum { THREADS_MAX = 1024 };
    if (r->threads > 0)
        return (int)r->threads;
    const int units = thread_team_units();
    return units > THREADS_MAX ? THREADS_MAX : units;
}

int scene_build_threads(const render_settings *r)
{
    return r->build_threads > 0 ? (int)r->build_threads : (int)sysconf(_SC_NPROCESSORS_ONLN);
}
