#include "cli/scene_files.h"
#include "scene/model/scene.h"
#include <stdlib.h>

typedef struct search {
    const scene *s;
    bool (*is_it)(void *context, const char *path);
    void *context;
} search;

static bool ask(const search *x, const char *named)
{
    char *path = named && named[0] ? scene_file_path(x->s, named) : NULL;
    const bool is_it = path && x->is_it(x->context, path);
    free(path);
    return is_it;
}

bool scene_files_any(const scene *s, bool (*is_it)(void *context, const char *path), void *context)
{
    const search x = {s, is_it, context};
    if ((s->path && s->path[0] && is_it(context, s->path)) || ask(&x, s->background.picture_path))
        return true;
    for (size_t i = 0; i < s->texture_count; i++)
        if (ask(&x, s->textures[i].path))
            return true;
    for (size_t i = 0; i < s->mesh_count; i++) {
        const mesh_entry *m = &s->meshes[i];
        if ((m->source == MESH_FILE && ask(&x, m->path)) || (m->source == MESH_SLIME && ask(&x, m->script_path)))
            return true;
    }
    return false;
}
