/* Estimates by numbers of rows, columns, files and pixels. */
#include "study/run_room.h"
#include "base/thread_team.h"
#include "scene/model/scene.h"
#include "study/keep.h"
#include "study/row_files.h"
#include <stdlib.h>

/* Bytes of a value with its comma; of a run in runs.json, which is rewritten next to the old one. */
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

typedef struct widths {
    double rows, workers, compares;
} widths;

static status add_cell(const run *r, size_t cell, const widths *columns, disk_room *out, diagnostic *why)
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
        disk_room_add(out, 1, 0, 16 * pixels + 20000); /* a reference, unless cells share it */
    }
    const status code = keeps ? keep_room(r->s, r->folder, cell, setting, out, why) : STATUS_OK;
    scene_destroy(setting);
    return code;
}

status run_room(const run *r, disk_room *out, diagnostic *why)
{
    widths columns;
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
