/* Tests of the depth buffer against the ray caster, which finds surfaces independently, and against closed forms:
 * affine and perspective-correct interpolation on a tilted square, and the coverage count of each point. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "geometry/mesh/mesh_generators.h"
#include "mesh_fixture.h"
#include "random_stream.h"
#include "scene/model/scene.h"
#include "zbuffer_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

#define HEAD                                                                                                         \
    "render: {width: 200, height: 150, depth: 0, shadows: off, lighting: phong}\n"                                   \
    "camera: {position: [0, 3, -8], target: [0, 0.8, 0], fov_deg: 40}\n"                                             \
    "background: {kind: gradient, color: [0.1, 0.2, 0.3], ambient: [0.5, 0.6, 0.7]}\n"                               \
    "lights: {lamp: {position: [4, 7, -5]}, other: {position: [-6, 2, -1], color: [0.2, 0.3, 1]}}\n"                 \
    "materials:\n"                                                                                                   \
    "  dull: {diffuse: 0.7, ambient: 0.1, specular: 0.4, shininess: 40, color: [0.8, 0.3, 0.2]}\n"                   \
    "  tiles: {diffuse: 0.7, ambient: 0.1, checker: 0.25, color: [0.8, 0.8, 0.8], checker_color: [0.2, 0.3, 0.4]}\n" \
    "  green: {diffuse: 0.8, ambient: 0.2, color: [0.1, 0.9, 0.1]}\n"                                                \
    "  glow: {diffuse: 0.3, emission: 0.4, specular: 0.5, shininess: 9, color: [0.9, 0.1, 0.7]}\n"

static const char flat_scene[] = HEAD
    "meshes: {prism: {generate: lathe, around: 5, crease_deg: 0, profile: [0, 0, 0.7, 0, 0.5, 1, 0, 1]}, soup: "
    "{generate: sparse, count: 60}}\n"
    "solids:\n"
    "  ground: {shape: plane, material: tiles, checker: 1, rotation: [1, 0, 2]}\n"
    "  crates: {shape: mesh, mesh: prism, material: dull, shading: flat, position: [-2.5, 0.3, 0], rotation: [40, 20, "
    "0],\n"
    "           scale: [1, 1.5, 1], copies: [1, 1, 3], spacing: [0, 0, 2]}\n"
    "  leaves: {shape: mesh, mesh: soup, material: tiles, position: [0, 1, 0], scale: [1.5, 0.8, 1]}\n"
    "  crate: {shape: box, material: tiles, size: [0.8, 1.2, 0.6], position: [2, 0.7, 1.5], rotation: [10, 40, 5]}\n";

static const char round_scene[] = HEAD
    "meshes: {donut: {generate: torus, major: 0.6, minor: 0.25}}\n"
    "solids:\n"
    "  ground: {shape: plane, material: tiles, checker: 1}\n"
    "  ring: {shape: mesh, mesh: donut, material: dull, shading: smooth, position: [-2.5, 0.5, 0], rotation: [40, "
    "20, 0]}\n"
    "  cup: {shape: cup, material: tiles, radius: 0.7, inner_radius: 0.6, height: 1, floor: 0.1, position: [-0.9, "
    "0.1, -1], rotation: [-20, 0, 10]}\n"
    "  can: {shape: cylinder, material: dull, radius: 0.5, height: 1.2, m: 2, position: [0.6, 0.1, 0.5], "
    "rotation: [0, 30, 0]}\n"
    "  ball: {shape: sphere, material: dull, radius: 0.7, position: [2, 0.7, -0.5]}\n"
    "  dish: {shape: lens, material: tiles, radius_1: -0.7, radius_2: 0.8, thickness: 0.1, diameter: 1.1, position: "
    "[-0.1, 1.5, 0.8], rotation: [70, 20, 0]}\n"
    "  pebble: {shape: lens, material: dull, radius_1: 1, radius_2: -0.8, thickness: 0.5, diameter: 1, position: "
    "[1.2, 1.5, 1], rotation: [-40, 0, 20]}\n"
    "  marble: {shape: sphere, transparency: 1, ior: 1.5, specular: 0.9, shininess: 10, diffuse: 0.2, radius: "
    "0.4, position: [0.8, 0.5, -2]}\n";

static double difference_at(const film *a, const film *b, int x, int y)
{
    double most = 0.0;
    for (int c = 0; c < 3; c++)
        most = fmax(most, fabs(film_value(a, x, y, c) - film_value(b, x, y, c)));
    return most;
}

/* The share of pixels that differ by more than a limit between rasterisation and ray casting. */
static double share_beyond(const char *text, const char *assignments, double much)
{
    scene *s = scene_loaded(text, assignments);
    set(s, "render.integrator=raycast");
    render_result *cast = render(s);
    set(s, "render.integrator=zbuffer");
    render_result *rasterised = render(s);
    int beyond = 0;
    for (int y = 0; y < cast->img->height; y++)
        for (int x = 0; x < cast->img->width; x++)
            beyond += difference_at(cast->img, rasterised->img, x, y) > much;
    const double share = (double)beyond / ((double)cast->img->width * cast->img->height);
    render_result_destroy(cast);
    render_result_destroy(rasterised);
    scene_destroy(s);
    return share;
}

