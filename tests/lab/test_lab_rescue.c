/* Tests of web/session/session.h: a laboratory that is killed leaves its unsaved scene, and the next one offers it; a
 * saved, clean or discarded one leaves nothing; a disk that fails is reported and stops nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/cancel.h"
#include "base/os_process.h"
#include "lab_study_fixture.h"
#include "measure/clock.h"
#include "web/document/kept_scenes.h"
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <utime.h>

/* A folder of scenes and the folder of kept ones; removed at the end of each test. */
typedef struct place {
    char scenes[64], kept[80];
} place;

static int make_place(void **state)
{
    place *p = calloc(1, sizeof *p);
    snprintf(p->scenes, sizeof p->scenes, "/tmp/cuvette-lab-XXXXXX");
    assert_non_null(mkdtemp(p->scenes));
    snprintf(p->kept, sizeof p->kept, "%s.state/cuvette", p->scenes);
    lab_room room = {.lab = NULL};
    snprintf(room.folder, sizeof room.folder, "%s", p->scenes);
    room_write(&room, "scene.yaml", BALL_SCENE);
    *state = p;
    return 0;
}

static int remove_place(void **state)
{
    place *p = *state;
    room_remove(p->scenes);
    *strrchr(p->kept, '/') = 0;
    room_remove(p->kept);
    free(p);
    return 0;
}

/* The laboratory borrows the room's texts. */
static void begin_in(lab_room *room, const char *scenes, const char *kept, const char *file)
{
    snprintf(room->folder, sizeof room->folder, "%s", scenes);
    room_start(room, file, (lab_settings){.rescue = kept});
}

static void begin(lab_room *room, const place *p, const char *file)
{
    begin_in(room, p->scenes, p->kept, file);
}

/* The number of kept scenes, and the path of the last; "" if the folder is missing. */
static int count_kept(const place *p, char path[512])
{
    int count = 0;
    DIR *files = opendir(p->kept);
    for (const struct dirent *one; files && (one = readdir(files));)
        if (strncmp(one->d_name, "unsaved-", 8) == 0) {
            count++;
            if (path)
                snprintf(path, 512, "%s/%s", p->kept, one->d_name);
        }
    if (files)
        closedir(files);
    return count;
}

static void wait_for_kept(const place *p, int count)
{
    while (count_kept(p, NULL) != count)
        usleep(10000);
}

/* Whether one of them has the words. */
static bool kept_has(const place *p, const char *words)
{
    bool has = false;
    DIR *files = opendir(p->kept);
    for (const struct dirent *one; files && !has && (one = readdir(files));) {
        char *path = text_format("%s/%s", p->kept, one->d_name), *text = NULL;
        size_t size;
        if (strncmp(one->d_name, "unsaved-", 8) == 0 && file_read(path, 1 << 20, &text, &size, NULL) == STATUS_OK)
            has = strstr(text, words) != NULL;
        free(text);
        free(path);
    }
    if (files)
        closedir(files);
    return has;
}

static void wait_for_words(const place *p, const char *words)
{
    while (!kept_has(p, words))
        usleep(10000);
}

static void set(const lab_room *room, const char *values)
{
    char *body = text_format("{\"set\": {%s}}", values);
    room_post(room, "/api/set", body);
    free(body);
}

static char *ior_of(const lab_room *room)
{
    char *text = client_ask(room->server, "GET", "/api/scene.yaml", "", NULL), *at = strstr(text, "ior:");
    char *value = at ? strndup(at + 5, strcspn(at + 5, "\n")) : strdup("");
    free(text);
    return value;
}

static void assert_ior(const lab_room *room, const char *expected)
{
    char *value = ior_of(room);
    assert_string_equal(value, expected);
    free(value);
}

/* The offers; the caller releases them. */
static json_t *offers_of(const lab_room *room, size_t count)
{
    json_t *state = room_get(room, "/api/state"), *offers = json_incref(json_object_get(state, "rescued"));
    json_decref(state);
    assert_int_equal(json_array_size(offers), count);
    return offers;
}

