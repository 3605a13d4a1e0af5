/* Beams that light the scene: what their photons bring to matte surfaces, against closed forms of the spot's power, its
 * size and profile, its place behind a tilted plate, and its brightness. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "photon_fixture.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"
#include "whole.h"
#include "zbuffer_fixture.h"

#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define assert_near(a, b, tolerance)                                    \
    do {                                                                \
        if (!(fabs((a) - (b)) <= (tolerance)))                          \
            fail_msg("%.9g instead of %.9g", (double)(a), (double)(b)); \
    } while (0)

/* A matte floor seen from above, 2 units wide, and a beam that shines down on it from a height of 3. */
static scene *spot(const char *keys, const char *solids)
{
    char text[1500];
    snprintf(text, sizeof text,
             "render: {width: 64, height: 64, depth: 8, caustics: photons, photons: 200000, integrator: raycast}\n"
             "camera: {position: [0, 5, 0], target: [0, 0, 0.0001], projection: orthographic, view_height: 2}\n"
             "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
             "beams: {laser: {position: [0, 3, 0], target: [0, 0, 0], lights: \"on\", white: \"on\", power: 2.5, %s}}\n"
             "solids:\n"
             "  floor: {shape: plane, diffuse: 1}\n%s",
             keys, solids);
    return scene_from(text);
}

/* The integral of irradiance over the image, in which a matte surface has the radiance E / pi. */
static double power_in_image(const scene *s, int channel)
{
    render_result *r = render(s);
    double sum = 0.0;
    for (int i = 0; i < r->img->width * r->img->height; i++)
        sum += (double)r->img->sum[3 * i + channel] / FILM_ONE;
    const double side = 2.0 / r->img->width;
    render_result_destroy(r);
    return PI * sum * side * side;
}

/* Moments of the photons on the floor, by power. */
typedef struct moments {
    double power, x, z, xx, zz; /* means */
    double within[4];           /* shares of the power within a half, one, one and a half and two of a radius */
} moments;

static moments moments_of(const scene *s, double radius, double x, double near)
{
    plan *p = NULL;
    moments m = {.power = 0.0};
    assert_int_equal(plan_build(s, &p, NULL), STATUS_OK);
    caustics *c = photons_of(p);
    for (size_t i = 0; i < photon_map_count(p->photons); i++) {
        const photon *one = photon_map_at(p->photons, i);
        const double power = PI * (double)one->flux[1], at = hypot(one->position.x, one->position.z);
        if (fabs(one->position.x - x) > near)
            continue;
        m.power += power;
        m.x += power * one->position.x, m.z += power * one->position.z;
        m.xx += power * one->position.x * one->position.x, m.zz += power * one->position.z * one->position.z;
        for (int k = 0; k < 4; k++)
            m.within[k] += at <= 0.5 * (k + 1) * radius ? power : 0.0;
    }
    caustics_destroy(c);
    plan_destroy(p);
    m.x /= m.power, m.z /= m.power, m.xx /= m.power, m.zz /= m.power;
    for (int k = 0; k < 4; k++)
        m.within[k] /= m.power;
    return m;
}

static void all_its_power_arrives(void **state)
{
    (void)state;
    static const char *const beams[] = {
        "kind: bundle, width: 0.6",
        "kind: bundle, width: 0.4, profile: gaussian",
        "kind: pencil, angle_deg: 10",
        "kind: pencil, angle_deg: 8, profile: gaussian",
    };
    for (size_t k = 0; k < sizeof beams / sizeof *beams; k++) {
        scene *s = spot(beams[k], "");
        set_all(s, "render.samples=16 render.width=32 render.height=32 render.photons=20000"); /* along the edge */
        assert_near(moments_of(s, 1.0, 0.0, 9.0).power, 2.5, 1e-4);
        assert_near(power_in_image(s, 1), 2.5, 5e-3);
        set(s, "render.integrator=path");
        set(s, "render.paths=8"); /* at a random point of each pixel */
        assert_near(power_in_image(s, 1), 2.5, 0.1);
        scene_destroy(s);
    }
}

