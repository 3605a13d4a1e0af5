/* Reads a glTF file with assimp, and flattens its scene to one mesh. */
#include "import/import.h"
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

/* --- reading, and the explanation of errors --- */

/* Equal vertices are joined in flat_mesh.c: assimp's own step also joins vertices that differ by up to 1e-5. */
enum { STEPS = aiProcess_ValidateDataStructure | aiProcess_Triangulate };

/* Reports the position of a JSON error, which assimp does not. True if the file has one. */
static bool locate_json(const request *req, diagnostic *why)
{
    json_error_t error;
    const char *reason;
    const int fd = files_open(req->path, req->root, &reason);
    FILE *stream = fd >= 0 ? fdopen(fd, "rb") : NULL;
    if (!stream)
        return false;
    json_t *root = json_loadf(stream, JSON_REJECT_DUPLICATES, &error);
    fclose(stream);
    if (!root) {
        diagnostic_locate(why, req->path, error.line, error.column);
        diagnose(why, STATUS_BAD_INPUT, "repair the JSON, or export the file again", "%s", error.text);
    }
    return !root;
}

/* Converts an error message of assimp to a diagnostic. */
static status explain(const request *req, const file_access *access, const char *message, diagnostic *why)
{
    diagnostic_locate(why, req->path, 0, 0);
    if (access->missing[0])
        return files_needed(access, why);
    if (strstr(message, "bad_alloc") || strstr(message, "length_error") || strstr(message, "bad_array_new_length") ||
        strstr(message, "_M_") || strstr(message, "max_size"))
        return no_memory_for(req, why);
    if (req->kind == FILE_GLTF && locate_json(req, why))
        return STATUS_BAD_INPUT;
    if (!*message || strstr(message, "No suitable reader"))
        return diagnose(why, STATUS_BAD_INPUT, "check that the file is complete and has the right ending",
                        "this is not a file of format %s",
                        req->kind == FILE_GLTF ? "glTF 2.0" : "binary glTF 2.0 (glb)");
    return diagnose(why, STATUS_BAD_INPUT, "repair the file or export it again", "cannot read: %.300s", message);
}

status read_scene(const request *req, const struct aiScene **out, diagnostic *why)
{
    file_access access;
    diagnostic_locate(why, req->path, 0, 0);
    TRY(files_check(req, why));
    files_prepare(&access, req);
    const struct aiScene *scene = aiImportFileEx(req->path, STEPS, &access.io);
    if (!scene || access.missing[0]) {
        const char *message = scene ? "" : aiGetErrorString();
        return explain(req, &access, message ? message : "", why);
    }
    *out = scene;
    return STATUS_OK;
}

/* --- flattening ---
 *
 * Every mesh is transformed to world coordinates, in double precision. A mesh without a transform keeps the exact
 * numbers of the file. */

enum { DEPTH_MAX = 1000 }; /* nesting of nodes */

typedef struct affine {
    double m[3][4];
} affine;

typedef struct walk {
    const request *req;
    const struct aiScene *scene;
    flat_mesh *flat;
    joiner join;
    uint64_t triangles; /* counted by the first traversal, like vertices: those of meshes with triangles */
    uint64_t vertices;
    uint16_t slot_of[65536]; /* by material: slot + 1, or 0 if unused */
    diagnostic *why;
    status (*visit)(struct walk *w, const struct aiMesh *mesh, const affine *place);
} walk;

static affine compose(const affine *a, const struct aiMatrix4x4 *b)
{
    double c[4][4] = {
        {b->a1, b->a2, b->a3, b->a4}, {b->b1, b->b2, b->b3, b->b4}, {b->c1, b->c2, b->c3, b->c4}, {0, 0, 0, 1}};
    affine product;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += a->m[row][k] * c[k][column];
            product.m[row][column] = sum;
        }
    }
    return product;
}

