/* API: the scene's optics compared with closed forms, and their curves, as `cuvette realism` writes them. */
#include "base/json_build.h"
#include "web/api/api.h"

#include "base/text.h"
#include "report/theory_rows.h"
#include "report/json.h"
#include <stdlib.h>
#include <string.h>

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

static status measure(realism_question *q, const scene *s, FILE *csv, diagnostic *why)
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

static status trace_curve(realism_question *q, const scene *s, FILE *csv, diagnostic *why)
{
    const realism_curve which = (realism_curve)q->curve;
    realism_points points;
    TRY(realism_trace_curve(s, q->c->l->settings.level, which, &points, why));
    if (!csv)
        return api_reply_json(q->c, realism_curve_json(which, &points));
    realism_write_curve(which, &points, csv);
    return STATUS_OK;
}

static status look(void *context, scene *s, diagnostic *why)
{
    realism_question *q = context;
    status (*const act)(realism_question *, const scene *, FILE *, diagnostic *) = q->curve < 0 ? measure : trace_curve;
    text_writer writer;
    if (!q->as_csv)
        return act(q, s, NULL, why);
    TRY(text_writer_open(&writer, why));
    return text_writer_end(&writer, act(q, s, writer.stream, why), &q->bytes, &q->size, why);
}

static status answer(call *c, realism_question *q)
{
    char *file = api_document_file(c);
    q->c = c;
    q->scene_name = file;
    status code = file ? semaphore_acquire(c->l->heavy, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        code = render_worker_with_scene(c->l->render_worker, look, q, &c->why);
        semaphore_release(c->l->heavy);
    }
    free(file);
    return code == STATUS_OK && q->as_csv ? api_send(c, "text/csv", q->bytes, q->size) : code;
}

status api_realism(call *c)
{
    return answer(c, &(realism_question){.curve = -1});
}

status api_realism_csv(call *c)
{
    return answer(c, &(realism_question){.curve = -1, .as_csv = true});
}

static status answer_curve(call *c, bool as_csv)
{
    const char *name = http_path_value(c->request, "curve");
    for (int i = 0; i < REALISM_CURVE_COUNT; i++)
        if (strcmp(realism_curve_name((realism_curve)i), name) == 0)
            return answer(c, &(realism_question){.curve = i, .as_csv = as_csv});
    return api_refuse(c, 404, "there is no curve of that name", "GET /api/realism lists those of the scene");
}

status api_realism_curve(call *c)
{
    return answer_curve(c, false);
}

status api_realism_curve_csv(call *c)
{
    return answer_curve(c, true);
}
