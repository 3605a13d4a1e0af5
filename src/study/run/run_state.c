/* A running study: its files, what exists already, the disk space that it needs, loading and rendering. */
#include "study/run/run_state.h"
#include "base/cancel.h"
#include "base/file.h"
#include "base/worker_pool.h"
#include "scene/model/open.h"
#include "scene/model/scene.h"
#include "study/plan/grid.h"
#include "study/plan/keep.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include <stdlib.h>
#include <string.h>

/* --- what exists --- */

void run_choose_cells(run *r)
{
    size_t total = study_cell_count(r->s);
    const bool divided = r->options->shards > 1 && !r->options->by_repetition;
    size_t shards = divided ? (size_t)r->options->shards : 1;
    size_t shard = shards > 1 ? (size_t)r->options->shard : 0;
    for (size_t i = 0; i < total; i++)
        r->order[i] = i;
    if (r->s->shuffle)
        order_shuffle(r->s->seed, ORDER_STREAM_SHARDS, r->order, total);
    for (size_t i = shard; i < total; i += shards)
        r->cells[r->cell_count++] = r->order[i];
}

status run_read_rows(run *r, diagnostic *why)
{
    progress_index_destroy(r->done);
    r->done = NULL;
    const progress_index_filter filter = {.environment = r->options->any_environment ? "" : r->environment.key,
                                          .shard = r->options->by_repetition ? r->options->shard : 0,
                                          .shards = r->options->by_repetition ? r->options->shards : 1};
    return progress_index_read(r->s, r->options->results, &filter, &r->done, why);
}

status run_find_compared(run *r, diagnostic *why)
{
    row_files *files;
    if (!r->s->reference.count)
        return STATUS_OK;
    status code = row_files_read(r->s, r->options->results, COMPARE_ROWS, &files, why);
    for (size_t i = 0; code == STATUS_OK && i < files->row_count; i++)
        r->compared[files->rows[i].cell] = true;
    row_files_destroy(files);
    return code;
}

/* --- files of rows --- */

/* Worker rows are written before the row of their frame; those at the end without such a row are from a killed
 * process. */
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
        code = checksum_columns_create(names, count, &out->columns, why);
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

/* The id comes first, because the chains of checksums begin with it. */
status run_prepare(run *r, diagnostic *why)
{
    const topology *machine = NULL;
    TRY(quick_check_runs(r->s, r->folder, why));
    TRY(file_make_directory(r->folder, why));
    TRY(job_machine(r->frame_job, &machine, why));
    runs_make_id(&r->environment, r->id);
    TRY(open_tables(r, why));
    TRY(run_read_rows(r, why));
    TRY(run_find_compared(r, why));
    return runs_begin(r->s, r->folder, machine, &r->environment, r->options->shard, r->options->shards, r->id, why);
}

status run_append(row_table *to, csv_buffer *lines, diagnostic *why)
{
    char last[CHECKSUM_TEXT];
    memcpy(last, to->last, sizeof last);
    status code = checksum_lines(&to->columns, last, lines, why);
    THEN(code, table_append(to->file, lines->text, lines->size, why));
    if (code == STATUS_OK) {
        memcpy(to->last, last, sizeof last);
        for (const char *at = lines->text; (at = strchr(at, '\n')); at++)
            to->count++;
    }
    csv_buffer_free(lines);
    return code;
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
            memcpy(seal->checksum, tables[kind]->last, sizeof seal->checksum);
        }
    return runs_end(r->folder, scene_root(r->s->base), r->options->shard, r->options->shards, r->id, seals, count, why);
}

static void close_table(row_table *t)
{
    table_close(t->file);
    checksum_columns_free(&t->columns);
}

