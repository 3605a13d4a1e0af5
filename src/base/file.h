/* Whole files in and out. A file that is written appears whole or not at all: it is built beside its
 * place, flushed to disk and renamed over it. Ownership: read text is the caller's, release with free. */
#pragma once

#include "base/status.h"
#include <stdio.h>

/* Reads a regular file of at most limit bytes; *text is its bytes and a final 0 that *size leaves out. */
status file_read(const char *path, size_t limit, char **text, size_t *size, diagnostic *why);
/* The same of a file that lies below root (base/below.h); STATUS_BAD_INPUT for others. */
status file_read_below(const char *path, const char *root, size_t limit, char **text, size_t *size, diagnostic *why);

/* A file being written. Open, write to stream, then commit or abandon: both release it. path "-" is standard
 * output. Nothing shows under path before the commit. The errors of all the writes come out at the commit. */
typedef struct file_writer {
    FILE *stream;
    char *path, *temporary;
} file_writer;

status file_writer_open(file_writer *writer, const char *path, diagnostic *why);
status file_writer_commit(file_writer *writer, diagnostic *why);
void file_writer_abandon(file_writer *writer);
/* One or the other: commits where code, of what was to be written, is STATUS_OK; else abandons and returns it. */
status file_writer_end(file_writer *writer, status code, diagnostic *why);

/* The whole of a text, at once. */
status file_write(const char *path, const char *text, diagnostic *why);

/* The entry of a file in its folder must reach the disk too; some file systems cannot do that, which is no error. */
void file_flush_folder(const char *path);

/* The last part of a path. */
const char *file_name_of(const char *path);

/* name as it is seen from the folder of path; fresh memory, or NULL. */
char *file_beside(const char *path, const char *name);

/* Makes a directory and its parents; no error if it is there. */
status file_make_directory(const char *path, diagnostic *why);
