/* Tests of mirrors: files of right-handed formats in the left-handed world, and negative scales. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "mesh_files.h"
#include "render/plan/film.h"
#include "render_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static render_result *image_of(const char *text, const char *assignments)
{
    scene *s = scene_from(text);
    set_all(s, assignments);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    render_result *r = render(s);
    scene_destroy(s);
    return r;
}

/* The largest difference of two films, the first one flipped from left to right or not. */
static double apart_if(const film *a, const film *b, bool flipped)
{
    double worst = 0.0;
    assert_true(a->width == b->width && a->height == b->height);
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs(film_value(a, flipped ? a->width - 1 - x : x, y, c) - film_value(b, x, y, c)));
    return worst;
}

/* --- a letter F in files --- */

/* The bars of an F that a viewer reads whose x is to the right, y up, and who is at positive z, in the axes of the
 * files: low and high corners. The short bar is the nearest to the viewer. */
static const float bars[3][2][3] = {{{0.0f, 0.0f, 0.0f}, {0.3125f, 2.0f, 0.25f}},
                                    {{0.3125f, 1.6875f, 0.0f}, {1.25f, 2.0f, 0.125f}},
                                    {{0.3125f, 0.875f, 0.0f}, {0.875f, 1.25f, 0.5f}}};
/* Corner k of a bar: bit 0 of k is x, bit 1 y, bit 2 z. Counter-clockwise from outside. */
static const uint8_t sides[12][3] = {{4, 5, 7}, {4, 7, 6}, {1, 0, 2}, {1, 2, 3}, {5, 1, 3}, {5, 3, 7},
                                     {0, 4, 6}, {0, 6, 2}, {6, 7, 3}, {6, 3, 2}, {0, 1, 5}, {0, 5, 4}};

static void find_corner(int bar, int k, float out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = bars[bar][k >> axis & 1][axis];
}

