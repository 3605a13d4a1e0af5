/* Tests of the depth buffer's layers of clear solids: against Fresnel's and Beer's formulas along one view, against
 * Whitted's rays where nothing is refracted, and the white furnace. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/compare.h"
#include "scene/model/scene.h"
#include "zbuffer_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double sky = 0.7, wall = 3.0;

/* A camera that looks along +z, at an emitting wall. */
#define VIEW                                                           \
    "render: {width: 1, height: 1, depth: 16, integrator: zbuffer}\n"  \
    "camera: {position: [0, 0, -10], target: [0, 0, 0], fov_deg: 1}\n" \
    "background: {color: [0.7, 0.7, 0.7], ambient: [0, 0, 0]}\n"       \
    "solids:\n  wall: {shape: box, emission: 3, size: [40, 40, 1], position: [0, 0, 20], priority: 9}\n"

static double seen_in(const char *solids, const char *assignments)
{
    char text[2048];
    snprintf(text, sizeof text, "%s%s", VIEW, solids);
    scene *s = scene_from(text);
    set_all(s, assignments);
    const double seen = look(s).x;
    scene_destroy(s);
    return seen;
}

/* Hecht, Optics, 4.6.3: at normal incidence. */
static double head_on(double n, double m)
{
    return (n - m) * (n - m) / ((n + m) * (n + m));
}

/* Fresnel's equations for unpolarised light. */
static double oblique(double cosine, double n, double m)
{
    const double sine = n / m * sqrt(1.0 - cosine * cosine), t = sqrt(1.0 - sine * sine);
    const double rs = (n * cosine - m * t) / (n * cosine + m * t), rp = (m * cosine - n * t) / (m * cosine + n * t);
    return 0.5 * (rs * rs + rp * rp);
}

static double behind(double reflectance, double rest)
{
    return reflectance * sky + (1.0 - reflectance) * rest;
}

static void a_slab_reflects_and_absorbs(void **state)
{
    (void)state;
    const double r = head_on(1.0, 1.5), left = exp(-0.3 * 2.0);
    static const char slab[] =
        "  slab: {shape: box, transparency: 1, ior: 1.5, absorb_per_m: [0.3, 0, 0], size: [4, 4, 2]}\n";
    assert_near(seen_in(slab, ""), behind(r, left * behind(r, wall)), 1e-9);
    assert_near(seen_in(slab, "wall.visible=off"), behind(r, left * sky), 1e-9);
    assert_near(seen_in(slab, "slab.transparency=0.5"),
                r * sky + 0.5 * (1.0 - r) * left * (r * sky + 0.5 * (1.0 - r) * wall), 1e-9);
    assert_near(seen_in(slab, "slab.emission=0.25"), 0.25 + r * sky + (1.0 - r) * left * (0.25 + behind(r, wall)),
                1e-9);
    /* rotated by 30 degrees: equal angles at both faces, and a straight path */
    const double c = sqrt(0.75), turned = oblique(c, 1.0, 1.5), longer = exp(-0.3 * 2.0 / c);
    assert_near(seen_in(slab, "slab.rotation=0,30,0"), behind(turned, longer * behind(turned, wall)), 1e-9);
    assert_near(
        seen_in(slab, "slab.rotation=0,30,0 render.transmission=simple slab.reflectivity=0.2 slab.transparency=0.8"),
        0.2 * sky + 0.8 * longer * (0.2 * sky + 0.8 * wall), 1e-9);
    assert_near(seen_in(slab, "render.weights=constant slab.reflectivity=0.1 slab.transparency=0.6"),
                0.1 * sky + 0.6 * left * (0.1 * sky + 0.6 * wall), 1e-9);
}

/* A ball, a cylinder and a mesh are slabs on their axis, too. */
static void curved_solids_equal_slabs_on_their_axis(void **state)
{
    (void)state;
    const double r = head_on(1.0, 1.5), expected = behind(r, exp(-0.3 * 2.0) * behind(r, wall));
    assert_near(seen_in("  ball: {shape: sphere, transparency: 1, ior: 1.5, absorb_per_m: [0.3, 0, 0]}\n", ""),
                expected, 1e-3);
    assert_near(seen_in("  can: {shape: cylinder, transparency: 1, ior: 1.5, absorb_per_m: [0.3, 0, 0], height: 4, "
                        "position: [0, -2, 0]}\n",
                        ""),
                expected, 1e-3);
}

