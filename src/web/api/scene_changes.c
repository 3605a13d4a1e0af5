/* Differences between two scenes: the scene document and its file, as the command line that renders the document; and
 * the scenes of two images, as a list of parameters. document/scene_document_changes.c edits the scene. */
#include "base/text.h"
#include "report/json.h"
#include "report/report.h"
#include "scene/file/write.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "web/api/api.h"

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
    static const param_group groups[] = {PARAM_SOLID, PARAM_LIGHT,   PARAM_BEAM, PARAM_MATERIAL,
                                         PARAM_MESH,  PARAM_TEXTURE, PARAM_DATA};
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

/* The settings so far, and the scene that results from them. */
typedef struct writing {
    json_t *settings;
    scene *so_far;
    bool camera; /* the camera is aimed differently: write all its parameters */
} writing;

static status add_setting(void *context, const char *path, const param *row, const char *value)
{
    writing *w = context;
    char *current = NULL;
    status code = scene_get(w->so_far, path, &current, NULL);
    if (code == STATUS_FAILURE)
        return code;
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

static status read_file(const folder *files, const char *file, int threads, scene **out, char **path, diagnostic *why)
{
    TRY(folder_path(files, file, true, path, why));
    TRY(scene_read_below(*path, folder_real(files), out, why));
    if (threads > 0 && (*out)->render.threads == 1)
        (*out)->render.threads = threads;
    return STATUS_OK;
}

/* A copy of s with the names of its files relative to the folder of `path`. */
static status rebase_paths(const scene *s, const char *path, scene **out, diagnostic *why)
{
    if (strcmp(s->path, path) == 0)
        return (*out = scene_clone(s)) ? STATUS_OK : out_of_memory(why);
    char *text = NULL;
    status code = scene_write_text(s, path, false, &text, why);
    THEN(code, scene_read_text(path, text, strlen(text), out, why));
    free(text);
    return code;
}

/* The settings that turn `from` into s. STATUS_BAD_INPUT if settings do not suffice. */
static status collect(json_t *settings, scene *from, const char *path, const scene *s, diagnostic *why)
{
    scene *rebased = NULL;
    status code = rebase_paths(s, path, &rebased, why);
    if (code == STATUS_OK && !same_objects(from, rebased))
        code = STATUS_BAD_INPUT;
    if (code == STATUS_OK) {
        writing w = {settings, from, from->camera.aimed != rebased->camera.aimed};
        code = scene_each_param(rebased, add_setting, &w);
        if (code == STATUS_FAILURE)
            out_of_memory(why);
    }
    scene_destroy(rebased);
    return code;
}

status command_settings(const folder *files, const char *file, const scene *s, int threads, char **path,
                        json_t **settings, bool *complete, diagnostic *why)
{
    scene *from = NULL;
    diagnostic refused = {.what = ""};
    *complete = false;
    *path = NULL;
    *settings = json_array();
    if (!*settings)
        return out_of_memory(why);
    status code = file ? read_file(files, file, threads, &from, path, &refused) : STATUS_BAD_INPUT;
    if (code != STATUS_OK) {
        free(*path);
        *path = NULL;
    }
    THEN(code, collect(*settings, from, *path, s, &refused));
    scene_destroy(from);
    *complete = code == STATUS_OK;
    if (code == STATUS_FAILURE && why)
        *why = refused;
    return code == STATUS_FAILURE ? code : STATUS_OK;
}

/* The scene's name in a command. A laboratory in a browser keeps its folder in memory, so the path does not exist
 * where the command is run. */
static const char *scene_name(const char *path, const char *file)
{
#if defined __EMSCRIPTEN__
    return path ? file : NULL;
#else
    (void)file;
    return path;
#endif
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
    const char *name = scene_name(path, file);
    shell_word_write(writer.stream, name ? name : "scene.yaml");
    for (size_t i = 0; i < json_array_size(settings); i++) {
        fputs(" --set ", writer.stream);
        shell_word_write(writer.stream, json_string_value(json_array_get(settings, i)));
    }
    fputs(" -o image.png", writer.stream);
    json_decref(settings);
    free(path);
    return text_writer_end(&writer, code, text, NULL, why);
}

/* --- the parameters in which two scenes differ --- */

static status add_value(void *context, const char *path, const param *row, const char *text)
{
    return json_object_set_new(context, path, report_value(row, text)) ? STATUS_FAILURE : STATUS_OK;
}

/* {path: value} of the parameters in use: an aimed camera, for example, does not use its angles. */
static json_t *values_of(const scene *s)
{
    json_t *values = json_object();
    return json_if(values, values && scene_each_param(s, add_value, values) == STATUS_OK);
}

static int add_change(json_t *list, const char *path, json_t *a, json_t *b)
{
    return json_array_append_new(
        list, json_pack("{s:s, s:O?, s:O?}", "path", path, "a", a ? a : json_null(), "b", b ? b : json_null()));
}

/* Whether path belongs to a solid and has the value of the solid's material. */
static bool is_inherited(const scene *s, const json_t *values, const char *path)
{
    const char *dot = strchr(path, '.');
    const size_t length = dot ? (size_t)(dot - path) : 0;
    for (size_t i = 0; dot && i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (strlen(one->name) != length || strncmp(one->name, path, length) != 0 || one->material_index < 0)
            continue;
        char *material_path = text_format("%s%s", s->materials[one->material_index].name, dot);
        const json_t *inherited = material_path ? json_object_get(values, material_path) : NULL;
        free(material_path);
        return inherited && json_equal(inherited, json_object_get(values, path));
    }
    return false;
}

static json_t *list_changes(const scene *scene_a, const scene *scene_b, json_t *a, json_t *b)
{
    json_t *list = json_array(), *value;
    const char *path;
    int bad = !list;
    json_object_foreach(b, path, value)
    {
        json_t *before = json_object_get(a, path);
        if (before && (json_equal(before, value) || (is_inherited(scene_a, a, path) && is_inherited(scene_b, b, path))))
            continue;
        bad |= add_change(list, path, before, value);
    }
    json_object_foreach(a, path, value) if (!json_object_get(b, path)) bad |= add_change(list, path, value, NULL);
    return json_if(list, !bad);
}

json_t *changed_params(const scene *a, const scene *b)
{
    json_t *values_a = values_of(a), *values_b = values_of(b);
    json_t *list = values_a && values_b ? list_changes(a, b, values_a, values_b) : NULL;
    json_decref(values_a);
    json_decref(values_b);
    return list;
}
