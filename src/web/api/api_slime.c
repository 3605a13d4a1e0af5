/* API: the live slime: play, pause, and hands that drag it through the image. */
#include "web/api/api.h"

#include "report/json.h"
#include "scene/motion/motion.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include <limits.h>
#include <math.h>
#include <string.h>

/* Reads one of the words as its index; -1 where the key is missing. */
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
        api_refuse(c, 400, "unknown word", remedy);
    return !word || *index >= 0;
}

static bool has_slime(lab *l)
{
    scene *current = scene_document_take(l->scene_document, NULL);
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
    if (!take_word(c, "do", orders, "use play, pause, restart or off for 'do'", &what) ||
        !take_word(c, "preview", previews, "use traced or zbuffer for 'preview'", &preview))
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

/* Reads the number of a hand; LIVE_ALL where it is missing. */
static bool take_hand(call *c, bool needed, int *hand)
{
    double number = LIVE_ALL;
    if (!api_take_number(c, "hand", needed, &number))
        return false;
    const bool is_one = number == LIVE_ALL || (number >= 0 && number <= INT_MAX && number == floor(number));
    if (!is_one)
        api_refuse(c, 400, "'hand' is not the number of a hand", "give the number that /api/slime/grab returned");
    *hand = is_one ? (int)number : LIVE_ALL;
    return is_one;
}

static bool take_point(call *c, double *x, double *y)
{
    const double limit = 1e6;
    if (!api_take_number(c, "x", true, x) || !api_take_number(c, "y", true, y))
        return false;
    const bool good = fabs(*x) <= limit && fabs(*y) <= limit;
    if (!good)
        api_refuse(c, 400, "the point is too far outside the image", "give x and y in pixels of the full image");
    return good;
}

status api_grab(call *c)
{
    double x, y, reach = 0.0;
    if (!take_point(c, &x, &y) || !api_take_number(c, "reach", false, &reach))
        return STATUS_BAD_INPUT;
    if (reach < 0.0)
        return api_refuse(c, 400, "'reach' is below 0", "give scene units; 0 or omitted: 0.3 of the slime's radius");
    vec3 origin, direction, where;
    int hand = LIVE_MISSED;
    scene *current = scene_document_take(c->l->scene_document, NULL);
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
    const double nearest_share = 0.05;
    vec3 eye, direction, forward;
    lab_camera_ray(s, (double)scene_settings(s)->width / 2.0, (double)scene_settings(s)->height / 2.0, &eye, &forward);
    lab_camera_ray(s, x, y, &eye, &direction);
    const double depth_at_grab = vec3_dot(vec3_sub(where, eye), forward),
                 new_depth = fmax(depth_at_grab + depth, nearest_share * fabs(depth_at_grab));
    const vec3 target = vec3_add(eye, vec3_scale(direction, new_depth / vec3_dot(direction, forward)));
    return vec3_sub(target, where);
}

status api_move_hand(call *c)
{
    double x, y, depth = 0.0;
    int hand;
    if (!take_hand(c, true, &hand) || !take_point(c, &x, &y) || !api_take_number(c, "depth", false, &depth))
        return STATUS_BAD_INPUT;
    live *live_slime = render_worker_live(c->l->render_worker);
    vec3 where;
    c->refused = 409;
    scene *current = scene_document_take(c->l->scene_document, NULL);
    status code = current ? live_where(live_slime, hand, &where, &c->why) : out_of_memory(&c->why);
    THEN(code, live_move(live_slime, hand, hand_offset(current, x, y, depth, where), &c->why));
    scene_destroy(current);
    api_reply_json(c, json_object());
    return code;
}

status api_release(call *c)
{
    int hand;
    if (!take_hand(c, false, &hand))
        return STATUS_BAD_INPUT;
    c->refused = 409;
    api_reply_json(c, json_object());
    return live_release(render_worker_live(c->l->render_worker), hand, &c->why);
}
