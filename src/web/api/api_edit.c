/* Objects come, go, move, turn and change their names: POST and DELETE under /api/objects. How new ones look is in
 * new_objects.c. */
#include "web/lab_private.h"
#include "web/session/desk_bounds.h"
#include "scene/model/place/new_objects.h"
#include "scene/model/check.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params_path.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct edit {
    const char *name;   /* of the object; NULL for a new one */
    bool or_camera;     /* it may be the camera, or many objects, too */
    const char *word;   /* its new name; its material, NULL for none; the kind of a new one */
    const char *wanted; /* name of a new one; NULL: any */
    const char *file;   /* of a new one, as the folder names it */
    const folder *files;
    const scene *loaded; /* of a model */
    shape_kind shape;
    vec3 by;
    double factor;
    object_name made; /* what came is called that; "" for nothing */
    int refused;      /* what to answer rather than 400: 404, 409; 0 */
    status (*act)(struct edit *e, scene *s, diagnostic *why);
} edit;

static status change(void *context, scene *s, diagnostic *why)
{
    edit *e = context;
    place at;
    scene_parts parts;
    if (e->or_camera && scene_parts_named(s, e->name, &parts))
        return e->act(e, s, why);
    if (e->name && place_find_object(s, e->name, &at, why) != STATUS_OK) {
        e->refused = 404;
        return STATUS_BAD_INPUT;
    }
    const bool is_one = !e->name || at.group >= PARAM_MESH || (e->or_camera && at.group == PARAM_CAMERA);
    return is_one ? e->act(e, s, why)
                  : diagnose(why, STATUS_BAD_INPUT, "name a solid, a light, a material, a mesh or a texture",
                             "that cannot be done with the %.60s", e->name);
}

/* verb: with the object's name after it, for undo. Answers the generation, and the name of what came. */
static void answer(lab *l, edit *e, const char *verb, const char *name, const char *gesture, http_reply *r)
{
    diagnostic why = {.what = ""};
    uint64_t generation = 0;
    char words[128];
    snprintf(words, sizeof words, "%s %.80s", verb, name);
    const status code = desk_apply(l->desk, words, gesture, change, e, &generation, &why);
    if (code == STATUS_OK && e->made[0])
        http_reply_json(r, 200, json_pack("{s:I, s:s}", "generation", (json_int_t)generation, "name", e->made));
    else if (code == STATUS_BAD_INPUT && e->refused)
        http_reply_error(r, e->refused, why.what, why.remedy);
    else
        lab_reply_generation(r, code, generation, &why);
}

/* --- what is there --- */

static status remove_it(edit *e, scene *s, diagnostic *why)
{
    const status code = scene_remove(s, e->name, why);
    e->refused = code == STATUS_OK ? 0 : 409;
    return code;
}

static void remove_object(void *context, const http_request *q, http_reply *r)
{
    edit e = {.name = http_path_value(q, "name"), .act = remove_it};
    answer(context, &e, "remove", e.name, NULL, r);
}

static status move_it(edit *e, scene *s, diagnostic *why)
{
    return scene_move(s, e->name, e->by, why);
}

static status turn_it(edit *e, scene *s, diagnostic *why)
{
    return scene_turn(s, e->name, e->by, why);
}

static void displace(lab *l, const http_request *q, http_reply *r, edit *e, const char *verb)
{
    json_t *body = http_body_json(q, r);
    double by[3];
    const char *gesture = NULL;
    if (body && lab_take_vector(body, "by", true, by, r) && lab_take_gesture(body, &gesture, r)) {
        e->by = vec3_make(by[0], by[1], by[2]);
        answer(l, e, verb, e->name, gesture, r);
    }
    json_decref(body);
}

static void move_object(void *context, const http_request *q, http_reply *r)
{
    displace(context, q, r, &(edit){.name = http_path_value(q, "name"), .or_camera = true, .act = move_it}, "move");
}

