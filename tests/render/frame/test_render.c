/* Tests of whole images against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/isa.h"
#include "render/frame/renderer.h"
#include "render/plan/sampling.h"
#include "render_fixture.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

/* Whole images against closed forms: slabs, furnaces, Phong's model at points computed by hand. */

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* A slab at normal incidence from below. Transmitted light goes up, to a red zenith; reflected light goes down, to a
 * green horizon. */
static const char slab_scene[] = "render: {width: 1, height: 1, shadows: off}\n"
                                 "camera: {position: [0, -5, 0], pitch_deg: 90, fov_deg: 1}\n"
                                 "background: {kind: gradient, color: [1, 0, 0], horizon: [0, 1, 0]}\n"
                                 "materials: {glass: {transparency: 1, ior: 1.5, reflectivity: 0}}\n"
                                 "solids: {slab: {shape: box, material: glass, size: [50, 1, 50]}}\n";

typedef struct slab_light {
    double passed, back, inside_up, inside_down;
} slab_light;

/* All paths of at most depth interfaces, R and T at each; then the light still inside, by direction. Born and Wolf,
 * 7.6.1, without interference: R + T^2 R + T^2 R^3 + ... is reflected, T^2 + T^2 R^2 + ... transmitted. */
static slab_light slab_series(double R, double T, int depth)
{
    slab_light l = {0.0, 0.0, 0.0, 0.0};
    double inside = T; /* after the first interface */
    if (depth == 0)
        return (slab_light){0.0, 0.0, 1.0, 0.0};
    l.back = R;
    int up = 1;
    for (int interfaces = 2; interfaces <= depth; interfaces++) {
        *(up ? &l.passed : &l.back) += inside * T;
        inside *= R;
        up = !up;
    }
    *(up ? &l.inside_up : &l.inside_down) = inside;
    return l;
}

/* At normal incidence there is one ray inside, and each interface splits it in two. */
static void check_slab_counters(const ray_counters *c, int depth, double cut)
{
    assert_near((double)c->cut_depth_throughput[0] / COUNTERS_CUT_ONE, cut, 1e-10);
    assert_near((double)c->cut_depth_throughput[2] / COUNTERS_CUT_ONE, cut, 1e-10);
    assert_int_equal(c->cut_depth, 2);
    assert_int_equal(c->cut_weight, 0);
    for (int d = 0; d <= depth; d++)
        assert_int_equal(c->by_depth[d], d == 0 ? 1 : 2);
    assert_int_equal(c->reflect, depth);
    assert_int_equal(c->refract, depth);
}

static void check_slab(scene *s, double R, double T, double lost_share)
{
    for (int depth = 0; depth <= 12; depth++) {
        s->render.depth = depth;
        s->render.beyond = DEPTH_LIMIT_BLACK;
        const slab_light expected = slab_series(R, T, depth);
        render_result *result = render(s);
        assert_near(film_value(result->img, 0, 0, 0), expected.passed, 1e-12);
        assert_near(film_value(result->img, 0, 0, 1), expected.back, 1e-12);
        assert_true(film_value(result->img, 0, 0, 2) == 0.0);
        /* the cut light is that which the last ray inside carries to its interface, split in two there */
        const double inside = expected.inside_up + expected.inside_down, cut = inside * (R + T);
        if (CUVETTE_COUNTERS)
            check_slab_counters(&result->counters, depth, cut);
        render_result_destroy(result);
        if (lost_share == 0.0)
            assert_near(expected.passed + expected.back + cut, 1.0, 1e-14);
        /* at the depth limit the sky: the two cut branches take it from their directions */
        s->render.beyond = DEPTH_LIMIT_SKY;
        const slab_light next = slab_series(R, T, depth + 1);
        vec3 seen = look(s);
        assert_near(seen.x, next.passed + next.inside_up, 1e-12);
        assert_near(seen.y, next.back + next.inside_down, 1e-12);
    }
}

