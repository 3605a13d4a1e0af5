/* Tests of spectral films: the colours of white skies, matte patches, absorbers and image skies, by their colour
 * difference (CIEDE2000) from the expected ones, and a prism's edges by Snell's law at each wavelength. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "color_difference.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static void xyz_at(const film *f, int x, int y, double xyz[3])
{
    const double rgb[3] = {film_value(f, x, y, 0), film_value(f, x, y, 1), film_value(f, x, y, 2)};
    linear_srgb_to_xyz(rgb, xyz);
}

static double difference_of(const double xyz[3], const double wanted_xyz[3])
{
    double lab[3], wanted_lab[3];
    lab_from_xyz(xyz, lab);
    lab_from_xyz(wanted_xyz, wanted_lab);
    return color_difference_2000(lab, wanted_lab);
}

/* The colour differences of all pixels: the largest, and that of the image's mean. */
typedef struct looks {
    double largest, of_mean;
} looks;

static looks compare(const film *f, const film *predicted)
{
    double mean[3] = {0}, wanted_mean[3] = {0};
    looks l = {0.0, 0.0};
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            double xyz[3], target[3];
            xyz_at(f, x, y, xyz);
            xyz_at(predicted, x, y, target);
            l.largest = fmax(l.largest, difference_of(xyz, target));
            for (int i = 0; i < 3; i++)
                mean[i] += xyz[i], wanted_mean[i] += target[i];
        }
    for (int i = 0; i < 3; i++)
        mean[i] /= f->width * f->height, wanted_mean[i] /= f->width * f->height;
    l.of_mean = difference_of(mean, wanted_mean);
    return l;
}

static looks spectral_against_rgb(scene *s, int wavelengths)
{
    s->render.spectrum = SPECTRUM_RGB;
    render_result *rgb = render(s);
    s->render.spectrum = SPECTRUM_SPECTRAL;
    s->render.wavelengths = wavelengths;
    render_result *spectral = render(s);
    assert_int_equal(spectral->img->space, FILM_XYZ);
    const looks l = compare(spectral->img, rgb->img);
    render_result_destroy(rgb);
    render_result_destroy(spectral);
    return l;
}

static const int wavelength_counts[] = {32, 256, 2048};

static void a_white_sky_is_white(void **state)
{
    (void)state;
    static const double largest[] = {1e-6, 1e-6, 1e-6}; /* the error for white is divided out */
    scene *s = scene_from("render: {width: 32, height: 32}\nbackground: {color: [1, 1, 1]}\n");
    for (size_t k = 0; k < COUNT(wavelength_counts); k++) {
        const looks l = spectral_against_rgb(s, wavelength_counts[k]);
        print_message("white, %d wavelengths: CIEDE2000 at most %.3g, of the mean %.2g\n", wavelength_counts[k],
                      l.largest, l.of_mean);
        assert_true(l.largest < largest[k] && l.of_mean < largest[k] / 10.0);
    }
    scene_destroy(s);
}

/* ColorChecker Classic, sRGB under D65 (X-Rite; Pascale, "RGB coordinates of the Macbeth ColorChecker", 2006). */
static const unsigned char patches[24][3] = {
    {115, 82, 68},   {194, 150, 130}, {98, 122, 157},  {87, 108, 67},   {133, 128, 177}, {103, 189, 170},
    {214, 126, 44},  {80, 91, 166},   {193, 90, 99},   {94, 60, 108},   {157, 188, 64},  {224, 163, 46},
    {56, 61, 150},   {70, 148, 73},   {175, 54, 60},   {231, 199, 31},  {187, 86, 149},  {8, 133, 161},
    {243, 243, 242}, {200, 200, 200}, {160, 160, 160}, {122, 122, 121}, {85, 85, 85},    {52, 52, 52}};

static vec3 patch_color(size_t k)
{
    return vec3_make(srgb_decode(patches[k][0] / 255.0), srgb_decode(patches[k][1] / 255.0),
                     srgb_decode(patches[k][2] / 255.0));
}

