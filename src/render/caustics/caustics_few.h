/* A caustic that rests on too few photons. Ownership: values. */
#pragma once

#include <stdint.h>

/* The solid whose light rests on the fewest photons, if these are too few for a caustic. */
typedef struct caustics_few {
    int solid;       /* its number in the scene, -1: there is none */
    int64_t arrived; /* its photons */
    int64_t enough;  /* the render.photons that would do */
} caustics_few;