/* The wall's index applies in the overlap; nothing is between them; equal ones are one medium. */
static void the_higher_priority_applies_where_solids_overlap(void **state)
{
    (void)state;
    static const char both[] =
        "  glass: {shape: box, transparency: 1, ior: 1.5, absorb_per_m: [0.1, 0, 0], size: [4, 4, 2], priority: 2}\n"
        "  water: {shape: box, transparency: 1, ior: 1.25, absorb_per_m: [0.4, 0, 0], size: [4, 4, 2], "
        "position: [0, 0, 1.5], priority: 1}\n";
    const double a = head_on(1.0, 1.5), b = head_on(1.5, 1.25), c = head_on(1.25, 1.0);
    assert_near(seen_in(both, ""), behind(a, exp(-0.2) * behind(b, exp(-0.4 * 1.5) * behind(c, wall))), 1e-9);
    assert_near(seen_in(both, "water.priority=3"),
                behind(a, exp(-0.1 * 1.5) * behind(b, exp(-0.4 * 2.0) * behind(c, wall))), 1e-9);
    assert_near(seen_in(both, "water.ior=1.5"), behind(a, exp(-0.2 - 0.4 * 1.5) * behind(a, wall)), 1e-9);
    /* In contact. */
    assert_near(seen_in(both, "water.position=0,0,2"), behind(a, exp(-0.2) * behind(b, exp(-0.8) * behind(c, wall))),
                1e-9);
    static const char vessel[] =
        "  cup: {shape: cup, transparency: 1, ior: 1.5, radius: 2, inner_radius: 1.5, height: 4, floor: 0.2, "
        "position: [0, -2, 0], priority: 2}\n"
        "  water: {shape: cylinder, transparency: 1, ior: 1.25, radius: 1.75, height: 3, position: [0, -1.9, 0], "
        "priority: 1}\n";
    assert_near(seen_in(vessel, ""), behind(a, behind(b, behind(b, behind(a, wall)))), 1e-3);
    const double air = behind(a, behind(a, behind(a, behind(a, wall))));
    assert_near(seen_in(vessel, "water.visible=off"), air, 1e-3);
}

/* An opaque solid is visible in front of, inside and behind a clear one, but not where a clear one has higher
 * priority. */
static void opaque_solids_among_clear_ones_are_visible_by_priority(void **state)
{
    (void)state;
    static const char block[] =
        "  glass: {shape: box, transparency: 1, ior: 1.5, absorb_per_m: [0.1, 0, 0], size: [4, 4, 4], priority: 2}\n"
        "  brick: {shape: box, emission: 1, size: [1, 1, 1], priority: 3}\n";
    const double a = head_on(1.0, 1.5);
    assert_near(seen_in(block, ""), behind(a, exp(-0.1 * 1.5)), 1e-9);
    assert_near(seen_in(block, "brick.priority=1"), behind(a, exp(-0.4) * behind(a, wall)), 1e-9);
    /* The brick begins where the glass ends. */
    assert_near(seen_in(block, "brick.priority=1 brick.position=0,0,2"), behind(a, exp(-0.4)), 1e-9);
    assert_near(seen_in(block, "brick.position=0,0,-3"), 1.0, 1e-9);
}

/* From inside: the path to the surface absorbs; beyond the critical angle, asin(1 / 1.5) = 41.8 degrees, the sky is
 * reflected. */