static void flat_solids_equal_ray_casting_except_at_edges(void **state)
{
    (void)state;
    static const char *const variants[] = {"",
                                           "render.samples=4",
                                           "render.samples=9",
                                           "render.samples=64",
                                           "crates.shading=smooth",
                                           "crates.shading=gouraud",
                                           "render.lighting=lambert camera.yaw_deg=20",
                                           "camera.position=-2.4,0.9,-0.8 camera.target=-2,0.5,3",
                                           "camera.position=0,30,0 camera.target=0,0,0.001",
                                           "lamp.reach=8 camera.fov_deg=150",
                                           "crate.material_1=glow crate.material_2=green",
                                           "crate.material_rim=glow render.samples=4",
                                           "camera.position=0,0.2,-3 camera.pitch_deg=60"};
    for (size_t v = 0; v < COUNT(variants); v++) {
        const double share = share_beyond(flat_scene, variants[v], 1e-6);
        if (share > 0.0001)
            fail_msg("%s: %g of the pixels differ", variants[v], share);
    }
}

/* Shading uses the solid itself: the remaining differences are where the chord is hit instead of the arc, and outlines.
 * A chord's height is under 2e-4 of the radius; it moves a point along the surface by that over the cosine of
 * incidence, and changes light by about as much. */
static void round_solids_equal_ray_casting_except_at_outlines(void **state)
{
    (void)state;
    static const char *const variants[] = {"",
                                           "render.samples=4",
                                           "camera.position=-0.9,4,-1.2 camera.target=-0.9,0,-1",
                                           "camera.position=0.6,2,-0.5 camera.target=0.6,0.5,0.5",
                                           "can.material_1=glow can.material_2=green camera.position=0,5,-6",
                                           "dish.material_1=green dish.material_2=glow pebble.material_rim=glow "
                                           "can.material_rim=green pebble.material_1=green",
                                           "cup.m=1.6",
                                           "cup.m=0.6 cup.inner_radius=0.5",
                                           "camera.roll_deg=33"};
    for (size_t v = 0; v < COUNT(variants); v++) {
        const double share = share_beyond(round_scene, variants[v], 0.004);
        if (share > 0.001)
            fail_msg("%s: %g of the pixels differ", variants[v], share);
    }
}

/* As for overlapping solids: the one with the higher priority is visible. */
static void the_surface_of_higher_priority_is_visible(void **state)
{
    (void)state;
    static const char text[] = HEAD "meshes: {one: {generate: box}}\n"
                                    "solids:\n"
                                    "  red: {shape: mesh, mesh: one, ambient: 1, color: [1, 0, 0], position: [0, 1, "
                                    "0], rotation: [10, 30, 0], shading: flat}\n"
                                    "  blue: {shape: mesh, mesh: one, ambient: 1, color: [0, 0, 1], position: [0, 1, "
                                    "0], rotation: [10, 30, 0], shading: flat}\n";
    assert_true(share_beyond(text, "red.priority=5 blue.priority=2", 1e-6) < 0.0001);
    assert_true(share_beyond(text, "red.priority=2 blue.priority=5", 1e-6) < 0.0001);
}

