/* Figures of results: SVG files that scripts in plots/ of the chosen folder draw from the rows of studies
 * (plots/draw.sh). The head of a script lists its input files (`# needs: tables/NAME.tsv`); a figure without that
 * line belongs to the study that its name begins with. Names of figures consist of lower-case letters, digits and
 * '-'. Ownership: results belong to the caller. */
#pragma once

#include "study/study.h"
#include "web/lab_private.h"

/* Reads the figure as last drawn; STATUS_BAD_INPUT if it does not exist. */
status figure_read(const lab *l, const char *name, char **svg, size_t *size, diagnostic *why);

/* Names of the existing figures of a study. STATUS_FAILURE: a folder or script that is there cannot be read now. */
status figures_of(const lab *l, const char *name, json_t **out, diagnostic *why);
/* Names of the figures that can be drawn of it; empty without plots/draw.sh. */
status figures_drawable(const lab *l, const char *name, json_t **out, diagnostic *why);

/* Writes the tables of the study (results/tables/) and draws its figures; limited to less than a minute, the time
 * that a page waits for a reply. *output: the script's output, one line per figure, or NULL. *complete: no figure
 * failed; figures of an incomplete study often cannot be drawn. */
status figures_draw(const lab *l, const study *s, char **output, bool *complete, diagnostic *why);
