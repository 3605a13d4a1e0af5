/* Studies in the laboratory, through its API: what there is, one that runs, is stopped and goes on, what was measured, and what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"
#include "study/csv.h"
#include "study/study.h"
#include "study/summary.h"
#include <errno.h>
#include <pthread.h>

#define TINY(repetitions)                                                                                                                                      \
    "study: tiny\ntitle: A tiny one\nscene: scene.yaml\nset: {render.width: 16, render.height: 12}\n"                                                         \
    "grid:\n  - {render.depth: [0, 1, 2]}\n  - {render.threads: [1, 2]}\nrepetitions: " repetitions "\nwarmups: 1\n"
enum { TINY_CELLS = 6 };
#define ENDLESS TINY("100000")

static int set_up(void **state)
{
    lab_room *room = calloc(1, sizeof *room);
    room_open(room, BALL_SCENE);
    *state = room;
    return 0;
}

static int tear_down(void **state)
{
    room_close(*state);
    free(*state);
    return 0;
}

static void make_folder(const lab_room *room, const char *name)
{
    char *path = room_path(room, name);
    assert_int_equal(mkdir(path, 0777), 0);
    free(path);
}

static char *read_text(const lab_room *room, const char *name)
{
    char *path = room_path(room, name), *text = NULL;
    size_t size;
    assert_int_equal(file_read(path, 64 << 20, &text, &size, NULL), STATUS_OK);
    free(path);
    return text;
}

static json_int_t number_at(const json_t *from, const char *key)
{
    const json_t *value = json_object_get(from, key);
    assert_true(json_is_integer(value));
    return json_integer_value(value);
}

static json_int_t rows_so_far(const lab_room *room)
{
    json_t *told = room_get(room, "/api/studies/tiny/rows?from=1000000");
    const json_int_t count = number_at(told, "count");
    assert_int_equal(json_array_size(json_object_get(told, "rows")), 0);
    json_decref(told);
    return count;
}

static void wait_for_rows(const lab_room *room, json_int_t count)
{
    while (rows_so_far(room) < count)
        ;
}

/* The state's part when it has ended. */
static json_t *wait_for_end(const lab_room *room)
{
    for (;;) {
        json_t *state = room_get(room, "/api/state"), *now = json_incref(json_object_get(state, "study"));
        json_decref(state);
        if (json_is_false(json_object_get(now, "running")))
            return now;
        json_decref(now);
    }
}

static void run_to_the_end(const lab_room *room)
{
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    json_t *ended = wait_for_end(room);
    assert_true(json_is_null(json_object_get(ended, "error")));
    json_decref(ended);
}

/* --- what there is --- */

static void studies_are_listed(void **state)
{
    const lab_room *room = *state;
    make_folder(room, "more");
    room_write(room, "tiny.study", TINY("3"));
    room_write(room, "more/broken.study", "study: broken\nscene: ../scene.yaml\ngrid: [{render.dept: [1, 2]}]\n");
    room_write(room, "twin.study", "study: tiny\nscene: scene.yaml\n");
    room_write(room, "nonsense.study", "[");
    json_t *told = room_get(room, "/api/studies"), *list = json_object_get(told, "studies");
    assert_string_equal(json_string_value(json_object_get(told, "results")), "results");
    assert_int_equal(json_array_size(list), 4);
    int seen = 0;
    for (size_t i = 0; i < 4; i++) {
        const json_t *one = json_array_get(list, i), *error = json_object_get(one, "error");
        const char *file = json_string_value(json_object_get(one, "file")), *name = json_string_value(json_object_get(one, "name"));
        const char *what = json_string_value(json_object_get(error, "error"));
        assert_true(json_is_false(json_object_get(one, "running")));
        if (strcmp(file, "more/broken.study") == 0) {
            assert_string_equal(name, "broken");
            assert_non_null(strstr(what, "dept"));
            assert_int_equal(number_at(error, "line"), 3);
            seen |= 1;
        } else if (strcmp(file, "nonsense.study") == 0) {
            assert_string_equal(name, "nonsense");
            assert_non_null(what);
            seen |= 2;
        } else if (error) {
            assert_string_equal(name, "tiny");
            assert_non_null(strstr(what, "this name too"));
            seen |= 4;
        } else {
            assert_string_equal(name, "tiny");
            assert_string_equal(json_string_value(json_object_get(one, "title")), "A tiny one");
            assert_int_equal(number_at(one, "cells"), TINY_CELLS);
            assert_int_equal(number_at(one, "cells_done"), 0);
            const json_t *axis = json_array_get(json_object_get(one, "axes"), 0);
            assert_string_equal(json_string_value(json_object_get(axis, "name")), "render.depth");
            assert_int_equal(number_at(axis, "count"), 3);
            seen |= 8;
        }
    }
    assert_int_equal(seen, 15);
    json_decref(told);
    told = room_get(room, "/api/studies/broken");
    assert_non_null(json_object_get(told, "error"));
    assert_true(json_is_null(json_object_get(told, "summary")));
    json_decref(told);
    free(room_refused(room, "POST", "/api/studies/broken/run", "{}", 400));
}

