/* Scenes with meshes for tests: reading, loading and probing, with textures from images made in memory. Ownership as in
 * probe_fixture.h. */
#pragma once

#include "probe_fixture.h"
#include "scene/model/scene.h"

/* A texture of the scene from texels of 0..1, row by row from the lowest row, red green blue. */
static inline void give_texture(scene *s, const char *name, const double *texels, int width, int height)
{
    for (size_t i = 0; i < s->texture_count; i++) {
        texture_entry *t = &s->textures[i];
        if (strcmp(t->name, name) != 0)
            continue;
        image *img = NULL;
        assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < 3 * width; x++)
                img->pixel[(size_t)(height - 1 - y) * 3 * (size_t)width + (size_t)x] = (float)texels[y * 3 * width + x];
        texture *made = NULL;
        assert_int_equal(texture_create(img, TEXTURE_SRGB, (texture_wrap)t->wrap_u, (texture_wrap)t->wrap_v,
                                        (texture_filter)t->filter, &made, NULL),
                         STATUS_OK);
        image_destroy(img);
        t->data = made;
    }
}

static inline scene *scene_with_meshes(const char *text, const char *assignments)
{
    scene *s = scene_from(text);
    set_all(s, assignments);
    /* each texel has its own colour: red increases across, green upwards */
    static const double texels[4 * 2 * 3] = {0.125, 0.25, 1, 0.375, 0.25, 1, 0.625, 0.25, 1, 0.875, 0.25, 1,
                                             0.125, 0.75, 1, 0.375, 0.75, 1, 0.625, 0.75, 1, 0.875, 0.75, 1};
    give_texture(s, "map", texels, 4, 2);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    return s;
}

static inline stage stage_with_meshes(const char *text, const char *assignments)
{
    stage g = {.setting = scene_with_meshes(text, assignments)};
    stage_look(&g);
    return g;
}

/* Root mean square over all values of two films. */
static inline double rms_between(const film *a, const film *b)
{
    double sum = 0.0;
    assert_true(a->width == b->width && a->height == b->height);
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            for (int c = 0; c < 3; c++) {
                const double d = film_value(a, x, y, c) - film_value(b, x, y, c);
                sum += d * d;
            }
    return sqrt(sum / (3.0 * a->width * a->height));
}

static inline double psnr(double rms)
{
    return -20.0 * log10(rms);
}
