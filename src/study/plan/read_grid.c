/* Reads the fixed settings, the grid and the reference of a study file, and tries every value on a scene. */
#include "base/number.h"
#include "scene/model/params.h"
#include "study/plan/grid.h"
#include <stdlib.h>
#include <string.h>

enum { POINTS_MAX = 4096 };

bool read_grid_plain(const char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < ' ' || *text == 0x7f)
            return false;
    return true;
}

static status locate(const document *d, const node *at, diagnostic *why, status code)
{
    diagnostic_locate(why, document_name(d), at->line, at->column);
    return code;
}

/* Sets one parameter of the scene, and returns the value as scene_get writes it, so that 1.0 and 1 are one value. */
static status try_value(scene *target, const document *d, const node *key, const node *value, char **canonical,
                        diagnostic *why)
{
    char *now = NULL;
    *canonical = NULL;
    status code = scene_get(target, key->text, &now, why);
    free(now);
    if (code != STATUS_OK)
        return locate(d, key, why, code);
    char *text = node_value_text(value);
    if (!text && node_is_value(value))
        return out_of_memory(why);
    if (!text)
        return node_error(d, value, why, "write a number, a word, or a list without commas in its elements",
                          "%s cannot be set to this", key->text);
    if (!read_grid_plain(text))
        code = node_error(d, value, why, "remove them", "%s has control characters", key->text);
    else if ((code = scene_set(target, key->text, text, why)) != STATUS_OK ||
             (code = scene_get(target, key->text, canonical, why)) != STATUS_OK)
        locate(d, value, why, code);
    free(text);
    return code;
}

static status point_reserve(study_point *point, const node *at, size_t count, diagnostic *why)
{
    point->line = at->line;
    point->column = at->column;
    point->paths = calloc(count + 1, sizeof *point->paths);
    point->values = calloc(count + 1, sizeof *point->values);
    return point->paths && point->values ? STATUS_OK : out_of_memory(why);
}

/* Replaces -0 by 0, also in vectors: otherwise [-0, 0] would be two cells of the same scene. */
static void drop_signs_of_zeros(char *text)
{
    for (char *at = text; *at; at++) {
        const bool begins = at == text || strchr("[, ", at[-1]) != NULL;
        if (begins && at[0] == '-' && at[1] == '0' && (!at[2] || strchr(",] ", at[2])))
            memmove(at, at + 1, strlen(at));
    }
}

static status point_add(study_point *point, scene *target, const document *d, const node *key, const node *value,
                        diagnostic *why)
{
    char *canonical;
    TRY(try_value(target, d, key, value, &canonical, why));
    drop_signs_of_zeros(canonical);
    point->values[point->count] = canonical;
    point->paths[point->count] = strdup(key->text);
    return point->paths[point->count++] ? STATUS_OK : out_of_memory(why);
}

status read_point(study_point *point, scene *target, const document *d, const node *map, diagnostic *why)
{
    if (map->kind != NODE_MAP || map->count == 0)
        return node_error(d, map, why, "write {path: value}", "this sets no parameter");
    TRY(point_reserve(point, map, map->count, why));
    for (size_t i = 0; i < map->count; i++)
        TRY(point_add(point, target, d, map->keys[i], map->items[i], why));
    return STATUS_OK;
}

/* Reorders the point's paths to the order of the axis' first point. */
static status align_point(study_point *point, const study_point *first, const document *d, const node *at,
                          diagnostic *why)
{
    for (size_t i = 0; i < first->count; i++) {
        size_t found = i;
        while (found < point->count && strcmp(point->paths[found], first->paths[i]) != 0)
            found++;
        if (found >= point->count)
            return node_error(d, at, why, "set the same parameters in every point of an axis",
                              "this point does not set %s", first->paths[i]);
        char *path = point->paths[found], *value = point->values[found];
        point->paths[found] = point->paths[i];
        point->values[found] = point->values[i];
        point->paths[i] = path;
        point->values[i] = value;
    }
    if (point->count > first->count)
        return node_error(d, at, why, "set the same parameters in every point of an axis",
                          "the axis' first point does not set %s", point->paths[first->count]);
    return STATUS_OK;
}

static bool points_equal(const study_point *a, const study_point *b)
{
    for (size_t i = 0; i < a->count; i++)
        if (strcmp(a->values[i], b->values[i]) != 0)
            return false;
    return true;
}

/* Reads an axis of one parameter with a list of values. */
static status read_values(study_axis *axis, scene *target, const document *d, const node *key, const node *list,
                          diagnostic *why)
{
    axis->name = strdup(key->text);
    status code = axis->name ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < list->count; i++) {
        study_point *point = &axis->points[axis->count++];
        code = point_reserve(point, list->items[i], 1, why);
        THEN(code, point_add(point, target, d, key, list->items[i], why));
    }
    return code;
}

