/* Tests of local light at points computed by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"

/* Local light at points computed by hand: Phong's model, shadows, checkers. One pixel, which looks along the
 * camera's axis. */

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* The camera sees the origin of a plane at V = (0, 0.6, -0.8); the lamp is at L = (0.6, 0.8, 0), so R = (-0.6, 0.8,
 * 0). */
static const char plane_scene[] = "render: {width: 1, height: 1, depth: 0}\n"
                                  "camera: {position: [0, 3, -4], target: [0, 0, 0], fov_deg: 1}\n"
                                  "background: {color: [0.1, 0.2, 0.3], ambient: [0.5, 1, 2]}\n"
                                  "lights: {lamp: {position: [3, 4, 0], color: [1, 0.5, 0.25], intensity: 2}}\n"
                                  "solids: {ground: {shape: plane, color: [0.9, 0.6, 0.3]}}\n";

static void expect_color(vec3 seen, double r, double g, double b)
{
    assert_near(seen.x, r, 1e-12);
    assert_near(seen.y, g, 1e-12);
    assert_near(seen.z, b, 1e-12);
}

static void each_term_of_phongs_model_equals_the_value_by_hand(void **state)
{
    (void)state;
    scene *s = scene_from(plane_scene);
    expect_color(look(s), 0.0, 0.0, 0.0);
    set(s, "ground.ambient=0.1");
    expect_color(look(s), 0.1 * 0.5 * 0.9, 0.1 * 1.0 * 0.6, 0.1 * 2.0 * 0.3);
    set_all(s, "ground.ambient=0 ground.diffuse=0.7"); /* N.L = 0.8 */
    expect_color(look(s), 0.7 * 2.0 * 0.9 * 0.8, 0.7 * 1.0 * 0.6 * 0.8, 0.7 * 0.5 * 0.3 * 0.8);
    set_all(s, "ground.diffuse=0 ground.specular=0.5 ground.shininess=3"); /* R.V = 0.48, and only the lamp's colour */
    const double cubed = 0.48 * 0.48 * 0.48;
    expect_color(look(s), 0.5 * 2.0 * cubed, 0.5 * 1.0 * cubed, 0.5 * 0.5 * cubed);
    set_all(s, "ground.ambient=0.1 ground.diffuse=0.7");
    vec3 seen = look(s);
    assert_near(seen.x, 0.045 + 1.008 + cubed, 1e-12);
    scene_destroy(s);
}

static void the_highlight_is_a_power_of_the_cosine(void **state)
{
    (void)state;
    static const double exponents[] = {0.0, 0.5, 1.0, 2.0, 2.5, 7.0, 80.0, 80.5, 1000.0, 5000.0};
    static const double heights[] = {4.0, 1.0, 2.25, 9.0};
    scene *s = scene_from(plane_scene);
    set_all(s, "ground.specular=1 lamp.intensity=1 lamp.color=1,1,1");
    for (size_t k = 0; k < sizeof exponents / sizeof *exponents; k++) {
        for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
            s->solids[0].surface.shininess = exponents[k];
            s->lights[0].position = vec3_make(0.0, heights[i], 3.0);
            /* R = (0, h, -3) / l, V = (0, 0.6, -0.8) */
            const double l = sqrt(heights[i] * heights[i] + 9.0), cosine = (0.6 * heights[i] + 2.4) / l;
            const double expected = pow(cosine, exponents[k]);
            assert_near(look(s).x, expected, 1e-12 + 1e-15 * exponents[k] * expected);
        }
    }
    scene_destroy(s);
}

static void a_lamp_behind_the_surface_does_not_contribute(void **state)
{
    (void)state;
    scene *s = scene_from(plane_scene);
    set_all(s, "ground.diffuse=1 ground.specular=1 ground.shininess=1 render.shadows=off lamp.position=3,-4,0");
    expect_color(look(s), 0.0, 0.0, 0.0);
    set(s, "lamp.position=3,0.001,0");
    assert_true(look(s).x > 0.0);
    scene_destroy(s);
}

/* A ball of radius 2, hit at (0, 0, -2): N = V = (0, 0, -1), L = (0, 0.6, -0.8), R = (0, -0.6, -0.8). Several lamps add
 * up. */
