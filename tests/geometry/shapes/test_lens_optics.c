/* Rays through lenses against the formulas of lens design: the exact trigonometric trace from sphere to sphere
 * (Conrady, Applied Optics and Optical Design, part I; Kingslake, Lens Design Fundamentals, ch. 2), Gaussian optics of
 * a thick lens (Hecht, Optics, 5th ed., 6.1), Seidel's spherical aberration (Welford, Aberrations of Optical Systems,
 * ch. 8) and the conics without any (Hecht 5.2). Light travels along +y, the axis of the lens. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "geometry/scene_geometry.h"
#include "optics/interface.h"
#include "random_stream.h"
#include "ray_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* Radii (0: flat), thickness, diameter, index. */
typedef struct prescription {
    double radius[2], thickness, diameter, n;
} prescription;

static const prescription lenses[] = {
    {{1.0, -1.0}, 0.3, 1.0, 1.5},    {{1.2, -2.5}, 0.25, 0.9, 1.7}, {{0.8, 0.0}, 0.3, 1.0, 1.5168},
    {{0.0, -0.8}, 0.3, 1.0, 1.5168}, {{-1.0, 1.0}, 0.1, 1.0, 1.5},  {{0.0, 1.3}, 0.1, 1.0, 1.62},
    {{-0.9, 0.0}, 0.1, 0.8, 1.62},   {{0.8, 1.5}, 0.25, 1.0, 1.5},  {{1.5, 0.7}, 0.1, 0.8, 1.5},
    {{-1.5, -0.8}, 0.3, 0.9, 1.8},   {{0.5, -0.5}, 2.0, 0.8, 1.5}, /* longer than its spheres */
};

static solid_shape shape_of_lens(const prescription *p)
{
    return (solid_shape){.kind = SHAPE_LENS,
                         .radius_1 = p->radius[0],
                         .radius_2 = p->radius[1],
                         .thickness = p->thickness,
                         .diameter = p->diameter};
}

/* The lens seen from the other side. */
static prescription reversed(prescription p)
{
    const double first = p.radius[0];
    p.radius[0] = -p.radius[1];
    p.radius[1] = -first;
    return p;
}

/* A ray behind the lens, in its meridional plane: it crosses the axis at a height l above the second vertex with a
 * slope u; tan(u) = -dx / dy, positive if it converges. */
typedef struct meridional_ray {
    double l, sin_u, tan_u;
} meridional_ray;

/* Snell's law sphere by sphere for a ray parallel to the axis at a distance h, with exact trigonometry: sin I = h / R
 * or (L - R) sin U / R, sin I' = n sin I / n', U' = U + I - I', L' = R + R sin I' / sin U'. U is the angle with the
 * axis, positive for a ray that converges; at a plane L' = L tan U / tan U', sin U' = n sin U / n'. */
static meridional_ray traced_by_formula(const prescription *p, double h)
{
    double n = 1.0, to = p->n, l = HUGE_VAL, u = 0.0;
    for (int k = 0; k < 2; k++) {
        const double r = p->radius[k];
        if (r == 0.0) {
            const double after = asin(n / to * sin(u));
            l = isinf(l) ? l : l * tan(u) / tan(after);
            u = after;
        } else {
            const double i = asin(isinf(l) ? h / r : (l - r) * sin(u) / r), after = asin(n / to * sin(i));
            u += i - after;
            l = r + r * sin(after) / sin(u);
        }
        n = to, to = 1.0;
        l -= k == 0 ? p->thickness : 0.0;
    }
    return (meridional_ray){l, sin(u), tan(u)};
}

/* The same through the geometry's kernels and the refraction of the renderer, in a placed and rotated lens and in a
 * meridional plane at the angle `around`. */
static meridional_ray traced(const prescription *p, const solid_shape *s, double h, double around)
{
    scene_geometry *a = scene_geometry_of(s, 1);
    const mat3 turn = rotation_from_deg(s->rotation_deg);
    const vec3 out = vec3_make(cos(around), 0.0, sin(around)),
               local = vec3_add(vec3_scale(out, h), vec3_make(0, -2.0, 0));
    one_ray r = {vec3_add(s->position, mat3_apply(turn, local)), mat3_apply(turn, vec3_make(0.0, 1.0, 0.0)), FACE_NONE,
                 0};
    for (int k = 0; k < 2; k++) {
        const one_hit hit = nearest_interface(a, r);
        assert_int_equal(hit.face, 1 + k);
        const fresnel f = fresnel_dielectric(hit.cos_i, k == 0 ? 1.0 : p->n, k == 0 ? p->n : 1.0);
        assert_true(!f.total);
        r = (one_ray){hit.point, direction_refract(r.d, hit.normal, hit.cos_i, f.eta, f.cos_t), hit.face,
                      hit.inside_after};
    }
    scene_geometry_destroy(a);
    const vec3 at = mat3_apply_transposed(turn, vec3_sub(r.o, s->position)), d = mat3_apply_transposed(turn, r.d);
    const double across = vec3_dot(d, out), height = vec3_dot(at, out);
    assert_true(fabs(d.x * out.z - d.z * out.x) < 1e-13); /* it stays in its plane */
    return (meridional_ray){at.y - height * d.y / across - p->thickness, -across, -across / d.y};
}

