/* Tests of textures against closed forms: texels at their centres, ramps between them, the box-filtered mipmap, and IEC
 * 61966-2-1. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "texture_fixture.h"
#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/isa.h"
#include "random_stream.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static image *noise(int width, int height)
{
    image *img = blank(width, height);
    uint64_t s = 7;
    for (int i = 0; i < 3 * width * height; i++)
        img->pixel[i] = (float)random_real(&s, 0.0, 1.0);
    return img;
}

static const texture_wrap wraps[] = {TEXTURE_REPEAT, TEXTURE_MIRROR, TEXTURE_CLAMP};
static const texture_filter filters[] = {TEXTURE_NEAREST, TEXTURE_BILINEAR, TEXTURE_TRILINEAR};
static const int sizes[][2] = {{1, 1}, {1, 8}, {7, 1}, {1, 2}, {3, 5}, {5, 3}, {8, 8}, {16, 4}, {13, 31}, {64, 33}};

static void texel_centres_return_the_texels_from_the_lowest_row(void **state)
{
    (void)state;
    for (size_t s = 0; s < COUNT(sizes); s++) {
        int width = sizes[s][0], height = sizes[s][1];
        image *img = noise(width, height);
        for (size_t f = 0; f < COUNT(filters); f++) {
            for (size_t w = 0; w < COUNT(wraps); w++) {
                texture *t = textured(img, wraps[w], filters[f]);
                for (int i = 0; i < width * height; i++) {
                    int x = i % width, y = i / width;
                    const float *p = img->pixel + ((height - 1 - y) * width + x) * 3;
                    vec3 c = texture_sample(t, (x + 0.5) / width, (y + 0.5) / height, 0.0);
                    /* a centre is exact if the size is a power of two; otherwise its error is about 1e-16 */
                    int exact =
                        filters[f] == TEXTURE_NEAREST || ((width & (width - 1)) == 0 && (height & (height - 1)) == 0);
                    assert_same(c, vec3_make((double)p[0], (double)p[1], (double)p[2]), exact ? 0.0 : 1e-13);
                }
                texture_release(t);
            }
        }
        image_destroy(img);
    }
}

static void the_lower_left_corner_of_the_image_is_the_origin(void **state)
{
    (void)state;
    image *img = blank(4, 2);
    for (int i = 0; i < 24; i++)
        img->pixel[i] = (float)i; /* rows from the top: pixel 4 is the left one of the lower row */
    texture *t = owned(img, TEXTURE_CLAMP, TEXTURE_NEAREST);
    assert_same(texture_sample(t, 0.0, 0.0, 0.0), vec3_make(12.0, 13.0, 14.0), 0.0);
    assert_same(texture_sample(t, 1.0, 0.0, 0.0), vec3_make(21.0, 22.0, 23.0), 0.0);
    assert_same(texture_sample(t, 0.0, 1.0, 0.0), vec3_make(0.0, 1.0, 2.0), 0.0);
    assert_same(texture_sample(t, 1.0, 1.0, 0.0), vec3_make(9.0, 10.0, 11.0), 0.0);
    assert_same(texture_texel(t, 0, 0, 0), vec3_make(12.0, 13.0, 14.0), 0.0);
    texture_release(t);
}

