/* Tests of metals and film stacks against the closed forms of textbooks. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/multilayer.h"
#include "random_stream.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static double squared(double a)
{
    return a * a;
}

static double pi(void)
{
    return acos(-1.0);
}

static thin_film film_of(double n, double k, double thickness_nm)
{
    return (thin_film){complex_of(n, k), thickness_nm};
}

typedef struct powers {
    double R_s, R_p, T_s, T_p;
} powers;

static powers powers_of(double cos_i, double n_from, const thin_film *film, int count, complex_pair to,
                        double lambda_nm)
{
    const sp_amplitudes a = multilayer_amplitudes(cos_i, n_from, film, count, to, lambda_nm);
    return (powers){complex_norm2(a.r_s), complex_norm2(a.r_p), complex_norm2(a.t_s), complex_norm2(a.t_p)};
}

/* n and k of silver, gold, copper and aluminium in green light, of a dull metal, and of a weak absorber. */
static const double metals[][2] = {{0.06, 3.586}, {0.43, 2.455}, {1.02, 2.577}, {0.96, 6.69}, {3.2, 3.3}, {1.5, 0.01}};

/* --- phases --- */

/* cos(delta) and sin(delta) / beta around the delta of 1/4 below which series replace them, of a real beta and, with
 * hyperbolic functions, of an imaginary one: to the last digits. */
static void small_phases_have_the_functions_of_large_ones(void **state)
{
    (void)state;
    const double lambda_nm = 500.0, thickness_nm = 100.0;
    const long double k = 2.0L * acosl(-1.0L) * thickness_nm / lambda_nm;
    for (int i = 1; i <= 400; i++) {
        const double beta = i / 400.0 * 0.4;
        const long double delta = k * beta, fade = expl(-delta);
        const film_phase real = film_phase_of(complex_of(beta * beta, 0.0), thickness_nm, lambda_nm);
        assert_near(real.cosine.re, (double)cosl(delta), 1e-15);
        assert_near(real.sine_over_beta.re, (double)(sinl(delta) / beta), 2e-15);
        const film_phase faded = film_phase_of(complex_of(-beta * beta, 0.0), thickness_nm, lambda_nm);
        assert_near(faded.cosine.re, (double)(coshl(delta) * fade), 1e-15);
        assert_near(faded.sine_over_beta.re, (double)(sinhl(delta) / beta * fade), 2e-15);
        assert_true(real.cosine.im == 0.0 && real.sine_over_beta.im == 0.0);
    }
}

/* --- metals --- */

/* Hecht, Optics, 5th ed., 4.8 (4.83); in a medium of index n_from by the relative index. */
static void metals_at_normal_incidence(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(metals); i++)
        for (double n_from = 1.0; n_from < 2.0; n_from += 0.33) {
            const double n = metals[i][0] / n_from, k = metals[i][1] / n_from,
                         R = (squared(n - 1.0) + k * k) / (squared(n + 1.0) + k * k);
            const sp_amplitudes a = conductor_amplitudes(1.0, n_from, complex_of(metals[i][0], metals[i][1]));
            assert_near(complex_norm2(a.r_s), R, 1e-14);
            assert_near(complex_norm2(a.r_p), R, 1e-14);
            assert_near(a.r_s.re, -a.r_p.re, 1e-14);
            assert_near(a.r_s.im, -a.r_p.im, 1e-14);
        }
}

/* Siegel and Howell, Thermal Radiation Heat Transfer, 4th ed., (4-70): a and b are the parts of sqrt(eps - sin^2). */
static powers metal_by_siegel(double angle, double n, double k)
{
    const double s2 = squared(sin(angle)), x = n * n - k * k - s2, root = sqrt(x * x + squared(2.0 * n * k)),
                 a2 = 0.5 * (root + x), b2 = 0.5 * (root - x), a = sqrt(a2), c = cos(angle),
                 st = sin(angle) * tan(angle);
    const double R_s = (squared(a - c) + b2) / (squared(a + c) + b2);
    return (powers){R_s, R_s * (squared(a - st) + b2) / (squared(a + st) + b2), 0.0, 0.0};
}

