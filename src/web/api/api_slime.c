/* API: the live slime: play, pause, and hands that drag it through the image; and the motion of the scene's slimes
 * compared with closed forms, as `cuvette motion` prints it. */
#include "base/cancel.h"
#include "base/json_build.h"
#include "base/text.h"
#include "measure/clock.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/assets/slime.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include "scene/motion/motion.h"
#include "web/api/api.h"
#include "web/session/studies.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Reads one of the words as its index; -1 if the key is missing. */
static bool read_word(call *c, const char *key, const char *const *words, const char *remedy, int *index)
{
    const char *word = NULL;
    *index = -1;
    if (!api_read_text(c, key, false, &word))
        return false;
    for (int i = 0; word && words[i] && *index < 0; i++)
        if (strcmp(words[i], word) == 0)
            *index = i;
    if (word && *index < 0)
        api_refuse(c, 400, "unknown word", remedy);
    return !word || *index >= 0;
}

static bool has_slime(lab *l)
{
    scene *current = scene_document_copy(l->scene_document, NULL);
    const bool has = current && scene_moves(current);
    scene_destroy(current);
    return has;
}

status api_slime(call *c)
{
    static const char *const orders[] = {
        [LIVE_PLAY] = "play", [LIVE_PAUSE] = "pause", [LIVE_RESTART] = "restart", [LIVE_OFF] = "off", NULL};
    static const char *const previews[] = {[LIVE_TRACED] = "traced", [LIVE_ZBUFFER] = "zbuffer", NULL};
    live *live_slime = render_worker_live(c->l->render_worker);
    int what, preview;
    if (!read_word(c, "do", orders, "use play, pause, restart or off for 'do'", &what) ||
        !read_word(c, "preview", previews, "use traced or zbuffer for 'preview'", &preview))
        return STATUS_BAD_INPUT;
    if (what < 0 && preview < 0)
        return api_refuse(c, 400, "neither 'do' nor 'preview' is given",
                          "give 'do' (play, pause, restart, off), 'preview' (traced, zbuffer) or both");
    if (!has_slime(c->l))
        return api_refuse(c, 409, "the scene has no slime",
                          "add one, or open a scene that has a mesh with 'generate: slime'");
    if (preview >= 0)
        live_set_preview(live_slime, (live_preview)preview);
    if (what >= 0)
        live_send(live_slime, (live_command)what);
    return api_reply_json(c, live_json(live_slime));
}

/* Reads the number of a hand; LIVE_ALL if it is missing. */
static bool read_hand(call *c, bool needed, int *hand)
{
    double number = LIVE_ALL;
    if (!api_read_number(c, "hand", needed, &number))
        return false;
    const bool is_valid = number == LIVE_ALL || (number >= 0 && number <= INT_MAX && number == floor(number));
    if (!is_valid)
        api_refuse(c, 400, "'hand' must be an integer of 0 or more", "give the number that /api/slime/grab returned");
    *hand = is_valid ? (int)number : LIVE_ALL;
    return is_valid;
}

static bool read_point(call *c, double *x, double *y)
{
    const double limit = 1e6;
    if (!api_read_number(c, "x", true, x) || !api_read_number(c, "y", true, y))
        return false;
    const bool good = fabs(*x) <= limit && fabs(*y) <= limit;
    if (!good)
        api_refuse(c, 400, "the point is too far outside the image", "give x and y in pixels of the full image");
    return good;
}

