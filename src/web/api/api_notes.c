/* What looks wrong in the scene: the linter's notes on it as it is shown now. */
#include "web/lab_private.h"

#include "lint/lint.h"
#include "report/json.h"

typedef struct notes_question {
    const lab *lab;
    json_t *list; /* NULL when memory is out */
} notes_question;

static void take_note(void *context, const scene_note *note)
{
    notes_question *q = context;
    json_t *one = json_pack("{s:o, s:o, s:o}", "place", json_of_text(note->place), "text", json_of_text(note->text),
                            "remedy", json_of_text(note->remedy));
    if (q->list && json_array_append_new(q->list, one) != 0) {
        json_decref(q->list);
        q->list = NULL;
    }
}

static status look_for_notes(void *context, scene *s, diagnostic *why)
{
    notes_question *q = context;
    return lint_scene(s, q->lab->settings.level, &(note_taker){take_note, q}, why);
}

static void get_notes(void *of, const http_request *request, http_reply *reply)
{
    (void)request;
    lab *l = of;
    diagnostic why = {0};
    notes_question q = {l, json_array()};
    const status code = painter_with_scene(l->painter, look_for_notes, &q, &why);
    if (code != STATUS_OK) {
        json_decref(q.list);
        http_reply_diagnostic(reply, code, &why);
        return;
    }
    http_reply_json(reply, 200, q.list ? json_pack("{s:o}", "notes", q.list) : NULL);
}

static const http_route routes[] = {
    {"GET", "/api/notes", get_notes, NULL},
};
const lab_routes note_routes = {routes, sizeof routes / sizeof *routes};
