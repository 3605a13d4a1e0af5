#include "cli/scene_edits.h"
#include "cli/options.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/material.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static status malformed(const scene_edit *edit, const char *text, diagnostic *why)
{
    char remedy[96];
    snprintf(remedy, sizeof remedy, "write %s %s", edit->option, edit->form);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "'%.80s' is not of the form %s", text, edit->form);
}

/* What stands before the '=' in fresh memory, and where the rest begins; NULL when there is no '='. */
static char *left_of_equals(const char *text, const char **rest)
{
    const char *equals = strchr(text, '=');
    *rest = equals ? equals + 1 : NULL;
    return equals ? strndup(text, (size_t)(equals - text)) : NULL;
}

static status apply_set(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    const char *value;
    char *path = left_of_equals(text, &value);
    if (!path)
        return malformed(edit, text, why);
    status result = scene_put(s, path, value, why);
    free(path);
    return result;
}

static status apply_vector(scene *s, const scene_edit *edit, const char *text, diagnostic *why,
                           status (*change)(scene *, const char *, vec3, diagnostic *))
{
    const char *value;
    char *name = left_of_equals(text, &value);
    double v[3];
    if (!name)
        return malformed(edit, text, why);
    status result = options_reals(edit->option, value, edit->form, 3, v, why);
    if (result == STATUS_OK)
        result = change(s, name, vec3_make(v[0], v[1], v[2]), why);
    free(name);
    return result;
}

static status apply_move(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    return apply_vector(s, edit, text, why, scene_move);
}

static status apply_turn(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    return apply_vector(s, edit, text, why, scene_turn);
}

static status apply_scale(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    const char *value;
    char *name = left_of_equals(text, &value);
    double factor;
    if (!name)
        return malformed(edit, text, why);
    status result = options_reals(edit->option, value, edit->form, 1, &factor, why);
    if (result == STATUS_OK)
        result = scene_scale(s, name, factor, why);
    free(name);
    return result;
}

static status apply_rename(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    const char *new_name;
    char *name = left_of_equals(text, &new_name);
    if (!name)
        return malformed(edit, text, why);
    status result = scene_rename(s, name, new_name, why);
    free(name);
    return result;
}

static status apply_delete(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    (void)edit;
    return scene_remove(s, text, why);
}

static status apply_title(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    (void)edit;
    return scene_set_title(s, text, why);
}

/* Cuts "a=1,b=2,3,c=4" where a comma is followed by "WORD=": the commas of vectors stay. Returns where the next
 * parameter begins, NULL at the end. */
static char *cut_parameter(char *text)
{
    for (char *comma = strchr(text, ','); comma; comma = strchr(comma + 1, ',')) {
        const size_t word = strspn(comma + 1, "abcdefghijklmnopqrstuvwxyz_");
        if (word > 0 && comma[1 + word] == '=') {
            *comma = 0;
            return comma + 1;
        }
    }
    return NULL;
}

/* "size=1,2,3" of the new object, if it is the material's name, which is to come first, or else if it is not. */
static status put_parameter(scene *s, const char *name, char *parameter, bool wants_material, diagnostic *why)
{
    char *equals = strchr(parameter, '='), path[2 * SCENE_NAME_MAX];
    const size_t length = equals ? (size_t)(equals - parameter) : strlen(parameter);
    const bool names_material = length == strlen("material") && strncmp(parameter, "material", length) == 0;
    if (names_material != wants_material)
        return STATUS_OK;
    if (!equals)
        return diagnose(why, STATUS_BAD_INPUT, "write PARAMETER=VALUE after each comma", "'%.80s' has no value",
                        parameter);
    snprintf(path, sizeof path, "%s.%.*s", name, (int)(length < SCENE_NAME_MAX ? length : SCENE_NAME_MAX), parameter);
    return scene_put(s, path, equals + 1, why);
}