static void metals_at_all_angles(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(metals); i++)
        for (double angle = 0.01; angle < 1.57; angle += 0.017) {
            const powers expected = metal_by_siegel(angle, metals[i][0], metals[i][1]),
                         seen = powers_of(cos(angle), 1.0, NULL, 0, complex_of(metals[i][0], metals[i][1]), 500.0);
            assert_near(seen.R_s, expected.R_s, 1e-13);
            assert_near(seen.R_p, expected.R_p, 1e-13);
        }
}

/* The least R_p is at the pseudo-Brewster angle: u = sin^2 solves
 *   2 (Re e + |e|^2) u^3 + (|e|^4 - 3 |e|^2) u^2 - 2 |e|^4 u + |e|^4 = 0.
 * Humphreys-Owen, Proc. Phys. Soc. 77, 949 (1961); Azzam, J. Opt. Soc. Am. 73, 1211 (1983). */
static void pseudo_brewster_angle(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(metals); i++) {
        const double n = metals[i][0], k = metals[i][1], e_re = n * n - k * k, e2 = squared(n * n + k * k), step = 1e-4;
        double low = 0.3, high = 1.0; /* the cubic falls from |e|^4 at 0 to below 0 at 1 */
        for (int j = 0; j < 60; j++) {
            const double u = 0.5 * (low + high),
                         value = ((2.0 * (e_re + e2) * u + (e2 * e2 - 3.0 * e2)) * u - 2.0 * e2 * e2) * u + e2 * e2;
            *(value > 0.0 ? &low : &high) = u;
        }
        const double angle = asin(sqrt(low));
        double R[3];
        for (int j = 0; j < 3; j++)
            R[j] = powers_of(cos(angle + (j - 1) * step), 1.0, NULL, 0, complex_of(n, k), 500.0).R_p;
        assert_true(R[0] > R[1] && R[2] > R[1]);
        assert_near((R[2] - R[0]) / (R[0] - 2.0 * R[1] + R[2]), 0.0, 1e-3); /* the parabola's vertex is there */
    }
}

/* An ideal plasma, n = i k, reflects all light, as total reflection does: r_s = (c - i w) / (c + i w) with w = sqrt(k^2
 * + sin^2), and r_p likewise with w / k^2 and the opposite sign. Its retardance is that of mueller.h's signs. */
static void a_plasma_retards(void **state)
{
    (void)state;
    for (double k = 0.5; k < 4.0; k += 0.7)
        for (double angle = 0.1; angle < 1.5; angle += 0.1) {
            const double c = cos(angle), w = sqrt(k * k + squared(sin(angle))), p = w / (k * k);
            const double phase_s = -2.0 * atan2(w, c), phase_p = 2.0 * atan2(p, c);
            const sp_amplitudes a = conductor_amplitudes(c, 1.0, complex_of(0.0, k));
            const sp_response r = sp_response_of(a.r_s, a.r_p);
            assert_near(r.mean, 1.0, 1e-14);
            assert_near(r.half, 0.0, 1e-14);
            assert_near(r.real, cos(phase_p - phase_s), 1e-13);
            assert_near(r.imag, sin(phase_p - phase_s), 1e-13);
            assert_near(complex_norm2(a.t_s) + complex_norm2(a.t_p), 0.0, 1e-15);
        }
}

/* --- no film --- */

static void assert_bare(double cos_i, double n_from, double n_to, sp_amplitudes a)
{
    const fresnel f = fresnel_dielectric(cos_i, n_from, n_to);
    const sp_response r = sp_response_of(a.r_s, a.r_p), t = sp_response_of(a.t_s, a.t_p), bare = sp_reflect(f, cos_i),
                      through = sp_refract(f);
    assert_near(r.mean, bare.mean, 1e-13);
    assert_near(r.half, bare.half, 1e-13);
    assert_near(r.real, bare.real, 1e-12);
    assert_near(r.imag, bare.imag, 1e-12);
    assert_near(t.mean, through.mean, 1e-13);
    assert_near(t.half, through.half, 1e-13);
    if (!f.total)
        assert_near(t.real, through.real, 1e-13);
    assert_near(t.imag, 0.0, 1e-13);
}

