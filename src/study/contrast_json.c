#include "base/json_build.h"
#include "study/contrast_json.h"
#include "study/grid.h"
#include <math.h>
#include <string.h>

static json_t *real_or_null(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *half_json(const contrast_half *h, bool of_cell)
{
    json_t *json = json_pack("{s:I, s:I, s:o}", "n", (json_int_t)h->count, "processes", (json_int_t)h->processes,
                             "median", real_or_null(h->median));
    if (of_cell)
        json_add_as(&json, "cell", json_integer((json_int_t)h->cell));
    return json;
}

static json_t *line_json(const contrast_line *l, bool of_cell)
{
    const char *a = l->a.film, *b = l->b.film;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:s, s:s, s:b, s:o, s:o}", "a", half_json(&l->a, of_cell), "b",
                     half_json(&l->b, of_cell), "ratio", real_or_null(l->ratio.value), "low",
                     real_or_null(l->ratio.low), "high", real_or_null(l->ratio.high), "verdict",
                     contrast_verdict_text(l->verdict), "reason", contrast_reason_text(l->reason), "alternate",
                     l->alternate, "pairs_needed",
                     l->pairs_needed ? json_integer((json_int_t)l->pairs_needed) : json_null(), "same_film",
                     a && b ? json_boolean(strcmp(a, b) == 0) : json_null());
}

static json_t *cell_json(const study *s, const contrast_line *l)
{
    json_t *json = json_pack("{s:I}", "cell", (json_int_t)l->a.cell);
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, l->a.cell, axis)];
        for (size_t i = 0; i < point->count; i++)
            json_add_as(&json, point->paths[i], json_string(point->values[i]));
    }
    if (json_object_update_new(json, line_json(l, true)) == 0)
        return json;
    json_decref(json);
    return NULL;
}

json_t *contrast_json(const study *s, const contrast *c, size_t most)
{
    json_t *paths = json_array(), *cells = json_array();
    const char *path;
    for (size_t i = 0; (path = study_grid_path(s, i)); i++)
        json_add(&paths, json_string(path));
    for (size_t i = 0; i < c->count && i < most; i++)
        json_add(&cells, cell_json(s, &c->lines[i]));
    return json_pack("{s:o, s:I, s:[s, s], s:{s:I, s:I}, s:o, s:o}", "columns", paths, "count", (json_int_t)c->count,
                     "environments", c->environment[0], c->environment[1], "films", "compared", (json_int_t)c->compared,
                     "same", (json_int_t)c->same, "cells", cells, "all", line_json(&c->all, false));
}
