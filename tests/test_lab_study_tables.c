/* Tests of study results through the API: tables, the comparison of two runs, figures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_study_fixture.h"
#include "rows_fixture.h"
#include "base/csv.h"
#include "study/summary/summary.h"
#include <pthread.h>

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
    const int wall = csv_column(table, "wall_s"), film = csv_column(table, "film_hash"),
              expected = csv_column(table, "film_expected");
    for (size_t i = 0; i < table->row_count; i++)
        for (int k = 0; k < (int)table->column_count; k++) {
            const bool other_film =
                strcmp(csv_field(table, i, csv_column(table, "cell")), "2") == 0 && (k == film || k == expected);
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
        cmocka_unit_test_setup_teardown(tables_equal_those_of_the_command, set_up, tear_down),
        cmocka_unit_test_setup_teardown(two_runs_are_compared, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_figure_of_study_plot_is_served, set_up, tear_down),
        cmocka_unit_test_setup_teardown(figures_are_drawn, set_up, tear_down),
        cmocka_unit_test_setup_teardown(stopping_the_laboratory_kills_the_drawing_script, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("lab_study_tables", tests, NULL, NULL);
}
