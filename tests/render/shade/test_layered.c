/* Tests of metals and films in images: colours against closed forms that are integrated here, at a wavelength, with
 * polarisation, on random paths; what is refused; determinism. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "mueller_matrix.h"
#include "optics/media.h"
#include "optics/spectrum.h"
#include "probe_fixture.h"
#include "render/plan/layered_table.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const vec3 level = {0.0, 0.0, 0.0};

static double squared(double a)
{
    return a * a;
}

/* --- closed forms --- */

typedef struct pair {
    double s, p;
} pair;

/* Airy's formula for a film of index n in air; Hecht, 9.6.1. */
static pair airy(double angle, double n, double thickness_nm, double lambda_nm)
{
    const double inner = asin(sin(angle) / n), delta = 2.0 * M_PI * n * thickness_nm * cos(inner) / lambda_nm,
                 normal = (n - 1.0) / (n + 1.0), plus = angle + inner,
                 r_s = plus < 1e-7 ? normal : sin(angle - inner) / sin(plus),
                 r_p = plus < 1e-7 ? normal : tan(angle - inner) / tan(plus);
    const double of_s = 4.0 * r_s * r_s / squared(1.0 - r_s * r_s) * squared(sin(delta)),
                 of_p = 4.0 * r_p * r_p / squared(1.0 - r_p * r_p) * squared(sin(delta));
    return (pair){of_s / (1.0 + of_s), of_p / (1.0 + of_p)};
}

/* A metal in air; Siegel and Howell, Thermal Radiation Heat Transfer, 4th ed., (4-70); a from a b = n k where its own
 * formula loses digits. */
static pair metal_by_siegel(double angle, double n, double k)
{
    const double s2 = squared(sin(angle)), x = n * n - k * k - s2, root = sqrt(x * x + squared(2.0 * n * k)),
                 b2 = 0.5 * (root - x), a = x < 0.0 ? n * k / sqrt(b2) : sqrt(0.5 * (root + x)), c = cos(angle),
                 st = sin(angle) * tan(angle), R_s = (squared(a - c) + b2) / (squared(a + c) + b2);
    return (pair){R_s, R_s * (squared(a - st) + b2) / (squared(a + st) + b2)};
}

typedef pair spectrum(double angle, const void *of, double lambda_nm);

static pair film_spectrum(double angle, const void *of, double lambda_nm)
{
    const double *soapy = of;
    return airy(angle, soapy[0], soapy[1], lambda_nm);
}

static pair metal_spectrum(double angle, const void *of, double lambda_nm)
{
    const complex_pair n = metal_index(of, lambda_nm);
    return metal_by_siegel(angle, n.re, n.im);
}

/* Linear sRGB of the reflected daylight, by the trapezoidal rule at 0.05 nm, clamped to 0 .. 1. */
static vec3 color_of(spectrum *R, double angle, const void *of)
{
    double xyz[3] = {0.0, 0.0, 0.0}, white[3] = {0.0, 0.0, 0.0}, rgb[3], one[3];
    for (int i = 0; i <= 8000; i++) {
        const double lambda_nm = 380.0 + 0.05 * i, end = i == 0 || i == 8000 ? 0.5 : 1.0;
        const pair both = R(angle, of, lambda_nm);
        double cmf[3];
        observer_xyz(lambda_nm, cmf);
        for (int c = 0; c < 3; c++) {
            const double daylight = end * observer_d65(lambda_nm) * cmf[c];
            xyz[c] += 0.5 * (both.s + both.p) * daylight, white[c] += daylight;
        }
    }
    xyz_to_linear_srgb(xyz, rgb);
    xyz_to_linear_srgb(white, one);
    return vec3_make(fmin(fmax(rgb[0] / one[0], 0.0), 1.0), fmin(fmax(rgb[1] / one[1], 0.0), 1.0),
                     fmin(fmax(rgb[2] / one[2], 0.0), 1.0));
}

static double color_apart(const double *a, vec3 b)
{
    return fmax(fabs(a[0] - b.x), fmax(fabs(a[1] - b.y), fabs(a[2] - b.z)));
}

/* --- stages --- */

static vec3 towards(double angle)
{
    return vec3_make(sin(angle), -cos(angle), 0.0);
}

