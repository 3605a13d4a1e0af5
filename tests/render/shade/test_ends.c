/* Tests of coatings and of materials of parts of a surface (material_1, material_2, material_rim) in images and rays:
 * the same material everywhere is the solid's own; each part has the reflectance of its layers from both sides; paint
 * and mirrors on clear solids; shadows; what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "optics/coating.h"
#include "optics/media.h"
#include "probe_fixture.h"
#include "scene/model/edit/edit.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* --- one material everywhere --- */

#define PARTS "material_1: coat, material_2: coat, material_rim: coat"

static const char *const shapes[] = {
    "shape: box, size: [1.2, 0.7, 1], rotation: [20, 30, 10]",
    "shape: cylinder, radius: 0.6, height: 1, rotation: [15, 0, 25]",
    "shape: cone, radius: 0.7, top_radius: 0.3, height: 1, rotation: [-70, 20, 0]",
    "shape: prism, sides: 3, radius: 0.7, height: 1, rotation: [70, 15, 0]",
    "shape: lens, radius_1: 1.3, radius_2: -1.5, thickness: 0.5, diameter: 1.2, rotation: [80, 10, 0]"};

static scene *coated_everywhere(const char *shape, const char *coat, bool by_parts, const char *assignments)
{
    char text[2048];
    snprintf(
        text, sizeof text,
        "background: {color: [0.3, 0.5, 0.9]}\ncamera: {position: [0, 0.6, -4], target: [0, 0.2, 0]}\n"
        "render: {width: 20, height: 15, depth: 5}\nlights:\n  lamp: {position: [2, 4, -3], radius: 0.2, reach: 9}\n"
        "materials:\n  glass: {medium: bk7, transparency: 1}\n  coat: {transparency: 1, %s}\nsolids:\n"
        "  ground: {shape: plane, position: [0, -0.5, 0], diffuse: 0.8}\n"
        "  it: {material: glass, %s, %s}\n",
        coat, shape, by_parts ? PARTS : coat);
    scene *s = scene_from(text);
    diagnostic why = {0};
    set_all(s, assignments);
    worked(scene_load(s, &why), &why);
    return s;
}

static void the_same_material_everywhere_is_the_solids_own(void **state)
{
    (void)state;
    static const char *const coats[] = {"coating: ar-broad", "coating: \"silver 20, mgf2 80\", specular: 0.4",
                                        "film_thickness_nm: 300, reflectivity: 0.2"},
                             *const settings[] = {"", "render.integrator=path render.paths=4",
                                                  "render.spectrum=spectral render.polarisation=on",
                                                  "render.caustics=photons render.photons=3000"};
    for (size_t i = 0; i < COUNT(shapes); i++)
        for (size_t k = 0; k < COUNT(settings); k++) {
            scene *own = coated_everywhere(shapes[i], coats[(i + k) % COUNT(coats)], false, settings[k]),
                  *parts = coated_everywhere(shapes[i], coats[(i + k) % COUNT(coats)], true, settings[k]);
            render_result *a = render(own), *b = render(parts);
            if (film_hash(a->img) != film_hash(b->img))
                fail_msg("%s with '%s': the film differs", shapes[i], settings[k]);
            render_result_destroy(a), render_result_destroy(b);
            scene_destroy(own), scene_destroy(parts);
        }
}

/* --- single rays --- */

static double index_of(const char *name, double lambda_nm)
{
    return medium_index(media_find(name), lambda_nm);
}

typedef struct powers {
    double R_s, R_p, T;
} powers;

static powers powers_of(const char *coat, bool inward, double angle, double n_from, complex_pair to, double lambda_nm)
{
    coating_layers layers;
    film_stack s;
    thin_film films[FILMS_MAX];
    int count = 0;
    if (coat) {
        assert_int_equal(coating_parse(coat, &layers, NULL), STATUS_OK);
        film_stack_make((thin_film){complex_of(1.0, 0.0), 0.0}, &layers, NULL, false, &s);
        count = film_stack_films(&s, lambda_nm, inward, films);
    }
    const sp_amplitudes a = multilayer_amplitudes(cos(angle), n_from, films, count, to, lambda_nm);
    return (powers){complex_norm2(a.r_s), complex_norm2(a.r_p), 0.5 * (complex_norm2(a.t_s) + complex_norm2(a.t_p))};
}