/* Within r of the axis: r^2 / R^2 of an even beam, 1 - exp(-2 r^2 / w^2) of a Gaussian one (Siegman, Lasers, 17.1). */
static void assert_profile(const moments *m, bool gaussian)
{
    for (int k = 0; k < 4; k++) {
        const double r = 0.5 * (k + 1), even = r < 1.0 ? r * r : 1.0;
        assert_near(m->within[k], gaussian ? 1.0 - exp(-2.0 * r * r) : even, k == 1 && !gaussian ? 1e-3 : 3e-3);
    }
}

static void a_bundle_keeps_its_radius(void **state)
{
    (void)state;
    scene *s = spot("kind: bundle, width: 0.6", "");
    moments m = moments_of(s, 0.3, 0.0, 9.0);
    assert_near(m.x, 0.0, 1e-4);
    assert_near(m.z, 0.0, 1e-4);
    assert_near(m.xx, 0.3 * 0.3 / 4.0, 1e-4);
    assert_near(m.zz, 0.3 * 0.3 / 4.0, 1e-4);
    assert_profile(&m, false);
    set(s, "laser.profile=gaussian");
    m = moments_of(s, 0.3, 0.0, 9.0);
    assert_near(m.x, 0.0, 1e-4);
    assert_near(m.z, 0.0, 1e-4);
    assert_near(m.xx, 0.3 * 0.3 / 4.0, 2e-4);
    assert_near(m.zz, 0.3 * 0.3 / 4.0, 2e-4);
    assert_profile(&m, true);
    scene_destroy(s);
}

/* The radiance across the image: E = 2 P / (pi w^2) exp(-2 r^2 / w^2). */
static void the_image_shows_the_profile(void **state)
{
    (void)state;
    scene *s = spot("kind: bundle, width: 0.8, profile: gaussian", "");
    set(s, "render.photons=1000000");
    render_result *r = render(s);
    const double w = 0.4;
    for (int x = 20; x < 44; x += 3) {
        const double dx = (x + 0.5 - 32.0) / 32.0, dy = 0.5 / 32.0,
                     e = 2.0 * 2.5 / (PI * w * w) * exp(-2.0 * (dx * dx + dy * dy) / (w * w));
        assert_near(film_value(r->img, x, 32, 1), e / PI, 0.06 * e / PI);
    }
    render_result_destroy(r);
    scene_destroy(s);
}

/* A cone of the full angle a is h tan(a / 2) wide at a height h, even in solid angle: within it 1 - cos is. */
static void a_pencil_widens(void **state)
{
    (void)state;
    scene *s = spot("kind: pencil, angle_deg: 20", "");
    const double radius = 3.0 * tan(10.0 * PI / 180.0);
    moments m = moments_of(s, radius, 0.0, 9.0);
    const double half = 1.0 - cos(atan(0.5 * radius / 3.0)), whole = 1.0 - cos(10.0 * PI / 180.0);
    assert_near(m.within[0], half / whole, 1e-3);
    assert_near(m.within[1], 1.0, 1e-3);
    set(s, "laser.profile=gaussian");
    m = moments_of(s, radius, 0.0, 9.0);
    assert_profile(&m, true);
    scene_destroy(s);
}

/* In a plane: offsets of variance b^2 / 12 over a width b, or (b / 4)^2 of exp(-2 x^2 / (b / 2)^2); a fan's tangents
 * alike. */
