/* Tests of the edges of lenses, and of lenses both of whose sides turn between convex and concave, as those of phone
 * cameras do: crossings against a dense search, volumes and rays of bevels in closed form, and bad numbers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "asphere_lines.h"
#include "geometry/shapes/lens_profile.h"

static void expect_refused(solid_shape s, const char *what, const char *remedy)
{
    diagnostic why = {.what = ""};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("'%s; %s' does not contain '%s' and '%s'", why.what, why.remedy, what, remedy);
}

static bool turns(const solid_shape *s, int k)
{
    double within;
    const lens_form form = lens_form_of(s, k, &within);
    return form >= LENS_ONE_TURN && form <= LENS_THREE_TURNS;
}

/* Two wavy sides at nearly the same height everywhere, so that lines at low angles cross them often. */
static solid_shape random_gull_wings(uint64_t *seed)
{
    for (;;) {
        solid_shape s = {.kind = SHAPE_LENS, .diameter = 2.0, .thickness = 3.0};
        const double share = random_real(seed, 0.0, 1.0);
        for (int i = 0; i < 6; i++) {
            const double term = random_real(seed, -1.0, 1.0) * (1.0 + i);
            s.even_1[i] = term, s.even_2[i] = share * term + (1.0 - share) * random_real(seed, -1.0, 1.0) * (1.0 + i);
        }
        s.radius_1 = random_real(seed, 1.0, 4.0) * (random_below(seed, 2) ? 1.0 : -1.0);
        s.radius_2 = random_below(seed, 2) ? s.radius_1 : -s.radius_1;
        s.conic_1 = s.conic_2 = random_real(seed, -3.0, 0.0);
        for (int k = 0; k < 2; k++) {
            if (!random_below(seed, 4))
                *(k == 0 ? &s.diameter_1 : &s.diameter_2) = random_real(seed, 1.2, 2.0);
            if (!random_below(seed, 4))
                *(k == 0 ? &s.chamfer_1 : &s.chamfer_2) = random_real(seed, 0.0, 0.1);
        }
        s.thickness = random_real(seed, 0.01, 0.1) + 3.0;
        if (solid_shape_check(&s, NULL) != STATUS_OK || !turns(&s, 0) || !turns(&s, 1))
            continue;
        s.thickness -= 0.98 * shape_of(&s)->thickness(&s);
        s.position = random_point(seed, 10.0);
        if (random_below(seed, 2))
            s.rotation_deg = random_point(seed, 180.0);
        return s;
    }
}

static void both_sides_may_turn(void **state)
{
    (void)state;
    uint64_t seed = 21;
    line_tally tally = {0};
    const int lenses = trials_of(400);
    for (int i = 0; i < lenses; i++) {
        const solid_shape s = random_gull_wings(&seed);
        for (int k = 0; k < 50; k++)
            compare_line(&s, &seed, &tally);
    }
    print_tally(&tally);
    assert_true(tally.with[6] > tally.lines / 400 && tally.with[8] > 0);
}

/* Ripples along one diameter: a level line through the middle of a thin lens with two turns on each side crosses both
 * sides twelve times, also when it is scaled, and in a tree of solids. */
static void a_level_line_crosses_ripples(void **state)
{
    (void)state;
    solid_shape s = {.kind = SHAPE_LENS, .diameter = 2.0, .thickness = 0.02};
    s.radius_1 = s.radius_2 = 0.4, s.conic_1 = s.conic_2 = -1.0;
    s.even_1[0] = s.even_2[0] = -4.6, s.even_1[1] = s.even_2[1] = 3.6;
    double within;
    assert_int_equal(lens_form_of(&s, 0, &within), LENS_TWO_TURNS);
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    for (int trial = 0; trial < 4; trial++) {
        solid_shape placed = s;
        placed.scale = vec3_make(1.0, 1.0, trial % 2 ? 0.5 : 1.0);
        const region_source source = {.shape = &placed, .priority = 1, .medium = 1, .shadow_transmittance = 1.0};
        scene_geometry *a = NULL;
        assert_int_equal(scene_geometry_build(&source, 1, 0, trial < 2 ? TREE_IF_MANY : TREE_ALWAYS, &a, NULL),
                         STATUS_OK);
        const double y = 0.022;
        const one_ray r = {{-5.0, y, 0.0}, {1.0, 0.0, 0.0}, FACE_NONE, 0};
        one_hit hits[HITS_MAX];
        const int n = walk(a, r, hits, HITS_MAX);
        const dense_crossings dense = dense_search(&s, r.o, r.d, 3.0);
        assert_int_equal(n, dense.count);
        double passed = 0.0;
        for (int k = 0; k < n; k++) {
            passed += hits[k].t;
            assert_true(fabs(passed - dense.t[k]) < 1e-12);
        }
        if (trial == 0)
            print_message("a level line crosses the ripples %d times\n", n);
        assert_int_equal(n, 12);
        scene_geometry_destroy(a);
    }
}

