#include "study/definition_v1.h"
#include "base/hash.h"
#include "scene/model/params_path.h"
#include "scene/model/params_value.h"
#include "study/grid.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

/* The parameters of that program. Do not add to this list: everything else is newer. */
static const char *const names[PARAM_GROUP_COUNT] = {
    [PARAM_RENDER] = ("width height depth samples integrator lighting weights transmission beyond shadows min_weight "
                      "paths roulette seed polarisation spectrum wavelengths lambda_nm unit_m threads pool schedule "
                      "tile pin accel build_threads keep rebuild texturing"),
    [PARAM_CAMERA] = "position target yaw_deg pitch_deg fov_deg",
    [PARAM_BACKGROUND] = "kind color horizon picture ambient ior medium absorb_per_m",
    [PARAM_MESH] = ("generate file count level major minor around tube profile crease_deg size depth seed time_s "
                    "script radius position velocity mass_kg stiffness bending through damping pressure gravity "
                    "ground ground_y restitution friction integrator dt_s adaptive threads"),
    [PARAM_TEXTURE] = "file filter wrap_u wrap_v space",
    [PARAM_LIGHT] = "kind position target half_angle_deg color intensity radius reach",
    [PARAM_MATERIAL] = ("color ambient diffuse specular shininess reflectivity transparency ior medium coefficients "
                        "absorb_per_m absorb_spectrum texture texture_size checker checker_color"),
    [PARAM_SOLID] = "position rotation priority visible",
};

/* Its shapes by number, and their additional parameters. */
static const struct {
    const char *word, *names;
} shapes[] = {
    {"plane", ""},
    {"cylinder", "radius height m"},
    {"cup", "radius height inner_radius floor"},
    {"box", "size"},
    {"sphere", "radius"},
    {"mesh", "mesh scale copies spacing shading"},
};

typedef struct visit_state {
    const scene *of;
    uint64_t hash;
    bool later; /* a newer parameter is not at its default */
} visit_state;

static bool is_word_of(const char *word, const char *words)
{
    const size_t length = strlen(word);
    for (const char *at = words; (at = strstr(at, word)); at += length)
        if ((at == words || at[-1] == ' ') && (at[length] == 0 || at[length] == ' '))
            return true;
    return false;
}

/* The number of the shape in that version, or -1. */
static int shape_number(const solid *of)
{
    for (int i = 0; i < (int)(sizeof shapes / sizeof *shapes); i++)
        if (strcmp(shapes[i].word, shape_name(of->shape.kind)) == 0)
            return i;
    return -1;
}

static bool was_there(const scene *of, const char *path, const param *row)
{
    if (is_word_of(row->name, names[row->group]))
        return true;
    if (row->group != PARAM_SOLID)
        return false;
    for (size_t i = 0; i < of->solid_count; i++) {
        const size_t length = strlen(of->solids[i].name);
        if (strncmp(path, of->solids[i].name, length) == 0 && path[length] == '.') {
            const int number = shape_number(&of->solids[i]);
            return number >= 0 && is_word_of(row->name, shapes[number].names);
        }
    }
    return false;
}

/* What a parameter that version 1 did not have must be for the same frames. Its tiles had the size render.tile. */
static status check_default(const param *row, const char *value, bool *other)
{
    if (row->group == PARAM_RENDER && strcmp(row->name, "pieces") == 0 && strcmp(value, "0") == 0)
        return STATUS_OK;
    char *usual = param_default_text(row);
    if (!usual)
        return STATUS_FAILURE;
    *other |= strcmp(usual, value) != 0;
    free(usual);
    return STATUS_OK;
}

static void hash_integer(uint64_t *hash, int64_t value)
{
    *hash = hash_words(*hash, &value, 1);
}

static status hash_param(void *context, const char *path, const param *row, const char *value)
{
    visit_state *state = context;
    if (!was_there(state->of, path, row))
        return check_default(row, value, &state->later);
    grid_hash_text(&state->hash, path);
    grid_hash_text(&state->hash, value);
    return STATUS_OK;
}

static void hash_axis(uint64_t *hash, const study_axis *axis)
{
    hash_integer(hash, (int64_t)axis->count);
    for (size_t i = 0; i < axis->count; i++)
        grid_hash_point(hash, &axis->points[i]);
}

status definition_v1(const study *s, bool *is, uint64_t *hash, diagnostic *why)
{
    visit_state state = {.of = s->base, .hash = HASH_START};
    *is = false;
    grid_hash_text(&state.hash, s->name);
    if (scene_each_param(s->base, hash_param, &state) != STATUS_OK)
        return out_of_memory(why);
    if (state.later)
        return STATUS_OK;
    hash_integer(&state.hash, s->base->camera.aimed);
    for (size_t i = 0; i < s->base->solid_count; i++) {
        const int number = shape_number(&s->base->solids[i]);
        if (number < 0)
            return STATUS_OK;
        hash_integer(&state.hash, number);
        hash_integer(&state.hash, s->base->solids[i].material_index);
    }
    TRY(grid_hash_files(&state.hash, s->base, why));
    for (size_t axis = 0; axis < s->axis_count; axis++)
        hash_axis(&state.hash, &s->axes[axis]);
    *hash = hash_finish(state.hash);
    *is = true;
    return STATUS_OK;
}
