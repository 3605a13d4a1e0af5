/* The memory that the process may still take. Sizes that users choose (films, meshes, images, hierarchies) are compared
 * with it before memory is taken, so that too large a request is refused at once and does not swap, or get the process
 * killed. No result depends on it. The limit is the process's, as its memory is: a program sets it once, at its start;
 * the library never does.
 *
 * Without a limit of its own the process may take three quarters of what is free: of the machine's memory
 * (MemAvailable), of its control groups' (versions 1 and 2, less what they use, pages that can be dropped not counted),
 * and of its address space (RLIMIT_AS), whichever is least. What cannot be read does not limit. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdint.h>

/* Bytes that the process may use in all; 0: the default. */
void memory_budget_set(uint64_t bytes);
uint64_t memory_budget_limit(void);

/* Bytes that it may still take. *chosen: by memory_budget_set. About 0.1 ms. */
uint64_t memory_budget_left(bool *chosen);

/* Looks the answer up now, for a thread that will not be able to: memory_budget_left of the thread that then calls
 * memory_budget_assume returns it. */
typedef struct memory_room {
    uint64_t left;
    bool chosen, known;
} memory_room;
memory_room memory_budget_look(void);
void memory_budget_assume(memory_room room);

/* What is free by the files of /proc and /sys below root ("" for the real ones), and by address_space, the bytes left
 * of it; UINT64_MAX where nothing limits. */
uint64_t memory_budget_free(const char *root, uint64_t address_space);

/* STATUS_BAD_INPUT if bytes, an estimate, are more than what is left: "WHAT needs about 12.3 GiB of memory, more than
 * the 9.1 GiB that ...", with the remedy and --memory-limit. Below 16 MiB nothing is looked up, unless a limit was set.
 * remedy: what makes it smaller ("use fewer triangles"). */
status memory_budget_check(uint64_t bytes, const char *remedy, diagnostic *why, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* "12.3 GiB"; returns text. */
enum { MEMORY_TEXT_MAX = 32 };
char *memory_text(uint64_t bytes, char text[MEMORY_TEXT_MAX]);

/* The opposite: a number with K, M, G or T (powers of 1024; a B or iB may follow). False for anything else. */
bool memory_parse(const char *text, uint64_t *bytes);
