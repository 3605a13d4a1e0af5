/* The fuzzer of mesh files of all formats: the first byte selects the format. assimp, which reads glTF, is not
 * instrumented, and its crashes end only the importer's process in the program; the subject there is what the importer
 * makes of its results. */
#include "import/import.h"
#include "mesh_file.h"
#include <assimp/cimport.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"fuzz.obj", "fuzz.ply", "fuzz.stl", "fuzz.gltf", "fuzz.glb"};
    if (size < 1)
        return 0;
    const file_kind kind = (file_kind)(data[0] % FILE_UNKNOWN);
    if (kind < FILE_GLTF) {
        read_plain(names[kind], kind, data + 1, size - 1);
        return 0;
    }
    fuzz_write(names[kind], data + 1, size - 1);
    char *path = fuzz_path(names[kind]);
    const request req = request_of(path, kind);
    const struct aiScene *scene = NULL;
    flat_mesh flat = {0};
    diagnostic why = {.what = ""};
    status code = read_scene(&req, &scene, &why);
    THEN(code, flatten(&req, scene, &flat, &why));
    if (code == STATUS_OK)
        pass_on(&req, &flat);
    else
        must_refuse(code, &why);
    flat_release(&flat);
    aiReleaseImport(scene);
    free(path);
    return 0;
}
