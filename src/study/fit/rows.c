/* The evaluations of a fit: in memory, and as rows of results/<study>/fit.csv, which is appended, flushed, and never
 * changed. A row is used again for the same point if what is measured (fit.identity) and the build are the same. */
#include "study/rows/rows.h"
#include "base/array.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/installed.h"
#include "base/text.h"
#include "study/fit/fit.h"
#include "study/rows/table.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An evaluation, and whether this run has requested it. */
typedef struct known {
    fit_evaluation at;
    bool asked;
} known;

struct fit_run {
    const fit *f;
    fit_options options;
    job *frames;
    table *file; /* NULL: no rows are kept */
    checksum_columns columns;
    char last[CHECKSUM_TEXT]; /* the checksum of the last row */
    known **list;
    size_t count, room, asked, measured, unused;
    double best;
};

/* --- columns --- */

/* A column for each parameter and each target stands between stage and merit. */
static const row_column leading[] = {
    {"study", "", "name of the study"},
    {"fit", "", "hash of what is measured: the scene, its files, the parameters and the quantities, 16 hex digits"},
    {"evaluation", "", "running number of the row, from 1"},
    {"stage", "", "what requested it: start, a method of the search, derivative, profile or tolerance"},
};
static const row_column trailing[] = {
    {"merit", "",
     "what the search makes least, by the targets when the row was written: the sum of weight (measured - value)^2, "
     "the "
     "quantity, or its negative; NA where a quantity cannot be measured"},
    {"build", "", "hash of the program's sources and compiler that can change a film, 16 hex digits"},
    {"checksum", "", "proves the row: 8 hex digits for its values, 8 for its place after the previous row"},
};
enum { LEADING = sizeof leading / sizeof leading[0], TRAILING = sizeof trailing / sizeof trailing[0] };

void fit_each_column(row_column_visitor *visit, void *context)
{
    static const row_column own[] = {
        {"<parameter>", "of the parameter", "value of each parameter of the fit, in its order"},
        {"<target>", "of the quantity", "measured value of each target"},
    };
    for (size_t i = 0; i < LEADING; i++)
        visit(context, &leading[i]);
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
        visit(context, &own[i]);
    for (size_t i = 0; i < TRAILING; i++)
        visit(context, &trailing[i]);
}

/* The names of a fit's columns, in order; borrowed. Returns their number. */
static size_t column_names(const fit *f, const char *names[LEADING + FIT_PARAMETERS_MAX + FIT_TARGETS_MAX + TRAILING])
{
    size_t count = 0;
    for (size_t i = 0; i < LEADING; i++)
        names[count++] = leading[i].name;
    for (size_t i = 0; i < f->parameter_count; i++)
        names[count++] = f->parameters[i].name;
    for (size_t i = 0; i < f->target_count; i++)
        names[count++] = f->targets[i].name;
    for (size_t i = 0; i < TRAILING; i++)
        names[count++] = trailing[i].name;
    return count;
}

/* --- what is known --- */

static known *find(const fit_run *r, const double *x)
{
    for (size_t i = 0; i < r->count; i++)
        if (memcmp(r->list[i]->at.x, x, r->f->parameter_count * sizeof *x) == 0)
            return r->list[i];
    return NULL;
}

static status keep(fit_run *r, const known *one, known **out, diagnostic *why)
{
    known *copy = malloc(sizeof *copy);
    if (!copy || !GROW(r->list, r->room, r->count + 1)) {
        free(copy);
        return out_of_memory(why);
    }
    *copy = *one;
    r->list[r->count++] = copy;
    *out = copy;
    return STATUS_OK;
}

/* --- reading --- */

static bool is_intact(const csv *t, const checksum_columns *c, size_t row)
{
    uint32_t content, chain;
    char *const *fields = t->fields + row * t->column_count;
    const char *text = csv_field(t, row, csv_column(t, "checksum"));
    return !t->broken[row] && checksum_parse(text, &content, &chain) && content == checksum_content(c, fields);
}

static bool belongs(const fit_run *r, const csv *t, size_t row)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, r->f->identity);
    return strcmp(csv_field(t, row, csv_column(t, "fit")), hash) == 0 &&
           strcmp(csv_field(t, row, csv_column(t, "build")), build_id()) == 0;
}

static status read_row(fit_run *r, const csv *t, size_t row, diagnostic *why)
{
    const fit *f = r->f;
    known one = {.asked = false}, *unused;
    for (size_t i = 0; i < f->parameter_count; i++)
        one.at.x[i] = csv_field_real(t, row, csv_column(t, f->parameters[i].name));
    for (size_t i = 0; i < f->target_count; i++)
        one.at.values[i] = csv_field_real(t, row, csv_column(t, f->targets[i].name));
    one.at.merit = fit_merit(f, one.at.values); /* weights may have changed */
    return find(r, one.at.x) ? STATUS_OK : keep(r, &one, &unused, why);
}

