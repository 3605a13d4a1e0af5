/* Tests of polarised light: frames, interfaces, and the analyser's row against forward products of Mueller matrices. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "mueller_matrix.h"
#include "polarised_chain.h"
#include "random_stream.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))
#define assert_stokes_near(a, b, tolerance) assert_true(stokes_distance(a, b) <= (tolerance))

static const double radian_deg = 57.295779513082321;
static const stokes unpolarised = {1.0, 0.0, 0.0, 0.0}, eye = {1.0, 0.0, 0.0, 0.0};
static const double indices[] = {1.31, 1.33, 1.5, 1.51, 1.7, 2.42};

static double stokes_distance(stokes a, stokes b)
{
    return fmax(fmax(fabs(a.i - b.i), fabs(a.q - b.q)), fmax(fabs(a.u - b.u), fabs(a.v - b.v)));
}

static double squared(double a)
{
    return a * a;
}

/* i^2 - q^2 - u^2 - v^2, in units of i^2: never negative for light, nor for a row that never gives a negative
 * intensity. */
static double unpolarised_excess(stokes s)
{
    return (s.i * s.i - s.q * s.q - s.u * s.u - s.v * s.v) / (s.i * s.i);
}

static stokes random_light(uint64_t *seed)
{
    vec3 pole = vec3_scale(random_direction(seed), random_real(seed, 0.0, 1.0));
    stokes s = {1.0, pole.x, pole.y, pole.z};
    return s;
}

/* A normal that faces d at cos_i, in a plane of incidence whose s is at angle a (degrees) from canonical x. */
static vec3 normal_at(vec3 d, double cos_i, double a_deg)
{
    vec3 x, y;
    polarisation_frame(d, &x, &y);
    vec3 s = vec3_add(vec3_scale(x, cos(a_deg / radian_deg)), vec3_scale(y, sin(a_deg / radian_deg)));
    /* s = d x n / sin_i: n = -cos_i d + sin_i (s x d) */
    return vec3_add(vec3_scale(d, -cos_i), vec3_scale(vec3_cross(s, d), sqrt(1.0 - cos_i * cos_i)));
}

/* --- frames --- */

static void frames_are_orthonormal_and_right_handed(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < 100000; i++) {
        vec3 d = random_direction(&seed), x, y;
        if (i < 64) /* poles and axes, of both signs */
            d = vec3_make((i & 1) - ((i >> 1) & 1), ((i >> 2) & 1) - ((i >> 3) & 1), ((i >> 4) & 1) - ((i >> 5) & 1));
        if (vec3_dot(d, d) == 0.0)
            continue;
        d = vec3_normalize(d);
        polarisation_frame(d, &x, &y);
        assert_near(vec3_dot(x, x), 1.0, 1e-15);
        assert_near(vec3_dot(x, d), 0.0, 5e-16);
        assert_near(vec3_length(vec3_sub(vec3_cross(d, x), y)), 0.0, 1e-15);
        assert_near(vec3_length(vec3_sub(vec3_cross(x, y), d)), 0.0, 1e-15);
    }
}

static void equal_directions_have_equal_frames(void **state)
{
    (void)state;
    vec3 x, y, other_x, other_y;
    polarisation_frame(vec3_make(0.6, 0.8, 0.0), &x, &y);
    polarisation_frame(vec3_make(0.6, 0.8, -0.0), &other_x, &other_y);
    assert_true(x.x == other_x.x && x.y == other_x.y && x.z == other_x.z);
    assert_true(y.x == other_y.x && y.y == other_y.y && y.z == other_y.z);
}

/* The double angle computed by trigonometry. */
static void a_frame_rotation_uses_the_double_angle(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int i = 0; i < 20000; i++) {
        vec3 d = random_direction(&seed), x, y;
        polarisation_frame(d, &x, &y);
        double a = random_real(&seed, -4.0, 4.0), length = exp(random_real(&seed, -20.0, 5.0));
        vec3 e = vec3_add(vec3_scale(x, length * cos(a)), vec3_scale(y, length * sin(a)));
        e = vec3_add(e, vec3_scale(d, length * random_real(&seed, -1.0, 1.0)));
        frame_turn t = frame_turn_to(x, y, e);
        assert_near(t.cos_2a, cos(2.0 * a), 4e-15);
        assert_near(t.sin_2a, sin(2.0 * a), 4e-15);
    }
    frame_turn none = frame_turn_to(vec3_make(1, 0, 0), vec3_make(0, 1, 0), vec3_make(0, 0, 1));
    assert_true(none.cos_2a == 1.0 && none.sin_2a == 0.0);
}