static const char *offer_text(const json_t *offers, size_t at, const char *key)
{
    return json_string_value(json_object_get(json_array_get(offers, at), key));
}

static char *order(const json_t *offers, size_t at, const char *action)
{
    return text_format("{\"action\": \"%s\", \"id\": \"%s\"}", action, offer_text(offers, at, "id"));
}

/* A laboratory in another process, with a change that it has kept; killed by the caller. */
static pid_t begin_elsewhere(const place *p, const char *file, const char *values, const char *words)
{
    int ready[2];
    assert_int_equal(pipe(ready), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        lab_room room;
        begin(&room, p, file);
        set(&room, values);
        wait_for_words(p, words);
        (void)!write(ready[1], "+", 1);
        for (;;)
            pause();
    }
    char byte = 0;
    close(ready[1]);
    assert_int_equal(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    return child;
}

static void kill_it(pid_t child)
{
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, NULL, 0), child);
}

static void assert_private(const place *p)
{
    struct stat about;
    char path[512];
    assert_int_equal(stat(p->kept, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0700);
    assert_int_equal(count_kept(p, path), 1);
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0600);
}

static void a_killed_laboratory_loses_nothing(void **state)
{
    const place *p = *state;
    const pid_t child = begin_elsewhere(p, "scene.yaml", "\"ball.ior\": 1.7", "ior: 1.7");
    assert_private(p);
    lab_room second;
    begin(&second, p, NULL); /* while the first runs, its scene is its own */
    json_decref(offers_of(&second, 0));
    set(&second, "\"camera.fov_deg\": 41");
    wait_for_kept(p, 2);
    lab_stop(second.lab);
    assert_int_equal(count_kept(p, NULL), 1);

    kill_it(child);
    lab_room room;
    begin(&room, p, "scene.yaml");
    json_t *offers = offers_of(&room, 1);
    assert_string_equal(offer_text(offers, 0, "title"), "Ball");
    assert_string_equal(offer_text(offers, 0, "file"), "scene.yaml");
    assert_int_equal(strlen(offer_text(offers, 0, "time")), strlen("2026-11-26T03:47:38Z"));
    char *open = order(offers, 0, "open");
    assert_ior(&room, "1.5");
    room_post(&room, "/api/rescue", open);
    assert_ior(&room, "1.7");
    free(room_refused(&room, "POST", "/api/rescue", open, 400)); /* it is offered once */
    json_decref(offers_of(&room, 0));
    json_t *now = room_get(&room, "/api/state");
    assert_string_equal(json_string_value(json_object_get(now, "file")), "scene.yaml");
    assert_true(json_is_false(json_object_get(now, "saved")));
    assert_string_equal(json_string_value(json_object_get(now, "undo")), "open a rescued scene");
    json_decref(now);
    wait_for_kept(p, 1); /* the rescued scene is unsaved again */
    wait_for_words(p, "ior: 1.7");
    room_post(&room, "/api/undo", "{}");
    assert_ior(&room, "1.5");
    room_post(&room, "/api/redo", "{}");
    room_post(&room, "/api/save", "{\"file\": \"scene.yaml\", \"replace\": true}");
    wait_for_kept(p, 0);
    lab_stop(room.lab);
    free(open);
    json_decref(offers);
}

static void a_rescued_scene_survives_a_second_kill(void **state)
{
    const place *p = *state;
    kill_it(begin_elsewhere(p, NULL, "\"camera.fov_deg\": 37", "fov_deg: 37"));
    lab_room room;
    begin(&room, p, NULL);
    json_t *offers = offers_of(&room, 1);
    assert_true(json_is_null(json_object_get(json_array_get(offers, 0), "file")));
    lab_leave_unsaved(room.lab);
    lab_stop(room.lab); /* not opened, not discarded: it is offered again */
    json_decref(offers);
    kill_it(begin_elsewhere(p, "scene.yaml", "\"ball.ior\": 1.8", "ior: 1.8"));
    wait_for_kept(p, 2);
    begin(&room, p, NULL);
    offers = offers_of(&room, 2);
    for (size_t i = 0; i < 2; i++) {
        char *body = order(offers, i, "discard");
        json_decref(room_ask(&room, "POST", "/api/rescue", body, 200));
        free(body);
    }
    json_decref(offers);
    assert_int_equal(count_kept(p, NULL), 0);
    lab_stop(room.lab);
}

