/* How the library says that something went wrong: by value. Every function that can fail returns a
 * status; one that reads what a person wrote also fills a diagnostic, which names file, line, column,
 * what is wrong and what would be right. The library never prints and never exits.
 * Ownership: a diagnostic holds its own text and needs no release. NULL is allowed for one that the
 * caller does not care about. */
#pragma once

#include <stddef.h>

typedef enum status {
    STATUS_OK = 0,
    STATUS_FAILURE = 1,      /* the machine failed us: memory, disk, threads; exit code 1 */
    STATUS_BAD_INPUT = 2,    /* a person's file, option or value is wrong; exit code 2 */
    STATUS_INTERRUPTED = 130 /* stopped on request; partial results are kept; exit code 130 */
} status;

typedef struct diagnostic {
    char file[512];   /* path or "" */
    long line;        /* from 1; 0 when there is none */
    long column;      /* from 1; 0 when there is none */
    char what[512];   /* what is wrong, no full stop */
    char remedy[512]; /* what would be right, no full stop; "" when nothing sensible can be said */
} diagnostic;

enum { DIAGNOSTIC_TEXT_MAX = 1792 };

/* Fills *why (when not NULL) and returns code, so that a failing line reads
 * `return diagnose(why, STATUS_BAD_INPUT, "set a width from 1 to 65536", "width %ld is out of range", w);`
 * file, line and column are left as they were: the caller that knows them calls diagnostic_locate.
 * Control characters in the text are replaced by '?', so that it stays one line. */
status diagnose(diagnostic *why, status code, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* For steps that leave nothing to tidy up: goes on where the call is well, else returns what it returned. */
#define TRY(call)                     \
    do {                              \
        const status tried_ = (call); \
        if (tried_ != STATUS_OK)      \
            return tried_;            \
    } while (0)

/* For steps that leave something to tidy up: makes the call where all went well so far, and keeps what it returned. */
#define THEN(code, call) ((void)((code) == STATUS_OK ? ((code) = (call)) : STATUS_OK))

/* STATUS_FAILURE, and the same words for all that runs out of memory. */
status out_of_memory(diagnostic *why);

/* Says where the trouble is. file may be NULL; line and column from 1, 0 for none. */
void diagnostic_locate(diagnostic *why, const char *file, long line, long column);

/* Both in one: diagnose, and the file, or what else stands for a place, without a line. */
status diagnose_at(diagnostic *why, const char *place, status code, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 5, 6)));

/* Hands on what a step returned; where that is not well, the trouble is at the place. */
status locate_failure(diagnostic *why, const char *place, status code);

/* Writes "file:line:column: what; remedy" (parts that are absent are left out) into text; returns text. */
char *diagnostic_text(const diagnostic *why, char *text, size_t size);
