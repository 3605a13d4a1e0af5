/* API: rays through the scene: the ray tree of a pixel, as `cuvette trace` writes it; the scene's beams, and a screen
 * that bins their power; a fan, as `cuvette fan` writes it. Also optics compared with closed forms, and the linter's
 * notes on the scene. */
#include "base/json_build.h"
#include "base/number.h"
#include "base/text.h"
#include "lint/lint.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "report/report.h"
#include "report/trace_writers.h"
#include "web/api/api.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Limits the reply: about one kilobyte per ray; a page displays far fewer. */
enum { TRACE_RAYS_MAX = 100000 };

typedef status trace_writer(const traced *t, FILE *out, diagnostic *why);

typedef struct trace_question {
    const lab *lab;
    trace_writer *write;
    int x, y;
    const char *scene_name;
    char *bytes; /* the reply */
    size_t size;
} trace_question;

static status write_tree(trace_question *q, const scene *s, const probe *p, const ray_tree *tree, diagnostic *why)
{
    if (tree->count > TRACE_RAYS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "lower render.depth or render.samples, or raise render.min_weight",
                        "the pixel's tree has %zu rays, more than the limit of %d", tree->count, TRACE_RAYS_MAX);
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    status code = q->write(&(traced){s, p, tree, q->scene_name, true}, writer.stream, why);
    return text_writer_end(&writer, code, &q->bytes, &q->size, why);
}

static status build_and_write(void *context, scene *s, diagnostic *why)
{
    trace_question *q = context;
    probe *p = NULL;
    ray_tree tree = {0};
    status code = probe_create(s, q->lab->settings.level, &p, why);
    THEN(code, probe_pixel(p, q->x, q->y, &tree, why));
    THEN(code, write_tree(q, s, p, &tree, why));
    ray_tree_release(&tree);
    probe_destroy(p);
    return code;
}

static bool read_coordinate(call *c, const char *key, int *place)
{
    const char *text = http_query_value(c->request, key);
    int64_t value;
    const bool good = text && number_parse_int(text, &value) && value >= INT_MIN && value <= INT_MAX;
    if (good)
        *place = (int)value;
    else
        diagnose(&c->why, STATUS_BAD_INPUT, "give a pixel as ?x=X&y=Y, counted from 0,0 at the top left",
                 text ? "%s is not an integer: '%.128s'" : "%s is missing", key, text);
    return good;
}

static status reply_trace(call *c, trace_writer *write, const char *type)
{
    trace_question q = {.lab = c->l, .write = write};
    if (!read_coordinate(c, "x", &q.x) || !read_coordinate(c, "y", &q.y))
        return STATUS_BAD_INPUT;
    char *file = api_document_file(c);
    q.scene_name = file;
    const status code =
        file ? render_worker_with_scene(c->l->render_worker, build_and_write, &q, &c->why) : out_of_memory(&c->why);
    free(file);
    if (code == STATUS_OK)
        return api_send(c, type, q.bytes, q.size);
    free(q.bytes);
    return code;
}

status api_trace_json(call *c)
{
    return reply_trace(c, trace_write_json, "application/json");
}

status api_trace_text(call *c)
{
    return reply_trace(c, trace_write_text, "text/plain; charset=utf-8");
}

status api_trace_drawing(call *c)
{
    return reply_trace(c, trace_write_drawing, "image/svg+xml");
}

/* --- the linter's notes on the current scene --- */

static void collect_note(void *list, const scene_note *note)
{
    json_add(list, report_note(note->place, note->text, note->remedy));
}

static status collect_notes(void *context, scene *s, diagnostic *why)
{
    call *c = context;
    json_t *list = json_array();
    const note_sink taker = {collect_note, &list};
    status code = lint_scene(s, c->l->settings.level, &taker, why);
    scene_beam_range_hints(s, &taker);
    if (json_object_set_new(c->json, "notes", list) != 0 && code == STATUS_OK)
        code = out_of_memory(why);
    return code;
}

status api_notes(call *c)
{
    api_reply_json(c, json_pack("{s:[]}", "notes"));
    return render_worker_with_scene(c->l->render_worker, collect_notes, c, &c->why);
}

/* Limits the reply: about one kilobyte per segment; a page draws far fewer. */
enum { SEGMENTS_MAX = 20000 };

typedef struct beam_question {
    const lab *lab;
    const char *scene_name;
    beam_screen *screen; /* NULL: the rays */
    char *bytes;
    size_t size;
} beam_question;

static status write_rays(beam_question *q, const scene *s, FILE *out, diagnostic *why)
{
    const beam_output b = {s, q->lab->settings.level, q->scene_name, SEGMENTS_MAX, true};
    return beams_write_json(&b, out, why);
}

static status trace_and_write(void *context, scene *s, diagnostic *why)
{
    beam_question *q = context;
    text_writer writer;
    if (q->screen)
        TRY(beam_screen_expose(s, q->lab->settings.level, q->screen, why));
    TRY(text_writer_open(&writer, why));
    const status code =
        q->screen ? beam_screen_write_json(q->screen, writer.stream, why) : write_rays(q, s, writer.stream, why);
    return text_writer_end(&writer, code, &q->bytes, &q->size, why);
}

