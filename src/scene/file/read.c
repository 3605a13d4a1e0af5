/* Reads scene files. The grammar, in YAML (all keys are optional except a solid's shape):
 *
 *   title: TEXT
 *   render: {PARAMETER: VALUE, ...}
 *   camera: {PARAMETER: VALUE, ...}             either a target, or yaw_deg and pitch_deg (0 by default)
 *   background: {PARAMETER: VALUE, ...}
 *   meshes: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   textures: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   data: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   materials: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   lights: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   beams: {NAME: {PARAMETER: VALUE, ...}, ...}
 *   lens_systems: {NAME: {file: PATH, ...}, ...}            lenses as solids (read_lens.c)
 *   solids: {NAME: {shape: SHAPE, material: NAME, PARAMETER: VALUE, ...}, ...}
 *
 * A medium may also be a map of data, {file: PATH, ...}. An image sets the background's kind to image. Switches are
 * on or off, also written yes or no, true or false. SHAPE is the word of a rule in geometry/shapes/. The parameters are
 * the rows of the table (scene/model/params.h); a solid may also have those of a material. Vectors and colours are
 * lists: [0, 1, 2]. The file's order is kept. Sections and objects may be empty. scene_read (shared_read.c) opens the
 * file. */
#include "scene/data/document.h"
#include "scene/file/read_lens.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct scene_reader {
    const document *file;
    const lens_access *access;
    struct scene *scene;
    diagnostic *why;
} scene_reader;

/* --- entries: rows of the parameter table --- */

static status read_check_keys(const scene_reader *r, param_group group, const node *map);
static void store_locations(const scene_reader *r, param_group group, size_t index, const node *map);
static status read_entries(const scene_reader *r, const char *name, param_group group, size_t index, const node *map);

/* Returns code; on failure, adds the node's location to a diagnostic from a function that does not know the file. */
static status read_located(const scene_reader *r, const node *at, status code)
{
    if (code != STATUS_OK)
        diagnostic_locate(r->why, document_name(r->file), at->line, at->column);
    return code;
}

static bool is_empty(const node *n)
{
    return n->kind == NODE_SCALAR && !n->quoted && !n->text[0];
}

/* Requires a map; a missing value counts as an empty map. */
static status read_expect_map(const scene_reader *r, const node *n, const char *name)
{
    if (n->kind == NODE_MAP || is_empty(n))
        return STATUS_OK;
    return node_error(r->file, n, r->why, "write indented lines 'key: value' below it",
                      "%.80s is not a map of keys and values", name);
}

/* Requires a scalar that is not empty. */
static status read_expect_word(const scene_reader *r, const node *n, const char *name)
{
    if (n->kind == NODE_SCALAR && n->text[0])
        return STATUS_OK;
    return node_error(r->file, n, r->why, "give one word", "%.80s is not a word", name);
}

static status check_value_kind(const scene_reader *r, const param *row, const char *path, const node *value)
{
    bool vector =
        row->type == PARAM_VECTOR || row->type == PARAM_COLOR || row->type == PARAM_LIST || row->type == PARAM_LAYERS;
    bool number = row->type == PARAM_INT || row->type == PARAM_REAL;
    if (value->kind == NODE_MAP || (value->kind == NODE_LIST && !vector)) {
        char remedy[420];
        return node_error(r->file, value, r->why, param_remedy(row, false, remedy, sizeof remedy), "%.150s is a %s",
                          path, value->kind == NODE_MAP ? "map" : "list");
    }
    if (value->quoted && number)
        return node_error(r->file, value, r->why, "remove the quotes", "%.150s is text, but must be a number", path);
    return STATUS_OK;
}

static status read_value(const scene_reader *r, const char *path, const param_place *at, const node *value)
{
    TRY(check_value_kind(r, at->row, path, value));
    char *text = node_value_text(value);
    if (!text && node_is_value(value))
        return out_of_memory(r->why);
    if (!text && at->row->type == PARAM_LAYERS)
        return node_error(r->file, value, r->why, "write each layer for itself: [mgf2 550/4, tio2 20]",
                          "%.150s has quoted layers with a comma", path);
    if (!text)
        return node_error(r->file, value, r->why, at->row->type == PARAM_LIST ? "give plain numbers" : "give 3 numbers",
                          "%.150s contains something other than plain numbers", path);
    status code = read_located(r, value, param_place_set(r->scene, at, path, text, r->why));
    free(text);
    return code;
}

