/* Included before every file of a WebAssembly module: functions of glibc that emscripten's C library lacks. */
#pragma once

#include <string.h>

#ifdef __EMSCRIPTEN__
/* musl's texts do not depend on the locale unless messages of one are installed, and there are none. */
static inline const char *strerrordesc_np(int error)
{
    return strerror(error);
}
#endif

/* A module has one thread. With copies of memory as instructions, clang would keep thread-local storage, which the
 * linker refuses without atomics. */
#define _Thread_local
