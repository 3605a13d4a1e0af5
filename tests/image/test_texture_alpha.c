/* Tests of the alpha of textures, against closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/hash.h"
#include "texture_fixture.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A red texel of alpha 1 next to a green one of alpha 0, and a blue row above of alpha 1/2. */
static image *partly_clear(void)
{
    image *img = blank(2, 2);
    assert_int_equal(image_add_alpha(img, NULL), STATUS_OK);
    set(img, 0, 0, 1.0, 0.0, 0.0), set(img, 1, 0, 0.0, 1.0, 0.0);
    set(img, 0, 1, 0.0, 0.0, 1.0), set(img, 1, 1, 0.0, 0.0, 1.0);
    img->alpha[3] = 0.0F, img->alpha[0] = img->alpha[1] = 0.5F;
    return img;
}

static void a_texture_ignores_alpha_and_its_covered_one_weights_colours_by_it(void **state)
{
    (void)state;
    texture *t = owned(partly_clear(), TEXTURE_CLAMP, TEXTURE_TRILINEAR);
    const texture *c = texture_covered(t);
    assert_non_null(c);
    assert_null(texture_covered(c));
    assert_same(texture_sample(t, 0.5, 0.25, 0.0), vec3_make(0.5, 0.5, 0.0), 0.0);
    /* half red of alpha 1 and half green of alpha 0: red, and alpha 1/2 */
    assert_same(texture_sample(c, 0.5, 0.25, 0.0), vec3_make(1.0, 0.0, 0.0), 0.0);
    assert_near(texture_alpha(c, 0.5, 0.25), 0.5, 0.0);
    assert_near(texture_alpha(c, 0.625, 0.25), 0.25, 0.0);
    /* in the middle: red 1/4, green 0, blue 2/4 x 1/2, over alpha 1/4 + 1/4 */
    assert_same(texture_sample(c, 0.5, 0.5, 0.0), vec3_make(0.5, 0.0, 0.5), 1e-15);
    assert_near(texture_alpha(c, 0.5, 0.5), 0.5, 0.0);
    /* the mean of the image in the last level, with the same weights; alpha does not depend on the footprint */
    assert_same(texture_sample(c, 0.9, 0.1, 1.0), vec3_make(0.5, 0.0, 0.5), 1e-7);
    assert_same(texture_sample(t, 0.9, 0.1, 1.0), vec3_make(0.25, 0.25, 0.5), 1e-7);
    texture_release(t);
    t = owned(partly_clear(), TEXTURE_REPEAT, TEXTURE_NEAREST);
    assert_near(texture_alpha(texture_covered(t), 0.7, 0.2), 0.0, 0.0);
    assert_near(texture_alpha(texture_covered(t), 0.2, -0.8), 1.0, 0.0);
    assert_near(texture_alpha(texture_covered(t), (double)NAN, 0.2), 1.0, 0.0);
    texture_release(t);
}

static void alpha_of_1_everywhere_is_no_alpha(void **state)
{
    (void)state;
    image *img = blank(5, 3);
    texture *plain = textured(img, TEXTURE_CLAMP, TEXTURE_TRILINEAR);
    assert_int_equal(image_add_alpha(img, NULL), STATUS_OK);
    texture *full = textured(img, TEXTURE_CLAMP, TEXTURE_TRILINEAR);
    assert_null(texture_covered(full));
    assert_true(texture_hash(full, 1) == texture_hash(plain, 1));
    img->alpha[7] = 0.5F;
    texture *part = owned(img, TEXTURE_CLAMP, TEXTURE_TRILINEAR);
    assert_true(texture_hash(part, 1) != texture_hash(plain, 1));
    texture_release(plain), texture_release(full), texture_release(part);
}

typedef struct packed_bytes {
    unsigned char bytes[512];
    size_t used;
} packed_bytes;

static status put_bytes(void *context, const void *bytes, size_t size, diagnostic *why)
{
    packed_bytes *to = context;
    (void)why;
    assert_true(size <= sizeof to->bytes - to->used);
    memcpy(to->bytes + to->used, bytes, size);
    to->used += size;
    return STATUS_OK;
}

static status get_bytes(void *context, void *bytes, size_t size, diagnostic *why)
{
    packed_bytes *from = context;
    (void)why;
    memcpy(bytes, from->bytes + from->used, size);
    from->used += size;
    return STATUS_OK;
}

static void a_packed_texture_keeps_its_alpha(void **state)
{
    (void)state;
    texture *t = owned(partly_clear(), TEXTURE_CLAMP, TEXTURE_BILINEAR);
    packed_bytes bytes = {.used = 0};
    pack_writer to = {.write = put_bytes, .context = &bytes, .hash = HASH_START};
    const texture *back;
    assert_int_equal(texture_pack(t, &to, NULL), STATUS_OK);
    bytes.used = 0;
    pack_reader from = {.read = get_bytes, .context = &bytes, .left = to.size, .hash = HASH_START};
    assert_int_equal(texture_unpack(&from, &back, NULL), STATUS_OK);
    assert_true(texture_hash(back, 1) == texture_hash(t, 1));
    assert_near(texture_alpha(texture_covered(back), 0.625, 0.25), 0.25, 0.0);
    texture_release(back), texture_release(t);
}

/* Every instruction set tints with the same colours. */
static void covered_colours_do_not_depend_on_the_instruction_set(void **state)
{
    (void)state;
    enum { POINTS = 100 };
    texture_tinter *const tint[ISA_COUNT] = ISA_ARRAY(texture_tint);
    double u[POINTS], v[POINTS], footprint[POINTS];
    for (int k = 0; k < POINTS; k++)
        u[k] = 0.037 * k - 1.0, v[k] = 0.071 * k - 2.0, footprint[k] = 0.01 * k;
    for (texture_filter filter = TEXTURE_NEAREST; filter <= TEXTURE_TRILINEAR; filter++) {
        texture *t = owned(partly_clear(), TEXTURE_MIRROR, filter);
        for (isa level = ISA_BASE; level <= isa_best(); level++) {
            double r[POINTS], g[POINTS], b[POINTS];
            for (int k = 0; k < POINTS; k++)
                r[k] = g[k] = b[k] = 1.0;
            tint[level](texture_covered(t), POINTS, u, v, footprint, r, g, b);
            for (int k = 0; k < POINTS; k++)
                assert_same(vec3_make(r[k], g[k], b[k]), texture_sample(texture_covered(t), u[k], v[k], footprint[k]),
                            0.0);
        }
        texture_release(t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texture_ignores_alpha_and_its_covered_one_weights_colours_by_it),
        cmocka_unit_test(alpha_of_1_everywhere_is_no_alpha),
        cmocka_unit_test(a_packed_texture_keeps_its_alpha),
        cmocka_unit_test(covered_colours_do_not_depend_on_the_instruction_set),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
