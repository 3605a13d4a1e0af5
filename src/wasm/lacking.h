/* Included before every file of a WebAssembly module: functions of glibc that emscripten's C library lacks. */
#pragma once

#include <string.h>

#ifdef __EMSCRIPTEN__
/* musl's strerror depends on the locale only if message catalogues are installed, and a module has none. */
static inline const char *strerrordesc_np(int error)
{
    return strerror(error);
}
#endif

/* A module has one thread. With the bulk-memory instructions, clang would keep thread-local storage, which the linker
 * refuses without atomics. */
#define _Thread_local
