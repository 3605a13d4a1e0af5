/* Tests of the kernels of random paths, and that their films are bit-identical. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "base/elementary.h"
#include "base/isa.h"
#include "base/lanes.h"
#include "base/random.h"
#include "render/shade/kernels.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

/* The kernels of random paths: the same random numbers as path_draw and the same angles as
 * elementary_sincos_deg, with each instruction set; directions on their cones, and points on their spheres. */

static const sampling_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(sampling_kernels);

static double unit(uint32_t a, uint32_t b)
{
    return random_unit(random_at(7, a, b, 0, 0).word[0]);
}

/* Pixels and samples over their whole ranges, the greatest included. */
static void fill_keys(uint32_t round, int64_t paths, int64_t *sample_key)
{
    for (uint32_t i = 0; i < ROW; i++) {
        const random_words r = random_at(1, round, i, 0, 0);
        const int64_t sample = i == 0 ? paths - 1 : (int64_t)(r.word[0] % (uint64_t)paths),
                      pixel = i == 1 ? 0xfffffff : r.word[1] >> 4;
        sample_key[i] = sample_key_make(pixel, sample) | (i % 2 ? SAMPLE_KEY_SPECULAR_BOUNCE : 0);
    }
}

static void expect_draws(const path_sampling *p, const int64_t *sample_key, int depth, int purpose)
{
    for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
        double u[ROW], v[ROW];
        kernels[level]->draw(p, ROW, sample_key, depth, purpose, u, v);
        for (int i = 0; i < ROW; i++) {
            const unit_pair expected = path_draw(p, sample_key[i], depth, purpose);
            if (u[i] != expected.u || v[i] != expected.v)
                fail_msg("%s, sampler %d, %d paths, ray %d: %.17g %.17g instead of %.17g %.17g", isa_name((isa)level),
                         (int)p->sampler, (int)p->paths, i, u[i], v[i], expected.u, expected.v);
        }
    }
}

static void draws_are_those_of_single_rays(void **state)
{
    (void)state;
    static const int64_t paths[] = {1, 2, 3, 7, 16, 63, 100, 1000, 4095, 65536, 1048575, 1048576};
    static const int64_t samplers[] = {SAMPLER_SOBOL, SAMPLER_PHILOX};
    for (uint32_t round = 0; round < sizeof paths / sizeof *paths; round++)
        for (int k = 0; k < 2; k++) {
            const render_settings r = {.paths = paths[round], .samples = 1, .seed = round, .sampler = samplers[k]};
            const path_sampling p = path_sampling_of(&r);
            int64_t sample_key[ROW];
            fill_keys(round, paths[round], sample_key);
            expect_draws(&p, sample_key, (int)round, DRAW_DIRECTION);
            expect_draws(&p, sample_key, 200, DRAW_PIXEL);
        }
}

/* With adaptive numbers of paths each pixel has its own. */
static void draws_follow_the_numbers_of_the_pixels(void **state)
{
    (void)state;
    const render_settings r = {.paths = 1024, .samples = 1, .sampler = SAMPLER_SOBOL};
    path_sampling p = path_sampling_of(&r);
    uint32_t by_pixel[ROW];
    int64_t sample_key[ROW];
    for (uint32_t i = 0; i < ROW; i++) {
        by_pixel[i] = (uint32_t)p.replicates * (i + 1);
        sample_key[i] = sample_key_make(i, random_at(3, i, 0, 0, 0).word[0] % by_pixel[i]);
    }
    p.by_pixel = by_pixel;
    expect_draws(&p, sample_key, 1, DRAW_LIGHT);
}

static void turns_are_those_of_the_scalar_function(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 100000; i++) {
        const double turn = i == 0   ? random_unit(0)
                            : i == 1 ? random_unit(UINT32_MAX)
                            : i < 34 ? random_unit((i / 4) << 29 | (i % 2 ? 0 : 0x1fffffff))
                                     : unit(i, 1);
        double s, c, expected_s, expected_c;
        elementary_sincos_turn_inline(turn, &s, &c);
        elementary_sincos_deg(360.0 * turn, &expected_s, &expected_c);
        if (s != expected_s || c != expected_c)
            fail_msg("turn %.17g: %.17g %.17g instead of %.17g %.17g", turn, s, c, expected_s, expected_c);
    }
}

