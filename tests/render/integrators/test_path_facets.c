/* Tests of polarised light at rough surfaces on random paths: each facet polarises as Fresnel's equations say, what it
 * reflects and transmits, and towards lamps behind sheets. Expected values are by quadrature of Walter's f, with fields
 * in space. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "polarised_chain.h"
#include "sheet_fixture.h"
#include "walter.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* The camera looks at the middle of glass with a black floor in it. */
static const char glass_scene[] =
    "render: {width: 1, height: 1, depth: 1, integrator: path, paths: 65536, beyond: black, polarisation: \"on\"}\n"
    "camera: {position: [0, 80, -60], target: [0, 0, 0], fov_deg: 0.001}\n"
    "background: {color: [0, 0, 0]}\n"
    "lights: {lamp: {position: [0.6, 3, 3.5], intensity: 0, reach: 2}}\n"
    "solids:\n"
    "  glass: {shape: plane, transparency: 1, ior: 2.4, roughness: 0.3}\n"
    "  black: {shape: plane, position: [0, -1, 0], diffuse: 0, priority: 1}\n";
static const double index_of_glass = 2.4;

/* What the camera sees of a facet's reflection. In the world, y is the normal. */
typedef struct eye {
    vec3 d, filter; /* the ray; the axis of the analyser, 0: none */
    double alpha;
} eye;

static eye eye_of(const scene *s, double alpha)
{
    const vec3 d = vec3_normalize(vec3_sub(s->camera.target, s->camera.position)), right = vec3_make(1.0, 0.0, 0.0),
               up = vec3_make(0.0, -d.z, d.y);
    const double a = s->camera.analyser_angle_deg * degree;
    eye e = {d, vec3_add(vec3_scale(right, cos(a)), vec3_scale(vec3_scale(up, up.y < 0.0 ? -1.0 : 1.0), sin(a))),
             alpha};
    if (s->camera.analyser == ANALYSER_NONE)
        e.filter = vec3_make(0.0, 0.0, 0.0);
    return e;
}

/* The model's frame, with z along the normal. */
static vec3 in_model(vec3 world)
{
    return vec3_make(-world.z, world.x, world.y);
}

static vec3 in_world(vec3 model)
{
    return vec3_make(model.y, model.z, -model.x);
}

/* The share of light from the unit vector `to` that the facet h sends through the eye's analyser: unpolarised, or
 * polarised along the axis. */
static double seen_at(const eye *e, enum chain_kind kind, vec3 h, vec3 to, const vec3 *axis)
{
    const vec3 x = vec3_normalize(vec3_cross(to, vec3_make(0.3, 0.5, 0.2))), y = vec3_cross(to, x);
    const chain_step step = {kind, e->d, h, to, -vec3_dot(e->d, h), 1.0, index_of_glass};
    double sum = 0.0;
    for (int k = 0; k < 2; k++) { /* unpolarised light is half of each of two fields */
        field in = field_from(k ? y : x, 1.0);
        if (axis) { /* what the sheet lets pass of it */
            const vec3 across = vec3_normalize(vec3_sub(*axis, vec3_scale(to, vec3_dot(*axis, to))));
            in = field_from(across, field_along(in, across));
        }
        const field out = chain_field(&step, in);
        const bool filtered = vec3_dot(e->filter, e->filter) > 0.0;
        const double complex along = field_along(out, e->filter);
        sum += 0.5 * (filtered ? creal(along * conj(along)) : field_power(out));
    }
    return sum;
}

/* By reflection. */
static double seen_of_facet(const eye *e, vec3 to, const vec3 *axis)
{
    return seen_at(e, CHAIN_REFLECT, vec3_normalize(vec3_sub(to, e->d)), to, axis);
}

/* --- light from everywhere above or below --- */

static double from_sky(vec3 m, const void *context)
{
    const eye *e = context;
    const vec3 i = in_model(vec3_scale(e->d, -1.0));
    const double i_m = vec3_dot(i, m);
    const vec3 o = vec3_sub(vec3_scale(m, 2.0 * i_m), i);
    if (!(i_m > 0.0 && o.z > 0.0))
        return 0.0;
    return walter_reflection(e->alpha, perfect_mirror, NULL, i, o) * o.z * 4.0 * i_m *
           seen_of_facet(e, in_world(o), NULL);
}

