/* Tests of the probe: a tree's radiance is the film's, to the bit, and the values of its hits obey the laws. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "geometry/scene_geometry.h"
#include "render/inspect/probe.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

static probe *probe_of(const scene *s)
{
    probe *p = NULL;
    diagnostic why = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    return p;
}

/* 50 pixels, spread over the image. */
static void compare_pixels(scene *s)
{
    render_result *frame = render(s);
    probe *p = probe_of(s);
    ray_tree tree = {0};
    diagnostic why = {0};
    const int width = (int)s->render.width, height = (int)s->render.height;
    for (int k = 0; k < 50; k++) {
        const int at = (int)((int64_t)k * 7919 % (width * height)), x = at % width, y = at / width;
        worked(probe_pixel(p, x, y, &tree, &why), &why);
        double contribution[3] = {0};
        for (size_t i = 0; i < tree.count; i++)
            for (int c = 0; c < 3; c++)
                contribution[c] += tree.node[i].contribution[c]; /* multiples of the film's step: exact */
        for (int c = 0; c < 3; c++) {
            assert_true(tree.radiance[c] == film_value(frame->img, x, y, c));
            assert_true(contribution[c] == tree.radiance[c]);
        }
    }
    ray_tree_release(&tree);
    probe_destroy(p);
    render_result_destroy(frame);
}

static void compare_settings(const char *const *settings, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        scene *s = rod_scene("render.width=96 render.height=72");
        set_all(s, settings[i]);
        compare_pixels(s);
        scene_destroy(s);
    }
}

static void the_radiance_of_a_tree_equals_the_film_at_every_depth(void **state)
{
    (void)state;
    static const char *const settings[] = {"render.depth=0", "render.depth=1", "render.depth=4", "render.depth=9",
                                           "render.depth=5 render.beyond=black"};
    compare_settings(settings, sizeof settings / sizeof *settings);
}

static void the_radiance_of_a_tree_equals_the_film_with_all_settings(void **state)
{
    (void)state;
    static const char *const settings[] = {
        "render.weights=constant clear.reflectivity=0.1 clear.transparency=0.9",
        "render.samples=4",
        "render.polarisation=on",
        "render.polarisation=on render.samples=4 render.depth=7",
        "liquid.absorb_per_m=1.5,0.4,0.1 vessel.absorb_per_m=0.2,0.1,0.3",
        "render.min_weight=0.02 render.depth=12",
        "render.shadows=off",
        "render.shadows=opaque",
        "render.lighting=lambert",
        "render.integrator=raycast",
        "background.kind=gradient liquid.ior=1",
        "vessel.medium=bk7 liquid.medium=water render.lambda_nm=450",
        "render.polarisation=on liquid.absorb_per_m=0.5,0.4,0.1 plastic.reflectivity=0.4 render.samples=4"};
    compare_settings(settings, sizeof settings / sizeof *settings);
}

/* In the rod's pixels parents and children are consistent. */
static void check_node(const ray_tree *tree, int at)
{
    const ray_node *node = &tree->node[at];
    const ray_hit *hit = &node->hit;
    assert_true(fabs(vec3_length(node->direction) - 1.0) < 1e-15);
    assert_true((node->first_child != RAY_NONE) <= (node->end == RAY_END_HIT));
    if (node->end != RAY_END_HIT)
        return;
    assert_true(hit->t > 0.0 && vec3_dot(hit->normal, node->direction) < 0.0);
    assert_true(vec3_length(vec3_sub(hit->point, vec3_add(node->origin, vec3_scale(node->direction, hit->t)))) < 1e-12);
    const double eta = hit->n_from / hit->n_to, sin2_t = eta * eta * (1.0 - hit->cos_i * hit->cos_i);
    if (!hit->opaque)
        assert_true(hit->tir ? sin2_t >= 1.0 && hit->R == 1.0 : fabs(hit->cos_t * hit->cos_t + sin2_t - 1.0) < 1e-13);
    for (int i = node->first_child; i != RAY_NONE; i = tree->node[i].next) {
        const ray_node *child = &tree->node[i];
        assert_int_equal(child->parent, at);
        assert_int_equal(child->depth, node->depth + (child->kind != RAY_SHADOW));
        assert_true(vec3_length(vec3_sub(child->origin, hit->point)) == 0.0);
        if (child->kind == RAY_SHADOW) {
            assert_true(child->end == RAY_END_LIT || child->end == RAY_END_BLOCKED);
            continue;
        }
        const double share = (child->kind == RAY_REFLECT ? hit->R : 1.0 - hit->R) * node->throughput[0];
        assert_true(fabs(child->throughput[0] - share) < 1e-14);
        assert_int_equal(child->medium, child->kind == RAY_REFLECT ? hit->from : hit->to);
        assert_true(child->depth <= tree->depth_limit || child->end == RAY_END_CUT_DEPTH);
    }
}

