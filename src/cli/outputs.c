/* Output files of the commands: checks of their names before any work, and writing. */
#include "cli/outputs.h"
#include "base/file.h"
#include "cli/options.h"
#include "render/frame/record.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct named_file {
    const char *option, *path;
} named_file;

static status refuse(const named_file *file, diagnostic *why, const char *remedy, const char *what)
{
    return options_wrong(file->option, file->path, why, remedy, "%s", what);
}

bool outputs_ends_with(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

bool outputs_is_page(const char *path)
{
    return outputs_ends_with(path, ".html");
}

bool outputs_same_entry(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

char *outputs_folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash)
        return strdup(".");
    return slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
}

/* Returns whether two paths name the same file, however spelt. The file need not exist yet. */
static bool same_file(const char *a, const char *b)
{
    if (strcmp(a, b) == 0 || outputs_same_entry(a, b))
        return true;
    char *first = outputs_folder_of(a), *second = outputs_folder_of(b);
    bool same = first && second && strcmp(file_name_of(a), file_name_of(b)) == 0 && outputs_same_entry(first, second);
    free(first);
    free(second);
    return same;
}

/* Whether the path is a device, a pipe or a link: then its folder need not be writable. */
static bool is_special(const char *path)
{
    struct stat about;
    return lstat(path, &about) == 0 && !S_ISREG(about.st_mode);
}

static status check_folder(const named_file *file, diagnostic *why)
{
    struct stat about;
    if (stat(file->path, &about) == 0 && S_ISDIR(about.st_mode))
        return refuse(file, why, "give a file inside that folder", "is a folder");
    char *folder = outputs_folder_of(file->path);
    if (!folder)
        return out_of_memory(why);
    const bool there = stat(folder, &about) == 0 && S_ISDIR(about.st_mode);
    const bool open = there && (is_special(file->path) || euidaccess(folder, W_OK) == 0);
    free(folder);
    if (!there)
        return refuse(file, why, "create it first, or give another", "the folder does not exist");
    return open
               ? STATUS_OK
               : refuse(file, why, "give a file in a folder in which you may write", "you may not write in the folder");
}

typedef struct search {
    const scene *s;
    bool (*matches)(void *context, const char *path);
    void *context;
} search;

static bool matches_file(const search *x, const char *named)
{
    char *path = named && named[0] ? scene_file_path(x->s, named) : NULL;
    const bool found = path && x->matches(x->context, path);
    free(path);
    return found;
}

bool scene_files_any(const scene *s, bool (*matches)(void *context, const char *path), void *context)
{
    const search x = {s, matches, context};
    if ((s->path && s->path[0] && matches(context, s->path)) || matches_file(&x, s->background.image_path))
        return true;
    for (size_t i = 0; i < s->texture_count; i++)
        if (matches_file(&x, s->textures[i].path))
            return true;
    for (size_t i = 0; i < s->data_count; i++)
        if (matches_file(&x, s->data[i].path))
            return true;
    for (size_t i = 0; i < s->mesh_count; i++) {
        const mesh_entry *m = &s->meshes[i];
        if ((m->source == MESH_FILE && matches_file(&x, m->path)) ||
            (m->source == MESH_SLIME && matches_file(&x, m->script_path)))
            return true;
    }
    return false;
}

static bool is_file_of(const char *path, const scene *s, const char *named)
{
    char *full_path = named && named[0] ? scene_file_path(s, named) : NULL;
    bool same = full_path && same_file(path, full_path);
    free(full_path);
    return same;
}

static bool is_script_of(const char *path, const scene *s)
{
    for (size_t i = 0; i < s->mesh_count; i++)
        if (s->meshes[i].source == MESH_SLIME && is_file_of(path, s, s->meshes[i].script_path))
            return true;
    return false;
}

static status check_image(const outputs *o, const named_file *file, bool is_map, diagnostic *why)
{
    image_format format = image_format_of(file->path);
    if (strcmp(file->path, "-") == 0)
        return refuse(file, why,
                      is_map ? "give a file that ends in .png, .pfm or .exr"
                             : "give a file that ends in " IMAGE_ENDINGS,
                      "standard output has no image format");
    if (is_map && format != IMAGE_PNG && !image_format_is_float(format))
        return refuse(file, why, "use .png for an image with a colour scale, .pfm or .exr for the numbers",
                      "unsupported format of a map");
    if (format == IMAGE_UNKNOWN)
        return refuse(file, why, "use " IMAGE_ENDINGS, "unknown image format");
    if (!is_map && o->bits == 16 && format != IMAGE_PNG)
        return refuse(file, why, "remove --bits, or use .png", "only PNG supports 16 bits");
    return STATUS_OK;
}

static bool is_same(void *context, const char *path)
{
    return same_file(context, path);
}

static status check_not_read(const named_file *file, const scene *s, diagnostic *why)
{
    if (scene_files_any(s, is_same, (void *)(uintptr_t)file->path))
        return refuse(file, why, "give another file", "the scene reads this file");
    return STATUS_OK;
}

/* Whether a map goes into the OpenEXR file of the image, as a channel. */
static bool joins_image(const outputs *o, const char *map)
{
    return map && o->img && image_format_of(o->img) == IMAGE_EXR && same_file(map, o->img);
}

static status check_file(const outputs *o, const named_file *files, size_t at, const scene *s, diagnostic *why)
{
    enum { TIMELINE = 5 };
    const named_file *file = &files[at];
    if (at < TIMELINE && !(at == 0 && outputs_is_page(file->path)))
        TRY(check_image(o, file, at > 0, why));
    else if (at >= TIMELINE && !outputs_ends_with(file->path, ".json"))
        return refuse(file, why, "use .json", "a timeline must be a JSON file");
    TRY(check_folder(file, why));
    TRY(check_not_read(file, s, why));
    for (size_t i = 0; i < at; i++)
        if (files[i].path && same_file(file->path, files[i].path) && !joins_image(o, file->path))
            return refuse(file, why, "give another file", "two outputs have the same file");
    return STATUS_OK;
}

