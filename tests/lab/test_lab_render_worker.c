/* Tests of the render worker and of its adaptive resolution. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"
#include "measure/clock.h"
#include "render_fixture.h"
#include "scene/model/scene.h"
#include "web/live/passes.h"
#include "web/live/render_worker.h"
#include "whole.h"
#include <pthread.h>
#include <stdatomic.h>
#include <sys/resource.h>
#include <time.h>

/* The render worker: the final image is the film of the scene, newer changes win, errors are reported, and all
 * waits end with the worker. */

typedef struct studio {
    scene_document *d;
    render_worker *p;
    pthread_mutex_t lock;
    uint64_t serial, generation; /* of the last image */
    int images, passes_after_final, json;
    bool final;
    double finer_s; /* when the first pass after the first one came, of the last generation that has one */
} studio;

/* Images arrive in order: serials increase, generations and passes never decrease. */
static void take_image(void *of, const shared_image *shown)
{
    studio *s = of;
    pthread_mutex_lock(&s->lock);
    if (shown->serial <= s->serial || shown->generation < s->generation)
        s->passes_after_final = -1000000;
    if (s->final && shown->generation == s->generation)
        s->passes_after_final++;
    s->serial = shown->serial;
    s->generation = shown->generation;
    s->final = shown->final;
    s->images++;
    if (shown->pass == 2)
        s->finer_s = clock_wall_s();
    pthread_mutex_unlock(&s->lock);
}

static void on_state(void *of)
{
    studio *s = of;
    pthread_mutex_lock(&s->lock);
    s->json++;
    pthread_mutex_unlock(&s->lock);
}

static void changed(void *of)
{
    studio *s = of;
    render_worker_wake(s->p);
}

static void open_studio(studio *s, scene *first)
{
    *s = (studio){.lock = PTHREAD_MUTEX_INITIALIZER};
    diagnostic why = {0};
    worked(scene_document_create(first, "ball.yaml", NULL, changed, s, &s->d, &why), &why);
    const render_worker_listener listener = {take_image, on_state, s};
    worked(render_worker_create(s->d, isa_best(), &listener, &s->p, &why), &why);
}

static void close_studio(studio *s)
{
    render_worker_end(s->p);
    render_worker_destroy(s->p);
    scene_document_destroy(s->d);
    assert_int_equal(s->passes_after_final, 0);
}

static status set_one(void *of, scene *s, diagnostic *why)
{
    return scene_set_assignment(s, of, why);
}

static void apply(studio *s, const char *assignment)
{
    diagnostic why = {0};
    worked(scene_document_apply(s->d, assignment, NULL, set_one, (void *)(uintptr_t)assignment, NULL, &why), &why);
}

static uint64_t final_film(studio *s)
{
    const shared_image *shown;
    diagnostic why = {0};
    worked(render_worker_wait_for_final(s->p, 600.0, &shown, &why), &why);
    assert_true(shown->final);
    assert_int_equal(shown->generation, scene_document_generation(s->d));
    assert_non_null(shown->rendered);
    assert_int_equal(shown->width, shown->full_width);
    const uint64_t hash = shown->film_hash;
    shared_image_release(shown);
    return hash;
}

static uint64_t film_of(scene *s)
{
    diagnostic why = {0};
    renderer *r;
    render_result *made;
    worked(renderer_create(isa_best(), NULL, &r, &why), &why);
    worked(scene_load(s, &why), &why);
    worked(renderer_render(r, s, NULL, &made, &why), &why);
    const uint64_t hash = film_hash(made->img);
    render_result_destroy(made);
    renderer_destroy(r);
    scene_destroy(s);
    return hash;
}

static void the_final_image_is_the_film_of_the_scene(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, rod_scene("render.depth=8"));
    assert_int_equal(final_film(&s), 0x804d2c54dfedd082);
    apply(&s, "render.depth=4");
    assert_int_equal(final_film(&s), 0xb92bb012fd9c5f71);
    apply(&s, "liquid.ior=1.5");
    assert_int_equal(final_film(&s), film_of(rod_scene("liquid.ior=1.5")));
    close_studio(&s);
}

