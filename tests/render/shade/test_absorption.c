/* Tests of absorption by Beer and Lambert's law: along known paths, in random scenes, and as tint. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "probe_fixture.h"
#include "random_scene.h"
#include "scene/model/scene.h"

/* Absorption by Beer and Lambert's law: the transmittance of a length d of a medium is exp(-a d) (Hecht,
 * 4.8.1, eq. 4.79), in every case of light passing through it: slabs with their reflections, solids without refraction,
 * and straight shadow rays. */

static const vec3 askew = {17.0, -33.0, 71.0};
static const double a_per_m[3] = {0.7, 0.0, 2.5};

/* A slab of that thickness, centred on y = 0. */
static stage slab(double n, double thickness, int depth, const char *assignments)
{
    char more[128];
    scene_text text = scene_begin(1.0, depth);
    snprintf(more, sizeof more, "absorb_per_m: [0.7, 0, 2.5], shape: box, size: [50, %.17g, 50]", thickness);
    add_clear(&text, "slab", n, 0, vec3_make(0.0, 0.0, 0.0), askew, more);
    return stage_of(text.at, assignments);
}

/* Sum of the radiance of the rays that leave on one side. */
static double leaving(const ray_tree *tree, vec3 side, int channel)
{
    double sum = 0.0;
    for (size_t i = 0; i < tree->count; i++)
        if (tree->node[i].end == RAY_END_SKY && vec3_dot(tree->node[i].direction, side) > 0.0)
            sum += tree->node[i].throughput[channel];
    return sum;
}

/* Through: (1 - R)^2 e^-ad (1 + q + q^2 + ...) with q = R^2 e^-2ad, which is (1 - R)^2 e^-ad / (1 - q); back: R + (1 -
 * R)^2 R e^-2ad (1 + q + ...) (Born and Wolf, 7.6.1, and 14.4.1, with intensities). A depth limit of D keeps the rays
 * of D and less: the term of q^k leaves as a ray of depth 2 k + 2, or 2 k + 3. */
static void a_slab_transmits_the_series_cut_at_the_depth(void **state)
{
    (void)state;
    const double d = 0.4, n = 1.5;
    const vec3 down = turned(vec3_make(0.0, -1.0, 0.0), askew);
    for (int depth = 0; depth <= 41; depth++) {
        for (double angle = 0.0; angle < 1.3; angle += 0.4) {
            stage g = slab(n, d, depth, "render.beyond=black");
            const double R = reflectance_of_angles(angle, 1.0, n).mean, path = d / sqrt(1.0 - pow(sin(angle) / n, 2.0));
            const vec3 to = turned(vec3_make(sin(angle), -cos(angle), 0.0), askew);
            const ray_tree *tree = stage_ray(&g, vec3_scale(to, -2.0), to);
            for (int c = 0; c < 3; c++) {
                const double transmitted = exp(-a_per_m[c] * path), q = R * R * transmitted * transmitted;
                double through = 0.0, back = depth >= 1 ? R : 0.0;
                for (int k = 0; 2 * k + 2 <= depth; k++)
                    through += (1.0 - R) * (1.0 - R) * transmitted * pow(q, k);
                for (int k = 0; 2 * k + 3 <= depth; k++)
                    back += (1.0 - R) * (1.0 - R) * R * transmitted * transmitted * pow(q, k);
                assert_true(fabs(leaving(tree, down, c) - through) <= 1e-13);
                assert_true(fabs(leaving(tree, vec3_scale(down, -1.0), c) - back) <= 1e-13);
                assert_true(fabs(tree->radiance[c] - through - back) <= 1e-12); /* the sky is 1 */
                if (depth >= 40)
                    assert_true(fabs(through - (1.0 - R) * (1.0 - R) * transmitted / (1.0 - q)) <= 1e-13);
            }
            stage_close(&g);
        }
    }
}

