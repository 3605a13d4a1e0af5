/* Reads scene files. The grammar, in YAML (all keys are optional except a solid's shape):
 *
 *   title: TEXT
 *   render: {PARAMETER: VALUE, ...}
 *   camera: {PARAMETER: VALUE, ...}             either a target, or yaw_deg and pitch_deg (0 by default)
 *   background: {PARAMETER: VALUE, ...}
 *   meshes: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   textures: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   materials: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   lights: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   beams: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   solids: {NAME: {shape: SHAPE, material: NAME, PARAMETER: VALUE, ...}, ...}
 *
 * Giving a picture sets the kind of the background to picture. Switches are on or off, also written
 * yes or no, true or false. SHAPE is the word of a rule in geometry/shapes/. The parameters are the rows of the table
 * (scene/model/params.h); a solid also takes those of a material, for itself alone. Vectors and colours are lists:
 * [0, 1, 2]. The file's order is kept. Sections and objects may be empty. */
#include "base/file.h"
#include "base/installed.h"
#include "scene/file/shared.h"
#include "scene/model/check.h"
#include "scene/model/edit/edit.h"
#include "scene/file/read_entries.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

/* Whether an image is given for a background of another kind. */
static status check_sky(const scene_reader *r, const node *map)
{
    const node *kind = node_get(map, "kind"), *img = node_get(map, "picture");
    bool shown = img && img->kind == NODE_SCALAR && img->text[0];
    status code = read_one_medium(r, map);
    if (code == STATUS_OK && shown) {
        r->scene->background.image_line = img->line;
        r->scene->background.image_column = img->column;
    }
    if (code == STATUS_OK && shown && kind && strcmp(kind->text, "picture") != 0)
        return node_error(r->file, kind, r->why, "set it to picture, or remove the image file",
                          "background.kind is %s, but an image file is set", kind->text);
    return code;
}

/* A section that is a single object. */
static status read_settings(const scene_reader *r, const char *name, param_group group, const node *map)
{
    TRY(read_expect_map(r, map, name));
    TRY(read_check_keys(r, group, map));
    TRY(read_entries(r, name, group, map));
    if (group == PARAM_BACKGROUND)
        TRY(check_sky(r, map));
    return read_located(r, map, check_object(r->scene, group, 0, r->why));
}

static status read_camera(const scene_reader *r, const char *name, param_group group, const node *map)
{
    const node *target = node_get(map, "target"), *yaw = node_get(map, "yaw_deg"), *pitch = node_get(map, "pitch_deg");
    if (target && (yaw || pitch))
        return node_error(r->file, yaw ? yaw : pitch, r->why, "keep either the target or the angles",
                          "the camera has both a target and %s", yaw ? "yaw_deg" : "pitch_deg");
    if (yaw || pitch) /* a missing angle is 0, not that of the default target */
        r->scene->camera.aimed = 0;
    return read_settings(r, name, group, map);
}

static status read_title(const scene_reader *r, const char *name, param_group group, const node *value)
{
    (void)group;
    TRY(read_expect_word(r, value, name));
    return scene_set_title(r->scene, value->text, r->why);
}

static status read_sections(const scene_reader *r)
{
    /* Not in the order of the file: solids refer to materials, and are checked with the weights of render. */
    static const struct section {
        const char *name;
        status (*read)(const scene_reader *, const char *, param_group, const node *);
        param_group group;
    } sections[] = {
        {"title", read_title, PARAM_GROUP_COUNT},    {"render", read_settings, PARAM_RENDER},
        {"camera", read_camera, PARAM_CAMERA},       {"background", read_settings, PARAM_BACKGROUND},
        {"meshes", read_objects, PARAM_MESH},        {"textures", read_objects, PARAM_TEXTURE},
        {"materials", read_objects, PARAM_MATERIAL}, {"lights", read_objects, PARAM_LIGHT},
        {"beams", read_objects, PARAM_BEAM},         {"solids", read_objects, PARAM_SOLID},
    };
    enum { COUNT = sizeof sections / sizeof sections[0] };
    const node *root = document_root(r->file);
    const char *names[COUNT];
    for (size_t i = 0; i < COUNT; i++)
        names[i] = sections[i].name;
    if (root->kind != NODE_MAP)
        return node_error(r->file, root, r->why,
                          "begin with keys such as camera:, lights: and solids:", "this is not a scene");
    const node *name = node_get(root, "study");
    if (name)
        return node_error(r->file, name, r->why, "this looks like a study; cuvette study run FILE",
                          "unknown key 'study'");
    status code = node_check_keys(r->file, root, names, COUNT, r->why);
    for (size_t i = 0; i < COUNT && code == STATUS_OK; i++) {
        const node *value = node_get(root, names[i]);
        code = value ? sections[i].read(r, names[i], sections[i].group, value) : STATUS_OK;
    }
    return code;
}

static status build(const document *file, scene **out, diagnostic *why)
{
    scene *s = scene_create();
    char *path = strdup(document_name(file));
    if (!s || !path) {
        free(path);
        scene_destroy(s);
        return out_of_memory(why);
    }
    free(s->path);
    s->path = path;
    scene_reader r = {.file = file, .scene = s, .why = why};
    status code = read_sections(&r);
    THEN(code, read_located(&r, document_root(file), scene_check(s, why)));
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    *out = s;
    return STATUS_OK;
}

static status build_and_release(document *file, scene **out, diagnostic *why)
{
    status code = build(file, out, why);
    document_destroy(file);
    return code;
}

status scene_read(const char *path, scene **out, diagnostic *why)
{
    return scene_read_below(path, NULL, out, why);
}

/* A shared image may be larger than a scene's text, whose own limit document_parse checks. */
enum { FILE_LIMIT = 1 << 28 };

static status read_file(const char *path, const char *root, scene **out, diagnostic *why)
{
    char *text;
    size_t size;
    const status read = file_read_below(path, root, FILE_LIMIT, &text, &size, why);
    if (read != STATUS_OK) {
        if (!root)
            installed_suggest(path, "experiments/scenes", ".yaml", why);
        return read;
    }
    const status code = shared_is_file(text, size) ? shared_read_file(path, text, size, out, why)
                                                   : scene_read_text(path, text, size, out, why);
    free(text);
    return code;
}

status scene_read_below(const char *path, const char *root, scene **out, diagnostic *why)
{
    *out = NULL;
    TRY(shared_is_link(path) ? shared_read_link(path, out, why) : read_file(path, root, out, why));
    const status code = scene_limit(*out, root, 0, why);
    if (code != STATUS_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return code;
}

status scene_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why)
{
    *out = NULL;
    document *file;
    TRY(document_parse(name, text, size, &file, why));
    return build_and_release(file, out, why);
}
