/* Parameters by path: find the place of a path, set and get its value, visit all parameters. */
#include "scene/model/params.h"
#include "base/elementary.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "scene/model/medium.h"
#include "scene/model/names.h"
#include "scene/model/scene.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- paths --- */

enum { WORDS_MAX = 128 };

/* The words of a path; a word that does not fit is invalid anyway. */
typedef struct path_words {
    char text[200];
    const char *group, *name, *element; /* name and element may be NULL */
} path_words;

const char *shape_name(shape_kind kind)
{
    const shape_rule *rule = shape_of_kind(kind);
    return rule ? rule->word : "";
}

bool solid_has(const solid *owner, const param *row)
{
    if (row->group == PARAM_SOLID && row->offset == offsetof(solid, offset)) /* a place: one's own, or from another */
        return solid_follows(owner);
    if (row->group == PARAM_SOLID && row->offset == offsetof(solid, shape.position))
        return !solid_follows(owner);
    return row->group == PARAM_MATERIAL || !row->by_shape || shape_has(shape_of(&owner->shape), row->name);
}

static bool split_path(const char *path, path_words *words)
{
    if (strlen(path) >= sizeof words->text)
        return false;
    strcpy(words->text, path);
    words->group = words->text;
    words->name = words->element = NULL;
    char *dot = strchr(words->text, '.');
    if (dot) {
        *dot = 0;
        words->name = dot + 1;
        dot = strchr(dot + 1, '.');
        if (dot) {
            *dot = 0;
            words->element = dot + 1;
        }
    }
    return true;
}

/* The valid first word of a path of this scene that is nearest to a word; *nearest is NULL if none is near. */
static status nearest_group(const scene *s, const char *word, const char **nearest, diagnostic *why)
{
    size_t room = 0, used = 0;
    for (int g = 0; g < PARAM_GROUP_COUNT; g++)
        room += param_place_group_size(s, (param_group)g);
    const char **words = malloc(room * sizeof *words);
    if (!words)
        return out_of_memory(why);
    for (int g = 0; g < PARAM_GROUP_COUNT; g++)
        for (size_t i = 0; i < param_place_group_size(s, (param_group)g); i++)
            words[used++] = param_place_group_name(s, (param_group)g, i);
    *nearest = suggest_word(word, words, used);
    free(words);
    return STATUS_OK;
}

static bool find_group(const scene *s, const char *word, param_place *out)
{
    for (int g = 0; g < PARAM_GROUP_COUNT; g++) {
        const int at = object_find(s, (param_group)g, word);
        if (at >= 0) {
            out->object_group = (param_group)g;
            out->index = (size_t)at;
            return true;
        }
    }
    return false;
}

/* Appends the names of the rows of one group that apply to the place's object; returns the new count. */
static size_t row_words(const scene *s, const param_place *at, param_group rows, const char **words, size_t count)
{
    for (size_t i = 0; i < param_count() && count < WORDS_MAX; i++) {
        const param *row = param_at(i);
        if (row->group == rows && (at->object_group != PARAM_SOLID || solid_has(&s->solids[at->index], row)))
            words[count++] = row->name;
    }
    return count;
}

/* For a path without a group, such as `depth` or `depht`: the nearest row of render, camera or background, or NULL. */
static const param *nearest_setting(const scene *s, const char *word)
{
    for (int g = 0; g <= PARAM_BACKGROUND; g++) {
        const param_place at = {.row = NULL, .object_group = (param_group)g, .index = 0, .element = -1};
        const char *words[WORDS_MAX];
        size_t count = row_words(s, &at, at.object_group, words, 0);
        const char *nearest = suggest_word(word, words, count);
        if (nearest)
            return param_find(at.object_group, nearest);
    }
    return NULL;
}

static status unknown_group(const scene *s, const path_words *path, diagnostic *why)
{
    const char *nearest;
    TRY(nearest_group(s, path->group, &nearest, why));
    char remedy[300] = "a path is render.NAME, camera.NAME, background.NAME, or the name of a mesh, texture, light, "
                       "beam, material or solid, a dot "
                       "and a parameter";
    const param *setting = nearest || path->name ? NULL : nearest_setting(s, path->group);
    if (nearest)
        snprintf(remedy, sizeof remedy, "did you mean '%.80s%s%.80s'?", nearest, path->name ? "." : "",
                 path->name ? path->name : "");
    else if (setting)
        snprintf(remedy, sizeof remedy, "did you mean '%s.%s'?", param_group_name(setting->group), setting->name);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "the scene has no object '%.80s'", path->group);
}