/* Stands in for what scene_load would load. */
static void give_mesh(scene *s, mesh *m)
{
    diagnostic why = {0};
    worked(mesh_finish(m, &why), &why);
    mesh_entry_unload(&s->meshes[0]);
    s->meshes[0].data = m;
}

/* White on any surface, black elsewhere; the camera looks along z, and half the image at depth z is z high. */
#define WHITE(size, extra)                                                                                         \
    "render: {width: " #size ", height: " #size ", depth: 0, integrator: zbuffer}\n"                               \
    "camera: {position: [0, 0, 0], yaw_deg: 0, fov_deg: 90}\nbackground: {color: [0, 0, 0], ambient: [1, 1, 1]}\n" \
    "meshes: {web: {generate: box}}\n" extra                                                                       \
    "solids: {it: {shape: mesh, mesh: web, color: [1, 1, 1], ambient: 1, diffuse: 0, shading: flat"

enum { WEB = 64 };
static const char web_scene[] = WHITE(64, "") "}}\n";

/* How often each pixel is covered when triangles are drawn one at a time. */
static void count_cover(const vec3 *vertices, size_t vertex_count, const mesh_triangle *triangles, size_t count,
                        int cover[WEB][WEB])
{
    for (size_t t = 0; t < count; t++) {
        scene *s = scene_from(web_scene);
        give_mesh(s, mesh_of(vertices, vertex_count, &triangles[t], 1));
        render_result *r = render(s);
        for (int y = 0; y < WEB; y++)
            for (int x = 0; x < WEB; x++)
                cover[y][x] += film_value(r->img, x, y, 0) > 0.5;
        render_result_destroy(r);
        scene_destroy(s);
    }
}

/* The point at depth 1 that is visible at (x, y) of the image, in pixels. */
static vec3 seen_at(double x, double y)
{
    return vec3_make(2.0 * x / WEB - 1.0, 1.0 - 2.0 * y / WEB, 1.0);
}

/* A fan whose middle and all but one of its rim's corners are middles of pixels, and eleven of whose sixteen spokes
 * cross more of them. The rim is a square of 40 by 40 pixels: 41 x 41 middles, minus those on the two sides that belong
 * to neighbours. */
static void a_fan_covers_each_pixel_once(void **state)
{
    (void)state;
    static const double rim[16][2] = {{20, 0},   {20, 7},   {20, 20},  {10, 20},         {0, 20},    {-5, 20},
                                      {-20, 20}, {-20, 10}, {-20, 0},  {-20, -3},        {-20, -20}, {-1, -20},
                                      {0, -20},  {13, -20}, {20, -20}, {20, -20.0 / 3.0}};
    vec3 vertices[17];
    mesh_triangle triangles[16];
    vertices[16] = seen_at(30.5, 31.5);
    for (uint32_t k = 0; k < 16; k++) {
        vertices[k] = seen_at(30.5 + rim[k][0], 31.5 + rim[k][1]);
        triangles[k] = k % 3 ? (mesh_triangle){{16, k, (k + 1) % 16}} : (mesh_triangle){{(k + 1) % 16, k, 16}};
    }
    static int cover[WEB][WEB];
    memset(cover, 0, sizeof cover);
    count_cover(vertices, 17, triangles, 16, cover);
    int all = 0;
    for (int y = 0; y < WEB; y++) {
        for (int x = 0; x < WEB; x++) {
            const bool inside = x >= 10 && x < 50 && y >= 11 && y < 51;
            if (cover[y][x] != inside)
                fail_msg("pixel %d, %d is drawn %d times", x, y, cover[y][x]);
            all += cover[y][x];
        }
    }
    assert_int_equal(all, 1600);
}