static vec3 random_direction(uint32_t i)
{
    const double z = 2.0 * unit(i, 2) - 1.0, across = sqrt(1.0 - z * z);
    double s, c;
    elementary_sincos_deg(360.0 * unit(i, 3), &s, &c);
    return vec3_make(across * c, across * s, z);
}

static void fill_group(group *g, uint32_t round)
{
    memset(g, 0, sizeof *g);
    g->count = ROW - (int)round;
    for (uint32_t i = 0; i < ROW; i++) {
        const vec3 n = random_direction(round * ROW + i);
        g->points.nx[i] = n.x, g->points.ny[i] = n.y, g->points.nz[i] = n.z;
        g->points.px[i] = unit(i, 4), g->points.py[i] = unit(i, 5), g->points.pz[i] = unit(i, 6);
    }
}

static vec3 normal(const group *g, int i)
{
    return vec3_make(g->points.nx[i], g->points.ny[i], g->points.nz[i]);
}

/* The cosine law: cos^2 to the normal is 1 - u; the azimuth is v of a turn about it from some direction, so that v and
 * v + 1/2 are opposite. */
static void directions_have_their_angles(void **state)
{
    (void)state;
    static group g;
    double u[ROW], v[2][ROW], x[2][ROW], y[2][ROW], z[2][ROW];
    for (uint32_t round = 0; round < 20; round++) {
        fill_group(&g, round);
        for (uint32_t i = 0; i < ROW; i++)
            u[i] = unit(i, 10 + round), v[0][i] = 0.5 * unit(i, 50 + round), v[1][i] = v[0][i] + 0.5;
        for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
            for (int k = 0; k < 2; k++)
                kernels[level]->cosine(&g, u, v[k], x[k], y[k], z[k]);
            for (int i = 0; i < g.count; i++) {
                const vec3 a = vec3_make(x[0][i], y[0][i], z[0][i]), b = vec3_make(x[1][i], y[1][i], z[1][i]);
                assert_true(fabs(vec3_length(a) - 1.0) < 1e-15);
                assert_true(fabs(vec3_dot(a, normal(&g, i)) - sqrt(1.0 - u[i])) < 1e-14);
                assert_true(fabs(vec3_dot(a, b) - (1.0 - 2.0 * u[i])) < 1e-14);
            }
        }
    }
}

/* The point at `reach` is on the sphere, on its near side; u = 1 is the rim of the cone. */
static void samples_are_on_their_spheres(void **state)
{
    (void)state;
    static group g;
    static sphere_samples s;
    fill_group(&g, 0);
    for (uint32_t i = 0; i < ROW; i++) {
        s.x[i] = 4.0 * unit(i, 7), s.y[i] = 3.0 + unit(i, 8), s.z[i] = -unit(i, 9);
        s.radius[i] = i % 8 == 0 ? 9.0 : unit(i, 20), s.u[i] = unit(i, 21), s.v[i] = unit(i, 22);
    }
    for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
        kernels[level]->spheres(&g, &s);
        for (int i = 0; i < g.count; i++) {
            const vec3 d = vec3_make(s.dx[i], s.dy[i], s.dz[i]),
                       v = vec3_make(s.x[i], s.y[i], s.z[i]); /* from the point */
            if (s.radius[i] == 9.0) {                         /* encloses the point */
                assert_true(s.n_l[i] == 0.0);
                continue;
            }
            const vec3 from_centre = vec3_sub(vec3_scale(d, s.reach[i]), v);
            const double cap = 1.0 - sqrt(1.0 - s.radius[i] * s.radius[i] / vec3_dot(v, v));
            assert_true(fabs(vec3_length(from_centre) - s.radius[i]) < 1e-7);
            assert_true(vec3_dot(from_centre, d) <= 1e-7);
            assert_true(fabs(s.cap[i] - cap) < 1e-14);
            assert_true(fabs(vec3_dot(d, v) / vec3_length(v) - (1.0 - s.u[i] * cap)) < 1e-14);
            assert_true(s.n_l[i] == vec3_dot(normal(&g, i), d));
        }
    }
}

/* Rays toward points at chosen distances from a centre, some of them away from it: the line's distance is exact by the
 * Pythagorean theorem. What is kept may exceed the sphere by a thousandth, no more. */
