/* The fuzzer of the PNG reader, behind the checksums. */
#include "image_fuzz.h"

#ifndef FUZZ_REPLAY
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed)
{
    (void)seed;
    size = LLVMFuzzerMutate(data, size, room);
    fix_png_sums(data, size);
    return size;
}
#endif

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    image *img = NULL;
    char *text = NULL;
    int bits = 0;
    diagnostic why = {.what = ""};
    const status code = codec_png_read(data, size, IMAGE_LIGHT, &img, &bits, &why);
    must(code != STATUS_OK || bits == 8 || bits == 16);
    check_image(code, img, true, &why);
    const status found = image_text_read(data, size, "cuvette scene", 4096, &text, &why);
    must(found == STATUS_OK ? !text || strlen(text) <= 4096 : found == STATUS_BAD_INPUT && !text && why.what[0]);
    free(text);
    return 0;
}
