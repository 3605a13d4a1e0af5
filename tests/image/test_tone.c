/* Tests of exposure and tone curves: 2^EV to the bit for whole stops, the published formulas' values, and that only
 * images with 8 bits have them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "image/codec.h"
#include "image/video.h"
#include "lint/lint.h"
#include "render/frame/record.h"
#include "render_fixture.h"
#include "scene/model/camera.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static float toned(image_tone t, float value)
{
    float rgb[3] = {value, value, value};
    image_tone_apply(&t, rgb, 1);
    assert_true(isnan(value) ? isnan(rgb[2]) : rgb[0] == rgb[1] && fabsf(rgb[1] - rgb[2]) <= 1e-7f * fabsf(rgb[2]));
    return rgb[0];
}

static void whole_stops_are_powers_of_two(void **state)
{
    (void)state;
    static const float values[] = {0.0f, 1e-7f, 0.1f, 0.73f, 1.0f, 812.3f, -0.5f};
    for (int stops = -20; stops <= 20; stops++)
        for (size_t k = 0; k < COUNT(values); k++)
            assert_true(toned((image_tone){.exposure = stops}, values[k]) == ldexpf(values[k], stops));
    assert_true(fabs(toned((image_tone){.exposure = 0.5}, 1.0f) - sqrt(2.0)) < 1e-7);
    assert_true(fabs(toned((image_tone){.exposure = -0.25}, 1.0f) - 1.0 / sqrt(sqrt(2.0))) < 1e-7);
    assert_true(isnan(toned((image_tone){.exposure = 1.0}, NAN)));
    assert_true(image_tone_is_plain(&(image_tone){.white = 3.0}));
    assert_false(image_tone_is_plain(&(image_tone){.exposure = 1e-9}));
    assert_false(image_tone_is_plain(&(image_tone){.curve = TONE_ACES}));
}

/* Reinhard et al. 2002: equation 4 is 1 at L_white, and for a very large one equation 3, L / (1 + L). Narkowicz 2015:
 * x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), with its values at 0.18, 1 and 4, and its limit 2.51 / 2.43. */
static void curves_have_their_published_values(void **state)
{
    (void)state;
    for (double white = 0.5; white < 20.0; white *= 1.7) {
        const image_tone t = {.curve = TONE_REINHARD, .white = white};
        assert_true(fabs(toned(t, (float)white) - 1.0) < 2e-7);
        assert_true(fabs(toned(t, 0.5f) - 0.5 * (1.0 + 0.5 / (white * white)) / 1.5) < 1e-7);
        assert_true(fabs(toned(t, 1e-6f) / 1e-6 - 1.0) < 1e-5);
    }
    const image_tone far = {.curve = TONE_REINHARD, .white = 1e6};
    assert_true(fabs(toned(far, 1.0f) - 0.5) < 1e-7 && fabs(toned(far, 3.0f) - 0.75) < 1e-7);
    const image_tone exposed = {.curve = TONE_REINHARD, .white = 1e6, .exposure = 2.0};
    assert_true(fabs(toned(exposed, 0.75f) - 0.75) < 1e-7); /* the exposure comes first */
    const image_tone aces = {.curve = TONE_ACES};
    assert_true(toned(aces, 0.0f) == 0.0f);
    assert_true(fabs(toned(aces, 0.18f) - 0.086724 / 0.324932) < 1e-7);
    assert_true(fabs(toned(aces, 1.0f) - 2.54 / 3.16) < 1e-7);
    assert_true(fabs(toned(aces, 4.0f) - 40.28 / 41.38) < 1e-6);
    assert_true(fabs(toned(aces, 1e7f) - 2.51 / 2.43) < 1e-5);
}

/* Reinhard's curve is one of luminance: a colour keeps its ratios, and a primary's factor is that of its luminance. */
static void reinhards_curve_keeps_hues(void **state)
{
    (void)state;
    float rgb[3] = {2.0f, 0.5f, 0.25f};
    const double luminance = 0.2126 * 2.0 + 0.7152 * 0.5 + 0.0722 * 0.25;
    image_tone_apply(&(image_tone){.curve = TONE_REINHARD, .white = 4.0}, rgb, 1);
    assert_true(fabs(rgb[0] - 2.0 * (1.0 + luminance / 16.0) / (1.0 + luminance)) < 1e-6);
    assert_true(fabs(rgb[0] / rgb[1] - 4.0) < 1e-6 && fabs(rgb[0] / rgb[2] - 8.0) < 1e-6);
}

static image *gradient(void)
{
    image *img = NULL;
    diagnostic why = {0};
    worked(image_create(16, 3, &img, &why), &why);
    for (int i = 0; i < 16 * 3 * 3; i++)
        img->pixel[i] = (float)i / 70.0f;
    return img;
}

static unsigned char *bytes_of(const image *img, image_format format, int bits, size_t *size)
{
    unsigned char *bytes = NULL;
    diagnostic why = {0};
    worked(image_encode(img, format, bits, false, &bytes, size, &why), &why);
    return bytes;
}

