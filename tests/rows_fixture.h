/* Rows that a test has changed, made consistent again: their checks, and the ends of runs in runs.json. */
#pragma once

#include "study/rows/checksum.h"
#include "base/csv.h"
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Changes the fields of a row, which may be pointed to other texts; returns whether the row stays. */
typedef bool rows_editor(void *context, const csv *table, char **fields);

/* Computes the checks of all rows of the file again, after edit (NULL: none) of each. */
__attribute__((unused)) static void rows_edit(const char *path, rows_editor *edit, void *context)
{
    csv *table = NULL;
    checksum_columns columns;
    char last[256][2][CHECKSUM_TEXT]; /* the runs, and the last check of each */
    size_t runs = 0;
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    assert_int_equal(checksum_columns_create(table->header, table->column_count, &columns, NULL), STATUS_OK);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fwrite(table->raw, 1, table->start[0], out);
    const int run = csv_column(table, "run");
    for (size_t i = 0; i < table->row_count; i++) {
        char **fields = table->fields + i * table->column_count;
        if (edit && !edit(context, table, fields))
            continue;
        size_t at = 0;
        while (at < runs && strncmp(last[at][0], fields[run], 16) != 0)
            at++;
        assert_true(at < 256);
        if (at == runs) {
            snprintf(last[at][0], CHECKSUM_TEXT, "%.16s", fields[run]);
            memcpy(last[runs++][1], last[at][0], CHECKSUM_TEXT);
        }
        csv_line line = {0};
        for (size_t k = 0; k < table->column_count; k++)
            csv_text(&line, fields[k]);
        csv_end(&line);
        assert_int_equal(checksum_lines(&columns, last[at][1], &line, NULL), STATUS_OK);
        fputs(line.text, out);
        csv_line_free(&line);
    }
    assert_int_equal(fclose(out), 0);
    checksum_columns_free(&columns);
    csv_destroy(table);
}

__attribute__((unused)) static void rows_recheck(const char *path)
{
    rows_edit(path, NULL, NULL);
}

/* Removes the numbers of rows from a list of runs, so that rows may be removed. */
__attribute__((unused)) static void rows_unseal(const char *path)
{
    json_t *list = json_load_file(path, 0, NULL), *run;
    size_t i;
    assert_non_null(list);
    json_array_foreach(json_object_get(list, "runs"), i, run) json_object_del(run, "rows");
    assert_int_equal(json_dump_file(list, path, 0), 0);
    json_decref(list);
}