static void sheets_and_fans_are_lines(void **state)
{
    (void)state;
    scene *s = spot("kind: sheet, width: 0.8, normal: [0, 0, 1]", "");
    moments m = moments_of(s, 1.0, 0.0, 9.0);
    assert_near(m.power, 2.5, 1e-4);
    assert_near(m.zz, 0.0, 1e-12);
    assert_near(m.xx, 0.64 / 12.0, 1e-3 * 0.64);
    set(s, "laser.profile=gaussian");
    m = moments_of(s, 1.0, 0.0, 9.0);
    assert_near(m.power, 2.5, 1e-4);
    assert_near(m.zz, 0.0, 1e-12);
    assert_near(m.xx, 0.04, 2e-4);
    set(s, "laser.kind=fan");
    set(s, "laser.angle_deg=15");
    const double wide = 3.0 * tan(7.5 * PI / 180.0);
    m = moments_of(s, 1.0, 0.0, 9.0);
    assert_near(m.zz, 0.0, 1e-12);
    assert_near(m.xx, wide * wide / 4.0, 1e-3);
    set(s, "laser.profile=uniform"); /* the mean of tan^2 over angles up to a: tan
                                      a / a - 1 */
    m = moments_of(s, 1.0, 0.0, 9.0);
    const double a = 7.5 * PI / 180.0;
    assert_near(m.xx, 9.0 * (tan(a) / a - 1.0), 1e-4);
    scene_destroy(s);
}

/* A plate of index n and thickness t at an incidence i displaces the beam by t sin i (1 - cos i / sqrt(n^2 - sin^2 i)),
 * and passes (1 - R)^2 at first (Hecht, Optics, 4.4 and 4.6). What is reflected in the plate arrives further away. */
static void a_tilted_plate_displaces_the_spot(void **state)
{
    (void)state;
    scene *s = spot("kind: bundle, width: 0.01", "  plate: {shape: box, position: [0, 1.5, 0], size: [3, 0.5, 3], "
                                                 "transparency: 1, ior: 1.5, rotation: [0, 0, 40]}\n");
    set(s, "render.photons=10000");
    for (int tilt = 15; tilt <= 60; tilt += 15) {
        s->solids[1].shape.rotation_deg.z = tilt;
        const double i = tilt * PI / 180.0, sine = sin(i), cosine = cos(i), n = 1.5, t = 0.5,
                     by = t * sine * (1.0 - cosine / sqrt(n * n - sine * sine)),
                     cos_t = sqrt(1.0 - sine * sine / (n * n)), r_s = (cosine - n * cos_t) / (cosine + n * cos_t),
                     r_p = (n * cosine - cos_t) / (n * cosine + cos_t), reflected = 0.5 * (r_s * r_s + r_p * r_p);
        const moments left = moments_of(s, 1.0, -by, 0.02), right = moments_of(s, 1.0, by, 0.02);
        const moments *m = left.power > right.power ? &left : &right;
        assert_near(fabs(m->x), by, 1e-4);
        assert_near(m->power, 2.5 * (1.0 - reflected) * (1.0 - reflected), 2.5e-3);
    }
    scene_destroy(s);
}

/* Irradiance of parallel light on an inclined surface, E = P cos i / A (Hecht, Optics, 3.3.1), seen along the beam. */
static void an_inclined_plane_gets_the_cosine(void **state)
{
    ONLY_IN_CHECK();
    (void)state;
    scene *s = spot("kind: bundle, width: 1.2", "");
    const double area = PI * 0.36;
    for (int tilt = 0; tilt <= 75; tilt += 25) {
        const double cosine = cos(tilt * PI / 180.0);
        s->solids[0].shape.rotation_deg.z = tilt;
        render_result *r = render(s);
        double sum = 0.0;
        for (int y = 26; y < 38; y++)
            for (int x = 26; x < 38; x++)
                sum += film_value(r->img, x, y, 1) / 144.0;
        render_result_destroy(r);
        assert_near(sum, 2.5 * cosine / (area * PI), 0.015 * 2.5 * cosine / (area * PI));
        set(s, "render.samples=4");
        assert_near(power_in_image(s, 1), 2.5 * cosine, 5e-3);
        set(s, "render.samples=1");
    }
    scene_destroy(s);
}

/* A beam enters water 1 deep at an incidence i: Snell's law, sin i = n sin t, gives its place on the bottom, and
 * (1 - R) exp(-a / cos t) its power (Hecht, Optics, 4.6 and 4.8). One that starts in the water passes no surface. */