static void bilinear_interpolates_between_centres_and_nearest_changes_at_the_edge(void **state)
{
    (void)state;
    image *img = blank(2, 2);
    set(img, 0, 0, 0.25, 1, 0);
    set(img, 1, 0, 0.75, 0, 0);
    set(img, 0, 1, 2.0, 0, 0);
    set(img, 1, 1, 5.0, 0, 1);
    texture *t = textured(img, TEXTURE_CLAMP, TEXTURE_BILINEAR);
    assert_same(texture_sample(t, 0.5, 0.25, 0.0), vec3_make(0.5, 0.5, 0.0), 0.0);
    assert_same(texture_sample(t, 0.25, 0.5, 0.0), vec3_make(1.125, 0.5, 0.0), 0.0);
    assert_same(texture_sample(t, 0.5, 0.5, 0.0), vec3_make(2.0, 0.25, 0.25), 0.0);
    /* a quarter of the way to the right, half up: (3/4) (1/4 + 2)/2 + (1/4) (3/4 + 5)/2 */
    assert_near(texture_sample(t, 0.375, 0.5, 0.0).x, 0.84375 + 0.71875, 0.0);
    texture_release(t);
    t = owned(img, TEXTURE_CLAMP, TEXTURE_NEAREST);
    assert_near(texture_sample(t, nextafter(0.5, 0.0), 0.1, 0.0).x, 0.25, 0.0);
    assert_near(texture_sample(t, 0.5, 0.1, 0.0).x, 0.75, 0.0);
    texture_release(t);
}

/* Texel (x, y) is 13 + 5 x - 2 y, in texels: u = (x + 1/2) / w gives 13 + 5 (u w - 1/2) - 2 (v h - 1/2) between the
 * centres. */
static void bilinear_filtering_reproduces_a_linear_ramp_and_clamps_outside(void **state)
{
    (void)state;
    const int width = 16, height = 6;
    image *img = blank(width, height);
    for (int i = 0; i < width * height; i++)
        set(img, i % width, i / width, 13 + 5 * (i % width) - 2 * (i / width), i % width, i / width);
    texture *t = owned(img, TEXTURE_CLAMP, TEXTURE_BILINEAR);
    for (int i = 0; i <= 200; i++) {
        for (int j = 0; j <= 20; j++) {
            double u = i / 200.0, v = j / 20.0;
            double x = fmin(fmax(u * width - 0.5, 0.0), width - 1.0),
                   y = fmin(fmax(v * height - 0.5, 0.0), height - 1.0);
            assert_same(texture_sample(t, u, v, 0.0), vec3_make(13.0 + 5.0 * x - 2.0 * y, x, y), 1e-13);
        }
    }
    texture_release(t);
}

/* The texel of four at cell k of the infinite row, by hand. */
static const struct {
    texture_wrap wrap;
    int first, texels[14];
} rows[] = {
    {TEXTURE_REPEAT, -5, {3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0}},
    {TEXTURE_MIRROR, -5, {3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0}},
    {TEXTURE_CLAMP, -5, {0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3}},
};

static void wrap_modes_place_the_texels_on_both_sides_of_the_seams(void **state)
{
    (void)state;
    image *along_u = blank(4, 1), *along_v = blank(1, 4);
    for (int i = 0; i < 4; i++) {
        set(along_u, i, 0, i, 0, 0);
        set(along_v, 0, i, i, 0, 0);
    }
    for (size_t r = 0; r < COUNT(rows); r++) {
        texture *near_u = textured(along_u, rows[r].wrap, TEXTURE_NEAREST),
                *near_v = textured(along_v, rows[r].wrap, TEXTURE_NEAREST);
        texture *soft_u = textured(along_u, rows[r].wrap, TEXTURE_BILINEAR),
                *soft_v = textured(along_v, rows[r].wrap, TEXTURE_BILINEAR);
        for (int k = 0; k < 14; k++) {
            double here = rows[r].texels[k], centre = (rows[r].first + k + 0.5) / 4.0;
            for (double off = -0.49; off < 0.5; off += 0.07) {
                assert_near(texture_sample(near_u, centre + off / 4.0, 0.3, 0.0).x, here, 0.0);
                assert_near(texture_sample(near_v, -7.7, centre + off / 4.0, 0.0).x, here, 0.0);
            }
            assert_near(texture_sample(soft_u, centre, 0.9, 0.0).x, here, 0.0);
            assert_near(texture_sample(soft_v, 0.2, centre, 0.0).x, here, 0.0);
            for (double part = 0.125; k < 13 && part < 1.0;
                 part += 0.125) { /* on both sides of the border of two cells */
                double expected = here + part * (rows[r].texels[k + 1] - here);
                assert_near(texture_sample(soft_u, centre + part / 4.0, 0.0, 0.0).x, expected, 0.0);
                assert_near(texture_sample(soft_v, 3.0, centre + part / 4.0, 0.0).x, expected, 0.0);
            }
        }
        texture_release(near_u);
        texture_release(near_v);
        texture_release(soft_u);
        texture_release(soft_v);
    }
    image_destroy(along_u);
    image_destroy(along_v);
}

