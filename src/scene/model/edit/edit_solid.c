/* Material and shape of a solid: its properties that are not rows of the table. */
#include "scene/model/suggest.h"
#include "scene/model/edit/edit.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "scene/model/check.h"
#include "scene/model/objects.h"
#include "scene/model/params_path.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <string.h>

status scene_give_material(scene *s, const char *solid_name, const char *material_name, diagnostic *why)
{
    param_place at;
    TRY(param_place_find_object(s, solid_name, &at, why));
    if (at.object_group != PARAM_SOLID)
        return diagnose(why, STATUS_BAD_INPUT, "name a solid", "%.80s is a %s, which has no material", solid_name,
                        param_group_name(at.object_group));
    solid *owner = &s->solids[at.index];
    if (!material_name || !material_name[0]) {
        owner->material_index = -1;
        return param_set_defaults(PARAM_MATERIAL, &owner->surface, why);
    }
    const int material_index = object_find(s, PARAM_MATERIAL, material_name);
    if (material_index >= 0) {
        owner->material_index = material_index;
        owner->surface = s->materials[material_index].value;
        return STATUS_OK;
    }
    char remedy[SCENE_NAME_MAX + 80];
    return diagnose(why, STATUS_BAD_INPUT, object_remedy(s, PARAM_MATERIAL, material_name, remedy, sizeof remedy),
                    "no material '%.80s'", material_name);
}

enum { SHAPES_MAX = 64 };

static size_t shape_words(const char *words[SHAPES_MAX])
{
    size_t count = 0;
    for (const shape_rule *rule; count < SHAPES_MAX && (rule = shape_of_kind((shape_kind)count)); count++)
        words[count] = rule->word;
    return count;
}

char *scene_shape_words(const char *conjunction, char *text, size_t size)
{
    const char *words[SHAPES_MAX];
    const size_t last = shape_words(words) - 1;
    suggest_list("", words, last, text, size);
    const size_t used = strlen(text);
    snprintf(text + used, size - used, " %s %s", conjunction, words[last]);
    return text;
}

status scene_shape_named(const char *word, shape_kind *out, diagnostic *why)
{
    if (shape_named(word, out))
        return STATUS_OK;
    const char *words[SHAPES_MAX], *nearest = text_nearest(word, words, shape_words(words));
    char remedy[200], all[160];
    snprintf(remedy, sizeof remedy, nearest ? "did you mean '%s'?" : "the shapes are %s",
             nearest ? nearest : scene_shape_words("and", all, sizeof all));
    return diagnose(why, STATUS_BAD_INPUT, remedy, "'%.60s' is not a shape", word);
}

static status put_shape(scene *s, solid *owner, const char *word, diagnostic *why)
{
    const shape_kind before = owner->shape.kind;
    status code = scene_shape_named(word, &owner->shape.kind, why);
    THEN(code, check_limits(s, why));
    if (code != STATUS_OK)
        owner->shape.kind = before;
    return code;
}

/* The solid at the start of a path, or NULL. */
static solid *owner_of(const scene *s, const char *path)
{
    const size_t length = strcspn(path, ".");
    for (size_t i = 0; i < s->solid_count; i++)
        if (strlen(s->solids[i].name) == length && strncmp(s->solids[i].name, path, length) == 0)
            return &s->solids[i];
    return NULL;
}

status scene_put(scene *s, const char *path, const char *value, diagnostic *why)
{
    solid *owner = owner_of(s, path);
    const char *rest = path + strcspn(path, ".");
    if (owner && strcmp(rest, ".material") == 0)
        return scene_give_material(s, owner->name, value, why);
    if (owner && strcmp(rest, ".shape") == 0)
        return put_shape(s, owner, value, why);
    return scene_set(s, path, value, why);
}