/* A lake of air, so that only its film reflects. */
static stage soap(double n, double thickness_nm, const char *assignments)
{
    char more[160];
    scene_text text = scene_begin(1.0, 1);
    snprintf(more, sizeof more, "film_thickness_nm: %.17g, film_ior: %.17g, shape: plane", thickness_nm, n);
    add_clear(&text, "lake", 1.0, 0, vec3_make(0.0, 0.0, 0.0), level, more);
    return stage_of(text.at, assignments);
}

static stage metal_floor(const char *name, const char *assignments)
{
    scene_text text = scene_begin(1.0, 1);
    add(&text, "  floor: {medium: %s, shape: plane}\n", name);
    return stage_of(text.at, assignments);
}

static const ray_node *branch_of(stage *g, double angle, ray_kind kind)
{
    const ray_tree *tree = stage_ray(g, vec3_make(0.0, 1.0, 0.0), towards(angle));
    return child_of(tree, &tree->node[0], kind);
}

static const double angles[] = {0.0, 0.3, 0.7, 1.0, 1.25, 1.45};

/* --- colours in an rgb film --- */

static void a_soap_film_has_the_colours_of_airys_formula(void **state)
{
    (void)state;
    static const double thickness_nm[] = {10.0, 120.0, 250.0, 420.0, 900.0, 2000.0};
    for (size_t i = 0; i < COUNT(thickness_nm); i++) {
        const double soapy[2] = {1.33, thickness_nm[i]};
        stage g = soap(soapy[0], soapy[1], "");
        for (size_t k = 0; k < COUNT(angles); k++) {
            const vec3 R = color_of(film_spectrum, angles[k], soapy);
            const vec3 T = vec3_sub(vec3_make(1.0, 1.0, 1.0), R);
            assert_near(color_apart(branch_of(&g, angles[k], RAY_REFLECT)->throughput, R), 0.0, 2e-5);
            assert_near(color_apart(branch_of(&g, angles[k], RAY_REFRACT)->throughput, T), 0.0, 2e-5);
        }
        stage_close(&g);
    }
}

/* Each strip of experiments/scenes/soap.yaml, straight on from the camera, reflects a white sky. */
static void the_strips_of_a_soap_film_have_newtons_colours(void **state)
{
    (void)state;
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_read("experiments/scenes/soap.yaml", &s, &why), &why);
    probe *p = NULL;
    ray_tree tree = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    int strips = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (strncmp(one->name, "film", 4) != 0)
            continue;
        const double soapy[2] = {1.33, 10.0 + 50.0 * strips++};
        const vec3 from = vec3_add(one->shape.position, vec3_make(0.0, 0.0, -3.0));
        worked(probe_ray(p, from, vec3_make(0.0, 0.0, 1.0), &tree, &why), &why);
        assert_near(color_apart(tree.radiance, color_of(film_spectrum, 0.0, soapy)), 0.0, 2e-5);
    }
    assert_int_equal(strips, 16);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

static void metals_have_the_colours_of_their_indices(void **state)
{
    (void)state;
    for (size_t i = 0; i < metals_count(); i++) {
        stage g = metal_floor(metals_at(i)->name, "");
        for (size_t k = 0; k < COUNT(angles); k++) {
            const vec3 R = color_of(metal_spectrum, angles[k], metals_at(i));
            assert_near(color_apart(branch_of(&g, angles[k], RAY_REFLECT)->throughput, R), 0.0, 2e-5);
            assert_null(branch_of(&g, angles[k], RAY_REFRACT));
        }
        stage_close(&g);
    }
}

/* A metal by its numbers is grey; its reflectivity is not used. Gold and silver as `cuvette media` prints them, and an
 * index that is almost imaginary, which reflects all light. */
static void a_metal_by_its_numbers(void **state)
{
    (void)state;
    static const double index[][2] = {{0.43, 2.455}, {0.0516, 3.9043}, {1e-6, 0.7}, {1e-300, 2.0}};
    for (size_t i = 0; i < COUNT(index); i++) {
        const double n = index[i][0], k = index[i][1];
        scene_text text = scene_begin(1.0, 1);
        add(&text, "  floor: {ior: %.17g, extinction: %.17g, reflectivity: 0.5, shape: plane}\n", n, k);
        stage g = stage_of(text.at, "");
        for (size_t a = 0; a < COUNT(angles); a++) {
            const pair R = metal_by_siegel(angles[a], n, k);
            const double mean = 0.5 * (R.s + R.p);
            assert_near(color_apart(branch_of(&g, angles[a], RAY_REFLECT)->throughput, vec3_make(mean, mean, mean)),
                        0.0, 1e-6);
            assert_near(stage_ray(&g, vec3_make(0.0, 1.0, 0.0), towards(angles[a]))->node[0].hit.R_p, R.p, 1e-13);
            assert_true(n > 1e-5 || fabs(R.s - 1.0) < 1e-5);
        }
        stage_close(&g);
    }
}