static void phongs_model_on_a_ball_adds_several_lamps(void **state)
{
    (void)state;
    scene *s = scene_from(
        "render: {width: 1, height: 1, depth: 0}\n"
        "camera: {position: [0, 0, -10], yaw_deg: 0}\n"
        "background: {ambient: [0, 0, 0]}\n"
        "lights:\n  one: {position: [0, 3, -6]}\n  two: {position: [-3, 0, -6], color: [0, 1, 0]}\n"
        "  behind: {position: [0, 0, 9], intensity: 100}\n"
        "solids: {ball: {shape: sphere, radius: 2, color: [1, 0.5, 0], diffuse: 0.5, specular: 0.25, shininess: 4}}\n");
    const double highlight = 0.25 * pow(0.8, 4.0), matte = 0.5 * 0.8;
    expect_color(look(s), matte + highlight, 2.0 * (matte * 0.5 + highlight), highlight);
    set(s, "ball.rotation=11,22,33");
    expect_color(look(s), matte + highlight, 2.0 * (matte * 0.5 + highlight), highlight);
    scene_destroy(s);
}

/* A clear surface has its highlight on the camera's side. */
static void a_clear_surface_has_its_highlight_on_the_cameras_side(void **state)
{
    (void)state;
    scene *s = scene_from(
        "render: {width: 1, height: 1, depth: 0, shadows: off, beyond: black}\n"
        "camera: {position: [0, 0, -10], yaw_deg: 0}\n"
        "lights: {lamp: {position: [0, 3, -6]}}\n"
        "solids: {ball: {shape: sphere, radius: 2, transparency: 1, ior: 1.5, specular: 0.25, shininess: 4}}\n");
    expect_color(look(s), 0.25 * pow(0.8, 4.0), 0.25 * pow(0.8, 4.0), 0.25 * pow(0.8, 4.0));
    /* from inside the far side is hit, at (0, 0, 2), with N = (0, 0, -1), away from the lamp outside */
    set(s, "camera.position=0,0,0");
    s->lights[0].position = vec3_make(0.0, 0.0, 1.0);
    assert_near(look(s).x, 0.25, 1e-12);
    s->lights[0].position = vec3_make(0.0, 0.0, 5.0);
    assert_true(look(s).x == 0.0);
    scene_destroy(s);
}

/* A solid is half way to the lamp: `off` ignores it, `opaque` tests only whether it exists, `attenuated` uses the
 * transmittance of its two surfaces. */
static void shadow_modes_ignore_block_or_attenuate(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {width: 1, height: 1, depth: 0}\n"
                   "camera: {position: [0, 3, -4], target: [0, 0, 0]}\n"
                   "background: {ambient: [0, 0, 0]}\n"
                   "lights: {lamp: {position: [3, 4, 0]}}\n"
                   "solids:\n"
                   "  ground: {shape: plane, diffuse: 1}\n"
                   "  between: {shape: sphere, radius: 0.5, position: [1.5, 2, 0], transparency: 0.8, ior: 1.5}\n");
    static const struct {
        const char *settings;
        double share;
    } cases[] = {{"render.shadows=off", 1.0},
                 {"render.shadows=opaque", 0.0},
                 {"render.shadows=attenuated", 0.64},
                 {"between.transparency=1", 1.0},
                 {"render.shadows=opaque", 0.0},
                 {"between.ior=1", 1.0}, /* with index 1 it has no surface */
                 {"render.shadows=attenuated between.transparency=0.5", 1.0},
                 {"between.ior=1.5", 0.25},
                 {"render.weights=constant between.ior=1", 0.25}, /* constant weights: still a surface */
                 {"between.transparency=0", 0.0},
                 {"between.position=6,8,0", 1.0},     /* behind the lamp */
                 {"between.position=3,4,0", 0.0},     /* around the lamp */
                 {"between.position=-1.5,-2,0", 1.0}, /* under the ground */
                 {"between.visible=off between.position=1.5,2,0", 1.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        set_all(s, cases[k].settings);
        assert_near(look(s).x, 0.8 * cases[k].share, 1e-12);
    }
    scene_destroy(s);
}

/* Straight down at points of a plane: cells of 0.5, even ones with the first colour, also left of and behind the
 * origin. */
static void the_checkers_of_a_plane_have_the_given_size_and_phase(void **state)
{
    (void)state;
    static const double at[] = {-1.3, -0.8, -0.3, 0.2, 0.7, 1.2};
    scene *s = scene_from("render: {width: 1, height: 1, depth: 0}\n"
                          "camera: {pitch_deg: -90}\n"
                          "background: {ambient: [1, 1, 1]}\n"
                          "solids: {ground: {shape: plane, ambient: 1, color: [1, 0, 0], "
                          "checker: 0.5, checker_color: [0, 1, 0]}}\n");
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) {
            s->camera.position = vec3_make(at[i], 2.0, at[k]);
            const int even = ((int)floor(at[i] / 0.5) + (int)floor(at[k] / 0.5)) % 2 == 0;
            expect_color(look(s), even, !even, 0.0);
        }
    scene_destroy(s);
}

