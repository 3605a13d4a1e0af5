/* Tests of the light that materials of mesh files emit: constant, or by an image, with every integrator; and its way
 * through packages, identities and written files. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "image/image.h"
#include "mesh_read.h"
#include "render_fixture.h"
#include "report/mesh_writers.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"
#include "study/plan/identity.h"

/* Four texels, from the upper left corner on, as bytes: the fractions of 255 are k / 5. */
static const int texels[4][3] = {{5, 0, 0}, {0, 4, 1}, {1, 2, 3}, {5, 5, 5}};

/* An image of the texels, all of them texels[only] if `only` is not negative. */
static void put_image(const char *name, int only)
{
    image *img;
    diagnostic why = {0};
    worked(image_create(2, 2, &img, &why), &why);
    for (int i = 0; i < 12; i++)
        img->pixel[i] = (float)srgb_decode(texels[only < 0 ? i / 3 : only][i % 3] / 5.0);
    char *path = in_folder(name);
    worked(image_write(img, path, 8, &why), &why);
    free(path);
    image_destroy(img);
}

/* The light of a texel, times a colour. */
static vec3 sent(int at, double r, double g, double b)
{
    return vec3_make(r * srgb_decode(texels[at][0] / 5.0), g * srgb_decode(texels[at][1] / 5.0),
                     b * srgb_decode(texels[at][2] / 5.0));
}

/* A square of side 2 in the plane z = 0, with the image upright for a viewer in front, as glTF; the material and what
 * else the document has. */
static void put_square(const char *name, const char *looks, const char *more)
{
    bytes data = {0};
    add_floats(&data, (const float[12]){-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, 12);
    add_floats(&data, (const float[8]){0, 1, 1, 1, 1, 0, 0, 0}, 8);
    add(&data, "\0\1\2\0\2\3\0\0", 8);
    char *json = text_format(
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
        "\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2,\"material\":0}]}],\"materials\":[{%s}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":2,\"componentType\":5121,\"count\":6,\"type\":\"SCALAR\"}],\"bufferViews\":["
        "{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},"
        "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":6}],\"buffers\":[{\"byteLength\":88}],"
        "\"textures\":[{\"source\":0,\"sampler\":0},{\"source\":1,\"sampler\":0}],\"images\":[{\"uri\":\"glow.png\"},"
        "{\"uri\":\"base.png\"}],\"samplers\":[{\"magFilter\":9728,\"minFilter\":9728}]%s}",
        looks, more);
    const size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    char *text = malloc(padded + 1);
    assert_non_null(text);
    snprintf(text, padded + 1, "%-*s", (int)padded, json);
    bytes b = glb_of(text, data.at, data.size);
    put(name, b.at, b.size);
    free(json);
    free(text);
    free(data.at);
    free(b.at);
}

/* A scene in the folder, with its camera in front of (x, y, 0), as a single narrow pixel. */
static scene *scene_of(const char *file, double x, double y)
{
    char *text = text_format("render: {width: 1, height: 1, depth: 2, paths: 8}\n"
                             "camera: {position: [%.17g, %.17g, -4], target: [%.17g, %.17g, 0], fov_deg: 0.0001}\n"
                             "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\nmeshes: {m: {file: %s}}\n"
                             "solids: {body: {shape: mesh, mesh: m}}\n",
                             x, y, x, y, file);
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

static void expect_from(const scene *s, vec3 expected, double tolerance, const char *what)
{
    const vec3 seen = look(s);
    if (!(fabs(seen.x - expected.x) <= tolerance && fabs(seen.y - expected.y) <= tolerance &&
          fabs(seen.z - expected.z) <= tolerance))
        fail_msg("%s: %.9g %.9g %.9g instead of %.9g %.9g %.9g", what, seen.x, seen.y, seen.z, expected.x, expected.y,
                 expected.z);
}

/* Pixels have a width, in which filtered texels differ. */
static void expect(const char *file, double x, double y, vec3 expected)
{
    static const char *const settings[] = {
        "render.integrator=whitted", "render.integrator=raycast", "render.integrator=zbuffer",
        "render.integrator=path",    "render.polarisation=on",    "render.integrator=zbuffer render.texturing=affine"};
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
        scene *s = scene_of(file, x, y);
        set_all(s, settings[k]);
        expect_from(s, expected, strstr(file, ".obj") ? 2e-5 : 1e-6, settings[k]);
        scene_destroy(s);
    }
}

