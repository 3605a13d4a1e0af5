/* Tests of spotlights: the falloff of a cone and a soft cone by the angle from their axis, with every integrator and
 * film. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "probe_fixture.h"
#include "scene/model/scene.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* The camera looks at the origin of a matte floor; the lamp is at L = (0.6, 0.8, 0), five units away: N.L = 0.8. */
static const char floor_scene[] = "render: {width: 1, height: 1, depth: 0}\n"
                                  "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
                                  "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                                  "lights: {lamp: {position: [3, 4, 0]}}\n"
                                  "solids: {floor: {shape: plane, diffuse: 1}}\n";
static const double irradiance = 0.8;

/* Rotates the lamp's axis so that the origin is at an angle from it, in a rotated plane through both. */
static void aim(scene *s, double angle_deg, double turn_deg)
{
    light *lamp = &s->lights[0];
    const vec3 to = vec3_make(-0.6, -0.8, 0.0), x = vec3_make(0.8, -0.6, 0.0), y = vec3_make(0.0, 0.0, 1.0);
    const double angle = angle_deg * DEGREE, turn = turn_deg * DEGREE;
    const vec3 across = vec3_add(vec3_scale(x, cos(turn)), vec3_scale(y, sin(turn)));
    const vec3 axis = vec3_add(vec3_scale(to, cos(angle)), vec3_scale(across, sin(angle)));
    lamp->target = vec3_add(lamp->position, vec3_scale(axis, 7.0));
}

static void a_cone_has_full_intensity_inside_and_none_outside(void **state)
{
    (void)state;
    static const double half_deg[] = {0.001, 0.5, 10.0, 30.0, 60.0, 90.0, 120.0, 179.0};
    scene *s = scene_from(floor_scene);
    set(s, "lamp.kind=cone");
    for (size_t i = 0; i < COUNT(half_deg); i++)
        for (int turn = 0; turn < 360; turn += 45) {
            s->lights[0].half_angle_deg = half_deg[i];
            aim(s, 0.999 * half_deg[i], turn);
            assert_near(look(s).x, irradiance, 1e-12);
            aim(s, 1.001 * half_deg[i], turn);
            assert_true(look(s).x == 0.0);
        }
    aim(s, 180.0, 0.0);
    s->lights[0].half_angle_deg = 180.0; /* in all directions */
    assert_near(look(s).x, irradiance, 1e-12);
    scene_destroy(s);
}

static double soft_share(double angle_deg, double half_deg)
{
    const double edge = cos(half_deg * DEGREE), share = (cos(angle_deg * DEGREE) - edge) / (1.0 - edge);
    return share > 0.0 ? share : 0.0;
}

static void a_soft_cone_falls_with_the_cosine(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set(s, "lamp.kind=soft_cone");
    for (double half_deg = 2.0; half_deg <= 180.0; half_deg += 22.25)
        for (double angle_deg = 0.0; angle_deg <= 180.0; angle_deg += 7.5) {
            s->lights[0].half_angle_deg = half_deg;
            aim(s, angle_deg, 3.0 * angle_deg);
            assert_near(look(s).x, irradiance * soft_share(angle_deg, half_deg), 1e-12);
        }
    set(s, "lamp.half_angle_deg=60"); /* cos 60 = 1/2; halfway from 1 in the cosine is 3/4 */
    aim(s, acos(0.75) / DEGREE, 20.0);
    assert_near(look(s).x, irradiance / 2.0, 1e-12);
    /* so narrow that 1 - cos a is 1.5e-10: by the squares of the angles, whose error is of order a^2 */
    set(s, "lamp.half_angle_deg=0.001");
    aim(s, 0.0006, 0.0);
    assert_near(look(s).x, irradiance * (1.0 - 0.36), 1e-9);
    scene_destroy(s);
}

/* Colour, intensity and squared distance apply as well, at five units from a light of full strength at ten. */
static void colour_and_falloff_are_the_same_for_every_kind_of_light(void **state)
{
    (void)state;
    static const char *const kinds[] = {"lamp.kind=point", "lamp.kind=cone", "lamp.kind=soft_cone"};
    scene *s = scene_from(floor_scene);
    set_all(s, "lamp.color=1,0.5,0.25 lamp.intensity=3 lamp.half_angle_deg=50 lamp.reach=10 floor.color=1,1,0.5");
    aim(s, 20.0, 75.0);
    for (int k = 0; k < 3; k++) {
        set(s, kinds[k]);
        const double share = k == 2 ? soft_share(20.0, 50.0) : 1.0, all = 3.0 * irradiance * 4.0 * share;
        const vec3 seen = look(s);
        assert_near(seen.x, all, 1e-11);
        assert_near(seen.y, 0.5 * all, 1e-11);
        assert_near(seen.z, 0.125 * all, 1e-11);
    }
    scene_destroy(s);
}

