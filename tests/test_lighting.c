/* Tests of the lighting models, each of which adds a term to the previous one, and of the falloff of lights, at a point
 * computed by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* The camera looks at the origin of a glazed floor along V = (0, 0.6, -0.8), the lamp is at L = (0.6, 0.8, 0), five
 * units away: N.L = 0.8, R.V = 0.48. The floor reflects white sky. */
static const char floor_scene[] =
    "render: {width: 1, height: 1, depth: 3}\n"
    "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
    "background: {color: [1, 1, 1], ambient: [0.5, 0.5, 0.5]}\n"
    "lights: {lamp: {position: [3, 4, 0], intensity: 2}}\n"
    "solids: {floor: {shape: plane, color: [0.9, 0.6, 0.3], ambient: 0.1, diffuse: 0.7, specular: 0.5, "
    "shininess: 3, reflectivity: 0.25}}\n";

static const double ambient = 0.1 * 0.5 * 0.9, diffuse = 0.7 * 2.0 * 0.9 * 0.8,
                    highlight = 0.5 * 2.0 * 0.48 * 0.48 * 0.48, mirrored = 0.25;

static void each_lighting_model_adds_a_term_to_the_previous_one(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    assert_near(look(s).x, ambient + diffuse + highlight + mirrored, 1e-12); /* Whitted's is the default */
    set(s, "render.lighting=phong");
    assert_near(look(s).x, ambient + diffuse + highlight, 1e-12);
    set(s, "render.lighting=lambert");
    assert_near(look(s).x, ambient + diffuse, 1e-12);
    assert_near(look(s).y, (ambient + diffuse) * 0.6 / 0.9, 1e-12);
    scene_destroy(s);
}

/* Ray casting gives the image of depth 0, whatever the depth and the lighting; it has no branches to cut off. */
static void raycasting_shades_only_the_first_surface(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set(s, "render.integrator=raycast");
    assert_near(look(s).x, ambient + diffuse + highlight, 1e-12);
    set(s, "render.lighting=lambert");
    assert_near(look(s).x, ambient + diffuse, 1e-12);
    scene_destroy(s);
}

static ray_counters count(const char *settings)
{
    scene *s = rod_scene("render.width=80 render.height=60 render.depth=5");
    set_all(s, settings);
    render_result *r = render(s);
    const ray_counters c = r->counters;
    render_result_destroy(r);
    scene_destroy(s);
    return c;
}

static void only_whitteds_lighting_traces_secondary_rays(void **state)
{
    (void)state;
    need_counters();
    static const char *const alone[] = {"render.integrator=raycast",
                                        "render.integrator=raycast render.lighting=phong",
                                        "render.integrator=raycast render.lighting=lambert",
                                        "render.lighting=phong",
                                        "render.lighting=lambert",
                                        "render.lighting=lambert render.spectrum=spectral render.wavelengths=2"};
    for (size_t k = 0; k < COUNT(alone); k++) {
        const ray_counters c = count(alone[k]);
        assert_true(c.camera >= 80 * 60 && c.shadow > 0);
        assert_int_equal(c.reflect + c.refract + c.cut_depth + c.by_depth[1], 0);
    }
    const ray_counters c = count("render.lighting=whitted");
    assert_true(c.reflect > 0 && c.refract > 0 && c.cut_depth > 0);
    /* a lambertian image has no highlights, so no shadow rays for clear solids, which have nothing else */
    assert_true(count("render.lighting=lambert").shadow < count("render.lighting=phong").shadow);
}

/* A mirror is black under a lighting model without branches, and so is clear glass without a highlight. */
static void mirrors_and_glass_are_black_without_branches(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set_all(s, "floor.ambient=0 floor.diffuse=0 floor.specular=0 floor.reflectivity=1 render.lighting=phong");
    assert_true(look(s).x == 0.0);
    set_all(s, "floor.transparency=1 floor.ior=1.5");
    assert_true(look(s).x == 0.0);
    set_all(s, "render.lighting=whitted");
    assert_near(look(s).x, 1.0, 1e-12);
    scene_destroy(s);
}

/* The inverse square of the distance, 1 at the light's reach; constant without a reach. The lamp moves away along L. */
static void light_falls_off_with_the_squared_distance(void **state)
{
    (void)state;
    static const double distances[] = {0.1, 0.5, 1.0, 5.0, 20.0, 1e4}, reaches[] = {0.5, 5.0, 30.0};
    scene *s = scene_from(floor_scene);
    set_all(s, "floor.ambient=0 floor.reflectivity=0");
    for (size_t i = 0; i < COUNT(distances); i++) {
        const double d = distances[i];
        s->lights[0].position = vec3_make(0.6 * d, 0.8 * d, 0.0);
        s->lights[0].reach = 0.0;
        assert_near(look(s).x, diffuse + highlight, 1e-12);
        for (size_t k = 0; k < COUNT(reaches); k++) {
            const double share = reaches[k] * reaches[k] / (d * d), expected = (diffuse + highlight) * share;
            s->lights[0].reach = reaches[k];
            for (int path = 0; path <= 1; path++) { /* a point light is the same with random paths, under a black sky */
                s->render.integrator = path ? INTEGRATOR_PATH : INTEGRATOR_WHITTED;
                s->render.filter = PIXEL_FILTER_CENTRE;
                s->render.beyond = DEPTH_LIMIT_BLACK;
                s->background.color = vec3_make(0.0, 0.0, 0.0);
                assert_near(look(s).x, expected, 1e-12 + 1e-12 * expected);
            }
            s->render.integrator = INTEGRATOR_WHITTED;
        }
    }
    scene_destroy(s);
}

/* Only the path integrator uses a light's radius: for the others the light is a point at the centre. */
static void a_lights_radius_affects_only_random_paths(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    const vec3 point = look(s);
    set_all(s, "lamp.radius=2 lamp.reach=0");
    assert_true(look(s).x == point.x);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_lighting_model_adds_a_term_to_the_previous_one),
        cmocka_unit_test(raycasting_shades_only_the_first_surface),
        cmocka_unit_test(only_whitteds_lighting_traces_secondary_rays),
        cmocka_unit_test(mirrors_and_glass_are_black_without_branches),
        cmocka_unit_test(light_falls_off_with_the_squared_distance),
        cmocka_unit_test(a_lights_radius_affects_only_random_paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
