/* Tests of the job: stopping before, during and after a frame, refused scenes, the content of accounts, and equal films
 * for all callers of a job. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/budget.h"
#include "base/cancel.h"
#include "cuvette.h"
#include "job/job.h"
#include "render_fixture.h"
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static scene *small_scene(void)
{
    scene *s = scene_create();
    assert_non_null(s);
    s->render.width = 32, s->render.height = 24;
    return s;
}

static job *job_with(job_settings settings)
{
    job *j = NULL;
    diagnostic why = {.what = ""};
    worked(job_create(&settings, &j, &why), &why);
    return j;
}

typedef struct caller {
    cancel_token token;
    int calls, limit; /* the call that cancels */
    double share;
} caller;

/* As the ask of a token. */
static bool has_enough(void *context)
{
    caller *c = context;
    return ++c->calls >= c->limit;
}

/* Cancels from within the frame, as another thread would. */
static void cancel_soon(void *context, double fraction_done)
{
    caller *c = context;
    c->share = fraction_done;
    if (++c->calls == c->limit)
        cancel_set(&c->token);
}

static void a_cancelled_job_starts_no_work(void **state)
{
    (void)state;
    scene *s = small_scene();
    job *j = job_with((job_settings){.measured = true});
    job_account made;
    diagnostic why = {.what = ""};
    cancel_token token = {.ask = NULL};
    cancel_begin(&token);
    cancel_set(&token);
    assert_int_equal(job_load(j, s, NULL, &why), STATUS_INTERRUPTED);
    assert_int_equal(job_render(j, s, NULL, &made, &why), STATUS_INTERRUPTED);
    assert_null(made.result);
    assert_int_equal(made.count, 0);
    assert_false(made.complete);
    assert_string_equal(why.what, "interrupted");
    job_account_release(&made);
    cancel_clear(&token);
    assert_int_equal(job_render(j, s, NULL, &made, &why), STATUS_OK);
    cancel_end(&token);
    assert_true(made.complete);
    job_account_release(&made);
    job_destroy(j);
    scene_destroy(s);
}

/* Long enough that no machine finishes the frame before the first check. */
static scene *long_scene(void)
{
    scene *s = small_scene();
    s->render.width = s->render.height = 2048;
    s->render.samples = 64;
    return s;
}

static void a_frame_ends_when_it_is_cancelled(void **state)
{
    (void)state;
    scene *s = long_scene();
    job *j = job_with((job_settings){.measured = true});
    caller c = {.limit = 2};
    const render_options options = {.progress = cancel_soon, .progress_s = 0.001, .context = &c};
    job_account made;
    cancel_begin(&c.token);
    assert_int_equal(job_render(j, s, &options, &made, NULL), STATUS_INTERRUPTED);
    cancel_end(&c.token);
    assert_non_null(made.result); /* the unfinished frame */
    assert_false(made.complete);
    assert_int_equal(made.count, 0);
    assert_true(c.share < 1.0);
    assert_true(made.result->counters.camera < 2048u * 2048u * 64u);
    job_account_release(&made);
    job_destroy(j);
    scene_destroy(s);
}

static void a_token_is_asked_during_a_frame(void **state)
{
    (void)state;
    scene *s = long_scene();
    caller c = {.limit = 3, .token = {.ask = has_enough, .context = &c}};
    job *j = job_with((job_settings){.level = NULL});
    const render_options options = {.progress_s = 0.001};
    job_account made;
    cancel_begin(&c.token);
    assert_int_equal(job_render(j, s, &options, &made, NULL), STATUS_INTERRUPTED);
    cancel_end(&c.token);
    assert_int_equal(c.calls, 3);
    job_account_release(&made);
    job_destroy(j);
    scene_destroy(s);
}

/* Complete frames are kept when a later one is interrupted. */
static void end_in_the_third(void *context, double fraction_done)
{
    if (fraction_done >= 0.667)
        cancel_set(context);
}

