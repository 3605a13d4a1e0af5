/* Tests of the progress that a run of a study reports. */
#include "measure/clock.h"
#include "study/run/progress.h"
#include "study_fixture.h"
#include <pthread.h>

typedef struct watch {
    size_t calls, frames_done, images;
    bool stop, knew_left;
    pthread_t from;
} watch;

static void look(void *context, const study_frame_progress *now)
{
    watch *w = context;
    assert_true(pthread_equal(w->from, pthread_self()));
    assert_true(now->cell < 4);
    assert_true(now->share >= 0 && now->share <= 1);
    if (w->calls++ == 0) {
        assert_true(now->stage == STUDY_MEASURING);
        assert_true(isnan(now->left_s)); /* no estimate before the first frame */
        assert_int_equal(now->frames_done, 0);
        assert_int_equal(now->frames_all, 4 * 4000);
    }
    if (now->stage == STUDY_IMAGES) {
        assert_true(now->img >= 1 && now->img <= now->images);
        assert_int_equal(now->images, 4);
    } else {
        assert_int_equal(now->images, 0);
    }
    if (now->frames_done)
        assert_true(now->left_s >= 0);
    assert_true(now->frames_done >= w->frames_done && now->frames_done <= now->frames_all);
    w->frames_done = now->frames_done;
    w->images = now->images;
    w->knew_left |= now->left_s > 0;
}

static bool stop_when_known(void *context)
{
    const watch *w = context;
    return w->stop && w->knew_left;
}

/* The callback and the terminal get the same progress at the same time. */
static void the_callback_reports_the_progress_of_the_terminal(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(
        f,
        "study: test\nscene: scene.yaml\nset: {render.width: 200, render.height: 150}\nrepetitions: 4000\nwarmups: 0\n"
        "grid: [{render.depth: [0, 1, 2, 3]}]\nkeep: {image: on}\n");
    char *message = NULL;
    size_t size, ran = 0;
    FILE *terminal = open_memstream(&message, &size);
    watch w = {.stop = true, .from = pthread_self()};
    const study_options options = {.results = f->results, .progress = terminal, .progressed = look, .context = &w};
    assert_int_equal(fixture_run_until(stop_when_known, &w, s, &options, &ran, NULL), STATUS_INTERRUPTED);
    assert_true(w.calls >= 2 && w.frames_done > 0);
    assert_true(ran >= w.frames_done);
    fclose(terminal);
    char last[64];
    snprintf(last, sizeof last, "\rtest: %zu of 16000 frames, ", w.frames_done);
    assert_int_equal(fixture_count(message, "\rtest: "), w.calls);
    assert_non_null(strstr(message, "\rtest: 0 of 16000 frames, 0%"));
    assert_non_null(strstr(message, last));
    free(message);
    study_destroy(s);
}

static void count_calls(void *context, const study_frame_progress *now)
{
    size_t *calls = context;
    assert_true(now->share >= 0 && now->share <= 1);
    ++*calls;
}

/* Updates within a tenth of a second are not shown. */
static void progress_is_shown_ten_times_a_second(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    size_t calls = 0;
    const study_options options = {.results = f->results, .progressed = count_calls, .context = &calls};
    progress_display *line = progress_begin(s, &options);
    const double began_s = clock_wall_s();
    for (int i = 0; i < 10; i++)
        progress_show(line, 0.1 * i);
    const bool quick = clock_wall_s() - began_s < 0.1; /* nobody interrupted this process */
    assert_true(calls >= 1 && (!quick || calls == 1));
    usleep(110000);
    const size_t before = calls;
    progress_show(line, 1);
    assert_int_equal(calls, before + 1);
    progress_end(line);
    study_destroy(s);
}

/* Waits until the next update is shown. */
static void note_motion(void *context, const study_frame_progress *now)
{
    bool *moved = context;
    if (now->stage == STUDY_MOVING)
        *moved = true;
    else if (!*moved)
        usleep(110000);
}

static void moving_slimes_are_reported_as_progress(void **state)
{
    const fixture *f = *state;
    fixture_write(f, "slime.yaml",
                  "render: {width: 8, height: 6, depth: 0}\n"
                  "meshes: {toy: {generate: slime, level: 3, time_s: 1.5, ground: off}}\n"
                  "solids: {body: {shape: mesh, mesh: toy, diffuse: 0.7}}\n");
    study *s = fixture_study(f, "study: test\nscene: slime.yaml\nrepetitions: 1\nwarmups: 0\n");
    bool moved = false;
    const study_options options = {.results = f->results, .progressed = note_motion, .context = &moved};
    assert_int_equal(study_run(s, &options, NULL, NULL), STATUS_OK);
    assert_true(moved);
    study_destroy(s);
}

/* Only the kept images of a study with complete rows. */
static void kept_images_are_reported_as_progress(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(
        f, "study: test\nscene: scene.yaml\nrepetitions: 1\nwarmups: 0\ngrid: [{render.depth: [0, 1, 2, 3]}]\n");
    fixture_run(f, s);
    study_destroy(s);
    s = fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 1\nwarmups: 0\ngrid: [{render.depth: [0, 1, 2, "
                         "3]}]\nkeep: {image: on}\n");
    watch w = {.calls = 1, .from = pthread_self()};
    study_options options = {.results = f->results, .progressed = look, .context = &w};
    assert_int_equal(study_run(s, &options, NULL, NULL), STATUS_OK);
    assert_true(w.calls >= 2);
    assert_int_equal(w.images, 4);
    assert_int_equal(w.frames_done, 4);
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_callback_reports_the_progress_of_the_terminal, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(progress_is_shown_ten_times_a_second, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(moving_slimes_are_reported_as_progress, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(kept_images_are_reported_as_progress, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
