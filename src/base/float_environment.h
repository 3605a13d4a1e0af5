/* The floating-point environment in which everything is computed: C's default, which rounds to nearest, keeps
 * subnormal numbers, and traps nothing. A thread can arrive in another one: the caller set a rounding mode,
 * unmasked exceptions, narrowed the x87 registers, or loaded a library that was linked with -ffast-math, whose
 * start-up code flushes subnormal numbers to zero (gcc's crtfastmath.o). The image must not depend on it.
 * Environments belong to threads; a new thread begins with its creator's. gcc and clang know no FENV_ACCESS, and
 * may move arithmetic on local variables across these calls: what is computed stands in functions that are called
 * between them, in another file or never inlined. These functions allocate nothing and cannot fail. */
#pragma once

#include <fenv.h>
#include <stdbool.h>

/* One that was set aside: rounding, traps, flushing, and the exceptions that were raised so far. */
typedef struct float_environment {
    bool was_default; /* but for raised exceptions: these are in control, and kept is not set */
    unsigned control;
    fenv_t kept;
} float_environment;

/* The calling thread computes in the default environment from now on: for the beginning of a thread or a program. */
void float_environment_set(void);

/* The same, until the other call puts back what was there, without what was raised in between. */
void float_environment_enter(float_environment *outer);
void float_environment_leave(const float_environment *outer);
