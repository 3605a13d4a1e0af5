/* Cells by content. The identity of a cell is a hash of everything that determines its film and its measurement: the
 * values of its scene that differ from their first default (scene/model/params.h), its objects and shapes by name, and
 * the contents of all files that it names. So a new parameter changes no identity, and a cell keeps its rows when axes
 * of its study grow, shrink or are reordered. Ownership: identities_find gives an array for free. */
#pragma once

#include "study/study.h"

/* The identity of each cell, in their order. The files of s->base must be loaded; those that an axis names are loaded
 * here. */
status identities_find(const study *s, uint64_t **out, diagnostic *why);

/* The number of the cell with that identity, or study_cell_count(s). */
size_t identity_cell(const study *s, uint64_t identity);

/* The identity of a row of compare.csv: that of the cell and its reference. */
uint64_t identity_compared(const study *s, uint64_t identity);
