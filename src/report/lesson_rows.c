/* Lessons and their results as JSON. */
#include "base/json_build.h"
#include "report/report.h"

#include "report/json.h"
#include <stdlib.h>

static json_t *texts(char *const *text, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        json_add(&list, json_of_text(text[i]));
    return list;
}

static json_t *controls(const lesson *l)
{
    json_t *list = json_array();
    for (int i = 0; i < l->control_count; i++) {
        const lesson_control *c = &l->control[i];
        json_t *one = json_pack("{s:o,s:o}", "parameter", json_of_text(c->parameter), "label", json_of_text(c->label));
        if (c->choice_count)
            json_add_as(&one, "choices", texts(c->choices, c->choice_count));
        else
            json_add_all(&one, json_pack("{s:f,s:f}", "from", c->from, "to", c->to));
        json_add(&list, one);
    }
    return list;
}

static json_t *prediction(const lesson *l)
{
    json_t *one = l->choice_count
                      ? json_pack("{s:o,s:o,s:o}", "ask", json_of_text(l->ask), "choices",
                                  texts(l->choices, l->choice_count), "right", json_of_text(l->choices[l->right]))
                      : json_pack("{s:o,s:f}", "ask", json_of_text(l->ask), "within", l->answer_within);
    json_add_as(&one, "axis", l->predicts ? json_stringn(&l->predicts, 1) : json_null());
    return one;
}

/* The parameter on the curve's x axis, or null. */
static json_t *x_parameter(const lesson *l)
{
    const char *parameter = l->over < 0 ? realism_curve_parameter(l->curve) : l->control[l->over].parameter;
    return parameter ? json_of_text(parameter) : json_null();
}

static json_t *measure(const lesson *l)
{
    char *x = lesson_x_label(l), *y = lesson_y_label(l);
    json_t *one = NULL;
    if (x && y)
        one = json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:b}", "curve",
                        l->over < 0 ? json_string(realism_curve_name(l->curve)) : json_null(), "over",
                        l->over < 0 ? json_null() : json_of_text(l->control[l->over].parameter), "x", json_of_text(x),
                        "y", json_of_text(y), "x_parameter", x_parameter(l), "reading", json_of_text(l->reading),
                        "unit", json_of_text(l->unit), "tolerance", json_of_real(l->tolerance), "metric",
                        l->metric ? json_of_text(l->metric) : json_null(), "timed", (int)lesson_is_timed(l));
    if (one && !l->metric)
        json_add_as(&one, "at", json_of_real(l->at));
    free(x);
    free(y);
    return one;
}

static json_t *commands(const lesson *l)
{
    json_t *list = json_array();
    const bool kinds[] = {true, false};
    for (int i = 0; i < 2; i++) {
        if (kinds[i] ? l->over >= 0 : !l->metric)
            continue;
        char *text = lesson_command(l, kinds[i]);
        json_add(&list, text ? json_of_text(text) : NULL);
        free(text);
    }
    return list;
}

json_t *lesson_json(const lesson *l)
{
    return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "name", json_of_text(l->name), "title",
                     json_of_text(l->title), "language", json_of_text(l->language), "question",
                     json_of_text(l->question), "scene", json_of_text(l->scene_path), "controls", controls(l),
                     "prediction", prediction(l), "measure", measure(l), "answer", json_of_text(l->answer), "commands",
                     commands(l));
}

json_t *lesson_result_json(const lesson *l, const lesson_result *r)
{
    json_t *points = json_array();
    for (int i = 0; i < r->points.count; i++) {
        const realism_point *p = &r->points.at[i];
        json_add(&points, json_pack("[o,o,o]", json_of_real(p->x), json_of_real(p->measured), json_of_real(p->theory)));
    }
    return json_pack("{s:o,s:o,s:o,s:b,s:o,s:o,s:o}", "points", points, "error", json_of_real(r->error), "tolerance",
                     json_of_real(l->tolerance), "passes", (int)r->passes, "measured", json_of_real(r->measured),
                     "theory", json_of_real(r->theory), "value_tolerance", json_of_real(r->tolerance));
}
