/* Writes measured values next to theory: metrics and curves of optics, and the motion of slimes; lessons and their
 * results. */
#include "base/json_build.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "report/report.h"
#include "scene/model/params.h"
#include <math.h>
#include <stdlib.h>

/* --- optics --- */

const char *realism_verdict(const realism_value *v)
{
    return !realism_is_defined(v) ? "none" : realism_passes(v) ? "pass" : "FAIL";
}

static void write_real(FILE *out, double value, const char *after)
{
    if (isnan(value))
        fprintf(out, "NA%s", after);
    else
        fprintf(out, "%.17g%s", value, after);
}

void realism_write_csv(const realism_report *r, FILE *out)
{
    fputs("metric,verdict,measured,theory,error,tolerance,unit,what\n", out);
    for (int i = 0; i < r->count; i++) {
        const realism_value *v = &r->value[i];
        const bool defined = realism_is_defined(v);
        fprintf(out, "%s,%s,", v->metric, realism_verdict(v));
        write_real(out, defined ? v->measured : NAN, ",");
        write_real(out, v->theory, ",");
        write_real(out, realism_error(v), ",");
        write_real(out, v->tolerance, ",");
        fprintf(out, "%s,\"%s\"\n", v->unit, v->what);
    }
}

static json_t *value_object(const realism_value *v)
{
    return json_pack("{s:s,s:s,s:o,s:o,s:o,s:o,s:s,s:s}", "metric", v->metric, "verdict", realism_verdict(v),
                     "measured", json_of_real(realism_is_defined(v) ? v->measured : NAN), "theory",
                     json_of_real(v->theory), "error", json_of_real(realism_error(v)), "tolerance",
                     json_of_real(v->tolerance), "unit", v->unit, "what", v->what);
}

json_t *realism_json(const realism_report *r, const char *scene_path)
{
    json_t *values = json_array(), *o = json_object();
    int passed = 0, defined = 0, bad = 0;
    for (int i = 0; i < r->count; i++) {
        bad |= json_array_append_new(values, value_object(&r->value[i]));
        passed += realism_passes(&r->value[i]);
        defined += realism_is_defined(&r->value[i]);
    }
    bad |= json_object_set_new(o, "schema", json_integer(1));
    bad |= json_object_set_new(o, "scene", json_of_text(scene_path));
    bad |= json_object_set_new(o, "defined", json_integer(defined));
    bad |= json_object_set_new(o, "passed", json_integer(passed));
    bad |= json_object_set_new(o, "values", values);
    return json_if(o, bad == 0);
}

void realism_write_curve(realism_curve which, const realism_points *points, FILE *out)
{
    fprintf(out, "\"%s\",\"%s: measured\",\"theory\"\n", realism_curve_x(which), realism_curve_y(which));
    for (int i = 0; i < points->count; i++) {
        write_real(out, points->at[i].x, ",");
        write_real(out, points->at[i].measured, ",");
        write_real(out, points->at[i].theory, "\n");
    }
}

json_t *realism_curve_json(realism_curve which, const realism_points *points)
{
    json_t *list = json_array();
    int bad = 0;
    for (int i = 0; i < points->count; i++) {
        const realism_point *p = &points->at[i];
        bad |= json_array_append_new(
            list, json_pack("[o,o,o]", json_of_real(p->x), json_of_real(p->measured), json_of_real(p->theory)));
    }
    json_t *o = json_pack("{s:s,s:s,s:s,s:o}", "name", realism_curve_name(which), "x", realism_curve_x(which), "y",
                          realism_curve_y(which), "points", list);
    return json_if(o, bad == 0);
}

/* --- motion --- */

const char *motion_integrator(const mesh_entry *m)
{
    return param_find(PARAM_MESH, "integrator")->choices[m->slime.integrator];
}

static void write_finite(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, "%.17g,", value);
    else
        fputs("NA,", out);
}

void motion_write_csv_header(FILE *out)
{
    fputs("slime,name,measured,theory,error,unit,what\n", out);
}

void motion_write_csv(const mesh_entry *m, const softbody_trial_report *r, FILE *out)
{
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &r->value[i];
        fprintf(out, "%s,%s,", m->name, v->name);
        write_finite(out, v->measured);
        write_finite(out, v->theory);
        write_finite(out, softbody_trial_error(v));
        fprintf(out, "%s,\"%s\"\n", v->unit, v->what);
    }
}

