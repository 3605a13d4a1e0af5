/* A white sky seen along z through sheets: boxes across the ray, which bend no light. Ownership: scenes belong to the
 * caller. */
#pragma once

#include "render_fixture.h"
#include "scene/model/edit/edit.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double degree = 3.14159265358979323846 / 180.0;

static inline double squared(double x)
{
    return x * x;
}

static inline scene *behind_air(const char *assignments)
{
    scene *s = scene_from("render: {width: 2, height: 2, depth: 4, polarisation: \"on\"}\n"
                          "camera: {position: [0, 0, 0], yaw_deg: 0, projection: orthographic, view_height: 0.1}\n"
                          "background: {color: [1, 1, 1]}\n");
    set_all(s, assignments);
    return s;
}

/* A sheet at that distance, which it shows in the same width everywhere: its parameters as assignments without its
 * name, its rotation about the ray from right to up, and the angle of its axis in it. Its name is sheet_1, sheet_2 ...
 */
static inline void add_sheet(scene *s, double z, const char *parameters, double turn_deg, double axis_deg)
{
    char name[20], text[300], copy[300];
    size_t at;
    diagnostic why = {0};
    snprintf(name, sizeof name, "sheet_%zu", s->solid_count + 1);
    worked(scene_add_solid(s, name, SHAPE_BOX, &at, &why), &why);
    solid *one = &s->solids[at];
    one->shape.size = vec3_make(0.6, 0.6, 0.01);
    one->shape.position = vec3_make(0.0, 0.0, z);
    one->shape.rotation_deg = vec3_make(0.0, 0.0, turn_deg);
    one->surface = (material){.color = {1, 1, 1}, .transparency = 1.0, .ior = 1.0, .film_ior = 1.4, .tint_distance = 1};
    one->surface.sheet_axis = vec3_make(cos(axis_deg * degree), sin(axis_deg * degree), 0.0);
    one->surface.sheet_pass = 1.0;
    snprintf(copy, sizeof copy, "%s", parameters);
    char *rest = copy;
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        snprintf(text, sizeof text, "%s.%s", name, word);
        set(s, text);
    }
}

/* Sheets 1 and 2 are crossed polarisers, 3 a plate between them. */
static inline scene *crossed_with(const char *plate, double turn_deg)
{
    scene *s = behind_air("");
    add_sheet(s, 1.0, "sheet=polariser", 90.0, 0.0);
    add_sheet(s, 3.0, "sheet=polariser", 0.0, 0.0);
    add_sheet(s, 2.0, plate, turn_deg, 0.0);
    return s;
}

static inline void assert_all(const scene *s, double expected, double tolerance)
{
    render_result *r = render(s);
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++)
            if (fabs(film_value(r->img, k % 2, k / 2, c) - expected) > tolerance)
                fail_msg("%.16g instead of %.16g", film_value(r->img, k % 2, k / 2, c), expected);
    render_result_destroy(r);
}
