/* The JSON account of a render, of its parameters and of an image comparison; this machine's clocks and
 * disturbances. */
#include "report/report.h"
#include "base/json_build.h"
#include "base/number.h"
#include "job/account.h"
#include "measure/statistics.h"
#include "measure/usage.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Parses "0,2.75,-6", with or without brackets, into a list of numbers; returns false for other text. *out is NULL when
 * out of memory. */
static bool list_of_numbers(const char *text, json_t **out)
{
    bool good = true;
    char *copy = strdup(text), *rest = NULL;
    *out = copy ? json_array() : NULL;
    for (char *word = copy ? strtok_r(copy, "[], ", &rest) : NULL; word; word = strtok_r(NULL, "[], ", &rest)) {
        double number = 0;
        good &= number_parse_real(word, &number);
        json_add(out, json_of_real(number));
    }
    free(copy);
    *out = json_if(*out, good);
    return good;
}

json_t *report_value(const param *row, const char *text)
{
    double real;
    int64_t integer;
    switch (row->type) {
    case PARAM_INT:
        if (number_parse_int(text, &integer))
            return json_integer(integer);
        break;
    case PARAM_REAL:
        if (number_parse_real(text, &real))
            return json_of_real(real);
        break;
    case PARAM_VECTOR:
    case PARAM_COLOR:
    case PARAM_LIST: {
        json_t *list;
        if (list_of_numbers(text, &list))
            return list;
        break;
    }
    case PARAM_CHOICE:
    case PARAM_PATH:
    case PARAM_WORD:
    case PARAM_LAYERS: break;
    }
    return json_of_text(text);
}

static status add_param(void *context, const char *path, const param *row, const char *value)
{
    json_object_del(context, path); /* so that the last assignment is the last entry */
    return json_object_set_new(context, path, report_value(row, value)) ? STATUS_FAILURE : STATUS_OK;
}

/* Adds all parameters of camera and background, including those without effect because others replace them. */
static status add_alternatives(json_t *params, const scene *s)
{
    status code = STATUS_OK;
    for (size_t i = 0; i < param_count() && code == STATUS_OK; i++) {
        const param *row = param_at(i);
        char *value = NULL, path[PARAM_PATH_MAX];
        if (row->group != PARAM_CAMERA && row->group != PARAM_BACKGROUND)
            continue;
        code = scene_get(s, param_lines_path(row, path, sizeof path), &value, NULL);
        THEN(code, add_param(params, path, row, value));
        free(value);
    }
    return code;
}

/* Parameters without effect precede those that replace them, so that setting all in this order reproduces the scene. */
json_t *report_params(const scene *s)
{
    json_t *params = json_object();
    return json_if(params, params && add_alternatives(params, s) == STATUS_OK &&
                               scene_each_param(s, add_param, params) == STATUS_OK);
}

/* --- frames --- */

static json_t *list_of_reals(const double *values, size_t count)
{
    json_t *list = json_array();
    for (size_t i = 0; list && i < count; i++)
        json_add(&list, json_of_real(values[i]));
    return list;
}

static json_t *by_depth(const quantity_value *v)
{
    json_t *list = json_array();
    for (size_t i = 0; list && i < v->size; i++)
        json_add(&list, json_integer((json_int_t)v->list[i]));
    return list;
}

static json_t *by_solid(const scene *s, const quantity_value *v)
{
    json_t *object = json_object();
    for (size_t i = 0; object && i < v->size; i++)
        json_add_as(&object, s->solids[i].name, json_integer((json_int_t)v->list[i]));
    return object;
}

json_t *report_quantity(const quantity *q, const job_account *a, int worker)
{
    const quantity_value v = q->read(a, worker);
    char hash[17];
    switch (q->type) {
    case QUANTITY_COUNT: return json_of_count(v.count);
    case QUANTITY_NUMBER: return json_integer(v.count);
    case QUANTITY_TRUTH: return json_boolean(v.count);
    case QUANTITY_REAL: return json_of_real(v.real[0]);
    case QUANTITY_COLOR: return list_of_reals(v.real, 3);
    case QUANTITY_HASH: snprintf(hash, sizeof hash, "%016" PRIx64, v.hash); return json_string(hash);
    case QUANTITY_WORD: return json_string(v.word);
    case QUANTITY_DEPTHS: return by_depth(&v);
    case QUANTITY_SOLIDS: return by_solid(a->of, &v);
    }
    return NULL;
}

