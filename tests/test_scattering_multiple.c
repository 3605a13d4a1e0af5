/* Tests of light that is scattered many times: a furnace, Chandrasekhar's closed forms of a half space that scatters
 * evenly, and a slab against a Monte-Carlo of its own. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "whole.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define PI 3.14159265358979323846

/* A ball that scatters without loss, in uniform surroundings, is as bright as these: with and without an index of its
 * own, and with roulette. */
static void a_ball_in_a_furnace_is_invisible(void **state)
{
    (void)state;
    static const char *const variants[] = {"ball.ior=1", "ball.ior=1.33", "ball.ior=1 render.roulette=on",
                                           "ball.ior=1.33 render.radiance=basic", "ball.ior=1 ball.asymmetry=-0.9"};
    scene *s = scene_from("render: {width: 12, height: 9, depth: 64, integrator: path, paths: 256, beyond: black}\n"
                          "camera: {position: [0, 0, 4], target: [0, 0, 0], fov_deg: 30}\n"
                          "background: {color: [0.5, 0.6, 0.7]}\n"
                          "solids:\n"
                          "  ball: {shape: sphere, transparency: 1, ior: 1, scatter_per_m: 1.5, asymmetry: 0.6}\n");
    for (size_t i = 0; i < COUNT(variants); i++) {
        set_all(s, variants[i]);
        render_result *r = render(s);
        for (int k = 0; k < 12 * 9 * 3; k++) {
            const double sky = 0.5 + 0.1 * (k % 3), seen = (double)r->img->sum[k] / FILM_ONE;
            if (!(fabs(seen - sky) < 1e-3))
                fail_msg("%s: %.6f instead of %.2f", variants[i], seen, sky);
        }
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* --- a half space --- */

enum { NODES = 600 };

/* H of a half space that scatters evenly with an albedo: Chandrasekhar, Radiative Transfer, 1960, V (16), in the form
 * 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 times the integral of m H(m) / (mu + m) over m from 0 to 1. */
static double h_integral(double albedo, const double *h, double mu)
{
    double sum = 0.0;
    for (int i = 0; i < NODES; i++) {
        const double m = (i + 0.5) / NODES;
        sum += m * h[i] / (mu + m) / NODES;
    }
    return 1.0 / (sqrt(1.0 - albedo) + 0.5 * albedo * sum);
}

static double h_function(double albedo, double mu)
{
    double h[NODES], next[NODES];
    for (int i = 0; i < NODES; i++)
        h[i] = 1.0;
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i < NODES; i++)
            next[i] = h_integral(albedo, h, (i + 0.5) / NODES);
        for (int i = 0; i < NODES; i++)
            h[i] = 0.5 * (h[i] + next[i]);
    }
    return h_integral(albedo, h, mu);
}

static void the_h_function_is_that_of_the_table(void **state)
{
    (void)state;
    assert_true(fabs(h_function(1.0, 1.0) - 2.9078) < 1e-3); /* Chandrasekhar, table XI */
}

/* The camera looks down on a half space at an angle of cosine mu. */
static scene *half_space(double albedo, double mu)
{
    scene *s = scene_from("render: {width: 1, height: 1, depth: 64, integrator: path, paths: 65536, beyond: black}\n"
                          "camera: {target: [0, 0, 0], fov_deg: 0.001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "lights: {lamp: {position: [0, 1000000, 0], intensity: 0}}\n"
                          "solids: {milk: {shape: plane, transparency: 1, ior: 1}}\n");
    s->camera.position = vec3_make(0.0, 5.0 * mu, -5.0 * sqrt(1.0 - mu * mu));
    s->solids[0].surface.scatter_per_m = 2.0 * albedo;
    s->solids[0].surface.absorb_per_m = vec3_make(2.0 - 2.0 * albedo, 2.0 - 2.0 * albedo, 2.0 - 2.0 * albedo);
    return s;
}

/* Its radiance under a white sky is its albedo for light from there, 1 - H(mu) sqrt(1 - albedo). */
static void a_half_space_has_its_plane_albedo(void **state)
{
    ONLY_IN_CHECK();
    (void)state;
    static const double albedos[] = {0.3, 0.8, 0.95}, cosines[] = {1.0, 0.6, 0.2};
    for (size_t a = 0; a < COUNT(albedos); a++)
        for (size_t c = 0; c < COUNT(cosines); c++) {
            scene *s = half_space(albedos[a], cosines[c]);
            set_all(s, "background.color=1,1,1");
            const double expected = 1.0 - h_function(albedos[a], cosines[c]) * sqrt(1.0 - albedos[a]);
            const estimate e = look_by_chance(s, 1);
            if (!(fabs(e.value - expected) <= 1e-3 + e.t_95 * e.standard_error))
                fail_msg("%g, %g: %.5f instead of %.5f", albedos[a], cosines[c], e.value, expected);
            scene_destroy(s);
        }
}

