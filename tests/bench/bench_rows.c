/* bench_rows [ROWS] - seconds that status, summary and merge take for a study with that many rows (100000) in 50 cells,
 * in two shards, with two worker rows each. The rows are copies of measured ones with other times. Prints a line for
 * each: medians of 5, wall time. Files are written below TMPDIR and removed. */
#include "base/csv.h"
#include "base/number.h"
#include "measure/clock.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include "study/rows/runs.h"
#include "study/summary/summary.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SHARDS = 2, TIMES = 5 };

static const char scene_text[] = "title: bench\n"
                                 "render: {width: 16, height: 12, depth: 2, tile: 4, threads: 2}\n"
                                 "camera: {position: [0, 1, -5], target: [0, 1, 0]}\n"
                                 "lights: {lamp: {position: [4, 7, -5]}}\n"
                                 "solids:\n"
                                 "  ball: {shape: sphere, position: [0, 1, 0], radius: 1, priority: 1}\n";
static const char study_text[] = "study: bench\nscene: scene.yaml\nwarmups: 0\nrepetitions: 1\nkeep: {workers: on}\n"
                                 "grid:\n  - {render.depth: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]}\n"
                                 "  - {ball.radius: [0.6, 0.7, 0.8, 0.9, 1]}\n";

static void require(bool good, const char *what, const diagnostic *why)
{
    if (good)
        return;
    fprintf(stderr, "bench_rows: %s: %s\n", what, why ? why->what : "failed");
    exit(1);
}

static void write_file(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    require(out && fputs(text, out) >= 0 && fclose(out) == 0, path, NULL);
}

/* A line of the table with other repetition, order and, in rows.csv, wall time. */
static void put_copy(const csv *table, size_t row, long repetition, long order, csv_buffer *line)
{
    const int repetition_at = csv_column(table, "repetition"), order_at = csv_column(table, "order"),
              wall_at = csv_column(table, "wall_s");
    char text[3][NUMBER_TEXT_MAX];
    const double scale = 1.0 + 0.01 * sin(12.9898 * (double)order);
    snprintf(text[0], sizeof text[0], "%ld", repetition);
    snprintf(text[1], sizeof text[1], "%ld", order);
    number_format(scale * csv_field_real(table, row, wall_at), text[2]);
    for (size_t k = 0; k < table->column_count; k++)
        csv_text(line, (int)k == repetition_at ? text[0]
                       : (int)k == order_at    ? text[1]
                       : (int)k == wall_at     ? text[2]
                                               : csv_field(table, row, (int)k));
    csv_end(line);
}

/* The file of a shard: each line of the table, `times` times. */
static void write_shard(const char *folder, row_kind kind, const csv *table, long shard, long times)
{
    diagnostic why = {.what = ""};
    checksum_columns columns;
    char last[CHECKSUM_TEXT];
    char *path = row_file_path(folder, kind, shard, SHARDS);
    FILE *out = fopen(path, "w");
    require(out != NULL, path, NULL);
    fwrite(table->raw, 1, table->start[0], out);
    snprintf(last, sizeof last, "%.16s", csv_field(table, 0, csv_column(table, "run")));
    last[0] = shard ? 'a' : 'b'; /* a run of its own */
    require(checksum_columns_create(table->header, table->column_count, &columns, &why) == STATUS_OK, path, &why);
    char run[CHECKSUM_TEXT];
    memcpy(run, last, sizeof run);
    const int run_at = csv_column(table, "run");
    long order = 0;
    for (long i = 0; i < times; i++)
        for (size_t row = 0; row < table->row_count; row++) {
            csv_buffer line = {0};
            char **field = &table->fields[row * table->column_count + (size_t)run_at], *before = *field;
            *field = run;
            put_copy(table, row, i * SHARDS + shard, order++, &line);
            *field = before;
            require(checksum_lines(&columns, last, &line, &why) == STATUS_OK, path, &why);
            fwrite(line.text, 1, line.size, out);
            csv_buffer_free(&line);
        }
    require(fclose(out) == 0, path, NULL);
    checksum_columns_free(&columns);
    free(path);
}

