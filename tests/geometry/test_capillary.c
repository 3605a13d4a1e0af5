/* Tests of the meniscus: the capillary surface against closed forms and an independent integration of the equation of
 * Young and Laplace, and lines through a liquid against its definition. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "geometry/primitives/capillary.h"
#include "geometry/shapes/meniscus.h"
#include "random_stream.h"
#include "ray_fixture.h"

static capillary_profile solved;
static const double degree = 3.14159265358979323846 / 180.0;

/* The height above the level of zero pressure difference. */
static double rise_at(double r)
{
    double slope;
    return capillary_rise(&solved, r * r, &slope);
}

static double slope_at(double r)
{
    double slope;
    capillary_rise(&solved, r * r, &slope);
    return 2.0 * r * slope;
}

/* (r, u, psi) by arc length from the axis: r' = cos psi, u' = sin psi, psi' = u / a^2 - sin(psi) / r, with steps of
 * Runge and Kutta; the last ones end at the wall. Returns u there. */
static long double integrated(long double axis, long double wide, long double *psi)
{
    long double y[3] = {0, axis, 0}, step = wide / 20000;
    while (wide - y[0] > 1e-16L * wide && step > 1e-17L * wide) {
        long double k[4][3], next[3];
        for (int i = 0; i < 4; i++) {
            const long double share = i == 0 ? 0 : i == 3 ? step : step / 2;
            long double z[3];
            for (int j = 0; j < 3; j++)
                z[j] = y[j] + (i > 0 ? share * k[i - 1][j] : 0);
            k[i][0] = cosl(z[2]);
            k[i][1] = sinl(z[2]);
            k[i][2] = z[0] == 0 ? z[1] / 2 : z[1] - sinl(z[2]) / z[0];
        }
        for (int j = 0; j < 3; j++)
            next[j] = y[j] + step / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
        if (next[0] > wide)
            step *= 0.5L;
        else
            memcpy(y, next, sizeof y);
    }
    *psi = y[2];
    return y[1];
}

static void surfaces_agree_with_an_integration_by_arc_length(void **state)
{
    (void)state;
    static const double widths[] = {0.05, 0.5, 1.0, 2.0, 4.6, 8.0}, angles[] = {1.0, 10.0, 20.0, 60.0, 89.0};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 5; j++) {
            capillary_solve(widths[i], 1.0, angles[j], 0.0, &solved);
            long double psi;
            const long double u = integrated(solved.piece[0].c[0], widths[i], &psi);
            assert_true(fabsl(u - rise_at(widths[i])) < 1e-11L);
            assert_true(fabsl(psi - (90.0L - angles[j]) * degree) < 1e-11L);
            assert_true(fabs(atan(slope_at(widths[i])) - (90.0 - angles[j]) * degree) < 1e-12);
        }
}

/* The wall carries the weight above the level of zero pressure difference: 2 pi integral of u r dr = 2 pi R a^2
 * cos(contact angle); and the liquid's volume is that below its height. By Simpson's rule in q = r^2. */
static void the_wall_carries_the_weight_and_volume_is_kept(void **state)
{
    (void)state;
    static const double radii[] = {0.02, 0.9, 3.0, 50.0}, angles[] = {3.0, 20.0, 70.0, 110.0, 170.0};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 5; j++) {
            const double a = 0.195, R = radii[i];
            capillary_solve(R, a, angles[j], 40.0, &solved);
            double sum = 0.0;
            for (int k = 0; k < solved.count; k++) {
                const capillary_piece *e = &solved.piece[k];
                for (int n = 0; n < 200; n++) {
                    const double q = e->from + e->width * n / 200, half = e->width / 400;
                    sum += half / 3 * (rise_at(sqrt(q)) + 4 * rise_at(sqrt(q + half)) + rise_at(sqrt(q + 2 * half)));
                }
            }
            const double weight = R * a * a * cos(angles[j] * degree);
            assert_true(fabs(0.5 * sum - weight) < 1e-10 * R * a);
            assert_true(fabs(solved.level + sum / (R * R) - 40.0) < 1e-10);
        }
}

/* Small slopes: u = A I0(r / a), the solution of u'' + u' / r = u / a^2. */
static void small_slopes_are_a_bessel_function(void **state)
{
    (void)state;
    const double angle = 89.99, R = 3.0;
    capillary_solve(R, 1.0, angle, 0.0, &solved);
    double term = 1.0, i0 = 1.0, i1 = 0.5 * R, of_i1 = 0.5 * R; /* series of I0 and I1 (DLMF 10.25.2) */
    for (int k = 1; k < 40; k++) {
        term *= 0.25 * R * R / (k * k), i0 += term;
        of_i1 *= 0.25 * R * R / (k * (k + 1.0)), i1 += of_i1;
    }
    const double A = 1.0 / (tan(angle * degree) * i1);
    assert_true(fabs(solved.piece[0].c[0] / A - 1.0) < 1e-7); /* the next terms are of the slope squared, 3e-8 */
    assert_true(fabs(rise_at(R) / (A * i0) - 1.0) < 1e-7);
}

