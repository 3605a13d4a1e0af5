/* The figures of the results: SVG files that scripts in plots/ of the chosen folder draw from studies' rows
 * (plots/draw.sh). A script says in its head what it needs (`# needs: tables/NAME.tsv`); a figure without one belongs
 * to the study that its name begins with. Names of figures are small letters, digits and '-'. Ownership: what is given
 * is the caller's. */
#pragma once

#include "study/study.h"
#include "web/lab_private.h"

/* The figure as it was drawn last; STATUS_BAD_INPUT where there is none. */
status figure_read(const lab *l, const char *name, char **svg, size_t *size, diagnostic *why);

/* Names of the figures of that study that are there; NULL when memory is out. */
json_t *figures_of(const lab *l, const char *name);
/* Those that could be drawn of it; empty without plots/draw.sh. */
json_t *figures_drawable(const lab *l, const char *name);

/* Writes the tables of the study (results/tables/) and draws its figures; takes less than a minute, which is how long a
 * page waits. *said: what the script said, one line a figure, or NULL. *whole: it failed in none of them; figures of a
 * study that is not complete often cannot be drawn. */
status figures_draw(const lab *l, const study *s, char **said, bool *whole, diagnostic *why);