static void a_camera_in_a_clear_solid_has_absorption_and_total_reflection(void **state)
{
    (void)state;
    static const char around[] =
        "  block: {shape: box, transparency: 1, ior: 1.5, absorb_per_m: [0.05, 0, 0], size: [60, 60, 24]}\n";
    const double a = head_on(1.5, 1.0);
    assert_near(seen_in(around, ""), exp(-0.05 * 22.0) * behind(a, wall), 1e-9);
    assert_near(seen_in(around, "block.rotation=0,30,0 wall.visible=off"),
                exp(-0.05 * (12.0 / sqrt(0.75) + 10.0)) * sky, 1e-9);
    assert_near(seen_in(around, "block.size=24,24,24 block.rotation=0,44,0 wall.emission=0"),
                exp(-0.05 * (12.0 / cos(44.0 * 3.141592653589793 / 180.0) + 10.0)) * sky, 1e-9);
    assert_near(seen_in(around, "wall.position=0,0,5"), exp(-0.05 * 14.5) * wall, 1e-9);
}

/* Next to the faces of a cube of glass, away from it, there is only sky; from inside, what the glass leaves of it. */
static void a_camera_is_in_a_clear_mesh_or_not(void **state)
{
    (void)state;
    static const char cube[] = "render: {width: 1, height: 1, depth: 16, integrator: zbuffer}\n"
                               "camera: {fov_deg: 1}\nbackground: {color: [0.7, 0.7, 0.7], ambient: [0, 0, 0]}\n"
                               "meshes: {cube: {generate: box}}\n"
                               "solids: {block: {shape: mesh, mesh: cube, scale: [2, 2, 2], transparency: 1, ior: 1.5, "
                               "absorb_per_m: [0.3, 0.3, 0.3]}}\n";
    scene *s = scene_loaded(cube, "");
    for (int k = 0; k < 4 * 9; k++) {
        const double sign = k & 1 ? 1.0 : -1.0, a = 0.3 * (k / 4 % 3 - 1), b = 0.2 * (k / 12 - 1);
        for (int inside = 0; inside < 2; inside++) {
            const double near = sign * (inside ? 0.5 : 1.02), far = sign * 5.0;
            s->camera.position = k & 2 ? vec3_make(near, a, b) : vec3_make(a, b, near);
            s->camera.target = k & 2 ? vec3_make(far, a, b) : vec3_make(a, b, far);
            assert_near(look(s).x, inside ? exp(-0.3 * 0.5) * sky : sky, 1e-9);
        }
    }
    scene_destroy(s);
}

/* Green light, which glass does not absorb, through a cube whose axis the view misses. */
static double seen_through(const char *shape, double off_axis, int turn_deg)
{
    char text[2048], assignments[80];
    snprintf(text, sizeof text,
             "%s  block: {%s, transparency: 1, ior: 1.5, absorb_per_m: [0.3, 0, 0]}\nmeshes: {cube: {generate: box}}\n",
             VIEW, shape);
    snprintf(assignments, sizeof assignments, "block.position=%g,0,0 block.rotation=0,%d,0", off_axis, turn_deg);
    scene *s = scene_loaded(text, assignments);
    const double seen = look(s).y;
    scene_destroy(s);
    return seen;
}

/* The normals at the corners of a flat face are equal, so that it is not curved, of a mesh too. A view nearer to the
 * axis than an edge leaves by the opposite face; others leave by a face perpendicular to the one that they entered by,
 * where the sine of their angle is sqrt(1 - sin^2 / 1.5^2) > 1 / 1.5: all light is reflected. */
static void flat_faces_refract_by_their_own_angles(void **state)
{
    (void)state;
    static const char *const shapes[] = {"shape: box, size: [2, 2, 2]",
                                         "shape: mesh, mesh: cube, scale: [2, 2, 2], shading: smooth"};
    for (int k = 0; k < 2 * 5; k++)
        for (int turn_deg = 7; turn_deg < 90; turn_deg += 9) {
            const double off_axis = 0.41 * (k / 2 - 2), turn = turn_deg * 3.141592653589793 / 180.0;
            const double r = oblique(fmax(cos(turn), sin(turn)), 1.0, 1.5);
            const bool opposite = fabs(off_axis) < fabs(cos(turn) - sin(turn));
            assert_near(seen_through(shapes[k % 2], off_axis, turn_deg), opposite ? behind(r, behind(r, wall)) : sky,
                        1e-9);
        }
}

