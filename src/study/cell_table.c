#include "study/cell_table.h"

#include "base/file.h"
#include "base/number.h"
#include "realism/realism.h"
#include "scene/model/scene.h"
#include "scene/assets/slime.h"
#include "scene/motion/motion.h"
#include "softbody/trials.h"
#include "study/grid.h"
#include <math.h>

/* A table of one cell: its measured data and its output file. */
typedef struct cell_lines {
    const study *s;
    size_t cell;
    const scene *setting;
    isa level;
    FILE *out;
} cell_lines;

void cell_table_number(FILE *out, double value)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "\t%s", isfinite(value) ? number_format(value, text) : "NA");
}

/* The start of a line, up to the last axis value. */
static void begin(const cell_lines *l)
{
    fprintf(l->out, "%s\t%zu", l->s->name, l->cell);
    grid_put_values(l->s, l->cell, l->out);
}

static void put_numbers(const cell_lines *l, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        cell_table_number(l->out, values[i]);
}

static status put_metrics(const cell_lines *l, diagnostic *why)
{
    realism_report report;
    const status code = realism_measure(l->setting, l->level, &report, why);
    for (int i = 0; code == STATUS_OK && i < report.count; i++) {
        const realism_value *v = &report.value[i];
        begin(l);
        fprintf(l->out, "\t%s\t%s", v->metric, v->unit[0] ? v->unit : "NA");
        put_numbers(l, (double[]){v->measured, v->theory, realism_error(v), v->tolerance}, 4);
        fprintf(l->out, "\t%s\t%s\n", !realism_is_defined(v) ? "NA" : realism_passes(v) ? "1" : "0", v->what);
    }
    return code;
}

static status put_curves(const cell_lines *l, diagnostic *why)
{
    status code = STATUS_OK;
    for (int which = 0; which < REALISM_CURVE_KEPT && code == STATUS_OK; which++) {
        realism_points points;
        code = realism_trace_curve(l->setting, l->level, (realism_curve)which, &points, why);
        for (int i = 0; code == STATUS_OK && i < points.count; i++) {
            begin(l);
            fprintf(l->out, "\t%s", realism_curve_name((realism_curve)which));
            put_numbers(l, (double[]){points.at[i].x, points.at[i].measured, points.at[i].theory}, 3);
            fputc('\n', l->out);
        }
    }
    return code;
}

static status put_slime(const cell_lines *l, const mesh_entry *m, diagnostic *why)
{
    const softbody_settings settings = slime_settings(m);
    softbody_trial_report report;
    const status code = softbody_trials(&settings, l->level, &report, why);
    for (int i = 0; code == STATUS_OK && i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &report.value[i];
        begin(l);
        fprintf(l->out, "\t%s\t%s\t%s", m->name, v->name, v->unit[0] ? v->unit : "NA");
        put_numbers(l, (double[]){v->measured, v->theory, softbody_trial_error(v)}, 3);
        fprintf(l->out, "\t%s\n", v->what);
    }
    return code;
}

static status put_motion(const cell_lines *l, diagnostic *why)
{
    for (size_t i = 0; i < l->setting->mesh_count; i++)
        if (l->setting->meshes[i].source == MESH_SLIME)
            TRY(put_slime(l, &l->setting->meshes[i], why));
    return STATUS_OK;
}

static const struct {
    const char *columns; /* after the axis values */
    status (*put)(const cell_lines *l, diagnostic *why);
} tables[] = {
    [CELL_METRICS] = {"metric\tunit\tmeasured\ttheory\terror\ttolerance\tpasses\twhat", put_metrics},
    [CELL_CURVES] = {"curve\tx\tmeasured\ttheory", put_curves},
    [CELL_MOTION] = {"slime\tname\tunit\tmeasured\ttheory\terror\twhat", put_motion},
};

status cell_table_write(cell_table which, const study *s, size_t cell, const scene *setting, isa level,
                        const char *path, diagnostic *why)
{
    file_writer file;
    TRY(file_writer_open(&file, path, why));
    fputs("study\tcell", file.stream);
    grid_put_paths(s, file.stream);
    fprintf(file.stream, "\t%s\n", tables[which].columns);
    return file_writer_end(&file, tables[which].put(&(cell_lines){s, cell, setting, level, file.stream}, why), why);
}

static status check_metrics(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    (void)context;
    diagnostic bad = {.what = ""};
    const status code = realism_check(setting, s->keep_curves, &bad);
    if (code == STATUS_OK)
        return code;
    return diagnose_at(why, s->path, code, bad.remedy, "%s of cell %zu cannot be saved: %s",
                       s->keep_curves ? "curves" : "metrics", cell, bad.what);
}

static status check_motion(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    (void)context;
    if (scene_moves(setting))
        return STATUS_OK;
    return diagnose_at(why, s->path, STATUS_BAD_INPUT, "add a mesh with 'generate: slime'",
                       "the motion of cell %zu cannot be saved: nothing moves in it", cell);
}

status cell_tables_check(const study *s, diagnostic *why)
{
    status code = STATUS_OK;
    if (s->keep_metrics || s->keep_curves)
        code = grid_each_cell(s, check_metrics, NULL, why);
    return code == STATUS_OK && s->keep_motion ? grid_each_cell(s, check_motion, NULL, why) : code;
}
