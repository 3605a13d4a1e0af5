/* What a row of a study means: all that decides which frame its numbers are of, as names with values. What is not said
 * is at its default, so that a version of the program with more parameters, shapes or words finds the same meaning in
 * the same files; objects and shapes go by their names, never by a number of the program's own. For that to hold, a
 * default once published must not change, nor may a name or a word. Ownership: meaning_free releases what was
 * filled. */
#pragma once

#include "study/study.h"

typedef struct meaning_item {
    char *name, *value;
} meaning_item;
typedef struct meaning {
    meaning_item *items;
    size_t count;
} meaning;

/* Of a scene, with or without the parameters that are how a frame is computed (param.performance_only). STATUS_FAILURE
 * when memory is out. */
status meaning_of_scene(meaning *m, const scene *of, bool without_performance);
/* Of a study: its name, its scene with the fixed parameters, its grid. What files hold is not in it
 * (grid_hash_files). */
status meaning_of_study(meaning *m, const study *s);
void meaning_free(meaning *m);

/* The same for any order of the items. */
uint64_t meaning_hash(const meaning *m);

/* The first item that differs, in words: "render.width is 800 there, and 640 here". False when none does. */
bool meaning_difference(const meaning *there, const meaning *here, char *text, size_t size);