static void layers_beyond_the_depth_limit_show_the_fallback(void **state)
{
    (void)state;
    static const char slab[] = "  slab: {shape: box, transparency: 1, ior: 1.5, size: [4, 4, 2]}\n";
    const double a = head_on(1.0, 1.5);
    assert_near(seen_in(slab, "render.depth=0"), sky, 1e-9);
    assert_near(seen_in(slab, "render.depth=0 render.beyond=black"), 0.0, 0.0);
    assert_near(seen_in(slab, "render.depth=1 render.beyond=black"), a * sky, 1e-9);
    assert_near(seen_in(slab, "render.depth=2 render.beyond=black"), behind(a, behind(a, wall)), 1e-9);
    assert_near(seen_in(slab, "render.lighting=phong"), 0.0, 0.0); /* no branches: only its surface */
}

static const char clear_scene[] =
    "render: {width: 160, height: 120, depth: 24, shadows: off}\n"
    "camera: {position: [0, 2.5, -7], target: [0, 0.8, 0], fov_deg: 40}\n"
    "background: {kind: gradient, color: [0.1, 0.2, 0.3], ambient: [0.5, 0.6, 0.7]}\n"
    "lights: {lamp: {position: [4, 7, -5]}}\n"
    "meshes: {donut: {generate: torus, major: 0.6, minor: 0.25}, ball: {generate: icosphere, level: 4}}\n"
    "materials:\n"
    "  tiles: {diffuse: 0.7, ambient: 0.1, checker: 0.5, color: [0.8, 0.8, 0.8], checker_color: [0.2, 0.3, 0.4]}\n"
    "  clear: {transparency: 0.9, specular: 0.3, diffuse: 0.1, color: [0.9, 0.8, 0.7], ior: 1.5}\n"
    "solids:\n"
    "  ground: {shape: plane, material: tiles}\n"
    "  ring: {shape: mesh, mesh: donut, material: clear, position: [-2.2, 0.6, 0], rotation: [70, 20, 0], "
    "absorb_per_m: [0.2, 1, 2], priority: 4}\n"
    "  bubble: {shape: mesh, mesh: ball, material: clear, position: [-1.6, 0.6, 0.4], scale: [0.7, 0.6, 0.5], "
    "absorb_per_m: [1, 0.2, 0], priority: 1}\n"
    "  cup: {shape: cup, material: clear, radius: 0.9, inner_radius: 0.7, height: 1.6, floor: 0.2, "
    "position: [0.2, 0.1, -0.5], rotation: [-10, 0, 5],\n"
    "    absorb_per_m: [0.1, 0.3, 0.1], priority: 3}\n"
    "  water: {shape: cylinder, material: clear, radius: 0.8, height: 1, position: [0.2, -0.3, -0.5], "
    "absorb_per_m: [2, 0.5, 0.2], priority: 2}\n"
    "  rod: {shape: box, material: tiles, size: [0.2, 2, 0.2], position: [0.3, 1, -0.4], rotation: [0, 0, 20], "
    "priority: 5}\n"
    "  can: {shape: cylinder, material: clear, radius: 0.6, height: 1.2, m: 2, position: [2, 0.2, 0.5], "
    "rotation: [0, 30, 20], absorb_per_m: [0.1, 1, 0.4]}\n"
    "  crate: {shape: box, material: tiles, size: [1, 1, 1], position: [2.3, 0.2, 0.9], rotation: [10, 40, 5], "
    "priority: -1}\n";

