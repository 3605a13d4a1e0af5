/* API: objects: add, remove, move, turn, scale, rename, change material (/api/objects). new_objects.c sets the
 * properties of new objects. */
#include "base/json_build.h"
#include "base/text.h"
#include "report/json.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"
#include "web/api/api.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct edit {
    const char *name;           /* of the object; NULL for a new one */
    bool or_camera;             /* the camera or a group of objects is allowed too */
    const char *word;           /* the new name; the material, NULL for none; the kind of a new object */
    const char *requested_name; /* name of a new object; NULL: any */
    const char *file;           /* file of a new object, relative to the folder */
    const folder *files;
    const scene *loaded; /* scene loaded from the file of a new object */
    shape_kind shape;
    const json_t *values; /* parameters of a new object; NULL: none */
    object_list group;    /* the object and those edited with it; first NULL: only the object */
    status (*displace)(scene *s, const char *name, vec3 by, diagnostic *why);
    status (*displace_group)(scene *s, const object_list *of, vec3 by, diagnostic *why);
    vec3 by;
    double factor;
    object_name new_name; /* name of the new object; "" for none */
    int refused;          /* HTTP code instead of 400: 404, 409; 0: none */
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
                  : diagnose(why, STATUS_BAD_INPUT, "name a solid, a light, a material, a mesh, a texture or data",
                             "the %.60s cannot be edited in this way", e->name);
}

/* verb: the text for undo, before the object's name. Replies with the generation and the name of the new object. */
static status apply(call *c, edit *e, const char *verb, const char *name, const char *gesture)
{
    uint64_t generation = 0;
    char words[128];
    snprintf(words, sizeof words, "%s %.80s", verb, name);
    const status code = scene_document_apply(c->l->scene_document, words, gesture, change, e, &generation, &c->why);
    c->refused = e->refused;
    if (code == STATUS_OK && e->new_name[0])
        return api_reply_json(c, json_pack("{s:I, s:s}", "generation", (json_int_t)generation, "name", e->new_name));
    return api_changed(c, code, generation);
}

static status apply_to(call *c, edit e, const char *verb, const char *gesture)
{
    e.name = http_path_value(c->request, "name");
    return apply(c, &e, verb, e.name, gesture);
}

/* --- existing objects --- */

static status remove_object(edit *e, scene *s, diagnostic *why)
{
    const status code = scene_remove(s, e->name, why);
    e->refused = code == STATUS_OK ? 0 : 409;
    return code;
}

status api_remove(call *c)
{
    return apply_to(c, (edit){.act = remove_object}, "remove", NULL);
}

static status displace_object(edit *e, scene *s, diagnostic *why)
{
    return e->group.first ? e->displace_group(s, &e->group, e->by, why) : e->displace(s, e->name, e->by, why);
}

/* Reads `with`; the caller frees group->others. */
static status read_group(call *c, object_list *group)
{
    enum { NAMES_MAX = 1000 };
    const json_t *list = json_object_get(c->body, "with");
    const size_t count = json_array_size(list);
    bool good = !list || (json_is_array(list) && count <= NAMES_MAX);
    if (good && count > 0) {
        if (!(group->others = calloc(count, sizeof *group->others)))
            return out_of_memory(&c->why);
        group->first = http_path_value(c->request, "name");
        for (group->count = 0; group->count < count && good; group->count++)
            good = (group->others[group->count] = json_string_value(json_array_get(list, group->count))) != NULL;
    }
    return good ? STATUS_OK
                : api_refuse(c, 400, "'with' is not a list of names", "give at most 1000 names of solids and lights");
}

/* Reads `with` and the gesture, and makes the edit. */
static status apply_to_group(call *c, edit *e, const char *verb)
{
    const char *gesture = NULL;
    status code = read_group(c, &e->group);
    if (code == STATUS_OK && !api_read_gesture(c, &gesture))
        code = STATUS_BAD_INPUT;
    THEN(code, apply_to(c, *e, verb, gesture));
    free(e->group.others);
    return code;
}

static status displace(call *c, edit e, const char *verb)
{
    e.or_camera = true;
    e.act = displace_object;
    double by[3];
    if (!api_read_vector(c, "by", true, by))
        return STATUS_BAD_INPUT;
    e.by = vec3_make(by[0], by[1], by[2]);
    return apply_to_group(c, &e, verb);
}

status api_move(call *c)
{
    return displace(c, (edit){.displace = scene_move, .displace_group = scene_move_objects}, "move");
}

