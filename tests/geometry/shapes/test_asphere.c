/* Tests of even aspheres: rays, and lenses as shapes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "asphere_lines.h"
#include "geometry/shapes/lens_profile.h"
#include "solid_reference.h"
#include "whole.h"

/* Rays and lenses with even aspheres: crossings of random lines against a dense search for changes of sign and
 * against the roots of a quartic, normals, and instruction sets. */

static void crossings_of_random_lines_agree_with_a_dense_search(void **state)
{
    (void)state;
    const int lines = trials_of(40000);
    uint64_t seed = 1;
    long forms[LENS_STEEP + 1] = {0};
    line_tally tally = {0};
    for (int i = 0; i < lines; i++) {
        const solid_shape s = random_asphere(&seed);
        double within;
        forms[lens_form_of(&s, 0, &within)]++;
        forms[lens_form_of(&s, 1, &within)]++;
        compare_line(&s, &seed, &tally);
    }
    print_tally(&tally);
    const long turning = forms[LENS_ONE_TURN] + forms[LENS_TWO_TURNS] + forms[LENS_THREE_TURNS];
    print_message("sides: %ld convex, %ld concave, %ld with one turn, %ld with two, %ld with three\n",
                  forms[LENS_CONVEX], forms[LENS_CONCAVE], forms[LENS_ONE_TURN], forms[LENS_TWO_TURNS],
                  forms[LENS_THREE_TURNS]);
    assert_true(tally.with[2] > lines / 4 && tally.with[4] > lines / 134 && tally.with[6] > lines / 8000);
    assert_true(tally.on_rings > lines / 20 && tally.on_bevels > lines / 40 && forms[LENS_CONVEX] > lines / 10 &&
                forms[LENS_CONCAVE] > lines / 10 && turning > lines / 10);
}

/* A paraboloid with a term of fourth order: along a line, y - c q / 2 - A4 q^2 is a quartic, all of whose roots
 * follow from those of its derivatives in quadruple precision, however close to each other. */
static int quartic_crossings(const solid_shape *s, vec3 o, vec3 d, quad reach, quad *t)
{
    const quad c = 1 / (quad)s->radius_1, a4 = s->even_1[0];
    const quad q0 = (quad)o.x * o.x + (quad)o.z * o.z, q1 = 2 * ((quad)o.x * d.x + (quad)o.z * d.z),
               q2 = (quad)d.x * d.x + (quad)d.z * d.z;
    const quad poly[5] = {o.y - c / 2 * q0 - a4 * q0 * q0, d.y - c / 2 * q1 - 2 * a4 * q0 * q1,
                          -c / 2 * q2 - a4 * (2 * q0 * q2 + q1 * q1), -2 * a4 * q1 * q2, -a4 * q2 * q2};
    return reference_roots(poly, 4, -reach, reach, t);
}

