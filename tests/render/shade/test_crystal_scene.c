/* Crystals in scenes against closed forms: the two images of a plate (Hecht, Optics, 8.4.2; Born and Wolf, Principles
 * of Optics, 7th ed., 15.3), their polarisation, and that no light is lost. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render/inspect/probe.h"
#include "render_fixture.h"
#include "sheet_fixture.h"

static const double n_o = 1.6584, n_e = 1.4864;
#define CALCITE "ior=1.6584 extraordinary_ior=1.4864 "

/* A plate of that thickness, centred at 2. */
static void add_plate(scene *s, const char *parameters, double thickness, double turn_deg)
{
    add_sheet(s, 2.0, parameters, turn_deg, 0.0);
    s->solids[s->solid_count - 1].shape.size.z = thickness;
}

/* Where rays along d leave the plate that they have crossed once, the ordinary one first; the number of such rays. */
static int exits(const scene *s, vec3 d, vec3 where[2])
{
    int count = 0;
    ray_tree tree = {0};
    probe *p = NULL;
    worked(probe_create(s, isa_best(), &p, NULL), NULL);
    worked(probe_ray(p, vec3_sub(vec3_make(0, 0, 1), vec3_scale(d, 0.1)), d, &tree, NULL), NULL);
    for (size_t i = 0; i < tree.count; i++) {
        const ray_node *out = &tree.node[i], *in = out->parent >= 0 ? &tree.node[out->parent] : NULL;
        if (out->depth != 2 || out->kind != RAY_REFRACT || in->kind != RAY_REFRACT)
            continue;
        count++;
        where[in->stokes[1] > 0.0 ? 0 : 1] = out->origin;
        assert_near(vec3_length(vec3_sub(out->direction, d)), 0.0, 1e-14); /* a plate bends no ray */
    }
    ray_tree_release(&tree);
    probe_destroy(p);
    return count;
}

/* Thickness times the tangent of 6.2 degrees, and round with the plate. */
static void a_plate_shows_two_images(void **state)
{
    (void)state;
    const double ratio = squared(n_o / n_e), tangent = (ratio - 1.0) / (1.0 + ratio), thickness = 0.3;
    for (double turn = 0.0; turn <= 360.0; turn += 30.0) {
        scene *s = behind_air("");
        vec3 at[2];
        add_plate(s, CALCITE "optic_axis=1,0,1", thickness, turn);
        assert_int_equal(exits(s, vec3_make(0, 0, 1), at), 2);
        assert_near(at[0].x, 0.0, 1e-14);
        assert_near(at[0].y, 0.0, 1e-14);
        assert_near(at[1].x, -thickness * tangent * cos(turn * degree), 1e-13);
        assert_near(at[1].y, -thickness * tangent * sin(turn * degree), 1e-13);
        scene_destroy(s);
    }
}

/* Two pieces of one crystal are one crystal; with other axes there is a surface between them. */
static void pieces_of_a_crystal_have_no_surface_between_them(void **state)
{
    (void)state;
    scene *s = behind_air("");
    vec3 whole[2], pieces[2];
    add_plate(s, CALCITE "optic_axis=1,0,1", 0.3, 0.0);
    assert_int_equal(exits(s, vec3_make(0, 0, 1), whole), 2);
    add_plate(s, CALCITE "optic_axis=1,0,1", 0.2, 0.0);
    s->solids[1].shape.position.z = 2.1;
    assert_int_equal(exits(s, vec3_make(0, 0, 1), pieces), 2);
    assert_near(pieces[0].z, 2.2, 1e-14);
    assert_near(pieces[1].x, whole[1].x * 0.35 / 0.3, 1e-13);
    set(s, "sheet_2.optic_axis=1,0,0");
    assert_int_equal(exits(s, vec3_make(0, 0, 1), pieces), 2);
    assert_near(pieces[0].z, 2.15, 1e-14); /* at the first one's end, where the second begins */
    scene_destroy(s);
}

/* The ordinary ray by Snell; the extraordinary one in a plate cut across its axis, tan = n_o sin i / (n_e sqrt(n_e^2 -
 * sin^2 i)). */
static void oblique_rays_cross_a_plate(void **state)
{
    (void)state;
    for (double a = 5.0; a < 80.0; a += 15.0) {
        const double q = sin(a * degree), thickness = 0.02, start = (1.99 - 1.0) * tan(a * degree);
        scene *s = behind_air("");
        vec3 at[2];
        add_plate(s, CALCITE "optic_axis=0,0,1", thickness, 0.0);
        s->solids[0].shape.size = vec3_make(20.0, 20.0, thickness);
        assert_int_equal(exits(s, vec3_make(q, 0, cos(a * degree)), at), 2);
        assert_near(at[0].x - start, thickness * q / sqrt(n_o * n_o - q * q), 1e-12);
        assert_near(at[1].x - start, thickness * n_o * q / (n_e * sqrt(n_e * n_e - q * q)), 1e-12);
        scene_destroy(s);
    }
}

