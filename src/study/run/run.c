/* Measures the missing repetitions of a study. They are measured in rounds: round k measures every cell once that has k
 * measured repetitions, in a new random order, so that slow drift of the machine affects all cells alike (a randomised
 * complete block design; Montgomery, Design and Analysis of Experiments, 4.1). A cell's warm-ups come immediately
 * before its first repetition in this process. A resumed run derives the current round from the rows. */
#include "base/cancel.h"
#include "study/plan/grid.h"
#include "study/plan/keep.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include "study/run/run_state.h"
#include <stdlib.h>
#include <string.h>

static status append_row(run *r, const study_row *row, diagnostic *why)
{
    csv_buffer line = {0};
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
                                        .film_hash = row->account->film_hash,
                                        .build = r->build,
                                        .wall_s = row->account->result->wall_s,
                                        .environment = r->environment.key};
    return progress_index_add(r->done, &entry, why);
}

/* Fails if taskset -p or a control group has changed the processing units. */
static status check_units(const run *r, diagnostic *why)
{
    char now[sizeof r->units];
    TRY(environment_read_units(now, sizeof now, why));
    if (strcmp(now, r->units) == 0)
        return STATUS_OK;
    return diagnose(why, STATUS_FAILURE, "run the command again: it measures the rest in the new environment",
                    "the processing units of the program changed during the run, from %s to %s", r->units, now);
}

/* Measures a frame, and writes its row. */
static status measure(run *r, size_t cell, bool warmup, diagnostic *why)
{
    scene *setting = NULL;
    job_account account = {.result = NULL};
    status code = study_cell_scene(r->s, cell, &setting, why);
    THEN(code, run_load(r, setting, why));
    THEN(code, run_noise_wait(r, why));
    THEN(code, run_render(r, setting, &(render_options){.usage = r->s->keep_workers}, &account, why));
    THEN(code, check_units(r, why));
    if (code == STATUS_OK) {
        const study_row row = {.s = r->s,
                               .cell = cell,
                               .repetition = r->done->cells[cell].next_repetition,
                               .warmup = warmup,
                               .order = r->row_number,
                               .film_expected = progress_index_film(r->done, cell, r->build, account.film_hash),
                               .disturbed = run_noise_judge(r, &account.noise),
                               .run = r->id,
                               .process = r->process,
                               .account = &account};
        code = append_row(r, &row, why);
    }
    job_account_release(&account);
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

/* How many repetitions of a cell exist when this process has finished. */
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
                                          &r.frame_job, why)
                             : out_of_memory(why);
    if (code == STATUS_OK) {
        code = environment_read("", job_isa(r.frame_job), &r.environment, why);
        THEN(code, environment_read_units(r.units, sizeof r.units, why));
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
