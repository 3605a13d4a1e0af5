/* Estimates a run: counts what is missing, finds times from rows or trial frames, and writes the estimate as text. */
#include "study/run/estimate.h"
#include "base/cancel.h"
#include "measure/clock.h"
#include "scene/model/scene.h"
#include "study/plan/grid.h"
#include "study/plan/keep.h"
#include "study/rows/row_files.h"
#include "study/run/run_state.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pixels of the trial frames: two sizes, because a frame also has costs that do not depend on its pixels (starting
 * threads, drawing triangles). */
enum { SMALL_PIXELS = 4800, LARGE_PIXELS = 19200 };

typedef struct trials {
    run *r;
    double deadline_s;
    double *tried_s;              /* by cell, the time of one frame by its trial; NaN: not tried */
    double *cell_s;               /* by cell, the time of one frame by its rows or its trial; NaN: unknown */
    double *once_s;               /* by cell, the additional time of its first loading, which simulates slimes */
    double other_s, other_once_s; /* the means of the trials, for the cells that were not tried; NaN: none was */
    bool cut;
} trials;

/* Whether the deadline has passed; a cancel token calls it. */
static bool is_late(void *context)
{
    const trials *t = context;
    return clock_wall_s() > t->deadline_s;
}

static double mean(const double *values, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    return sum / (double)count;
}

static double pixels_of(const scene *s)
{
    return (double)s->render.width * (double)s->render.height;
}

/* Reduces the frame to at most that number of pixels, with the same aspect ratio. */
static void shrink(scene *s, double width, double height, double most)
{
    const double scale = fmin(1.0, sqrt(most / (width * height)));
    s->render.width = (int64_t)fmax(1.0, round(width * scale));
    s->render.height = (int64_t)fmax(1.0, round(height * scale));
}

static status render(const trials *t, const scene *setting, double *wall_s, diagnostic *why)
{
    job_account account = {.result = NULL};
    const status code = job_render(t->r->frame_job, setting, NULL, &account, why);
    if (code == STATUS_OK)
        *wall_s = account.result->wall_s;
    job_account_release(&account);
    return code;
}

/* Loads the cell as a run does before each frame. */
static status load(const trials *t, size_t cell, scene **out, double *took_s, diagnostic *why)
{
    const double began_s = clock_wall_s();
    TRY(study_cell_scene(t->r->s, cell, out, why));
    const status code = job_load(t->r->frame_job, *out, NULL, why);
    *took_s = clock_wall_s() - began_s;
    return code;
}

/* Renders the cell twice with few pixels and once with more. The first frame and the first loading warm up. */
static status try_cell(const trials *t, size_t cell, diagnostic *why)
{
    scene *first = NULL, *second = NULL;
    double first_s = 0, load_s = 0, small_s = NAN, large_s = NAN, *frame_s = &t->tried_s[cell];
    status code = load(t, cell, &first, &first_s, why);
    const double width = code == STATUS_OK ? (double)first->render.width : 1.0;
    const double height = code == STATUS_OK ? (double)first->render.height : 1.0;
    if (code == STATUS_OK) {
        shrink(first, width, height, SMALL_PIXELS);
        code = render(t, first, &small_s, why);
    }
    THEN(code, load(t, cell, &second, &load_s, why));
    THEN(code, render(t, first, &small_s, why));
    if (code == STATUS_OK) {
        shrink(second, width, height, LARGE_PIXELS);
        code = render(t, second, &large_s, why);
    }
    if (!isnan(large_s)) {
        const double more = pixels_of(second) - pixels_of(first);
        const double slope = more > 0 ? fmax(0.0, large_s - small_s) / more : 0.0;
        *frame_s = load_s + large_s + slope * (width * height - pixels_of(second));
    } else if (!isnan(small_s)) {
        *frame_s = load_s + small_s * width * height / pixels_of(first);
    }
    t->once_s[cell] = fmax(0.0, first_s - load_s);
    scene_destroy(first);
    scene_destroy(second);
    return code;
}

static bool lacks_rows(const run *r, size_t cell)
{
    return !progress_index_cell_done(r->done, cell);
}