/* runs.json of a shard with the shard's run instead of the one that measured. */
static void write_runs(const char *folder, const char *measured, long shard)
{
    char path[600], from[600];
    snprintf(from, sizeof from, "%s/runs.json", folder);
    snprintf(path, sizeof path, "%s/runs.shard-%ld-of-%d.json", folder, shard, SHARDS);
    json_t *list = json_load_file(from, 0, NULL), *run = json_array_get(json_object_get(list, "runs"), 0);
    char id[RUN_ID];
    snprintf(id, sizeof id, "%s", measured);
    id[0] = shard ? 'a' : 'b';
    json_object_set_new(run, "id", json_string(id));
    json_object_del(run, "rows");
    require(list && json_dump_file(list, path, 0) == 0, path, NULL);
    json_decref(list);
}

static void make_rows(const study *s, const char *results, long rows)
{
    char *folder = study_folder(s, results);
    diagnostic why = {.what = ""};
    const study_options options = {.results = results};
    char measured[RUN_ID] = "";
    require(study_run(s, &options, NULL, &why) == STATUS_OK, "run", &why);
    for (row_kind kind = WORKER_ROWS;; kind = ROWS) {
        csv *table = NULL;
        char *path = row_file_path(folder, kind, 0, 1);
        require(csv_read(path, &table, &why) == STATUS_OK, path, &why);
        snprintf(measured, sizeof measured, "%.16s", csv_field(table, 0, csv_column(table, "run")));
        for (long shard = 0; shard < SHARDS; shard++)
            write_shard(folder, kind, table, shard, rows / (SHARDS * (long)study_cell_count(s)));
        csv_destroy(table);
        require(unlink(path) == 0, path, NULL);
        free(path);
        if (kind == ROWS)
            break;
    }
    char path[600];
    for (long shard = 0; shard < SHARDS; shard++)
        write_runs(folder, measured, shard);
    snprintf(path, sizeof path, "%s/runs.json", folder);
    unlink(path);
    free(folder);
}

static void do_status(const study *s, const char *results)
{
    study_progress progress = {.faults = 0};
    diagnostic why = {.what = ""};
    require(study_status(s, results, &progress, &why) == STATUS_OK, "status", &why);
    require(progress.faults == 0, "status", &progress.fault);
}

static void do_summary(const study *s, const char *results)
{
    diagnostic why = {.what = ""};
    FILE *out = fopen("/dev/null", "w");
    require(study_summary(s, results, out, &why) == STATUS_OK, "summary", &why);
    fclose(out);
}

static void do_merge(const study *s, const char *results)
{
    diagnostic why = {.what = ""}, verdict = {.what = ""};
    char line[700];
    size_t rows = 0;
    require(study_merge(s, results, &rows, &verdict, &why) == STATUS_OK && !verdict.what[0], "merge",
            verdict.what[0] ? &verdict : &why);
    snprintf(line, sizeof line, "%s/bench/rows.csv", results);
    unlink(line);
    snprintf(line, sizeof line, "%s/bench/workers.csv", results);
    unlink(line);
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void measure(const char *name, void (*act)(const study *, const char *), const study *s, const char *results)
{
    double took_s[TIMES];
    for (int i = 0; i < TIMES; i++) {
        const double began_s = clock_wall_s();
        act(s, results);
        took_s[i] = clock_wall_s() - began_s;
    }
    qsort(took_s, TIMES, sizeof *took_s, by_value);
    printf("%-8s %.3f s (%.3f to %.3f)\n", name, took_s[TIMES / 2], took_s[0], took_s[TIMES - 1]);
}

int main(int argc, char **argv)
{
    const long rows = argc > 1 ? atol(argv[1]) : 100000;
    const char *place = getenv("TMPDIR");
    char folder[400], path[500], results[500], clean[500];
    diagnostic why = {.what = ""};
    study *s = NULL;
    snprintf(folder, sizeof folder, "%s/cuvette-rows-XXXXXX", place ? place : "/tmp");
    require(rows > 0 && mkdtemp(folder), folder, NULL);
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    write_file(path, scene_text);
    snprintf(path, sizeof path, "%s/bench.study", folder);
    write_file(path, study_text);
    snprintf(results, sizeof results, "%s/results", folder);
    require(study_read(path, &s, &why) == STATUS_OK, "study", &why);
    make_rows(s, results, rows);
    printf("%ld rows and %ld worker rows of %zu cells\n", rows, 2 * rows, study_cell_count(s));
    measure("status", do_status, s, results);
    measure("summary", do_summary, s, results);
    measure("merge", do_merge, s, results);
    study_destroy(s);
    snprintf(clean, sizeof clean, "rm -rf '%s'", folder);
    return system(clean) != 0;
}