static void a_slab_with_fresnel_weights_equals_the_series(void **state)
{
    (void)state;
    scene *s = scene_from(slab_scene);
    check_slab(s, 0.04, 0.96, 0.0);
    set(s, "slab.ior=2.42");
    const double r = 1.42 / 3.42;
    check_slab(s, r * r, 1.0 - r * r, 0.0);
    set(s, "slab.transparency=0.8"); /* each interface transmits a fifth of what it refracts */
    check_slab(s, r * r, 0.8 * (1.0 - r * r), 0.2);
    scene_destroy(s);
}

static void a_slab_with_constant_weights_equals_the_series(void **state)
{
    (void)state;
    scene *s = scene_from(slab_scene);
    set_all(s, "slab.reflectivity=0.1 slab.transparency=0.9 render.weights=constant");
    check_slab(s, 0.1, 0.9, 0.0);
    set_all(s, "slab.reflectivity=0.3 slab.transparency=0.5 slab.ior=1"); /* as in the report, index 1 reflects too */
    check_slab(s, 0.3, 0.5, 0.2);
    scene_destroy(s);
}

static void branches_below_the_minimum_weight_are_cut(void **state)
{
    (void)state;
    scene *s = scene_from(slab_scene);
    set_all(s, "render.depth=8 render.min_weight=0.01");
    render_result *result = render(s);
    assert_near(film_value(result->img, 0, 0, 0), 0.96 * 0.96, 1e-12);
    assert_near(film_value(result->img, 0, 0, 1), 0.04 + 0.96 * 0.96 * 0.04, 1e-12);
    if (CUVETTE_COUNTERS) {
        assert_int_equal(result->counters.cut_weight, 1);
        assert_near((double)result->counters.cut_weight_throughput[1] / COUNTERS_CUT_ONE, 0.96 * 0.04 * 0.04, 1e-10);
        assert_int_equal(result->counters.cut_depth, 0);
    }
    render_result_destroy(result);
    scene_destroy(s);
}

/* In a slab that transmits one channel only: a branch continues as long as that channel has enough weight, whichever it
 * is. R is reflected, and T^2 and T^2 R of the clear channel; its next branch has weight 0.96 R^2. */
static void the_weight_of_a_branch_is_its_largest_channel(void **state)
{
    (void)state;
    static const char *const clear_for[] = {"slab.absorb_per_m=0,9,9", "slab.absorb_per_m=9,0,9",
                                            "slab.absorb_per_m=9,9,0"};
    for (int clear = 0; clear < 3; clear++) {
        scene *s = scene_from(slab_scene);
        set_all(s, "render.depth=8 render.min_weight=0.01 background.kind=uniform background.color=1,1,1");
        set(s, clear_for[clear]);
        const vec3 seen = look(s);
        const double by_channel[3] = {seen.x, seen.y, seen.z};
        for (int c = 0; c < 3; c++) {
            const double transmittance = c == clear ? 1.0 : exp(-9.0), R = 0.04, T = 0.96;
            assert_near(by_channel[c], R + T * T * transmittance + T * T * R * transmittance * transmittance, 1e-12);
        }
        scene_destroy(s);
    }
}

/* In a slab of unit thickness that transmits exp(-a) of each channel. The first branches have weights R and T; the one
 * inside yields T exp(-a) (R + T) at the other side, all of which depth 1 cuts off; a min_weight of 0.5 cuts the
 * smaller of each pair. */
static void terminated_throughput_is_counted_by_channel(void **state)
{
    (void)state;
    need_counters();
    const double a_per_m[3] = {0.3, 0.0, 0.1}, R = 0.04, T = 0.96;
    scene *s = scene_from(slab_scene);
    set_all(s, "slab.absorb_per_m=0.3,0,0.1 render.depth=1");
    render_result *shallow = render(s);
    set_all(s, "render.depth=8 render.min_weight=0.5");
    render_result *pruned = render(s);
    assert_int_equal(pruned->counters.cut_weight, 2);
    for (int c = 0; c < 3; c++) {
        const double transmittance = exp(-a_per_m[c]);
        assert_near((double)shallow->counters.cut_depth_throughput[c] / COUNTERS_CUT_ONE, T * transmittance, 1e-10);
        assert_near((double)pruned->counters.cut_weight_throughput[c] / COUNTERS_CUT_ONE, R + T * R * transmittance,
                    1e-10);
    }
    render_result_destroy(shallow);
    render_result_destroy(pruned);
    scene_destroy(s);
}

