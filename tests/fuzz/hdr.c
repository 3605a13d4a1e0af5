/* The fuzzer of the reader of Radiance's HDR files. */
#include "image_fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 2 || memcmp(data, "#?", 2) != 0)
        return 0; /* image_read does not call it */
    image *img = NULL;
    diagnostic why = {.what = ""};
    const status code = codec_hdr_read(data, size, &img, &why);
    check_image(code, img, false, &why);
    return 0;
}