static void water_bends_and_absorbs_a_beam(void **state)
{
    (void)state;
    const double n = 1.33, a = 0.3;
    scene *s =
        spot("kind: bundle, width: 0.01", "  water: {shape: box, position: [0, 0, 0], size: [40, 2, 40], priority: 1, "
                                          "transparency: 1, ior: 1.33, absorb_per_m: [0.3, 0.3, 0.3]}\n");
    set_all(s, "render.photons=20000 floor.priority=2 render.unit_m=1");
    for (int degrees = 0; degrees <= 75; degrees += 25) {
        const double i = degrees * PI / 180.0, sine = sin(i) / n, cos_t = sqrt(1.0 - sine * sine),
                     x = 2.0 * tan(i) + sine / cos_t, r_s = (cos(i) - n * cos_t) / (cos(i) + n * cos_t),
                     r_p = (n * cos(i) - cos_t) / (n * cos(i) + cos_t), R = 0.5 * (r_s * r_s + r_p * r_p);
        s->beams[0].direction = vec3_make(sin(i), -cos(i), 0.0);
        const moments m = moments_of(s, 1.0, x, 0.1);
        assert_near(m.x, x, 1e-4);
        assert_near(m.power, 2.5 * (1.0 - R) * exp(-a / cos_t), 2.5e-3);
    }
    s->beams[0].direction = vec3_make(0.0, -1.0, 0.0);
    s->beams[0].position = vec3_make(0.2, 0.5, 0.0);
    assert_near(moments_of(s, 1.0, 0.2, 0.1).power, 2.5 * exp(-0.5 * a), 1e-4);
    scene_destroy(s);
}

/* Each source brings its own power, however they share the photons; a lamp's go to the ball only. */
static void lamps_and_beams_share_photons(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 16, height: 16, depth: 8, caustics: photons, photons: 50000}\n"
                          "camera: {position: [0, 5, 0], target: [0, 0, 0.001]}\n"
                          "lights: {lamp: {position: [50, 5, 0], reach: 5}}\n"
                          "beams:\n"
                          "  one: {kind: bundle, width: 0.1, position: [-1, 3, 0], direction: [0, -1, 0], "
                          "white: on, power: 1, lights: on}\n"
                          "  none: {kind: bundle, position: [0, 3, 0], direction: [0, -1, 0], power: 9}\n"
                          "  three: {kind: pencil, angle_deg: 2, position: [1, 3, 0], direction: [0, -1, 0], "
                          "white: on, power: 3, lights: on}\n"
                          "solids:\n"
                          "  floor: {shape: plane, diffuse: 1}\n"
                          "  ball: {shape: sphere, position: [50, 2, 0], radius: 1, transparency: 1, ior: 1.5}\n");
    const double both = moments_of(s, 1.0, 50.0, 5.0).power;
    assert_true(both > 0.1);
    assert_near(moments_of(s, 1.0, -1.0, 0.5).power, 1.0, 1e-4);
    assert_near(moments_of(s, 1.0, 1.0, 0.5).power, 3.0, 2e-3); /* with what the ball scatters here */
    set_all(s, "one.lights=off three.visible=off render.photons=100000");
    assert_near(moments_of(s, 1.0, 50.0, 5.0).power, both, 0.02 * both);
    scene_destroy(s);
}

