/* Tests of half mirrors: under Fresnel weights a clear surface with a reflectivity reflects that share of the light
 * that would be transmitted. R' = R + (1 - R) reflectivity, T' = (1 - R) (1 - reflectivity), from both sides. Closed
 * forms: Hecht, Optics, 5th ed., 4.6.2, and for sheets the series of reflections between two faces (9.6.1, of
 * intensities). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/mueller.h"
#include "probe_fixture.h"

static const vec3 level = {0.0, 0.0, 0.0};

static stage mirrored(const char *shape, double ior, double reflectivity, int depth, const char *assignments)
{
    char more[160];
    scene_text text = scene_begin(1.0, depth);
    snprintf(more, sizeof more, "reflectivity: %.17g, %s", reflectivity, shape);
    add_clear(&text, "glass", ior, 0, vec3_make(0.0, 0.0, 0.0), level, more);
    return stage_of(text.at, assignments);
}

static double share_of(const ray_tree *tree, ray_kind kind)
{
    const ray_node *child = child_of(tree, &tree->node[0], kind);
    return child ? child->throughput[0] : 0.0;
}

static void a_half_mirror_reflects_a_share_of_the_transmitted_light(void **state)
{
    (void)state;
    static const double reflectivities[] = {0.0, 0.1, 0.5, 0.99, 1.0};
    for (size_t k = 0; k < COUNT(reflectivities); k++) {
        stage g = mirrored("shape: plane", 1.5, reflectivities[k], 1, "");
        for (double angle = 0.0; angle < 1.5; angle += 0.1) {
            const reflectance bare = reflectance_of_angles(angle, 1.0, 1.5);
            const double R = bare.mean, expected = R + (1.0 - R) * reflectivities[k];
            const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(sin(angle), -cos(angle), 0.0));
            assert_true(fabs(share_of(tree, RAY_REFLECT) - expected) <= 1e-13);
            assert_true(fabs(share_of(tree, RAY_REFRACT) - (1.0 - expected)) <= 1e-13);
            const ray_hit *hit = &tree->node[0].hit;
            assert_true(fabs(hit->R - expected) <= 1e-13);
            assert_true(fabs(hit->R_s - (bare.s + (1.0 - bare.s) * reflectivities[k])) <= 1e-13);
            assert_true(fabs(hit->R_p - (bare.p + (1.0 - bare.p) * reflectivities[k])) <= 1e-13);
            tree = stage_ray(&g, vec3_make(0.0, -1.0, 0.0), vec3_make(sin(angle), cos(angle), 0.0)); /* from inside */
            const bool total = 1.5 * sin(angle) >= 1.0;
            const double inner = total ? 1.0 : reflectance_of_angles(angle, 1.5, 1.0).mean;
            assert_true(fabs(share_of(tree, RAY_REFLECT) - (inner + (1.0 - inner) * reflectivities[k])) <= 1e-12);
            assert_true(fabs(share_of(tree, RAY_REFRACT) - (1.0 - inner) * (1.0 - reflectivities[k])) <= 1e-12);
        }
        stage_close(&g);
    }
}

/* A sheet with the index of its surroundings, a half mirror on both faces, reflects r + (1 - r)^2 r (1 + r^2 + ..) = 2
 * r / (1 + r) and transmits (1 - r) / (1 + r). Without its reflectivity it is no interface. */
static void a_sheet_of_air_with_coated_faces_is_a_half_mirror(void **state)
{
    (void)state;
    for (double r = 0.0; r <= 0.9; r += 0.3) {
        stage g = mirrored("shape: box, size: [50, 0.1, 50]", 1.0, r, 60, "render.beyond=black");
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(0.6, -0.8, 0.0));
        double through = 0.0, back = 0.0;
        for (size_t i = 0; i < tree->count; i++)
            if (tree->node[i].end == RAY_END_SKY)
                *(tree->node[i].direction.y < 0.0 ? &through : &back) += tree->node[i].throughput[0];
        assert_true(fabs(through - (1.0 - r) / (1.0 + r)) <= 0.01 * pow(r, 40.0) + 1e-12);
        assert_true(fabs(back - 2.0 * r / (1.0 + r)) <= 0.01 * pow(r, 40.0) + 1e-12);
        if (r == 0.0)
            assert_int_equal((int)tree->count, 1);
        stage_close(&g);
    }
}