/* Light along +45 degrees is u = 1 in the frame, and q = 1 in the frame rotated to it. */
static void a_rotated_frame_describes_the_same_light(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int i = 0; i < 20000; i++) {
        vec3 d = random_direction(&seed), x, y;
        polarisation_frame(d, &x, &y);
        assert_stokes_near(stokes_linear(d, vec3_add(x, y)), ((stokes){1.0, 0.0, 1.0, 0.0}), 2e-15);
        field e = field_add(field_from(x, random_real(&seed, -1.0, 1.0) + I * random_real(&seed, -1.0, 1.0)),
                            field_from(y, random_real(&seed, -1.0, 1.0) + I * random_real(&seed, -1.0, 1.0)));
        double a = random_real(&seed, -4.0, 4.0);
        vec3 turned_x = vec3_add(vec3_scale(x, cos(a)), vec3_scale(y, sin(a))), turned_y = vec3_cross(d, turned_x);
        frame_turn t = frame_turn_to(x, y, turned_x);
        stokes expected = field_stokes(e, turned_x, turned_y), here = field_stokes(e, x, y);
        assert_stokes_near(stokes_rotate(here, t.cos_2a, t.sin_2a), expected, 2e-14);
        assert_stokes_near(mueller_apply(mueller_rotation(t.cos_2a, t.sin_2a), here), expected, 2e-14);
        assert_near(unpolarised_excess(here), 0.0, 1e-14); /* one field is fully polarised */
    }
}

static void a_rotation_by_180_degrees_is_the_identity(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int i = 0; i < 1000; i++) {
        vec3 d = random_direction(&seed), x, y;
        polarisation_frame(d, &x, &y);
        stokes s = random_light(&seed);
        frame_turn t = frame_turn_to(x, y, vec3_scale(x, -1.0));
        assert_stokes_near(stokes_rotate(s, t.cos_2a, t.sin_2a), s, 1e-15);
        vec3 quarter = vec3_add(x, vec3_scale(y, random_real(&seed, -5.0, 5.0))); /* and there and back */
        t = frame_turn_to(x, y, quarter);
        stokes there = stokes_rotate(s, t.cos_2a, t.sin_2a);
        assert_stokes_near(stokes_rotate(there, t.cos_2a, -t.sin_2a), s, 1e-15);
    }
}

/* --- one interface --- */

/* tan theta_B = n: reflected light is polarised along s, with R_s = ((n^2 - 1) / (n^2 + 1))^2. Hecht, 8.6.1. */
static void reflection_at_brewsters_angle_is_fully_polarised_along_s(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (size_t k = 0; k < COUNT(indices); k++) {
        const double n = indices[k], cos_i = 1.0 / sqrt(1.0 + n * n), R_s = squared((n * n - 1.0) / (n * n + 1.0));
        stokes s = mueller_apply(mueller_reflect(cos_i, 1.0, n), unpolarised);
        assert_near(s.i, 0.5 * R_s, 1e-15);
        assert_near(s.q / s.i, 1.0, 1e-15);
        assert_true(s.u == 0.0 && s.v == 0.0);
        for (int i = 0; i < 1000;
             i++) { /* the eye receives all of it through a filter along s and none through one along p */
            vec3 d = random_direction(&seed), normal = normal_at(d, cos_i, random_real(&seed, 0.0, 360.0));
            vec3 s_axis = vec3_cross(d, normal), child = direction_reflect(d, normal, cos_i);
            stokes open = stokes_linear(d, s_axis), closed = stokes_linear(d, vec3_cross(d, s_axis));
            assert_near(analyser_reflect(open, d, normal, cos_i, 1.0, n, child).i, R_s, 1e-14);
            assert_near(analyser_reflect(closed, d, normal, cos_i, 1.0, n, child).i, 0.0, 1e-14);
        }
    }
}

/* T_s = sin 2i sin 2t / sin^2 (i + t), T_p = T_s / cos^2 (i - t). Born and Wolf, 7th ed., 1.5.3. */
static void transmittances_agree_with_the_sine_laws(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(indices); k++)
        for (double i_deg = 1.0; i_deg < 89.5; i_deg += 1.0)
            for (int out = 0; out < 2; out++) {
                const double i = i_deg / radian_deg, from = out ? indices[k] : 1.0, to = out ? 1.0 : indices[k];
                if (sin(i) * from / to > 0.999)
                    continue;
                const double t = asin(sin(i) * from / to);
                const double T_s = sin(2.0 * i) * sin(2.0 * t) / squared(sin(i + t)), T_p = T_s / squared(cos(i - t));
                mueller m = mueller_refract(cos(i), from, to);
                const double tolerance = 1e-14 / cos(t);
                assert_near(m.m[0][0] + m.m[0][1], T_s, tolerance);
                assert_near(m.m[0][0] - m.m[0][1], T_p, tolerance);
                assert_near(m.m[2][2], sqrt(T_s * T_p), tolerance);
                assert_true(m.m[3][3] == m.m[2][2] && m.m[2][3] == 0.0 && m.m[3][2] == 0.0);
                m = mueller_reflect(cos(i), from, to); /* r_s = -sin(i-t) / sin(i+t), r_p = tan(i-t) / tan(i+t) */
                assert_near(m.m[2][2], -sin(i - t) / sin(i + t) * tan(i - t) / tan(i + t), tolerance);
            }
}

