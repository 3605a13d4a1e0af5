/* What handlers have in common: reading bodies, answering changes, rays of the camera. See web/lab_private.h. */
#include "web/lab_private.h"
#include "base/text.h"
#include "scene/model/camera.h"
#include "scene/model/open.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool refuse(http_reply *r, const char *key, const char *form)
{
    char *what = text_format("'%s' is not given as %s", key, form);
    http_reply_error(r, 400, what ? what : "out of memory", form);
    free(what);
    return false;
}

/* Is there something to read? *good is the answer when there is not. */
static bool is_there(const json_t *body, const char *key, bool needed, const char *form, json_t **value, bool *good,
                     http_reply *r)
{
    *value = json_object_get(body, key);
    if (*value && !json_is_null(*value))
        return true;
    *good = needed ? refuse(r, key, form) : true;
    return false;
}

bool lab_take_number(const json_t *body, const char *key, bool needed, double *value, http_reply *r)
{
    json_t *given;
    bool good;
    if (!is_there(body, key, needed, "a number", &given, &good, r))
        return good;
    if (!json_is_number(given) || !isfinite(json_number_value(given)))
        return refuse(r, key, "a number");
    *value = json_number_value(given);
    return true;
}

bool lab_take_vector(const json_t *body, const char *key, bool needed, double value[3], http_reply *r)
{
    json_t *given;
    bool good;
    if (!is_there(body, key, needed, "a list of three numbers", &given, &good, r))
        return good;
    if (json_array_size(given) != 3)
        return refuse(r, key, "a list of three numbers");
    for (size_t i = 0; i < 3; i++) {
        const json_t *item = json_array_get(given, i);
        if (!json_is_number(item) || !isfinite(json_number_value(item)))
            return refuse(r, key, "a list of three numbers");
        value[i] = json_number_value(item);
    }
    return true;
}

bool lab_take_text(const json_t *body, const char *key, bool needed, const char **value, http_reply *r)
{
    json_t *given;
    bool good;
    if (!is_there(body, key, needed, "a text", &given, &good, r))
        return good;
    if (!json_is_string(given) || strlen(json_string_value(given)) != json_string_length(given))
        return refuse(r, key, "a text");
    *value = json_string_value(given);
    return true;
}

bool lab_take_flag(const json_t *body, const char *key, bool *value, http_reply *r)
{
    json_t *given;
    bool good;
    if (!is_there(body, key, false, "true or false", &given, &good, r))
        return good;
    if (!json_is_boolean(given))
        return refuse(r, key, "true or false");
    *value = json_is_true(given);
    return true;
}

bool lab_take_gesture(const json_t *body, const char **gesture, http_reply *r)
{
    enum { GESTURE_MAX = 64 };
    *gesture = NULL;
    if (!lab_take_text(body, "gesture", false, gesture, r))
        return false;
    return !*gesture || strlen(*gesture) <= GESTURE_MAX ? true
                                                        : refuse(r, "gesture", "a text of at most 64 characters");
}

void lab_reply_generation(http_reply *r, status code, uint64_t generation, const diagnostic *why)
{
    if (code == STATUS_OK)
        http_reply_json(r, 200, json_pack("{s:I}", "generation", (json_int_t)generation));
    else
        http_reply_diagnostic(r, code, why);
}

void lab_camera_ray(const scene *s, double x, double y, vec3 *origin, vec3 *direction)
{
    const camera_frame f = camera_frame_of(s);
    *origin = f.eye;
    *direction = camera_direction(&f, scene_settings(s), x, y);
}
