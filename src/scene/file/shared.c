/* Which scenes may be shared, and their forms: text, code of a link, metadata of an image. shared_read.c reads
 * these. */
#include "scene/file/shared.h"
#include "base/text.h"
#include "scene/file/write.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static status refuse_file(const char *what, const char *path, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "remove it, or send the scene file together with its files",
                    "a shared scene cannot name files, but %.80s reads %.200s", what, path);
}

/* Refuses what a program gave as arrays: no file of it could accompany the scene. */
static status refuse_arrays(const char *name, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "remove it, or write it to a file, and send the scene file together with it",
                    "%.80s was given as arrays, which a shared scene cannot contain", name);
}

static status check_files(const scene *s, diagnostic *why)
{
    if (s->background.image_path[0])
        return refuse_file("the background", s->background.image_path, why);
    if (s->texture_count > 0 && !s->textures[0].path[0])
        return refuse_arrays(s->textures[0].name, why);
    if (s->texture_count > 0)
        return refuse_file(s->textures[0].name, s->textures[0].path, why);
    if (s->data_count > 0 && !s->data[0].path[0])
        return refuse_arrays(s->data[0].name, why);
    if (s->data_count > 0)
        return refuse_file(s->data[0].name, s->data[0].path, why);
    for (size_t i = 0; i < s->mesh_count; i++) {
        const mesh_entry *m = &s->meshes[i];
        if (m->path[0] || m->script_path[0])
            return refuse_file(m->name, m->path[0] ? m->path : m->script_path, why);
        if (m->source == MESH_ARRAYS)
            return refuse_arrays(m->name, why);
    }
    return STATUS_OK;
}

#define SMALLER "make the scene smaller, or send the scene file instead"

static status too_much(const char *what, double value, double limit, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, SMALLER, "a shared scene can have at most %.4g %s, not %.4g", limit, what,
                    value);
}

static double motion_of(const scene *s)
{
    double work = 0.0;
    for (size_t i = 0; i < s->mesh_count; i++)
        if (s->meshes[i].source == MESH_SLIME)
            work += slime_work(&s->meshes[i]);
    return work;
}

status shared_scene_check(const scene *s, diagnostic *why)
{
    TRY(check_files(s, why));
    const struct {
        const char *what;
        double value, limit;
    } bounds[] = {
        {"pixels", (double)s->render.width * (double)s->render.height, SHARED_PIXELS_MAX},
        {"triangles", scene_planned_triangles(s), SHARED_TRIANGLES_MAX},
        {"rays", scene_rays_bound(&s->render), SHARED_RAYS_MAX},
        {"steps times masses of slimes", motion_of(s), SHARED_MOTION_MAX},
    };
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++)
        if (bounds[i].value > bounds[i].limit)
            return too_much(bounds[i].what, bounds[i].value, bounds[i].limit, why);
    return STATUS_OK;
}

/* Resets the settings of the machine to their defaults. render.accel stays, because it decides the number of
 * intersection tests; beams are no setting of the machine. */
static status forget_machine(void *bare, const param_place *at)
{
    const bool is_of_machine = at->row->performance_only && strcmp(at->row->name, "accel") != 0;
    return is_of_machine ? param_place_set(bare, at, at->row->name, at->row->fallback, NULL) : STATUS_OK;
}

static status too_long(diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, SMALLER, "a shared scene can have at most %d bytes of text",
                    SHARED_TEXT_MAX);
}

status shared_scene_text(const scene *s, char **text, diagnostic *why)
{
    enum { SOLID_LEAST = 20 }; /* bytes of the shortest solid */
    *text = NULL;
    TRY(shared_scene_check(s, why));
    if (s->solid_count > SHARED_TEXT_MAX / SOLID_LEAST)
        return too_long(why);
    scene *bare = scene_clone(s);
    const bool forgot = bare && param_place_each(s, PARAM_RENDER, forget_machine, bare) == STATUS_OK &&
                        param_place_each(s, PARAM_MESH, forget_machine, bare) == STATUS_OK;
    const status code = forgot ? scene_write_short(bare, SHARED_TEXT_MAX, text, why) : out_of_memory(why);
    scene_destroy(bare);
    return code == STATUS_OK && !*text ? too_long(why) : code;
}

status shared_scene_code(const char *text, char **code, diagnostic *why)
{
    const uLong size = (uLong)strlen(text);
    uLongf room = compressBound(size);
    unsigned char *packed = malloc(room);
    *code = NULL;
    if (packed && compress2(packed, &room, (const Bytef *)text, size, Z_BEST_COMPRESSION) == Z_OK)
        *code = base64_encode(packed, room, true);
    free(packed);
    return *code ? STATUS_OK : out_of_memory(why);
}

status shared_texts_make(const scene *s, shared_texts *texts, diagnostic *why)
{
    *texts = (shared_texts){.item = {{"Software", "Cuvette " CUVETTE_VERSION}}, .count = 1};
    const status code = shared_scene_text(s, &texts->scene, why);
    if (code == STATUS_OK)
        texts->item[texts->count++] = (image_text){SHARED_KEYWORD, texts->scene};
    return code == STATUS_BAD_INPUT ? STATUS_OK : code;
}
