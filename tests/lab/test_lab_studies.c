/* Tests of studies through the API. */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/csv.h"
#include "lab_study_fixture.h"
#include "rows_fixture.h"
#include "study/summary/summary.h"
#include <errno.h>

/* Studies through the API: the list, a run that is stopped and continued, and refused requests. */

/* --- the list --- */

static void studies_are_listed(void **state)
{
    const lab_room *room = *state;
    make_folder(room, "more");
    room_write(room, "tiny.study", TINY("3"));
    room_write(room, "more/broken.study", "study: broken\nscene: ../scene.yaml\ngrid: [{render.dept: [1, 2]}]\n");
    room_write(room, "twin.study", "study: tiny\nscene: scene.yaml\n");
    room_write(room, "nonsense.study", "[");
    json_t *json = room_get(room, "/api/studies"), *list = json_object_get(json, "studies");
    assert_string_equal(json_string_value(json_object_get(json, "results")), "results");
    assert_int_equal(json_array_size(list), 4);
    int seen = 0;
    for (size_t i = 0; i < 4; i++) {
        const json_t *one = json_array_get(list, i), *error = json_object_get(one, "error");
        const char *file = json_string_value(json_object_get(one, "file")),
                   *name = json_string_value(json_object_get(one, "name"));
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
            assert_non_null(strstr(what, "already used by"));
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
    json_decref(json);
    json = room_get(room, "/api/studies/broken");
    assert_non_null(json_object_get(json, "error"));
    assert_true(json_is_null(json_object_get(json, "summary")));
    json_decref(json);
    free(room_refused(room, "POST", "/api/studies/broken/run", "{}", 400));
}

/* --- run, stop, continue --- */

/* Counts the rows of each cell; a cell and repetition that occurs twice was measured twice. */
static void count_cells(const lab_room *room, int counted[TINY_CELLS])
{
    char *path = room_path(room, "results/tiny/rows.csv");
    csv *table = NULL;
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    assert_int_equal(table->complete_size, table->size);
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
    char *request = text_format("GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n\r\n",
                                http_port(room->server), http_token(room->server));
    client_send(fd, request, strlen(request));
    free(request);
    while (http_event_clients((http_server *)(uintptr_t)room->server) == 0)
        ;
    return fd;
}

/* Waits for the next event `study` that satisfies the condition. */
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
        json_t *json = json_loads(line + 6, 0, NULL);
        assert_non_null(json);
        assert_string_equal(json_string_value(json_object_get(json, "name")), "tiny");
        if (is_so(json))
            return json;
        json_decref(json);
    }
}

static bool has_frames(const json_t *json)
{
    return json_is_true(json_object_get(json, "running")) && number_at(json, "frames_done") > 0;
}

static bool has_ended(const json_t *json)
{
    return json_is_false(json_object_get(json, "running"));
}

static void a_study_is_stopped_and_continued(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", ENDLESS);
    free(room_refused(room, "POST", "/api/studies/tiny/stop", "{}", 409));
    const int events = open_events(room);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    json_t *json = wait_for_event(events, has_frames);
    assert_int_equal(number_at(json, "frames_all"), TINY_CELLS * 100000);
    assert_true(json_is_number(json_object_get(json, "left_s")));
    assert_string_equal(json_string_value(json_object_get(json, "stage")), "measuring");
    json_decref(json);
    json_t *now = room_get(room, "/api/state");
    assert_string_equal(json_string_value(json_object_get(now, "waiting")), "a study is measuring: tiny");
    json_decref(now);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/stop", "{}", 200));
    json = wait_for_event(events, has_ended);
    assert_true(json_is_null(json_object_get(json, "error")));
    json_decref(json);
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
    room_post(room, "/api/set", "{\"set\": {\"ball.ior\": 1.3}}");
    char *img = client_ask(room->server, "GET", "/api/image.png?wait=1", "", NULL);
    assert_int_equal(reply_code(img), 200); /* rendering is resumed */
    free(img);
    free(rows);
    free(rows_now);
}

