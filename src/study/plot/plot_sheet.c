/* Writes the contact sheet: a script that shows the kept image of each cell with the values of its parameters. */
#include "base/file.h"
#include "base/text.h"
#include "study/plan/keep.h"
#include "study/plot/plot.h"
#include "study/rows/row_files.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TITLE = 36, LETTER = 6, LINE = 13, GAP = 10, MARGIN = 12, SHEET_WIDTH = 1200, WIDTH_MAX = 360, WIDTH_MIN = 110 };

/* An image of the sheet. */
typedef struct frame {
    size_t row;
    char *path; /* absolute */
} frame;

typedef struct sheet {
    frame frames[PLOT_SHEET_MAX];
    size_t count, missing, columns, lines;                    /* lines: of a caption */
    double last_missing;                                      /* the last cell that missing counts */
    int width, height;                                        /* of an image on the sheet */
    int image_width, image_height, least_width, least_height; /* in pixels */
} sheet;

static const char *last_part(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot ? dot + 1 : path;
}

/* --- images --- */

static status add_frame(const plot_plan *p, const char *folder, size_t row, sheet *out, diagnostic *why)
{
    const double cell = summary_table_real(&p->table, row, summary_table_column(&p->table, "cell"));
    char *path = keep_image_path(folder, (size_t)cell), *absolute = path ? realpath(path, NULL) : NULL;
    const bool known = path != NULL;
    free(path);
    if (!known)
        return out_of_memory(why);
    for (size_t i = 0; absolute && i < out->count; i++)
        if (strcmp(out->frames[i].path, absolute) == 0) { /* the same cell in another environment */
            free(absolute);
            return STATUS_OK;
        }
    if (!absolute) { /* the lines of a cell, one per environment, are neighbours */
        out->missing += out->missing == 0 || out->last_missing != cell;
        out->last_missing = cell;
        return STATUS_OK;
    }
    if (out->count == PLOT_SHEET_MAX) {
        free(absolute);
        return diagnose_at(why, p->s->path, STATUS_BAD_INPUT, "show a part of the grid with --where PATH=VALUE",
                           "more than %d images", PLOT_SHEET_MAX);
    }
    out->frames[out->count++] = (frame){row, absolute};
    return STATUS_OK;
}

/* The size in the header of a PNG: big-endian at bytes 16 and 20. False for another file. */
static bool size_of(const char *path, int *width, int *height)
{
    unsigned char head[24] = {0};
    FILE *file = fopen(path, "rb");
    const bool is_png = file && fread(head, 1, sizeof head, file) == sizeof head && memcmp(head + 1, "PNG", 3) == 0;
    if (file)
        fclose(file);
    *width = head[18] << 8 | head[19];
    *height = head[22] << 8 | head[23];
    return is_png && *width > 0 && *height > 0;
}

/* Finds the sizes of the smallest and the largest image. Places on the sheet have the aspect ratio of the largest. */
static status measure(sheet *out, diagnostic *why)
{
    for (size_t i = 0; i < out->count; i++) {
        int width, height;
        if (!size_of(out->frames[i].path, &width, &height))
            return diagnose_at(why, out->frames[i].path, STATUS_BAD_INPUT,
                               "remove it, and run the study again to render it", "the PNG file is incomplete");
        if (i == 0 || width > out->image_width)
            out->image_width = width, out->image_height = height;
        if (i == 0 || width < out->least_width)
            out->least_width = width, out->least_height = height;
    }
    return STATUS_OK;
}

static status find_frames(const plot_plan *p, sheet *out, diagnostic *why)
{
    char *folder = study_folder(p->s, p->request->results);
    status code = folder ? STATUS_OK : out_of_memory(why);
    for (size_t row = 0; code == STATUS_OK && row < p->table.rows; row++)
        if (p->shown[row])
            code = add_frame(p, folder, row, out, why);
    free(folder);
    if (code == STATUS_OK && out->count == 0)
        code = diagnose_at(why, p->s->path, STATUS_BAD_INPUT,
                           "write `keep: {image: on}` in the study, and run it again: only the images are added",
                           "the study has no kept images in %s", p->request->results);
    THEN(code, measure(out, why));
    return code;
}

/* --- layout --- */

/* Chooses a row for each value of the slower axes if the fastest axis fits; otherwise a shape that fills the page. */
static void find_columns(const plot_plan *p, sheet *out)
{
    size_t fastest = 1;
    for (size_t i = 0; i < p->axis_count; i++)
        if (p->axes[i].kept && p->axes[i].group == p->s->axis_count - 1)
            fastest = p->s->axes[p->axes[i].group].count;
    const bool fits = fastest > 1 && fastest <= 8 && out->count % fastest == 0 && !p->request->where_count;
    const double aspect = (double)out->image_height / out->image_width;
    out->columns = (size_t)ceil(sqrt((double)out->count * aspect * 1.3));
    if (fits && out->count > fastest)
        out->columns = fastest;
    out->columns = out->columns < 1 ? 1 : out->columns > 10 ? 10 : out->columns;
}

static size_t caption_lines(const plot_plan *p)
{
    size_t lines = 0;
    for (size_t i = 0; i < p->axis_count; i++)
        lines += p->axes[i].kept && p->axes[i].group != PLOT_NONE;
    return lines;
}

