/* Test fixtures: scenes from text, and their images. Each call asserts that it succeeded. Ownership: release results of
 * scene_from with scene_destroy and of render with render_result_destroy. */
#pragma once

#include "scene/model/scene.h"
#include "render/frame/renderer.h"
#include "scene/model/params.h"
#include <stdio.h>
#include <string.h>

/* Tests run in the project's root. */
#define ROD_SCENE "experiments/scenes/rod.yaml"

/* Skips a test that needs counters in a build without them. */
static inline void need_counters(void)
{
    if (!CUVETTE_COUNTERS)
        skip();
}

static inline void worked(status code, const diagnostic *why)
{
    char text[DIAGNOSTIC_TEXT_MAX];
    if (code != STATUS_OK)
        fail_msg("%s", diagnostic_text(why, text, sizeof text));
}

static inline void set(scene *s, const char *assignment)
{
    diagnostic why = {0};
    worked(scene_set_assignment(s, assignment, &why), &why);
}

/* Assignments, separated by blanks. */
static inline void set_all(scene *s, const char *assignments)
{
    char text[512];
    snprintf(text, sizeof text, "%s", assignments);
    char *rest = text;
    for (char *word; (word = strtok_r(rest, " ", &rest));)
        set(s, word);
}

static inline scene *scene_from(const char *text)
{
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_read_text("test.yaml", text, strlen(text), &s, &why), &why);
    return s;
}

static inline scene *rod_scene(const char *assignments)
{
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_read(ROD_SCENE, &s, &why), &why);
    set_all(s, assignments);
    return s;
}

static inline render_result *render_at(const scene *s, isa level, const render_options *options)
{
    renderer *r = NULL;
    render_result *result = NULL;
    diagnostic why = {0};
    worked(renderer_create(level, NULL, &r, &why), &why);
    worked(renderer_render(r, s, options, &result, &why), &why);
    renderer_destroy(r);
    return result;
}

static inline render_result *render(const scene *s)
{
    return render_at(s, isa_best(), NULL);
}

/* The mean over the image, first channel. */
static inline double mean_radiance(const scene *s)
{
    render_result *r = render(s);
    double sum = 0.0;
    const int pixels = r->img->width * r->img->height;
    for (int i = 0; i < pixels; i++)
        sum += film_value(r->img, i % r->img->width, i / r->img->width, 0) / pixels;
    render_result_destroy(r);
    return sum;
}

/* The radiance of an image of one pixel, whose ray is exactly the camera's axis. */
static inline vec3 look(const scene *s)
{
    render_result *result = render(s);
    vec3 seen =
        vec3_make(film_value(result->img, 0, 0, 0), film_value(result->img, 0, 0, 1), film_value(result->img, 0, 0, 2));
    render_result_destroy(result);
    return seen;
}
