/* API: a fan of rays through the scene as JSON, CSV or drawing, as `cuvette fan` writes it. */
#include "web/api/api.h"

#include "base/text.h"
#include "report/fan_writers.h"
#include <stdlib.h>

/* A page draws fewer; the longest paths have tens of points. */
enum { RAYS_MAX = 1000 };

#define FORM "give ?from=X,Y,Z&to=X,Y,Z&rays=N and width=W (scene units) or spread=DEGREES"

typedef enum fan_form { FAN_JSON, FAN_CSV, FAN_DRAWING } fan_form;

typedef struct fan_question {
    call *c;
    fan_form form;
    fan_rule rule;
    bool whole_trees;
    char *bytes; /* of CSV and drawing */
    size_t size;
} fan_question;

static status write_text(fan_question *q, const fanned *t, diagnostic *why)
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
    THEN(code, fan_follow(p, &q->rule, &f, why));
    const fanned t = {s, p, &q->rule, &f, q->whole_trees, q->form == FAN_CSV};
    if (code == STATUS_OK && q->form == FAN_JSON)
        code = api_reply_json(q->c, fan_json(&t));
    else
        THEN(code, write_text(q, &t, why));
    fan_release(&f);
    probe_destroy(p);
    return code;
}

/* The size of the fan: its width, or its angle. */
static bool take_size(call *c, fan_rule *rule)
{
    const char *width = http_query_value(c->request, "width"), *spread = http_query_value(c->request, "spread");
    rule->spreads = spread;
    if (!width == !spread) {
        api_refuse(c, 400, width ? "width and spread exclude each other" : "width or spread is missing", FORM);
        return false;
    }
    double *size = spread ? &rule->spread_deg : &rule->width;
    if (!api_query_numbers(c, spread ? "spread" : "width", 1, size, FORM))
        return false;
    const bool good = *size >= 0.0 && *size <= (spread ? 179.0 : 1e6);
    if (!good)
        api_refuse(c, 400, spread ? "spread is out of range" : "width is out of range",
                   spread ? "give 0 to 179 degrees" : "give 0 to 1e6 scene units");
    return good;
}

static bool take_rule(call *c, fan_rule *rule)
{
    double from[3], to[3], normal[3] = {0}, rays = 0;
    rule->has_normal = http_query_value(c->request, "plane");
    if (!api_query_numbers(c, "from", 3, from, FORM) || !api_query_numbers(c, "to", 3, to, FORM) ||
        !api_query_numbers(c, "rays", 1, &rays, FORM) ||
        (rule->has_normal && !api_query_numbers(c, "plane", 3, normal, FORM)) || !take_size(c, rule))
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

static status answer(call *c, fan_form form)
{
    fan_question q = {.c = c, .form = form, .whole_trees = api_query_flag(c, "tree")};
    if (!take_rule(c, &q.rule))
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
    return answer(c, FAN_JSON);
}

status api_fan_csv(call *c)
{
    return answer(c, FAN_CSV);
}

status api_fan_drawing(call *c)
{
    return answer(c, FAN_DRAWING);
}