/* Corners of random depths, some of them behind the camera; the web extends beyond the image. */
static void an_irregular_web_covers_each_pixel_once(void **state)
{
    (void)state;
    enum { N = 8 };
    vec3 vertices[(N + 1) * (N + 1)];
    mesh_triangle triangles[2 * N * N];
    uint64_t seed = 5;
    size_t count = 0;
    for (int j = 0; j <= N; j++) {
        for (int i = 0; i <= N; i++) {
            const double x = 10.0 * i - 8.0 + random_real(&seed, -2.0, 2.0),
                         y = 10.0 * j - 8.0 + random_real(&seed, -2.0, 2.0);
            vertices[j * (N + 1) + i] = vec3_scale(seen_at(x, y), random_real(&seed, 0.01, 5.0));
        }
    }
    for (uint32_t j = 0; j < N; j++) {
        for (uint32_t i = 0; i < N; i++) {
            const uint32_t a = j * (N + 1) + i, b = a + 1, c = a + N + 1, d = c + 1;
            triangles[count++] = (mesh_triangle){{a, b, d}};
            triangles[count++] = (mesh_triangle){{d, a, c}};
        }
    }
    static int cover[WEB][WEB];
    memset(cover, 0, sizeof cover);
    count_cover(vertices, COUNT(vertices), triangles, count, cover);
    for (int y = 0; y < WEB; y++)
        for (int x = 0; x < WEB; x++)
            if (cover[y][x] != 1)
                fail_msg("pixel %d, %d is drawn %d times", x, y, cover[y][x]);
}

/* A floor from far behind the camera to z = 10, one unit below it, is visible where a ray (x, y, 1) reaches it before
 * that: y < -1/10, and |x / y| < 50. */
static void triangles_behind_the_camera_are_clipped(void **state)
{
    (void)state;
    const vec3 corner[4] = {{-50, -1, -1000}, {50, -1, -1000}, {50, -1, 10}, {-50, -1, 10}};
    const mesh_triangle halves[2] = {{{0, 1, 2}}, {{0, 2, 3}}};
    scene *s = scene_from(web_scene);
    give_mesh(s, mesh_of(corner, 4, halves, 2));
    render_result *r = render(s);
    for (int y = 0; y < WEB; y++) {
        for (int x = 0; x < WEB; x++) {
            const double across = (2.0 * x + 1.0) / WEB - 1.0, up = 1.0 - (2.0 * y + 1.0) / WEB;
            const bool seen = up < -0.1 && fabs(across) < -50.0 * up;
            assert_int_equal(film_value(r->img, x, y, 0) > 0.5, seen);
        }
    }
    render_result_destroy(r);
    scene_destroy(s);
}

/* A ramp: red is u, green v, blue 0. */
static const texture *ramp(void)
{
    enum { SIDE = 64 };
    image *img;
    texture *t;
    assert_int_equal(image_create(SIDE, SIDE, &img, NULL), STATUS_OK);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            float *pixel = img->pixel + (y * SIDE + x) * 3;
            pixel[0] = (float)((x + 0.5) / SIDE);
            pixel[1] = (float)((SIDE - y - 0.5) / SIDE);
            pixel[2] = 0.0F;
        }
    }
    assert_int_equal(texture_create(img, TEXTURE_CLAMP, TEXTURE_CLAMP, TEXTURE_BILINEAR, &t, NULL), STATUS_OK);
    image_destroy(img);
    return t;
}

/* A square of 2 by 2 that leans away: z = 2 at y = -1, z = 6 at y = 1. */
static const vec3 leaning[4] = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 6}, {-1, 1, 6}};
static const double leaning_uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
static const uint32_t leaning_halves[2][3] = {{0, 1, 2}, {0, 2, 3}};

static scene *leaning_scene(const char *texturing)
{
    scene *s = scene_from(WHITE(100, "textures: {ramp: {file: ramp.png}}\n") ", texture: ramp}}\n");
    mesh *m = NULL;
    assert_int_equal(mesh_create(4, 2, false, true, false, &m, NULL), STATUS_OK);
    for (int k = 0; k < 4; k++) {
        m->vertices[k] = leaning[k];
        m->uvs[k] = (mesh_uv){leaning_uv[k][0], leaning_uv[k][1]};
    }
    for (int t = 0; t < 2; t++)
        memcpy(m->triangles[t].corner, leaning_halves[t], sizeof leaning_halves[t]);
    give_mesh(s, m);
    s->textures[0].data = ramp();
    set(s, texturing);
    return s;
}

