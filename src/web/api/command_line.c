/* The command line that renders the film of the scene document. */
#include "web/api/api.h"
#include "base/shell_word.h"
#include "base/text.h"
#include "base/text_writer.h"
#include "scene/model/params.h"
#include "scene/model/params_path.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *material_of(const scene *s, const solid *one)
{
    return one->material_index >= 0 ? s->materials[one->material_index].name : "";
}

/* Whether both scenes have the same objects, so that they differ in parameters only. */
static bool same_objects(const scene *a, const scene *b)
{
    static const param_group groups[] = {PARAM_SOLID,    PARAM_LIGHT, PARAM_BEAM,
                                         PARAM_MATERIAL, PARAM_MESH,  PARAM_TEXTURE};
    bool same = true;
    for (size_t g = 0; g < sizeof groups / sizeof *groups && same; g++) {
        same = param_place_group_size(a, groups[g]) == param_place_group_size(b, groups[g]);
        for (size_t i = 0; i < param_place_group_size(a, groups[g]) && same; i++)
            same = strcmp(param_place_group_name(a, groups[g], i), param_place_group_name(b, groups[g], i)) == 0;
    }
    for (size_t i = 0; i < a->solid_count && same; i++)
        same = a->solids[i].shape.kind == b->solids[i].shape.kind &&
               strcmp(material_of(a, &a->solids[i]), material_of(b, &b->solids[i])) == 0;
    return same;
}

/* The settings so far, and the scene that they give. */
typedef struct writing {
    json_t *settings;
    scene *so_far;
    bool camera; /* the camera is aimed differently: write all its parameters */
} writing;

static status add_option(void *of, const char *path, const param *row, const char *value)
{
    writing *w = of;
    char *current = NULL;
    status code = scene_get(w->so_far, path, &current, NULL);
    if (code != STATUS_OK || strcmp(current, value) != 0 || (w->camera && row->group == PARAM_CAMERA)) {
        code = scene_set(w->so_far, path, value, NULL);
        char *both = text_format("%s=%s", path, value);
        if (!both || json_array_append_new(w->settings, json_string(both)) != 0)
            code = STATUS_FAILURE;
        free(both);
    }
    free(current);
    return code;
}

static status read_again(const folder *files, const char *file, int threads, scene **out, char **path)
{
    diagnostic unread;
    status code = folder_path(files, file, true, path, &unread);
    THEN(code, scene_read_below(*path, folder_real(files), out, &unread));
    if (code == STATUS_OK && threads > 0 && (*out)->render.threads == 1)
        (*out)->render.threads = threads;
    return code;
}

/* The scene as read from that file, whose folder may differ from the base of the scene's own paths; NULL on error. */
static scene *rebase_paths(const scene *s, const char *path)
{
    if (strcmp(s->path, path) == 0)
        return scene_clone(s);
    scene *rebased = NULL;
    char *text = NULL;
    diagnostic ignored;
    if (scene_write_text(s, path, false, &text, &ignored) == STATUS_OK &&
        scene_read_text(path, text, strlen(text), &rebased, &ignored) != STATUS_OK)
        rebased = NULL;
    free(text);
    return rebased;
}

/* The settings that turn `from` into s; false where settings do not suffice. */
static bool collect(json_t *settings, scene *from, const char *path, const scene *s)
{
    scene *rebased = rebase_paths(s, path);
    writing w = {.settings = settings, .so_far = from};
    if (rebased)
        w.camera = from->camera.aimed != rebased->camera.aimed;
    const bool complete =
        rebased && same_objects(from, rebased) && scene_each_param(rebased, add_option, &w) == STATUS_OK;
    scene_destroy(rebased);
    return complete;
}

status command_settings(const folder *files, const char *file, const scene *s, int threads, char **path,
                        json_t **settings, bool *complete, diagnostic *why)
{
    scene *from = NULL;
    *complete = false;
    *path = NULL;
    *settings = json_array();
    if (!*settings)
        return out_of_memory(why);
    if (file && read_again(files, file, threads, &from, path) == STATUS_OK)
        *complete = collect(*settings, from, *path, s);
    else if (*path)
        free(*path), *path = NULL;
    scene_destroy(from);
    return STATUS_OK;
}

status command_line(const folder *files, const char *file, const scene *s, int threads, char **text, bool *complete,
                    diagnostic *why)
{
    char *path = NULL;
    json_t *settings = NULL;
    *text = NULL;
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    status code = command_settings(files, file, s, threads, &path, &settings, complete, why);
    fputs("cuvette render ", writer.stream);
    shell_word_write(writer.stream, path ? path : "scene.yaml");
    for (size_t i = 0; i < json_array_size(settings); i++) {
        fputs(" --set ", writer.stream);
        shell_word_write(writer.stream, json_string_value(json_array_get(settings, i)));
    }
    fputs(" -o image.png", writer.stream);
    json_decref(settings);
    free(path);
    return text_writer_end(&writer, code, text, NULL, why);
}