/* A pile of plates, light that is never reflected: T_s / T_p = cos^2 (i - t) at each surface, so that after k of them P
 * = (1 - cos^2k (i - t)) / (1 + cos^2k (i - t)). Born and Wolf, 7th ed., 1.5.3; Hecht, 8.6.1. */
static void a_pile_of_plates_has_its_degree_of_polarisation(void **state)
{
    (void)state;
    uint64_t seed = 6;
    for (size_t k = 0; k < COUNT(indices); k++)
        for (double i_deg = 0.0; i_deg < 86.0; i_deg += 5.0) {
            const double n = indices[k], i = i_deg / radian_deg, t = asin(sin(i) / n);
            vec3 d = random_direction(&seed), normal = normal_at(d, cos(i), 77.0);
            stokes along = {1.0, 0.0, 0.0, 0.0}, row_s = stokes_linear(d, vec3_cross(d, normal)), row_p = row_s;
            row_p.q = -row_p.q, row_p.u = -row_p.u;
            if (i_deg == 0.0)
                row_s = row_p = eye; /* any plane */
            double ratio = 1.0;
            for (int surface = 0; surface < 40; surface++) {
                const double from = surface % 2 ? n : 1.0, to = surface % 2 ? 1.0 : n, cos_i = -vec3_dot(d, normal);
                fresnel f = fresnel_dielectric(cos_i, from, to);
                vec3 child = direction_refract(d, normal, cos_i, f.eta, f.cos_t);
                row_s = analyser_refract(row_s, d, normal, cos_i, from, to, child);
                row_p = analyser_refract(row_p, d, normal, cos_i, from, to, child);
                along = mueller_apply(mueller_refract(cos_i, from, to), along);
                d = child;
                ratio *= squared(cos(i - t));
                const double degree = (1.0 - ratio) / (1.0 + ratio);
                assert_near(-along.q / along.i, degree, 3e-14 / cos(i));
                assert_near((row_p.i - row_s.i) / (row_p.i + row_s.i), degree, 3e-14 / cos(i));
            }
        }
}

/* Two glass plates, both at Brewster's angle, with planes of incidence rotated by phi: polariser and analyser after
 * Malus and Noerremberg. Unpolarised light is reduced to R_s^2 cos^2(phi) / 2. Hecht, 8.2.1 and 8.6.1. */
static void two_brewster_reflections_obey_malus(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (size_t k = 0; k < COUNT(indices); k++)
        for (double phi = 0.0; phi <= 360.0; phi += 7.5) {
            const double n = indices[k], cos_i = 1.0 / sqrt(1.0 + n * n), R_s = squared((n * n - 1.0) / (n * n + 1.0));
            vec3 d = random_direction(&seed), first = normal_at(d, cos_i, random_real(&seed, 0.0, 360.0));
            vec3 c = direction_reflect(d, first, cos_i), x, y;
            polarisation_frame(c, &x, &y);
            vec3 s = vec3_cross(d, first);
            double s_deg = atan2(vec3_dot(s, y), vec3_dot(s, x)) * radian_deg;
            vec3 second = normal_at(c, cos_i, s_deg + phi);
            stokes row = analyser_reflect(eye, d, first, cos_i, 1.0, n, c);
            row = analyser_reflect(row, c, second, cos_i, 1.0, n, direction_reflect(c, second, cos_i));
            assert_near(row.i, 0.5 * R_s * R_s * squared(cos(phi / radian_deg)), 4e-15);
        }
}

/* --- total reflection --- */

static double retardance_deg(mueller m)
{
    return atan2(m.m[2][3], m.m[2][2]) * radian_deg;
}

/* delta = delta_s - delta_p, tan(delta_s / 2) = -root / cos, tan(delta_p / 2) = -root / (n^2 cos), root = sqrt(sin^2 -
 * n^2), n < 1 the relative index. Born and Wolf, 7th ed., 1.5.4. */