/* Adds data for a medium that is a map, as {file: N-BK7.yml}, and sets the medium to them. */
static status read_medium_map(const scene_reader *r, const char *owner, const param_place *at, const node *map)
{
    object_name name;
    const node *file = node_get(map, "file");
    TRY(read_check_keys(r, PARAM_DATA, map));
    if (!file || file->kind != NODE_SCALAR || !file->text[0])
        return node_error(r->file, map, r->why, "write {file: NAME}, or the name of a medium (cuvette media)",
                          "%.80s.medium is a map without a file", owner);
    TRY(read_located(r, file, new_data(r->scene, file->text, NULL, name, r->why)));
    const size_t index = r->scene->data_count - 1;
    TRY(read_entries(r, name, PARAM_DATA, index, map));
    store_locations(r, PARAM_DATA, index, map);
    param_place of = *at;
    TRY(param_place_set(r->scene, &of, owner, "data", r->why));
    of.row = param_find(PARAM_MATERIAL, "medium_data");
    return param_place_set(r->scene, &of, owner, name, r->why);
}

/* Sets the entries of an object's map that are rows of its group, and skips others; name is the path's first word. */
static status read_entries(const scene_reader *r, const char *name, param_group group, size_t index, const node *map)
{
    param_place at = {.object_group = group, .index = index, .element = -1};
    for (size_t i = 0; i < map->count; i++) {
        const char *key = map->keys[i]->text;
        at.row = param_find(group, key);
        if (!at.row)
            continue;
        char path[2 * SCENE_NAME_MAX + 2];
        snprintf(path, sizeof path, "%s.%s", name, key);
        if (group == PARAM_SOLID && !solid_has(&r->scene->solids[index], at.row))
            TRY(read_located(r, map->keys[i], param_place_find(r->scene, path, &at, r->why)));
        TRY(at.row->group == PARAM_MATERIAL && map->items[i]->kind == NODE_MAP && strcmp(key, "medium") == 0
                ? read_medium_map(r, name, &at, map->items[i])
                : read_value(r, path, &at, map->items[i]));
    }
    return STATUS_OK;
}

/* Refuses a map that has both an index and a medium other than `ior`. */
static status read_one_medium(const scene_reader *r, const node *map)
{
    const node *ior = node_get(map, "ior"), *medium = node_get(map, "medium");
    if (ior && medium && strcmp(medium->text ? medium->text : "", "ior") != 0)
        return node_error(r->file, ior, r->why, "keep either the ior or the medium",
                          "both an ior and a medium are given");
    return STATUS_OK;
}

static bool is_key(param_group group, const char *key)
{
    return param_find(group, key) ||
           (group == PARAM_SOLID && (strcmp(key, "shape") == 0 || strcmp(key, "material") == 0));
}

/* Refuses keys that are not rows of the group. */
static status read_check_keys(const scene_reader *r, param_group group, const node *map)
{
    size_t known = 0;
    while (known < map->count && is_key(group, map->keys[known]->text))
        known++;
    if (known == map->count)
        return STATUS_OK;
    enum { ROOM = 128 };
    const char *words[ROOM];
    size_t count = 0;
    if (group == PARAM_SOLID) {
        words[count++] = "shape";
        words[count++] = "material";
    }
    for (size_t i = 0; i < param_count() && count < ROOM; i++) {
        const param *row = param_at(i);
        if (row->group == group || (group == PARAM_SOLID && row->group == PARAM_MATERIAL))
            words[count++] = row->name;
    }
    return node_check_keys(r->file, map, words, count, r->why);
}

/* --- objects: meshes, textures, materials, lights, beams, solids --- */

static status read_shape(const scene_reader *r, const node *key, const node *map, shape_kind *out)
{
    const node *shape = node_get(map, "shape");
    if (!shape) {
        char remedy[200] = "add shape: ";
        const size_t used = strlen(remedy);
        scene_shape_words("or", remedy + used, sizeof remedy - used);
        return node_error(r->file, key, r->why, remedy, "%s has no shape", key->text);
    }
    TRY(read_expect_word(r, shape, "shape"));
    return read_located(r, shape, scene_shape_named(shape->text, out, r->why));
}

/* Assigns the material that the solid's entry names, if any. */
static status read_material_name(const scene_reader *r, const node *key, const node *map)
{
    const node *word = node_get(map, "material");
    if (!word)
        return STATUS_OK;
    TRY(read_expect_word(r, word, "material"));
    return read_located(r, word, scene_assign_material(r->scene, key->text, word->text, r->why));
}