/* By the ray (x, y, 1): z = 2 / (1/2 - y), u = (x z + 1) / 2, v = (y z + 1) / 2: linear over linear. */
static bool in_perspective(double x, double y, double uv[2])
{
    const double z = 2.0 / (0.5 - y);
    uv[0] = 0.5 * (x * z + 1.0);
    uv[1] = 0.5 * (y * z + 1.0);
    return z > 0.0 && uv[0] > 0.0 && uv[0] < 1.0 && uv[1] > 0.0 && uv[1] < 1.0;
}

/* Affine: by the areas between the point and the sides of its triangle, in the image. */
static bool straight(double x, double y, double uv[2])
{
    for (int t = 0; t < 2; t++) {
        double area[3], total_area = 0.0;
        for (int k = 0; k < 3; k++) {
            const vec3 a = leaning[leaning_halves[t][(k + 1) % 3]], b = leaning[leaning_halves[t][(k + 2) % 3]];
            area[k] = (a.x / a.z - x) * (b.y / b.z - y) - (a.y / a.z - y) * (b.x / b.z - x);
            total_area += area[k];
        }
        if (area[0] < 0.0 || area[1] < 0.0 || area[2] < 0.0)
            continue;
        uv[0] = uv[1] = 0.0;
        for (int k = 0; k < 3; k++)
            for (int j = 0; j < 2; j++)
                uv[j] += area[k] / total_area * leaning_uv[leaning_halves[t][k]][j];
        return true;
    }
    return false;
}

/* Returns the largest difference of v from the other texture interpolation. */
static double expect_texture(const char *texturing, bool (*expected)(double, double, double[2]),
                             bool (*other)(double, double, double[2]))
{
    scene *s = leaning_scene(texturing);
    render_result *r = render(s);
    int seen = 0;
    double apart = 0.0;
    for (int j = 0; j < 100; j++) {
        for (int i = 0; i < 100; i++) {
            const double x = (i + 0.5) / 50.0 - 1.0, y = 1.0 - (j + 0.5) / 50.0, edge = 1.0 / 128.0;
            double uv[2], not [2];
            if (!expected(x, y, uv) || !other(x, y, not ) || uv[0] < edge || uv[0] > 1.0 - edge || uv[1] < edge ||
                uv[1] > 1.0 - edge)
                continue; /* the ramp is constant outside its last texels' middles */
            assert_true(fabs(film_value(r->img, i, j, 0) - uv[0]) < 1e-6);
            assert_true(fabs(film_value(r->img, i, j, 1) - uv[1]) < 1e-6);
            apart = fmax(apart, fabs(uv[1] - not [1]));
            seen++;
        }
    }
    assert_true(seen > 1000);
    render_result_destroy(r);
    scene_destroy(s);
    return apart;
}

/* Half way up the left side in the image, v is 1/2 with affine and 1/4 with perspective-correct interpolation: 1/z is
 * the mean there. */
static void texture_interpolation_is_perspective_correct(void **state)
{
    (void)state;
    assert_true(expect_texture("render.texturing=perspective", in_perspective, straight) > 0.2);
}

static void affine_texture_interpolation_equals_its_closed_form(void **state)
{
    (void)state;
    assert_true(expect_texture("render.texturing=affine", straight, in_perspective) > 0.2);
}

/* Where all corners are equally far both are correct; elsewhere analytic solids show the difference too, and the ray
 * caster is correct. */