static status answer_beams(call *c, beam_question *q)
{
    char *file = api_document_file(c);
    q->lab = c->l;
    q->scene_name = file;
    status code = file ? semaphore_acquire(c->l->heavy, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        code = render_worker_with_scene(c->l->render_worker, trace_and_write, q, &c->why);
        semaphore_release(c->l->heavy);
    }
    free(file);
    if (code == STATUS_OK)
        return api_send(c, "application/json", q->bytes, q->size);
    free(q->bytes);
    return code;
}

status api_beams(call *c)
{
    beam_question q = {.screen = NULL};
    return answer_beams(c, &q);
}

#define SCREEN_REMEDY "give ?centre=X,Y,Z&normal=X,Y,Z&size=WIDTH,HEIGHT&bins=COLUMNS,ROWS&rays=N"

status api_beam_screen(call *c)
{
    double centre[3], normal[3], size[2], bins[2], rays = 0;
    if (!api_query_numbers(c, "centre", 3, centre, SCREEN_REMEDY) ||
        !api_query_numbers(c, "normal", 3, normal, SCREEN_REMEDY) ||
        !api_query_numbers(c, "size", 2, size, SCREEN_REMEDY) ||
        !api_query_numbers(c, "bins", 2, bins, SCREEN_REMEDY) || !api_query_numbers(c, "rays", 1, &rays, SCREEN_REMEDY))
        return STATUS_BAD_INPUT;
    const double most = 1e6; /* only for the conversion to int; beam_screen_expose checks the ranges */
    for (int i = 0; i < 2; i++)
        if (!(bins[i] >= -most && bins[i] <= most && rays >= -most && rays <= most))
            return api_refuse(c, 400, "the number of bins or rays is out of range",
                              "give 1 to 512 bins, 1 to 100000 rays");
    beam_screen screen = {.centre = vec3_make(centre[0], centre[1], centre[2]),
                          .normal = vec3_make(normal[0], normal[1], normal[2]),
                          .width = size[0],
                          .height = size[1],
                          .columns = (int)bins[0],
                          .rows = (int)bins[1],
                          .rays_of_beam = (int)rays};
    beam_question q = {.screen = &screen};
    const status code = answer_beams(c, &q);
    beam_screen_release(&screen);
    return code;
}

/* Limits the reply: the longest paths have tens of points; a page draws far fewer rays. */
enum { RAYS_MAX = 1000 };

#define FAN_REMEDY "give ?from=X,Y,Z&to=X,Y,Z&rays=N and width=W (scene units) or spread=DEGREES"

typedef enum fan_form { FAN_JSON, FAN_CSV, FAN_DRAWING } fan_form;

typedef struct fan_question {
    call *c;
    fan_form form;
    fan_rule rule;
    bool full_trees;
    char *bytes; /* of CSV and drawing */
    size_t size;
} fan_question;

static status write_text(fan_question *q, const fan_output *t, diagnostic *why)
{
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    const status code =
        q->form == FAN_CSV ? fan_write_csv(t, writer.stream, why) : fan_write_drawing(t, writer.stream, why);
    return text_writer_end(&writer, code, &q->bytes, &q->size, why);
}

static status follow_and_write(void *context, scene *s, diagnostic *why)
{
    fan_question *q = context;
    probe *p = NULL;
    fan f = {0};
    status code = probe_create(s, q->c->l->settings.level, &p, why);
    THEN(code, fan_trace(p, &q->rule, &f, why));
    const fan_output t = {s, p, &q->rule, &f, q->full_trees, q->form == FAN_CSV};
    if (code == STATUS_OK && q->form == FAN_JSON)
        code = api_reply_json(q->c, fan_json(&t));
    else
        THEN(code, write_text(q, &t, why));
    fan_release(&f);
    probe_destroy(p);
    return code;
}

/* Reads the width of the fan, or its angle. */
static bool read_size(call *c, fan_rule *rule)
{
    const char *width = http_query_value(c->request, "width"), *spread = http_query_value(c->request, "spread");
    rule->spreads = spread;
    if (!width == !spread) {
        api_refuse(c, 400, width ? "width and spread exclude each other" : "width or spread is missing", FAN_REMEDY);
        return false;
    }
    double *size = spread ? &rule->spread_deg : &rule->width;
    if (!api_query_numbers(c, spread ? "spread" : "width", 1, size, FAN_REMEDY))
        return false;
    const bool good = *size >= 0.0 && *size <= (spread ? 179.0 : 1e6);
    if (!good)
        api_refuse(c, 400, spread ? "spread is out of range" : "width is out of range",
                   spread ? "give 0 to 179 degrees" : "give 0 to 1e6 scene units");
    return good;
}

