#include "report/report.h"
#include "report/json.h"
#include "report/param_lines.h"
#include "base/number.h"
#include "measure/statistics.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

typedef json_int_t count_type;

/* "0,2.75,-6", with or without brackets, as a list of numbers. */
static json_t *list_of_numbers(const char *text)
{
    json_t *list = json_array();
    char *copy = strdup(text), *rest = NULL;
    int bad = !list || !copy;
    for (char *word = copy ? strtok_r(copy, "[], ", &rest) : NULL; word; word = strtok_r(NULL, "[], ", &rest)) {
        double number;
        bad |= !number_parse_real(word, &number) || json_array_append_new(list, json_of_real(number));
    }
    free(copy);
    if (bad)
        json_decref(list);
    return bad ? NULL : list;
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
        json_t *list = list_of_numbers(text);
        if (list)
            return list;
        break;
    }
    case PARAM_CHOICE:
    case PARAM_PATH:
    case PARAM_WORD: break;
    }
    return json_of_text(text);
}

static status add_param(void *context, const char *path, const param *row, const char *value)
{
    json_object_del(context, path); /* so that what is added last stands last */
    return json_object_set_new(context, path, report_value(row, value)) ? STATUS_FAILURE : STATUS_OK;
}

/* The camera's and the background's, of which some may be out of use. */
static status add_alternatives(json_t *params, const scene *s)
{
    status code = STATUS_OK;
    for (size_t i = 0; i < param_count() && code == STATUS_OK; i++) {
        const param *row = param_at(i);
        char *value = NULL, path[PARAM_PATH_MAX];
        if (row->group != PARAM_CAMERA && row->group != PARAM_BACKGROUND)
            continue;
        code = scene_get(s, param_lines_path(row, path, sizeof path), &value, NULL);
        if (code == STATUS_OK)
            code = add_param(params, path, row, value);
        free(value);
    }
    return code;
}

/* Those out of use stand before those that take their place: set one by one in this order they make the scene. */
json_t *report_params(const scene *s)
{
    json_t *params = json_object();
    if (params && add_alternatives(params, s) == STATUS_OK && scene_each_param(s, add_param, params) == STATUS_OK)
        return params;
    json_decref(params);
    return NULL;
}

static json_t *by_kind(uint64_t primary, uint64_t reflect, uint64_t refract, uint64_t shadow)
{
    return json_pack("{s:I,s:I,s:I,s:I,s:I}", "camera", (count_type)primary, "reflect", (count_type)reflect, "refract",
                     (count_type)refract, "shadow", (count_type)shadow, "total",
                     (count_type)(primary + reflect + refract + shadow));
}

static json_t *rays(const ray_counters *c)
{
    return by_kind(c->camera, c->reflect, c->refract, c->shadow);
}

static json_t *rays_by_depth(const scene *s, const ray_counters *c)
{
    json_t *list = json_array();
    for (int64_t depth = 0; list && depth <= s->render.depth && depth <= COUNTERS_DEPTH_MAX; depth++)
        json_array_append_new(list, json_integer((count_type)c->by_depth[depth]));
    return list;
}

static json_t *by_solid(const scene *s, const uint64_t *counts)
{
    json_t *object = json_object();
    for (size_t i = 0; object && i < s->solid_count && i < COUNTERS_SOLID_MAX; i++)
        json_object_set_new(object, s->solids[i].name, json_integer((count_type)counts[i]));
    return object;
}

static json_t *cut(uint64_t count, const int64_t throughput[3])
{
    return json_pack("{s:I,s:[o,o,o]}", "rays", (count_type)count, "throughput",
                     json_of_real((double)throughput[0] / COUNTERS_CUT_ONE),
                     json_of_real((double)throughput[1] / COUNTERS_CUT_ONE),
                     json_of_real((double)throughput[2] / COUNTERS_CUT_ONE));
}

/* Mean over RGB of the throughput of all the rays that were not traced. */
static double cut_throughput(const ray_counters *c)
{
    double sum = 0;
    for (int channel = 0; channel < 3; channel++)
        sum += (double)(c->cut_depth_throughput[channel] + c->cut_weight_throughput[channel]);
    return sum / 3 / COUNTERS_CUT_ONE;
}

static json_t *worker(int index, const worker_report *w)
{
    return json_pack("{s:i,s:o,s:o,s:o,s:o,s:o,s:I,s:o,s:i}", "worker", index, "wall_s", json_of_real(w->wall_s),
                     "cpu_s", json_of_real(w->cpu_s), "start_s", json_of_real(w->start_s), "busy_s",
                     json_of_real(w->busy_s), "waiting_s", json_of_real(w->waiting_s), "tiles", (count_type)w->tiles,
                     "rays", by_kind(w->camera, w->reflect, w->refract, w->shadow), "pu", w->pu);
}

static json_t *workers(const render_result *result)
{
    json_t *list = json_array();
    for (int i = 0; list && i < result->worker_count; i++)
        if (json_array_append_new(list, worker(i, &result->workers[i]))) {
            json_decref(list);
            return NULL;
        }
    return list;
}

static json_t *list_of_reals(const double *values, size_t count)
{
    json_t *list = json_array();
    for (size_t i = 0; list && i < count; i++)
        json_array_append_new(list, json_of_real(values[i]));
    return list;
}

/* The median of all the finished frames; of a frame that was broken off, what it took. */
static json_t *median(const double *values, size_t count, double otherwise)
{
    double *sorted = malloc((count + 1) * sizeof *sorted);
    if (!sorted)
        return NULL;
    memcpy(sorted, values, count * sizeof *sorted);
    json_t *result = json_of_real(count ? summarize(sorted, count).median : otherwise);
    free(sorted);
    return result;
}