/* Nested clear solids, a mirror, and the camera inside them. */
static const char furnace_scene[] =
    "render: {width: 24, height: 18, shadows: off}\n"
    "camera: {position: [0.3, 2.5, -5], target: [0, 1, 0], fov_deg: 40}\n"
    "background: {kind: uniform, color: [1, 1, 1], ambient: [0, 0, 0]}\n"
    "materials: {clear: {transparency: 1}}\n"
    "solids:\n"
    "  vessel: {shape: cup, material: clear, ior: 1.5, radius: 1, inner_radius: 0.9, height: 3, floor: 0.1, "
    "priority: 2}\n"
    "  liquid: {shape: cylinder, material: clear, ior: 1.33, position: [0, 0.05, 0], radius: 0.95, "
    "height: 1.95, priority: 1}\n"
    "  ball: {shape: sphere, material: clear, ior: 2.4, position: [0.2, 1.2, 0.1], radius: 0.5, priority: 3}\n"
    "  bubble: {shape: sphere, material: clear, ior: 1, position: [0.2, 1.3, 0], radius: 0.2, priority: 4}\n"
    "  block: {shape: box, material: clear, ior: 1.6, position: [-1.2, 0.5, -1], size: [0.8, 1, 0.8], "
    "rotation: [10, 20, 30], priority: 5}\n"
    "  mirror: {shape: sphere, reflectivity: 1, position: [1.5, 0.5, -1], radius: 0.4, priority: 6}\n";

static void check_furnace(const char *settings)
{
    static const char *const eyes[] = {"0.3,2.5,-5", "0.1,0.5,-0.3",
                                       "0.2,1.25,0.1"}; /* in the air, the liquid, the bubble */
    scene *s = scene_from(furnace_scene);
    set_all(s, settings);
    for (size_t eye = 0; eye < 3; eye++) {
        diagnostic why = {0};
        worked(scene_set(s, "camera.position", eyes[eye], &why), &why);
        for (int depth = 0; depth <= 10; depth += depth < 4 ? 1 : 3) {
            s->render.depth = depth;
            render_result *result = render(s);
            for (int y = 0; y < 18; y++)
                for (int x = 0; x < 24; x++)
                    for (int c = 0; c < 3; c++)
                        assert_near(film_value(result->img, x, y, c), 1.0, 1e-9);
            assert_true(!CUVETTE_COUNTERS || result->counters.total_internal > 0 || depth < 4);
            render_result_destroy(result);
        }
    }
    scene_destroy(s);
}

static void every_pixel_of_a_white_furnace_is_white(void **state)
{
    (void)state;
    check_furnace("");
}

/* With weights that add up to 1; under total internal reflection the transmitted share is reflected too. */
static void a_furnace_under_constant_weights_is_white(void **state)
{
    (void)state;
    check_furnace("render.weights=constant clear.reflectivity=0.1 clear.transparency=0.9");
}

/* The difference from white was cut off, by depth or by weight, and is counted. */
static void terminated_light_is_counted(void **state)
{
    (void)state;
    need_counters();
    scene *s = scene_from(furnace_scene);
    for (int pruned = 0; pruned <= 1; pruned++) {
        for (int depth = 0; depth <= 8; depth += 2) {
            set(s, pruned ? "render.min_weight=0.02" : "render.min_weight=0");
            s->render.depth = depth;
            s->render.beyond = DEPTH_LIMIT_BLACK;
            render_result *result = render(s);
            for (int c = 0; c < 3; c++) {
                double sum =
                    (double)(result->counters.cut_depth_throughput[c] + result->counters.cut_weight_throughput[c]) /
                    COUNTERS_CUT_ONE;
                for (int y = 0; y < 18; y++)
                    for (int x = 0; x < 24; x++)
                        sum += film_value(result->img, x, y, c);
                assert_near(sum / (24 * 18), 1.0, 1e-9);
            }
            assert_true((result->counters.cut_weight > 0) == (pruned && depth > 0));
            render_result_destroy(result);
        }
    }
    scene_destroy(s);
}

