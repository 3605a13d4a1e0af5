/* Tests of scenes: reading, copying, checking, their media, and the geometry of the reference scene. Run from the
 * repository root. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SCENES "experiments/scenes/"

static scene *read_file(const char *path)
{
    scene *s;
    diagnostic why = {.what = ""};
    status code = scene_read(path, &s, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
    return s;
}

static scene *read_text(const char *text)
{
    scene *s;
    diagnostic why = {.what = ""};
    status code = scene_read_text("folder/test.yaml", text, strlen(text), &s, &why);
    assert_string_equal(why.what, "");
    assert_int_equal(code, STATUS_OK);
    return s;
}

static void assert_vector(vec3 v, double x, double y, double z)
{
    assert_true(v.x == x && v.y == y && v.z == z);
}

static const solid *find(const scene *s, const char *name)
{
    int index = scene_find_solid(s, name);
    assert_true(index >= 0);
    return &s->solids[index];
}

/* ---- the reference scene, which other renderers in the comparison use as well ---- */

static void the_rod_scene_has_the_reference_camera_and_light(void **state)
{
    (void)state;
    scene *s = read_file(SCENES "rod.yaml");
    assert_int_equal(s->render.width, 800);
    assert_int_equal(s->render.height, 600);
    assert_int_equal(s->render.depth, 4);
    assert_int_equal(s->render.weights, WEIGHTS_FRESNEL);
    assert_true(s->render.min_weight == 0);
    assert_vector(s->camera.position, 0, 2.75, -6);
    assert_vector(s->camera.target, 0, 1.5, 0);
    assert_int_equal(s->camera.aimed, 1);
    assert_true(s->camera.fov_deg == 45);
    assert_int_equal(s->background.kind, BACKGROUND_UNIFORM);
    assert_vector(s->background.color, 0.53, 0.75, 0.92);
    assert_vector(s->background.ambient, 1, 1, 1);
    assert_int_equal(s->light_count, 1);
    assert_string_equal(s->lights[0].name, "lamp");
    assert_vector(s->lights[0].position, 4, 7, -5);
    assert_vector(s->lights[0].color, 1, 1, 1);
    assert_true(s->lights[0].intensity == 1);
    scene_destroy(s);
}

static void the_rod_scene_has_the_reference_solids(void **state)
{
    (void)state;
    scene *s = read_file(SCENES "rod.yaml");
    assert_int_equal(s->solid_count, 4);
    const solid *ground = find(s, "ground"), *vessel = find(s, "vessel"), *liquid = find(s, "liquid"),
                *rod = find(s, "rod");
    assert_int_equal(ground->shape.kind, SHAPE_PLANE);
    assert_vector(ground->shape.position, 0, 0, 0);
    assert_true(ground->surface.checker == 0.5 && ground->surface.ambient == 0.1 && ground->surface.diffuse == 0.7);
    assert_vector(ground->surface.color, 0.85, 0.85, 0.85);
    assert_vector(ground->surface.checker_color, 0.25, 0.30, 0.35);
    assert_int_equal(vessel->shape.kind, SHAPE_CUP);
    assert_vector(vessel->shape.position, 0, 0.001, 0);
    assert_true(vessel->shape.radius == 1 && vessel->shape.inner_radius == 0.9 && vessel->shape.floor == 0.1);
    assert_true(vessel->shape.height == 3 && vessel->surface.ior == 1.5 && vessel->surface.transparency == 1);
    assert_int_equal(liquid->shape.kind, SHAPE_CYLINDER);
    assert_true(fabs(liquid->shape.position.y + liquid->shape.height - 2.001) <= DBL_EPSILON * 2);
    /* It reaches into the wall and the floor of the vessel, and not through them. */
    assert_true(liquid->shape.radius > 0.9 && liquid->shape.radius < 1);
    assert_true(liquid->shape.position.y > 0.001 && liquid->shape.position.y < 0.101);
    assert_true(liquid->surface.ior == 1.33 && liquid->shape.m == 1);
    for (int i = 0; i < 2; i++) {
        const material *clear = i ? &liquid->surface : &vessel->surface;
        assert_true(clear->specular == 0.6 && clear->shininess == 80 && clear->ambient == 0 && clear->diffuse == 0);
    }
    assert_int_equal(rod->shape.kind, SHAPE_BOX);
    assert_vector(rod->shape.size, 0.25, 3, 0.25);
    assert_vector(rod->shape.position, 0.2, 2.101, 0);
    assert_true(fabs(rod->shape.position.y - 1.5 - 0.601) < 1e-15 &&
                fabs(rod->shape.position.x - 0.125 - 0.075) < 1e-15);
    assert_vector(rod->surface.color, 0.85, 0.15, 0.10);
    assert_true(rod->surface.specular == 0.5 && rod->surface.shininess == 40 && rod->surface.transparency == 0);
    assert_true(rod->priority > vessel->priority && vessel->priority > liquid->priority &&
                liquid->priority > ground->priority);
    scene_destroy(s);
}