static void the_wrap_modes_of_the_axes_are_independent(void **state)
{
    (void)state;
    image *img = blank(4, 4);
    for (int i = 0; i < 16; i++)
        set(img, i % 4, i / 4, i % 4, i / 4, 0);
    for (int i = 0; i < 9; i++) {
        texture *t;
        assert_int_equal(texture_create(img, rows[i / 3].wrap, rows[i % 3].wrap, TEXTURE_BILINEAR, &t, NULL),
                         STATUS_OK);
        for (int k = 0; k < 14 * 14; k++) {
            vec3 c = texture_sample(t, (k % 14 - 4.5) / 4.0, (k / 14 - 4.5) / 4.0, 0.0);
            assert_same(c, vec3_make(rows[i / 3].texels[k % 14], rows[i % 3].texels[k / 14], 0.0), 0.0);
        }
        texture_release(t);
    }
    image_destroy(img);
}

static void a_mirrored_texture_is_symmetric_about_integers(void **state)
{
    (void)state;
    for (size_t f = 0; f < COUNT(filters); f++) {
        texture *t = owned(noise(7, 4), TEXTURE_MIRROR, filters[f]);
        for (int i = 0; i < 400; i++) {
            double u = i * 0.01234, v = i * 0.0071, footprint = 0.3;
            vec3 c = texture_sample(t, u, v, footprint);
            assert_same(texture_sample(t, -u, v, footprint), c, 0.0);
            assert_same(texture_sample(t, u, -v, footprint), c, 0.0);
            assert_same(texture_sample(t, 2.0 - u, v, footprint), c, filters[f] == TEXTURE_NEAREST ? 0.0 : 1e-13);
            assert_same(texture_sample(t, 4.0 + u, v, footprint), c, filters[f] == TEXTURE_NEAREST ? 0.0 : 1e-13);
        }
        texture_release(t);
    }
}

static void each_level_has_half_the_size_and_the_mean_of_the_image(void **state)
{
    (void)state;
    for (size_t s = 0; s < COUNT(sizes); s++) {
        int width = sizes[s][0], height = sizes[s][1];
        image *img = noise(width, height);
        double sum[3] = {0.0, 0.0, 0.0};
        for (int i = 0; i < 3 * width * height; i++)
            sum[i % 3] += (double)img->pixel[i] / (width * height);
        texture *t = owned(img, TEXTURE_REPEAT, TEXTURE_TRILINEAR);
        for (int level = 0; level < texture_levels(t); level++) {
            int w, h;
            level_size(t, level, &w, &h);
            assert_int_equal(w, width >> level > 1 ? width >> level : 1);
            assert_int_equal(h, height >> level > 1 ? height >> level : 1);
            assert_true(level == texture_levels(t) - 1 ? w == 1 && h == 1 : w > 1 || h > 1);
            vec3 mean = vec3_make(0.0, 0.0, 0.0);
            for (int i = 0; i < w * h; i++)
                mean = vec3_add(mean, vec3_scale(texture_texel(t, level, i % w, i / w), 1.0 / (w * h)));
            /* Texels are floats: 2^-24 a level. */
            assert_same(mean, vec3_make(sum[0], sum[1], sum[2]), 6e-8 * level + 1e-14);
        }
        texture_release(t);
    }
}