static void a_clean_end_leaves_nothing_unless_told_to(void **state)
{
    const place *p = *state;
    lab_room room;
    begin(&room, p, "scene.yaml");
    set(&room, "\"ball.ior\": 1.6");
    wait_for_kept(p, 1);
    lab_stop(room.lab);
    assert_int_equal(count_kept(p, NULL), 0);
    begin(&room, p, "scene.yaml");
    set(&room, "\"ball.ior\": 1.6");
    wait_for_kept(p, 1);
    set(&room, "\"ball.ior\": 1.9"); /* within the same second */
    cancel_token sigterm = {.ask = NULL};
    cancel_begin(&sigterm);
    cancel_set(&sigterm); /* the program's, whose main thread ends the laboratory */
    lab_leave_unsaved(room.lab);
    lab_stop(room.lab);
    cancel_end(&sigterm);
    assert_true(kept_has(p, "ior: 1.9"));
}

static void what_is_in_a_file_is_not_kept(void **state)
{
    const place *p = *state;
    lab_room room;
    begin(&room, p, "scene.yaml");
    room_post(&room, "/api/camera", "{\"orbit\": [10, 0]}");
    room_post(&room, "/api/open", "{\"new\": true}");
    usleep(300000);
    assert_int_equal(count_kept(p, NULL), 0);
    lab_stop(room.lab);
    assert_int_equal(access(p->kept, F_OK), -1); /* not even the folder */
}

static void changes_are_written_once_a_second(void **state)
{
    const place *p = *state;
    struct stat before, after;
    char path[512];
    int files = 1;
    lab_room room;
    begin(&room, p, "scene.yaml");
    set(&room, "\"ball.ior\": 1.6");
    wait_for_kept(p, 1);
    count_kept(p, path);
    assert_int_equal(stat(path, &before), 0);
    const double began_s = clock_wall_s();
    char value[32], last[32];
    for (int i = 0; i < 100 || files < 3; i++) { /* two seconds, or until it has been written twice more */
        snprintf(value, sizeof value, "\"ball.ior\": 1.%d", 60000 + i);
        snprintf(last, sizeof last, "ior: 1.%d", 60000 + i);
        set(&room, value);
        usleep(20000);
        if (stat(path, &after) == 0 && after.st_ino != before.st_ino)
            files++;
        before = after;
    }
    assert_true(files <= clock_wall_s() - began_s + 2);
    wait_for_words(p, last);
    lab_stop(room.lab);
}

static char *unkept(const lab_room *room)
{
    json_t *state = room_get(room, "/api/state");
    const json_t *trouble = json_object_get(state, "unkept");
    char *text = json_is_null(trouble) ? NULL
                                       : text_format("%s: %s; %s", json_string_value(json_object_get(trouble, "file")),
                                                     json_string_value(json_object_get(trouble, "error")),
                                                     json_string_value(json_object_get(trouble, "remedy")));
    json_decref(state);
    return text;
}

static void wait_for_unkept(const lab_room *room, const char *words)
{
    char *text = unkept(room);
    while (!text == (words != NULL)) {
        usleep(10000);
        free(text);
        text = unkept(room);
    }
    if (words && !strstr(text ? text : "", words))
        fail_msg("expected %s, got %s", words, text);
    assert_true(words || !text);
    free(text);
}