/* The 2 x 2 samples of a pixel are the pixel centres of an image with twice the resolution. */
static void four_samples_are_the_mean_of_four_pixels(void **state)
{
    (void)state;
    scene *coarse = rod_scene("render.width=40 render.height=30 render.samples=4 render.depth=3");
    scene *fine = rod_scene("render.width=80 render.height=60 render.samples=1 render.depth=3");
    render_result *four = render(coarse), *one = render(fine);
    for (int y = 0; y < 30; y++)
        for (int x = 0; x < 40; x++)
            for (int c = 0; c < 3; c++) {
                double mean = 0.0;
                for (int k = 0; k < 4; k++)
                    mean += 0.25 * film_value(one->img, 2 * x + k % 2, 2 * y + k / 2, c);
                assert_near(film_value(four->img, x, y, c), mean, 1e-11);
            }
    assert_int_equal(four->counters.camera, CUVETTE_COUNTERS ? 4 * 40 * 30 : 0);
    render_result_destroy(four);
    render_result_destroy(one);
    scene_destroy(coarse);
    scene_destroy(fine);
}

/* Yaw rotates the camera from z towards x, so that right is (cos yaw, 0, -sin yaw); pitch raises it. A ball there is in
 * the middle of the right one of two pixels, at tan 30 degrees. */
static void objects_on_the_right_are_on_the_right_of_the_image(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 2, height: 1, shadows: off}\n"
                          "camera: {position: [0.5, 0.2, -0.3], yaw_deg: 0, fov_deg: 60}\n"
                          "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
                          "solids: {ball: {shape: sphere, ambient: 1, color: [1, 1, 1], radius: 1}}\n");
    for (int k = 0; k < 24; k++) {
        const double yaw_deg = 15.0 * k, pitch_deg = 20.0 * (k % 7 - 3), radian = acos(-1.0) / 180.0;
        const double yaw = yaw_deg * radian, pitch = pitch_deg * radian;
        const vec3 forward = vec3_make(cos(pitch) * sin(yaw), sin(pitch), cos(pitch) * cos(yaw)),
                   right = vec3_make(cos(yaw), 0.0, -sin(yaw));
        s->camera.yaw_deg = yaw_deg, s->camera.pitch_deg = pitch_deg;
        s->solids[0].shape.position =
            vec3_add(s->camera.position, vec3_scale(vec3_add(forward, vec3_scale(right, tan(30.0 * radian))), 10.0));
        render_result *result = render(s);
        assert_true(film_value(result->img, 0, 0, 0) == 0.0);
        assert_near(film_value(result->img, 1, 0, 0), 1.0, 1e-12);
        render_result_destroy(result);
    }
    scene_destroy(s);
}

/* A crossing between equal indices is no interface: no highlight, no depth, no ray. */
static void solids_of_index_one_are_invisible(void **state)
{
    (void)state;
    for (int depth = 0; depth <= 4; depth += 2) {
        scene *there = rod_scene("render.width=120 render.height=90 vessel.ior=1 liquid.ior=1");
        scene *away = rod_scene("render.width=120 render.height=90 vessel.visible=off liquid.visible=off");
        there->render.depth = away->render.depth = depth;
        render_result *a = render(there), *b = render(away);
        assert_true(film_hash(a->img) == film_hash(b->img));
        assert_memory_equal(a->counters.hits, b->counters.hits, sizeof a->counters.hits);
        assert_memory_equal(a->counters.first_hits, b->counters.first_hits, sizeof a->counters.hits);
        assert_memory_equal(a->counters.by_depth, b->counters.by_depth, sizeof a->counters.by_depth);
        assert_int_equal(ray_counters_total(&a->counters), ray_counters_total(&b->counters));
        assert_int_equal(a->counters.refract, 0);
        render_result_destroy(a);
        render_result_destroy(b);
        scene_destroy(there);
        scene_destroy(away);
    }
}

