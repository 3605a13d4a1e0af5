/* Parses a side of a comparison, and finds the cells that two sides compare. */
#include "base/number.h"
#include "study/plan/grid.h"
#include "study/summary/contrast.h"
#include <stdlib.h>
#include <string.h>

/* Whether the item is a number, and so an element of a vector: folders and settings are not numbers. */
static bool is_element(const char *text)
{
    char number[64];
    double value;
    text += strspn(text, " ");
    size_t length = strcspn(text, ",");
    while (length > 0 && text[length - 1] == ' ')
        length--;
    if (length >= sizeof number)
        return false;
    memcpy(number, text, length);
    number[length] = '\0';
    return number_parse_real(number, &value);
}

/* The next item of a list separated by commas; commas inside brackets, and those before numbers, belong to a value. */
static char *next_item(char **rest)
{
    char *item = *rest;
    int depth = 0;
    if (!item)
        return NULL;
    for (char *c = item; *c; c++) {
        depth += (*c == '[' || *c == '{') - (*c == ']' || *c == '}');
        if (*c == ',' && depth <= 0 && !is_element(c + 1)) {
            *c = '\0';
            *rest = c + 1;
            return item;
        }
    }
    *rest = NULL;
    return item;
}

static void list_add(char *list, size_t size, const char *text)
{
    const size_t length = strlen(list);
    snprintf(list + length, size - length, "%s%.60s", length && list[length - 1] != ' ' ? ", " : "", text);
}

static status no_such_parameter(const study *s, const char *path, diagnostic *why)
{
    char list[400] = "choose from the parameters: ";
    for (size_t axis = 0; axis < s->axis_count; axis++)
        for (size_t i = 0; i < s->axes[axis].points[0].count; i++)
            list_add(list, sizeof list, s->axes[axis].points[0].paths[i]);
    return diagnose_at(why, s->path, STATUS_BAD_INPUT, s->axis_count ? list : "give a results folder",
                       "the grid has no parameter '%.64s'", path);
}

/* Linked parameters are one axis: the value selects the first point that has it. */
static status set_value(const study *s, study_side *side, const char *path, const char *value, diagnostic *why)
{
    char list[400] = "choose from: ";
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_axis *candidate = &s->axes[axis];
        for (size_t i = 0; i < candidate->points[0].count; i++) {
            if (strcmp(candidate->points[0].paths[i], path) != 0)
                continue;
            for (size_t point = 0; point < candidate->count; point++) {
                if (grid_same_value(candidate->points[point].values[i], value)) {
                    side->point[axis] = point;
                    return STATUS_OK;
                }
                list_add(list, sizeof list, candidate->points[point].values[i]);
            }
            return diagnose_at(why, s->path, STATUS_BAD_INPUT, list, "no cell has %.64s=%.64s", path, value);
        }
    }
    return no_such_parameter(s, path, why);
}

static status set_cell(const study *s, study_side *side, const char *value, diagnostic *why)
{
    int64_t cell;
    if (!number_parse_int(value, &cell) || cell < 0 || (size_t)cell >= study_cell_count(s))
        return diagnose_at(why, s->path, STATUS_BAD_INPUT, "see the first column of cuvette study summary",
                           "there is no cell '%.64s'", value);
    side->cell = (long)cell;
    for (size_t axis = 0; axis < s->axis_count; axis++)
        side->point[axis] = study_cell_point(s, (size_t)cell, axis);
    return STATUS_OK;
}

static status read_item(const study *s, char *item, study_side *side, diagnostic *why)
{
    char *value = strchr(item, '=');
    if (!value) {
        side->results = item;
        return STATUS_OK;
    }
    *value++ = '\0';
    if (strcmp(item, "environment") == 0)
        side->environment = value;
    else if (strcmp(item, "run") == 0)
        side->run = value;
    else if (strcmp(item, "cell") == 0)
        return set_cell(s, side, value, why);
    else
        return set_value(s, side, item, value, why);
    return STATUS_OK;
}

study_side side_of_folder(const char *results)
{
    study_side side = {.given = results, .results = results, .cell = -1};
    for (size_t axis = 0; axis < STUDY_AXES_MAX; axis++)
        side.point[axis] = STUDY_SIDE_ANY;
    return side;
}

status side_read(const study *s, const char *text, const char *results, study_side *out, diagnostic *why)
{
    *out = side_of_folder(results);
    out->given = text;
    out->text = strdup(text);
    if (!out->text)
        return out_of_memory(why);
    status code = STATUS_OK;
    char *rest = out->text;
    for (char *item; code == STATUS_OK && (item = next_item(&rest)) != NULL;)
        code = *item ? read_item(s, item, out, why)
                     : diagnose_at(why, s->path, STATUS_BAD_INPUT,
                                   "give a results folder, PATH=VALUE, cell=N, environment=KEY or run=ID",
                                   "'%.128s' has an empty item", text);
    return code;
}

void side_release(study_side *side)
{
    free(side->text);
    *side = (study_side){.text = NULL};
}

/* The cell of a side: its values, and those of the cell `like` on axes that the side does not name. */
static size_t cell_of(const study *s, const study_side *side, size_t like)
{
    size_t cell = 0;
    for (size_t axis = 0; axis < s->axis_count; axis++)
        cell = cell * s->axes[axis].count +
               (side->point[axis] == STUDY_SIDE_ANY ? study_cell_point(s, like, axis) : side->point[axis]);
    return cell;
}

status side_cells(const study *s, const study_side *a, const study_side *b, size_t (**pairs)[2], size_t *count,
                  diagnostic *why)
{
    *count = 0;
    for (size_t axis = 0; axis < s->axis_count; axis++)
        if ((a->point[axis] == STUDY_SIDE_ANY) != (b->point[axis] == STUDY_SIDE_ANY)) {
            *pairs = NULL;
            return diagnose_at(why, s->path, STATUS_BAD_INPUT, "name it on both sides, or on neither",
                               "only one side has a value of %.64s", s->axes[axis].points[0].paths[0]);
        }
    *pairs = calloc(study_cell_count(s) + 1, sizeof **pairs);
    if (!*pairs)
        return out_of_memory(why);
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        if (cell_of(s, a, cell) == cell) {
            (*pairs)[*count][0] = cell;
            (*pairs)[(*count)++][1] = cell_of(s, b, cell);
        }
    return STATUS_OK;
}
