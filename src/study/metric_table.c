#include "study/metric_table.h"

#include "base/file.h"
#include "realism/realism.h"
#include "study/cell_table.h"
#include "study/grid.h"
#include <math.h>

static status check_cell(const study *s, size_t cell, diagnostic *why)
{
    scene *setting = NULL;
    diagnostic bad = {.what = ""};
    status code = study_cell_scene(s, cell, &setting, why);
    if (code == STATUS_OK && (code = realism_check(setting, s->keep_curves, &bad)) != STATUS_OK) {
        diagnostic_locate(why, s->path, 0, 0);
        diagnose(why, code, bad.remedy, "%s cannot be kept of cell %zu: %s", s->keep_curves ? "curves" : "metrics",
                 cell, bad.what);
    }
    scene_destroy(setting);
    return code;
}

status metric_table_check(const study *s, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t cell = 0; (s->keep_metrics || s->keep_curves) && code == STATUS_OK && cell < study_cell_count(s);
         cell++)
        code = check_cell(s, cell, why);
    return code;
}

static void put_metrics(const study *s, size_t cell, const realism_report *r, FILE *out)
{
    cell_table_header(s, "metric\tunit\tmeasured\ttheory\terror\ttolerance\tpasses\twhat", out);
    for (int i = 0; i < r->count; i++) {
        const realism_value *v = &r->value[i];
        cell_table_begin(s, cell, out);
        fprintf(out, "\t%s\t%s", v->metric, v->unit[0] ? v->unit : "NA");
        cell_table_number(out, v->measured);
        cell_table_number(out, v->theory);
        cell_table_number(out, realism_error(v));
        cell_table_number(out, v->tolerance);
        fprintf(out, "\t%s\t%s\n", !realism_is_defined(v) ? "NA" : realism_passes(v) ? "1" : "0", v->what);
    }
}

status metric_table_write(const study *s, size_t cell, const scene *setting, isa level, const char *path,
                          diagnostic *why)
{
    realism_report report;
    file_writer file;
    status code = realism_measure(setting, level, &report, why);
    if (code == STATUS_OK)
        code = file_writer_open(&file, path, why);
    if (code != STATUS_OK)
        return code;
    put_metrics(s, cell, &report, file.stream);
    return file_writer_commit(&file, why);
}

static status put_curve(const study *s, size_t cell, const scene *setting, isa level, realism_curve which, FILE *out,
                        diagnostic *why)
{
    realism_points points;
    const status code = realism_trace_curve(setting, level, which, &points, why);
    for (int i = 0; code == STATUS_OK && i < points.count; i++) {
        cell_table_begin(s, cell, out);
        fprintf(out, "\t%s", realism_curve_name(which));
        cell_table_number(out, points.at[i].x);
        cell_table_number(out, points.at[i].measured);
        cell_table_number(out, points.at[i].theory);
        fputc('\n', out);
    }
    return code;
}

status curve_table_write(const study *s, size_t cell, const scene *setting, isa level, const char *path,
                         diagnostic *why)
{
    file_writer file;
    status code = file_writer_open(&file, path, why);
    if (code != STATUS_OK)
        return code;
    cell_table_header(s, "curve\tx\tmeasured\ttheory", file.stream);
    for (int which = 0; which < REALISM_CURVE_COUNT && code == STATUS_OK; which++)
        code = put_curve(s, cell, setting, level, (realism_curve)which, file.stream, why);
    if (code == STATUS_OK)
        return file_writer_commit(&file, why);
    file_writer_abandon(&file);
    return code;
}
