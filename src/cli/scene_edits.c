/* The edits of `cuvette scene`: parsing of their values and application to the scene. */
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
    return diagnose(why, STATUS_BAD_INPUT, remedy, "'%.80s' does not have the form %s", text, edit->form);
}

static status apply_set(scene *s, const scene_edit *edit, const char *path, const char *value, diagnostic *why)
{
    (void)edit;
    return scene_put(s, path, value, why);
}

static status apply_move(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why)
{
    double v[3];
    TRY(options_reals(edit->option, text, edit->form, 3, v, why));
    return scene_move(s, name, vec3_make(v[0], v[1], v[2]), why);
}

static status apply_turn(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why)
{
    double v[3];
    TRY(options_reals(edit->option, text, edit->form, 3, v, why));
    return scene_turn(s, name, vec3_make(v[0], v[1], v[2]), why);
}

static status apply_scale(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why)
{
    double factor;
    TRY(options_reals(edit->option, text, edit->form, 1, &factor, why));
    return scene_scale(s, name, factor, why);
}

static status apply_rename(scene *s, const scene_edit *edit, const char *name, const char *new_name, diagnostic *why)
{
    (void)edit;
    return scene_rename(s, name, new_name, why);
}

static status apply_delete(scene *s, const scene_edit *edit, const char *none, const char *text, diagnostic *why)
{
    (void)edit, (void)none;
    return scene_remove(s, text, why);
}

static status apply_title(scene *s, const scene_edit *edit, const char *none, const char *text, diagnostic *why)
{
    (void)edit, (void)none;
    return scene_set_title(s, text, why);
}

/* Splits "a=1,b=2,3,c=4" at the first comma before "WORD=", so that the commas of vectors stay. Returns the start of
 * the next parameter, NULL at the end. */
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

/* Sets "size=1,2,3" of the new object. The material is set in a first pass (wants_material), the others after it. */
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
    TRY(scene_shape_named(shape, &kind, why));
    return scene_add_solid(s, name, kind, NULL, why);
}

static status add_object(scene *s, const char *kind, const char *name, const char *shape, diagnostic *why)
{
    static const char *const kinds[] = {"solid", "light", "beam", "material", "mesh", "texture"};
    const bool is_solid = strcmp(kind, "solid") == 0;
    if (is_solid && !shape)
        return diagnose(why, STATUS_BAD_INPUT, "write solid:NAME=SHAPE, such as solid:rod=box", "%.80s has no shape",
                        name);
    if (is_solid)
        return add_solid(s, name, shape, why);
    if (shape)
        return diagnose(why, STATUS_BAD_INPUT, "remove '=SHAPE'", "a %.20s has no shape", kind);
    static const param_group groups[] = {PARAM_SOLID,    PARAM_LIGHT, PARAM_BEAM,
                                         PARAM_MATERIAL, PARAM_MESH,  PARAM_TEXTURE};
    int which = 0;
    TRY(options_choice(NULL, "kind of object", kind, kinds, sizeof kinds / sizeof *kinds, &which, why));
    return scene_add(s, groups[which], name, NULL, why);
}

/* Splits "solid:rod=box,size=1,2,3" into its parts, adds the object and sets its parameters. */
static status apply_add(scene *s, const scene_edit *edit, const char *none, const char *text, diagnostic *why)
{
    (void)none;
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
    {"--add", 0, false, "KIND:NAME[=SHAPE][,PARAM=VALUE]...",
     "add a solid, light, beam, material, mesh or texture, such as solid:rod=box,size=0.25,3,0.25", apply_add},
    {"--set", 's', true, "PATH=VALUE",
     "set a parameter, or the material or shape of a solid (NAME.material, NAME.shape)", apply_set},
    {"--move", 0, true, "NAME=DX,DY,DZ",
     "move a solid, a light, the camera, or a group: all, solids, lights, or names joined by +, such as all+camera",
     apply_move},
    {"--turn", 0, true, "NAME=RX,RY,RZ",
     "rotate a solid or the camera about its position, or a group about the origin: about the world's x, then y, then "
     "z axis, in degrees",
     apply_turn},
    {"--scale", 0, true, "NAME=FACTOR",
     "scale a solid or a light about its position, or a group about the origin; scaling all solids adapts "
     "render.unit_m, so that lengths in metres do not change",
     apply_scale},
    {"--rename", 0, true, "OLD=NEW", "rename an object", apply_rename},
    {"--delete", 0, false, "NAME", "delete an object; camera, background and render return to their defaults",
     apply_delete},
    {"--title", 0, false, "TEXT", "set the title of the scene", apply_title},
};
const size_t scene_edit_count = sizeof scene_edits / sizeof *scene_edits;

static status apply_named(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    const char *equals = strchr(text, '=');
    char *name = equals ? strndup(text, (size_t)(equals - text)) : NULL;
    const status result = name     ? edit->apply(s, edit, name, equals + 1, why)
                          : equals ? out_of_memory(why)
                                   : malformed(edit, text, why);
    free(name);
    return result;
}

status scene_edit_apply(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    char where[512];
    const status result = edit->is_named ? apply_named(s, edit, text, why) : edit->apply(s, edit, NULL, text, why);
    snprintf(where, sizeof where, "%s %s", edit->option, text);
    return locate_failure(why, where, result);
}