/* Root may write anywhere, but not below a file. */
static void an_unwritable_folder_is_reported(void **state)
{
    const place *p = *state;
    char *below_file = text_format("%s/scene.yaml/cuvette", p->scenes);
    const struct {
        const char *folder, *words;
    } bad[] = {
        {below_file, "/scene.yaml: cannot make the folder: Not a directory; save the scene, or set XDG_STATE_HOME"},
        {"", "there is no folder in which to keep unsaved changes; set HOME or XDG_STATE_HOME"},
        {"/tmp", "/tmp: the folder belongs to another user, or another user can write to it; make it yours"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        lab_room room;
        begin_in(&room, p->scenes, bad[i].folder, "scene.yaml");
        char *none = unkept(&room);
        assert_null(none); /* nothing is unsaved yet */
        set(&room, "\"ball.ior\": 1.6");
        wait_for_unkept(&room, bad[i].words);
        set(&room, "\"ball.ior\": 1.7");
        assert_ior(&room, "1.7");
        free(room_film(&room));
        room_post(&room, "/api/save", "{\"file\": \"other.yaml\", \"replace\": true}");
        wait_for_unkept(&room, NULL); /* nothing is unsaved any more */
        lab_stop(room.lab);
    }
    free(below_file);
}

static void a_full_disk_is_reported_until_it_has_room(void **state)
{
    const place *p = *state;
    struct rlimit own;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &own), 0);
    os_signals_as_errors();
    lab_room room;
    begin(&room, p, "scene.yaml");
    set(&room, "\"ball.ior\": 1.6");
    wait_for_words(p, "ior: 1.6");
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){100, own.rlim_max}), 0);
    set(&room, "\"ball.ior\": 1.7");
    wait_for_unkept(&room, "cannot write: File too large; raise the limit on file size");
    assert_true(kept_has(p, "ior: 1.6")); /* the older file is whole */
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &own), 0);
    set(&room, "\"ball.ior\": 1.8");
    wait_for_unkept(&room, NULL);
    wait_for_words(p, "ior: 1.8");
    lab_stop(room.lab);
}

static void nothing_is_written_while_a_study_measures(void **state)
{
    const place *p = *state;
    lab_room room;
    begin(&room, p, "scene.yaml");
    room_write(&room, "tiny.study", ENDLESS);
    json_decref(room_ask(&room, "POST", "/api/studies/tiny/run", "{}", 200));
    wait_for_rows(&room, 1);
    set(&room, "\"ball.ior\": 1.6");
    usleep(1300000);
    assert_int_equal(count_kept(p, NULL), 0);
    json_decref(room_ask(&room, "POST", "/api/studies/tiny/stop", "{}", 200));
    json_decref(wait_for_end(&room));
    wait_for_words(p, "ior: 1.6");
    lab_stop(room.lab);
}

/* --- the folder --- */

static void write_kept(const place *p, const char *name, const char *text)
{
    char *path = text_format("%s/%s", p->kept, name);
    assert_int_equal(file_write(path, text, NULL), STATUS_OK);
    free(path);
}

static void write_old(const place *p, int day, const char *within, const char *rest)
{
    char name[64];
    char *text = text_format("# An unsaved scene of cuvette lab: {\"time\": \"2026-01-%02dT00:00:00Z\", \"title\": "
                             "\"%d\", \"folder\": \"%s\", \"file\": \"scene.yaml\"}\n%s",
                             day, day, within, rest);
    snprintf(name, sizeof name, "unsaved-00000000000000%02d.yaml", day);
    write_kept(p, name, text);
    free(text);
}

static bool exists(const place *p, const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", p->kept, name);
    return access(path, F_OK) == 0;
}