/* Lit by ambient light only, then emitting, then lit by a white lamp. */
static void check_color_checker(const char *lit_by, int wavelengths, double limit)
{
    scene *s = scene_from("render: {width: 12, height: 12, depth: 0}\n"
                          "camera: {position: [0, 5, 0], pitch_deg: -90, fov_deg: 1}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "lights: {lamp: {position: [0, 10, 0]}}\n"
                          "solids: {patch: {shape: plane}}\n");
    set_all(s, lit_by);
    looks worst = {0.0, 0.0};
    for (size_t k = 0; k < COUNT(patches); k++) {
        s->solids[0].surface.color = patch_color(k);
        const looks l = spectral_against_rgb(s, wavelengths);
        worst.largest = fmax(worst.largest, l.largest);
        worst.of_mean = fmax(worst.of_mean, l.of_mean);
    }
    print_message("ColorChecker, %s, %d wavelengths: CIEDE2000 at most %.3g, of a patch's mean %.2g\n", lit_by,
                  wavelengths, worst.largest, worst.of_mean);
    assert_true(worst.largest < limit && worst.of_mean < limit / 5.0);
    scene_destroy(s);
}

static void the_color_checker_has_its_rgb_colours(void **state)
{
    (void)state;
    check_color_checker("patch.ambient=1", 32, 1.0);
    check_color_checker("patch.ambient=1", 256, 0.05);
    check_color_checker("patch.emission=1", 256, 0.05);
    check_color_checker("patch.diffuse=0.8 lamp.intensity=0.7", 256, 0.05);
}

/* A checker's second colour has its own spectrum. */
static void both_colours_of_a_checker_have_their_rgb_values(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 16, height: 16, depth: 0}\n"
                          "camera: {position: [0.1, 5, 0.2], pitch_deg: -90, fov_deg: 40}\n"
                          "solids: {patch: {shape: plane, ambient: 1, checker: 0.5, color: [0.8, 0.2, 0.1], "
                          "checker_color: [0.1, 0.3, 0.7]}}\n");
    const looks l = spectral_against_rgb(s, 1024);
    print_message("checker: CIEDE2000 at most %.3g\n", l.largest);
    assert_true(l.largest < 0.01);
    scene_destroy(s);
}

/* --- skies --- */

static void gradient_and_coloured_skies_have_their_rgb_colours(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 24, height: 24}\n"
                          "camera: {position: [0, 1, 0], pitch_deg: 40, fov_deg: 100}\n"
                          "background: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: [3, 2.5, 1.5]}\n");
    looks l = spectral_against_rgb(s, 1024);
    print_message("gradient: CIEDE2000 at most %.3g\n", l.largest);
    assert_true(l.largest < 0.01);
    set(s, "background.kind=uniform");
    l = spectral_against_rgb(s, 1024);
    assert_true(l.largest < 0.01);
    scene_destroy(s);
}

/* White, grey, each primary and secondary, and two mixtures (a sum of spectra has the sum of their colours), next to
 * each other around the horizon, each 3 texels wide. */
static void an_image_sky_has_its_rgb_colours(void **state)
{
    (void)state;
    static const float texels[][3] = {{1, 1, 1}, {0.3F, 0.3F, 0.3F}, {1, 0, 0}, {0, 1, 0},          {0, 0, 1},
                                      {0, 1, 1}, {1, 0, 1},          {1, 1, 0}, {0.7F, 0.4F, 0.1F}, {0.2F, 0.5F, 2.0F}};
    enum { TEXELS = sizeof texels / sizeof texels[0] };
    scene *s = scene_from("render: {width: 8, height: 8}\ncamera: {position: [0, 0, 0], fov_deg: 2}\n");
    s->background.kind = BACKGROUND_IMAGE;
    free(s->background.image_path);
    s->background.image_path = strdup("in-memory.pfm");
    assert_int_equal(image_create(3 * TEXELS, 5, &s->background.img, NULL), STATUS_OK);
    for (int i = 0; i < 3 * TEXELS * 5; i++)
        memcpy(s->background.img->pixel + 3 * i, texels[i % (3 * TEXELS) / 3], sizeof texels[0]);
    double largest = 0.0;
    for (int k = 0; k < TEXELS; k++) {
        s->camera.aimed = 0;
        s->camera.yaw_deg = ((3 * k + 1.5) / (3.0 * TEXELS) - 0.5) * 360.0;
        const looks l = spectral_against_rgb(s, 1024);
        if (l.largest > 0.01)
            fail_msg("texel %d: CIEDE2000 %g", k, l.largest);
        largest = fmax(largest, l.largest);
    }
    print_message("image: CIEDE2000 at most %.3g\n", largest);
    scene_destroy(s);
}

