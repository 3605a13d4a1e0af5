/* Reading and writing of files. A written file appears complete or not at all, after a power cut too: it is written to
 * a temporary file in the same folder, flushed to disk, moved over the target, and the folder is flushed. Ownership:
 * the caller owns the text that was read; free it with free. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdio.h>

/* Reads a regular file of at most limit bytes; *text holds its bytes and a final 0, which *size does not count. */
status file_read(const char *path, size_t limit, char **text, size_t *size, diagnostic *why);
/* The same for a file below root (below_open); STATUS_BAD_INPUT for a file outside. */
status file_read_below(const char *path, const char *root, size_t limit, char **text, size_t *size, diagnostic *why);

/* Opens a file for reading if it is below a root folder. The check is made on the opened file and not on the path, so
 * that no symbolic link can be changed in between. root: the real path of the folder: absolute, without links, without
 * a trailing slash; NULL or "": no restriction. Does not block, for example on a FIFO without a writer. The caller owns
 * the descriptor. Returns -1 with errno; EXDEV: the file is outside the root and was not opened for reading. */
int below_open(const char *path, const char *root);

/* The error text for EXDEV. */
#define BELOW_WHAT "is outside the folder from which files may be read"
#define BELOW_REMEDY "move it into that folder, or choose a folder that contains both"

/* ---- writing ---- */

/* A file being written. Open it, write to stream, then commit or abandon: both free it. path "-" is standard output.
 * Nothing is visible at path before the commit. The commit reports the errors of all writes; cancelled work
 * (base/cancel.h) is abandoned. */
typedef struct file_writer {
    FILE *stream;
    char *path, *temporary; /* temporary: NULL without a name */
    bool atomic;            /* false: a device, a pipe or standard output, which is written directly */
} file_writer;

status file_writer_open(file_writer *writer, const char *path, diagnostic *why);
status file_writer_commit(file_writer *writer, diagnostic *why);
void file_writer_abandon(file_writer *writer);
/* Commits if code, the status of the writing so far, is STATUS_OK; otherwise abandons the file and returns code. */
status file_writer_end(file_writer *writer, status code, diagnostic *why);

/* Writes a file from text. */
status file_write(const char *path, const char *text, diagnostic *why);

/* ---- temporary files ---- */

/* A file that is written before it gets its name. If the file system supports it (O_TMPFILE), the file has no name
 * until then, so that a killed process leaves nothing. Otherwise, and for the instant of a replacement, its name is
 * .cuvette-HOST-N.part, perhaps with an ending, in the folder of its later name, and its writer holds a lock (flock).
 * The next writer of such a file in that folder removes those that nobody has locked. HOST is a hash of the host's
 * name, because the lock of a network file system may not reach other machines. Ownership: *name is the caller's, freed
 * with free. Errors: -1, with errno. */

/* Opens an empty file for writing, to be moved to path. *name: NULL if it has no name. */
int temporary_open(const char *path, char **name);

/* The same for a file that another program writes: it always has a name, which ends in `ending` (".png", at most 16
 * bytes). The descriptor holds the lock; the program may truncate the file, but not replace it. */
int temporary_open_named(const char *path, const char *ending, char **name);

/* Moves the open file to path; a file there is replaced. The descriptor stays open. After an error the caller removes
 * *name, unless it is NULL. */
int temporary_move(int fd, char **name, const char *path);

/* ---- names and folders ---- */

/* Flushes a file's entry in its folder to disk; some file systems do not support that, which is no error. */
void file_flush_folder(const char *path);

/* The last component of a path. */
const char *file_name_of(const char *path);

/* Resolves `name` against the folder of `path`; an absolute name is returned unchanged. Newly allocated; NULL: out of
 * memory. */
char *file_next_to(const char *path, const char *name);

/* Makes a folder and its parents, and flushes their entries to disk; no error if it exists. */
status file_make_directory(const char *path, diagnostic *why);
