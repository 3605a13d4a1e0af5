/* The SVG 1.1 writer. Coordinates are rounded to 0.01 px, so that equal drawings have equal bytes; there are no scripts
 * and no embedded fonts. Colours are those of plots/style.gp (Okabe and Ito). Errors of the stream stay in the stream,
 * where the caller checks them. Ownership: nothing is kept. */
#pragma once

#include <stdio.h>

#define SVG_BLUE "#0072b2"
#define SVG_VERMILLION "#d55e00"
#define SVG_PURPLE "#cc79a7"
#define SVG_ORANGE "#e69f00"
#define SVG_INK "#222222"
#define SVG_GREY "#777777"

/* The start of the document with a white background and a title, which may be NULL. Sizes are CSS pixels. */
void svg_begin(FILE *out, double width, double height, const char *title);
void svg_end(FILE *out);

/* stroke: the attributes of the line, such as "stroke=\"#777777\"". */
void svg_line(FILE *out, double x1, double y1, double x2, double y2, const char *stroke);

/* anchor: "start", "middle" or "end". y is the baseline. */
void svg_label(FILE *out, double x, double y, const char *anchor, const char *color, const char *text);

/* An entry of a legend, line and text; returns the x of the next entry, x + width. dashes may be NULL. */
double svg_key(FILE *out, double x, double y, const char *color, const char *dashes, const char *words, double width);

/* Writes text with XML entities; control characters become '?'. */
void svg_escape(FILE *out, const char *text);
