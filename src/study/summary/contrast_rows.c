/* Reads and sorts the rows of one side of a comparison. */
#include "study/rows/row_files.h"
#include "study/summary/contrast_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows of runs that are not in runs.json count as one process. */
static const char unknown_run[] = "unknown";

static bool is_wanted(const study_side *side, const contrast_rows *r, const row_ref *ref)
{
    return strcmp(row_environment(ref), r->environment) == 0 &&
           (!side->run || strcmp(row_field(ref, "run"), side->run) == 0);
}

/* The index of the row's process, which is added if it is new. `last` is tried first: rows of a run are neighbours. */
static size_t process_of(contrast_rows *r, const row_ref *ref, size_t last)
{
    const char *id = ref->run >= 0 ? r->files->runs->entry[ref->run].id : unknown_run;
    if (last < r->process_count && strcmp(r->processes[last].id, id) == 0)
        return last;
    size_t i = 0;
    while (i < r->process_count && strcmp(r->processes[i].id, id) != 0)
        i++;
    if (i == r->process_count)
        r->processes[r->process_count++] = (contrast_process){.id = id};
    return i;
}

static void note_time(contrast_process *p, const char *time)
{
    if (!p->first || strcmp(time, p->first) < 0)
        p->first = time;
    if (!p->last || strcmp(time, p->last) > 0)
        p->last = time;
}

static int by_place(const void *a, const void *b)
{
    const contrast_row *x = a, *y = b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    if (x->process != y->process)
        return x->process < y->process ? -1 : 1;
    return (x->repetition > y->repetition) - (x->repetition < y->repetition);
}

static int by_start(const void *a, const void *b)
{
    const contrast_process *x = *(const contrast_process *const *)a, *y = *(const contrast_process *const *)b;
    const int order = strcmp(x->first, y->first);
    return order ? order : (x > y) - (x < y);
}

/* Renumbers the processes in the order of their starts. */
static status sort_processes(contrast_rows *r, size_t rows, diagnostic *why)
{
    const size_t count = r->process_count;
    const contrast_process **sorted = calloc(count + 1, sizeof *sorted);
    contrast_process *ordered = calloc(count + 1, sizeof *ordered);
    size_t *number = calloc(count + 1, sizeof *number);
    const status code = sorted && ordered && number ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        for (size_t i = 0; i < count; i++)
            sorted[i] = &r->processes[i];
        qsort(sorted, count, sizeof *sorted, by_start);
        for (size_t i = 0; i < count; i++) {
            ordered[i] = *sorted[i];
            number[sorted[i] - r->processes] = i;
        }
        for (size_t i = 0; i < rows; i++)
            r->rows[i].process = number[r->rows[i].process];
        contrast_process *before = r->processes;
        r->processes = ordered;
        ordered = before;
    }
    free(number);
    free(ordered);
    free(sorted);
    return code;
}

static status collect(const study *s, const study_side *side, const char *column, const excluded *without,
                      contrast_rows *r, diagnostic *why)
{
    const size_t cells = study_cell_count(s);
    size_t count = 0, process = 0;
    for (size_t i = 0; i < r->files->row_count; i++) {
        const row_ref *ref = &r->files->rows[i];
        const double value = row_field_real(ref, column);
        r->left_out += !ref->warmup && strcmp(row_environment(ref), r->environment) != 0;
        if (!(value > 0) || isinf(value) || !is_wanted(side, r, ref) || row_use_of(without, ref) != ROW_COUNTS)
            continue;
        process = process_of(r, ref, process);
        note_time(&r->processes[process], row_field(ref, "time_utc"));
        r->rows[count++] = (contrast_row){ref->cell, process, ref->repetition, value, ref};
    }
    TRY(sort_processes(r, count, why));
    qsort(r->rows, count, sizeof *r->rows, by_place);
    for (size_t cell = 0, at = 0; cell <= cells; cell++) {
        while (at < count && r->rows[at].cell < cell)
            at++;
        r->first_of[cell] = cell == cells ? count : at;
    }
    return STATUS_OK;
}

static status check_column(const contrast_rows *r, const char *column, diagnostic *why)
{
    bool known = false;
    for (size_t i = 0; i < r->files->count; i++)
        known |= csv_column(r->files->tables[i], column) >= 0;
    for (size_t i = 0; known && i < r->files->row_count; i++)
        if (row_field_real(&r->files->rows[i], column) > 0)
            return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "see `man cuvette-results` for the columns of rows.csv",
                    known ? "the column '%.64s' has no positive number" : "the rows have no column '%.64s'", column);
}