/* The falloff also applies to the highlight: the camera is at the lamp's mirror direction. */
static void the_falloff_applies_to_highlights(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set_all(s, "camera.position=-3,4,0 floor.diffuse=0 floor.specular=1 lamp.kind=soft_cone lamp.half_angle_deg=40");
    aim(s, 25.0, 10.0);
    assert_near(look(s).x, soft_share(25.0, 40.0), 1e-11);
    aim(s, 41.0, 10.0);
    assert_true(look(s).x == 0.0);
    scene_destroy(s);
}

static void no_shadow_rays_are_traced_outside_a_cone(void **state)
{
    (void)state;
    need_counters();
    static const char *const films[] = {
        "render.spectrum=rgb", "render.spectrum=spectral render.wavelengths=8",
        "render.spectrum=rgb render.integrator=path render.filter=centre render.paths=4"};
    static const int rays[] = {1, 8, 4};
    scene *s = scene_from(floor_scene);
    for (size_t k = 0; k < COUNT(films); k++) {
        set_all(s, films[k]);
        for (int soft = 0; soft <= 1; soft++)
            for (int inside = 0; inside <= 1; inside++) {
                set(s, soft ? "lamp.kind=soft_cone" : "lamp.kind=cone");
                aim(s, inside ? 29.0 : 31.0, 0.0);
                render_result *r = render(s);
                assert_int_equal(r->counters.shadow, inside ? rays[k] : 0);
                render_result_destroy(r);
            }
    }
    scene_destroy(s);
}

/* Every film and integrator, and the probe, gets the same share of a point light's value. */
static void all_integrators_have_the_same_cone_falloff(void **state)
{
    (void)state;
    static const char *const films[] = {
        "render.spectrum=spectral", "render.polarisation=on", "render.shadows=off",
        "render.spectrum=rgb render.integrator=raycast",
        "render.polarisation=off render.integrator=path render.filter=centre render.shadows=attenuated"};
    static const double angles[] = {0.0, 12.0, 29.0, 31.0};
    for (size_t k = 0; k < COUNT(films); k++) {
        scene *s = scene_from(floor_scene);
        set_all(s, films[k]);
        set(s, "lamp.kind=point");
        const double full = look(s).y;
        set(s, "lamp.kind=soft_cone");
        for (size_t i = 0; i < COUNT(angles); i++) {
            aim(s, angles[i], 200.0);
            assert_near(look(s).y, full * soft_share(angles[i], 30.0), 1e-11);
        }
        scene_destroy(s);
    }
    stage g = stage_of(floor_scene, "lamp.kind=soft_cone");
    for (size_t i = 0; i < COUNT(angles); i++) {
        aim(g.setting, angles[i], 200.0);
        stage_look(&g);
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 3.0, -4.0), vec3_make(0.0, -0.6, 0.8));
        assert_near(tree->radiance[0], irradiance * soft_share(angles[i], 30.0), 1e-12);
        assert_int_equal(tree->count, angles[i] < 30.0 ? 2 : 1);
    }
    stage_close(&g);
}

/* Two spotlights in one place, one facing away: the probe's shadow ray belongs to the other. */
static void the_probe_names_the_spotlight_that_contributes(void **state)
{
    (void)state;
    stage g = stage_of("render: {width: 1, height: 1, depth: 0}\n"
                       "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                       "lights:\n"
                       "  away: {kind: cone, position: [3, 4, 0], target: [9, 4, 0]}\n"
                       "  here: {kind: cone, position: [3, 4, 0], target: [0, 0, 0]}\n"
                       "solids: {floor: {shape: plane, diffuse: 1}}\n",
                       "");
    const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 3.0, -4.0), vec3_make(0.0, -0.6, 0.8));
    assert_int_equal(tree->count, 2);
    assert_int_equal(tree->node[1].light, 1);
    stage_close(&g);
}