static status visit_node(walk *w, const struct aiNode *node, const affine *parent, int depth)
{
    if (depth > DEPTH_MAX)
        return diagnose(w->why, STATUS_BAD_INPUT, "flatten the hierarchy in the program that made the file",
                        "nodes are nested more than %d deep", DEPTH_MAX);
    affine place = compose(parent, &node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        TRY(w->visit(w, w->scene->mMeshes[node->mMeshes[i]], &place));
    for (unsigned i = 0; i < node->mNumChildren; i++)
        TRY(visit_node(w, node->mChildren[i], &place, depth + 1));
    return STATUS_OK;
}

static status visit_all(walk *w, status (*visit)(walk *, const struct aiMesh *, const affine *))
{
    static const affine identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    w->visit = visit;
    return visit_node(w, w->scene->mRootNode, &identity, 0);
}

/* ---- first traversal: count triangles, find materials and attributes ---- */

static status count_mesh(walk *w, const struct aiMesh *mesh, const affine *place)
{
    (void)place;
    uint64_t before = w->triangles;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        w->triangles += mesh->mFaces[i].mNumIndices == 3;
    if (w->triangles == before)
        return STATUS_OK;
    if (mesh->mMaterialIndex >= w->scene->mNumMaterials ||
        mesh->mMaterialIndex >= sizeof w->slot_of / sizeof *w->slot_of) {
        return diagnose(w->why, STATUS_BAD_INPUT, "repair the file or export it again",
                        "a part refers to a missing material");
    }
    w->vertices += mesh->mNumVertices;
    w->slot_of[mesh->mMaterialIndex] = 1;
    w->flat->with_normals |= mesh->mNormals != NULL;
    w->flat->with_uvs |= mesh->mTextureCoords[0] != NULL;
    return STATUS_OK;
}

/* ---- materials ---- */

static void get_color(const struct aiMaterial *material, const char *key, double to[3], float *alpha)
{
    struct aiColor4D color = {0, 0, 0, 1};
    if (aiGetMaterialColor(material, key, 0, 0, &color) == aiReturn_SUCCESS) {
        memcpy(to, (double[3]){color.r, color.g, color.b}, 3 * sizeof *to);
        *alpha = color.a;
    }
}

static void get_number(const struct aiMaterial *material, const char *key, double *to)
{
    float value;
    if (aiGetMaterialFloatArray(material, key, 0, 0, &value, NULL) == aiReturn_SUCCESS)
        *to = (double)value;
}

/* For triangles without a material assimp adds a default one after all others. */
static bool is_given(const struct aiScene *scene, unsigned index, const struct aiString *name)
{
    return index + 1 != scene->mNumMaterials && strcmp(name->data, AI_DEFAULT_MATERIAL_NAME) != 0;
}

static status add_material(const walk *w, unsigned index, uint8_t *slot)
{
    const struct aiMaterial *material = w->scene->mMaterials[index];
    mesh_wire_material m = {.diffuse = {1, 1, 1}, .opacity = 1, .ior = 1};
    float alpha = 1, unused;
    double strength = 1; /* glTF's KHR_materials_emissive_strength */
    struct aiString name, texture;
    if (aiGetMaterialString(material, AI_MATKEY_NAME, &name) != aiReturn_SUCCESS)
        name = (struct aiString){0}; /* assimp leaves it undefined on failure */
    get_color(material, "$clr.diffuse", m.diffuse, &alpha);
    get_color(material, "$clr.ambient", m.ambient, &unused);
    get_color(material, "$clr.specular", m.specular, &unused);
    get_color(material, "$clr.emissive", m.emissive, &unused);
    get_number(material, "$mat.emissiveIntensity", &strength);
    for (int c = 0; c < 3; c++)
        m.emissive[c] *= strength;
    get_number(material, "$mat.shininess", &m.shininess);
    get_number(material, "$mat.refracti", &m.ior);
    m.opacity = (double)alpha;
    get_number(material, "$mat.opacity", &m.opacity);
    const bool textured = aiGetMaterialTexture(material, aiTextureType_DIFFUSE, 0, &texture, NULL, NULL, NULL, NULL,
                                               NULL, NULL) == aiReturn_SUCCESS,
               inside = textured && texture.data[0] == '*'; /* the index of an image inside the file */
    const bool given = is_given(w->scene, index, &name);
    m.flags = (given ? MESH_WIRE_GIVEN : 0u) | (inside ? MESH_WIRE_TEXTURE_INSIDE : 0u);
    return flat_material(w->req, w->flat, &m, given ? name.data : NULL, textured && !inside ? texture.data : NULL, slot,
                         w->why);
}

static status number_slots(walk *w)
{
    for (unsigned i = 0; i < sizeof w->slot_of / sizeof *w->slot_of; i++) {
        uint8_t slot;
        if (!w->slot_of[i])
            continue;
        TRY(add_material(w, i, &slot));
        w->slot_of[i] = (uint16_t)(slot + 1);
    }
    return STATUS_OK;
}

/* ---- second traversal: copy vertices and triangles ---- */

static bool is_identity(const affine *a)
{
    static const affine identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    return memcmp(a, &identity, sizeof identity) == 0;
}

/* The transform of normals: the inverse transpose, up to a positive factor. It is the matrix of cofactors divided by
 * the determinant, and only the determinant's sign matters. */
static affine normal_transform(const affine *a, double *determinant)
{
    affine c = {0};
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

static void apply(const affine *a, struct aiVector3D v, double to[3])
{
    for (int row = 0; row < 3; row++)
        to[row] = a->m[row][0] * (double)v.x + a->m[row][1] * (double)v.y + a->m[row][2] * (double)v.z + a->m[row][3];
}

typedef struct node_transform {
    affine points, normals;
    bool identity, mirrored;
} node_transform;

static void vertex_numbers(const walk *w, const struct aiMesh *mesh, const node_transform *at, unsigned i,
                           double numbers[8])
{
    memset(numbers, 0, 8 * sizeof *numbers);
    struct aiVector3D p = mesh->mVertices[i];
    memcpy(numbers, (double[3]){p.x, p.y, p.z}, 3 * sizeof *numbers);
    if (!at->identity)
        apply(&at->points, p, numbers);
    if (w->flat->with_normals && mesh->mNormals) {
        struct aiVector3D n = mesh->mNormals[i];
        memcpy(numbers + 3, (double[3]){n.x, n.y, n.z}, 3 * sizeof *numbers);
        if (!at->identity)
            apply(&at->normals, n, numbers + 3);
    }
    if (mesh->mTextureCoords[0]) {
        numbers[6] = (double)mesh->mTextureCoords[0][i].x;
        numbers[7] = (double)mesh->mTextureCoords[0][i].y;
    }
}

/* Sets index[i] to USED for each vertex i of a triangle. */
enum { UNUSED = 0, USED = 1 };
static status mark_used(walk *w, const struct aiMesh *mesh, uint32_t *index)
{
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        for (unsigned k = 0; face->mNumIndices == 3 && k < 3; k++) {
            if (face->mIndices[k] >= mesh->mNumVertices)
                return diagnose(w->why, STATUS_BAD_INPUT, "repair the file or export it again",
                                "a triangle refers to vertex %u of %u", face->mIndices[k], mesh->mNumVertices);
            index[face->mIndices[k]] = USED;
        }
    }
    return STATUS_OK;
}

/* Joins the vertices that the mesh's triangles use; index[i] is set to the new index of vertex i. */
static status join_used(walk *w, const struct aiMesh *mesh, const node_transform *at, uint32_t *index)
{
    double numbers[JOIN_BLOCK][8];
    uint32_t joined[JOIN_BLOCK];
    unsigned from[JOIN_BLOCK];
    size_t count = 0;
    TRY(mark_used(w, mesh, index));
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        if (index[i] == USED) {
            vertex_numbers(w, mesh, at, i, numbers[count]);
            from[count++] = i;
        }
        if (count < JOIN_BLOCK && i + 1 < mesh->mNumVertices)
            continue;
        TRY(join_vertices(w->req, &w->join, w->flat, numbers, count, joined, w->why));
        for (size_t k = 0; k < count; k++)
            index[from[k]] = joined[k];
        count = 0;
    }
    return STATUS_OK;
}