static meridional_ray at_origin(const prescription *p, double h)
{
    const solid_shape s = shape_of_lens(p);
    return traced(p, &s, h, 0.0);
}

static void assert_close(double a, double b, double within, const char *what, size_t lens)
{
    if (!(fabs(a - b) <= within * fmax(1.0, fabs(b))))
        fail_msg("lens %zu: %s is %.15g instead of %.15g (off by %.2g)", lens, what, a, b, fabs(a - b));
}

/* At all heights, in lenses anywhere: where the ray crosses the axis, and its slope. */
static void rays_agree_with_the_trigonometric_trace(void **state)
{
    (void)state;
    uint64_t seed = 1;
    int rays = 0;
    for (size_t i = 0; i < COUNT(lenses); i++) {
        const prescription *p = &lenses[i];
        for (int trial = 0; trial < 200; trial++) {
            solid_shape s = shape_of_lens(p);
            s.position = random_point(&seed, 2.0);
            s.rotation_deg = random_point(&seed, 180.0);
            const double h = 0.5 * p->diameter * random_real(&seed, 0.05, i == COUNT(lenses) - 1 ? 0.3 : 0.9);
            const meridional_ray expected = traced_by_formula(p, h), found = traced(p, &s, h, random_real(&seed, 0, 6));
            if (isnan(expected.sin_u)) /* totally reflected */
                continue;
            assert_close(found.sin_u, expected.sin_u, 1e-12, "sin U'", i);
            assert_close(found.l, expected.l, 1e-10, "the crossing of the axis", i);
            rays++;
        }
    }
    assert_true(rays > 2000);
}

/* The limit of f(h) for h to 0, where f is even in h: Richardson's extrapolation of three heights. */
static double limit_at_axis(double f(const prescription *, double), const prescription *p)
{
    const double h = 0.016 * p->diameter, a = f(p, h), b = f(p, h / 2), c = f(p, h / 4);
    const double ab = (4.0 * b - a) / 3.0, bc = (4.0 * c - b) / 3.0;
    return (16.0 * bc - ab) / 15.0;
}

static double focal_length_at(const prescription *p, double h)
{
    return h / at_origin(p, h).tan_u;
}

static double back_focus_at(const prescription *p, double h)
{
    return at_origin(p, h).l;
}

/* Of the second principal surface: where the ray behind the lens, extended, is again at its height before it. */
static double principal_at(const prescription *p, double h)
{
    const meridional_ray r = at_origin(p, h);
    return r.l - h / r.tan_u;
}

static double curvature(double radius)
{
    return radius == 0.0 ? 0.0 : 1.0 / radius;
}

/* Hecht 6.2 to 6.4: 1 / f = (n - 1) (c1 - c2 + (n - 1) d c1 c2 / n), h1 = -f (n - 1) d c2 / n from the first vertex,
 * h2 = -f (n - 1) d c1 / n from the second; the back focal distance is f + h2. */
static void paraxial_rays_have_the_cardinal_points_of_a_thick_lens(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(lenses); i++) {
        const prescription p = lenses[i], back = reversed(p);
        const double c1 = curvature(p.radius[0]), c2 = curvature(p.radius[1]), d = p.thickness, m = p.n - 1.0;
        const double f = 1.0 / (m * (c1 - c2 + m * d * c1 * c2 / p.n)), h1 = -f * m * d * c2 / p.n,
                     h2 = -f * m * d * c1 / p.n;
        assert_close(limit_at_axis(focal_length_at, &p), f, 1e-10, "the focal length", i);
        assert_close(limit_at_axis(focal_length_at, &back), f, 1e-10, "the focal length backwards", i);
        assert_close(limit_at_axis(back_focus_at, &p), f + h2, 1e-10, "the back focal distance", i);
        assert_close(limit_at_axis(back_focus_at, &back), f - h1, 1e-10, "the front focal distance", i);
        assert_close(limit_at_axis(principal_at, &p), h2, 1e-10, "the second principal plane", i);
        assert_close(-limit_at_axis(principal_at, &back), h1, 1e-10, "the first principal plane", i);
    }
}