static status wrong_shape(const scene *s, const param_place *at, const path_words *path, diagnostic *why)
{
    const char *shape = shape_name(s->solids[at->index].shape.kind), *words[WORDS_MAX];
    size_t count = row_words(s, at, PARAM_SOLID, words, 0);
    static const char others[] = ", and the parameters of a material";
    char prefix[40], remedy[sizeof why->remedy];
    if (!at->row->by_shape && solid_follows(&s->solids[at->index])) {
        snprintf(remedy, sizeof remedy, "set %s.offset, or %s.%s", path->group, s->solids[at->index].follows,
                 path->name);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "%s follows %s, and has no %s of its own", path->group,
                        s->solids[at->index].follows, path->name);
    }
    if (!at->row->by_shape)
        return diagnose(why, STATUS_BAD_INPUT, "set its position, or first the solid that it follows",
                        "%s follows no solid, so it has no offset", path->group);
    snprintf(prefix, sizeof prefix, "a %s has ", shape);
    suggest_list(prefix, words, count, remedy, sizeof remedy - sizeof others);
    size_t used = strlen(remedy);
    snprintf(remedy + used, sizeof remedy - used, "%s", others);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s is a %s, which has no %s", path->group, shape, path->name);
}

static status unknown_name(const scene *s, const param_place *at, const path_words *path, diagnostic *why)
{
    if (path->name && at->row)
        return wrong_shape(s, at, path, why);
    const char *words[WORDS_MAX];
    size_t count = row_words(s, at, at->object_group, words, 0);
    count = at->object_group == PARAM_SOLID ? row_words(s, at, PARAM_MATERIAL, words, count) : count;
    char remedy[400], prefix[140];
    if (!path->name || !*path->name) {
        suggest_list("add a dot and one of: ", words, count, remedy, sizeof remedy);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "'%s' is not a parameter", path->group);
    }
    const char *nearest = suggest_word(path->name, words, count);
    if (at->object_group == PARAM_SOLID && (strcmp(path->name, "material") == 0 || strcmp(path->name, "shape") == 0)) {
        snprintf(remedy, sizeof remedy,
                 "shape and material are set in the scene file or by cuvette scene; for glass set %s.transparency=1 "
                 "and %s.ior=1.5",
                 path->group, path->group);
    } else if (nearest) {
        snprintf(remedy, sizeof remedy, "did you mean '%s.%s'?", path->group, nearest);
    } else {
        snprintf(prefix, sizeof prefix, "%s has ", path->group);
        suggest_list(prefix, words, count, remedy, sizeof remedy);
    }
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s has no parameter '%.80s'", path->group, path->name);
}

static status find_element(const path_words *path, param_place *out, diagnostic *why)
{
    out->element = -1;
    if (!path->element)
        return STATUS_OK;
    bool color = out->row->type == PARAM_COLOR;
    if (!color && out->row->type != PARAM_VECTOR)
        return diagnose(why, STATUS_BAD_INPUT, "remove the part after the second dot", "%.80s.%.80s has no elements",
                        path->group, path->name);
    const char *letters = color ? "rgb" : "xyz", *letter = strchr(letters, path->element[0]);
    if (!path->element[0] || path->element[1] || !letter)
        return diagnose(why, STATUS_BAD_INPUT,
                        color ? "the elements are .r, .g and .b" : "the elements are .x, .y and .z",
                        "%.80s.%.80s has no element '%.20s'", path->group, path->name, path->element);
    out->element = (int)(letter - letters);
    return STATUS_OK;
}

status param_place_find(const scene *s, const char *path, param_place *out, diagnostic *why)
{
    path_words words;
    if (!split_path(path, &words))
        return diagnose(why, STATUS_BAD_INPUT, "a path is group.name, such as render.depth",
                        "the path '%.60s...' is too long", path);
    if (!find_group(s, words.group, out))
        return unknown_group(s, &words, why);
    out->row = words.name ? param_find(out->object_group, words.name) : NULL;
    if (!out->row || (out->object_group == PARAM_SOLID && !solid_has(&s->solids[out->index], out->row)))
        return unknown_name(s, out, &words, why);
    return find_element(&words, out, why);
}