/* The counts of POV-Ray and a third program for this scene. */
static void first_hits_of_the_rod_scene_equal_those_of_other_renderers(void **state)
{
    (void)state;
    need_counters();
    scene *s = rod_scene("render.depth=0 render.shadows=off");
    render_result *result = render(s);
    const uint64_t vessel = result->counters.first_hits[scene_find_solid(s, "vessel")];
    const uint64_t liquid = result->counters.first_hits[scene_find_solid(s, "liquid")];
    assert_int_equal(result->counters.camera, 480000);
    assert_in_range(vessel + liquid, 95458 - 20, 95458 + 20);
    render_result_destroy(result);
    scene_destroy(s);
}

/* Neighbouring rays leave a slab through one face, some into an opaque box, some into the open: the surface belongs to
 * different regions. */
static void neighbouring_rays_hit_different_regions_on_one_face(void **state)
{
    (void)state;
    scene *s = scene_from(
        "render: {width: 64, height: 2, depth: 4}\n"
        "camera: {position: [0, 50, 0], yaw_deg: 0, pitch_deg: -90, fov_deg: 0.05}\n"
        "background: {color: [0, 0, 0]}\n"
        "solids:\n"
        "  slab: {shape: box, transparency: 1, ior: 1.5, position: [0, 0.5, 0], size: [9, 1, 9], priority: 1}\n"
        "  half: {shape: box, ambient: 1, color: [1, 0, 0], position: [-2, -0.25, 0], size: [4, 1.5, 9]}\n");
    render_result *result = render(s);
    int lit = 0;
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 64; x++) {
            const double red = film_value(result->img, x, y, 0);
            assert_true((red > 0.9) == (x < 32));
            lit += red > 0.0;
        }
    assert_int_equal(lit, 64);
    render_result_destroy(result);
    scene_destroy(s);
}

/* Pixel samples: the middles of k x k cells. One pixel covers, at z = 1, the square from -1 to 1, with a white
 * wall that ends at an edge: the wall's share is that of the cells whose middle it covers. */

static const char edge_scene[] = "render: {width: 1, height: 1, depth: 0}\n"
                                 "camera: {position: [0, 0, 0], yaw_deg: 0, fov_deg: 90}\n"
                                 "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
                                 "solids: {wall: {shape: box, size: [20, 20, 1e-6], ambient: 1}}\n";

/* The number of k cells from -1 to 1 whose middle is below the edge. */
static int covered(int k, double edge)
{
    int count = 0;
    for (int i = 0; i < k; i++)
        count += (2.0 * i + 1.0) / k - 1.0 < edge;
    return count;
}

static void an_edge_covers_the_cells_whose_centre_is_inside(void **state)
{
    (void)state;
    static const double edges[] = {-0.95, -0.6, -0.3, 0.05, 0.31, 0.55, 0.9, 1.1};
    scene *s = scene_from(edge_scene);
    for (int k = 1; k <= 8; k++) {
        s->render.samples = (int64_t)k * k;
        for (size_t i = 0; i < sizeof edges / sizeof *edges; i++) {
            const double expected = (double)covered(k, edges[i]) / k, rounding = k * k * 0x1p-44;
            s->solids[0].shape.position = vec3_make(edges[i] - 10.0, 0.0, 1.0);
            assert_near(look(s).x, expected, rounding);
            s->solids[0].shape.position = vec3_make(0.0, edges[i] - 10.0, 1.0);
            assert_near(look(s).y, expected, rounding);
        }
    }
    scene_destroy(s);
}

/* A corner distinguishes the cells in both directions at once. */
static void a_corner_covers_a_rectangle_of_cells(void **state)
{
    (void)state;
    scene *s = scene_from(edge_scene);
    s->solids[0].shape.position = vec3_make(-0.45 - 10.0, 0.2 - 10.0, 1.0);
    for (int k = 1; k <= 8; k++) {
        s->render.samples = (int64_t)k * k;
        assert_near(look(s).x, (double)(covered(k, -0.45) * covered(k, 0.2)) / (k * k), k * k * 0x1p-44);
    }
    scene_destroy(s);
}