/* The same as an image, and in other units: a of 70 per metre with 1 unit = 1 cm is a of 0.7 with 1 unit = 1 m. */
static void the_scene_sets_the_length_of_a_unit(void **state)
{
    (void)state;
    static const char *const alike[] = {"", "render.unit_m=0.01 slab.absorb_per_m=70,0,250",
                                        "render.unit_m=1000 slab.absorb_per_m=0.0007,0,0.0025"};
    for (size_t k = 0; k < COUNT(alike); k++) {
        stage g = slab(1.5, 0.4, 40, alike[k]);
        set_all(g.setting, "camera.position=0,3,0 camera.target=0,0,0 slab.rotation=0,0,0");
        const vec3 seen = look(g.setting);
        const double seen_by[3] = {seen.x, seen.y, seen.z}, R = 0.04;
        for (int c = 0; c < 3; c++) {
            const double transmitted = exp(-a_per_m[c] * 0.4), q = R * R * transmitted * transmitted,
                         T2 = (1.0 - R) * (1.0 - R);
            assert_true(fabs(seen_by[c] - (R + T2 * (transmitted + R * transmitted * transmitted) / (1.0 - q))) <=
                        1e-12);
        }
        stage_close(&g);
    }
}

/* A ball in a block of liquid, both of index 1.33: no interface, but the ball's coefficient over its chord 2 sqrt(r^2 -
 * h^2) and the liquid's over the rest. The hit contains the length in metres and the transmittance. */
static void a_solid_without_refraction_still_absorbs(void **state)
{
    (void)state;
    scene_text text = scene_begin(1.0, 8);
    add_clear(&text, "liquid", 1.33, 0, vec3_make(0.0, 0.0, 0.0), askew,
              "shape: box, size: [4, 2, 4], absorb_per_m: [0.3, 0, 0.1]");
    add_clear(&text, "ball", 1.33, 1, vec3_make(0.0, 0.0, 0.0), askew,
              "shape: sphere, radius: 0.8, absorb_per_m: [2, 0.5, 0]");
    stage g = stage_of(text.at, "render.unit_m=0.5");
    const double R = reflectance_of_angles(0.0, 1.0, 1.33).mean, T2 = (1.0 - R) * (1.0 - R);
    static const double liquid[3] = {0.15, 0.0, 0.05}, ball[3] = {1.0, 0.25, 0.0}; /* per scene unit */
    for (double h = -1.0; h <= 1.0; h += 0.053) {
        const ray_tree *tree =
            stage_way(&g, turned(vec3_make(h, 3.0, 0.0), askew), turned(vec3_make(0.0, -1.0, 0.0), askew), -1);
        const double chord = fabs(h) < 0.8 ? 2.0 * sqrt(0.64 - h * h) : 0.0;
        assert_int_equal((int)tree->count, 3);
        assert_true(fabs(tree->node[1].hit.path_length_m - 1.0) <= 1e-12);
        for (int c = 0; c < 3; c++) {
            const double transmitted = exp(-liquid[c] * (2.0 - chord) - ball[c] * chord);
            assert_true(fabs(tree->node[1].hit.transmittance[c] - transmitted) <= 1e-12);
            assert_true(fabs(tree->node[2].throughput[c] - T2 * transmitted) <= 1e-12);
        }
    }
    stage_close(&g);
}

/* In surroundings of the same index, in front of the sky: no hit, but absorption; from inside, only from the origin
 * on. */
static void a_cloud_attenuates_the_sky_behind_it(void **state)
{
    (void)state;
    scene_text text = scene_begin(1.0, 4);
    add_clear(&text, "cloud", 1.0, 0, vec3_make(0.0, 0.0, 0.0), askew,
              "shape: sphere, radius: 1, absorb_per_m: [0.5, 1, 2]");
    stage g = stage_of(text.at, "");
    static const double a[3] = {0.5, 1.0, 2.0};
    for (double h = -0.99; h < 1.2; h += 0.06) {
        const double half = fabs(h) < 1.0 ? sqrt(1.0 - h * h) : 0.0;
        for (int inside = 0; inside < 2; inside++) {
            const ray_tree *tree = stage_ray(&g, vec3_make(h, 0.0, inside ? 0.0 : -5.0), vec3_make(0.0, 0.0, 1.0));
            assert_int_equal((int)tree->count, 1);
            assert_true(tree->node[0].end == RAY_END_SKY);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(tree->radiance[c] - exp(-a[c] * half * (inside ? 1.0 : 2.0))) <= 1e-12);
        }
    }
    stage_close(&g);
}