/* The four index pairs of the report, and its constant weights, are settings of the one scene. */
static void the_settings_of_the_report_are_overrides_of_the_scene(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {{"1.0", "1.0"}, {"1.0", "1.5"}, {"1.3", "1.0"}, {"1.3", "1.5"}};
    scene *s = read_file(SCENES "rod.yaml");
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(scene_set(s, "vessel.ior", pairs[i][0], NULL), STATUS_OK);
        assert_int_equal(scene_set(s, "liquid.ior", pairs[i][1], NULL), STATUS_OK);
        assert_int_equal(scene_check(s, NULL), STATUS_OK);
    }
    assert_int_equal(scene_set_assignment(s, "render.weights=constant", NULL), STATUS_OK);
    assert_int_equal(scene_set_assignment(s, "clear.reflectivity=0.1", NULL), STATUS_OK);
    diagnostic why = {.what = ""};
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "vessel: with constant weights, reflectivity 0.1 + transparency 1 exceeds 1");
    assert_int_equal(scene_set_assignment(s, "clear.transparency=0.9", NULL), STATUS_OK);
    assert_int_equal(scene_check(s, NULL), STATUS_OK);
    scene_destroy(s);
}

static void every_scene_of_the_project_is_valid(void **state)
{
    (void)state;
    scene *leaning = read_file(SCENES "rod-leaning.yaml"), *inside = read_file(SCENES "rod-from-inside.yaml"),
          *solids = read_file(SCENES "solids.yaml");
    assert_true(find(leaning, "rod")->shape.rotation_deg.z != 0);
    assert_true(solid_shape_contains(&find(inside, "liquid")->shape, inside->camera.position));
    assert_false(solid_shape_contains(&find(inside, "vessel")->shape, inside->camera.position));
    assert_false(solid_shape_contains(&find(inside, "rod")->shape, inside->camera.position));
    unsigned shapes = 0;
    for (size_t i = 0; i < solids->solid_count; i++)
        shapes |= 1u << solids->solids[i].shape.kind;
    assert_int_equal(shapes, (1u << SHAPE_MESH) - 1); /* all analytic ones */
    /* The leaning rod does not touch the vessel. */
    const solid *rod = find(leaning, "rod"), *vessel = find(leaning, "vessel");
    mat3 turn = rotation_from_deg(rod->shape.rotation_deg);
    for (int corner = 0; corner < 8; corner++) {
        vec3 half = vec3_scale(rod->shape.size, 0.5);
        vec3 local =
            vec3_make(corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z);
        assert_false(solid_shape_contains(&vessel->shape, vec3_add(rod->shape.position, mat3_apply(turn, local))));
    }
    scene_destroy(leaning);
    scene_destroy(inside);
    scene_destroy(solids);
}

/* ---- reading ---- */

static void the_order_of_the_file_is_preserved_and_solids_may_be_first(void **state)
{
    (void)state;
    scene *s = read_text("solids:\n  zebra: {shape: sphere, material: glass}\n  ape: {shape: box, ior: 2}\n"
                         "materials:\n  glass: {ior: 1.5}\nlights:\n  b: {}\n  a: {}\ntitle: Zoo\n");
    assert_string_equal(s->title, "Zoo");
    assert_string_equal(s->path, "folder/test.yaml");
    assert_string_equal(s->solids[0].name, "zebra");
    assert_string_equal(s->lights[1].name, "a");
    assert_int_equal(s->solids[0].material_index, 0);
    assert_int_equal(s->solids[1].material_index, -1);
    assert_true(s->solids[0].surface.ior == 1.5 && s->solids[1].surface.ior == 2);
    assert_int_equal(scene_find_solid(s, "ape"), 1);
    assert_int_equal(scene_find_solid(s, "glass"), -1);
    scene_destroy(s);
}

