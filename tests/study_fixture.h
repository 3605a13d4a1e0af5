/* A temporary folder for a test, with a small scene and a study in it; removed at the end. */
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "study/summary/summary.h"
#include "study/study.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char fixture_scene[] =
    "title: test\n"
    "render: {width: 24, height: 18, depth: 2, tile: 8}\n"
    "camera: {position: [0, 1, -5], target: [0, 1, 0]}\n"
    "materials:\n"
    "  clear: {transparency: 1, ior: 1.5}\n"
    "lights:\n"
    "  lamp: {position: [4, 7, -5]}\n"
    "solids:\n"
    "  ground: {shape: plane, ambient: 0.1, diffuse: 0.7, checker: 0.5}\n"
    "  ball: {shape: sphere, material: clear, position: [0, 1, 0], radius: 1, priority: 1}\n";

typedef struct fixture {
    char folder[256], results[300];
} fixture;

__attribute__((unused)) static void fixture_path(const fixture *f, const char *name, char path[400])
{
    snprintf(path, 400, "%s/%s", f->folder, name);
}

__attribute__((unused)) static void fixture_write(const fixture *f, const char *name, const char *text)
{
    char path[400];
    fixture_path(f, name, path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* The whole text of a file, or "" if it does not exist; free it. */
__attribute__((unused)) static char *fixture_text(const fixture *f, const char *name)
{
    char path[400];
    fixture_path(f, name, path);
    FILE *file = fopen(path, "r");
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    if (file) {
        assert_true(fread(text, 1, (1 << 20) - 1, file) < (1 << 20) - 1);
        fclose(file);
    }
    return text;
}

__attribute__((unused)) static bool fixture_has(const fixture *f, const char *name)
{
    char path[400];
    fixture_path(f, name, path);
    return access(path, F_OK) == 0;
}

__attribute__((unused)) static int fixture_setup(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    const char *place = getenv("TMPDIR");
    snprintf(f->folder, sizeof f->folder, "%s/cuvette-test-XXXXXX", place ? place : "/tmp");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->results, sizeof f->results, "%s/results", f->folder);
    fixture_write(f, "scene.yaml", fixture_scene);
    *state = f;
    return 0;
}

static int fixture_remove(const char *path, const struct stat *about, int kind, struct FTW *where)
{
    (void)about;
    (void)kind;
    (void)where;
    return remove(path);
}

__attribute__((unused)) static int fixture_teardown(void **state)
{
    fixture *f = *state;
    nftw(f->folder, fixture_remove, 16, FTW_DEPTH | FTW_PHYS);
    free(f);
    return 0;
}

/* Reads a study from this text, which must be valid; its scene is scene.yaml of the folder. */
__attribute__((unused)) static study *fixture_study(const fixture *f, const char *text)
{
    char path[400], message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    study *s = NULL;
    fixture_write(f, "test.study", text);
    fixture_path(f, "test.study", path);
    if (study_read(path, &s, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return s;
}

/* Runs the study without a shard, which must succeed; returns the number of rows written. */
__attribute__((unused)) static size_t fixture_run(const fixture *f, const study *s)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    size_t ran = 0;
    study_options options = {.results = f->results};
    if (study_run(s, &options, &ran, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return ran;
}

/* The number of occurrences of a text in another. */
__attribute__((unused)) static size_t fixture_count(const char *text, const char *part)
{
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part))
        count++;
    return count;
}

/* The summary has the columns of comparisons, without values, in each of its lines. */
__attribute__((unused)) static void fixture_lacks_comparisons(const fixture *f, const study *s, size_t lines)
{
    summary_table table;
    assert_int_equal(summary_table_read(s, f->results, &table, NULL), STATUS_OK);
    assert_int_equal(table.rows, lines);
    const long from = summary_table_column(&table, "reference"), to = summary_table_column(&table, "reference_noise_rms");
    assert_int_equal(to - from, 8);
    for (long column = from; column <= to; column++)
        for (size_t row = 0; row < lines; row++)
            assert_string_equal(summary_table_text(&table, row, column), "NA");
    summary_table_free(&table);
}