static void turn_object(void *context, const http_request *q, http_reply *r)
{
    displace(context, q, r, &(edit){.name = http_path_value(q, "name"), .or_camera = true, .act = turn_it}, "turn");
}

static status scale_it(edit *e, scene *s, diagnostic *why)
{
    return scene_scale(s, e->name, e->factor, why);
}

static void scale_object(void *context, const http_request *q, http_reply *r)
{
    json_t *body = http_body_json(q, r);
    edit e = {.name = http_path_value(q, "name"), .or_camera = true, .act = scale_it};
    const char *gesture = NULL;
    if (body && !json_is_number(json_object_get(body, "factor")))
        http_reply_error(r, 400, "'factor' is no number", "give a factor above 0");
    else if (body && lab_take_gesture(body, &gesture, r)) {
        e.factor = json_number_value(json_object_get(body, "factor"));
        answer(context, &e, "scale", e.name, gesture, r);
    }
    json_decref(body);
}

static status rename_it(edit *e, scene *s, diagnostic *why)
{
    const bool taken = strcmp(e->name, e->word) != 0 && check_name_is_free(s, e->word, NULL) != STATUS_OK;
    const status code = scene_rename(s, e->name, e->word, why);
    e->refused = code != STATUS_OK && taken ? 409 : 0;
    return code;
}

static void rename_object(void *context, const http_request *q, http_reply *r)
{
    json_t *body = http_body_json(q, r);
    edit e = {.name = http_path_value(q, "name"), .act = rename_it};
    if (body && lab_take_text(body, "to", true, &e.word, r))
        answer(context, &e, "rename", e.name, NULL, r);
    json_decref(body);
}

/* A solid that loses its material looks as before, for itself alone: the defaults would be black. */
static status give_material(edit *e, scene *s, diagnostic *why)
{
    const int index = scene_find_solid(s, e->name);
    if (e->word || index < 0)
        return scene_give_material(s, e->name, e->word, why);
    s->solids[index].material_index = -1;
    return STATUS_OK;
}

static void change_material(void *context, const http_request *q, http_reply *r)
{
    json_t *body = http_body_json(q, r);
    edit e = {.name = http_path_value(q, "name"), .act = give_material};
    if (body && (json_is_null(json_object_get(body, "material")) || lab_take_text(body, "material", true, &e.word, r)))
        answer(context, &e, e.word ? "give a material to" : "take the material of", e.name, NULL, r);
    json_decref(body);
}

static status copy_it(edit *e, scene *s, diagnostic *why)
{
    return new_copy(s, e->name, e->made, why);
}

static void copy_object(void *context, const http_request *q, http_reply *r)
{
    edit e = {.name = http_path_value(q, "name"), .act = copy_it};
    answer(context, &e, "copy", e.name, NULL, r);
}

/* --- what is new --- */

static status add_solid(edit *e, scene *s, diagnostic *why)
{
    return new_solid(s, e->shape, e->wanted, e->made, why);
}

static status add_light(edit *e, scene *s, diagnostic *why)
{
    return new_light(s, e->wanted, e->made, why);
}

static status add_material(edit *e, scene *s, diagnostic *why)
{
    return new_material(s, e->wanted, e->made, why);
}

static status add_slime(edit *e, scene *s, diagnostic *why)
{
    return new_slime(s, e->wanted, e->made, why);
}

static status add_texture(edit *e, scene *s, diagnostic *why)
{
    char *path;
    status code = folder_path_from(e->files, e->file, s->path, &path, why);
    if (code == STATUS_OK)
        code = new_texture(s, path, e->wanted, e->made, why);
    free(path);
    return code;
}

static status add_model(edit *e, scene *s, diagnostic *why)
{
    char *path;
    status code = folder_path_from(e->files, e->file, s->path, &path, why);
    if (code == STATUS_OK)
        code = new_model(s, e->loaded, path, e->wanted, e->made, why);
    free(path);
    return code;
}

