#include "base/file.h"
#include "study/quick.h"
#include "study/row_files.h"
#include "study/run_state.h"
#include "scene/model/open.h"
#include <stdlib.h>
#include <string.h>

/* Worker rows are written before their row; worker rows at the end without a row are from a killed process. */
static status set_orphans_aside(run *r, const csv *rows, const char *path, diagnostic *why)
{
    csv *workers = NULL;
    status code = csv_read_rows(path, scene_root(r->s->base), &workers, why);
    if (code != STATUS_OK || !workers || !workers->header) {
        csv_destroy(workers);
        return code;
    }
    int cell = csv_column(workers, "cell"), repetition = csv_column(workers, "repetition");
    int row_cell = rows ? csv_column(rows, "cell") : -1, row_repetition = rows ? csv_column(rows, "repetition") : -1;
    size_t keep = workers->row_count;
    for (bool orphan = true; keep > 0 && cell >= 0 && repetition >= 0; keep--) {
        for (size_t i = row_cell >= 0 && row_repetition >= 0 ? rows->row_count : 0; orphan && i > 0; i--)
            orphan = strcmp(csv_field(rows, i - 1, row_cell), csv_field(workers, keep - 1, cell)) != 0 ||
                     strcmp(csv_field(rows, i - 1, row_repetition), csv_field(workers, keep - 1, repetition)) != 0;
        if (!orphan)
            break;
    }
    code = table_set_aside(r->workers.file, workers->start[keep], why);
    csv_destroy(workers);
    return code;
}

static status open_table(const run *r, row_kind kind, row_table *out, char **path, diagnostic *why)
{
    char *header = row_file_header(r->s, kind);
    *path = row_file_path(r->folder, kind, r->options->shard, r->options->shards);
    status code = *path && header ? table_open(*path, header, &out->file, why) : out_of_memory(why);
    char **names = header ? malloc((strlen(header) + 1) * sizeof *names) : NULL;
    if (code == STATUS_OK && names) {
        header[strcspn(header, "\n")] = 0;
        const size_t count = csv_split(header, names);
        code = check_columns_create(names, count, &out->columns, why);
    } else if (code == STATUS_OK) {
        code = out_of_memory(why);
    }
    memcpy(out->last, r->id, sizeof out->last);
    free(names);
    free(header);
    return code;
}

static status open_tables(run *r, diagnostic *why)
{
    char *path = NULL, *workers_path = NULL, *compare_path = NULL;
    csv *rows = NULL;
    status code = open_table(r, ROWS, &r->rows, &path, why);
    if (code == STATUS_OK && (code = csv_read_rows(path, scene_root(r->s->base), &rows, why)) == STATUS_OK && rows)
        r->row_number = rows->row_count;
    if (code == STATUS_OK && r->s->keep_workers)
        code = open_table(r, WORKER_ROWS, &r->workers, &workers_path, why);
    if (code == STATUS_OK && r->workers.file)
        code = set_orphans_aside(r, rows, workers_path, why);
    if (code == STATUS_OK && r->s->reference.count)
        code = open_table(r, COMPARE_ROWS, &r->compares, &compare_path, why);
    csv_destroy(rows);
    free(path);
    free(workers_path);
    free(compare_path);
    return code;
}

status run_read_rows(run *r, diagnostic *why)
{
    progress_index_destroy(r->done);
    r->done = NULL;
    const progress_index_filter filter = {.environment = r->options->any_environment ? "" : r->here.key,
                                          .shard = r->options->by_repetition ? r->options->shard : 0,
                                          .shards = r->options->by_repetition ? r->options->shards : 1};
    return progress_index_read(r->s, r->options->results, &filter, &r->done, why);
}

/* The id comes first: the tables' chains begin with it. */
status run_prepare(run *r, diagnostic *why)
{
    const topology *machine = NULL;
    TRY(quick_check_runs(r->s, r->folder, why));
    TRY(file_make_directory(r->folder, why));
    TRY(job_machine(r->with, &machine, why));
    runs_make_id(&r->here, r->id);
    TRY(open_tables(r, why));
    TRY(run_read_rows(r, why));
    TRY(run_find_compared(r, why));
    return runs_begin(r->s, r->folder, machine, &r->here, r->options->shard, r->options->shards, r->id, why);
}

status run_seal_rows(const run *r, diagnostic *why)
{
    const row_table *const tables[] = {[ROWS] = &r->rows, [WORKER_ROWS] = &r->workers, [COMPARE_ROWS] = &r->compares};
    run_seal seals[3];
    size_t count = 0;
    for (row_kind kind = ROWS; kind <= COMPARE_ROWS; kind++)
        if (tables[kind]->file) {
            run_seal *seal = &seals[count++];
            *seal = (run_seal){.table = row_file_stem(kind), .rows = tables[kind]->count};
            memcpy(seal->check, tables[kind]->last, sizeof seal->check);
        }
    return runs_end(r->folder, scene_root(r->s->base), r->options->shard, r->options->shards, r->id, seals, count, why);
}

static void close_table(row_table *t)
{
    table_close(t->file);
    check_columns_free(&t->columns);
}

void run_release(run *r)
{
    progress_end(r->line);
    job_destroy(r->with);
    reference_release(&r->held);
    close_table(&r->compares);
    close_table(&r->workers);
    close_table(&r->rows);
    progress_index_destroy(r->done);
    free(r->compared);
    free(r->order);
    free(r->warm);
    free(r->cells);
    free(r->folder);
}
