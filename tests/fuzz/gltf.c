/* The fuzzer of the reader of glTF files, binary ones and JSON. */
#include "mesh_file.h"
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size >= 4 && memcmp(data, "glTF", 4) == 0)
        read_plain("fuzz.glb", FILE_GLB, data, size);
    else
        read_plain("fuzz.gltf", FILE_GLTF, data, size);
    return 0;
}
