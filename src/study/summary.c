#include "study/summary.h"
#include "base/number.h"
#include "base/text.h"
#include "measure/statistics.h"
#include "study/compare_rows.h"
#include "study/row_files.h"
#include "study/rows.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const timed[] = {"wall_s", "cpu_s"};
static const char *const before_hash[] = {"rays_total",  "rays_camera",          "rays_reflect",  "rays_refract",
                                          "rays_shadow", "cut_depth_throughput", "total_internal"};
static const char *const after_marked[] = {
    "busy_s_mean",    "busy_s_max",  "waiting_s_mean",   "imbalance",    "others_share", "worker_cpu_s_sum",
    "peak_rss_bytes", "noise_rms",   "triangles",        "instances",    "accel_bytes",  "build_s",
    "drawn",          "drawn_bytes", "visibility_s_sum", "motion_steps", "motion_s"};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

typedef struct cell_rows {
    const row_ref **rows;
    size_t count, marked;
    double *values;
    const row_ref *compared; /* the cell's row of compare.csv, or NULL */
    FILE *out;
} cell_rows;

static const char *field(const row_ref *ref, const char *name)
{
    return csv_field(ref->table, ref->row, csv_column(ref->table, name));
}

static void put_real(FILE *out, double value)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "\t%s", isfinite(value) ? number_format(value, text) : "NA");
}

/* Known values of one column over the cell's rows. */
static summary summarize_column(const cell_rows *cell, const char *name)
{
    size_t count = 0;
    for (size_t i = 0; i < cell->count; i++) {
        double value = csv_field_real(cell->rows[i]->table, cell->rows[i]->row, csv_column(cell->rows[i]->table, name));
        if (!isnan(value))
            cell->values[count++] = value;
    }
    if (count == 0)
        return (summary){0, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    return summarize(cell->values, count);
}

static void put_timed(const cell_rows *cell, const char *name)
{
    summary s = summarize_column(cell, name);
    put_real(cell->out, s.median);
    put_real(cell->out, s.median_low);
    put_real(cell->out, s.median_high);
    put_real(cell->out, s.mean);
    put_real(cell->out, s.minimum);
    put_real(cell->out, s.maximum);
}

static void put_median(const cell_rows *cell, const char *name)
{
    put_real(cell->out, summarize_column(cell, name).median);
}

static status put_solids(const study *s, const cell_rows *cell, bool header, diagnostic *why)
{
    for (size_t i = 0; i < s->base->solid_count; i++) {
        char *name = text_format("first_hits.%s", s->base->solids[i].name);
        if (!name)
            return out_of_memory(why);
        if (header)
            fprintf(cell->out, "\t%s", name);
        else
            put_median(cell, name);
        free(name);
    }
    return STATUS_OK;
}

/* A picture has one comparison, so its values are as they stand. */
static void put_compared(const study *s, const cell_rows *cell)
{
    for (size_t i = 0; s->reference.count && i < compare_shown_count; i++)
        fprintf(cell->out, "\t%s", cell->compared ? field(cell->compared, compare_shown[i]) : "NA");
}

static status put_header(const study *s, FILE *out, diagnostic *why)
{
    static const char *const parts[] = {"median", "low", "high", "mean", "min", "max"};
    const char *path;
    fputs("cell", out);
    for (size_t i = 0; (path = study_grid_path(s, i)); i++)
        fprintf(out, "\t%s", path);
    fputs("\tn", out);
    for (size_t i = 0; i < COUNT(timed); i++)
        for (size_t part = 0; part < COUNT(parts); part++)
            fprintf(out, "\t%s_%s", timed[i], parts[part]);
    for (size_t i = 0; i < COUNT(before_hash); i++)
        fprintf(out, "\t%s", before_hash[i]);
    fputs("\tfilm_hash\tmarked", out);
    for (size_t i = 0; i < COUNT(after_marked); i++)
        fprintf(out, "\t%s", after_marked[i]);
    status code = put_solids(s, &(cell_rows){.out = out}, true, why);
    for (size_t i = 0; s->reference.count && i < compare_shown_count; i++)
        fprintf(out, "\t%s", compare_shown[i]);
    fputc('\n', out);
    return code;
}

static status put_cell(const study *s, size_t number, const char *film_expected, const cell_rows *cell, diagnostic *why)
{
    fprintf(cell->out, "%zu", number);
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, number, axis)];
        for (size_t i = 0; i < point->count; i++)
            fprintf(cell->out, "\t%s", point->values[i]);
    }
    fprintf(cell->out, "\t%zu", cell->count);
    for (size_t i = 0; i < COUNT(timed); i++)
        put_timed(cell, timed[i]);
    for (size_t i = 0; i < COUNT(before_hash); i++)
        put_median(cell, before_hash[i]);
    fprintf(cell->out, "\t%s\t%zu", film_expected ? film_expected : "NA", cell->marked);
    for (size_t i = 0; i < COUNT(after_marked); i++)
        put_median(cell, after_marked[i]);
    status code = put_solids(s, cell, false, why);
    put_compared(s, cell);
    fputc('\n', cell->out);
    return code;
}

/* Rows lie in the order of time; those of one cell are gathered for its line. */
static status put_cells(const study *s, const row_files *files, const row_files *compared, FILE *out, diagnostic *why)
{
    size_t room = files->row_count + 1;
    cell_rows cell = {
        .rows = malloc(room * sizeof *cell.rows), .values = malloc(room * sizeof *cell.values), .out = out};
    status code = cell.rows && cell.values ? STATUS_OK : out_of_memory(why);
    for (size_t number = 0; code == STATUS_OK && number < study_cell_count(s); number++) {
        const char *film_expected = NULL;
        cell.count = cell.marked = 0;
        for (size_t i = 0; i < files->row_count; i++) {
            const row_ref *ref = &files->rows[i];
            if (ref->cell != number)
                continue;
            bool marked = strcmp(field(ref, "marked"), "0") != 0;
            film_expected = film_expected ? film_expected : field(ref, "film_expected");
            cell.marked += marked;
            if (!marked && !ref->warmup)
                cell.rows[cell.count++] = ref;
        }
        cell.compared = NULL;
        for (size_t i = 0; compared && i < compared->row_count && !cell.compared; i++)
            if (compared->rows[i].cell == number)
                cell.compared = &compared->rows[i];
        code = put_cell(s, number, film_expected, &cell, why);
    }
    free(cell.rows);
    free(cell.values);
    return code;
}

status study_summary(const study *s, const char *results, FILE *out, diagnostic *why)
{
    row_files *files, *compared = NULL;
    status code = row_files_read(s, results, ROWS, &files, why);
    if (code == STATUS_OK && files->row_count == 0) {
        char remedy[256];
        snprintf(remedy, sizeof remedy,
                 "run cuvette study run %.128s first, or name the folder of its results with --results", s->path);
        code = diagnose(why, STATUS_FAILURE, remedy, "no rows in %s/%s", results, s->name);
        diagnostic_locate(why, s->path, 0, 0);
    }
    if (code == STATUS_OK && s->reference.count)
        code = row_files_read(s, results, COMPARE_ROWS, &compared, why);
    if (code == STATUS_OK)
        code = put_header(s, out, why);
    if (code == STATUS_OK)
        code = put_cells(s, files, compared, out, why);
    row_files_destroy(compared);
    row_files_destroy(files);
    return code;
}
