/* Runs what a study lacks. Repetitions go in rounds: round k measures every cell once that has k measured
 * repetitions, in an order shuffled afresh, so that slow drift of the machine falls on all cells alike (a
 * randomised complete block design; Montgomery, Design and Analysis of Experiments, 4.1). A cell's warm-ups come
 * right before its first repetition in this process. A continued run finds the round where it stopped from the rows
 * themselves. */
#include "study/keep.h"
#include "study/order.h"
#include "study/row_files.h"
#include "study/rows.h"
#include "study/run_state.h"
#include <fcntl.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

status run_interrupted(diagnostic *why)
{
    return diagnose(why, STATUS_INTERRUPTED, "run it again: it goes on from here", "stopped; all rows so far are kept");
}

bool run_should_stop(const run *r)
{
    return r->options->stop && r->options->stop(r->options->context);
}

bool run_frame_progress(void *of, double share_done)
{
    run *r = of;
    progress_show(r->line, share_done);
    return !run_should_stop(r);
}

static void choose_cells(run *r)
{
    size_t total = study_cell_count(r->s);
    size_t shards = r->options->shards > 1 ? (size_t)r->options->shards : 1;
    size_t shard = shards > 1 ? (size_t)r->options->shard : 0;
    for (size_t i = 0; i < total; i++)
        r->order[i] = i;
    if (r->s->shuffle)
        order_shuffle(r->s->seed, ORDER_STREAM_SHARDS, r->order, total);
    for (size_t i = shard; i < total; i += shards)
        r->cells[r->cell_count++] = r->order[i];
}

/* Linux forgets the highest resident memory so far when 5 is written there (proc(5)); elsewhere it stays as it is. */
static void reset_peak_memory(void)
{
    int fd = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
    if (fd < 0)
        return;
    ssize_t written = write(fd, "5", 1);
    (void)written;
    close(fd);
}

static status append_row(run *r, const study_row *row, diagnostic *why)
{
    csv_line line = {0};
    status code = STATUS_OK;
    if (r->workers) {
        worker_rows_write(&line, row);
        code = line.failed ? out_of_memory(why) : table_append(r->workers, line.text, line.size, why);
        csv_line_free(&line);
    }
    if (code == STATUS_OK) {
        row_write(&line, row);
        code = line.failed ? out_of_memory(why) : table_append(r->rows, line.text, line.size, why);
        csv_line_free(&line);
    }
    if (code != STATUS_OK)
        return code;
    r->row_number++;
    r->ran++;
    ledger_entry entry = {row->cell, row->repetition, row->warmup, row->film_hash, row->frame->wall_s};
    return ledger_add(r->done, &entry, why);
}

static bool show_motion(void *of, double share_done)
{
    run *r = of;
    progress_moving(r->line, share_done);
    return !run_should_stop(r);
}

status run_prepare_scene(run *r, scene *setting, diagnostic *why)
{
    const load_watch watch = {show_motion, r};
    status code = shelf_load(&r->meshes, setting, &watch, why);
    if (code == STATUS_INTERRUPTED)
        return run_interrupted(why);
    return code == STATUS_OK ? renderer_prepare(r->tracer, setting, why) : code;
}

/* One frame, one row. */
static status measure(run *r, size_t cell, bool warmup, diagnostic *why)
{
    if (run_should_stop(r))
        return run_interrupted(why);
    scene *setting = NULL;
    status code = study_cell_scene(r->s, cell, &setting, why);
    if (code == STATUS_OK)
        code = run_prepare_scene(r, setting, why);
    if (code != STATUS_OK) {
        scene_destroy(setting);
        return code;
    }
    const ledger_cell *known = &r->done->cells[cell];
    study_row row = {.of = r->s,
                     .cell = cell,
                     .setting = setting,
                     .repetition = known->next_repetition,
                     .warmup = warmup,
                     .order = r->row_number,
                     .level = r->level};
    render_options options = {.progress = run_frame_progress, .context = r};
    render_result *frame = NULL;
    reset_peak_memory();
    hardware_counts counted = hardware_counter_read(r->hardware);
    usage used = usage_now();
    code = renderer_render(r->tracer, setting, &options, &frame, why);
    row.used = usage_since(&used);
    row.hardware = hardware_counts_since(r->hardware, &counted);
    if (code == STATUS_OK) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        row.time_ms = (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
        row.frame = frame;
        row.film_hash = film_hash(frame->picture);
        row.film_expected = ledger_film(r->done, cell, row.film_hash);
        code = append_row(r, &row, why);
    } else if (code == STATUS_INTERRUPTED) {
        code = run_interrupted(why);
    }
    render_result_destroy(frame);
    scene_destroy(setting);
    return code;
}

static status measure_warm(run *r, size_t cell, diagnostic *why)
{
    status code = STATUS_OK;
    for (long i = 0; code == STATUS_OK && !r->warm[cell] && i < r->s->warmups; i++)
        code = measure(r, cell, true, why);
    if (code != STATUS_OK)
        return code;
    r->warm[cell] = true;
    return measure(r, cell, false, why);
}

static status run_rounds(run *r, diagnostic *why)
{
    for (long round = 0; round < r->s->repetitions_max; round++) {
        for (size_t i = 0; i < r->cell_count; i++)
            r->order[i] = i;
        if (r->s->shuffle)
            order_shuffle(r->s->seed, (uint64_t)round, r->order, r->cell_count);
        for (size_t i = 0; i < r->cell_count; i++) {
            size_t cell = r->cells[r->order[i]];
            if (r->done->cells[cell].counted > (size_t)round || ledger_cell_done(r->done, cell))
                continue;
            progress_count(r->line, cell, r->done, r->cells, r->cell_count);
            status code = measure_warm(r, cell, why);
            if (code != STATUS_OK)
                return code;
        }
    }
    progress_measured(r->line, r->done, r->cells, r->cell_count);
    return STATUS_OK;
}

status study_run(const study *s, const study_options *options, size_t *ran, diagnostic *why)
{
    if (ran)
        *ran = 0;
    if (options->shards > 1 && (options->shard < 0 || options->shard >= options->shards))
        return diagnose(why, STATUS_BAD_INPUT, "write --shard i/N with i from 0 to N - 1",
                        "there is no shard %ld of %ld", options->shard, options->shards);
    size_t total = study_cell_count(s);
    run r = {.s = s,
             .options = options,
             .folder = study_folder(s, options->results),
             .cells = calloc(total, sizeof *r.cells),
             .warm = calloc(total, sizeof *r.warm),
             .order = calloc(total, sizeof *r.order),
             .compared = calloc(total, sizeof *r.compared),
             .line = progress_begin(s, options)};
    bool has_memory = r.folder && r.cells && r.warm && r.order && r.compared && r.line;
    status code = has_memory ? ledger_read(s, options->results, &r.done, why) : out_of_memory(why);
    if (code == STATUS_OK)
        code = run_find_compared(&r, why);
    if (code == STATUS_OK) {
        choose_cells(&r);
        bool idle = run_complete(&r);
        if (!idle) {
            code = run_prepare(&r, why);
            if (code == STATUS_OK)
                code = run_rounds(&r, why);
            if (code == STATUS_OK)
                code = run_keep_all(&r, why);
        }
        if (code == STATUS_OK)
            code = keep_index(s, r.folder, !idle, why);
    }
    if (ran)
        *ran = r.ran;
    run_release(&r);
    return code;
}