/* R' + T' = 1, so that no light is lost, whatever a ray's tree: a sphere under a sky of 1 is 1 except for what the
 * depth limit cuts off. */
static void coated_media_conserve_energy(void **state)
{
    (void)state;
    stage g = mirrored("shape: sphere, radius: 1", 1.7, 0.35, 9, "render.beyond=black");
    for (double h = -0.97; h < 1.0; h += 0.0713) {
        const ray_tree *tree = stage_ray(&g, vec3_make(h, 0.2, -4.0), vec3_make(0.0, 0.0, 1.0));
        assert_true(fabs(tree->radiance[0] + tree_cut(tree, 0) - 1.0) <= 1e-11);
    }
    stage_close(&g);
}

/* Reflectances of s and p light: sin^2(a - b) / sin^2(a + b) and tan^2(a - b) / tan^2(a + b), of Fresnel's formulas in
 * Hecht, Optics, 4.6. */
static void reflectances(double cosine, double n, double *s, double *p, double *refracted)
{
    const double a = acos(cosine), b = asin(sin(a) / n);
    *s = pow(sin(a - b) / sin(a + b), 2.0);
    *p = pow(tan(a - b) / tan(a + b), 2.0);
    *refracted = b;
}

/* Seen through a polarising surface, with all light equal to 1, a half mirror deviates by c q (R_s - R_p) / 2: it
 * reflects unpolarised light, but is transmitted in polarised directions. Both surfaces have one plane of incidence;
 * the second is vertical. */
static void a_polarised_view_of_a_half_mirror_deviates_by_its_polarisation(void **state)
{
    (void)state;
    for (double angle = 20.0; angle < 80.0; angle += 7.0) {
        const double a = angle * acos(-1.0) / 180.0, n = 1.7, reflectivity = 0.35;
        const vec3 down = vec3_make(sin(a), -cos(a), 0.0), d = vec3_make(sin(a), cos(a), 0.0);
        double s, p, b;
        reflectances(cos(a), 1.5, &s, &p, &b);
        const double q = (s - p) / (s + p);
        stokes row =
            analyser_reflect((stokes){1.0, 0.0, 0.0, 0.0}, down, vec3_make(0.0, 1.0, 0.0), cos(a), 1.0, 1.5, d);
        row = (stokes){1.0, row.q / row.i, row.u / row.i, row.v / row.i};
        reflectances(sin(a), n, &s, &p, &b);
        const vec3 wall = vec3_make(-1.0, 0.0, 0.0), back = vec3_make(-d.x, d.y, 0.0);
        const vec3 through = vec3_make(cos(b), sin(b), 0.0);
        const double seen = analyser_reflect(row, d, wall, sin(a), 1.0, n, back).i +
                            reflectivity * analyser_half_mirror(row, d, wall, sin(a), 1.0, n, back).i +
                            (1.0 - reflectivity) * analyser_refract(row, d, wall, sin(a), 1.0, n, through).i;
        assert_true(fabs(seen - (1.0 + reflectivity * q * (s - p) / 2.0)) <= 1e-12);
        assert_true(fabs(seen - 1.0) > 1e-4);
    }
}

/* A half mirror on a thin film takes its share of what the film transmits, with and without polarisation: at
 * perpendicular incidence, where both polarisations are alike, T' / T = 1 - c and R' = R + c T. */
