/* The definition of an animation, which distinguishes its frames from those of other animations. */
#include "cli/animate.h"
#include "base/hash.h"
#include "base/number.h"
#include "report/json.h"
<<<<<<< /work/s/src/cli/animate_definition.c
#include "scene/model/params.h"
#include "scene/assets/slime.h"
#include "study/plan/grid.h"
=======
#include "scene/model/params_path.h"
#include "scene/model/slime.h"
#include "study/plan/identity.h"
>>>>>>> /tmp/q6/n
#include "scene/model/scene.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

static bool is_time_of_slime(const param *row)
{
    return row->group == PARAM_MESH && strcmp(row->name, "time_s") == 0;
}

typedef struct visit_state {
    const scene *of;
    json_t *into;
} visit_state;

/* Skips what no film depends on, but not how the film is shown; beams that light nothing; time_s of slimes, which the
 * frame sets; and file names: only contents count, so that a folder may be moved. */
static status add_param(void *context, const char *path, const param *row, const char *value)
{
    const visit_state *state = context;
    const bool dark_beam = row->group == PARAM_BEAM && strcmp(row->name, "lights") == 0 && strcmp(value, "off") == 0;
    if ((!scene_film_depends_on(state->of, path) && row->group != PARAM_CAMERA) || dark_beam ||
        row->type == PARAM_PATH || is_time_of_slime(row))
        return STATUS_OK;
    json_object_del(state->into, path); /* so that the last assignment is the last entry */
    return json_object_set_new(state->into, path, json_of_text(value)) == 0 ? STATUS_OK : STATUS_FAILURE;
}

static bool add_request(json_t *parameters, const animate_request *request)
{
    char fps[64], start[NUMBER_TEXT_MAX];
    snprintf(fps, sizeof fps, "%" PRId64 "/%" PRId64, request->times.fps_num, request->times.fps_den);
    return json_object_set_new(parameters, "--fps", json_string(fps)) == 0 &&
           json_object_set_new(parameters, "--start", json_string(number_format(request->times.start_s, start))) == 0;
}

static void hash_parameters(uint64_t *hash, json_t *parameters)
{
    const char *path;
    json_t *value;
    json_object_foreach(parameters, path, value)
    {
        const char *text = json_string_value(value);
        *hash = hash_bytes(*hash, path, strlen(path) + 1);
        *hash = hash_bytes(*hash, text, strlen(text) + 1);
    }
}

/* Hashes shape and material of each solid, which are not parameters. */
static void hash_solids(uint64_t *hash, const scene *s)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const int64_t words[] = {s->solids[i].shape.kind, s->solids[i].material_index};
        *hash = hash_words(*hash, words, 2);
    }
}

status animate_define(const animate_request *request, const scene *s, animate_definition *out, diagnostic *why)
{
    *out = (animate_definition){.parameters = json_object(), .hash = HASH_START};
    visit_state state = {s, out->parameters};
    if (!out->parameters || !add_request(out->parameters, request) ||
        scene_each_param(s, add_param, &state) != STATUS_OK)
        return out_of_memory(why);
    hash_parameters(&out->hash, out->parameters);
    hash_solids(&out->hash, s);
    TRY(identity_hash_files(&out->hash, s, why));
    out->hash = hash_finish(out->hash);
    return STATUS_OK;
}

void animate_definition_release(animate_definition *d)
{
    json_decref(d->parameters);
    *d = (animate_definition){0};
}