/* An infinite medium returns light only in a channel that it transmits: R, and R + T = 1. */
static void an_absorbing_infinite_medium_is_black(void **state)
{
    (void)state;
    scene_text text = scene_begin(1.0, 4);
    add_clear(&text, "deep", 1.5, 0, vec3_make(0.0, 0.0, 0.0), askew, "shape: plane, absorb_per_m: [1e-6, 0, 1e9]");
    stage g = stage_of(text.at, "");
    for (double angle = 0.0; angle < 1.5; angle += 0.3) {
        const vec3 d = turned(vec3_make(sin(angle), -cos(angle), 0.0), askew);
        const double R = reflectance_of_angles(angle, 1.0, 1.5).mean;
        const ray_tree *tree = stage_ray(&g, vec3_scale(d, -2.0), d);
        assert_true(fabs(tree->radiance[0] - R) <= 1e-12 && fabs(tree->radiance[1] - 1.0) <= 1e-12 &&
                    fabs(tree->radiance[2] - R) <= 1e-12);
    }
    stage_close(&g);
}

/* Light from the sky is not absorbed by the surroundings, whose length has no end: also where the list of a batch's
 * paths fills up, as by rays through 150 slabs without interfaces in the other half of the image. */
static void the_sky_is_seen_past_any_number_of_media(void **state)
{
    (void)state;
    static scene_text text;
    text.length = 0;
    add(&text, "background: {color: [0.25, 0.5, 0.75], absorb_per_m: [3, 3, 3]}\n"
               "camera: {position: [0, 0, 0], target: [0, 0, 1], fov_deg: 60}\n"
               "render: {depth: 1, width: 16, height: 16, samples: 1}\nsolids:\n");
    for (int k = 0; k < 150; k++)
        add(&text, "  s%d: {shape: box, transparency: 1, ior: 1, size: [40, 80, 0.01], position: [20.5, 0, %g]}\n", k,
            5.0 + 0.05 * k);
    scene *s = scene_from(text.at);
    render_result *r = render(s);
    const double expected[3] = {0.25, 0.5, 0.75};
    for (int i = 0; i < 3 * 16 * 16; i++)
        assert_true(i % 48 >= 24 || fabs((double)r->img->sum[i] / FILM_ONE - expected[i % 3]) < 1e-6);
    render_result_destroy(r);
    scene_destroy(s);
}

/* A white ground under a lamp with a coloured pane between them: shadow rays are straight, so that the ground has k_d
 * (N.L) exp(-a d / cos) times 0.9, the transmittance of each of the pane's two faces. Phong, CACM 18(6), 1975, for
 * N.L. */
static const char lit_ground[] = "background: {color: [0, 0, 0]}\n"
                                 "render: {width: 1, height: 1}\n"
                                 "lights: {lamp: {position: [0, 4, 0]}}\n"
                                 "solids:\n"
                                 "  ground: {shape: plane, diffuse: 1}\n"
                                 "  pane: {shape: box, transparency: 0.9, ior: 1.5, position: [0, 2, 0], size: [50, "
                                 "0.5, 50], absorb_per_m: [0.7, 0, 2.5]}\n";

/* The pane's thickness along the light's path, its number of faces there, and the length of the view ray in it. */
static void check_lit_ground(const char *assignments, double light_path, double faces, double eye_path)
{
    stage g = stage_of(lit_ground, assignments);
    for (double x = 0.0; x < 8.0; x += 0.5) {
        const vec3 to_lamp = vec3_sub(g.setting->lights[0].position, vec3_make(x, 0.0, 0.0));
        const double n_l = to_lamp.y / vec3_length(to_lamp);
        const vec3 at = vec3_make(x, 1.0, 1.0); /* under the pane, looking at the ground */
        const ray_tree *tree = stage_ray(&g, at, vec3_make(0.0, -1.0, -1.0));
        assert_int_equal((int)tree->count, 2);
        assert_int_equal(tree->node[1].kind, RAY_SHADOW);
        for (int c = 0; c < 3; c++) {
            const double expected = n_l * exp(-a_per_m[c] * (light_path / n_l + eye_path)) * pow(0.9, faces);
            assert_true(fabs(tree->radiance[c] - expected) <= 1e-12);
            assert_true(fabs(tree->node[1].contribution[c] - expected) <= 1e-12);
        }
        g.setting->camera.aimed = 1;
        g.setting->camera.position = at, g.setting->camera.target = vec3_make(x, 0.0, 0.0);
        const vec3 seen = look(g.setting);
        assert_true(fabs(seen.x - n_l * exp(-a_per_m[0] * (light_path / n_l + eye_path)) * pow(0.9, faces)) <= 1e-12);
    }
    stage_close(&g);
}

