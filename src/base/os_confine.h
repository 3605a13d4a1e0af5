/* Rights that a thread drops permanently, so that a fault in a reader of other people's files does little harm:
 * Landlock for files and outgoing TCP connections (Linux 5.13), seccomp for system calls. They hold for the calling
 * thread, and for the threads and processes that it starts later; other threads of the process keep theirs. Where the
 * kernel or a container refuses, the functions return false and nothing has changed: the caller continues unconfined.
 * Both also rule out new privileges by set-user-ID programs (no_new_privs). They are off with CUVETTE_SANDBOX=off in
 * the environment and under valgrind; the filter of system calls also in builds with sanitizers, which need more
 * calls. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef enum confine_right { CONFINE_READ = 1, CONFINE_RUN = 2, CONFINE_WRITE = 4 } confine_right;

/* A file, or a folder with all below it. RUN includes READ; WRITE includes READ, creating, renaming and removing. */
typedef struct confine_place {
    const char *path;
    unsigned rights;
} confine_place;

/* Restricts access to these places; places that do not exist are skipped. Open files stay open. If it returns false,
 * errno is 0, or reports a shortage (memory, open files). */
bool os_confine_files(const confine_place *places, size_t count);

/* CONFINE_COMPUTING: memory, locks, clocks and the end of the thread; no files, no descriptors. CONFINE_READING: also
 * opening files for reading, reading and writing what is open, and more threads. Everything else fails with EPERM. */
typedef enum confine_calls { CONFINE_COMPUTING, CONFINE_READING } confine_calls;
bool os_confine_calls(confine_calls what);

/* Whether confinement is off, by the environment or valgrind. */
bool os_confine_is_off(void);
