/* The error interface of the library: errors are values. Every function that can fail returns a status; one that reads
 * user input also fills a diagnostic, which holds the file, line and column, what is wrong and how to fix it. The
 * library never prints and never exits. Ownership: a diagnostic holds its own text and needs no release. NULL is
 * allowed for a diagnostic that the caller does not need. */
#pragma once

#include <stddef.h>

typedef enum status {
    STATUS_OK = 0,
    STATUS_FAILURE = 1,      /* the machine failed: memory, disk, threads; exit code 1 */
    STATUS_BAD_INPUT = 2,    /* a file, option or value of the user is wrong; exit code 2 */
    STATUS_INTERRUPTED = 130 /* stopped on request; partial results are kept; exit code 130 */
} status;

typedef struct diagnostic {
    char file[512];   /* path or "" */
    long line;        /* from 1; 0 for none */
    long column;      /* from 1; 0 for none */
    char what[512];   /* what is wrong, no full stop */
    char remedy[512]; /* how to fix it, no full stop; "" if there is no useful advice */
} diagnostic;

enum { DIAGNOSTIC_TEXT_MAX = 1792 };

/* Fills *why (if not NULL) and returns code, so that a failing line reads `return diagnose(why, STATUS_BAD_INPUT, "set
 * a width from 1 to 65536", "width %ld is out of range", w);`. The file, line and column stay unchanged: the caller
 * that knows them calls diagnostic_locate. Control characters in the text are replaced by '?', so that it stays one
 * line. */
status diagnose(diagnostic *why, status code, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* For steps without clean-up: continues if the call succeeds, otherwise returns its status. */
#define TRY(call)                     \
    do {                              \
        const status tried_ = (call); \
        if (tried_ != STATUS_OK)      \
            return tried_;            \
    } while (0)

/* For steps with clean-up: makes the call if all succeeded so far, and stores its status. */
#define THEN(code, call) ((void)((code) == STATUS_OK ? ((code) = (call)) : STATUS_OK))

/* STATUS_FAILURE with the common text for out of memory. MEMORY_REMEDY: for messages that name what needs the
 * memory. */
status out_of_memory(diagnostic *why);
#define MEMORY_REMEDY "close other programs, or use a smaller scene or image"

/* Sets the position of the error. file may be NULL; line and column from 1, 0 for none. */
void diagnostic_locate(diagnostic *why, const char *file, long line, long column);

/* diagnose and diagnostic_locate in one: with a file, or another name of a place, without a line. */
status diagnose_at(diagnostic *why, const char *place, status code, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 5, 6)));

/* Returns the status of a step; if it failed, sets the position of the error to the place. */
status locate_failure(diagnostic *why, const char *place, status code);

/* Writes "file:line:column: what; remedy" (without absent parts) into text; returns text. */
char *diagnostic_text(const diagnostic *why, char *text, size_t size);

/* ---- system errors ---- */

/* What to do about an errno; NULL if that depends on what was being done. */
const char *system_remedy(int error);

/* Fills *why with "doing: reason" and a remedy. error: an errno. path: the place, or NULL to leave it unchanged.
 * Returns STATUS_FAILURE for faults of the machine (memory, disk space, open files, a damaged disk), and `otherwise`
 * for all other errors. The remedy is `advice` if system_remedy has none. */
status system_error(diagnostic *why, status otherwise, const char *path, const char *doing, int error,
                    const char *advice);
