#include "study/grid.h"
#include "base/hash.h"
#include "base/number.h"
#include "scene/model/params.h"
#include "study/meaning.h"
#include "study/quick.h"
#include <stdlib.h>
#include <string.h>

static void point_free(study_point *point)
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
            point_free(&s->axes[axis].points[i]);
        free(s->axes[axis].points);
        free(s->axes[axis].name);
    }
    free(s->axes);
    point_free(&s->fixed);
    point_free(&s->reference);
    free(s->path);
    free(s->name);
    free(s->title);
    free(s->scene_path);
    free(s->text);
    free(s->scene_text);
    scene_destroy(s->base);
    free(s->identity);
    free(s->notes);
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

size_t study_cell_film(const study *s, size_t cell)
{
    size_t film = 0;
    for (size_t axis = 0; axis < s->axis_count; axis++)
        film = film * s->axes[axis].count + s->axes[axis].points[study_cell_point(s, cell, axis)].film;
    return film;
}

static bool is_performance_only(const scene *s, const char *path)
{
    param_place at;
    return param_place_find(s, path, &at, NULL) == STATUS_OK && at.row->performance_only;
}

static bool have_one_film(const scene *s, const study_point *a, const study_point *b)
{
    for (size_t i = 0; i < a->count; i++)
        if (strcmp(a->values[i], b->values[i]) != 0 && !is_performance_only(s, a->paths[i]))
            return false;
    return true;
}

void axis_find_films(study_axis *axis, const scene *s)
{
    for (size_t i = 0; i < axis->count; i++)
        for (axis->points[i].film = 0; !have_one_film(s, &axis->points[i], &axis->points[axis->points[i].film]);)
            axis->points[i].film++;
}

status grid_set_point(scene *to, const study_point *point, diagnostic *why)
{
    for (size_t i = 0; i < point->count; i++)
        TRY(scene_set(to, point->paths[i], point->values[i], why));
    return STATUS_OK;
}

status study_cell_scene(const study *s, size_t cell, scene **out, diagnostic *why)
{
    *out = NULL;
    scene *setting = scene_clone(s->base);
    if (!setting)
        return out_of_memory(why);
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, cell, axis)];
        status code = grid_set_point(setting, point, why);
        if (code != STATUS_OK) {
            diagnostic_locate(why, s->path, point->line, point->column);
            scene_destroy(setting);
            return code;
        }
    }
    if (s->quick)
        quick_frame(setting);
    *out = setting;
    return STATUS_OK;
}

status grid_check_kept(const study *s, const study_point *point, const scene *setting, diagnostic *why)
{
    for (size_t i = 0; i < point->count; i++) {
        char *value;
        TRY(scene_get(setting, point->paths[i], &value, why));
        status code = STATUS_OK;
        if (strcmp(value, point->values[i]) != 0) {
            code = diagnose(why, STATUS_BAD_INPUT, "set only one of them, or set the more general one first",
                            "%s is set to %s here, but a later parameter changes it to %s", point->paths[i],
                            point->values[i], value);
            diagnostic_locate(why, s->path, point->line, point->column);
        }
        free(value);
        if (code != STATUS_OK)
            return code;
    }
    return STATUS_OK;
}

status grid_each_cell(const study *s, grid_visit *look, void *context, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t cell = 0, count = study_cell_count(s); code == STATUS_OK && cell < count; cell++) {
        scene *setting = NULL;
        code = study_cell_scene(s, cell, &setting, why);
        THEN(code, look(context, s, cell, setting, why));
        scene_destroy(setting);
    }
    return code;
}

static status check_cell(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    (void)context;
    const study_point *last = &s->fixed;
    status code = grid_check_kept(s, &s->fixed, setting, why);
    for (size_t axis = 0; code == STATUS_OK && axis < s->axis_count; axis++) {
        last = &s->axes[axis].points[study_cell_point(s, cell, axis)];
        code = grid_check_kept(s, last, setting, why);
    }
    if (code == STATUS_OK && (code = scene_check(setting, why)) != STATUS_OK)
        diagnostic_locate(why, s->path, last->line, last->column);
    return code;
}

status grid_check_cells(const study *s, diagnostic *why)
{
    return grid_each_cell(s, check_cell, NULL, why);
}

void grid_hash_text(uint64_t *hash, const char *text)
{
    *hash = hash_bytes(*hash, text, strlen(text) + 1);
}

status grid_hash_scene(uint64_t *hash, const scene *of, bool without_performance)
{
    meaning said = {0};
    const status code = meaning_of_scene(&said, of, without_performance);
    const int64_t word = (int64_t)meaning_hash(&said);
    meaning_free(&said);
    *hash = hash_words(*hash, &word, 1);
    return code == STATUS_OK ? grid_hash_files(hash, of, NULL) : code;
}

void grid_hash_point(uint64_t *hash, const study_point *point)
{
    for (size_t i = 0; i < point->count; i++) {
        grid_hash_text(hash, point->paths[i]);
        grid_hash_text(hash, point->values[i]);
    }
}

const char *study_grid_path(const study *s, size_t index)
{
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *first = &s->axes[axis].points[0];
        if (index < first->count)
            return first->paths[index];
        index -= first->count;
    }
    return NULL;
}

void grid_put_paths(const study *s, FILE *out)
{
    const char *path;
    for (size_t i = 0; (path = study_grid_path(s, i)); i++)
        fprintf(out, "\t%s", path);
}

void grid_put_values(const study *s, size_t cell, FILE *out)
{
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, cell, axis)];
        for (size_t i = 0; i < point->count; i++)
            fprintf(out, "\t%s", point->values[i]);
    }
}

/* The next element of a vector, and what is left; false if it is not a number. */
static bool next_number(const char **text, double *value)
{
    char number[64];
    *text += strspn(*text, " ");
    size_t length = strcspn(*text, ","), used = length;
    while (used > 0 && (*text)[used - 1] == ' ')
        used--;
    if (used >= sizeof number)
        return false;
    memcpy(number, *text, used);
    number[used] = 0;
    *text += length;
    return number_parse_real(number, value);
}

bool grid_same_value(const char *a, const char *b)
{
    if (strcmp(a, b) == 0)
        return true;
    char *bare[] = {strdup(a), strdup(b)};
    bool same = bare[0] && bare[1];
    for (int i = 0; same && i < 2; i++) {
        const size_t length = strlen(bare[i]);
        if (length >= 2 && bare[i][0] == '[' && bare[i][length - 1] == ']') {
            bare[i][length - 1] = 0;
            memmove(bare[i], bare[i] + 1, length - 1);
        }
    }
    const char *left = bare[0], *right = bare[1];
    for (bool more = true; same && more;) {
        double first, second;
        same = next_number(&left, &first) && next_number(&right, &second) && first == second && *left == *right;
        more = same && *left == ',';
        left += more;
        right += more;
    }
    free(bare[0]);
    free(bare[1]);
    return same;
}