/* Whether the group of a key is null: noise of a render without random samples, meshes of a scene without any. */
static bool is_void(const job_account *a, const char *key)
{
    const mesh_report *m = &a->result->meshes;
    return (strncmp(key, "noise.", 6) == 0 && !a->result->variance) ||
           (strncmp(key, "meshes.", 7) == 0 && m->triangles == 0 && m->drawn == 0);
}

/* Stores and owns a value: "rays.camera" is camera in the object rays. NULL sets the group, here rays, to null. */
static int put(json_t *o, const char *key, json_t *value)
{
    char group[64];
    const size_t length = strcspn(key, ".");
    if (key[length] == '\0')
        return json_object_set_new(o, key, value);
    snprintf(group, sizeof group, "%.*s", (int)length, key);
    if (!value)
        return json_object_set_new(o, group, json_null());
    json_t *inner = json_object_get(o, group);
    if (!inner && json_object_set_new(o, group, inner = json_object()) != 0) {
        json_decref(value);
        return -1;
    }
    return put(inner, key + length + 1, value);
}

static int put_all(json_t *o, const quantity *list, size_t count, const job_account *a, int worker)
{
    int bad = 0;
    for (size_t i = 0; i < count; i++)
        if (list[i].json)
            bad |= put(o, list[i].json, is_void(a, list[i].json) ? NULL : report_quantity(&list[i], a, worker));
    return bad;
}

static json_t *workers(const job_account *a)
{
    json_t *list = json_array();
    for (int i = 0; list && i < a->result->worker_count; i++) {
        json_t *one = json_object();
        if (put_all(one, worker_quantities, worker_quantity_count, a, i) | json_array_append_new(list, one))
            return json_if(list, false);
    }
    return list;
}

/* The processes that rendered the frame. */
static json_t *ranks(const render_result *r)
{
    json_t *list = json_array();
    for (int i = 0; list && i < r->rank_count; i++) {
        const rank_usage *k = &r->ranks[i];
        json_add(&list, json_pack("{s:o, s:o, s:I, s:I, s:I}", "wall_s", json_of_real(k->wall_s), "cpu_s",
                                  json_of_real(k->cpu_s), "peak_rss_bytes", (json_int_t)k->peak_rss_bytes, "tiles_sent",
                                  (json_int_t)k->tiles_sent, "bytes_sent", (json_int_t)k->tile_bytes_sent));
    }
    return list;
}

/* The 95% interval of the median; nulls for fewer than 6 values. */
static int put_interval(json_t *o, const char *key, const double *values, size_t count)
{
    double *sorted = malloc((count + 1) * sizeof *sorted);
    if (!sorted)
        return -1;
    memcpy(sorted, values, count * sizeof *sorted);
    const summary s = summarize(sorted, count);
    free(sorted);
    return json_object_set_new(o, key, json_pack("[o, o]", json_of_real(s.median_low), json_of_real(s.median_high)));
}

json_t *report_note(const char *place, const char *text, const char *remedy)
{
    return json_pack("{s:o, s:o, s:o}", "place", json_of_text(place), "text", json_of_text(text), "remedy",
                     json_of_text(remedy));
}

static void add_note(void *list, const scene_note *note)
{
    json_add(list, report_note(note->place, note->text, note->remedy));
}

static json_t *notes(const job_account *a)
{
    json_t *list = json_array();
    frame_notes(a, &(note_sink){add_note, &list});
    return list;
}

json_t *report_create(const job_account *a, bool repeated)
{
    json_t *o = json_pack("{s:i}", "schema", REPORT_SCHEMA);
    if (!o)
        return NULL;
    int bad = put_all(o, frame_quantities, frame_quantity_count, a, -1);
    if (repeated) {
        bad |= json_object_set_new(o, "repeat", json_integer((json_int_t)a->count));
        bad |= json_object_set_new(o, "wall_s_all", list_of_reals(a->wall_s, a->count));
        bad |= json_object_set_new(o, "cpu_s_all", list_of_reals(a->cpu_s, a->count));
        bad |= put_interval(o, "wall_s_interval", a->wall_s, a->count);
        bad |= put_interval(o, "cpu_s_interval", a->cpu_s, a->count);
    }
    bad |= json_object_set_new(o, "threads", workers(a));
    bad |= json_object_set_new(o, "notes", notes(a));
    if (a->result->ranks) {
        bad |= json_object_set_new(o, "ranks", ranks(a->result));
        bad |= json_object_set_new(o, "tile", json_integer(a->result->tile));
        bad |= json_object_set_new(o, "scene_bytes", json_integer((json_int_t)a->result->scene_bytes));
    }
    bad |= json_object_set_new(o, "version", json_string(CUVETTE_VERSION));
    bad |= json_object_set_new(o, "scene", json_of_text(a->of->path ? a->of->path : ""));
    bad |= json_object_set_new(o, "params", report_params(a->of));
    return json_if(o, bad == 0);
}

