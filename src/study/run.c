/* Measures the missing repetitions of a study. They are measured in rounds: round k measures every cell once that has k
 * measured repetitions, in a new random order, so that slow drift of the machine affects all cells alike (a randomised
 * complete block design; Montgomery, Design and Analysis of Experiments, 4.1). A cell's warm-ups come immediately
 * before its first repetition in this process. A resumed run derives the current round from the rows. */
#include "base/cancel.h"
#include "study/keep.h"
#include "study/order.h"
#include "study/row_files.h"
#include "study/rows.h"
#include "study/run_noise.h"
#include "study/run_room.h"
#include "study/run_state.h"
#include <stdlib.h>
#include <string.h>

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

status run_append(row_table *to, csv_line *lines, diagnostic *why)
{
    char last[CHECK_TEXT];
    memcpy(last, to->last, sizeof last);
    status code = check_lines(&to->columns, last, lines, why);
    THEN(code, table_append(to->file, lines->text, lines->size, why));
    if (code == STATUS_OK) {
        memcpy(to->last, last, sizeof last);
        for (const char *at = lines->text; (at = strchr(at, '\n')); at++)
            to->count++;
    }
    csv_line_free(lines);
    return code;
}

static status append_row(run *r, const study_row *row, diagnostic *why)
{
    csv_line line = {0};
    if (r->workers.file) {
        worker_rows_write(&line, row);
        TRY(run_append(&r->workers, &line, why));
    }
    row_write(&line, row);
    TRY(run_append(&r->rows, &line, why));
    r->row_number++;
    r->ran++;
    const progress_index_entry entry = {.cell = row->cell,
                                        .repetition = row->repetition,
                                        .warmup = row->warmup,
                                        .disturbed = row->disturbed,
                                        .film_hash = row->made->film_hash,
                                        .build = r->build,
                                        .wall_s = row->made->result->wall_s,
                                        .environment = r->here.key};
    return progress_index_add(r->done, &entry, why);
}

static void show_motion(void *of, double share_done)
{
    progress_moving(((run *)of)->line, share_done);
}

static void show_frame(void *of, double share_done)
{
    progress_show(((run *)of)->line, share_done);
}

/* As the ask of a token: the work outside of the run's shield is cancelled. */
static bool is_outside_cancelled(void *unused)
{
    (void)unused;
    return cancel_hurries();
}

static status say_interrupted(status code, diagnostic *why)
{
    return code != STATUS_INTERRUPTED
               ? code
               : diagnose(why, code, "run the command again to resume", "interrupted; all completed rows are kept");
}

status run_load(run *r, scene *setting, diagnostic *why)
{
    cancel_token token = {.ask = is_outside_cancelled};
    cancel_begin(&token);
    const status code = job_load(r->with, setting, &(load_watch){show_motion, r}, why);
    cancel_end(&token);
    return say_interrupted(code, why);
}

status run_render(run *r, const scene *setting, const render_options *wanted, job_account *out, diagnostic *why)
{
    render_options options = wanted ? *wanted : (render_options){.progress = NULL};
    options.progress = show_frame;
    options.context = r;
    cancel_token token = {.ask = is_outside_cancelled};
    cancel_begin(&token);
    const status code = job_render(r->with, setting, &options, out, why);
    cancel_end(&token);
    return say_interrupted(code, why);
}

/* taskset -p, or a control group that was changed. */
static status check_units(const run *r, diagnostic *why)
{
    char now[sizeof r->units];
    environment_read_units(now, sizeof now);
    if (strcmp(now, r->units) == 0)
        return STATUS_OK;
    return diagnose(why, STATUS_FAILURE, "run the command again: it measures the rest in the new environment",
                    "the processing units of the program changed during the run, from %s to %s", r->units, now);
}

/* One frame and its row. */
static status measure(run *r, size_t cell, bool warmup, diagnostic *why)
{
    scene *setting = NULL;
    job_account made = {.result = NULL};
    status code = study_cell_scene(r->s, cell, &setting, why);
    THEN(code, run_load(r, setting, why));
    THEN(code, run_noise_wait(r, why));
    THEN(code, run_render(r, setting, &(render_options){.usage = r->s->keep_workers}, &made, why));
    THEN(code, check_units(r, why));
    if (code == STATUS_OK) {
        const study_row row = {.of = r->s,
                               .cell = cell,
                               .repetition = r->done->cells[cell].next_repetition,
                               .warmup = warmup,
                               .order = r->row_number,
                               .film_expected = progress_index_film(r->done, cell, r->build, made.film_hash),
                               .disturbed = run_noise_judge(r, &made.noise),
                               .run = r->id,
                               .process = r->process,
                               .made = &made};
        code = append_row(r, &row, why);
    }
    job_account_release(&made);
    scene_destroy(setting);
    return code;
}

