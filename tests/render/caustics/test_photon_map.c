/* Tests of photon maps: irradiance of known distributions, its integral, its noise and its
 * edges, and independence of the order of photons. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "render/photons/photon_map.h"
#include <stdlib.h>
#include <string.h>

#define assert_near(a, b, tolerance)                                    \
    do {                                                                \
        if (!(fabs((a) - (b)) <= (tolerance)))                          \
            fail_msg("%.9g instead of %.9g", (double)(a), (double)(b)); \
    } while (0)

static photon photon_at(double x, double y, double z, float flux)
{
    return (photon){.position = {x, y, z}, .normal = {0.0F, 1.0F, 0.0F}, .flux = {flux, 2.0F * flux, 0.0F}};
}

/* Photon i of `count` on the unit square at y = 0, with a total flux of 1. */
static photon spread_evenly(uint32_t i, int count)
{
    const sobol_point s = sobol_at(i, 7);
    return photon_at(random_unit(s.x), 0.0, random_unit(s.y), 1.0F / (float)count);
}

static photon_map *map_of(photon_list *lists, size_t count, double widest)
{
    photon_map *m = NULL;
    assert_int_equal(photon_map_create(lists, count, &m, NULL), STATUS_OK);
    for (size_t first = 0; first < photon_map_count(m); first += PHOTON_BLOCK)
        photon_map_spread(m, first, &(photon_limits){.widest = widest});
    assert_true(photon_map_finish(m));
    for (size_t i = 0; i < count; i++)
        free(lists[i].list);
    return m;
}

static photon_map *even_map(int count)
{
    photon_list all = {0};
    for (int i = 0; i < count; i++) {
        const photon one = spread_evenly((uint32_t)i, count);
        assert_true(photon_list_add(&all, &one));
    }
    return map_of(&all, 1, 0.2);
}

static const vec3 up = {0.0, 1.0, 0.0};

static void an_even_density_gives_its_irradiance(void **state)
{
    (void)state;
    photon_map *m = even_map(20000);
    double sum = 0.0;
    int points = 0;
    for (double x = 0.2; x < 0.81; x += 0.05)
        for (double z = 0.2; z < 0.81; z += 0.05, points++) {
            const vec3 e = photon_map_irradiance(m, vec3_make(x, 0.0, z), up, -1);
            assert_near(e.x, 1.0, 0.1);
            assert_near(e.y, 2.0 * e.x, 1e-6);
            assert_near(e.z, 0.0, 0.0);
            sum += e.x;
        }
    assert_near(sum / points, 1.0, 0.005);
    photon_map_destroy(m);
}

/* Discs spread light, but none is lost: the integral over the plane, also beyond the square's edge, is the flux. */
static void the_integral_of_irradiance_is_the_flux(void **state)
{
    (void)state;
    photon_map *m = even_map(3000);
    double sum = 0.0;
    const double step = 0.004;
    for (double x = -0.3; x < 1.3; x += step)
        for (double z = -0.3; z < 1.3; z += step)
            sum += photon_map_irradiance(m, vec3_make(x, 0.0, z), up, -1).x * step * step;
    assert_near(sum, 1.0, 1e-3);
    photon_map_destroy(m);
}

/* Where light is not even, as along a line, a disc reaches to the PHOTON_NEIGHBOURS-th neighbour: here half as many
 * spacings, on either side. */
static void discs_reach_the_nearest_neighbours(void **state)
{
    (void)state;
    enum { COUNT = 1500 };
    photon_list all = {0};
    for (int i = 0; i < COUNT; i++) {
        const photon one = photon_at((i + 0.5) / COUNT, 0.0, 0.5, 1.0F);
        assert_true(photon_list_add(&all, &one));
    }
    photon_map *m = map_of(&all, 1, 0.2);
    const double r = 0.5 * PHOTON_NEIGHBOURS / COUNT;
    int inner = 0;
    for (size_t i = 0; i < photon_map_count(m); i++) {
        const photon *one = photon_map_at(m, i);
        if (one->position.x > 0.1 && one->position.x < 0.9) {
            assert_near((double)one->radius, r, 1e-5);
            inner++;
        }
    }
    assert_true(inner > 100);
    photon_map_destroy(m);
}

