/* Terminal and signals: the progress line, colour, the stop request of SIGINT, SIGTERM and SIGHUP, and checked standard
 * output. The stop request, standard output and the exit handler are global state of the program. */
#pragma once

#include "base/status.h"

#include <stdbool.h>

/* Sets up signals and standard output. Opens closed descriptors among 0 to 2, turns SIGPIPE and SIGXFSZ into errors of
 * the write, SIGINT, SIGTERM and SIGHUP (unless ignored, by nohup) into a stop request, which also cancels the work of
 * the calling thread (base/cancel.h; a second signal, at least a fifth of a second later, kills), and makes exit()
 * check that standard output was written. Must be called first. */
void terminal_prepare(void);

/* Whether SIGINT has arrived, also under a shield: Ctrl-C, not the end of the session or the machine. */
bool terminal_stopped_by_user(void);

/* Flushes standard output. STATUS_FAILURE if data could not be written; if the reader of a pipe has closed it, *why
 * stays empty, so that nothing is printed. */
status terminal_flush(diagnostic *why);

/* Returns whether fd is a terminal with cursor movement and colour; TERM=dumb has neither. */
bool terminal_is_smart(int fd);

/* Width of the terminal fd in columns: as the terminal reports it, otherwise COLUMNS, otherwise 80. 0 if fd is not a
 * terminal. */
int terminal_columns(int fd);

/* Prints "cuvette: ..." as one line on standard error; nothing for an empty diagnostic. */
void terminal_error(const diagnostic *why);

/* Prints "cuvette: note: ..." as one line on standard error. */
void terminal_note(const char *text);
/* The same, about a file; nothing for an empty text. */
void terminal_note_of(const char *path, const char *text);

/* A progress line with the time left, on standard error if that is a terminal. Work of less than half a second shows
 * none. Ownership: the label is borrowed. */
typedef struct progress_line {
    const char *label;
    double started_s;
    int shown; /* characters on the screen */
    bool enabled;
} progress_line;

void progress_start(progress_line *line, const char *label);
/* fraction: 0..1 */
void progress_draw(progress_line *line, double fraction);
/* Erases the line; does nothing when no line is shown. */
void progress_erase(progress_line *line);