/* Without films, with films of no thickness, and with films of the indices of the media on either side, powers and
 * phases are those of the bare interface (optics/mueller.h), total reflection included. */
static void stacks_that_are_bare_interfaces(void **state)
{
    (void)state;
    static const double pairs[][2] = {{1.0, 1.5}, {1.5, 1.0}, {1.33, 1.5}, {2.4, 1.33}};
    for (size_t i = 0; i < COUNT(pairs); i++)
        for (double angle = 0.0; angle < 1.55; angle += 0.03) {
            const double c = cos(angle), from = pairs[i][0], to = pairs[i][1];
            const complex_pair behind = complex_of(to, 0.0);
            const thin_film thin[] = {film_of(1.7, 0.0, 0.0), film_of(0.4, 2.5, 0.0)};
            const bool total = from * sin(angle) > to;
            assert_bare(c, from, to, conductor_amplitudes(c, from, behind));
            assert_bare(c, from, to, multilayer_amplitudes(c, from, thin, 2, behind, 550.0));
            const thin_film same = film_of(to, 0.0, 321.0);
            const sp_amplitudes a = multilayer_amplitudes(c, from, &same, 1, behind, 550.0);
            if (!total)
                assert_bare(c, from, to, a);
            assert_near(complex_norm2(a.r_s), fresnel_dielectric(c, from, to).R_s, 1e-12);
        }
}

/* --- one film --- */

/* At normal incidence a film a quarter of a wave thick: R = ((n0 ns - n1^2) / (n0 ns + n1^2))^2; one of half a wave is
 * absent. Hecht, 9.7.2; Born and Wolf, 1.6.4. */
static void quarter_and_half_wave_films(void **state)
{
    (void)state;
    static const double sets[][3] = {
        {1.0, 1.38, 1.52}, {1.0, 1.2247448713915890, 1.5}, {1.33, 2.3, 1.7}, {1.5, 1.2, 1.0}};
    for (size_t i = 0; i < COUNT(sets); i++) {
        const double from = sets[i][0], n = sets[i][1], to = sets[i][2], lambda_nm = 550.0;
        const thin_film quarter = film_of(n, 0.0, 0.25 * lambda_nm / n), half = film_of(n, 0.0, 0.5 * lambda_nm / n);
        const powers a = powers_of(1.0, from, &quarter, 1, complex_of(to, 0.0), lambda_nm),
                     b = powers_of(1.0, from, &half, 1, complex_of(to, 0.0), lambda_nm);
        assert_near(a.R_s, squared((from * to - n * n) / (from * to + n * n)), 1e-14);
        assert_near(a.R_p, a.R_s, 1e-14);
        assert_near(b.R_s, squared((from - to) / (from + to)), 1e-14);
        assert_near(b.T_p, 4.0 * from * to / squared(from + to), 1e-14);
    }
}

/* Airy: R = F sin^2 delta / (1 + F sin^2 delta), F = 4 r^2 / (1 - r^2)^2, delta = 2 pi n d cos theta' / lambda; Hecht,
 * 9.6.1; r by Fresnel's sine and tangent laws. */
static double airy(double r2, double delta)
{
    const double F = 4.0 * r2 / squared(1.0 - r2), s2 = squared(sin(delta));
    return F * s2 / (1.0 + F * s2);
}