/* --- run, stop, go on --- */

/* Frames that carry cell and repetition twice would have been measured twice. */
static void count_cells(const lab_room *room, int counted[TINY_CELLS])
{
    char *path = room_path(room, "results/tiny/rows.csv");
    csv *table = NULL;
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    assert_int_equal(table->whole, table->size);
    bool *seen = calloc(TINY_CELLS * (table->row_count + 1), sizeof *seen);
    memset(counted, 0, TINY_CELLS * sizeof *counted);
    for (size_t i = 0; i < table->row_count; i++) {
        const size_t cell = (size_t)csv_field_real(table, i, csv_column(table, "cell"));
        const size_t repetition = (size_t)csv_field_real(table, i, csv_column(table, "repetition"));
        assert_true(cell < TINY_CELLS && repetition <= table->row_count);
        bool *place = &seen[cell * (table->row_count + 1) + repetition];
        assert_false(*place);
        *place = true;
        counted[cell] += csv_field_real(table, i, csv_column(table, "warmup")) == 0;
    }
    free(seen);
    csv_destroy(table);
    free(path);
}

static int open_events(const lab_room *room)
{
    const int fd = client_connect(http_port(room->server));
    char *request = text_format("GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n\r\n", http_port(room->server), http_token(room->server));
    client_send(fd, request, strlen(request));
    free(request);
    while (http_event_clients((http_server *)(uintptr_t)room->server) == 0)
        ;
    return fd;
}

/* The next event `study` that is so. */
static json_t *wait_for_event(int fd, bool (*is_so)(const json_t *))
{
    char line[65536];
    bool of_study = false;
    for (size_t size = 0;;) {
        assert_true(size < sizeof line - 1);
        ssize_t got;
        while ((got = recv(fd, line + size, 1, 0)) < 0 && errno == EINTR)
            ;
        if (got != 1)
            fail_msg("the stream ends: %s", strerror(errno));
        if (line[size] != '\n') {
            size++;
            continue;
        }
        line[size - (size && line[size - 1] == '\r')] = 0;
        size = 0;
        if (strncmp(line, "event: ", 7) == 0)
            of_study = strcmp(line, "event: study") == 0;
        if (!of_study || strncmp(line, "data: ", 6) != 0)
            continue;
        json_t *told = json_loads(line + 6, 0, NULL);
        assert_non_null(told);
        assert_string_equal(json_string_value(json_object_get(told, "name")), "tiny");
        if (is_so(told))
            return told;
        json_decref(told);
    }
}

static bool has_frames(const json_t *told)
{
    return json_is_true(json_object_get(told, "running")) && number_at(told, "frames_done") > 0;
}

static bool has_ended(const json_t *told)
{
    return json_is_false(json_object_get(told, "running"));
}