/* Mean and standard deviation of irradiance at points of a patch. */
static double irradiance_noise(const photon_map *m, double *mean)
{
    double sum = 0.0, sum2 = 0.0;
    int points = 0;
    for (double x = 0.25; x < 0.75; x += 0.02)
        for (double z = 0.25; z < 0.75; z += 0.02, points++) {
            const double e = photon_map_irradiance(m, vec3_make(x, 0.0, z), up, -1).x;
            sum += e, sum2 += e * e;
        }
    *mean = sum / points;
    return sqrt(sum2 / points - *mean * *mean);
}

/* Photons at independent random points: the sum of biweights over n photons in a disc has the relative variance
 * (9 / 5) / n, as the kernel's squared integral is 9 / (5 pi r^2); n is 48 in the narrowest discs, and 16 times as
 * much in the widest. */
static void discs_are_wide_where_light_is_even(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    photon_list all = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
        const random_words w = random_at(5, i, 0, 0, 0);
        const photon one = photon_at(random_unit(w.word[0]), 0.0, random_unit(w.word[1]), 1.0F / COUNT);
        assert_true(photon_list_add(&all, &one));
    }
    photon_map *m = map_of(&all, 1, 0.3);
    double mean;
    const double noise = irradiance_noise(m, &mean), widest = sqrt(1.8 / (16.0 * PHOTON_NEIGHBOURS));
    assert_near(mean, 1.0, 0.005);
    if (!(noise > 0.7 * widest && noise < 2.0 * widest)) /* that of the narrowest would be 4 times as much */
        fail_msg("noise %g instead of about %g", noise, widest);
    assert_true(photon_map_count(m) < COUNT / 4); /* many became one */
    photon_map_destroy(m);
}

/* Half of the square is lit. What wider discs lose or gain near its edge is below the noise of the narrow ones, which
 * is 19 % (discs_are_wide_where_light_is_even). */
static void edges_stay_sharp(void **state)
{
    (void)state;
    enum { COUNT = 40000 };
    photon_list all = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
        photon one = spread_evenly(i, COUNT);
        one.position.x *= 0.5;
        assert_true(photon_list_add(&all, &one));
    }
    photon_map *m = map_of(&all, 1, 0.3);
    const double narrow = sqrt(PHOTON_NEIGHBOURS / (2.0 * COUNT * 3.141592653589793)); /* of a disc within */
    double in = 0.0, out = 0.0, far_out = 0.0;
    int points = 0;
    for (double z = 0.2; z < 0.8; z += 0.005, points++) {
        in += photon_map_irradiance(m, vec3_make(0.5 - 2.0 * narrow, 0.0, z), up, -1).x;
        out += photon_map_irradiance(m, vec3_make(0.5 + 2.0 * narrow, 0.0, z), up, -1).x;
        far_out += photon_map_irradiance(m, vec3_make(0.5 + 4.0 * narrow, 0.0, z), up, -1).x;
    }
    assert_near(in / points, 2.0, 0.2);
    assert_near(out / points, 0.0, 0.1);
    assert_near(far_out, 0.0, 0.0);
    photon_map_destroy(m);
}

