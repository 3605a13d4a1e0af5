/* Tests of sunlit rain: a drop's scattering function against closed forms (Descartes' angles, mirror reflection between
 * the bows, lenses at both poles, the share of light), and films of a background of rain. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "optics/media.h"
#include "optics/phase_function.h"
#include "optics/spectrum.h"
#include "render/plan/sky.h"
#include "render_fixture.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))
#define DEGREE (3.14159265358979323846 / 180.0)

static drop_angles sharp, sunny;
static double p[DROP_BINS];

static double middle_deg(int bin)
{
    return (bin + 0.5) * DROP_BIN_DEG;
}

/* The middle of the brightest bin from low to high degrees. */
static double brightest(double low, double high)
{
    int best = (int)(low / DROP_BIN_DEG);
    for (int b = best; b < (int)(high / DROP_BIN_DEG); b++)
        best = p[b] > p[best] ? b : best;
    return middle_deg(best);
}

/* Angles from the antisolar point of the rays of least deviation: Descartes, Les Meteores, 1637. */
static double primary_deg(double n)
{
    const double i = acos(sqrt((n * n - 1.0) / 3.0)), r = asin(sin(i) / n);
    return (4.0 * r - 2.0 * i) / DEGREE;
}

static double secondary_deg(double n)
{
    const double i = acos(sqrt((n * n - 1.0) / 8.0)), r = asin(sin(i) / n);
    return 180.0 + (2.0 * i - 6.0 * r) / DEGREE;
}

static void the_bows_are_at_descartes_angles(void **state)
{
    (void)state;
    for (double n = 1.32; n < 1.36; n += 0.004) {
        drop_scattering(&sharp, n, p);
        assert_near(brightest(35.0, 46.0), primary_deg(n), DROP_BIN_DEG);
        assert_near(brightest(46.0, 60.0), secondary_deg(n), DROP_BIN_DEG);
        drop_scattering(&sunny, n, p); /* the disc moves the maximum into the bow's bright side */
        assert_near(brightest(35.0, 46.0), primary_deg(n) - 0.5 * SUN_RADIUS_DEG, 0.5 * SUN_RADIUS_DEG + DROP_BIN_DEG);
        assert_near(brightest(46.0, 60.0), secondary_deg(n) + 0.5 * SUN_RADIUS_DEG,
                    0.5 * SUN_RADIUS_DEG + DROP_BIN_DEG);
    }
}

static double index_of_water(double lambda_nm)
{
    return medium_index(media_find("water"), lambda_nm) / medium_index(media_find("air"), lambda_nm);
}

static void red_is_outside_the_primary_and_inside_the_secondary(void **state)
{
    (void)state;
    double primary[2], secondary[2];
    for (int k = 0; k < 2; k++) {
        drop_scattering(&sunny, index_of_water(k == 0 ? 656.3 : 434.0), p);
        primary[k] = brightest(35.0, 46.0), secondary[k] = brightest(46.0, 60.0);
    }
    assert_true(primary[0] > primary[1] + 1.0);
    assert_true(secondary[0] < secondary[1] - 2.0);
}

static double reflectance(double i, double n)
{
    const double r = asin(sin(i) / n), s = sin(i - r) / sin(i + r), t = tan(i - r) / tan(i + r);
    return 0.5 * (s * s + t * t);
}

/* Between the bows a drop shows only its outside, a mirror that spreads light evenly: p is the reflectance at half the
 * angle. */
static void the_dark_band_shows_the_outside_of_the_drops(void **state)
{
    (void)state;
    const double n = index_of_water(587.6);
    drop_scattering(&sunny, n, p);
    const double bow = brightest(35.0, 46.0), second = brightest(46.0, 60.0);
    for (int b = (int)((bow + 0.6) / DROP_BIN_DEG); middle_deg(b) < second - 0.6; b++) {
        assert_near(p[b], reflectance(0.5 * middle_deg(b) * DEGREE, n), 1e-5);
        assert_true(p[b] < 0.2 * p[(int)((bow - 4.0) / DROP_BIN_DEG)]);
        assert_true(p[b] < 0.5 * p[(int)((second + 4.0) / DROP_BIN_DEG)]);
    }
}

/* Near the axis a drop is a lens or a mirror: an angle of k times that of incidence gives 4 / k^2. */
static double lens(double k)
{
    return 4.0 / (k * k);
}

