/* Tests of colours of vertices: the numbers of files as linear colours, their way through meshes, writers and packages,
 * and their mix in images, against barycentric weights. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/budget.h"
#include "geometry/hierarchy/hierarchy.h"
#include "image/image.h"
#include "import/mesh_wire.h"
#include "mesh_read.h"
#include "render_fixture.h"
#include "report/mesh_writers.h"
#include "scene/model/edit/edit.h"
#include "scene/model/face_materials.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"
#include "study/plan/identity.h"

/* --- the numbers of files --- */

/* The colours of a mesh of three vertices in the order of its corners. */
static void assert_colors(const mesh_import *got, const double expected[9], double tolerance, const char *what)
{
    assert_non_null(got->mesh->colors);
    for (int i = 0; i < 9; i++) {
        const double value = (double)got->mesh->colors[got->mesh->triangles[0].corner[i / 3]][i % 3];
        if (!(fabs(value - expected[i]) <= tolerance))
            fail_msg("%s: number %d is %.9g instead of %.9g", what, i, value, expected[i]);
    }
}

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define RGB(type) "property " type " red\nproperty " type " green\nproperty " type " blue\n"
#define PLY(colors)                                                                                                   \
    "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ colors "element face 1\nproperty list uchar int vertex_indices\n" \
    "end_header\n"
#define FACE "3 0 1 2\n"
#define CLAMPED "colours of vertices outside 0 to 1 are clamped"
#define CLEAR "the alpha of vertices is ignored"