static void omitted_parameters_have_their_defaults(void **state)
{
    (void)state;
    static const char *const texts[] = {"{}", "render:\nlights:\nsolids:\n", "camera: {}\nmaterials: {}\n",
                                        "lights:\n  l:\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        scene *s = read_text(texts[i]);
        assert_int_equal(s->solid_count, 0);
        assert_int_equal(s->render.depth, 4);
        scene_destroy(s);
    }
    scene *s = read_text("solids:\n  s: {shape: cup}\n");
    const solid *cup = &s->solids[0];
    assert_true(cup->shape.radius == 1 && cup->shape.inner_radius == 0.9 && cup->visible == 1 && cup->surface.ior == 1);
    assert_true(cup->surface.ambient == 0 && cup->surface.diffuse == 0 && cup->surface.transparency == 0);
    scene_destroy(s);
}

/* A missing angle is 0, whatever the order of the keys. */
static void angles_do_not_depend_on_the_order_of_keys(void **state)
{
    (void)state;
    static const char *const texts[] = {"camera: {yaw_deg: 30, position: [1, 9, 2]}",
                                        "camera: {position: [1, 9, 2], yaw_deg: 30}"};
    for (size_t i = 0; i < 2; i++) {
        scene *s = read_text(texts[i]);
        assert_int_equal(s->camera.aimed, 0);
        assert_true(s->camera.yaw_deg == 30 && s->camera.pitch_deg == 0);
        scene_destroy(s);
    }
}

/* ---- copies, checks, images ---- */

static status compare(void *context, const char *path, const param *row, const char *value)
{
    (void)row;
    char *other;
    assert_int_equal(scene_get(context, path, &other, NULL), STATUS_OK);
    assert_string_equal(other, value);
    free(other);
    return STATUS_OK;
}

static void a_copy_is_equal_and_independent(void **state)
{
    (void)state;
    scene *s = read_file(SCENES "rod.yaml");
    assert_int_equal(image_create(2, 1, &s->background.img, NULL), STATUS_OK);
    s->background.img->pixel[5] = 0.25f;
    scene *c = scene_clone(s);
    assert_non_null(c);
    assert_int_equal(scene_each_param(s, compare, c), STATUS_OK);
    assert_string_equal(c->path, SCENES "rod.yaml");
    assert_string_equal(c->title, s->title);
    /* Both share one sky, which is constant after loading. */
    assert_ptr_equal(c->background.img, s->background.img);
    assert_int_equal(scene_set(c, "clear.ior", "3", NULL), STATUS_OK);
    assert_true(find(s, "vessel")->surface.ior == 1.5 && find(c, "vessel")->surface.ior == 3);
    scene_destroy(s); /* the copy outlives the original */
    assert_true(c->background.img->pixel[5] == 0.25f);
    assert_string_equal(c->solids[1].name, "vessel");
    assert_int_equal(scene_check(c, NULL), STATUS_OK);
    scene_destroy(c);
    scene_destroy(NULL);
}

static void assert_check_finds(scene *s, const char *assignment, const char *word)
{
    scene *c = scene_clone(s);
    diagnostic why = {.what = ""};
    assert_int_equal(scene_set_assignment(c, assignment, NULL), STATUS_OK);
    assert_int_equal(scene_check(c, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, word));
    scene_destroy(c);
}

static void scene_check_finds_invalid_combinations(void **state)
{
    (void)state;
    scene *s = read_file(SCENES "rod.yaml");
    assert_check_finds(s, "vessel.inner_radius=1", "inner_radius");
    assert_check_finds(s, "vessel.floor=5", "floor");
    assert_check_finds(s, "camera.target=0,2.75,-6", "target");
    assert_check_finds(s, "background.kind=image", "image");
    assert_int_equal(scene_set(s, "render.width", "65536", NULL), STATUS_OK);
    assert_check_finds(s, "render.height=4097", "too large");
    assert_int_equal(scene_set(s, "render.width", "8", NULL), STATUS_OK);
    free(s->solids[3].name);
    s->solids[3].name = strdup("lamp");
    assert_check_finds(s, "render.depth=1", "already in use");
    s->solids[3].name[0] = '.';
    assert_check_finds(s, "render.depth=1", "name");
    scene_destroy(s);
}