static void the_poles_are_those_of_lens_and_mirror(void **state)
{
    (void)state;
    const double n = 1.333, R = (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0)), T = 1.0 - R;
    drop_scattering(&sharp, n, p);
    const double back = R + T * T * R * lens(4.0 / n - 2.0),
                 ahead = 1.0 + T * T * lens(2.0 - 2.0 / n) + T * T * R * R * lens(6.0 / n - 2.0);
    assert_near(p[2] / back, 1.0, 1e-3);
    assert_near(p[DROP_BINS - 3] / ahead, 1.0, 5e-3); /* the outside's reflectance falls steeply at grazing incidence */
}

/* The share of a disc between two parallel lines: the integral of its chord, 2 sqrt(r^2 - x^2), over pi r^2. */
static double disc_between(double x0, double x1, double r)
{
    const double a = fmax(-r, fmin(x0, r)), b = fmax(-r, fmin(x1, r));
    const double upto_a = a * sqrt(r * r - a * a) + r * r * asin(a / r);
    const double upto_b = b * sqrt(r * r - b * b) + r * r * asin(b / r);
    return (upto_b - upto_a) / (acos(-1.0) * r * r);
}

static void a_disc_spreads_evenly_to_both_sides(void **state)
{
    (void)state;
    static drop_angles a;
    const double radii[] = {0.05, SUN_RADIUS_DEG, 1.0, 4.9};
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        drop_angles_make(radii[i], &a);
        for (int k = -a.disc_bins; k <= a.disc_bins; k++) {
            const double share = a.disc[k + a.disc_bins];
            assert_true(fabs(share - a.disc[a.disc_bins - k]) < 1e-14);
            const double exact = disc_between((k - 0.5) * DROP_BIN_DEG, (k + 0.5) * DROP_BIN_DEG, radii[i]);
            assert_true(fabs(share - exact) < 0.02 / (2 * a.disc_bins + 1));
        }
    }
}

/* The bins near both poles take what is spread beyond them. */
static void a_disc_moves_light_and_loses_none(void **state)
{
    (void)state;
    static drop_angles wide;
    double of_point = 0.0, of_disc = 0.0;
    drop_angles_make(4.9, &wide);
    drop_scattering(&sharp, 1.333, p);
    for (int b = 0; b < DROP_BINS; b++)
        of_point += p[b];
    drop_scattering(&wide, 1.333, p);
    for (int b = 0; b < DROP_BINS; b++)
        of_disc += p[b];
    assert_near(of_disc / of_point, 1.0, 1e-13);
}

static double sum_of(const drop_angles *a)
{
    double sum = 0.0;
    for (int b = 0; b < DROP_BINS; b++)
        sum += p[b] * drop_bin_fraction(a, b);
    return sum;
}

/* R + T^2 (1 + R + R^2) = 1 - T R^3 of each polarisation, summed over the cross-section by Simpson's rule in i. */
static double share_of_orders(double n)
{
    enum { STEPS = 20000 };
    double sum = 0.0;
    for (int k = 0; k <= STEPS; k++) {
        const double i = 90.0 * DEGREE * k / STEPS, si = sin(i), ci = cos(i), sr = si / n;
        const double cr = sr < 1.0 ? sqrt(1.0 - sr * sr) : 0.0, s = (ci - n * cr) / (ci + n * cr),
                     t = (n * ci - cr) / (n * ci + cr), R_s = sr < 1.0 ? s * s : 1.0, R_p = sr < 1.0 ? t * t : 1.0;
        const double lost = 0.5 * ((1.0 - R_s) * pow(R_s, 3.0) + (1.0 - R_p) * pow(R_p, 3.0));
        sum += (k == 0 || k == STEPS ? 1.0 : k % 2 ? 4.0 : 2.0) * 2.0 * si * ci * (1.0 - lost);
    }
    return sum * 90.0 * DEGREE / STEPS / 3.0;
}

static void no_light_is_lost_but_that_of_later_orders(void **state)
{
    (void)state;
    static const double index[] = {0.75, 1.0, 1.31, 1.333, 1.343, 1.47, 2.4};
    for (size_t k = 0; k < sizeof index / sizeof *index; k++) {
        drop_scattering(&sharp, index[k], p);
        assert_near(sum_of(&sharp), share_of_orders(index[k]), index[k] < 1.0 ? 1e-4 : 1e-6);
        drop_scattering(&sunny, index[k], p);
        if (index[k] != 1.0) /* a ray that goes straight on is no smooth function at the pole */
            assert_near(sum_of(&sunny), share_of_orders(index[k]), 1e-4);
    }
    drop_scattering(&sharp, 1.0, p); /* nothing happens to the light, except at exactly grazing incidence */
    assert_near(p[DROP_BINS - 1] * drop_bin_fraction(&sharp, DROP_BINS - 1), 1.0, 1e-5);
    assert_true(p[DROP_BINS / 2] < 1e-20);
}