static void a_soap_film_by_airys_formula(void **state)
{
    (void)state;
    const double n = 1.33;
    for (double thickness_nm = 5.0; thickness_nm < 3000.0; thickness_nm *= 1.9)
        for (double angle = 0.05; angle < 1.55; angle += 0.1)
            for (double lambda_nm = 380.0; lambda_nm <= 780.0; lambda_nm += 37.0) {
                const double inner = asin(sin(angle) / n),
                             delta = 2.0 * pi() * n * thickness_nm * cos(inner) / lambda_nm;
                const double s2 = squared(sin(angle - inner) / sin(angle + inner)),
                             p2 = squared(tan(angle - inner) / tan(angle + inner));
                const thin_film soap = film_of(n, 0.0, thickness_nm);
                const powers seen = powers_of(cos(angle), 1.0, &soap, 1, complex_of(1.0, 0.0), lambda_nm);
                assert_near(seen.R_s, airy(s2, delta), 1e-12);
                assert_near(seen.R_p, airy(p2, delta), 1e-12);
            }
}

/* Frustrated total reflection through a gap of air in glass of index N: 1 / T = 1 + alpha sinh^2 y; Zhu, Yu, Hawley and
 * Roy, Am. J. Phys. 54, 601 (1986). */
static void frustrated_total_reflection(void **state)
{
    (void)state;
    const double N = 1.5, lambda_nm = 600.0;
    for (double angle = 0.74; angle < 1.5; angle += 0.05)
        for (double gap_nm = 1.0; gap_nm < 3000.0; gap_nm *= 2.0) {
            const double s2 = squared(sin(angle)), inside = N * N * s2 - 1.0,
                         y = 2.0 * pi() * gap_nm / lambda_nm * sqrt(inside);
            const double of_s = squared(N * N - 1.0) / (4.0 * N * N * squared(cos(angle)) * inside),
                         of_p = of_s * squared((N * N + 1.0) * s2 - 1.0);
            const thin_film gap = film_of(1.0, 0.0, gap_nm);
            const powers seen = powers_of(cos(angle), N, &gap, 1, complex_of(N, 0.0), lambda_nm);
            assert_near(seen.T_s * (1.0 + of_s * squared(sinh(y))), 1.0, 1e-11);
            assert_near(seen.T_p * (1.0 + of_p * squared(sinh(y))), 1.0, 1e-11);
        }
}

/* The same at the critical angle and next to it, where the wave number in the gap is almost 0: sinh y over its square
 * root tends to k d. */
static void a_gap_at_the_critical_angle(void **state)
{
    (void)state;
    static const double offset[] = {0.0, 1e-14, -1e-14, 1e-12, -1e-12};
    const double N = 1.5, lambda_nm = 600.0;
    for (size_t i = 0; i < COUNT(offset); i++)
        for (double gap_nm = 1.0; gap_nm < 3000.0; gap_nm *= 2.0) {
            const double sine = (1.0 + offset[i]) / N, cosine = sqrt(1.0 - sine * sine),
                         y = 2.0 * pi() * gap_nm / lambda_nm, of_s = squared((N * N - 1.0) * y / (2.0 * N * cosine));
            const thin_film gap = film_of(1.0, 0.0, gap_nm);
            const powers seen = powers_of(cosine, N, &gap, 1, complex_of(N, 0.0), lambda_nm);
            assert_near(seen.T_s * (1.0 + of_s), 1.0, 1e-12 + y * y * fabs(offset[i]));
        }
}

/* A thick film of metal hides what is behind it and fades as exp(-4 pi k d / lambda); nothing overflows. */
static void thick_metal_films(void **state)
{
    (void)state;
    const double n = 0.43, k = 2.455, lambda_nm = 550.0;
    for (double d_nm = 200.0; d_nm < 1e7; d_nm *= 10.0) {
        const thin_film one = film_of(n, k, d_nm), more = film_of(n, k, d_nm + 50.0);
        const powers bare = powers_of(0.6, 1.0, NULL, 0, complex_of(n, k), lambda_nm);
        const powers a = powers_of(0.6, 1.0, &one, 1, complex_of(1.5, 0.0), lambda_nm);
        assert_near(a.R_s, bare.R_s, 10.0 * exp(-4.0 * pi() * k * d_nm / lambda_nm) + 1e-14);
        assert_near(a.R_p, bare.R_p, 10.0 * exp(-4.0 * pi() * k * d_nm / lambda_nm) + 1e-14);
        const powers u = powers_of(1.0, 1.0, &one, 1, complex_of(1.5, 0.0), lambda_nm),
                     v = powers_of(1.0, 1.0, &more, 1, complex_of(1.5, 0.0), lambda_nm);
        if (u.T_s > 1e-250)
            assert_near(v.T_s / u.T_s, exp(-4.0 * pi() * k * 50.0 / lambda_nm), 1e-4);
        else
            assert_true(v.T_s >= 0.0 && v.T_s <= u.T_s);
    }
}

