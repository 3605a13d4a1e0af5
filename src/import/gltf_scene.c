/* The scene of a glTF file (3.5): its hierarchy of nodes, and their meshes as one mesh in world coordinates. A mesh
 * without a transform keeps the exact numbers of the file. */
#include "import/gltf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nesting of nodes, of which a level takes about 0.5 KB of the 1 MB stack of the module for browsers; joints of a
 * vertex, by four. */
enum { DEPTH_MAX = 256, SKIN_SETS_MAX = 4 };
enum { TRIANGLES = 4, TRIANGLE_STRIP, TRIANGLE_FAN }; /* modes of primitives, 3.7.2.1 */

static const gltf_affine IDENTITY = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/* A primitive of a mesh; triangles: 0 if it has none. */
typedef struct primitive {
    gltf_item mesh;
    const json_t *attributes;
    int64_t material;
    gltf_accessor positions, normals, uvs, colors, indices; /* count 0: none */
    uint64_t mode, corners, triangles;
    gltf_uv_map map;
} primitive;

/* A material that triangles use, and the colour of all their vertices (COLOR_0), which multiplies its own. Where
 * vertices of a material differ, all have colours of their own instead. */
typedef struct tinted {
    bool used;
    double tint[3];
} tinted;

typedef struct walk {
    gltf_file *g;
    joiner join;
    uint64_t triangles, vertices; /* counted by the first traversal */
    tinted *used;                 /* by look_of */
    uint8_t *slot_of;
    bool *visited;      /* by node */
    gltf_affine *world; /* by node: its transform, after the first traversal */
    status (*visit)(struct walk *w, const primitive *p, size_t node);
} walk;

/* --- nodes --- */

static gltf_affine compose(const gltf_affine *a, const gltf_affine *b)
{
    gltf_affine product;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = 0;
            for (int k = 0; k < 3; k++)
                sum += a->m[row][k] * b->m[k][column];
            product.m[row][column] = column == 3 ? sum + a->m[row][3] : sum;
        }
    return product;
}

/* The transform of a node, 3.5.3: a matrix, column by column; or T R S, with a unit quaternion x, y, z, w. */
static status node_transform(const gltf_file *g, gltf_item node, gltf_affine *out)
{
    double c[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1},
           s[3] = {1, 1, 1};
    TRY(gltf_numbers(g, node, node.json, "matrix", 16, c));
    TRY(gltf_numbers(g, node, node.json, "translation", 3, t));
    TRY(gltf_numbers(g, node, node.json, "rotation", 4, q));
    TRY(gltf_numbers(g, node, node.json, "scale", 3, s));
    if (json_object_get(node.json, "matrix")) {
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 4; column++)
                out->m[row][column] = c[4 * column + row];
        return STATUS_OK;
    }
    const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(length2 > 0))
        return gltf_bad(g, node, "rotation", "is a quaternion of length 0");
    const double n = 2 / length2, x = q[0], y = q[1], z = q[2], w = q[3];
    *out = (gltf_affine){
        {{s[0] * (1 - n * (y * y + z * z)), s[1] * n * (x * y - w * z), s[2] * n * (x * z + w * y), t[0]},
         {s[0] * n * (x * y + w * z), s[1] * (1 - n * (x * x + z * z)), s[2] * n * (y * z - w * x), t[1]},
         {s[0] * n * (x * z - w * y), s[1] * n * (y * z + w * x), s[2] * (1 - n * (x * x + y * y)), t[2]}}};
    return STATUS_OK;
}

/* The index in a list of nodes. */
static status listed_node(const gltf_file *g, gltf_item of, const char *key, size_t at, size_t *out)
{
    const json_t *value = json_array_get(json_object_get(of.json, key), at);
    const double number = json_number_value(value);
    const size_t count = gltf_count(g, "nodes");
    if (!json_is_number(value) || !(number >= 0) || number != floor(number) || number >= (double)count)
        return gltf_bad(g, of, key, "has an item that is none of the file's %zu nodes", count);
    *out = (size_t)number;
    return STATUS_OK;
}

