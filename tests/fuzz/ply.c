/* The fuzzer of the reader of PLY files. */
#include "mesh_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_plain("fuzz.ply", FILE_PLY, data, size);
    return 0;
}