/* Where light is not refracted and surfaces do not reflect, rays give the same image, except at outlines. */
static void views_without_refraction_equal_ray_tracing(void **state)
{
    (void)state;
    static const char *const variants[] = {"",
                                           "render.samples=4",
                                           "ground.priority=3",
                                           "camera.position=0.2,0.8,-0.55 camera.target=2,0.6,0.5",
                                           "camera.position=-1.6,0.7,0.3 camera.target=2,0.6,0.5",
                                           "water.priority=7 can.priority=-3",
                                           "ring.shading=flat bubble.shading=gouraud",
                                           "camera.position=-2.2,0.9,-4 camera.target=-2,0.5,3"};
    for (size_t v = 0; v < COUNT(variants); v++) {
        scene *s = scene_loaded(clear_scene, variants[v]);
        set_all(s, "clear.ior=1 render.transmission=simple");
        render_result *traced = render(s);
        set(s, "render.integrator=zbuffer");
        render_result *rasterised = render(s);
        int beyond = 0;
        for (int at = 0; at < 160 * 120; at++) {
            double most = 0.0;
            for (int c = 0; c < 3; c++)
                most = fmax(most, fabs(film_value(traced->img, at % 160, at / 160, c) -
                                       film_value(rasterised->img, at % 160, at / 160, c)));
            beyond += most > 0.01;
        }
        if (beyond > 160 * 120 / 100)
            fail_msg("%s: %d pixels differ", variants[v], beyond);
        render_result_destroy(traced);
        render_result_destroy(rasterised);
        scene_destroy(s);
    }
}

/* Of two opaque walls, one slightly behind the other, the nearer is visible, whatever clear solid turns them into
 * layers: from outside, and from inside both. */
static void an_invisible_clear_solid_does_not_change_the_order(void **state)
{
    (void)state;
    static const char walls[] = "render: {width: 8, height: 8, integrator: zbuffer}\n"
                                "camera: {position: [0, 0, -2], target: [0, 0, 0], fov_deg: 40}\n"
                                "solids:\n"
                                "  near: {shape: box, emission: 1, size: [4, 4, 1], priority: 1}\n"
                                "  far: {shape: box, emission: 2, size: [4, 4, 0.9999999998], priority: 2}\n";
    static const char bead[] =
        "  bead: {shape: box, transparency: 1, ior: 1.5, size: [0.1, 0.1, 0.1], position: [0, 1.9, "
        "0.4], priority: 3}\n";
    static const char *const eyes[] = {"camera.position=0,0,-2", "camera.position=0,0,0.1 camera.target=0,0,3"};
    for (size_t k = 0; k < COUNT(eyes); k++) {
        char with[2048];
        snprintf(with, sizeof with, "%s%s", walls, bead);
        scene *a = scene_loaded(walls, eyes[k]), *b = scene_loaded(with, eyes[k]);
        assert_true(film_hash_at(a, isa_best()) == film_hash_at(b, isa_best()));
        assert_near(look(a).x, k == 0 ? 1.0 : 2.0, 0.0);
        scene_destroy(a);
        scene_destroy(b);
    }
}

/* A rod that no view ray hits makes layers of the solid whose bounds overlap its own, and the image does not change. */
static bool stays_with_a_rod(const char *text, const char *rod, const char *assignments)
{
    char with[2048];
    snprintf(with, sizeof with, "%s  rod: {shape: box, size: [0.02, 6, 0.02], transparency: 1, priority: 9, %s}\n",
             text, rod);
    scene *a = scene_from(text), *b = scene_from(with);
    set_all(a, assignments), set_all(b, assignments);
    const bool same = film_hash_at(a, isa_best()) == film_hash_at(b, isa_best());
    scene_destroy(a);
    scene_destroy(b);
    return same;
}

/* An opaque ball in water has its highlight where the refracted view requires; out of the water its shading is
 * bit-identical; of two faces in one plane the one of higher priority is visible. */