/* Chords along the axis, of many columns: their sum is the volume. */
static double volume_by_columns(const solid_shape *s)
{
    enum { COLUMNS = 400 };
    scene_geometry *a = scene_geometry_of(s, 1);
    const double rim = 0.5 * s->diameter, step = s->diameter / COLUMNS;
    double sum = 0.0;
    for (int i = 0; i < COLUMNS; i++)
        for (int k = 0; k < COLUMNS; k++) {
            const vec3 o = {(i + 0.5) * step - rim, -5.0 * rim, (k + 0.5) * step - rim};
            one_hit hits[HITS_MAX];
            const int n = walk(a, (one_ray){o, {0.0, 1.0, 0.0}, FACE_NONE, 0}, hits, HITS_MAX);
            for (int j = 1; j < n; j += 2)
                sum += hits[j].t;
        }
    scene_geometry_destroy(a);
    return sum * step * step;
}

/* A plate of thickness t and radius R loses, by a bevel of length c, the integral of 2 pi r (r - R + c) from R - c to
 * R, pi c^2 (R - c / 3). A biconvex lens of spheres of radius S has below side 1, up to the radius r, the volume 2 pi
 * (S r^2 / 2 + ((S^2 - r^2)^(3/2) - S^3) / 3), and its bevel is the ring between the cone and the sphere. */
static void volumes_of_bevelled_lenses(void **state)
{
    (void)state;
    const double pi = acos(-1.0), R = 1.0, t = 0.6, c = 0.25, b = 0.1;
    const solid_shape plate = {.kind = SHAPE_LENS, .thickness = t, .diameter = 2.0 * R, .chamfer_1 = c, .chamfer_2 = b};
    assert_int_equal(solid_shape_check(&plate, NULL), STATUS_OK);
    const double whole = pi * R * R * t - pi * c * c * (R - c / 3.0) - pi * b * b * (R - b / 3.0);
    assert_true(fabs(volume_by_columns(&plate) / whole - 1.0) < 1e-4);

    const double S = 2.0, thick = 1.0, end = R - c;
    const solid_shape lens = {
        .kind = SHAPE_LENS, .radius_1 = S, .radius_2 = -S, .thickness = thick, .diameter = 2.0 * R, .chamfer_1 = c};
    assert_int_equal(solid_shape_check(&lens, NULL), STATUS_OK);
    const double below[2] = {2.0 * pi * (0.5 * S * end * end + (pow(S * S - end * end, 1.5) - S * S * S) / 3.0),
                             2.0 * pi * (0.5 * S * R * R + (pow(S * S - R * R, 1.5) - S * S * S) / 3.0)};
    const double sag = S - sqrt(S * S - end * end);
    /* from the axis to the bevel below the sphere; then below the cone, sag + r - end */
    const double under =
        below[0] + pi * (R * R - end * end) * (sag - end) + 2.0 * pi / 3.0 * (R * R * R - end * end * end);
    const double expected = pi * R * R * thick - below[1] - under;
    assert_true(fabs(volume_by_columns(&lens) / expected - 1.0) < 1e-4);
    uint64_t seed = 5;
    scene_geometry *a = scene_geometry_of(&lens, 1);
    for (int i = 0; i < 20000; i++) {
        const vec3 p = vec3_add(random_point(&seed, 1.1), vec3_make(0.0, 0.5 * thick, 0.0));
        const double rho = hypot(p.x, p.z), from_1 = p.y - (S - sqrt(fmax(0.0, S * S - rho * rho))),
                     from_2 = thick - (S - sqrt(fmax(0.0, S * S - rho * rho))) - p.y;
        const bool in = rho <= R && from_1 >= 0.0 && from_2 >= 0.0 && rho <= end + p.y - sag;
        assert_int_equal(solid_shape_contains(&lens, p), in);
        assert_int_equal(scene_geometry_inside(a, p) == 1, in);
    }
    scene_geometry_destroy(a);
}

/* Rays along the axis and level ones meet a bevel at 45 degrees, at the height of the edge plus what is beyond its
 * beginning; and after they have started on it, the far side. */
