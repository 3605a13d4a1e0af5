#include "geometry/arrangement.h"
#include "base/elementary.h"
#include "geometry/forest.h"
#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"

#include <stdlib.h>

/* Indices of the sources, lowest rank first: ascending priority, and of equals the later one first. */
static void order_by_priority(const body_source *sources, int count, int *order)
{
    for (int i = 0; i < count; i++) {
        int at = i;
        while (at > 0 && sources[order[at - 1]].priority >= sources[i].priority) {
            order[at] = order[at - 1];
            at--;
        }
        order[at] = i;
    }
}

/* Unit vectors outwards; the corner before the first side lies in front, at -z, the next ones to its right, as seen
 * from outside. */
static const vec3 *add_normals(arrangement *a, int sides)
{
    vec3 *normals = a->normals + a->normal_count;
    for (int k = 0; k < sides; k++) {
        double sine, cosine;
        elementary_sincos_deg(180.0 * (2 * k + 1) / sides, &sine, &cosine);
        normals[k] = vec3_make(sine, 0.0, -cosine);
    }
    a->normal_count += sides;
    return normals;
}

static void add_primitive(arrangement *a, int rank, const primitive *part)
{
    primitive *p = &a->primitives[a->primitive_count];
    *p = *part;
    p->rank = rank;
    p->first_face = (int64_t)a->primitive_count++ * FACES_MAX;
    p->rows = p->rule ? p->rule->sse2->intervals : 1;
    p->normals = p->sides > 0 ? add_normals(a, p->sides) : NULL;
    if (p->extent > a->extent)
        a->extent = p->extent;
    for (int row = 1; row < p->rows; row++) {
        a->further |= (uint64_t)1 << a->primitive_count;
        a->primitives[a->primitive_count++] = (primitive){.rank = rank, .rows = 1};
    }
}

static void add_body(arrangement *a, int rank, const body_source *source)
{
    primitive parts[SHAPE_PRIMITIVES];
    const shape_rule *shape = shape_of(source->shape);
    const int n = shape->primitive_count;
    shape->primitives(source->shape, parts);
    a->opaque_ranks |= (uint64_t)source->opaque << (rank - 1);
    body *b = &a->bodies[rank];
    a->shapes[rank] = *source->shape;
    *b = (body){.outside = a->primitive_count,
                .hollow = n == 2 ? a->primitive_count + 1 : -1,
                .medium = source->medium,
                .opaque = source->opaque,
                .clearness = source->opaque ? 0.0 : source->clearness,
                .face_clearness = source->opaque ? NULL : source->face_clearness,
                .absorbs = source->absorbs && !source->opaque,
                .reflects = source->reflects && !source->opaque,
                .solid = source->solid};
    a->absorbs |= b->absorbs;
    for (int k = 0; k < n; k++)
        add_primitive(a, rank, &parts[k]);
}

static bool media_are_distinct(const arrangement *a)
{
    for (int r = 1; r <= a->body_count; r++)
        for (int q = 0; q < r; q++)
            if (a->bodies[q].medium == a->bodies[r].medium)
                return false;
    return true;
}

/* order: the sources by rank. */
static status plant_meshes(arrangement *a, const body_source *sources, const int *order, diagnostic *why)
{
    forest_source planted[PRIMITIVES_MAX];
    int count = 0;
    for (int r = 1; r <= a->body_count; r++) {
        const body_source *source = &sources[order[r - 1]];
        if (shape_of(source->shape)->triangles)
            planted[count++] = (forest_source){source->shape, source->tree, a->bodies[r].outside, r};
    }
    return count > 0 ? forest_build(planted, count, &a->meshes, why) : STATUS_OK;
}

status arrangement_build(const body_source *sources, int count, int64_t outside_medium, arrangement **out,
                         diagnostic *why)
{
    int primitives = 0;
    for (int i = 0; i < count; i++)
        primitives += shape_places(sources[i].shape);
    if (primitives > PRIMITIVES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 64 in all; a cup and a torus count as two",
                        "the visible solids make %d primitives", primitives);
    arrangement *a = calloc(1, sizeof *a);
    int *order = calloc((size_t)count + 1, sizeof *order);
    if (a) {
        a->primitives = calloc((size_t)primitives + 1, sizeof *a->primitives);
        a->bodies = calloc((size_t)count + 1, sizeof *a->bodies);
        a->shapes = calloc((size_t)count + 1, sizeof *a->shapes);
        a->normals = calloc((size_t)primitives * FACES_MAX + 1, sizeof *a->normals);
    }
    if (!a || !order || !a->primitives || !a->bodies || !a->shapes || !a->normals) {
        free(order);
        arrangement_destroy(a);
        return out_of_memory(why);
    }
    a->bodies[0] = (body){.outside = -1, .hollow = -1, .medium = outside_medium, .clearness = 1.0, .solid = -1};
    a->body_count = count;
    order_by_priority(sources, count, order);
    for (int r = 0; r < count; r++)
        add_body(a, r + 1, &sources[order[r]]);
    status code = plant_meshes(a, sources, order, why);
    free(order);
    if (code != STATUS_OK) {
        arrangement_destroy(a);
        return code;
    }
    a->distinct = media_are_distinct(a);
    *out = a;
    return STATUS_OK;
}

void arrangement_destroy(arrangement *a)
{
    if (!a)
        return;
    forest_destroy(a->meshes);
    free(a->primitives);
    free(a->bodies);
    free(a->normals);
    free(a->shapes);
    free(a);
}

void arrangement_surroundings_absorb(arrangement *a)
{
    a->bodies[0].absorbs = a->absorbs = true;
}

uint64_t arrangement_inside(const arrangement *a, vec3 point)
{
    uint64_t inside = a->meshes ? forest_inside(a->meshes, point) : 0;
    for (int i = 0; i < a->primitive_count; i++)
        inside |= (uint64_t)primitive_contains(&a->primitives[i], point) << i;
    return inside;
}

static bool set_has(uint64_t inside, int bit)
{
    return bit >= 0 && (inside >> bit & 1);
}

int arrangement_rank(const arrangement *a, uint64_t inside)
{
    for (int r = a->body_count; r > 0; r--)
        if (set_has(inside, a->bodies[r].outside) && !set_has(inside, a->bodies[r].hollow))
            return r;
    return 0;
}

int arrangement_surface(const arrangement *a, int before, int after)
{
    if (a->bodies[after].opaque || a->bodies[before].opaque)
        return a->bodies[after].opaque ? after : before;
    return after > before ? after : before;
}
