/* API: the ray tree of a pixel as JSON, text or drawing, as `cuvette trace` writes it; and the linter's notes on the
 * scene. */
#include "base/json_build.h"
#include "web/api/api.h"

#include "base/number.h"
#include "base/text.h"
#include "lint/lint.h"
#include "report/report.h"
#include "report/trace_writers.h"
#include <limits.h>
#include <stdlib.h>

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
        return diagnose(why, STATUS_BAD_INPUT, "lower render.depth or render.samples, or set render.min_weight",
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

static bool take_coordinate(call *c, const char *key, int *place)
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
    if (!take_coordinate(c, "x", &q.x) || !take_coordinate(c, "y", &q.y))
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

static void take_note(void *list, const scene_note *note)
{
    json_add(list, report_note(note->place, note->text, note->remedy));
}

static status collect_notes(void *context, scene *s, diagnostic *why)
{
    call *c = context;
    json_t *list = json_array();
    const note_taker taker = {take_note, &list};
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
