/* What a pixel's ray grows into: its tree as JSON, as text, as a drawing; what `cuvette trace` writes. */
#include "web/lab_private.h"

#include "base/number.h"
#include "base/text_writer.h"
#include "report/trace_writers.h"
#include <limits.h>
#include <stdlib.h>

/* A kilobyte each, about; a page shows far fewer. */
enum { TRACE_RAYS_MAX = 100000 };

typedef status trace_writer(const traced *t, FILE *out, diagnostic *why);

typedef struct trace_question {
    const lab *lab;
    trace_writer *write;
    int x, y;
    const char *scene_name;
    char *bytes; /* the answer */
    size_t size;
} trace_question;

static status write_tree(trace_question *q, const scene *s, const probe *p, const ray_tree *tree, diagnostic *why)
{
    if (tree->count > TRACE_RAYS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "lower render.depth or render.samples, or set render.min_weight",
                        "the pixel's tree has %zu rays, more than the %d that are sent", tree->count, TRACE_RAYS_MAX);
    text_writer writer;
    status code = text_writer_open(&writer, why);
    if (code != STATUS_OK)
        return code;
    code = q->write(&(traced){s, p, tree, q->scene_name}, writer.stream, why);
    if (code == STATUS_OK)
        return text_writer_close(&writer, &q->bytes, &q->size, why);
    text_writer_abandon(&writer);
    return code;
}

static status grow_and_write(void *context, scene *s, diagnostic *why)
{
    trace_question *q = context;
    probe *p = NULL;
    ray_tree tree = {0};
    status code = probe_create(s, q->lab->settings.level, &p, why);
    if (code == STATUS_OK)
        code = probe_pixel(p, q->x, q->y, &tree, why);
    if (code == STATUS_OK)
        code = write_tree(q, s, p, &tree, why);
    ray_tree_release(&tree);
    probe_destroy(p);
    return code;
}

static bool take_place(const http_request *request, const char *key, int *place, http_reply *reply)
{
    const char *text = http_query_value(request, key);
    int64_t value;
    if (text && number_parse_int(text, &value) && value >= INT_MIN && value <= INT_MAX) {
        *place = (int)value;
        return true;
    }
    char what[256];
    snprintf(what, sizeof what, text ? "%s is no integer: '%.128s'" : "%s is missing", key, text);
    http_reply_error(reply, 400, what, "ask for a pixel as ?x=X&y=Y, counted from 0,0 at the top left");
    return false;
}

static void reply_trace(lab *l, const http_request *request, http_reply *reply, trace_writer *write, const char *type)
{
    trace_question q = {.lab = l, .write = write};
    if (!take_place(request, "x", &q.x, reply) || !take_place(request, "y", &q.y, reply))
        return;
    diagnostic why = {0};
    json_t *told = json_object();
    const bool known = told && desk_tell(l->desk, told);
    const char *file = json_string_value(json_object_get(told, "file"));
    q.scene_name = file ? file : "";
    const status code = known ? painter_with_scene(l->painter, grow_and_write, &q, &why)
                              : diagnose(&why, STATUS_FAILURE, "", "no memory for the scene's name");
    if (code == STATUS_OK) {
        http_reply_bytes(reply, 200, type, q.bytes, q.size);
    } else {
        free(q.bytes);
        http_reply_diagnostic(reply, code, &why);
    }
    json_decref(told);
}

static void get_json(void *context, const http_request *request, http_reply *reply)
{
    reply_trace(context, request, reply, trace_write_json, "application/json");
}

static void get_text(void *context, const http_request *request, http_reply *reply)
{
    reply_trace(context, request, reply, trace_write_text, "text/plain; charset=utf-8");
}

static void get_drawing(void *context, const http_request *request, http_reply *reply)
{
    reply_trace(context, request, reply, trace_write_drawing, "image/svg+xml");
}

static const http_route routes[] = {
    {"GET", "/api/trace", get_json, NULL},
    {"GET", "/api/trace.txt", get_text, NULL},
    {"GET", "/api/trace.svg", get_drawing, NULL},
};
const lab_routes trace_routes = {routes, sizeof routes / sizeof *routes};
