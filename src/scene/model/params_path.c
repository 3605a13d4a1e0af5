#include "scene/model/params_path.h"
#include "geometry/shapes/shape.h"
#include "scene/model/objects.h"
#include "scene/model/suggest.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* All valid first words of paths of this scene, for suggestions; fresh memory, or NULL. */
static const char **group_words(const scene *s, size_t *count)
{
    size_t room = 0, used = 0;
    for (int g = 0; g < PARAM_GROUP_COUNT; g++)
        room += param_place_group_size(s, (param_group)g);
    const char **words = malloc(room * sizeof *words);
    for (int g = 0; words && g < PARAM_GROUP_COUNT; g++)
        for (size_t i = 0; i < param_place_group_size(s, (param_group)g); i++)
            words[used++] = param_place_group_name(s, (param_group)g, i);
    *count = used;
    return words;
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

/* For `depth` or `depht` alone, without a group: the nearest row of the groups without names, or NULL. */
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
    size_t count;
    const char **words = group_words(s, &count);
    if (!words)
        return out_of_memory(why);
    const char *nearest = suggest_word(path->group, words, count);
    char remedy[300] = "a path is render.NAME, camera.NAME, background.NAME, or the name of a mesh, texture, light, "
                       "beam, material or solid, a dot "
                       "and a parameter";
    const param *setting = nearest || path->name ? NULL : nearest_setting(s, path->group);
    if (nearest)
        snprintf(remedy, sizeof remedy, "did you mean '%.80s%s%.80s'?", nearest, path->name ? "." : "",
                 path->name ? path->name : "");
    else if (setting)
        snprintf(remedy, sizeof remedy, "did you mean '%s.%s'?", param_group_name(setting->group), setting->name);
    free(words);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "the scene has no object '%.80s'", path->group);
}

static status wrong_shape(const scene *s, const param_place *at, const path_words *path, diagnostic *why)
{
    const char *shape = shape_name(s->solids[at->index].shape.kind), *words[WORDS_MAX];
    size_t count = row_words(s, at, PARAM_SOLID, words, 0);
    char prefix[40], remedy[400];
    snprintf(prefix, sizeof prefix, "a %s has ", shape);
    suggest_list(prefix, words, count, remedy, sizeof remedy);
    size_t used = strlen(remedy);
    snprintf(remedy + used, sizeof remedy - used, ", and the parameters of a material");
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
    size_t count;
    const char **words = group_words(s, &count);
    if (!words)
        return out_of_memory(why);
    const char *nearest = suggest_word(name, words, count);
    char remedy[SCENE_NAME_MAX + 80] = "give the name of a light, material or solid";
    if (nearest)
        snprintf(remedy, sizeof remedy, "did you mean '%s'?", nearest);
    free(words);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "the scene has no object '%.80s'", name);
}

bool scene_film_depends_on(const scene *s, const char *path)
{
    param_place at;
    if (param_place_find(s, path, &at, NULL) != STATUS_OK || at.row->performance_only)
        return false;
    return at.object_group != PARAM_BEAM || strcmp(at.row->name, "lights") == 0 || s->beams[at.index].lights;
}
