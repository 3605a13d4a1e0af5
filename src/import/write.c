/* The writer of the wire format, and the conversion of assimp materials. */
#include "import/import.h"

#include <assimp/material.h>
#include <errno.h>
#include <string.h>

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

/* Whether the file defines the material. For triangles without a material assimp adds a default one: with the name
 * below; in a PLY file without a name; in a glTF file after all others. */
static bool is_given(const request *req, const struct aiScene *scene, unsigned index, const struct aiString *name)
{
    bool gltf = req->kind == FILE_GLTF || req->kind == FILE_GLB;
    return !(gltf && index + 1 == scene->mNumMaterials) && strcmp(name->data, AI_DEFAULT_MATERIAL_NAME) != 0 &&
           (name->length > 0 || req->kind != FILE_PLY);
}

static mesh_wire_material describe(const request *req, const struct aiScene *scene, unsigned index,
                                   struct aiString *name, struct aiString *texture)
{
    const struct aiMaterial *material = scene->mMaterials[index];
    mesh_wire_material m = {.diffuse = {1, 1, 1}, .opacity = 1, .ior = 1};
    float alpha = 1, unused;
    double strength = 1; /* glTF's KHR_materials_emissive_strength */
    *name = *texture = (struct aiString){0};
    if (aiGetMaterialString(material, AI_MATKEY_NAME, name) != aiReturn_SUCCESS)
        *name = (struct aiString){0}; /* assimp leaves it undefined on failure */
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
    if (aiGetMaterialTexture(material, aiTextureType_DIFFUSE, 0, texture, NULL, NULL, NULL, NULL, NULL, NULL) !=
        aiReturn_SUCCESS)
        *texture = (struct aiString){0};
    m.flags = is_given(req, scene, index, name) ? MESH_WIRE_GIVEN : 0;
    if (texture->data[0] == '*') { /* the index of an image inside the file */
        m.flags |= MESH_WIRE_TEXTURE_INSIDE;
        *texture = (struct aiString){0};
    }
    if (!(m.flags & MESH_WIRE_GIVEN))
        *name = (struct aiString){0};
    m.name_length = (uint32_t)strnlen(name->data, MESH_WIRE_TEXT_MAX);
    m.texture_length = (uint32_t)strnlen(texture->data, MESH_WIRE_TEXT_MAX);
    return m;
}

static void write_materials(const request *req, const struct aiScene *scene, const flat_mesh *flat, FILE *to)
{
    for (unsigned i = 0; i < flat->material_count; i++) {
        struct aiString name, texture;
        mesh_wire_material record = describe(req, scene, flat->materials[i], &name, &texture);
        fwrite(&record, sizeof record, 1, to);
        fwrite(name.data, 1, record.name_length, to);
        fwrite(texture.data, 1, record.texture_length, to);
    }
}

status write_mesh(const request *req, const struct aiScene *scene, const flat_mesh *flat, FILE *to, diagnostic *why)
{
    mesh_wire_header header = {
        .magic = MESH_WIRE_MAGIC,
        .version = MESH_WIRE_VERSION,
        .vertex_count = flat->vertex_count,
        .triangle_count = flat->triangle_count,
        .flags = (flat->with_normals ? MESH_WIRE_NORMALS : 0u) | (flat->with_uvs ? MESH_WIRE_UVS : 0u),
        .material_count = flat->material_count,
    };
    fwrite(&header, sizeof header, 1, to);
    fwrite(flat->positions, sizeof *flat->positions, flat->vertex_count, to);
    if (flat->with_normals)
        fwrite(flat->normals, sizeof *flat->normals, flat->vertex_count, to);
    if (flat->with_uvs)
        fwrite(flat->uvs, sizeof *flat->uvs, flat->vertex_count, to);
    fwrite(flat->triangles, sizeof *flat->triangles, flat->triangle_count, to);
    fwrite(flat->slots, 1, flat->triangle_count, to);
    write_materials(req, scene, flat, to);
    fwrite(MESH_WIRE_END, 1, sizeof MESH_WIRE_END - 1, to);
    if (fflush(to) != 0 || ferror(to)) {
        const char *reason = strerrordesc_np(errno);
        return diagnose_at(why, NULL, STATUS_FAILURE, "write to a pipe", "cannot write to standard output: %s",
                           reason ? reason : "unknown error");
    }
    return STATUS_OK;
}
