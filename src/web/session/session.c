/* Functions for all parts of a laboratory: events, names of scenes, default threads, camera rays. */
#include "web/session/session.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

#include <string.h>
#include <strings.h>

/* --- events --- */

void lab_publish(lab *l, const char *event, json_t *value)
{
    pthread_mutex_lock(&l->publish_lock);
    if (l->open && value)
        http_publish(l->server, event, value, NULL);
    pthread_mutex_unlock(&l->publish_lock);
    json_decref(value);
}

bool lab_is_open(lab *l)
{
    pthread_mutex_lock(&l->publish_lock);
    const bool open = l->open;
    pthread_mutex_unlock(&l->publish_lock);
    return open;
}

void lab_publish_state(lab *l)
{
    pthread_mutex_lock(&l->state_lock);
    if (lab_is_open(l))
        lab_publish(l, "state", l->state(l));
    pthread_mutex_unlock(&l->state_lock);
}

/* --- scenes --- */

bool lab_is_scene_name(const char *name)
{
    const char *ending = strrchr(name, '.');
    return ending && (strcasecmp(ending, ".yaml") == 0 || strcasecmp(ending, ".yml") == 0) && name[0] != '.' &&
           !strstr(name, "/.");
}

void lab_set_default_threads(const lab *l, scene *s)
{
    if (l->settings.threads > 0 && s->render.threads == 1)
        s->render.threads = l->settings.threads;
}

void lab_clear_default_threads(const lab *l, scene *s)
{
    if (s->render.threads == l->settings.threads)
        s->render.threads = 1;
}

void lab_camera_ray(const scene *s, double x, double y, vec3 *origin, vec3 *direction)
{
    const camera_frame f = camera_frame_of(s);
    const camera_ray chief = camera_chief_ray(&f, scene_settings(s), x, y);
    *origin = chief.origin;
    *direction = chief.direction;
}