static void discs_are_no_narrower_than_the_least(void **state)
{
    (void)state;
    photon_list all = {0};
    for (int i = 0; i < 20000; i++) {
        const photon one = spread_evenly((uint32_t)i, 20000);
        assert_true(photon_list_add(&all, &one));
    }
    photon_map *m = NULL;
    assert_int_equal(photon_map_create(&all, 1, &m, NULL), STATUS_OK);
    free(all.list);
    const photon_limits limits = {.widest = 0.001, .least = 0.1, .least_at_1 = 0.01, .eye = vec3_make(0.5, 100.0, 0.5)};
    for (size_t first = 0; first < photon_map_count(m); first += PHOTON_BLOCK)
        photon_map_spread(m, first, &limits);
    assert_true(photon_map_finish(m));
    assert_true(photon_map_count(m) < 2000);
    double sum = 0.0;
    for (size_t i = 0; i < photon_map_count(m); i++) {
        assert_near((double)photon_map_at(m, i)->radius, 1.1, 1e-4); /* 100 above the plane */
        sum += (double)photon_map_at(m, i)->flux[0];
    }
    assert_near(sum, 1.0, 1e-4);
    photon_map_destroy(m);
}

static void other_surfaces_receive_nothing(void **state)
{
    (void)state;
    photon_map *m = even_map(20000);
    const vec3 at = {0.5, 0.0, 0.5};
    assert_true(photon_map_irradiance(m, at, up, -1).x > 0.5);
    assert_near(photon_map_irradiance(m, at, vec3_make(0.0, -1.0, 0.0), -1).x, 0.0, 0.0);
    assert_near(photon_map_irradiance(m, at, vec3_make(1.0, 0.0, 0.0), -1).x, 0.0, 0.0);
    assert_near(photon_map_irradiance(m, vec3_make(0.5, 0.1, 0.5), up, -1).x, 0.0, 0.0);
    assert_near(photon_map_irradiance(m, vec3_make(3.0, 0.0, 0.5), up, -1).x, 0.0, 0.0);
    photon_map_destroy(m);
}

/* Divided among three lists, in another order. */
static void the_map_does_not_depend_on_the_order_of_photons(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    photon_map *m = even_map(COUNT);
    photon_list three[3] = {{0}};
    for (int i = COUNT - 1; i >= 0; i--) {
        const photon one = spread_evenly((uint32_t)i, COUNT);
        assert_true(photon_list_add(&three[i * 7 % 3], &one));
    }
    photon_map *other = map_of(three, 3, 0.2);
    assert_int_equal(photon_map_count(other), photon_map_count(m));
    for (size_t i = 0; i < photon_map_count(m); i++)
        assert_memory_equal(photon_map_at(m, i), photon_map_at(other, i), sizeof(photon));
    for (double x = 0.0; x < 1.0; x += 0.03) {
        const vec3 a = photon_map_irradiance(m, vec3_make(x, 0.0, 0.4), up, -1),
                   b = photon_map_irradiance(other, vec3_make(x, 0.0, 0.4), up, -1);
        assert_memory_equal(&a, &b, sizeof a);
    }
    photon_map_destroy(m);
    photon_map_destroy(other);
}

static photon_map *unspread(const photon *photons, int count, int first, int step)
{
    photon_list all = {0};
    photon_map *m = NULL;
    for (int i = first; i >= 0 && i < count; i += step)
        assert_true(photon_list_add(&all, &photons[i]));
    assert_int_equal(photon_map_create(&all, 1, &m, NULL), STATUS_OK);
    assert_int_equal(photon_map_count(m), count);
    free(all.list);
    return m;
}

/* Photons at one point that differ in one number have an order, whichever came first. */
static void photons_at_one_point_have_an_order(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        photon pair[2] = {photon_at(1.0, 0.0, 1.0, 1e-6F), photon_at(1.0, 0.0, 1.0, 1e-6F)};
        if (k < 6)
            (k < 3 ? pair[1].flux : pair[1].normal)[k % 3] += 0.125F;
        else
            pair[1].radius += k == 6 ? 0.125F : 0.0F, pair[1].wavelength += k == 7;
        photon_map *m = unspread(pair, 2, 0, 1), *other = unspread(pair, 2, 1, -1);
        for (size_t i = 0; i < 2; i++)
            assert_memory_equal(photon_map_at(m, i), photon_map_at(other, i), sizeof(photon));
        photon_map_destroy(m);
        photon_map_destroy(other);
    }
}