static status append_mesh(walk *w, const struct aiMesh *mesh, const affine *place)
{
    double determinant;
    node_transform at = {
        .points = *place, .normals = normal_transform(place, &determinant), .identity = is_identity(place)};
    at.mirrored = determinant < 0;
    uint32_t *index = calloc((size_t)mesh->mNumVertices + 1, sizeof *index);
    if (!index)
        return no_memory_for(w->req, w->why);
    status code = join_used(w, mesh, &at, index);
    for (unsigned f = 0; f < mesh->mNumFaces && code == STATUS_OK; f++) {
        const unsigned *corner = mesh->mFaces[f].mIndices;
        if (mesh->mFaces[f].mNumIndices == 3) {
            size_t t = w->flat->triangle_count++;
            w->flat->triangles[t][0] = index[corner[0]];
            w->flat->triangles[t][1] =
                index[corner[at.mirrored ? 2 : 1]]; /* a mirrored transform reverses the winding */
            w->flat->triangles[t][2] = index[corner[at.mirrored ? 1 : 2]];
            w->flat->slots[t] = (uint8_t)(w->slot_of[mesh->mMaterialIndex] - 1);
        }
    }
    free(index);
    return code;
}

status flatten(const request *req, const struct aiScene *scene, flat_mesh *flat, diagnostic *why)
{
    walk w = {.req = req, .scene = scene, .flat = flat, .why = why};
    diagnostic_locate(why, req->path, 0, 0);
    status code = scene->mRootNode ? visit_all(&w, count_mesh) : STATUS_OK;
    THEN(code, flat_reserve(req, flat, w.triangles, why));
    THEN(code, number_slots(&w));
    /* few triangles have a vertex for each of them, so that more are seldom left after joining */
    const uint64_t vertices = w.vertices < w.triangles ? w.vertices : w.triangles;
    if (code == STATUS_OK && !join_reserve(&w.join, flat, (size_t)vertices))
        code = no_memory_for(req, why);
    THEN(code, visit_all(&w, append_mesh));
    free(w.join.table);
    return code;
}
