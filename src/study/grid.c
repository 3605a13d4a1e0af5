#include "study/grid.h"
#include "base/hash.h"
#include "scene/params.h"
#include <stdlib.h>
#include <string.h>

void study_point_free(study_point *point)
{
    for (size_t i = 0; i < point->count; i++) {
        free(point->paths[i]);
        free(point->values[i]);
    }
    free(point->paths);
    free(point->values);
    *point = (study_point){0};
}

void study_destroy(study *s)
{
    if (!s)
        return;
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        for (size_t i = 0; i < s->axes[axis].count; i++)
            study_point_free(&s->axes[axis].points[i]);
        free(s->axes[axis].points);
        free(s->axes[axis].name);
    }
    free(s->axes);
    study_point_free(&s->fixed);
    free(s->path);
    free(s->name);
    free(s->title);
    free(s->scene_path);
    free(s->text);
    free(s->scene_text);
    scene_destroy(s->base);
    free(s);
}

size_t study_cell_count(const study *s)
{
    size_t count = 1;
    for (size_t axis = 0; axis < s->axis_count; axis++)
        count *= s->axes[axis].count;
    return count;
}

size_t study_cell_point(const study *s, size_t cell, size_t axis)
{
    for (size_t last = s->axis_count - 1; last > axis; last--)
        cell /= s->axes[last].count;
    return cell % s->axes[axis].count;
}

static status set_point(scene *to, const study_point *point, diagnostic *why)
{
    for (size_t i = 0; i < point->count; i++) {
        status code = scene_set(to, point->paths[i], point->values[i], why);
        if (code != STATUS_OK)
            return code;
    }
    return STATUS_OK;
}

status study_cell_scene(const study *s, size_t cell, scene **out, diagnostic *why)
{
    *out = NULL;
    scene *setting = scene_clone(s->base);
    if (!setting)
        return diagnose(why, STATUS_FAILURE, "", "out of memory");
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, cell, axis)];
        status code = set_point(setting, point, why);
        if (code != STATUS_OK) {
            diagnostic_locate(why, s->path, point->line, point->column);
            scene_destroy(setting);
            return code;
        }
    }
    *out = setting;
    return STATUS_OK;
}

status grid_check_cells(const study *s, diagnostic *why)
{
    for (size_t cell = 0, count = study_cell_count(s); cell < count; cell++) {
        scene *setting;
        status code = study_cell_scene(s, cell, &setting, why);
        if (code != STATUS_OK)
            return code;
        code = scene_check(setting, why);
        scene_destroy(setting);
        if (code == STATUS_OK)
            continue;
        const study_point *at = &s->fixed;
        if (s->axis_count) {
            const study_axis *last = &s->axes[s->axis_count - 1];
            at = &last->points[study_cell_point(s, cell, s->axis_count - 1)];
        }
        diagnostic_locate(why, s->path, at->line, at->column);
        return code;
    }
    return STATUS_OK;
}

static void hash_text(uint64_t *hash, const char *text)
{
    *hash = hash_bytes(*hash, text, strlen(text) + 1);
}

static void hash_integer(uint64_t *hash, int64_t value)
{
    *hash = hash_words(*hash, &value, 1);
}

static status hash_param(void *context, const char *path, const param *row, const char *value)
{
    (void)row;
    hash_text(context, path);
    hash_text(context, value);
    return STATUS_OK;
}

status grid_definition(const study *s, uint64_t *hash, diagnostic *why)
{
    status code = scene_load_pictures(s->base, why);
    if (code != STATUS_OK)
        return code;
    *hash = HASH_START;
    hash_text(hash, s->name);
    code = scene_each_param(s->base, hash_param, hash);
    if (code != STATUS_OK)
        return code;
    /* What the parameters do not say. */
    hash_integer(hash, s->base->camera.aimed);
    for (size_t i = 0; i < s->base->solid_count; i++) {
        hash_integer(hash, s->base->solids[i].shape.kind);
        hash_integer(hash, s->base->solids[i].material_index);
    }
    const image *sky = s->base->background.picture;
    if (sky)
        *hash = hash_bytes(*hash, sky->pixel, (size_t)sky->width * (size_t)sky->height * 3 * sizeof *sky->pixel);
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        hash_integer(hash, (int64_t)s->axes[axis].count);
        for (size_t i = 0; i < s->axes[axis].count; i++) {
            const study_point *point = &s->axes[axis].points[i];
            for (size_t k = 0; k < point->count; k++) {
                hash_text(hash, point->paths[k]);
                hash_text(hash, point->values[k]);
            }
        }
    }
    *hash = hash_finish(*hash);
    return STATUS_OK;
}