/* Nodes form trees, 3.5.2: each has one parent at most, which also keeps their number small. */
static status find_parents(const gltf_file *g, uint32_t *parent_plus_1)
{
    const size_t count = gltf_count(g, "nodes");
    for (size_t i = 0; i < count; i++) {
        const gltf_item of = gltf_at(g, "nodes", i);
        const size_t children = json_array_size(json_object_get(of.json, "children"));
        for (size_t k = 0; k < children; k++) {
            size_t child;
            TRY(listed_node(g, of, "children", k, &child));
            if (parent_plus_1[child])
                return gltf_bad(g, of, "children", "has nodes[%zu], which is already a child of nodes[%lu]", child,
                                (unsigned long)(parent_plus_1[child] - 1));
            parent_plus_1[child] = (uint32_t)i + 1;
        }
    }
    return STATUS_OK;
}

/* --- meshes --- */

/* Opens an attribute; count 0: the primitive has none. Its elements are as many as those of the positions. */
static status open_attribute(gltf_file *g, const primitive *p, const json_t *attributes, const char *name,
                             int components, gltf_accessor *out)
{
    int64_t index;
    *out = (gltf_accessor){0};
    TRY(gltf_index(g, p->mesh, attributes, name, "accessors", &index));
    if (index < 0)
        return STATUS_OK;
    TRY(gltf_accessor_open(g, p->mesh, index, components, out));
    if (p->positions.count && out->count < p->positions.count)
        return gltf_bad(g, p->mesh, name, "has %zu elements for %zu positions", out->count, p->positions.count);
    return STATUS_OK;
}

static status open_indices(gltf_file *g, const json_t *json, primitive *p)
{
    enum { UINT8 = 5121, UINT16 = 5123, UINT32 = 5125 };
    int64_t index;
    TRY(gltf_index(g, p->mesh, json, "indices", "accessors", &index));
    if (index < 0)
        return STATUS_OK;
    TRY(gltf_accessor_open(g, p->mesh, index, 1, &p->indices));
    if (!p->indices.base && !p->indices.sparse_count)
        return gltf_bad(g, gltf_at(g, "accessors", (size_t)index), "bufferView", "is missing, but these are indices");
    const int type = p->indices.type;
    return type == UINT8 || type == UINT16 || type == UINT32
               ? STATUS_OK
               : gltf_bad(g, gltf_at(g, "accessors", (size_t)index), "componentType", "is %d, but these are indices",
                          type);
}

static void note_rest(const gltf_file *g, const json_t *primitive_json)
{
    if (json_array_size(json_object_get(primitive_json, "targets")) > 0)
        flat_note(g->flat, "shapes that morph are shown at rest");
}

/* Refuses a primitive that has its positions in no other form. */
static status refuse_draco(const gltf_file *g, gltf_item mesh, const json_t *json)
{
    int64_t index;
    TRY(gltf_index(g, mesh, json_object_get(json, "attributes"), "POSITION", "accessors", &index));
    if (index < 0 || !gltf_extension(json, "KHR_draco_mesh_compression") ||
        json_object_get(gltf_at(g, "accessors", (size_t)index).json, "bufferView"))
        return STATUS_OK;
    return diagnose(g->why, STATUS_BAD_INPUT, "export the file without compression",
                    "%s[%zu] is compressed with Draco, which is not read", mesh.list, mesh.index);
}