/* An antireflection coating of a quarter wave on glass, from both sides: the colour is that of the two amplitudes'
 * sum, r = (r1 + r2 e^2id) / (1 + r1 r2 e^2id); Born and Wolf, 1.6.4 (at normal incidence). */
static pair coating_spectrum(double angle, const void *of, double lambda_nm)
{
    const double *c = of, r1 = (c[0] - c[1]) / (c[0] + c[1]), r2 = (c[1] - c[2]) / (c[1] + c[2]),
                 cos_2d = cos(4.0 * M_PI * c[1] * c[3] / lambda_nm),
                 R = (r1 * r1 + r2 * r2 + 2.0 * r1 * r2 * cos_2d) / (1.0 + r1 * r1 * r2 * r2 + 2.0 * r1 * r2 * cos_2d);
    (void)angle;
    return (pair){R, R};
}

static void a_coated_lens_from_both_sides(void **state)
{
    (void)state;
    const double coating[4] = {1.0, 1.38, 1.52, 99.6};
    const vec3 R = color_of(coating_spectrum, 0.0, coating);
    scene_text text = scene_begin(1.0, 1);
    add_clear(&text, "glass", 1.52, 0, vec3_make(0.0, 0.0, 0.0), level,
              "film_thickness_nm: 99.6, film_ior: 1.38, shape: plane");
    stage g = stage_of(text.at, "");
    assert_true(R.y < 0.014 && R.z > R.y && R.x > R.y); /* purple, a third of bare glass */
    assert_near(color_apart(branch_of(&g, 0.0, RAY_REFLECT)->throughput, R), 0.0, 1e-6);
    const ray_tree *tree = stage_ray(&g, vec3_make(0.0, -1.0, 0.0), vec3_make(0.0, 1.0, 0.0));
    assert_near(color_apart(child_of(tree, &tree->node[0], RAY_REFLECT)->throughput, R), 0.0, 1e-6);
    /* An oblique ray and its reverse reflect the same share; beyond the critical angle all of it. */
    for (double angle = 0.1; angle < 1.5; angle += 0.2) {
        const double inner = asin(sin(angle) / 1.52);
        double out[3];
        memcpy(out, branch_of(&g, angle, RAY_REFLECT)->throughput, sizeof out);
        tree = stage_ray(&g, vec3_make(0.0, -1.0, 0.0), vec3_make(sin(inner), cos(inner), 0.0));
        const ray_node *back = child_of(tree, &tree->node[0], RAY_REFLECT);
        assert_near(color_apart(out, vec3_make(back->throughput[0], back->throughput[1], back->throughput[2])), 0.0,
                    1e-9);
    }
    tree = stage_ray(&g, vec3_make(0.0, -1.0, 0.0), vec3_make(0.8, 0.6, 0.0));
    assert_true(child_of(tree, &tree->node[0], RAY_REFLECT)->throughput[1] == 1.0);
    assert_null(child_of(tree, &tree->node[0], RAY_REFRACT));
    stage_close(&g);
}

