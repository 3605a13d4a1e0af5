/* Playing with the slime: when it moves, and hands that reach through the picture. */
#include "web/api/api.h"

#include "report/json.h"
#include "scene/motion/motion.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include <limits.h>
#include <math.h>
#include <string.h>

/* -1 where the key is missing. */
static bool take_word(call *c, const char *key, const char *const *words, const char *remedy, int *index)
{
    const char *word = NULL;
    *index = -1;
    if (!api_take_text(c, key, false, &word))
        return false;
    for (int i = 0; word && words[i] && *index < 0; i++)
        if (strcmp(words[i], word) == 0)
            *index = i;
    if (word && *index < 0)
        api_refuse(c, 400, "there is no such word", remedy);
    return !word || *index >= 0;
}

static bool has_slime(lab *l)
{
    scene *now = scene_document_take(l->scene_document, NULL);
    const bool has = now && scene_moves(now);
    scene_destroy(now);
    return has;
}

status api_slime(call *c)
{
    static const char *const orders[] = {
        [LIVE_PLAY] = "play", [LIVE_PAUSE] = "pause", [LIVE_RESTART] = "restart", [LIVE_OFF] = "off", NULL};
    static const char *const previews[] = {[LIVE_TRACED] = "traced", [LIVE_ZBUFFER] = "zbuffer", NULL};
    live *toy = render_worker_live(c->l->render_worker);
    int what, preview;
    if (!take_word(c, "do", orders, "'do' is play, pause, restart or off", &what) ||
        !take_word(c, "preview", previews, "'preview' is traced or zbuffer", &preview))
        return STATUS_BAD_INPUT;
    if (what < 0 && preview < 0)
        return api_refuse(c, 400, "nothing is asked for",
                          "give 'do' (play, pause, restart, off), 'preview' (traced, zbuffer) or both");
    if (!has_slime(c->l))
        return api_refuse(c, 409, "the scene has no slime",
                          "add one, or open a scene that has a mesh with 'generate: slime'");
    if (preview >= 0)
        live_set_preview(toy, (live_preview)preview);
    if (what >= 0)
        live_give(toy, (live_order)what);
    return api_tell(c, live_tell(toy));
}

/* A hand's number; LIVE_ALL where there is none. */
static bool take_hand(call *c, bool needed, int *hand)
{
    double number = LIVE_ALL;
    if (!api_take_number(c, "hand", needed, &number))
        return false;
    const bool is_one = number == LIVE_ALL || (number >= 0 && number <= INT_MAX && number == floor(number));
    if (!is_one)
        api_refuse(c, 400, "'hand' is no hand's number", "give the number that /api/slime/grab answered");
    *hand = is_one ? (int)number : LIVE_ALL;
    return is_one;
}

static bool take_place(call *c, double *x, double *y)
{
    const double far = 1e6;
    if (!api_take_number(c, "x", true, x) || !api_take_number(c, "y", true, y))
        return false;
    const bool good = fabs(*x) <= far && fabs(*y) <= far;
    if (!good)
        api_refuse(c, 400, "the place is too far from the picture", "give pixels of the full picture");
    return good;
}

status api_grab(call *c)
{
    double x, y, reach = 0.0;
    if (!take_place(c, &x, &y) || !api_take_number(c, "reach", false, &reach))
        return STATUS_BAD_INPUT;
    if (reach < 0.0)
        return api_refuse(c, 400, "a hand cannot reach less than 0",
                          "give scene units; 0 or nothing: three tenths of the slime's radius");
    vec3 origin, direction, where;
    int hand = LIVE_MISSED;
    scene *now = scene_document_take(c->l->scene_document, NULL);
    if (!now)
        return out_of_memory(&c->why);
    lab_camera_ray(now, x, y, &origin, &direction);
    scene_destroy(now);
    c->refused = 409; /* what does not go together with what is there now is no fault of the request */
    const status code =
        live_grab(render_worker_live(c->l->render_worker), origin, direction, reach, &hand, &where, &c->why);
    if (code == STATUS_OK && hand == LIVE_MISSED)
        return api_refuse(c, 404, "there is no slime", "grab where the slime is seen");
    if (code == STATUS_OK)
        api_tell(c, json_pack("{s:i, s:[o, o, o]}", "hand", hand, "where", json_of_real(where.x), json_of_real(where.y),
                              json_of_real(where.z)));
    return code;
}

/* The way from a place to where the ray through the picture is as far from the camera, along its view, and depth
 * farther; never behind it. */
static vec3 way_to(const scene *s, double x, double y, double depth, vec3 where)
{
    const double nearest = 0.05;
    vec3 eye, direction, forward;
    lab_camera_ray(s, (double)scene_settings(s)->width / 2.0, (double)scene_settings(s)->height / 2.0, &eye, &forward);
    lab_camera_ray(s, x, y, &eye, &direction);
    const double away = vec3_dot(vec3_sub(where, eye), forward), along = fmax(away + depth, nearest * fabs(away));
    const vec3 there = vec3_add(eye, vec3_scale(direction, along / vec3_dot(direction, forward)));
    return vec3_sub(there, where);
}

status api_move_hand(call *c)
{
    double x, y, depth = 0.0;
    int hand;
    if (!take_hand(c, true, &hand) || !take_place(c, &x, &y) || !api_take_number(c, "depth", false, &depth))
        return STATUS_BAD_INPUT;
    live *toy = render_worker_live(c->l->render_worker);
    vec3 where;
    c->refused = 409;
    scene *now = scene_document_take(c->l->scene_document, NULL);
    status code = now ? live_where(toy, hand, &where, &c->why) : out_of_memory(&c->why);
    THEN(code, live_move(toy, hand, way_to(now, x, y, depth, where), &c->why));
    scene_destroy(now);
    api_tell(c, json_object());
    return code;
}

status api_release(call *c)
{
    int hand;
    if (!take_hand(c, false, &hand))
        return STATUS_BAD_INPUT;
    c->refused = 409;
    api_tell(c, json_object());
    return live_release(render_worker_live(c->l->render_worker), hand, &c->why);
}
