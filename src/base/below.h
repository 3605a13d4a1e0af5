/* Opening files for reading only where they lie below a folder, whatever path leads there. What was opened is looked
 * at, not the path, so that no symbolic link can be changed in between. A root is the real path of the folder: from /,
 * without links, without a slash at its end; NULL or "": anywhere. Ownership: the descriptor is the caller's. */
#pragma once

/* Does not wait, for a FIFO's writer say. -1 with errno; EXDEV: it lies elsewhere, and was not opened for reading. */
int below_open(const char *path, const char *root);

/* Of EXDEV, for diagnostics. */
#define BELOW_WHAT "lies outside of the folder from which files may be read"
#define BELOW_REMEDY "put it into that folder, or choose a folder that holds both"