/* Between its entries the table is the integral. */
static void tables_are_as_exact_as_stated(void **state)
{
    (void)state;
    static const double thickness_nm[] = {0.0, 100.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0, 20000.0};
    static const double sides[][3] = {{1.0, 1.0, 1.33}, {1.0, 1.5, 1.38}, {1.0, 1.52, 2.4}};
    for (size_t i = 0; i < COUNT(sides); i++)
        for (size_t j = 0; j < COUNT(thickness_nm); j++) {
            if (thickness_nm[j] == 0.0 && sides[i][0] == sides[i][1])
                continue;
            film_stack layer;
            film_stack_make((thin_film){complex_of(sides[i][2], 0.0), thickness_nm[j]}, NULL, NULL, false, &layer);
            const layered_surface s = {.stack = &layer};
            layered_curves c = {.side = {{0}}};
            layered_curves_make(&s, sides[i][0], sides[i][1], &c);
            double worst = 0.0, grazing = 0.0;
            for (double at = 0.001; at < 1.0; at += 0.00937) {
                const vec3 table = layered_colors_at(&s, &c, true, at, sides[i][0], sides[i][1]).reflected,
                           exact = layered_colors_at(&s, NULL, true, at, sides[i][0], sides[i][1]).reflected;
                double *of = at < 0.02 ? &grazing : &worst;
                *of = fmax(*of, color_apart((const double[3]){table.x, table.y, table.z}, exact));
            }
            layered_curves_release(&c);
            assert_true(worst < (thickness_nm[j] <= 2000.0 ? 2e-5 : thickness_nm[j] <= 1e4 ? 1e-4 : 2e-3));
            assert_true(grazing < 1e-2);
        }
}

static film_stack coating_of(const char *text)
{
    coating_layers layers;
    film_stack s;
    assert_int_equal(coating_parse(text, &layers, NULL), STATUS_OK);
    film_stack_make((thin_film){complex_of(1.0, 0.0), 0.0}, &layers, NULL, false, &s);
    return s;
}

static double colors_apart(layered_colors a, layered_colors b)
{
    return fmax(color_apart((const double[3]){a.reflected.x, a.reflected.y, a.reflected.z}, b.reflected),
                color_apart((const double[3]){a.transmitted.x, a.transmitted.y, a.transmitted.z}, b.transmitted));
}

/* Of both directions, below and beyond the critical angle, on solids of higher and of lower index. */
static void tables_of_coatings_are_as_exact_as_stated(void **state)
{
    (void)state;
    static const char *const coatings[] = {"ar-broad",
                                           "mirror-550",
                                           "short-pass-595",
                                           "splitter-45",
                                           "silver 45",
                                           "aluminium-enhanced",
                                           "1.7+0.02i 400, mgf2 90, gold 12"};
    static const double sides[][2] = {{1.0, 1.52}, {1.33, 1.0}, {1.52, 1.52}};
    double worst = 0.0;
    for (size_t j = 0; j < COUNT(coatings); j++)
        for (size_t i = 0; i < COUNT(sides); i++) {
            const film_stack layers = coating_of(coatings[j]);
            const layered_surface s = {.stack = &layers};
            layered_curves c = {.side = {{0}}};
            layered_curves_make(&s, sides[i][0], sides[i][1], &c);
            for (double at = 0.0213; at < 1.0; at += 0.0437)
                for (int inward = 0; inward < 2; inward++) {
                    const double from = sides[i][!inward], to = sides[i][inward];
                    worst = fmax(worst, colors_apart(layered_colors_at(&s, &c, inward, at, from, to),
                                                     layered_colors_at(&s, NULL, inward, at, from, to)));
                }
            layered_curves_release(&c);
        }
    if (!(worst < 1e-4))
        fail_msg("error %g", worst);
}

/* A gap of air between water and glass has no table: the colours are those of frustrated total reflection, by Airy's
 * formula with the exponential of an imaginary phase beyond the critical angle (s light: Zhu and others, Am. J. Phys.
 * 54, 601, for equal media). */
static pair gap_spectrum(double angle, const void *of, double lambda_nm)
{
    const double *gap = of, N = gap[0], s2 = squared(sin(angle)), inside = N * N * s2 - 1.0,
                 y = 2.0 * M_PI * gap[1] / lambda_nm * sqrt(fabs(inside)),
                 change = inside > 0.0 ? squared(sinh(y)) : -squared(sin(y)),
                 of_s = squared(N * N - 1.0) / (4.0 * N * N * squared(cos(angle)) * inside) * change,
                 of_p = of_s * squared((N * N + 1.0) * s2 - 1.0);
    return (pair){of_s / (1.0 + of_s), of_p / (1.0 + of_p)};
}