static status put_parameters(scene *s, const char *name, const char *text, bool wants_material, diagnostic *why)
{
    char *copy = strdup(text);
    status result = copy ? STATUS_OK : out_of_memory(why);
    for (char *next, *at = copy; at && result == STATUS_OK; at = next) {
        next = cut_parameter(at);
        result = put_parameter(s, name, at, wants_material, why);
    }
    free(copy);
    return result;
}

static status add_solid(scene *s, const char *name, const char *shape, diagnostic *why)
{
    shape_kind kind;
    status result = scene_shape_named(shape, &kind, why);
    return result == STATUS_OK ? scene_add_solid(s, name, kind, NULL, why) : result;
}

static status add_object(scene *s, const char *kind, const char *name, const char *shape, diagnostic *why)
{
    static const char *const kinds[] = {"solid", "light", "material", "mesh", "texture"};
    const bool is_solid = strcmp(kind, "solid") == 0;
    if (is_solid && !shape)
        return diagnose(why, STATUS_BAD_INPUT, "write solid:NAME=SHAPE, as solid:rod=box", "%.80s has no shape", name);
    if (is_solid)
        return add_solid(s, name, shape, why);
    if (shape)
        return diagnose(why, STATUS_BAD_INPUT, "leave it out", "a %.20s has no shape", kind);
    status (*const adders[])(scene *, const char *, size_t *, diagnostic *) = {
        NULL, scene_add_light, scene_add_material, scene_add_mesh, scene_add_texture};
    for (size_t i = 1; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(kind, kinds[i]) == 0)
            return adders[i](s, name, NULL, why);
    return options_unknown_word("kind of object", kind, kinds, sizeof kinds / sizeof *kinds, why);
}

/* Cuts "solid:rod=box,size=1,2,3" into its parts. */
static status apply_add(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    char *copy = strdup(text);
    if (!copy)
        return out_of_memory(why);
    char *colon = strchr(copy, ':'), *comma = strchr(copy, ',');
    if (comma)
        *comma = 0;
    char *equals = colon ? strchr(colon, '=') : NULL;
    status result;
    if (!colon || (comma && colon > comma)) {
        result = malformed(edit, text, why);
    } else {
        *colon = 0;
        if (equals)
            *equals = 0;
        result = add_object(s, copy, colon + 1, equals ? equals + 1 : NULL, why);
    }
    for (int pass = 0; pass < 2 && comma && result == STATUS_OK; pass++)
        result = put_parameters(s, colon + 1, comma + 1, pass == 0, why);
    free(copy);
    return result;
}

const scene_edit scene_edits[] = {
    {"--add", 0x200, "KIND:NAME[=SHAPE][,PARAM=VALUE]...",
     "add a solid, light, material, mesh or texture, as solid:rod=box,size=0.25,3,0.25", apply_add},
    {"--set", 's', "PATH=VALUE", "set a parameter, or NAME.material and NAME.shape of a solid", apply_set},
    {"--move", 0x201, "NAME=DX,DY,DZ",
     "move a solid, a light, the camera; all, solids, lights, or words joined by +, as all+camera", apply_move},
    {"--turn", 0x202, "NAME=RX,RY,RZ",
     "turn a solid or the camera, where it stands, or all and so on, about the origin: about the world's x, then y, "
     "then z axis, in degrees",
     apply_turn},
    {"--scale", 0x206, "NAME=FACTOR",
     "scale a solid or a light, where it stands, or all and so on, about the origin; with all solids, lengths in "
     "metres stay (render.unit_m)",
     apply_scale},
    {"--rename", 0x203, "OLD=NEW", "give an object another name", apply_rename},
    {"--delete", 0x204, "NAME", "take an object away; camera, background and render go back to their defaults",
     apply_delete},
    {"--title", 0x205, "TEXT", "give the scene another title", apply_title},
};
const size_t scene_edit_count = sizeof scene_edits / sizeof *scene_edits;

status scene_edit_apply(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    status result = edit->apply(s, edit, text, why);
    if (result != STATUS_OK) {
        char where[512];
        snprintf(where, sizeof where, "%s %s", edit->option, text);
        diagnostic_locate(why, where, 0, 0);
    }
    return result;
}