/* Wavelengths and random paths use the same points; sixteen paths are too few for 64 points, and use 16. */
static void other_films_use_the_same_points(void **state)
{
    (void)state;
    scene *s = scene_from(edge_scene);
    set_all(s, "render.samples=64 render.spectrum=spectral render.wavelengths=8");
    s->solids[0].shape.position = vec3_make(0.05 - 10.0, 0.0, 1.0);
    assert_near(look(s).y, 4.0 / 8.0, 1e-9);
    s->solids[0].shape.position = vec3_make(0.2 - 10.0, 0.0, 1.0); /* the fifth column's middle is 0.125 */
    assert_near(look(s).y, 5.0 / 8.0, 1e-9);
    /* here the wall is black in front of a white sky */
    set_all(s,
            "render.spectrum=rgb render.integrator=path render.paths=64 render.filter=centre background.color=1,1,1");
    assert_near(look(s).y, 3.0 / 8.0, 1e-9);
    s->render.paths = 16; /* middles -0.75, -0.25, 0.25, 0.75 */
    assert_near(look(s).y, 2.0 / 4.0, 1e-9);
    scene_destroy(s);
}

/* The largest number of samples and wavelengths fits with the largest pixel and wavelength. */
static void the_largest_sample_and_pixel_fit_in_a_sample_key(void **state)
{
    (void)state;
    const int64_t pixel = SCENE_PIXELS_MAX - 1, sample = (int64_t)SCENE_SAMPLES_MAX * 65536 - 1, number = 3999;
    const int64_t sample_key =
        sample_key_with_wavelength(sample_key_make(pixel, sample), number) | SAMPLE_KEY_SPECULAR_BOUNCE;
    assert_true(sample_key > 0);
    assert_true(sample_key_pixel(sample_key) == pixel && sample_key_sample(sample_key) == sample &&
                sample_key_wavelength(sample_key) == number);
}

/* The view through the vessel's base, along one ray that can be computed by hand. POV-Ray 3.7 shows the ground
 * there, dark; Cuvette shows the sky. In the plane x = 0 the vessel is a stack of flat layers: a ray that comes down
 * through the vertical walls at elevation -e keeps sin e' = sin e / n in every layer, so on the horizontal base it has
 * n cos e' = sqrt(n^2 - sin^2 e) > 1: total reflection, whatever e, for every n > sqrt 2 (and through the liquid, n =
 * 1.33, including the floor of glass below it, since n cos e' is the same in all layers, sqrt(1.33^2 - sin^2 e) = 1.266
 * for the ray below). It returns upwards at +e', leaves through the far wall at +e, and ends in the sky. */

static const double GLASS = 1.5, LIQUID = 1.33;

/* Hecht, Optics, 4.6.2, written with sines only: R = (sin^2(i-t)/sin^2(i+t) + tan^2(i-t)/tan^2(i+t)) / 2. */
static double reflectance(double i, double t)
{
    double s = sin(i - t) / sin(i + t), p = tan(i - t) / tan(i + t);
    return 0.5 * (s * s + p * p);
}

typedef struct point {
    double y, z;
} point;

/* From p at elevation e (radians) to the plane z, or to the height y. */
static point to_wall(point p, double e, double z)
{
    return (point){p.y + tan(e) * (z - p.z), z};
}
static point to_height(point p, double e, double y)
{
    return (point){y, p.z + (y - p.y) / tan(e)};
}

/* The throughput of the path camera, wall, liquid, floor, base (total), floor, liquid, wall, sky. Asserts that the ray
 * takes this path. */
