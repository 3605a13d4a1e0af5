/* Tests that films of random paths, wavelengths and Stokes vectors are bit-identical for any threads and batches. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"

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
        cmocka_unit_test(films_are_bit_identical_on_all_instruction_sets),
        cmocka_unit_test(films_are_bit_identical_for_threads_schedules_and_tiles),
        cmocka_unit_test(the_seed_changes_only_random_choices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