static status read_rows(fit_run *r, const char *path, diagnostic *why)
{
    csv *t = NULL;
    checksum_columns columns = {.name = NULL};
    TRY(csv_read_rows(path, NULL, &t, why));
    if (!t)
        return STATUS_OK;
    status code = t->header ? checksum_columns_create(t->header, t->column_count, &columns, why) : STATUS_OK;
    for (size_t row = 0; row < t->row_count && code == STATUS_OK; row++) {
        const bool intact = is_intact(t, &columns, row);
        if (intact && belongs(r, t, row))
            code = read_row(r, t, row, why);
        else
            r->unused++;
        snprintf(r->last, sizeof r->last, "%s", csv_field(t, row, csv_column(t, "checksum")));
    }
    r->measured = 0;
    checksum_columns_free(&columns);
    csv_destroy(t);
    return code;
}

/* --- writing --- */

static status write_row(fit_run *r, const char *stage, const fit_evaluation *e, diagnostic *why)
{
    const fit *f = r->f;
    csv_buffer line = {0};
    if (!r->file)
        return STATUS_OK;
    csv_text(&line, f->s->name);
    csv_hash(&line, f->identity);
    csv_count(&line, (int64_t)(r->count + r->unused + 1));
    csv_text(&line, stage);
    for (size_t i = 0; i < f->parameter_count; i++)
        csv_real(&line, e->x[i]);
    for (size_t i = 0; i < f->target_count; i++)
        csv_real(&line, e->values[i]);
    csv_real(&line, e->merit);
    csv_text(&line, build_id());
    csv_text(&line, NULL);
    csv_end(&line);
    status code = checksum_lines(&r->columns, r->last, &line, why);
    THEN(code, table_append(r->file, line.text, line.size, why));
    csv_buffer_free(&line);
    return code;
}

static status open_rows(fit_run *r, diagnostic *why)
{
    const char *names[LEADING + FIT_PARAMETERS_MAX + FIT_TARGETS_MAX + TRAILING];
    const size_t count = column_names(r->f, names);
    csv_buffer header = {0};
    char *folder = study_folder(r->f->s, r->options.results), *path = folder ? text_format("%s/fit.csv", folder) : NULL;
    for (size_t i = 0; i < count; i++)
        csv_text(&header, names[i]);
    csv_end(&header);
    status code = path && !header.failed ? file_make_directory(folder, why) : out_of_memory(why);
    THEN(code, table_open(path, header.text, &r->file, why));
    THEN(code, checksum_columns_create((char *const *)(uintptr_t)names, count, &r->columns, why));
    snprintf(r->last, sizeof r->last, "%016" PRIx64, r->f->identity);
    THEN(code, read_rows(r, path, why));
    csv_buffer_free(&header);
    free(path);
    free(folder);
    return code;
}

/* --- runs --- */

status fit_run_begin(const fit *f, const fit_options *options, fit_run **out, diagnostic *why)
{
    *out = NULL;
    fit_run *r = calloc(1, sizeof *r);
    if (!r)
        return out_of_memory(why);
    r->f = f;
    r->options = *options;
    r->best = NAN;
    status code = job_create(&(job_settings){.keeps_meshes = true}, &r->frames, why);
    if (options->results)
        THEN(code, open_rows(r, why));
    if (code == STATUS_OK)
        *out = r;
    else
        fit_run_end(r);
    return code;
}

void fit_run_end(fit_run *r)
{
    if (!r)
        return;
    for (size_t i = 0; i < r->count; i++)
        free(r->list[i]);
    free(r->list);
    checksum_columns_free(&r->columns);
    table_close(r->file);
    job_destroy(r->frames);
    free(r);
}

static status measure(fit_run *r, const char *stage, const double *x, known **out, diagnostic *reason, diagnostic *why)
{
    known one = {.asked = false};
    diagnostic bad = {.what = ""};
    memcpy(one.at.x, x, r->f->parameter_count * sizeof *x);
    const status code = fit_measure_at(r->f, r->frames, x, one.at.values, &bad);
    if (code == STATUS_BAD_INPUT && reason)
        *reason = bad;
    for (size_t i = 0; code == STATUS_BAD_INPUT && i < r->f->target_count; i++)
        one.at.values[i] = NAN;
    if (code != STATUS_OK && code != STATUS_BAD_INPUT) {
        if (why)
            *why = bad;
        return code;
    }
    one.at.merit = fit_merit(r->f, one.at.values);
    if (!isfinite(one.at.merit))
        one.at.merit = NAN;
    TRY(write_row(r, stage, &one.at, why));
    r->measured++;
    return keep(r, &one, out, why);
}

status fit_evaluate(fit_run *r, const char *stage, const double *x, const fit_evaluation **out, diagnostic *reason,
                    diagnostic *why)
{
    known *one = find(r, x);
    if (!one)
        TRY(measure(r, stage, x, &one, reason, why));
    r->asked += !one->asked;
    one->asked = true;
    r->best = one->at.merit < r->best || isnan(r->best) ? one->at.merit : r->best;
    if (r->options.progressed)
        r->options.progressed(r->options.context, r->asked, r->best);
    *out = &one->at;
    return STATUS_OK;
}

size_t fit_run_evaluations(const fit_run *r)
{
    return r->asked;
}

size_t fit_run_new(const fit_run *r)
{
    return r->measured;
}

size_t fit_run_set_aside(const fit_run *r)
{
    return r->unused;
}

const fit *fit_run_of(const fit_run *r)
{
    return r->f;
}