static double from_floor(vec3 m, const void *context)
{
    const eye *e = context;
    const two_media n = {1.0, index_of_glass};
    const vec3 i = in_model(vec3_scale(e->d, -1.0));
    const double i_m = vec3_dot(i, m);
    if (!(i_m > 0.0))
        return 0.0;
    const fresnel f = fresnel_dielectric(i_m, n.n_i, n.n_o);
    const vec3 o = direction_refract(vec3_scale(i, -1.0), m, i_m, f.eta, f.cos_t);
    const double o_m = vec3_dot(o, m), sum = n.n_i * i_m + n.n_o * o_m;
    if (!(o.z < 0.0))
        return 0.0;
    return walter_refraction(e->alpha, n, i, o) / (1.0 - f.R) * -o.z * sum * sum / (n.n_o * n.n_o * -o_m) *
           seen_at(e, CHAIN_REFRACT, in_world(m), in_world(o), NULL);
}

static void look_from(scene *s, double cosine)
{
    s->camera.position = vec3_make(0.0, 100.0 * cosine, -100.0 * sqrt(1.0 - cosine * cosine));
}

/* A white sky, and a floor in the glass that emits as much. */
static void rough_glass_polarises_what_it_reflects_and_transmits(void **state)
{
    (void)state;
    static const double cosines[] = {0.9, 0.3846 /* near Brewster's angle */, 0.15}, alphas[] = {0.05, 0.3, 0.8};
    scene *s = scene_from(glass_scene);
    s->camera.analyser = ANALYSER_LINEAR;
    for (int k = 0; k < (int)(COUNT(cosines) * COUNT(alphas)) * 8; k++) {
        const double cosine = cosines[k / 8 % 3], alpha = alphas[k / 24];
        const bool below = k % 2;
        set_all(s, below ? "background.color=0,0,0 black.emission=1" : "background.color=1,1,1 black.emission=0");
        look_from(s, cosine);
        s->solids[0].surface.roughness = alpha;
        s->camera.analyser_angle_deg = 45.0 * (k / 2 % 4) - 45.0;
        const eye e = eye_of(s, alpha);
        const double expected = over_normals(below ? from_floor : from_sky, &e, 600, 60);
        const estimate got = look_by_chance(s, 0);
        if (!(fabs(got.value - expected) <= got.t_9999 * got.standard_error + 1e-4))
            fail_msg("%s, alpha %g, cosine %g, analyser at %g: %.6f +- %.1e instead of %.6f",
                     below ? "from below" : "the sky", alpha, cosine, s->camera.analyser_angle_deg, got.value,
                     got.standard_error, expected);
    }
    scene_destroy(s);
}

/* --- lamps behind a sheet --- */

/* A polariser between the glass and the lamp; the camera's ray passes at its side. */
static void put_sheet(scene *s, vec3 axis)
{
    add_sheet(s, 0.0, "sheet=polariser", 0.0, 0.0);
    solid *one = &s->solids[s->solid_count - 1];
    one->shape.position = vec3_scale(s->lights[0].position, 0.5);
    one->shape.size = vec3_make(2.0, 0.01, 2.0);
    one->surface.sheet_axis = axis;
}

/* A point: nothing is random. */
static void a_point_behind_a_sheet_is_seen_by_its_field(void **state)
{
    (void)state;
    static const vec3 axes[] = {{1, 0, 0}, {0, 0, 1}, {1, 0.3, -0.7}};
    scene *s = scene_from(glass_scene);
    set_all(s, "lamp.intensity=1 render.paths=8 render.filter=centre render.depth=0");
    const double bare = look(s).x;
    const eye open = eye_of(s, 0.3);
    const vec3 to = vec3_normalize(s->lights[0].position);
    const double clear = seen_of_facet(&open, to, NULL);
    assert_true(bare > 1e-3);
    put_sheet(s, axes[0]);
    for (size_t k = 0; k < COUNT(axes); k++)
        for (int angle = 0; angle <= 180; angle += 30) {
            s->solids[2].surface.sheet_axis = axes[k];
            s->camera.analyser = angle == 180 ? ANALYSER_NONE : ANALYSER_LINEAR;
            s->camera.analyser_angle_deg = angle;
            const eye e = eye_of(s, 0.3);
            assert_near(look(s).x / bare, seen_of_facet(&e, to, &axes[k]) / clear, 1e-6); /* of the film's units */
        }
    scene_destroy(s);
}

