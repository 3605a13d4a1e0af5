/* What the program does with the terminal and with signals: the one line of progress, colour, the wish to stop, and
 * standard output that is known to have arrived. The stop flag and the exit handler are the program's only global
 * state. */
#pragma once

#include "base/status.h"
#include <stdbool.h>

/* Opens what is closed of descriptors 0 to 2, ignores SIGPIPE, makes SIGINT and SIGTERM a wish to stop (the second
 * one kills), and has exit() check that standard output was written. Call it first. */
void terminal_prepare(void);

/* Has SIGINT or SIGTERM come? unused: so that others can be told to ask. */
bool terminal_stop_asked(void *unused);

/* Flushes standard output; failure if something could not be written. The reader of a pipe who left is a failure
 * without words: *why is then left empty. */
status terminal_flush(diagnostic *why);

/* Is fd a terminal that moves its cursor, and takes colour? TERM=dumb does not. */
bool terminal_is_smart(int fd);

/* Columns of the terminal that fd is; 0 when it is none. */
int terminal_columns(int fd);

/* "cuvette: ..." in one line on standard error; nothing for an empty diagnostic. */
void terminal_error(const diagnostic *why);

/* "cuvette: note: ..." in one line on standard error. */
void terminal_note(const char *text);

/* One line of progress with the time left, on standard error if that is a terminal, nothing elsewhere. Work of under
 * half a second shows none. Ownership: the label is borrowed. */
typedef struct progress_line {
    const char *label;
    double started_s;
    int shown; /* characters on the screen */
    bool enabled;
} progress_line;

void progress_start(progress_line *line, const char *label);
/* share_done: 0..1 */
void progress_draw(progress_line *line, double share_done);
/* Leaves the line as it was before. Harmless when nothing is shown. */
void progress_erase(progress_line *line);
