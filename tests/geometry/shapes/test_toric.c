/* Tests of lens sides that are not round, or have odd coefficients: rays against bisection in quadruple precision,
 * normals, lenses as shapes, and closed forms of optics: cylinders, an astigmat, an axicon. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "geometry/shapes/lens_profile.h"
#include "optics/interface.h"
#include "ray_fixture.h"
#include "toric_fixture.h"
#include "whole.h"

static int walk(const scene_geometry *a, one_ray r, one_hit *hits, int most)
{
    int n = 0;
    for (one_hit h = nearest_interface(a, r); h.hit_primitive >= 0; h = nearest_interface(a, r)) {
        assert_true(n < most);
        hits[n++] = h;
        r = (one_ray){h.point, r.d, h.face, h.inside_after};
    }
    return n;
}

/* --- crossings --- */

/* The least of the distances within the rim, above side 1 and below side 2: positive inside. */
static quad depth_at(const solid_shape *s, const vec3 o, const vec3 d, quad t)
{
    const quad x = o.x + t * d.x, y = o.y + t * d.y, z = o.z + t * d.z, r = (quad)s->diameter / 2;
    const quad within = r - quad_sqrt(x * x + z * z);
    return within < 0 ? within : quad_min(within, quad_min(y - toric_height(s, 0, x, z), toric_height(s, 1, x, z) - y));
}

enum { STEPS = 500, MOST = 16 };

/* Changes of sign at equidistant points of the line within the lens's ball, each then halved to 100 bits. */
static int bisected(const solid_shape *s, vec3 o, vec3 d, double ball, quad *t)
{
    int count = 0;
    const quad middle = -(quad)vec3_dot(vec3_sub(o, vec3_make(0.0, 0.5 * s->thickness, 0.0)), d);
    quad last = middle - ball;
    bool before = depth_at(s, o, d, last) >= 0;
    for (int i = 1; i <= STEPS; i++) {
        const quad next = middle - ball + 2 * (quad)ball * i / STEPS;
        const bool here = depth_at(s, o, d, next) >= 0;
        quad a = last, b = next;
        for (int step = 0; step < 100 && here != before; step++) {
            const quad half = (a + b) / 2;
            *(((depth_at(s, o, d, half) >= 0) == before) ? &a : &b) = half;
        }
        assert_true(count < MOST);
        if (here != before)
            t[count++] = b;
        last = next, before = here;
    }
    return count;
}

/* The slopes of a side, by differences in quadruple precision. */
static void slopes_at(const solid_shape *s, int k, vec3 p, quad out[2])
{
    const quad h = (quad)1e-12 * s->diameter;
    out[0] = (toric_height(s, k, p.x + h, p.z) - toric_height(s, k, p.x - h, p.z)) / (2 * h);
    out[1] = (toric_height(s, k, p.x, p.z + h) - toric_height(s, k, p.x, p.z - h)) / (2 * h);
}

/* The distance of a local point from a face. */
static double distance_from(const solid_shape *s, vec3 p, int64_t face)
{
    quad slope[2];
    const quad rho = quad_sqrt((quad)p.x * p.x + (quad)p.z * p.z);
    if (face == 0)
        return fabs((double)(rho - (quad)s->diameter / 2));
    if (face > 2)
        return fabs((double)(p.y - toric_height(s, (int)face - 3, 0, s->diameter)));
    slopes_at(s, (int)face - 1, p, slope);
    return fabs((double)((p.y - toric_height(s, (int)face - 1, p.x, p.z)) /
                         quad_sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1])));
}

static void random_line(const solid_shape *s, uint64_t *seed, vec3 *o, vec3 *d)
{
    const double size = s->diameter, low = random_below(seed, 4) ? 1.0 : 0.2;
    const vec3 turn = random_direction(seed), to = random_point(seed, 0.5 * size * low);
    *d = vec3_normalize(vec3_make(turn.x, turn.y * low, turn.z));
    *o = vec3_sub(vec3_make(to.x, 0.5 * s->thickness + to.y * low, to.z), vec3_scale(*d, 3.0 * size));
}