static void coarse_passes_come_first_and_leave_the_film_unchanged(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, rod_scene("render.width=400 render.height=300 render.samples=16"));
    assert_int_equal(final_film(&s), film_of(rod_scene("render.width=400 render.height=300 render.samples=16")));
    assert_true(s.images >= 2);
    close_studio(&s);
}

static void the_last_of_many_changes_wins(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, rod_scene("render.width=320 render.height=240"));
    for (int i = 0; i < 1000; i++) {
        char text[32];
        snprintf(text, sizeof text, "liquid.ior=%.3f", 1.0 + i * 0.001);
        apply(&s, text);
    }
    assert_int_equal(final_film(&s), film_of(rod_scene("render.width=320 render.height=240 liquid.ior=1.999")));
    close_studio(&s);
}

/* Two changes without a pause are a drag: its finer passes wait for 0.15 s, which the first passes may use. On a busy
 * machine there may be a pause, and other changes follow. */
static void finer_passes_wait_until_a_drag_rests(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, rod_scene("render.width=400 render.height=300 render.samples=16"));
    final_film(&s);
    double began_s, changed_s;
    do {
        began_s = clock_wall_s();
        apply(&s, "liquid.ior=1.4");
        changed_s = clock_wall_s();
        apply(&s, "liquid.ior=1.5");
    } while (clock_wall_s() - began_s > 0.2); /* a pause of 0.25 s ends a drag */
    final_film(&s);
    close_studio(&s);
    assert_true(s.finer_s >= changed_s + 0.15);
}

static void errors_are_reported_and_cleared(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, scene_from(BALL_SCENE));
    final_film(&s);
    apply(&s, "background.image=/nowhere/sky.png");
    const shared_image *shown;
    diagnostic why = {0};
    assert_int_equal(render_worker_wait_for_final(s.p, 600.0, &shown, &why), STATUS_BAD_INPUT);
    assert_null(shown);
    assert_non_null(strstr(why.what, "background.image"));
    json_t *json = json_object();
    assert_true(render_worker_json(s.p, json));
    assert_true(json_is_object(json_object_get(json, "trouble")));
    json_decref(json);
    assert_int_equal(scene_document_undo(s.d, false, NULL, NULL), STATUS_OK);
    final_film(&s);
    apply(&s, "lamp.color=1000,1000,1000");
    apply(&s, "lamp.intensity=10000"); /* brighter than a film can store: detected while rendering */
    apply(&s, "ball.transparency=0");
    assert_int_equal(render_worker_wait_for_final(s.p, 600.0, &shown, &why), STATUS_BAD_INPUT);
    close_studio(&s);
}

/* A lack of open files ends, but the scene does not change: whoever asks later has it loaded again. */
static void a_lack_of_the_machine_is_forgotten(void **state)
{
    (void)state;
    studio s;
    struct rlimit usual;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &usual), 0);
    open_studio(&s, scene_from(BALL_SCENE));
    final_film(&s);
    const struct rlimit few = {3, usual.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &few), 0);
    apply(&s, "background.image=experiments/scenes/chequer.png");
    const shared_image *shown;
    diagnostic why = {0}, later = {0};
    const status refused = render_worker_wait_for_final(s.p, 600.0, &shown, &why),
                 again = render_worker_wait_for_final(s.p, 600.0, &shown, &later);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &usual), 0);
    assert_int_equal(refused, STATUS_FAILURE);
    assert_int_equal(again, STATUS_FAILURE);
    assert_non_null(strstr(why.remedy, "open files"));
    final_film(&s);
    close_studio(&s);
}

static void nothing_is_rendered_while_suspended(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, scene_from(BALL_SCENE));
    final_film(&s);
    render_worker_suspend(s.p, "a study is measuring");
    apply(&s, "ball.ior=1.7");
    const shared_image *shown;
    diagnostic why = {0};
    assert_int_equal(render_worker_wait_for_final(s.p, 600.0, &shown, &why), STATUS_INTERRUPTED);
    assert_non_null(strstr(why.what, "a study is measuring"));
    shown = render_worker_newest(s.p);
    assert_int_equal(shown->generation, 1);
    shared_image_release(shown);
    render_worker_suspend(s.p, NULL);
    final_film(&s);
    close_studio(&s);
}

