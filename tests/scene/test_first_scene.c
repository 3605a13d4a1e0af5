/* Tests of the first scene out of a glTF file: its camera, lights and glass in the left-handed world. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "mesh_files.h"
#include "scene/assets/mesh_stream.h"
#include "scene/file/write.h"
#include "scene/model/camera.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>

/* Two triangles from -1, -1, 0 to 1, 1, 0; ' stands for ". */
static scene *scene_of(const char *nodes, const char *looks, const char *more, char **notes)
{
    static const float square[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    char *json = text_format(
        "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'children':[%s]}%s%s],'meshes':[{"
        "'primitives':[{'attributes':{'POSITION':0},'mode':6,'material':0}]}],'materials':[{'name':'a',%s}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'}],'bufferViews':[{'buffer':0,"
        "'byteLength':48}],'buffers':[{'byteLength':48}]%s}",
        *nodes ? "1,2" : "", *nodes ? "," : "", nodes, looks, more);
    bytes data = {0};
    add_floats(&data, square, 12);
    for (char *c = json; *c; c++)
        *c = *c == '\'' ? '"' : *c;
    bytes b = glb_of(json, data.at, data.size);
    put("first.glb", b.at, b.size);
    free(b.at), free(data.at), free(json);
    char *path = in_folder("first.glb"), text[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {.what = ""};
    scene *s;
    if (mesh_first_scene(path, &s, notes, &why) != STATUS_OK || scene_load(s, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, text, sizeof text));
    free(path);
    return s;
}

static void assert_near(vec3 got, double x, double y, double z)
{
    if (!(fabs(got.x - x) < 1e-12 && fabs(got.y - y) < 1e-12 && fabs(got.z - z) < 1e-12))
        fail_msg("%.15g %.15g %.15g is not %g %g %g", got.x, got.y, got.z, x, y, z);
}

/* In the file the camera is at z = 4 and looks along -z, with its right side up (a quarter turn about z). Here it is at
 * z = -4, and its up points to the left: -x in both. */
static void the_camera_is_that_of_the_file(void **state)
{
    (void)state;
    char *notes;
    scene *s = scene_of(
        "{'camera':0,'translation':[0,0.5,4],'rotation':[0,0,1,1]},{'camera':0,'children':[3]},{'camera':1}",
        "'doubleSided':true", ",'cameras':[{'perspective':{'yfov':0.5,'aspectRatio':2}},{'name':'side'}]", &notes);
    const camera_frame f = camera_frame_of(s);
    assert_near(f.eye, 0, 0.5, -4);
    assert_near(f.forward, 0, 0, 1);
    assert_near(f.up, -1, 0, 0);
    assert_true(fabs(f.half_height - tan(0.25)) < 1e-12);
    assert_int_equal(s->render.width, 2 * s->render.height);
    assert_non_null(strstr(notes, "a scene has one camera: camera 2, which has no name, is left out"));
    assert_non_null(strstr(notes, "a scene has one camera: 'side' is left out"));
    scene_destroy(s);
    free(notes);
}

/* A sun of 3 lx along -z, and a spot of 4 cd at a distance of 2, which gives 1: a quarter of the sum. */
static void the_lights_sum_up_to_one(void **state)
{
    (void)state;
    char *notes;
    scene *s = scene_of("{'extensions':{'KHR_lights_punctual':{'light':0}}},"
                        "{'translation':[0,0,2],'extensions':{'KHR_lights_punctual':{'light':1}}}",
                        "'doubleSided':true",
                        ",'extensions':{'KHR_lights_punctual':{'lights':[{'type':'directional','intensity':3},{'type':"
                        "'spot','color':[0.5,1,0.25],'intensity':4,'spot':{'outerConeAngle':0.5}}]}}",
                        &notes);
    assert_int_equal(s->light_count, 2);
    const light *sun = &s->lights[0], *spot = &s->lights[1];
    assert_int_equal(sun->kind, LIGHT_SUN);
    assert_near(vec3_normalize(vec3_sub(sun->target, sun->position)), 0, 0, 1);
    assert_true(fabs(sun->intensity - 0.75) < 1e-15 && fabs(spot->intensity - 0.25) < 1e-15);
    assert_int_equal(spot->kind, LIGHT_SOFT_CONE);
    assert_near(spot->position, 0, 0, -2);
    assert_near(vec3_normalize(vec3_sub(spot->target, spot->position)), 0, 0, 1);
    assert_near(spot->color, 0.5, 1, 0.25);
    assert_true(spot->reach == 2 && fabs(spot->half_angle_deg - 0.5 * 180 / M_PI) < 1e-12);
    scene_destroy(s);
    free(notes);
}

/* Without camera and light the whole mesh is in the image: every corner is less than half its height from the middle.
 * n_d = 1.5 and Abbe's number 50: n_F - n_C = 0.01. */
static void glass_and_defaults(void **state)
{
    (void)state;
    char *notes, *text;
    scene *s = scene_of("",
                        "'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},'KHR_materials_volume':{"
                        "'thicknessFactor':1,'attenuationDistance':2,'attenuationColor':[0.5,1,1]},"
                        "'KHR_materials_dispersion':{'dispersion':0.4}}",
                        "", &notes);
    const camera_frame f = camera_frame_of(s);
    for (int k = 0; k < 4; k++) {
        const vec3 to = vec3_sub(vec3_make(k % 2 ? 1 : -1, k / 2 ? 1 : -1, 0), f.eye);
        const double depth = vec3_dot(to, f.forward);
        assert_true(fabs(vec3_dot(to, f.up)) < depth * f.half_height &&
                    fabs(vec3_dot(to, f.right)) < depth * f.half_width);
    }
    assert_int_equal(s->light_count, 1);
    const solid *body = &s->solids[0];
    assert_true(body->material_index == 0 && body->surface.transparency == 1 && body->surface.tint_distance == 2);
    assert_true(body->surface.color.x == 0.5);
    index_law law;
    assert_int_equal(material_index_law(&body->surface, "a", &law, NULL), STATUS_OK);
    assert_true(fabs(index_law_at(&law, 587.56) - 1.5) < 1e-12);
    assert_true(fabs(index_law_at(&law, 486.13) - index_law_at(&law, 656.27) - 0.01) < 1e-12);
    assert_int_equal(scene_write_text(s, NULL, false, &text, NULL), STATUS_OK);
    assert_non_null(strstr(text, "first.glb"));
    free(text);
    scene_destroy(s);
    free(notes);
}

/* Alpha that blends or masks leaves holes in a surface, and no glass. */
static void alpha_is_no_glass(void **state)
{
    (void)state;
    static const char *const looks[] = {"'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.5]}",
                                        "'alphaMode':'MASK','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.25]}"};
    for (int i = 0; i < 2; i++) {
        char *notes;
        scene *s = scene_of("", looks[i], "", &notes);
        assert_int_equal(s->render.transmission, TRANSMISSION_REFRACT);
        assert_true(!notes || !strstr(notes, "light goes straight"));
        scene_destroy(s);
        free(notes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_camera_is_that_of_the_file),
        cmocka_unit_test(the_lights_sum_up_to_one),
        cmocka_unit_test(glass_and_defaults),
        cmocka_unit_test(alpha_is_no_glass),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
