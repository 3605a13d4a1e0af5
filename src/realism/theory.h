/* Closed forms of textbook optics, on scalars: independent of the tracer's formulas (optics/interface.h, geometry/), in
 * another algebraic form where one exists, so that the two cannot share an error. Angles in radians; n are refractive
 * indices, any unit of length. NaN for undefined quantities. Pure; cannot fail. */
#pragma once

/* Angle of refraction; NaN under total internal reflection. Hecht, Optics, 5th ed., eq. 4.4. */
double theory_snell(double angle, double n_from, double n_to);

/* asin(n_to / n_from); NaN unless n_to < n_from. Hecht, eq. 4.69. */
double theory_critical_angle(double n_from, double n_to);

/* Power reflectances as sin^2(i - t) / sin^2(i + t) and tan^2(i - t) / tan^2(i + t); 1 beyond the critical angle.
 * Hecht, eqs. 4.42 and 4.43, squared. */
double theory_fresnel_s(double angle, double n_from, double n_to);
double theory_fresnel_p(double angle, double n_from, double n_to);
double theory_fresnel(double angle, double n_from, double n_to);

/* Transmittance of the first `passes` orders of a slab of reflectance R at each face: (1 - R)^2 (1 + R^2 + R^4 + ...),
 * `passes` terms, which tend to (1 - R) / (1 + R). Born and Wolf, Principles of Optics, 7th ed., 7.6, without
 * phases. */
double theory_slab(double R, int passes);

/* Transmittance of a pile of interfaces of reflectance R each, summed over the paths that meet at most `depth`
 * interfaces; the paths with k interfaces follow from those with k - 1. Without a limit it is (1 - R) / (1 +
 * (interfaces - 1) R): Stokes, "On the intensity of the light reflected from or transmitted through a pile of plates",
 * Proc. R. Soc. 11, 1862. interfaces: up to 16. */
double theory_pile(double R, int interfaces, int depth);

/* Coaxial cylinders: a wall of n_wall from `outer` to `inner` around n_core, in n_around. Along a ray n rho is
 * constant, rho its distance from the axis: Bouguer's invariant, Born and Wolf, 3.2. So a ray aimed past the axis at
 * `offset` passes it at offset n_around / n in each medium, and turns by a difference of asin at each surface. */
typedef struct theory_shells {
    double n_around, n_wall, n_core, outer, inner;
} theory_shells;

/* Largest offset of a ray that reaches the core. */
double theory_shells_reach(const theory_shells *c);
/* theory_shells_turn: the angle by which a ray inside the core has turned towards the axis. theory_shells_deviation:
 * this angle after the ray has left, twice as large. */
double theory_shells_turn(const theory_shells *c, double offset);
double theory_shells_deviation(const theory_shells *c, double offset);
/* Limit of deviation / offset on the axis: 1 / focal length, from the centre of the lens. For one medium 2 (n - 1) / (n
 * R), the ball lens: Hecht, table 6.1. */
double theory_shells_power(const theory_shells *c);

/* An eye at distance `eye` from the axis looks past the axis at an offset. Returns the distance from the axis at which
 * the line of sight meets a plane at distance `behind` on the other side; negative if the line has crossed the axis.
 * Near the axis the ray-transfer matrices give it as offset (1 + behind / eye - behind / f): Hecht, 6.2.1. */
double theory_shells_place(const theory_shells *c, double eye, double behind, double offset);

/* A flat surface: the eye is `height` above it in n_above, the point `depth` below it in n_below, at horizontal
 * distance `distance`. Tangent of the angle from the vertical at which the eye sees the point; NaN if there is no such
 * ray. */
double theory_apparent_tangent(double height, double depth, double distance, double n_above, double n_below);

/* Apparent depth over depth of a point below a flat surface, straight above the point, for a line of sight at an angle
 * from the vertical; n_above / n_below straight down: Hecht, Optics, 5th ed., 4.4. */
double theory_apparent_depth(double angle, double n_above, double n_below);

/* Deviation by a prism in surroundings of index 1: Hecht, eq. 5.53. NaN under total reflection at the second face. */
double theory_prism_deviation(double incidence, double apex, double n);

/* Angle from the antisolar point of a ray with one internal reflection in a sphere, for its offset over the radius:
 * Descartes, Les Meteores, 1637; Born and Wolf, Principles of Optics, 7th ed., 4.7 exercises. */
double theory_drop_angle(double offset, double n);

/* Transmittance for unpolarised light of two ideal linear polarisers at an angle between their axes, with a plate of
 * `retardance` between them, whose axis is at an angle `plate` from the first polariser's: Malus's law without a plate;
 * Born and Wolf, Principles of Optics, 7th ed., 15.4.2. Radians. */
double theory_crossed(double between, double plate, double retardance);

/* The depth of a liquid of index n (relative to the surroundings) over a point at which the point comes into sight over
 * an edge. The point is at a depth `drop` below the edge and a horizontal distance `across` from it; `tangent` is the
 * tangent of the line of sight over the edge, from the vertical. From Snell's law and the right triangles above and
 * below the surface; Hecht, eq. 4.4. */
double theory_least_depth(double drop, double across, double tangent, double n);

/* Reflectance for unpolarised light of a film between two media, for its thickness in wavelengths (of vacuum):
 * (r1^2 + r2^2 + 2 r1 r2 cos d) / (1 + r1^2 r2^2 + 2 r1 r2 cos d), r1 and r2 the amplitudes at its faces, d = 4 pi n
 * thickness cos t: Airy; Born and Wolf, 7th ed., 1.6.4. */
double theory_film(double angle, double n_from, double n_film, double n_behind, double thickness);