static void assert_hit(const ray_node *node, powers expected)
{
    assert_near(node->hit.R_s, expected.R_s, 1e-12);
    assert_near(node->hit.R_p, expected.R_p, 1e-12);
    assert_near(node->hit.T, expected.T, 1e-12);
}

#define SLAB                                                                                                       \
    "background: {color: [1, 1, 1]}\nrender: {depth: 3, width: 1, height: 1, lambda_nm: 520}\nmaterials:\n"        \
    "  ar: {transparency: 1, coating: ar-visible}\n  thin: {transparency: 1, coating: \"aluminium 9, tio2 50\"}\n" \
    "  mirror: {medium: silver}\n  paint: {diffuse: 0.5}\n"                                                        \
    "solids:\n  slab: {shape: box, size: [4, 1, 4], medium: bk7, transparency: 1, "

static void each_part_has_its_own_layers_from_both_sides(void **state)
{
    (void)state;
    stage g = stage_of(SLAB "material_1: thin, material_2: ar}\n", "");
    const double n = index_of("bk7", 520.0);
    for (double angle = 0.0; angle < 1.4; angle += 0.2) {
        const double inner = asin(sin(angle) / n);
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 3.0, 0.0), vec3_make(sin(angle), -cos(angle), 0.0));
        if (3.0 * tan(angle) + tan(inner) > 1.9)
            break;
        assert_hit(&tree->node[0], powers_of("ar-visible", true, angle, 1.0, complex_of(n, 0.0), 520.0));
        const ray_node *inside = child_of(tree, &tree->node[0], RAY_REFRACT);
        assert_hit(inside, powers_of("aluminium 9, tio2 50", false, inner, n, complex_of(1.0, 0.0), 520.0));
        tree = stage_ray(&g, vec3_make(0.0, -3.0, 0.0), vec3_make(sin(angle), cos(angle), 0.0));
        assert_hit(&tree->node[0], powers_of("aluminium 9, tio2 50", true, angle, 1.0, complex_of(n, 0.0), 520.0));
        assert_hit(child_of(tree, &tree->node[0], RAY_REFRACT),
                   powers_of("ar-visible", false, inner, n, complex_of(1.0, 0.0), 520.0));
    }
    /* the sides are bare */
    const ray_tree *tree = stage_ray(&g, vec3_make(-5.0, 0.0, 0.0), vec3_make(1.0, 0.0, 0.0));
    assert_hit(&tree->node[0], powers_of(NULL, true, 0.0, 1.0, complex_of(n, 0.0), 520.0));
    stage_close(&g);
}

/* Beyond the critical angle: layers that absorb take light of the evanescent wave (Otto's and Kretschmann's prisms);
 * silver of 50 nm has the dip of its surface plasmon for p only. */
static void a_plasmon_absorbs_under_total_reflection(void **state)
{
    (void)state;
    stage g = stage_of(
        "background: {color: [1, 1, 1]}\nrender: {depth: 2, width: 1, height: 1, lambda_nm: 632.8}\nmaterials:\n"
        "  plasmon: {transparency: 1, coating: \"silver 50\"}\nsolids:\n"
        "  slab: {shape: box, size: [40, 1, 40], medium: bk7, transparency: 1, material_1: plasmon}\n",
        "");
    const double n = index_of("bk7", 632.8);
    double least = 1.0;
    for (double angle = 0.73; angle < 0.9; angle += 0.002) {
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 0.0, 0.0), vec3_make(sin(angle), -cos(angle), 0.0));
        const powers expected = powers_of("silver 50", false, angle, n, complex_of(1.0, 0.0), 632.8);
        assert_near(tree->node[0].hit.R_s, expected.R_s, 1e-12);
        assert_near(tree->node[0].hit.R_p, expected.R_p, 1e-12);
        assert_true(tree->node[0].hit.tir && expected.R_s > 0.95);
        least = fmin(least, expected.R_p);
    }
    assert_true(least < 0.4);
    stage_close(&g);
}

