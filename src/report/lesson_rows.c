/* Writes the columns of lessons. */
#include "report/lesson_rows.h"

#include "report/json.h"
#include <stdlib.h>

static json_t *texts(char *const *text, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        json_array_append_new(list, json_of_text(text[i]));
    return list;
}

static json_t *controls(const lesson *l)
{
    json_t *list = json_array();
    for (int i = 0; i < l->control_count; i++) {
        const lesson_control *c = &l->control[i];
        json_t *one = json_pack("{s:o,s:o}", "parameter", json_of_text(c->parameter), "label", json_of_text(c->label));
        if (c->choice_count)
            json_object_set_new(one, "choices", texts(c->choices, c->choice_count));
        else
            json_object_update_new(one, json_pack("{s:f,s:f}", "from", c->from, "to", c->to));
        json_array_append_new(list, one);
    }
    return list;
}

static json_t *prediction(const lesson *l)
{
    return l->choice_count ? json_pack("{s:o,s:o,s:o}", "ask", json_of_text(l->ask), "choices",
                                       texts(l->choices, l->choice_count), "right", json_of_text(l->choices[l->right]))
                           : json_pack("{s:o,s:f}", "ask", json_of_text(l->ask), "within", l->answer_within);
}

json_t *lesson_json(const lesson *l)
{
    char *curve = lesson_command(l, true), *value = l->metric ? lesson_command(l, false) : NULL;
    json_t *all = NULL;
    if (curve && (value || !l->metric))
        all = json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:{s:s,s:s,s:s,s:o,s:o,s:f,s:o},s:o,s:o}", "name",
                        json_of_text(l->name), "title", json_of_text(l->title), "language", json_of_text(l->language),
                        "question", json_of_text(l->question), "scene", json_of_text(l->scene_path), "controls",
                        controls(l), "prediction", prediction(l), "measure", "curve", realism_curve_name(l->curve), "x",
                        realism_curve_x(l->curve), "y", realism_curve_y(l->curve), "reading", json_of_text(l->reading),
                        "unit", json_of_text(l->unit), "tolerance", l->tolerance, "metric",
                        l->metric ? json_of_text(l->metric) : json_null(), "answer", json_of_text(l->answer),
                        "commands", value ? json_pack("[s,s]", curve, value) : json_pack("[s]", curve));
    free(curve);
    free(value);
    return all;
}

json_t *lesson_result_json(const lesson *l, const lesson_result *r)
{
    json_t *points = json_array();
    for (int i = 0; i < r->points.count; i++) {
        const realism_point *p = &r->points.at[i];
        json_array_append_new(
            points, json_pack("[o,o,o]", json_of_real(p->x), json_of_real(p->measured), json_of_real(p->theory)));
    }
    return json_pack("{s:o,s:o,s:f,s:b,s:o,s:o,s:o}", "points", points, "error", json_of_real(r->error), "tolerance",
                     l->tolerance, "passes", (int)r->passes, "measured", json_of_real(r->measured), "theory",
                     json_of_real(r->theory), "value_tolerance", json_of_real(r->tolerance));
}
