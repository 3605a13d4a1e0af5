/* Tests of edits: new objects have the defaults of a file, rotations are correct, and a failed edit changes nothing.
 * Run from the repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random_stream.h"
#include "render_fixture.h"
#include "scene/file/write.h"
#include "scene/model/edit/edit.h"
#include "scene/model/names.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>

/* The expected rotations use libm's sines, multiplied below. */
#define RADIANS (3.14159265358979323846 / 180.0)

static const char small_scene[] = "materials: {glass: {ior: 1.5, transparency: 1}, clay: {diffuse: 0.5}, spare: {}}\n"
                                  "lights: {lamp: {position: [1, 2, 3]}, other: {}}\n"
                                  "solids: {a: {shape: box, material: glass}, b: {shape: sphere, material: clay},\n"
                                  "  c: {shape: cup, material: clay, position: [1, 2, 3], diffuse: 0.25}}\n";

static char *text_of(const scene *s)
{
    char *text = NULL;
    diagnostic why = {0};
    worked(scene_write_text(s, "", true, &text, &why), &why);
    return text;
}

static void assert_vector(vec3 v, double x, double y, double z)
{
    if (!(v.x == x && v.y == y && v.z == z))
        fail_msg("%.17g,%.17g,%.17g is not %.17g,%.17g,%.17g", v.x, v.y, v.z, x, y, z);
}

static void added_objects_have_the_defaults_of_a_file(void **state)
{
    (void)state;
    static const char *const shapes[] = {"plane", "cylinder", "cup",  "box",   "sphere",
                                         "mesh",  "torus",    "cone", "prism", "lens"};
    assert_int_equal(sizeof shapes / sizeof *shapes, SHAPE_COUNT);
    for (int k = 0; k < SHAPE_COUNT; k++) {
        char file[300];
        snprintf(file, sizeof file,
                 "meshes: {body: {generate: box}}\ntextures: {wood: {file: wood.png}}\nmaterials: {stuff: {}}\n"
                 "lights: {lamp: {}}\nsolids: {thing: {shape: %s%s}}\n",
                 shapes[k], k == SHAPE_MESH ? ", mesh: body" : "");
        scene *read = scene_from(file), *made = scene_create();
        size_t stuff = 9, lamp = 9, thing = 9;
        shape_kind kind;
        assert_int_equal(scene_shape_named(shapes[k], &kind, NULL), STATUS_OK);
        assert_int_equal(scene_add_solid(made, "thing", kind, &thing, NULL), STATUS_OK);
        assert_int_equal(scene_add(made, PARAM_LIGHT, "lamp", &lamp, NULL), STATUS_OK);
        assert_int_equal(scene_add(made, PARAM_MATERIAL, "stuff", &stuff, NULL), STATUS_OK);
        assert_int_equal(scene_add(made, PARAM_MESH, "body", NULL, NULL), STATUS_OK);
        assert_int_equal(scene_add(made, PARAM_TEXTURE, "wood", NULL, NULL), STATUS_OK);
        set_all(made, "body.generate=box wood.file=wood.png");
        if (k == SHAPE_MESH)
            set(made, "thing.mesh=body");
        assert_true(stuff == 0 && lamp == 0 && thing == 0);
        char *from_file = text_of(read), *from_calls = text_of(made);
        assert_string_equal(from_file, from_calls);
        assert_int_equal(made->solids[0].material_index, -1);
        free(from_file);
        free(from_calls);
        scene_destroy(read);
        scene_destroy(made);
    }
}

/* Asserts that the call fails for that reason and does not change the scene. */
#define assert_refused(s, call, reason)           \
    do {                                          \
        char *before_ = text_of(s);               \
        diagnostic why = {0};                     \
        assert_int_equal(call, STATUS_BAD_INPUT); \
        assert_string_equal(why.what, reason);    \
        assert_true(why.remedy[0] != 0);          \
        char *after_ = text_of(s);                \
        assert_string_equal(before_, after_);     \
        free(before_);                            \
        free(after_);                             \
    } while (0)

