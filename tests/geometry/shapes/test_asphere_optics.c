/* Rays through aspheric lenses: an exact trace of the meridional plane with slopes of its own, Seidel's sums with the
 * contribution of an aspheric term (Welford, Aberrations of Optical Systems, 1986, ch. 8), the hyperboloid of Descartes
 * written as a series (Hecht, Optics, 5.2), and a lens from a catalogue. Light travels along +y, the axis. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "asphere_fixture.h"
#include "optics/interface.h"
#include "ray_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

typedef struct prescription {
    solid_shape shape;
    double n;
} prescription;

#define LENS(r1, r2, t, d, ...)                                                                        \
    {                                                                                                  \
        .kind = SHAPE_LENS, .radius_1 = r1, .radius_2 = r2, .thickness = t, .diameter = d, __VA_ARGS__ \
    }

static const prescription lenses[] = {
    {LENS(1.0, -1.0, 0.3, 1.0, .even_1 = {-0.1, 0.05, -0.02}), 1.5},
    {LENS(0.8, 0.0, 0.3, 1.0, .even_1 = {-0.2, 0.1, 0.0}, .conic_1 = -0.6), 1.5168},
    {LENS(0.0, -0.8, 0.3, 1.0, .even_2 = {0.15, -0.1, 0.2}), 1.5168},
    {LENS(-1.0, 1.0, 0.15, 1.0, .even_1 = {-0.1, 0.0, -0.1}, .even_2 = {0.05, 0.05, 0.0}), 1.5},
    {LENS(0.8, 1.5, 0.25, 1.0, .even_1 = {-0.1, 0.0, 0.0}, .even_2 = {0.1, 0.0, 0.0}), 1.7},
    {LENS(1.2, 0.0, 0.3, 1.0, .even_1 = {-0.5, 0.0, 0.0}), 1.5}, /* it turns, as a Schmidt plate does */
};

static double curvature(double radius)
{
    return radius == 0.0 ? 0.0 : 1.0 / radius;
}

/* A ray behind the lens: it crosses the axis at a height l above the second vertex; tan(u) = -dx / dy. */
typedef struct meridional_ray {
    double l, tan_u;
} meridional_ray;

/* In the plane x, y in long double: the side is met where the height of the ray less that of the side, which has
 * different signs at the ends of a short interval, is 0; refraction by the angles with the normal. */
static meridional_ray traced_by_formula(const prescription *p, double h)
{
    const solid_shape *s = &p->shape;
    long double x = h, y = -2.0L, dx = 0.0L, dy = 1.0L, n = 1.0L, to = p->n;
    for (int k = 0; k < 2; k++) {
        long double low = ((k == 0 ? 0.0L : (long double)s->thickness) - 0.3L - y) / dy, high = low + 0.6L / dy;
        for (int step = 0; step < 90; step++) {
            const long double t = 0.5L * (low + high), at = x + t * dx;
            if (y + t * dy < (long double)asphere_height(s, k, (quad)at * at))
                low = t;
            else
                high = t;
        }
        x += low * dx, y += low * dy;
        const long double rise = x < 0 ? -(long double)asphere_rise(s, k, -x) : (long double)asphere_rise(s, k, x);
        const long double normal = atan2l(-rise, 1.0L), angle = atan2l(dx, dy) - normal; /* from +y towards +x */
        const long double after = normal + asinl(n / to * sinl(angle));
        dx = sinl(after), dy = cosl(after);
        n = to, to = 1.0L;
    }
    return (meridional_ray){(double)(y - x * dy / dx - s->thickness), (double)(-dx / dy)};
}