/* Checks the file of each layer like a named output. */
static status check_layers(const outputs *o, const named_file *files, size_t count, const scene *s, diagnostic *why)
{
    const named_file prefix = {"--layers", o->layers};
    const char *word = integrator_with_layers();
    if (!integrator_traits_of(&s->render)->layers) {
        char remedy[64];
        snprintf(remedy, sizeof remedy, "set render.integrator to %s", word ? word : "one with layers");
        return refuse(&prefix, why, remedy, "this render.integrator has no layers");
    }
    status result = STATUS_OK;
    for (int i = 0; i < LAYER_COUNT && result == STATUS_OK; i++) {
        char *path = record_layer_path(o->layers, i);
        const named_file file = {"--layers", path};
        result = path ? check_folder(&file, why) : out_of_memory(why);
        THEN(result, check_not_read(&file, s, why));
        for (size_t k = 0; k < count && result == STATUS_OK; k++)
            if (files[k].path && same_file(path, files[k].path))
                result = refuse(&file, why, "give another prefix", "two outputs have the same file");
        free(path);
    }
    return result;
}

status outputs_check(const outputs *o, const scene *s, diagnostic *why)
{
    const named_file files[] = {{"-o", o->img},    {"--rays", o->rays},   {"--time", o->time},
                                {"--cut", o->cut}, {"--noise", o->noise}, {"--timeline", o->timeline}};
    if (o->noise && (!integrator_traits_of(&s->render)->by_chance || s->render.paths < 2))
        return refuse(&files[4], why, "set render.integrator to path and render.paths to 16 or more",
                      "this scene is rendered without random samples");
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        if (files[i].path)
            TRY(check_file(o, files, i, s, why));
    return o->layers ? check_layers(o, files, sizeof files / sizeof files[0], s, why) : STATUS_OK;
}

status outputs_check_image(const char *option, const char *path, const char *const *read, size_t count, diagnostic *why)
{
    const named_file file = {option, path};
    TRY(check_image(&(outputs){0}, &file, false, why));
    TRY(check_folder(&file, why));
    for (size_t i = 0; i < count; i++)
        if (same_file(path, read[i]))
            return refuse(&file, why, "give another file", "one of the images is read from this file");
    return STATUS_OK;
}

status outputs_ending(const char *option, const char *path, const char *const *endings, size_t count,
                      const char *remedy, size_t *which, diagnostic *why)
{
    const named_file file = {option, path};
    for (size_t i = 0; i < count; i++)
        if (outputs_ends_with(path, endings[i])) {
            *which = i;
            return STATUS_OK;
        }
    return refuse(&file, why, remedy, "unknown file name ending");
}

status outputs_check_folder(const char *option, const char *path, diagnostic *why)
{
    return strcmp(path, "-") == 0 ? STATUS_OK : check_folder(&(named_file){option, path}, why);
}

status outputs_check_place(const char *option, const char *path, const scene *s, diagnostic *why)
{
    const named_file file = {option, path};
    if (strcmp(path, "-") == 0)
        return STATUS_OK;
    TRY(check_folder(&file, why));
    return check_not_read(&file, s, why);
}

status outputs_check_script(const char *option, const char *path, const scene *s, diagnostic *why)
{
    const named_file file = {option, path};
    const bool is_read = strcmp(path, "-") != 0 && is_script_of(path, s);
    return is_read ? refuse(&file, why, "give another file", "this file is a script that the scene uses") : STATUS_OK;
}

status outputs_write_text(const char *path, status (*write)(const void *content, FILE *out, diagnostic *why),
                          const void *content, diagnostic *why)
{
    if (!path || strcmp(path, "-") == 0)
        return write(content, stdout, why);
    file_writer writer;
    TRY(file_writer_open(&writer, path, why));
    return file_writer_end(&writer, write(content, writer.stream, why), why);
}

/* A map is written into a file of its own, or is a channel of the image. */
static status write_map(const outputs *o, const char *path, const double *values, const film *f, const char *title,
                        diagnostic *why)
{
    return path && values && !joins_image(o, path) ? record_map(values, f, title, path, why) : STATUS_OK;
}

status outputs_write(const outputs *o, const scene *s, const render_result *result, const record_more *more,
                     diagnostic *why)
{
    render_result shown = *result; /* with the maps that join the image */
    shown.pixel_rays = joins_image(o, o->rays) ? result->pixel_rays : NULL;
    shown.pixel_ns = joins_image(o, o->time) ? result->pixel_ns : NULL;
    shown.pixel_cut = joins_image(o, o->cut) ? result->pixel_cut : NULL;
    if (o->img && !outputs_is_page(o->img))
        TRY(record_image(&shown, more, s, o->img, o->bits == 16 ? 16 : 8, why));
    TRY(write_map(o, o->rays, result->pixel_rays, result->img, "rays per pixel", why));
    TRY(write_map(o, o->time, result->pixel_ns, result->img, "nanoseconds per pixel", why));
    TRY(write_map(o, o->cut, result->pixel_cut, result->img, "fraction of cut light per pixel", why));
    if (o->noise && result->variance && !joins_image(o, o->noise))
        TRY(record_noise(result, o->noise, why));
    if (o->timeline && result->events)
        TRY(record_timeline(result, o->timeline, why));
    return o->layers && result->layers ? record_layers(result, o->layers, why) : STATUS_OK;
}
