/* The identity of this build, from macros that the Makefile defines. */
#include "base/installed.h"

#ifndef CUVETTE_BUILD_ID
#define CUVETTE_BUILD_ID "unknown"
#endif
#ifndef CUVETTE_BUILD_COMMIT
#define CUVETTE_BUILD_COMMIT ""
#endif

const char *build_id(void)
{
    return CUVETTE_BUILD_ID;
}

const char *build_commit(void)
{
    return CUVETTE_BUILD_COMMIT;
}