static void children_are_consistent_with_parents_and_the_laws_of_optics(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=96 render.height=72 render.depth=6");
    probe *p = probe_of(s);
    ray_tree tree = {0};
    size_t seen = 0;
    for (int k = 0; k < 50; k++) {
        worked(probe_pixel(p, 20 + k, 30 + k % 7, &tree, NULL), NULL);
        for (size_t i = 0; i < tree.count; i++)
            check_node(&tree, (int)i);
        seen += tree.count;
    }
    assert_true(seen > 800);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

static const char slab_text[] =
    "render: {depth: 3, shadows: off}\n"
    "solids: {slab: {shape: box, transparency: 1, ior: 1.5, size: [9, 2, 9], absorb_per_m: [0.5, 0.1, 0]}}\n";

/* R = ((n - 1) / (n + 1))^2 at normal incidence: Hecht 4.67; absorption by exp(-a d). */
static void a_slab_at_normal_incidence_has_fresnels_and_beers_shares(void **state)
{
    (void)state;
    scene *s = scene_from(slab_text);
    probe *p = probe_of(s);
    ray_tree tree = {0};
    worked(probe_ray(p, vec3_make(0.1, 5, 0.2), vec3_make(0, -3, 0), &tree, NULL), NULL);
    const ray_node *root = &tree.node[0], *inner = &tree.node[root->first_child];
    assert_string_equal(probe_medium_name(p, root->medium), "air");
    assert_string_equal(probe_face_name(p, &root->hit), "top");
    assert_true(root->hit.t == 4.0 && root->hit.cos_i == 1.0 && fabs(root->hit.R - 0.04) < 1e-15);
    assert_int_equal(inner->kind, RAY_REFLECT);
    assert_int_equal(inner->end, RAY_END_SKY);
    inner = &tree.node[inner->next];
    assert_int_equal(inner->kind, RAY_REFRACT);
    assert_true(inner->n == 1.5 && inner->hit.path_length_m == 2.0);
    assert_string_equal(probe_face_name(p, &inner->hit), "bottom");
    const double absorb[3] = {0.5, 0.1, 0.0};
    for (int c = 0; c < 3; c++)
        assert_true(fabs(inner->hit.transmittance[c] - exp(-absorb[c] * 2.0)) < 1e-15);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

/* Unpolarised light reflected by glass at Brewster's angle is fully polarised: Hecht 8.6. A cut ray records that
 * too. */
static void a_terminated_ray_keeps_its_degree_of_polarisation(void **state)
{
    (void)state;
    for (int depth = 0; depth < 2; depth++) {
        scene *s = scene_from(slab_text);
        set(s, "render.polarisation=on");
        set(s, depth ? "render.depth=1" : "render.depth=0");
        probe *p = probe_of(s);
        ray_tree tree = {0};
        worked(probe_ray(p, vec3_make(-1.5, 2, 0), vec3_make(1.5, -1, 0), &tree, NULL), NULL);
        const ray_node *mirrored = &tree.node[tree.node[0].first_child];
        assert_int_equal(mirrored->end, depth ? RAY_END_SKY : RAY_END_CUT_DEPTH);
        const double *v = mirrored->stokes;
        assert_true(fabs(v[1] * v[1] + v[2] * v[2] + v[3] * v[3] - 1.0) < 1e-12);
        ray_tree_release(&tree);
        probe_destroy(p);
        scene_destroy(s);
    }
}

/* The light that a shadow ray brings from a polarised lamp through a sheet: Malus, (1 + P cos 2 a) / 2. */
static void a_shadow_ray_from_a_polarised_lamp_obeys_malus(void **state)
{
    (void)state;
    scene *s = scene_from("render: {depth: 2, polarisation: \"on\"}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                          "lights:\n"
                          "  other: {position: [5, 10, 0]}\n"
                          "  lamp: {kind: cone, position: [0, 10, 0], target: [0, 0, 0], polarised: 0.8}\n"
                          "solids:\n"
                          "  floor: {shape: plane, diffuse: 1}\n"
                          "  sheet: {shape: box, transparency: 1, ior: 1, sheet: polariser, sheet_axis: [1, 0, 0], "
                          "position: [0, 3, 0], size: [1, 0.01, 1]}\n");
    for (int a = 0; a <= 90; a += 15) {
        s->lights[1].polarisation_deg = a;
        probe *p = probe_of(s);
        ray_tree tree = {0};
        worked(probe_ray(p, vec3_make(0, 1, -1), vec3_make(0, -1, 1), &tree, NULL), NULL);
        const ray_node *shadow = &tree.node[tree.node[0].first_child];
        while (shadow->light != 1)
            shadow = &tree.node[shadow->next];
        assert_int_equal(shadow->kind, RAY_SHADOW);
        assert_true(fabs(shadow->contribution[0] - 0.5 * (1.0 + 0.8 * cos(2.0 * a * 0.017453292519943295))) < 1e-9);
        ray_tree_release(&tree);
        probe_destroy(p);
    }
    scene_destroy(s);
}

static void a_direction_may_have_any_length(void **state)
{
    (void)state;
    scene *s = scene_from(slab_text);
    probe *p = probe_of(s);
    ray_tree tree = {0};
    const double lengths[] = {1e-200, 1e-3, 1e200};
    for (int i = 0; i < 3; i++) {
        worked(probe_ray(p, vec3_make(0, 5, 0), vec3_make(0, -lengths[i], 0), &tree, NULL), NULL);
        assert_true(tree.node[0].hit.t == 4.0);
    }
    const vec3 bad[] = {{0, 0, 0}, {NAN, 0, 1}, {0, INFINITY, 0}};
    for (int i = 0; i < 3; i++) {
        diagnostic why = {0};
        assert_int_equal(probe_ray(p, vec3_make(0, 5, 0), bad[i], &tree, &why), STATUS_BAD_INPUT);
        assert_true(why.what[0] && why.remedy[0]);
    }
    assert_int_equal(probe_ray(p, vec3_make(NAN, 5, 0), vec3_make(0, 1, 0), &tree, NULL), STATUS_BAD_INPUT);
    assert_int_equal(probe_pixel(p, -1, 0, &tree, NULL), STATUS_BAD_INPUT);
    assert_int_equal(probe_pixel(p, 0, (int)s->render.height, &tree, NULL), STATUS_BAD_INPUT);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

/* A direction taken from one tree starts the same tree again. */
static void tracing_a_stored_ray_gives_the_same_tree(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=96 render.height=72");
    probe *p = probe_of(s);
    ray_tree tree = {0}, again = {0};
    for (int k = 0; k < 50; k++) {
        worked(probe_pixel(p, 20 + k, 20 + k % 40, &tree, NULL), NULL);
        worked(probe_ray(p, tree.node[0].origin, tree.node[0].direction, &again, NULL), NULL);
        assert_int_equal(tree.count, again.count);
        assert_memory_equal(&tree.node[0].direction, &again.node[0].direction, sizeof(vec3));
        for (int c = 0; c < 3; c++)
            assert_true(tree.radiance[c] == again.radiance[c]);
    }
    ray_tree_release(&tree);
    ray_tree_release(&again);
    probe_destroy(p);
    scene_destroy(s);
}

/* R, and T^2 and T^2 R of a channel that the slab transmits: that channel alone makes a ray worth tracing, whichever it
 * is. */
static void the_weight_of_a_ray_is_its_largest_channel(void **state)
{
    (void)state;
    static const char *const clear_for[] = {"slab.absorb_per_m=0,9,9", "slab.absorb_per_m=9,0,9",
                                            "slab.absorb_per_m=9,9,0"};
    for (int clear = 0; clear < 3; clear++) {
        scene *s = scene_from(slab_text);
        set_all(s, "render.depth=8 render.min_weight=0.01 background.kind=uniform background.color=1,1,1");
        set(s, clear_for[clear]);
        probe *p = probe_of(s);
        ray_tree tree = {0};
        worked(probe_ray(p, vec3_make(0, 5, 0), vec3_make(0, -1, 0), &tree, NULL), NULL);
        for (int c = 0; c < 3; c++) {
            const double through = c == clear ? 1.0 : exp(-18.0), R = 0.04, T = 0.96;
            assert_true(fabs(tree.radiance[c] - (R + T * T * through + T * T * R * through * through)) < 1e-12);
        }
        ray_tree_release(&tree);
        probe_destroy(p);
        scene_destroy(s);
    }
}

/* A cup's hollow has a side and a floor of its own, numbered after those of its outside. */
static void the_faces_of_a_cups_hollow_are_numbered_separately(void **state)
{
    (void)state;
    static const struct {
        vec3 from, to;
        int face;
    } rays[] = {{{5, 1, 0}, {0, 1, 0}, 0},
                {{0, -5, 0}, {0, 0, 0}, 1},
                {{0, 1, 0}, {1, 1, 0}, HOLLOW_FACES},
                {{0, 5, 0}, {0, 0, 0}, HOLLOW_FACES + 1}};
    scene *s = scene_from("solids: {cup: {shape: cup, transparency: 1, ior: 1.5, radius: 1, inner_radius: 0.9, height: "
                          "3, floor: 0.1}}\n");
    probe *p = probe_of(s);
    ray_tree tree = {0};
    for (size_t i = 0; i < sizeof rays / sizeof rays[0]; i++) {
        worked(probe_ray(p, rays[i].from, vec3_sub(rays[i].to, rays[i].from), &tree, NULL), NULL);
        assert_int_equal(tree.node[0].hit.face, rays[i].face);
    }
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

/* Shadow rays to two lamps in one place coincide, but each belongs to one lamp, in their order. */
static void lamps_at_one_position_are_distinguished(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1}\n"
                          "lights: {far: {position: [0, 9, 0]}, red: {position: [0, 4, 0], color: [1, 0, 0]}, "
                          "green: {position: [0, 4, 0], color: [0, 1, 0]}}\n"
                          "solids: {floor: {shape: plane, diffuse: 1}}\n");
    probe *p = probe_of(s);
    ray_tree tree = {0};
    worked(probe_ray(p, vec3_make(1, 1, 0), vec3_make(0, -1, 0), &tree, NULL), NULL);
    int lamp = 0;
    for (int i = tree.node[0].first_child; i != RAY_NONE; i = tree.node[i].next) {
        if (tree.node[i].kind != RAY_SHADOW)
            continue;
        assert_int_equal(tree.node[i].light, lamp);
        assert_true((tree.node[i].contribution[0] > 0.0) == (lamp != 2) &&
                    (tree.node[i].contribution[1] > 0.0) == (lamp != 1));
        lamp++;
    }
    assert_int_equal(lamp, 3);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

static void a_path_refracts_or_reflects_where_requested(void **state)
{
    (void)state;
    scene *s = scene_from(slab_text);
    probe *p = probe_of(s);
    ray_tree tree = {0};
    worked(probe_path(p, vec3_make(0, 5, 0), vec3_make(0, -1, 0), -1, &tree, NULL), NULL);
    assert_int_equal(tree.count, 3);
    assert_true(tree.node[2].kind == RAY_REFRACT && tree.node[2].end == RAY_END_SKY &&
                tree.node[2].direction.y == -1.0);
    worked(probe_path(p, vec3_make(0, 5, 0), vec3_make(0, -1, 0), 1, &tree, NULL), NULL);
    assert_int_equal(tree.count, 4);
    assert_true(tree.node[2].kind == RAY_REFLECT && tree.node[3].kind == RAY_REFRACT &&
                tree.node[3].direction.y == 1.0);
    assert_true(fabs(tree.node[3].throughput[2] - 0.96 * 0.04 * 0.96) < 1e-15);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

/* At one wavelength, absorption by wavelength is equal for all channels; at 450 nm it is half way between the table's
 * points. */
static void the_probe_of_a_spectral_scene_absorbs_by_its_wavelength(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        scene *s = scene_from("render: {depth: 1, lambda_nm: 450}\nsolids: {slab: {shape: box, transparency: 1, ior: "
                              "1.5, size: [9, 9, 2],\n"
                              "  absorb_spectrum: [400, 0.5, 500, 1.5]}}\n");
        set_all(s, i ? "render.spectrum=spectral" : "render.spectrum=rgb");
        diagnostic why = {0};
        probe *p = NULL;
        ray_tree tree = {0};
        worked(probe_create(s, isa_best(), &p, &why), &why);
        if (!i)
            probe_use_one_wavelength(p);
        worked(probe_path(p, vec3_make(0.0, 0.0, -5.0), vec3_make(0.0, 0.0, 1.0), -1, &tree, &why), &why);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(tree.node[1].hit.transmittance[c] - exp(-2.0)) < 1e-14);
        ray_tree_release(&tree);
        probe_destroy(p);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_radiance_of_a_tree_equals_the_film_at_every_depth),
        cmocka_unit_test(the_radiance_of_a_tree_equals_the_film_with_all_settings),
        cmocka_unit_test(children_are_consistent_with_parents_and_the_laws_of_optics),
        cmocka_unit_test(a_slab_at_normal_incidence_has_fresnels_and_beers_shares),
        cmocka_unit_test(a_terminated_ray_keeps_its_degree_of_polarisation),
        cmocka_unit_test(a_shadow_ray_from_a_polarised_lamp_obeys_malus),
        cmocka_unit_test(a_direction_may_have_any_length),
        cmocka_unit_test(tracing_a_stored_ray_gives_the_same_tree),
        cmocka_unit_test(the_weight_of_a_ray_is_its_largest_channel),
        cmocka_unit_test(the_faces_of_a_cups_hollow_are_numbered_separately),
        cmocka_unit_test(lamps_at_one_position_are_distinguished),
        cmocka_unit_test(a_path_refracts_or_reflects_where_requested),
        cmocka_unit_test(the_probe_of_a_spectral_scene_absorbs_by_its_wavelength),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