void run_release(run *r)
{
    progress_end(r->line);
    job_destroy(r->frame_job);
    reference_release(&r->last_reference);
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

/* --- frames --- */

static void show_motion(void *context, double fraction_done)
{
    progress_moving(((run *)context)->line, fraction_done);
}

static void show_frame(void *context, double fraction_done)
{
    progress_show(((run *)context)->line, fraction_done);
}

/* Whether the work outside the run's shield is cancelled; a cancel token calls it. */
static bool is_outside_cancelled(void *unused)
{
    (void)unused;
    return cancel_hurries();
}

static status diagnose_interruption(status code, diagnostic *why)
{
    return code != STATUS_INTERRUPTED
               ? code
               : diagnose(why, code, "run the command again to resume", "interrupted; all completed rows are kept");
}

status run_load(run *r, scene *setting, diagnostic *why)
{
    cancel_token token = {.ask = is_outside_cancelled};
    cancel_begin(&token);
    const status code = job_load(r->frame_job, setting, &(load_watch){show_motion, r}, why);
    cancel_end(&token);
    return diagnose_interruption(code, why);
}

status run_render(run *r, const scene *setting, const render_options *wanted, job_account *out, diagnostic *why)
{
    render_options options = wanted ? *wanted : (render_options){.progress = NULL};
    options.progress = show_frame;
    options.context = r;
    cancel_token token = {.ask = is_outside_cancelled};
    cancel_begin(&token);
    const status code = job_render(r->frame_job, setting, &options, out, why);
    cancel_end(&token);
    return diagnose_interruption(code, why);
}

/* --- disk space --- */

/* Bytes of a value with its comma, and of a run in runs.json, whose new file exists next to the old one. */
enum { VALUE_LEAST = 2, VALUE_MOST = 18, RUN_LEAST = 4000, RUNS_MOST = 100000 };

/* The number of columns of a table. */
static status count_columns(const study *s, row_kind kind, double *count, diagnostic *why)
{
    char *header = row_file_header(s, kind);
    *count = 1;
    for (const char *c = header; c && *c; c++)
        *count += *c == ',';
    free(header);
    return header ? STATUS_OK : out_of_memory(why);
}

static void add_rows(disk_room *to, double columns, double least, double most)
{
    to->least_bytes += least * columns * VALUE_LEAST;
    to->most_bytes += most * columns * VALUE_MOST;
}

typedef struct column_counts {
    double rows, workers, compares;
} column_counts;

static status add_cell(const run *r, size_t cell, const column_counts *columns, disk_room *out, diagnostic *why)
{
    const progress_index_cell *at = &r->done->cells[cell];
    const size_t least = (size_t)progress_index_least(r->done), most = (size_t)progress_index_most(r->done);
    const bool lacks = !progress_index_cell_done(r->done, cell);
    const bool compares = r->s->reference.count && !r->compared[cell];
    const bool keeps = keep_missing(r->s, r->folder, cell);
    const double rows_least = !lacks ? 0 : at->counted < least ? (double)(least - at->counted) : 1;
    const double rows_most =
        !lacks ? 0 : (double)(most - at->counted) + (double)r->s->warmups * (double)study_processes(r->s);
    add_rows(out, columns->rows, rows_least, rows_most);
    if (!compares && !keeps && !r->s->keep_workers)
        return STATUS_OK;
    scene *setting = NULL;
    TRY(study_cell_scene(r->s, cell, &setting, why));
    const double threads = setting->render.threads > 0 ? (double)setting->render.threads : (double)thread_team_units();
    if (r->s->keep_workers)
        add_rows(out, columns->workers, rows_least, rows_most * threads);
    if (compares) {
        const double pixels = (double)setting->render.width * (double)setting->render.height;
        add_rows(out, columns->compares, 1, 1);
        disk_room_add(out, 1, 0, 16 * pixels + 20000); /* a reference, unless another cell has the same */
    }
    const status code = keeps ? keep_room(r->s, r->folder, cell, setting, out, why) : STATUS_OK;
    scene_destroy(setting);
    return code;
}

status run_room(const run *r, disk_room *out, diagnostic *why)
{
    column_counts columns;
    *out = (disk_room){.least_bytes = RUN_LEAST, .most_bytes = RUNS_MOST};
    TRY(count_columns(r->s, ROWS, &columns.rows, why));
    TRY(count_columns(r->s, WORKER_ROWS, &columns.workers, why));
    TRY(count_columns(r->s, COMPARE_ROWS, &columns.compares, why));
    for (size_t i = 0; i < r->cell_count; i++)
        TRY(add_cell(r, r->cells[i], &columns, out, why));
    return STATUS_OK;
}

status run_check_room(const run *r, diagnostic *why)
{
    disk_room needed;
    char note[DISK_ROOM_TEXT_MAX];
    TRY(run_room(r, &needed, why));
    TRY(disk_room_check(&needed, disk_room_free(r->folder), r->folder, "the run", note, why));
    if (note[0] && r->options->news)
        r->options->news(r->options->context, note);
    return STATUS_OK;
}