/* The pattern rotates and moves with its solid. */
static void checkers_transform_with_their_solid(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 0}\n"
                          "camera: {pitch_deg: -90}\n"
                          "background: {ambient: [1, 1, 1]}\n"
                          "solids: {slab: {shape: box, size: [4, 0.9, 4], ambient: 1, color: [1, 0, 0], "
                          "checker: 0.5, checker_color: [0, 1, 0]}}\n");
    s->camera.position = vec3_make(0.7, 2.0, 0.2); /* cells 1, 0 and, at y = 0.45, 0: odd */
    expect_color(look(s), 0.0, 1.0, 0.0);
    set(s, "slab.rotation=0,90,0"); /* z goes to x: local (-0.2, 0.45, 0.7), cells -1, 0, 1 */
    expect_color(look(s), 1.0, 0.0, 0.0);
    set(s, "slab.position=0.5,0,0"); /* local (-0.2, 0.45, 0.2): cells -1, 0, 0 */
    expect_color(look(s), 0.0, 1.0, 0.0);
    set_all(s, "slab.position=0,0,0 slab.rotation=0,0,0 slab.size=4,1.9,4"); /* y = 0.95: cell 1 */
    expect_color(look(s), 1.0, 0.0, 0.0);
    scene_destroy(s);
}

/* On a rotated flat face the coordinate across it is zero up to rounding, or on a border between cells: rounding must
 * not choose the cell. */
static void rounding_does_not_change_checkers_on_rotated_faces(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {width: 1, height: 1, depth: 0}\n"
                   "background: {ambient: [1, 1, 1]}\n"
                   "materials: {board: {ambient: 1, color: [1, 0, 0], checker: 0.5, checker_color: [0, 1, 0]}}\n"
                   "solids:\n"
                   "  floor: {shape: plane, material: board, rotation: [10, 20, 7]}\n"
                   "  block: {shape: box, material: board, size: [6, 1, 6], rotation: [10, 20, 7], visible: off}\n");
    const mat3 turn = rotation_from_deg(vec3_make(10.0, 20.0, 7.0));
    for (int block = 0; block < 2; block++) {
        for (int i = -5; i < 5; i++)
            for (int k = -5; k < 5; k++) {
                const double x = i * 0.5 + 0.1, z = k * 0.5 + 0.3, y = block ? 0.5 : 0.0;
                s->camera.target = mat3_apply(turn, vec3_make(x, y, z));
                s->camera.position = mat3_apply(turn, vec3_make(x, y + 2.0, z));
                s->camera.aimed = 1;
                /* the block's face y = 0.5 shows the cells below it, 0 <= y < 0.5: like the plane */
                const int even = (i + k) % 2 == 0;
                expect_color(look(s), even, !even, 0.0);
            }
        set_all(s, "floor.visible=off block.visible=on");
    }
    scene_destroy(s);
}

/* Each flat face is on a border between cells of 0.5 and shows those behind it: for a box 0 under the upper faces and
 * -1 over the lower ones; for a cylinder 0 over its bottom and 1 under its top at 1. */
static void flat_faces_show_the_checkers_behind_them(void **state)
{
    (void)state;
    static const struct {
        vec3 outward;
        double at;
        int cell;
    } faces[] = {{{1, 0, 0}, 0.5, 0},   {{0, 1, 0}, 0.5, 0},   {{0, 0, 1}, 0.5, 0},
                 {{-1, 0, 0}, 0.5, -1}, {{0, -1, 0}, 0.5, -1}, {{0, 0, -1}, 0.5, -1},
                 {{0, -1, 0}, 0.0, 0},  {{0, 1, 0}, 1.0, 1}}; /* the last two are the cylinder's */
    scene *s = scene_from("render: {width: 1, height: 1, depth: 0}\n"
                          "background: {ambient: [1, 1, 1]}\n"
                          "materials: {board: {ambient: 1, color: [1, 0, 0], checker: 0.5, checker_color: [0, 1, 0]}}\n"
                          "solids:\n"
                          "  block: {shape: box, material: board, size: [1, 1, 1]}\n"
                          "  drum: {shape: cylinder, material: board, radius: 1, height: 1, visible: off}\n");
    for (size_t k = 0; k < sizeof faces / sizeof faces[0]; k++) {
        const vec3 n = faces[k].outward;
        if (k == 6)
            set_all(s, "block.visible=off drum.visible=on");
        for (int i = -1; i <= 0; i++)
            for (int j = -1; j <= 0; j++) { /* across the face, and the cell's indices there */
                const double a = i * 0.5 + 0.2, b = j * 0.5 + 0.3;
                const vec3 in_face = n.x != 0.0   ? vec3_make(0.0, a, b)
                                     : n.y != 0.0 ? vec3_make(a, 0.0, b)
                                                  : vec3_make(a, b, 0.0);
                s->camera.target = vec3_add(in_face, vec3_scale(n, faces[k].at));
                s->camera.position = vec3_add(s->camera.target, n);
                s->camera.aimed = 1;
                const int even = (i + j + faces[k].cell) % 2 == 0;
                expect_color(look(s), even, !even, 0.0);
            }
    }
    scene_destroy(s);
}