/* The order, and so every sum, does not depend on the unit of length. */
static void the_order_is_the_same_at_any_scale(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    photon photons[2][COUNT];
    for (int i = 0; i < COUNT; i++) {
        const photon one = photons[0][i] = spread_evenly((uint32_t)i, COUNT);
        photons[1][i] = one;
        photons[1][i].position = vec3_scale(one.position, 0x1p10);
    }
    photon_map *m = unspread(photons[0], COUNT, 0, 1), *large = unspread(photons[1], COUNT, 0, 1);
    for (size_t i = 0; i < COUNT; i++) {
        const vec3 at = photon_map_at(m, i)->position, there = photon_map_at(large, i)->position;
        assert_true(there.x == 0x1p10 * at.x && there.z == 0x1p10 * at.z);
    }
    photon_map_destroy(m);
    photon_map_destroy(large);
}

/* Photons at all wavelengths alike: irradiance per wavelength number times 4000 is the same at each. */
static void a_spectral_map_counts_photons_of_near_wavelengths(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    photon_list all = {0};
    for (int i = 0; i < COUNT; i++) {
        photon one = spread_evenly((uint32_t)i, COUNT);
        const sobol_point s = sobol_at((uint32_t)i, 8);
        one.wavelength = (int32_t)(random_unit(s.x) * 4000.0);
        one.flux[0] = one.wavelength < 2000 ? 1.0F / COUNT : 0.0F;
        assert_true(photon_list_add(&all, &one));
    }
    photon_map *m = map_of(&all, 1, 0.2);
    double low = 0.0, high = 0.0;
    int points = 0;
    for (double x = 0.2; x < 0.81; x += 0.01)
        for (double z = 0.2; z < 0.81; z += 0.01, points++) {
            low += photon_map_irradiance(m, vec3_make(x, 0.0, z), up, 1200).x;
            high += photon_map_irradiance(m, vec3_make(x, 0.0, z), up, 2800).x;
        }
    assert_near(low / points, 1.0, 0.02);
    assert_near(high, 0.0, 0.0);
    photon_map_destroy(m);
}

static void maps_without_photons_or_with_coincident_ones(void **state)
{
    (void)state;
    photon_map *m = map_of(NULL, 0, 1.0);
    assert_near(photon_map_irradiance(m, vec3_make(0.0, 0.0, 0.0), up, -1).x, 0.0, 0.0);
    photon_map_destroy(m);
    photon_list same = {0};
    const photon one = photon_at(1.0, 0.0, 1.0, 1e-6F);
    for (int i = 0; i < 1000; i++)
        assert_true(photon_list_add(&same, &one));
    m = map_of(&same, 1, 1.0);
    const double e = photon_map_irradiance(m, vec3_make(1.0, 0.0, 1.0), up, -1).x;
    assert_true(isfinite(e) && e > 0.0);
    photon_map_destroy(m);
}

/* --- what samples of an image see --- */

/* Of the lattice of samples seen along a direction, whose cells on the ground have these sides, by photons of `reach`
 * and with `blur`: the flux, its centre, and its variance in both directions. */
typedef struct lattice {
    double flux, x, z, variance, image[64 * 64];
} lattice;

static void look(const photon_map *m, vec3 toward, double across, double down, double reach, double blur, lattice *out)
{
    const vec3 both = vec3_cross(vec3_make(across, 0.0, 0.0), vec3_make(0.0, 0.0, down));
    const photon_footprint f = {.toward = toward,
                                .across = {{across, 0.0, 0.0}, {0.0, 0.0, down}},
                                .along = vec3_scale(both, 1.0 / vec3_dot(both, toward)),
                                .reach = reach,
                                .blur = blur};
    double xx = 0.0;
    *out = (lattice){.flux = 0.0};
    for (int i = 0; i < 64 * 64; i++) {
        const double x = across * (i % 64 - 32), z = down * (i / 64 - 32);
        const double e = across * down * photon_map_seen(m, vec3_make(x, 0.0, z), up, -1, &f, NULL).x;
        out->image[i] = e;
        out->flux += e, out->x += e * x, out->z += e * z, xx += e * (x * x + z * z);
    }
    out->x /= out->flux, out->z /= out->flux;
    out->variance = xx / out->flux - out->x * out->x - out->z * out->z;
}