json_t *report_image_numbers(const job_account *a)
{
    json_t *o = json_object();
    int bad = !o;
    for (size_t i = 0; i < frame_quantity_count; i++)
        if (frame_quantities[i].page)
            bad |= json_object_set_new(o, frame_quantities[i].page, report_quantity(&frame_quantities[i], a, -1));
    bad |= json_object_set_new(o, "notes", notes(a));
    return json_if(o, bad == 0);
}

bool report_comparison(json_t *o, const image_comparison *c)
{
    json_t *place = c->largest > 0 ? json_pack("[i,i]", c->largest_x, c->largest_y) : json_null();
    int bad = json_object_set_new(o, "mse", json_of_real(c->mse));
    bad |= json_object_set_new(o, "psnr_db", json_of_real(c->psnr_db));
    bad |= json_object_set_new(o, "ssim", json_of_real(c->ssim));
    bad |= json_object_set_new(o, "flip", json_of_real(c->flip));
    bad |= json_object_set_new(o, "largest", json_of_real(c->largest));
    bad |= json_object_set_new(o, "largest_at", place);
    bad |= json_object_set_new(o, "differing_fraction", json_of_real(c->differing_fraction));
    return !bad;
}

/* --- this machine's clocks and disturbances --- */

#define LOAD_SAMPLE_S 0.5 /* 50 ticks of /proc/stat */

static void add_disturbance(void *context, const char *text)
{
    json_add(context, json_of_text(text));
}

static bool counts_cycles(void)
{
    hardware_counter *counter = hardware_counter_create();
    hardware_counts counts = hardware_counter_read(counter);
    hardware_counter_destroy(counter);
    return counts.cycles >= 0;
}

status machine_measure(machine_report *a, diagnostic *why)
{
    status result = isa_choose(&a->chosen, why);
    if (result != STATUS_OK) {
        diagnostic_locate(why, "environment", 0, 0);
        return result;
    }
    a->best = isa_best();
    TRY(topology_create(&a->machine, why));
    a->wall = clock_wall_quality();
    a->cpu = clock_thread_cpu_quality();
    a->has_hardware_counters = counts_cycles();
    uname(&a->kernel);
    a->disturbances = json_array();
    disturbances_report(LOAD_SAMPLE_S, add_disturbance, &a->disturbances);
    return a->disturbances ? STATUS_OK : out_of_memory(why);
}

static json_t *clock_json(clock_quality clock)
{
    return json_pack("{s:o,s:o}", "tick_s", json_of_real(clock.tick_s), "overhead_s", json_of_real(clock.overhead_s));
}

json_t *machine_json(const machine_report *a)
{
    char *units = topology_summary(a->machine);
    json_t *o = json_object();
    int bad = json_object_set_new(o, "schema", json_integer(1));
    bad |= json_object_set_new(o, "machine", units ? json_of_text(units) : NULL);
    bad |= json_object_set_new(o, "units", json_integer(topology_pu_count(a->machine)));
    bad |= json_object_set_new(o, "cores", json_integer(topology_core_count(a->machine)));
    bad |= json_object_set_new(o, "packages", json_integer(topology_package_count(a->machine)));
    bad |= json_object_set_new(o, "isa", json_string(isa_name(a->chosen)));
    bad |= json_object_set_new(o, "isa_best", json_string(isa_name(a->best)));
    bad |=
        json_object_set_new(o, "kernel", json_pack("[s,s,s]", a->kernel.sysname, a->kernel.release, a->kernel.machine));
    bad |= json_object_set_new(o, "wall_clock", clock_json(a->wall));
    bad |= json_object_set_new(o, "thread_clock", clock_json(a->cpu));
    bad |= json_object_set_new(o, "hardware_counters", json_boolean(a->has_hardware_counters));
    bad |= json_object_set_new(o, "version", json_string(CUVETTE_VERSION));
    bad |= json_object_set_new(o, "compiler", json_string(__VERSION__));
    bad |= json_object_set_new(o, "flags", json_string(CUVETTE_COMPILER_FLAGS));
    bad |= json_object_set(o, "disturbances", a->disturbances);
    free(units);
    return json_if(o, bad == 0);
}

void machine_release(machine_report *a)
{
    json_decref(a->disturbances);
    topology_destroy(a->machine);
    *a = (machine_report){0};
}