static void a_study_is_stopped_and_goes_on(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", ENDLESS);
    free(room_refused(room, "POST", "/api/studies/tiny/stop", "{}", 409));
    const int events = open_events(room);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    json_t *told = wait_for_event(events, has_frames);
    assert_int_equal(number_at(told, "frames_all"), TINY_CELLS * 100000);
    assert_true(json_is_number(json_object_get(told, "left_s")));
    assert_string_equal(json_string_value(json_object_get(told, "stage")), "measuring");
    json_decref(told);
    json_t *now = room_get(room, "/api/state");
    assert_string_equal(json_string_value(json_object_get(now, "waiting")), "a study measures: tiny");
    json_decref(now);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/stop", "{}", 200));
    told = wait_for_event(events, has_ended);
    assert_true(json_is_null(json_object_get(told, "error")));
    json_decref(told);
    close(events);
    json_decref(wait_for_end(room));

    int before[TINY_CELLS], after[TINY_CELLS], most = 0;
    count_cells(room, before);
    char *rows = read_text(room, "results/tiny/rows.csv");
    for (int i = 0; i < TINY_CELLS; i++)
        most = before[i] > most ? before[i] : most;
    char repetitions[32];
    snprintf(repetitions, sizeof repetitions, "repetitions: %d\n", most + 2);
    char *text = strdup(ENDLESS), *at = strstr(text, "repetitions: "), *shorter;
    *at = 0;
    shorter = text_format("%s%swarmups: 1\n", text, repetitions);
    room_write(room, "tiny.study", shorter);
    free(text);
    free(shorter);
    run_to_the_end(room);
    count_cells(room, after);
    for (int i = 0; i < TINY_CELLS; i++)
        assert_int_equal(after[i], most + 2);
    char *rows_now = read_text(room, "results/tiny/rows.csv");
    assert_memory_equal(rows_now, rows, strlen(rows));
    const json_int_t count = rows_so_far(room);
    run_to_the_end(room);
    assert_int_equal(rows_so_far(room), count);
    json_t *list = room_get(room, "/api/studies"), *one = json_array_get(json_object_get(list, "studies"), 0);
    assert_int_equal(number_at(one, "cells_done"), TINY_CELLS);
    assert_int_equal(number_at(one, "rows"), count);
    json_decref(list);
    free(room_film(room)); /* pictures are made again */
    free(rows);
    free(rows_now);
}

static void one_runs_at_a_time(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", ENDLESS);
    room_write(room, "other.study", "study: other\nscene: scene.yaml\n");
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    char *said = room_refused(room, "POST", "/api/studies/other/run", "{}", 409);
    assert_non_null(strstr(said, "tiny"));
    free(said);
    free(room_refused(room, "POST", "/api/studies/tiny/run", "{}", 409));
    free(room_refused(room, "POST", "/api/studies/other/stop", "{}", 409));
    json_t *told = room_get(room, "/api/studies/tiny");
    assert_true(json_is_true(json_object_get(told, "running")));
    json_decref(told);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/stop", "{}", 200));
    json_decref(wait_for_end(room));
    json_decref(room_ask(room, "POST", "/api/studies/other/run", "{}", 200));
    told = wait_for_end(room);
    assert_string_equal(json_string_value(json_object_get(told, "name")), "other");
    json_decref(told);
}

static void the_laboratory_may_end_meanwhile(void **state)
{
    lab_room *room = *state;
    room_write(room, "tiny.study", ENDLESS);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    wait_for_rows(room, 10);
    lab_stop(room->lab);
    room->lab = NULL;
    int counted[TINY_CELLS];
    count_cells(room, counted);
    assert_true(counted[0] + counted[1] > 0 || counted[2] + counted[3] > 0 || counted[4] + counted[5] > 0);
}

/* What fails in the middle is told: another process has the rows. */
static void trouble_is_told(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", TINY("1"));
    make_folder(room, "results");
    room_write(room, "results/tiny", "not a folder");
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    json_t *told = wait_for_end(room), *error = json_object_get(told, "error");
    assert_non_null(json_string_value(json_object_get(error, "error")));
    json_decref(told);
}

/* --- what was measured --- */