static void a_half_mirror_takes_its_share_of_what_a_film_transmits(void **state)
{
    (void)state;
    static const char *const views[] = {"render.spectrum=spectral render.polarisation=off",
                                        "render.spectrum=spectral render.polarisation=on"};
    for (int k = 0; k < 2; k++) {
        double R = 0.0, T = 0.0;
        for (double c = 0.0; c < 1.0; c += 0.4) {
            stage g = mirrored("shape: plane, film_thickness_nm: 110, film_ior: 1.9", 1.5, c, 1, views[k]);
            const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(0.0, -1.0, 0.0));
            const double reflected = share_of(tree, RAY_REFLECT), transmitted = share_of(tree, RAY_REFRACT);
            assert_true(fabs(reflected + transmitted - 1.0) <= 1e-12 && transmitted > 0.1);
            if (c == 0.0)
                R = reflected, T = transmitted;
            assert_true(fabs(transmitted - (1.0 - c) * T) <= 1e-12 && fabs(reflected - (R + c * T)) <= 1e-12);
            stage_close(&g);
        }
    }
}

/* Where two solids are in contact, the surface is that of the higher priority, and so is its reflectivity. */
static void reflectivity_belongs_to_the_surface_owner(void **state)
{
    (void)state;
    for (int above_wins = 0; above_wins < 2; above_wins++) {
        scene_text text = scene_begin(1.0, 1);
        add_clear(&text, "above", 1.5, above_wins ? 2 : 0, vec3_make(0.0, 0.5, 0.0), level,
                  "shape: box, size: [9, 1, 9], reflectivity: 0.25");
        add_clear(&text, "below", 1.5, 1, vec3_make(0.0, -0.5, 0.0), level,
                  "shape: box, size: [9, 1, 9], reflectivity: 0.5");
        stage g = stage_of(text.at, "");
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 0.5, 0.0), vec3_make(0.0, -1.0, 0.0));
        assert_true(fabs(share_of(tree, RAY_REFLECT) - (above_wins ? 0.25 : 0.5)) <= 1e-13);
        stage_close(&g);
    }
}

static void constant_weights_have_no_half_mirror(void **state)
{
    (void)state;
    static const char *const rules[] = {"glass.transparency=0.5 render.weights=constant",
                                        "glass.transparency=0.5 render.transmission=simple"};
    for (size_t k = 0; k < COUNT(rules); k++) {
        stage g = mirrored("shape: plane", 1.5, 0.25, 1, rules[k]);
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(0.6, -0.8, 0.0));
        assert_true(share_of(tree, RAY_REFLECT) == 0.25 && share_of(tree, RAY_REFRACT) == 0.5);
        stage_close(&g);
    }
}

/* A shadow ray keeps (1 - reflectivity) at each face, in addition to the transparency. */
static void a_coated_pane_attenuates_shadow_rays(void **state)
{
    (void)state;
    static const char lit_ground[] = "background: {color: [0, 0, 0]}\n"
                                     "render: {width: 1, height: 1}\n"
                                     "lights: {lamp: {position: [0, 4, 0]}}\n"
                                     "solids:\n"
                                     "  ground: {shape: plane, diffuse: 1}\n"
                                     "  pane: {shape: box, transparency: 0.9, reflectivity: 0.25, ior: 1.5, position: "
                                     "[0, 2, 0], size: [50, 0.5, 50]}\n";
    stage g = stage_of(lit_ground, "");
    const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(0.0, -1.0, 0.0));
    assert_true(fabs(tree->radiance[0] - pow(0.9 * 0.75, 2.0)) <= 1e-12);
    stage_close(&g);
    g = stage_of(lit_ground, "pane.ior=1 pane.transparency=1"); /* a half mirror of air casts a shadow too */
    tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(0.0, -1.0, 0.0));
    assert_true(fabs(tree->radiance[0] - 0.75 * 0.75) <= 1e-12);
    stage_close(&g);
}