/* --- stacks --- */

/* N pairs of quarter waves on a substrate at normal incidence: R = ((1 - Y) / (1 + Y))^2, Y = (ns / n0) (nH / nL)^2N;
 * Born and Wolf, 1.6.5. */
static void a_quarter_wave_mirror(void **state)
{
    (void)state;
    const double high = 2.3, low = 1.38, ns = 1.52, lambda_nm = 600.0;
    thin_film film[24];
    for (int pairs = 1; pairs <= 12; pairs++) {
        film[2 * pairs - 2] = film_of(high, 0.0, 0.25 * lambda_nm / high);
        film[2 * pairs - 1] = film_of(low, 0.0, 0.25 * lambda_nm / low);
        const double Y = ns * pow(high / low, 2.0 * pairs);
        const powers seen = powers_of(1.0, 1.0, film, 2 * pairs, complex_of(ns, 0.0), lambda_nm);
        assert_near(seen.R_s, squared((1.0 - Y) / (1.0 + Y)), 1e-13);
        assert_near(seen.R_s + seen.T_s, 1.0, 1e-12);
    }
}

enum { FILMS_MAX = 4 };
typedef struct random_stack {
    double cos_i, n_from, n_to, lambda_nm;
    int count;
    thin_film film[FILMS_MAX];
} random_stack;

static random_stack random_stack_of(uint64_t *seed, double k_max)
{
    random_stack s = {.cos_i = random_real(seed, 0.02, 1.0),
                      .n_from = random_real(seed, 1.0, 2.4),
                      .n_to = random_real(seed, 1.0, 2.4),
                      .lambda_nm = random_real(seed, 380.0, 780.0)};
    s.count = (int)random_real(seed, 0.0, FILMS_MAX + 0.999);
    for (int i = 0; i < s.count; i++)
        s.film[i] = film_of(random_real(seed, 1.0, 2.4), random_real(seed, 0.0, k_max), random_real(seed, 0.0, 900.0));
    return s;
}

/* The stack as light from behind meets it; its angle by Snell. */
static random_stack reversed(random_stack s)
{
    random_stack r = s;
    for (int i = 0; i < s.count; i++)
        r.film[i] = s.film[s.count - 1 - i];
    r.n_from = s.n_to, r.n_to = s.n_from;
    r.cos_i = sqrt(1.0 - squared(s.n_from / s.n_to) * (1.0 - s.cos_i * s.cos_i));
    return r;
}

static sp_amplitudes amplitudes_of(random_stack s)
{
    return multilayer_amplitudes(s.cos_i, s.n_from, s.film, s.count, complex_of(s.n_to, 0.0), s.lambda_nm);
}

/* No film absorbs: R + T = 1, under total reflection, too. */
static void lossless_stacks_conserve_energy(void **state)
{
    (void)state;
    uint64_t seed = 11;
    int total = 0;
    for (int i = 0; i < 20000; i++) {
        const random_stack s = random_stack_of(&seed, 0.0);
        const sp_amplitudes a = amplitudes_of(s);
        assert_near(complex_norm2(a.r_s) + complex_norm2(a.t_s), 1.0, 1e-12);
        assert_near(complex_norm2(a.r_p) + complex_norm2(a.t_p), 1.0, 1e-12);
        total += complex_norm2(a.t_s) == 0.0;
    }
    assert_true(total > 1000);
}

/* From either side the transmission is the same, phase included, also with absorption; without it the stack's two
 * reflections and its transmission make a unitary matrix: conj(r) t + conj(t) r' = 0 (Stokes' relations; Hecht,
 * 4.10). */
