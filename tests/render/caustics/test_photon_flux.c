/* Tests of the flux that photons bring, over random scenes: in a closed room with spheres and boxes of glass, mirrors,
 * and lamps that are narrow or wide, near or far, each wall receives what a forward tracer of its own says, which sends
 * light into all directions of a lamp and knows nothing of targets. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

#include "photon_fixture.h"
#include "random_stream.h"
#include "whole.h"

#define PI 3.14159265358979323846
#define ROOM 20.0  /* half the room's edge */
#define ALBEDO 0.8 /* of mirrors */
enum { SOLIDS = 6, LAMPS = 2, WALLS = 6, SCENES = 10, PHOTONS = 200000, FORWARD = 400000 };

typedef struct body {
    bool is_box, is_mirror;
    vec3 at, half; /* half.x: the radius */
    double n;
} body;

typedef struct lamp {
    vec3 at, to;
    double half_angle_deg; /* 180: a point */
} lamp;

typedef struct room {
    body solids[SOLIDS];
    lamp lamps[LAMPS];
} room;

/* --- the scenes --- */

/* Solids in cells of their own, so that none overlap; their sizes differ by factors of up to 30. */
static room random_room(uint64_t *r)
{
    room a;
    for (int i = 0; i < SOLIDS; i++) {
        body *b = &a.solids[i];
        const double size = 0.1 * pow(30.0, random_real(r, 0.0, 1.0));
        b->is_box = random_real(r, 0.0, 1.0) < 0.5;
        b->is_mirror = random_real(r, 0.0, 1.0) < 0.3;
        b->n = random_real(r, 1.2, 1.8);
        b->at = vec3_make(-8.0 + 8.0 * (i % 3), random_real(r, -6.0, 6.0), i < 3 ? -5.0 : 5.0);
        b->half = b->is_box ? vec3_make(size * random_real(r, 0.02, 1.0), size * random_real(r, 0.02, 1.0), size)
                            : vec3_make(size, size, size);
    }
    for (int i = 0; i < LAMPS; i++) {
        lamp *l = &a.lamps[i];
        const bool far = random_real(r, 0.0, 1.0) < 0.5;
        l->at =
            vec3_make(random_real(r, -1.0, 1.0) + (far ? 18.0 : 3.0), random_real(r, -1.0, 1.0) + (far ? 17.0 : 0.0),
                      random_real(r, -1.0, 1.0) + (far ? -17.0 : 0.0));
        l->to = a.solids[(int)(random_real(r, 0.0, 1.0) * SOLIDS)].at;
        l->half_angle_deg = i == 0                           ? random_real(r, 0.5, 5.0)
                            : random_real(r, 0.0, 1.0) < 0.5 ? 180.0
                                                             : random_real(r, 20.0, 80.0);
    }
    return a;
}

static int write_room(const room *a, char *text, size_t size)
{
    static const char *const walls[WALLS] = {"-41, 0, 0", "41, 0, 0", "0, -41, 0", "0, 41, 0", "0, 0, -41", "0, 0, 41"};
    int n = snprintf(text, size, "render: {caustics: photons, photons: %d}\nlights:\n", PHOTONS);
    for (int i = 0; i < LAMPS; i++) {
        const lamp *l = &a->lamps[i];
        n += snprintf(text + n, size - (size_t)n, "  l%d: {kind: %s, position: [%.17g, %.17g, %.17g], reach: 1", i,
                      l->half_angle_deg == 180.0 ? "point" : "cone", l->at.x, l->at.y, l->at.z);
        if (l->half_angle_deg < 180.0)
            n += snprintf(text + n, size - (size_t)n, ", target: [%.17g, %.17g, %.17g], half_angle_deg: %.17g", l->to.x,
                          l->to.y, l->to.z, l->half_angle_deg);
        n += snprintf(text + n, size - (size_t)n, "}\n");
    }
    n += snprintf(text + n, size - (size_t)n, "solids:\n");
    for (int i = 0; i < WALLS; i++)
        n += snprintf(text + n, size - (size_t)n,
                      "  w%d: {shape: box, size: [42, 42, 42], position: [%s], diffuse: 1}\n", i, walls[i]);
    for (int i = 0; i < SOLIDS; i++) {
        const body *b = &a->solids[i];
        n += snprintf(text + n, size - (size_t)n, "  s%d: {position: [%.17g, %.17g, %.17g], ", i, b->at.x, b->at.y,
                      b->at.z);
        n += b->is_box ? snprintf(text + n, size - (size_t)n, "shape: box, size: [%.17g, %.17g, %.17g], ",
                                  2.0 * b->half.x, 2.0 * b->half.y, 2.0 * b->half.z)
                       : snprintf(text + n, size - (size_t)n, "shape: sphere, radius: %.17g, ", b->half.x);
        n += b->is_mirror ? snprintf(text + n, size - (size_t)n, "reflectivity: %.17g}\n", ALBEDO)
                          : snprintf(text + n, size - (size_t)n, "transparency: 1, ior: %.17g}\n", b->n);
    }
    return n;
}