static void add_line(bytes *b, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add_line(bytes *b, const char *format, ...)
{
    char line[256];
    va_list list;
    va_start(list, format);
    const int n = vsnprintf(line, sizeof line, format, list);
    va_end(list);
    assert_true(n >= 0 && n < (int)sizeof line);
    add_text(b, line);
}

/* Corners, and faces of three numbers from `first` on. */
static void add_letter(bytes *b, const char *vertex, const char *face, int first)
{
    for (int v = 0; v < 24; v++) {
        float p[3];
        find_corner(v / 8, v % 8, p);
        add_line(b, "%s%.9g %.9g %.9g\n", vertex, (double)p[0], (double)p[1], (double)p[2]);
    }
    for (int f = 0; f < 36; f++) {
        const uint8_t *s = sides[f % 12];
        const int from = f / 12 * 8 + first;
        add_line(b, "%s%d %d %d\n", face, s[0] + from, s[1] + from, s[2] + from);
    }
}

static void put_stl(void)
{
    bytes b = {0};
    add_text(&b, "solid F\n");
    for (int f = 0; f < 36; f++) {
        add_text(&b, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++) {
            float p[3];
            find_corner(f / 12, sides[f % 12][k], p);
            add_line(&b, "vertex %.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
        }
        add_text(&b, "endloop\nendfacet\n");
    }
    add_text(&b, "endsolid F\n");
    put("f.stl", b.at, b.size);
    free(b.at);
}

static void put_glb(void)
{
    bytes data = {0};
    for (int v = 0; v < 24; v++) {
        float p[3];
        find_corner(v / 8, v % 8, p);
        add_floats(&data, p, 3);
    }
    for (int f = 0; f < 36; f++)
        for (int k = 0; k < 3; k++)
            add(&data, &(uint8_t){(uint8_t)(sides[f % 12][k] + f / 12 * 8)}, 1);
    bytes b =
        glb_of("{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
               "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":24,\"type\":\"VEC3\","
               "\"min\":[0,0,0],\"max\":[1.25,2,0.5]},"
               "{\"bufferView\":1,\"componentType\":5121,\"count\":108,\"type\":\"SCALAR\"}],"
               "\"bufferViews\":[{\"buffer\":0,\"byteLength\":288},"
               "{\"buffer\":0,\"byteOffset\":288,\"byteLength\":108}],\"buffers\":[{\"byteLength\":396}]}",
               data.at, data.size);
    put("f.glb", b.at, b.size);
    free(b.at);
    free(data.at);
}

static void put_letters(void)
{
    bytes obj = {0}, ply = {0};
    add_letter(&obj, "v ", "f ", 1);
    put("f.obj", obj.at, obj.size);
    add_text(&ply, "ply\nformat ascii 1.0\nelement vertex 24\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 36\nproperty list uchar int vertex_indices\nend_header\n");
    add_letter(&ply, "", "3 ", 0);
    put("f.ply", ply.at, ply.size);
    free(obj.at);
    free(ply.at);
    put_stl();
    put_glb();
}

/* The letter as a viewer at negative z sees it, from the left and from above; its z is that of the files, times
 * `sign`. With ending NULL it is made of analytic boxes. */
static render_result *letter(const char *ending, int sign, const char *assignments)
{
    char text[4096];
    int n = snprintf(text, sizeof text,
                     "render: {width: 60, height: 80, depth: 2}\n"
                     "camera: {position: [0.2, 1.9, -5], target: [0.6, 1, 0], fov_deg: 32}\n"
                     "background: {kind: uniform, color: [0.5, 0.6, 0.7]}\n"
                     "lights: {lamp: {position: [-2, 4, -5]}, back: {position: [3, 4, 5]}}\n");
    const char *surface = "color: [0.8, 0.3, 0.1], diffuse: 0.7, ambient: 0.3";
    if (ending)
        n += snprintf(text + n, sizeof text - (size_t)n,
                      "meshes: {letter: {file: %s/f.%s}}\nsolids: {f: {shape: mesh, mesh: letter, %s}}\n", folder,
                      ending, surface);
    else
        n += snprintf(text + n, sizeof text - (size_t)n, "solids:\n");
    for (int bar = 0; bar < 3 && !ending; bar++) {
        double at[3], size[3];
        for (int k = 0; k < 3; k++) {
            at[k] = 0.5 * ((double)bars[bar][0][k] + (double)bars[bar][1][k]) * (k == 2 ? sign : 1);
            size[k] = (double)bars[bar][1][k] - (double)bars[bar][0][k];
        }
        n += snprintf(text + n, sizeof text - (size_t)n,
                      "  bar%d: {shape: box, position: [%.17g, %.17g, %.17g], size: [%.17g, %.17g, %.17g], %s}\n", bar,
                      at[0], at[1], at[2], size[0], size[1], size[2], surface);
    }
    assert_true(n > 0 && n < (int)sizeof text);
    return image_of(text, assignments);
}

static void a_letter_from_each_format_is_read_from_its_front(void **state)
{
    (void)state;
    static const char *const endings[] = {"obj", "ply", "stl", "glb"};
    put_letters();
    render_result *front = letter(NULL, -1, ""), *as_written = letter(NULL, 1, "");
    assert_true(apart_if(front->img, as_written->img, false) > 0.1); /* the bars tell the sign of z */
    for (size_t k = 0; k < COUNT(endings); k++) {
        render_result *converted = letter(endings[k], 0, ""), *right = letter(endings[k], 0, "letter.handedness=right"),
                      *left = letter(endings[k], 0, "letter.handedness=left");
        const double a = apart_if(front->img, converted->img, false), b = apart_if(as_written->img, left->img, false);
        if (!(a < 1e-9 && b < 1e-9 && film_hash(converted->img) == film_hash(right->img)))
            fail_msg("%s: the letter is apart by %g, as it is written by %g", endings[k], a, b);
        render_result_destroy(converted);
        render_result_destroy(right);
        render_result_destroy(left);
    }
    render_result_destroy(front);
    render_result_destroy(as_written);
}

/* Normals at corners are converted with the vertices, and faces keep their outside. */
static void normals_and_fronts_are_converted(void **state)
{
    (void)state;
    put_text("n.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1.5\nvn 0 0.6 0.8\nvt 0 0\nvt 1 0\nvt 0 1\n"
                      "f 1/1/1 2/2/1 3/3/1\nf 2//1 4//1 3//1\n");
    char text[1024];
    snprintf(text, sizeof text, "meshes: {m: {file: %s/n.obj}}\nsolids: {s: {shape: mesh, mesh: m}}\n", folder);
    scene *s = scene_from(text);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    const mesh *m = s->meshes[0].data;
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *corner = m->triangles[t].corner;
        const vec3 a = m->vertices[corner[0]], b = m->vertices[corner[1]], c = m->vertices[corner[2]];
        const vec3 front = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
        assert_true(a.z <= -1.0 && front.z < 0.0 && vec3_dot(front, m->normals[corner[0]]) > 0.0);
        assert_true(fabs(m->normals[corner[0]].y - 0.6) < 1e-15 && fabs(m->normals[corner[0]].z + 0.8) < 1e-15);
    }
    const uint32_t *first = m->triangles[0].corner;
    assert_true(m->vertices[first[1]].y == 1.0 && m->uvs[first[1]].v == 1.0); /* with their texture coordinates */
    scene_destroy(s);
}

static void points_are_in_the_worlds_axes(void **state)
{
    (void)state;
    static const struct {
        const char *assignments;
        double z;
    } cases[] = {{"", 3.0}, {"p.handedness=left", 3.0}, {"p.handedness=right", -3.0}};
    put_text("p.xyz", "1 2 3\n");
    for (size_t k = 0; k < COUNT(cases); k++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "meshes: {p: {file: %s/p.xyz}}\nsolids: {s: {shape: sphere, radius: 0.1, points: p}}\n", folder);
        scene *s = scene_from(text);
        set_all(s, cases[k].assignments);
        diagnostic why = {0};
        worked(scene_load(s, &why), &why);
        const mesh *m = s->meshes[0].data;
        assert_true(m->vertices[0].x == 1.0 && m->vertices[0].y == 2.0 && m->vertices[0].z == cases[k].z);
        assert_true(m->bounds.low.z == cases[k].z && m->bounds.high.z == cases[k].z);
        scene_destroy(s);
    }
}