static void mirrors_and_paint_on_clear_solids_are_met_from_both_sides(void **state)
{
    (void)state;
    stage g = stage_of(SLAB "material_1: mirror, material_rim: paint}\n", "");
    const double n = index_of("bk7", 520.0);
    const complex_pair silver = metal_index(metals_find("silver"), 520.0);
    const ray_tree *tree = stage_ray(&g, vec3_make(0.3, 3.0, 0.2), vec3_make(0.0, -1.0, 0.0));
    const ray_node *inside = child_of(tree, &tree->node[0], RAY_REFRACT);
    assert_true(inside->hit.opaque);
    assert_near(inside->hit.R, powers_of(NULL, true, 0.0, n, silver, 520.0).R_s, 1e-12);
    const ray_node *back = child_of(tree, inside, RAY_REFLECT);
    assert_true(back && !child_of(tree, inside, RAY_REFRACT) && back->hit.to == -1);
    tree = stage_ray(&g, vec3_make(0.3, -3.0, 0.2), vec3_make(0.0, 1.0, 0.0));
    assert_true(tree->node[0].hit.opaque);
    assert_near(tree->node[0].hit.R, powers_of(NULL, true, 0.0, 1.0, silver, 520.0).R_s, 1e-12);
    tree = stage_ray(&g, vec3_make(0.0, 0.0, 0.0), vec3_make(0.0, 0.0, 1.0));
    assert_true(tree->node[0].hit.opaque && tree->node[0].hit.R == 0.0 && tree->node[0].first_child == RAY_NONE);
    stage_close(&g);
}

/* Prisms of n-sf11 that touch: the coating of the one with the higher priority splits by polarisation at 45 degrees. */
static void a_cube_of_two_prisms_splits_polarisations(void **state)
{
    (void)state;
    stage g =
        stage_of("background: {color: [1, 1, 1]}\nrender: {depth: 4, width: 1, height: 1, lambda_nm: 550}\n"
                 "materials:\n  split: {transparency: 1, coating: polariser-cube}\nsolids:\n"
                 "  upper: {shape: box, size: [4, 1, 4], position: [0, 0.5, 0], medium: n-sf11, transparency: 1}\n"
                 "  lower: {shape: box, size: [4, 1, 4], position: [0, -0.5, 0], medium: n-sf11, transparency: 1, "
                 "priority: 1, material_2: split}\n",
                 "");
    const double n = index_of("n-sf11", 550.0), half = sqrt(0.5);
    const ray_tree *tree = stage_ray(&g, vec3_make(-0.5, 0.5, 0.0), vec3_make(half, -half, 0.0));
    const powers expected = powers_of("polariser-cube", true, acos(-1.0) / 4.0, n, complex_of(n, 0.0), 550.0);
    assert_hit(&tree->node[0], expected);
    assert_true(expected.R_s > 0.999 && expected.R_p < 0.01);
    tree = stage_ray(&g, vec3_make(-0.5, -0.5, 0.0), vec3_make(half, half, 0.0));
    assert_hit(&tree->node[0], expected);
    stage_close(&g);
}

/* A gap between two blocks lets light tunnel; a coating of air of this thickness is the same. */
static void a_layer_of_air_is_a_gap(void **state)
{
    (void)state;
    const char *text =
        "background: {color: [1, 1, 1]}\nrender: {depth: 2, width: 1, height: 1}\nmaterials:\n"
        "  gap: {transparency: 1, coating: \"1 150\"}\n  film: {transparency: 1, film_thickness_nm: 150, "
        "film_ior: 1}\nsolids:\n  upper: {shape: box, size: [9, 1, 9], position: [0, 0.5, 0], ior: 1.5, "
        "transparency: 1, priority: 1, material_1: gap}\n"
        "  lower: {shape: box, size: [9, 1, 9], position: [0, -0.5, 0], ior: 1.5, transparency: 1}\n";
    stage a = stage_of(text, ""), b = stage_of(text, "upper.material_1=film");
    for (double angle = 0.0; angle < 1.3; angle += 0.1) {
        const vec3 from = vec3_make(0.0, 0.5, 0.0), to = vec3_make(sin(angle), -cos(angle), 0.0);
        const ray_node *one = &stage_ray(&a, from, to)->node[0], *other = &stage_ray(&b, from, to)->node[0];
        assert_true(one->hit.R_s == other->hit.R_s && one->hit.R_p == other->hit.R_p);
        assert_hit(one, powers_of("1 150", true, angle, 1.5, complex_of(1.5, 0.0), a.setting->render.lambda_nm));
    }
    stage_close(&a), stage_close(&b);
}

