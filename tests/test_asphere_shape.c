/* Tests of lenses with even aspheres as shapes: how their sides bend, volumes, bounds, drawings, and bad numbers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "asphere_fixture.h"
#include "geometry/shapes/lens_profile.h"
#include "ray_fixture.h"

/* The largest number of changes of sign of the height's second difference along lines at eight distances from the axis,
 * outwards from the point nearest to it, and whether it is ever positive or negative. */
static int turns_along_lines(const solid_shape *s, bool *up, bool *down)
{
    enum { STEPS = 200 };
    const double rim = 0.5 * s->diameter, h = 1e-3 * rim, zero = 1e-6 / rim;
    int most = 0;
    *up = *down = false;
    for (int k = 0; k < 8; k++) {
        const double b = rim * k / 8, reach = sqrt(rim * rim - b * b) - h;
        int turns = 0, last = 0;
        for (int i = 0; i <= STEPS; i++) {
            const double t = reach * i / STEPS, at = b * b + t * t;
            const double second =
                (asphere_height_near(s, 0, at + h * (h + 2.0 * t)) - 2.0 * asphere_height_near(s, 0, at) +
                 asphere_height_near(s, 0, at + h * (h - 2.0 * t))) /
                (h * h);
            const int sign = second > zero ? 1 : second < -zero ? -1 : 0;
            turns += sign * last < 0;
            last = sign ? sign : last;
            *up |= sign > 0, *down |= sign < 0;
        }
        most = turns > most ? turns : most;
    }
    return most;
}

/* Along any line, the second derivative keeps its sign on a convex and on a concave side, and changes it at most once
 * on either side of the axis where a side turns; of those refused for more turns, most have them. */
static void forms_are_those_of_second_derivatives(void **state)
{
    (void)state;
    uint64_t seed = 10;
    int count[LENS_STEEP + 1] = {0}, with_turns = 0;
    for (int i = 0; i < 6000; i++) {
        solid_shape s = {.kind = SHAPE_LENS, .diameter = 2.0, .thickness = 9.0};
        s.radius_1 =
            random_below(&seed, 3) ? random_real(&seed, 1.2, 4.0) * (random_below(&seed, 2) ? 1.0 : -1.0) : 0.0;
        s.conic_1 = random_real(&seed, -2.0, 0.3);
        for (int k = 0; k < 3; k++)
            s.even_1[k] = random_below(&seed, 3) ? random_real(&seed, -0.4, 0.4) : 0.0;
        double within;
        const lens_form form = lens_form_of(&s, 0, &within);
        bool up, down;
        const int turns = turns_along_lines(&s, &up, &down);
        count[form]++;
        assert_true(form != LENS_CONVEX || !down);
        assert_true(form != LENS_CONCAVE || !up);
        assert_true(form != LENS_ONE_TURN || turns <= 1);
        assert_true(form >= LENS_TURNS || within == 1.0);
        with_turns += form == LENS_TURNS && turns > 1;
    }
    print_message("%d convex, %d concave, %d with a turn, %d with more, of which %d have more\n", count[LENS_CONVEX],
                  count[LENS_CONCAVE], count[LENS_ONE_TURN], count[LENS_TURNS], with_turns);
    assert_true(count[LENS_CONVEX] > 500 && count[LENS_CONCAVE] > 500 && count[LENS_ONE_TURN] > 500);
    assert_true(with_turns > count[LENS_TURNS] / 2);
}

/* The volume between the sides is the integral of 2 pi rho times their distance: pi R^2 d + pi (p(R^2)) of the
 * polynomial's integral q^3 A4 / 3 + q^4 A6 / 4 + q^5 A8 / 5, here of a lens without conics. */
static void the_volume_is_that_of_the_polynomials(void **state)
{
    (void)state;
    enum { POINTS = 200000 };
    const double pi = acos(-1.0), rim = 0.6, q = rim * rim;
    solid_shape s = {.kind = SHAPE_LENS,
                     .thickness = 0.5,
                     .diameter = 2.0 * rim,
                     .position = {0.1, -0.2, 0.3},
                     .rotation_deg = {20.0, 40.0, 60.0},
                     .even_1 = {0.8, -0.4, 0.9},
                     .even_2 = {-0.5, -0.6, 0.3}};
    double volume = pi * q * s.thickness;
    for (int i = 0; i < 3; i++)
        volume += pi * pow(q, 3.0 + i) * (s.even_2[i] - s.even_1[i]) / (3.0 + i);
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    scene_geometry *a = scene_geometry_of(&s, 1);
    const bounds3 box = shape_world_box(&s);
    const vec3 size = vec3_sub(box.high, box.low);
    uint64_t seed = 6;
    int inside = 0;
    for (int k = 0; k < POINTS; k++) {
        const vec3 p = {box.low.x + size.x * random_real(&seed, 0.0, 1.0),
                        box.low.y + size.y * random_real(&seed, 0.0, 1.0),
                        box.low.z + size.z * random_real(&seed, 0.0, 1.0)};
        const bool in = scene_geometry_inside(a, p) == 1;
        assert_int_equal(in, solid_shape_contains(&s, p));
        inside += in;
    }
    const double share = volume / (size.x * size.y * size.z);
    assert_true(fabs((double)inside / POINTS - share) < 4.0 * sqrt(share * (1.0 - share) / POINTS));
    scene_geometry_destroy(a);
}