status api_turn(call *c)
{
    return displace(c, (edit){.displace = scene_turn, .displace_group = scene_turn_objects}, "turn");
}

static status scale_object(edit *e, scene *s, diagnostic *why)
{
    return e->group.first ? scene_scale_objects(s, &e->group, e->factor, why) : scene_scale(s, e->name, e->factor, why);
}

status api_scale(call *c)
{
    const json_t *factor = json_object_get(c->body, "factor");
    edit e = {.or_camera = true, .factor = json_number_value(factor), .act = scale_object};
    if (!json_is_number(factor))
        return api_refuse(c, 400, "'factor' is not a number", "give a factor above 0");
    return apply_to_group(c, &e, "scale");
}

static status rename_object(edit *e, scene *s, diagnostic *why)
{
    const bool taken = strcmp(e->name, e->word) != 0 && check_name_is_free(s, e->word, NULL) != STATUS_OK;
    const status code = scene_rename(s, e->name, e->word, why);
    e->refused = code != STATUS_OK && taken ? 409 : 0;
    return code;
}

status api_rename(call *c)
{
    edit e = {.act = rename_object};
    return api_read_text(c, "to", true, &e.word) ? apply_to(c, e, "rename", NULL) : STATUS_BAD_INPUT;
}

/* A solid that loses its material keeps a copy of the material's values: the defaults would be black. */
static status set_material(edit *e, scene *s, diagnostic *why)
{
    const int index = scene_find_solid(s, e->name);
    if (e->word || index < 0)
        return scene_assign_material(s, e->name, e->word, why);
    s->solids[index].material_index = -1;
    return STATUS_OK;
}

status api_material(call *c)
{
    edit e = {.act = set_material};
    if (!json_is_null(json_object_get(c->body, "material")) && !api_read_text(c, "material", true, &e.word))
        return STATUS_BAD_INPUT;
    return apply_to(c, e, e.word ? "set the material of" : "remove the material of", NULL);
}

static status copy_object(edit *e, scene *s, diagnostic *why)
{
    return new_copy(s, e->name, e->new_name, why);
}

status api_copy(call *c)
{
    return apply_to(c, (edit){.act = copy_object}, "copy", NULL);
}

/* What is inside a solid, and a ball around the solid itself. */
status api_contents(call *c)
{
    const char *name = http_path_value(c->request, "name");
    scene *s = scene_document_copy(c->l->scene_document, NULL);
    json_t *names = json_array(), *ball = json_null();
    contents inside = {.count = 0};
    vec3 centre;
    double radius;
    const status code = s && names ? contents_find(s, name, &inside, &c->why) : out_of_memory(&c->why);
    c->refused = 404;
    for (size_t i = 0; i < inside.count; i++)
        json_add(&names, json_of_text(inside.name[i]));
    if (code == STATUS_OK && contents_ball(s, name, &centre, &radius))
        ball = json_pack("{s:[f,f,f], s:f}", "centre", centre.x, centre.y, centre.z, "radius", radius);
    contents_clear(&inside);
    scene_destroy(s);
    if (code == STATUS_OK)
        return api_reply_json(c, json_pack("{s:o, s:o}", "contents", names, "ball", ball));
    json_decref(names);
    return code;
}

/* --- new objects --- */

/* Sets parameters and the material of the new object, by name. */
static status set_values(const json_t *values, const char *name, scene *s, diagnostic *why)
{
    const char *row;
    json_t *value;
    status code = STATUS_OK;
    json_object_foreach((json_t *)(uintptr_t)values, row, value)
    {
        char *text = NULL, *path = text_format("%s.%s", name, row);
        THEN(code, api_value_text(value, row, &text, why));
        THEN(code, path ? scene_set_property(s, path, text, why) : out_of_memory(why));
        free(text);
        free(path);
    }
    return code;
}

/* Adds a texture, data, or the loaded model. */
static status add_file(edit *e, scene *s, diagnostic *why)
{
    char *path;
    status code = folder_path_from(e->files, e->file, s->path, &path, why);
    THEN(code, strcmp(e->word, "model") == 0  ? new_model(s, e->loaded, path, e->requested_name, e->new_name, why)
               : strcmp(e->word, "data") == 0 ? new_data(s, path, e->requested_name, e->new_name, why)
                                              : new_texture(s, path, e->requested_name, e->new_name, why));
    free(path);
    return code;
}

