/* Tests of the white furnace: under a sky of 1, without opaque surfaces and absorption, every ray returns 1, whatever
 * its path, because each interface has R + T = 1 (pbrt-v4's own furnace tests; Veach, Robust Monte Carlo Methods for
 * Light Transport Simulation, 1997, 5.3.1: energy is conserved). Only the light of the branches that the depth limit
 * cuts off is missing, to the last bit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/counters.h"
#include "probe_fixture.h"

/* Seven media, nested and tilted; the vessel's hollow and the plane's upper side are open to the sky. */
static const char furnace[] =
    "background: {color: [1, 1, 1]}\n"
    "camera: {position: [0.3, 1.9, -4.5], target: [0, 1, 0], fov_deg: 40}\n"
    "render: {width: 16, height: 12, beyond: black}\n"
    "solids:\n"
    "  ground: {shape: plane, transparency: 1, ior: 1.3, position: [0, 0.1, 0], rotation: [4, 0, -7]}\n"
    "  vessel: {shape: cup, transparency: 1, ior: 1.5, radius: 1, inner_radius: 0.9, height: 2, floor: 0.1, priority: "
    "3}\n"
    "  liquid: {shape: cylinder, transparency: 1, ior: 1.33, position: [0, 0.05, 0], radius: 0.95, height: 1.4, "
    "priority: 2}\n"
    "  block: {shape: box, transparency: 1, ior: 1.7, position: [0.3, 0.9, 0.1], rotation: [20, 30, 10], size: [0.8, "
    "1.1, 0.7], priority: 4}\n"
    "  core: {shape: cylinder, transparency: 1, ior: 1.2, position: [0.3, 0.4, 0.1], rotation: [0, 0, 15], radius: "
    "0.3, height: 0.9, m: 1.4,\n"
    "    priority: 5}\n"
    "  bead: {shape: sphere, transparency: 1, ior: 2.42, position: [0.2, 0.9, 0], radius: 0.2, priority: 6}\n"
    "  bubble: {shape: sphere, transparency: 1, ior: 1, position: [-0.4, 0.8, -0.5], radius: 0.45, priority: 3}\n"
    "  slab: {shape: box, transparency: 1, ior: 1.45, position: [-0.2, 1.3, 0.4], rotation: [0, 45, 80], size: [1.5, "
    "0.3, 1], priority: 1}\n";

enum { DEEPEST = 10 };

/* A whole small image, through the probe and by renders with and without the fallback of cut branches. */
static void check_image(const char *assignments, int depth)
{
    char depth_now[32];
    snprintf(depth_now, sizeof depth_now, "render.depth=%d", depth);
    stage g = stage_of(furnace, assignments);
    set(g.setting, depth_now);
    stage_look(&g);
    render_result *black = render(g.setting);
    set(g.setting, "render.beyond=sky");
    render_result *sky = render(g.setting);
    double all_cut[3] = {0.0, 0.0, 0.0}, worst = 0.0;
    size_t cuts = 0;
    for (int y = 0; y < black->img->height; y++) {
        for (int x = 0; x < black->img->width; x++) {
            const ray_tree *tree = stage_pixel(&g, x, y);
            for (size_t i = 0; i < tree->count; i++)
                cuts += tree->node[i].end == RAY_END_CUT_DEPTH;
            for (int c = 0; c < 3; c++) {
                const double cut = tree_cut(tree, c), seen = film_value(black->img, x, y, c),
                             whole = film_value(sky->img, x, y, c);
                all_cut[c] += cut;
                worst = fmax(worst, fmax(fabs(seen + cut - 1.0), fabs(tree->radiance[c] + cut - 1.0)));
                worst = fmax(worst, fmax(fabs(whole - 1.0), fabs(whole - seen - cut)));
            }
        }
    }
    assert_true(worst <= 1e-9);
    assert_true(depth > 3 || cuts > 50);
    for (int c = 0; c < 3 && CUVETTE_COUNTERS; c++) /* each cut branch is rounded to a unit */
        assert_true(fabs((double)black->counters.cut_depth_throughput[c] / COUNTERS_CUT_ONE - all_cut[c]) <=
                    0.5 * (double)(cuts + 1) / COUNTERS_CUT_ONE);
    assert_true(!CUVETTE_COUNTERS || black->counters.cut_depth == cuts);
    render_result_destroy(black);
    render_result_destroy(sky);
    stage_close(&g);
}

static void fresnel_weights_conserve_energy(void **state)
{
    (void)state;
    for (int depth = 0; depth <= DEEPEST; depth++)
        check_image("", depth);
}

static void polarised_light_conserves_energy(void **state)
{
    (void)state;
    for (int depth = 0; depth <= DEEPEST; depth += depth < 4 ? 1 : 3)
        check_image("render.polarisation=on", depth);
}