/* Seidel's first sum S = -sum A^2 y (u'/n' - u/n), A = n (y c + u), by the paraxial ray at height h (y' = y + d u, n'
 * u' = n u - y c (n' - n)); the third-order longitudinal aberration is -S / (2 n' u'^2). */
static double seidel_aberration(const prescription *p, double h)
{
    double y = h, u = 0.0, n = 1.0, sum = 0.0;
    for (int k = 0; k < 2; k++) {
        const double c = curvature(p->radius[k]), to = k == 0 ? p->n : 1.0, a = n * (y * c + u),
                     after = (n * u - y * c * (to - n)) / to;
        sum -= a * a * y * (after / to - u / n);
        u = after, n = to;
        y += k == 0 ? p->thickness * u : 0.0;
    }
    return -sum / (2.0 * u * u);
}

/* The exact aberration is Seidel's, up to terms of fourth order in h, against its second order: halving h divides the
 * difference by 16, and the relative difference by 4. */
static void spherical_aberration_is_seidels_to_third_order(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(lenses); i++) {
        const prescription *p = &lenses[i];
        const double focus = limit_at_axis(back_focus_at, p);
        double differs[3];
        for (int k = 0; k < 3; k++) {
            const double h = ldexp(0.08 * p->diameter, -k), exact = back_focus_at(p, h) - focus,
                         third = seidel_aberration(p, h);
            differs[k] = exact - third;
            assert_true(fabs(exact / third - 1.0) < 0.1 * pow(0.25, k));
        }
        for (int k = 0; k < 2; k++)
            if (!(fabs(differs[k] / differs[k + 1] - 16.0) < 1.0))
                fail_msg("lens %zu: the remainder falls by %g", i, differs[k] / differs[k + 1]);
    }
}

/* Marginal rays of a biconvex lens meet in front of the paraxial focus, and exactly where the formula says. */
static void marginal_rays_have_the_aberration_of_the_formula(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(lenses) - 1; i++) {
        const prescription *p = &lenses[i];
        const double h = 0.4 * p->diameter, paraxial = limit_at_axis(back_focus_at, p);
        const meridional_ray expected = traced_by_formula(p, h);
        const double aberration = back_focus_at(p, h) - paraxial;
        assert_close(aberration, expected.l - paraxial, 1e-10, "the marginal aberration", i);
        assert_true(aberration * focal_length_at(p, h) < 0.0);
    }
}

/* Hecht 5.2: a flat side and a hyperboloid with k = -n^2 have one focus for all heights, at f = R / (n - 1) behind the
 * vertex; so has an ellipsoid with k = -1 / n^2 whose second side is a sphere about that focus, n R / (n - 1) behind
 * the first vertex. */
static void conics_of_descartes_have_no_aberration(void **state)
{
    (void)state;
    const double n = 1.5;
    prescription hyperbolic = {{0.0, -0.5}, 0.4, 1.2, n}, elliptic = {{0.5, 1.1}, 0.4, 0.7, n};
    solid_shape one = shape_of_lens(&hyperbolic), two = shape_of_lens(&elliptic);
    one.conic_2 = -n * n;
    two.conic_1 = -1.0 / (n * n);
    assert_int_equal(solid_shape_check(&one, NULL), STATUS_OK);
    assert_int_equal(solid_shape_check(&two, NULL), STATUS_OK);
    for (int k = 1; k <= 19; k++) {
        const double h = 0.05 * k;
        assert_close(traced(&hyperbolic, &one, 0.6 * h, 0.3 * k).l, 1.0, 1e-12, "the focus of a hyperboloid",
                     (size_t)k);
        assert_close(traced(&elliptic, &two, 0.35 * h, 0.3 * k).l, 1.5 - 0.4, 1e-12, "the focus of an ellipsoid",
                     (size_t)k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_agree_with_the_trigonometric_trace),
        cmocka_unit_test(paraxial_rays_have_the_cardinal_points_of_a_thick_lens),
        cmocka_unit_test(spherical_aberration_is_seidels_to_third_order),
        cmocka_unit_test(marginal_rays_have_the_aberration_of_the_formula),
        cmocka_unit_test(conics_of_descartes_have_no_aberration),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
