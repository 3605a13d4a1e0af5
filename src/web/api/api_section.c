/* API: a section of the scene, as `cuvette section` writes it: the outlines as JSON, and the drawing. */
#include "base/number.h"
#include "base/text.h"
#include "report/trace_writers.h"
#include "web/api/api.h"

#include <stdlib.h>
#include <string.h>

#define SECTION_REMEDY \
    "give ?view=front, top or side, or ?through=SOLID; &at=X,Y,Z, &extent=U0,U1,V0,V1 and &cells=N are optional"

/* Limits the time for which an image must wait. */
enum { CELLS_MAX = 1000 };

typedef struct section_question {
    const lab *lab;
    const char *scene_name;
    section_rule rule;
    bool as_drawing;
    char *bytes;
    size_t size;
} section_question;

static status cut_and_write(void *context, scene *s, diagnostic *why)
{
    section_question *q = context;
    section_output t = {.s = s, .level = q->lab->settings.level, .scene_path = q->scene_name, .cells = q->rule.cells};
    probe *p = NULL;
    text_writer writer;
    TRY(section_rule_resolve(&q->rule, s, &t.plane, why));
    TRY(probe_create(s, t.level, &p, why));
    t.p = p;
    status code = text_writer_open(&writer, why);
    if (code == STATUS_OK) {
        code =
            q->as_drawing ? section_write_drawing(&t, writer.stream, why) : section_write_json(&t, writer.stream, why);
        code = text_writer_end(&writer, code, &q->bytes, &q->size, why);
    }
    probe_destroy(p);
    return code;
}

static bool read_view(call *c, section_rule *rule)
{
    const char *view = http_query_value(c->request, "view");
    rule->through = http_query_value(c->request, "through");
    for (int i = 0; i < SECTION_VIEW_COUNT && view; i++)
        if (strcmp(view, section_view_words[i]) == 0) {
            rule->view = (section_view)i;
            return true;
        }
    if (view || !rule->through)
        api_refuse(c, 400, view ? "there is no view of that name" : "view or through is missing", SECTION_REMEDY);
    return !view && rule->through;
}

static bool read_rule(call *c, section_rule *rule)
{
    double at[3] = {0}, cells = SECTION_CELLS_USUAL;
    rule->has_at = http_query_value(c->request, "at");
    rule->has_extent = http_query_value(c->request, "extent");
    if (!read_view(c, rule) || (rule->has_at && !api_query_numbers(c, "at", 3, at, SECTION_REMEDY)) ||
        (rule->has_extent && !api_query_numbers(c, "extent", 4, rule->extent, SECTION_REMEDY)) ||
        (http_query_value(c->request, "cells") && !api_query_numbers(c, "cells", 1, &cells, SECTION_REMEDY)))
        return false;
    if (!(cells >= 2 && cells <= CELLS_MAX)) {
        api_refuse(c, 400, "the number of cells is out of range", "give 2 to 1000 cells");
        return false;
    }
    rule->at = vec3_make(at[0], at[1], at[2]);
    rule->cells = (int)cells;
    return true;
}

static status answer_section(call *c, bool as_drawing)
{
    section_question q = {.lab = c->l, .as_drawing = as_drawing};
    if (!read_rule(c, &q.rule))
        return STATUS_BAD_INPUT;
    char *file = api_document_file(c);
    q.scene_name = file;
    status code = file ? semaphore_acquire(c->l->heavy, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        code = render_worker_with_scene(c->l->render_worker, cut_and_write, &q, &c->why);
        semaphore_release(c->l->heavy);
    }
    free(file);
    if (code == STATUS_OK)
        return api_send(c, as_drawing ? "image/svg+xml" : "application/json", q.bytes, q.size);
    free(q.bytes);
    return code;
}

status api_section(call *c)
{
    return answer_section(c, false);
}

status api_section_drawing(call *c)
{
    return answer_section(c, true);
}