static void one_study_runs_at_a_time(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", ENDLESS);
    room_write(room, "other.study", "study: other\nscene: scene.yaml\n");
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    char *refusal = room_refused(room, "POST", "/api/studies/other/run", "{}", 409);
    assert_non_null(strstr(refusal, "tiny"));
    free(refusal);
    free(room_refused(room, "POST", "/api/studies/tiny/run", "{}", 409));
    free(room_refused(room, "POST", "/api/studies/tiny/draw", "{}", 409)); /* drawing would disturb the running study */
    free(room_refused(room, "POST", "/api/studies/other/stop", "{}", 409));
    json_t *json = room_get(room, "/api/studies/tiny");
    assert_true(json_is_true(json_object_get(json, "running")));
    json_decref(json);
    json_decref(room_ask(room, "POST", "/api/studies/tiny/stop", "{}", 200));
    json_decref(wait_for_end(room));
    json_decref(room_ask(room, "POST", "/api/studies/other/run", "{}", 200));
    json = wait_for_end(room);
    assert_string_equal(json_string_value(json_object_get(json, "name")), "other");
    json_decref(json);
}

static void stopping_the_laboratory_during_a_study_keeps_its_rows(void **state)
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

/* An error during the run is reported: another process holds the rows. */
static void errors_are_reported(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", TINY("1"));
    make_folder(room, "results");
    room_write(room, "results/tiny", "not a folder");
    json_decref(room_ask(room, "POST", "/api/studies/tiny/run", "{}", 200));
    json_t *json = wait_for_end(room), *error = json_object_get(json, "error");
    assert_non_null(json_string_value(json_object_get(error, "error")));
    json_decref(json);
}

/* --- refused requests --- */

static void files_outside_the_folder_are_not_read(void **state)
{
    const lab_room *room = *state;
    char *inside = room_path(room, "inside"), *first = room_path(room, "inside/scene.yaml"),
         *link = room_path(room, "inside/results/away"), *away = room_path(room, "away"),
         *results = room_path(room, "inside/results");
    make_folder(room, "inside");
    make_folder(room, "inside/results");
    make_folder(room, "away");
    room_write(room, "inside/scene.yaml", BALL_SCENE);
    room_write(room, "inside/far.study", "study: far\nscene: ../scene.yaml\n");
    room_write(room, "inside/sky.study",
               "study: sky\nscene: scene.yaml\ngrid: [{background.image: [near.png, ../../far.png]}]\n");
    room_write(room, "inside/away.study", "study: away\nscene: scene.yaml\nrepetitions: 1\n");
    assert_int_equal(symlink(away, link), 0);
    lab_room inner = {.lab = NULL};
    const lab_settings settings = {
        .folder = inside, .scene = first, .results = results, .level = isa_best(), .threads = 1, .requests_per_s = 1e9};
    assert_int_equal(lab_start(&settings, &inner.lab, NULL), STATUS_OK);
    inner.server = lab_server(inner.lab);
    static const char *const names[] = {"far", "sky", "away"};
    for (size_t i = 0; i < 3; i++) {
        char *run = text_format("/api/studies/%s/run", names[i]),
             *refusal = room_refused(&inner, "POST", run, "{}", 400);
        assert_non_null(strstr(refusal, "out"));
        free(refusal);
        free(run);
    }
    json_t *json = room_get(&inner, "/api/studies"), *list = json_object_get(json, "studies");
    assert_int_equal(json_array_size(list), 3);
    for (size_t i = 0; i < 3; i++)
        assert_non_null(json_object_get(json_array_get(list, i), "error"));
    json_decref(json);
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
    json_t *json = room_get(room, "/api/machine");
    assert_true(number_at(json, "units") >= 1);
    assert_non_null(json_string_value(json_object_get(json, "machine")));
    assert_true(json_is_array(json_object_get(json, "disturbances")));
    json_decref(json);
}

/* Study results through the API: tables, the comparison of two runs, figures. */

/* --- tables --- */

static void tables_equal_those_of_the_command(void **state)
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
    json_t *json = room_get(room, "/api/studies/tiny"), *summary = json_object_get(json, "summary"),
           *rows = json_object_get(summary, "rows");
    assert_int_equal(json_array_size(rows), TINY_CELLS);
    for (size_t i = 0; i <= json_array_size(rows); i++) {
        const json_t *line = i ? json_array_get(rows, i - 1) : json_object_get(summary, "columns");
        for (size_t k = 0; k < json_array_size(line); k++) {
            char *longer = text_format("%s%s%s", joined, json_string_value(json_array_get(line, k)),
                                       k + 1 < json_array_size(line) ? "\t" : "\n");
            free(joined);
            joined = longer;
        }
    }
    assert_string_equal(joined, text);
    assert_string_equal(json_string_value(json_array_get(json_object_get(json, "runs"), 0)), "results");
    json_decref(json);
    free(joined);
    free(text);
    free(path);

    json = room_get(room, "/api/studies/tiny/rows");
    const json_int_t count = number_at(json, "count");
    assert_int_equal(count, TINY_CELLS * 8);
    json_t *raw = json_object_get(json, "rows");
    assert_int_equal(json_array_size(raw), count);
    json_t *rest = room_get(room, "/api/studies/tiny/rows?from=40");
    assert_int_equal(json_array_size(json_object_get(rest, "rows")), count - 40);
    assert_true(json_equal(json_array_get(raw, 40), json_array_get(json_object_get(rest, "rows"), 0)));
    assert_true(json_equal(json_object_get(json, "columns"), json_object_get(rest, "columns")));
    json_decref(rest);
    json_decref(json);
    free(room_refused(room, "GET", "/api/studies/tiny/rows?from=-1", NULL, 400));
    free(room_refused(room, "GET", "/api/studies/tiny/rows?from=two", NULL, 400));
}

