/* Polarised light at smooth interfaces: Stokes vectors, and the row vector that a ray traced backwards from the eye
 * carries instead of them. The functions that a tracer calls for every ray are inline and branch-free (only + - * /
 * sqrt), so that kernels and tests share one formula. Pure; cannot fail; all values, nothing is owned.
 *
 * Signs. A ray runs from the eye along a unit vector d; its light travels along -d. Its frame is (x, y) with y = d x x
 * (d cross x), so x cross y = d. For a Stokes vector in that frame
 *   i      is the intensity (radiance),
 *   q > 0: the field is along x, q < 0: along y,
 *   u > 0: the field is at +45 degrees, from x towards y,
 *   v > 0: the field rotates from x towards y. A camera shows x to the right, y up and z away from it, a left-handed
 *          frame, in which this is anticlockwise for the eye that the light reaches: left-handed light in Hecht's and
 *          Born and Wolf's sense. (For light that travels along +d the same v is right-handed.)
 * In complex amplitudes with exp(-i omega t), as in Born and Wolf: u + i v = 2 conj(E_x) E_y. In an s/p frame x = s = d
 * x n / |d x n| and y = p = d x s, with a separate p for each ray: at normal incidence the reflected p is reversed, r_p
 * = -r_s, and nothing jumps. The normal n faces the ray: cos_i = -d.n >= 0; n_from is the index on the side of the ray
 * from the eye, n_to the index on the other side.
 *
 * Transmittances are of power: n_t cos_t / (n_i cos_i) |t|^2 = 1 - R, the same number from either side. The factor n^2
 * of radiance across an interface is omitted, as is common in renderers: eye and lights are in one medium, where it has
 * cancelled. */
#pragma once

#include "base/lanes.h"
#include "base/vec3.h"
#include "optics/interface.h"
#include <math.h>

typedef struct stokes {
    double i, q, u, v;
} stokes;

/* --- frames --- */

/* The canonical frame of direction d, a function of d, so that no ray stores its frame; also two unit vectors across
 * any unit vector: Duff and others, Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017. It is discontinuous
 * where d.z changes sign. */
static inline void polarisation_frame(vec3 d, vec3 *x, vec3 *y)
{
    double sign = blend(mask_less(d.z, 0.0), -1.0, 1.0);
    double a = -1.0 / (sign + d.z), b = d.x * d.y * a;
    *x = vec3_make(1.0 + sign * d.x * d.x * a, sign * b, -sign * d.x);
    *y = vec3_make(b, sign + d.y * d.y * a, -d.y);
}

/* Rotates a direction perpendicular to f, the axis of a camera or a lamp, by the shortest rotation from f to the ray d
 * (Rodrigues' formula; d != -f). It preserves right angles, so that crossed filters are crossed everywhere in the
 * image. */
static inline vec3 polarisation_across_ray(vec3 across, vec3 f, vec3 d)
{
    return vec3_sub(across, vec3_scale(vec3_add(f, d), vec3_dot(across, d) / (1.0 + vec3_dot(f, d))));
}

/* A rotation of the frame by an angle a, from x towards y, as it acts on Stokes vectors. */
typedef struct frame_turn {
    double cos_2a, sin_2a;
} frame_turn;

/* The rotation of x of the frame (x, y) to the direction e, of any length, projected onto the frame's plane. The
 * identity if that projection is zero. */
static inline frame_turn frame_turn_to(vec3 x, vec3 y, vec3 e)
{
    double c = vec3_dot(e, x), s = vec3_dot(e, y), length2 = c * c + s * s;
    int64_t none = mask_less_equal(length2, 0.0);
    double over = 1.0 / blend(none, 1.0, length2);
    frame_turn t;
    t.cos_2a = blend(none, 1.0, (c * c - s * s) * over);
    t.sin_2a = 2.0 * c * s * over;
    return t;
}

/* The same light in a frame rotated by a: q + i u rotates by -2a. The row of an analyser rotates likewise. */
static inline stokes stokes_rotate(stokes s, double cos_2a, double sin_2a)
{
    stokes r = {s.i, s.q * cos_2a + s.u * sin_2a, s.u * cos_2a - s.q * sin_2a, s.v};
    return r;
}

