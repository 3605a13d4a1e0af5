/* A file that is written before it gets its name. Where the file system supports it (O_TMPFILE) the file has no name
 * until then, so that a process that is killed leaves nothing. Otherwise, and for the instant of a replacement, it is
 * .cuvette-HOST-N.part, perhaps with an ending, in the folder of its later name, and locked (flock) as long as its
 * writer lives: whoever needs such a name with that ending next in that folder removes the files without a writer.
 * HOST is a hash of the host's name, because the lock of a network file system may not reach other machines. Ownership:
 * *name is the caller's, freed with free. Errors: -1, with errno. */
#pragma once

/* Opens an empty file for writing, to be moved to path. *name: NULL if it has no name. */
int temporary_open(const char *path, char **name);

/* For another program that writes it: always has a name, with an ending of at most 16 bytes after the others (".png").
 * The descriptor holds the lock; that program may truncate the file, but not replace it. */
int temporary_open_named(const char *path, const char *ending, char **name);

/* Gives the open file the name path; a file there is replaced. The descriptor stays open. After an error *name is the
 * name to remove. */
int temporary_move(int fd, char **name, const char *path);
