/* Tests of animated PNG: the chunks and their checksums, the frames as rebuilt PNG files, and a delay that does not fit
 * 16 bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/video.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { WIDE = 37, HIGH = 21, FRAMES = 3 };

static image *frame_image(int number)
{
    image *img = NULL;
    assert_int_equal(image_create(WIDE, HIGH, &img, NULL), STATUS_OK);
    for (size_t i = 0; i < 3 * WIDE * HIGH; i++)
        img->pixel[i] = (float)((i * 7 + (size_t)number * 31) % 256) / 255.0F;
    return img;
}

static unsigned char *film(int64_t fps_num, int64_t fps_den, size_t *size)
{
    char *bytes = NULL;
    FILE *stream = open_memstream(&bytes, size);
    apng a = {.stream = stream, .frames = FRAMES, .fps_num = fps_num, .fps_den = fps_den};
    for (int i = 0; i < FRAMES; i++) {
        image *img = frame_image(i);
        assert_int_equal(apng_frame(&a, img, NULL), STATUS_OK);
        image_destroy(img);
    }
    assert_int_equal(fclose(stream), 0);
    return (unsigned char *)bytes;
}

static uint32_t word(const unsigned char *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* The chunks as their types, one after the other; repeated IDAT and fdAT once. */
static void read_chunks(const unsigned char *bytes, size_t size, char *types, uint32_t *sequence)
{
    *types = 0;
    for (size_t at = 8; at < size;) {
        const uint32_t length = word(bytes + at);
        const unsigned char *type = bytes + at + 4;
        assert_true(at + 12 + length <= size);
        assert_int_equal(crc32(0, type, length + 4), word(type + 4 + length));
        if (memcmp(type, "fcTL", 4) == 0 || memcmp(type, "fdAT", 4) == 0)
            assert_int_equal(word(type + 4), (*sequence)++);
        if (strlen(types) < 4 || memcmp(types + strlen(types) - 4, type, 4) != 0)
            strncat(types, (const char *)type, 4);
        at += 12 + length;
    }
}

static void chunks_are_in_order_with_checksums_and_numbers(void **state)
{
    (void)state;
    size_t size;
    char types[256];
    uint32_t sequence = 0;
    unsigned char *bytes = film(25, 1, &size);
    read_chunks(bytes, size, types, &sequence);
    assert_string_equal(types, "IHDRsRGBacTLfcTLIDATfcTLfdATfcTLfdATIEND");
    assert_true(sequence >= 5);
    free(bytes);
}

static void other_programs_read_the_first_frame(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = film(25, 1, &size);
    char path[] = "/tmp/cuvette-apng-XXXXXX";
    const int file = mkstemp(path);
    assert_int_equal(write(file, bytes, size), size);
    close(file);
    image *first = frame_image(0), *seen = NULL;
    assert_int_equal(image_read(path, &seen, NULL, NULL), STATUS_OK);
    for (size_t i = 0; i < 3 * WIDE * HIGH; i++)
        assert_true((int)(srgb_encode(seen->pixel[i]) * 255.0 + 0.5) ==
                    (int)(srgb_encode(first->pixel[i]) * 255.0 + 0.5));
    unlink(path);
    image_destroy(first);
    image_destroy(seen);
    free(bytes);
}

static void delay_of(int64_t fps_num, int64_t fps_den, int num, int den)
{
    size_t size;
    unsigned char *bytes = film(fps_num, fps_den, &size), *control = bytes;
    while (memcmp(control, "fcTL", 4) != 0)
        control++;
    const unsigned char *delay = control + 24;
    assert_int_equal(delay[0] << 8 | delay[1], num);
    assert_int_equal(delay[2] << 8 | delay[3], den);
    free(bytes);
}

static void a_frame_lasts_as_the_rate_says(void **state)
{
    (void)state;
    delay_of(25, 1, 1, 25);
    delay_of(30000, 1001, 1001, 30000);
    delay_of(1000000, 33333, 33, 1000); /* in ms */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chunks_are_in_order_with_checksums_and_numbers),
        cmocka_unit_test(other_programs_read_the_first_frame),
        cmocka_unit_test(a_frame_lasts_as_the_rate_says),
    };
    return cmocka_run_group_tests_name("apng", tests, NULL, NULL);
}
