/* Objects come, go, move, turn and change their names: POST and DELETE under /api/objects. How new ones look is in
 * new_objects.c. */
#include "web/api/api.h"
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
    status (*displace)(scene *s, const char *name, vec3 by, diagnostic *why);
    vec3 by;
    double factor;
    object_name made; /* what came is called that; "" for nothing */
    int refused;      /* what to answer rather than 400: 404, 409; 0 */
    status (*act)(struct edit *e, scene *s, diagnostic *why);
} edit;

static status change(void *context, scene *s, diagnostic *why)
{
    edit *e = context;
    param_place at;
    scene_parts parts;
    if (e->or_camera && scene_parts_named(s, e->name, &parts))
        return e->act(e, s, why);
    if (e->name && param_place_find_object(s, e->name, &at, why) != STATUS_OK) {
        e->refused = 404;
        return STATUS_BAD_INPUT;
    }
    const bool is_one = !e->name || at.object_group >= PARAM_MESH || (e->or_camera && at.object_group == PARAM_CAMERA);
    return is_one ? e->act(e, s, why)
                  : diagnose(why, STATUS_BAD_INPUT, "name a solid, a light, a material, a mesh or a texture",
                             "that cannot be done with the %.60s", e->name);
}

/* verb: with the object's name after it, for undo. Answers the generation, and the name of what came. */
static status apply(call *c, edit *e, const char *verb, const char *name, const char *gesture)
{
    uint64_t generation = 0;
    char words[128];
    snprintf(words, sizeof words, "%s %.80s", verb, name);
    const status code = scene_document_apply(c->l->scene_document, words, gesture, change, e, &generation, &c->why);
    c->refused = e->refused;
    if (code == STATUS_OK && e->made[0])
        return api_tell(c, json_pack("{s:I, s:s}", "generation", (json_int_t)generation, "name", e->made));
    return api_changed(c, code, generation);
}

static status apply_to(call *c, edit e, const char *verb, const char *gesture)
{
    e.name = http_path_value(c->request, "name");
    return apply(c, &e, verb, e.name, gesture);
}

/* --- what is there --- */

static status remove_it(edit *e, scene *s, diagnostic *why)
{
    const status code = scene_remove(s, e->name, why);
    e->refused = code == STATUS_OK ? 0 : 409;
    return code;
}

status api_remove(call *c)
{
    return apply_to(c, (edit){.act = remove_it}, "remove", NULL);
}

static status displace_it(edit *e, scene *s, diagnostic *why)
{
    return e->displace(s, e->name, e->by, why);
}

static status displace(call *c, edit e, const char *verb)
{
    e.or_camera = true;
    e.act = displace_it;
    double by[3];
    const char *gesture;
    if (!api_take_vector(c, "by", true, by) || !api_take_gesture(c, &gesture))
        return STATUS_BAD_INPUT;
    e.by = vec3_make(by[0], by[1], by[2]);
    return apply_to(c, e, verb, gesture);
}

status api_move(call *c)
{
    return displace(c, (edit){.displace = scene_move}, "move");
}

status api_turn(call *c)
{
    return displace(c, (edit){.displace = scene_turn}, "turn");
}

static status scale_it(edit *e, scene *s, diagnostic *why)
{
    return scene_scale(s, e->name, e->factor, why);
}

status api_scale(call *c)
{
    const json_t *factor = json_object_get(c->body, "factor");
    const char *gesture;
    if (!json_is_number(factor))
        return api_refuse(c, 400, "'factor' is no number", "give a factor above 0");
    if (!api_take_gesture(c, &gesture))
        return STATUS_BAD_INPUT;
    return apply_to(c, (edit){.or_camera = true, .factor = json_number_value(factor), .act = scale_it}, "scale",
                    gesture);
}

static status rename_it(edit *e, scene *s, diagnostic *why)
{
    const bool taken = strcmp(e->name, e->word) != 0 && check_name_is_free(s, e->word, NULL) != STATUS_OK;
    const status code = scene_rename(s, e->name, e->word, why);
    e->refused = code != STATUS_OK && taken ? 409 : 0;
    return code;
}