json_t *motion_slime_json(const mesh_entry *m, const softbody_trial_report *r)
{
    json_t *values = json_array();
    int bad = 0;
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &r->value[i];
        json_t *one = json_pack("{s:s,s:o,s:o,s:o,s:s,s:s}", "name", v->name, "measured", json_of_real(v->measured),
                                "theory", json_of_real(v->theory), "error", json_of_real(softbody_trial_error(v)),
                                "unit", v->unit, "what", v->what);
        bad |= json_array_append_new(values, one);
    }
    json_t *o = json_pack("{s:s,s:I,s:s,s:o,s:o}", "name", m->name, "level", (json_int_t)m->level, "integrator",
                          motion_integrator(m), "dt_s", json_of_real(m->slime.dt_s), "values", values);
    return json_if(o, bad == 0);
}

json_t *motion_json(json_t *slimes, const char *scene_path)
{
    return json_pack("{s:i,s:o,s:o}", "schema", 1, "scene", json_of_text(scene_path), "slimes", slimes);
}

/* --- lessons --- */

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
        if (c->with)
            json_add_as(&one, "with", json_of_text(c->with));
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

static json_t *numbers(const double *x, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        json_add(&list, json_of_real(x[i]));
    return list;
}

/* What the section shows when the lesson opens. */
static json_t *show(const lesson *l)
{
    const lesson_show *s = &l->show;
    return json_pack("{s:o,s:o,s:o,s:b,s:b,s:b}", "view", json_of_text(s->view), "at", json_of_real(s->at), "window",
                     s->has_window ? numbers(s->window, 4) : json_null(), "normals", (int)s->normals, "angles",
                     (int)s->angles, "extensions", (int)s->extensions);
}

/* The measurement by hand, or null. */
static json_t *hand(const lesson *l)
{
    static const char *const tools[] = {"", "protractor", "ruler", "screen"};
    const lesson_hand *h = &l->hand;
    if (h->tool == LESSON_NO_TOOL)
        return json_null();
    json_t *one = json_pack("{s:s,s:o,s:o,s:o,s:f,s:o}", "tool", tools[h->tool], "ask", json_of_text(h->ask), "unit",
                            json_of_text(h->unit ? h->unit : ""), "truth", json_of_text(h->truth), "within", h->within,
                            "place", numbers(h->place, 3));
    if (h->tool == LESSON_PROTRACTOR)
        json_add_as(&one, "arms", numbers(h->arms, 2));
    if (h->tool == LESSON_RULER)
        json_add_as(&one, "to", numbers(h->to, 3));
    if (h->tool == LESSON_SCREEN)
        json_add_all(
            &one, json_pack("{s:s,s:o}", "reads", h->reads_power ? "power" : "distance", "from", numbers(h->from, 3)));
    return one;
}

json_t *lesson_json(const lesson *l)
{
    return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "added",
                     texts(l->added, (int)l->added_count), "show", show(l), "hand", hand(l), "name",
                     json_of_text(l->name), "title", json_of_text(l->title), "language", json_of_text(l->language),
                     "question", json_of_text(l->question), "scene", json_of_text(l->scene_path), "controls",
                     controls(l), "prediction", prediction(l), "measure", measure(l), "answer", json_of_text(l->answer),
                     "commands", commands(l));
}

json_t *lesson_result_json(const lesson *l, const lesson_result *r)
{
    json_t *points = json_array();
    for (int i = 0; i < r->points.count; i++) {
        const realism_point *p = &r->points.at[i];
        json_add(&points, json_pack("[o,o,o]", json_of_real(p->x), json_of_real(p->measured), json_of_real(p->theory)));
    }
    json_t *values = json_object();
    for (int i = 0; i < l->value_count; i++)
        json_add_as(&values, l->value[i].name, json_of_real(r->values[i]));
    return json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:b,s:o,s:o,s:o}", "values", values, "truth", json_of_real(r->truth),
                     "right", l->choice_count ? json_of_text(l->choices[r->right]) : json_null(), "points", points,
                     "error", json_of_real(r->error), "tolerance", json_of_real(l->tolerance), "passes", (int)r->passes,
                     "measured", json_of_real(r->measured), "theory", json_of_real(r->theory), "value_tolerance",
                     json_of_real(r->tolerance));
}