/* A row of five becomes two texels of 2.5 each, then their mean; one of three becomes one. */
static void texels_of_odd_sizes_are_weighted_by_area(void **state)
{
    (void)state;
    image *img = blank(5, 3);
    for (int i = 0; i < 15; i++)
        set(img, i % 5, i / 5, i % 5 == 0, i % 5 == 2, (i % 5 == 4) * (i / 5 == 1));
    texture *t = owned(img, TEXTURE_CLAMP, TEXTURE_TRILINEAR);
    assert_int_equal(texture_levels(t), 3);
    assert_same(texture_texel(t, 1, 0, 0), vec3_make(0.4, 0.2, 0.0), 3e-8);
    assert_same(texture_texel(t, 1, 1, 0), vec3_make(0.0, 0.2, 0.4 / 3.0), 3e-8);
    assert_same(texture_texel(t, 2, 0, 0), vec3_make(0.2, 0.2, 1.0 / 15.0), 3e-8);
    texture_release(t);
}

static char folder[4096];

static int make_folder(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder - 32, "%s/cuvette-texture-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

static void write_then_read(const image *img, const char *ending, int bits, texture_space space, texture_filter filter,
                            texture **out)
{
    char path[sizeof folder + 32];
    snprintf(path, sizeof path, "%s/image%s", folder, ending);
    assert_int_equal(image_write(img, path, bits, NULL), STATUS_OK);
    assert_int_equal(texture_read(path, space, TEXTURE_REPEAT, TEXTURE_REPEAT, filter, out, NULL), STATUS_OK);
    unlink(path);
}

/* IEC 61966-2-1: half the light of white is the sRGB value 1.055 (1/2)^(1/2.4) - 0.055 = 0.7354; averaging encoded
 * values would give 1/2, the light ((0.5 + 0.055) / 1.055)^2.4 = 0.2140. */
static void a_distant_checkerboard_has_half_the_light_of_white(void **state)
{
    (void)state;
    image *board = blank(64, 64), *grey = blank(1, 1);
    for (int i = 0; i < 64 * 64; i++) {
        double light = (i + i / 64) % 2;
        set(board, i % 64, i / 64, light, light, light);
    }
    texture *t;
    write_then_read(board, ".png", 8, TEXTURE_SRGB, TEXTURE_TRILINEAR, &t);
    for (double footprint = 2.0 / 64; footprint < 9.0; footprint *= 1.7)
        assert_same(texture_sample(t, 0.3, 0.7, footprint), vec3_make(0.5, 0.5, 0.5), 0.0);
    assert_near(srgb_encode(texture_sample(t, 0.1, 0.2, 1.0).x), 1.055 * pow(0.5, 1.0 / 2.4) - 0.055, 1e-12);
    texture_release(t);
    /* the byte 128 as linear light, and as a plain number */
    set(grey, 0, 0, pow((128.0 / 255.0 + 0.055) / 1.055, 2.4), 0.0, 1.0);
    write_then_read(grey, ".png", 8, TEXTURE_SRGB, TEXTURE_BILINEAR, &t);
    assert_same(texture_sample(t, 0.1, 0.2, 0.0), vec3_make(pow((128.0 / 255.0 + 0.055) / 1.055, 2.4), 0.0, 1.0), 1e-8);
    texture_release(t);
    write_then_read(grey, ".png", 8, TEXTURE_LINEAR, TEXTURE_BILINEAR, &t);
    assert_same(texture_sample(t, 0.1, 0.2, 0.0), vec3_make((double)(float)(128.0 / 255.0), 0.0, 1.0), 0.0);
    texture_release(t);
    image_destroy(board);
    image_destroy(grey);
}

static void a_linear_image_returns_the_values_of_its_file(void **state)
{
    (void)state;
    image *steps = blank(256, 1), *fine = blank(256, 2);
    for (int i = 0; i < 256; i++) {
        double code = i / 255.0, light = code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
        set(steps, i, 0, light, 1.0, light);
        code = i * 257 / 65535.0;
        set(fine, i, 1, light, 0.0, 0.0);
        code = (i * 251 + 3) / 65535.0;
        light = code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
        set(fine, i, 0, light, 0.0, 0.0);
    }
    texture *eight, *sixteen, *light;
    write_then_read(steps, ".png", 8, TEXTURE_LINEAR, TEXTURE_NEAREST, &eight);
    write_then_read(fine, ".png", 16, TEXTURE_LINEAR, TEXTURE_NEAREST, &sixteen);
    write_then_read(steps, ".pfm", 0, TEXTURE_LINEAR, TEXTURE_NEAREST, &light);
    for (int i = 0; i < 256; i++) {
        double u = (i + 0.5) / 256;
        assert_same(texture_sample(eight, u, 0.5, 0.0),
                    vec3_make((double)(float)(i / 255.0), 1.0, (double)(float)(i / 255.0)), 0.0);
        assert_near(texture_sample(sixteen, u, 0.75, 0.0).x, (double)(float)(i / 255.0), 0.0);
        assert_near(texture_sample(sixteen, u, 0.25, 0.0).x, (double)(float)((i * 251 + 3) / 65535.0), 0.0);
        assert_near(texture_sample(light, u, 0.5, 0.0).x, (double)steps->pixel[3 * i], 0.0);
    }
    texture_release(eight);
    texture_release(sixteen);
    texture_release(light);
    texture *grey;
    image *middle = blank(8, 8);
    for (int i = 0; i < 192; i++)
        middle->pixel[i] = (float)pow((128.0 / 255.0 + 0.055) / 1.055, 2.4); /* JPEG preserves a uniform grey exactly */
    write_then_read(middle, ".jpg", 0, TEXTURE_LINEAR, TEXTURE_TRILINEAR, &grey);
    assert_near(texture_sample(grey, 0.5, 0.5, 1.0).x, (double)(float)(128.0 / 255.0), 0.0);
    texture_release(grey);
    image_destroy(steps);
    image_destroy(fine);
    image_destroy(middle);
}

/* One column of eight is white; at its edge the levels 0 to 3 have the values 1, 1/2, 1/4 and 1/8. */
static void the_level_is_the_logarithm_of_the_footprint_in_texels(void **state)
{
    (void)state;
    image *img = blank(8, 1);
    set(img, 0, 0, 1, 1, 1);
    texture *t = owned(img, TEXTURE_CLAMP, TEXTURE_TRILINEAR);
    static const double light[] = {1.0, 0.5, 0.25, 0.125};
    for (int level = 0; level <= 3; level++)
        assert_near(texture_sample(t, 0.0, 0.5, (1 << level) / 8.0).x, light[level], 0.0);
    for (double level = 0.0; level < 3.0; level += 0.01) {
        int k = (int)level;
        double expected = light[k] + (level - k) * (light[k + 1] - light[k]);
        assert_near(texture_sample(t, 0.0, 0.5, pow(2.0, level) / 8.0).x, expected, 1e-14);
    }
    assert_near(texture_sample(t, 0.0, 0.5, 0.0).x, 1.0, 0.0);
    assert_near(texture_sample(t, 0.0, 0.5, 0.125).x, 1.0, 0.0);
    assert_near(texture_sample(t, 0.0, 0.5, 1e300).x, 0.125, 0.0);
    texture_release(t);
}

static void trilinear_filtering_is_continuous_between_levels(void **state)
{
    (void)state;
    texture *t = owned(noise(24, 37), TEXTURE_REPEAT, TEXTURE_TRILINEAR);
    for (int level = 0; level < 8; level++) {
        double footprint = (1 << level) / 37.0;
        for (int i = 0; i < 50; i++) {
            double u = i * 0.037, v = i * 0.091;
            vec3 here = texture_sample(t, u, v, footprint);
            assert_same(texture_sample(t, u, v, footprint * (1.0 - 1e-12)), here, 1e-11);
            assert_same(texture_sample(t, u, v, footprint * (1.0 + 1e-12)), here, 1e-11);
        }
    }
    /* nor elsewhere: the slope of a level is at most 1, the range of the texels */
    for (double footprint = 0.01; footprint < 2.0; footprint *= 1.001)
        assert_same(texture_sample(t, 0.4, 0.6, footprint * 1.001), texture_sample(t, 0.4, 0.6, footprint), 1.5e-3);
    texture_release(t);
}

static void contrast_never_increases_with_the_footprint(void **state)
{
    (void)state;
    image *img = blank(64, 64);
    set(img, 20, 41, 1, 1, 1); /* one bright texel: the value at its centre can only decrease */
    texture *t = owned(img, TEXTURE_REPEAT, TEXTURE_TRILINEAR);
    double before = 2.0;
    for (double footprint = 0.001; footprint < 3.0; footprint *= 1.01) {
        double now = texture_sample(t, 20.5 / 64, 41.5 / 64, footprint).x;
        assert_true(now <= before && now >= 1.0 / 4096);
        before = now;
    }
    assert_near(before, 1.0 / 4096, 0.0);
    texture_release(t);
}

static void samples_stay_within_the_range_of_the_texels(void **state)
{
    (void)state;
    uint64_t s = 11;
    for (size_t k = 0; k < COUNT(sizes); k++) {
        image *img = noise(sizes[k][0], sizes[k][1]);
        float low = 2.0f, high = -1.0f;
        for (int i = 0; i < 3 * sizes[k][0] * sizes[k][1]; i++) {
            low = fminf(low, img->pixel[i]);
            high = fmaxf(high, img->pixel[i]);
        }
        for (size_t i = 0; i < COUNT(wraps) * COUNT(filters); i++) {
            texture *t = textured(img, wraps[i / 3], filters[i % 3]);
            for (int j = 0; j < 2000; j++) {
                double u = random_real(&s, -3.0, 3.0), v = random_real(&s, -3.0, 3.0);
                vec3 c = texture_sample(t, u, v, random_real(&s, 0.0, 1.2));
                assert_true(fmin(fmin(c.x, c.y), c.z) >= (double)low * (1.0 - 1e-15));
                assert_true(fmax(fmax(c.x, c.y), c.z) <= (double)high * (1.0 + 1e-15));
            }
            texture_release(t);
        }
        image_destroy(img);
    }
}

static void a_uniform_image_gives_a_uniform_texture(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(sizes); k++) {
        image *img = blank(sizes[k][0], sizes[k][1]);
        for (int i = 0; i < sizes[k][0] * sizes[k][1]; i++)
            set(img, i % sizes[k][0], i / sizes[k][0], 0.1, 0.7, (double)FLT_MAX);
        for (size_t i = 0; i < COUNT(wraps) * COUNT(filters); i++) {
            texture *t = textured(img, wraps[i / 3], filters[i % 3]);
            for (int j = 0; j < 300; j++) {
                vec3 c = texture_sample(t, j * 0.0173 - 2.0, j * 0.0311 - 4.0, j * 0.004);
                assert_same(c, vec3_make((double)0.1f, (double)0.7f, (double)FLT_MAX), 0.0);
            }
            texture_release(t);
        }
        image_destroy(img);
    }
}