static status add_object(edit *e, scene *s, diagnostic *why)
{
    static const struct {
        const char *word;
        status (*add)(edit *e, scene *s, diagnostic *why);
    } kinds[] = {
        {"solid", add_solid}, {"light", add_light},     {"material", add_material},
        {"slime", add_slime}, {"texture", add_texture}, {"model", add_model},
    };
    if (e->wanted && check_name_is_free(s, e->wanted, why) != STATUS_OK) {
        e->refused = 409;
        return STATUS_BAD_INPUT;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(e->word, kinds[i].word) == 0)
            return kinds[i].add(e, s, why);
    return diagnose(why, STATUS_BAD_INPUT, "the kinds are solid, light, material, model, slime and texture",
                    "no kind '%.60s'", e->word);
}

/* A scene of nothing but that model or picture, which can then be read. It takes its time, and the desk is not held up
 * by it. */
static status load_alone(lab *l, const char *file, bool is_model, scene **out, diagnostic *why)
{
    char *path = NULL;
    status code = folder_path(l->files, file, true, &path, why);
    scene *s = code == STATUS_OK ? scene_create() : NULL;
    if (code == STATUS_OK && !s)
        code = out_of_memory(why);
    if (code == STATUS_OK)
        code = is_model ? scene_add_mesh(s, "model", NULL, why) : scene_add_texture(s, "picture", NULL, why);
    if (code == STATUS_OK)
        code = scene_set(s, is_model ? "model.file" : "picture.file", path, why);
    if (code == STATUS_OK)
        code = desk_limit(s, l->files, why);
    if (code == STATUS_OK)
        code = scene_load(s, why);
    free(path);
    if (code == STATUS_OK)
        *out = s;
    else
        scene_destroy(s);
    return code;
}

static bool take_new(lab *l, const json_t *body, edit *e, scene **loaded, http_reply *r)
{
    const char *shape = NULL;
    if (!lab_take_text(body, "kind", true, &e->word, r) || !lab_take_text(body, "name", false, &e->wanted, r))
        return false;
    const bool is_model = strcmp(e->word, "model") == 0, is_texture = strcmp(e->word, "texture") == 0,
               is_solid = strcmp(e->word, "solid") == 0;
    if (!lab_take_text(body, "shape", is_solid, &shape, r) ||
        !lab_take_text(body, "file", is_model || is_texture, &e->file, r))
        return false;
    diagnostic why = {.what = ""};
    status code = is_solid ? scene_shape_named(shape, &e->shape, &why) : STATUS_OK;
    if ((is_model || is_texture) && (code = gate_enter(l->heavy, &why)) == STATUS_OK) {
        code = load_alone(l, e->file, is_model, loaded, &why);
        gate_leave(l->heavy);
    }
    if (code != STATUS_OK)
        http_reply_diagnostic(r, code, &why);
    return code == STATUS_OK;
}

static void add(void *context, const http_request *q, http_reply *r)
{
    lab *l = context;
    json_t *body = http_body_json(q, r);
    edit e = {.act = add_object, .files = l->files};
    scene *loaded = NULL;
    if (body && take_new(l, body, &e, &loaded, r)) {
        e.loaded = loaded;
        answer(l, &e, "add",
               e.wanted                       ? e.wanted
               : strcmp(e.word, "solid") == 0 ? shape_name(e.shape)
                                              : e.word,
               NULL, r);
    }
    scene_destroy(loaded);
    json_decref(body);
}

static const http_route routes[] = {
    {"POST", "/api/objects", add, NULL},
    {"DELETE", "/api/objects/{name}", remove_object, NULL},
    {"POST", "/api/objects/{name}/move", move_object, NULL},
    {"POST", "/api/objects/{name}/turn", turn_object, NULL},
    {"POST", "/api/objects/{name}/scale", scale_object, NULL},
    {"POST", "/api/objects/{name}/rename", rename_object, NULL},
    {"POST", "/api/objects/{name}/material", change_material, NULL},
    {"POST", "/api/objects/{name}/copy", copy_object, NULL},
};
const lab_routes edit_routes = {routes, sizeof routes / sizeof *routes};