/* A visible light sphere: its radiance is (reach / radius)^2 inside the cone, black outside. */
static void a_spheres_cone_is_visible_only_from_inside(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set_all(s, "render.integrator=path render.filter=centre lamp.kind=soft_cone lamp.radius=0.5 lamp.reach=2 "
               "floor.visible=off "
               "camera.position=0,0,0 "
               "camera.target=3,4,0");
    for (double angle_deg = 0.0; angle_deg < 40.0; angle_deg += 8.0) {
        aim(s, angle_deg, 50.0);
        assert_near(look(s).x, 16.0 * soft_share(angle_deg, 30.0), 1e-10);
    }
    scene_destroy(s);
}

/* Irradiance by a sphere that covers a cap of half-angle g about w, whose radiance (1 - (1 - o.u) / q) is linear in the
 * direction o towards it (u: against the axis, q = 1 - cos a). Over the cap the integral of o is pi sin^2 g w, that of
 * o o^T is A 1 + B w w^T with 3 A + B = 2 pi (1 - cos g) and A + B = 2 pi (1 - cos^3 g) / 3. */
static void irradiance_by_a_soft_sphere_equals_its_integral(void **state)
{
    (void)state;
    scene *s = scene_from(floor_scene);
    set_all(
        s,
        "render.integrator=path render.filter=centre render.paths=65536 lamp.kind=soft_cone lamp.radius=2 lamp.reach=5 "
        "lamp.half_angle_deg=70");
    aim(s, 30.0, 0.0);
    const double pi = acos(-1.0), c = sqrt(1.0 - 4.0 / 25.0), q = 1.0 - cos(70.0 * DEGREE);
    const double trace = 2.0 * pi * (1.0 - c), along = 2.0 * pi * (1.0 - c * c * c) / 3.0, A = (trace - along) / 2.0,
                 B = along - A;
    const vec3 n = vec3_make(0.0, 1.0, 0.0), w = vec3_make(0.6, 0.8, 0.0);
    const vec3 u = vec3_normalize(vec3_sub(s->lights[0].position, s->lights[0].target));
    const double first = pi * 4.0 / 25.0 * vec3_dot(n, w),
                 second = A * vec3_dot(n, u) + B * vec3_dot(n, w) * vec3_dot(w, u);
    const double radiance = 25.0 / 4.0, expected = radiance / pi * ((1.0 - 1.0 / q) * first + second / q);
    assert_near(look(s).x, expected, 0.002 * expected);
    assert_true(fabs(expected - irradiance * soft_share(30.0, 70.0)) >
                0.005 * expected); /* not the value of a point light */
    scene_destroy(s);
}

static void a_cone_needs_a_direction(void **state)
{
    (void)state;
    static const char *const kinds[] = {"cone", "soft_cone"};
    diagnostic why = {0};
    char text[DIAGNOSTIC_TEXT_MAX];
    scene *s = scene_from(floor_scene);
    set(s, "lamp.target=3,4,0");
    worked(scene_check(s, &why), &why); /* a point light ignores its target */
    for (int k = 0; k < 2; k++) {
        s->lights[0].kind = k + 1;
        assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(diagnostic_text(&why, text, sizeof text), "lamp: the light is at its own target"));
        char line[200];
        snprintf(line, sizeof line, "lights: {spot: {kind: %s, position: [0, 0, 0]}}\n", kinds[k]);
        scene *none = NULL;
        assert_int_equal(scene_read_text("test.yaml", line, strlen(line), &none, &why), STATUS_BAD_INPUT);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cone_has_full_intensity_inside_and_none_outside),
        cmocka_unit_test(a_soft_cone_falls_with_the_cosine),
        cmocka_unit_test(colour_and_falloff_are_the_same_for_every_kind_of_light),
        cmocka_unit_test(the_falloff_applies_to_highlights),
        cmocka_unit_test(no_shadow_rays_are_traced_outside_a_cone),
        cmocka_unit_test(all_integrators_have_the_same_cone_falloff),
        cmocka_unit_test(the_probe_names_the_spotlight_that_contributes),
        cmocka_unit_test(a_spheres_cone_is_visible_only_from_inside),
        cmocka_unit_test(irradiance_by_a_soft_sphere_equals_its_integral),
        cmocka_unit_test(a_cone_needs_a_direction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
