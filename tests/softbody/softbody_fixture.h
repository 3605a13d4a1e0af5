/* Small spring nets whose motion is known in closed form, and functions that run them. */
#pragma once

#include "scene/assets/slime.h"
#include "scene/model/edit/edit.h"
#include "scene/model/scene.h"
#include "softbody/softbody.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define assert_near(got, expected, within) assert_near_at(got, expected, within, __FILE__, __LINE__)
static inline void assert_near_at(double got, double expected, double within, const char *file, int line)
{
    if (!(fabs(got - expected) <= within)) {
        print_error("%.17g is not within %g of %.17g\n", got, within, expected);
        _fail(file, line);
    }
}

/* The toy with the defaults of the parameter table. */
static inline softbody_settings default_toy(void)
{
    scene *s = scene_create();
    assert_non_null(s);
    assert_int_equal(scene_add(s, PARAM_MESH, "toy", NULL, NULL), STATUS_OK);
    const softbody_settings settings = slime_settings(&s->meshes[0]);
    scene_destroy(s);
    return settings;
}

/* No force but the springs'. */
static inline softbody_settings settings_in_space(softbody_integrator integrator, double dt_s)
{
    softbody_settings s = default_toy();
    s.integrator = integrator;
    s.dt_s = dt_s;
    s.gravity = vec3_make(0.0, 0.0, 0.0);
    s.ground = 0;
    s.position = vec3_make(0.0, 0.0, 0.0);
    return s;
}

static inline softbody *body_of_net(const softbody_net *net, const softbody_settings *s)
{
    softbody *b;
    diagnostic why = {.what = ""};
    const status code = softbody_create_net(net, s, isa_best(), &b, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
    return b;
}

static inline softbody *toy_of(const softbody_settings *s)
{
    softbody *b;
    diagnostic why = {.what = ""};
    const status code = softbody_create(s, isa_best(), &b, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
    return b;
}

/* One mass of 1 kg. */
static inline softbody *point_at(vec3 position, vec3 velocity, const softbody_settings *s)
{
    const double mass_kg = 1.0;
    const softbody_net net = {.mass_count = 1, .position = &position, .velocity = &velocity, .mass_kg = &mass_kg};
    return body_of_net(&net, s);
}

/* Two masses along x on a spring of length 1, stretched by `drawn`. */
static inline softbody *pair_of(double m1, double m2, double k, double damping, double drawn,
                                const softbody_settings *s)
{
    const vec3 position[2] = {{0.0, 0.0, 0.0}, {1.0 + drawn, 0.0, 0.0}};
    const double mass_kg[2] = {m1, m2};
    const softbody_spring spring = {{0, 1}, 1.0, k, damping};
    const softbody_net net = {
        .mass_count = 2, .spring_count = 1, .position = position, .mass_kg = mass_kg, .springs = &spring};
    return body_of_net(&net, s);
}

static inline double pair_length(const softbody *b)
{
    vec3 at[2];
    softbody_positions(b, at);
    return vec3_length(vec3_sub(at[1], at[0]));
}

static inline void steps_of(softbody *b, long count)
{
    diagnostic why = {.what = ""};
    for (long i = 0; i < count; i++) {
        const status code = softbody_step(b, &why);
        if (code != STATUS_OK)
            fail_msg("step %ld: %s", i, why.what);
    }
}

static inline double energy_of(const softbody *b)
{
    const softbody_quantities a = softbody_measure(b);
    return a.kinetic + a.elastic + a.compression + a.gravity;
}
