/* Ideal polarising filters and wave plates, as the analyser's row of a ray from the eye passes them (optics/mueller.h).
 * They do not bend the ray, and act on its Stokes vector alike in both directions. Pure; cannot fail. */
#pragma once

#include "optics/mueller.h"

/* A linear polariser in the frame of its axis, with the transmittances of light whose field is along and across it.
 * Goldstein, Polarized Light, Mueller matrix of a linear diattenuator, with p_x^2 and p_y^2 as these. */
static inline sp_response sp_polariser(double along, double across)
{
    sp_response r = {0.5 * (along + across), 0.5 * (along - across), sqrt(along * across), 0.0};
    return r;
}

/* A wave plate in the frame of its slow axis: the field along it lags behind the field across it by delta. In
 * exp(-i omega t) a lag is a factor exp(i delta), so that conj(E_x) E_y turns by -delta. Goldstein, Mueller matrix of a
 * linear retarder. */
static inline sp_response sp_retarder(double sin_delta, double cos_delta)
{
    sp_response r = {1.0, 0.0, cos_delta, -sin_delta};
    return r;
}

/* The row across an element that a ray of direction d passes; axis: of any length, projected onto the plane across the
 * ray. Along the ray it has no direction there, and the frame's x is used. */
static inline stokes analyser_through(stokes row, vec3 d, vec3 axis, sp_response r)
{
    vec3 x, y;
    polarisation_frame(d, &x, &y);
    const frame_turn to_axis = frame_turn_to(x, y, axis);
    const stokes beyond = analyser_times(stokes_rotate(row, to_axis.cos_2a, to_axis.sin_2a), r);
    return stokes_rotate(beyond, to_axis.cos_2a, -to_axis.sin_2a);
}

/* A circular polariser with the transmittances of left- and right-handed light, which stay circular: the homogeneous
 * diattenuator along v. Lu and Chipman, Interpretation of Mueller matrices based on polar decomposition, J. Opt. Soc.
 * Am. A 13, 1106 (1996). */
static inline stokes analyser_through_circular(stokes row, double left, double right)
{
    const double mean = 0.5 * (left + right), half = 0.5 * (left - right), between = sqrt(left * right);
    const stokes s = {row.i * mean + row.v * half, row.q * between, row.u * between, row.i * half + row.v * mean};
    return s;
}