status param_place_find_object(const scene *s, const char *name, param_place *out, diagnostic *why)
{
    *out = (param_place){.element = -1};
    if (find_group(s, name, out))
        return STATUS_OK;
    const char *nearest;
    TRY(nearest_group(s, name, &nearest, why));
    char remedy[SCENE_NAME_MAX + 80] = "give the name of a mesh, texture, light, beam, material or solid";
    if (nearest)
        snprintf(remedy, sizeof remedy, "did you mean '%s'?", nearest);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "the scene has no object '%.80s'", name);
}

bool scene_film_depends_on(const scene *s, const char *path)
{
    param_place at;
    if (param_place_find(s, path, &at, NULL) != STATUS_OK || at.row->performance_only)
        return false;
    return at.object_group != PARAM_BEAM || strcmp(at.row->name, "lights") == 0 || s->beams[at.index].lights;
}

/* --- values --- */

/* The struct with the field of a place. */
static void *place_base(const scene *s, const param_place *at)
{
    const bool of_surface = at->object_group == PARAM_SOLID && at->row->group == PARAM_MATERIAL;
    return of_surface ? (void *)&s->solids[at->index].surface : object_values(s, at->object_group, at->index);
}

static bool is_camera_row(const param *row, size_t offset)
{
    return row->group == PARAM_CAMERA && row->offset == offset;
}

static bool is_target(const param *row)
{
    return is_camera_row(row, offsetof(camera, target));
}

static bool is_angle(const param *row)
{
    return is_camera_row(row, offsetof(camera, yaw_deg)) || is_camera_row(row, offsetof(camera, pitch_deg));
}

/* The camera with target and angles valid: the unused ones are derived from the others. */
static camera camera_with_both(camera c)
{
    if (c.aimed) {
        vec3 d = vec3_sub(c.target, c.position);
        c.yaw_deg = elementary_atan2_deg(d.x, d.z);
        c.pitch_deg = elementary_atan2_deg(d.y, sqrt(d.x * d.x + d.z * d.z));
    } else {
        double sin_yaw, cos_yaw, sin_pitch, cos_pitch;
        elementary_sincos_deg(c.yaw_deg, &sin_yaw, &cos_yaw);
        elementary_sincos_deg(c.pitch_deg, &sin_pitch, &cos_pitch);
        c.target = vec3_add(c.position, vec3_make(cos_pitch * sin_yaw, sin_pitch, cos_pitch * cos_yaw));
    }
    return c;
}

/* A constant index replaces a medium that was set before. */
static void forget_medium(scene *s, const param_place *at)
{
    if (at->row->group == PARAM_BACKGROUND && at->row->offset == offsetof(background, ior))
        s->background.medium = MEDIUM_IOR;
    if (at->row->group != PARAM_MATERIAL || at->row->offset != offsetof(material, ior))
        return;
    if (at->object_group == PARAM_SOLID) {
        s->solids[at->index].surface.medium = MEDIUM_IOR;
        return;
    }
    s->materials[at->index].value.medium = MEDIUM_IOR;
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].material_index == (int)at->index)
            s->solids[i].surface.medium = MEDIUM_IOR;
}

/* Releases the mesh or image that was loaded for the old value. Setting a path also selects the file as the source. */
static void forget_loaded(scene *s, const param_place *at, param_value value)
{
    const bool names_file = at->row->type == PARAM_PATH, has_path = names_file && value.path[0];
    if (at->object_group == PARAM_MESH) {
        mesh_entry *m = &s->meshes[at->index];
        mesh_entry_unload(m);
        if (at->row->offset == offsetof(mesh_entry, script_path)) {
            m->script_line = m->script_column = 0;
            return;
        }
        m->source = has_path ? MESH_FILE : m->source;
        m->path_line = names_file ? 0 : m->path_line;
    } else if (at->object_group == PARAM_TEXTURE) {
        texture_entry *t = &s->textures[at->index];
        texture_entry_unload(t);
        t->path_line = names_file ? 0 : t->path_line;
    } else if (at->object_group == PARAM_DATA) {
        data_entry *d = &s->data[at->index];
        data_entry_unload(d);
        d->path_line = names_file ? 0 : d->path_line;
    } else if (names_file) {
        image_destroy(s->background.img);
        s->background.img = NULL;
        s->background.image_line = s->background.image_column = 0;
        s->background.kind = has_path ? BACKGROUND_IMAGE : s->background.kind;
    }
}