/* --- films --- */

/* The camera looks at an angle from the antisolar point, on the side of the zenith or level with it. */
#define RAIN                                                                                     \
    "render: {width: 1, height: 1}\ncamera: {position: [0, 0, 0], yaw_deg: 0, fov_deg: 0.001}\n" \
    "background: {kind: rain, color: [0.2, 0.1, 0.4], horizon: [0.2, 0.1, 0.4], rain: 0.8, sun_elevation_deg: 30}\n"

static scene *rain_scene(const char *assignments)
{
    scene *s = scene_from(RAIN);
    set_all(s, assignments);
    return s;
}

static vec3 look_up(double angle_deg, const char *assignments)
{
    char pitch[60];
    scene *s = rain_scene(assignments);
    snprintf(pitch, sizeof pitch, "camera.pitch_deg=%.17g", angle_deg - 30.0);
    set(s, pitch);
    const vec3 seen = look(s);
    scene_destroy(s);
    return seen;
}

/* White light reflected by drops in the dark band, in three channels and by wavelength. */
static void a_pixel_is_the_sky_and_strength_times_p(void **state)
{
    (void)state;
    for (double angle = 45.0; angle < 49.0; angle += 0.7) {
        const double R = reflectance(0.5 * angle * DEGREE, index_of_water(560.0));
        const vec3 rgb = look_up(angle, "");
        assert_near(rgb.x, 0.2 + 0.8 * R, 3e-4);
        assert_near(rgb.y, 0.1 + 0.8 * R, 3e-4);
        assert_near(rgb.z, 0.4 + 0.8 * R, 6e-4);
        const vec3 by_wavelength = look_up(angle, "render.spectrum=spectral render.wavelengths=200");
        assert_near(by_wavelength.x, rgb.x, 2e-3);
        assert_near(by_wavelength.y, rgb.y, 2e-3);
        assert_near(by_wavelength.z, rgb.z, 2e-3);
    }
}

/* In the bow each wavelength has its own p, which the observer sums to a colour. */
static void both_films_agree_in_the_bow(void **state)
{
    (void)state;
    for (double angle = 39.0; angle < 44.0; angle += 0.31) {
        const vec3 a = look_up(angle, ""), b = look_up(angle, "render.spectrum=spectral render.wavelengths=400");
        assert_near(a.x, b.x, 0.01);
        assert_near(a.y, b.y, 0.01);
        assert_near(a.z, b.z, 0.01);
    }
    const vec3 outer = look_up(42.3, ""), inner = look_up(40.8, "");
    assert_true(outer.x - 0.2 > 2.0 * (outer.z - 0.4));
    assert_true(inner.z - 0.4 > 1.2 * (inner.x - 0.2));
}

/* The bow depends only on the angle from the antisolar point. */
static void the_sun_moves_the_bow(void **state)
{
    (void)state;
    const vec3 up = look_up(42.0, "");
    scene *s = rain_scene("background.sun_elevation_deg=0 background.sun_azimuth_deg=70 camera.yaw_deg=-68");
    const vec3 aside = look(s); /* antisolar point at azimuth 250; the camera looks 42 degrees from it */
    assert_near(up.x, aside.x, 1e-6);
    assert_near(up.z, aside.z, 1e-6);
    set(s, "background.drops=glycerol");
    assert_true(fabs(look(s).x - aside.x) > 0.01);
    set(s, "background.rain=0");
    assert_near(look(s).x, 0.2, 1e-6);
    scene_destroy(s);
}

static void the_mean_is_that_of_all_directions(void **state)
{
    (void)state;
    enum { PARTS = 36000 };
    const background sky = {.kind = BACKGROUND_RAIN, .rain = 0.8, .sun_elevation_deg = 90.0};
    for (int spectral = 0; spectral < 2; spectral++) {
        rain *r = rain_create(&sky, vec3_make(0.0, 1.0, 0.0), spectral);
        assert_non_null(r);
        double sum = 0.0;
        for (int k = 0; k < PARTS; k++) {
            const double angle = (k + 0.5) / PARTS * 180.0 * DEGREE;
            const vec3 d = vec3_make(sin(angle), -cos(angle), 0.0);
            sum += 0.5 * sin(angle) * 180.0 * DEGREE / PARTS *
                   (spectral ? rain_radiance(r, 501.0, d) : rain_color(r, d).y);
        }
        assert_near(spectral ? rain_radiance_mean(r, 501.0) : rain_color_mean(r).y, sum, 1e-4);
        assert_near(sum, 0.8, 0.8 * 0.01);
        rain_destroy(r);
    }
}