/* --- negative scales --- */

/* A scene that is its own mirror image in x but for a lump without any symmetry, seen along z. */
#define LUMP(scale, place)                                                                                            \
    "render: {width: 72, height: 54, depth: 6}\ncamera: {position: [0, 1.2, -6], target: [0, 0.3, 0], fov_deg: 34}\n" \
    "background: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: [0.9, 0.8, 0.6]}\n"                                \
    "lights: {lamp: {position: [0, 5, -4]}, back: {position: [0, 3, 6], intensity: 0.6}}\n"                           \
    "meshes: {hills: {generate: terrain, around: 9, tube: 7, size: [1.6, 1.4, 1.1], depth: 0.3, seed: 4}}\n"          \
    "solids:\n  ground: {shape: plane, position: [0.35, -1, 0], checker: 0.7, diffuse: 0.8}\n"                        \
    "  lump: {shape: mesh, mesh: hills, ior: 1.4, transparency: 0.9, specular: 0.4, diffuse: 0.2, color: [0.4, 0.8, " \
    "0.5], absorb_per_m: [0.3, 0.1, 0.4], copies: [2, 1, 2], priority: 1, scale: " scale ", " place "}\n"             \
    "  post: {shape: cylinder, radius: 0.1, height: 0.8, position: [0, -0.4, 0], diffuse: 0.8, priority: 2}\n"

static const char plain[] =
    LUMP("[1, 0.75, 1]", "position: [-0.7, -0.2, -0.4], spacing: [1.9, 1, 1.5], rotation: [12, 0, 0]");