static void tables_are_as_the_files(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", TINY("7"));
    run_to_the_end(room);
    char *path = room_path(room, "tiny.study"), *text = NULL, *joined = strdup("");
    size_t size;
    study *s;
    assert_int_equal(study_read(path, &s, NULL), STATUS_OK);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(study_summary(s, room->results, out, NULL), STATUS_OK);
    fclose(out);
    study_destroy(s);
    json_t *told = room_get(room, "/api/studies/tiny"), *summary = json_object_get(told, "summary"), *rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_size(rows), TINY_CELLS);
    for (size_t i = 0; i <= json_array_size(rows); i++) {
        const json_t *line = i ? json_array_get(rows, i - 1) : json_object_get(summary, "columns");
        for (size_t k = 0; k < json_array_size(line); k++) {
            char *longer = text_format("%s%s%s", joined, json_string_value(json_array_get(line, k)), k + 1 < json_array_size(line) ? "\t" : "\n");
            free(joined);
            joined = longer;
        }
    }
    assert_string_equal(joined, text);
    assert_string_equal(json_string_value(json_array_get(json_object_get(told, "runs"), 0)), "results");
    json_decref(told);
    free(joined);
    free(text);
    free(path);

    told = room_get(room, "/api/studies/tiny/rows");
    const json_int_t count = number_at(told, "count");
    assert_int_equal(count, TINY_CELLS * 8);
    json_t *raw = json_object_get(told, "rows");
    assert_int_equal(json_array_size(raw), count);
    json_t *rest = room_get(room, "/api/studies/tiny/rows?from=40");
    assert_int_equal(json_array_size(json_object_get(rest, "rows")), count - 40);
    assert_true(json_equal(json_array_get(raw, 40), json_array_get(json_object_get(rest, "rows"), 0)));
    assert_true(json_equal(json_object_get(told, "columns"), json_object_get(rest, "columns")));
    json_decref(rest);
    json_decref(told);
    free(room_refused(room, "GET", "/api/studies/tiny/rows?from=-1", NULL, 400));
    free(room_refused(room, "GET", "/api/studies/tiny/rows?from=two", NULL, 400));
}

/* The same rows with twice the times, and another film in one cell. */
static void write_other_run(const lab_room *room)
{
    char *path = room_path(room, "results/tiny/rows.csv"), *other = room_path(room, "old/runs/tiny/rows.csv");
    csv *table = NULL;
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    FILE *out = fopen(other, "w");
    fwrite(table->raw, 1, table->start[0], out);
    const int wall = csv_column(table, "wall_s"), film = csv_column(table, "film_hash"), expected = csv_column(table, "film_expected");
    for (size_t i = 0; i < table->row_count; i++)
        for (int k = 0; k < (int)table->column_count; k++) {
            const bool other_film = strcmp(csv_field(table, i, csv_column(table, "cell")), "2") == 0 && (k == film || k == expected);
            if (k == wall)
                fprintf(out, "%.17g", 2 * csv_field_real(table, i, k));
            else
                fputs(other_film ? "0123456789abcdef" : csv_field(table, i, k), out);
            fputc(k + 1 < (int)table->column_count ? ',' : '\n', out);
        }
    fclose(out);
    csv_destroy(table);
    free(path);
    free(other);
}

static void two_runs_are_compared(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", TINY("6"));
    run_to_the_end(room);
    make_folder(room, "old");
    make_folder(room, "old/runs");
    make_folder(room, "old/runs/tiny");
    write_other_run(room);
    json_t *told = room_get(room, "/api/studies/tiny");
    assert_int_equal(json_array_size(json_object_get(told, "runs")), 2);
    assert_string_equal(json_string_value(json_array_get(json_object_get(told, "runs"), 0)), "old/runs");
    json_decref(told);
    told = room_get(room, "/api/studies/tiny/compare?with=old/runs");
    const json_t *cells = json_object_get(told, "cells");
    assert_int_equal(json_array_size(cells), TINY_CELLS);
    for (size_t i = 0; i < TINY_CELLS; i++) {
        const json_t *cell = json_array_get(cells, i), *a = json_object_get(cell, "a"), *b = json_object_get(cell, "b");
        assert_int_equal(number_at(cell, "cell"), i);
        assert_int_equal(atoi(json_string_value(json_object_get(cell, "render.depth"))), i / 2);
        assert_true(json_real_value(json_object_get(cell, "ratio")) == 2);
        assert_int_equal(number_at(a, "n"), 6);
        assert_true(json_number_value(json_object_get(b, "median")) == 2 * json_number_value(json_object_get(a, "median")));
        assert_true(json_number_value(json_object_get(a, "low")) <= json_number_value(json_object_get(a, "median")));
        assert_true(json_number_value(json_object_get(a, "high")) >= json_number_value(json_object_get(a, "median")));
        assert_int_equal(json_is_true(json_object_get(cell, "same_film")), i != 2);
    }
    json_decref(told);
    static const char *const wrong[] = {"", "?with=", "?with=nowhere", "?with=..", "?with=../tmp", "?with=/tmp", "?with=old/../old/runs", "?with=old"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char *target = text_format("/api/studies/tiny/compare%s", wrong[i]);
        free(room_refused(room, "GET", target, NULL, 400));
        free(target);
    }
}