static json_t *hardware(const hardware_counts *h)
{
    return json_pack("{s:o,s:o,s:o,s:o}", "cycles", json_of_count(h->cycles), "instructions",
                     json_of_count(h->instructions), "branch_misses", json_of_count(h->branch_misses), "cache_misses",
                     json_of_count(h->cache_misses));
}

static int add_times(json_t *o, const frames *f, bool repeated)
{
    int bad = json_object_set_new(o, "wall_s", median(f->wall_s, f->count, f->result->wall_s));
    bad |= json_object_set_new(o, "cpu_s", median(f->cpu_s, f->count, f->result->cpu_s));
    if (repeated) {
        bad |= json_object_set_new(o, "repeat", json_integer((count_type)f->count));
        bad |= json_object_set_new(o, "wall_s_all", list_of_reals(f->wall_s, f->count));
        bad |= json_object_set_new(o, "cpu_s_all", list_of_reals(f->cpu_s, f->count));
    }
    return bad;
}

static int add_counts(json_t *o, const scene *s, const ray_counters *c)
{
    int bad = json_object_set_new(o, "rays", rays(c));
    bad |= json_object_set_new(o, "rays_by_depth", rays_by_depth(s, c));
    bad |= json_object_set_new(o, "total_internal", json_integer((count_type)c->total_internal));
    bad |= json_object_set_new(o, "first_hits", by_solid(s, c->first_hits));
    bad |= json_object_set_new(o, "hits", by_solid(s, c->hits));
    bad |= json_object_set_new(o, "tests", by_solid(s, c->tests));
    bad |= json_object_set_new(o, "cut",
                               json_pack("{s:o,s:o}", "depth", cut(c->cut_depth, c->cut_depth_throughput), "weight",
                                         cut(c->cut_weight, c->cut_weight_throughput)));
    bad |= json_object_set_new(o, "cut_throughput", json_of_real(cut_throughput(c)));
    return bad;
}

/* Mean variance of the film's values by channel, in the film's own space, and the root of its mean; null where nothing
 * is drawn by chance. */
static json_t *noise(const render_result *r)
{
    double mean[3] = {0.0, 0.0, 0.0};
    const size_t pixels = (size_t)r->picture->width * (size_t)r->picture->height;
    if (!r->variance)
        return json_null();
    for (size_t i = 0; i < 3 * pixels; i++)
        mean[i % 3] += r->variance[i] / (double)pixels;
    return json_pack("{s:o,s:[o,o,o]}", "rms", json_of_real(render_noise_rms(r)), "variance", json_of_real(mean[0]),
                     json_of_real(mean[1]), json_of_real(mean[2]));
}

/* null where a scene has no meshes and none are drawn. */
static json_t *meshes(const mesh_report *m)
{
    if (m->triangles == 0 && m->drawn == 0)
        return json_null();
    const double each = m->triangles > 0 ? (double)m->bytes / (double)m->triangles : (double)NAN;
    json_t *o = json_pack("{s:o,s:o,s:o}", "triangles", json_of_count((int64_t)m->triangles), "instances",
                          json_of_count((int64_t)m->instances), "accel_bytes", json_of_count((int64_t)m->bytes));
    int bad = json_object_set_new(o, "bytes_per_triangle", json_of_real(each));
    bad |= json_object_set_new(o, "build_s", json_of_real(m->build_s));
    bad |= json_object_set_new(o, "drawn", json_of_count((int64_t)m->drawn));
    bad |= json_object_set_new(o, "drawn_bytes", json_of_count((int64_t)m->drawn_bytes));
    if (!bad)
        return o;
    json_decref(o);
    return NULL;
}

static int add_process(json_t *o, const frames *f)
{
    int bad = json_object_set_new(o, "threads", workers(f->result));
    bad |= json_object_set_new(o, "peak_rss_bytes", json_of_count(f->spent.peak_rss_bytes));
    bad |= json_object_set_new(o, "voluntary_switches", json_of_count(f->spent.voluntary_switches));
    bad |= json_object_set_new(o, "involuntary_switches", json_of_count(f->spent.involuntary_switches));
    bad |= json_object_set_new(o, "others_share", json_of_real(usage_others_share(&f->spent)));
    bad |= json_object_set_new(o, "hardware", hardware(&f->hardware));
    return bad;
}

json_t *report_create(const scene *s, isa level, const frames *f, bool repeated)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)film_hash(f->result->picture));
    json_t *o = json_pack("{s:i,s:s,s:b}", "schema", REPORT_SCHEMA, "film_hash", hash, "whole", (int)f->whole);
    if (!o)
        return NULL;
    int bad = add_times(o, f, repeated) | add_counts(o, s, &f->result->counters) | add_process(o, f);
    bad |= json_object_set_new(o, "noise", noise(f->result));
    bad |= json_object_set_new(o, "meshes", meshes(&f->result->meshes));
    bad |= json_object_set_new(o, "isa", json_string(isa_name(level)));
    bad |= json_object_set_new(o, "version", json_string(CUVETTE_VERSION));
    bad |= json_object_set_new(o, "scene", json_of_text(s->path ? s->path : ""));
    bad |= json_object_set_new(o, "params", report_params(s));
    if (!bad)
        return o;
    json_decref(o);
    return NULL;
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
    bad |= json_object_set_new(o, "differing_share", json_of_real(c->differing_share));
    return !bad;
}
