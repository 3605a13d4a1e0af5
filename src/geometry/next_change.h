/* Formulas for one region, from the intervals of its primitives ahead of a ray, that the pass over the direct
 * primitives and the solid tree share: the next change of medium by it, and its overlap with a shadow ray. No
 * branches; pure. */
#pragma once

#include "base/isa.h"
#include "base/lanes.h"
#include <math.h>

typedef struct next_change {
    double t;
    int64_t through_hollow; /* the boundary is the hollow's */
} next_change;

/* A region without a hollow: its exit if the ray is within, otherwise its entry. */
ALWAYS_INLINE double next_of_convex(int64_t within, double in, double out)
{
    return blend(within, out, in);
}

/* A region with a hollow. If the ray is in the region, its one boundary ahead is the exit: out of its outside or into
 * its hollow. Otherwise it is the entry: through its outside, or out of the hollow if that covers the entry. */
ALWAYS_INLINE next_change next_of_hollowed(int64_t within, double in, double out, double hollow_in, double hollow_out)
{
    int64_t by_hollow = mask_less(hollow_in, out);
    double leave = blend(by_hollow, hollow_in, out);
    int64_t covered = mask_less_equal(hollow_in, in) & mask_less(in, hollow_out);
    double emerge = blend(mask_less(hollow_out, out), hollow_out, HUGE_VAL);
    double enter = blend(covered, emerge, in);
    next_change c = {blend(within, leave, enter), blend_int(within, by_hollow, covered)};
    return c;
}

/* The overlap of a region with the range 0..1 of a shadow ray, whatever hides it; thick: the ends of an overlap are
 * farther apart than the window within which they could be in contact. */
typedef struct overlap {
    int64_t any, thick;
} overlap;

ALWAYS_INLINE overlap overlap_of_convex(double in, double out, double thin)
{
    const int64_t any = mask_less(in, 1.0) & mask_less(0.0, out);
    return (overlap){any, any & mask_less(thin, out - in)};
}

ALWAYS_INLINE overlap overlap_of_hollowed(double in, double out, double hollow_in, double hollow_out, double thin)
{
    const double first_out = lesser(out, hollow_in), second_in = greater(in, hollow_out);
    const int64_t first = mask_less(in, lesser(first_out, 1.0)) & mask_less(0.0, first_out);
    const int64_t second = mask_less(second_in, lesser(out, 1.0)) & mask_less(0.0, out);
    return (overlap){first | second,
                     (first & mask_less(thin, first_out - in)) | (second & mask_less(thin, out - second_in))};
}
