/* A texel and a colour as vectors of four, in the vector extensions that gcc and clang share. Pure; cannot fail. */
#pragma once

#include "base/kernel.h"
#include "image/texture_parts.h"

/* Without AVX compilers warn about passing wide vectors to functions; all functions here are inlined. */
#pragma GCC diagnostic ignored "-Wpsabi"

typedef float texel4 __attribute__((vector_size(16)));
typedef double color4 __attribute__((vector_size(32)));

ALWAYS_INLINE color4 color_of_texel(const texel *t)
{
    return __builtin_convertvector(*(const texel4 *)(const void *)t, color4);
}

ALWAYS_INLINE color4 color_mix(color4 from, color4 to, double part)
{
    const color4 share = {part, part, part, part};
    return from + share * (to - from);
}