static void total_reflection_has_the_closed_form_retardance(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(indices); k++)
        for (double theta = 1.0; theta < 90.0; theta += 0.5) {
            const double n = 1.0 / indices[k], sine = sin(theta / radian_deg), cosine = cos(theta / radian_deg);
            if (sine < n + 1e-6)
                continue;
            const double root = sqrt(sine * sine - n * n);
            const double delta = 2.0 * (atan(root / (n * n * cosine)) - atan(root / cosine)) * radian_deg;
            mueller m = mueller_reflect(cosine, indices[k], 1.0), through = mueller_refract(cosine, indices[k], 1.0);
            assert_near(retardance_deg(m), delta, 1e-12 / root);
            assert_near(m.m[3][2], -m.m[2][3], 0.0);
            assert_near(squared(m.m[2][2]) + squared(m.m[2][3]), 1.0, 1e-15);
            assert_true(m.m[0][0] == 1.0 && m.m[1][1] == 1.0 && m.m[0][1] == 0.0 && m.m[1][0] == 0.0);
            for (int row = 0; row < 4; row++)
                for (int column = 0; column < 4; column++)
                    assert_true(through.m[row][column] == 0.0);
        }
}

/* The greatest difference of phase, tan(delta / 2) = (1 - n^2) / 2n at sin^2 = 2 n^2 / (1 + n^2): for glass of 1.51
 * 45 deg 56' at 51 deg 20'. Born and Wolf, 7th ed., 1.5.4. */
static void the_retardance_of_glass_is_largest_at_51_degrees(void **state)
{
    (void)state;
    const double n = 1.0 / 1.51, sine = sqrt(2.0 * n * n / (1.0 + n * n)), theta = asin(sine);
    assert_near(theta * radian_deg, 51.0 + 20.0 / 60.0, 0.5 / 60.0);
    const double most = retardance_deg(mueller_reflect(cos(theta), 1.51, 1.0));
    assert_near(most, 45.0 + 56.0 / 60.0, 1.0 / 60.0); /* the book truncates 56.5' */
    assert_near(most, 2.0 * atan((1.0 - n * n) / (2.0 * n)) * radian_deg, 1e-12);
    assert_true(retardance_deg(mueller_reflect(cos(theta + 1e-3), 1.51, 1.0)) < most);
    assert_true(retardance_deg(mueller_reflect(cos(theta - 1e-3), 1.51, 1.0)) < most);
}

/* Fresnel's rhomb: two total reflections of 45 degrees retardance each make linear light at 45 degrees to the plane of
 * incidence circular. cos^2 (sin^2 - n^2) = tan^2(22.5 deg) sin^4 is quadratic in sin^2; for 1.51 its roots are 54 deg
 * 37' and 48 deg 37'. Born and Wolf, 7th ed., 1.5.4; Hecht, 8.7. */
static void fresnels_rhomb_makes_linear_light_circular(void **state)
{
    (void)state;
    uint64_t seed = 8;
    const double n2 = 1.0 / (1.51 * 1.51), k2 = squared(sqrt(2.0) - 1.0),
                 root = sqrt(squared(1.0 + n2) - 4.0 * (1.0 + k2) * n2);
    const double known_deg[] = {48.0 + 37.0 / 60.0, 54.0 + 37.0 / 60.0};
    for (int branch = 0; branch < 2; branch++) {
        const double sin2 = (1.0 + n2 + (branch ? root : -root)) / (2.0 * (1.0 + k2)), cos_i = sqrt(1.0 - sin2);
        assert_near(acos(cos_i) * radian_deg, known_deg[branch], 0.5 / 60.0);
        mueller once = mueller_reflect(cos_i, 1.51, 1.0), rhomb = mueller_multiply(once, once);
        stokes diagonal = {1.0, 0.0, 1.0, 0.0}, out = mueller_apply(rhomb, diagonal);
        assert_stokes_near(out, ((stokes){1.0, 0.0, 0.0, -1.0}), 1e-13);
        for (int i = 0; i < 1000; i++) { /* in space: parallel faces, circular analyser, polariser at 45 degrees */
            vec3 d = random_direction(&seed), normal = normal_at(d, cos_i, random_real(&seed, 0.0, 360.0));
            vec3 s = vec3_normalize(vec3_cross(d, normal)), c = direction_reflect(d, normal, cos_i);
            stokes row = {0.5, 0.0, 0.0, -0.5};
            row = analyser_reflect(row, d, normal, cos_i, 1.51, 1.0, c);
            vec3 far = vec3_scale(normal, -1.0), out_d = direction_reflect(c, far, -vec3_dot(c, far));
            row = analyser_reflect(row, c, far, -vec3_dot(c, far), 1.51, 1.0, out_d);
            vec3 p = vec3_cross(out_d, s);
            assert_near(analyser_intensity(row, stokes_linear(out_d, vec3_add(s, p))), 1.0, 1e-13);
            assert_near(analyser_intensity(row, stokes_linear(out_d, vec3_sub(s, p))), 0.0, 1e-13);
        }
    }
}

