/* The cache of meshes of recently loaded scenes. */
#include "job/shelf.h"
#include "scene/model/scene.h"

void shelf_clear(shelf *s)
{
    while (s->count > 0)
        scene_destroy(s->scenes[--s->count]);
}

static size_t triangles_of(const scene *s)
{
    size_t sum = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        sum += s->meshes[i].data ? s->meshes[i].data->triangle_count : 0;
    return sum;
}

/* True if the scene already has all meshes that the cache could provide. */
static bool is_whole(const scene *s)
{
    bool whole = true;
    for (size_t i = 0; i < s->mesh_count; i++)
        whole &= s->meshes[i].data || (s->meshes[i].source == MESH_SLIME && !s->render.keep);
    return whole;
}

/* A full cache is cleared: the cells of a study repeat in cycles, for which no replacement order is better. */
static void keep(shelf *s, const scene *setting)
{
    size_t triangles = triangles_of(setting);
    for (size_t i = 0; i < s->count; i++)
        triangles += triangles_of(s->scenes[i]);
    if (s->count == SHELF_SCENES || triangles > SHELF_TRIANGLES)
        shelf_clear(s);
    scene *copy = scene_clone(setting); /* if this fails, the mesh is merely built again */
    if (copy)
        s->scenes[s->count++] = copy;
}

status shelf_load(shelf *s, scene *setting, const load_watch *watch, diagnostic *why)
{
    for (size_t i = 0; i < s->count; i++)
        scene_borrow_meshes(setting, s->scenes[i]);
    const bool new_ones = !is_whole(setting);
    const status code = scene_load_until(setting, watch, why);
    if (code == STATUS_OK && new_ones)
        keep(s, setting);
    return code;
}