static void ply_and_obj_files_have_srgb(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text, *note;
        double encoded[9];
    } cases[] = {
        {"bytes.ply",
         PLY(RGB("uchar")) "0 0 0 0 51 102\n1 0 0 153 204 255\n0 1 0 1 2 128\n" FACE,
         NULL,
         {0, 0.2, 0.4, 0.6, 0.8, 1, 1 / 255.0, 2 / 255.0, 128 / 255.0}},
        {"words.ply",
         PLY(RGB("ushort")) "0 0 0 0 13107 26214\n1 0 0 65535 1 2\n0 1 0 3 4 5\n" FACE,
         NULL,
         {0, 0.2, 0.4, 1, 1 / 65535.0, 2 / 65535.0, 3 / 65535.0, 4 / 65535.0, 5 / 65535.0}},
        {"ints.ply",
         PLY(RGB("int")) "0 0 0 0 51 102\n1 0 0 153 204 255\n0 1 0 0 0 0\n" FACE,
         NULL,
         {0, 0.2, 0.4, 0.6, 0.8, 1, 0, 0, 0}},
        {"floats.ply",
         PLY(RGB("float")) "0 0 0 0 .2 .4\n1 0 0 .6 .8 1\n0 1 0 .01 .02 .03\n" FACE,
         NULL,
         {0, 0.2, 0.4, 0.6, 0.8, 1, 0.01, 0.02, 0.03}},
        {"far.ply",
         PLY(RGB("double")) "0 0 0 -1 .2 .4\n1 0 0 .6 .8 7\n0 1 0 0 0 1\n" FACE,
         CLAMPED,
         {0, 0.2, 0.4, 0.6, 0.8, 1, 0, 0, 1}},
        {"diffuse.ply",
         PLY("property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n"
             "property uchar alpha\n") "0 0 0 0 51 102 255\n1 0 0 153 204 255 254\n0 1 0 0 0 0 255\n" FACE,
         CLEAR,
         {0, 0.2, 0.4, 0.6, 0.8, 1, 0, 0, 0}},
        {"opaque.ply",
         PLY(RGB("uchar") "property uchar alpha\n") "0 0 0 0 51 102 255\n1 0 0 153 204 255 255\n"
                                                    "0 1 0 0 0 0 255\n" FACE,
         NULL,
         {0, 0.2, 0.4, 0.6, 0.8, 1, 0, 0, 0}},
        {"plain.obj",
         "v 0 0 0 0 .2 .4\nv 1 0 0 .6 .8 1\nv 0 1 0 .01 .02 .03\nf 1 2 3\n",
         NULL,
         {0, 0.2, 0.4, 0.6, 0.8, 1, 0.01, 0.02, 0.03}},
        {"some.obj", "v 0 0 0\nv 1 0 0 .6 .8 1 1\nv 0 1 0 1\nf 1 2 3\n", NULL, {1, 1, 1, 0.6, 0.8, 1, 1, 1, 1}},
        {"clear.obj",
         "v 0 0 0 0 0 0 .5\nv 1 0 0 \\\n.6 \\\n.8 1\nv 0 1 0 #1 1 1\nf 1 2 3\n",
         CLEAR,
         {0, 0, 0, 0.6, 0.8, 1, 1, 1, 1}},
        {"bytes.obj", "v 0 0 0 0 51 102\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n", CLAMPED, {0, 1, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_import *got = read_text(cases[i].name, cases[i].text);
        double linear[9];
        for (int k = 0; k < 9; k++)
            linear[k] = srgb_decode(cases[i].encoded[k]);
        assert_colors(got, linear, 1e-7, cases[i].name);
        if (cases[i].note)
            assert_string_equal(got->note, cases[i].note);
        else
            assert_null(got->note);
        mesh_import_destroy(got);
    }
    mesh_import *got = read_text(
        "lone.ply", PLY("property uchar red\nproperty uchar alpha\n") "0 0 0 1 2\n1 0 0 1 2\n0 1 0 1 2\n" FACE);
    assert_true(!got->mesh->colors && !got->note);
    mesh_import_destroy(got);
}

static void binary_ply_files_have_either_order(void **state)
{
    (void)state;
    for (int big = 0; big < 2; big++) {
        char *header = text_format("ply\nformat binary_%s_endian 1.0\nelement vertex 3\n" RGB("ushort") XYZ
                                   "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n",
                                   big ? "big" : "little");
        static const unsigned words[9] = {65535, 0, 256, 1, 13107, 2, 3, 4, 26214};
        static const float places[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        bytes b = {0};
        double linear[9];
        add_text(&b, header);
        free(header);
        for (int i = 0; i < 18; i++) {
            const int k = i / 6 * 3 + i % 3;
            unsigned char at[4];
            uint32_t bits;
            memcpy(&bits, &places[k], sizeof bits);
            const int size = i % 6 < 3 ? 2 : 4;
            for (int byte = 0; byte < size; byte++)
                at[big ? size - 1 - byte : byte] =
                    (unsigned char)((size == 2 ? (uint32_t)words[k] : bits) >> 8 * byte & 0xff);
            add(&b, at, (size_t)size);
            linear[k] = srgb_decode(words[k] / 65535.0);
        }
        add(&b, "\3\0\1\2", 4);
        mesh_import *got = read_bytes("words.ply", b);
        assert_colors(got, linear, 1e-7, "binary");
        mesh_import_destroy(got);
    }
}

/* Large OBJ files are read in parts: the first part may lack colours, and another be without its last ones. */
static void every_part_of_an_obj_file_has_its_colors(void **state)
{
    (void)state;
    enum { COUNT = 90000 };
    bytes b = {0};
    for (int i = 0; i < COUNT; i++) {
        char line[120];
        const bool colored = i == COUNT / 2 + 1 || i == COUNT - 2;
        snprintf(line, sizeof line, "v %d %d %d%s # a comment to make the file long\n", i, i % 7, i % 11,
                 colored ? " 1 0 0" : "");
        add_text(&b, line);
    }
    char last[200];
    snprintf(last, sizeof last, "f 1 %d %d\nf %d %d %d\n", COUNT / 2 + 2, COUNT / 2 + 3, COUNT / 2, COUNT - 1, COUNT);
    add_text(&b, last);
    mesh_import *got = read_bytes("parts.obj", b);
    for (int i = 0; i < 6; i++) {
        const float *color = got->mesh->colors[got->mesh->triangles[i / 3].corner[i % 3]];
        const float other = i % 3 == 1 ? 0.0F : 1.0F;
        assert_true(color[0] == 1.0F && color[1] == other && color[2] == other);
    }
    mesh_import_destroy(got);
}

/* A vertex with another colour is another vertex, even at the same place; with the same colour it is one. */
static void vertices_are_joined_by_their_colors(void **state)
{
    (void)state;
    mesh_import *got =
        read_text("two.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 0 1 0 0\nv 1 0 0 0 1 1\n"
                             "v 0 -1 0 0 0 0\nf 1 2 3\nf 4 6 5\n");
    assert_int_equal(got->mesh->vertex_count, 5);
    assert_int_equal(got->mesh->triangles[0].corner[0], got->mesh->triangles[1].corner[0]);
    mesh_import_destroy(got);
}

/* --- glTF --- */

static mesh_import *read_gltf(const char *name, const char *primitives, const char *accessors, bytes data,
                              const char *materials)
{
    char *json =
        text_format("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[%s]}],"
                    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},%s],"
                    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,"
                    "\"byteLength\":%zu}],\"buffers\":[{\"byteLength\":%zu}]%s}",
                    primitives, accessors, data.size - 36, data.size, materials);
    const size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    char *text = malloc(padded + 1);
    assert_non_null(text);
    snprintf(text, padded + 1, "%-*s", (int)padded, json);
    bytes b = glb_of(text, data.at, data.size);
    free(json);
    free(text);
    free(data.at);
    return read_bytes(name, b);
}