/* --- shadows --- */

static double light_below(const char *parts)
{
    char text[1024];
    snprintf(text, sizeof text,
             "background: {color: [0, 0, 0]}\ncamera: {position: [0, -0.8, 0.3], target: [0, -1, 0.3]}\n"
             "render: {width: 1, height: 1, depth: 0}\nlights:\n  lamp: {position: [0, 9, 0.3]}\nmaterials:\n"
             "  paint: {diffuse: 0.3}\n  half: {transparency: 1, reflectivity: 0.5}\n  tin: {transparency: 1, coating: "
             "\"aluminium 10\"}\nsolids:\n"
             "  ground: {shape: plane, position: [0, -1, 0], diffuse: 1}\n"
             "  slab: {shape: box, size: [2, 0.2, 2], ior: 1.5, transparency: 1%s}\n",
             parts);
    scene *s = scene_from(text);
    const double seen = look(s).x;
    scene_destroy(s);
    return seen;
}

static void shadow_rays_meet_the_parts(void **state)
{
    (void)state;
    const double whole = light_below("");
    assert_true(whole > 0.0);
    assert_near(light_below(", material_1: half"), 0.5 * whole, 1e-6);
    assert_near(light_below(", material_1: half, material_2: half"), 0.25 * whole, 1e-6);
    assert_true(light_below(", material_2: paint") == 0.0 && light_below(", material_1: paint") == 0.0);
    assert_true(light_below(", material_rim: paint") == whole);
    double passing = 0.0; /* the definition of cuvette-optics(7) */
    static const double channels[] = {611.4, 549.1, 464.3};
    for (int i = 0; i < 3; i++)
        passing += powers_of("aluminium 10", true, 0.0, 1.0, complex_of(1.5, 0.0), channels[i]).T / 3.0;
    assert_near(light_below(", material_1: tin"), passing * whole, 1e-6 * whole);
}

/* --- refused --- */

static void what_is_not_supported_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *assignments, *what;
    } cases[] = {{"slab.material_1=nobody", "there is no material 'nobody'"},
                 {"render.integrator=zbuffer slab.material_1=paint", "the depth buffer does not support materials"},
                 {"slab.transparency=0 slab.material_1=ar", "slab is opaque, but ar"},
                 {"render.polarisation=on slab.material_1=ar", "polarisation by a coating depends on the wavelength"},
                 {"render.radiance=basic slab.material_1=ar", "basic radiance does not support a coating"},
                 {"paint.alpha=mask slab.material_1=paint", "has alpha"},
                 {"ar.coating_data=none slab.coating_data=none", "there is no data 'none'"}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        scene *s = scene_from(SLAB "}\n");
        diagnostic why = {.what = ""};
        set_all(s, cases[i].assignments);
        assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, cases[i].what))
            fail_msg("%s: %s", cases[i].assignments, why.what);
        scene_destroy(s);
    }
    scene *s = scene_from("solids:\n  ball: {shape: sphere}\n");
    assert_int_equal(scene_set_assignment(s, "ball.material_1=ball", NULL), STATUS_BAD_INPUT);
    scene_destroy(s);
}

static void a_renamed_material_stays_that_of_the_end(void **state)
{
    (void)state;
    scene *s = scene_from(SLAB "material_2: ar}\n");
    diagnostic why = {.what = ""};
    char *now = NULL;
    worked(scene_rename(s, "ar", "clean", &why), &why);
    worked(scene_get(s, "slab.material_2", &now, &why), &why);
    assert_string_equal(now, "clean");
    free(now);
    assert_int_equal(scene_remove(s, "clean", NULL), STATUS_BAD_INPUT);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_material_everywhere_is_the_solids_own),
        cmocka_unit_test(each_part_has_its_own_layers_from_both_sides),
        cmocka_unit_test(a_plasmon_absorbs_under_total_reflection),
        cmocka_unit_test(mirrors_and_paint_on_clear_solids_are_met_from_both_sides),
        cmocka_unit_test(a_cube_of_two_prisms_splits_polarisations),
        cmocka_unit_test(a_layer_of_air_is_a_gap),
        cmocka_unit_test(shadow_rays_meet_the_parts),
        cmocka_unit_test(what_is_not_supported_is_refused),
        cmocka_unit_test(a_renamed_material_stays_that_of_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