/* Each change of sign is a crossing within 1e-12 of the size; crossings besides them are close pairs. */
static void crossings_of_random_lines_agree_with_bisection(void **state)
{
    (void)state;
    const int lines = trials_of(6000);
    uint64_t seed = 11;
    long crossings = 0, with[MOST] = {0}, pairs = 0, forms[3] = {0};
    double worst = 0.0, worst_point = 0.0;
    for (int i = 0; i < lines; i++) {
        solid_shape s = random_toric(&seed);
        s.position = s.rotation_deg = vec3_make(0.0, 0.0, 0.0); /* the local frame, without roundings of its own */
        forms[s.form_1]++, forms[s.form_2]++;
        scene_geometry *a = scene_geometry_of(&s, 1);
        vec3 o, d;
        random_line(&s, &seed, &o, &d);
        one_hit hits[MOST];
        const int n = walk(a, (one_ray){o, d, FACE_NONE, 0}, hits, MOST);
        quad t[MOST], passed = 0;
        const double ball = 1.5 * shape_of(&s)->extent(&s).ball + s.diameter, spacing = 2.0 * ball / STEPS;
        const int count = bisected(&s, o, d, ball, t);
        double at[MOST];
        for (int k = 0; k < n; k++) {
            const vec3 p = hits[k].point;
            passed = vec3_dot(vec3_sub(p, o), d);
            at[k] = (double)passed;
            worst_point = fmax(worst_point, distance_from(&s, p, hits[k].face % FACES_MAX) / hits[k].error);
        }
        int next = 0;
        for (int k = 0; k < count; k++, next++) {
            while (next + 1 < n && at[next] < (double)t[k] - 1e-6 * spacing && at[next + 1] - at[next] < 2.0 * spacing)
                next += 2, pairs++;
            if (next >= n)
                fail_msg("line %d: %d crossings instead of %d", i, n, count);
            /* a grazing crossing is uncertain along the ray */
            worst = fmax(worst, fabs((double)(at[next] - t[k])) * hits[next].cos_i / (s.diameter + vec3_length(o)));
        }
        while (next + 1 < n && at[next + 1] - at[next] < 2.0 * spacing)
            next += 2, pairs++;
        if (next != n)
            fail_msg("line %d: %d crossings instead of %d", i, n, count);
        crossings += n, with[n]++;
        scene_geometry_destroy(a);
    }
    print_message(
        "%d lines, %ld crossings; %ld with two, %ld with four, %ld with six; %ld pairs between the search's "
        "points; sides: %ld round, %ld biconic, %ld toric; off by at most %.2g of the size, %.3f of the bound "
        "for points\n",
        lines, crossings, with[2], with[4], with[6], pairs, forms[0], forms[1], forms[2], worst, worst_point);
    assert_true(worst < 1e-12 && worst_point <= 1.0);
    assert_true(with[2] > lines / 4 && with[4] > lines / 200 && forms[1] > lines / 6 && forms[2] > lines / 6);
}

static void normals_agree_with_differences(void **state)
{
    (void)state;
    uint64_t seed = 12;
    double worst = 0.0;
    for (int i = 0; i < 3000; i++) {
        solid_shape s = random_toric(&seed);
        s.position = s.rotation_deg = vec3_make(0.0, 0.0, 0.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        vec3 o, d;
        random_line(&s, &seed, &o, &d);
        const one_hit h = nearest_interface(a, (one_ray){o, d, FACE_NONE, 0});
        scene_geometry_destroy(a);
        const int face = (int)h.face;
        if (h.hit_primitive < 0 || face == 0 || face > 2 || hypot(h.point.x, h.point.z) < 1e-3 * s.diameter)
            continue;
        quad slope[2];
        slopes_at(&s, face - 1, h.point, slope);
        const quad length = quad_sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]), up = face == 1 ? -1 : 1;
        worst = fmax(worst, fabs((double)(h.normal.x + up * slope[0] / length)));
        worst = fmax(worst, fabs((double)(h.normal.y - up / length)));
        worst = fmax(worst, fabs((double)(h.normal.z + up * slope[1] / length)));
    }
    print_message("normals are within %.2g of differences\n", worst);
    assert_true(worst < 1e-12);
}