static void a_gap_of_air_in_glass(void **state)
{
    (void)state;
    static const double thickness_nm[] = {50.0, 300.0, 2000.0};
    for (size_t i = 0; i < COUNT(thickness_nm); i++) {
        const double gap[2] = {1.5, thickness_nm[i]};
        char more[160];
        scene_text text = scene_begin(1.5, 1);
        snprintf(more, sizeof more, "film_thickness_nm: %.17g, film_ior: 1, shape: plane", thickness_nm[i]);
        add_clear(&text, "lake", 1.5, 0, vec3_make(0.0, 0.0, 0.0), level, more);
        stage g = stage_of(text.at, "");
        for (double angle = 0.05; angle < 1.5; angle += 0.06)
            assert_near(color_apart(branch_of(&g, angle, RAY_REFLECT)->throughput, color_of(gap_spectrum, angle, gap)),
                        0.0, 1e-5);
        stage_close(&g);
    }
}

/* The interpolated normals of a coarse mesh send some refracted rays back: all of their colours are then reflected. */
static void a_smooth_mesh_with_a_film_conserves_energy(void **state)
{
    (void)state;
    stage g = {.setting =
                   scene_from("background: {color: [1, 1, 1]}\nrender: {depth: 9, width: 1, height: 1, beyond: black}\n"
                              "meshes: {ball: {generate: icosphere, level: 0}}\n"
                              "solids: {a: {shape: mesh, mesh: ball, shading: smooth, transparency: 1, ior: 1.5, "
                              "film_thickness_nm: 400}}\n")};
    diagnostic why = {0};
    worked(scene_load(g.setting, &why), &why);
    stage_look(&g);
    for (double h = -0.97; h < 1.0; h += 0.0213)
        for (double v = -0.9; v < 1.0; v += 0.3) {
            const ray_tree *tree = stage_ray(&g, vec3_make(h, v, -4.0), vec3_make(0.0, 0.0, 1.0));
            for (int c = 0; c < 3; c++)
                assert_near(tree->radiance[c] + tree_cut(tree, c), 1.0, 1e-9);
        }
    stage_close(&g);
}

/* --- by wavelength --- */

static void at_a_wavelength_reflectances_are_exact(void **state)
{
    (void)state;
    for (double lambda_nm = 400.0; lambda_nm < 720.0; lambda_nm += 37.0) {
        char set_lambda[80];
        snprintf(set_lambda, sizeof set_lambda, "render.spectrum=spectral render.lambda_nm=%g", lambda_nm);
        stage g = soap(1.33, 420.0, set_lambda), gold = metal_floor("gold", set_lambda);
        for (size_t k = 0; k < COUNT(angles); k++) {
            const pair R = airy(angles[k], 1.33, 420.0, lambda_nm);
            const ray_node *back = branch_of(&g, angles[k], RAY_REFLECT);
            for (int c = 0; c < 3; c++)
                assert_near(back->throughput[c], 0.5 * (R.s + R.p), 1e-12);
            assert_near(branch_of(&g, angles[k], RAY_REFRACT)->throughput[1], 1.0 - 0.5 * (R.s + R.p), 1e-12);
            const complex_pair n = metal_index(metals_find("gold"), lambda_nm);
            const pair M = metal_by_siegel(angles[k], n.re, n.im);
            assert_near(branch_of(&gold, angles[k], RAY_REFLECT)->throughput[2], 0.5 * (M.s + M.p), 1e-12);
        }
        stage_close(&g);
        stage_close(&gold);
    }
}

/* One reflection of a white sky: a spectral film has the colour of the rgb film, up to its sum over wavelengths. */
static void both_kinds_of_film_agree(void **state)
{
    (void)state;
    static const char *const surfaces[] = {"medium=gold", "medium=copper", "medium=silver",
                                           "transparency=1 floor.film_thickness_nm=300 floor.ior=1.5"};
    for (size_t i = 0; i < COUNT(surfaces); i++) {
        scene *s = scene_from("render: {width: 1, height: 1, depth: 1, wavelengths: 512, beyond: sky}\n"
                              "camera: {position: [0, 1, 0], target: [1, 0, 0], fov_deg: 0.001}\n"
                              "background: {kind: gradient, color: [1, 1, 1], horizon: [0, 0, 0]}\n"
                              "solids: {floor: {shape: plane}}\n");
        char text[120];
        snprintf(text, sizeof text, "floor.%s", surfaces[i]);
        set_all(s, text);
        const vec3 rgb = look(s);
        set(s, "render.spectrum=spectral");
        const vec3 spectral = look(s);
        const vec3 clamped = vec3_make(fmin(spectral.x, sqrt(0.5)), fmin(spectral.y, sqrt(0.5)), spectral.z);
        assert_near(color_apart((const double[3]){rgb.x, rgb.y, rgb.z}, clamped), 0.0, 1e-4);
        assert_true(rgb.x > 0.0);
        scene_destroy(s);
    }
}