status api_rename(call *c)
{
    edit e = {.act = rename_it};
    return api_take_text(c, "to", true, &e.word) ? apply_to(c, e, "rename", NULL) : STATUS_BAD_INPUT;
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

status api_material(call *c)
{
    edit e = {.act = give_material};
    if (!json_is_null(json_object_get(c->body, "material")) && !api_take_text(c, "material", true, &e.word))
        return STATUS_BAD_INPUT;
    return apply_to(c, e, e.word ? "give a material to" : "take the material of", NULL);
}

static status copy_it(edit *e, scene *s, diagnostic *why)
{
    return new_copy(s, e->name, e->made, why);
}

status api_copy(call *c)
{
    return apply_to(c, (edit){.act = copy_it}, "copy", NULL);
}

/* --- what is new --- */

/* A texture, or what was loaded of a model. */
static status add_file(edit *e, scene *s, diagnostic *why)
{
    char *path;
    status code = folder_path_from(e->files, e->file, s->path, &path, why);
    THEN(code, strcmp(e->word, "model") == 0 ? new_model(s, e->loaded, path, e->wanted, e->made, why)
                                             : new_texture(s, path, e->wanted, e->made, why));
    free(path);
    return code;
}

static status add_object(edit *e, scene *s, diagnostic *why)
{
    static const struct {
        const char *word;
        status (*add)(scene *s, const char *wanted, object_name made, diagnostic *why); /* NULL: of a file */
    } kinds[] = {
        {"light", new_light}, {"material", new_material}, {"slime", new_slime}, {"texture", NULL}, {"model", NULL}};
    if (e->wanted && check_name_is_free(s, e->wanted, why) != STATUS_OK) {
        e->refused = 409;
        return STATUS_BAD_INPUT;
    }
    if (strcmp(e->word, "solid") == 0)
        return new_solid(s, e->shape, e->wanted, e->made, why);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(e->word, kinds[i].word) == 0)
            return kinds[i].add ? kinds[i].add(s, e->wanted, e->made, why) : add_file(e, s, why);
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
        code =
            is_model ? scene_add(s, PARAM_MESH, "model", NULL, why) : scene_add(s, PARAM_TEXTURE, "picture", NULL, why);
    THEN(code, scene_set(s, is_model ? "model.file" : "picture.file", path, why));
    THEN(code, scene_document_limit(s, l->files, why));
    THEN(code, scene_load(s, why));
    free(path);
    if (code == STATUS_OK)
        *out = s;
    else
        scene_destroy(s);
    return code;
}

static status take_new(call *c, edit *e, scene **loaded)
{
    const char *shape = NULL;
    if (!api_take_text(c, "kind", true, &e->word) || !api_take_text(c, "name", false, &e->wanted))
        return STATUS_BAD_INPUT;
    const bool is_model = strcmp(e->word, "model") == 0, is_file = is_model || strcmp(e->word, "texture") == 0,
               is_solid = strcmp(e->word, "solid") == 0;
    if (!api_take_text(c, "shape", is_solid, &shape) || !api_take_text(c, "file", is_file, &e->file))
        return STATUS_BAD_INPUT;
    status code = is_solid ? scene_shape_named(shape, &e->shape, &c->why) : STATUS_OK;
    if (is_file && (code = semaphore_acquire(c->l->heavy, &c->why)) == STATUS_OK) {
        code = load_alone(c->l, e->file, is_model, loaded, &c->why);
        semaphore_release(c->l->heavy);
    }
    return code;
}

status api_add(call *c)
{
    edit e = {.act = add_object, .files = c->l->files};
    scene *loaded = NULL;
    status code = take_new(c, &e, &loaded);
    e.loaded = loaded;
    THEN(code, apply(c, &e, "add",
                     e.wanted                       ? e.wanted
                     : strcmp(e.word, "solid") == 0 ? shape_name(e.shape)
                                                    : e.word,
                     NULL));
    scene_destroy(loaded);
    return code;
}
