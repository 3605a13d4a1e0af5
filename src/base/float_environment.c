#include "base/float_environment.h"

/* C17 7.6.4.3 defines FE_DFL_ENV by what a program starts with; glibc (since 2.21) and musl also end flushing to zero, on x86
 * the bits FTZ and DAZ of MXCSR. */
void float_environment_set(void)
{
    fesetenv(FE_DFL_ENV);
}

void float_environment_enter(float_environment *outer)
{
    fegetenv(&outer->kept);
    fesetenv(FE_DFL_ENV);
}

void float_environment_leave(const float_environment *outer)
{
    fesetenv(&outer->kept);
}