/* --- polarisation --- */

/* Two mirrors of gold that face each other: both planes of incidence are one, so that s and p stay themselves. */
static void two_metal_mirrors_polarise(void **state)
{
    (void)state;
    scene_text text = scene_begin(1.0, 2);
    add(&text, "  floor: {medium: gold, shape: plane}\n  lid: {medium: gold, shape: box, size: [99, 1, 99], position: "
               "[0, 4, 0]}\n");
    stage g = stage_of(text.at, "render.spectrum=spectral render.polarisation=on render.lambda_nm=550");
    const complex_pair n = metal_index(metals_find("gold"), 550.0);
    for (size_t k = 1; k < COUNT(angles); k++) {
        const pair R = metal_by_siegel(angles[k], n.re, n.im);
        const ray_tree *tree = stage_ray(&g, vec3_make(-2.0, 1.0, 0.0), towards(angles[k]));
        const ray_node *one = child_of(tree, &tree->node[0], RAY_REFLECT), *two = child_of(tree, one, RAY_REFLECT);
        assert_near(one->throughput[0], 0.5 * (R.s + R.p), 1e-12);
        assert_near(two->throughput[0], 0.5 * (R.s * R.s + R.p * R.p), 1e-12);
    }
    stage_close(&g);
}

/* Born and Wolf, 14.2: r_s and r_p of a metal in air by its complex angle of refraction, here in C's own complex
 * numbers would be the same formula; instead from the parts a, b of sqrt(eps - sin^2): r_s = (c - a - i b) / (c + a + i
 * b), and r_p / r_s = (a + i b - sin tan) / (a + i b + sin tan) times -1 in mueller.h's signs. */
static sp_response metal_response(double angle, double n, double k)
{
    const double s2 = squared(sin(angle)), x = n * n - k * k - s2, root = sqrt(x * x + squared(2.0 * n * k)),
                 b = sqrt(0.5 * (root - x)), a = sqrt(0.5 * (root + x)), st = sin(angle) * tan(angle);
    const pair R = metal_by_siegel(angle, n, k);
    /* conj(r_s) r_p = R_s r_p / r_s */
    const double below = squared(a + st) + b * b, re = (a * a + b * b - st * st) / below, im = 2.0 * b * st / below;
    return (sp_response){0.5 * (R.s + R.p), 0.5 * (R.s - R.p), -R.s * re, -R.s * im};
}

/* Three mirrors whose planes of incidence are turned by 90 and 90 degrees minus a tilt: light from the sky on the last,
 * forward by whole Mueller matrices. */
static void three_metal_mirrors_by_mueller_matrices(void **state)
{
    (void)state;
    scene_text text = scene_begin(1.0, 3);
    add(&text, "  floor: {medium: gold, shape: plane}\n"
               "  wall: {medium: gold, shape: plane, position: [3, 0, 0], rotation: [20, 35, 90]}\n"
               "  lid: {medium: gold, shape: plane, position: [0, 6, 0], rotation: [170, 0, 25]}\n");
    stage g = stage_of(text.at, "render.spectrum=spectral render.polarisation=on render.lambda_nm=550");
    const complex_pair n = metal_index(metals_find("gold"), 550.0);
    int chains = 0;
    for (double angle = 0.2; angle < 1.2; angle += 0.13)
        for (double turn = -0.5; turn < 0.5; turn += 0.23) {
            const vec3 d = vec3_make(sin(angle) * cos(turn), -cos(angle), sin(angle) * sin(turn));
            const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), d);
            mueller all = mueller_rotation(1.0, 0.0);
            const ray_node *at = &tree->node[0], *last = NULL;
            for (int i = 0; at && at->end == RAY_END_HIT && i < 3; i++) {
                const ray_node *next = child_of(tree, at, RAY_REFLECT);
                vec3 x, y, cx, cy;
                const vec3 s = vec3_cross(at->direction, at->hit.normal);
                polarisation_frame(at->direction, &x, &y);
                polarisation_frame(next->direction, &cx, &cy);
                const frame_turn in = frame_turn_to(cx, cy, s), out = frame_turn_to(x, y, s);
                const mueller m =
                    mueller_multiply(mueller_rotation(out.cos_2a, -out.sin_2a),
                                     mueller_multiply(mueller_from(metal_response(acos(at->hit.cos_i), n.re, n.im)),
                                                      mueller_rotation(in.cos_2a, in.sin_2a)));
                all = mueller_multiply(all, m);
                last = next, at = next, chains += i == 2;
            }
            if (!last)
                continue;
            assert_near(last->throughput[0], all.m[0][0], 1e-11);
            for (int c = 1; c < 4; c++)
                assert_near(last->stokes[c] * last->throughput[0], all.m[0][c], 1e-11);
        }
    assert_true(chains > 5);
    stage_close(&g);
}