/* The same through the geometry's kernels and the refraction of the renderer, in a rotated lens. */
static meridional_ray traced(const prescription *p, double h)
{
    solid_shape s = p->shape;
    s.rotation_deg = vec3_make(20.0, 0.0, -35.0), s.position = vec3_make(0.3, -0.2, 0.5);
    scene_geometry *a = scene_geometry_of(&s, 1);
    const mat3 turn = rotation_from_deg(s.rotation_deg);
    const vec3 out = vec3_make(0.6, 0.0, 0.8), local = vec3_add(vec3_scale(out, h), vec3_make(0.0, -2.0, 0.0));
    one_ray r = {vec3_add(s.position, mat3_apply(turn, local)), mat3_apply(turn, vec3_make(0.0, 1.0, 0.0)), FACE_NONE,
                 0};
    for (int k = 0; k < 2; k++) {
        const one_hit hit = nearest_interface(a, r);
        assert_int_equal(hit.face, 1 + k);
        const fresnel f = fresnel_dielectric(hit.cos_i, k == 0 ? 1.0 : p->n, k == 0 ? p->n : 1.0);
        r = (one_ray){hit.point, direction_refract(r.d, hit.normal, hit.cos_i, f.eta, f.cos_t), hit.face,
                      hit.inside_after};
    }
    scene_geometry_destroy(a);
    const vec3 at = mat3_apply_transposed(turn, vec3_sub(r.o, s.position)), d = mat3_apply_transposed(turn, r.d);
    const double across = vec3_dot(d, out);
    return (meridional_ray){at.y - vec3_dot(at, out) * d.y / across - s.thickness, -across / d.y};
}

static void assert_close(double a, double b, double within, const char *what, size_t lens)
{
    if (!(fabs(a - b) <= within * fmax(1.0, fabs(b))))
        fail_msg("lens %zu: %s is %.15g instead of %.15g (off by %.2g)", lens, what, a, b, fabs(a - b));
}

static void rays_agree_with_an_exact_trace(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(lenses); i++) {
        diagnostic why;
        if (solid_shape_check(&lenses[i].shape, &why) != STATUS_OK)
            fail_msg("lens %zu: %s", i, why.what);
        for (int k = 1; k <= 40; k++) {
            const double h = 0.4 * lenses[i].shape.diameter * k / 40;
            const meridional_ray expected = traced_by_formula(&lenses[i], h), found = traced(&lenses[i], h);
            assert_close(found.tan_u, expected.tan_u, 1e-12, "tan U'", i);
            assert_close(found.tan_u * found.l, expected.tan_u * expected.l, 1e-12, "the height at the vertex", i);
        }
    }
}

/* The limit of f(h) for h to 0, where f is even in h: Richardson's extrapolation of three heights. */
static double limit_at_axis(double f(const prescription *, double), const prescription *p)
{
    const double h = 0.016 * p->shape.diameter, a = f(p, h), b = f(p, h / 2), c = f(p, h / 4);
    return (16.0 * (4.0 * c - b) / 3.0 - (4.0 * b - a) / 3.0) / 15.0;
}

static double focal_length_at(const prescription *p, double h)
{
    return h / traced(p, h).tan_u;
}

static double back_focus_at(const prescription *p, double h)
{
    return traced(p, h).l;
}

/* Hecht 6.2 to 6.4, of the curvatures at the vertices: coefficients do not change the cardinal points. */
static void gaussian(const prescription *p, double *f, double *back)
{
    const double c1 = curvature(p->shape.radius_1), c2 = curvature(p->shape.radius_2), d = p->shape.thickness,
                 m = p->n - 1.0;
    *f = 1.0 / (m * (c1 - c2 + m * d * c1 * c2 / p->n));
    *back = *f - *f * m * d * c1 / p->n;
}

static void coefficients_leave_the_cardinal_points(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(lenses); i++) {
        double f, back;
        gaussian(&lenses[i], &f, &back);
        assert_close(limit_at_axis(focal_length_at, &lenses[i]), f, 1e-9, "the focal length", i);
        assert_close(limit_at_axis(back_focus_at, &lenses[i]), back, 1e-9, "the back focal distance", i);
    }
}

/* Seidel's first sum: -A^2 y (u'/n' - u/n) of each sphere, and of its departure from it by G y^4, 8 (n' - n) G y^4; a
 * conic has G = k c^3 / 8. The longitudinal aberration of third order is -S / (2 n' u'^2). */
static double seidel_sum(const prescription *p, double h, double *slope)
{
    double y = h, u = 0.0, n = 1.0, sum = 0.0;
    for (int k = 0; k < 2; k++) {
        const solid_shape *s = &p->shape;
        const double c = curvature(k == 0 ? s->radius_1 : s->radius_2), to = k == 0 ? p->n : 1.0, a = n * (y * c + u),
                     after = (n * u - y * c * (to - n)) / to;
        const double g = (k == 0 ? s->even_1 : s->even_2)[0] + (k == 0 ? s->conic_1 : s->conic_2) * c * c * c / 8.0;
        sum -= a * a * y * (after / to - u / n);
        sum += 8.0 * (to - n) * g * y * y * y * y;
        u = after, n = to;
        y += k == 0 ? s->thickness * u : 0.0;
    }
    *slope = u;
    return sum;
}