static void rays_near_a_sphere_are_found(void **state)
{
    (void)state;
    static double o[3][ROW], d[3][ROW];
    static int64_t near[ROW];
    static const double ratios[] = {0.0, 0.5, 0.999999, 1.001, 1.5, 100.0};
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (uint32_t round = 0; round < 200; round++) {
            const int count = 1 + (int)(round % BATCH);
            const vec3 centre = vec3_make(4 * unit(round, 1) - 2, 4 * unit(round, 2) - 2, 4 * unit(round, 3) - 2);
            const double radius = 0.01 + unit(round, 4), far = 2.0 + 50.0 * unit(round, 5);
            bool expected[ROW], any = false;
            for (int i = 0; i < count; i++) {
                const uint32_t r = round * ROW + (uint32_t)i;
                const vec3 along = vec3_normalize(vec3_make(unit(r, 6) - 0.5, unit(r, 7) - 0.5, unit(r, 8) - 0.5));
                const vec3 across = vec3_normalize(vec3_cross(along, vec3_make(0.3, 1.0, -0.2)));
                const double ratio = ratios[i % 6], side = i % 5 == 4 ? -1.0 : 1.0;
                const vec3 from =
                    vec3_add(vec3_sub(centre, vec3_scale(along, far)), vec3_scale(across, ratio * radius));
                o[0][i] = from.x, o[1][i] = from.y, o[2][i] = from.z;
                d[0][i] = side * along.x, d[1][i] = side * along.y, d[2][i] = side * along.z;
                expected[i] = ratio < 1.0 && side > 0.0;
                any |= expected[i];
            }
            const ray_batch rays = {
                .count = count, .ox = o[0], .oy = o[1], .oz = o[2], .dx = d[0], .dy = d[1], .dz = d[2]};
            assert_int_equal(kernels[level]->near_sphere(&rays, centre, radius, near), any);
            for (int i = 0; i < count; i++)
                assert_int_equal(near[i], expected[i] ? -1 : 0);
        }
}

/* A clear surface sends a path where a random number falls among the two weights, a matte one along its directions. */
static void continuations_are_those_of_single_paths(void **state)
{
    (void)state;
    static group g;
    static branch_group b;
    static continuations c;
    double chance[ROW];
    fill_group(&g, 1);
    for (uint32_t i = 0; i < ROW; i++) {
        b.rx[i] = i, b.ry[i] = i + 200, b.rz[i] = i + 400, b.tx[i] = i + 600, b.ty[i] = i + 800, b.tz[i] = i + 1000;
        b.reflect[i] = i % 5 == 0 ? 0.0 : unit(i, 20), b.refract[i] = i % 7 == 0 ? 0.0 : unit(i, 21);
        chance[i] = i % 11 == 0 ? b.reflect[i] / (b.reflect[i] + b.refract[i]) : unit(i, 22);
        g.inside_before[i] = i, g.inside_after[i] = i + 200;
        g.sample_key[i] = i | (i % 2 ? SAMPLE_KEY_SPECULAR_BOUNCE : 0);
        g.cr[i] = i % 3 ? 0.0 : unit(i, 23), g.cg[i] = i % 4 ? 0.0 : unit(i, 24), g.cb[i] = i % 5 ? 0.0 : unit(i, 25);
    }
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (g.count = 1; g.count <= BATCH; g.count++) {
            kernels[level]->choose_branches(&g, &b, chance, &c);
            for (int i = 0; i < g.count; i++) {
                const double both = b.reflect[i] + b.refract[i];
                const bool refracted = chance[i] * both >= b.reflect[i] && b.refract[i] > 0.0;
                assert_int_equal(c.exists[i], both > 0.0 ? -1 : 0);
                if (!(both > 0.0))
                    continue;
                assert_int_equal(c.refracted[i], refracted ? -1 : 0);
                assert_true(c.dx[i] == i + (refracted ? 600 : 0) && c.dy[i] == i + (refracted ? 800 : 200) &&
                            c.dz[i] == i + (refracted ? 1000 : 400));
                assert_true(c.r[i] == both && c.g[i] == both && c.b[i] == both);
                assert_true(c.inside[i] == (uint64_t)i + (refracted ? 200 : 0));
                assert_true(c.sample_key[i] == (i | SAMPLE_KEY_SPECULAR_BOUNCE));
            }
            kernels[level]->leave_matte(&g, 0.7, &c);
            for (int i = 0; i < g.count; i++) {
                assert_int_equal(c.exists[i], g.cr[i] > 0.0 || g.cg[i] > 0.0 || g.cb[i] > 0.0 ? -1 : 0);
                assert_true(c.r[i] == g.cr[i] * 0.7 && c.g[i] == g.cg[i] * 0.7 && c.b[i] == g.cb[i] * 0.7);
                assert_true(c.inside[i] == (uint64_t)i && c.sample_key[i] == i && c.refracted[i] == 0);
            }
        }
}

