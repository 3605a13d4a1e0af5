#include "base/file.h"
#include "study/manifest.h"
#include "study/row_files.h"
#include "study/run_state.h"
#include <stdlib.h>
#include <string.h>

static status no_memory(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "", "out of memory");
}

/* Worker rows are written before the row that they belong to; those without one are what a killed process left. */
static status set_orphans_aside(run *r, const char *path, diagnostic *why)
{
    row_files *rows = NULL;
    csv *workers = NULL;
    status code = row_files_read(r->s, r->options->results, ROWS, &rows, why);
    if (code == STATUS_OK)
        code = csv_read(path, &workers, why);
    size_t keep = code == STATUS_OK && workers ? workers->row_count : 0;
    for (bool orphan = true; keep > 0 && orphan; keep -= orphan) {
        double cell = csv_field_real(workers, keep - 1, csv_column(workers, "cell"));
        double repetition = csv_field_real(workers, keep - 1, csv_column(workers, "repetition"));
        for (size_t i = rows->row_count; orphan && i > 0; i--)
            orphan = (double)rows->rows[i - 1].cell != cell || (double)rows->rows[i - 1].repetition != repetition;
    }
    if (code == STATUS_OK && workers && workers->header)
        code = table_set_aside(r->workers, workers->start[keep], why);
    csv_destroy(workers);
    row_files_destroy(rows);
    return code;
}

static status open_table(run *r, row_kind kind, table **out, diagnostic *why)
{
    char *path = row_file_path(r->folder, kind, r->options->shard, r->options->shards);
    char *header = row_file_header(r->s, kind);
    status code = path && header ? table_open(path, header, out, why) : no_memory(why);
    csv *written = NULL;
    if (code == STATUS_OK && kind == ROWS && (code = csv_read(path, &written, why)) == STATUS_OK && written)
        r->row_number = written->row_count;
    if (code == STATUS_OK && kind == WORKER_ROWS)
        code = set_orphans_aside(r, path, why);
    csv_destroy(written);
    free(header);
    free(path);
    return code;
}

/* Folder, locks, the rows so far (read again under the lock), manifest, machine, renderer. */
status run_prepare(run *r, diagnostic *why)
{
    status code = isa_choose(&r->level, why);
    if (code == STATUS_OK)
        code = file_make_directory(r->folder, why);
    if (code == STATUS_OK)
        code = open_table(r, ROWS, &r->rows, why);
    if (code == STATUS_OK && r->s->keep_workers)
        code = open_table(r, WORKER_ROWS, &r->workers, why);
    if (code != STATUS_OK)
        return code;
    ledger_destroy(r->done);
    code = ledger_read(r->s, r->options->results, &r->done, why);
    if (code == STATUS_OK)
        code = topology_create(&r->machine, why);
    if (code == STATUS_OK)
        code = manifest_write(r->s, r->folder, r->machine, r->level, r->options->shard, r->options->shards, why);
    /* Counts the threads that start after it, so it comes before the pool. */
    r->hardware = hardware_counter_create();
    return code == STATUS_OK ? renderer_create(r->level, r->machine, &r->tracer, why) : code;
}

void run_release(run *r)
{
    progress_end(r->line);
    renderer_destroy(r->tracer);
    if (r->hardware)
        hardware_counter_destroy(r->hardware);
    topology_destroy(r->machine);
    table_close(r->workers);
    table_close(r->rows);
    ledger_destroy(r->done);
    free(r->order);
    free(r->warm);
    free(r->cells);
    free(r->folder);
}