/* --- glass --- */

/* With grey light and grey walls each wavelength has the rgb values. */
static void glass_of_constant_index_has_the_values_of_rgb(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=40 render.height=30 background.kind=gradient background.color=0.2,0.2,0.2 "
                         "plastic.color=0.5,0.5,0.5 "
                         "tiles.color=0.8,0.8,0.8 tiles.checker_color=0.3,0.3,0.3");
    const looks l = spectral_against_rgb(s, 1024);
    print_message("glass: CIEDE2000 at most %.3g, of the mean %.2g\n", l.largest, l.of_mean);
    assert_true(l.largest < 0.01 && l.of_mean < 0.001);
    scene_destroy(s);
}

/* Schott's Sellmeier law of N-BK7 (2017), L in um; relative to air, which surrounds the prism here. */
static double index_of_bk7(double lambda_nm)
{
    const double L2 = lambda_nm * lambda_nm * 1e-6;
    return sqrt(1.0 + 1.03961212 * L2 / (L2 - 0.00600069867) + 0.231792344 * L2 / (L2 - 0.0200179144) +
                1.01046945 * L2 / (L2 - 103.560653));
}

/* A block whose back is cut off by air at 30 degrees, thicker at the top, is a prism; the distant background is black
 * up to some height. */
/* otherwise the first face reflects the sky */
static const char prism_scene[] =
    "render: {width: 1, height: 240, depth: 2, beyond: black}\n"
    "camera: {position: [0, 0, -3], target: [0, 0, 0], fov_deg: 3}\n"
    "background: {color: [1, 1, 1], medium: air}\n"
    "solids:\n"
    "  prism: {shape: box, size: [4, 4, 2], position: [0, 0, 0.5], transparency: 1, medium: bk7}\n"
    "  cut: {shape: box, size: [8, 8, 4], position: [0, -1, 2.2320508075688772], rotation: [30, 0, 0], transparency: "
    "1, medium: air, priority: 1}\n"
    "  black: {shape: box, size: [1000000, 1000000, 1000], position: [0, -500000, 1000000]}\n"
    "  behind: {shape: box, size: [10, 10, 1], position: [0, 0, -10]}\n";

enum { ROWS = 240 };

/* Elevation behind the prism of a view ray of that elevation: Snell's law at both faces. */
static double elevation_behind(double elevation_deg, double n, double tilt_deg)
{
    const double degree = acos(-1.0) / 180.0, inside = asin(sin(elevation_deg * degree) / n);
    const double incidence = inside - tilt_deg * degree;
    return tilt_deg + asin(n * sin(incidence)) / degree;
}

/* The row of the image in which the elevation behind the prism is the black edge's. */
static double edge_row(double n, double tilt_deg, double edge_deg)
{
    double low = -1.5, high = 1.5;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        *(elevation_behind(middle, n, tilt_deg) < edge_deg ? &low : &high) = middle;
    }
    const double degree = acos(-1.0) / 180.0;
    return ROWS * 0.5 * (1.0 - tan(low * degree) / tan(1.5 * degree));
}