/* --- energy, realisability --- */

static void an_interface_weights_unpolarised_light_by_fresnel(void **state)
{
    (void)state;
    uint64_t seed = 9;
    for (int i = 0; i < 100000; i++) {
        vec3 d = random_direction(&seed);
        chain_step c = chain_step_random(&seed, d, random_real(&seed, 1.0, 2.5));
        fresnel f = fresnel_dielectric(c.cos_i, c.n_from, c.n_to);
        vec3 reflected = direction_reflect(d, c.n, c.cos_i),
             refracted = direction_refract(d, c.n, c.cos_i, f.eta, f.cos_t);
        stokes row = {random_real(&seed, 0.1, 1.0), 0.0, 0.0, 0.0};
        assert_near(analyser_reflect(row, d, c.n, c.cos_i, c.n_from, c.n_to, reflected).i, row.i * f.R, 1e-15);
        assert_near(analyser_refract(row, d, c.n, c.cos_i, c.n_from, c.n_to, refracted).i, row.i * (1.0 - f.R), 1e-15);
        assert_true(mueller_reflect(c.cos_i, c.n_from, c.n_to).m[0][0] == f.R);
        stokes behind = analyser_mirror(row, d, c.n, reflected); /* which keeps unpolarised light unchanged */
        assert_stokes_near(behind, row, 0.0);
    }
}

/* R_s + T_s = 1 = R_p + T_p: reflected and refracted light add up for every polarisation and every row. */
static void reflected_and_refracted_light_add_up_to_the_incident(void **state)
{
    (void)state;
    uint64_t seed = 10;
    for (int i = 0; i < 100000; i++) {
        vec3 d = random_direction(&seed);
        chain_step c = chain_step_random(&seed, d, random_real(&seed, 1.0, 2.5));
        fresnel f = fresnel_dielectric(c.cos_i, c.n_from, c.n_to);
        vec3 reflected = direction_reflect(d, c.n, c.cos_i),
             refracted = direction_refract(d, c.n, c.cos_i, f.eta, f.cos_t);
        stokes s = random_light(&seed);
        assert_near(analyser_reflect(s, d, c.n, c.cos_i, c.n_from, c.n_to, reflected).i +
                        analyser_refract(s, d, c.n, c.cos_i, c.n_from, c.n_to, refracted).i,
                    1.0, 2e-15);
        assert_near(mueller_apply(mueller_reflect(c.cos_i, c.n_from, c.n_to), s).i +
                        mueller_apply(mueller_refract(c.cos_i, c.n_from, c.n_to), s).i,
                    1.0, 2e-15);
    }
}

enum { CHAIN = 6 };

static mueller chain_mueller(const chain_step *c)
{
    switch (c->kind) {
    case CHAIN_REFLECT: return mueller_reflect(c->cos_i, c->n_from, c->n_to);
    case CHAIN_REFRACT: return mueller_refract(-vec3_dot(c->child, c->n), c->n_to, c->n_from); /* leaving n_to */
    case CHAIN_MIRROR: return mueller_from((sp_response){1.0, 0.0, -1.0, 0.0});
    default: return mueller_rotation(1.0, 0.0);
    }
}

static void light_and_rows_stay_physically_realisable(void **state)
{
    (void)state;
    uint64_t seed = 11;
    for (int i = 0; i < 10000; i++) {
        chain_step steps[CHAIN];
        chain_random(&seed, steps, CHAIN);
        stokes row = eye, light = random_light(&seed);
        vec3 axis = random_direction(&seed);
        row = i % 2 ? stokes_linear(steps[0].d, axis) : row;
        for (int k = 0; k < CHAIN && row.i > 1e-12; k++) {
            row = chain_analyser(&steps[k], row);
            assert_true(row.i >= 0.0 && row.i <= 1.0 + 1e-14);
            assert_true(unpolarised_excess(row) >= -1e-13 / fmin(row.i, 1.0));
        }
        for (int k = CHAIN; k-- > 0 && light.i > 1e-12;) {
            light = mueller_apply(chain_mueller(&steps[k]), light);
            assert_true(light.i >= 0.0 && light.i <= 1.0 + 1e-14);
            assert_true(unpolarised_excess(light) >= -1e-13 / fmin(light.i, 1.0));
            vec3 turn = random_direction(&seed);
            light = stokes_rotate(light, turn.x / hypot(turn.x, turn.y), turn.y / hypot(turn.x, turn.y));
        }
    }
}