#define PRIMITIVE "{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1}}"
#define COLORS(type, of) \
    "{\"bufferView\":1,\"componentType\":" #type ",\"normalized\":true,\"count\":3,\"type\":\"" of "\"}"

static bytes three(const float numbers[9])
{
    bytes b = {0};
    add_floats(&b, numbers, 9);
    return b;
}

static const float places_xyz[9] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};

/* 3.7.2.1: floats, or normalised bytes or words; linear. */
static void gltf_files_have_linear_colors(void **state)
{
    (void)state;
    static const float reals[12] = {0, 0.25F, 0.5F, 1, 1, 0.125F, 0, 1, 0.75F, 0, 0.5F, 1};
    static const double expected[9] = {0, 0.25, 0.5, 1, 0.125, 0, 0.75, 0, 0.5};
    for (int form = 0; form < 4; form++) {
        const char *of[] = {COLORS(5126, "VEC4"), COLORS(5126, "VEC3"), COLORS(5121, "VEC4"), COLORS(5123, "VEC4")};
        bytes b = three(places_xyz);
        for (int i = 0; i < 12; i++) {
            const unsigned word = (unsigned)lrintf(reals[i] * (form == 2 ? 255.0F : 65535.0F));
            const unsigned char at[2] = {(unsigned char)word, (unsigned char)(word >> 8)};
            if (form < 2 && !(form == 1 && i % 4 == 3))
                add_float(&b, reals[i]);
            else if (form >= 2)
                add(&b, at, form == 2 ? 1 : 2);
        }
        mesh_import *got = read_gltf("colors.glb", PRIMITIVE, of[form], b, "");
        assert_colors(got, expected, form == 2 ? 0.003 : form == 3 ? 1e-5 : 0, of[form]);
        assert_null(got->note);
        mesh_import_destroy(got);
    }
}

/* Two primitives of one material: one has colours, the other is white. The material keeps its own colour. */
static void primitives_without_colors_are_white(void **state)
{
    (void)state;
    bytes b = three(places_xyz);
    for (int i = 0; i < 3; i++)
        add_floats(&b, (float[3]){0.5F, 0.25F, 2.0F}, 3);
    mesh_import *got = read_gltf("white.glb",
                                 "{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1},\"material\":0},"
                                 "{\"attributes\":{\"POSITION\":0},\"material\":0}",
                                 COLORS(5126, "VEC3"), b,
                                 ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,1,1]}}]");
    assert_colors(got, (const double[9]){0.5, 0.25, 1, 0.5, 0.25, 1, 0.5, 0.25, 1}, 0, "colored");
    for (int k = 0; k < 3; k++)
        assert_true(got->mesh->colors[got->mesh->triangles[1].corner[k]][1] == 1.0F);
    assert_true(got->materials[0].color[0] == 0.5 && got->materials[0].color[1] == 1);
    assert_string_equal(got->note, CLAMPED);
    mesh_import_destroy(got);
}