/* Whether the files of two images are the same. */
static bool same_files(const image *a, const image *b, image_format format, int bits)
{
    size_t size_a, size_b;
    unsigned char *bytes_a = bytes_of(a, format, bits, &size_a), *bytes_b = bytes_of(b, format, bits, &size_b);
    const bool same = size_a == size_b && memcmp(bytes_a, bytes_b, size_a) == 0;
    free(bytes_a);
    free(bytes_b);
    return same;
}

static unsigned char *video_of(const image *img, size_t *size)
{
    char *bytes = NULL;
    diagnostic why = {0};
    FILE *stream = open_memstream(&bytes, size);
    assert_non_null(stream);
    worked(y4m_frame(stream, img, &why), &why);
    fclose(stream);
    return (unsigned char *)bytes;
}

/* The file of an image with a tone is that of an image whose values have been changed: 8 bits; or the plain one. */
static void only_eight_bits_have_the_tone(void **state)
{
    (void)state;
    static const image_tone tones[] = {
        {.exposure = 1.0}, {.exposure = -1.5}, {.curve = TONE_REINHARD, .white = 2.0}, {.curve = TONE_ACES}};
    for (size_t k = 0; k < COUNT(tones); k++) {
        image *plain = gradient(), *with = gradient(), *changed = gradient();
        with->tone = tones[k];
        image_tone_apply(&tones[k], changed->pixel, 16 * 3);
        assert_true(same_files(with, changed, IMAGE_PNG, 8) && !same_files(with, plain, IMAGE_PNG, 8));
        assert_true(same_files(with, changed, IMAGE_JPEG, 8) && !same_files(with, plain, IMAGE_JPEG, 8));
        assert_true(same_files(with, plain, IMAGE_PNG, 16));
        assert_true(same_files(with, plain, IMAGE_PFM, 8));
        assert_true(same_files(with, plain, IMAGE_EXR, 8));
        size_t size, wanted;
        unsigned char *shown = video_of(with, &size), *expected = video_of(changed, &wanted);
        assert_true(size == wanted && memcmp(shown, expected, size) == 0);
        free(shown);
        free(expected);
        image_destroy(plain);
        image_destroy(with);
        image_destroy(changed);
    }
}

static image *file_of(const render_result *result, const scene *s, const char *name, int bits)
{
    char path[200];
    image *img = NULL;
    diagnostic why = {0};
    snprintf(path, sizeof path, "%s/%s", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp", name);
    worked(record_image(result, NULL, s, path, bits, &why), &why);
    worked(image_read(path, &img, NULL, &why), &why);
    remove(path);
    return img;
}

/* A scene's image of 8 bits has its exposure; its film and its other files have not. */
static void a_scenes_film_does_not_depend_on_how_it_is_shown(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=20 render.height=15");
    render_result *plain = render(s);
    set_all(s, "camera.exposure=-1 camera.tone=none");
    render_result *dark = render(s);
    assert_true(film_hash(plain->img) == film_hash(dark->img));
    image *shown = file_of(dark, s, "test_tone.png", 8), *whole = file_of(dark, s, "test_tone.pfm", 8);
    for (int y = 0; y < 15; y++)
        for (int x = 0; x < 20; x++) {
            const double value = film_value(plain->img, x, y, 2), seen = shown->pixel[(y * 20 + x) * 3 + 2];
            assert_true(fabs(srgb_encode(seen) - srgb_encode(0.5 * value)) < 0.5001 / 255.0);
            assert_true(whole->pixel[(y * 20 + x) * 3 + 2] == (float)value);
        }
    image_destroy(shown);
    image_destroy(whole);
    render_result_destroy(plain);
    render_result_destroy(dark);
    set_all(s, "render.integrator=aov camera.tone=aces camera.exposure=3");
    const image_tone layer = camera_tone(s); /* a layer's image is no light */
    assert_true(image_tone_is_plain(&layer));
    scene_destroy(s);
}

static void find(void *context, const scene_note *note)
{
    char *found = context;
    if (strncmp(note->place, "camera.", 7) == 0)
        snprintf(found, 64, "%s", note->place + 7);
}

static void what_has_no_effect_is_said(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"camera.exposure=0", ""},         {"camera.white=2", "white"},         {"camera.tone=aces", "white"},
        {"camera.tone=reinhard", ""},      {"render.integrator=aov", "tone"},   {"camera.exposure=1", "exposure"},
        {"render.integrator=whitted", ""}, {"camera.aperture=0.1", "aperture"}, {"render.integrator=path", ""},
        {"render.paths=1", "aperture"},
    };
    scene *s = rod_scene("");
    for (size_t k = 0; k < COUNT(cases); k++) {
        char found[64] = "";
        set(s, cases[k][0]);
        scene_hints(s, &(note_sink){find, found});
        assert_string_equal(found, cases[k][1]);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_stops_are_powers_of_two),
        cmocka_unit_test(curves_have_their_published_values),
        cmocka_unit_test(reinhards_curve_keeps_hues),
        cmocka_unit_test(only_eight_bits_have_the_tone),
        cmocka_unit_test(a_scenes_film_does_not_depend_on_how_it_is_shown),
        cmocka_unit_test(what_has_no_effect_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