/* --- random paths --- */

static void random_paths_have_the_mean_of_the_ray_tree(void **state)
{
    (void)state;
    static const char *const scenes[] = {
        "solids: {a: {shape: sphere, radius: 1, transparency: 1, ior: 1, film_thickness_nm: 350}}\n",
        "solids: {a: {shape: sphere, radius: 1, transparency: 1, ior: 1.5, film_thickness_nm: 250, reflectivity: "
        "0.1}}\n",
        "solids: {a: {shape: sphere, radius: 1, medium: copper}, b: {shape: sphere, radius: 1, position: [0.3, 2.4, "
        "0], "
        "medium: gold}}\n"};
    for (size_t i = 0; i < COUNT(scenes); i++) {
        char text[600];
        snprintf(text, sizeof text,
                 "render: {width: 1, height: 1, depth: 12}\n"
                 "camera: {position: [0.4, 0.6, 4], target: [0.4, 0.6, 0], fov_deg: 0.001}\n"
                 "background: {kind: gradient, color: [0.2, 1, 0.4], horizon: [0.9, 0.1, 0.6]}\n%s",
                 scenes[i]);
        scene *s = scene_from(text);
        const vec3 tree = look(s);
        set_all(s, "render.integrator=path render.paths=65536 render.roulette=off");
        const vec3 paths = look(s);
        assert_near(color_apart((const double[3]){tree.x, tree.y, tree.z}, paths), 0.0, 5.0 * 0.5 / 256.0);
        assert_true(i != 2 || color_apart((const double[3]){tree.x, tree.y, tree.z}, paths) < 1e-9);
        set(s, "render.spectrum=spectral");
        const vec3 by_wavelength = look(s);
        assert_true(by_wavelength.y > 0.0);
        scene_destroy(s);
    }
}

/* --- limits --- */

static void refuse(const char *text, const char *assignments, const char *message)
{
    scene *s = scene_from(text);
    diagnostic why = {0};
    char all[256];
    snprintf(all, sizeof all, "%s", assignments);
    char *rest = all;
    status code = STATUS_OK;
    for (char *word; code == STATUS_OK && (word = strtok_r(rest, " ", &rest));)
        code = scene_set_assignment(s, word, &why);
    if (code == STATUS_OK)
        code = scene_check(s, &why);
    assert_int_equal(code, STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, message));
    assert_true(why.remedy[0]);
    scene_destroy(s);
}

static void what_is_not_traced_is_refused(void **state)
{
    (void)state;
    static const char text[] = "solids: {a: {shape: sphere, ior: 1.5, transparency: 1}, b: {shape: sphere}}\n";
    refuse(text, "a.medium=gold", "is a metal");
    refuse(text, "a.film_thickness_nm=100 render.polarisation=on", "depends on the wavelength");
    refuse(text, "b.medium=gold render.polarisation=on", "depends on the wavelength");
    refuse(text, "a.film_thickness_nm=100 render.radiance=basic", "basic radiance");
    refuse(text, "a.film_thickness_nm=100 render.integrator=zbuffer", "depth buffer");
}

static uint64_t hash_of(const scene *s, isa level_of)
{
    render_result *r = render_at(s, level_of, NULL);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    return hash;
}