static double seidel_aberration(const prescription *p, double h)
{
    double u;
    const double sum = seidel_sum(p, h, &u);
    return -sum / (2.0 * u * u);
}

/* The exact aberration is Seidel's up to a remainder of fourth order in h: halving h divides it by 16. */
static void spherical_aberration_is_seidels_to_third_order(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(lenses); i++) {
        double f, back, differs[3];
        gaussian(&lenses[i], &f, &back);
        for (int k = 0; k < 3; k++) {
            const double h = ldexp(0.08 * lenses[i].shape.diameter, -k), third = seidel_aberration(&lenses[i], h);
            differs[k] = traced(&lenses[i], h).l - back - third;
            assert_true(fabs(differs[k]) < 0.15 * pow(0.25, k) * fabs(third));
        }
        for (int k = 0; k < 2; k++)
            if (!(fabs(differs[k] / differs[k + 1] - 16.0) < 1.5))
                fail_msg("lens %zu: the remainder falls by %g", i, differs[k] / differs[k + 1]);
    }
}

/* A singlet, flat on one side, whose A4 cancels Seidel's sum: the transverse aberration, of third order in h without
 * A4, is of fifth order. */
static void a_coefficient_cancels_third_order_aberration(void **state)
{
    (void)state;
    for (int side = 0; side < 2; side++) {
        prescription p = {LENS(side == 0 ? 0.7 : 0.0, side == 0 ? 0.0 : -0.7, 0.3, 0.9, .conic_1 = 0.0), 1.5168};
        double u, f, back;
        gaussian(&p, &f, &back);
        for (int corrected = 0; corrected < 2; corrected++) {
            if (corrected) { /* S is linear in A4 */
                double *a4 = side == 0 ? &p.shape.even_1[0] : &p.shape.even_2[0];
                const double without = seidel_sum(&p, 1.0, &u);
                *a4 = 1.0;
                const double with = seidel_sum(&p, 1.0, &u);
                *a4 = -without / (with - without);
            }
            for (int k = 0; k < 3; k++) {
                const double h = ldexp(0.2, -k), power = corrected ? 32.0 : 8.0;
                const meridional_ray wide = traced(&p, h), narrow = traced(&p, h / 2);
                const double falls = (wide.l - back) * wide.tan_u / ((narrow.l - back) * narrow.tan_u);
                if (!(fabs(falls / power - 1.0) < 0.3 * pow(0.25, k)))
                    fail_msg("side %d, %s: the transverse aberration falls by %g", side + 1,
                             corrected ? "corrected" : "spherical", falls);
            }
        }
    }
}

/* A flat side and a hyperboloid with k = -n^2 have one focus for all heights. As a paraboloid of the same curvature,
 * whose series ends with c q / 2, and the further terms of the hyperboloid's, (1 + k) c^3 q^2 / 8 + (1 + k)^2 c^5 q^3 /
 * 16 + 5 (1 + k)^3 c^7 q^4 / 128, each term leaves an aberration of the next order: h^2, h^4, h^6, h^8. */
static void each_term_of_the_hyperboloid_removes_an_order(void **state)
{
    (void)state;
    const double n = 1.5, r = -0.5, c = 1.0 / r, k = -n * n, e = 1.0 + k, back = -r / (n - 1.0);
    const double series[3] = {e * pow(c, 3.0) / 8.0, e * e * pow(c, 5.0) / 16.0, 5.0 * e * e * e * pow(c, 7.0) / 128.0};
    prescription p = {LENS(0.0, r, 0.4, 0.8, .conic_2 = -1.0), n};
    for (int terms = 0; terms <= 3; terms++) {
        if (terms > 0)
            p.shape.even_2[terms - 1] = series[terms - 1];
        assert_int_equal(solid_shape_check(&p.shape, NULL), STATUS_OK);
        /* the height leaves out the term of the next order, 7 (1 + k)^4 c^9 q^5 / 256 after the last */
        const double next[4] = {series[0], series[1], series[2], 7.0 * pow(e, 4.0) * pow(c, 9.0) / 256.0};
        const double q = 1e-4, conic = c * q / (1.0 + sqrt(1.0 - e * c * c * q));
        const quad exact = (quad)c * q / (1 + quad_sqrt(1 - (quad)e * c * c * q)),
                   left = exact - (asphere_height(&p.shape, 1, q) - (quad)p.shape.thickness);
        assert_true(fabs((double)left / (next[terms] * pow(q, 2.0 + terms)) - 1.0) < 2e-3 && conic < 0.0);
        for (int i = 0; i < 2; i++) {
            const double h = ldexp(0.1, -i), power = ldexp(1.0, 2 * (terms + 1)),
                         falls = (traced(&p, h).l - back) / (traced(&p, h / 2).l - back);
            if (!(fabs(falls / power - 1.0) < 0.25 * pow(0.3, i)))
                fail_msg("%d terms: the aberration falls by %g instead of %g", terms, falls, power);
        }
    }
}