/* Beyond the depth limit a mirror reflects the mean: the sky's colour and nearly all the light of the drops. */
static void a_mirror_shows_the_mean_beyond_the_depth_limit(void **state)
{
    (void)state;
    static const char *const films[] = {"render.depth=0", "render.spectrum=spectral render.wavelengths=400"};
    scene *s = scene_from(RAIN "solids: {mirror: {shape: box, size: [90, 90, 1], position: [0, 0, 4], reflectivity: 1, "
                               "ambient: 0, diffuse: 0, specular: 0}}\n");
    set_all(s, "render.depth=0 render.beyond=mean camera.target=0,0,4");
    for (int k = 0; k < 2; k++) {
        set_all(s, films[k]);
        const vec3 seen = look(s);
        assert_near(seen.x, 0.2 + 0.8, 0.02);
        assert_near(seen.y, 0.1 + 0.8, 0.02);
        assert_near(seen.z, 0.4 + 0.8, 0.02);
    }
    scene_destroy(s);
}

/* Drops of water in air: the primary bow is where the index of water relative to air puts it. One relative to vacuum
 * moves it by a bin. */
static void the_bow_is_that_of_water_in_air(void **state)
{
    (void)state;
    const background sky = {.kind = BACKGROUND_RAIN, .rain = 1.0, .sun_elevation_deg = 90.0};
    rain *r = rain_create(&sky, vec3_make(0.0, 1.0, 0.0), true);
    assert_non_null(r);
    drop_scattering(&sunny, index_of_water(550.0), p);
    int best = 0, found = 0;
    double most = 0.0;
    for (int b = (int)(38.0 / DROP_BIN_DEG); b < (int)(46.0 / DROP_BIN_DEG); b++) {
        const double angle = (b + 0.5) * DROP_BIN_DEG * DEGREE,
                     share = rain_radiance(r, 550.0, vec3_make(sin(angle), -cos(angle), 0.0));
        best = p[b] > p[best] || best == 0 ? b : best;
        found = share > most ? b : found;
        most = fmax(most, share);
    }
    assert_int_equal(best, found);
    rain_destroy(r);
}

static void all_threads_and_instruction_sets_give_the_same_film(void **state)
{
    (void)state;
    static const char *const modes[] = {"", "render.spectrum=spectral render.wavelengths=4 render.beyond=mean"};
    for (int m = 0; m < 2; m++) {
        scene *s = rain_scene("render.width=80 render.height=60 camera.fov_deg=90");
        set_all(s, modes[m]);
        uint64_t first = 0;
        for (int level = ISA_BASE; level <= (int)isa_best(); level++)
            for (int threads = 1; threads <= 3; threads += 2) {
                s->render.threads = threads;
                render_result *result = render_at(s, (isa)level, NULL);
                first = first ? first : film_hash(result->img);
                assert_true(film_hash(result->img) == first);
                render_result_destroy(result);
            }
        scene_destroy(s);
    }
}

static int make_angles(void **state)
{
    (void)state;
    drop_angles_make(0.0, &sharp);
    drop_angles_make(SUN_RADIUS_DEG, &sunny);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bows_are_at_descartes_angles),
        cmocka_unit_test(red_is_outside_the_primary_and_inside_the_secondary),
        cmocka_unit_test(the_dark_band_shows_the_outside_of_the_drops),
        cmocka_unit_test(the_poles_are_those_of_lens_and_mirror),
        cmocka_unit_test(a_disc_spreads_evenly_to_both_sides),
        cmocka_unit_test(a_disc_moves_light_and_loses_none),
        cmocka_unit_test(no_light_is_lost_but_that_of_later_orders),
        cmocka_unit_test(a_pixel_is_the_sky_and_strength_times_p),
        cmocka_unit_test(both_films_agree_in_the_bow),
        cmocka_unit_test(the_sun_moves_the_bow),
        cmocka_unit_test(the_mean_is_that_of_all_directions),
        cmocka_unit_test(a_mirror_shows_the_mean_beyond_the_depth_limit),
        cmocka_unit_test(the_bow_is_that_of_water_in_air),
        cmocka_unit_test(all_threads_and_instruction_sets_give_the_same_film),
    };
    return cmocka_run_group_tests(tests, make_angles, NULL);
}