/* Rows from the top: the first in which less than half of the top row's light is left. */
static double seen_edge(const film *f, int channel)
{
    for (int y = 0; y < ROWS; y++)
        if ((double)f->sum[3 * y + channel] < 0.5 * (double)f->sum[channel])
            return y;
    return ROWS;
}

/* Glass of constant index has the same tree at each wavelength, so the same branches are too faint at each. 64: a power
 * of two divides weights and threshold without rounding. */
static void the_weight_limit_does_not_depend_on_the_number_of_wavelengths(void **state)
{
    (void)state;
    need_counters();
    scene *s = scene_from("render: {width: 12, height: 9, depth: 8, min_weight: 0.02, wavelengths: 64}\n"
                          "background: {color: [1, 1, 1]}\ncamera: {position: [0, 0, -4], target: [0, 0, 0]}\n"
                          "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5}}\n");
    render_result *rgb = render(s);
    s->render.spectrum = SPECTRUM_SPECTRAL;
    render_result *spectral = render(s);
    assert_true(rgb->counters.cut_weight > 0);
    assert_int_equal(spectral->counters.cut_weight, 64 * rgb->counters.cut_weight);
    render_result_destroy(rgb);
    render_result_destroy(spectral);
    scene_destroy(s);
}

/* A white furnace is white at every pixel, and no pixel gets more. Dispersing glass in dispersing water, for numbers of
 * wavelengths that divide the table evenly or not, and for random paths. */
static void a_spectral_furnace_is_white_in_every_pixel(void **state)
{
    (void)state;
    static const char *const settings[] = {"render.wavelengths=8", "render.wavelengths=32", "render.wavelengths=48",
                                           "render.integrator=path render.paths=24"};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        scene *s = scene_from("render: {width: 12, height: 9, depth: 5, spectrum: spectral}\n"
                              "background: {color: [1, 1, 1]}\ncamera: {position: [0, 0, -4], target: [0, 0, 0]}\n"
                              "solids: {ball: {shape: sphere, transparency: 1, medium: sf11, priority: 1},\n"
                              "  pond: {shape: box, transparency: 1, medium: water, size: [3, 1, 3]}}\n");
        set_all(s, settings[i]);
        render_result *result = render(s);
        for (int y = 0; y < 9; y++)
            for (int x = 0; x < 12; x++)
                for (int c = 0; c < 3; c++)
                    if (!(fabs(film_value(result->img, x, y, c) - 1.0) <= 1e-9))
                        fail_msg("%s: %.12f at %d,%d", settings[i], film_value(result->img, x, y, c), x, y);
        render_result_destroy(result);
        scene_destroy(s);
    }
}

static void a_prism_separates_red_and_blue(void **state)
{
    (void)state;
    scene *s = scene_from(prism_scene);
    const double tilt_deg = -30.0; /* elevation of the second face's normal */
    const double n_between = index_of_bk7(550.0), edge_deg = elevation_behind(0.0, n_between, tilt_deg);
    s->solids[2].shape.position.y = 1e6 * tan(edge_deg * acos(-1.0) / 180.0) - 5e5;
    s->solids[2].shape.position.z = 1e6 + 500.0;
    /* one narrow band at a time: all else is absorbed */
    static const struct {
        double nm;
        const char *law;
    } bands[] = {{450.0, "prism.absorb_spectrum=[444.9,1e6,445,0,455,0,455.1,1e6]"},
                 {650.0, "prism.absorb_spectrum=[644.9,1e6,645,0,655,0,655.1,1e6]"}};
    double rows[2];
    set_all(s, "render.spectrum=spectral render.wavelengths=512");
    for (int k = 0; k < 2; k++) {
        set(s, bands[k].law);
        render_result *r = render(s);
        rows[k] = seen_edge(r->img, k == 0 ? 2 : 0);
        const double predicted = edge_row(index_of_bk7(bands[k].nm), tilt_deg, edge_deg);
        print_message("edge at %g nm: row %g, by Snell's law %.2f\n", bands[k].nm, rows[k], predicted);
        assert_near(rows[k], predicted, 1.5);
        render_result_destroy(r);
    }
    assert_true(fabs(rows[0] - rows[1]) > 20.0);
    /* all wavelengths: colour between the edges, none outside them; constant index: no colour anywhere */
    set(s, "prism.absorb_spectrum=[]");
    render_result *all = render(s);
    const int between = (int)(0.5 * (rows[0] + rows[1]));
    const double *white =
        (const double[3]){film_value(all->img, 0, 0, 0), film_value(all->img, 0, 0, 1), film_value(all->img, 0, 0, 2)};
    assert_true(fabs(white[0] - white[2]) < 0.01 && white[0] > 0.8);
    assert_true(fabs(film_value(all->img, 0, between, 0) - film_value(all->img, 0, between, 2)) > 0.2);
    assert_true(fabs(film_value(all->img, 0, ROWS - 1, 1)) < 1e-12);
    render_result_destroy(all);
    set_all(s, "render.spectrum=rgb render.lambda_nm=450");
    render_result *rgb = render(s);
    assert_near(seen_edge(rgb->img, 0), edge_row(index_of_bk7(450.0), tilt_deg, edge_deg), 1.0);
    for (int y = 0; y < ROWS; y++)
        assert_true(film_value(rgb->img, 0, y, 0) == film_value(rgb->img, 0, y, 2));
    render_result_destroy(rgb);
    scene_destroy(s);
}