/* Lines that nearly touch the side, or cross it four times: the crossings are the roots within the rim. */
static void crossings_are_the_roots_of_a_quartic(void **state)
{
    (void)state;
    enum { LINES = 30000 };
    uint64_t seed = 2;
    long with[5] = {0}, close = 0;
    for (int i = 0; i < LINES; i++) {
        solid_shape s = {.kind = SHAPE_LENS, .radius_1 = random_below(&seed, 2) ? 1.0 : -1.0, .conic_1 = -1.0};
        s.diameter = random_real(&seed, 0.5, 1.6), s.thickness = 3.0;
        const double rim = 0.5 * s.diameter, sign = s.radius_1 * (random_below(&seed, 3) ? -1.0 : 1.0);
        s.even_1[0] = sign * random_real(&seed, 0.1, 0.8) / (rim * rim); /* -1 / (4 rim^2): level at the rim */
        assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
        scene_geometry *a = scene_geometry_of(&s, 1);
        /* In a plane through a point of the side, along its tangent there, up to an angle of any order. */
        const double rho = rim * random_real(&seed, 0.0, 1.0), around = random_real(&seed, 0.0, 6.3),
                     slope = rho * s.radius_1 + 4.0 * s.even_1[0] * rho * rho * rho,
                     heading = random_real(&seed, 0, 6.3),
                     tilt = (random_below(&seed, 2) ? 1.0 : -1.0) * pow(10.0, random_real(&seed, -7.0, 0.0));
        const vec3 out = vec3_make(cos(around), slope, sin(around)), across = vec3_make(-sin(around), 0.0, cos(around));
        const vec3 tangent = vec3_add(vec3_scale(out, cos(heading)), vec3_scale(across, sin(heading))),
                   d = vec3_normalize(vec3_add(tangent, vec3_make(0.0, tilt, 0.0)));
        const double lift = random_below(&seed, 2) ? 0.0 : pow(10.0, random_real(&seed, -12.0, -2.0));
        const vec3 at = vec3_make(rho * cos(around), asphere_height_near(&s, 0, rho * rho) + lift, rho * sin(around));
        const one_ray r = {vec3_sub(at, vec3_scale(d, 4.0)), d, FACE_NONE, 0};
        one_hit hits[HITS_MAX];
        const int n = walk(a, r, hits, HITS_MAX);
        quad roots[5];
        const int count = quartic_crossings(&s, r.o, r.d, 10, roots);
        int expected = 0, found = 0;
        quad gap = 1, last = -100;
        for (int k = 0; k < count; k++) {
            const quad x = r.o.x + roots[k] * r.d.x, z = r.o.z + roots[k] * r.d.z,
                       within = (quad)rim - quad_sqrt(x * x + z * z);
            if (within > 0)
                expected++, gap = quad_min(gap, roots[k] - last), last = roots[k];
            gap = quad_min(gap, quad_abs(within)); /* near the rim's edge */
        }
        for (int k = 0; k < n; k++)
            found += hits[k].face == 1;
        close += expected == found && gap < (quad)1e-5 && expected > 1;
        if (expected != found && gap > (quad)3e-7)
            fail_msg("line %d: %d crossings instead of %d, %g apart", i, found, expected, (double)gap);
        with[expected < 5 ? expected : 4]++;
        scene_geometry_destroy(a);
    }
    print_message("%d lines: %ld without, %ld with one, %ld with two, %ld with three, %ld with four; %ld close pairs "
                  "found\n",
                  LINES, with[0], with[1], with[2], with[3], with[4], close);
    assert_true(with[2] > 1000 && with[3] > 100 && with[4] > 20 && close > 100);
}

/* The normal is (-x z' / rho, 1, -z z' / rho) up to its length, with z' by central differences of the definition in
 * quadruple precision, and in closed form: for c rho / w and 4 A4 rho^3 + 6 A6 rho^5 + ... + 20 A20
 * rho^19. */