static bool names_data(const param *row)
{
    return row->names && strcmp(row->names, param_group_name(PARAM_DATA)) == 0;
}

/* Without loaded data, as while a file is read, there is nothing to follow. */
static bool has_loaded_data(const scene *s)
{
    bool any = false;
    for (size_t i = 0; i < s->data_count; i++)
        any |= s->data[i].data != NULL;
    return any;
}

/* Places the object, and all that follow, after a parameter that can be a place. One that no longer follows another
 * keeps its place. */
static void place_again(scene *s, const param_place *at)
{
    const param *row = at->row;
    const bool word = row->type == PARAM_WORD;
    if (row->group == PARAM_BEAM && (word || row->type == PARAM_VECTOR || row->type == PARAM_REAL)) {
        beam *b = &s->beams[at->index];
        s->has_followers |= b->follows[0] != 0;
        if (!b->follows[0] && word)
            b->own = (beam_place){b->position, b->target, b->direction, b->normal, b->width, b->field_width};
        else if (!b->follows[0])
            beam_stand(b);
        scene_follow_leaders(s);
    } else if (row->group == PARAM_SOLID && (word || row->type == PARAM_VECTOR)) {
        solid *owner = &s->solids[at->index];
        s->has_followers |= solid_follows(owner);
        if (row->offset == offsetof(solid, follows) && !solid_follows(owner))
            owner->rotation_deg = owner->shape.rotation_deg, owner->scale = owner->shape.scale;
        else if (!solid_follows(owner) &&
                 (row->offset == offsetof(solid, rotation_deg) || row->offset == offsetof(solid, scale)))
            solid_stand(owner);
        scene_follow_leaders(s);
    }
}

static void store(scene *s, const param_place *at, param_value value)
{
    forget_medium(s, at);
    const param *row = at->row;
    if (is_target(row) || is_angle(row)) {
        int64_t aimed = is_target(row);
        if (aimed != s->camera.aimed) {
            s->camera = camera_with_both(s->camera);
            s->camera.aimed = aimed;
        }
    }
    forget_loaded(s, at, value);
    param_value_store(row, at->element, (char *)place_base(s, at) + row->offset, value);
    for (size_t i = 0; at->object_group == PARAM_MATERIAL && i < s->solid_count; i++)
        if (s->solids[i].material_index == (int)at->index)
            param_value_store(row, at->element, (char *)&s->solids[i].surface + row->offset, value);
    place_again(s, at);
    if (at->object_group == PARAM_DATA || (names_data(row) && has_loaded_data(s)))
        scene_follow_data(s);
}

status param_place_set(scene *s, const param_place *at, const char *path, const char *value, diagnostic *why)
{
    param_value parsed;
    TRY(param_value_parse(at->row, at->element, path, value, &parsed, why));
    store(s, at, parsed);
    return STATUS_OK;
}

status scene_set(scene *s, const char *path, const char *value, diagnostic *why)
{
    param_place at;
    TRY(param_place_find(s, path, &at, why));
    return param_place_set(s, &at, path, value, why);
}

status scene_set_assignment(scene *s, const char *assignment, diagnostic *why)
{
    const char *equals = strchr(assignment, '=');
    if (!equals)
        return diagnose(why, STATUS_BAD_INPUT, "write path=value, such as render.depth=8", "'%.80s' has no '='",
                        assignment);
    char *path = strndup(assignment, (size_t)(equals - assignment));
    if (!path)
        return out_of_memory(why);
    status code = scene_set(s, path, equals + 1, why);
    free(path);
    return code;
}

/* The unused direction of the camera is derived. */
char *param_place_text(const scene *s, const param_place *at)
{
    if (at->object_group != PARAM_CAMERA)
        return param_value_text(at->row, at->element, (const char *)place_base(s, at) + at->row->offset);
    const camera both = camera_with_both(s->camera);
    return param_value_text(at->row, at->element, (const char *)&both + at->row->offset);
}

status scene_get(const scene *s, const char *path, char **value, diagnostic *why)
{
    *value = NULL;
    param_place at;
    TRY(param_place_find(s, path, &at, why));
    *value = param_place_text(s, &at);
    return *value ? STATUS_OK : out_of_memory(why);
}