/* Each reflected ray starts on a face, whose own root is taken out. */
static void reflected_rays_stay_within(void **state)
{
    (void)state;
    uint64_t seed = 13;
    for (int trial = 0; trial < 200; trial++) {
        solid_shape s = random_toric(&seed);
        s.position = s.rotation_deg = vec3_make(0.0, 0.0, 0.0);
        scene_geometry *a = scene_geometry_of(&s, 1);
        one_ray r = {vec3_make(1e-3 * s.diameter, 0.5 * s.thickness, 2e-3 * s.diameter), random_direction(&seed),
                     FACE_NONE, 1};
        r.inside = solid_shape_contains(&s, r.o);
        for (int k = 0; k < 60 && r.inside; k++) {
            const one_hit h = nearest_interface(a, r);
            assert_int_equal(h.hit_primitive, 0);
            if (distance_from(&s, h.point, h.face) > h.error)
                fail_msg("trial %d, bounce %d: %.3g off face %d", trial, k, distance_from(&s, h.point, h.face),
                         (int)h.face);
            const vec3 out = vec3_sub(r.d, vec3_scale(h.normal, 2.0 * vec3_dot(r.d, h.normal)));
            r = (one_ray){h.point, vec3_normalize(out), h.face, 1};
        }
        scene_geometry_destroy(a);
    }
}