#define GLOW(factor) "\"emissiveFactor\":" factor ",\"emissiveTexture\":{\"index\":0}"
#define BASE(color) "\"pbrMetallicRoughness\":{\"baseColorFactor\":" color ",\"baseColorTexture\":{\"index\":1}}"
#define STRENGTH ",\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":3}}"

/* emissiveTexture x emissiveFactor x emissiveStrength, 3.9.3, whatever the base colour and its image are. */
static void an_image_of_emission_is_seen_exactly(void **state)
{
    (void)state;
    static const char *const materials[] = {GLOW("[0.5,0.25,1]") STRENGTH,
                                            GLOW("[0.5,0.25,1]") STRENGTH "," BASE("[0,0.5,1,1]")};
    put_image("glow.png", -1);
    put_image("base.png", 1);
    for (int m = 0; m < 2; m++) {
        put_square("square.glb", materials[m], "");
        for (int i = 0; i < 4; i++)
            expect("square.glb", i % 2 ? 0.5 : -0.5, i < 2 ? 0.5 : -0.5, sent(i, 1.5, 0.75, 3));
    }
}

/* Without an image the emitted light is the file's, not that of the surface's colour. */
static void constant_emission_has_its_own_color(void **state)
{
    (void)state;
    put_image("base.png", 1);
    put_square("square.glb", "\"emissiveFactor\":[0.5,0.25,1]" STRENGTH "," BASE("[1,1,0,1]"), "");
    expect("square.glb", 0.5, 0.5, vec3_make(1.5, 0.75, 3));
}

static void images_that_cannot_be_shown_emit_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *looks, *note;
    } cases[] = {
        {"\"emissiveTexture\":{\"index\":0}", NULL}, /* the factor's default is 0 */
        {"\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{"
         "\"scale\":[2,2]}}}," BASE("[1,1,1,1]"),
         "images of emission that are laid on unlike those of the colour cannot be shown: their surfaces emit nothing"},
        {"\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0,\"texCoord\":1}",
         "a texture whose coordinates the mesh lacks is left out"},
        {"\"name\":\"m\"," GLOW("[1,1,1]"),
         "the image 'glow.png' of the emission of material 'm' does not exist: it emits nothing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        put_image("base.png", 1);
        put_image("glow.png", -1);
        if (i == 3) {
            char *path = in_folder("glow.png");
            assert_int_equal(unlink(path), 0);
            free(path);
        }
        put_square("square.glb", cases[i].looks, ",\"extensionsUsed\":[\"KHR_texture_transform\"]");
        expect("square.glb", 0.5, 0.5, vec3_make(0, 0, 0));
        mesh_import *got = read_mesh("square.glb");
        if (cases[i].note)
            assert_string_equal(got->note, cases[i].note);
        else
            assert_null(got->note);
        mesh_import_destroy(got);
    }
    put_image("glow.png", -1);
    put_square("square.glb",
               "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{"
               "\"offset\":[0.5,0]}}}",
               "");
    expect("square.glb", 0.5, 0.5, sent(0, 1, 1, 1)); /* moved by half the image */
}

#define SQUARE_OBJ \
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n"

/* map_Ke times Ke; a Ke of 0 is taken as 1, because the image would not be seen. Filtered: at the centre of a texel. */
static void material_libraries_have_images_of_emission(void **state)
{
    (void)state;
    put_image("glow.png", -1);
    put_text("square.obj", "mtllib m.mtl\n" SQUARE_OBJ);
    put_text("m.mtl", "newmtl m\nKd 0.5 0 1\nKe 2 1 0.5\nmap_Ke -clamp on glow.png\n");
    expect("square.obj", -0.5, 0.5, sent(0, 2, 1, 0.5));
    expect("square.obj", 0.5, -0.5, sent(3, 2, 1, 0.5));
    put_text("m.mtl", "newmtl m\nKe 0 0 0\nmap_Ke glow.png\n");
    expect("square.obj", 0.5, 0.5, sent(1, 1, 1, 1));
    put_text("m.mtl", "newmtl m\nKe 2 2 2\nmap_Ke none.png\n");
    expect("square.obj", 0.5, 0.5, vec3_make(0, 0, 0));
}

