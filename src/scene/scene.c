#include "scene/scene.h"
#include "base/text.h"
#include "scene/params_value.h"

#include <stdlib.h>
#include <string.h>

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
    free(s->materials);
    free(s->lights);
    free(s->solids);
    free(s->background.picture_path);
    image_destroy(s->background.picture);
    free(s->path);
    free(s->title);
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

static bool clone_objects(scene *s, const scene *original)
{
    bool whole = true;
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
    if (!from->picture) {
        return true;
    }
    if (image_create(from->picture->width, from->picture->height, &to->picture, NULL) != STATUS_OK) {
        return false;
    }
    size_t pixels = (size_t)from->picture->width * (size_t)from->picture->height;
    memcpy(to->picture->pixel, from->picture->pixel, pixels * 3 * sizeof(float));
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
    if (!whole || !s->path || !s->title) {
        scene_destroy(s);
        return NULL;
    }
    return s;
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

/* A picture that the scene file names is wrong there. */
static status picture_error(const scene *s, const diagnostic *bad, status code, diagnostic *why)
{
    if (s->background.picture_line == 0) {
        diagnostic_locate(why, bad->file, bad->line, bad->column);
        return diagnose(why, code, bad->remedy, "background.picture: %s", bad->what);
    }
    diagnostic_locate(why, s->path, s->background.picture_line, s->background.picture_column);
    return diagnose(why, code, bad->remedy, "background.picture: %s%s%s", bad->file, bad->file[0] ? ": " : "", bad->what);
}

/* Light is not negative, and the film must hold it. */
static status check_sky(const image *sky, const char *path, diagnostic *bad)
{
    for (int y = 0; y < sky->height; y++) {
        for (int x = 0; x < sky->width; x++) {
            const float *pixel = &sky->pixel[((size_t)y * (size_t)sky->width + (size_t)x) * 3];
            for (int channel = 0; channel < 3; channel++) {
                if (!(pixel[channel] >= 0.0F && pixel[channel] <= SCENE_SKY_MAX)) {
                    diagnostic_locate(bad, path, 0, 0);
                    return diagnose(bad, STATUS_BAD_INPUT, "scale the picture to 0..65536",
                                    "pixel %d,%d is %g in channel %d, and a sky's light is from 0 to 65536", x, y,
                                    (double)pixel[channel], channel);
                }
            }
        }
    }
    return STATUS_OK;
}

status scene_load_pictures(scene *s, diagnostic *why)
{
    background *sky = &s->background;
    if (sky->kind != BACKGROUND_PICTURE || sky->picture || !sky->picture_path[0]) {
        return STATUS_OK;
    }
    const char *slash = strrchr(s->path, '/');
    int folder = sky->picture_path[0] != '/' && slash ? (int)(slash - s->path) + 1 : 0;
    char *path = text_format("%.*s%s", folder, s->path, sky->picture_path);
    if (!path) {
        return diagnose(why, STATUS_FAILURE, "", "memory is out");
    }
    diagnostic bad = {.what = ""};
    status code = image_read(path, &sky->picture, NULL, &bad);
    if (code == STATUS_OK && (code = check_sky(sky->picture, path, &bad)) != STATUS_OK) {
        image_destroy(sky->picture);
        sky->picture = NULL;
    }
    free(path);
    return code == STATUS_OK ? code : picture_error(s, &bad, code, why);
}