/* A white sky all around is white through any crystal: what is reflected and what is transmitted add up to 1. */
static void a_white_furnace_stays_white(void **state)
{
    (void)state;
    static const char *const crystals[] = {CALCITE "optic_axis=1,0,1", CALCITE "optic_axis=0.3,-0.8,0.2",
                                           "ior=1.3091 extraordinary_ior=1.3105 optic_axis=0,0,1",
                                           "ior=1.2 extraordinary_ior=2.4 optic_axis=1,2,3",
                                           "ior=1 extraordinary_ior=1.3 optic_axis=0,1,0"};
    for (int i = 0; i < 10; i++) {
        scene *s = behind_air(i % 2 ? "render.polarisation=off render.depth=7" : "render.depth=7");
        add_plate(s, crystals[i / 2], 0.3, 20.0);
        s->solids[0].shape.rotation_deg = vec3_make(35.0, 20.0, 10.0);
        assert_all(s, 1.0, 1e-9);
        add_plate(s, crystals[4 - i / 2], 0.2, 50.0); /* in the first one, and glass on it */
        set(s, "sheet_2.priority=1");
        add_sheet(s, 1.9, "ior=1.5", 0.0, 0.0);
        assert_all(s, 1.0, 1e-9);
        scene_destroy(s);
    }
}

/* A thick plate between crossed polarisers, its axis at 45 degrees: of the light that it transmits, 2 n / (n^2 + 1)
 * with all reflections, each mode has a half of a half, and the second polariser passes a half of that. */
static void thick_plates_between_crossed_polarisers(void **state)
{
    (void)state;
    scene *s = behind_air("render.depth=30 background.color=0,0,0");
    add_sheet(s, 1.0, "sheet=polariser", 90.0, 0.0);
    add_sheet(s, 3.0, "sheet=polariser", 0.0, 0.0);
    add_sheet(s, 5.0, "transparency=0 emission=1", 0.0, 0.0);
    assert_all(s, 0.0, 1e-12);
    add_plate(s, CALCITE "optic_axis=1,1,0", 0.3, 0.0);
    const double of_o = 2.0 * n_o / (n_o * n_o + 1.0), of_e = 2.0 * n_e / (n_e * n_e + 1.0);
    assert_all(s, 0.125 * (of_o + of_e), 1e-11);
    set(s, "sheet_4.optic_axis=1,0,0"); /* along the first one: nothing turns */
    assert_all(s, 0.0, 1e-12);
    set(s, "sheet_2.rotation.z=90"); /* parallel: one mode alone */
    assert_all(s, 0.5 * of_o, 1e-11);
    scene_destroy(s);
}

/* One of the two images goes when an analyser is turned across it. */
static void images_are_polarised_across_each_other(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene *s = behind_air("background.color=0,0,0 camera.analyser=linear render.depth=30");
        add_plate(s, CALCITE "optic_axis=1,0,1", 0.3, 0.0);
        add_sheet(s, 5.0, "transparency=0 emission=1", 0.0, 0.0);
        /* the board is where the ordinary image is, or the extraordinary one, and the other's place is dark */
        s->solids[1].shape.size.x = 0.02;
        s->solids[1].shape.position.x = k ? -0.0327 : 0.0;
        set(s, "camera.view_height=0.001");
        for (int a = 0; a <= 90; a += 15) {
            char text[60];
            snprintf(text, sizeof text, "camera.analyser_angle_deg=%d", a);
            set(s, text);
            const double share = squared(k ? cos(a * degree) : sin(a * degree));
            render_result *r = render(s);
            /* one surface after the other, without the reflections in the plate, which are below 8 % of it */
            const double seen = film_value(r->img, 0, 0, 1);
            assert_true(seen >= 0.5 * share * 0.87 - 1e-12 && seen <= 0.5 * share * 0.97 + 1e-12);
            render_result_destroy(r);
        }
        scene_destroy(s);
    }
}

static uint64_t hash_of(renderer *r, scene *s, const char *settings)
{
    render_result *result = NULL;
    diagnostic why = {0};
    set_all(s, settings);
    worked(renderer_render(r, s, NULL, &result, &why), &why);
    const uint64_t hash = film_hash(result->img);
    render_result_destroy(result);
    return hash;
}

/* A ray has up to four children in a crystal, so that the queues of all depths are larger than in other scenes: those
 * of a renderer that traced a deeper scene without crystals in between as well. */
static void one_renderer_traces_crystals_after_a_deeper_scene(void **state)
{
    (void)state;
    static const char small[] = "render.width=64 render.height=48 render.samples=1 render.threads=1";
    scene *s = NULL, *other = rod_scene(small);
    renderer *kept = NULL, *fresh = NULL;
    worked(scene_read("experiments/scenes/calcite.yaml", &s, NULL), NULL);
    set_all(s, small);
    worked(renderer_create(isa_best(), NULL, &kept, NULL), NULL);
    worked(renderer_create(isa_best(), NULL, &fresh, NULL), NULL);
    hash_of(kept, s, "render.depth=2");
    hash_of(kept, other, "render.depth=9");
    const uint64_t after = hash_of(kept, s, "render.depth=9");
    assert_true(after == hash_of(fresh, s, "render.depth=9"));
    renderer_destroy(kept);
    renderer_destroy(fresh);
    scene_destroy(s);
    scene_destroy(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plate_shows_two_images),
        cmocka_unit_test(pieces_of_a_crystal_have_no_surface_between_them),
        cmocka_unit_test(oblique_rays_cross_a_plate),
        cmocka_unit_test(a_white_furnace_stays_white),
        cmocka_unit_test(thick_plates_between_crossed_polarisers),
        cmocka_unit_test(images_are_polarised_across_each_other),
        cmocka_unit_test(one_renderer_traces_crystals_after_a_deeper_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