static void extreme_coordinates_and_footprints_are_valid(void **state)
{
    (void)state;
    static const double strange[] = {(double)NAN,
                                     (double)INFINITY,
                                     -(double)INFINITY,
                                     1e308,
                                     -1e308,
                                     1e18,
                                     -1e18,
                                     4503599627370497.5,
                                     DBL_MIN,
                                     -DBL_MIN,
                                     5e-324,
                                     -5e-324,
                                     -0.0,
                                     1.0,
                                     0.99999999999999989,
                                     -1e-17};
    for (size_t k = 0; k < COUNT(sizes); k++) {
        image *img = noise(sizes[k][0], sizes[k][1]);
        for (size_t i = 0; i < COUNT(wraps) * COUNT(filters); i++) {
            texture *t = textured(img, wraps[i / 3], filters[i % 3]);
            for (size_t j = 0; j < COUNT(strange) * COUNT(strange) * COUNT(strange); j++) {
                double u = strange[j % COUNT(strange)], v = strange[j / COUNT(strange) % COUNT(strange)];
                vec3 c = texture_sample(t, u, v, strange[j / COUNT(strange) / COUNT(strange)]);
                assert_true(fmin(fmin(c.x, c.y), c.z) >= 0.0 && fmax(fmax(c.x, c.y), c.z) <= 1.0);
            }
            /* as documented in the header */
            vec3 origin = texture_sample(t, 0.0, 0.0, 0.0),
                 far = texture_sample(t, wraps[i / 3] == TEXTURE_CLAMP ? 1.0 : 0.0, 0.0, 0.0);
            assert_same(texture_sample(t, (double)NAN, (double)NAN, (double)NAN), origin, 0.0);
            assert_same(texture_sample(t, (double)INFINITY, 0.0, -1.0), far, 0.0);
            texture_release(t);
        }
        image_destroy(img);
    }
}