static status lay_out(plot_plan *p, sheet *out, diagnostic *why)
{
    find_columns(p, out);
    const int columns = (int)out->columns, rows = (int)((out->count + out->columns - 1) / out->columns);
    int width = (SHEET_WIDTH - 2 * MARGIN - (columns - 1) * GAP) / columns;
    width = width > WIDTH_MAX ? WIDTH_MAX : width < WIDTH_MIN ? WIDTH_MIN : width;
    out->width = width;
    out->height = (int)lround((double)width * out->image_height / out->image_width);
    out->lines = caption_lines(p);
    p->width = 2 * MARGIN + columns * (width + GAP) - GAP;
    p->width = p->width < 420 ? 420 : p->width;
    char least[40] = "";
    if (out->least_width != out->image_width)
        snprintf(least, sizeof least, "%d x %d to ", out->least_width, out->least_height);
    TRY(plot_caption_add(p, why, "%zu images of %s%d x %d pixels%s.", out->count, least, out->image_width,
                         out->image_height, p->request->where_count ? ", of the cells chosen by --where" : ""));
    if (out->missing)
        TRY(plot_caption_add(p, why, "%zu of %zu cells have no kept image.", out->missing, out->missing + out->count));
    p->height = TITLE + rows * (out->height + (int)out->lines * LINE + GAP) + (int)p->caption_count * LINE + 12;
    return STATUS_OK;
}

/* --- the script --- */

/* Writes a line for each parameter; names that do not fit are shortened. */
static void put_captions(FILE *out, const plot_plan *p, const sheet *s, size_t row, double left, double top)
{
    size_t line = 0;
    for (size_t i = 0; i < p->axis_count; i++) {
        const plot_axis *axis = &p->axes[i];
        if (!axis->kept || axis->group == PLOT_NONE)
            continue;
        const char *value = summary_table_text(&p->table, row, axis->column);
        const bool fits = (int)(strlen(axis->name) + strlen(value) + 3) * LETTER <= s->width;
        char *text = text_format("%s = %s", fits ? axis->name : last_part(axis->name), value);
        fprintf(out, "set label %zu ", 101 + line);
        plot_script_text(out, text ? text : value);
        fprintf(out, " at screen %.6f,%.6f left font \",8\" textcolor rgb ink\n", left / p->width,
                1 - (top + s->height + LINE * ((double)line + 0.65)) / p->height);
        free(text);
        line++;
    }
}

/* Writes a path, relative to the script if the image is below its folder, so that both can be moved together. */
static void put_path(FILE *out, const char *folder, const char *path)
{
    const size_t length = strlen(folder);
    const bool below = strncmp(path, folder, length) == 0 && path[length] == '/';
    fputs(below ? "here." : "", out);
    plot_script_text(out, below ? path + length + 1 : path);
}

static void put_frame(FILE *out, const plot_plan *p, const sheet *s, size_t number, const char *folder)
{
    const double left = MARGIN + (double)(number % s->columns) * (s->width + GAP);
    const double top = TITLE + (double)(number / s->columns) * (s->height + (double)s->lines * LINE + GAP);
    fprintf(out, "set lmargin at screen %.6f; set rmargin at screen %.6f\n", left / p->width,
            (left + s->width) / p->width);
    fprintf(out, "set bmargin at screen %.6f; set tmargin at screen %.6f\n", 1 - (top + s->height) / p->height,
            1 - top / p->height);
    put_captions(out, p, s, s->frames[number].row, left, top);
    fputs("plot ", out);
    put_path(out, folder, s->frames[number].path);
    fputs(" binary filetype=png with rgbimage notitle\n", out);
    if (number == 0)
        fputs("unset label\n", out);
}

static status put_script(const plot_plan *p, const sheet *s, const char *base, diagnostic *why)
{
    file_writer file;
    char *path = text_format("%s.gp", base), *parent = file_next_to(base, "."), *folder = NULL;
    status code = path && parent ? STATUS_OK : out_of_memory(why);
    THEN(code, file_writer_open(&file, path, why));
    if (code == STATUS_OK) {
        folder = realpath(parent, NULL);
        plot_script_head(file.stream, p, base, false);
        fputs("unset border; unset tics; unset key; unset grid\nset autoscale fix\nset multiplot\n", file.stream);
        for (size_t i = 0; i < s->count; i++)
            put_frame(file.stream, p, s, i, folder ? folder : "");
        fputs("unset multiplot\n", file.stream);
        code = file_writer_end(&file, STATUS_OK, why);
    }
    free(folder);
    free(parent);
    free(path);
    return code;
}

status plot_sheet_write(plot_plan *p, const char *base, diagnostic *why)
{
    sheet *s = calloc(1, sizeof *s);
    status code = s ? plot_axes_read(p, why) : out_of_memory(why);
    THEN(code, find_frames(p, s, why));
    THEN(code, lay_out(p, s, why));
    THEN(code, put_script(p, s, base, why));
    for (size_t i = 0; s && i < s->count; i++)
        free(s->frames[i].path);
    free(s);
    return code;
}