/* --- the forward tracer --- */

static double part(vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static vec3 unit(int axis, double sign)
{
    return vec3_make(axis == 0 ? sign : 0.0, axis == 1 ? sign : 0.0, axis == 2 ? sign : 0.0);
}

/* The distance to a box's surface beyond `least`, and its outer normal there; HUGE_VAL: none. */
static double to_box(vec3 centre, vec3 half, vec3 o, vec3 d, double least, vec3 *normal)
{
    double in = -HUGE_VAL, out = HUGE_VAL;
    vec3 first = {0.0, 0.0, 0.0}, last = first;
    for (int k = 0; k < 3; k++) {
        const double slope = part(d, k), off = part(o, k) - part(centre, k), size = part(half, k);
        if (slope == 0.0) {
            if (fabs(off) > size)
                return HUGE_VAL;
            continue;
        }
        const double sign = slope > 0.0 ? 1.0 : -1.0, enter = (-sign * size - off) / slope,
                     leave = (sign * size - off) / slope;
        if (enter > in)
            in = enter, first = unit(k, -sign);
        if (leave < out)
            out = leave, last = unit(k, sign);
    }
    if (in > out || out <= least)
        return HUGE_VAL;
    *normal = in > least ? first : last;
    return in > least ? in : out;
}

static double to_sphere(vec3 centre, double radius, vec3 o, vec3 d, double least, vec3 *normal)
{
    const vec3 off = vec3_sub(o, centre);
    const double b = vec3_dot(off, d), c = vec3_dot(off, off) - radius * radius, root = b * b - c;
    if (root < 0.0)
        return HUGE_VAL;
    const double t = -b - sqrt(root) > least ? -b - sqrt(root) : -b + sqrt(root);
    if (t <= least)
        return HUGE_VAL;
    *normal = vec3_scale(vec3_add(off, vec3_scale(d, t)), 1.0 / radius);
    return t;
}

/* Fresnel's equations for both polarisations, and their mean; 1: total reflection. */
static double reflectance(double cos_i, double n, double *cos_t)
{
    const double sin2 = (1.0 - cos_i * cos_i) / (n * n);
    if (sin2 >= 1.0)
        return 1.0;
    *cos_t = sqrt(1.0 - sin2);
    const double s = (cos_i - n * *cos_t) / (cos_i + n * *cos_t), p = (n * cos_i - *cos_t) / (n * cos_i + *cos_t);
    return 0.5 * (s * s + p * p);
}

/* Where light from a lamp arrives: the number of the wall, or -1: absorbed by a mirror, or it has met no solid. */
static int follow(const room *a, vec3 o, vec3 d, uint64_t *r)
{
    for (int meets = 0;; meets++) {
        vec3 normal = {0.0, 0.0, 0.0}, wall;
        int hit = -1;
        double t = to_box(vec3_make(0.0, 0.0, 0.0), vec3_make(ROOM, ROOM, ROOM), o, d, 0.0, &wall);
        for (int i = 0; i < SOLIDS; i++) {
            const body *b = &a->solids[i];
            vec3 n;
            const double far =
                b->is_box ? to_box(b->at, b->half, o, d, 1e-9, &n) : to_sphere(b->at, b->half.x, o, d, 1e-9, &n);
            if (far < t)
                t = far, hit = i, normal = n;
        }
        if (hit < 0)
            return meets == 0     ? -1
                   : wall.x < 0.0 ? 0
                   : wall.x > 0.0 ? 1
                   : wall.y < 0.0 ? 2
                   : wall.y > 0.0 ? 3
                   : wall.z < 0.0 ? 4
                                  : 5;
        const body *b = &a->solids[hit];
        const bool inside = vec3_dot(d, normal) > 0.0;
        const vec3 facing = inside ? vec3_scale(normal, -1.0) : normal;
        const double cos_i = -vec3_dot(d, facing), n = inside ? 1.0 / b->n : b->n;
        double cos_t = 0.0;
        o = vec3_add(o, vec3_scale(d, t));
        if (b->is_mirror && random_real(r, 0.0, 1.0) >= ALBEDO)
            return -1;
        if (b->is_mirror || random_real(r, 0.0, 1.0) < reflectance(cos_i, n, &cos_t))
            d = vec3_add(d, vec3_scale(facing, 2.0 * cos_i));
        else
            d = vec3_add(vec3_scale(d, 1.0 / n), vec3_scale(facing, cos_i / n - cos_t));
        d = vec3_normalize(d);
    }
}

/* Even over the lamp's cone. */
static vec3 direction_of(const lamp *l, uint64_t *r)
{
    const vec3 axis = vec3_normalize(vec3_sub(l->to, l->at));
    const vec3 other = fabs(axis.x) < 0.5 ? vec3_make(1.0, 0.0, 0.0) : vec3_make(0.0, 1.0, 0.0);
    const vec3 u = vec3_normalize(vec3_cross(axis, other)), v = vec3_cross(axis, u);
    const double cosine = 1.0 - random_real(r, 0.0, 1.0) * (1.0 - cos(l->half_angle_deg * PI / 180.0)),
                 sine = sqrt(fmax(0.0, 1.0 - cosine * cosine)), turn = 2.0 * PI * random_real(r, 0.0, 1.0);
    return vec3_add(vec3_scale(axis, cosine),
                    vec3_add(vec3_scale(u, sine * cos(turn)), vec3_scale(v, sine * sin(turn))));
}

typedef struct tally {
    double flux[WALLS], variance[WALLS];
} tally;

/* I reach^2 times the solid angle, by wall; binomial variance. */
static void send_forward(const room *a, int count, uint64_t *r, tally *out)
{
    for (int k = 0; k < LAMPS; k++) {
        const lamp *l = &a->lamps[k];
        const double around = 2.0 * PI * (1.0 - cos(l->half_angle_deg * PI / 180.0));
        int arrived[WALLS] = {0};
        for (int i = 0; i < count; i++) {
            const int wall = follow(a, l->at, direction_of(l, r), r);
            if (wall >= 0)
                arrived[wall]++;
        }
        for (int w = 0; w < WALLS; w++) {
            const double share = (double)arrived[w] / count;
            out->flux[w] += around * share;
            out->variance[w] += around * around * share * (1.0 - share) / count;
        }
    }
}

/* --- photons --- */

static int wall_at(vec3 at)
{
    const double most = fmax(fabs(at.x), fmax(fabs(at.y), fabs(at.z)));
    return most == fabs(at.x) ? (at.x < 0.0 ? 0 : 1) : most == fabs(at.y) ? (at.y < 0.0 ? 2 : 3) : at.z < 0.0 ? 4 : 5;
}

/* The variance is that of independent photons, an upper bound of that of Sobol points. */
static size_t sum_photons(const room *a, tally *out)
{
    char text[4096];
    plan *p = NULL;
    write_room(a, text, sizeof text);
    scene *s = scene_from(text);
    assert_int_equal(plan_build(s, &p, NULL), STATUS_OK);
    caustics *c = photons_of(p);
    const size_t count = photon_map_count(p->photons);
    for (size_t i = 0; i < count; i++) {
        const photon *one = photon_map_at(p->photons, i);
        const double flux = (double)one->flux[0];
        out->flux[wall_at(one->position)] += flux;
        out->variance[wall_at(one->position)] += flux * flux;
    }
    caustics_destroy(c);
    plan_destroy(p);
    scene_destroy(s);
    return count;
}

static void each_wall_receives_what_a_forward_tracer_says(void **state)
{
    (void)state;
    uint64_t r = 20261129;
    const int scenes = is_whole() ? 4 * SCENES : SCENES, forward = is_whole() ? 10 * FORWARD : FORWARD;
    int compared = 0, within_one = 0;
    for (int i = 0; i < scenes; i++) {
        const room a = random_room(&r);
        tally photons = {{0.0}, {0.0}}, expected = {{0.0}, {0.0}};
        const size_t count = sum_photons(&a, &photons);
        send_forward(&a, forward, &r, &expected);
        double worst = 0.0;
        for (int w = 0; w < WALLS; w++) {
            const double error = sqrt(photons.variance[w] + expected.variance[w]);
            const double off = error > 0.0 ? fabs(photons.flux[w] - expected.flux[w]) / error : 0.0;
            worst = fmax(worst, off);
            compared++;
            within_one += off < 1.0;
            if (off > 4.0)
                fail_msg("scene %d, wall %d: %.6g instead of %.6g +- %.2g", i, w, photons.flux[w], expected.flux[w],
                         error);
        }
        printf("# scene %d: %zu photons of %d arrive, at most %.2f standard errors off\n", i, count, PHOTONS, worst);
    }
    printf("# %d of %d within one standard error\n", within_one, compared);
    assert_true(within_one > 0.6 * compared);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_wall_receives_what_a_forward_tracer_says)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