/* Whether scene_each_param visits the row. It skips rows that are not in use, and that a setting would put into use:
 * the unused direction of the camera, the background image, a mesh's file; and the parameters of slimes for other
 * meshes. */
static bool is_in_use(const scene *s, const param_place *at)
{
    const param *row = at->row;
    if (row->group == PARAM_MESH && row->makers != 0)
        return (row->makers & 1u << s->meshes[at->index].source) != 0;
    if (row->type == PARAM_PATH && row->group == PARAM_MESH)
        return s->meshes[at->index].source == MESH_FILE;
    if (row->type == PARAM_PATH && row->group == PARAM_BACKGROUND && s->background.kind != BACKGROUND_IMAGE)
        return !s->background.image_path[0];
    return s->camera.aimed ? !is_angle(row) : !is_target(row);
}

/* A visit to places of a scene. */
typedef struct place_tour {
    const scene *s;
    const param_defaults *but; /* places with these values are skipped; NULL: none */
    const param_selection *of; /* only these; NULL: all */
    param_place_visit *visit;
    void *context;
} place_tour;

static bool is_wanted(const place_tour *tour, const param_place *at)
{
    return !tour->of || tour->of->wants(tour->of->context, tour->s, at);
}

static bool is_skipped(const place_tour *tour, const param_place *at)
{
    if (!is_wanted(tour, at))
        return true;
    return tour->but &&
           param_defaults_hold(tour->but, at->row, (const char *)place_base(tour->s, at) + at->row->offset);
}

/* Visits the rows of one object in one group of the table. */
static status visit_rows(const place_tour *tour, param_place at, param_group rows)
{
    const scene *s = tour->s;
    status code = STATUS_OK;
    for (size_t i = 0; i < param_count() && code == STATUS_OK; i++) {
        at.row = param_at(i);
        if (at.row->group == rows && is_in_use(s, &at) &&
            (at.object_group != PARAM_SOLID || solid_has(&s->solids[at.index], at.row)) && !is_skipped(tour, &at))
            code = tour->visit(tour->context, &at);
    }
    return code;
}

static status visit_group(const place_tour *tour, param_group group)
{
    status code = STATUS_OK;
    param_place at = {.row = NULL, .object_group = group, .index = 0, .element = -1};
    for (; at.index < param_place_group_size(tour->s, group) && code == STATUS_OK; at.index++) {
        if (!is_wanted(tour, &at))
            continue;
        code = visit_rows(tour, at, group);
        if (code == STATUS_OK && group == PARAM_SOLID)
            code = visit_rows(tour, at, PARAM_MATERIAL);
    }
    return code;
}

status param_place_each(const scene *s, param_group group, param_place_visit *visit, void *context)
{
    return visit_group(&(place_tour){.s = s, .visit = visit, .context = context}, group);
}

typedef struct path_visitor {
    const scene *s;
    param_visit *visit;
    void *context;
} path_visitor;

static status visit_path(void *context, const param_place *at)
{
    const path_visitor *v = context;
    char *path = text_format("%s.%s", param_place_group_name(v->s, at->object_group, at->index), at->row->name);
    char *value = param_place_text(v->s, at);
    const status code = path && value ? v->visit(v->context, path, at->row, value) : STATUS_FAILURE;
    free(path);
    free(value);
    return code;
}

static status visit_paths(place_tour tour, param_visit *visit, void *context)
{
    path_visitor v = {tour.s, visit, context};
    status code = STATUS_OK;
    tour.visit = visit_path;
    tour.context = &v;
    for (int g = 0; g < PARAM_GROUP_COUNT && code == STATUS_OK; g++)
        code = visit_group(&tour, (param_group)g);
    return code;
}

status scene_each_param_but(const scene *s, const param_defaults *but, param_visit *visit, void *context)
{
    return visit_paths((place_tour){.s = s, .but = but}, visit, context);
}

status scene_each_param_of(const scene *s, const param_selection *of, param_visit *visit, void *context)
{
    return visit_paths((place_tour){.s = s, .of = of}, visit, context);
}

status scene_each_param(const scene *s, param_visit *visit, void *context)
{
    return scene_each_param_but(s, NULL, visit, context);
}