/* A pane of index 1 in white light, 0.1 m thick, that absorbs 500 to 600 nm: the light outside the band remains, by the
 * observer's weights and daylight, summed by the midpoint rule at every 0.05 nm. */
static void light_of_an_absorbed_band_is_removed(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 16, height: 16, spectrum: spectral, wavelengths: 1024}\n"
                          "camera: {position: [0, 0, -3], target: [0, 0, 0], fov_deg: 1}\n"
                          "background: {color: [1, 1, 1]}\n"
                          "solids:\n"
                          "  pane: {shape: box, size: [4, 4, 0.1], transparency: 1, ior: 1,\n"
                          "         absorb_spectrum: [499.999, 0, 500, 1e5, 600, 1e5, 600.001, 0]}\n");
    double predicted[3] = {0.0, 0.0, 0.0}, mean[3] = {0.0, 0.0, 0.0}, xyz[3];
    for (int k = 0; k < 8000; k++) {
        const double lambda_nm = 380.0 + 0.05 * (k + 0.5);
        observer_weights(lambda_nm, xyz);
        for (int i = 0; i < 3; i++)
            predicted[i] += lambda_nm < 500.0 || lambda_nm > 600.0 ? xyz[i] * observer_d65(lambda_nm) / 8000.0 : 0.0;
    }
    render_result *r = render(s);
    for (int i = 0; i < 256; i++) {
        xyz_at(r->img, i % 16, i / 16, xyz);
        for (int c = 0; c < 3; c++)
            mean[c] += xyz[c] / 256.0;
    }
    print_message("band: CIEDE2000 %.3g, luminance %.4f of white\n", difference_of(mean, predicted), mean[1]);
    assert_true(difference_of(mean, predicted) < 0.05 && mean[1] < 0.35);
    /* unit_m scales lengths: at 0.0001 it absorbs very little */
    set_all(s, "render.unit_m=1e-6 pane.absorb_spectrum=[499.999,0,500,1e6,600,1e6,600.001,0]"); /* optical depth 0.1 */
    render_result_destroy(r);
    r = render(s);
    double seen = 0.0, rest = predicted[1];
    for (int i = 0; i < 256; i++) {
        xyz_at(r->img, i % 16, i / 16, xyz);
        seen += xyz[1] / 256.0;
    }
    assert_near(seen, rest + (1.0 - rest) * exp(-0.1), 2e-4);
    render_result_destroy(r);
    scene_destroy(s);
}

