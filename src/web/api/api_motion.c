/* API: the motion of the scene's slimes compared with closed forms, as `cuvette motion` prints it. */
#include "web/api/api.h"

#include "base/cancel.h"
#include "base/json_build.h"
#include "base/text.h"
#include "measure/clock.h"
#include "report/json.h"
#include "report/theory_rows.h"
#include "scene/model/scene.h"
#include "scene/assets/slime.h"
#include "scene/motion/motion.h"
#include "web/session/studies.h"
#include <stdlib.h>

/* Less than the time that a page waits for a reply. */
#define LIMIT_S 50.0

typedef struct motion_question {
    lab *l;
    unsigned stops; /* when it began */
    double began_s;
} motion_question;

static bool is_late(const motion_question *q)
{
    return clock_wall_s() - q->began_s > LIMIT_S;
}

static bool must_stop(void *context)
{
    const motion_question *q = context;
    return is_late(q) || atomic_load(&q->l->motion_stops) != q->stops || studies_runs(q->l->studies, NULL) ||
           studies_ending(q->l->studies);
}

/* Lists the slimes, and writes them as the table of `cuvette motion --csv`. */
static status measure(call *c, motion_question *q, const scene *s, json_t *slimes, FILE *table)
{
    motion_write_csv_header(table);
    status code = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && code == STATUS_OK; i++) {
        const mesh_entry *m = &s->meshes[i];
        if (m->source != MESH_SLIME)
            continue;
        const softbody_settings settings = slime_settings(m);
        softbody_trial_report report;
        cancel_token stop = {.ask = must_stop, .context = q};
        cancel_begin(&stop);
        code = softbody_trials(&settings, c->l->settings.level, &report, &c->why);
        cancel_end(&stop);
        if (code != STATUS_OK)
            continue;
        motion_write_csv(m, &report, table);
        if (json_array_append_new(slimes, motion_slime_json(m, &report)) != 0)
            code = out_of_memory(&c->why);
    }
    if (code == STATUS_INTERRUPTED && is_late(q))
        diagnose(&c->why, code, "lower 'level' of the slime, or raise its 'dt_s'",
                 "the measurement takes more than 50 s");
    else if (code == STATUS_INTERRUPTED)
        diagnose(&c->why, code, "measure again", "the measurement was stopped");
    return code;
}

static status answer(call *c, const scene *s)
{
    motion_question q = {.l = c->l, .stops = atomic_load(&c->l->motion_stops)};
    char *file = api_document_file(c);
    char *text = NULL;
    text_writer table;
    json_t *slimes = json_array();
    status code = file ? semaphore_acquire(c->l->heavy, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        q.began_s = clock_wall_s();
        code = text_writer_open(&table, &c->why);
        if (code == STATUS_OK)
            code = text_writer_end(&table, measure(c, &q, s, slimes, table.stream), &text, NULL, &c->why);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_OK) {
        api_reply_json(c, motion_json(json_incref(slimes), file));
        json_add_as(&c->json, "csv", json_of_text(text));
    }
    json_decref(slimes);
    free(text);
    free(file);
    return code;
}

/* The trials simulate bodies of their own: what hands did to the live slime does not matter. */
status api_motion(call *c)
{
    if (studies_runs(c->l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and this would disturb it", "wait until it ends, or stop it");
    scene *s = scene_document_take(c->l->scene_document, NULL);
    if (!s)
        return out_of_memory(&c->why);
    const status code = scene_moves(s) ? answer(c, s)
                                       : api_refuse(c, 409, "nothing moves in this scene: it has no slime",
                                                    "add one, or open a scene that has a mesh with 'generate: slime'");
    scene_destroy(s);
    return code;
}

status api_motion_stop(call *c)
{
    atomic_fetch_add(&c->l->motion_stops, 1);
    return api_reply_json(c, json_object());
}
