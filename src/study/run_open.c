#include "base/file.h"
#include "study/manifest.h"
#include "study/row_files.h"
#include "study/run_state.h"
#include "scene/model/open.h"
#include <stdlib.h>
#include <string.h>

/* Worker rows are written before their row; worker rows at the end without a row are from a killed process. */
static status set_orphans_aside(run *r, const csv *rows, const char *path, diagnostic *why)
{
    csv *workers = NULL;
    status code = csv_read_below(path, scene_root(r->s->base), &workers, why);
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
    code = table_set_aside(r->workers, workers->start[keep], why);
    csv_destroy(workers);
    return code;
}

static status open_table(const run *r, row_kind kind, table **out, char **path, diagnostic *why)
{
    char *header = row_file_header(r->s, kind);
    *path = row_file_path(r->folder, kind, r->options->shard, r->options->shards);
    status code = *path && header ? table_open(*path, header, out, why) : out_of_memory(why);
    free(header);
    return code;
}

static status open_tables(run *r, diagnostic *why)
{
    char *path = NULL, *workers_path = NULL, *compare_path = NULL;
    csv *rows = NULL;
    status code = open_table(r, ROWS, &r->rows, &path, why);
    if (code == STATUS_OK && (code = csv_read_below(path, scene_root(r->s->base), &rows, why)) == STATUS_OK && rows)
        r->row_number = rows->row_count;
    if (code == STATUS_OK && r->s->keep_workers)
        code = open_table(r, WORKER_ROWS, &r->workers, &workers_path, why);
    if (code == STATUS_OK && r->workers)
        code = set_orphans_aside(r, rows, workers_path, why);
    if (code == STATUS_OK && r->s->reference.count)
        code = open_table(r, COMPARE_ROWS, &r->compares, &compare_path, why);
    csv_destroy(rows);
    free(path);
    free(workers_path);
    free(compare_path);
    return code;
}

/* Opens folder, locks, existing rows (read again under the lock), manifest, job. */
status run_prepare(run *r, diagnostic *why)
{
    const job_settings settings = {.measured = true,
                                   .fresh_peak = true,
                                   .keeps_meshes = true,
                                   .stop = r->options->stop,
                                   .context = r->options->context};
    const topology *machine = NULL;
    TRY(job_create(&settings, &r->with, why));
    TRY(file_make_directory(r->folder, why));
    TRY(open_tables(r, why));
    progress_index_destroy(r->done);
    TRY(progress_index_read(r->s, r->options->results, &r->done, why));
    TRY(run_find_compared(r, why));
    TRY(job_machine(r->with, &machine, why));
    return manifest_write(r->s, r->folder, machine, job_isa(r->with), r->options->shard, r->options->shards, why);
}

void run_release(run *r)
{
    progress_end(r->line);
    job_destroy(r->with);
    reference_release(&r->held);
    table_close(r->compares);
    table_close(r->workers);
    table_close(r->rows);
    progress_index_destroy(r->done);
    free(r->compared);
    free(r->order);
    free(r->warm);
    free(r->cells);
    free(r->folder);
}