static void negative_and_infinite_skies_are_refused(void **state)
{
    (void)state;
    static const float bad[] = {-1e-6F, 65600.0F, 1e30F}, good[] = {0.0F, 65536.0F};
    char path[] = "/tmp/test_scene_XXXXXX.pfm", text[128], message[DIAGNOSTIC_TEXT_MAX];
    int file = mkstemps(path, 4);
    assert_true(file >= 0);
    close(file);
    snprintf(text, sizeof text, "background: {image: %s}\n", path);
    for (size_t i = 0; i < sizeof bad / sizeof *bad + sizeof good / sizeof *good; i++) {
        bool is_bad = i < sizeof bad / sizeof *bad;
        image *sky;
        scene *s;
        diagnostic why = {.what = ""};
        assert_int_equal(image_create(4, 2, &sky, NULL), STATUS_OK);
        sky->pixel[(1 * 4 + 2) * 3 + 1] = is_bad ? bad[i] : good[i - sizeof bad / sizeof *bad];
        assert_int_equal(image_write(sky, path, 8, NULL), STATUS_OK);
        image_destroy(sky);
        assert_int_equal(scene_read_text("s.yaml", text, strlen(text), &s, NULL), STATUS_OK);
        assert_int_equal(scene_load(s, &why), is_bad ? STATUS_BAD_INPUT : STATUS_OK);
        assert_true(is_bad == !s->background.img);
        if (is_bad) {
            diagnostic_text(&why, message, sizeof message);
            assert_memory_equal(message, "s.yaml:1:21: background.image: ", 31);
            assert_non_null(strstr(message, "column 2, row 1 from the top"));
        }
        scene_destroy(s);
    }
    unlink(path);
}

static void the_path_of_a_sky_image_is_relative_to_the_scene(void **state)
{
    (void)state;
    char folder[] = "/tmp/test_scene_XXXXXX", image_path[64], scene_path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(image_path, sizeof image_path, "%s/sky.pfm", folder);
    snprintf(scene_path, sizeof scene_path, "%s/s.yaml", folder);
    image *sky;
    assert_int_equal(image_create(4, 2, &sky, NULL), STATUS_OK);
    sky->pixel[3] = 0.5f;
    assert_int_equal(image_write(sky, image_path, 8, NULL), STATUS_OK);
    image_destroy(sky);
    FILE *file = fopen(scene_path, "w");
    assert_non_null(file);
    fputs("background: {image: sky.pfm}\n", file);
    fclose(file);
    scene *s = read_file(scene_path);
    assert_int_equal(s->background.kind, BACKGROUND_IMAGE);
    assert_null(s->background.img);
    assert_int_equal(scene_load(s, NULL), STATUS_OK);
    const image *loaded = s->background.img;
    assert_true(loaded && loaded->width == 4 && loaded->height == 2 && loaded->pixel[3] == 0.5f);
    assert_int_equal(scene_load(s, NULL), STATUS_OK);
    assert_ptr_equal(s->background.img, loaded); /* once */
    assert_int_equal(scene_set(s, "background.image", "other.pfm", NULL), STATUS_OK);
    assert_null(s->background.img); /* another path, another image */
    diagnostic why = {.what = ""};
    assert_int_equal(scene_load(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.file, "other.pfm"));
    assert_int_equal(scene_set(s, "background.image", image_path, NULL), STATUS_OK); /* absolute */
    assert_int_equal(scene_load(s, NULL), STATUS_OK);
    assert_non_null(s->background.img);
    assert_int_equal(scene_set(s, "background.image", "none.png", NULL), STATUS_OK);
    assert_int_equal(scene_set(s, "background.kind", "uniform", NULL), STATUS_OK);
    assert_int_equal(scene_load(s, NULL), STATUS_OK); /* unused, not read */
    scene_destroy(s);
    unlink(image_path);
    s = read_file(scene_path); /* refers to a missing image */
    scene *c = scene_clone(s);
    char where[200], text[DIAGNOSTIC_TEXT_MAX];
    snprintf(where, sizeof where, "%s:1:21: background.image: %s: ", scene_path, image_path);
    assert_int_equal(scene_load(c, &why), STATUS_BAD_INPUT);
    assert_int_equal(strncmp(diagnostic_text(&why, text, sizeof text), where, strlen(where)), 0);
    scene_destroy(c);
    scene_destroy(s);
    unlink(scene_path);
    rmdir(folder);
}

