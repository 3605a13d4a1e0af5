/* The times of an animation's frames. */
#include "scene/motion/frame_times.h"

#include "scene/model/scene.h"
#include "scene/model/slime.h"
#include "scene/motion/script.h"
#include <math.h>

int64_t frame_times_count(const frame_times *t)
{
    return (int64_t)fmax(1, round(t->duration_s * (double)t->fps_num / (double)t->fps_den));
}

double frame_times_at(const frame_times *t, int64_t frame)
{
    return t->start_s + (double)(frame * t->fps_den) / (double)t->fps_num;
}

/* *end_s: the latest key time of all scripts of the scene's slimes; *any: whether any slime has a script. */
static status find_script_end(const scene *s, bool *any, double *end_s, diagnostic *why)
{
    *any = false;
    *end_s = 0;
    status result = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && result == STATUS_OK; i++) {
        hand_script *script = NULL;
        if (s->meshes[i].source == MESH_SLIME)
            result = slime_read_script(s, &s->meshes[i], &script, why);
        if (script) {
            *any = true;
            *end_s = fmax(*end_s, hand_script_end_s(script));
        }
        hand_script_destroy(script);
    }
    return result;
}

status frame_times_choose(frame_times *t, const scene *s, diagnostic *why)
{
    const double rest_s = 2, without_script_s = 4;
    bool any;
    double end_s;
    TRY(find_script_end(s, &any, &end_s, why));
    if (t->duration_s < 0)
        t->duration_s = any ? fmax(0, end_s + rest_s - t->start_s) : without_script_s;
    return STATUS_OK;
}

status frame_times_check_end(const frame_times *t, const scene *s, diagnostic *why)
{
    status result = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && result == STATUS_OK; i++)
        if (s->meshes[i].source == MESH_SLIME)
            result = slime_check_end(&s->meshes[i], t->start_s + t->duration_s, why);
    return result;
}