/* --- images --- */

#define TRIANGLE_OBJ "v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n"
#define QUAD_OBJ "v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 1 1 0 0 0 1\nv -1 1 0 1 1 1\nf 1 2 3 4\n"

static void put_triangles(void)
{
    put_text("t.obj", TRIANGLE_OBJ);
    put_text("quad.obj", QUAD_OBJ);
    put_text("t.ply", PLY(RGB("uchar")) "-1 -1 0 255 0 0\n1 -1 0 0 255 0\n0 1 0 0 0 255\n" FACE);
    bytes b = three(places_xyz);
    add_floats(&b, (float[9]){1, 0, 0, 0, 1, 0, 0, 0, 1}, 9);
    mesh_import_destroy(read_gltf("t.glb", PRIMITIVE, COLORS(5126, "VEC3"), b, ""));
}

/* A scene in the folder of the files, with the camera in front of the point (x, y, 0), as a single narrow pixel. */
static scene *scene_of(const char *file, const char *values, double x, double y)
{
    char *text =
        text_format("render: {width: 1, height: 1, depth: 2, paths: 8}\n"
                    "camera: {position: [%.17g, %.17g, -4], target: [%.17g, %.17g, 0], fov_deg: 0.0001}\n"
                    "background: {color: [1, 1, 1], ambient: [1, 1, 1]}\n"
                    "meshes: {m: {file: %s}}\nmaterials: {grey: {color: [0.5, 0.5, 0.5], ambient: 1, diffuse: 1}}\n"
                    "solids: {body: {shape: mesh, mesh: m, %s}}\n",
                    x, y, x, y, file, values);
    char *path = in_folder("scene.yaml");
    put_text("scene.yaml", text);
    free(text);
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_read(path, &s, &why), &why);
    worked(scene_load(s, &why), &why);
    free(path);
    return s;
}

static void expect(const scene *s, const double expected[3], double tolerance, const char *what)
{
    const vec3 seen = look(s);
    if (!(fabs(seen.x - expected[0]) <= tolerance && fabs(seen.y - expected[1]) <= tolerance &&
          fabs(seen.z - expected[2]) <= tolerance))
        fail_msg("%s: %.9g %.9g %.9g instead of %.9g %.9g %.9g", what, seen.x, seen.y, seen.z, expected[0], expected[1],
                 expected[2]);
}

#define AMBIENT "ambient: 1, diffuse: 0"

/* In ambient light, or under a white sky, a point has the barycentric mix of the corners. */
static void a_point_is_the_mix_of_its_corners(void **state)
{
    (void)state;
    static const char *const files[] = {"t.obj", "t.ply", "t.glb"};
    static const double points[][2] = {{0, 0}, {-0.5, -0.75}, {0.5, -0.75}, {0.0625, 0.75}, {-0.25, 0.25}};
    static const char *const settings[] = {"render.integrator=whitted", "render.integrator=raycast",
                                           "render.integrator=zbuffer", "render.integrator=path",
                                           "render.integrator=aov render.layer=albedo"};
    put_triangles();
    for (size_t f = 0; f < 3; f++)
        for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
            const double blue = (points[i][1] + 1) / 2, green = (points[i][0] + 1 - blue) / 2,
                         mix[3] = {1 - green - blue, green, blue};
            scene *s = scene_of(files[f], "ambient: 1, diffuse: 1", points[i][0], points[i][1]);
            for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
                set_all(s, settings[k]);
                expect(s, mix, 1e-6, settings[k]);
            }
            scene_destroy(s);
        }
}

