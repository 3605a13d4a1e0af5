/* The floating-point environment of all computations: C's default, which rounds to nearest, keeps subnormal numbers,
 * and enables no traps. A calling thread may have another one: the caller set a rounding mode, unmasked exceptions,
 * reduced the x87 precision, or loaded a library linked with -ffast-math, whose start-up code flushes subnormal numbers
 * to zero (gcc's crtfastmath.o). The image must not depend on it. Environments belong to threads; a new thread inherits
 * its creator's. gcc and clang do not support FENV_ACCESS and may move arithmetic on local variables across these
 * calls: so the computation must be in functions that are called in between, in another file or never inlined. These
 * functions allocate nothing and cannot fail. */
#pragma once

#include <fenv.h>
#include <stdbool.h>

/* A saved environment: rounding, traps, flushing, and the exceptions raised so far. */
typedef struct float_environment {
    bool was_default; /* except for raised exceptions, which are in control; saved is then unset */
    unsigned control;
    fenv_t saved;
} float_environment;

/* Sets the calling thread's environment to the default: for the start of a thread or program. */
void float_environment_set(void);

/* enter sets the default until leave restores the saved environment; exceptions raised in between are dropped. */
void float_environment_enter(float_environment *outer);
void float_environment_leave(const float_environment *outer);