/* Media in scenes: laws by name and by coefficients, absorption, and the diagnostics of invalid media. */

static double index_at(const scene *s, const char *name, double lambda_nm)
{
    index_law law;
    diagnostic why = {0};
    const solid *owner = &s->solids[scene_find_solid(s, name)];
    worked(material_index_law(&owner->surface, name, &law, &why), &why);
    return index_law_at(&law, lambda_nm);
}

static void near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%.12f is not %.12f within %g", got, expected, tolerance);
}

static const char three_laws[] =
    "materials: {glass: {transparency: 1, medium: bk7}}\n"
    "solids:\n"
    "  a: {shape: sphere, material: glass}\n"
    "  b: {shape: sphere, material: glass, ior: 1.25}\n"
    "  c: {shape: sphere, transparency: 1, medium: cauchy, coefficients: [1.5, 0.004, 0.0001]}\n"
    "  d: {shape: sphere, transparency: 1, medium: table, coefficients: [400, 1.6, 600, 1.5]}\n"
    "  e: {shape: sphere, transparency: 1, medium: sellmeier, coefficients: [0.5684027565, 0.005101829712, "
    "0.1726177391, 0.01821153936, 0.02086189578, 0.02620722293, 0.1130748688, 10.69792721]}\n";

/* Catalogue glasses are measured in air; Schott gives N-BK7 n_d = 1.51680, and dry air has n_d = 1.000277 (Ciddor
 * 1996). */
static void indices_by_name_and_by_coefficients_equal_published_values(void **state)
{
    (void)state;
    scene *s = scene_from(three_laws);
    near(index_at(s, "a", 587.5618), 1.51680 * 1.000277, 5e-6);
    near(index_at(s, "b", 450.0), 1.25, 0.0);
    near(index_at(s, "c", 500.0), 1.5 + 0.004 / 0.25 + 0.0001 / 0.0625, 1e-15); /* Cauchy, um */
    near(index_at(s, "d", 450.0), 1.575, 1e-15);
    near(index_at(s, "e", 589.3), 1.33336, 5e-5); /* water at 20 C: Daimon and Masumura 2007, and any handbook */
    scene_destroy(s);
}

/* The last setting wins; printed parameters give the same scene. */
static void the_last_of_index_and_medium_applies(void **state)
{
    (void)state;
    scene *s = scene_from(three_laws);
    set(s, "a.ior=1.7");
    near(index_at(s, "a", 500.0), 1.7, 0.0);
    set(s, "a.medium=diamond");
    assert_true(index_at(s, "a", 587.5618) > 2.4);
    set(s, "glass.ior=1.1");
    near(index_at(s, "a", 500.0), 1.1, 0.0);
    near(index_at(s, "b", 500.0), 1.1, 0.0);
    set(s, "background.medium=water");
    index_law around = surrounding_index_law(&s->background);
    near(index_law_at(&around, 587.5618), 1.33340, 1e-5);
    set(s, "background.ior=1.2");
    around = surrounding_index_law(&s->background);
    near(index_law_at(&around, 587.5618), 1.2, 0.0);
    char *text = NULL;
    assert_int_equal(scene_get(s, "c.coefficients", &text, NULL), STATUS_OK);
    assert_string_equal(text, "[1.5,0.004,0.0001]");
    free(text);
    scene_destroy(s);
}