static void invalid_names_are_refused(void **state)
{
    (void)state;
    scene *s = scene_from(small_scene);
    assert_refused(s, scene_add(s, PARAM_LIGHT, "lamp", NULL, &why), "the name 'lamp' is already in use");
    assert_refused(s, scene_add(s, PARAM_MATERIAL, "a", NULL, &why), "the name 'a' is already in use");
    assert_refused(s, scene_add_solid(s, "camera", SHAPE_BOX, NULL, &why),
                   "the name 'camera' is a reserved word of scene files");
    assert_refused(s, scene_add_solid(s, "two words", SHAPE_BOX, NULL, &why), "'two words' is not a valid name");
    assert_refused(s, scene_rename(s, "a", "a→b", &why), "'a→b' is not a valid name");
    assert_refused(s, scene_remove(s, "lump", &why), "the scene has no object 'lump'");
    assert_refused(s, scene_rename(s, "lamp", "other", &why), "the name 'other' is already in use");
    assert_refused(s, scene_rename(s, "camera", "eye", &why), "the camera has no name");
    assert_refused(s, scene_rename(s, "a", "9", &why), "'9' is not a valid name");
    assert_refused(s, scene_assign_material(s, "a", "glas", &why), "no material 'glas'");
    assert_refused(s, scene_assign_material(s, "lamp", "glass", &why), "lamp is a light, which has no material");
    assert_refused(s, scene_move(s, "glass", vec3_make(1, 0, 0), &why), "glass is a material, which has no place");
    assert_refused(s, scene_turn(s, "lamp", vec3_make(1, 0, 0), &why), "lamp is a light, which has no direction");
    assert_refused(s, scene_move(s, "render", vec3_make(1, 0, 0), &why), "render is the render, which has no place");
    scene_destroy(s);
}

static void names_have_letters_of_any_script(void **state)
{
    (void)state;
    scene *s = scene_from(small_scene);
    static const char *const names[] = {"Линза_1", "größe", "透鏡", "a"};
    const char *old = "a";
    for (size_t i = 0; i < sizeof names / sizeof names[0]; old = names[i++])
        assert_int_equal(scene_rename(s, old, names[i], NULL), STATUS_OK);
    scene_destroy(s);
}

static void a_material_in_use_is_not_removed(void **state)
{
    (void)state;
    scene *s = scene_from(small_scene);
    assert_refused(s, scene_remove(s, "glass", &why), "glass is the material of a");
    assert_refused(s, scene_remove(s, "clay", &why), "clay is the material of b and 1 more");
    assert_int_equal(scene_remove(s, "spare", NULL), STATUS_OK);
    assert_int_equal(scene_remove(s, "a", NULL), STATUS_OK);
    assert_int_equal(scene_remove(s, "glass", NULL), STATUS_OK);
    assert_true(s->material_count == 1 && s->solid_count == 2 && s->light_count == 2);
    assert_string_equal(s->materials[s->solids[0].material_index].name, "clay"); /* its index changed */
    assert_string_equal(s->solids[1].name, "c");
    assert_int_equal(scene_remove(s, "lamp", NULL), STATUS_OK);
    assert_true(s->light_count == 1);
    assert_string_equal(s->lights[0].name, "other");
    set(s, "clay.diffuse=0.75"); /* its solids still use it */
    assert_true(s->solids[0].surface.diffuse == 0.75);
    scene_destroy(s);
}

