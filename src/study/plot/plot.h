/* A figure of a study's summary, chosen from its grid and drawn by gnuplot. One numeric parameter makes lines, two with
 * at least three values each make a heat map, and words make dots; the other parameters become lines or panels. Cells
 * of unlike environments are never joined by a line, nor combined in one cell of a heat map. A second kind of figure,
 * the sheet, shows the kept images with captions.
 *
 * A figure is a script, BASE.gp, which contains the style and can be edited, and its data, BASE.tsv. Ownership: nothing
 * is kept. STATUS_BAD_INPUT: no such column, value or file, or more lines, panels or images than a figure can show;
 * STATUS_FAILURE: the chosen cells have no value, or gnuplot is missing or fails. */
#pragma once

#include "study/study.h"
#include "study/summary/summary.h"
#include <stdio.h>

typedef enum plot_log { PLOT_LOG_AUTO, PLOT_LOG_NONE, PLOT_LOG_X, PLOT_LOG_Y, PLOT_LOG_XY } plot_log;

typedef struct plot_request {
    const char *results; /* results folder */
    const char *x, *y,
        *by; /* NULL: chosen by the program; x: a parameter of the grid or a column; y: a column; by: a parameter */
    const char *const *where; /* PATH=VALUE: only cells with this value */
    size_t where_count;
    plot_log log;
    const char *published; /* CSV file with numbers to compare with, or NULL */
    bool images;           /* make a sheet instead of a figure */
} plot_request;

/* Writes BASE.gp and, for a figure, BASE.tsv. */
status study_plot_write(const study *s, const plot_request *request, const char *base, diagnostic *why);

/* Runs gnuplot on BASE.gp; BASE.png, .svg or .pdf (format: png, svg, pdf) appears complete or not at all.
 * STATUS_INTERRUPTED after limit_s, or when cancelled. */
status study_plot_draw(const char *base, const char *format, double limit_s, diagnostic *why);

/* The beginning of any script that study_plot_draw draws: how to redraw it, `rows` (the path of the file BASE with the
 * ending `data`, unless that is NULL), width and height in px, and the style. by: the command that writes it. */
void plot_script_open(FILE *out, const char *by, const char *base, const char *data, int width, int height);
/* A text as gnuplot reads it, in quotes. */
void plot_script_text(FILE *out, const char *text);

/* The parts of a figure, private to study/plot. A plan is made in this order: the table, its shown rows and linked
 * parameters (plot_axes.c), the kind (plot.c), measured and published points (plot_data.c), scales
 * (plot_scale.c), layout with captions (plot_layout.c); then the data (plot_data.c) and the script (plot_script.c) are
 * written. Ownership: plot_plan_free releases a plan, also an unfinished one; the study and the request are borrowed.
 * Errors: as in plot.h. */

enum {
    PLOT_AXES_MAX = 64,
    PLOT_SERIES_MAX = 12,
    PLOT_COLORS = 6, /* line types of measured series in plots/style.gp */
    PLOT_PANELS_MAX = 36,
    PLOT_CAPTIONS_MAX = 24,
    PLOT_SHEET_MAX = 240 /* images of a sheet */
};

#define PLOT_NONE SIZE_MAX

/* A parameter of the grid, or the environment, and its distinct values: numbers in ascending order, words in the order
 * of the study. */
typedef struct plot_axis {
    const char *name;
    long column;
    size_t group; /* the study's axis that sets the parameter; PLOT_NONE for the environment */
    bool numeric;
    bool kept; /* false: constant, or determined by the kept parameters of the same axis of the study */
    size_t count;
    const char **texts;
    double *reals;
    size_t *at; /* for each row of the table, the index of its value; PLOT_NONE: not shown */
} plot_axis;

/* A measured column, with its interval and range if the summary has them. */
typedef struct plot_quantity {
    char name[64], label[96], unit[24]; /* label: without the unit */
    long value, low, high, least, most; /* columns, or -1 */
    double factor;                      /* shown value = value of the table * factor */
    bool log;
    double from, to; /* shown range, in shown units */
} plot_quantity;

typedef enum plot_kind { PLOT_LINES, PLOT_DOTS, PLOT_HEAT } plot_kind;

typedef struct plot_point {
    size_t row, panel, series;
    size_t along;           /* index of the value on the axis along which lines run */
    size_t up;              /* heat map: index on the vertical axis */
    double x, y, low, high; /* in shown units after plot_scale; low and high NaN without any spread */
} plot_point;

typedef struct plot_published {
    double *x, *y; /* in shown units after plot_scale */
    size_t *series, count, series_count;
    char **names; /* of the series */
    char caption[320];
} plot_published;

typedef struct plot_panel {
    char *title;
    double left, right, bottom, top; /* fractions of the figure */
    bool shows_x, shows_y;
    bool used;
} plot_panel;

typedef struct plot_plan {
    const study *s;
    const plot_request *request;
    summary_table table;
    bool *shown; /* for each row of the table */
    plot_axis axes[PLOT_AXES_MAX];
    size_t axis_count;
    plot_kind kind;
    const plot_axis *along, *up, *by; /* up: vertical axis of a heat map; along is the horizontal one. May be NULL */
    const plot_axis *faceted[PLOT_AXES_MAX];
    size_t faceted_count;
    plot_quantity x, y; /* x.value: -1 if x is the axis `along` */
    char x_label[160];
    plot_point *points; /* ordered by panel, series, along, up */
    size_t point_count, series_count;
    plot_panel *panels;
    size_t panel_count; /* one for each combination of values; only used ones are drawn */
    plot_published published;
    int width, height; /* CSS pixels */
    double key_left, key_top;
    char *captions[PLOT_CAPTIONS_MAX];
    size_t caption_count;
} plot_plan;

/* Runs all steps of a figure. */
status plot_figure_write(plot_plan *p, const char *base, diagnostic *why);

/* Reads the summary, unless the plan has a table, applies --where, and finds the axes. */
status plot_axes_read(plot_plan *p, diagnostic *why);
/* Chooses the kind, and which parameters become the x axis, lines and panels. */
status plot_axes_choose(plot_plan *p, diagnostic *why);
/* The axis of that name, or NULL. */
const plot_axis *plot_axis_named(const plot_plan *p, const char *name);

/* plot_points_collect finds the points that have a value; plot_data_write writes them after plot_scale. */
status plot_points_collect(plot_plan *p, diagnostic *why);
status plot_data_write(const plot_plan *p, const char *path, diagnostic *why);
/* Reads the published numbers. */
status plot_published_read(plot_plan *p, diagnostic *why);

/* Finds the columns, label and unit of a quantity; option: the place of an error, "--x" or "--y". */
status plot_quantity_find(const plot_plan *p, const char *option, const char *name, plot_quantity *out,
                          diagnostic *why);
status plot_scale(plot_plan *p, diagnostic *why);

status plot_layout(plot_plan *p, diagnostic *why);
/* Wraps a caption to the width of the figure and adds its lines. */
status plot_caption_add(plot_plan *p, diagnostic *why, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Write parts of a script: its head with the style (data: and with the path of the data file); a text as a string of
 * gnuplot. */
void plot_script_head(FILE *out, const plot_plan *p, const char *base, bool data);
status plot_script_write(const plot_plan *p, const char *base, diagnostic *why);
status plot_sheet_write(plot_plan *p, const char *base, diagnostic *why);

void plot_plan_free(plot_plan *p);