static bool lacks_files(const run *r, size_t cell)
{
    return keep_missing(r->s, r->folder, cell) || (r->s->reference.count && !r->compared[cell]);
}

/* Takes the times of existing rows as trials: in study_estimate_parts, a part without rows of a cell uses those of
 * other parts. */
static void use_rows_as_trials(const trials *t)
{
    const run *r = t->r;
    for (size_t cell = 0; cell < r->done->cell_count; cell++) {
        const progress_index_cell *at = &r->done->cells[cell];
        if (at->counted)
            t->tried_s[cell] = mean(at->wall_s, at->counted);
    }
}

/* Tries the cells without rows in a random order, so that those that are tried represent the others. */
static status try_cells(trials *t, diagnostic *why)
{
    run *r = t->r;
    for (size_t i = 0; i < r->cell_count; i++)
        r->order[i] = i;
    order_shuffle(r->s->seed, 0, r->order, r->cell_count);
    for (size_t i = 0; i < r->cell_count; i++) {
        const size_t cell = r->cells[r->order[i]];
        if (r->done->cells[cell].counted || !(lacks_rows(r, cell) || lacks_files(r, cell)))
            continue;
        if (is_late(t))
            return STATUS_OK;
        diagnostic error = {.what = ""};
        cancel_token deadline = {.ask = is_late, .context = t};
        cancel_begin(&deadline);
        status code = try_cell(t, cell, &error);
        cancel_end(&deadline);
        t->cut = code == STATUS_INTERRUPTED;
        if (t->cut && !cancel_asked())
            code = STATUS_OK; /* the deadline */
        else if (code != STATUS_OK && why)
            *why = error;
        TRY(code);
    }
    return STATUS_OK;
}

/* The mean of the values of the cells that were tried; NaN if none was. */
static double mean_trial(const trials *t, const double *values)
{
    double sum = 0;
    size_t tried = 0;
    for (size_t cell = 0; cell < study_cell_count(t->r->s); cell++)
        if (!isnan(t->tried_s[cell])) {
            sum += values[cell];
            tried++;
        }
    return tried ? sum / (double)tried : NAN;
}

/* The warm-ups that the cell still needs: each further process warms it up. */
static size_t warmups_of(const run *r, size_t cell)
{
    const size_t least = (size_t)progress_index_least(r->done), counted = r->done->cells[cell].counted;
    const size_t lacking = counted < least ? least - counted : 1, processes = (size_t)r->s->processes;
    return (size_t)r->s->warmups * (least ? (lacking * processes + least - 1) / least : 1);
}

/* Counts what is missing, and finds the times of cells from rows and trials. */
static void count(const trials *t, study_estimate *out)
{
    const run *r = t->r;
    out->cells = r->cell_count;
    for (size_t i = 0; i < r->cell_count; i++) {
        const size_t cell = r->cells[i];
        const progress_index_cell *at = &r->done->cells[cell];
        const bool lacks = lacks_rows(r, cell), keeps = lacks_files(r, cell);
        t->cell_s[cell] = at->counted ? mean(at->wall_s, at->counted) : t->tried_s[cell];
        if (lacks) {
            const size_t least = (size_t)progress_index_least(r->done), most = (size_t)progress_index_most(r->done);
            out->cells_lacking++;
            out->rows_least += at->counted < least ? least - at->counted : 1;
            out->rows_most += most - at->counted;
            out->warmups += warmups_of(r, cell);
        }
        out->cells_to_keep += keeps;
        out->files += keep_missing_count(r->s, r->folder, cell);
        out->comparisons += r->s->reference.count && !r->compared[cell] ? 1 : 0;
        out->from_rows += (lacks || keeps) && at->counted ? 1 : 0;
        out->from_trials += (lacks || keeps) && !at->counted && !isnan(t->cell_s[cell]) ? 1 : 0;
    }
}

