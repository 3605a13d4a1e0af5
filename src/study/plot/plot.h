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