/* The same rows with doubled times, and another film in one cell. */
static void write_other_run(const lab_room *room)
{
    char *path = room_path(room, "results/tiny/rows.csv"), *other = room_path(room, "old/runs/tiny/rows.csv");
    csv *table = NULL;
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    FILE *out = fopen(other, "w");
    fwrite(table->raw, 1, table->start[0], out);
    const int wall = csv_column(table, "wall_s"), hash = csv_column(table, "film_hash"),
              expected = csv_column(table, "film_expected");
    for (size_t i = 0; i < table->row_count; i++)
        for (int k = 0; k < (int)table->column_count; k++) {
            const bool other_film =
                strcmp(csv_field(table, i, csv_column(table, "cell")), "2") == 0 && (k == hash || k == expected);
            if (k == wall)
                fprintf(out, "%.17g", 2 * csv_field_real(table, i, k));
            else
                fputs(other_film ? "0123456789abcdef" : csv_field(table, i, k), out);
            fputc(k + 1 < (int)table->column_count ? ',' : '\n', out);
        }
    fclose(out);
    csv_destroy(table);
    rows_recheck(other);
    char *runs = room_path(room, "results/tiny/runs.json"), *copy = room_path(room, "old/runs/tiny/runs.json");
    json_t *list = json_load_file(runs, 0, NULL);
    assert_int_equal(json_dump_file(list, copy, 0), 0);
    json_decref(list);
    rows_unseal(copy);
    free(runs);
    free(copy);
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
    json_t *json = room_get(room, "/api/studies/tiny");
    assert_int_equal(json_array_size(json_object_get(json, "runs")), 2);
    assert_string_equal(json_string_value(json_array_get(json_object_get(json, "runs"), 0)), "old/runs");
    json_decref(json);
    json = room_get(room, "/api/studies/tiny/compare?with=old/runs");
    const json_t *cells = json_object_get(json, "cells");
    assert_int_equal(json_array_size(cells), TINY_CELLS);
    for (size_t i = 0; i < TINY_CELLS; i++) {
        const json_t *cell = json_array_get(cells, i), *a = json_object_get(cell, "a"), *b = json_object_get(cell, "b");
        assert_int_equal(number_at(cell, "cell"), i);
        assert_int_equal(atoi(json_string_value(json_object_get(cell, "render.depth"))), i / 2);
        assert_true(fabs(json_real_value(json_object_get(cell, "ratio")) - 2) < 1e-12);
        assert_int_equal(number_at(a, "n"), 6);
        assert_true(json_number_value(json_object_get(b, "median")) ==
                    2 * json_number_value(json_object_get(a, "median")));
        assert_true(json_number_value(json_object_get(cell, "low")) <= 2);
        assert_true(json_number_value(json_object_get(cell, "high")) >= 2);
        assert_string_equal(json_string_value(json_object_get(cell, "verdict")), "cannot tell"); /* one process each */
        assert_int_equal(json_is_true(json_object_get(cell, "same_film")), i != 2);
    }
    json_decref(json);
    static const char *const wrong[] = {
        "", "?with=", "?with=nowhere", "?with=..", "?with=../tmp", "?with=/tmp", "?with=old/../old/runs", "?with=old"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char *target = text_format("/api/studies/tiny/compare%s", wrong[i]);
        free(room_refused(room, "GET", target, NULL, 400));
        free(target);
    }
}

/* --- figures --- */

