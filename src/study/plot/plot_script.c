/* Writes the gnuplot script of a figure. */
#include "base/file.h"
#include "base/number.h"
#include "study/plot/plot.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Writes a single-quoted string of gnuplot, in which only the quote is special. */
void plot_script_text(FILE *out, const char *text)
{
    fputc('\'', out);
    for (; *text; text++)
        if (*text == '\'')
            fputs("''", out);
        else
            fputc((unsigned char)*text < ' ' ? ' ' : *text, out);
    fputc('\'', out);
}

static void put_setting(FILE *out, const char *setting, const char *text, const char *rest)
{
    fprintf(out, "set %s ", setting);
    plot_script_text(out, text);
    fprintf(out, "%s\n", rest);
}

/* --- head --- */

/* The style of all figures, plots/style.gp, embedded by the assembler. */
extern const char plot_style[];
__asm__(".pushsection .rodata\n.globl plot_style\n.hidden plot_style\nplot_style: .incbin \"plots/style.gp\"\n.byte "
        "0\n.popsection");

/* The style without the lines that name files of the project. */
static void put_style(FILE *out)
{
    for (const char *line = plot_style; *line;) {
        const size_t length = strcspn(line, "\n");
        if (strncmp(line, "load ", 5) != 0 && strncmp(line, "published", 9) != 0)
            fprintf(out, "%.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

void plot_script_open(FILE *out, const char *by, const char *base, const char *data, int width, int height)
{
    const char *name = file_name_of(base);
    fprintf(out,
            "# Written by `%s`. Edit it, and redraw it from any folder:\n"
            "#   gnuplot %s.gp                          writes %s.png next to this script\n"
            "#   gnuplot -e \"format = 'svg'\" %s.gp     writes %s.svg; also 'pdf'\n",
            by, name, name, name, name);
    fputs("here = ARG0\n"
          "while (strlen(here) > 0 && here[strlen(here):strlen(here)] ne \"/\") { here = here[1:strlen(here)-1] }\n"
          "if (!exists(\"format\")) { format = \"png\" }\n"
          "if (!exists(\"output\")) { output = here.",
          out);
    plot_script_text(out, name);
    fputs(" }\n", out);
    if (data) {
        fputs("rows = here.", out);
        char file[300];
        snprintf(file, sizeof file, "%.290s%s", name, data);
        plot_script_text(out, file);
        fputc('\n', out);
    }
    fprintf(out, "width = %d; height = %d\n\n# --- style: plots/style.gp ---\n", width, height);
    put_style(out);
    fputs("\n# --- figure ---\n", out);
}

void plot_script_head(FILE *out, const plot_plan *p, const char *base, bool data)
{
    char by[160];
    snprintf(by, sizeof by, "cuvette study plot` for the study `%.100s", p->s->name);
    plot_script_open(out, by, base, data ? ".tsv" : NULL, p->width, p->height);
    fputs("set datafile separator tab\nset datafile missing \"NA\"\nset termoption noenhanced\n", out);
    put_setting(out, "label 1", p->s->title ? p->s->title : p->s->name,
                " at screen 0.5,1 offset 0,-0.9 center font \",11\" textcolor rgb ink");
    for (size_t i = 0; i < p->caption_count; i++) {
        char setting[24], rest[120];
        snprintf(setting, sizeof setting, "label %zu", 2 + i);
        snprintf(rest, sizeof rest, " at screen %.6f,%.6f left font \",8\" textcolor rgb grey", 10.0 / p->width,
                 (6.0 + 13.0 * (double)(p->caption_count - 1 - i) + 5) / p->height);
        put_setting(out, setting, p->captions[i], rest);
    }
}

/* --- axes --- */

static const char *with_unit(const plot_quantity *q, char text[160])
{
    snprintf(text, 160, "%s%s%s", q->label, q->unit[0] ? " / " : "", q->unit);
    return text;
}

/* The place of a value on a numeric axis, as a fraction of the panel. */
static double place_of(const plot_quantity *x, double value)
{
    return x->log ? log(value / x->from) / log(x->to / x->from) : (value - x->from) / (x->to - x->from);
}

/* Writes a tic for each value. A label that would touch the one before is omitted; without `labels`, all are. x: the
 * scale of the values; NULL: they are at 0, 1, 2, ... and all labels fit. */
static void put_tics(FILE *out, const char *which, const plot_axis *axis, const plot_quantity *x, int pixels,
                     bool labels)
{
    double end = -1e9; /* of the last label, in pixels */
    fprintf(out, "set %s (", which);
    for (size_t i = 0; i < axis->count; i++) {
        char number[NUMBER_TEXT_MAX];
        const double at = x ? place_of(x, axis->reals[i]) * pixels : 0, half = 3.8 * (double)strlen(axis->texts[i]);
        const bool fits = labels && (!x || at - half > end + 5);
        end = fits ? at + half : end;
        fputs(i ? ", " : "", out);
        plot_script_text(out, fits ? axis->texts[i] : "");
        if (x)
            fprintf(out, " %s", number_format(axis->reals[i], number));
        else
            fprintf(out, " %zu", i);
    }
    fputs(")\n", out);
}

static int panel_pixels(const plot_plan *p)
{
    for (size_t i = 0; i < p->panel_count; i++)
        if (p->panels[i].used)
            return (int)((p->panels[i].right - p->panels[i].left) * p->width);
    return p->width;
}

static size_t longest_text(const plot_axis *axis)
{
    size_t most = 1;
    for (size_t i = 0; i < axis->count; i++)
        most = strlen(axis->texts[i]) > most ? strlen(axis->texts[i]) : most;
    return most;
}

static bool has_only_integers(const plot_axis *axis)
{
    for (size_t i = 0; i < axis->count; i++)
        if (axis->reals[i] != floor(axis->reals[i]))
            return false;
    return true;
}

static void put_xtics(FILE *out, const plot_plan *p, bool labels)
{
    const plot_axis *along = p->along;
    const int pixels = panel_pixels(p);
    if (!along) {
        fputs(p->kind == PLOT_DOTS ? "unset xtics\n" : "", out);
    } else if (p->kind != PLOT_LINES) {
        const bool turned = longest_text(along) * 7 > (size_t)pixels / along->count;
        fprintf(out, "set xtics %s\n", turned ? "rotate by 90 right" : "norotate");
        put_tics(out, "xtics", along, NULL, pixels, labels);
    } else if (p->x.value < 0 && (p->x.log || along->count <= 3)) {
        put_tics(out, "xtics", along, &p->x, pixels, labels);
    } else if (p->x.value < 0 && has_only_integers(along) &&
               along->reals[along->count - 1] - along->reals[0] <= pixels / 24.0) {
        fputs("set xtics 1\n", out);
    }
}

enum { LOG_TICS_MAX = 12 };

/* The values of a scale that are 1, 2 or 5 times a power of ten; returns their number. */
static int round_values(const plot_quantity *q, double values[LOG_TICS_MAX])
{
    static const double parts[] = {1, 2, 5};
    int count = 0;
    for (double k = floor(log10(q->from)); count < LOG_TICS_MAX && pow(10, k) <= q->to; k++)
        for (int i = 0; i < 3 && count < LOG_TICS_MAX; i++)
            if (parts[i] * pow(10, k) >= q->from && parts[i] * pow(10, k) <= q->to)
                values[count++] = parts[i] * pow(10, k);
    return count;
}

/* The values of a scale at about five even steps of a round size; returns their number. */
static int even_values(const plot_quantity *q, double values[LOG_TICS_MAX])
{
    const double raw = (q->to - q->from) / 5, power = pow(10, floor(log10(raw))), digits = raw / power;
    const double step = power * (digits < 1.5 ? 1 : digits < 3.5 ? 2 : digits < 7.5 ? 5 : 10);
    int count = 0;
    for (double k = ceil(q->from / step); count < LOG_TICS_MAX && k * step <= q->to; k++)
        values[count++] = k * step;
    return count;
}

/* Writes the tics of a logarithmic scale of less than two decades, in which gnuplot labels at most two powers of
 * ten. */
static void put_log_tics(FILE *out, const char *axis, const plot_quantity *q)
{
    double values[LOG_TICS_MAX];
    if (!q->log || q->to / q->from >= 100)
        return;
    int count = round_values(q, values);
    if (count < 3)
        count = even_values(q, values);
    fprintf(out, "set %stics (", axis);
    for (int i = 0; i < count; i++)
        fprintf(out, "%s%.9g", i ? ", " : "", values[i]);
    fputs(")\n", out);
}

static void put_axes(FILE *out, const plot_plan *p)
{
    fprintf(out, "set xrange [%.9g:%.9g]\n%s", p->x.from, p->x.to, p->x.log ? "set logscale x\n" : "");
    if (p->x.value >= 0)
        put_log_tics(out, "x", &p->x);
    if (p->kind == PLOT_HEAT) {
        fprintf(out, "set yrange [-0.5:%zu.5]\n", p->up->count - 1);
        return;
    }
    fprintf(out, "set yrange [%.9g:%.9g]\n%s", p->y.from, p->y.to, p->y.log ? "set logscale y\n" : "");
    put_log_tics(out, "y", &p->y);
}

/* Writes the color bar next to the first panel, at least 110 pixels long. */
static void put_color_bar(FILE *out, const plot_plan *p)
{
    char label[160];
    size_t first = 0;
    while (!p->panels[first].used)
        first++;
    const plot_panel *panel = &p->panels[first];
    fprintf(out, "eval \"set palette defined \".viridis\nset cbrange [%.9g:%.9g]\n%s", p->y.from, p->y.to,
            p->y.log ? "set logscale cb\n" : "");
    put_log_tics(out, "cb", &p->y);
    put_setting(out, "cblabel", with_unit(&p->y, label), " offset 2.2,0");
    fprintf(out, "set colorbox user origin %.6f,%.6f size %.6f,%.6f\nunset key\nunset grid\n", p->key_left,
            fmin(panel->bottom, panel->top - 110.0 / p->height), 14.0 / p->width,
            fmax(panel->top - panel->bottom, 110.0 / p->height));
}

/* --- lines --- */

/* Writes the line type of a series: one of the style's six, or, for more series, a color of viridis. */
static void put_type(FILE *out, const plot_plan *p, size_t series)
{
    static const int points[] = {7, 5, 9, 13, 11, 3, 2, 1};
    const size_t count = p->series_count;
    if (count <= PLOT_COLORS)
        fprintf(out, "lt %zu", series + 1);
    else
        fprintf(out, "lt 1 pt %d lc palette frac %.3f", points[series % 8],
                0.92 * (double)series / (double)(count - 1));
}

static const char *drawing(const plot_plan *p)
{
    const bool spread = p->y.low >= 0 || p->y.least >= 0;
    if (p->kind == PLOT_DOTS)
        return spread ? "2:3:4:5 with yerrorbars" : "2:3 with points";
    return spread ? "2:3:4:5 with yerrorlines" : "2:3 with linespoints";
}

/* Words have no order that a line could follow. */
static const char *style_of(const plot_plan *p)
{
    return p->kind == PLOT_DOTS ? "points" : "linespoints";
}

static void put_key(FILE *out, const plot_plan *p)
{
    const char *style = style_of(p);
    for (size_t i = 0; p->by && i < p->by->count; i++) {
        fprintf(out, "    NaN with %s ", style);
        put_type(out, p, i);
        fputs(" title ", out);
        plot_script_text(out, p->by->texts[i]);
        fputs(", \\\n", out);
    }
    if (!p->by && p->published.series_count)
        fprintf(out, "    NaN with %s lt 1 title 'measured', \\\n", style);
    for (size_t i = 0; i < p->published.series_count; i++) {
        const char *source = p->published.names[i];
        char name[60];
        snprintf(name, sizeof name, "published%s%.24s%s", source[0] ? ": " : "", source,
                 strlen(source) > 24 ? "…" : "");
        fprintf(out, "    NaN with %s lt 7 pt %zu title ", style, 6 + 2 * i);
        plot_script_text(out, name);
        fputs(", \\\n", out);
    }
}

/* Draws the blocks of one panel; *index is the number of the next block. */
static void put_blocks(FILE *out, const plot_plan *p, size_t panel, size_t *index)
{
    const char *gap = "";
    for (size_t i = 0; i < p->point_count; i++) {
        const plot_point *point = &p->points[i];
        if (point->panel != panel || (i > 0 && point[-1].panel == panel && point[-1].series == point->series))
            continue;
        fprintf(out, "%s    rows index %zu using %s ", gap, *index, drawing(p));
        put_type(out, p, point->series);
        fputs(" notitle", out);
        gap = ", \\\n";
        ++*index;
    }
}

static size_t block_count(const plot_plan *p)
{
    size_t count = 0;
    for (size_t i = 0; i < p->point_count; i++)
        count +=
            i == 0 || p->points[i - 1].panel != p->points[i].panel || p->points[i - 1].series != p->points[i].series;
    return count;
}

static void put_heat(FILE *out, const plot_plan *p, size_t index)
{
    const int width = panel_pixels(p) / (int)p->along->count;
    fprintf(out,
            "plot rows index %zu using 2:3:($2-0.5):($2+0.5):($3-0.5):($3+0.5):4 with boxxyerror lc palette "
            "notitle",
            index);
    if (width >= 36)
        fprintf(out, ", \\\n    rows index %zu using 2:3:5:6 with labels font \",8\" textcolor rgb variable notitle",
                index);
    fputc('\n', out);
}

static void put_panel(FILE *out, const plot_plan *p, size_t number, size_t *index, bool first)
{
    const plot_panel *panel = &p->panels[number];
    char label[160];
    fprintf(out, "\nset lmargin at screen %.6f; set rmargin at screen %.6f\n", panel->left, panel->right);
    fprintf(out, "set bmargin at screen %.6f; set tmargin at screen %.6f\n", panel->bottom, panel->top);
    put_setting(out, "title", panel->title, "");
    put_setting(out, "xlabel", panel->shows_x ? p->x_label : "", "");
    put_setting(out, "ylabel", !panel->shows_y ? "" : p->kind == PLOT_HEAT ? p->up->name : with_unit(&p->y, label), "");
    fprintf(out, "set format x %s\nset format y %s\n", panel->shows_x ? "'%h'" : "''", panel->shows_y ? "'%h'" : "''");
    put_xtics(out, p, panel->shows_x);
    if (p->kind == PLOT_HEAT)
        put_tics(out, "ytics", p->up, NULL, 0, panel->shows_y);
    if (p->kind == PLOT_HEAT) {
        put_heat(out, p, (*index)++);
    } else {
        fputs("plot \\\n", out);
        if (first)
            put_key(out, p);
        put_blocks(out, p, number, index);
        for (size_t i = 0; i < p->published.series_count; i++)
            fprintf(out, ", \\\n    rows index %zu using 2:3 with %s lt 7 pt %zu notitle", block_count(p) + i,
                    style_of(p), 6 + 2 * i);
        fputc('\n', out);
    }
    if (first)
        fputs("unset label\nunset colorbox\nunset key\n", out);
}

status plot_script_write(const plot_plan *p, const char *base, diagnostic *why)
{
    char path[4096];
    file_writer file;
    snprintf(path, sizeof path, "%s.gp", base);
    TRY(file_writer_open(&file, path, why));
    FILE *out = file.stream;
    plot_script_head(out, p, base, true);
    put_axes(out, p);
    if (p->kind == PLOT_HEAT) {
        put_color_bar(out, p);
    } else {
        fprintf(out, "set key at screen %.6f,%.6f left top Left reverse vertical maxrows 40\n", p->key_left,
                p->key_top);
        if (p->by)
            put_setting(out, "key title", p->by->name, " left font \",9\"");
        if (p->series_count > PLOT_COLORS)
            fputs("eval \"set palette defined \".viridis\nunset colorbox\n", out);
    }
    fputs("set multiplot\n", out);
    size_t index = 0;
    bool first = true;
    for (size_t i = 0; i < p->panel_count; i++)
        if (p->panels[i].used) {
            put_panel(out, p, i, &index, first);
            first = false;
        }
    fputs("unset multiplot\n", out);
    return file_writer_end(&file, STATUS_OK, why);
}
