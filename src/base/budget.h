/* Memory and disk space: how much is left, and checks that refuse a request before it fails. No result depends on
 * them. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdint.h>

/* ---- memory ---- */

/* The memory that the process may still allocate. Sizes that users choose (films, meshes, images, hierarchies) are
 * compared with it before the allocation, so that too large a request is refused at once and does not swap, or get the
 * process killed. The limit applies to the process: a program sets it once, at its start; the library never does.
 *
 * Without a limit the process may allocate three quarters of the free memory. Free is the least of what is free on the
 * machine (MemAvailable), in each control group (versions 1 and 2; pages that can be dropped do not count as used), and
 * in the address space (RLIMIT_AS). A value that cannot be read does not limit. */

/* Bytes that the process may use in all; 0: the default. */
void memory_budget_set(uint64_t bytes);
uint64_t memory_budget_limit(void);

/* Bytes that the process may still allocate. *chosen: whether memory_budget_set decides. Takes about 0.1 ms. */
uint64_t memory_budget_left(bool *chosen);

/* For a thread that cannot read /proc: memory_budget_snapshot finds the answer now, and memory_budget_left returns it
 * on the thread that calls memory_budget_assume. */
typedef struct memory_room {
    uint64_t left;
    bool chosen, known;
} memory_room;
memory_room memory_budget_snapshot(void);
void memory_budget_assume(memory_room room);

/* The free bytes according to the files of /proc and /sys below root ("" for the real ones), at most address_space, the
 * bytes left in the address space; UINT64_MAX without a limit. */
uint64_t memory_budget_free(const char *root, uint64_t address_space);

/* STATUS_BAD_INPUT if bytes, an estimate, are more than what is left: "WHAT needs about 12.3 GiB of memory, more than
 * the 9.1 GiB that ...", with the remedy and --memory-limit. Below 16 MiB nothing is looked up, unless a limit was set.
 * remedy: how to need less ("use fewer triangles"). */
status memory_budget_check(uint64_t bytes, const char *remedy, diagnostic *why, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* Writes a size such as "12.3 GiB"; returns text. */
enum { MEMORY_TEXT_MAX = 32 };
char *memory_text(uint64_t bytes, char text[MEMORY_TEXT_MAX]);

/* Reads a size: a number with K, M, G or T (powers of 1024; a B or iB may follow). False for anything else. */
bool memory_parse(const char *text, uint64_t *bytes);

/* ---- disk space ---- */

/* Bytes that will be written: at least (what cannot be compressed or left out), and at most. */
typedef struct disk_room {
    double least_bytes, most_bytes;
} disk_room;

/* Adds count files of these sizes; most_bytes of each is rounded up to blocks. */
void disk_room_add(disk_room *to, double count, double least_bytes, double most_bytes);

/* Free bytes for this user on the file system of path, which need not exist yet; NaN if unknown. Quotas are ignored. */
double disk_room_free(const char *path);

enum { DISK_ROOM_TEXT_MAX = 160 };
/* STATUS_FAILURE, with both numbers, if even least_bytes do not fit into free_bytes. place: the file or folder that the
 * message names. what: the writer, subject of the message ("the run"). If most_bytes do not fit, note becomes the text
 * of a warning; otherwise "". */
status disk_room_check(const disk_room *needed, double free_bytes, const char *place, const char *what,
                       char note[DISK_ROOM_TEXT_MAX], diagnostic *why);

/* Writes a range such as "1.2 GB to 3.4 GB". */
void disk_room_text(const disk_room *needed, char *text, size_t size);
/* Writes a size such as "1.2 GB", with powers of 1000. */
void disk_room_bytes_text(double bytes, char *text, size_t size);