static status open_primitive(gltf_file *g, gltf_item mesh, const json_t *json, primitive *p)
{
    const json_t *attributes = json_object_get(json, "attributes");
    *p = (primitive){.mesh = mesh, .attributes = attributes};
    TRY(gltf_whole(g, mesh, json, "mode", 6, TRIANGLES, &p->mode));
    if (p->mode < TRIANGLES) {
        flat_note(g->flat, "points and lines are ignored");
        return STATUS_OK;
    }
    TRY(gltf_index(g, mesh, json, "material", "materials", &p->material));
    TRY(gltf_material_uv_map(g, p->material, &p->map));
    TRY(refuse_draco(g, mesh, json));
    TRY(open_attribute(g, p, attributes, "POSITION", 3, &p->positions));
    if (!p->positions.count)
        return STATUS_OK; /* 3.7.2.1: not drawn */
    if (p->positions.count > g->req->vertices)
        return diagnose(g->why, STATUS_BAD_INPUT, "use a mesh of less detail", "more vertices than the limit of %llu",
                        (unsigned long long)g->req->vertices);
    char set[32];
    snprintf(set, sizeof set, "TEXCOORD_%llu", (unsigned long long)p->map.set);
    TRY(open_attribute(g, p, attributes, "NORMAL", 3, &p->normals));
    TRY(open_attribute(g, p, attributes, set, 2, &p->uvs));
    TRY(open_attribute(g, p, attributes, "COLOR_0", 0, &p->colors));
    TRY(open_indices(g, json, p));
    note_rest(g, json);
    p->corners = p->indices.count ? p->indices.count : p->positions.count;
    p->triangles = p->mode == TRIANGLES ? p->corners / 3 : p->corners > 2 ? p->corners - 2 : 0;
    return STATUS_OK;
}

static status visit_mesh(walk *w, gltf_item node)
{
    int64_t index;
    TRY(gltf_index(w->g, node, node.json, "mesh", "meshes", &index));
    if (index < 0)
        return STATUS_OK;
    const gltf_item mesh = gltf_at(w->g, "meshes", (size_t)index);
    const json_t *list = json_object_get(mesh.json, "primitives");
    for (size_t i = 0; i < json_array_size(list); i++) {
        primitive p;
        TRY(open_primitive(w->g, mesh, json_array_get(list, i), &p));
        if (p.triangles)
            TRY(w->visit(w, &p, node.index));
    }
    return STATUS_OK;
}

/* --- the traversal --- */

static status visit_node(walk *w, size_t index, const gltf_affine *parent, int depth)
{
    const gltf_item node = gltf_at(w->g, "nodes", index);
    gltf_affine own;
    if (depth > DEPTH_MAX)
        return diagnose(w->g->why, STATUS_BAD_INPUT, "flatten the hierarchy in the program that made the file",
                        "nodes are nested more than %d deep", DEPTH_MAX);
    if (!w->slot_of && w->visited[index])
        return gltf_bad(w->g, node, "", "is its own descendant, or is listed twice");
    w->visited[index] = true;
    TRY(node_transform(w->g, node, &own));
    const gltf_affine place = compose(parent, &own);
    w->world[index] = place;
    TRY(visit_mesh(w, node));
    if (!w->slot_of) /* the first traversal */
        TRY(gltf_views(w->g, node, &place));
    const size_t children = json_array_size(json_object_get(node.json, "children"));
    for (size_t k = 0; k < children; k++) {
        size_t child;
        TRY(listed_node(w->g, node, "children", k, &child));
        TRY(visit_node(w, child, &place, depth + 1));
    }
    return STATUS_OK;
}

/* Visits the default scene, or the first; without scenes all nodes that have no parent. */
static status visit_all(walk *w, const uint32_t *parent_plus_1, status (*visit)(walk *, const primitive *, size_t))
{
    const gltf_file *g = w->g;
    const size_t scenes = gltf_count(g, "scenes"), count = gltf_count(g, "nodes");
    int64_t chosen;
    w->visit = visit;
    TRY(gltf_index(g, (gltf_item){0}, g->root, "scene", "scenes", &chosen));
    chosen = chosen < 0 ? 0 : chosen;
    if (scenes > 1)
        flat_note(g->flat, "the file has %zu scenes, of which scenes[%lld] is read", scenes, (long long)chosen);
    const gltf_item of = gltf_at(g, "scenes", (size_t)chosen);
    const size_t roots = scenes ? json_array_size(json_object_get(of.json, "nodes")) : count;
    for (size_t i = 0; i < roots; i++) {
        size_t node = i;
        if (scenes)
            TRY(listed_node(g, of, "nodes", i, &node));
        if (scenes || !parent_plus_1[node])
            TRY(visit_node(w, node, &IDENTITY, 0));
    }
    return STATUS_OK;
}

