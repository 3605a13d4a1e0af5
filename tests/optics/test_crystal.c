/* Double refraction at an interface against closed forms: Born and Wolf, Principles of Optics, 7th ed., 15.2 and 15.3;
 * Hecht, Optics, 8.4 (calcite: n_o = 1.6584, n_e = 1.4864 for sodium light). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "optics/crystal.h"
#include "random_stream.h"

#define assert_near(a, b, tolerance)                      \
    do {                                                  \
        if (!(fabs((a) - (b)) <= (tolerance)))            \
            fail_msg("%.17g instead of %.17g", (a), (b)); \
    } while (0)
#define assert_same_direction(a, b, tolerance) assert_near(vec3_length(vec3_sub(a, b)), 0.0, tolerance)

static const double degree = 3.14159265358979323846 / 180.0, n_o = 1.6584, n_e = 1.4864;
static const optical_medium air = {.n_o = 1.0};

static optical_medium calcite(vec3 axis)
{
    return (optical_medium){.uniaxial = true, .n_o = n_o, .n_e = n_e, .axis = vec3_normalize(axis)};
}

/* A ray from air into a medium whose surface faces -z, at that angle in the x-z plane. */
static crystal_incidence at_angle(double angle_deg, optical_medium to)
{
    return (crystal_incidence){.from = air,
                               .to = to,
                               .d = vec3_make(sin(angle_deg * degree), 0.0, cos(angle_deg * degree)),
                               .n = vec3_make(0.0, 0.0, -1.0)};
}

static stokes random_row(uint64_t *seed)
{
    stokes s = {.i = 1.0};
    s.q = random_real(seed, -0.5, 0.5);
    s.u = random_real(seed, -0.5, 0.5);
    s.v = random_real(seed, -0.5, 0.5);
    return s;
}

static const stokes unpolarised = {1.0, 0.0, 0.0, 0.0};

static crystal_ray ray_of(const crystal_incidence *in, stokes row, bool reflected, crystal_mode mode)
{
    crystal_ray out[CRYSTAL_RAYS_MAX];
    const int count = crystal_split(in, row, out);
    for (int i = 0; i < count; i++)
        if (out[i].reflected == reflected && out[i].mode == mode)
            return out[i];
    fail_msg("no such ray");
    return out[0];
}

static double square(double x)
{
    return x * x;
}

/* The energy's angle to the axis has n_o^2 / n_e^2 times the tangent of the wave's: Born and Wolf, 15.3.3. */
static void energy_walks_off_at_6_degrees(void **state)
{
    (void)state;
    crystal_incidence in = at_angle(0.0, calcite(vec3_make(1.0, 0.0, 1.0)));
    const vec3 o = ray_of(&in, unpolarised, false, MODE_ORDINARY).d,
               e = ray_of(&in, unpolarised, false, MODE_EXTRAORDINARY).d;
    const double ratio = square(n_o / n_e), tangent = (ratio - 1.0) / (1.0 + ratio);
    assert_near(tangent, tan(6.224 * degree), 1e-5);
    assert_same_direction(o, vec3_make(0.0, 0.0, 1.0), 1e-15);
    assert_near(e.x / e.z, -tangent, 1e-14); /* away from the axis of a negative crystal */
    assert_near(e.y, 0.0, 1e-15);
}

/* Along or across the axis nothing walks off; across it the two waves have their own indices. */
static void an_axis_along_or_across_the_normal_splits_no_directions(void **state)
{
    (void)state;
    const vec3 axes[] = {{0, 0, 1}, {1, 0, 0}, {0.6, 0.8, 0}};
    for (int i = 0; i < 3; i++) {
        crystal_incidence in = at_angle(0.0, calcite(axes[i]));
        const crystal_ray o = ray_of(&in, unpolarised, false, MODE_ORDINARY),
                          e = ray_of(&in, unpolarised, false, MODE_EXTRAORDINARY);
        const double index = i == 0 ? n_o : n_e;
        assert_same_direction(o.d, in.d, 1e-14);
        assert_same_direction(e.d, in.d, 1e-14);
        assert_near(vec3_length(crystal_wave_vector(&in.to, MODE_EXTRAORDINARY, e.d)), index, 1e-14);
        assert_near(o.row.i, 2.0 * n_o / square(1.0 + n_o), 1e-14);
        assert_near(e.row.i, 2.0 * index / square(1.0 + index), 1e-14);
    }
}

/* With the axis across the plane of incidence both rays obey Snell and Fresnel, the extraordinary one for s with
 * n_e. */
