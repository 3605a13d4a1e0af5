/* Setting and restoring the floating-point environment. */
#include "base/float_environment.h"

/* C17 7.6.4.3 defines FE_DFL_ENV as the environment at program start; glibc (since 2.21) and musl also disable flushing
 * to zero, on x86 the bits FTZ and DAZ of MXCSR. */
void float_environment_set(void)
{
    fesetenv(FE_DFL_ENV);
}

/* Changing the complete environment takes 0.3 us on x86, more than the nearest hit of a ray. Most callers have the
 * default environment: then only the raised exceptions are saved. MXCSR: Intel's manual, volume 1, 10.2.3; its low six
 * bits are the exceptions. */
#if defined(__x86_64__) && defined(__GLIBC__)
#include <fpu_control.h>
#include <xmmintrin.h>

static unsigned control_now(void)
{
    return _mm_getcsr();
}

static void restore_control(unsigned control)
{
    if (_mm_getcsr() != control)
        _mm_setcsr(control);
}

static bool is_default(unsigned control)
{
    fpu_control_t x87;
    _FPU_GETCW(x87);
    return (control & ~0x3fu) == 0x1f80 && x87 == _FPU_DEFAULT;
}
#else
static unsigned control_now(void)
{
    return 0;
}

static void restore_control(unsigned control)
{
    (void)control;
}

static bool is_default(unsigned control)
{
    (void)control;
    return false;
}
#endif

void float_environment_enter(float_environment *outer)
{
    outer->control = control_now();
    outer->was_default = is_default(outer->control);
    if (outer->was_default)
        return;
    fegetenv(&outer->saved);
    fesetenv(FE_DFL_ENV);
}

void float_environment_leave(const float_environment *outer)
{
    if (outer->was_default)
        restore_control(outer->control);
    else
        fesetenv(&outer->saved);
}
