/* SVG 1.1 as text: decimals to a hundredth of a pixel, so that the same drawing is the same bytes; no scripts, no fonts
 * of its own. Colours are those of plots/style.gp: Okabe and Ito's. Errors of the stream are left in the stream.
 * Ownership: nothing is kept. */
#pragma once

#include <stdio.h>

#define SVG_BLUE "#0072b2"
#define SVG_VERMILLION "#d55e00"
#define SVG_GREEN "#009e73"
#define SVG_PURPLE "#cc79a7"
#define SVG_ORANGE "#e69f00"
#define SVG_INK "#222222"
#define SVG_GREY "#777777"
#define SVG_PALE "#d9d9d9"

/* The document's head with a white ground and a title, which may be NULL. Sizes are CSS pixels. */
void svg_begin(FILE *out, double width, double height, const char *title);
void svg_end(FILE *out);

/* stroke: the attributes that a line has beside its ends, as "stroke=\"#777777\"". */
void svg_line(FILE *out, double x1, double y1, double x2, double y2, const char *stroke);

/* anchor: "start", "middle" or "end". y is the base line. */
void svg_label(FILE *out, double x, double y, const char *anchor, const char *color, const char *text);

/* A line of a key and what it stands for; returns where the next one may begin, width px on. dashes may be NULL. */
double svg_key(FILE *out, double x, double y, const char *color, const char *dashes, const char *words, double width);

/* Writes text with what XML would misread as entities, and without what it forbids. */
void svg_escape(FILE *out, const char *text);
