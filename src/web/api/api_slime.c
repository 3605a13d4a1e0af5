/* Playing with the slime: when it moves, and hands that reach through the picture. */
#include "web/lab_private.h"

#include "report/json.h"
#include "scene/motion/motion.h"
#include "scene/model/scene.h"
#include <limits.h>
#include <math.h>
#include <string.h>

static void reply_live(lab *l, http_reply *reply)
{
    http_reply_json(reply, 200, live_tell(painter_live(l->painter)));
}

/* What does not go together with what is there now is no fault of the request. */
static void reply_refusal(http_reply *reply, status code, const diagnostic *why)
{
    if (code == STATUS_FAILURE)
        http_reply_diagnostic(reply, code, why);
    else
        http_reply_error(reply, 409, why->what, why->remedy);
}

static bool find_word(const char *const *words, const char *word, int *index)
{
    for (*index = 0; words[*index]; ++*index)
        if (strcmp(words[*index], word) == 0)
            return true;
    return false;
}

/* -1 where the key is missing. */
static bool take_word(const json_t *given, const char *key, const char *const *words, const char *remedy, int *index,
                      http_reply *reply)
{
    const char *word = NULL;
    *index = -1;
    if (!lab_take_text(given, key, false, &word, reply))
        return false;
    if (!word || find_word(words, word, index))
        return true;
    http_reply_error(reply, 400, "there is no such word", remedy);
    return false;
}

static bool has_slime(lab *l)
{
    scene *now = desk_take(l->desk, NULL);
    const bool has = now && scene_moves(now);
    scene_destroy(now);
    return has;
}

static void order(lab *l, const json_t *given, http_reply *reply)
{
    static const char *const orders[] = {
        [LIVE_PLAY] = "play", [LIVE_PAUSE] = "pause", [LIVE_RESTART] = "restart", [LIVE_OFF] = "off", NULL};
    static const char *const previews[] = {[LIVE_TRACED] = "traced", [LIVE_ZBUFFER] = "zbuffer", NULL};
    int what, preview;
    if (!take_word(given, "do", orders, "'do' is play, pause, restart or off", &what, reply) ||
        !take_word(given, "preview", previews, "'preview' is traced or zbuffer", &preview, reply))
        return;
    if (what < 0 && preview < 0) {
        http_reply_error(reply, 400, "nothing is asked for",
                         "give 'do' (play, pause, restart, off), 'preview' (traced, zbuffer) or both");
        return;
    }
    if (!has_slime(l)) {
        http_reply_error(reply, 409, "the scene has no slime",
                         "add one, or open a scene that has a mesh with 'generate: slime'");
        return;
    }
    if (preview >= 0)
        live_set_preview(painter_live(l->painter), (live_preview)preview);
    if (what >= 0)
        live_give(painter_live(l->painter), (live_order)what);
    reply_live(l, reply);
}

/* A hand's number; LIVE_ALL where there is none. */
static bool take_hand(const json_t *given, bool needed, int *hand, http_reply *reply)
{
    double number = LIVE_ALL;
    if (!lab_take_number(given, "hand", needed, &number, reply))
        return false;
    const bool is_one = number == LIVE_ALL || (number >= 0 && number <= INT_MAX && number == floor(number));
    if (!is_one)
        http_reply_error(reply, 400, "'hand' is no hand's number", "give the number that /api/slime/grab answered");
    *hand = is_one ? (int)number : LIVE_ALL;
    return is_one;
}

static bool take_place(const json_t *given, double *x, double *y, http_reply *reply)
{
    const double far = 1e6;
    if (!lab_take_number(given, "x", true, x, reply) || !lab_take_number(given, "y", true, y, reply))
        return false;
    const bool good = fabs(*x) <= far && fabs(*y) <= far;
    if (!good)
        http_reply_error(reply, 400, "the place is too far from the picture", "give pixels of the full picture");
    return good;
}