static double share_by_hand(double entry_y)
{
    const double e = atan2(2.75 - entry_y, 6.0 - 1.0);
    const double in_glass = asin(sin(e) / GLASS), in_liquid = asin(sin(in_glass) * GLASS / LIQUID);
    point p = to_wall((point){entry_y, -1.0}, -in_glass, -0.9);
    p = to_height(p, -in_liquid, 0.101);
    assert_true(p.z > -0.9 && p.z < 0.9);
    /* Angles of incidence on horizontal faces are from the vertical; across the floor n sin is invariant. */
    const double from_vertical = M_PI / 2 - in_liquid, floor_angle = asin(LIQUID * sin(from_vertical) / GLASS);
    assert_true(GLASS * sin(floor_angle) > 1.0); /* total reflection at the base */
    p = to_height(p, -(M_PI / 2 - floor_angle), 0.001);
    assert_true(p.z < 1.0);
    p = to_height(p, M_PI / 2 - floor_angle, 0.101);
    assert_true(p.z < 0.9);
    p = to_wall(p, in_liquid, 0.9);
    assert_true(p.y < 2.001);
    p = to_wall(p, in_glass, 1.0);
    assert_true(p.y < 3.001);
    double wall = (1 - reflectance(e, in_glass)) * (1 - reflectance(in_glass, in_liquid));
    double floor_share = 1 - reflectance(from_vertical, floor_angle);
    return wall * floor_share * floor_share * wall;
}

/* One ray to (0, entry_y, -1) among clear solids over black ground under a white sky, black beyond the last depth. */
static double radiance(const char *depth, double entry_y)
{
    scene *s;
    diagnostic why;
    assert_int_equal(scene_read("experiments/scenes/rod.yaml", &s, &why), STATUS_OK);
    const char *const settings[] = {"render.width=1",         "render.height=1",    "render.beyond=black",
                                    "background.color=1,1,1", "ground.color=0,0,0", "ground.checker=0",
                                    "rod.visible=off",        "lamp.intensity=0",   depth};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        assert_int_equal(scene_set_assignment(s, settings[i], &why), STATUS_OK);
    s->camera.target = vec3_make(0.0, entry_y, -1.0);
    renderer *r;
    render_result *result;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, &why), STATUS_OK);
    assert_int_equal(renderer_render(r, s, NULL, &result, &why), STATUS_OK);
    double value = film_value(result->img, 0, 0, 1);
    render_result_destroy(result);
    renderer_destroy(r);
    scene_destroy(s);
    return value;
}

static void the_base_of_the_vessel_reflects_the_sky(void **state)
{
    (void)state;
    for (double entry_y = 0.32; entry_y < 0.46; entry_y += 0.04) {
        double share = share_by_hand(entry_y);
        assert_true(share > 0.6);
        double with = radiance("render.depth=7", entry_y), without = radiance("render.depth=6", entry_y);
        /* The seventh branch reaches the sky; all other paths together carry at most the rest. */
        assert_true(with - without >= share - 1e-12);
        assert_true(with - without <= share + (1 - share) + 1e-12);
        assert_true(without <= 1 - share + 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slab_with_fresnel_weights_equals_the_series),
        cmocka_unit_test(a_slab_with_constant_weights_equals_the_series),
        cmocka_unit_test(branches_below_the_minimum_weight_are_cut),
        cmocka_unit_test(the_weight_of_a_branch_is_its_largest_channel),
        cmocka_unit_test(terminated_throughput_is_counted_by_channel),
        cmocka_unit_test(every_pixel_of_a_white_furnace_is_white),
        cmocka_unit_test(a_furnace_under_constant_weights_is_white),
        cmocka_unit_test(terminated_light_is_counted),
        cmocka_unit_test(four_samples_are_the_mean_of_four_pixels),
        cmocka_unit_test(objects_on_the_right_are_on_the_right_of_the_image),
        cmocka_unit_test(solids_of_index_one_are_invisible),
        cmocka_unit_test(first_hits_of_the_rod_scene_equal_those_of_other_renderers),
        cmocka_unit_test(neighbouring_rays_hit_different_regions_on_one_face),
        cmocka_unit_test(an_edge_covers_the_cells_whose_centre_is_inside),
        cmocka_unit_test(a_corner_covers_a_rectangle_of_cells),
        cmocka_unit_test(other_films_use_the_same_points),
        cmocka_unit_test(the_largest_sample_and_pixel_fit_in_a_sample_key),
        cmocka_unit_test(the_base_of_the_vessel_reflects_the_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
