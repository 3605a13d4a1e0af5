/* API: the camera, as a view of the scene with a history of its own (/api/camera, /api/view). */
#include "web/api/api.h"
#include "scene/model/camera_moves.h"

#include <math.h>
#include <string.h>

static bool take_pair(call *c, const char *key, double pair[2])
{
    const json_t *angles = json_object_get(c->body, key);
    for (size_t i = 0; angles && i < 2; i++) {
        const json_t *item = json_array_get(angles, i);
        if (json_array_size(angles) != 2 || !json_is_number(item) || !(fabs(json_number_value(item)) <= 1e6)) {
            api_refuse(c, 400, "the camera needs two angles", "give [YAW, PITCH] in degrees, each -1e6..1e6");
            return false;
        }
        pair[i] = json_number_value(item);
    }
    return true;
}

static bool take_zoom(call *c, double *zoom)
{
    const double most = 1e6;
    if (!api_take_number(c, "zoom", false, zoom))
        return false;
    if (!json_object_get(c->body, "zoom") || (*zoom >= 1.0 / most && *zoom <= most))
        return true;
    api_refuse(c, 400, "'zoom' is out of range", "give a factor of the distance, 1e-6..1e6");
    return false;
}

status api_camera(call *c)
{
    camera_move move = {.zoom = 0.0};
    const char *gesture;
    uint64_t generation = 0;
    if (!take_pair(c, "orbit", move.orbit_deg) || !take_pair(c, "turn", move.turn_deg) || !take_zoom(c, &move.zoom) ||
        !api_take_vector(c, "step", false, move.step) || !api_take_text(c, "look", false, &move.look) ||
        !api_take_text(c, "frame", false, &move.frame) || !api_take_gesture(c, &gesture))
        return STATUS_BAD_INPUT;
    const status code = scene_document_move_view(c->l->scene_document, &move, gesture, &generation, &c->why);
    return api_changed(c, code, generation);
}

status api_view(call *c)
{
    static const char *const words[] = {
        [VIEW_BACK] = "back", [VIEW_FORWARD] = "forward", [VIEW_HOME] = "home", [VIEW_KEEP] = "keep"};
    const char *word = NULL;
    uint64_t generation = 0;
    if (!api_take_text(c, "do", true, &word))
        return STATUS_BAD_INPUT;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(words[i], word) == 0) {
            c->refused = 409;
            const status code = scene_document_view(c->l->scene_document, (view_command)i, &generation, &c->why);
            return api_changed(c, code, generation);
        }
    return api_refuse(c, 400, "'do' is not a command for views", "use back, forward, home or keep");
}