static status add_of_kind(edit *e, scene *s, diagnostic *why)
{
    static const struct {
        const char *word;
        status (*add)(scene *s, const char *requested_name, object_name new_name,
                      diagnostic *why); /* NULL: from a file */
    } kinds[] = {{"light", new_light}, {"beam", new_beam}, {"material", new_material},
                 {"slime", new_slime}, {"texture", NULL},  {"model", NULL},
                 {"data", NULL}};
    if (e->requested_name && check_name_is_free(s, e->requested_name, why) != STATUS_OK) {
        e->refused = 409;
        return STATUS_BAD_INPUT;
    }
    if (strcmp(e->word, "solid") == 0)
        return new_solid(s, e->shape, e->requested_name, e->new_name, why);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(e->word, kinds[i].word) == 0)
            return kinds[i].add ? kinds[i].add(s, e->requested_name, e->new_name, why) : add_file(e, s, why);
    return diagnose(why, STATUS_BAD_INPUT, "use solid, light, beam, material, model, slime, texture or data",
                    "unknown kind '%.60s'", e->word);
}

static status add_object(edit *e, scene *s, diagnostic *why)
{
    const status code = add_of_kind(e, s, why);
    return code == STATUS_OK && e->values ? set_values(e->values, e->new_name, s, why) : code;
}

/* The kind of object that a file makes; PARAM_GROUP_COUNT: the word names none. */
static param_group group_of_file(const char *word)
{
    return strcmp(word, "model") == 0     ? PARAM_MESH
           : strcmp(word, "texture") == 0 ? PARAM_TEXTURE
           : strcmp(word, "data") == 0    ? PARAM_DATA
                                          : PARAM_GROUP_COUNT;
}

/* Loads the file of a new object into a scene of its own, without holding the lock of the scene document. The glass of
 * a catalogue is among the values of the object. */
static status load_file(lab *l, const edit *e, param_group group, scene **out, diagnostic *why)
{
    /* the words of kinds are reserved */
    const char *name = group == PARAM_MESH ? "model" : group == PARAM_TEXTURE ? "image" : "table";
    char *path = NULL, *row = text_format("%s.file", name);
    status code = row ? folder_path(l->files, e->file, true, &path, why) : out_of_memory(why);
    scene *s = code == STATUS_OK ? scene_create() : NULL;
    if (code == STATUS_OK && !s)
        code = out_of_memory(why);
    THEN(code, scene_add(s, group, name, NULL, why));
    THEN(code, scene_set(s, row, path, why));
    if (code == STATUS_OK && group == PARAM_DATA && e->values)
        code = set_values(e->values, name, s, why);
    THEN(code, scene_document_limit(s, l->files, why));
    THEN(code, scene_load(s, why));
    free(path);
    free(row);
    if (code == STATUS_OK)
        *out = s;
    else
        scene_destroy(s);
    return code;
}

static status read_new(call *c, edit *e, scene **loaded)
{
    const char *shape = NULL;
    if (!api_read_text(c, "kind", true, &e->word) || !api_read_text(c, "name", false, &e->requested_name))
        return STATUS_BAD_INPUT;
    const param_group group = group_of_file(e->word);
    const bool is_file = group != PARAM_GROUP_COUNT, is_solid = strcmp(e->word, "solid") == 0;
    if (!api_read_text(c, "shape", is_solid, &shape) || !api_read_text(c, "file", is_file, &e->file))
        return STATUS_BAD_INPUT;
    e->values = json_object_get(c->body, "set");
    if (e->values && !json_is_object(e->values))
        return api_refuse(c, 400, "'set' is not an object", "give {PARAMETER: VALUE} of the new object");
    status code = is_solid ? scene_shape_named(shape, &e->shape, &c->why) : STATUS_OK;
    if (is_file && (code = semaphore_acquire(c->l->heavy, &c->why)) == STATUS_OK) {
        code = load_file(c->l, e, group, loaded, &c->why);
        semaphore_release(c->l->heavy);
    }
    return code;
}

status api_add(call *c)
{
    edit e = {.act = add_object, .files = c->l->files};
    const char *gesture = NULL;
    scene *loaded = NULL;
    status code = api_read_gesture(c, &gesture) ? read_new(c, &e, &loaded) : STATUS_BAD_INPUT;
    e.loaded = loaded;
    THEN(code, apply(c, &e, "add",
                     e.requested_name               ? e.requested_name
                     : strcmp(e.word, "solid") == 0 ? shape_name(e.shape)
                                                    : e.word,
                     gesture));
    scene_destroy(loaded);
    return code;
}
