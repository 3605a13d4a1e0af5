/* The names of a scene's objects, and other words of its file: which names are valid, which are in use, and what a
 * wrong word was probably meant to be. Pure, except for the memory of a tally. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Letters, digits, _ and -, not starting with a digit or -, at most SCENE_NAME_MAX bytes, and not a reserved word of
 * paths or scene files. */
status check_name(const char *name, diagnostic *why);

/* How many objects of a scene may have a name: an upper bound by the names' hashes, which is nearly always exact; and
 * where the newest of them is. So the time to find a name does not depend on the number of objects.
 *
 * Ownership: zero-initialised; name_tally_clear frees. Without memory it is `lost`, and gives the largest bound. */
typedef struct name_place {
    uint32_t group, index; /* in a scene's lists */
} name_place;
typedef struct name_tally {
    uint64_t *hash;     /* open addressing; a place with count 0 and hash 0 is free */
    uint32_t *count;    /* of names with that hash */
    name_place *newest; /* of them */
    size_t size, used;
    bool lost;
} name_tally;

void name_tally_add(name_tally *t, const char *name, name_place at);
void name_tally_remove(name_tally *t, const char *name);
/* At least the number of objects with that name. */
size_t name_tally_most(const name_tally *t, const char *name);
/* The place of the newest object with that name, or with another name of equal hash; NULL if there is none, or if it is
 * not known. An object that has moved needs name_tally_move. */
const name_place *name_tally_newest(const name_tally *t, const char *name);
void name_tally_move(name_tally *t, const char *name, name_place to);
void name_tally_clear(name_tally *t);

/* The word of words[0..count-1] that was probably meant: a synonym (n and index for ior, opacity for transparency), the
 * only word that begins with wrong (fov for fov_deg), or the nearest in spelling. NULL if there is none; numbers and
 * words of one or two characters, to which every short word is near, match only synonyms. */
const char *suggest_word(const char *wrong, const char *const *words, size_t count);

/* The remedy for a wrong key if words[] are the valid ones; returns text. */
char *suggest_key(const char *wrong, const char *const *words, size_t count, char *text, size_t size);

/* "prefix" and "a, b, c"; what has no room in the buffer is left out: "a, b, ...". */
void suggest_list(const char *prefix, const char *const *words, size_t count, char *text, size_t size);
