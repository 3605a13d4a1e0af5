#include "scene/model/open.h"
#include "base/text.h"
#include "scene/model/looks.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

scene *scene_create(void)
{
    scene *s = calloc(1, sizeof *s);
    if (!s) {
        return NULL;
    }
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
    if (!s) {
        return;
    }
    for (size_t i = 0; i < s->material_count; i++) {
        free(s->materials[i].name);
    }
    for (size_t i = 0; i < s->light_count; i++) {
        free(s->lights[i].name);
    }
    for (size_t i = 0; i < s->solid_count; i++) {
        free(s->solids[i].name);
    }
    for (size_t i = 0; i < s->mesh_count; i++) {
        mesh_entry_unload(&s->meshes[i]);
        free(s->meshes[i].name);
        free(s->meshes[i].path);
        free(s->meshes[i].script_path);
    }
    for (size_t i = 0; i < s->texture_count; i++) {
        texture_entry_unload(&s->textures[i]);
        free(s->textures[i].name);
        free(s->textures[i].path);
    }
    free(s->meshes);
    free(s->textures);
    free(s->materials);
    free(s->lights);
    free(s->solids);
    free(s->background.picture_path);
    image_destroy(s->background.picture);
    free(s->path);
    free(s->title);
    free(s->limits.root);
    free(s);
}

/* A copy of count elements, whose names are still those of the original; NULL for none, or when memory is out. */
static void *copy_array(const void *from, size_t count, size_t size)
{
    void *to = count ? malloc(count * size) : NULL;
    if (to) {
        memcpy(to, from, count * size);
    }
    return to;
}

/* Copies share what was loaded. */
static bool clone_assets(scene *s, const scene *original)
{
    bool whole = true;
    s->meshes = copy_array(original->meshes, original->mesh_count, sizeof *s->meshes);
    for (size_t i = 0; s->meshes && i < original->mesh_count; i++, s->mesh_count++) {
        mesh_entry *m = &s->meshes[i];
        whole &= (m->name = strdup(m->name)) != NULL;
        whole &= (m->path = strdup(m->path)) != NULL;
        whole &= (m->script_path = strdup(m->script_path)) != NULL;
        looks_retain(m->looks);
        if (m->data) {
            mesh_retain(m->data);
        }
    }
    s->textures = copy_array(original->textures, original->texture_count, sizeof *s->textures);
    for (size_t i = 0; s->textures && i < original->texture_count; i++, s->texture_count++) {
        texture_entry *t = &s->textures[i];
        whole &= (t->name = strdup(t->name)) != NULL;
        whole &= (t->path = strdup(t->path)) != NULL;
        if (t->data) {
            texture_retain(t->data);
        }
    }
    return whole && s->mesh_count == original->mesh_count && s->texture_count == original->texture_count;
}

static bool clone_objects(scene *s, const scene *original)
{
    bool whole = clone_assets(s, original);
    s->materials = copy_array(original->materials, original->material_count, sizeof *s->materials);
    for (size_t i = 0; s->materials && i < original->material_count; i++, s->material_count++) {
        whole &= (s->materials[i].name = strdup(original->materials[i].name)) != NULL;
    }
    s->lights = copy_array(original->lights, original->light_count, sizeof *s->lights);
    for (size_t i = 0; s->lights && i < original->light_count; i++, s->light_count++) {
        whole &= (s->lights[i].name = strdup(original->lights[i].name)) != NULL;
    }
    s->solids = copy_array(original->solids, original->solid_count, sizeof *s->solids);
    for (size_t i = 0; s->solids && i < original->solid_count; i++, s->solid_count++) {
        whole &= (s->solids[i].name = strdup(original->solids[i].name)) != NULL;
    }
    return whole && s->material_count == original->material_count && s->light_count == original->light_count &&
           s->solid_count == original->solid_count;
}

static bool clone_picture(background *to, const background *from)
{
    to->picture = NULL;
    to->picture_path = strdup(from->picture_path);
    if (!to->picture_path) {
        return false;
    }
    if (from->picture) {
        to->picture = image_share(from->picture); /* never changed once it is loaded */
    }
    return true;
}

scene *scene_clone(const scene *original)
{
    scene *s = calloc(1, sizeof *s);
    if (!s) {
        return NULL;
    }
    s->render = original->render;
    s->camera = original->camera;
    s->background = original->background;
    s->path = strdup(original->path);
    s->title = strdup(original->title);
    bool whole = clone_picture(&s->background, &original->background);
    whole = clone_objects(s, original) && whole;
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
    if (root && !copy) {
        return out_of_memory(why);
    }
    free(s->limits.root);
    s->limits = (load_limits){.root = copy, .triangles = triangles};
    return STATUS_OK;
}

int scene_find_solid(const scene *s, const char *name)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        if (strcmp(s->solids[i].name, name) == 0) {
            return (int)i;
        }
    }
    return -1;
}

int scene_build_threads(const render_settings *r)
{
    return r->build_threads > 0 ? (int)r->build_threads : (int)sysconf(_SC_NPROCESSORS_ONLN);
}