static status read_step_count(const document *d, const node *n, int64_t *steps, diagnostic *why)
{
    static const char *const remedy = "write an integer from 2 to 4096";
    if (n->kind != NODE_SCALAR || !number_parse_int(n->text, steps))
        return node_error(d, n, why, remedy, "steps is not an integer");
    if (*steps < 2 || *steps > POINTS_MAX)
        return node_error(d, n, why, remedy, "steps: %.64s is out of range", n->text);
    return STATUS_OK;
}

/* {from: 1.0, to: 2.0, steps: 5}: evenly spaced, both ends included. Inner values are rounded to 15 digits, so that 1.0
 * to 1.6 in 4 steps has 1.4, not 1.4000000000000001. */
static status read_range(study_axis *axis, scene *target, const document *d, const node *key, const node *range,
                         diagnostic *why)
{
    static const char *const keys[] = {"from", "to", "steps"};
    double end[2] = {0, 0};
    int64_t steps = 2;
    status code = node_check_keys(d, range, keys, 3, why);
    for (size_t i = 0; code == STATUS_OK && i < 3; i++) {
        const node *n = node_get(range, keys[i]);
        if (!n)
            code = node_error(d, range, why, "write {from: 1.0, to: 2.0, steps: 5}", "the range has no '%s'", keys[i]);
        else if (i == 2)
            code = read_step_count(d, n, &steps, why);
        else if (n->kind != NODE_SCALAR || !number_parse_real(n->text, &end[i]))
            code = node_error(d, n, why, "write a number", "'%s' is not a number", keys[i]);
    }
    if (code == STATUS_OK && !(end[0] < end[1]) && !(end[0] > end[1]))
        code = node_error(d, range, why, "use different values", "from and to are equal");
    if (code != STATUS_OK)
        return code;
    axis->points = calloc((size_t)steps, sizeof *axis->points);
    axis->name = strdup(key->text);
    code = axis->points && axis->name ? STATUS_OK : out_of_memory(why);
    for (int64_t i = 0; code == STATUS_OK && i < steps; i++) {
        char text[NUMBER_TEXT_MAX];
        double value = i == steps - 1 ? end[1] : end[0] + (double)i * (end[1] - end[0]) / (double)(steps - 1);
        node at = {.kind = NODE_SCALAR, .line = range->line, .column = range->column, .text = text};
        if (i % (steps - 1))
            number_format_digits(value, 15, text);
        else
            number_format(value, text);
        study_point *point = &axis->points[axis->count++];
        code = point_reserve(point, range, 1, why);
        THEN(code, point_add(point, target, d, key, &at, why));
    }
    return code;
}

/* Reads an axis of several parameters that vary together: a name and points. */
static status read_points(study_axis *axis, scene *target, const document *d, const node *name, const node *list,
                          diagnostic *why)
{
    if (!name || name->kind != NODE_SCALAR || !name->text[0] || !read_grid_plain(name->text))
        return node_error(d, name ? name : list, why, "write {name: WORD, points: [...]}", "the axis has no name");
    axis->name = strdup(name->text);
    status code = axis->name ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < list->count; i++) {
        study_point *point = &axis->points[axis->count++];
        code = read_point(point, target, d, list->items[i], why);
        THEN(code, align_point(point, &axis->points[0], d, list->items[i], why));
    }
    return code;
}

/* The remedy for equal values, which may come from decimal commas: [1.1, 1,3, 1,4] has the value 1 twice. */
static const char *distinct_remedy(const node *at, char text[COMMA_SLIP_TEXT_MAX + 24])
{
    char joined[COMMA_SLIP_TEXT_MAX];
    for (size_t i = 0; at->kind == NODE_LIST && i < at->count; i++)
        if (comma_slip_at(at, i, false, joined)) {
            snprintf(text, COMMA_SLIP_TEXT_MAX + 24, "did you mean %s?", joined);
            return text;
        }
    return "list each value once";
}

/* at: the node of the points; if it is a list, each point is located at its item. */
static status check_distinct(const study_axis *axis, const document *d, const node *at, diagnostic *why)
{
    char remedy[COMMA_SLIP_TEXT_MAX + 24];
    for (size_t i = 1; i < axis->count; i++)
        for (size_t k = 0; k < i; k++)
            if (points_equal(&axis->points[i], &axis->points[k]))
                return node_error(d, at->kind == NODE_LIST ? at->items[i] : at, why, distinct_remedy(at, remedy),
                                  "value %zu equals value %zu", i + 1, k + 1);
    return STATUS_OK;
}