static void images_with_nan_or_without_pixels_are_refused(void **state)
{
    (void)state;
    image *img = noise(5, 4);
    texture *t = (texture *)&t;
    diagnostic why = {0};
    img->pixel[(2 * 5 + 3) * 3 + 1] = NAN;
    assert_int_equal(texture_create(img, TEXTURE_REPEAT, TEXTURE_REPEAT, TEXTURE_NEAREST, &t, &why), STATUS_BAD_INPUT);
    assert_null(t);
    assert_non_null(strstr(why.what, "column 3, row 2"));
    image nothing = {.height = 3};
    assert_int_equal(texture_create(&nothing, TEXTURE_REPEAT, TEXTURE_REPEAT, TEXTURE_NEAREST, &t, &why),
                     STATUS_BAD_INPUT);
    assert_int_equal(
        texture_read("/nonexistent/brick.png", TEXTURE_SRGB, TEXTURE_REPEAT, TEXTURE_REPEAT, TEXTURE_NEAREST, &t, &why),
        STATUS_BAD_INPUT);
    assert_null(t);
    assert_string_equal(why.file, "/nonexistent/brick.png");
    image_destroy(img);
    texture_release(NULL);
}

static void *take_and_leave(void *shared)
{
    for (int i = 0; i < 10000; i++) {
        texture_retain(shared);
        texture_release(shared);
    }
    texture_release(shared);
    return NULL;
}