static void a_mesh_or_texture_in_use_is_not_removed(void **state)
{
    (void)state;
    scene *s =
        scene_from("meshes: {body: {generate: box}, spare: {generate: torus}}\n"
                   "textures: {wood: {file: wood.png}, bark: {file: bark.png}}\nmaterials: {stuff: {texture: wood}}\n"
                   "solids: {thing: {shape: mesh, mesh: body, texture: bark}, other: {shape: box, material: stuff}}\n");
    assert_refused(s, scene_remove(s, "body", &why), "body is the mesh of thing");
    assert_refused(s, scene_remove(s, "wood", &why), "wood is the texture of stuff");
    assert_refused(s, scene_remove(s, "bark", &why), "bark is the texture of thing");
    assert_int_equal(scene_rename(s, "body", "corpus", NULL), STATUS_OK);
    assert_int_equal(scene_rename(s, "wood", "oak", NULL), STATUS_OK);
    assert_string_equal(s->solids[0].mesh, "corpus");
    assert_string_equal(s->materials[0].value.texture, "oak");
    assert_string_equal(s->solids[1].surface.texture, "oak");
    assert_int_equal(scene_check(s, NULL), STATUS_OK);
    assert_int_equal(scene_remove(s, "thing", NULL), STATUS_OK);
    assert_int_equal(scene_remove(s, "corpus", NULL), STATUS_OK);
    assert_int_equal(scene_remove(s, "bark", NULL), STATUS_OK);
    assert_true(s->mesh_count == 1 && s->texture_count == 1);
    scene_destroy(s);
}

static void removing_a_fixed_group_restores_its_defaults(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {depth: 9}\ncamera: {yaw_deg: 5, fov_deg: 20}\nbackground: {image: sky.png, ior: 1.25}\n");
    scene *empty = scene_create();
    assert_int_equal(scene_remove(s, "camera", NULL), STATUS_OK);
    assert_int_equal(scene_remove(s, "background", NULL), STATUS_OK);
    assert_int_equal(scene_remove(s, "render", NULL), STATUS_OK);
    char *left = text_of(s), *defaults = text_of(empty);
    assert_string_equal(left, defaults);
    assert_int_equal(s->background.image_line, 0);
    free(left);
    free(defaults);
    scene_destroy(s);
    scene_destroy(empty);
}

static void references_follow_a_renamed_object(void **state)
{
    (void)state;
    scene *s = scene_from(small_scene);
    assert_int_equal(scene_rename(s, "clay", "mud", NULL), STATUS_OK);
    assert_int_equal(scene_rename(s, "a", "a", NULL), STATUS_OK);
    assert_int_equal(scene_rename(s, "lamp", "clay", NULL), STATUS_OK); /* unused now */
    char *text = NULL;
    assert_int_equal(scene_write_text(s, "", false, &text, NULL), STATUS_OK);
    assert_non_null(strstr(text, "  b:\n    shape: sphere\n    material: mud\n"));
    assert_non_null(strstr(text, "  clay:\n    position: [1, 2, 3]\n"));
    free(text);
    scene_destroy(s);
}

static void assigning_a_material_replaces_all_surface_values(void **state)
{
    (void)state;
    scene *s = scene_from(small_scene);
    assert_true(s->solids[2].surface.diffuse == 0.25);
    assert_int_equal(scene_set_property(s, "c.material", "clay", NULL), STATUS_OK); /* its own values are discarded */
    assert_true(s->solids[2].surface.diffuse == 0.5);
    assert_int_equal(scene_set_property(s, "c.material", "glass", NULL), STATUS_OK);
    assert_true(s->solids[2].surface.ior == 1.5 && s->solids[2].surface.diffuse == 0.0 &&
                s->solids[2].material_index == 0);
    assert_int_equal(scene_set_property(s, "c.material", "", NULL), STATUS_OK);
    assert_true(s->solids[2].surface.ior == 1.0 && s->solids[2].material_index == -1);
    assert_int_equal(scene_set_property(s, "c.shape", "sphere", NULL), STATUS_OK);
    assert_int_equal(s->solids[2].shape.kind, SHAPE_SPHERE);
    assert_int_equal(scene_set_property(s, "c.radius", "3", NULL), STATUS_OK);
    assert_true(s->solids[2].shape.radius == 3.0);
    assert_refused(s, scene_set_property(s, "c.shape", "cylindre", &why), "'cylindre' is not a shape");
    scene_destroy(s);
}

