/* Reading and writing of whole files. A written file appears complete or not at all, after a power cut too: it is
 * written to a temporary file in the same folder (base/temporary.h), flushed to disk, moved over the target, and the
 * folder is flushed. Ownership: the caller owns the text that was read; free it with free. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdio.h>

/* Reads a regular file of at most limit bytes; *text is its bytes and a final 0, which *size does not count. */
status file_read(const char *path, size_t limit, char **text, size_t *size, diagnostic *why);
/* The same for a file below root (base/below.h); STATUS_BAD_INPUT for a file outside. */
status file_read_below(const char *path, const char *root, size_t limit, char **text, size_t *size, diagnostic *why);

/* A file being written. Open it, write to stream, then commit or abandon: both free it. path "-" is standard output.
 * Nothing is visible at path before the commit. The commit reports the errors of all writes; cancelled
 * work (base/cancel.h) is abandoned. */
typedef struct file_writer {
    FILE *stream;
    char *path, *temporary; /* temporary: NULL without a name */
    bool whole;             /* false: a device, a pipe or standard output, which is written directly */
} file_writer;

status file_writer_open(file_writer *writer, const char *path, diagnostic *why);
status file_writer_commit(file_writer *writer, diagnostic *why);
void file_writer_abandon(file_writer *writer);
/* Commits if code, the status of the writing so far, is STATUS_OK; otherwise abandons the file and returns code. */
status file_writer_end(file_writer *writer, status code, diagnostic *why);

/* Writes a whole file from text. */
status file_write(const char *path, const char *text, diagnostic *why);

/* Flushes a file's entry in its folder to disk; some file systems do not support that, which is no error. */
void file_flush_folder(const char *path);

/* The last component of a path. */
const char *file_name_of(const char *path);

/* The path of `name` relative to the folder of path; newly allocated, or NULL. */
char *file_beside(const char *path, const char *name);

/* Makes a folder and its parents, and flushes their entries to disk; no error if it exists. */
status file_make_directory(const char *path, diagnostic *why);
