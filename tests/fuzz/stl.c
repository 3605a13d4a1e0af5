/* The fuzzer of the reader of STL files. */
#include "mesh_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_plain("fuzz.stl", FILE_STL, data, size);
    return 0;
}