static bool read_rule(call *c, fan_rule *rule)
{
    double from[3], to[3], normal[3] = {0}, rays = 0;
    rule->has_normal = http_query_value(c->request, "plane");
    if (!api_query_numbers(c, "from", 3, from, FAN_REMEDY) || !api_query_numbers(c, "to", 3, to, FAN_REMEDY) ||
        !api_query_numbers(c, "rays", 1, &rays, FAN_REMEDY) ||
        (rule->has_normal && !api_query_numbers(c, "plane", 3, normal, FAN_REMEDY)) || !read_size(c, rule))
        return false;
    if (!(rays >= 1 && rays <= RAYS_MAX)) {
        api_refuse(c, 400, "the number of rays is out of range", "give 1 to 1000 rays");
        return false;
    }
    rule->from = vec3_make(from[0], from[1], from[2]);
    rule->to = vec3_make(to[0], to[1], to[2]);
    rule->normal = vec3_make(normal[0], normal[1], normal[2]);
    rule->rays = (int)rays;
    return true;
}

static status answer_fan(call *c, fan_form form)
{
    fan_question q = {.c = c, .form = form, .full_trees = api_query_flag(c, "tree")};
    if (!read_rule(c, &q.rule))
        return STATUS_BAD_INPUT;
    TRY(semaphore_acquire(c->l->heavy, &c->why));
    const status code = render_worker_with_scene(c->l->render_worker, follow_and_write, &q, &c->why);
    semaphore_release(c->l->heavy);
    if (code == STATUS_OK && form != FAN_JSON)
        return api_send(c, form == FAN_CSV ? "text/csv" : "image/svg+xml", q.bytes, q.size);
    return code;
}

status api_fan(call *c)
{
    return answer_fan(c, FAN_JSON);
}

status api_fan_csv(call *c)
{
    return answer_fan(c, FAN_CSV);
}

status api_fan_drawing(call *c)
{
    return answer_fan(c, FAN_DRAWING);
}

/* --- the scene's optics compared with closed forms, and their curves, as `cuvette realism` writes them --- */

typedef struct realism_question {
    call *c;
    const char *scene_name;
    int curve; /* realism_curve, or -1: the metrics */
    bool as_csv;
    char *bytes; /* of CSV */
    size_t size;
} realism_question;

/* The curves that the scene has. */
static json_t *curves_of(const scene *s)
{
    json_t *list = json_array();
    for (int i = 0; i < REALISM_CURVE_COUNT; i++) {
        const realism_curve which = (realism_curve)i;
        if (realism_check_curve(s, which, NULL) == STATUS_OK)
            json_add(&list, json_pack("{s:s, s:s, s:s}", "name", realism_curve_name(which), "x", realism_curve_x(which),
                                      "y", realism_curve_y(which)));
    }
    return list;
}

static status measure_optics(realism_question *q, const scene *s, FILE *csv, diagnostic *why)
{
    realism_report report;
    TRY(realism_measure(s, q->c->l->settings.level, &report, why));
    if (csv) {
        realism_write_csv(&report, csv);
        return STATUS_OK;
    }
    json_t *json = realism_json(&report, q->scene_name);
    if (json)
        json_add_as(&json, "curves", curves_of(s));
    return api_reply_json(q->c, json);
}

static status measure_curve(realism_question *q, const scene *s, FILE *csv, diagnostic *why)
{
    const realism_curve which = (realism_curve)q->curve;
    realism_points points;
    TRY(realism_measure_curve(s, q->c->l->settings.level, which, &points, why));
    if (!csv)
        return api_reply_json(q->c, realism_curve_json(which, &points));
    realism_write_curve(which, &points, csv);
    return STATUS_OK;
}

static status answer_with_scene(void *context, scene *s, diagnostic *why)
{
    realism_question *q = context;
    status (*const act)(realism_question *, const scene *, FILE *, diagnostic *) =
        q->curve < 0 ? measure_optics : measure_curve;
    text_writer writer;
    if (!q->as_csv)
        return act(q, s, NULL, why);
    TRY(text_writer_open(&writer, why));
    return text_writer_end(&writer, act(q, s, writer.stream, why), &q->bytes, &q->size, why);
}

static status answer_realism(call *c, realism_question *q)
{
    char *file = api_document_file(c);
    q->c = c;
    q->scene_name = file;
    status code = file ? semaphore_acquire(c->l->heavy, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        code = render_worker_with_scene(c->l->render_worker, answer_with_scene, q, &c->why);
        semaphore_release(c->l->heavy);
    }
    free(file);
    return code == STATUS_OK && q->as_csv ? api_send(c, "text/csv", q->bytes, q->size) : code;
}

status api_realism(call *c)
{
    return answer_realism(c, &(realism_question){.curve = -1});
}

status api_realism_csv(call *c)
{
    return answer_realism(c, &(realism_question){.curve = -1, .as_csv = true});
}

static status answer_curve(call *c, bool as_csv)
{
    const char *name = http_path_value(c->request, "curve");
    for (int i = 0; i < REALISM_CURVE_COUNT; i++)
        if (strcmp(realism_curve_name((realism_curve)i), name) == 0)
            return answer_realism(c, &(realism_question){.curve = i, .as_csv = as_csv});
    return api_refuse(c, 404, "there is no curve of that name", "use a curve that GET /api/realism lists");
}

status api_realism_curve(call *c)
{
    return answer_curve(c, false);
}

status api_realism_curve_csv(call *c)
{
    return answer_curve(c, true);
}