/* The solid that it follows is read first, because it decides which parameters the solid has. */
static status read_leader(const scene_reader *r, const node *key, const node *map, size_t index)
{
    const node *follows = node_get(map, "follows"), *own = node_get(map, "position");
    if (!follows)
        return STATUS_OK;
    if (own)
        return node_error(r->file, own, r->why, "keep either follows and offset, or position",
                          "%.80s follows another solid, but has its own place", key->text);
    const param_place at = {param_find(PARAM_SOLID, "follows"), PARAM_SOLID, index, -1};
    return read_value(r, key->text, &at, follows);
}

/* Adds a solid; its shape and material are not rows of the table. */
static status begin_solid(const scene_reader *r, const node *key, const node *map, size_t *index)
{
    shape_kind shape = {0};
    TRY(read_check_keys(r, PARAM_SOLID, map));
    TRY(read_one_medium(r, map));
    TRY(read_shape(r, key, map, &shape));
    TRY(read_located(r, key, scene_add_solid(r->scene, key->text, shape, index, r->why)));
    TRY(read_leader(r, key, map, *index));
    return read_material_name(r, key, map);
}

static status begin_object(const scene_reader *r, param_group group, const node *key, const node *map, size_t *index)
{
    if (group == PARAM_SOLID)
        return begin_solid(r, key, map, index);
    status code = read_located(r, key, scene_add(r->scene, group, key->text, index, r->why));
    THEN(code, read_check_keys(r, group, map));
    if (code == STATUS_OK && group == PARAM_MATERIAL)
        code = read_one_medium(r, map);
    const node *generate = node_get(map, "generate");
    if (code == STATUS_OK && group == PARAM_MESH && generate && node_get(map, "file"))
        return node_error(r->file, generate, r->why, "keep one of them", "%.80s has both a file and a generator",
                          key->text);
    return code;
}

static void store_location(const node *file, long *line, long *column)
{
    if (file) {
        *line = file->line;
        *column = file->column;
    }
}

/* Stores where the scene names files, for diagnostics when the files are read. */
static void store_locations(const scene_reader *r, param_group group, size_t index, const node *map)
{
    const node *file = node_get(map, "file");
    if (group == PARAM_MESH) {
        mesh_entry *m = &r->scene->meshes[index];
        store_location(file ? file : node_get(map, "generate"), &m->path_line, &m->path_column);
        store_location(node_get(map, "script"), &m->script_line, &m->script_column);
    } else if (group == PARAM_TEXTURE) {
        texture_entry *t = &r->scene->textures[index];
        store_location(file, &t->path_line, &t->path_column);
    } else if (group == PARAM_DATA) {
        data_entry *d = &r->scene->data[index];
        store_location(file, &d->path_line, &d->path_column);
    }
}

static status read_object(const scene_reader *r, param_group group, const node *key, const node *map)
{
    size_t index = 0;
    TRY(begin_object(r, group, key, map, &index));
    TRY(read_entries(r, key->text, group, index, map));
    store_locations(r, group, index, map);
    return read_located(r, key, check_object(r->scene, group, index, r->why));
}

/* Reads a section of named objects: each is added to the scene and checked. Materials come before solids, which refer
 * to them. */
static status read_objects(const scene_reader *r, const char *name, param_group group, const node *map)
{
    status code = read_expect_map(r, map, name);
    for (size_t i = 0; i < map->count && code == STATUS_OK; i++) {
        code = read_expect_map(r, map->items[i], map->keys[i]->text);
        THEN(code, read_object(r, group, map->keys[i], map->items[i]));
    }
    return code;
}

/* --- sections --- */

/* Stores where the scene names the background image; refuses an image for a background of another kind. */
static status check_sky(const scene_reader *r, const node *map)
{
    const node *kind = node_get(map, "kind"), *img = node_get(map, "image");
    bool shown = img && img->kind == NODE_SCALAR && img->text[0];
    status code = read_one_medium(r, map);
    if (code == STATUS_OK && shown) {
        r->scene->background.image_line = img->line;
        r->scene->background.image_column = img->column;
    }
    if (code == STATUS_OK && shown && kind && strcmp(kind->text, "image") != 0)
        return node_error(r->file, kind, r->why, "set it to image, or remove the image file",
                          "background.kind is %s, but an image file is set", kind->text);
    return code;
}

/* Reads a section that is a single object. */
static status read_settings(const scene_reader *r, const char *name, param_group group, const node *map)
{
    TRY(read_expect_map(r, map, name));
    TRY(read_check_keys(r, group, map));
    TRY(read_entries(r, name, group, 0, map));
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
    if (yaw || pitch) /* a missing angle is 0, not the angle of the default target */
        r->scene->camera.aimed = 0;
    return read_settings(r, name, group, map);
}