static void light_is_attenuated_along_its_straight_path(void **state)
{
    (void)state;
    check_lit_ground("", 0.5, 2.0, 0.0);
    check_lit_ground("pane.transparency=1", 0.5, 0.0, 0.0);
    check_lit_ground("pane.transparency=1 pane.ior=1", 0.5, 0.0, 0.0); /* absorbs without refraction */
    check_lit_ground("pane.ior=1", 0.5, 0.0, 0.0);                     /* there is no interface */
    check_lit_ground("lamp.position=0,2.1,0", 0.35, 1.0, 0.0);         /* a lamp in the pane */
    check_lit_ground("lamp.position=0,1.5,0", 0.0, 0.0, 0.0);          /* a lamp under the pane */
    check_lit_ground("render.unit_m=0.1 pane.absorb_per_m=7,0,25", 0.5, 2.0, 0.0);
    /* camera and ground in the medium, which overlaps the ground at lower priority; and light that leaves the medium */
    check_lit_ground("pane.position=0,1,0 pane.size=50,4,50 ground.priority=1", 3.0, 1.0, sqrt(2.0));
    check_lit_ground("pane.position=0,1,0 pane.size=50,8,50 ground.priority=1", 4.0, 0.0, sqrt(2.0));
}

/* With opaque shadows solids transmit nothing, clear or not; without shadows light is not attenuated. */
static void other_shadow_modes_have_no_absorption(void **state)
{
    (void)state;
    stage g = stage_of(lit_ground, "render.shadows=opaque");
    assert_true(stage_ray(&g, vec3_make(0.0, 1.0, 1.0), vec3_make(0.0, -1.0, -1.0))->radiance[0] == 0.0);
    set(g.setting, "render.shadows=off");
    stage_look(&g);
    assert_true(stage_ray(&g, vec3_make(0.0, 1.0, 1.0), vec3_make(0.0, -1.0, -1.0))->radiance[0] == 1.0);
    stage_close(&g);
}

/* A table of wavelengths replaces the three coefficients: linear between points, constant outside, evaluated at the
 * channels' wavelengths (CHANNEL_LAMBDA_NM, the dominant wavelengths of the primaries of sRGB: 611.4, 549.1 and 464.3
 * nm). */
static void an_absorption_spectrum_is_sampled_at_the_channels_wavelengths(void **state)
{
    (void)state;
    stage g = slab(1.0, 1.0, 4, "slab.absorb_spectrum=[400,1,500,3,600,5]");
    const ray_tree *tree =
        stage_ray(&g, turned(vec3_make(0.0, 2.0, 0.0), askew), turned(vec3_make(0.0, -1.0, 0.0), askew));
    const double a[3] = {5.0, 3.0 + 2.0 * 0.491, 1.0 + 2.0 * 0.643};
    for (int c = 0; c < 3; c++)
        assert_true(fabs(tree->radiance[c] - exp(-a[c])) <= 1e-12);
    set(g.setting, "render.unit_m=0.1");
    stage_look(&g);
    tree = stage_ray(&g, turned(vec3_make(0.0, 2.0, 0.0), askew), turned(vec3_make(0.0, -1.0, 0.0), askew));
    for (int c = 0; c < 3; c++)
        assert_true(fabs(tree->radiance[c] - exp(-0.1 * a[c])) <= 1e-12);
    stage_close(&g);
}

/* Absorption along rays in random scenes against the integral of the absorption coefficient (Beer and Lambert;
 * Born and Wolf, 7th ed., 4.11.4): the media along the ray are determined from the solids' own shapes, at many points,
 * and the boundaries by bisection. */

enum { STEPS = 300 };

static vec3 at_distance(vec3 origin, vec3 direction, double t)
{
    return vec3_add(origin, vec3_scale(direction, t));
}

