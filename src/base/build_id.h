/* The identity of this build: a hash of the sources that can change a film or a time, of the compiler and its flags
 * (Makefile, build_id). Constant; never fails. */
#pragma once

/* 16 hex digits, equal for equal sources, compiler and flags in any folder; "unknown" without the Makefile. */
const char *build_id(void);
/* The commit that was checked out, abbreviated, with "+" if tracked files differed from it; "" if unknown. */
const char *build_commit(void);