#define SHOW                                                                                              \
    "render: {width: 48, height: 36, depth: 5}\n"                                                         \
    "camera: {position: [0, 1.5, 6], target: [0, 0.8, 0]}\n"                                              \
    "background: {kind: gradient, color: [0.25, 0.45, 0.9], horizon: [1, 1, 1]}\n"                        \
    "lights: {lamp: {position: [4, 6, 5], radius: 0.3, reach: 9}}\n"                                      \
    "solids:\n"                                                                                           \
    "  ground: {shape: plane, diffuse: 0.7, checker: 0.5}\n"                                              \
    "  a: {shape: sphere, radius: 0.7, position: [-1.8, 0.7, 0], medium: gold, film_thickness_nm: 200}\n" \
    "  b: {shape: sphere, radius: 0.7, position: [0, 0.7, -1], medium: silver, diffuse: 0.1}\n"           \
    "  c: {shape: cylinder, radius: 0.7, height: 1, position: [1.8, 0, 0], transparency: 1, ior: 1.5, "   \
    "film_thickness_nm: 400}\n"                                                                           \
    "  d: {shape: sphere, radius: 0.6, position: [0.3, 0.7, 1.5], transparency: 1, film_thickness_nm: 400}\n"

static void films_are_bit_identical_for_all_threads_and_instruction_sets(void **state)
{
    (void)state;
    static const char *const variants[] = {"render.depth=5", "render.spectrum=spectral render.wavelengths=5",
                                           "render.integrator=path render.paths=16",
                                           "render.spectrum=spectral render.wavelengths=5 render.polarisation=on",
                                           "render.integrator=path render.paths=8 render.spectrum=spectral"};
    for (size_t v = 0; v < COUNT(variants); v++) {
        scene *s = scene_from(SHOW);
        set_all(s, variants[v]);
        set(s, "render.threads=1");
        const uint64_t expected = hash_of(s, ISA_BASE);
        set(s, "render.threads=3");
        for (int at = ISA_BASE; at <= (int)isa_best(); at++)
            assert_true(hash_of(s, (isa)at) == expected);
        scene_destroy(s);
    }
}

/* What is not there changes no bit: a film of no thickness whatever its index, an extinction of glass, a film with
 * constant weights. */
static void films_that_are_not_there(void **state)
{
    (void)state;
    static const char plain[] =
        "render: {width: 40, height: 30}\nbackground: {kind: gradient, color: [0, 0, 1], horizon: "
        "[1, 1, 1]}\ncamera: {position: [0, 1, 5]}\n"
        "solids: {a: {shape: sphere, ior: 1.5, transparency: 0.9, reflectivity: 0.1}}\n";
    static const char *const changes[] = {"a.film_ior=2", "a.extinction=2"};
    for (size_t i = 0; i < COUNT(changes); i++) {
        scene *s = scene_from(plain);
        const uint64_t before = hash_of(s, isa_best());
        set(s, changes[i]);
        assert_true(hash_of(s, isa_best()) == before);
        scene_destroy(s);
    }
    scene *s = scene_from(plain);
    set(s, "render.weights=constant");
    const uint64_t before = hash_of(s, isa_best());
    set(s, "a.film_thickness_nm=300");
    assert_true(hash_of(s, isa_best()) == before);
    set(s, "render.weights=fresnel");
    const uint64_t with = hash_of(s, isa_best());
    set(s, "a.film_thickness_nm=0");
    assert_true(hash_of(s, isa_best()) != with);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_soap_film_has_the_colours_of_airys_formula),
        cmocka_unit_test(the_strips_of_a_soap_film_have_newtons_colours),
        cmocka_unit_test(metals_have_the_colours_of_their_indices),
        cmocka_unit_test(a_metal_by_its_numbers),
        cmocka_unit_test(a_coated_lens_from_both_sides),
        cmocka_unit_test(tables_are_as_exact_as_stated),
        cmocka_unit_test(tables_of_coatings_are_as_exact_as_stated),
        cmocka_unit_test(a_gap_of_air_in_glass),
        cmocka_unit_test(a_smooth_mesh_with_a_film_conserves_energy),
        cmocka_unit_test(at_a_wavelength_reflectances_are_exact),
        cmocka_unit_test(both_kinds_of_film_agree),
        cmocka_unit_test(two_metal_mirrors_polarise),
        cmocka_unit_test(three_metal_mirrors_by_mueller_matrices),
        cmocka_unit_test(random_paths_have_the_mean_of_the_ray_tree),
        cmocka_unit_test(what_is_not_traced_is_refused),
        cmocka_unit_test(films_are_bit_identical_for_all_threads_and_instruction_sets),
        cmocka_unit_test(films_that_are_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