static void the_newest_are_kept_and_strange_files_left_alone(void **state)
{
    const place *p = *state;
    assert_int_equal(file_make_directory(p->kept, NULL), STATUS_OK);
    for (int day = 1; day <= KEPT_SCENES_MAX + 2; day++)
        write_old(p, (day * 7) % (KEPT_SCENES_MAX + 2) + 1, p->scenes, BALL_SCENE);
    write_kept(p, "unsaved-ffffffffffffffff.yaml", BALL_SCENE);
    write_kept(p, "notes.txt", "mine");
    write_kept(p, ".cuvette-1-0.part", "half");
    write_kept(p, ".cuvette-1-1.part", "half");
    char *old = text_format("%s/.cuvette-1-0.part", p->kept);
    assert_int_equal(utime(old, &(struct utimbuf){1000, 1000}), 0);
    free(old);
    lab_room room;
    begin(&room, p, NULL);
    json_t *offers = offers_of(&room, KEPT_SCENES_MAX);
    for (int i = 0; i < KEPT_SCENES_MAX; i++)
        assert_int_equal(atoi(offer_text(offers, (size_t)i, "title")), KEPT_SCENES_MAX + 2 - i);
    json_decref(offers);
    assert_int_equal(count_kept(p, NULL), KEPT_SCENES_MAX + 1);
    assert_true(exists(p, "notes.txt") && exists(p, "unsaved-ffffffffffffffff.yaml"));
    assert_true(exists(p, ".cuvette-1-1.part") && !exists(p, ".cuvette-1-0.part"));
    lab_stop(room.lab);
}

/* A laboratory reads no file outside its folder, and a damaged scene changes nothing. */
static void what_cannot_be_opened_stays(void **state)
{
    const place *p = *state;
    assert_int_equal(file_make_directory(p->kept, NULL), STATUS_OK);
    write_old(p, 1, "/tmp/cuvette-elsewhere", BALL_SCENE "textures:\n  wood: {file: wood.png}\n");
    write_old(p, 2, p->scenes, "solids: 7\n");
    lab_room room;
    begin(&room, p, "scene.yaml");
    json_t *offers = offers_of(&room, 2);
    assert_string_equal(offer_text(offers, 0, "file"), "scene.yaml");
    assert_string_equal(offer_text(offers, 1, "file"), "/tmp/cuvette-elsewhere/scene.yaml");
    static const char *const words[] = {"solids is not a map",
                                        "open it with: cuvette lab --folder /tmp/cuvette-elsewhere"};
    for (size_t i = 0; i < 2; i++) {
        char *open = order(offers, i, "open"), *text = room_refused(&room, "POST", "/api/rescue", open, 400);
        if (!strstr(text, words[i]))
            fail_msg("%s", text);
        free(open);
        free(text);
    }
    json_decref(offers);
    json_decref(offers_of(&room, 2));
    assert_ior(&room, "1.5");
    free(room_refused(&room, "POST", "/api/rescue", "{\"action\": \"open\", \"id\": \"none\"}", 400));
    free(room_refused(&room, "POST", "/api/rescue", "{\"action\": \"burn\", \"id\": \"none\"}", 400));
    free(room_refused(&room, "POST", "/api/rescue", "{\"action\": \"open\"}", 400));
    lab_stop(room.lab);
}

int main(void)
{
#define IN_A_PLACE(test) cmocka_unit_test_setup_teardown(test, make_place, remove_place)
    const struct CMUnitTest tests[] = {
        IN_A_PLACE(a_killed_laboratory_loses_nothing),
        IN_A_PLACE(a_rescued_scene_survives_a_second_kill),
        IN_A_PLACE(a_clean_end_leaves_nothing_unless_told_to),
        IN_A_PLACE(what_is_in_a_file_is_not_kept),
        IN_A_PLACE(changes_are_written_once_a_second),
        IN_A_PLACE(an_unwritable_folder_is_reported),
        IN_A_PLACE(a_full_disk_is_reported_until_it_has_room),
        IN_A_PLACE(nothing_is_written_while_a_study_measures),
        IN_A_PLACE(the_newest_are_kept_and_strange_files_left_alone),
        IN_A_PLACE(what_cannot_be_opened_stays),
    };
    return cmocka_run_group_tests_name("lab_rescue", tests, NULL, NULL);
}
