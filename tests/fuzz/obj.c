/* The fuzzer of the reader of OBJ files, without material libraries. */
#include "mesh_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_plain("fuzz.obj", FILE_OBJ, data, size);
    return 0;
}