/* The box in the world contains a dense set of the lens's points, and is the smallest one that does. */
static void bounds_are_tight(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int trial = 0; trial < 400; trial++) {
        solid_shape s = random_asphere(&seed);
        const vec3 d = random_direction(&seed);
        double most = -HUGE_VAL;
        for (int i = 0; i <= 4000; i++) {
            const double rho = 0.5 * s.diameter * i / 4000;
            for (int k = 0; k < 2; k++)
                most = fmax(most, hypot(d.x, d.z) * rho + d.y * asphere_height_near(&s, k, rho * rho));
        }
        const double farthest = shape_of(&s)->farthest(&s, d);
        assert_true(farthest >= most - 1e-12 * s.diameter && farthest <= most + 1e-5 * s.diameter);
        const bounds3 box = shape_of(&s)->extent(&s).box;
        assert_true(box.low.y <= 0.0 && box.high.y >= s.thickness);
    }
}

/* Corners of the triangles, and circles of the outline, are on the faces. */
static void drawings_are_on_the_surface(void **state)
{
    (void)state;
    uint64_t seed = 9;
    for (int trial = 0; trial < 100; trial++) {
        const solid_shape s = random_asphere(&seed);
        mesh *triangles = NULL;
        assert_int_equal(shape_of(&s)->tessellation(&s, 0, &triangles, NULL), STATUS_OK);
        for (size_t i = 0; i < triangles->vertex_count; i += 97) {
            const vec3 p = triangles->vertices[i];
            const double rho = hypot(p.x, p.z), rim = fabs(rho - 0.5 * s.diameter);
            const double one = fabs(p.y - asphere_height_near(&s, 0, rho * rho)),
                         two = fabs(p.y - asphere_height_near(&s, 1, rho * rho));
            assert_true(fmin(rim, fmin(one, two)) < 1e-12 * s.diameter);
        }
        mesh_release(triangles);
        shape_ring rings[RINGS_MAX];
        const int count = shape_of(&s)->rings(&s, rings);
        assert_true(count >= 14 && count <= RINGS_MAX);
        for (int i = 0; i < count; i++) {
            const double q = rings[i].x * rings[i].x, one = fabs(rings[i].y - asphere_height_near(&s, 0, q)),
                         two = fabs(rings[i].y - asphere_height_near(&s, 1, q));
            assert_true(fmin(one, two) < 1e-12 * s.diameter && rings[i].x <= 0.5 * s.diameter * (1.0 + 1e-15));
        }
    }
}

static void expect_refused(solid_shape s, const char *what, const char *remedy)
{
    diagnostic why = {.what = ""};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("'%s; %s' does not contain '%s' and '%s'", why.what, why.remedy, what, remedy);
}

static void impossible_aspheres_are_refused(void **state)
{
    (void)state;
    const solid_shape flat = {.kind = SHAPE_LENS, .thickness = 0.5, .diameter = 2.0};
    solid_shape s = flat;
    s.even_1[0] = 0.6; /* 0.6 rho^4 reaches side 2 */
    expect_refused(s, "cross within the rim, at 1 from the axis", "at least 0.6");
    s.thickness = 0.6;
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    s = flat; /* rho^2 - 0.625 rho^4 has its maximum, 0.4, at sqrt(0.8) */
    s.radius_1 = 0.5, s.conic_1 = -1.0, s.even_1[0] = -0.625, s.thickness = 0.38;
    expect_refused(s, "cross within the rim, at 0.89442", "a thickness of at least 0.4,");
    s = flat;
    s.even_2[2] = HUGE_VAL;
    expect_refused(s, "a4_2, a6_2 or a8_2 is not finite", "finite");
    s = flat;
    s.even_1[0] = -5.0; /* a slope of 20 at the rim */
    expect_refused(s, "side 1 is too steep", "a diameter of at most 1.8");
    s = flat;
    s.even_1[0] = 1.0, s.even_1[1] = -2.5, s.even_1[2] = 1.5; /* it bends up, down and up */
    expect_refused(s, "side 1 turns more than once", "a6_1 and a8_1");
    s = flat; /* a turn in side 1, and a hollow side 2 */
    s.radius_1 = 4.0, s.even_1[0] = -0.2, s.radius_2 = 4.0;
    expect_refused(s, "side 1 turns and side 2 is not convex", "make side 2 flat or convex");
    s.radius_2 = -4.0;
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    s = flat; /* a hemisphere has an infinite slope at its rim */
    s.thickness = 2.0, s.radius_1 = 1.0;
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    s.even_1[0] = 0.01;
    expect_refused(s, "diameter 2 is larger than side 1, which with coefficients ends at a diameter of 1.98",
                   "at most 1.98");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forms_are_those_of_second_derivatives),
        cmocka_unit_test(the_volume_is_that_of_the_polynomials),
        cmocka_unit_test(bounds_are_tight),
        cmocka_unit_test(drawings_are_on_the_surface),
        cmocka_unit_test(impossible_aspheres_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
