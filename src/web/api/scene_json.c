/* The JSON of GET /api/scene: objects, outlines of solids, shapes, and rows of parameters. */
#include "base/json_build.h"
#include "web/api/api.h"
#include "geometry/shapes/shape.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

static const char *const light_words[] = {"point", "cone", "soft-cone", "disc", "rectangle", "sun"};

static json_t *object_json(const char *name, const char *kind)
{
    return json_pack("{s:o,s:s}", "name", json_of_text(name), "kind", kind);
}

static json_t *solid_json(const scene *s, const solid *one)
{
    json_t *o = object_json(one->name, "solid");
    int bad = json_object_set_new(o, "shape", json_string(shape_name(one->shape.kind)));
    bad |= json_object_set_new(
        o, "material", one->material_index >= 0 ? json_of_text(s->materials[one->material_index].name) : json_null());
    if (shape_of(&one->shape)->triangles)
        bad |= json_object_set_new(o, "mesh", json_of_text(one->mesh));
    return json_if(o, !bad);
}

static json_t *objects_json(const scene *s)
{
    static const param_group rest[] = {PARAM_BEAM, PARAM_MATERIAL, PARAM_MESH, PARAM_TEXTURE};
    json_t *list = json_array();
    int bad = 0;
    for (size_t i = 0; i < s->solid_count; i++)
        bad |= json_array_append_new(list, solid_json(s, &s->solids[i]));
    for (size_t i = 0; i < s->light_count; i++) {
        json_t *o = object_json(s->lights[i].name, "light");
        bad |= json_object_set_new(o, "light", json_string(light_words[s->lights[i].kind]));
        bad |= json_array_append_new(list, o);
    }
    for (size_t group = 0; group < sizeof rest / sizeof *rest; group++)
        for (size_t i = 0; i < param_place_group_size(s, rest[group]); i++)
            bad |= json_array_append_new(
                list, object_json(param_place_group_name(s, rest[group], i), param_group_name(rest[group])));
    return json_if(list, !bad);
}

/* [[ring..]..] by convex part, each [y, x, z, corners, from_deg] as shape_ring has them. */
static json_t *outline_json(const solid_shape *shape)
{
    shape_ring rings[RINGS_MAX];
    const int count = shape_of(shape)->rings(shape, rings);
    json_t *parts = json_array(), *part = NULL;
    for (int i = 0; i < count; i++) {
        const shape_ring *r = &rings[i];
        if (i == 0 || r->part != rings[i - 1].part)
            part = json_array();
        json_add(&part, json_pack("[f,f,f,i,f]", r->y, r->x, r->z, r->corners, r->from_deg));
        if (i + 1 == count || rings[i + 1].part != r->part)
            json_add(&parts, part);
    }
    return parts;
}

/* {name of a solid: outline}, for visible solids whose shape has one. */
static json_t *outlines_json(const scene *s)
{
    json_t *all = json_object();
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].visible && shape_of(&s->solids[i].shape)->rings)
            json_add_as(&all, s->solids[i].name, outline_json(&s->solids[i].shape));
    return all;
}

/* All shapes. */
static json_t *shapes_json(void)
{
    json_t *list = json_array();
    const shape_rule *rule;
    for (int k = 0; (rule = shape_of_kind((shape_kind)k)); k++)
        json_add(&list, json_pack("{s:s,s:s,s:b}", "shape", rule->word, "meaning", rule->meaning, "unbounded",
                                  (int)rule->unbounded));
    return list;
}

json_t *scene_json(const scene *s, const scene *opened, uint64_t generation)
{
    json_t *rows = NULL, *o = NULL;
    if (param_rows_json(s, opened, NULL, &rows, NULL) == STATUS_OK)
        o = json_pack("{s:I,s:o,s:o,s:o,s:o,s:O}", "generation", (json_int_t)generation, "title",
                      json_of_text(s->title), "objects", objects_json(s), "outlines", outlines_json(s), "shapes",
                      shapes_json(), "params", json_object_get(rows, "params"));
    json_decref(rows);
    return o;
}
