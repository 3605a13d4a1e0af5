/* The fuzzer of mesh files read with assimp: the first byte selects the format. assimp itself is not instrumented, and
 * its crashes end only the importer's process in the program; the subject here is what the importer makes of its
 * results. */
#include "mesh_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"fuzz.obj", "fuzz.ply", "fuzz.stl", "fuzz.gltf", "fuzz.glb"};
    if (size < 1)
        return 0;
    const file_kind kind = (file_kind)(data[0] % FILE_UNKNOWN);
    fuzz_write(names[kind], data + 1, size - 1);
    char *path = fuzz_path(names[kind]);
    const request req = {
        .path = path, .kind = kind, .triangles = 10000, .vertices = 30000, .memory_mib = 1024, .root = fuzz_folder()};
    const struct aiScene *scene = NULL;
    flat_mesh flat = {0};
    diagnostic why = {.what = ""};
    status code = read_scene(&req, &scene, &why);
    THEN(code, flatten(&req, scene, &flat, &why));
    if (code == STATUS_OK)
        pass_on(&req, scene, &flat);
    else
        must_refuse(code, &why);
    release_flat(&flat);
    aiReleaseImport(scene);
    free(path);
    return 0;
}