static void normals_are_those_of_the_derivative(void **state)
{
    (void)state;
    uint64_t seed = 3;
    double worst = 0.0, worst_closed = 0.0;
    for (int i = 0; i < 20000; i++) {
        solid_shape s = random_asphere(&seed);
        s.position = s.rotation_deg = vec3_make(0.0, 0.0, 0.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        const int k = random_below(&seed, 2);
        const double rho = 0.998 * side_radius(&s, k) * sqrt(random_real(&seed, 1e-6, 1.0)),
                     turn = random_real(&seed, 0, 6.3);
        const vec3 d = vec3_make(0.0, k == 0 ? 1.0 : -1.0, 0.0),
                   o = vec3_make(rho * cos(turn), k == 0 ? -3.0 * s.diameter : 9.0 * s.diameter, rho * sin(turn));
        const one_hit h = nearest_interface(a, (one_ray){o, d, FACE_NONE, 0});
        assert_int_equal(h.face, 1 + k);
        const double c = (k == 0 ? s.radius_1 : s.radius_2) == 0.0 ? 0.0 : 1.0 / (k == 0 ? s.radius_1 : s.radius_2);
        const double *even = k == 0 ? s.even_1 : s.even_2, stretch = 1.0 + (k == 0 ? s.conic_1 : s.conic_2);
        double closed = c * rho / sqrt(1.0 - stretch * c * c * rho * rho);
        for (int n = 0; n < ASPHERE_TERMS; n++)
            closed += (4.0 + 2.0 * n) * even[n] * pow(rho, 3.0 + 2.0 * n);
        const double rises[2] = {(double)asphere_rise(&s, k, rho), closed};
        for (int way = 0; way < 2; way++) {
            const vec3 n = vec3_normalize(vec3_make(-cos(turn) * rises[way], 1.0, -sin(turn) * rises[way]));
            const double off = vec3_length(vec3_sub(h.normal, k == 0 ? vec3_scale(n, -1.0) : n));
            if (way == 0)
                worst = fmax(worst, off);
            else
                worst_closed = fmax(worst_closed, off);
        }
        scene_geometry_destroy(a);
    }
    print_message("normals are within %.2g of differences, %.2g of the closed form\n", worst, worst_closed);
    assert_true(worst < 1e-13 && worst_closed < 1e-13);
}

/* Rays that reflect within a lens stay on its surface: each starts on a face, whose own root is taken out. */
static void reflected_rays_stay_within_an_asphere(void **state)
{
    (void)state;
    uint64_t seed = 4;
    long bounces = 0;
    for (int trial = 0; trial < 300; trial++) {
        solid_shape s = random_asphere(&seed);
        s.position = vec3_make(0.0, 0.0, 0.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        const mat3 turn = rotation_from_deg(s.rotation_deg);
        one_ray r = {mat3_apply(turn, vec3_make(0.0, 0.5 * s.thickness, 0.0)), random_direction(&seed), FACE_NONE, 1};
        for (int k = 0; k < 100; k++) {
            const one_hit h = nearest_interface(a, r);
            assert_int_equal(h.hit_primitive, 0);
            assert_true(distance_from_face(&s, mat3_apply_transposed(turn, h.point), h.face) <= h.error);
            const vec3 d = vec3_sub(r.d, vec3_scale(h.normal, 2.0 * vec3_dot(r.d, h.normal)));
            r = (one_ray){h.point, vec3_normalize(d), h.face, 1};
            bounces++;
        }
        scene_geometry_destroy(a);
    }
    assert_int_equal(bounces, 30000);
}

/* The first hit has the same bits with every instruction set. */
static void all_instruction_sets_find_the_same_bits(void **state)
{
    (void)state;
    uint64_t seed = 5;
    static mesh_scratch meshes;
    static ray_scratch scratch;
    static hit_batch first, other;
    scratch.meshes = &meshes;
    for (int i = 0; i < 4000; i++) {
        const solid_shape s = random_asphere(&seed);
        scene_geometry *a = scene_geometry_of(&s, 1);
        one_ray r = {.start = FACE_NONE};
        random_line(&s, &seed, &r.o, &r.d);
        r.o = vec3_add(r.o, s.position);
        const ray_batch batch = batch_of_one(&r);
        for (isa level = ISA_BASE; level <= isa_best(); level++) {
            kernels_of(level)->nearest(a, &batch, &scratch, level == ISA_BASE ? &first : &other);
            if (level != ISA_BASE)
                assert_memory_equal(&first.t[0], &other.t[0], sizeof first.t[0]);
        }
        scene_geometry_destroy(a);
    }
}

/* With coefficients of 0 the lens is the conic one: the same primitive, whose rays have a closed form. */
static void a_lens_without_coefficients_is_a_conic(void **state)
{
    (void)state;
    uint64_t seed = 8;
    solid_shape s = {.kind = SHAPE_LENS};
    random_lens(&s, &seed);
    scene_geometry *plain = scene_geometry_of(&s, 1);
    s.even_1[1] = 1e-300; /* a coefficient without effect, by the search for roots */
    scene_geometry *aspheric = scene_geometry_of(&s, 1);
    assert_true(plain->primitives[0].rule != aspheric->primitives[0].rule);
    for (int i = 0; i < 5000; i++) {
        one_ray r = {.start = FACE_NONE};
        random_line(&s, &seed, &r.o, &r.d);
        one_hit a[8], b[8];
        const int n = walk(plain, r, a, 8);
        assert_int_equal(walk(aspheric, r, b, 8), n);
        for (int k = 0; k < n; k++) {
            assert_int_equal(a[k].face, b[k].face);
            assert_true(vec3_length(vec3_sub(a[k].point, b[k].point)) <= 2.0 * a[k].error / fmin(1.0, a[k].cos_i));
        }
    }
    scene_geometry_destroy(plain);
    scene_geometry_destroy(aspheric);
}

/* Lenses with even aspheres as shapes: how their sides bend, volumes, bounds, drawings, and bad numbers. */

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

/* Along any line, the second derivative keeps its sign on a convex and on a concave side, and changes it at most n
 * times on either side of the axis where a side turns n times; most that are said to turn twice do. */
static void forms_are_those_of_second_derivatives(void **state)
{
    (void)state;
    uint64_t seed = 10;
    int count[LENS_STEEP + 1] = {0}, twice = 0;
    for (int i = 0; i < 6000; i++) {
        solid_shape s = {.kind = SHAPE_LENS, .diameter = 2.0, .thickness = 9.0};
        s.radius_1 =
            random_below(&seed, 3) ? random_real(&seed, 1.2, 4.0) * (random_below(&seed, 2) ? 1.0 : -1.0) : 0.0;
        s.conic_1 = random_real(&seed, -2.0, 0.3);
        const int orders = i % 3 ? 3 : ASPHERE_TERMS;
        for (int k = 0; k < orders; k++)
            s.even_1[k] = random_below(&seed, 3) ? random_real(&seed, -0.4, 0.4) : 0.0;
        double within;
        const lens_form form = lens_form_of(&s, 0, &within);
        bool up, down;
        const int turns = turns_along_lines(&s, &up, &down);
        count[form]++;
        assert_true(form != LENS_CONVEX || !down);
        assert_true(form != LENS_CONCAVE || !up);
        assert_true(form < LENS_ONE_TURN || form > LENS_THREE_TURNS || turns <= (int)form - LENS_CONCAVE);
        assert_true(form >= LENS_TURNS || within == 1.0);
        twice += form == LENS_TWO_TURNS && turns == 2;
    }
    print_message(
        "%d convex, %d concave, %d with a turn, %d with two, %d of which have two, %d with three, %d refused\n",
        count[LENS_CONVEX], count[LENS_CONCAVE], count[LENS_ONE_TURN], count[LENS_TWO_TURNS], twice,
        count[LENS_THREE_TURNS], count[LENS_TURNS]);
    assert_true(count[LENS_CONVEX] > 500 && count[LENS_CONCAVE] > 500 && count[LENS_ONE_TURN] > 500);
    assert_true(twice > count[LENS_TWO_TURNS] / 2 && count[LENS_TWO_TURNS] > 100);
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

static void expect_refused(solid_shape s, const char *what, const char *remedy)
{
    diagnostic why = {.what = ""};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("'%s; %s' does not contain '%s' and '%s'", why.what, why.remedy, what, remedy);
}

/* A side of its own diameter: a spherical cap of height h and radius a has the volume pi h (3 a^2 + h^2) / 6, and what
 * is beyond it is level. The outer side of this fisheye's first element is 60 wide, its inner one half a ball of
 * diameter 30. */
static void a_hemisphere_within_a_wider_rim(void **state)
{
    (void)state;
    const double pi = acos(-1.0);
    const solid_shape s = {.kind = SHAPE_LENS,
                           .radius_1 = 50.0,
                           .radius_2 = 15.0,
                           .thickness = 3.0,
                           .diameter = 62.0,
                           .diameter_1 = 60.0,
                           .diameter_2 = 30.0};
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    solid_shape whole = s;
    whole.diameter_2 = 0.0;
    expect_refused(whole, "diameter 62 is larger than side 2, which ends at a diameter of 30",
                   "a diameter_2 of at most 30");
    const double sag = 50.0 - 40.0, bowl = pi * sag * (3.0 * 900.0 + sag * sag) / 6.0,
                 half_ball = 2.0 / 3.0 * pi * 3375.0;
    /* From the vertex of side 1 to the ring of side 2, at 18: the cylinder, without what is below side 1 or its ring,
     * and without the hemisphere. Below side 1: the cylinder up to its ring at 10, less the bowl. */
    const double volume = pi * 961.0 * 18.0 - (pi * 961.0 * sag - bowl) - half_ball;
    scene_geometry *a = scene_geometry_of(&s, 1);
    const bounds3 box = shape_world_box(&s);
    assert_true(fabs(box.high.y - 18.0) < 1e-12 && fabs(box.low.y) < 1e-12 && fabs(box.high.x - 31.0) < 1e-12);
    enum { COLUMNS = 400 };
    double sum = 0.0;
    for (int i = 0; i < COLUMNS; i++)
        for (int k = 0; k < COLUMNS; k++) {
            const vec3 o = {31.0 * (2.0 * (i + 0.5) / COLUMNS - 1.0), -5.0, 31.0 * (2.0 * (k + 0.5) / COLUMNS - 1.0)};
            one_hit hits[HITS_MAX];
            const int n = walk(a, (one_ray){o, {0.0, 1.0, 0.0}, FACE_NONE, 0}, hits, 8);
            for (int j = 1; j < n; j += 2)
                sum += hits[j].t;
        }
    sum *= 62.0 / COLUMNS * 62.0 / COLUMNS;
    assert_true(fabs(sum / volume - 1.0) < 1e-3);
    scene_geometry_destroy(a);
}

/* Each point of the four zones along a diameter is on the face of its zone. */
static void rings_are_faces_of_their_own(void **state)
{
    (void)state;
    const solid_shape s = {.kind = SHAPE_LENS,
                           .radius_1 = 3.0,
                           .radius_2 = -4.0,
                           .thickness = 1.0,
                           .diameter = 2.0,
                           .diameter_1 = 1.0,
                           .diameter_2 = 1.6};
    scene_geometry *a = scene_geometry_of(&s, 1);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 100; i++) {
            const double x = 0.0099 * i + 1e-6;
            const one_ray r = {{x, k == 0 ? -9.0 : 9.0, 0.0}, {0.0, k == 0 ? 1.0 : -1.0, 0.0}, FACE_NONE, 0};
            const one_hit h = nearest_interface(a, r);
            const bool ring = x > (k == 0 ? 0.5 : 0.8);
            assert_int_equal(h.face, 1 + k + 2 * ring);
            assert_true(!ring || h.normal.y == (k == 0 ? -1.0 : 1.0));
        }
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
            for (int k = 0; k < 2; k++) {
                const double rho = bevel_radius(&s, k) * i / 4000;
                most = fmax(most, hypot(d.x, d.z) * rho + d.y * asphere_height_near(&s, k, rho * rho));
            }
        }
        for (int k = 0; k < 2; k++) { /* the rim's edges */
            const double end = bevel_radius(&s, k), rim = 0.5 * s.diameter, up = k == 0 ? rim - end : end - rim;
            most = fmax(most, hypot(d.x, d.z) * rim + d.y * (asphere_height_near(&s, k, end * end) + up));
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
            const double rim = fabs(rings[i].x - 0.5 * s.diameter);
            assert_true(fmin(rim, fmin(one, two)) < 1e-12 * s.diameter &&
                        rings[i].x <= 0.5 * s.diameter * (1.0 + 1e-15));
        }
    }
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
    expect_refused(s, "a8_2 is not finite", "finite");
    s.even_2[2] = 0.0, s.even_2[8] = NAN;
    expect_refused(s, "a20_2 is not finite", "finite");
    s = flat;
    s.even_1[0] = -5.0; /* a slope of 20 at the rim */
    expect_refused(s, "side 1 is too steep", "a diameter of at most 1.8");
    s.even_1[0] = -1e9;
    expect_refused(s, "side 1 is too steep", "use a smaller diameter, or smaller coefficients of side 1");
    s = flat;
    s.even_1[0] = 1.0, s.even_1[1] = -2.5, s.even_1[2] = 1.5; /* it bends up, down and up */
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    s = flat;
    s.diameter_2 = 2.5;
    expect_refused(s, "diameter_2 2.5 is larger than the diameter 2", "a diameter of at least 2.5");
    s.diameter_2 = 0.0, s.diameter_1 = -1.0;
    expect_refused(s, "diameter_1 is -1", "from 0");
    s = flat; /* a turn in side 1, and a hollow side 2 */
    s.radius_1 = 4.0, s.even_1[0] = -0.2, s.radius_2 = 4.0;
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
        cmocka_unit_test(crossings_of_random_lines_agree_with_a_dense_search),
        cmocka_unit_test(crossings_are_the_roots_of_a_quartic),
        cmocka_unit_test(normals_are_those_of_the_derivative),
        cmocka_unit_test(reflected_rays_stay_within_an_asphere),
        cmocka_unit_test(all_instruction_sets_find_the_same_bits),
        cmocka_unit_test(a_lens_without_coefficients_is_a_conic),
        cmocka_unit_test(forms_are_those_of_second_derivatives),
        cmocka_unit_test(the_volume_is_that_of_the_polynomials),
        cmocka_unit_test(bounds_are_tight),
        cmocka_unit_test(a_hemisphere_within_a_wider_rim),
        cmocka_unit_test(rings_are_faces_of_their_own),
        cmocka_unit_test(drawings_are_on_the_surface),
        cmocka_unit_test(impossible_aspheres_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