static void check_figure(const lab_room *room, const char *query, const char *type, const char *begin)
{
    char *target = text_format("/api/studies/tiny/figure%s", query);
    char *reply = client_ask(room->server, "GET", target, "", NULL);
    assert_int_equal(reply_code(reply), 200);
    assert_true(reply_has(reply, type));
    assert_int_equal(strncmp(reply_body(reply), begin, strlen(begin)), 0);
    free(reply);
    free(target);
}

static void the_figure_of_study_plot_is_served(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", TINY("1"));
    free(room_refused(room, "GET", "/api/studies/none/figure", NULL, 404));
    run_to_the_end(room);
    if (system("gnuplot -e 'set terminal pngcairo' 2>/dev/null") != 0)
        skip();
    check_figure(room, "", "Content-Type: image/svg+xml", "<?xml");
    check_figure(room, "?format=png&y=rays_total&x=render.threads&by=render.depth&log=none", "Content-Type: image/png",
                 "\x89PNG");
    check_figure(room, "?format=pdf&by=", "Content-Type: application/pdf", "%PDF");
    static const char *const wrong[] = {"format=gif", "log=z", "y=wal_s", "x=none", "by=render.width"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char *target = text_format("/api/studies/tiny/figure?%s", wrong[i]);
        free(room_refused(room, "GET", target, NULL, 400));
        free(target);
    }
    char *left = room_path(room, "results/tiny/figure.gp");
    assert_int_not_equal(access(left, F_OK), 0);
    free(left);
}

static void figures_are_drawn(void **state)
{
    const lab_room *room = *state;
    room_write(room, "tiny.study", TINY("1"));
    free(room_refused(room, "POST", "/api/studies/tiny/draw", "{}", 400)); /* there is no plot script */
    make_folder(room, "plots");
    room_write(room, "plots/draw.sh",
               "shift; results=$1; shift 3; mkdir -p $results/figures\n"
               "for f in $*; do head -n 1 $results/tables/tiny.tsv >$results/figures/$f.svg; echo drawn: $f; done\n");
    room_write(room, "plots/of-it.gp", "# A figure.\n# needs: other/rows.csv tables/tiny.tsv\n");
    room_write(room, "plots/not-of-it.gp", "# needs: tables/tiny-other.tsv tiny-other/images/*.png\n");
    room_write(room, "plots/tiny-not.gp", "# needs: tables/another.tsv\n");
    json_t *json = room_get(room, "/api/studies/tiny");
    assert_int_equal(json_array_size(json_object_get(json, "figures")), 0);
    assert_int_equal(json_array_size(json_object_get(json, "drawable")), 1);
    assert_string_equal(json_string_value(json_array_get(json_object_get(json, "drawable"), 0)), "of-it");
    json_decref(json);
    run_to_the_end(room);
    json = room_ask(room, "POST", "/api/studies/tiny/draw", "{}", 200);
    assert_string_equal(json_string_value(json_object_get(json, "said")), "drawn: of-it\n");
    assert_true(json_is_true(json_object_get(json, "complete")));
    json_decref(json);
    room_write(room, "results/figures/tiny-by-name.svg", "<svg/>");
    room_write(room, "results/figures/tiny-not.svg", "<svg/>");
    room_write(room, "results/figures/Tiny.svg", "<svg/>");
    json = room_get(room, "/api/studies/tiny");
    const json_t *figures = json_object_get(json, "figures");
    assert_int_equal(json_array_size(figures), 2);
    assert_string_equal(json_string_value(json_array_get(figures, 0)), "of-it");
    assert_string_equal(json_string_value(json_array_get(figures, 1)), "tiny-by-name");
    json_decref(json);
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

/* A script that never ends is killed with the laboratory. */
static void stopping_the_laboratory_kills_the_drawing_script(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(studies_are_listed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_study_is_stopped_and_continued, set_up, tear_down),
        cmocka_unit_test_setup_teardown(one_study_runs_at_a_time, set_up, tear_down),
        cmocka_unit_test_setup_teardown(stopping_the_laboratory_during_a_study_keeps_its_rows, set_up, tear_down),
        cmocka_unit_test_setup_teardown(errors_are_reported, set_up, tear_down),
        cmocka_unit_test_setup_teardown(files_outside_the_folder_are_not_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_machine_is_described, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tables_equal_those_of_the_command, set_up, tear_down),
        cmocka_unit_test_setup_teardown(two_runs_are_compared, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_figure_of_study_plot_is_served, set_up, tear_down),
        cmocka_unit_test_setup_teardown(figures_are_drawn, set_up, tear_down),
        cmocka_unit_test_setup_teardown(stopping_the_laboratory_kills_the_drawing_script, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
