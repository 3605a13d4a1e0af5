/* Writes measured values next to theory: metrics and curves of optics, and the motion of slimes. */
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/model/params.h"
#include <math.h>

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
