/* The fuzzer of the reader of material libraries, in a mesh that uses three of their names. */
#include "mesh_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char text[] = "mtllib fuzz.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 2 3\nusemtl b\n"
                               "f 1 2 4\nusemtl c d\nf 2 3 4\n";
    fuzz_write("fuzz.mtl", data, size);
    read_plain("mtl.obj", FILE_OBJ, (const uint8_t *)text, sizeof text - 1);
    return 0;
}
