/* The fuzzer of the importer's own OBJ reader, and its comparison with assimp: what the reader accepts, assimp accepts
 * with the same triangles. */
#include "mesh_file.h"

static bool same_positions(const flat_mesh *a, const flat_mesh *b)
{
    bool same = a->triangle_count == b->triangle_count && a->vertex_count == b->vertex_count;
    for (size_t t = 0; t < a->triangle_count && same; t++)
        for (int k = 0; k < 3 && same; k++)
            same = memcmp(&a->positions[a->triangles[t][k]], &b->positions[b->triangles[t][k]], sizeof(vec3)) == 0;
    return same;
}

static void compare_with_assimp(const request *req, const flat_mesh *own)
{
    const struct aiScene *scene = NULL;
    flat_mesh flat = {0};
    must(read_scene(req, &scene, NULL) == STATUS_OK && flatten(req, scene, &flat, NULL) == STATUS_OK);
    must(same_positions(own, &flat));
    release_flat(&flat);
    aiReleaseImport(scene);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_write("fuzz.obj", data, size);
    char *path = fuzz_path("fuzz.obj");
    const request req = {
        .path = path, .kind = FILE_OBJ, .triangles = 10000, .vertices = 30000, .memory_mib = 1024, .root = ""};
    flat_mesh flat = {0};
    const struct aiScene *scene = NULL;
    if (obj_read(&req, &flat, &scene)) {
        pass_on(&req, scene, &flat);
        compare_with_assimp(&req, &flat);
        release_flat(&flat);
        aiReleaseImport(scene);
    }
    free(path);
    return 0;
}