static void absorption_is_given_by_channel_or_by_wavelength(void **state)
{
    (void)state;
    scene *s = scene_from("solids:\n"
                          "  a: {shape: sphere, transparency: 1, absorb_per_m: [3, 2, 1]}\n"
                          "  b: {shape: sphere, transparency: 1, absorb_spectrum: [400, 0, 500, 10, 700, 10]}\n"
                          "  c: {shape: sphere, transparency: 1}\n");
    const material *a = &s->solids[0].surface, *b = &s->solids[1].surface, *c = &s->solids[2].surface;
    assert_true(material_absorbs(a) && material_absorbs(b) && !material_absorbs(c));
    near(material_absorption(a).y, 2.0, 0.0);
    near(material_absorption_at(a, 549.1), 2.0, 1e-15);
    near(material_absorption_at(a, 0.5 * (549.1 + 611.4)), 2.5, 1e-14);
    near(material_absorption_at(a, 780.0), 3.0, 0.0);
    near(material_absorption_at(a, 380.0), 1.0, 0.0);
    near(material_absorption_at(b, 450.0), 5.0, 1e-14);
    near(material_absorption(b).z, 10.0 * 0.643, 1e-12); /* at 464.3 nm */
    scene_destroy(s);
}

static void expect_error(const char *text, const char *expected)
{
    scene *s = NULL;
    diagnostic why = {.what = ""};
    char line[DIAGNOSTIC_TEXT_MAX];
    assert_int_equal(scene_read_text("test.yaml", text, strlen(text), &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
    assert_string_equal(diagnostic_text(&why, line, sizeof line), expected);
}

static void invalid_media_are_refused_with_a_location(void **state)
{
    (void)state;
    expect_error("solids:\n  a: {shape: sphere, ior: 1.5, medium: water}\n",
                 "test.yaml:2:27: both an ior and a medium are given; keep either the ior or the medium");
    expect_error("materials:\n  a: {medium: water, ior: 1.5}\n",
                 "test.yaml:2:27: both an ior and a medium are given; keep either the ior or the medium");
    expect_error("background: {medium: water, ior: 1.5}\n",
                 "test.yaml:1:34: both an ior and a medium are given; keep either the ior or the medium");
    expect_error(
        "solids:\n  a: {shape: sphere, medium: cauchy}\n",
        "test.yaml:2:3: a: medium cauchy has no coefficients; give A, B (um^2), ..., for example 'coefficients: "
        "[1.5046, 0.0042]'");
    expect_error(
        "solids:\n  a: {shape: sphere, medium: wather}\n",
        "test.yaml:2:30: a.medium: 'wather' is not one of the choices; did you mean 'water'? cuvette media lists the "
        "names");
    expect_error("solids:\n  a: {shape: sphere, absorb_spectrum: [400, 1, 500]}\n",
                 "test.yaml:2:3: a: absorb_spectrum is not a list of pairs of wavelength and coefficient; "
                 "write nm,1/m,nm,1/m.. with ascending wavelengths, as [400, 0.1, 700, 2]");
    expect_error("solids:\n  a: {shape: sphere, coefficients: [1, x]}\n",
                 "test.yaml:2:36: a.coefficients: 'x' is not a finite number; give a number -1000000..1000000");
    expect_error("render: {integrator: path}\nlights:\n  l: {radius: 1}\n",
                 "test.yaml:3:3: l: a light with a size falls off with distance, and its reach is 0; set "
                 "'reach', the distance at which the intensity applies, or set radius to 0");
    expect_error("render: {weights: constant, polarisation: on}\n",
                 "test.yaml:1:9: constant weights do not support polarisation, which requires the Fresnel "
                 "equations; set render.weights to fresnel");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rod_scene_has_the_reference_camera_and_light),
        cmocka_unit_test(the_rod_scene_has_the_reference_solids),
        cmocka_unit_test(the_settings_of_the_report_are_overrides_of_the_scene),
        cmocka_unit_test(every_scene_of_the_project_is_valid),
        cmocka_unit_test(the_order_of_the_file_is_preserved_and_solids_may_be_first),
        cmocka_unit_test(omitted_parameters_have_their_defaults),
        cmocka_unit_test(angles_do_not_depend_on_the_order_of_keys),
        cmocka_unit_test(a_copy_is_equal_and_independent),
        cmocka_unit_test(scene_check_finds_invalid_combinations),
        cmocka_unit_test(negative_and_infinite_skies_are_refused),
        cmocka_unit_test(the_path_of_a_sky_image_is_relative_to_the_scene),
        cmocka_unit_test(indices_by_name_and_by_coefficients_equal_published_values),
        cmocka_unit_test(the_last_of_index_and_medium_applies),
        cmocka_unit_test(absorption_is_given_by_channel_or_by_wavelength),
        cmocka_unit_test(invalid_media_are_refused_with_a_location),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