/* A quadrilateral is divided at its first corner. */
static void a_quadrilateral_has_two_mixes(void **state)
{
    (void)state;
    put_triangles();
    scene *s = scene_of("quad.obj", AMBIENT, 0.5, -0.5); /* a quarter of corners 1 and 3, half of 2 */
    expect(s, (const double[3]){0.25, 0.5, 0.25}, 1e-6, "below");
    scene_destroy(s);
    s = scene_of("quad.obj", AMBIENT, -0.5, 0.5); /* a quarter of corners 1 and 3, half of 4, which is white */
    expect(s, (const double[3]){0.75, 0.5, 0.75}, 1e-6, "above");
    scene_destroy(s);
}

/* Colours multiply the solid's colour, and light: k_d (N.L) I. */
static void colors_multiply_colour_and_light(void **state)
{
    (void)state;
    put_triangles();
    scene *s = scene_of("t.obj", "color: [0.5, 0.25, 1], ambient: 0.5, diffuse: 0", 0, 0);
    expect(s, (const double[3]){0.0625, 0.03125, 0.25}, 1e-6, "color");
    scene_destroy(s);
    s = scene_of("t.obj", "ambient: 0, diffuse: 0.5, shading: flat", 0, 0);
    diagnostic why = {0};
    size_t lamp;
    worked(scene_add(s, PARAM_LIGHT, "lamp", &lamp, &why), &why);
    set_all(s, "lamp.position=0,0,-2 lamp.intensity=2");
    expect(s, (const double[3]){0.25, 0.25, 0.5}, 1e-6, "lamp");
    scene_destroy(s);
}