static status check_run(const contrast_rows *r, const char *wanted, diagnostic *why)
{
    char list[400] = "give one of these: ";
    for (size_t i = 0; i < r->files->row_count; i++) {
        const char *run = row_field(&r->files->rows[i], "run");
        const size_t used = strlen(list);
        if (strcmp(run, wanted) == 0)
            return STATUS_OK;
        if (!strstr(list, run) && used + strlen(run) + 2 < sizeof list)
            snprintf(list + used, sizeof list - used, "%s ", run);
    }
    return diagnose(why, STATUS_BAD_INPUT, list, "no row in %.200s is of the run '%.64s'", r->results, wanted);
}

status contrast_rows_read(const study *s, const study_side *side, const char *column, contrast_rows *out,
                          diagnostic *why)
{
    *out = (contrast_rows){.results = side->results};
    TRY(row_files_read(s, side->results, ROWS, &out->files, why));
    if (out->files->row_count == 0)
        return diagnose_at(why, s->path, STATUS_FAILURE, "run the study first, or give the folder of its results",
                           "no rows in %.200s/%s", side->results, s->name);
    TRY(check_column(out, column, why));
    if (side->run)
        TRY(check_run(out, side->run, why));
    TRY(row_environments_choose(out->files, side->environment ? side->environment : "main", out->environment, why));
    out->rows = calloc(out->files->row_count + 1, sizeof *out->rows);
    out->first_of = calloc(study_cell_count(s) + 1, sizeof *out->first_of);
    out->processes = calloc(out->files->runs->count + 2, sizeof *out->processes);
    if (!out->rows || !out->first_of || !out->processes)
        return out_of_memory(why);
    excluded *without = NULL;
    status code = excluded_read(s, side->results, &without, why);
    THEN(code, collect(s, side, column, without, out, why));
    excluded_destroy(without);
    return code;
}

void contrast_rows_release(contrast_rows *r)
{
    row_files_destroy(r->files);
    free(r->rows);
    free(r->first_of);
    free(r->processes);
    *r = (contrast_rows){.files = NULL};
}

/* --- samples --- */

static status make_room(contrast_sample *out, size_t values, size_t processes, diagnostic *why)
{
    *out = (contrast_sample){.values = calloc(values + 1, sizeof *out->values),
                             .start = calloc(processes + 2, sizeof *out->start),
                             .process = calloc(processes + 1, sizeof *out->process)};
    out->levels = (level_sample){out->values, out->start, 0};
    return out->values && out->start && out->process ? STATUS_OK : out_of_memory(why);
}

void contrast_sample_free(contrast_sample *s)
{
    free(s->values);
    free(s->start);
    free(s->process);
    *s = (contrast_sample){.values = NULL};
}

status contrast_sample_of_cell(const contrast_rows *r, size_t cell, contrast_sample *out, diagnostic *why)
{
    const size_t from = r->first_of[cell], count = r->first_of[cell + 1] - from;
    TRY(make_room(out, count, r->process_count, why));
    for (size_t i = 0; i < count; i++) {
        const size_t process = r->rows[from + i].process;
        if (i == 0 || process != r->rows[from + i - 1].process)
            out->process[out->levels.processes++] = process;
        out->values[i] = log(r->rows[from + i].value);
        out->start[out->levels.processes] = i + 1;
    }
    return STATUS_OK;
}

/* --- alternation --- */

static bool are_the_same(const contrast_process *a, const contrast_process *b)
{
    return strcmp(a->id, b->id) == 0 && strcmp(a->id, unknown_run) != 0;
}

static bool ends_before(const contrast_process *a, const contrast_process *b)
{
    return strcmp(a->last, b->first) <= 0;
}

bool contrast_alternate(const contrast_rows *ra, const contrast_sample *a, const contrast_rows *rb,
                        const contrast_sample *b)
{
    const size_t count = a->levels.processes;
    bool in_turn = count == b->levels.processes, same = in_turn && strcmp(ra->results, rb->results) == 0;
    for (size_t k = 0; k < count && (same || in_turn); k++) {
        const contrast_process *pa = &ra->processes[a->process[k]], *pb = &rb->processes[b->process[k]];
        same = same && are_the_same(pa, pb);
        in_turn = in_turn && (ends_before(pa, pb) || ends_before(pb, pa));
        if (k + 1 < count) {
            const contrast_process *na = &ra->processes[a->process[k + 1]], *nb = &rb->processes[b->process[k + 1]];
            in_turn =
                in_turn && ends_before(pa, na) && ends_before(pa, nb) && ends_before(pb, na) && ends_before(pb, nb);
        }
    }
    return count > 0 && (same || in_turn);
}
