/* The fuzzer of the OpenEXR reader. */
#include "image_fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!image_holds_text(data, size) || image_is_png(data, size))
        return 0; /* image_read does not call it */
    image *img = NULL;
    diagnostic why = {.what = ""};
    const status code = codec_exr_read(data, size, &img, &why);
    check_image(code, img, false, &why);
    char *text = NULL;
    const status found = codec_exr_text(data, size, "Cuvette scene", 4096, &text, &why);
    if (found != STATUS_OK)
        must_refuse(found, &why);
    free(text);
    return 0;
}