static void *wait_for_final(void *of)
{
    studio *s = of;
    const shared_image *shown;
    diagnostic why;
    const status code = render_worker_wait_for_final(s->p, 600.0, &shown, &why);
    shared_image_release(shown);
    return (void *)(intptr_t)code;
}

static void ending_the_worker_ends_all_waits(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, rod_scene("render.integrator=path render.paths=1024 render.width=1600 render.height=1200"));
    pthread_t waiting;
    assert_int_equal(pthread_create(&waiting, NULL, wait_for_final, &s), 0);
    render_worker_end(s.p); /* during a frame that takes minutes */
    void *code;
    pthread_join(waiting, &code);
    assert_int_equal((intptr_t)code, STATUS_INTERRUPTED);
    render_worker_destroy(s.p);
    scene_document_destroy(s.d);
}

static void assert_whole(const pass_plan *plan)
{
    assert_in_range(plan->count, 1, PASSES_MAX);
    assert_int_equal(plan->shrink[plan->count - 1], 1);
    assert_false(plan->single[plan->count - 1]);
    for (int i = 1; i < plan->count; i++)
        assert_true(plan->shrink[i] < plan->shrink[i - 1] || (plan->single[i - 1] && !plan->single[i]));
}

static void passes_fit_the_available_time(void **state)
{
    (void)state;
    const render_settings fast = {.width = 800, .height = 600, .samples = 1};
    const render_settings slow = {
        .width = 4000, .height = 3000, .samples = 64, .integrator = INTEGRATOR_PATH, .paths = 256};
    pass_plan plan = passes_plan(&fast, 480000 / 0.03, 0.04); /* a frame takes 0.03 s */
    assert_int_equal(plan.count, 1);
    plan = passes_plan(&fast, 480000 / 0.5, 0.04);
    assert_whole(&plan);
    assert_true(passes_work(&fast, plan.shrink[0], plan.single[0]) / (480000 / 0.5) <= 0.04);
    assert_int_equal(plan.shrink[0], 4);
    for (double rate = 1; rate < 1e9; rate *= 7) {
        plan = passes_plan(&slow, rate, 0.04);
        assert_whole(&plan);
    }
    plan = passes_plan(&slow, 0.0, 0.04);
    assert_whole(&plan);
    const render_settings odd = {.width = 801, .height = 1, .samples = 4};
    const render_settings pass = passes_settings(&odd, 8, true);
    assert_int_equal(pass.width, 101);
    assert_int_equal(pass.height, 1);
    assert_int_equal(pass.samples, 1);
}

/* The load is long enough to check for interruptions. */
static void a_slowly_loading_scene_is_rendered(void **state)
{
    (void)state;
    studio s;
    open_studio(
        &s,
        scene_from("render: {width: 8, height: 8}\n"
                   "camera: {position: [0, 0, -5], target: [0, 0, 0]}\n"
                   "meshes:\n"
                   "  toy: {generate: slime, level: 3, position: [0, 0, 0], ground_y: -1, dt_s: 0.0005, time_s: 1}\n"
                   "solids:\n"
                   "  body: {shape: mesh, mesh: toy}\n"));
    final_film(&s);
    close_studio(&s);
}

#define SLIME_SCENE(time_s)                                                                       \
    "render: {width: 8, height: 8}\n"                                                             \
    "camera: {position: [0, 0, -5], target: [0, 0, 0]}\n"                                         \
    "meshes:\n"                                                                                   \
    "  toy: {generate: slime, level: 2, position: [0, 0, 0], ground_y: -1, time_s: " time_s "}\n" \
    "solids:\n"                                                                                   \
    "  body: {shape: mesh, mesh: toy}\n"