/* Light of intensity 1 with its field along e, in the canonical frame of ray d. Half of it is the row of an ideal
 * polarising filter that transmits e. */
static inline stokes stokes_linear(vec3 d, vec3 e)
{
    vec3 x, y;
    polarisation_frame(d, &x, &y);
    frame_turn t = frame_turn_to(x, y, e);
    stokes s = {1.0, t.cos_2a, t.sin_2a, 0.0};
    return s;
}

/* --- interfaces, in s/p frames --- */

/* The effect of an interface on amplitudes, r_s and r_p (or t_s and t_p), as powers: the four numbers of its Mueller
 * matrix
 *  | mean half  0     0     |
 *  | half mean  0     0     |
 *  | 0    0     real -imag  |
 *  | 0    0     imag  real  |
 * A dielectric is a diattenuator (half) and, under total internal reflection, a retarder (imag). */
typedef struct sp_response {
    double mean, half; /* (|r_s|^2 + |r_p|^2) / 2, (|r_s|^2 - |r_p|^2) / 2 */
    double real, imag; /* conj(r_s) r_p */
} sp_response;

/* Reflection. f is fresnel_dielectric at cos_i. Below the critical angle r_s r_p is real. Under total internal
 * reflection conj(r_s) r_p = exp(-i delta) with tan(delta / 2) = cos_i sqrt(sin_i^2 - n^2) / sin_i^2, n = n_to /
 * n_from: Born and Wolf, Principles of Optics, 7th ed., 1.5.4. The half-angle form makes cos and sin of delta
 * rational. */
static inline sp_response sp_reflect(fresnel f, double cos_i)
{
    double below = (f.eta * cos_i + f.cos_t) * (cos_i + f.eta * f.cos_t);
    double real = (f.eta * cos_i - f.cos_t) * (cos_i - f.eta * f.cos_t) / blend(f.total, 1.0, below);
    double sin2 = 1.0 - cos_i * cos_i, lost2 = greater(sin2 - 1.0 / (f.eta * f.eta), 0.0);
    double opposite = cos_i * sqrt(lost2), over = 1.0 / blend(f.total, sin2 * sin2 + opposite * opposite, 1.0);
    sp_response r;
    r.mean = f.R;
    r.half = 0.5 * (f.R_s - f.R_p);
    r.real = blend(f.total, (sin2 * sin2 - opposite * opposite) * over, real);
    r.imag = blend(f.total, -2.0 * sin2 * opposite * over, 0.0);
    return r;
}

/* Refraction: t_s and t_p are positive, so that conj(t_s) t_p is the square root of the product of the power
 * transmittances. 0 under total internal reflection. */
static inline sp_response sp_refract(fresnel f)
{
    sp_response r = {1.0 - f.R, 0.5 * (f.R_p - f.R_s), sqrt((1.0 - f.R_s) * (1.0 - f.R_p)), 0.0};
    return r;
}

/* An ideal mirror, r_s = -1 and r_p = 1 at every angle. */
static inline sp_response sp_mirror(void)
{
    sp_response r = {1.0, 0.0, -1.0, 0.0};
    return r;
}

/* --- backwards: the analyser's row --- */

/* A ray from the eye carries the first row of the product of all Mueller matrices between eye and ray, in the ray's
 * canonical frame: (1, 0, 0, 0) at the eye; .i is everywhere the weight of unpolarised light from there. Of light
 * s that enters the path at a ray, the eye sees the intensity analyser_intensity(row, s), with row and s in that ray's
 * canonical frame. */
static inline double analyser_intensity(stokes row, stokes s)
{
    return row.i * s.i + row.q * s.q + row.u * s.u + row.v * s.v;
}

/* The row times the matrix of r, both in its s/p frame. */
static inline stokes analyser_times(stokes w, sp_response r)
{
    stokes s = {w.i * r.mean + w.q * r.half, w.i * r.half + w.q * r.mean, w.u * r.real + w.v * r.imag,
                w.v * r.real - w.u * r.imag};
    return s;
}

/* The analyser row multiplied by the Mueller matrix of an interface with normal n that a ray of direction d meets; in
 * the frame of `child`, the reflected or refracted direction. */