/* Its radiance in the light of a lamp far away, whose irradiance across its direction is pi I:
 * albedo / 4 mu0 / (mu + mu0) H(mu) H(mu0) I (Chandrasekhar III (123)). */
static void a_half_space_reflects_a_lamp(void **state)
{
    (void)state;
    static const double suns[] = {1.0, 0.5, 0.1};
    for (size_t i = 0; i < COUNT(suns); i++) {
        const double albedo = 0.8, mu = 0.6, sun = suns[i], far = 1e6;
        scene *s = half_space(albedo, mu);
        s->lights[0].intensity = 2.0;
        s->lights[0].position = vec3_make(far * sqrt(1.0 - sun * sun), far * sun, 0.0);
        const double expected =
            2.0 * 0.25 * albedo * sun / (mu + sun) * h_function(albedo, mu) * h_function(albedo, sun);
        const estimate e = look_by_chance(s, 1);
        if (!(fabs(e.value - expected) <= 2e-3 * expected + e.t_95 * e.standard_error))
            fail_msg("%g: %.5f +- %.2g instead of %.5f", sun, e.value, e.standard_error, expected);
        scene_destroy(s);
    }
}

/* --- a slab --- */

static double chance(uint64_t *state)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return ((double)(*state >> 12) + 0.5) * 0x1p-52;
}

typedef struct shares {
    double passed, returned;
} shares;

/* Photons that fall straight on a slab of optical thickness `thick`: absorbed by chance at each of the events, and
 * turned by rejection from the phase function as it was printed; only the height and the cosine to the axis matter. */
static shares shares_of_slab(double thick, double albedo, double g)
{
    const int photons = 1000000;
    const double most = (1.0 - g * g) / pow(1.0 - g, 3);
    uint64_t state = 1;
    shares s = {0.0, 0.0};
    for (int i = 0; i < photons; i++) {
        double z = 0.0, mu = 1.0;
        for (;;) {
            z -= mu * log(chance(&state));
            if (z < 0.0 || z > thick || chance(&state) > albedo)
                break;
            double c;
            do
                c = 2.0 * chance(&state) - 1.0;
            while (chance(&state) * most > (1.0 - g * g) / pow(1.0 + g * g - 2.0 * g * c, 1.5));
            mu = mu * c + sqrt((1.0 - mu * mu) * (1.0 - c * c)) * cos(2.0 * PI * chance(&state));
            mu = fmin(fmax(mu, -1.0), 1.0);
        }
        s.passed += z > thick ? 1.0 / photons : 0.0;
        s.returned += z < 0.0 ? 1.0 / photons : 0.0;
    }
    return s;
}

/* Seen from one side: the ground behind shines, or the sky in front. */
static void a_slab_passes_and_returns_its_shares(void **state)
{
    (void)state;
    static const struct {
        double thick, albedo, g;
    } slabs[] = {{1.0, 1.0, 0.0}, {3.0, 0.9, 0.5}, {4.0, 0.98, 0.8}};
    scene *s = scene_from("render: {width: 1, height: 1, depth: 64, integrator: path, paths: 65536, beyond: black}\n"
                          "camera: {position: [0, 5, 0], target: [0, 0, 0], fov_deg: 0.001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "solids:\n"
                          "  slab: {shape: box, transparency: 1, ior: 1, position: [0, 2, 0], size: [9000, 1, 9000]}\n"
                          "  ground: {shape: plane, emission: 1}\n");
    for (size_t i = 0; i < COUNT(slabs); i++) {
        material *m = &s->solids[0].surface;
        const double absorbs = slabs[i].thick * (1.0 - slabs[i].albedo);
        m->scatter_per_m = slabs[i].thick * slabs[i].albedo, m->asymmetry = slabs[i].g;
        m->absorb_per_m = vec3_make(absorbs, absorbs, absorbs);
        const shares expected = shares_of_slab(slabs[i].thick, slabs[i].albedo, slabs[i].g);
        set_all(s, "ground.emission=1 background.color=0,0,0");
        const double passed = look_by_chance(s, 1).value;
        set_all(s, "ground.emission=0 background.color=1,1,1");
        const double returned = look_by_chance(s, 1).value;
        if (!(fabs(passed - expected.passed) < 3e-3 && fabs(returned - expected.returned) < 3e-3))
            fail_msg("%g: %.5f, %.5f instead of %.5f, %.5f", slabs[i].thick, passed, returned, expected.passed,
                     expected.returned);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_in_a_furnace_is_invisible),     cmocka_unit_test(the_h_function_is_that_of_the_table),
        cmocka_unit_test(a_half_space_has_its_plane_albedo),    cmocka_unit_test(a_half_space_reflects_a_lamp),
        cmocka_unit_test(a_slab_passes_and_returns_its_shares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
