/* The meaning of a row: everything that determines its frame, as pairs of name and value. Values at their first
 * defaults (param.first_default) are omitted, so that a version of the program with more parameters, shapes or words,
 * or with other defaults, gives the same meaning for the same values; so are parameters of random paths in a scene of
 * another integrator (param.by_chance); objects and shapes are identified by name. For
 * this, a published name or word must never change. Ownership: meaning_free releases what was filled. */
#pragma once

#include "study/study.h"

typedef struct meaning_item {
    char *name, *value;
} meaning_item;
typedef struct meaning {
    meaning_item *items;
    size_t count;
} meaning;

/* The meaning of a scene, with or without the parameters that affect only performance (param.performance_only).
 * STATUS_FAILURE if memory runs out. */
status meaning_of_scene(meaning *m, const scene *of, bool without_performance);
void meaning_free(meaning *m);

/* A hash that does not depend on the order of the items. */
uint64_t meaning_hash(const meaning *m);