/* The end of the medium at the nearer distance; the medium at the farther distance differs. */
static double border(const probe *p, vec3 origin, vec3 direction, int medium, double near, double far)
{
    while (far - near > 1e-13) {
        const double middle = 0.5 * (near + far);
        *(probe_medium_at(p, at_distance(origin, direction, middle)) == medium ? &near : &far) = middle;
    }
    return far;
}

static void add_depth(const scene *s, int medium, double length, double depth[3])
{
    if (medium == RAY_OUTSIDE || s->solids[medium].surface.transparency == 0.0)
        return;
    const vec3 a = s->solids[medium].surface.absorb_per_m;
    depth[0] += a.x * length, depth[1] += a.y * length, depth[2] += a.z * length;
}

/* The optical depth of a straight segment. A medium between two of the points, with equal media on both sides, is
 * missed. */
static void optical_depth(const probe *p, const scene *s, vec3 origin, vec3 direction, double length, double depth[3])
{
    depth[0] = depth[1] = depth[2] = 0.0;
    const double step = length / STEPS, edge = 1e-3 * step;
    double from = 0.0;
    int now = probe_medium_at(p, at_distance(origin, direction, edge));
    for (int k = 1; k <= STEPS; k++) {
        const double far = k == STEPS ? length - edge : k * step;
        const int last = probe_medium_at(p, at_distance(origin, direction, far));
        while (now != last) {
            const double to = border(p, origin, direction, now, from < edge ? edge : from, far);
            add_depth(s, now, to - from, depth);
            now = to + 1e-12 < far ? probe_medium_at(p, at_distance(origin, direction, to + 1e-12)) : last;
            from = to;
        }
        add_depth(s, now, far - from, depth);
        from = far;
    }
    add_depth(s, now, edge, depth);
}

typedef struct tally {
    int rays, unlike;
    double worst;
} tally;

static void compare(tally *sum, const double depth[3], const double transmittance[3])
{
    double error = 0.0;
    for (int c = 0; c < 3; c++)
        error = fmax(error, fabs(transmittance[c] - exp(-depth[c])));
    sum->rays++;
    sum->unlike += error > 1e-9;
    sum->worst = fmax(sum->worst, error);
}

static void check_node(const stage *g, const ray_node *node, tally *hits, tally *shadows)
{
    double depth[3], transmittance[3];
    /* a shadow ray's contribution is rounded to film units: make it large enough for nine digits */
    if (node->kind == RAY_SHADOW && node->end == RAY_END_LIT && fmin(node->throughput[0], node->throughput[2]) > 1e-3) {
        optical_depth(g->probe, g->setting, node->origin, node->direction, node->light_distance, depth);
        for (int c = 0; c < 3; c++)
            transmittance[c] = node->contribution[c] / node->throughput[c];
        compare(shadows, depth, transmittance);
    }
    if (node->kind != RAY_SHADOW && node->end == RAY_END_HIT && node->hit.t < 20.0) {
        optical_depth(g->probe, g->setting, node->origin, node->direction, node->hit.t, depth);
        compare(hits, depth, node->hit.transmittance);
    }
}

static void rays_and_shadow_rays_have_the_transmittance_of_the_media_along_them(void **state)
{
    (void)state;
    uint64_t seed = 8;
    tally hits = {0}, shadows = {0};
    print_message("seed %llu\n", (unsigned long long)seed);
    for (int number = 0; number < 250; number++) {
        const room m = random_room(&seed, number % 4 == 0);
        const vec3 lamp = random_point(&seed, number % 2 ? 3.0 : 0.8);
        scene_text text = {.length = 0};
        add(&text,
            "render: {depth: 3}\nlights: {lamp: {position: [%.17g, %.17g, %.17g], color: [1000, 1000, "
            "1000]}}\nsolids:\n",
            lamp.x, lamp.y, lamp.z);
        add_room(&text, &seed, &m, 1.0, true, true);
        stage g = stage_of(text.at, "");
        for (size_t k = 0; k < g.setting->solid_count; k++)
            g.setting->solids[k].surface.diffuse = 1.0;
        stage_look(&g);
        for (int k = 0; k < 8; k++) {
            const vec3 from = random_point(&seed, k % 2 ? 3.0 : 0.8), to = random_point(&seed, 0.8);
            const ray_tree *tree = stage_ray(&g, from, vec3_sub(to, from));
            for (size_t i = 0; i < tree->count; i++)
                check_node(&g, &tree->node[i], &hits, &shadows);
        }
        stage_close(&g);
    }
    assert_true(hits.rays > 3000 && shadows.rays > 1500);
    assert_true(hits.unlike < hits.rays / 500 && hits.worst < 0.01);
    assert_true(shadows.unlike < shadows.rays / 500 && shadows.worst < 0.01);
}