/* The sanitizers detect a block that is released too early, twice or never. */
static void owners_share_a_texture_and_the_last_one_releases_it(void **state)
{
    (void)state;
    texture *t = owned(noise(9, 9), TEXTURE_REPEAT, TEXTURE_TRILINEAR);
    vec3 before = texture_sample(t, 0.2, 0.3, 0.1);
    pthread_t threads[4];
    for (int i = 0; i < 4; i++) {
        texture_retain(t);
        assert_int_equal(pthread_create(&threads[i], NULL, take_and_leave, t), 0);
    }
    for (int i = 0; i < 4; i++)
        pthread_join(threads[i], NULL);
    assert_same(texture_sample(t, 0.2, 0.3, 0.1), before, 0.0);
    texture_release(t);
}

static void mipmaps_take_a_third_more_memory(void **state)
{
    (void)state;
    image *img = noise(256, 256);
    texture *flat = textured(img, TEXTURE_REPEAT, TEXTURE_BILINEAR),
            *deep = textured(img, TEXTURE_REPEAT, TEXTURE_TRILINEAR);
    assert_int_equal(texture_levels(flat), 1);
    assert_int_equal(texture_levels(deep), 9);
    assert_true(texture_bytes(flat) >= 256 * 256 * 3 * sizeof(float));
    double more = (double)texture_bytes(deep) / (double)texture_bytes(flat);
    assert_near(more, 4.0 / 3.0, 1e-3);
    texture_release(flat);
    texture_release(deep);
    image_destroy(img);
}