/* Random paths sample wavelengths too: the same colours, within their noise. */
static void random_paths_have_the_same_colours(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 12, height: 12, integrator: path, paths: 1024, filter: centre}\n"
                          "camera: {position: [0, 0, -5], target: [0, 0, 0], fov_deg: 30}\n"
                          "background: {color: [1, 1, 1]}\n"
                          "solids: {ball: {shape: sphere, color: [0.8, 0.3, 0.1], diffuse: 1}}\n");
    const looks l = spectral_against_rgb(s, 32);
    print_message("paths: CIEDE2000 at most %.3g, of the mean %.2g\n", l.largest, l.of_mean);
    assert_true(l.largest < 0.01 && l.of_mean < 0.001);
    scene_destroy(s);
}

/* An orange lamp is orange itself, and gives orange light on a floor: the first exactly, the second at random. */
static void sphere_lights_have_their_colour(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {width: 6, height: 6, integrator: path, paths: 2048, depth: 0, beyond: black}\n"
                   "camera: {position: [0, 5, -5], target: [0, 5, 0], fov_deg: 5}\n"
                   "lights: {lamp: {position: [0, 5, 0], color: [1, 0.6, 0.2], intensity: 0.1, reach: 4, radius: 1}}\n"
                   "solids: {floor: {shape: plane, diffuse: 0.9}}\n");
    looks l = spectral_against_rgb(s, 32);
    print_message("lamp: CIEDE2000 at most %.3g\n", l.largest);
    assert_true(l.largest < 0.01);
    set(s, "camera.target=0,0,0");
    l = spectral_against_rgb(s, 32);
    print_message("its light: CIEDE2000 at most %.3g, of the mean %.2g\n", l.largest, l.of_mean);
    assert_true(l.largest < 1.5 && l.of_mean < 0.2);
    scene_destroy(s);
}

/* A slab whose index equals the surroundings' at render.lambda_nm, 1.4375 + 0.015625 um^2 / 0.25 um^2 = 1.5, and is
 * lower at longer wavelengths, is one medium with them only at that wavelength. At 85 degrees it reflects everything
 * above 525 nm, where sin 85 > n / 1.5: red sees the sky, sin 5 of its brightness up there, and blue the black
 * below. */
static void media_with_equal_index_at_one_wavelength_stay_distinct(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {width: 1, height: 1, spectrum: spectral, wavelengths: 64, lambda_nm: 500, depth: 3}\n"
                   "camera: {position: [0, 1, 0], pitch_deg: -5, fov_deg: 0.01}\n"
                   "background: {kind: gradient, color: [1, 1, 1], horizon: [0, 0, 0], ior: 1.5}\n"
                   "solids: {slab: {shape: box, position: [0, -500, 0], size: [1000, 1000, 1000], transparency: 1, "
                   "medium: cauchy, "
                   "coefficients: [1.4375, 0.015625]}}\n");
    const vec3 seen = look(s);
    const double sky = sin(acos(-1.0) / 36.0);
    assert_true(seen.x > 0.9 * sky && seen.z < 0.2 * sky);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_sky_is_white),
        cmocka_unit_test(the_color_checker_has_its_rgb_colours),
        cmocka_unit_test(both_colours_of_a_checker_have_their_rgb_values),
        cmocka_unit_test(gradient_and_coloured_skies_have_their_rgb_colours),
        cmocka_unit_test(an_image_sky_has_its_rgb_colours),
        cmocka_unit_test(glass_of_constant_index_has_the_values_of_rgb),
        cmocka_unit_test(the_weight_limit_does_not_depend_on_the_number_of_wavelengths),
        cmocka_unit_test(a_spectral_furnace_is_white_in_every_pixel),
        cmocka_unit_test(a_prism_separates_red_and_blue),
        cmocka_unit_test(light_of_an_absorbed_band_is_removed),
        cmocka_unit_test(random_paths_have_the_same_colours),
        cmocka_unit_test(sphere_lights_have_their_colour),
        cmocka_unit_test(media_with_equal_index_at_one_wavelength_stay_distinct),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