static inline stokes analyser_across(stokes row, vec3 d, vec3 n, vec3 child, sp_response r)
{
    vec3 x, y, child_x, child_y, s = vec3_cross(d, n);
    polarisation_frame(d, &x, &y);
    polarisation_frame(child, &child_x, &child_y);
    /* At normal incidence any plane is a plane of incidence, but both frames must use the same one. Within 1e-9 radians
     * of it s and p reflect equally up to the square of the angle, which is below the last place. */
    int64_t any = mask_less(vec3_dot(s, s), 0x1p-60);
    s = vec3_make(blend(any, x.x, s.x), blend(any, x.y, s.y), blend(any, x.z, s.z));
    frame_turn to_sp = frame_turn_to(x, y, s), from_sp = frame_turn_to(child_x, child_y, s);
    stokes w = stokes_rotate(row, to_sp.cos_2a, to_sp.sin_2a);
    stokes beyond = analyser_times(w, r);
    return stokes_rotate(beyond, from_sp.cos_2a, -from_sp.sin_2a);
}

static inline stokes analyser_reflect(stokes row, vec3 d, vec3 n, double cos_i, double n_from, double n_to,
                                      vec3 reflected)
{
    return analyser_across(row, d, n, reflected, sp_reflect(fresnel_dielectric(cos_i, n_from, n_to), cos_i));
}

/* The light travels from n_to into n_from; the transmittances are for this direction of light. A row of zeros under
 * total internal reflection. */
static inline stokes analyser_refract(stokes row, vec3 d, vec3 n, double cos_i, double n_from, double n_to,
                                      vec3 refracted)
{
    return analyser_across(row, d, n, refracted, sp_refract(fresnel_dielectric(cos_i, n_from, n_to)));
}

/* A half mirror that returns all of the light that would be transmitted, unpolarised. Its matrix has the first row of
 * refraction's matrix and zeros elsewhere, so that returned and transmitted light add up for every polarisation of the
 * incident light. Such a matrix is not its own reverse: an analyser whose row is (1, q) in the plane of incidence sees
 * 1 + c q (R_s - R_p) / 2 of a surrounding light of 1. The caller scales the result by its fraction c. */
static inline stokes analyser_half_mirror(stokes row, vec3 d, vec3 n, double cos_i, double n_from, double n_to,
                                          vec3 reflected)
{
    const stokes intensity = {row.i, 0.0, 0.0, 0.0};
    return analyser_across(intensity, d, n, reflected, sp_refract(fresnel_dielectric(cos_i, n_from, n_to)));
}

/* A mirror of reflectance 1; the caller scales the result by the mirror's reflectance. */
static inline stokes analyser_mirror(stokes row, vec3 d, vec3 n, vec3 reflected)
{
    return analyser_across(row, d, n, reflected, sp_mirror());
}

/* --- ideal polarising filters and wave plates --- */

/* Filters and plates do not deflect the ray, and act alike on light in both directions. */

/* A linear polariser in the frame of its axis, with the transmittances of light whose field is along and across it.
 * Goldstein, Polarized Light, Mueller matrix of a linear diattenuator, with p_x^2 = along and p_y^2 = across. */
static inline sp_response sp_polariser(double along, double across)
{
    sp_response r = {0.5 * (along + across), 0.5 * (along - across), sqrt(along * across), 0.0};
    return r;
}

/* A wave plate in the frame of its slow axis: the field along it lags behind the field across it by delta. In exp(-i
 * omega t) a lag is a factor exp(i delta), so that conj(E_x) E_y turns by -delta. Goldstein, Mueller matrix of a linear
 * retarder. */
static inline sp_response sp_retarder(double sin_delta, double cos_delta)
{
    sp_response r = {1.0, 0.0, cos_delta, -sin_delta};
    return r;
}

/* The row behind an element that a ray of direction d passes through. axis, of any length, is projected onto the plane
 * perpendicular to the ray; if it is along the ray, the frame's x is used. */
static inline stokes analyser_element(stokes row, vec3 d, vec3 axis, sp_response r)
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
static inline stokes analyser_circular_polariser(stokes row, double left, double right)
{
    const double mean = 0.5 * (left + right), half = 0.5 * (left - right), between = sqrt(left * right);
    const stokes s = {row.i * mean + row.v * half, row.q * between, row.u * between, row.i * half + row.v * mean};
    return s;
}