static status read_title(const scene_reader *r, const char *name, param_group group, const node *value)
{
    (void)group;
    TRY(read_expect_word(r, value, name));
    return scene_set_title(r->scene, value->text, r->why);
}

static status read_lenses(const scene_reader *r, const char *name, param_group group, const node *map)
{
    (void)name, (void)group;
    return is_empty(map) ? STATUS_OK : read_lens_systems(r->file, r->access, r->scene, map, r->why);
}

static status read_sections(const scene_reader *r)
{
    /* In this order, not the file's: solids refer to materials, and are checked with render.weights; beams refer to
     * solids. */
    static const struct section {
        const char *name;
        status (*read)(const scene_reader *, const char *, param_group, const node *);
        param_group group;
    } sections[] = {
        {"title", read_title, PARAM_GROUP_COUNT}, {"render", read_settings, PARAM_RENDER},
        {"camera", read_camera, PARAM_CAMERA},    {"background", read_settings, PARAM_BACKGROUND},
        {"meshes", read_objects, PARAM_MESH},     {"textures", read_objects, PARAM_TEXTURE},
        {"data", read_objects, PARAM_DATA},       {"materials", read_objects, PARAM_MATERIAL},
        {"lights", read_objects, PARAM_LIGHT},    {"lens_systems", read_lenses, PARAM_SOLID},
        {"solids", read_objects, PARAM_SOLID},    {"beams", read_objects, PARAM_BEAM},
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
        return node_error(r->file, name, r->why, "this looks like a study; use 'cuvette study run FILE'",
                          "unknown key 'study'");
    status code = node_check_keys(r->file, root, names, COUNT, r->why);
    for (size_t i = 0; i < COUNT && code == STATUS_OK; i++) {
        const node *value = node_get(root, names[i]);
        code = value ? sections[i].read(r, names[i], sections[i].group, value) : STATUS_OK;
    }
    return code;
}

static status build(const document *file, const lens_access *access, scene **out, diagnostic *why)
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
    scene_reader r = {.file = file, .access = access, .scene = s, .why = why};
    status code = read_sections(&r);
    THEN(code, read_located(&r, document_root(file), scene_check(s, why)));
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    *out = s;
    return STATUS_OK;
}

static status build_and_release(document *file, const lens_access *access, scene **out, diagnostic *why)
{
    status code = build(file, access, out, why);
    document_destroy(file);
    return code;
}

status read_scene_text(const char *name, const char *text, size_t size, const lens_access *access, scene **out,
                       diagnostic *why)
{
    *out = NULL;
    document *file;
    TRY(document_parse(name, text, size, &file, why));
    return build_and_release(file, access, out, why);
}

status scene_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why)
{
    return read_scene_text(name, text, size, &(lens_access){.allowed = false}, out, why);
}

/* --- scenes to begin with --- */

static const char initial_scene[] =
    "title: A new scene\n"
    "render: {width: 800, height: 600, depth: 6}\n"
    "camera: {position: [0, 1.8, -6], target: [0, 0.8, 0], fov_deg: 40}\n"
    "background: {kind: gradient, color: [0.25, 0.45, 0.75], horizon: [0.85, 0.9, 0.95]}\n"
    "materials:\n"
    "  paving: {color: [0.8, 0.8, 0.78], ambient: 0.25, diffuse: 0.7, checker: 1, checker_color: [0.45, 0.47, 0.5]}\n"
    "lights:\n"
    "  lamp: {position: [5, 9, -7]}\n"
    "solids:\n"
    "  ground: {shape: plane, material: paving}\n";

/* One scene unit is a centimetre; objects stand on the table, and beams run at a height of 2.5. */
static const char bench_scene[] =
    "title: Free experiment\n"
    "render: {width: 800, height: 600, depth: 8, unit_m: 0.01}\n"
    "camera: {position: [-6, 19, -36], target: [0, 2.5, 0], fov_deg: 40}\n"
    "background: {kind: gradient, color: [0.3, 0.45, 0.65], horizon: [0.86, 0.9, 0.94]}\n"
    "materials:\n"
    "  board: {color: [0.74, 0.76, 0.78], ambient: 0.3, diffuse: 0.6, checker: 5, checker_color: [0.62, 0.65, 0.68]}\n"
    "lights:\n"
    "  lamp: {position: [-25, 45, -35]}\n"
    "solids:\n"
    "  table: {shape: plane, material: board}\n";

status new_scene(bool bench, scene **out, diagnostic *why)
{
    return bench ? scene_read_text("", bench_scene, sizeof bench_scene - 1, out, why)
                 : scene_read_text("", initial_scene, sizeof initial_scene - 1, out, why);
}
