/* The cells of a study: their points, scenes and references, texts of their values, and orders of measuring. */
#include "study/plan/grid.h"
#include "base/hash.h"
#include "base/number.h"
#include "base/random.h"
#include "base/text.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* Points of an axis, in the order of their values that act on the film. */
typedef struct film_order {
    const study_point *points;
    const bool *acts; /* of each value of a point: all points of an axis have the same paths */
} film_order;

static int compare_films(const film_order *o, size_t one, size_t two)
{
    const study_point *a = &o->points[one], *b = &o->points[two];
    int order = 0;
    for (size_t i = 0; i < a->count && order == 0; i++)
        order = o->acts[i] ? strcmp(a->values[i], b->values[i]) : 0;
    return order;
}

static int compare_points(const void *a, const void *b, void *context)
{
    const size_t one = *(const size_t *)a, two = *(const size_t *)b;
    const int order = compare_films(context, one, two);
    return order ? order : (one > two) - (one < two);
}

status grid_find_films(study_axis *axis, const scene *s, diagnostic *why)
{
    const study_point *first = &axis->points[0];
    size_t *sorted = malloc(axis->count * sizeof *sorted);
    bool *acts = malloc(first->count * sizeof *acts + 1);
    film_order by_film = {axis->points, acts};
    const status code = sorted && acts ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < first->count; i++)
        acts[i] = !is_performance_only(s, first->paths[i]);
    for (size_t i = 0; code == STATUS_OK && i < axis->count; i++)
        sorted[i] = i;
    if (code == STATUS_OK)
        qsort_r(sorted, axis->count, sizeof *sorted, compare_points, &by_film);
    for (size_t i = 0; code == STATUS_OK && i < axis->count; i++) {
        const bool same = i > 0 && compare_films(&by_film, sorted[i - 1], sorted[i]) == 0;
        axis->points[sorted[i]].film = same ? axis->points[sorted[i - 1]].film : sorted[i];
    }
    free(acts);
    free(sorted);
    return code;
}

status study_point_apply(const study_point *point, scene *to, diagnostic *why)
{
    for (size_t i = 0; i < point->count; i++)
        TRY(scene_set(to, point->paths[i], point->values[i], why));
    return STATUS_OK;
}

static int64_t divided(int64_t pixels, int64_t by)
{
    return pixels / by > 0 ? pixels / by : 1;
}

/* Divides width and height of the frame by the smallest integer that leaves at most QUICK_PIXELS pixels. */
static void quick_frame(scene *setting)
{
    const int64_t width = setting->render.width, height = setting->render.height;
    int64_t by = 1;
    while (divided(width, by) * divided(height, by) > QUICK_PIXELS)
        by++;
    setting->render.width = divided(width, by);
    setting->render.height = divided(height, by);
}

status study_cell_scene(const study *s, size_t cell, scene **out, diagnostic *why)
{
    *out = NULL;
    scene *setting = scene_clone(s->base);
    if (!setting)
        return out_of_memory(why);
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, cell, axis)];
        status code = study_point_apply(point, setting, why);
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

/* Fails, located at the point, if one of its parameters has been overwritten by a later one: the row would then have a
 * wrong value. */
static status check_kept(const study *s, const study_point *point, const scene *setting, diagnostic *why)
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

status grid_each_cell(const study *s, grid_visit *visit, void *context, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t cell = 0, count = study_cell_count(s); code == STATUS_OK && cell < count; cell++) {
        scene *setting = NULL;
        code = study_cell_scene(s, cell, &setting, why);
        THEN(code, visit(context, s, cell, setting, why));
        scene_destroy(setting);
    }
    return code;
}

static status check_cell(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    (void)context;
    const study_point *last = &s->fixed;
    status code = check_kept(s, &s->fixed, setting, why);
    for (size_t axis = 0; code == STATUS_OK && axis < s->axis_count; axis++) {
        last = &s->axes[axis].points[study_cell_point(s, cell, axis)];
        code = check_kept(s, last, setting, why);
    }
    if (code == STATUS_OK && (code = scene_check(setting, why)) != STATUS_OK)
        diagnostic_locate(why, s->path, last->line, last->column);
    return code;
}

status grid_check_cells(const study *s, diagnostic *why)
{
    return grid_each_cell(s, check_cell, NULL, why);
}

/* --- reference images --- */

status reference_scene(const study *s, size_t cell, scene **out, diagnostic *why)
{
    status code = study_cell_scene(s, cell, out, why);
    if (code == STATUS_OK && (code = study_point_apply(&s->reference, *out, why)) != STATUS_OK) {
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
        scene_destroy(*out);
        *out = NULL;
    }
    if (code == STATUS_OK && s->quick)
        quick_frame(*out);
    return code;
}

static status check_reference(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    (void)context;
    scene *reference = NULL;
    status code = reference_scene(s, cell, &reference, why);
    THEN(code, check_kept(s, &s->reference, reference, why));
    if (code == STATUS_OK && (code = scene_check(reference, why)) != STATUS_OK)
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
    if (code == STATUS_OK &&
        (setting->render.width != reference->render.width || setting->render.height != reference->render.height)) {
        code = diagnose(why, STATUS_BAD_INPUT, "give them the same size",
                        "the reference has %" PRId64 "x%" PRId64 " pixels, the image of cell %zu %" PRId64 "x%" PRId64,
                        reference->render.width, reference->render.height, cell, setting->render.width,
                        setting->render.height);
        diagnostic_locate(why, s->path, s->reference.line, s->reference.column);
    }
    scene_destroy(reference);
    return code;
}

status reference_check(const study *s, diagnostic *why)
{
    return s->reference.count ? grid_each_cell(s, check_reference, NULL, why) : STATUS_OK;
}

/* --- texts --- */

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

void grid_put_number(FILE *out, double value)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "\t%s", isfinite(value) ? number_format(value, text) : "NA");
}

/* Reads the next number of a vector, and moves *text past it; false if it is not a number. */
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

/* --- orders, processes, folder --- */

/* 64 random bits for a place of the order; attempt: how many draws were rejected before. */
static uint64_t random_bits(uint64_t seed, uint64_t stream, uint32_t place, uint32_t attempt)
{
    random_words drawn = random_at(seed, place, attempt, (uint32_t)stream, (uint32_t)(stream >> 32));
    return (uint64_t)drawn.word[1] << 32 | drawn.word[0];
}

/* Uniform on 0..bound-1: the lowest 2^64 mod bound values are rejected, so that every remainder is equally likely. */
static uint64_t random_below(uint64_t seed, uint64_t stream, uint32_t place, uint64_t bound)
{
    uint64_t rejected = -bound % bound; /* 2^64 mod bound */
    uint64_t bits;
    uint32_t attempt = 0;
    do
        bits = random_bits(seed, stream, place, attempt++);
    while (bits < rejected);
    return bits % bound;
}

void order_shuffle(uint64_t seed, uint64_t stream, size_t *order, size_t count)
{
    for (size_t i = 0; i < count; i++)
        order[i] = i;
    for (size_t i = count; i > 1; i--) {
        size_t j = (size_t)random_below(seed, stream, (uint32_t)i, i);
        size_t moved = order[i - 1];
        order[i - 1] = order[j];
        order[j] = moved;
    }
}

long study_processes(const study *s)
{
    return s->processes * (s->processes > 1 && s->repetitions_max > s->repetitions_min ? 2 : 1);
}

char *study_folder(const study *s, const char *results)
{
    return text_format("%s/%s", results, s->name);
}