/* A corner of two media that are black inside, so that only the two faces reflect light: at an angle a from the floor,
 * at 90 - a from the wall. A half mirror makes light unpolarised: half of its reflected light is s, half p. Light goes
 * from the sky to one face, then to the other, then to the camera. */
static double floor_then_wall(reflectance first, double first_added, reflectance second, double second_added)
{
    const double made = 0.5 * (1.0 - first.mean) * first_added, s = 0.5 * first.s + made, p = 0.5 * first.p + made;
    return second.s * s + second.p * p + second_added * ((1.0 - second.s) * s + (1.0 - second.p) * p);
}

static void a_half_mirror_reflects_unpolarised_light(void **state)
{
    (void)state;
    for (int which = 0; which < 4; which++) {
        const double on_floor = which & 1 ? 0.3 : 0.0, on_wall = which & 2 ? 0.6 : 0.0;
        scene_text text = scene_begin(1.0, 2);
        char more[96];
        snprintf(more, sizeof more, "shape: plane, absorb_per_m: [1e9, 1e9, 1e9], reflectivity: %g", on_floor);
        add_clear(&text, "floor", 1.5, 0, vec3_make(0.0, 0.0, 0.0), level, more);
        snprintf(more, sizeof more, "shape: plane, absorb_per_m: [1e9, 1e9, 1e9], reflectivity: %g", on_wall);
        add_clear(&text, "wall", 1.9, 0, vec3_make(5.0, 0.0, 0.0), vec3_make(0.0, 0.0, 90.0), more);
        stage g = stage_of(text.at, "render.polarisation=on");
        for (double angle = 0.2; angle < 1.4; angle += 0.15) {
            const vec3 to = vec3_make(sin(angle), -cos(angle), 0.0), from = vec3_scale(to, -1.0);
            const ray_tree *tree = stage_ray(&g, vec3_add(vec3_make(0.0, 0.0, 0.0), from), to);
            const reflectance floor = reflectance_of_angles(angle, 1.0, 1.5),
                              wall = reflectance_of_angles(0.5 * M_PI - angle, 1.0, 1.9);
            /* The view ray hits the floor first, and then the wall. */
            assert_true(fabs(tree->radiance[0] - floor_then_wall(wall, on_wall, floor, on_floor)) <= 1e-12);
        }
        stage_close(&g);
    }
}

/* Random paths choose the branches of half mirrors at random: the mean over many is the tree's. */
static void random_paths_have_the_mean_of_the_ray_tree(void **state)
{
    (void)state;
    stage g = mirrored("shape: box, size: [50, 0.1, 50]", 1.0, 0.5, 40, "render.integrator=path render.paths=65536");
    /* below the horizon the sky is black, so that only reflected light is visible */
    set_all(g.setting, "camera.position=0,3,0 camera.target=0,0,0 camera.fov_deg=0.001 background.kind=gradient "
                       "background.color=1,1,1 "
                       "background.horizon=0,0,0");
    const double back = 2.0 * 0.5 / 1.5, sigma = sqrt(back * (1.0 - back) / 65536.0);
    assert_true(fabs(look(g.setting).x - back) <= 5.0 * sigma);
    stage_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_half_mirror_reflects_a_share_of_the_transmitted_light),
        cmocka_unit_test(a_sheet_of_air_with_coated_faces_is_a_half_mirror),
        cmocka_unit_test(coated_media_conserve_energy),
        cmocka_unit_test(a_polarised_view_of_a_half_mirror_deviates_by_its_polarisation),
        cmocka_unit_test(a_half_mirror_takes_its_share_of_what_a_film_transmits),
        cmocka_unit_test(reflectivity_belongs_to_the_surface_owner),
        cmocka_unit_test(constant_weights_have_no_half_mirror),
        cmocka_unit_test(a_coated_pane_attenuates_shadow_rays),
        cmocka_unit_test(a_half_mirror_reflects_unpolarised_light),
        cmocka_unit_test(random_paths_have_the_mean_of_the_ray_tree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
