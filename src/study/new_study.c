/* Composes the text of a new study file, and reads it as a run would. */
#include "study/new_study.h"
#include "base/file.h"
#include "base/text.h"
#include "scene/file/write.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

enum { NAME_LENGTH = 64 };

/* Applies one setting, or each value of one axis, so that an error is located at its option. */
static status try_settings(const new_study_order *r, scene *s, const new_axis *axes, diagnostic *why)
{
    char where[512];
    for (size_t i = 0; i < r->set_count; i++) {
        const status code = scene_set_assignment(s, r->sets[i], why);
        snprintf(where, sizeof where, "--set %.400s", r->sets[i]);
        if (code != STATUS_OK) {
            diagnostic_locate(why, where, 0, 0);
            return code;
        }
    }
    scene *on = scene_clone(s);
    status code = on ? STATUS_OK : out_of_memory(why);
    for (size_t a = 0; a < r->axis_count && code == STATUS_OK; a++)
        for (size_t i = 0; i < axes[a].count - (axes[a].range ? 1 : 0) && code == STATUS_OK; i++) {
            code = scene_set(on, axes[a].path, axes[a].values[i], why);
            snprintf(where, sizeof where, "--axis %.400s", r->axes[a]);
            if (code != STATUS_OK)
                diagnostic_locate(why, where, 0, 0);
        }
    scene_destroy(on);
    return code;
}

/* The name of the file without its ending; or the names of scene and parameter, "rod-depth". */
static void choose_name(const new_study_order *r, const new_axis *first, char name[NAME_LENGTH + 1])
{
    const char *file = file_name_of(r->target ? r->target : r->scene);
    const char *ending = strrchr(file, '.'), *parameter = strrchr(first->path, '.');
    const int length = ending ? (int)(ending - file) : (int)strlen(file);
    if (r->name)
        snprintf(name, NAME_LENGTH + 1, "%s", r->name);
    else if (r->target)
        snprintf(name, NAME_LENGTH + 1, "%.*s", length, file);
    else
        snprintf(name, NAME_LENGTH + 1, "%.*s-%s", length, file, parameter ? parameter + 1 : first->path);
    for (char *c = name; !r->name && *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_", *c))
            *c = '-';
}

/* Locates an error in a file that was not written at the option that made its line. */
static void relocate(const new_study_order *r, const char *text, diagnostic *why)
{
    char where[512] = "study new";
    size_t axes = 0;
    for (long line = 1; line <= why->line && *text; line++) {
        axes += strncmp(text, "  - {", 5) == 0;
        if (line == why->line && strncmp(text, "study: ", 7) == 0)
            snprintf(where, sizeof where, "--name %.400s", r->name ? r->name : "");
        text += strcspn(text, "\n");
        text += *text == '\n';
    }
    if (axes > 0 && axes <= r->axis_count)
        snprintf(where, sizeof where, "--axis %.400s", r->axes[axes - 1]);
    diagnostic_locate(why, where, 0, 0);
}

static status write_and_read(const new_study_order *r, const new_study *made, const char *file, char **text,
                             study **read, diagnostic *why)
{
    text_writer writer;
    size_t size = 0;
    TRY(text_writer_open(&writer, why));
    new_study_write(made, writer.stream);
    TRY(text_writer_close(&writer, text, &size, why));
    const status code = study_read_text_guarded(file, *text, size, r->guard, read, why);
    if (code == STATUS_BAD_INPUT && why->line > 0)
        relocate(r, *text, why);
    return code;
}

static status compose(const new_study_order *r, scene *s, new_axis *axes, char **text, study **read, diagnostic *why)
{
    char where[512], name[NAME_LENGTH + 1], file[NAME_LENGTH + 16], *path = NULL;
    for (size_t i = 0; i < r->axis_count; i++) {
        const status code = new_axis_parse(r->axes[i], &axes[i], why);
        snprintf(where, sizeof where, "--axis %.400s", r->axes[i]);
        if (code != STATUS_OK) {
            diagnostic_locate(why, where, 0, 0);
            return code;
        }
    }
    TRY(try_settings(r, s, axes, why));
    choose_name(r, &axes[0], name);
    snprintf(file, sizeof file, "%s.study", name);
    const char *target = r->target ? r->target : file;
    TRY(write_moved_path(file_name_of(r->scene), r->scene, target, &path, why));
    const new_study made = {.name = name,
                            .scene_path = path,
                            .of = s,
                            .sets = r->sets,
                            .set_count = r->set_count,
                            .axes = axes,
                            .axis_count = r->axis_count,
                            .repetitions = r->repetitions,
                            .warmups = r->warmups};
    const status code = write_and_read(r, &made, target, text, read, why);
    free(path);
    return code;
}

status new_study_compose(const new_study_order *order, scene *s, char **text, study **read, diagnostic *why)
{
    *text = NULL;
    *read = NULL;
    new_axis *axes = calloc(order->axis_count + 1, sizeof *axes);
    status code = axes ? STATUS_OK : out_of_memory(why);
    THEN(code, compose(order, s, axes, text, read, why));
    for (size_t i = 0; axes && i < order->axis_count; i++)
        new_axis_release(&axes[i]);
    free(axes);
    if (code != STATUS_OK) {
        study_destroy(*read);
        free(*text);
        *read = NULL;
        *text = NULL;
    }
    return code;
}
