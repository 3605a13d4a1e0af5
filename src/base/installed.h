/* Which build of the program this is, and the files that come with it, in an installation or in the sources around a
 * build. The caller frees the returned paths. */
#pragma once

#include "base/status.h"

/* The first existing path FOLDER PLACE/NAME; NULL if none exists. FOLDER is the program's folder, then the folder of
 * the file with this code, which may be a shared library. Each PLACE is "" or begins with a slash. */
char *installed_find(const char *const *places, size_t count, const char *name);

/* The folder `below`, such as "experiments/lessons", of share/cuvette next to the program's bin or the library's lib,
 * or of the sources above a build folder; NULL if there is none. */
char *installed_folder(const char *below);

/* After an error about `path`: if there is no such file, the remedy in *why suggests the file with this ending that the
 * user may mean, next to `path` or installed in the folder `below`. Otherwise *why is unchanged. */
void installed_suggest(const char *path, const char *below, const char *ending, diagnostic *why);

/* --- build_id.c ---
 *
 * The identity of this build: a hash of the sources that can change a film or a time, of the compiler and its flags
 * (Makefile, build_id). Constant; never fails. */

/* 16 hex digits, equal for equal sources, compiler and flags in any folder; "unknown" without the Makefile. */
const char *build_id(void);
/* The commit that was checked out, abbreviated, with "+" if tracked files differed from it; "" if unknown. */
const char *build_commit(void);