/* --- figures --- */

static void figures_are_drawn(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", TINY("1"));
    free(room_refused(room, "POST", "/api/studies/tiny/draw", "{}", 400)); /* there is no script */
    make_folder(room, "plots");
    room_write(room, "plots/draw.sh", "shift; results=$1; shift 3; mkdir -p $results/figures\n"
                                      "for f in $*; do head -n 1 $results/tables/tiny.tsv >$results/figures/$f.svg; echo drawn: $f; done\n");
    room_write(room, "plots/of-it.gp", "# A figure.\n# needs: other/rows.csv tables/tiny.tsv\n");
    room_write(room, "plots/not-of-it.gp", "# needs: tables/tiny-other.tsv tiny-other/images/*.png\n");
    room_write(room, "plots/tiny-not.gp", "# needs: tables/another.tsv\n");
    json_t *told = room_get(room, "/api/studies/tiny");
    assert_int_equal(json_array_size(json_object_get(told, "figures")), 0);
    assert_int_equal(json_array_size(json_object_get(told, "drawable")), 1);
    assert_string_equal(json_string_value(json_array_get(json_object_get(told, "drawable"), 0)), "of-it");
    json_decref(told);
    run_to_the_end(room);
    told = room_ask(room, "POST", "/api/studies/tiny/draw", "{}", 200);
    assert_string_equal(json_string_value(json_object_get(told, "said")), "drawn: of-it\n");
    assert_true(json_is_true(json_object_get(told, "complete")));
    json_decref(told);
    room_write(room, "results/figures/tiny-by-name.svg", "<svg/>");
    room_write(room, "results/figures/tiny-not.svg", "<svg/>");
    room_write(room, "results/figures/Tiny.svg", "<svg/>");
    told = room_get(room, "/api/studies/tiny");
    const json_t *figures = json_object_get(told, "figures");
    assert_int_equal(json_array_size(figures), 2);
    assert_string_equal(json_string_value(json_array_get(figures, 0)), "of-it");
    assert_string_equal(json_string_value(json_array_get(figures, 1)), "tiny-by-name");
    json_decref(told);
    char *reply = client_ask(room->server, "GET", "/api/figures/of-it", "", NULL);
    assert_int_equal(reply_code(reply), 200);
    assert_true(reply_has(reply, "Content-Type: image/svg+xml"));
    assert_int_equal(strncmp(reply_body(reply), "cell\trender.depth\trender.threads\tn\t", 34), 0);
    free(reply);
    static const char *const wrong[] = {"nothing", "Tiny", "of-it.svg", "of_it"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char *target = text_format("/api/figures/%s", wrong[i]);
        free(room_refused(room, "GET", target, NULL, 404));
        free(target);
    }
    free(room_refused(room, "GET", "/api/figures/..%2fof-it", NULL, 400));
}

static void *draw(void *of)
{
    const lab_room *room = of;
    return client_ask(room->server, "POST", "/api/studies/tiny/draw", "Content-Type: application/json\r\n", "{}");
}