static void finished_frames_are_kept(void **state)
{
    (void)state;
    scene *s = small_scene();
    job *j = job_with((job_settings){.measured = true});
    s->render.width = s->render.height = 512;
    s->render.samples = 16;
    cancel_token token = {.ask = NULL};
    const render_options options = {.progress = end_in_the_third, .progress_s = 0.0001, .context = &token};
    job_account made;
    cancel_begin(&token);
    assert_int_equal(job_repeat(j, s, 3, &options, &made, NULL), STATUS_INTERRUPTED);
    cancel_end(&token);
    assert_int_equal(made.count, 2);
    assert_false(made.complete);
    assert_int_equal(made.result->counters.camera, 512 * 512 * 16);
    assert_true(made.film_hash == film_hash(made.result->img));
    job_account_release(&made);
    job_destroy(j);
    scene_destroy(s);
}

static void expect_refusal(job_settings settings, scene *s, const render_options *options, status code,
                           const char *what)
{
    job *j = job_with(settings);
    job_account made;
    diagnostic why = {.what = ""};
    assert_int_equal(job_render(j, s, options, &made, &why), code);
    if (!strstr(why.what, what))
        fail_msg("'%s' is not about '%s'", why.what, what);
    assert_null(made.result);
    job_account_release(&made);
    scene *good = small_scene(); /* the job remains usable */
    assert_int_equal(job_render(j, good, NULL, &made, &why), STATUS_OK);
    job_account_release(&made);
    scene_destroy(good);
    job_destroy(j);
    scene_destroy(s);
}

static void invalid_scenes_are_refused(void **state)
{
    (void)state;
    scene *s = small_scene();
    s->camera.target = s->camera.position;
    s->camera.aimed = true;
    expect_refusal((job_settings){.measured = true}, s, NULL, STATUS_BAD_INPUT, "target");
}

/* Requests more threads than there is memory for their stacks: in a separate process with a limited address space. */
static int ask_for_too_many(void)
{
    scene *s = small_scene();
    job *j = job_with((job_settings){.measured = false});
    job_account made;
    diagnostic why = {.what = ""};
    struct rlimit room = {.rlim_cur = 256u << 20, .rlim_max = RLIM_INFINITY};
    s->render.threads = 1024;
    if (setrlimit(RLIMIT_AS, &room) != 0)
        return 1;
    if (job_render(j, s, NULL, &made, &why) != STATUS_BAD_INPUT || !strstr(why.what, "memory"))
        return 4;
    job_account_release(&made);
    memory_budget_set((uint64_t)1 << 40); /* as a user who knows better: then the system refuses */
    if (job_render(j, s, NULL, &made, &why) != STATUS_FAILURE || made.result || !strstr(why.what, "thread"))
        return 2;
    job_account_release(&made);
    s->render.threads = 2; /* the job continues with fewer threads */
    if (job_render(j, s, NULL, &made, &why) != STATUS_OK)
        return 3;
    job_account_release(&made);
    job_destroy(j);
    scene_destroy(s);
    return 0;
}

static void too_many_threads_are_an_error(void **state)
{
    (void)state;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    skip(); /* the sanitizers' shadow memory exceeds any limit */
#endif
    if (getenv("RUNNER"))
        skip(); /* valgrind's does too */
    int ended = 0;
    const pid_t child = fork();
    if (child == 0)
        _exit(ask_for_too_many());
    assert_true(child > 0 && waitpid(child, &ended, 0) == child);
    assert_true(WIFEXITED(ended));
    assert_int_equal(WEXITSTATUS(ended), 0);
}

static void limits_are_enforced(void **state)
{
    (void)state;
    const uint64_t sums = 32 * 24 * 3 * 8, map = 32 * 24 * 8;
    const render_options mapped = {.pixel_rays = true};
    job_account made;
    scene *s = small_scene();
    job *j = job_with((job_settings){.memory_bytes = sums});
    assert_int_equal(job_render(j, s, NULL, &made, NULL), STATUS_OK);
    job_account_release(&made);
    job_destroy(j);
    expect_refusal((job_settings){.memory_bytes = sums + map - 1}, s, &mapped, STATUS_BAD_INPUT, "quota");
    expect_refusal((job_settings){.time_s = 1e-9}, long_scene(), &(render_options){.progress_s = 0.001}, STATUS_FAILURE,
                   "not finished");
}

