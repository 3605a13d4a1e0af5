/* Writes measured properties of motion. */
#include "report/motion_rows.h"

#include "report/json.h"
#include "scene/model/params.h"
#include <math.h>

const char *motion_integrator(const mesh_entry *m)
{
    return param_find(PARAM_MESH, "integrator")->choices[m->slime.integrator];
}

static void write_real(FILE *out, double value)
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
        write_real(out, v->measured);
        write_real(out, v->theory);
        write_real(out, softbody_trial_error(v));
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
    return json_whole(o, bad == 0);
}

json_t *motion_json(json_t *slimes, const char *scene_path)
{
    return json_pack("{s:i,s:o,s:o}", "schema", 1, "scene", json_of_text(scene_path), "slimes", slimes);
}
