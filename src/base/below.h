/* Opening files for reading only if they are below a root folder. The check is made on the opened file and not on the
 * path, so that no symbolic link can be changed in between. A root is the real path of the folder: absolute, without
 * links, without a trailing slash; NULL or "": no restriction. Ownership: the caller owns the descriptor. */
#pragma once

/* Does not block, for example on a FIFO without a writer. Returns -1 with errno; EXDEV: the file is outside the root
 * and was not opened for reading. */
int below_open(const char *path, const char *root);

/* The error text for EXDEV. */
#define BELOW_WHAT "is outside the folder from which files may be read"
#define BELOW_REMEDY "move it into that folder, or choose a folder that contains both"