static void lights_and_solids_above_the_limit_are_refused(void **state)
{
    (void)state;
    scene *s = scene_create();
    for (int i = 0; i < SCENE_LIGHTS_MAX; i++) {
        char name[20];
        snprintf(name, sizeof name, "l%d", i);
        assert_int_equal(scene_add(s, PARAM_LIGHT, name, NULL, NULL), STATUS_OK);
        snprintf(name, sizeof name, "s%d", i);
        if (i < SCENE_UNBOUNDED_MAX)
            assert_int_equal(scene_add_solid(s, name, SHAPE_PLANE, NULL, NULL), STATUS_OK);
    }
    assert_refused(s, scene_add(s, PARAM_LIGHT, "more", NULL, &why), "more than 1024 lights");
    assert_refused(s, scene_add_solid(s, "more", SHAPE_PLANE, NULL, &why), "more than 64 planes and solids of meshes");
    assert_int_equal(scene_add_solid(s, "bounded", SHAPE_SPHERE, NULL, NULL), STATUS_OK);
    assert_refused(s, scene_set_property(s, "bounded.shape", "plane", &why),
                   "more than 64 planes and solids of meshes");
    assert_int_equal(scene_remove(s, "s0", NULL), STATUS_OK);
    assert_int_equal(scene_set_property(s, "bounded.shape", "plane", NULL), STATUS_OK);
    scene_destroy(s);
}

static void objects_and_the_camera_are_moved(void **state)
{
    (void)state;
    scene *s = scene_from(small_scene);
    assert_int_equal(scene_move(s, "c", vec3_make(0.5, 0, -1), NULL), STATUS_OK);
    assert_vector(s->solids[2].shape.position, 1.5, 2, 2);
    assert_int_equal(scene_move(s, "lamp", vec3_make(1, 1, 1), NULL), STATUS_OK);
    assert_vector(s->lights[0].position, 2, 3, 4);
    set_all(s, "camera.position=0,1,-6 camera.target=0,2,0");
    assert_int_equal(scene_move(s, "camera", vec3_make(1, 2, 3), NULL), STATUS_OK);
    assert_vector(s->camera.position, 1, 3, -3);
    assert_vector(s->camera.target, 1, 4, 3);
    set(s, "camera.yaw_deg=30");
    assert_int_equal(scene_move(s, "camera", vec3_make(-1, -3, 3), NULL), STATUS_OK);
    assert_vector(s->camera.position, 0, 0, 0);
    assert_true(s->camera.yaw_deg == 30 && !s->camera.aimed);
    assert_int_equal(scene_look_at(s, vec3_make(0, 0, 9), NULL), STATUS_OK);
    assert_true(s->camera.aimed == 1);
    assert_vector(s->camera.target, 0, 0, 9);
    scene_destroy(s);
}

static void movements_out_of_range_are_refused(void **state)
{
    (void)state;
    scene *s = scene_from(small_scene);
    set_all(s, "camera.position=0,0,0 camera.target=0,0,999999");
    assert_refused(s, scene_move(s, "c", vec3_make(1e6, 0, 0), &why), "c.position.x: 1000001 is out of range");
    assert_refused(s, scene_move(s, "lamp", vec3_make(0, (double)NAN, 0), &why),
                   "lamp.position.y: 'nan' is not a finite number");
    assert_refused(s, scene_move(s, "camera", vec3_make(0, 0, 2), &why), "camera.target.z: 1000001 is out of range");
    assert_refused(s, scene_turn(s, "c", vec3_make(0, (double)INFINITY, 0), &why),
                   "c cannot be rotated by these angles");
    assert_refused(s, scene_look_at(s, vec3_make(0, 2e6, 0), &why), "camera.target.y: 2000000 is out of range");
    scene_destroy(s);
}