static void rays_meet_bevels_at_45_degrees(void **state)
{
    (void)state;
    uint64_t seed = 7;
    const double half = sqrt(0.5);
    for (int i = 0; i < 2000; i++) {
        solid_shape s = {.kind = SHAPE_LENS, .diameter = 2.0, .thickness = 0.8};
        const int k = random_below(&seed, 2), ring = random_below(&seed, 2);
        const double c = random_real(&seed, 0.02, 0.2), end = 1.0 - c, radius = random_real(&seed, 3.0, 9.0);
        s.radius_1 = radius * (random_below(&seed, 2) ? 1.0 : -1.0), s.radius_2 = -s.radius_1;
        *(k == 0 ? &s.chamfer_1 : &s.chamfer_2) = c;
        *(k == 0 ? &s.diameter_1 : &s.diameter_2) = ring ? 2.0 * end * random_real(&seed, 0.5, 1.0) : 0.0;
        assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
        const double edge = (double)asphere_height(&s, k, (quad)end * end), up = k == 0 ? 1.0 : -1.0;
        const double rho = end + c * random_real(&seed, 0.01, 0.99), turn = random_real(&seed, 0.0, 6.3);
        const vec3 at = vec3_make(rho * cos(turn), edge + up * (rho - end), rho * sin(turn)),
                   out = vec3_make(cos(turn), 0.0, sin(turn));
        scene_geometry *a = scene_geometry_of(&s, 1);
        const one_ray along = {vec3_make(at.x, at.y - 4.0 * up, at.z), {0.0, up, 0.0}, FACE_NONE, 0};
        const one_ray level = {vec3_add(at, vec3_scale(out, 4.0)), vec3_scale(out, -1.0), FACE_NONE, 0};
        for (int way = 0; way < 2; way++) {
            const one_hit h = nearest_interface(a, way == 0 ? along : level);
            assert_int_equal(h.face, 5 + k);
            assert_true(fabs(h.t - 4.0) < 1e-14 && vec3_length(vec3_sub(h.point, at)) < 1e-14);
            const vec3 n = vec3_make(half * out.x, -half * up, half * out.z);
            assert_true(vec3_length(vec3_sub(h.normal, n)) < 1e-15 && fabs(h.cos_i - half) < 1e-15);
            const one_hit far = nearest_interface(a, (one_ray){h.point, way == 0 ? along.d : level.d, h.face, 1});
            /* Along the axis to the other side; level, to the same height on the bevel or the rim opposite. */
            const double other = (double)asphere_height(&s, 1 - k, (quad)rho * rho);
            if (way == 0)
                assert_true(fabs(far.t - fabs(other - at.y)) < 1e-14);
            else if (far.face == 5 + k)
                assert_true(fabs(far.t - 2.0 * rho) < 1e-14);
        }
        scene_geometry_destroy(a);
    }
}

static void impossible_chamfers_are_refused(void **state)
{
    (void)state;
    const solid_shape plate = {.kind = SHAPE_LENS, .thickness = 0.5, .diameter = 2.0};
    solid_shape s = plate;
    s.chamfer_1 = -0.1;
    expect_refused(s, "chamfer_1 is -0.1", "from 0");
    s.chamfer_1 = NAN;
    expect_refused(s, "chamfer_1 is", "from 0");
    s.chamfer_1 = 1.0;
    expect_refused(s, "chamfer_1 1 reaches the axis", "below 1");
    s.chamfer_1 = 0.3, s.chamfer_2 = 0.25;
    expect_refused(s, "chamfer_1 0.3 and chamfer_2 0.25 are longer than the edge", "0.05 shorter");
    s.chamfer_2 = 0.2; /* they meet in a sharp edge */
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    s.diameter_1 = 1.5;
    expect_refused(s, "chamfer_1 0.3 reaches into the diameter 1.5 of side 1", "at most 0.25");
    s.chamfer_1 = 0.25;
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    s = plate;
    s.radius_1 = 1.0, s.thickness = 2.0, s.chamfer_1 = 0.1; /* a hemisphere */
    expect_refused(s, "side 1 is steeper than 45 degrees at its chamfer", "another chamfer_1");
    s = plate; /* side 2 dips into the bevel of side 1, which ends below its edge */
    s.thickness = 0.5, s.radius_2 = -0.8, s.conic_2 = -1.0, s.even_2[0] = 0.625, s.chamfer_1 = 0.5;
    expect_refused(s, "are longer than the edge", "shorter in sum");
    s = plate;
    s.radius_1 = 1.0, s.thickness = 2.0, s.chamfer_1 = 0.1, s.diameter_1 = 1.4;
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_sides_may_turn),
        cmocka_unit_test(a_level_line_crosses_ripples),
        cmocka_unit_test(volumes_of_bevelled_lenses),
        cmocka_unit_test(rays_meet_bevels_at_45_degrees),
        cmocka_unit_test(impossible_chamfers_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