/* --- backwards and forwards --- */

/* The product of the matrices in the order of the light's path, with explicit frames. */
static stokes forwards(const chain_step *steps, int count, stokes light)
{
    vec3 x, y;
    polarisation_frame(steps[count - 1].child, &x, &y);
    mueller product = mueller_rotation(1.0, 0.0);
    for (int k = count; k-- > 0;) {
        const chain_step *c = &steps[k];
        const vec3 s = vec3_normalize(vec3_cross(c->d, c->n)), p = vec3_cross(c->child, s);
        const double in = atan2(vec3_dot(s, y), vec3_dot(s, x)); /* from the frame of the light so far */
        assert_near(vec3_dot(vec3_cross(s, p), c->child), 1.0, 1e-14);
        product = mueller_multiply(mueller_rotation(cos(2.0 * in), sin(2.0 * in)), product);
        product = mueller_multiply(chain_mueller(c), product);
        x = s, y = vec3_cross(c->d, s);
    }
    vec3 eye_x, eye_y;
    polarisation_frame(steps[0].d, &eye_x, &eye_y);
    const double out = atan2(vec3_dot(eye_x, y), vec3_dot(eye_x, x));
    return mueller_apply(mueller_multiply(mueller_rotation(cos(2.0 * out), sin(2.0 * out)), product), light);
}

static stokes chain_row(const chain_step *steps, int count, stokes row)
{
    for (int k = 0; k < count; k++)
        row = chain_analyser(&steps[k], row);
    return row;
}

/* For the light's last step out of a medium the angle is only known through cos_t: a grazing angle loses digits to the
 * square root. */
static int chain_grazes(const chain_step *steps, int count)
{
    for (int k = 0; k < count; k++)
        if (steps[k].cos_i < 1e-2 || fabs(vec3_dot(steps[k].child, steps[k].n)) < 1e-2 || steps[k].cos_i > 1.0 - 1e-6)
            return 1;
    return 0;
}

static void the_analysers_row_equals_the_forward_product(void **state)
{
    (void)state;
    uint64_t seed = 12;
    int compared = 0;
    for (int i = 0; i < 10000; i++) {
        chain_step steps[CHAIN];
        chain_random(&seed, steps, CHAIN);
        stokes light = random_light(&seed), row = random_light(&seed); /* the eye with any filter in front of it */
        if (chain_grazes(steps, CHAIN))
            continue;
        compared++;
        assert_near(analyser_intensity(chain_row(steps, CHAIN, row), light),
                    analyser_intensity(row, forwards(steps, CHAIN, light)), 1e-12);
        assert_near(analyser_intensity(chain_row(steps, CHAIN, eye), light), forwards(steps, CHAIN, light).i, 1e-12);
    }
    assert_true(compared > 8000);
}

/* At each plane the tangential parts of E and H are continuous, for light that arrives along -child, leaves along -d
 * and continues behind the plane (a complex direction under total internal reflection). This ties the signs of the
 * amplitudes to Maxwell's equations. */
static void the_tests_fields_obey_maxwell_at_an_interface(void **state)
{
    (void)state;
    uint64_t seed = 13;
    int total = 0;
    for (int i = 0; i < 20000; i++) {
        vec3 d = random_direction(&seed);
        chain_step c = chain_step_random(&seed, d, random_real(&seed, 1.0, 2.5));
        c.kind = CHAIN_REFLECT;
        c.child = direction_reflect(c.d, c.n, c.cos_i);
        const vec3 s = vec3_normalize(vec3_cross(c.d, c.n)), arrives = vec3_scale(c.child, -1.0),
                   leaves = vec3_scale(c.d, -1.0);
        const vec3 plane = vec3_add(arrives, vec3_scale(c.n, c.cos_i)); /* the tangential part of `arrives` */
        amplitudes a = amplitudes_at(c.cos_i, c.n_from, c.n_to);
        total += cimag(a.cos_t) > 0.0;
        const field on = field_add(field_from(plane, c.n_from / c.n_to), field_from(c.n, -a.cos_t));
        assert_near(cabs(field_dot(on, on) - 1.0), 0.0, 1e-13);
        const double complex e_s = random_real(&seed, -1.0, 1.0) + I * random_real(&seed, -1.0, 1.0),
                             e_p = random_real(&seed, -1.0, 1.0) + I * random_real(&seed, -1.0, 1.0);
        const field in = field_add(field_from(s, e_s), field_from(vec3_cross(c.child, s), e_p)),
                    back = chain_field(&c, in);
        const field beyond =
            field_add(field_from(s, a.t_s * e_s), field_scale(field_cross(on, field_from(s, 1.0)), -a.t_p * e_p));
        const field e = field_add(field_add(in, back), field_scale(beyond, -1.0));
        const field h = field_add(field_add(field_scale(field_cross(field_from(arrives, 1.0), in), c.n_from),
                                            field_scale(field_cross(field_from(leaves, 1.0), back), c.n_from)),
                                  field_scale(field_cross(on, beyond), -c.n_to));
        assert_near(field_power(field_cross(e, field_from(c.n, 1.0))), 0.0, 1e-24);
        assert_near(field_power(field_cross(h, field_from(c.n, 1.0))), 0.0, 1e-24);
    }
    assert_true(total > 1000);
}