/* Thorlabs AL50100J, a flat and an aspheric side of N-BK7, for 1310 nm, in mm: the prescription as the manual of
 * BeamletOptics.jl gives it (juliaphysics.github.io/BeamletOptics.jl, "Simple aspherical lens example"). Its focal
 * length is 100 mm. It is corrected: all rays meet within 0.1 um on the axis, and Seidel's sum is less than 1e-4 of
 * that of a sphere of the same radius. */
static void a_lens_of_a_catalogue_has_one_focus(void **state)
{
    (void)state;
    prescription p = {
        LENS(50.3583, 0.0, 10.2, 50.0, .conic_1 = -0.789119, .even_1 = {2.10405e-7, 1.76468e-11, 1.02641e-15}), 1.5036};
    assert_int_equal(solid_shape_check(&p.shape, NULL), STATUS_OK);
    double f, back, u, least = HUGE_VAL, most = -HUGE_VAL;
    gaussian(&p, &f, &back);
    assert_close(f, 100.0, 1e-4, "the catalogue's focal length", 0);
    assert_close(limit_at_axis(focal_length_at, &p), f, 1e-10, "the focal length", 0);
    assert_close(limit_at_axis(back_focus_at, &p), back, 1e-10, "the back focal distance", 0);
    for (int k = 1; k <= 20; k++) {
        const double l = traced(&p, 22.5 * k / 20).l;
        least = fmin(least, l), most = fmax(most, l);
    }
    prescription sphere = p;
    sphere.shape.conic_1 = sphere.shape.even_1[0] = sphere.shape.even_1[1] = sphere.shape.even_1[2] = 0.0;
    const double third = seidel_sum(&p, 22.5, &u), of_sphere = seidel_sum(&sphere, 22.5, &u);
    print_message("foci within %.2g mm; a sphere: %.2g mm; Seidel's sum %.2g of the sphere's\n", most - least,
                  back - traced(&sphere, 22.5).l, third / of_sphere);
    assert_true(most - least < 1e-4 && fabs(third) < 1e-4 * fabs(of_sphere));
}

/* The example of cuvette-optics(7): its coefficients bring the foci of all rays together, which are 0.15 apart
 * without. */
static void the_manuals_example_has_one_focus(void **state)
{
    (void)state;
    prescription p = {LENS(0.8, 0.0, 0.25, 1.0, .conic_1 = 0.0), 1.5};
    double f, back;
    gaussian(&p, &f, &back);
    const double sphere = back - traced(&p, 0.44).l;
    assert_true(fabs(sphere - 0.1517) < 1e-4);
    p.shape.even_1[0] = -0.14, p.shape.even_1[1] = -0.141, p.shape.even_1[2] = -0.3189;
    for (int k = 1; k <= 22; k++)
        assert_true(fabs(traced(&p, 0.02 * k).l - back) < 1.1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_agree_with_an_exact_trace),
        cmocka_unit_test(coefficients_leave_the_cardinal_points),
        cmocka_unit_test(spherical_aberration_is_seidels_to_third_order),
        cmocka_unit_test(a_coefficient_cancels_third_order_aberration),
        cmocka_unit_test(each_term_of_the_hyperboloid_removes_an_order),
        cmocka_unit_test(a_lens_of_a_catalogue_has_one_focus),
        cmocka_unit_test(the_manuals_example_has_one_focus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