status api_grab(call *c)
{
    double x, y, reach = 0.0;
    if (!read_point(c, &x, &y) || !api_read_number(c, "reach", false, &reach))
        return STATUS_BAD_INPUT;
    if (reach < 0.0)
        return api_refuse(c, 400, "'reach' is below 0", "give scene units; 0 or omitted: 0.3 of the slime's radius");
    vec3 origin, direction, where;
    int hand = LIVE_MISSED;
    scene *current = scene_document_copy(c->l->scene_document, NULL);
    if (!current)
        return out_of_memory(&c->why);
    lab_camera_ray(current, x, y, &origin, &direction);
    scene_destroy(current);
    c->refused = 409; /* a conflict with the current state is 409, not 400 */
    const status code =
        live_grab(render_worker_live(c->l->render_worker), origin, direction, reach, &hand, &where, &c->why);
    if (code == STATUS_OK && hand == LIVE_MISSED)
        return api_refuse(c, 404, "no slime at that point", "grab a visible part of the slime");
    if (code == STATUS_OK)
        api_reply_json(c, json_pack("{s:i, s:[o, o, o]}", "hand", hand, "where", json_of_real(where.x),
                                    json_of_real(where.y), json_of_real(where.z)));
    return code;
}

/* The offset from `where` to the point on the camera ray of (x, y) at the same depth along the view direction, plus
 * depth; the target never moves behind the camera. */
static vec3 hand_offset(const scene *s, double x, double y, double depth, vec3 where)
{
    const double nearest_fraction = 0.05;
    vec3 eye, direction, forward;
    lab_camera_ray(s, (double)scene_settings(s)->width / 2.0, (double)scene_settings(s)->height / 2.0, &eye, &forward);
    lab_camera_ray(s, x, y, &eye, &direction);
    const double depth_at_grab = vec3_dot(vec3_sub(where, eye), forward),
                 new_depth = fmax(depth_at_grab + depth, nearest_fraction * fabs(depth_at_grab));
    const vec3 target = vec3_add(eye, vec3_scale(direction, new_depth / vec3_dot(direction, forward)));
    return vec3_sub(target, where);
}

status api_move_hand(call *c)
{
    double x, y, depth = 0.0;
    int hand;
    if (!read_hand(c, true, &hand) || !read_point(c, &x, &y) || !api_read_number(c, "depth", false, &depth))
        return STATUS_BAD_INPUT;
    live *live_slime = render_worker_live(c->l->render_worker);
    vec3 where;
    c->refused = 409;
    scene *current = scene_document_copy(c->l->scene_document, NULL);
    status code = current ? live_where(live_slime, hand, &where, &c->why) : out_of_memory(&c->why);
    THEN(code, live_move(live_slime, hand, hand_offset(current, x, y, depth, where), &c->why));
    scene_destroy(current);
    api_reply_json(c, json_object());
    return code;
}

status api_release(call *c)
{
    int hand;
    if (!read_hand(c, false, &hand))
        return STATUS_BAD_INPUT;
    c->refused = 409;
    api_reply_json(c, json_object());
    return live_release(render_worker_live(c->l->render_worker), hand, &c->why);
}

/* --- the motion compared with closed forms --- */

/* Below the minute that a page waits for a reply. */
#define LIMIT_S 50.0

typedef struct motion_question {
    lab *l;
    unsigned stops; /* lab.motion_stops at the start */
    double began_s;
} motion_question;

static bool is_late(const motion_question *q)
{
    return clock_wall_s() - q->began_s > LIMIT_S;
}

static bool is_cancelled(void *context)
{
    const motion_question *q = context;
    return is_late(q) || atomic_load(&q->l->motion_stops) != q->stops || studies_runs(q->l->studies, NULL) ||
           studies_ending(q->l->studies);
}

/* Measures each slime, adds it to the list, and writes its rows of `cuvette motion --csv`. */
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
        cancel_token token = {.ask = is_cancelled, .context = q};
        cancel_begin(&token);
        code = softbody_trials(&settings, c->l->settings.level, &report, &c->why);
        cancel_end(&token);
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

/* The trials simulate separate bodies, so hands on the live slime do not affect them. */
status api_motion(call *c)
{
    if (studies_runs(c->l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and the trials would disturb it",
                          "wait until the study ends, or stop it");
    scene *s = scene_document_copy(c->l->scene_document, NULL);
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