/* --- the first traversal: counts triangles, finds materials and attributes --- */

/* Finds the colour of all vertices of a primitive, which keeps its value if they have none; false: they differ. */
static bool find_tint(gltf_file *g, const primitive *p, double tint[3])
{
    double color[4] = {0, 0, 0, 1};
    bool clear = false, one = true;
    for (size_t i = 0; p->colors.count && (one || !clear) && i < p->positions.count; i++) {
        gltf_accessor_get(&p->colors, i, color);
        if (i == 0)
            memcpy(tint, color, 3 * sizeof *tint);
        one &= memcmp(tint, color, 3 * sizeof *tint) == 0;
        clear |= color[3] < 1;
    }
    if (clear)
        flat_note(g->flat, VERTEX_ALPHA_NOTE);
    return one;
}

/* The number of a primitive's look, of two for each material and for none: the second is without the texture, for
 * primitives that lack its coordinates. */
static size_t look_of(const gltf_file *g, const primitive *p)
{
    const size_t material = p->material < 0 ? gltf_count(g, "materials") : (size_t)p->material;
    return 2 * material + (p->map.textured && !p->uvs.count);
}

static size_t look_count(const gltf_file *g)
{
    return 2 * gltf_count(g, "materials") + 2;
}

static status count_primitive(walk *w, const primitive *p, size_t node)
{
    (void)node;
    gltf_file *g = w->g;
    double tint[3] = {1, 1, 1};
    w->triangles += p->triangles;
    w->vertices += p->positions.count;
    g->flat->with_normals |= p->normals.count > 0;
    g->flat->with_uvs |= p->uvs.count > 0;
    const bool one = find_tint(g, p, tint);
    if (p->map.textured && !p->uvs.count)
        flat_note(g->flat, "a texture whose coordinates the mesh lacks is left out");
    tinted *m = &w->used[look_of(g, p)];
    g->flat->with_colors |= !one || (m->used && memcmp(tint, m->tint, sizeof tint) != 0);
    m->used = true;
    memcpy(m->tint, tint, sizeof tint);
    return STATUS_OK;
}

static status number_slots(walk *w)
{
    static const double white[3] = {1, 1, 1};
    const size_t count = look_count(w->g);
    w->slot_of = calloc(count, 1);
    if (!w->slot_of)
        return no_memory_for(w->g->req, w->g->why);
    for (size_t i = 0; i < count; i++)
        if (w->used[i].used)
            TRY(gltf_material_slot(w->g, i + 2 < count ? (int64_t)(i / 2) : -1,
                                   w->g->flat->with_colors ? white : w->used[i].tint, i % 2 == 0, &w->slot_of[i]));
    return STATUS_OK;
}

/* --- the second traversal: copies vertices and triangles --- */

/* The transform of normals: the inverse transpose, up to a positive factor. It is the matrix of cofactors divided by
 * the determinant, and only the determinant's sign matters. */
static gltf_affine normal_transform(const gltf_affine *a, double *determinant)
{
    gltf_affine c = {0};
    for (int row = 0; row < 3; row++) {
        int r1 = (row + 1) % 3, r2 = (row + 2) % 3;
        for (int column = 0; column < 3; column++) {
            int c1 = (column + 1) % 3, c2 = (column + 2) % 3;
            c.m[row][column] = a->m[r1][c1] * a->m[r2][c2] - a->m[r1][c2] * a->m[r2][c1];
        }
    }
    *determinant = a->m[0][0] * c.m[0][0] + a->m[0][1] * c.m[0][1] + a->m[0][2] * c.m[0][2];
    for (int i = 0; i < 9 && *determinant < 0; i++)
        c.m[i / 3][i % 3] = -c.m[i / 3][i % 3];
    return c;
}