static void add_times(const trials *t, study_estimate *out)
{
    const run *r = t->r;
    for (size_t i = 0; i < r->cell_count; i++) {
        const size_t cell = r->cells[i], counted = r->done->cells[cell].counted;
        const bool lacks = lacks_rows(r, cell), keeps = lacks_files(r, cell);
        if (!lacks && !keeps)
            continue;
        const size_t least = (size_t)progress_index_least(r->done), most = (size_t)progress_index_most(r->done);
        const size_t more = (lacks ? warmups_of(r, cell) : 0) + (keeps ? 1 : 0);
        const bool tried = !isnan(t->cell_s[cell]);
        const double frame_s = tried ? t->cell_s[cell] : t->other_s;
        const double once_s = tried ? t->once_s[cell] : t->other_once_s;
        out->from_others += !tried && !isnan(t->other_s) ? 1 : 0;
        out->least_s += once_s + frame_s * (double)(more + (!lacks ? 0 : counted < least ? least - counted : 1));
        out->most_s += once_s + frame_s * (double)(more + (lacks ? most - counted : 0));
    }
}

/* Reads the existing rows, and tries the cells that have none. */
static status survey(trials *t, diagnostic *why)
{
    run *r = t->r;
    TRY(run_read_rows(r, why));
    TRY(run_find_compared(r, why));
    run_choose_cells(r);
    if (!isinf(t->deadline_s))
        TRY(try_cells(t, why));
    t->other_s = mean_trial(t, t->tried_s);
    t->other_once_s = mean_trial(t, t->once_s);
    return STATUS_OK;
}

static status sum_up(const trials *t, study_estimate *out, diagnostic *why)
{
    *out = (study_estimate){.cut = t->cut, .free_bytes = disk_room_free(t->r->folder)};
    count(t, out);
    add_times(t, out);
    return run_room(t->r, &out->needed, why);
}

static status open(trials *t, const study_options *options, diagnostic *why)
{
    run *r = t->r;
    const size_t total = study_cell_count(r->s);
    const job_settings settings = {.keeps_meshes = true};
    r->folder = study_folder(r->s, options->results);
    r->cells = calloc(total, sizeof *r->cells);
    r->order = calloc(total, sizeof *r->order);
    r->compared = calloc(total, sizeof *r->compared);
    t->tried_s = malloc(total * sizeof *t->tried_s);
    t->cell_s = malloc(total * sizeof *t->cell_s);
    t->once_s = calloc(total, sizeof *t->once_s);
    if (!r->folder || !r->cells || !r->order || !r->compared || !t->tried_s || !t->cell_s || !t->once_s)
        return out_of_memory(why);
    for (size_t i = 0; i < total; i++)
        t->tried_s[i] = NAN;
    TRY(job_create(&settings, &r->frame_job, why));
    TRY(environment_read("", job_isa(r->frame_job), &r->environment, why));
    if (options->environment)
        snprintf(r->environment.key, sizeof r->environment.key, "%s", options->environment);
    return STATUS_OK;
}

static void release(trials *t)
{
    free(t->once_s);
    free(t->cell_s);
    free(t->tried_s);
    run_release(t->r);
}

status study_estimate_run(const study *s, const study_options *options, study_estimate *out, diagnostic *why)
{
    run r = {.s = s, .options = options};
    trials t = {.r = &r, .deadline_s = clock_wall_s() + STUDY_ESTIMATE_TRIALS_S};
    *out = (study_estimate){.least_s = 0};
    status code = open(&t, options, why);
    THEN(code, survey(&t, why));
    THEN(code, sum_up(&t, out, why));
    release(&t);
    return code;
}

status study_estimate_parts(const study *s, const study_options *options, bool tries, study_estimate *parts,
                            diagnostic *why)
{
    study_options part = *options;
    part.shard = 0;
    part.shards = 1;
    run r = {.s = s, .options = &part};
    trials t = {.r = &r, .deadline_s = tries ? clock_wall_s() + STUDY_ESTIMATE_TRIALS_S : INFINITY};
    status code = open(&t, options, why);
    THEN(code, survey(&t, why));
    if (code == STATUS_OK)
        use_rows_as_trials(&t);
    part.shards = options->shards;
    for (part.shard = 0; code == STATUS_OK && part.shard < part.shards; part.shard++) {
        if (part.by_repetition)
            code = run_read_rows(&r, why);
        r.cell_count = 0;
        run_choose_cells(&r);
        THEN(code, sum_up(&t, &parts[part.shard], why));
    }
    release(&t);
    return code;
}