/* A script that does not end is ended with the laboratory. */
static void drawing_ends_with_the_laboratory(void **state)
{
    lab_room *room = *state;
    room_write(room, "tiny.study", TINY("1"));
    make_folder(room, "plots");
    room_write(room, "plots/draw.sh", "echo begun >$2/begun\nsleep 1000 & sleep 1000\n");
    room_write(room, "plots/of-it.gp", "# needs: tables/tiny.tsv\n");
    run_to_the_end(room);
    pthread_t drawer;
    void *reply;
    char *begun = room_path(room, "results/begun");
    assert_int_equal(pthread_create(&drawer, NULL, draw, room), 0);
    while (access(begun, F_OK) != 0)
        ;
    free(room_refused(room, "POST", "/api/studies/tiny/draw", "{}", 409));
    lab_stop(room->lab);
    room->lab = NULL;
    pthread_join(drawer, &reply);
    free(reply);
    free(begun);
}

/* --- what is refused --- */

static void nothing_outside_is_read(void **state)
{
    const lab_room *room = *state;
    char *inside = room_path(room, "inside"), *first = room_path(room, "inside/scene.yaml"), *link = room_path(room, "inside/results/away"),
         *away = room_path(room, "away"), *results = room_path(room, "inside/results");
    make_folder(room, "inside");
    make_folder(room, "inside/results");
    make_folder(room, "away");
    room_write(room, "inside/scene.yaml", BALL_SCENE);
    room_write(room, "inside/far.study", "study: far\nscene: ../scene.yaml\n");
    room_write(room, "inside/sky.study", "study: sky\nscene: scene.yaml\ngrid: [{background.picture: [near.png, ../../far.png]}]\n");
    room_write(room, "inside/away.study", "study: away\nscene: scene.yaml\nrepetitions: 1\n");
    assert_int_equal(symlink(away, link), 0);
    lab_room inner = {.lab = NULL};
    const lab_settings settings = {.folder = inside, .scene = first, .results = results, .level = isa_best(), .threads = 1, .requests_per_s = 1e9};
    assert_int_equal(lab_start(&settings, &inner.lab, NULL), STATUS_OK);
    inner.server = lab_server(inner.lab);
    static const char *const names[] = {"far", "sky", "away"};
    for (size_t i = 0; i < 3; i++) {
        char *run = text_format("/api/studies/%s/run", names[i]), *said = room_refused(&inner, "POST", run, "{}", 400);
        assert_non_null(strstr(said, "out"));
        free(said);
        free(run);
    }
    json_t *told = room_get(&inner, "/api/studies"), *list = json_object_get(told, "studies");
    assert_int_equal(json_array_size(list), 3);
    for (size_t i = 0; i < 3; i++)
        assert_non_null(json_object_get(json_array_get(list, i), "error"));
    json_decref(told);
    free(room_refused(&inner, "GET", "/api/studies/nobody", NULL, 404));
    free(room_refused(&inner, "POST", "/api/studies/nobody/run", "{}", 404));
    free(room_refused(&inner, "GET", "/api/studies/..%2faway", NULL, 400));
    free(room_refused(&inner, "GET", "/api/studies/%2e%2e/rows", NULL, 400));
    free(room_refused(&inner, "POST", "/api/studies/away/run", "[1]", 400));
    lab_stop(inner.lab);
    free(inside);
    free(first);
    free(link);
    free(away);
    free(results);
}

static void the_machine_is_described(void **state)
{
    const lab_room *room = *state;
    json_t *told = room_get(room, "/api/machine");
    assert_true(number_at(told, "units") >= 1);
    assert_non_null(json_string_value(json_object_get(told, "machine")));
    assert_true(json_is_array(json_object_get(told, "disturbances")));
    json_decref(told);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(studies_are_listed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_study_is_stopped_and_goes_on, set_up, tear_down),
        cmocka_unit_test_setup_teardown(one_runs_at_a_time, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_laboratory_may_end_meanwhile, set_up, tear_down),
        cmocka_unit_test_setup_teardown(trouble_is_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tables_are_as_the_files, set_up, tear_down),
        cmocka_unit_test_setup_teardown(two_runs_are_compared, set_up, tear_down),
        cmocka_unit_test_setup_teardown(figures_are_drawn, set_up, tear_down),
        cmocka_unit_test_setup_teardown(drawing_ends_with_the_laboratory, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_outside_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_machine_is_described, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("lab_studies", tests, NULL, NULL);
}