static status read_axis(study_axis *axis, scene *target, const document *d, const node *n, diagnostic *why)
{
    static const char *const keys[] = {"name", "points"};
    const char *const form =
        "write {path: [values]}, {path: {from: 1, to: 2, steps: 5}} or {name: WORD, points: [{path: value}, ...]}";
    if (n->kind != NODE_MAP || n->count == 0 || (n->count > 1 && !node_get(n, "name") && !node_get(n, "points")))
        return node_error(d, n, why, form, "this is not an axis");
    bool has_points = n->count > 1 || strcmp(n->keys[0]->text, "points") == 0;
    if (has_points)
        TRY(node_check_keys(d, n, keys, 2, why));
    status code = STATUS_OK;
    const node *list = has_points ? node_get(n, "points") : n->items[0];
    if (!has_points && list->kind == NODE_MAP) {
        code = read_range(axis, target, d, n->keys[0], list, why);
        return code == STATUS_OK ? check_distinct(axis, d, list, why) : code;
    }
    if (!list || list->kind != NODE_LIST || list->count == 0)
        return node_error(d, list ? list : n, why, form, "the axis has no list of values");
    if (list->count > POINTS_MAX)
        return node_error(d, list, why, "write at most 4096 values", "the axis has %zu values", list->count);
    axis->points = calloc(list->count, sizeof *axis->points);
    if (!axis->points)
        return out_of_memory(why);
    code = has_points ? read_points(axis, target, d, node_get(n, "name"), list, why)
                      : read_values(axis, target, d, n->keys[0], list, why);
    return code == STATUS_OK ? check_distinct(axis, d, list, why) : code;
}

/* A parameter may be set in one place only: otherwise one setting would be lost silently. */
static status check_once(const study *s, size_t axis, const document *d, const node *at, diagnostic *why)
{
    const study_point *point = &s->axes[axis].points[0];
    for (size_t i = 0; i < point->count; i++) {
        for (size_t k = 0; k < s->fixed.count; k++)
            if (strcmp(point->paths[i], s->fixed.paths[k]) == 0)
                return node_error(d, at, why, "remove it from set or from the grid", "%s is already set for all cells",
                                  point->paths[i]);
        for (size_t other = 0; other < axis; other++)
            for (size_t k = 0; k < s->axes[other].points[0].count; k++)
                if (strcmp(point->paths[i], s->axes[other].points[0].paths[k]) == 0)
                    return node_error(d, at, why, "set it on one axis only", "%s is already on axis %zu",
                                      point->paths[i], other + 1);
    }
    return STATUS_OK;
}

static bool is_real(const scene *s, const char *path)
{
    param_place at;
    return param_place_find(s, path, &at, NULL) == STATUS_OK && at.row->type == PARAM_REAL;
}

static status read_axes(study *s, scene *target, const document *d, const node *grid, diagnostic *why)
{
    if (grid->kind != NODE_LIST || grid->count == 0)
        return node_error(d, grid, why, "write a list of axes, such as - {path: [values]}",
                          "grid is not a list of axes");
    if (grid->count > STUDY_AXES_MAX)
        return node_error(d, grid, why, "use at most 16 axes", "the grid has %zu axes", grid->count);
    s->axes = calloc(grid->count, sizeof *s->axes);
    if (!s->axes)
        return out_of_memory(why);
    size_t cells = 1;
    for (size_t i = 0; i < grid->count; i++) {
        s->axis_count++;
        status code = read_axis(&s->axes[i], target, d, grid->items[i], why);
        THEN(code, grid_find_films(&s->axes[i], target, why));
        if (code == STATUS_OK) {
            code = check_once(s, i, d, grid->items[i], why);
            if (code == STATUS_OK && grid->items[i]->count == 1)
                code = comma_slip_note(s, s->axes[i].name, grid->items[i]->items[0],
                                       is_real(target, s->axes[i].points[0].paths[0]), why);
        }
        if (code != STATUS_OK)
            return code;
        cells *= s->axes[i].count;
        if (cells > STUDY_CELLS_MAX)
            return node_error(d, grid, why, "use at most 65536 cells", "the grid has more than 65536 cells");
    }
    return STATUS_OK;
}

status read_grid(study *s, const document *d, const node *set, const node *grid, diagnostic *why)
{
    status code = STATUS_OK;
    if (set)
        code = read_point(&s->fixed, s->base, d, set, why);
    if (code != STATUS_OK || !grid)
        return code;
    scene *target = scene_clone(s->base);
    if (!target)
        return out_of_memory(why);
    code = read_axes(s, target, d, grid, why);
    scene_destroy(target);
    return code;
}

status read_reference(study *s, const document *d, const node *reference, diagnostic *why)
{
    if (!reference)
        return STATUS_OK;
    scene *target = scene_clone(s->base);
    if (!target)
        return out_of_memory(why);
    status code = read_point(&s->reference, target, d, reference, why);
    scene_destroy(target);
    return code;
}