/* Films that do not absorb, on glass, water, a bubble of air and a block whose film has its own index: by channel. */
#define FILMS                                                                                                 \
    "vessel.film_thickness_nm=100 vessel.film_ior=1.38 liquid.film_thickness_nm=700 liquid.film_ior=1.47 "    \
    "bubble.film_thickness_nm=420 block.film_thickness_nm=5000 block.film_ior=1.7 core.film_thickness_nm=60 " \
    "core.film_ior=2.4"

static void thin_films_conserve_energy(void **state)
{
    (void)state;
    for (int depth = 0; depth <= DEEPEST; depth += depth < 4 ? 1 : 3)
        check_image(FILMS, depth);
}

/* Coatings without absorption, too. */
static void coatings_conserve_energy(void **state)
{
    (void)state;
    for (int depth = 0; depth <= 6; depth += 3)
        check_image("vessel.coating=ar-broad block.coating=mirror-550 bead.coating=short-pass-595 "
                    "bubble.coating=splitter-45 slab.coating=polariser-cube",
                    depth);
}

/* By wavelength, also of polarised light: at every depth the whole film is white. */
static void thin_films_conserve_energy_at_every_wavelength(void **state)
{
    (void)state;
    static const char *const kinds[] = {"render.polarisation=off", "render.polarisation=on"};
    for (size_t k = 0; k < COUNT(kinds); k++) {
        scene *s = scene_from(furnace);
        set_all(s, FILMS);
        set_all(s, "render.beyond=sky render.depth=7 render.spectrum=spectral render.wavelengths=8");
        set(s, kinds[k]);
        render_result *r = render(s);
        double worst = 0.0;
        for (int i = 0; i < 3 * r->img->width * r->img->height; i++)
            worst = fmax(worst, fabs(film_value(r->img, i / 3 % r->img->width, i / 3 / r->img->width, i % 3) - 1.0));
        assert_true(worst <= 1e-9);
        render_result_destroy(r);
        scene_destroy(s);
    }
}

/* Weights of 0.1 and 0.9 add up to 1 as well; under total reflection the transmitted share is reflected. */
static void constant_weights_conserve_energy(void **state)
{
    (void)state;
    static const char *const solids[] = {"ground", "vessel", "liquid", "block", "core", "bead", "bubble", "slab"};
    char shares[512] = "render.weights=constant";
    for (size_t k = 0; k < COUNT(solids); k++)
        snprintf(shares + strlen(shares), sizeof shares - strlen(shares), " %s.reflectivity=0.1 %s.transparency=0.9",
                 solids[k], solids[k]);
    for (int depth = 0; depth <= DEEPEST; depth += 2)
        check_image(shares, depth);
}

/* From inside each medium, and in surroundings that are not a vacuum: throughput is of power, so there is no factor
 * n^2. */
static void a_camera_in_any_medium_has_radiance_1_in_the_furnace(void **state)
{
    (void)state;
    static const char *const places[] = {"camera.position=0,1,0.7",    "camera.position=0.2,0.9,0.01",
                                         "camera.position=0.95,1,0",   "camera.position=-0.4,0.8,-0.5",
                                         "camera.position=0.1,-2,0.1", "camera.position=0,1.8,0"};
    for (size_t k = 0; k < COUNT(places); k++) {
        char all[128];
        snprintf(all, sizeof all, "%s camera.target=0.31,0.7,0.13%s", places[k], k % 2 ? " background.ior=1.38" : "");
        check_image(all, 7);
    }
}

/* Faint branches that render.min_weight cuts off are missing in the same way. */
static void radiance_plus_cut_faint_branches_is_1(void **state)
{
    (void)state;
    stage g = stage_of(furnace, "render.depth=12 render.min_weight=0.001");
    for (int y = 0; y < 12; y++) {
        for (int x = 0; x < 16; x++) {
            const ray_tree *tree = stage_pixel(&g, x, y);
            assert_true(fabs(tree->radiance[1] + tree_cut(tree, 1) - 1.0) <= 1e-9);
        }
    }
    stage_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fresnel_weights_conserve_energy),
        cmocka_unit_test(polarised_light_conserves_energy),
        cmocka_unit_test(thin_films_conserve_energy),
        cmocka_unit_test(coatings_conserve_energy),
        cmocka_unit_test(thin_films_conserve_energy_at_every_wavelength),
        cmocka_unit_test(constant_weights_conserve_energy),
        cmocka_unit_test(a_camera_in_any_medium_has_radiance_1_in_the_furnace),
        cmocka_unit_test(radiance_plus_cut_faint_branches_is_1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