/* Whatever its colour, a beam is as bright as a white one: Y = P / area / pi of linear sRGB, and of a spectral film. */
static void a_beam_is_as_bright_as_white(void **state)
{
    (void)state;
    static const char *const lines[] = {"laser.lambda_nm=532", "laser.lambda_nm=632.8", "laser.lambda_nm=450"};
    static const int strongest[] = {1, 0, 2};
    static const double d65[] = {0.95047, 1.0, 1.08883}; /* XYZ, which a spectral film sums (IEC 61966-2-1) */
    scene *s = spot("kind: bundle, width: 0.6", "");
    set_all(s, "render.samples=16 render.width=32 render.height=32");
    for (int c = 0; c < 3; c++)
        assert_near(power_in_image(s, c), 2.5, 5e-3);
    set_all(s, "render.spectrum=spectral render.wavelengths=16 render.samples=1");
    for (int c = 0; c < 3; c++)
        assert_near(power_in_image(s, c), 2.5 * d65[c], 0.05 * d65[c]);
    set(s, "laser.white=off");
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        set(s, lines[k]);
        set_all(s, "render.spectrum=rgb render.samples=16 render.photons=20000");
        const double rgb[3] = {power_in_image(s, 0), power_in_image(s, 1), power_in_image(s, 2)};
        assert_near(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2], 2.5, 5e-3);
        const double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
        assert_true(rgb[strongest[k]] == most && most > 1.5 * fmin(rgb[0], fmin(rgb[1], rgb[2])));
        set_all(s, "render.spectrum=spectral render.samples=16 render.wavelengths=2");
        assert_near(power_in_image(s, 1), 2.5, 0.025);
    }
    set(s, "laser.lambda_nm=1064"); /* no eye sees it */
    assert_near(power_in_image(s, 1), 0.0, 0.0);
    scene_destroy(s);
}

/* A scaled scene has the same image: its beams keep their irradiance. */
static void a_scaled_scene_keeps_its_film(void **state)
{
    (void)state;
    scene *s = spot("kind: bundle, width: 0.6", "");
    set_all(s, "render.photons=5000 render.width=30 render.height=20");
    const uint64_t hash = film_hash_at(s, isa_best());
    assert_int_equal(scene_scale(s, "all+camera", 4.0, NULL), STATUS_OK);
    assert_near(s->beams[0].power, 2.5 * 16.0, 0.0);
    assert_true(film_hash_at(s, isa_best()) == hash);
    set(s, "laser.lights=off");
    assert_int_equal(scene_scale(s, "all+camera", 0.5, NULL), STATUS_OK);
    assert_near(s->beams[0].power, 2.5 * 16.0, 0.0); /* shown in any unit */
    scene_destroy(s);
}

static void films_are_bit_identical(void **state)
{
    (void)state;
    static const char *const variants[] = {
        "",
        "laser.kind=pencil laser.angle_deg=20 laser.profile=gaussian render.integrator=path render.paths=2",
        "laser.kind=fan laser.white=off render.spectrum=spectral render.wavelengths=3",
        "laser.kind=sheet render.integrator=whitted render.polarisation=on",
    };
    static const char solids[] =
        "  ball: {shape: sphere, position: [0.2, 1.2, 0], radius: 0.5, transparency: 1, ior: 1.5}\n";
    for (size_t v = 0; v < sizeof variants / sizeof *variants; v++) {
        scene *s = spot("kind: bundle, width: 0.6", solids);
        set_all(s, "render.photons=5000 render.width=30 render.height=20");
        set_all(s, variants[v]);
        uint64_t hash = 0;
        for (int level = ISA_BASE; level <= (int)isa_best(); level++)
            for (int threads = 1; threads <= 5; threads += 2) {
                s->render.threads = threads;
                const uint64_t one = film_hash_at(s, (isa)level);
                assert_true(!hash || one == hash);
                hash = one;
            }
        set(s, "laser.lights=off");
        assert_true(film_hash_at(s, isa_best()) != hash);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_its_power_arrives),
        cmocka_unit_test(a_bundle_keeps_its_radius),
        cmocka_unit_test(the_image_shows_the_profile),
        cmocka_unit_test(a_pencil_widens),
        cmocka_unit_test(sheets_and_fans_are_lines),
        cmocka_unit_test(a_tilted_plate_displaces_the_spot),
        cmocka_unit_test(an_inclined_plane_gets_the_cosine),
        cmocka_unit_test(water_bends_and_absorbs_a_beam),
        cmocka_unit_test(lamps_and_beams_share_photons),
        cmocka_unit_test(a_scaled_scene_keeps_its_film),
        cmocka_unit_test(a_beam_is_as_bright_as_white),
        cmocka_unit_test(films_are_bit_identical),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