/* Waits until the program is idle; with retries, because other processes may delay it. */
static bool comes_to_rest(void)
{
    enum { LOOKS = 100 };
    const struct timespec while_away = {.tv_nsec = 100000000};
    for (int i = 0; i < LOOKS; i++) {
        const double cpu_s = clock_process_cpu_s();
        nanosleep(&while_away, NULL);
        if (clock_process_cpu_s() - cpu_s < 0.02)
            return true;
    }
    return false;
}

static void an_unrenderable_scene_leaves_the_worker_idle(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, scene_from(SLIME_SCENE("0")));
    final_film(&s);
    apply(&s, "background.image=/nowhere/sky.png");
    const shared_image *shown;
    diagnostic why = {0};
    assert_int_equal(render_worker_wait_for_final(s.p, 600.0, &shown, &why), STATUS_BAD_INPUT);
    assert_true(comes_to_rest());
    live_send(render_worker_live(s.p), LIVE_PAUSE); /* a command is executed even then */
    assert_true(comes_to_rest());
    close_studio(&s);
}

/* Each change interrupts a load of hours; no load runs to its end. */
static void long_loads_do_not_delay_newer_changes(void **state)
{
    (void)state;
    enum { CHANGES = 60 };
    const struct timespec as_a_hand_drags = {.tv_nsec = 10000000};
    studio s;
    open_studio(&s, scene_from(SLIME_SCENE("80000")));
    for (int i = 0; i < CHANGES; i++) {
        char text[48];
        snprintf(text, sizeof text, "toy.damping=%g", 0.04 + 0.01 * (i % 2));
        apply(&s, text);
        nanosleep(&as_a_hand_drags, NULL);
    }
    apply(&s, "toy.time_s=0");
    final_film(&s);
    close_studio(&s);
}

typedef struct reader {
    studio *s;
    atomic_bool *ends;
    int reads, unloaded;
} reader;

static status check_meshes(void *of, scene *s, diagnostic *why)
{
    (void)why;
    reader *l = of;
    l->reads++;
    for (size_t i = 0; i < s->mesh_count; i++)
        l->unloaded += s->meshes[i].data == NULL;
    return STATUS_OK;
}

static void *read_repeatedly(void *of)
{
    reader *l = of;
    diagnostic why;
    while (!atomic_load(l->ends))
        render_worker_with_scene(l->s->p, check_meshes, l, &why);
    return NULL;
}

/* Threads that read without pause delay no change and never get an unloaded scene. */
static void readers_get_only_loaded_scenes(void **state)
{
    (void)state;
    enum { READERS = 6 };
    const int changes = trials_of(300);
    static const char ring[] = "render: {width: 8, height: 8}\ncamera: {position: [0, 0, -5], target: [0, 0, 0]}\n"
                               "meshes: {ring: {generate: torus}}\nsolids: {body: {shape: mesh, mesh: ring}}\n";
    studio s;
    atomic_bool ends = false;
    pthread_t thread[READERS];
    reader readers[READERS];
    open_studio(&s, scene_from(ring));
    final_film(&s);
    for (int i = 0; i < READERS; i++) {
        readers[i] = (reader){.s = &s, .ends = &ends};
        assert_int_equal(pthread_create(&thread[i], NULL, read_repeatedly, &readers[i]), 0);
    }
    for (int i = 0; i < changes; i++) {
        const shared_image *shown;
        diagnostic why;
        char text[48];
        apply(&s, "background.image=/nowhere/sky.png");
        snprintf(text, sizeof text, "ring.major=%d", 2 + i % 7);
        apply(&s, text);
        assert_int_equal(render_worker_wait_for_final(s.p, 600.0, &shown, &why), STATUS_BAD_INPUT);
        apply(&s, "background.kind=uniform");
        final_film(&s);
    }
    atomic_store(&ends, true);
    for (int i = 0; i < READERS; i++) {
        pthread_join(thread[i], NULL);
        assert_int_equal(readers[i].unloaded, 0);
        assert_true(readers[i].reads > 0);
    }
    close_studio(&s);
}