static status measure_warm(run *r, size_t cell, diagnostic *why)
{
    for (long i = 0; !r->warm[cell] && i < r->s->warmups; i++)
        TRY(measure(r, cell, true, why));
    r->warm[cell] = true;
    return measure(r, cell, false, why);
}

long study_processes(const study *s)
{
    return s->processes * (s->processes > 1 && s->repetitions_max > s->repetitions_min ? 2 : 1);
}

/* The repetitions of a cell that exist when this process is done. */
static long rounds_of(const run *r)
{
    const long least = progress_index_least(r->done), most = progress_index_most(r->done);
    const long process = r->options->process, processes = r->s->processes;
    if (process == 0)
        return most;
    if (process <= processes)
        return (least * process + processes - 1) / processes;
    return least + ((most - least) * (process - processes) + processes - 1) / processes;
}

static bool lacks_rounds(const run *r)
{
    bool lacks = false;
    for (size_t i = 0; i < r->cell_count; i++) {
        const size_t cell = r->cells[i];
        lacks |= r->done->cells[cell].counted < (size_t)rounds_of(r) && !progress_index_cell_done(r->done, cell);
    }
    return lacks;
}

static status run_rounds(run *r, diagnostic *why)
{
    for (long round = 0; round < rounds_of(r); round++) {
        for (size_t i = 0; i < r->cell_count; i++)
            r->order[i] = i;
        if (r->s->shuffle)
            order_shuffle(r->s->seed, (uint64_t)round, r->order, r->cell_count);
        for (size_t i = 0; i < r->cell_count; i++) {
            size_t cell = r->cells[r->order[i]];
            if (r->done->cells[cell].counted > (size_t)round || progress_index_cell_done(r->done, cell))
                continue;
            progress_count(r->line, cell, r->done, r->cells, r->cell_count);
            TRY(measure_warm(r, cell, why));
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
             .process = (int)(options->process ? options->process - 1 : 0),
             .folder = study_folder(s, options->results),
             .cells = calloc(total, sizeof *r.cells),
             .warm = calloc(total, sizeof *r.warm),
             .order = calloc(total, sizeof *r.order),
             .compared = calloc(total, sizeof *r.compared),
             .line = progress_begin(s, options)};
    cancel_token shield; /* rows and images of what is complete are written, however the run ends */
    cancel_shield(&shield);
    bool has_memory = r.folder && r.cells && r.warm && r.order && r.compared && r.line;
    status code = has_memory ? job_create(&(job_settings){.measured = true, .fresh_peak = true, .keeps_meshes = true},
                                          &r.with, why)
                             : out_of_memory(why);
    if (code == STATUS_OK) {
        code = environment_read("", job_isa(r.with), &r.here, why);
        environment_read_units(r.units, sizeof r.units);
        r.build = progress_index_build();
    }
    THEN(code, run_read_rows(&r, why));
    THEN(code, run_find_compared(&r, why));
    bool renumbered = false;
    THEN(code, keep_renumber(s, r.folder, false, &renumbered, why));
    if (code == STATUS_OK) {
        run_choose_cells(&r);
        bool idle = options->process ? !lacks_rounds(&r) : run_complete(&r);
        if (!idle) {
            code = run_check_room(&r, why);
            THEN(code, run_prepare(&r, why));
            THEN(code, run_rounds(&r, why));
            if (!options->process)
                THEN(code, run_keep_all(&r, why));
            diagnostic unsealed = {.what = ""};
            const status sealed = r.id[0] ? run_seal_rows(&r, code == STATUS_OK ? why : &unsealed) : STATUS_OK;
            code = code == STATUS_OK ? sealed : code;
        }
        THEN(code, keep_index(s, r.folder, !idle || renumbered, why));
    }
    if (ran)
        *ran = r.ran;
    run_release(&r);
    cancel_end(&shield);
    return code;
}
