/* The files of a folder, to compare before and after a command. Ownership: a listing owns its entries. Errors end the
 * driver: it cannot judge without its own files. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct entry {
    char *name;            /* relative to the folder */
    uint64_t hash, masked; /* of the content, and of the content without its numbers */
    long size, lines;
} entry;

typedef struct listing {
    entry *entries; /* by name */
    size_t count;
} listing;

listing folder_list(const char *path);
void listing_free(listing *l);
const entry *listing_find(const listing *l, const char *name);
bool listing_same(const listing *a, const listing *b);

/* Empties `to`, which may not exist, and copies the files of `from` into it. */
void folder_copy(const char *from, const char *to);
void folder_remove(const char *path);

/* A whole file as text, with a final 0; empty when it does not exist. The caller frees it. */
char *file_text(const char *path, size_t *size);
/* Replaces each number, times above all, by '#', in place. */
void mask_numbers(char *text);