static void apply(const gltf_affine *a, const double v[3], double to[3])
{
    for (int row = 0; row < 3; row++)
        to[row] = a->m[row][0] * v[0] + a->m[row][1] * v[1] + a->m[row][2] * v[2] + a->m[row][3];
}

static bool is_mirror(const gltf_affine *a)
{
    double determinant;
    (void)normal_transform(a, &determinant);
    return determinant < 0;
}

/* How a primitive's vertices get to their places: by the node's transform, or by those of its skin's joints (3.7.3),
 * which replace it. */
typedef struct placement {
    gltf_affine points, normals;
    bool identity, mirrored;
    const primitive *of;
    gltf_affine *joints; /* by joint of the skin: from the mesh to the world; NULL: no skin */
    size_t joint_count;
    int sets; /* of four joints each */
    gltf_accessor bones[SKIN_SETS_MAX], weights[SKIN_SETS_MAX];
} placement;

static status open_joint(walk *w, gltf_item skin, const gltf_accessor *inverse, size_t k, gltf_affine *out)
{
    double c[16];
    size_t node;
    TRY(listed_node(w->g, skin, "joints", k, &node));
    if (!w->visited[node])
        return gltf_bad(w->g, skin, "joints", "has nodes[%zu], which is not in the scene", node);
    *out = w->world[node];
    if (!inverse->count)
        return STATUS_OK;
    gltf_affine back;
    gltf_accessor_get(inverse, k, c);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            back.m[row][column] = c[4 * column + row];
    *out = compose(&w->world[node], &back);
    return STATUS_OK;
}

static status open_skin(walk *w, gltf_item skin, placement *at)
{
    gltf_file *g = w->g;
    gltf_accessor inverse = {0};
    int64_t index;
    at->joint_count = json_array_size(json_object_get(skin.json, "joints"));
    TRY(gltf_index(g, skin, skin.json, "inverseBindMatrices", "accessors", &index));
    if (index >= 0)
        TRY(gltf_accessor_open(g, skin, index, 16, &inverse));
    if (at->joint_count == 0)
        return gltf_bad(g, skin, "joints", "are none, where a skin needs at least one");
    if (inverse.count && inverse.count < at->joint_count)
        return gltf_bad(g, skin, "joints", "are %zu in number, but there are only %zu inverse bind matrices",
                        at->joint_count, inverse.count);
    at->joints = malloc(at->joint_count * sizeof *at->joints);
    if (!at->joints)
        return no_memory_for(g->req, g->why);
    for (size_t k = 0; k < at->joint_count; k++)
        TRY(open_joint(w, skin, &inverse, k, &at->joints[k]));
    at->mirrored = is_mirror(&at->joints[0]);
    return STATUS_OK;
}

/* The caller frees at->joints, also after an error. */
static status open_placement(walk *w, const primitive *p, size_t node, placement *at)
{
    const gltf_item of = gltf_at(w->g, "nodes", node);
    int64_t skin;
    double determinant;
    *at = (placement){.of = p, .points = w->world[node]};
    at->normals = normal_transform(&at->points, &determinant);
    at->identity = memcmp(&at->points, &IDENTITY, sizeof IDENTITY) == 0;
    at->mirrored = determinant < 0;
    TRY(gltf_index(w->g, of, of.json, "skin", "skins", &skin));
    for (int set = 0; skin >= 0 && set < SKIN_SETS_MAX; set++) {
        char bones[32], weights[32];
        snprintf(bones, sizeof bones, "JOINTS_%d", set);
        snprintf(weights, sizeof weights, "WEIGHTS_%d", set);
        TRY(open_attribute(w->g, p, p->attributes, bones, 4, &at->bones[set]));
        TRY(open_attribute(w->g, p, p->attributes, weights, 4, &at->weights[set]));
        if (!at->bones[set].count || !at->weights[set].count)
            break;
        at->sets = set + 1;
    }
    return at->sets ? open_skin(w, gltf_at(w->g, "skins", (size_t)skin), at) : STATUS_OK;
}