/* Reflections of the axes that together mirror x: rotations by half a turn make up for the others. */
static const char *const mirrored[] = {
    LUMP("[-1, 0.75, 1]", "position: [0.7, -0.2, -0.4], spacing: [-1.9, 1, 1.5], rotation: [12, 0, 0]"),
    LUMP("[1, 0.75, -1]", "position: [0.7, -0.2, -0.4], spacing: [1.9, 1, -1.5], rotation: [-12, 180, 0]"),
    LUMP("[1, -0.75, 1]", "position: [0.7, -0.2, -0.4], spacing: [1.9, -1, 1.5], rotation: [-12, 0, 180]"),
    LUMP("[-1, -0.75, -1]", "position: [0.7, -0.2, -0.4], spacing: [-1.9, -1, -1.5], rotation: [192, 0, 0]"),
};
/* Two reflections are a rotation. */
static const char *const turned[] = {
    LUMP("[-1, 0.75, -1]", "position: [-0.7, -0.2, -0.4], spacing: [-1.9, 1, -1.5], rotation: [-12, 180, 0]"),
    LUMP("[-1, -0.75, 1]", "position: [-0.7, -0.2, -0.4], spacing: [-1.9, -1, 1.5], rotation: [-12, 0, 180]"),
    LUMP("[1, -0.75, -1]", "position: [-0.7, -0.2, -0.4], spacing: [1.9, -1, -1.5], rotation: [192, 0, 0]"),
};

static void expect_mirror_images(const char *assignments, double tolerance)
{
    render_result *a = image_of(plain, assignments);
    assert_true(apart_if(a->img, a->img, true) > 0.1); /* the lump has no symmetry */
    for (size_t k = 0; k < COUNT(mirrored) + COUNT(turned); k++) {
        const bool flipped = k < COUNT(mirrored);
        render_result *b = image_of(flipped ? mirrored[k] : turned[k - COUNT(mirrored)], assignments);
        const double worst = apart_if(a->img, b->img, flipped);
        if (!(worst <= tolerance))
            fail_msg("%s, number %zu: apart by %g", assignments, k, worst);
        render_result_destroy(b);
    }
    render_result_destroy(a);
}

static void negative_scales_mirror(void **state)
{
    (void)state;
    expect_mirror_images("", 1e-8);
    expect_mirror_images("lump.shading=flat render.shadows=attenuated", 1e-8);
    expect_mirror_images("lump.transparency=0 lump.diffuse=0.7 lump.reflectivity=0.2", 1e-8);
    expect_mirror_images("lump.transparency=0 lump.diffuse=0.7 lump.shading=gouraud", 1e-8);
    expect_mirror_images("lump.copies=1,1,1 render.accel=octant", 1e-8);
}

static void negative_scales_mirror_in_the_depth_buffer(void **state)
{
    (void)state;
    /* corners are rounded to the grid, and halves of its steps not to a mirrored point */
    expect_mirror_images("render.integrator=zbuffer", 1e-5);
    expect_mirror_images("render.integrator=zbuffer lump.transparency=0 lump.diffuse=0.7", 1e-5);
}

/* A mirrored solid is not turned inside out. */
static void a_camera_is_inside_a_mirrored_mesh(void **state)
{
    (void)state;
    expect_mirror_images("camera.position=0,-0.3,-0.4 camera.target=0,0.3,3", 1e-8);
    expect_mirror_images("camera.position=0,-0.3,-0.4 camera.target=0,0.3,3 render.integrator=zbuffer", 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_letter_from_each_format_is_read_from_its_front),
        cmocka_unit_test(normals_and_fronts_are_converted),
        cmocka_unit_test(points_are_in_the_worlds_axes),
        cmocka_unit_test(negative_scales_mirror),
        cmocka_unit_test(negative_scales_mirror_in_the_depth_buffer),
        cmocka_unit_test(a_camera_is_inside_a_mirrored_mesh),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