static void an_account_has_the_requested_measurements(void **state)
{
    (void)state;
    scene *s = small_scene();
    for (int measured = 0; measured < 2; measured++) {
        job *j = job_with((job_settings){.measured = measured, .fresh_peak = measured});
        job_account made;
        const render_options options = {.pixel_rays = true, .timeline = true};
        assert_int_equal(job_repeat(j, s, 2, &options, &made, NULL), STATUS_OK);
        assert_int_equal(made.count, 2);
        assert_non_null(made.result->pixel_rays); /* of a third, unmeasured frame */
        assert_true(made.result->event_count > 0);
        assert_true(made.of == s && made.level == job_isa(j) && made.ended_ms > 0);
        assert_int_equal(made.spent.peak_rss_bytes > 0, measured);
        assert_true(isnan(made.spent.wall_s) == !measured);
        assert_true(made.film_hash != 0);
        assert_true(job_account_hash(&made) == film_hash(made.result->img));
        job_account_release(&made);
        job_destroy(j);
    }
    scene_destroy(s);
}

/* Threads are pinned, and the machine's topology is read only for that. */
static void pinned_scenes_have_the_same_film(void **state)
{
    (void)state;
    scene *s = small_scene();
    job *j = job_with((job_settings){.measured = false});
    uint64_t hash[3];
    const pin_rule rules[] = {PIN_RULE_NONE, PIN_RULE_COMPACT, PIN_RULE_NONE};
    for (int i = 0; i < 3; i++) {
        job_account made;
        s->render.pin = rules[i];
        assert_int_equal(job_render(j, s, NULL, &made, NULL), STATUS_OK);
        hash[i] = job_account_hash(&made);
        job_account_release(&made);
    }
    assert_true(hash[0] == hash[1] && hash[1] == hash[2]);
    const topology *machine = NULL, *again = NULL;
    assert_int_equal(job_machine(j, &machine, NULL), STATUS_OK);
    assert_int_equal(job_machine(j, &again, NULL), STATUS_OK);
    assert_true(machine && machine == again);
    job_destroy(j);
    scene_destroy(s);
}

/* The engine's frame, the job's own, and one of a job that keeps meshes. */
static void all_callers_of_a_job_get_the_same_film(void **state)
{
    (void)state;
    const char *path = "experiments/scenes/models.yaml";
    cuvette_engine *engine;
    cuvette_scene *handle;
    cuvette_frame *frame;
    cuvette_diagnostic failure;
    assert_int_equal(cuvette_engine_create(NULL, &engine, &failure), CUVETTE_OK);
    assert_int_equal(cuvette_scene_read(path, &handle, &failure), CUVETTE_OK);
    assert_int_equal(cuvette_scene_set(handle, "render.width", "60", &failure), CUVETTE_OK);
    assert_int_equal(cuvette_scene_set(handle, "render.height", "40", &failure), CUVETTE_OK);
    assert_int_equal(cuvette_engine_render(engine, handle, NULL, &frame, &failure), CUVETTE_OK);
    for (int keeps = 0; keeps < 2; keeps++) {
        job *j = job_with((job_settings){.keeps_meshes = keeps, .measured = keeps});
        for (int times = 0; times < 2; times++) {
            scene *s;
            job_account made;
            diagnostic why = {.what = ""};
            worked(scene_read(path, &s, &why), &why);
            s->render.width = 60, s->render.height = 40;
            worked(job_load(j, s, NULL, &why), &why);
            worked(job_render(j, s, NULL, &made, &why), &why);
            assert_true(job_account_hash(&made) == cuvette_frame_hash(frame));
            job_account_release(&made);
            scene_destroy(s);
        }
        job_destroy(j);
    }
    cuvette_frame_destroy(frame);
    cuvette_scene_destroy(handle);
    cuvette_engine_destroy(engine);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cancelled_job_starts_no_work),
        cmocka_unit_test(a_frame_ends_when_it_is_cancelled),
        cmocka_unit_test(a_token_is_asked_during_a_frame),
        cmocka_unit_test(finished_frames_are_kept),
        cmocka_unit_test(invalid_scenes_are_refused),
        cmocka_unit_test(too_many_threads_are_an_error),
        cmocka_unit_test(limits_are_enforced),
        cmocka_unit_test(an_account_has_the_requested_measurements),
        cmocka_unit_test(pinned_scenes_have_the_same_film),
        cmocka_unit_test(all_callers_of_a_job_get_the_same_film),
    };
    return cmocka_run_group_tests_name("job", tests, NULL, NULL);
}
