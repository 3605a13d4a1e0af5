/* A minute of the default toy with the recorded grab of experiments/hands/tug.yaml: it rests, is stretched, released,
 * and recovers. Its rest shape is not a sphere but a drop on a floor, so it recovers to the shape of an untouched toy;
 * without gravity, to the sphere. */
#include "softbody_fixture.h"
#include "whole.h"

typedef struct extent {
    double tall, wide, nearest, farthest, turned_over;
} extent;

/* Shape of the body about its centre of mass, in radii; turned_over: inverted faces. */
static extent extent_of(const softbody *b)
{
    const softbody_quantities a = softbody_measure(b);
    const size_t count = softbody_mass_count(b);
    vec3 *at = malloc(count * sizeof *at);
    softbody_positions(b, at);
    extent e = {.tall = a.high - a.low, .nearest = INFINITY};
    for (size_t i = 0; i < count; i++) {
        const vec3 r = vec3_sub(at[i], a.center);
        e.wide = fmax(e.wide, sqrt(r.x * r.x + r.z * r.z));
        e.nearest = fmin(e.nearest, vec3_length(r));
        e.farthest = fmax(e.farthest, vec3_length(r));
    }
    free(at);
    mesh *surface;
    assert_int_equal(softbody_surface(b, &surface, NULL), STATUS_OK);
    for (size_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t *corner = surface->triangles[t].corner;
        const vec3 p = surface->vertices[corner[0]];
        const vec3 n = vec3_cross(vec3_sub(surface->vertices[corner[1]], p), vec3_sub(surface->vertices[corner[2]], p));
        e.turned_over += vec3_dot(n, vec3_sub(p, a.center)) <= 0.0;
    }
    mesh_release(surface);
    return e;
}

static hand_script *recorded_grab(void)
{
    hand_script *script;
    diagnostic why = {.what = ""};
    const status code = script_read_below("experiments/hands/tug.yaml", NULL, &script, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
    return script;
}

/* Simulates a toy with the script for a minute; before: its state after a second, stretched: during the pull. */
static softbody *after_a_minute(const softbody_settings *s, extent *before, extent *stretched)
{
    hand_script *script = recorded_grab();
    softbody *b = toy_of(s);
    diagnostic why = {.what = ""};
    assert_int_equal(softbody_follow(b, script, NULL), STATUS_OK);
    for (double t = 1.0; t <= 60.0; t += 1.0) {
        const status code = softbody_advance(b, t, &why);
        assert_string_equal(why.what, "");
        assert_int_equal(code, STATUS_OK);
        assert_true(isfinite(energy_of(b)));
        if (t == 1.0)
            *before = extent_of(b);
        if (t == 2.0)
            *stretched = extent_of(b);
    }
    hand_script_destroy(script);
    return b;
}

/* The same toy without a script. */
static extent left_alone(const softbody_settings *s)
{
    softbody *b = toy_of(s);
    assert_int_equal(softbody_advance(b, 60.0, NULL), STATUS_OK);
    const extent e = extent_of(b);
    softbody_destroy(b);
    return e;
}

static void a_toy_on_its_floor_recovers_its_rest_shape(void **state)
{
    ONLY_IN_CHECK();
    (void)state;
    const softbody_settings s = default_toy();
    extent before, stretched;
    softbody *b = after_a_minute(&s, &before, &stretched);
    const softbody_quantities a = softbody_measure(b);
    const extent after = extent_of(b), rest = left_alone(&s);
    assert_true(stretched.farthest > 1.2 * before.farthest);
    assert_near(after.tall, rest.tall, 0.01 * s.radius);
    assert_near(after.wide, rest.wide, 0.01 * s.radius);
    assert_near(after.nearest, rest.nearest, 0.01 * s.radius);
    assert_near(after.farthest, rest.farthest, 0.01 * s.radius);
    assert_near(a.volume / a.volume_at_rest, 1.0, 0.02);
    assert_true(after.turned_over == 0.0);
    assert_true(a.kinetic < 1e-4);
    softbody_destroy(b);
}

static void a_toy_without_gravity_recovers_the_sphere(void **state)
{
    (void)state;
    ONLY_IN_CHECK();
    softbody_settings s = default_toy();
    s.gravity = vec3_make(0.0, 0.0, 0.0);
    s.ground = 0;
    extent before, stretched;
    softbody *b = after_a_minute(&s, &before, &stretched);
    const softbody_quantities a = softbody_measure(b);
    const extent after = extent_of(b);
    assert_true(stretched.farthest > 1.1);
    assert_near(after.nearest, s.radius, 0.01 * s.radius);
    assert_near(after.farthest, s.radius, 0.01 * s.radius);
    assert_near(a.volume / a.volume_at_rest, 1.0, 0.02);
    assert_true(after.turned_over == 0.0);
    softbody_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_toy_on_its_floor_recovers_its_rest_shape),
        cmocka_unit_test(a_toy_without_gravity_recovers_the_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