static void an_axis_across_the_plane_of_incidence_gives_snell(void **state)
{
    (void)state;
    for (double a = 1.0; a < 89.0; a += 4.0) {
        crystal_incidence in = at_angle(a, calcite(vec3_make(0.0, 1.0, 0.0)));
        const double cosine = cos(a * degree);
        const fresnel of_o = fresnel_dielectric(cosine, 1.0, n_o), of_e = fresnel_dielectric(cosine, 1.0, n_e);
        const stokes s = stokes_linear(in.d, vec3_make(0.0, 1.0, 0.0)), p = {1.0, -s.q, -s.u, 0.0};
        const crystal_ray o = ray_of(&in, p, false, MODE_ORDINARY), e = ray_of(&in, s, false, MODE_EXTRAORDINARY);
        assert_near(o.d.x, sin(a * degree) / n_o, 1e-14);
        assert_near(e.d.x, sin(a * degree) / n_e, 1e-14);
        assert_near(o.row.i, 1.0 - of_o.R_p, 1e-13);
        assert_near(e.row.i, 1.0 - of_e.R_s, 1e-13);
        assert_near(ray_of(&in, s, false, MODE_ORDINARY).row.i, 0.0, 1e-14);
        assert_near(ray_of(&in, unpolarised, true, MODE_ANY).row.i, 0.5 * (of_o.R_p + of_e.R_s), 1e-13);
    }
}

/* The axis in the plane of incidence, across the surface or along it. */
static void closed_forms_of_extraordinary_refraction(void **state)
{
    (void)state;
    for (double a = 1.0; a < 89.0; a += 4.0) {
        const double q = sin(a * degree);
        crystal_incidence across = at_angle(a, calcite(vec3_make(0.0, 0.0, 1.0))),
                          along = at_angle(a, calcite(vec3_make(1.0, 0.0, 0.0)));
        const vec3 one = ray_of(&across, unpolarised, false, MODE_EXTRAORDINARY).d,
                   other = ray_of(&along, unpolarised, false, MODE_EXTRAORDINARY).d;
        assert_near(one.x / one.z, q * n_o / (n_e * sqrt(n_e * n_e - q * q)), 1e-13);
        assert_near(other.x / other.z, q * n_e / (n_o * sqrt(n_o * n_o - q * q)), 1e-13);
    }
}

static crystal_incidence random_incidence(uint64_t *seed, bool from_crystal, bool to_crystal)
{
    crystal_incidence in = {.from = air, .to = air};
    in.from.n_o = random_real(seed, 1.0, 2.0);
    in.to.n_o = random_real(seed, 1.0, 2.0);
    if (from_crystal)
        in.from = calcite(random_direction(seed));
    if (to_crystal) {
        in.to.uniaxial = true;
        in.to.n_e = random_real(seed, 1.2, 2.0);
        in.to.axis = random_direction(seed);
    }
    in.mode = !from_crystal ? MODE_ANY : random_real(seed, 0.0, 1.0) < 0.5 ? MODE_ORDINARY : MODE_EXTRAORDINARY;
    in.n = random_direction(seed);
    do
        in.d = random_direction(seed);
    while (vec3_dot(in.d, in.n) > -0.05);
    return in;
}

/* The wave vector: its tangential part is the incident one's, its length n(theta) of 1 / n^2 = cos^2 / n_o^2 + sin^2 /
 * n_e^2 (Born and Wolf, 15.3.2). */
static void wave_vectors_match_along_the_interface(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int k = 0; k < 20000; k++) {
        crystal_incidence in = random_incidence(&seed, k % 3 != 0, k % 3 != 1);
        crystal_ray out[CRYSTAL_RAYS_MAX];
        const int count = crystal_split(&in, unpolarised, out);
        const vec3 before = crystal_wave_vector(&in.from, in.mode, in.d);
        for (int i = 0; i < count; i++) {
            const optical_medium *m = out[i].reflected ? &in.from : &in.to;
            const vec3 wave = crystal_wave_vector(m, out[i].mode, out[i].d), change = vec3_sub(wave, before);
            const double n = vec3_length(wave), cosine = m->uniaxial ? vec3_dot(wave, m->axis) / n : 0.0;
            assert_near(vec3_length(vec3_cross(change, in.n)), 0.0, 1e-12);
            assert_true((vec3_dot(out[i].d, in.n) > 0.0) == out[i].reflected);
            if (out[i].mode != MODE_EXTRAORDINARY)
                assert_near(n, m->n_o, 1e-12);
            else
                assert_near(1.0 / (n * n), square(cosine / m->n_o) + (1.0 - cosine * cosine) / square(m->n_e), 1e-12);
        }
    }
}

static void power_is_conserved(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int k = 0; k < 40000; k++) {
        crystal_incidence in = random_incidence(&seed, k % 3 != 0, k % 3 != 1);
        in.mirror = k % 12 == 1;
        crystal_ray out[CRYSTAL_RAYS_MAX];
        const stokes row = random_row(&seed);
        const int count = crystal_split(&in, unpolarised, out);
        double sum = 0.0;
        for (int i = 0; i < count; i++)
            sum += out[i].row.i;
        assert_near(sum, 1.0, 2e-12);
        const int same = crystal_split(&in, row, out); /* a row of any polarisation sees a white furnace as white */
        sum = 0.0;
        for (int i = 0; i < same; i++)
            sum += out[i].row.i;
        assert_near(sum, 1.0, 2e-12);
    }
}

/* Light that goes back arrives where it came from, with the same share: Stokes's principle of reversion, for every
 * pair of rays and the polarisation in air. */
