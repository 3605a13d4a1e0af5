/* The fuzzer of a study's tables: rows.csv, runs.json, excluded.csv, workers.csv and compare.csv of one study, from the
 * parts of the input. A first line "!" makes the checks of rows.csv right, so that changed values pass them. Rows are
 * read, verified, summarised and listed; none of it changes a file. */
#include "study/rows/rows.h"
#include "base/csv.h"
#include "base/file.h"
#include "fuzz.h"
#include "study/rows/row_files.h"
#include "study/run/progress.h"
#include "study/summary/summary.h"
#include "study/summary/verify.h"

static const char text_of_study[] = "study: fuzz\nscene: scenes/rod.yaml\n"
                                    "set: {render.width: 8, render.height: 6, render.threads: 1}\n"
                                    "grid:\n  - {render.depth: [0, 1]}\nreference: {render.depth: 3}\n"
                                    "repetitions: 2\nkeep: {workers: on}\n";
static const char *const names[] = {"rows.csv", "runs.json", "excluded.csv", "workers.csv", "compare.csv"};
enum { FILES = sizeof names / sizeof *names };

static void check_row(const checksum_columns *columns, char *const *fields, char last[CHECKSUM_TEXT], csv_buffer *out)
{
    const uint32_t content = checksum_content(columns, fields);
    checksum_text(content, checksum_chain(last, content), last);
    for (size_t k = 0; k < columns->count; k++)
        csv_text(out, columns->name[k] ? fields[k] : last);
    csv_end(out);
}

/* Writes the table again with right checks; rows with a wrong number of fields are dropped. */
static void check_again(const char *path)
{
    csv *table = NULL;
    checksum_columns columns;
    if (csv_read_rows(path, NULL, &table, NULL) != STATUS_OK || !table)
        return;
    must(checksum_columns_create(table->header, table->column_count, &columns, NULL) == STATUS_OK);
    csv_buffer out = {0};
    char last[CHECKSUM_TEXT] = "";
    for (size_t k = 0; k < table->column_count; k++)
        csv_text(&out, table->header[k]);
    csv_end(&out);
    for (size_t i = 0; i < table->row_count; i++) {
        if (table->broken[i])
            continue;
        if (!last[0])
            snprintf(last, sizeof last, "%.16s", csv_field(table, i, csv_column(table, "run")));
        check_row(&columns, table->fields + i * table->column_count, last, &out);
    }
    must(file_write(path, out.text, NULL) == STATUS_OK);
    csv_buffer_free(&out);
    checksum_columns_free(&columns);
    csv_destroy(table);
}

static void write_files(fuzz_part rest)
{
    const bool right = rest.size > 2 && memcmp(rest.at, "!\n", 2) == 0;
    rest = right ? (fuzz_part){rest.at + 2, rest.size - 2} : rest;
    for (int i = 0; i < FILES; i++) {
        char *name = text_format("results/fuzz/%s", names[i]), *path = fuzz_path(name);
        fuzz_part part;
        if (fuzz_next(&rest, &part))
            fuzz_write(name, part.at, part.size);
        else
            unlink(path);
        if (i == 0 && right)
            check_again(path);
        free(name);
        free(path);
    }
}

static void read_rows(const study *s, const char *results, row_kind kind)
{
    row_files *files = NULL;
    diagnostic why = {.what = ""};
    const status code = row_files_read(s, results, kind, &files, &why);
    if (code != STATUS_OK) {
        must(!files && why.file[0]);
        must_refuse(code, &why);
        return;
    }
    for (size_t i = 0; i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        must(ref->cell < study_cell_count(s) && ref->row < ref->table->row_count && ref->repetition >= 0);
        must(ref->run < 0 || (size_t)ref->run < files->runs->count);
        row_field_real(ref, "wall_s");
    }
    row_files_destroy(files);
}

/* A table may have no rows, which is no fault of the input. */
static void read_all(const study *s, const char *results)
{
    FILE *out = fopen("/dev/null", "w");
    must(out);
    study_verdict verdict;
    diagnostic faults = {.what = ""}, why = {.what = ""};
    excluded *list = NULL;
    progress_index *index = NULL;
    if (study_verify(s, results, out, &verdict, &why) != STATUS_OK)
        must(why.what[0]);
    if (study_summary_of(s, results, &(summary_options){NULL}, out, &faults, &why) != STATUS_OK)
        must(why.what[0]);
    if (row_list_write(s, results, "all", out, &faults, &why) != STATUS_OK)
        must(why.what[0]);
    if (excluded_read(s, results, &list, &why) == STATUS_OK)
        excluded_count(list);
    if (progress_index_read(s, results, &(progress_index_filter){.environment = "", .shards = 1}, &index, &why) ==
        STATUS_OK)
        progress_index_cell_done(index, 0);
    progress_index_destroy(index);
    excluded_destroy(list);
    fclose(out);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static study *s;
    static char *results;
    if (!s) {
        char *folder = fuzz_path("results/fuzz");
        results = fuzz_path("results");
        must(study_read_text("experiments/fuzz.study", text_of_study, strlen(text_of_study), &s, NULL) == STATUS_OK);
        must(mkdir(results, 0700) == 0 && mkdir(folder, 0700) == 0);
        free(folder);
    }
    write_files((fuzz_part){(const char *)data, size});
    read_rows(s, results, ROWS);
    read_rows(s, results, WORKER_ROWS);
    read_rows(s, results, COMPARE_ROWS);
    read_all(s, results);
    return 0;
}