/* R_z R_y R_x of the angles, times v: about x first. */
static vec3 rotated(vec3 degrees, vec3 v)
{
    double s = sin(degrees.x * RADIANS), c = cos(degrees.x * RADIANS);
    v = vec3_make(v.x, c * v.y - s * v.z, s * v.y + c * v.z);
    s = sin(degrees.y * RADIANS), c = cos(degrees.y * RADIANS);
    v = vec3_make(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
    s = sin(degrees.z * RADIANS), c = cos(degrees.z * RADIANS);
    return vec3_make(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
}

static double random_angle(uint64_t *seed, bool straight)
{
    return straight ? 45.0 * (double)((int)random_below(seed, 17) - 8) : random_real(seed, -360.0, 360.0);
}

static void rotations_are_about_the_axes_of_the_world(void **state)
{
    (void)state;
    uint64_t seed = 20;
    scene *s = scene_from(small_scene);
    solid_shape *shape = &s->solids[0].shape;
    for (int i = 0; i < 20000; i++) {
        const bool straight = i % 2 == 0; /* including a vertical axis, where x and z rotate about the same line */
        const vec3 turn =
            vec3_make(random_angle(&seed, straight), random_angle(&seed, straight), random_angle(&seed, straight));
        vec3 from =
            vec3_make(random_angle(&seed, straight), random_angle(&seed, straight), random_angle(&seed, straight));
        if (i % 5 == 0) /* nearly vertical */
            from.y = 90.0 + random_real(&seed, -1.0, 1.0) * pow(10.0, -(double)random_below(&seed, 14));
        shape->rotation_deg = from;
        diagnostic why = {0};
        worked(scene_turn(s, "a", turn, &why), &why);
        for (int k = 0; k < 3; k++) {
            const vec3 unit = vec3_make(k == 0, k == 1, k == 2);
            const vec3 expected = rotated(turn, rotated(from, unit)), found = rotated(shape->rotation_deg, unit);
            assert_true(vec3_length(vec3_sub(expected, found)) < 1e-13);
        }
        assert_true(fabs(shape->rotation_deg.x) <= 360 && fabs(shape->rotation_deg.y) <= 360 &&
                    fabs(shape->rotation_deg.z) <= 360);
    }
    scene_destroy(s);
}

static void rotations_keep_round_angles_exact(void **state)
{
    (void)state;
    static const double cases[][9] = {
        {0, 0, 0, 0, 0, -22, 0, 0, -22},    {0, 35, 0, 0, 10, 0, 0, 45, 0},    {10, 20, 30, 0, 0, 5, 10, 20, 35},
        {10, 0, 0, 5, 0, 0, 15, 0, 0},      {0, 0, 170, 0, 0, 20, 0, 0, -170}, {10, 20, 0, 0, 30, 0, 10, 50, 0},
        {90, 0, 0, 0, 90, 0, 90, 90, 0},    {0, 0, 90, 90, 0, 0, 90, -90, 0},  {30, 40, 50, 0, 0, 0, 30, 40, 50},
        {0, 0, 30, 0, 180, 0, 180, 0, 150}, {0, 350, 0, 0, 350, 0, 0, -20, 0},
    };
    scene *s = scene_from(small_scene);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double *c = cases[i];
        s->solids[0].shape.rotation_deg = vec3_make(c[0], c[1], c[2]);
        assert_int_equal(scene_turn(s, "a", vec3_make(c[3], c[4], c[5]), NULL), STATUS_OK);
        assert_vector(s->solids[0].shape.rotation_deg, c[6], c[7], c[8]);
    }
    assert_vector(s->solids[0].shape.position, 0, 0, 0);
    scene_destroy(s);
}

static vec3 direction_of(const camera *c)
{
    if (c->aimed)
        return vec3_sub(c->target, c->position);
    const double yaw = c->yaw_deg * RADIANS, pitch = c->pitch_deg * RADIANS;
    return vec3_make(cos(pitch) * sin(yaw), sin(pitch), cos(pitch) * cos(yaw));
}

/* About y, z goes to x. */
static void moving_and_rotating_a_spotlight_transforms_its_target(void **state)
{
    (void)state;
    scene *s = scene_create();
    diagnostic why = {0};
    assert_int_equal(scene_add(s, PARAM_LIGHT, "spot", NULL, &why), STATUS_OK);
    assert_int_equal(scene_set(s, "spot.kind", "cone", &why), STATUS_OK);
    assert_int_equal(scene_set(s, "spot.position", "1,2,3", &why), STATUS_OK);
    assert_int_equal(scene_set(s, "spot.target", "1,2,5", &why), STATUS_OK);
    assert_int_equal(scene_move(s, "spot", vec3_make(0.0, 1.0, 0.5), &why), STATUS_OK);
    assert_true(s->lights[0].position.y == 3.0 && s->lights[0].target.y == 3.0 && s->lights[0].target.z == 5.5);
    assert_int_equal(scene_turn(s, "spot", vec3_make(0.0, 90.0, 0.0), &why), STATUS_OK);
    assert_true(fabs(s->lights[0].target.x - 3.0) < 1e-12 && fabs(s->lights[0].target.z - 3.5) < 1e-12);
    assert_int_equal(scene_set(s, "spot.kind", "point", &why), STATUS_OK);
    assert_int_equal(scene_move(s, "spot", vec3_make(1.0, 0.0, 0.0), &why), STATUS_OK);
    assert_true(s->lights[0].position.x == 2.0 && fabs(s->lights[0].target.x - 3.0) < 1e-12);
    scene_destroy(s);
}

static void the_camera_rotates_in_place(void **state)
{
    (void)state;
    uint64_t seed = 21;
    scene *s = scene_from(small_scene);
    for (int i = 0; i < 2000; i++) {
        const bool aimed = i % 2 == 0;
        set_all(s, aimed ? "camera.position=1,2,3 camera.target=2,1,5"
                         : "camera.position=1,2,3 camera.yaw_deg=40 camera.pitch_deg=-20");
        const vec3 turn =
            vec3_make(random_angle(&seed, i % 4 < 2), random_angle(&seed, i % 4 < 2), random_angle(&seed, i % 4 < 2));
        const vec3 expected = rotated(turn, direction_of(&s->camera));
        assert_int_equal(scene_turn(s, "camera", turn, NULL), STATUS_OK);
        assert_true(vec3_length(vec3_sub(direction_of(&s->camera), expected)) < 1e-13);
        assert_vector(s->camera.position, 1, 2, 3);
        assert_true(s->camera.aimed == aimed);
    }
    set_all(s, "camera.yaw_deg=170 camera.pitch_deg=-20");
    assert_int_equal(scene_turn(s, "camera", vec3_make(0, 30, 0), NULL), STATUS_OK);
    assert_true(s->camera.yaw_deg == -160 && s->camera.pitch_deg == -20);
    scene_destroy(s);
}

static void solid_with(scene *s, const char *name, shape_kind shape, const char *material_name, const char *values)
{
    diagnostic why = {0};
    worked(scene_add_solid(s, name, shape, NULL, &why), &why);
    worked(scene_assign_material(s, name, material_name, &why), &why);
    set_all(s, values);
}

static void the_rod_scene_is_built_by_edits_alone(void **state)
{
    (void)state;
    scene *s = scene_create(), *read = rod_scene("render.width=80 render.height=60");
    diagnostic why = {0};
    worked(scene_add(s, PARAM_MATERIAL, "clear", NULL, &why), &why);
    worked(scene_add(s, PARAM_MATERIAL, "tiles", NULL, &why), &why);
    worked(scene_add(s, PARAM_MATERIAL, "plastic", NULL, &why), &why);
    set_all(s, "clear.transparency=1 clear.specular=0.6 clear.shininess=80 tiles.color=0.85,0.85,0.85 "
               "tiles.checker_color=0.25,0.3,0.35");
    set_all(s, "tiles.checker=0.5 tiles.ambient=0.1 tiles.diffuse=0.7 plastic.color=0.85,0.15,0.1 plastic.ambient=0.1");
    set_all(s, "plastic.diffuse=0.7 plastic.specular=0.5 plastic.shininess=40 camera.position=0,2.75,-6 "
               "camera.target=0,1.5,0");
    worked(scene_add(s, PARAM_LIGHT, "lamp", NULL, &why), &why);
    worked(scene_move(s, "lamp", vec3_make(4, -3, -5), &why), &why); /* from 0,10,0 */
    solid_with(s, "ground", SHAPE_PLANE, "tiles", "");
    solid_with(s, "vessel", SHAPE_CUP, "clear",
               "vessel.ior=1.5 vessel.position=0,0.001,0 vessel.height=3 vessel.priority=2");
    solid_with(s, "liquid", SHAPE_CYLINDER, "clear",
               "liquid.ior=1.33 liquid.position=0,0.051,0 liquid.radius=0.95 liquid.height=1.95 liquid.priority=1");
    solid_with(s, "rod", SHAPE_BOX, "plastic", "rod.size=0.25,3,0.25 rod.priority=3");
    worked(scene_move(s, "rod", vec3_make(0.2, 2.101, 0), &why), &why);
    worked(scene_set_title(s, "Rod in a vessel", &why), &why);
    worked(scene_check(s, &why), &why);
    set_all(s, "render.width=80 render.height=60");
    char *made = text_of(s), *expected = text_of(read);
    assert_string_equal(made, expected);
    free(made);
    free(expected);
    render_result *a = render(s), *b = render(read);
    assert_true(film_hash(a->img) == film_hash(b->img));
    render_result_destroy(a);
    render_result_destroy(b);
    scene_destroy(s);
    scene_destroy(read);
}

/* By a search through all of them. */
static int found_by_search(const scene *s, param_group group, const char *name)
{
    for (size_t i = param_place_group_size(s, group); i-- > 0;)
        if (strcmp(param_place_group_name(s, group, i), name) == 0)
            return (int)i;
    return -1;
}

/* Objects come, go, get other names, and are copied: each of 40 names leads to the object that has it. */
static void objects_are_found_by_name_after_any_edits(void **state)
{
    (void)state;
    static const param_group groups[] = {PARAM_LIGHT, PARAM_MATERIAL, PARAM_TEXTURE};
    uint64_t seed = 50;
    scene *s = scene_create();
    int objects = 0;
    for (int i = 0; i < 4000; i++) {
        char name[20], other[20];
        size_t index;
        snprintf(name, sizeof name, "o%d", random_below(&seed, 40));
        snprintf(other, sizeof other, "o%d", random_below(&seed, 40));
        const int what = random_below(&seed, 16);
        if (what == 0) {
            scene *copy = scene_clone(s);
            scene_destroy(s);
            s = copy;
        } else if (what < 8) {
            objects += scene_add(s, groups[random_below(&seed, 3)], name, &index, NULL) == STATUS_OK;
        } else if (what < 12) {
            objects -= scene_remove(s, name, NULL) == STATUS_OK;
        } else {
            scene_rename(s, name, other, NULL);
        }
        int found = 0;
        for (int g = 0; g < 3; g++)
            for (int k = 0; k < 40; k++) {
                snprintf(name, sizeof name, "o%d", k);
                const int at = object_find(s, groups[g], name);
                assert_int_equal(at, found_by_search(s, groups[g], name));
                found += at >= 0;
            }
        assert_int_equal(found, objects);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(added_objects_have_the_defaults_of_a_file),
        cmocka_unit_test(invalid_names_are_refused),
        cmocka_unit_test(names_have_letters_of_any_script),
        cmocka_unit_test(a_material_in_use_is_not_removed),
        cmocka_unit_test(a_mesh_or_texture_in_use_is_not_removed),
        cmocka_unit_test(removing_a_fixed_group_restores_its_defaults),
        cmocka_unit_test(references_follow_a_renamed_object),
        cmocka_unit_test(assigning_a_material_replaces_all_surface_values),
        cmocka_unit_test(lights_and_solids_above_the_limit_are_refused),
        cmocka_unit_test(objects_and_the_camera_are_moved),
        cmocka_unit_test(movements_out_of_range_are_refused),
        cmocka_unit_test(rotations_are_about_the_axes_of_the_world),
        cmocka_unit_test(rotations_keep_round_angles_exact),
        cmocka_unit_test(moving_and_rotating_a_spotlight_transforms_its_target),
        cmocka_unit_test(the_camera_rotates_in_place),
        cmocka_unit_test(the_rod_scene_is_built_by_edits_alone),
        cmocka_unit_test(objects_are_found_by_name_after_any_edits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