static void all_instruction_sets_find_the_same_bits(void **state)
{
    (void)state;
    uint64_t seed = 14;
    static mesh_scratch meshes;
    static ray_scratch scratch;
    static hit_batch first, other;
    scratch.meshes = &meshes;
    for (int i = 0; i < 1000; i++) {
        const solid_shape s = random_toric(&seed);
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

/* Equal radii and conic constants make a biconic side round; a sphere is a toric side, too; and r^2 is a paraboloid. */
static void round_sides_are_special_cases(void **state)
{
    (void)state;
    uint64_t seed = 15;
    for (int i = 0; i < 3000; i++) {
        solid_shape s = {.kind = SHAPE_LENS}, t;
        random_lens(&s, &seed);
        s.radius_1 = s.radius_1 == 0.0 ? s.diameter : s.radius_1;
        s.conic_1 = i % 3 == 1 ? 0.0 : i % 3 == 2 ? -1.0 : s.conic_1;
        s.thickness += s.diameter;
        t = s;
        t.form_1 = i % 3 ? SIDE_TORIC : SIDE_BICONIC, t.radius_1_x = s.radius_1, t.conic_1_x = s.conic_1;
        if (i % 3 == 2)
            t.form_1 = SIDE_ROUND, t.radius_1 = t.radius_1_x = 0.0, t.odd_1[1] = 0.5 / s.radius_1;
        if (solid_shape_check(&t, NULL) != STATUS_OK)
            continue;
        scene_geometry *a = scene_geometry_of(&s, 1), *b = scene_geometry_of(&t, 1);
        vec3 o, d;
        random_line(&s, &seed, &o, &d);
        one_hit p[MOST], q[MOST];
        const int n = walk(a, (one_ray){o, d, FACE_NONE, 0}, p, MOST);
        assert_int_equal(walk(b, (one_ray){o, d, FACE_NONE, 0}, q, MOST), n);
        for (int k = 0; k < n; k++)
            assert_true(vec3_length(vec3_sub(p[k].point, q[k].point)) <= 2.0 * p[k].error / fmin(1.0, p[k].cos_i));
        scene_geometry_destroy(a), scene_geometry_destroy(b);
    }
}

/* --- optics --- */

/* From below, parallel to the axis, at (x, z); the point and the direction behind the lens. */
static void traced(const solid_shape *s, double n, double x, double z, vec3 *at, vec3 *along)
{
    scene_geometry *a = scene_geometry_of(s, 1);
    one_ray r = {vec3_make(x, -2.0, z), vec3_make(0.0, 1.0, 0.0), FACE_NONE, 0};
    for (int k = 0; k < 2; k++) {
        const one_hit hit = nearest_interface(a, r);
        assert_int_equal(hit.face, 1 + k);
        const fresnel f = fresnel_dielectric(hit.cos_i, k == 0 ? 1.0 : n, k == 0 ? n : 1.0);
        r = (one_ray){hit.point, direction_refract(r.d, hit.normal, hit.cos_i, f.eta, f.cos_t), hit.face,
                      hit.inside_after};
    }
    scene_geometry_destroy(a);
    *at = r.o, *along = r.d;
}

/* Behind a flat side 1 and a circle of radius R towards it: the angles, by Snell's law, and where the ray crosses the
 * axis, above the vertex of side 2. */
static double circle_focus(double R, double n, double h, double *slope)
{
    const double in = asin(h / R), out = asin(n * h / R);
    *slope = tan(out - in);
    return h / *slope - (R - sqrt(R * R - h * h));
}

/* The line focus of a plano-convex cylinder, at R / (n - 1) for rays near the axis, and none along the cylinder; both
 * foci of a toric and of a biconic side, which are circles in their meridians. */
static void meridians_have_their_own_foci(void **state)
{
    (void)state;
    const double n = 1.5, R = 1.2, X = 2.5;
    solid_shape s = {.kind = SHAPE_LENS, .radius_2 = -R, .thickness = 0.4, .diameter = 1.0};
    for (int form = 0; form < 3; form++) {
        s.form_2 = form < 2 ? SIDE_TORIC : SIDE_BICONIC, s.radius_2_x = form ? -X : 0.0;
        for (int k = 1; k <= 40; k++) {
            const double h = k == 40 ? 1e-4 : 0.4 * k / 40;
            vec3 at, along;
            double slope;
            traced(&s, n, 0.0, h, &at, &along);
            const double focus = circle_focus(R, n, h, &slope);
            assert_true(along.x == 0.0 && fabs(along.z / along.y + slope) < 1e-13);
            assert_true(fabs(at.y - s.thickness - at.z * along.y / along.z - focus) < 1e-12 * focus / fmin(1.0, h));
            if (k == 40)
                assert_true(fabs(focus - R / (n - 1.0)) < 1e-7);
            traced(&s, n, h, 0.0, &at, &along);
            if (form == 0) {
                assert_true(along.x == 0.0 && along.z == 0.0 && along.y == 1.0);
                continue;
            }
            const double focus_x = circle_focus(X, n, h, &slope);
            assert_true(along.z == 0.0 && fabs(along.x / along.y + slope) < 1e-13);
            assert_true(fabs(at.y - s.thickness - at.x * along.y / along.x - focus_x) < 1e-12 * focus_x / fmin(1.0, h));
        }
    }
}

/* A cone of slope a1 behind a flat side turns all parallel rays by asin(n sin alpha) - alpha, tan(alpha) = a1. */
static void an_axicon_turns_all_rays_alike(void **state)
{
    (void)state;
    const double n = 1.5, a1 = -0.2, alpha = atan(0.2), turned = asin(n * sin(alpha)) - alpha;
    const solid_shape s = {.kind = SHAPE_LENS, .thickness = 0.4, .diameter = 1.0, .odd_2 = {a1}};
    assert_int_equal(solid_shape_check(&s, NULL), STATUS_OK);
    uint64_t seed = 16;
    for (int i = 0; i < 1000; i++) {
        const double rho = random_real(&seed, 1e-6, 0.49), angle = random_real(&seed, 0.0, 6.28);
        const double x = rho * cos(angle), z = rho * sin(angle);
        vec3 at, along;
        traced(&s, n, x, z, &at, &along);
        assert_true(fabs(along.y - cos(turned)) < 1e-14);
        assert_true(fabs(along.x + x / rho * sin(turned)) < 1e-13 && fabs(along.z + z / rho * sin(turned)) < 1e-13);
        assert_true(fabs(at.y - (0.4 + a1 * rho)) < 1e-15);
    }
}

/* --- lenses as shapes --- */

static void bounds_hold_and_drawings_are_on_the_surface(void **state)
{
    (void)state;
    uint64_t seed = 17;
    for (int trial = 0; trial < 40; trial++) {
        solid_shape s = random_toric(&seed);
        const double r = 0.5 * s.diameter, slack = 1e-9 * s.diameter;
        const shape_extent e = shape_of(&s)->extent(&s);
        const vec3 d = random_direction(&seed);
        double most = -HUGE_VAL, gap = HUGE_VAL;
        for (int i = 0; i < 2000; i++) {
            const double rho = r * sqrt(random_real(&seed, 0.0, 1.0)), angle = random_real(&seed, 0.0, 6.2831853);
            const double at = i % 2 ? rho : r, x = at * cos(angle), z = at * sin(angle);
            const double y1 = (double)toric_height(&s, 0, x, z), y2 = (double)toric_height(&s, 1, x, z);
            assert_true(y1 >= e.box.low.y - slack && y2 <= e.box.high.y + slack);
            most = fmax(most, x * d.x + z * d.z + fmax(y1 * d.y, y2 * d.y));
            gap = fmin(gap, y2 - y1);
        }
        const double farthest = shape_of(&s)->farthest(&s, d), thin = shape_of(&s)->thickness(&s);
        assert_true(farthest >= most - slack && farthest <= most + 0.05 * s.diameter);
        assert_true(thin <= gap + slack && thin >= gap - 0.05 * s.diameter);
        mesh *m = NULL;
        diagnostic why = {0};
        if (shape_of(&s)->tessellation(&s, 0, &m, &why) != STATUS_OK)
            fail_msg("%s", why.what);
        for (size_t v = 0; v < m->vertex_count; v += 7) {
            const vec3 p = m->vertices[v];
            const double y1 = (double)toric_height(&s, 0, p.x, p.z), y2 = (double)toric_height(&s, 1, p.x, p.z);
            assert_true(fmin(fabs(p.y - y1), fabs(p.y - y2)) <= slack);
        }
        mesh_release(m);
        shape_ring rings[RINGS_MAX];
        const int count = shape_rings(&s, rings);
        for (int i = 0; i < count; i++) {
            const bool between = rings[i].corners == 4;
            const double x = between ? rings[i].x * sqrt(0.5) : rings[i].x,
                         z = between ? rings[i].z * sqrt(0.5) : rings[i].z;
            if (!between && x > 0.0 && z > 0.0)
                continue; /* a circle on a round side */
            const double y1 = (double)toric_height(&s, 0, x, z), y2 = (double)toric_height(&s, 1, x, z);
            assert_true(fmin(fabs(rings[i].y - y1), fabs(rings[i].y - y2)) <= slack);
        }
    }
}

/* A plano-convex lens with a toric side of two parabolas' radii: the volume below h = z^2 / (2 R) turned about a line
 * is compared with an integral over the disc in polar coordinates. */
static void volumes_agree_with_integrals(void **state)
{
    (void)state;
    uint64_t seed = 18;
    for (int trial = 0; trial < 12; trial++) {
        solid_shape s = random_toric(&seed);
        enum { RADII = 160, ANGLES = 128 };
        double sum = 0.0, r = 0.5 * s.diameter;
        for (int i = 0; i < RADII; i++)
            for (int j = 0; j < ANGLES; j++) {
                const double rho = r * (i + 0.5) / RADII, angle = 2.0 * M_PI * (j + 0.5) / ANGLES;
                const double x = rho * cos(angle), z = rho * sin(angle);
                sum += rho * (double)(toric_height(&s, 1, x, z) - toric_height(&s, 0, x, z));
            }
        sum *= r / RADII * (2.0 * M_PI / ANGLES);
        mesh *m = NULL;
        diagnostic why = {0};
        if (shape_of(&s)->tessellation(&s, 0, &m, &why) != STATUS_OK)
            fail_msg("%s", why.what);
        double volume = 0.0;
        for (size_t t = 0; t < m->triangle_count; t++) {
            const uint32_t *c = m->triangles[t].corner;
            volume += vec3_dot(m->vertices[c[0]], vec3_cross(m->vertices[c[1]], m->vertices[c[2]])) / 6.0;
        }
        if (!(fabs(fabs(volume) - sum) < 2e-3 * sum + 1e-4 * r * r * r))
            fail_msg("trial %d: a volume of %.9g instead of %.9g", trial, volume, sum);
        mesh_release(m);
    }
}

static void refused(solid_shape s, const char *what, const char *remedy)
{
    diagnostic why = {.what = ""};
    assert_int_equal(solid_shape_check(&s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("%s; %s", why.what, why.remedy);
}

static void impossible_sides_are_refused(void **state)
{
    (void)state;
    const solid_shape plain = {.kind = SHAPE_LENS,
                               .radius_1 = 1.0,
                               .thickness = 1.0,
                               .diameter = 1.0,
                               .form_1 = SIDE_TORIC,
                               .radius_1_x = 2.0};
    assert_int_equal(solid_shape_check(&plain, NULL), STATUS_OK);
    solid_shape s = plain;
    s.diameter_1 = 0.8;
    refused(s, "side 1 is not round: its edge is not level", "set diameter_1 to 0");
    s = plain, s.form_1 = SIDE_BICONIC, s.even_1[0] = 0.1;
    refused(s, "side 1 is biconic, and has no coefficients", "set form_1 to toric");
    s = plain, s.odd_1[0] = 0.1;
    refused(s, "its curve would have a corner", "set a1_1 to 0");
    s = plain, s.radius_1_x = 0.4;
    refused(s, "diameter 1 is larger than side 1", "diameter of at most 0.79");
    s = plain, s.form_1 = SIDE_BICONIC, s.radius_1_x = 0.4;
    refused(s, "diameter 1 is larger than side 1", "diameter of at most 0.79");
    s = plain, s.radius_1_x = -2.0, s.even_1[0] = 0.1;
    refused(s, "may be crossed too often", "radius_1_x of 0");
    s = plain, s.thickness = 0.1; /* the sag is 0.134 along z */
    refused(s, "the sides cross within the rim, at 0.5 from the axis", "thickness of at least 0.133974596");
    s = plain, s.odd_1[2] = NAN;
    refused(s, "a3_1 is not finite", "finite");
    s = plain, s.radius_1_x = INFINITY, s.conic_1_x = NAN;
    refused(s, "radius_1_x or conic_1_x is not finite", "flat");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crossings_of_random_lines_agree_with_bisection),
        cmocka_unit_test(normals_agree_with_differences),
        cmocka_unit_test(reflected_rays_stay_within),
        cmocka_unit_test(all_instruction_sets_find_the_same_bits),
        cmocka_unit_test(round_sides_are_special_cases),
        cmocka_unit_test(meridians_have_their_own_foci),
        cmocka_unit_test(an_axicon_turns_all_rays_alike),
        cmocka_unit_test(bounds_hold_and_drawings_are_on_the_surface),
        cmocka_unit_test(volumes_agree_with_integrals),
        cmocka_unit_test(impossible_sides_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