/* Tint: inside a clear solid light has the solid's colour after tint_distance, and by Beer and Lambert's law
 * color^(d / tint_distance) after d (Hecht, Optics, 5th ed., eq. 4.79, with -ln(color) / tint_distance as the
 * coefficient). */

static const double color[3] = {0.8, 1.0, 0.1};

/* A pane across y = 0 without refraction, and the path straight down through it. */
static stage pane(double thickness, const char *assignments)
{
    char more[128];
    scene_text text = scene_begin(1.0, 4);
    snprintf(more, sizeof more, "color: [0.8, 1, 0.1], shape: box, size: [50, %.17g, 50]", thickness);
    add_clear(&text, "pane", 1.0, 0, vec3_make(0.0, 0.0, 0.0), vec3_make(0.0, 0.0, 0.0), more);
    stage g = stage_of(text.at, assignments);
    set_all(g.setting, "camera.position=0,30,0 camera.target=0,0,0 camera.fov_deg=0.001");
    return g;
}

static const ray_tree *down(stage *g)
{
    return stage_ray(g, vec3_make(0.0, 30.0, 0.0), vec3_make(0.0, -1.0, 0.0));
}

static void a_tint_is_the_transmittance_after_its_distance(void **state)
{
    (void)state;
    static const double distance[] = {0.05, 1.0, 3.0};
    for (size_t k = 0; k < COUNT(distance); k++) {
        for (double d = 0.1; d < 4.0; d += 0.37) {
            char assignments[64];
            snprintf(assignments, sizeof assignments, "pane.tint_distance=%.17g", distance[k]);
            stage g = pane(d, assignments);
            const ray_tree *tree = down(&g);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(tree->radiance[c] - pow(color[c], d / distance[k])) <= 1e-12);
            stage_close(&g);
        }
    }
}

/* On a slanted path the tint is that of the path's length, not of the pane's thickness. */
static void tint_depends_on_the_length_of_the_path(void **state)
{
    (void)state;
    stage g = pane(0.5, "");
    for (double angle = 0.0; angle < 1.4; angle += 0.1) {
        const ray_tree *tree = stage_ray(&g, vec3_make(0.0, 1.0, 0.0), vec3_make(sin(angle), -cos(angle), 0.0));
        for (int c = 0; c < 3; c++)
            assert_true(fabs(tree->radiance[c] - pow(color[c], 0.5 / cos(angle))) <= 1e-12);
    }
    stage_close(&g);
}

/* Absorption is per metre, tint per scene unit. */
static void absorption_and_tint_add_up(void **state)
{
    (void)state;
    stage g = pane(0.5, "pane.absorb_per_m=70,10,0 render.unit_m=0.01");
    static const double a[3] = {0.7, 0.1, 0.0};
    const ray_tree *tree = down(&g);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(tree->radiance[c] - pow(color[c], 0.5) * exp(-a[c] * 0.5)) <= 1e-12);
    stage_close(&g);
}

static void black_transmits_nothing_and_white_all(void **state)
{
    (void)state;
    stage g = pane(0.001, "pane.color=0,1,0");
    const ray_tree *tree = down(&g);
    assert_true(tree->radiance[0] == 0.0 && tree->radiance[1] == 1.0 && tree->radiance[2] == 0.0);
    stage_close(&g);
}

/* An opaque solid has no inside. */
static void opaque_solids_have_no_tint(void **state)
{
    (void)state;
    stage g = pane(0.5, "pane.transparency=0 pane.ambient=1");
    const vec3 seen = look(g.setting);
    assert_true(fabs(seen.x - 0.8) <= 1e-12 && fabs(seen.y - 1.0) <= 1e-12 && fabs(seen.z - 0.1) <= 1e-12);
    stage_close(&g);
}