/* The transform of a vertex of a skin: the mean of its joints', by weight. False: it has no weight. */
static bool blend(const placement *at, size_t vertex, gltf_affine *out)
{
    double sum = 0, bones[4], weights[4];
    memset(out, 0, sizeof *out);
    for (int set = 0; set < at->sets; set++) {
        gltf_accessor_get(&at->bones[set], vertex, bones);
        gltf_accessor_get(&at->weights[set], vertex, weights);
        for (int k = 0; k < 4; k++) {
            if (weights[k] == 0 || !(bones[k] >= 0 && bones[k] < (double)at->joint_count))
                continue;
            const gltf_affine *joint = &at->joints[(size_t)bones[k]];
            sum += weights[k];
            for (int i = 0; i < 12; i++)
                out->m[i / 4][i % 4] += weights[k] * joint->m[i / 4][i % 4];
        }
    }
    for (int i = 0; i < 12; i++)
        out->m[i / 4][i % 4] /= sum;
    return sum != 0;
}

/* v of the file increases downwards, 3.8.3; here it increases upwards. */
static void vertex_numbers(flat_mesh *flat, const placement *at, size_t i, double numbers[JOIN_NUMBERS])
{
    const primitive *p = at->of;
    gltf_affine points = at->points, normals = at->normals;
    bool identity = at->identity;
    double v[3], determinant, color[4] = {1, 1, 1, 1};
    memset(numbers, 0, JOIN_NUMBERS * sizeof *numbers);
    if (at->joints) {
        identity = !blend(at, i, &points);
        normals = normal_transform(&points, &determinant);
    }
    gltf_accessor_get(&p->positions, i, numbers);
    if (!identity) {
        memcpy(v, numbers, sizeof v);
        apply(&points, v, numbers);
    }
    if (p->normals.count) {
        gltf_accessor_get(&p->normals, i, numbers + 3);
        if (!identity) {
            memcpy(v, numbers + 3, sizeof v);
            apply(&normals, v, numbers + 3);
        }
    }
    if (p->uvs.count) {
        const double *m = p->map.m;
        gltf_accessor_get(&p->uvs, i, v);
        numbers[6] = m[0] * v[0] + m[1] * v[1] + m[2];
        numbers[7] = 1 - (m[3] * v[0] + m[4] * v[1] + m[5]);
    }
    if (p->colors.count)
        gltf_accessor_get(&p->colors, i, color);
    if (flat->with_colors)
        join_color(flat, color, numbers);
}

/* The corners of a triangle, 3.7.2.1. */
static status triangle_corners(const gltf_file *g, const primitive *p, uint64_t t, uint32_t corners[3])
{
    const uint64_t odd = t & 1;
    const uint64_t at[3][3] = {{3 * t, 3 * t + 1, 3 * t + 2}, {t, t + 1 + odd, t + 2 - odd}, {t + 1, t + 2, 0}};
    for (int k = 0; k < 3; k++) {
        const size_t corner = (size_t)at[p->mode - TRIANGLES][k];
        corners[k] = p->indices.count ? gltf_accessor_index(&p->indices, corner) : (uint32_t)corner;
        if (corners[k] >= p->positions.count)
            return gltf_bad(g, p->mesh, "indices", "have %lu, but there are %zu positions", (unsigned long)corners[k],
                            p->positions.count);
    }
    return STATUS_OK;
}