/* The same rule as for the colours of an MTL file: they belong to the file's materials, which the scene's replace. */
static void a_material_of_the_scene_replaces_colors(void **state)
{
    (void)state;
    put_triangles();
    put_text("m.mtl", "newmtl red\nKd 1 0.5 0.25\nnewmtl grey\nKd 1 1 1\n");
    put_text("m.obj", "mtllib m.mtl\nusemtl red\n" TRIANGLE_OBJ);
    put_text("n.obj", "mtllib m.mtl\nusemtl grey\n" TRIANGLE_OBJ);
    static const struct {
        const char *file, *values;
        double seen[3];
    } cases[] = {{"t.obj", "material: grey", {0.5, 0.5, 0.5}},
                 {"m.obj", "material: grey", {0.5, 0.5, 0.5}},
                 {"n.obj", "ambient: 1", {0.5, 0.5, 0.5}}, /* by the name of the slot */
                 {"m.obj", "ambient: 1", {0.25, 0.125, 0.125}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene *s = scene_of(cases[i].file, cases[i].values, 0, 0);
        expect(s, cases[i].seen, 1e-6, cases[i].file);
        scene_destroy(s);
    }
}

/* In a spectral film, white vertices change nothing, bit by bit, and others have their colour. */
static void spectral_films_have_the_colors(void **state)
{
    (void)state;
    put_triangles();
    put_text("white.obj", "v -1 -1 0 1 1 1\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    put_text("none.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    scene *white = scene_of("white.obj", "color: [0.9, 0.4, 0.1], ambient: 1", 0, 0),
          *none = scene_of("none.obj", "color: [0.9, 0.4, 0.1], ambient: 1", 0, 0);
    set_all(white, "render.spectrum=spectral");
    set_all(none, "render.spectrum=spectral");
    const vec3 a = look(white), b = look(none);
    assert_non_null(white->meshes[0].data->colors);
    assert_true(a.x == b.x && a.y == b.y && a.z == b.z);
    scene_destroy(white);
    scene_destroy(none);
    static const char *const settings[] = {"render.integrator=whitted", "render.integrator=path"};
    for (size_t k = 0; k < 2; k++) {
        scene *s = scene_of("t.obj", "ambient: 1, diffuse: 1", 0, 0);
        set_all(s, "render.spectrum=spectral render.wavelengths=400 render.paths=400");
        set_all(s, settings[k]);
        expect(s, (const double[3]){0.25, 0.25, 0.5}, 1e-3, settings[k]);
        scene_destroy(s);
    }
}

/* --- identity, packages --- */

static void identity_and_packages_have_the_colors(void **state)
{
    (void)state;
    put_triangles();
    put_text("other.obj", "v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 0 1 0 0 0 .99\nf 1 2 3\n");
    scene *s = scene_of("t.obj", AMBIENT, 0, 0), *other = scene_of("other.obj", AMBIENT, 0, 0);
    uint64_t a = 1, b = 1;
    diagnostic why = {0};
    worked(identity_hash_files(&a, s, &why), &why);
    worked(identity_hash_files(&b, other, &why), &why);
    assert_true(a != b);
    void *content;
    size_t size;
    scene *again = NULL;
    worked(scene_pack(s, &content, &size, &why), &why);
    worked(scene_unpack(content, size, &again, &why), &why);
    const mesh *from = s->meshes[0].data, *to = again->meshes[0].data;
    assert_memory_equal(from->colors, to->colors, from->vertex_count * sizeof *from->colors);
    expect(again, (const double[3]){0.25, 0.25, 0.5}, 1e-6, "package");
    free(content);
    scene_destroy(s);
    scene_destroy(other);
    scene_destroy(again);
}

/* --- layers, repair, writers --- */

/* Two tetrahedra that overlap, each vertex with a colour of its own. */
static void put_pair(bool open)
{
    bytes b = {0};
    for (int i = 0; i < 8; i++) {
        static const int at[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
        char line[120];
        snprintf(line, sizeof line, "v %g %d %d %g %g %g\n", at[i % 4][0] + 0.5 * (i / 4), at[i % 4][1], at[i % 4][2],
                 i / 7.0, 1 - i / 7.0, i % 2 ? 0.3 : 0.6);
        add_text(&b, line);
    }
    for (int i = 0; i < 8 - open; i++) {
        static const int of[4][3] = {{1, 3, 2}, {1, 2, 4}, {1, 4, 3}, {2, 3, 4}};
        char line[60];
        snprintf(line, sizeof line, "f %d %d %d\n", of[i % 4][0] + i / 4 * 4, of[i % 4][1] + i / 4 * 4,
                 of[i % 4][2] + i / 4 * 4);
        add_text(&b, line);
    }
    add(&b, "", 1);
    put_text("pair.obj", (const char *)b.at);
    free(b.at);
}

static bool same_color(const mesh *a, uint32_t v, const mesh *b, uint32_t w)
{
    return memcmp(a->colors[v], b->colors[w], sizeof *a->colors) == 0;
}

static void layers_have_the_colors(void **state)
{
    (void)state;
    put_pair(false);
    scene *s = scene_of("pair.obj", "transparency: 1", 0, 0);
    const mesh *whole = s->meshes[0].data, *const * layers;
    int count;
    diagnostic why = {0};
    worked(scene_mesh_operands(s, &s->solids[0], &layers, &count, &why), &why);
    assert_int_equal(count, 2);
    for (int i = 0; i < count; i++)
        for (size_t t = 0; t < layers[i]->triangle_count; t++)
            for (int k = 0; k < 3; k++) {
                bool found = false;
                for (int q = 0; q < 3; q++)
                    found |= same_color(layers[i], layers[i]->triangles[t].corner[k], whole,
                                        whole->triangles[layers[i]->numbers[t]].corner[q]);
                assert_true(found);
            }
    scene_destroy(s);
}

static void a_closed_mesh_keeps_the_colors(void **state)
{
    (void)state;
    put_pair(true);
    mesh_import *got = read_mesh("pair.obj");
    mesh_repairs repairs = {0};
    mesh *closed;
    diagnostic why = {0};
    worked(mesh_repair(got->mesh, 0.0, &repairs, &closed, &why), &why);
    assert_true(closed->closed && closed->colors);
    for (size_t v = 0; v < closed->vertex_count; v++) {
        bool found = false;
        for (size_t w = 0; w < got->mesh->vertex_count; w++)
            found |= memcmp(&closed->vertices[v], &got->mesh->vertices[w], sizeof(vec3)) == 0 &&
                     same_color(closed, (uint32_t)v, got->mesh, (uint32_t)w);
        assert_true(found);
    }
    free(repairs.fills);
    mesh_release(closed);
    mesh_import_destroy(got);
}

/* Bytes, and all colours of a GLB file, are read back exactly; others with the rounding of floats. */
static void written_files_have_the_colors(void **state)
{
    (void)state;
    static const char *const texts[] = {"v -1 -1 0 .2 .4 .6\nv 1 -1 0 1 .8 0\nv 0 1 0 0 0 1\nf 1 2 3\n",
                                        "v -1 -1 0 .21 .43 .61\nv 1 -1 0 1 .8 .001\nv 0 1 0 .05 0 1\nf 1 2 3\n"};
    for (int i = 0; i < 2 * MESH_FORMAT_COUNT; i++) {
        const mesh_format format = (mesh_format)(i / 2);
        mesh_import *got = read_text("from.obj", texts[i % 2]);
        char *name = text_format("to.%s", mesh_format_name(format)), *path = in_folder(name);
        FILE *to = fopen(path, "wb");
        diagnostic why = {0};
        assert_non_null(to);
        worked(mesh_write(got->mesh, got, format, false, path, to, &why), &why);
        fclose(to);
        double expected[9];
        for (int k = 0; k < 9; k++)
            expected[k] = (double)got->mesh->colors[got->mesh->triangles[0].corner[k / 3]][k % 3];
        mesh_import *again = read_mesh(name);
        assert_colors(again, expected, i % 2 == 0 || format == MESH_GLB ? 0 : 2e-7, name);
        mesh_import_destroy(again);
        mesh_import_destroy(got);
        free(name);
        free(path);
    }
}

/* --- limits --- */

static void colors_count_as_memory_and_are_checked(void **state)
{
    (void)state;
    diagnostic why = {0};
    mesh *m;
    memory_budget_set((uint64_t)1 << 40);
    worked(mesh_create((size_t)1 << 20, 0, false, false, false, &m, &why), &why);
    memory_budget_set(1); /* less than what is in use */
    assert_int_equal(mesh_add_colors(m, &why), STATUS_BAD_INPUT);
    assert_null(m->colors);
    memory_budget_set(0);
    worked(mesh_add_colors(m, &why), &why);
    m->colors[7][1] = NAN;
    assert_int_equal(mesh_finish(m, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "vertex 7 has a colour of nan");
    m->colors[7][1] = 1.0F;
    worked(mesh_finish(m, &why), &why);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_and_obj_files_have_srgb),
        cmocka_unit_test(binary_ply_files_have_either_order),
        cmocka_unit_test(every_part_of_an_obj_file_has_its_colors),
        cmocka_unit_test(vertices_are_joined_by_their_colors),
        cmocka_unit_test(gltf_files_have_linear_colors),
        cmocka_unit_test(primitives_without_colors_are_white),
        cmocka_unit_test(a_point_is_the_mix_of_its_corners),
        cmocka_unit_test(a_quadrilateral_has_two_mixes),
        cmocka_unit_test(colors_multiply_colour_and_light),
        cmocka_unit_test(a_material_of_the_scene_replaces_colors),
        cmocka_unit_test(spectral_films_have_the_colors),
        cmocka_unit_test(identity_and_packages_have_the_colors),
        cmocka_unit_test(layers_have_the_colors),
        cmocka_unit_test(a_closed_mesh_keeps_the_colors),
        cmocka_unit_test(written_files_have_the_colors),
        cmocka_unit_test(colors_count_as_memory_and_are_checked),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