/* The radiance of a point on a plane from a lamp, in double precision: k_d cos + k_s, with and without falloff. */
static void weights_follow_the_law_of_distance(void **state)
{
    (void)state;
    static lamp_table lamps;
    const vec3 n = vec3_make(0.0, 0.6, 0.8), point = vec3_make(0.1, -0.2, 0.3);
    lamps.blocks = 5;
    for (int k = 0; k < lamps.blocks * LAMP_BLOCK; k++) {
        lamps.x[k] = 6 * unit(1, (uint32_t)k) - 3, lamps.y[k] = 6 * unit(2, (uint32_t)k) - 3;
        lamps.z[k] = 6 * unit(3, (uint32_t)k) - 3;
        lamps.strength[k] = (float)unit(4, (uint32_t)k);
        lamps.even[k] = k % 2 ? 1.0f : 0.0f, lamps.falling[k] = 1.0f - lamps.even[k];
    }
    for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
        float weight[LAMPS_MAX];
        float around[LAMPS_MAX];
        kernels[level]->light_weights(&lamps, point, vec3_make(0.0, 0.0, 0.0), 0.0f, 0.1f, -1.0f, around);
        kernels[level]->light_weights(&lamps, point, n, 0.7f, 0.1f, 0.0f, weight);
        for (int k = 0; k < lamps.blocks * LAMP_BLOCK; k++) {
            const vec3 to = vec3_sub(vec3_make(lamps.x[k], lamps.y[k], lamps.z[k]), point);
            const double distance2 = vec3_dot(to, to), cosine = vec3_dot(n, to) / sqrt(distance2);
            const double radiance = (double)lamps.strength[k] / (k % 2 ? 1.0 : distance2) * (0.7 * cosine + 0.1);
            const double expected = cosine > 0.0 ? radiance : 0.0;
            assert_true(fabs((double)weight[k] - expected) <= 1e-5 * (1.0 + expected));
            const double even = (double)lamps.strength[k] / (k % 2 ? 1.0 : distance2) * 0.1;
            assert_true(fabs((double)around[k] - even) <= 1e-5 * (1.0 + even));
        }
    }
}