/* --- text --- */

/* "0.2 s", "42 s", "7 min", "3.5 h": an estimate has no more digits. */
static const char *duration(double s, char *text, size_t size)
{
    if (s < 0.05)
        snprintf(text, size, "0.1 s");
    else if (s < 9.95)
        snprintf(text, size, "%.1f s", s);
    else if (s < 99.5)
        snprintf(text, size, "%.0f s", s);
    else if (s < 99.5 * 60)
        snprintf(text, size, "%.0f min", s / 60);
    else
        snprintf(text, size, "%.1f h", s / 3600);
    return text;
}

static void write_rows(FILE *out, const study *s, const study_estimate *e)
{
    fprintf(out, "%s: %zu of %zu cells lack rows: ", s->name, e->cells_lacking, e->cells);
    if (e->rows_least != e->rows_most)
        fprintf(out, "%zu to ", e->rows_least);
    fprintf(out, "%zu rows and %zu warm-ups to measure\n", e->rows_most, e->warmups);
}

static void write_basis(FILE *out, const study_estimate *e)
{
    const char *before = ", from ";
    if (e->from_rows)
        fprintf(out, "%sthe rows of %zu cell%s", before, e->from_rows, e->from_rows == 1 ? "" : "s"), before = " and ";
    if (e->from_trials)
        fprintf(out, "%strial frames of %zu cell%s, extrapolated in pixels", before, e->from_trials,
                e->from_trials == 1 ? "" : "s");
    if (e->from_others)
        fprintf(out, "; for %zu other cell%s the mean of the trials", e->from_others, e->from_others == 1 ? "" : "s");
    if (e->comparisons)
        fprintf(out, "; without the reference images");
    fputc('\n', out);
}

static void write_time(FILE *out, const study *s, const study_estimate *e)
{
    char least[32], most[32];
    if (isnan(e->most_s)) {
        fprintf(out, "%s: time unknown: a trial frame with few pixels takes more than %g s\n", s->name,
                STUDY_ESTIMATE_TRIALS_S);
        return;
    }
    duration(e->least_s, least, sizeof least);
    duration(e->most_s, most, sizeof most);
    fprintf(out, "%s: %s ", s->name, e->cut ? "more than" : e->most_s < 0.05 ? "less than" : "about");
    if (strcmp(least, most) != 0)
        fprintf(out, "%s to ", least);
    fprintf(out, "%s", most);
    write_basis(out, e);
}

static void write_files(FILE *out, const study *s, const char *results, const study_estimate *e)
{
    if (e->files) {
        fprintf(out, "%s: %zu files to keep in %s/%s/images:", s->name, e->files, results, s->name);
        const char *ending;
        for (size_t i = 0; (ending = keep_ending(s, i)); i++)
            fprintf(out, "%s CELL%s", i ? "," : "", ending);
        fputc('\n', out);
    }
    if (e->comparisons)
        fprintf(out, "%s: %zu cells to compare with their reference\n", s->name, e->comparisons);
}

static void write_room(FILE *out, const study *s, const char *results, const study_estimate *e)
{
    char needed[80], available[32];
    disk_room_text(&e->needed, needed, sizeof needed);
    disk_room_bytes_text(e->free_bytes, available, sizeof available);
    fprintf(out, "%s: %s to write", s->name, needed);
    if (!isnan(e->free_bytes))
        fprintf(out, ", %s free in %s", available, results);
    fputc('\n', out);
}

void study_estimate_write(FILE *out, const study *s, const char *results, const study_estimate *e)
{
    if (!e->cells_lacking && !e->cells_to_keep) {
        fprintf(out, "%s: complete, nothing to do\n", s->name);
        return;
    }
    write_rows(out, s, e);
    write_time(out, s, e);
    write_files(out, s, results, e);
    write_room(out, s, results, e);
}