static void stacks_from_behind(void **state)
{
    (void)state;
    uint64_t seed = 12;
    for (int i = 0; i < 20000; i++) {
        const random_stack s = random_stack_of(&seed, i % 2 ? 0.5 : 0.0);
        if (s.n_from * s.n_from * (1.0 - s.cos_i * s.cos_i) > 0.999 * s.n_to * s.n_to)
            continue;
        const sp_amplitudes a = amplitudes_of(s), b = amplitudes_of(reversed(s));
        assert_near(complex_norm2(complex_sub(a.t_s, b.t_s)), 0.0, 1e-22);
        assert_near(complex_norm2(complex_sub(a.t_p, b.t_p)), 0.0, 1e-22);
        if (i % 2)
            continue;
        const complex_pair of_s = complex_add(complex_conj_multiply(a.r_s, a.t_s), complex_conj_multiply(a.t_s, b.r_s)),
                           of_p = complex_add(complex_conj_multiply(a.r_p, a.t_p), complex_conj_multiply(a.t_p, b.r_p));
        assert_near(complex_norm2(of_s), 0.0, 1e-22);
        assert_near(complex_norm2(of_p), 0.0, 1e-22);
    }
}

/* Absorbing films lose light: 0 <= R + T <= 1. */
static void absorbing_stacks_create_no_light(void **state)
{
    (void)state;
    uint64_t seed = 13;
    for (int i = 0; i < 20000; i++) {
        const sp_amplitudes a = amplitudes_of(random_stack_of(&seed, 3.0));
        assert_true(complex_norm2(a.r_s) + complex_norm2(a.t_s) <= 1.0 + 1e-13);
        assert_true(complex_norm2(a.r_p) + complex_norm2(a.t_p) <= 1.0 + 1e-13);
    }
}

/* A film split into two thinner ones is the same film. */
static void a_film_is_the_sum_of_its_parts(void **state)
{
    (void)state;
    uint64_t seed = 14;
    for (int i = 0; i < 2000; i++) {
        random_stack s = random_stack_of(&seed, 1.0);
        s.count = 1;
        s.film[0] = film_of(random_real(&seed, 0.3, 2.4), random_real(&seed, 0.0, 2.0), random_real(&seed, 0.0, 500.0));
        random_stack parts = s;
        const double share = random_real(&seed, 0.0, 1.0);
        parts.count = 2, parts.film[1] = s.film[0];
        parts.film[0].thickness_nm *= share, parts.film[1].thickness_nm *= 1.0 - share;
        const sp_amplitudes a = amplitudes_of(s), b = amplitudes_of(parts);
        assert_near(complex_norm2(complex_sub(a.r_s, b.r_s)), 0.0, 1e-22);
        assert_near(complex_norm2(complex_sub(a.r_p, b.r_p)), 0.0, 1e-22);
        assert_near(complex_norm2(complex_sub(a.t_p, b.t_p)), 0.0, 1e-22);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_phases_have_the_functions_of_large_ones),
        cmocka_unit_test(metals_at_normal_incidence),
        cmocka_unit_test(metals_at_all_angles),
        cmocka_unit_test(pseudo_brewster_angle),
        cmocka_unit_test(a_plasma_retards),
        cmocka_unit_test(stacks_that_are_bare_interfaces),
        cmocka_unit_test(quarter_and_half_wave_films),
        cmocka_unit_test(a_soap_film_by_airys_formula),
        cmocka_unit_test(frustrated_total_reflection),
        cmocka_unit_test(a_gap_at_the_critical_angle),
        cmocka_unit_test(thick_metal_films),
        cmocka_unit_test(a_quarter_wave_mirror),
        cmocka_unit_test(lossless_stacks_conserve_energy),
        cmocka_unit_test(stacks_from_behind),
        cmocka_unit_test(absorbing_stacks_create_no_light),
        cmocka_unit_test(a_film_is_the_sum_of_its_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
