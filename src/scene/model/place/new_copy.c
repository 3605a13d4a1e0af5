/* Copies a solid. */
#include "scene/model/place/new_objects.h"
#include "scene/model/edit/edit.h"
#include "scene/model/objects.h"
#include "scene/model/params_path.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"

#include <math.h>
#include <string.h>

static vec3 rounded(vec3 v, double size)
{
    return vec3_make(placement_round(v.x, size), placement_round(v.y, size), placement_round(v.z, size));
}

/* Depth of overlap of two solids' bounding boxes, aligned with the camera, after moving the first; 0 if they are
 * disjoint. */
static double depth(const scene *s, const placement *where, const solid *a, vec3 step, const solid *b)
{
    const vec3 along[] = {where->right, where->away, vec3_make(0, 1, 0)};
    vec3 from, to;
    double radius, least = INFINITY;
    if (!placement_bounding_sphere(s, a, &from, &radius) || !placement_bounding_sphere(s, b, &to, &radius))
        return 0.0;
    const vec3 offset = vec3_sub(to, vec3_add(from, step));
    for (size_t i = 0; i < sizeof along / sizeof *along; i++)
        least = fmin(least, placement_half_size(s, a, along[i]) + placement_half_size(s, b, along[i]) -
                                fabs(vec3_dot(offset, along[i])));
    return fmax(0.0, least);
}

/* The copy may be inside everything that contains the original. */
static double overlap_after(const scene *s, const placement *where, const solid *of, vec3 step)
{
    double sum = depth(s, where, of, step, of);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        if (other != of && other->visible && depth(s, where, of, vec3_make(0, 0, 0), other) <= 0.0)
            sum += depth(s, where, of, step, other);
    }
    return sum;
}

/* Slightly more than its size in that direction, so that the copy is separate. */
static double stride(const scene *s, const solid *of, vec3 along, double radius)
{
    return 2.1 * fmax(placement_half_size(s, of, along), 0.01 * radius);
}

/* Offset from the original to a visible and preferably free place: to a side, behind or in front of it. */
static vec3 step_beside(const scene *s, const placement *where, const solid *of, vec3 centre, double radius)
{
    static const double offsets[][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},  {2, 0}, {-2, 0},
                                        {1, 1}, {-1, 1}, {1, -1}, {-1, -1}, {0, 2}};
    const double aside = stride(s, of, where->right, radius), behind = stride(s, of, where->away, radius);
    vec3 best = where->right;
    double least = INFINITY;
    for (size_t i = 0; i < sizeof offsets / sizeof *offsets && least > 0.0; i++) {
        vec3 step =
            vec3_add(vec3_scale(where->right, aside * offsets[i][0]), vec3_scale(where->away, behind * offsets[i][1]));
        step = rounded(step, fmin(aside, behind));
        const double bad =
            overlap_after(s, where, of, step) + (placement_in_view(s, vec3_add(centre, step)) ? 0.0 : radius);
        if (bad < least) {
            least = bad;
            best = step;
        }
    }
    return best;
}

static status copy_object(scene *s, param_group group, size_t of, const char *name, diagnostic *why)
{
    size_t index;
    const status code = group == PARAM_SOLID ? scene_add_solid(s, name, s->solids[of].shape.kind, &index, why)
                                             : scene_add(s, group, name, &index, why);
    if (code != STATUS_OK || object_assign(s, group, index, of))
        return code;
    object_remove(s, group, index);
    return out_of_memory(why);
}

/* The copy of a plane is behind its surface, where it has no effect until it is moved. */
static status copy_solid(scene *s, size_t of, const char *name, diagnostic *why)
{
    const placement where = placement_of(s);
    const vec3 normal = mat3_apply(rotation_from_deg(s->solids[of].shape.rotation_deg), vec3_make(0, 1, 0));
    vec3 centre, step = rounded(vec3_scale(normal, -where.size), where.size);
    double radius;
    if (placement_bounding_sphere(s, &s->solids[of], &centre, &radius))
        step = step_beside(s, &where, &s->solids[of], centre, radius);
    TRY(copy_object(s, PARAM_SOLID, of, name, why));
    return scene_move(s, name, step, why);
}

static status copy_beside(scene *s, param_group group, size_t of, const char *name, diagnostic *why)
{
    TRY(copy_object(s, group, of, name, why));
    const placement where = placement_of(s);
    return scene_move(s, name, rounded(vec3_scale(where.right, where.size), where.size), why);
}

status new_copy(scene *s, const char *of, object_name name, diagnostic *why)
{
    param_place at;
    object_name base;
    TRY(param_place_find_object(s, of, &at, why));
    status code = STATUS_OK;
    size_t length = strlen(strcpy(base, of));
    while (length > 1 && base[length - 1] >= '0' && base[length - 1] <= '9')
        base[--length] = 0;
    if ((code = new_name(s, base, name, why)) != STATUS_OK)
        return code;
    switch (at.object_group) {
    case PARAM_SOLID: return copy_solid(s, at.index, name, why);
    case PARAM_LIGHT:
    case PARAM_BEAM: return copy_beside(s, at.object_group, at.index, name, why);
    case PARAM_MATERIAL:
    case PARAM_MESH:
    case PARAM_TEXTURE: return copy_object(s, at.object_group, at.index, name, why);
    case PARAM_RENDER:
    case PARAM_CAMERA:
    case PARAM_BACKGROUND:
    case PARAM_GROUP_COUNT: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "copy a solid, a light, a beam, a material, a mesh or a texture",
                    "there is only one %.60s", of);
}
