/* The libFuzzer entry for scenes of strangers: any bytes are a PNG image or a shared page, the code of a link, or the
 * text of a shared scene. An accepted scene names no files, and can be shared again: the text is then read as the same
 * scene. tests/bad-shared has whole ones to start from, and what was found.
 *   clang -g -O1 -fsanitize=fuzzer,address,undefined ... tests/fuzz_shared.c; ./fuzz_shared CORPUS */
#include "scene/file/shared.h"
#include "base/text.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t room);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed);

static size_t big_endian(const uint8_t *at)
{
    return (size_t)at[0] << 24 | (size_t)at[1] << 16 | (size_t)at[2] << 8 | at[3];
}

/* Random changes alone would stop at the checksums: libpng drops a text whose checksum is wrong. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed)
{
    (void)seed;
    size = LLVMFuzzerMutate(data, size, room);
    if (!image_is_png(data, size))
        return size;
    for (size_t at = 8; size - at >= 12 && big_endian(data + at) <= size - at - 12; at += 12 + big_endian(data + at)) {
        const size_t length = big_endian(data + at);
        const uLong sum = crc32(0, data + at + 4, (uInt)(length + 4));
        for (int i = 0; i < 4; i++)
            data[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
    }
    return size;
}

static void check(status code, scene *s, const diagnostic *why)
{
    if (code != STATUS_OK) {
        if (code != STATUS_BAD_INPUT || s || !why->what[0])
            abort();
        return;
    }
    char *text = NULL, *same = NULL;
    scene *again = NULL;
    if (shared_scene_text(s, &text, NULL) != STATUS_OK || strlen(text) > SHARED_TEXT_MAX ||
        shared_read_text("again", text, strlen(text), &again, NULL) != STATUS_OK ||
        shared_scene_text(again, &same, NULL) != STATUS_OK || strcmp(text, same) != 0)
        abort();
    free(same);
    free(text);
    scene_destroy(again);
    scene_destroy(s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *bytes = (const char *)data;
    scene *s = NULL;
    diagnostic why = {.what = ""};
    if (shared_is_file(bytes, size))
        check(shared_read_file("fuzz", bytes, size, &s, &why), s, &why);
    char *link = memchr(data, 0, size) ? NULL : text_format(SHARED_FRAGMENT "%.*s", (int)size, bytes);
    if (link)
        check(shared_read_link(link, &s, &why), s, &why);
    free(link);
    check(shared_read_text("fuzz", bytes, size, &s, &why), s, &why);
    return 0;
}