static double draw(uint32_t *draws, double low, double high)
{
    return low + (high - low) * random_unit(random_at(53, (*draws)++, 0, 0, 0).word[0]);
}

/* Photons that are seen as one keep their power, their centre and their variance, and look like themselves. (The mean
 * over a cell moves what is narrow in it to the cell's centre, so that centres are those of the cells.) */
static void groups_look_like_their_photons(void **state)
{
    (void)state;
    static lattice whole, grouped;
    uint32_t draws = 0;
    const int trials = 60;
    for (int trial = 0; trial < trials; trial++) {
        photon_list all = {0};
        const int clusters = 1 + (int)draw(&draws, 0.0, 4.0);
        double flux = 0.0;
        for (int c = 0; c < clusters; c++) {
            const double x = draw(&draws, -1.0, 1.0), z = draw(&draws, -1.0, 1.0), width = draw(&draws, 0.01, 0.6),
                         length = draw(&draws, 0.01, 0.6);
            for (int i = 0; i < 800; i++) {
                const photon one = photon_at(x + draw(&draws, -width, width), 0.0, z + draw(&draws, -length, length),
                                             (float)draw(&draws, 0.5, 1.5));
                flux += (double)one.flux[0];
                assert_true(photon_list_add(&all, &one));
            }
        }
        photon_map *m = map_of(&all, 1, draw(&draws, 0.02, 0.3));
        const vec3 toward = vec3_make(draw(&draws, -0.8, 0.8), -1.0, draw(&draws, -0.8, 0.8));
        const double across = draw(&draws, 0.07, 0.15), down = across * draw(&draws, 0.9, 2.0),
                     blur = trial % 2 ? 0.5 : 0.0;
        look(m, vec3_scale(toward, 1.0 / vec3_length(toward)), across, down, 1e9, blur, &whole);
        look(m, vec3_scale(toward, 1.0 / vec3_length(toward)), across, down, 0.0, blur, &grouped);
        double difference = 0.0;
        for (int i = 0; i < 64 * 64; i++)
            difference += fabs(whole.image[i] - grouped.image[i]);
        assert_near(whole.flux / flux, 1.0, 1e-3);
        assert_near(grouped.flux / flux, 1.0, 2e-3);
        assert_near(grouped.x, whole.x, 0.1 * across);
        assert_near(grouped.z, whole.z, 0.1 * across);
        assert_near(grouped.variance, whole.variance, 0.02 * whole.variance + 0.05 * across * down);
        assert_true(difference > 0.0);
        assert_near(difference / flux, 0.0, 0.2);
        photon_map_destroy(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_density_gives_its_irradiance),
        cmocka_unit_test(the_integral_of_irradiance_is_the_flux),
        cmocka_unit_test(discs_reach_the_nearest_neighbours),
        cmocka_unit_test(discs_are_wide_where_light_is_even),
        cmocka_unit_test(edges_stay_sharp),
        cmocka_unit_test(discs_are_no_narrower_than_the_least),
        cmocka_unit_test(other_surfaces_receive_nothing),
        cmocka_unit_test(the_map_does_not_depend_on_the_order_of_photons),
        cmocka_unit_test(photons_at_one_point_have_an_order),
        cmocka_unit_test(the_order_is_the_same_at_any_scale),
        cmocka_unit_test(a_spectral_map_counts_photons_of_near_wavelengths),
        cmocka_unit_test(maps_without_photons_or_with_coincident_ones),
        cmocka_unit_test(groups_look_like_their_photons),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