/* Yaw rotates the image even when the camera looks straight down. */
static void yaw_rotates_the_image_when_looking_down(void **state)
{
    (void)state;
    scene *s = scene_from(
        "render: {width: 8, height: 6, depth: 0}\n"
        "camera: {position: [0.5, 3, 0.2], pitch_deg: -90}\n"
        "background: {ambient: [1, 1, 1]}\n"
        "solids: {floor: {shape: plane, ambient: 1, color: [1, 0, 0], checker: 0.5, checker_color: [0, 1, 0]}}\n");
    render_result *level = render_at(s, isa_best(), NULL);
    set(s, "camera.yaw_deg=180");
    render_result *turned = render_at(s, isa_best(), NULL);
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 8; x++)
            assert_true(film_value(level->img, x, y, 0) == film_value(turned->img, 7 - x, 5 - y, 0));
    set(s, "camera.yaw_deg=40");
    render_result *askew = render_at(s, isa_best(), NULL);
    assert_true(film_hash(askew->img) != film_hash(level->img));
    render_result_destroy(level);
    render_result_destroy(turned);
    render_result_destroy(askew);
    scene_destroy(s);
}

/* An opaque mirror reflects light times its reflectivity, once for each bounce. */
static void reflectivities_of_mirrors_multiply(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 2, beyond: black}\n"
                          "camera: {position: [0, 3, -4], target: [0, 0, 0]}\n"
                          "background: {color: [1, 1, 1], ambient: [0, 0, 0]}\n"
                          "solids:\n  ground: {shape: plane, reflectivity: 0.5}\n"
                          "  wall: {shape: plane, position: [0, 0, 4], rotation: [-90, 0, 0], reflectivity: 0.4}\n");
    expect_color(look(s), 0.2, 0.2, 0.2); /* off the ground, off the wall, into the sky behind the camera */
    set(s, "render.depth=1");
    expect_color(look(s), 0.0, 0.0, 0.0);
    set(s, "render.beyond=sky");
    expect_color(look(s), 0.2, 0.2, 0.2);
    set(s, "wall.visible=off");
    expect_color(look(s), 0.5, 0.5, 0.5);
    scene_destroy(s);
}

/* The lighting models, each of which adds a term to the previous one, and the falloff of lights, at a point
 * computed by hand. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

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
        cmocka_unit_test(each_term_of_phongs_model_equals_the_value_by_hand),
        cmocka_unit_test(the_highlight_is_a_power_of_the_cosine),
        cmocka_unit_test(a_lamp_behind_the_surface_does_not_contribute),
        cmocka_unit_test(phongs_model_on_a_ball_adds_several_lamps),
        cmocka_unit_test(a_clear_surface_has_its_highlight_on_the_cameras_side),
        cmocka_unit_test(shadow_modes_ignore_block_or_attenuate),
        cmocka_unit_test(the_checkers_of_a_plane_have_the_given_size_and_phase),
        cmocka_unit_test(checkers_transform_with_their_solid),
        cmocka_unit_test(rounding_does_not_change_checkers_on_rotated_faces),
        cmocka_unit_test(flat_faces_show_the_checkers_behind_them),
        cmocka_unit_test(yaw_rotates_the_image_when_looking_down),
        cmocka_unit_test(reflectivities_of_mirrors_multiply),
        cmocka_unit_test(each_lighting_model_adds_a_term_to_the_previous_one),
        cmocka_unit_test(raycasting_shades_only_the_first_surface),
        cmocka_unit_test(only_whitteds_lighting_traces_secondary_rays),
        cmocka_unit_test(mirrors_and_glass_are_black_without_branches),
        cmocka_unit_test(light_falls_off_with_the_squared_distance),
        cmocka_unit_test(a_lights_radius_affects_only_random_paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