/* A wide tube: the height at a flat wall, a sqrt(2 (1 - sin(contact angle))) (Landau and Lifshitz, Fluid Mechanics,
 * 61), and the next term: along the surface near the wall u du = sin(psi) dpsi + sin(psi) du / R, with u = 2 sin(psi/2)
 * in the last term, gives 2 (1 - cos(psi / 2)^3) / (3 R sin(psi / 2)). A narrow one: Jurin's height 2 a^2 cos / R and a
 * spherical cap. */
static void wide_and_narrow_tubes_have_their_limits(void **state)
{
    (void)state;
    static const double angles[] = {2.0, 30.0, 75.0}, widths[] = {50.0, 100.0, 400.0};
    for (int j = 0; j < 3; j++) {
        const double sine = sin(angles[j] * degree), cosine = cos(angles[j] * degree), flat = sqrt(2.0 * (1.0 - sine));
        const double half = 0.5 * (90.0 - angles[j]) * degree,
                     next = 2.0 * (1.0 - pow(cos(half), 3.0)) / (3.0 * sin(half));
        for (int i = 0; i < 3; i++) {
            capillary_solve(widths[i], 1.0, angles[j], 0.0, &solved);
            assert_true(fabs(widths[i] * (rise_at(widths[i]) - flat) - next) < 0.4 / widths[i]);
        }
        const double R = 1e-3, ball = R / cosine;
        capillary_solve(R, 1.0, angles[j], 0.0, &solved);
        assert_true(fabs(rise_at(R) - rise_at(0.0) - (ball - ball * sine)) < 1e-5 * R);
        assert_true(fabs(rise_at(0.0) -
                         (2.0 * cosine / R -
                          R / cosine * (1.0 - 2.0 / 3.0 * (1.0 - sine * sine * sine) / (cosine * cosine)))) < 1e-6);
    }
}

static solid_shape random_liquid(uint64_t *seed)
{
    solid_shape s = {.kind = SHAPE_CYLINDER, .m = 1.0, .height = 2.0};
    s.radius = random_real(seed, 0.3, 1.5);
    s.contact_radius = random_below(seed, 2) ? 0.0 : s.radius * random_real(seed, 0.7, 1.0);
    s.capillary_length = s.radius * exp(random_real(seed, -4.0, -0.5));
    s.contact_angle_deg = random_below(seed, 3) ? random_real(seed, 3.0, 88.0) : random_real(seed, 92.0, 177.0);
    s.position = random_point(seed, random_below(seed, 4) ? 1.0 : 100.0);
    if (random_below(seed, 2))
        s.rotation_deg = random_point(seed, 180.0);
    return s;
}

/* From hit to hit, so with starts on the surface: between hits the line is within the liquid or outside, as the
 * definition says for points along it; each hit is on the surface. */
static void lines_cross_where_the_definition_says(void **state)
{
    (void)state;
    enum { LIQUIDS = 300, LINES = 100, POINTS = 60 };
    uint64_t seed = 7;
    int crossed[8] = {0};
    for (int i = 0; i < LIQUIDS; i++) {
        const solid_shape s = random_liquid(&seed);
        if (solid_shape_check(&s, NULL) != STATUS_OK)
            continue;
        scene_geometry *a = scene_geometry_of(&s, 1);
        const mat3 turn = rotation_from_deg(s.rotation_deg);
        for (int k = 0; k < LINES; k++) {
            const vec3 aim = vec3_make(random_real(&seed, -s.radius, s.radius),
                                       random_real(&seed, meniscus_low(&s) - 0.1, meniscus_high(&s) + 0.02),
                                       random_real(&seed, -s.radius, s.radius));
            const vec3 d = vec3_normalize(random_point(&seed, 1.0));
            const vec3 at = vec3_add(s.position, mat3_apply(turn, aim));
            one_ray r = {vec3_sub(at, vec3_scale(d, 6.0)), d, FACE_NONE, 0};
            int n = 0;
            bool inside = false;
            for (;; n++) {
                const one_hit h = nearest_interface(a, r);
                const double length = h.hit_primitive >= 0 ? h.t : 12.0;
                for (int j = 1; j < POINTS; j++) {
                    const double t = length * j / POINTS;
                    if (t > 1e-9 && length - t > 1e-9)
                        assert_true(solid_shape_contains(&s, vec3_add(r.o, vec3_scale(d, t))) == inside);
                }
                if (h.hit_primitive < 0)
                    break;
                assert_true(n < 6);
                const double slip = 1e-9 * (1.0 + vec3_length(s.position));
                assert_true(vec3_length(vec3_sub(h.point, vec3_add(r.o, vec3_scale(d, h.t)))) < slip);
                inside = !inside;
                r = (one_ray){h.point, d, h.face, h.inside_after};
            }
            assert_false(inside);
            crossed[n]++;
        }
        scene_geometry_destroy(a);
    }
    assert_true(crossed[0] > 300 && crossed[2] > 10000 && crossed[4] > 300);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_agree_with_an_integration_by_arc_length),
        cmocka_unit_test(the_wall_carries_the_weight_and_volume_is_kept),
        cmocka_unit_test(small_slopes_are_a_bessel_function),
        cmocka_unit_test(wide_and_narrow_tubes_have_their_limits),
        cmocka_unit_test(lines_cross_where_the_definition_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