/* The field itself, as a vector in space, through the same chain. */
static void the_analysers_row_equals_the_fields_intensity(void **state)
{
    (void)state;
    uint64_t seed = 14;
    int compared = 0;
    for (int i = 0; i < 10000; i++) {
        chain_step steps[CHAIN];
        chain_random(&seed, steps, CHAIN);
        vec3 x, y, eye_x, eye_y;
        polarisation_frame(steps[CHAIN - 1].child, &x, &y);
        polarisation_frame(steps[0].d, &eye_x, &eye_y);
        field e = field_add(field_from(x, random_real(&seed, -1.0, 1.0) + I * random_real(&seed, -1.0, 1.0)),
                            field_from(y, random_real(&seed, -1.0, 1.0) + I * random_real(&seed, -1.0, 1.0)));
        const stokes light = field_stokes(e, x, y), row = random_light(&seed);
        if (chain_grazes(steps, CHAIN))
            continue;
        compared++;
        for (int k = CHAIN; k-- > 0;)
            e = chain_field(&steps[k], e);
        assert_near(analyser_intensity(chain_row(steps, CHAIN, row), light),
                    analyser_intensity(row, field_stokes(e, eye_x, eye_y)), 4e-12);
    }
    assert_true(compared > 8000);
}

/* A mirror at normal incidence: the field is inverted, so that linear light keeps its plane in space, and circular
 * light changes its handedness. */
static void a_mirror_keeps_linear_planes_and_inverts_handedness(void **state)
{
    (void)state;
    uint64_t seed = 15;
    for (int i = 0; i < 10000; i++) {
        vec3 d = random_direction(&seed), e = random_direction(&seed);
        if (i % 4 == 0) /* a horizontal direction: frames of d and -d do not share x there */
            d = vec3_normalize(vec3_make(d.x, d.y, 0.0));
        vec3 n = vec3_scale(d, -1.0);
        if (vec3_length(vec3_cross(e, d)) < 1e-2)
            continue;
        stokes row = analyser_mirror(stokes_linear(d, e), d, n, n);
        assert_stokes_near(row, stokes_linear(n, e), 1e-12);
        row = analyser_mirror((stokes){1.0, 0.0, 0.0, 1.0}, d, n, n);
        assert_stokes_near(row, ((stokes){1.0, 0.0, 0.0, -1.0}), 1e-15);
        row = analyser_reflect(stokes_linear(d, e), d, n, 1.0, 1.0, 1.5, n); /* and so does glass, 4% */
        stokes expected = stokes_linear(n, e);
        assert_stokes_near(row, ((stokes){0.04 * expected.i, 0.04 * expected.q, 0.04 * expected.u, 0.0}), 1e-13);
        row = analyser_refract(stokes_linear(d, e), d, n, 1.0, 1.0, 1.5, d);
        expected = stokes_linear(d, e);
        assert_stokes_near(row, ((stokes){0.96 * expected.i, 0.96 * expected.q, 0.96 * expected.u, 0.0}), 1e-13);
    }
}

/* Towards normal incidence s and p lose their plane, but the result is continuous: rows differ from the limit by at
 * most the rotation of the canonical frames and the angle's square times Fresnel's difference. */