/* Towards a lamp in the plane z = 0 the frames of rays are discontinuous, and the facet's branch may be on the other
 * side of it than the direction to the lamp. */
static void a_lamp_where_frames_jump_is_seen_by_its_field(void **state)
{
    (void)state;
    static const double sides[] = {0.0, 1e-18, -1e-18};
    const vec3 axis = vec3_make(1.0, 0.3, -0.7);
    scene *s = scene_from(glass_scene);
    set_all(s, "lamp.intensity=1 render.paths=8 render.filter=centre render.depth=0 lamp.position=3.5,3,0 "
               "camera.position=-60,80,0 camera.analyser=circular_left");
    put_sheet(s, axis);
    for (int tilt = 3; tilt < 30; tilt += 3) { /* of the glass, in that plane: directions are rounded */
        double first = 0.0;
        s->solids[0].shape.rotation_deg.z = tilt;
        for (size_t k = 0; k < COUNT(sides); k++) {
            s->lights[0].position.z = sides[k];
            const double seen = look(s).x;
            first = k == 0 ? seen : first;
            assert_true(seen > 1e-3);
            assert_near(seen / first, 1.0, 1e-6);
        }
    }
    scene_destroy(s);
}

/* A sphere is sampled by its points and by the path's own direction. */
static void a_sphere_behind_a_sheet_is_its_quadrature(void **state)
{
    (void)state;
    enum { RINGS = 200, SECTORS = 200 };
    const vec3 axis = vec3_make(1.0, 0.0, -0.6);
    scene *s = scene_from(glass_scene);
    set_all(s, "lamp.intensity=1 lamp.radius=0.8 camera.analyser=linear camera.analyser_angle_deg=25");
    put_sheet(s, axis);
    for (int rough = 1; rough <= 3; rough++) {
        const double alpha = 0.2 * rough, d2 = vec3_dot(s->lights[0].position, s->lights[0].position),
                     cap = 1.0 - sqrt(1.0 - 0.64 / d2);
        s->solids[0].surface.roughness = alpha;
        const eye e = eye_of(s, alpha);
        const vec3 to = vec3_normalize(s->lights[0].position),
                   x = vec3_normalize(vec3_cross(to, vec3_make(1.0, 0.0, 0.0))), y = vec3_cross(to, x);
        double sum = 0.0;
        for (int k = 0; k < RINGS * SECTORS; k++) {
            const double off = cap * (k / SECTORS + 0.5) / RINGS, sine = sqrt(off * (2.0 - off)),
                         phi = 2.0 * WALTER_PI * (k % SECTORS + 0.5) / SECTORS;
            const vec3 o = vec3_add(vec3_scale(to, 1.0 - off),
                                    vec3_add(vec3_scale(x, sine * cos(phi)), vec3_scale(y, sine * sin(phi))));
            sum += walter_reflection(alpha, perfect_mirror, NULL, in_model(vec3_scale(e.d, -1.0)), in_model(o)) * o.y *
                   seen_of_facet(&e, o, &axis);
        }
        const double expected = 4.0 / 0.64 * sum * 2.0 * WALTER_PI * cap / (RINGS * SECTORS);
        const estimate got = look_by_chance(s, 0);
        print_message("alpha %g: %.6f +- %.1e, expected %.6f\n", alpha, got.value, got.standard_error, expected);
        assert_true(got.standard_error < 0.01 * expected);
        assert_true(fabs(got.value - expected) <= got.t_9999 * got.standard_error + 2e-4 * expected);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rough_glass_polarises_what_it_reflects_and_transmits),
        cmocka_unit_test(a_point_behind_a_sheet_is_seen_by_its_field),
        cmocka_unit_test(a_lamp_where_frames_jump_is_seen_by_its_field),
        cmocka_unit_test(a_sphere_behind_a_sheet_is_its_quadrature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