/* Joins the vertices that triangles use; index[i] is then the new index of vertex i. */
enum { UNUSED = 0, USED = 1 };
static status join_used(walk *w, const primitive *p, const placement *at, uint32_t *index)
{
    double numbers[JOIN_BLOCK][JOIN_NUMBERS];
    uint32_t joined[JOIN_BLOCK], corners[3];
    size_t from[JOIN_BLOCK], count = 0;
    for (uint64_t t = 0; t < p->triangles; t++) {
        TRY(triangle_corners(w->g, p, t, corners));
        for (int k = 0; k < 3; k++)
            index[corners[k]] = USED;
    }
    for (size_t i = 0; i < p->positions.count; i++) {
        if (index[i] == USED) {
            vertex_numbers(w->g->flat, at, i, numbers[count]);
            from[count++] = i;
        }
        if (count < JOIN_BLOCK && i + 1 < p->positions.count)
            continue;
        TRY(join_vertices(w->g->req, &w->join, w->g->flat, numbers, count, joined, w->g->why));
        for (size_t k = 0; k < count; k++)
            index[from[k]] = joined[k];
        count = 0;
    }
    return STATUS_OK;
}

/* A mirroring transform reverses the winding (3.7.4). Strips are turned by triangles with two equal corners, which are
 * left out. */
static status append_triangles(walk *w, const primitive *p, const placement *at, const uint32_t *index)
{
    flat_mesh *flat = w->g->flat;
    const uint8_t slot = w->slot_of[look_of(w->g, p)];
    for (uint64_t t = 0; t < p->triangles; t++) {
        uint32_t c[3];
        TRY(triangle_corners(w->g, p, t, c));
        if (p->mode != TRIANGLES && (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]))
            continue;
        const size_t to = flat->triangle_count++;
        flat->triangles[to][0] = index[c[0]];
        flat->triangles[to][1] = index[c[at->mirrored ? 2 : 1]];
        flat->triangles[to][2] = index[c[at->mirrored ? 1 : 2]];
        flat->slots[to] = slot;
    }
    return STATUS_OK;
}

static status append_primitive(walk *w, const primitive *p, size_t node)
{
    placement at;
    uint32_t *index = calloc(p->positions.count, sizeof *index);
    status code = index ? open_placement(w, p, node, &at) : no_memory_for(w->g->req, w->g->why);
    THEN(code, join_used(w, p, &at, index));
    THEN(code, append_triangles(w, p, &at, index));
    if (index)
        free(at.joints);
    free(index);
    return code;
}

/* --- the file --- */

static status read_scene(walk *w)
{
    gltf_file *g = w->g;
    const size_t nodes = gltf_count(g, "nodes");
    uint32_t *parent_plus_1 = calloc(nodes + 1, sizeof *parent_plus_1);
    w->visited = calloc(nodes + 1, sizeof *w->visited);
    w->world = malloc((nodes + 1) * sizeof *w->world);
    w->used = calloc(look_count(g), sizeof *w->used);
    status code = parent_plus_1 && w->visited && w->world && w->used ? find_parents(g, parent_plus_1)
                                                                     : no_memory_for(g->req, g->why);
    THEN(code, visit_all(w, parent_plus_1, count_primitive));
    THEN(code, flat_reserve(g->req, g->flat, w->triangles, g->why));
    THEN(code, number_slots(w));
    /* few triangles have a vertex for each of them, so that more are seldom left after joining */
    const uint64_t vertices = w->vertices < w->triangles ? w->vertices : w->triangles;
    if (code == STATUS_OK && !join_reserve(&w->join, g->flat, (size_t)vertices))
        code = no_memory_for(g->req, g->why);
    THEN(code, visit_all(w, parent_plus_1, append_primitive));
    if (code == STATUS_OK && g->flat->triangle_count == 0)
        code = flat_reserve(g->req, g->flat, 0, g->why); /* all were left out */
    free(parent_plus_1), free(w->visited), free(w->world), free(w->used), free(w->slot_of), free(w->join.table);
    return code;
}

status gltf_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why)
{
    gltf_file g = {.req = req, .flat = flat, .why = why};
    walk w = {.g = &g};
    status code = gltf_open(&g, text, size);
    THEN(code, read_scene(&w));
    if (code == STATUS_OK && gltf_count(&g, "animations") > 0)
        flat_note(flat, "animations are not played: the model is as the file begins");
    gltf_close(&g);
    return code;
}