static void rows_are_continuous_near_normal_incidence(void **state)
{
    (void)state;
    uint64_t seed = 16;
    const double angles[] = {0.0, 1e-300, 1e-17, 1e-16, 1e-12, 0.9e-9, 1e-9, 1.1e-9, 1e-8, 1e-6, 1e-3};
    for (int i = 0; i < 3000; i++) {
        vec3 n = random_direction(&seed);
        if (fabs(n.z) < 0.01)
            continue; /* where the canonical frame is discontinuous */
        const stokes row = random_light(&seed);
        const double n_to = random_real(&seed, 1.0, 2.5), plane_deg = random_real(&seed, 0.0, 360.0);
        const double R = squared((1.0 - n_to) / (1.0 + n_to));
        /* q, u, v in canonical frames of d = -n and of n, which share x: the field is inverted, with y and the
         * handedness */
        const stokes back = {R * row.i, R * row.q, -R * row.u, -R * row.v};
        const stokes on = {(1.0 - R) * row.i, (1.0 - R) * row.q, (1.0 - R) * row.u, (1.0 - R) * row.v};
        for (size_t k = 0; k < COUNT(angles); k++) {
            vec3 x, y;
            polarisation_frame(n, &x, &y);
            vec3 tilt =
                vec3_add(vec3_scale(x, cos(plane_deg / radian_deg)), vec3_scale(y, sin(plane_deg / radian_deg)));
            vec3 d = vec3_normalize(vec3_add(vec3_scale(n, -1.0), vec3_scale(tilt, angles[k])));
            const double cos_i = -vec3_dot(d, n);
            fresnel f = fresnel_dielectric(cos_i, 1.0, n_to);
            vec3 reflected = direction_reflect(d, n, cos_i), refracted = direction_refract(d, n, cos_i, f.eta, f.cos_t);
            const double turn = 4e-15 + 8.0 * angles[k], difference = 4e-15 + 8.0 * angles[k] * angles[k];
            stokes reflected_row = analyser_reflect(row, d, n, cos_i, 1.0, n_to, reflected);
            stokes refracted_row = analyser_refract(row, d, n, cos_i, 1.0, n_to, refracted);
            assert_stokes_near(reflected_row, back, turn);
            assert_stokes_near(refracted_row, on, turn);
            /* no rotation of the frame affects these */
            assert_near(reflected_row.i, back.i, difference);
            assert_near(refracted_row.i, on.i, difference);
            assert_near(reflected_row.v, back.v, difference);
            assert_near(hypot(refracted_row.q, refracted_row.u), hypot(on.q, on.u), difference);
            assert_near(hypot(reflected_row.q, reflected_row.u), hypot(back.q, back.u), difference);
        }
    }
}

/* R_s,p = R (1 +- 2 theta^2 / n) to the second order in theta, from Fresnel's equations with cos = 1 - theta^2 / 2. */
static void s_and_p_differ_by_the_square_of_the_angle(void **state)
{
    (void)state;
    uint64_t seed = 17;
    for (double theta = 1e-5; theta < 2e-3; theta *= 2.0)
        for (int i = 0; i < 200; i++) {
            const double n = random_real(&seed, 1.3, 2.5), R = squared((1.0 - n) / (1.0 + n)),
                         cos_i = 1.0 - 0.5 * theta * theta;
            vec3 d = random_direction(&seed), normal = normal_at(d, cos_i, random_real(&seed, 0.0, 360.0));
            vec3 s = vec3_cross(d, normal), child = direction_reflect(d, normal, cos_i);
            const double R_s = analyser_reflect(stokes_linear(d, s), d, normal, cos_i, 1.0, n, child).i;
            const double R_p = analyser_reflect(stokes_linear(d, vec3_cross(d, s)), d, normal, cos_i, 1.0, n, child).i;
            assert_near((R_s - R_p) / (4.0 * R * theta * theta / n), 1.0, 1e-3);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_orthonormal_and_right_handed),
        cmocka_unit_test(equal_directions_have_equal_frames),
        cmocka_unit_test(a_frame_rotation_uses_the_double_angle),
        cmocka_unit_test(a_rotated_frame_describes_the_same_light),
        cmocka_unit_test(a_rotation_by_180_degrees_is_the_identity),
        cmocka_unit_test(reflection_at_brewsters_angle_is_fully_polarised_along_s),
        cmocka_unit_test(transmittances_agree_with_the_sine_laws),
        cmocka_unit_test(a_pile_of_plates_has_its_degree_of_polarisation),
        cmocka_unit_test(two_brewster_reflections_obey_malus),
        cmocka_unit_test(total_reflection_has_the_closed_form_retardance),
        cmocka_unit_test(the_retardance_of_glass_is_largest_at_51_degrees),
        cmocka_unit_test(fresnels_rhomb_makes_linear_light_circular),
        cmocka_unit_test(an_interface_weights_unpolarised_light_by_fresnel),
        cmocka_unit_test(reflected_and_refracted_light_add_up_to_the_incident),
        cmocka_unit_test(light_and_rows_stay_physically_realisable),
        cmocka_unit_test(the_analysers_row_equals_the_forward_product),
        cmocka_unit_test(the_tests_fields_obey_maxwell_at_an_interface),
        cmocka_unit_test(the_analysers_row_equals_the_fields_intensity),
        cmocka_unit_test(a_mirror_keeps_linear_planes_and_inverts_handedness),
        cmocka_unit_test(rows_are_continuous_near_normal_incidence),
        cmocka_unit_test(s_and_p_differ_by_the_square_of_the_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
