/* New objects at the end of their sections. */
#include "geometry/shapes/shape.h"
#include "scene/model/check.h"
#include "scene/model/edit/edit.h"
#include "scene/model/objects.h"
#include "scene/model/params_path.h"
#include "scene/model/params_value.h"
#include "scene/model/scene.h"

/* shape is for solids. */
static status add(scene *s, param_group group, shape_kind shape, const char *name, size_t *index, diagnostic *why)
{
    const size_t at = param_place_group_size(s, group);
    TRY(check_name(name, why));
    TRY(check_name_is_free(s, name, why));
    if (!object_append(s, group, name))
        return out_of_memory(why);
    status code = param_set_defaults(group, object_values(s, group, at), why);
    if (group == PARAM_SOLID && code == STATUS_OK) {
        solid *new = &s->solids[at];
        new->shape.kind = shape;
        new->material_index = -1;
        code = param_set_defaults(PARAM_MATERIAL, &new->surface, why);
    }
    /* A bounded solid is within the limits as long as there are few. */
    const shape_rule *rule = shape_of_kind(shape);
    if (group != PARAM_SOLID || rule->unbounded || rule->triangles || s->solid_count > SCENE_PRIMITIVES_MAX / 3)
        THEN(code, check_limits(s, why));
    if (code != STATUS_OK)
        object_remove(s, group, at);
    else if (index)
        *index = at;
    return code;
}

status scene_add(scene *s, param_group group, const char *name, size_t *index, diagnostic *why)
{
    return add(s, group, (shape_kind){0}, name, index, why);
}

status scene_add_solid(scene *s, const char *name, shape_kind shape, size_t *index, diagnostic *why)
{
    return add(s, PARAM_SOLID, shape, name, index, why);
}