/* Random paths collect it: a floor has the same light from an image of one colour as from a constant of that colour. */
static void paths_collect_images_of_emission(void **state)
{
    (void)state;
    vec3 seen[2];
    put_image("glow.png", 2);
    for (int textured = 0; textured < 2; textured++) {
        char *constant = text_format("\"emissiveFactor\":[%.17g,%.17g,%.17g]", sent(2, 1, 1, 1).x, sent(2, 1, 1, 1).y,
                                     sent(2, 1, 1, 1).z);
        put_square("square.glb", textured ? GLOW("[1,1,1]") : constant, "");
        free(constant);
        put_text("scene.yaml",
                 "render: {width: 1, height: 1, depth: 2, paths: 4096, integrator: path}\n"
                 "camera: {position: [0, 0.5, -1], target: [0, -1, -1], fov_deg: 1}\n"
                 "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\nmeshes: {m: {file: square.glb}}\n"
                 "solids: {body: {shape: mesh, mesh: m}, floor: {shape: plane, position: [0, -1, 0], diffuse: 1}}\n");
        char *path = in_folder("scene.yaml");
        scene *s = NULL;
        diagnostic why = {0};
        worked(scene_read(path, &s, &why), &why);
        worked(scene_load(s, &why), &why);
        free(path);
        seen[textured] = look(s);
        scene_destroy(s);
    }
    assert_true(seen[0].z > 0.01);
    assert_true(fabs(seen[0].x - seen[1].x) < 1e-6 && fabs(seen[0].y - seen[1].y) < 1e-6 &&
                fabs(seen[0].z - seen[1].z) < 1e-6);
}

static uint64_t hash_of(const scene *s)
{
    uint64_t hash = 1;
    diagnostic why = {0};
    worked(identity_hash_files(&hash, s, &why), &why);
    return hash;
}

/* The image of the colour is also that of the emission: it travels once. */
static void packages_and_identities_have_the_emission(void **state)
{
    (void)state;
    uint64_t hashes[3];
    static const char *const materials[] = {GLOW("[1,1,1]"), GLOW("[1,1,0.5]"),
                                            "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":1}"};
    put_image("glow.png", -1);
    put_image("base.png", 2);
    for (int i = 0; i < 3; i++) {
        put_square("square.glb", materials[i], "");
        scene *s = scene_of("square.glb", 0.5, 0.5);
        hashes[i] = hash_of(s);
        scene_destroy(s);
    }
    assert_true(hashes[0] != hashes[1] && hashes[0] != hashes[2] && hashes[1] != hashes[2]);
    put_square("square.glb", GLOW("[1,1,1]") ",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}", "");
    scene *s = scene_of("square.glb", 0.5, 0.5), *again = NULL;
    const face_material *m = face_materials_at(s->meshes[0].shading_materials, 0);
    assert_true(m->img && m->img == m->glow_img);
    void *content;
    size_t size;
    diagnostic why = {0};
    worked(scene_pack(s, &content, &size, &why), &why);
    worked(scene_unpack(content, size, &again, &why), &why);
    m = face_materials_at(again->meshes[0].shading_materials, 0);
    assert_true(m->img && m->img == m->glow_img && hash_of(s) == hash_of(again));
    expect_from(again, sent(1, 1, 1, 1), 1e-6, "package");
    free(content);
    scene_destroy(s);
    scene_destroy(again);
}

static void written_files_have_the_emission(void **state)
{
    (void)state;
    put_image("glow.png", -1);
    put_square("square.glb", GLOW("[0.5,0.25,1]") STRENGTH, "");
    mesh_import *got = read_mesh("square.glb");
    char *from = in_folder("square.glb"), *path = in_folder("again.glb");
    diagnostic why = {0};
    worked(mesh_textures_find(from, got, &why), &why);
    FILE *to = fopen(path, "wb");
    assert_non_null(to);
    worked(mesh_write(got->mesh, got, MESH_GLB, false, path, to, &why), &why);
    fclose(to);
    expect("again.glb", 0.5, 0.5, sent(1, 1.5, 0.75, 3));
    mesh_import_destroy(got);
    free(from);
    free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_image_of_emission_is_seen_exactly),
        cmocka_unit_test(constant_emission_has_its_own_color),
        cmocka_unit_test(images_that_cannot_be_shown_emit_nothing),
        cmocka_unit_test(material_libraries_have_images_of_emission),
        cmocka_unit_test(paths_collect_images_of_emission),
        cmocka_unit_test(packages_and_identities_have_the_emission),
        cmocka_unit_test(written_files_have_the_emission),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