static void an_invisible_clear_solid_does_not_change_opaque_ones(void **state)
{
    (void)state;
    static const char ball[] =
        "render: {width: 24, height: 24, integrator: zbuffer}\n"
        "camera: {position: [0.6, 0, -3], target: [0, 0, 0.5], fov_deg: 10}\n"
        "lights:\n  lamp: {position: [2, 1, -3]}\n"
        "solids:\n"
        "  water: {shape: box, size: [4, 4, 6], position: [0, 0, 1.2], transparency: 1, ior: 1.7, priority: -1}\n"
        "  ball: {shape: sphere, radius: 0.5, position: [0, 0, 0.5], specular: 1, shininess: 40}\n";
    static const char boards[] =
        "render: {width: 40, height: 30, integrator: zbuffer}\n"
        "camera: {position: [0, 0, -4], target: [0, 0, 0], fov_deg: 40}\n"
        "lights:\n  lamp: {position: [2, 1, -3]}\n"
        "solids:\n"
        "  red: {shape: box, size: [2, 2, 2], diffuse: 0.7, color: [1, 0, 0], priority: 1}\n"
        "  green: {shape: box, size: [2, 2, 2], position: [1, 0, 0], diffuse: 0.7, color: [0, 1, 0], priority: 2}\n";
    static const char by_the_ball[] = "position: [0, 2.4, 1], rotation: [45, 0, 0]";
    assert_true(stays_with_a_rod(ball, by_the_ball, ""));
    assert_true(
        stays_with_a_rod(ball, by_the_ball,
                         "water.visible=off ball.position=0.1,0.3,0.5 ball.diffuse=1 camera.position=0.3,-1.9,-3 "
                         "camera.fov_deg=20 render.width=200 render.height=200"));
    assert_true(stays_with_a_rod(boards, "position: [1.99, 2.4, 1], rotation: [-45, 0, 0]", ""));
}

/* R + T = 1 at every layer: under a sky of 1, clear solids of any index are invisible. */
static void no_light_is_lost_between_layers(void **state)
{
    (void)state;
    scene *s = scene_loaded(
        clear_scene, "render.integrator=zbuffer ground.visible=off rod.visible=off crate.visible=off "
                     "clear.absorb_per_m=0,0,0 clear.color=1,1,1 clear.transparency=1 clear.specular=0 clear.diffuse=0 "
                     "background.kind=uniform background.color=1,1,1");
    set_all(s, "ring.ior=1.8 water.ior=1.33 can.ior=0.8");
    for (int depth = 0; depth <= 12; depth += 3) {
        s->render.depth = depth;
        render_result *r = render(s);
        for (int at = 0; at < 160 * 120; at++)
            for (int c = 0; c < 3; c++)
                assert_near(film_value(r->img, at % 160, at / 160, c), 1.0, 1e-9);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* The difference between the preview of the rod and Whitted's image: black glass was at 0.2. */
static void the_rod_is_close_to_the_traced_image(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=400 render.height=300 render.depth=4");
    render_result *traced = render(s);
    set(s, "render.integrator=zbuffer");
    render_result *rasterised = render(s);
    image *a = NULL, *b = NULL;
    image_comparison c;
    assert_int_equal(film_image(traced->img, &a, NULL), STATUS_OK);
    assert_int_equal(film_image(rasterised->img, &b, NULL), STATUS_OK);
    assert_int_equal(image_compare(a, b, &c, NULL), STATUS_OK);
    print_message("rod: FLIP %.3f\n", c.flip);
    assert_true(c.flip < 0.12);
    image_destroy(a);
    image_destroy(b);
    render_result_destroy(traced);
    render_result_destroy(rasterised);
    scene_destroy(s);
}

static void layers_do_not_depend_on_order(void **state)
{
    (void)state;
    one_film_only(scene_loaded(clear_scene, "render.integrator=zbuffer"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slab_reflects_and_absorbs),
        cmocka_unit_test(curved_solids_equal_slabs_on_their_axis),
        cmocka_unit_test(the_higher_priority_applies_where_solids_overlap),
        cmocka_unit_test(opaque_solids_among_clear_ones_are_visible_by_priority),
        cmocka_unit_test(a_camera_in_a_clear_solid_has_absorption_and_total_reflection),
        cmocka_unit_test(a_camera_is_in_a_clear_mesh_or_not),
        cmocka_unit_test(flat_faces_refract_by_their_own_angles),
        cmocka_unit_test(layers_beyond_the_depth_limit_show_the_fallback),
        cmocka_unit_test(views_without_refraction_equal_ray_tracing),
        cmocka_unit_test(an_invisible_clear_solid_does_not_change_the_order),
        cmocka_unit_test(an_invisible_clear_solid_does_not_change_opaque_ones),
        cmocka_unit_test(no_light_is_lost_between_layers),
        cmocka_unit_test(the_rod_is_close_to_the_traced_image),
        cmocka_unit_test(layers_do_not_depend_on_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
