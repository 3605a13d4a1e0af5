/* A screen: a rectangle that bins the power of the beams' rays that cross it. It does not stop them, and does not
 * belong to the scene.
 *
 * Ownership: the caller owns a screen's bins; release them with beam_screen_release. */
#pragma once

#include "render/inspect/beams.h"

enum { SCREEN_BINS_MAX = 512, SCREEN_RAYS_MAX = 100000 };

typedef struct beam_screen {
    vec3 centre, normal;
    double width, height;        /* scene units, along e_u (horizontal, or x for a horizontal screen) and e_v */
    int columns, rows;           /* of bins; 1 .. SCREEN_BINS_MAX */
    int rays_of_beam;            /* 1 .. SCREEN_RAYS_MAX for each beam and wavelength; 0: the beam's own number */
    vec3 e_u, e_v;               /* results from here on */
    double *bin;                 /* power by bin, [row * columns + column], row 0 at the top (largest v) */
    double *color;               /* the same in linear sRGB, each wavelength in its colour: [3 * bin + channel] */
    double power;                /* of all beams */
    double received;             /* sum of the bins */
    size_t ray_count, hit_count; /* rays of the beams; crossings of the screen */
} beam_screen;

status beam_screen_expose(const scene *s, isa level, beam_screen *screen, diagnostic *why);
void beam_screen_release(beam_screen *screen);