/* Films of random paths, wavelengths and Stokes vectors are bit-identical for any threads and batches. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define SMALL "render.width=40 render.height=30 render.depth=4 lamp.radius=0.7 lamp.reach=10 vessel.absorb_per_m=1,2,3 "

static const char *const variants[] = {
    SMALL "render.integrator=path render.paths=17",
    SMALL "render.integrator=path render.paths=16 render.sampler=philox",
    SMALL "render.integrator=path render.paths=16 render.samples=4 render.filter=centre render.roulette=on",
    SMALL "render.integrator=path render.spectrum=spectral render.paths=8 liquid.medium=water vessel.medium=sf11",
    SMALL "render.integrator=path render.spectrum=spectral render.paths=8 render.sampler=philox",
    SMALL
    "render.integrator=path render.paths=16 vessel.roughness=0.2 rod.medium=gold rod.roughness=0.3 lamp.radius=0.2",
    SMALL "render.integrator=path render.spectrum=spectral render.paths=8 vessel.medium=sf11 vessel.roughness=0.1 "
          "rod.reflectivity=0.5 rod.roughness=0.5 render.caustics=photons render.photons=3000",
    SMALL "render.integrator=path render.paths=16 liquid.scatter_per_m=2 liquid.asymmetry=0.7 vessel.scatter_per_m=1 "
          "lamp.kind=cone lamp.half_angle_deg=3 lamp.target=0,1,0 lamp.radius=0",
    SMALL "render.integrator=path render.spectrum=spectral render.paths=8 liquid.scatter_per_m=3 liquid.medium=water "
          "liquid.asymmetry=-0.4",
    SMALL "render.integrator=path render.paths=16 render.polarisation=on vessel.roughness=0.2 rod.reflectivity=0.5 "
          "liquid.sheet=retarder liquid.retardance_deg=50 vessel.sheet=polariser vessel.sheet_block=0.2 "
          "lamp.radius=0.2 liquid.scatter_per_m=1 camera.analyser=linear camera.analyser_angle_deg=25",
    SMALL "render.integrator=path render.spectrum=spectral render.paths=8 render.polarisation=on vessel.medium=sf11 "
          "rod.medium=gold rod.roughness=0.3 vessel.film_thickness_nm=300 camera.analyser=circular_right",
    SMALL "render.integrator=path render.paths=16 render.polarisation=on render.caustics=photons render.photons=3000 "
          "rod.reflectivity=0.5 liquid.sheet=polariser",
    SMALL "render.spectrum=spectral render.wavelengths=9 liquid.medium=water vessel.medium=sf11",
    SMALL "render.spectrum=spectral render.wavelengths=5 render.polarisation=on render.samples=4 vessel.medium=sf11",
    SMALL "render.polarisation=on render.min_weight=0.01",
};

typedef struct fingerprint {
    uint64_t hash, variance;
    ray_counters counters;
} fingerprint;

static fingerprint fingerprint_of(const render_result *r)
{
    fingerprint f = {film_hash(r->img), 0, r->counters};
    for (int i = 0; r->variance && i < 3 * r->img->width * r->img->height; i++) {
        uint64_t bits;
        memcpy(&bits, &r->variance[i], sizeof bits);
        f.variance = f.variance * 0x9e3779b97f4a7c15U + bits;
    }
    return f;
}

static fingerprint fingerprint_at(const scene *s, isa level)
{
    render_result *r = render_at(s, level, NULL);
    const fingerprint f = fingerprint_of(r);
    render_result_destroy(r);
    return f;
}

static void films_are_bit_identical_on_all_instruction_sets(void **state)
{
    (void)state;
    for (size_t v = 0; v < COUNT(variants); v++) {
        scene *s = rod_scene(variants[v]);
        const fingerprint expected = fingerprint_at(s, ISA_BASE);
        for (int level = ISA_BASE + 1; level <= (int)isa_best(); level++) {
            const fingerprint f = fingerprint_at(s, (isa)level);
            assert_memory_equal(&f, &expected, sizeof f);
        }
        scene_destroy(s);
    }
}

static void films_are_bit_identical_for_threads_schedules_and_tiles(void **state)
{
    (void)state;
    static const int threads[] = {1, 2, 7}, tiles[] = {1, 8, 64};
    renderer *r = NULL;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, NULL), STATUS_OK);
    for (size_t v = 0; v < COUNT(variants); v++) {
        scene *s = rod_scene(variants[v]);
        const fingerprint expected = fingerprint_at(s, isa_best());
        for (size_t t = 0; t < COUNT(threads); t++)
            for (int rule = SCHEDULE_COLUMNS; rule <= SCHEDULE_DYNAMIC; rule++)
                for (size_t k = 0; k < (rule < SCHEDULE_TILES ? 1 : COUNT(tiles)); k++) {
                    s->render.threads = threads[t];
                    s->render.schedule = rule;
                    s->render.tile = tiles[k];
                    render_result *result = NULL;
                    assert_int_equal(renderer_render(r, s, NULL, &result, NULL), STATUS_OK);
                    const fingerprint f = fingerprint_of(result);
                    assert_memory_equal(&f, &expected, sizeof f);
                    render_result_destroy(result);
                }
        scene_destroy(s);
    }
    renderer_destroy(r);
}

/* Without random choices the seed does not change the film. */
static void the_seed_changes_only_random_choices(void **state)
{
    (void)state;
    for (size_t v = 0; v < COUNT(variants); v++) {
        scene *s = rod_scene(variants[v]);
        const bool by_chance = s->render.integrator == INTEGRATOR_PATH || s->render.spectrum == SPECTRUM_SPECTRAL;
        const fingerprint one = fingerprint_at(s, isa_best());
        set(s, "render.seed=2");
        const fingerprint two = fingerprint_at(s, isa_best());
        assert_true((one.hash != two.hash) == by_chance);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_are_those_of_single_rays),
        cmocka_unit_test(draws_follow_the_numbers_of_the_pixels),
        cmocka_unit_test(turns_are_those_of_the_scalar_function),
        cmocka_unit_test(directions_have_their_angles),
        cmocka_unit_test(samples_are_on_their_spheres),
        cmocka_unit_test(rays_near_a_sphere_are_found),
        cmocka_unit_test(continuations_are_those_of_single_paths),
        cmocka_unit_test(weights_follow_the_law_of_distance),
        cmocka_unit_test(films_are_bit_identical_on_all_instruction_sets),
        cmocka_unit_test(films_are_bit_identical_for_threads_schedules_and_tiles),
        cmocka_unit_test(the_seed_changes_only_random_choices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
