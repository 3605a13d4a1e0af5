/* Where the files that come with the program are: those of an installation, or those of the sources around a build.
 * The caller frees what is returned. */
#pragma once

#include "base/status.h"

/* The first that exists of FOLDER PLACE / NAME, where FOLDER is that of the program, then that of the file with this
 * code, which may be a shared library, and each PLACE is "" or begins with a slash; NULL if none does. */
char *installed_find(const char *const *places, size_t count, const char *name);

/* The folder `below`, such as "experiments/lessons", of share/cuvette next to the program's bin or the library's lib,
 * or of the sources above a build folder; NULL if there is none. */
char *installed_folder(const char *below);

/* After path was refused: if there is no such file, the remedy in *why becomes the file with this ending that may be
 * meant, next to it or installed in the folder `below`. Otherwise *why stays. */
void installed_suggest(const char *path, const char *below, const char *ending, diagnostic *why);