static void light_paths_are_reversible(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int k = 0; k < 20000; k++) {
        crystal_incidence in = random_incidence(&seed, k % 3 != 0, k % 3 != 1);
        crystal_ray out[CRYSTAL_RAYS_MAX];
        const vec3 field = random_direction(&seed);
        const bool in_air = in.mode == MODE_ANY;
        const stokes row = in_air ? stokes_linear(in.d, field) : unpolarised;
        const int count = crystal_split(&in, row, out);
        for (int i = 0; i < count; i++) {
            if (out[i].mode == MODE_ANY && in_air)
                continue;
            const vec3 there = random_direction(&seed);
            crystal_incidence back = in;
            if (!out[i].reflected)
                back.from = in.to, back.to = in.from, back.n = vec3_scale(in.n, -1.0);
            back.d = vec3_scale(out[i].d, -1.0);
            back.mode = out[i].mode;
            if (fabs(vec3_dot(back.d, back.n)) < 0.05)
                continue;
            const stokes again = back.mode == MODE_ANY ? stokes_linear(back.d, there) : unpolarised;
            const crystal_ray home = ray_of(&back, again, out[i].reflected, in.mode);
            assert_same_direction(home.d, vec3_scale(in.d, -1.0), 1e-11);
            /* a mode's row weighs half of the light */
            const double one = in_air ? 2.0 * out[i].row.i
                               : out[i].mode == MODE_ANY
                                   ? analyser_intensity(out[i].row, stokes_linear(out[i].d, there))
                                   : out[i].row.i;
            const double other = back.mode == MODE_ANY ? 2.0 * home.row.i
                                 : in_air              ? analyser_intensity(home.row, stokes_linear(home.d, field))
                                                       : home.row.i;
            assert_near(one, other, 1e-11);
        }
    }
}

/* With n_e = n_o the reflected row is Fresnel's for every polarisation, also under total reflection, and the modes
 * together carry what is transmitted. */
static void equal_indices_give_fresnel(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int k = 0; k < 20000; k++) {
        crystal_incidence in = random_incidence(&seed, false, true);
        in.to.n_e = in.to.n_o;
        const double cos_i = -vec3_dot(in.d, in.n);
        const fresnel f = fresnel_dielectric(cos_i, in.from.n_o, in.to.n_o);
        if (fabs(1.0 - square(f.eta) * (1.0 - square(cos_i))) < 1e-4)
            continue; /* rounding decides at the critical angle */
        const stokes row = random_row(&seed);
        const vec3 mirrored = direction_reflect(in.d, in.n, cos_i);
        const crystal_ray r = ray_of(&in, row, true, MODE_ANY);
        const stokes expected = analyser_reflect(row, in.d, in.n, cos_i, in.from.n_o, in.to.n_o, mirrored);
        assert_same_direction(r.d, mirrored, 1e-10);
        assert_near(r.row.i, expected.i, 1e-10);
        assert_near(r.row.q, expected.q, 1e-10);
        assert_near(r.row.u, expected.u, 1e-10);
        assert_near(r.row.v, expected.v, 1e-10);
        crystal_ray out[CRYSTAL_RAYS_MAX];
        assert_int_equal(crystal_split(&in, row, out), f.total ? 1 : 3);
        if (f.total)
            continue;
        const vec3 refracted = direction_refract(in.d, in.n, cos_i, f.eta, f.cos_t);
        assert_same_direction(out[1].d, refracted, 1e-10);
        assert_same_direction(out[2].d, refracted, 1e-10);
        assert_near(out[1].row.i + out[2].row.i, 1.0 - expected.i, 1e-10);
    }
}

/* What leaves a crystal is polarised, the ordinary ray across the plane of the axis and the wave. */
static void rays_leave_polarised(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int k = 0; k < 20000; k++) {
        crystal_incidence in = random_incidence(&seed, true, false);
        crystal_ray out[CRYSTAL_RAYS_MAX];
        const int count = crystal_split(&in, unpolarised, out);
        const stokes s = out[count - 1].row;
        if (!out[count - 1].reflected)
            assert_near(s.q * s.q + s.u * s.u + s.v * s.v, s.i * s.i, 1e-12);
    }
    crystal_incidence in = {.from = calcite(vec3_make(1.0, 0.0, 1.0)), .to = air, .n = {0, 0, -1}, .d = {0, 0, 1}};
    in.mode = MODE_ORDINARY;
    const stokes o = ray_of(&in, unpolarised, false, MODE_ANY).row, y = stokes_linear(in.d, vec3_make(0.0, 1.0, 0.0));
    assert_near(o.q, o.i * y.q, 1e-14);
    assert_near(o.u, o.i * y.u, 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_walks_off_at_6_degrees),
        cmocka_unit_test(an_axis_along_or_across_the_normal_splits_no_directions),
        cmocka_unit_test(an_axis_across_the_plane_of_incidence_gives_snell),
        cmocka_unit_test(closed_forms_of_extraordinary_refraction),
        cmocka_unit_test(wave_vectors_match_along_the_interface),
        cmocka_unit_test(power_is_conserved),
        cmocka_unit_test(light_paths_are_reversible),
        cmocka_unit_test(equal_indices_give_fresnel),
        cmocka_unit_test(rays_leave_polarised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