static void grab(lab *l, const json_t *given, http_reply *reply)
{
    double x, y, reach = 0.0;
    if (!take_place(given, &x, &y, reply) || !lab_take_number(given, "reach", false, &reach, reply))
        return;
    if (reach < 0.0) {
        http_reply_error(reply, 400, "a hand cannot reach less than 0",
                         "give scene units; 0 or nothing: three tenths of the slime's radius");
        return;
    }
    diagnostic why = {.what = ""};
    vec3 origin, direction, where;
    int hand = LIVE_MISSED;
    scene *now = desk_take(l->desk, NULL);
    status code = now ? STATUS_OK : out_of_memory(&why);
    if (now) {
        lab_camera_ray(now, x, y, &origin, &direction);
        scene_destroy(now);
        code = live_grab(painter_live(l->painter), origin, direction, reach, &hand, &where, &why);
    }
    if (code != STATUS_OK)
        reply_refusal(reply, code, &why);
    else if (hand == LIVE_MISSED)
        http_reply_error(reply, 404, "there is no slime", "grab where the slime is seen");
    else
        http_reply_json(reply, 200,
                        json_pack("{s:i, s:[o, o, o]}", "hand", hand, "where", json_of_real(where.x),
                                  json_of_real(where.y), json_of_real(where.z)));
}

/* The way from a place to where the ray through the picture is as far from the camera, along its view, and depth
 * farther; never behind it. */
static vec3 way_to(const scene *s, double x, double y, double depth, vec3 where)
{
    const double nearest = 0.05;
    vec3 eye, direction, forward;
    lab_camera_ray(s, (double)s->render.width / 2.0, (double)s->render.height / 2.0, &eye, &forward);
    lab_camera_ray(s, x, y, &eye, &direction);
    const double away = vec3_dot(vec3_sub(where, eye), forward), along = fmax(away + depth, nearest * fabs(away));
    const vec3 there = vec3_add(eye, vec3_scale(direction, along / vec3_dot(direction, forward)));
    return vec3_sub(there, where);
}

static void move(lab *l, const json_t *given, http_reply *reply)
{
    double x, y, depth = 0.0;
    int hand;
    if (!take_hand(given, true, &hand, reply) || !take_place(given, &x, &y, reply) ||
        !lab_take_number(given, "depth", false, &depth, reply))
        return;
    live *toy = painter_live(l->painter);
    diagnostic why = {.what = ""};
    vec3 where;
    scene *now = desk_take(l->desk, NULL);
    status code = now ? live_where(toy, hand, &where, &why) : out_of_memory(&why);
    if (code == STATUS_OK)
        code = live_move(toy, hand, way_to(now, x, y, depth, where), &why);
    scene_destroy(now);
    if (code == STATUS_OK)
        http_reply_json(reply, 200, json_object());
    else
        reply_refusal(reply, code, &why);
}

static void release(lab *l, const json_t *given, http_reply *reply)
{
    int hand;
    diagnostic why = {.what = ""};
    if (!take_hand(given, false, &hand, reply))
        return;
    const status code = live_release(painter_live(l->painter), hand, &why);
    if (code == STATUS_OK)
        http_reply_json(reply, 200, json_object());
    else
        reply_refusal(reply, code, &why);
}

/* The body that all of them have. */
static void with_body(lab *l, const http_request *request, http_reply *reply,
                      void (*act)(lab *l, const json_t *given, http_reply *reply))
{
    json_t *given = http_body_json(request, reply);
    if (!given)
        return;
    if (json_is_object(given))
        act(l, given, reply);
    else
        http_reply_error(reply, 400, "the body is no object", "send {..}");
    json_decref(given);
}

static void post_order(void *context, const http_request *request, http_reply *reply)
{
    with_body(context, request, reply, order);
}

static void post_grab(void *context, const http_request *request, http_reply *reply)
{
    with_body(context, request, reply, grab);
}

static void post_move(void *context, const http_request *request, http_reply *reply)
{
    with_body(context, request, reply, move);
}

static void post_release(void *context, const http_request *request, http_reply *reply)
{
    with_body(context, request, reply, release);
}

static const http_route routes[] = {
    {"POST", "/api/slime", post_order, NULL},
    {"POST", "/api/slime/grab", post_grab, NULL},
    {"POST", "/api/slime/move", post_move, NULL},
    {"POST", "/api/slime/release", post_release, NULL},
};
const lab_routes slime_routes = {routes, sizeof routes / sizeof *routes};