static void boxes_support_both_texture_interpolations(void **state)
{
    (void)state;
    static const char text[] = "render: {width: 60, height: 60, depth: 0, integrator: zbuffer, shadows: off}\n"
                               "camera: {position: [0, 0, -3], yaw_deg: 0}\n"
                               "background: {ambient: [1, 1, 1]}\ntextures: {ramp: {file: ramp.png}}\n"
                               "solids: {it: {shape: box, texture: ramp, ambient: 1, size: [2, 2, 2]}}\n";
    static const char *const how[] = {"render.texturing=perspective", "render.texturing=affine",
                                      "render.integrator=raycast"};
    for (int turned = 0; turned < 2; turned++) {
        scene *s = scene_from(text);
        render_result *r[3];
        double apart[3] = {0.0, 0.0, 0.0};
        s->textures[0].data = ramp();
        set(s, turned ? "it.rotation=40,0,0" : "it.rotation=0,0,30");
        for (int k = 0; k < 3; k++) {
            set(s, how[k]);
            r[k] = render(s);
        }
        for (int y = 25; y < 35; y++)
            for (int x = 25; x < 35; x++)
                for (int k = 0; k < 2; k++)
                    apart[k] = fmax(apart[k], difference_at(r[k]->img, r[2]->img, x, y));
        assert_true(apart[0] < 1e-6);
        assert_true(turned ? apart[1] > 0.02 : apart[1] < 1e-6);
        for (int k = 0; k < 3; k++)
            render_result_destroy(r[k]);
        scene_destroy(s);
    }
}

/* The last scene has an affine texture on triangles that the near plane clips. */
static void the_film_does_not_depend_on_the_order_of_drawing(void **state)
{
    (void)state;
    one_film_only(scene_loaded(flat_scene, "render.integrator=zbuffer"));
    one_film_only(scene_loaded(round_scene, "render.integrator=zbuffer"));
    scene *s = leaning_scene("render.texturing=affine");
    set(s, "camera.position=0.2,0.5,3.2");
    one_film_only(s);
}

static void covered_points_are_counted_and_no_rays_are_tested(void **state)
{
    (void)state;
    need_counters();
    scene *s = scene_loaded(
        round_scene,
        "render.integrator=zbuffer render.samples=4 render.shadows=opaque render.lighting=whitted render.depth=5");
    render_result *r = render(s);
    const ray_counters *c = &r->counters;
    assert_int_equal(c->camera, 4 * 200 * 150);
    assert_int_equal(c->shadow + c->reflect + c->refract, 0);
    uint64_t covered = 0;
    for (int k = 0; k < COUNTERS_SOLID_MAX; k++) {
        assert_int_equal(c->tests[k], 0);
        covered += c->first_hits[k];
    }
    for (size_t k = 0; k < s->solid_count; k++)
        assert_true(c->first_hits[k] > 100);
    assert_true(covered > 4 * 200 * 75 && covered < c->camera);
    render_result_destroy(r);
    scene_destroy(s);
}

static void the_depth_buffer_refuses_spectral_films_and_polarisation(void **state)
{
    (void)state;
    static const char *const wrong[] = {"render.spectrum=spectral", "render.polarisation=on"};
    for (size_t k = 0; k < COUNT(wrong); k++) {
        scene *s = scene_loaded(round_scene, "render.integrator=zbuffer");
        diagnostic why = {0};
        set(s, wrong[k]);
        assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.remedy, "raycast"));
        set(s, "render.integrator=raycast");
        assert_int_equal(scene_check(s, &why), STATUS_OK);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_solids_equal_ray_casting_except_at_edges),
        cmocka_unit_test(round_solids_equal_ray_casting_except_at_outlines),
        cmocka_unit_test(the_surface_of_higher_priority_is_visible),
        cmocka_unit_test(a_fan_covers_each_pixel_once),
        cmocka_unit_test(an_irregular_web_covers_each_pixel_once),
        cmocka_unit_test(triangles_behind_the_camera_are_clipped),
        cmocka_unit_test(texture_interpolation_is_perspective_correct),
        cmocka_unit_test(affine_texture_interpolation_equals_its_closed_form),
        cmocka_unit_test(boxes_support_both_texture_interpolations),
        cmocka_unit_test(the_film_does_not_depend_on_the_order_of_drawing),
        cmocka_unit_test(covered_points_are_counted_and_no_rays_are_tested),
        cmocka_unit_test(the_depth_buffer_refuses_spectral_films_and_polarisation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