/* Also when the slime is switched off before it has moved, while something else is loaded. */
static void a_formerly_live_slime_is_loaded(void **state)
{
    (void)state;
    enum { TURNS = 20 };
    static const char toys[] = "render: {width: 8, height: 8}\ncamera: {position: [0, 0, -5], target: [0, 0, 0]}\n"
                               "meshes:\n  toy: {generate: slime, level: 2, ground_y: -1, time_s: 0.001}\n  ring: "
                               "{generate: torus, around: 500, tube: 100}\n"
                               "solids:\n  body: {shape: mesh, mesh: toy}\n  hoop: {shape: mesh, mesh: ring}\n";
    const struct timespec a_moment = {.tv_nsec = 2000000};
    studio s;
    open_studio(&s, scene_from(toys));
    live *live_slime = render_worker_live(s.p);
    final_film(&s);
    for (int i = 0; i < TURNS; i++) {
        render_worker_suspend(s.p, "a change comes");
        apply(&s, i % 2 ? "ring.major=3" : "ring.major=4");
        apply(&s, i % 2 ? "toy.time_s=0.002" : "toy.time_s=0.003");
        live_send(live_slime, LIVE_PLAY);
        render_worker_suspend(s.p, NULL);
        nanosleep(&a_moment, NULL);
        live_send(live_slime, LIVE_OFF);
        final_film(&s);
    }
    render_worker_end(s.p);
    render_worker_destroy(s.p);
    scene_document_destroy(s.d);
}

/* The adaptive resolution settles quickly, at the finest step that the time allows, without
 * oscillation. */

static const double wanted_s = 0.03;

/* full_s: the time of a frame at full resolution. */
static int settle(adaptive_resolution *p, double full_s, int frames)
{
    for (int i = 0; i < frames; i++)
        adaptive_resolution_update(p, full_s / (adaptive_resolution_divisor(p) * adaptive_resolution_divisor(p)),
                                   wanted_s);
    return adaptive_resolution_divisor(p);
}

static void the_resolution_settles_at_the_finest_step_that_the_time_allows(void **state)
{
    (void)state;
    static const double full_s[] = {0.001, 0.02, 0.05, 0.1, 0.3, 1.0, 3.0};
    for (size_t i = 0; i < sizeof full_s / sizeof *full_s; i++)
        for (int first = 0; first < 8; first += 7) {
            adaptive_resolution p = {.step = first};
            const int shrink = settle(&p, full_s[i], 60);
            assert_true(full_s[i] / (shrink * shrink) <= 1.3 * wanted_s);
            assert_true(shrink == 1 || full_s[i] / (shrink * shrink) > 0.1 * wanted_s);
            for (int k = 0; k < 100; k++)
                assert_int_equal(settle(&p, full_s[i], 1), shrink);
        }
}

static void the_resolution_has_limits(void **state)
{
    (void)state;
    adaptive_resolution p = {.step = 3};
    assert_int_equal(settle(&p, 1e6, 100), 16);
    assert_int_equal(settle(&p, 0.0, 1000), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_final_image_is_the_film_of_the_scene),
        cmocka_unit_test(coarse_passes_come_first_and_leave_the_film_unchanged),
        cmocka_unit_test(the_last_of_many_changes_wins),
        cmocka_unit_test(finer_passes_wait_until_a_drag_rests),
        cmocka_unit_test(errors_are_reported_and_cleared),
        cmocka_unit_test(a_lack_of_the_machine_is_forgotten),
        cmocka_unit_test(nothing_is_rendered_while_suspended),
        cmocka_unit_test(ending_the_worker_ends_all_waits),
        cmocka_unit_test(a_slowly_loading_scene_is_rendered),
        cmocka_unit_test(an_unrenderable_scene_leaves_the_worker_idle),
        cmocka_unit_test(long_loads_do_not_delay_newer_changes),
        cmocka_unit_test(readers_get_only_loaded_scenes),
        cmocka_unit_test(a_formerly_live_slime_is_loaded),
        cmocka_unit_test(passes_fit_the_available_time),
        cmocka_unit_test(the_resolution_settles_at_the_finest_step_that_the_time_allows),
        cmocka_unit_test(the_resolution_has_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