static void every_instruction_set_tints_with_the_same_samples(void **state)
{
    (void)state;
    enum { POINTS = 150 };
    texture_tinter *const tint[ISA_COUNT] = ISA_ARRAY(texture_tint);
    uint64_t s = 9;
    double u[POINTS], v[POINTS], footprint[POINTS];
    for (int k = 0; k < POINTS; k++) {
        u[k] = k % 50 == 7 ? (double)NAN : random_real(&s, -3.0, 3.0);
        v[k] = k % 50 == 8 ? -(double)INFINITY : random_real(&s, -3.0, 3.0);
        footprint[k] = k % 50 == 9 ? (double)NAN : pow(2.0, random_real(&s, -5.0, 2.0));
    }
    for (size_t i = 0; i < COUNT(wraps) * COUNT(filters); i++) {
        texture *t = owned(noise(11, 6), wraps[i / COUNT(filters)], filters[i % COUNT(filters)]);
        for (isa level = ISA_BASE; level <= isa_best(); level++) {
            double r[POINTS], g[POINTS], b[POINTS];
            for (int k = 0; k < POINTS; k++)
                r[k] = 1.0, g[k] = 0.25, b[k] = 4.0;
            tint[level](t, POINTS, u, v, footprint, r, g, b);
            for (int k = 0; k < POINTS; k++) {
                const vec3 c = texture_sample(t, u[k], v[k], footprint[k]);
                assert_same(vec3_make(r[k], 4.0 * g[k], 0.25 * b[k]), c, 0.0);
            }
        }
        texture_release(t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texel_centres_return_the_texels_from_the_lowest_row),
        cmocka_unit_test(the_lower_left_corner_of_the_image_is_the_origin),
        cmocka_unit_test(bilinear_interpolates_between_centres_and_nearest_changes_at_the_edge),
        cmocka_unit_test(bilinear_filtering_reproduces_a_linear_ramp_and_clamps_outside),
        cmocka_unit_test(wrap_modes_place_the_texels_on_both_sides_of_the_seams),
        cmocka_unit_test(the_wrap_modes_of_the_axes_are_independent),
        cmocka_unit_test(a_mirrored_texture_is_symmetric_about_integers),
        cmocka_unit_test(each_level_has_half_the_size_and_the_mean_of_the_image),
        cmocka_unit_test(texels_of_odd_sizes_are_weighted_by_area),
        cmocka_unit_test(a_distant_checkerboard_has_half_the_light_of_white),
        cmocka_unit_test(a_linear_image_returns_the_values_of_its_file),
        cmocka_unit_test(the_level_is_the_logarithm_of_the_footprint_in_texels),
        cmocka_unit_test(trilinear_filtering_is_continuous_between_levels),
        cmocka_unit_test(contrast_never_increases_with_the_footprint),
        cmocka_unit_test(samples_stay_within_the_range_of_the_texels),
        cmocka_unit_test(a_uniform_image_gives_a_uniform_texture),
        cmocka_unit_test(every_instruction_set_tints_with_the_same_samples),
        cmocka_unit_test(extreme_coordinates_and_footprints_are_valid),
        cmocka_unit_test(images_with_nan_or_without_pixels_are_refused),
        cmocka_unit_test(owners_share_a_texture_and_the_last_one_releases_it),
        cmocka_unit_test(mipmaps_take_a_third_more_memory),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