/* Every integrator and kind of weights. */
static void every_film_is_tinted(void **state)
{
    (void)state;
    static const char *const films[] = {"", "render.integrator=path", "render.weights=constant",
                                        "render.transmission=simple", "render.polarisation=on"};
    for (size_t k = 0; k < COUNT(films); k++) {
        stage g = pane(0.5, films[k]);
        const vec3 seen = look(g.setting);
        assert_true(fabs(seen.x - pow(0.8, 0.5)) <= 1e-9 && fabs(seen.y - 1.0) <= 1e-9 &&
                    fabs(seen.z - pow(0.1, 0.5)) <= 1e-9);
        stage_close(&g);
    }
}

/* A grey has equal transmittance at all wavelengths, so its film is grey too; a colour uses its upsampled spectrum. */
static void a_spectral_film_is_tinted_by_the_upsampled_color(void **state)
{
    (void)state;
    stage g = pane(2.0, "render.spectrum=spectral render.wavelengths=64 pane.color=0.5,0.5,0.5");
    vec3 seen = look(g.setting);
    assert_true(fabs(seen.x - 0.25) <= 2e-3 && fabs(seen.y - 0.25) <= 2e-3 && fabs(seen.z - 0.25) <= 2e-3);
    stage_close(&g);
    g = pane(1.0, "render.spectrum=spectral render.wavelengths=64 pane.color=0.6,0.3,0.2");
    seen = look(g.setting); /* after the distance the light has the colour */
    assert_true(fabs(seen.x - 0.6) <= 5e-3 && fabs(seen.y - 0.3) <= 5e-3 && fabs(seen.z - 0.2) <= 5e-3);
    stage_close(&g);
}

/* Shadow rays go straight through: N.L color^(d / cos). */
static void light_through_a_tinted_pane_is_tinted(void **state)
{
    (void)state;
    static const char tinted_ground[] =
        "background: {color: [0, 0, 0]}\n"
        "render: {width: 1, height: 1}\n"
        "lights: {lamp: {position: [0, 4, 0]}}\n"
        "solids:\n"
        "  ground: {shape: plane, diffuse: 1}\n"
        "  pane: {shape: box, transparency: 1, ior: 1.5, color: [0.8, 1, 0.1], position: "
        "[0, 2, 0], size: [50, 0.5, 50]}\n";
    stage g = stage_of(tinted_ground, "");
    for (double x = 0.0; x < 6.0; x += 0.5) {
        const double n_l = 4.0 / sqrt(16.0 + x * x);
        const ray_tree *tree = stage_ray(&g, vec3_make(x, 1.0, 1.0), vec3_make(0.0, -1.0, -1.0));
        for (int c = 0; c < 3; c++)
            assert_true(fabs(tree->radiance[c] - n_l * pow(color[c], 0.5 / n_l)) <= 1e-12);
    }
    stage_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slab_transmits_the_series_cut_at_the_depth),
        cmocka_unit_test(the_scene_sets_the_length_of_a_unit),
        cmocka_unit_test(a_solid_without_refraction_still_absorbs),
        cmocka_unit_test(a_cloud_attenuates_the_sky_behind_it),
        cmocka_unit_test(an_absorbing_infinite_medium_is_black),
        cmocka_unit_test(the_sky_is_seen_past_any_number_of_media),
        cmocka_unit_test(light_is_attenuated_along_its_straight_path),
        cmocka_unit_test(other_shadow_modes_have_no_absorption),
        cmocka_unit_test(an_absorption_spectrum_is_sampled_at_the_channels_wavelengths),
        cmocka_unit_test(rays_and_shadow_rays_have_the_transmittance_of_the_media_along_them),
        cmocka_unit_test(a_tint_is_the_transmittance_after_its_distance),
        cmocka_unit_test(tint_depends_on_the_length_of_the_path),
        cmocka_unit_test(absorption_and_tint_add_up),
        cmocka_unit_test(black_transmits_nothing_and_white_all),
        cmocka_unit_test(opaque_solids_have_no_tint),
        cmocka_unit_test(every_film_is_tinted),
        cmocka_unit_test(a_spectral_film_is_tinted_by_the_upsampled_color),
        cmocka_unit_test(light_through_a_tinted_pane_is_tinted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
