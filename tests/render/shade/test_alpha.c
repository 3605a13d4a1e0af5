/* Tests of textures with alpha: films against closed forms, and against the same scene with holes, without the object,
 * or without alpha. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "mesh_stage.h"
#include "render/plan/film.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

/* The surface sends out (0.75, 0.25, 0) and nothing else; the sky sends (0.25, 0.5, 1). */
#define SETTINGS(more)                                                                                                 \
    "background: {color: [0.25, 0.5, 1], horizon: [0.25, 0.5, 1], ambient: [1, 1, 1]}\nrender: {width: 8, height: 8, " \
    "depth: 8" more "}\ncamera: {position: [0, 0, -5], target: [0, 0, 0], projection: orthographic, view_height: 2}\n"
#define GLOWS "emission: 1, ambient: 0, diffuse: 0, specular: 0, color: [0.75, 0.25, 0]"
static const double sky[3] = {0.25, 0.5, 1.0}, glow[3] = {0.75, 0.25, 0.0};

/* A square of side 2 in the plane z = 0 about the origin, u to the right and v up; and the box of side 2. */
static mesh *square(double width)
{
    mesh *m = NULL;
    assert_int_equal(mesh_create(4, 2, false, true, false, &m, NULL), STATUS_OK);
    for (int k = 0; k < 4; k++) {
        const double x = k == 1 || k == 2 ? 1.0 : 1.0 - width, y = k > 1 ? 1.0 : -1.0;
        m->vertices[k] = vec3_make(x, y, 0.0);
        m->uvs[k] = (mesh_uv){0.5 + 0.5 * x, 0.5 + 0.5 * y};
    }
    m->triangles[0] = (mesh_triangle){{0, 2, 1}};
    m->triangles[1] = (mesh_triangle){{0, 3, 2}};
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    return m;
}

/* A white texture with the alphas of rows from below. */
static const texture *white_with(const texture_entry *like, int width, int height, const float *alpha)
{
    image *img;
    texture *t;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    assert_int_equal(image_add_alpha(img, NULL), STATUS_OK);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            img->alpha[(height - 1 - y) * width + x] = alpha[y * width + x];
    for (int i = 0; i < 3 * width * height; i++)
        img->pixel[i] = 1.0F;
    assert_int_equal(texture_create(img, TEXTURE_CLAMP, TEXTURE_CLAMP, (texture_filter)like->filter, &t, NULL),
                     STATUS_OK);
    image_destroy(img);
    return t;
}

/* The scene, loaded; its texture `map` gets these alphas, its meshes squares of full and half width. */
static scene *scene_of(const char *text, const char *assignments, int width, int height, const float *alpha)
{
    scene *s = scene_from(text);
    set_all(s, assignments);
    for (size_t i = 0; i < s->mesh_count; i++)
        if (s->meshes[i].name[0] == 's')
            s->meshes[i].data = square(strcmp(s->meshes[i].name, "short") == 0 ? 1.0 : 2.0);
    for (size_t i = 0; i < s->texture_count; i++)
        s->textures[i].data = white_with(&s->textures[i], width, height, alpha);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    return s;
}

static render_result *image_of(const char *text, const char *assignments, int width, int height, const float *alpha)
{
    scene *s = scene_of(text, assignments, width, height, alpha);
    render_result *r = render(s);
    scene_destroy(s);
    return r;
}

static uint64_t hash_of(const char *text, const char *assignments, int width, int height, const float *alpha)
{
    render_result *r = image_of(text, assignments, width, height, alpha);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    return hash;
}

static const float one[1] = {1.0F}, half[1] = {0.5F}, quarter[1] = {0.25F}, none[1] = {0.0F};

#define CARD                                                                                             \
    SETTINGS("")                                                                                         \
    "meshes: {square: {generate: box}}\ntextures: {map: {file: none.png, filter: nearest}}\nmaterials: " \
    "{leaf: {" GLOWS ", texture: map}}\nsolids:\n  card: {shape: mesh, mesh: square, material: leaf}\n"
static const char card[] = CARD;

/* a C + (1 - a) B in each pixel, within the film's rounding. */
static void check_cover(const render_result *r, const float *alpha, int pixels, double tolerance)
{
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 3; c++) {
            const double a = (double)alpha[pixels == 1 ? 0 : (7 - i / 8) * 8 + i % 8];
            assert_true(fabs(film_value(r->img, i % 8, i / 8, c) - (a * glow[c] + (1.0 - a) * sky[c])) <= tolerance);
        }
}

static void a_blended_card_is_over_the_sky_and_a_mask_cuts_it(void **state)
{
    (void)state;
    float alpha[64], cut[64];
    for (int i = 0; i < 64; i++)
        alpha[i] = (float)(i * 37 % 64) / 63.0F, cut[i] = alpha[i] >= 0.5F, alpha[i] = i % 5 ? alpha[i] : cut[i];
    render_result *r = image_of(card, "leaf.alpha=blend", 8, 8, alpha);
    check_cover(r, alpha, 64, 1e-5);
    need_counters();
    int between = 0;
    for (int i = 0; i < 64; i++)
        between += alpha[i] > 0.0F && alpha[i] < 1.0F;
    assert_int_equal(r->counters.refract, between); /* the rays that go on */
    render_result_destroy(r);
    static const char *const modes[] = {"render.lighting=whitted", "render.lighting=phong", "render.integrator=path"};
    for (int i = 0; i < 3; i++) {
        char text[100];
        snprintf(text, sizeof text, "leaf.alpha=mask %s", modes[i]);
        r = image_of(card, text, 8, 8, alpha);
        check_cover(r, cut, 64, 1e-5);
        assert_int_equal(r->counters.refract, 0);
        render_result_destroy(r);
    }
    for (int i = 0; i < 64; i++)
        cut[i] = alpha[i] >= 0.125F;
    r = image_of(card, "leaf.alpha=mask leaf.alpha_cutoff=0.125", 8, 8, alpha);
    check_cover(r, cut, 64, 1e-5);
    render_result_destroy(r);
    /* by default alpha is ignored */
    r = image_of(card, "", 8, 8, alpha);
    check_cover(r, one, 1, 1e-5);
    render_result_destroy(r);
}

/* Cards one behind the other: the sky keeps (1 - a)^n. */
static void layers_of_blended_cards_multiply(void **state)
{
    (void)state;
    scene *s =
        scene_of(card, "leaf.alpha=blend leaf.emission=0 card.copies=1,1,6 card.spacing=1,1,0.25", 1, 1, quarter);
    render_result *r = render(s);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(film_value(r->img, 3, 4, c) - sky[c] * pow(0.75, 6)) < 1e-5);
    render_result_destroy(r);
    /* each card is one deeper: a lower limit cuts, and the cut light is counted */
    set(s, "render.depth=3");
    set(s, "render.beyond=black");
    r = render(s);
    assert_true(film_value(r->img, 3, 4, 0) == 0.0);
    need_counters();
    assert_int_equal(r->counters.cut_depth, 64);
    render_result_destroy(r);
    scene_destroy(s);
}

#define OPEN(shape)                                                                                      \
    SETTINGS("")                                                                                         \
    "textures: {map: {file: none.png, filter: nearest}}\nmaterials: {leaf: {" GLOWS ", texture: map}}\n" \
    "solids:\n  ball: {material: leaf, " shape "}\n"
#define BALL OPEN("shape: sphere, radius: 3")

/* A ray meets a solid's surface twice, or once from within. */
static void a_solid_is_a_skin_with_two_sides(void **state)
{
    (void)state;
    static const char *const shapes[] = {BALL, OPEN("shape: box, size: [4, 4, 4]"),
                                         OPEN("shape: cylinder, radius: 3, height: 6, position: [0, -3, 0]"),
                                         OPEN("shape: torus, radius: 9, tube_radius: 2, position: [9, 0, 0]")};
    for (int i = 0; i < 4; i++) {
        for (int within = 0; within < 2; within++) {
            const char *text = within ? "leaf.alpha=blend camera.position=0,0,-0.5 camera.view_height=0.5"
                                      : "leaf.alpha=blend camera.position=0,0,-20 camera.view_height=0.5";
            render_result *r = image_of(shapes[i], text, 1, 1, quarter);
            for (int c = 0; c < 3; c++) {
                const double clear = within ? 0.75 : 0.75 * 0.75, expected = clear * sky[c] + (1.0 - clear) * glow[c];
                assert_true(fabs(film_value(r->img, 3, 4, c) - expected) < 1e-5);
            }
            render_result_destroy(r);
        }
    }
    /* a smaller ball inside, of higher priority, is seen through the surface */
    render_result *r = image_of(
        BALL
        "  core: {shape: sphere, radius: 2.5, priority: 1, color: [0, 1, 1], emission: 1, diffuse: 0, specular: 0, "
        "ambient: 0}\n",
        "leaf.alpha=blend", 1, 1, quarter);
    static const double core[3] = {0.0, 1.0, 1.0};
    for (int c = 0; c < 3; c++)
        assert_true(fabs(film_value(r->img, 3, 4, c) - (0.75 * core[c] + 0.25 * glow[c])) < 1e-5);
    render_result_destroy(r);
}

/* The mean over N paths of a surface that is met by chance: 5 standard deviations of the binomial distribution. */
static void random_paths_meet_a_blended_surface_by_chance(void **state)
{
    (void)state;
    static const char *const samplers[] = {"philox", "sobol"};
    for (int i = 0; i < 2; i++) {
        char text[120];
        snprintf(text, sizeof text, "leaf.alpha=blend render.integrator=path render.paths=64 render.sampler=%s",
                 samplers[i]);
        scene *s = scene_of(BALL, text, 1, 1, quarter);
        const double clear = 0.75 * 0.75, mean = mean_radiance(s), expected = clear * sky[0] + (1.0 - clear) * glow[0],
                     deviation = sqrt(clear * (1.0 - clear) / (64.0 * 64.0)) * fabs(glow[0] - sky[0]);
        assert_true(fabs(mean - expected) < 5.0 * deviation);
        assert_true(fabs(mean - expected) > 0.0);
        scene_destroy(s);
    }
}

/* A white furnace: a surface that reflects all of a uniform sky is invisible, whatever part of it is there. */
static void a_blended_surface_keeps_the_light_of_a_furnace(void **state)
{
    (void)state;
    scene *s = scene_of(BALL,
                        "leaf.alpha=blend leaf.emission=0 leaf.diffuse=1 leaf.color=1,1,1 background.color=1,1,1 "
                        "background.horizon=1,1,1 render.integrator=path render.paths=256 render.depth=64",
                        1, 1, half);
    assert_true(fabs(mean_radiance(s) - 1.0) < 1e-3);
    scene_destroy(s);
}

/* A floor under a card or a ball, seen from the side. */
#define ROOM                                                                                                        \
    "background: {color: [0.1, 0.2, 0.3], horizon: [0.1, 0.2, 0.3]}\nrender: {width: 24, height: 18, depth: 5, "    \
    "shadows: attenuated}\ncamera: {position: [0.3, 3, -6.1], target: [0.1, 0.2, 0]}\nmeshes: {square: {generate: " \
    "box}, short: {generate: box}, closed: {generate: box}}\ntextures: {map: {file: none.png, filter: nearest}}\n"  \
    "materials: {leaf: {color: [0.5, 0.75, 0.25], diffuse: 0.8, specular: 0, texture: map}}\nlights: {lamp: "       \
    "{position: [0.37, 5.3, "                                                                                       \
    "0.21], intensity: 1}}\nsolids:\n  floor: {shape: plane, diffuse: 0.8, specular: 0, ambient: 0}\n"
#define OVERHEAD "  card: {shape: mesh, mesh: square, material: leaf, position: [0, 2.5, 0], rotation: [90, 0, 0]}\n"
#define OVERHEAD_SHORT \
    "  card: {shape: mesh, mesh: short, material: leaf, position: [0, 2.5, 0], rotation: [90, 0, 0]}\n"

static void a_masked_card_and_a_card_with_that_shape_give_one_film(void **state)
{
    (void)state;
    static const float right[2] = {0.0F, 1.0F};
    static const char *const modes[] = {"render.integrator=whitted", "render.radiance=basic",
                                        "render.integrator=path render.paths=4 lamp.radius=0.5 lamp.reach=5",
                                        "render.samples=4 lamp.radius=0.5 lamp.reach=5 render.soft_shadows=on"};
    for (int i = 0; i < 3; i++) {
        char text[120];
        snprintf(text, sizeof text, "leaf.alpha=mask %s", modes[i]);
        const uint64_t cut = hash_of(ROOM OVERHEAD, text, 2, 1, right),
                       shape = hash_of(ROOM OVERHEAD_SHORT, modes[i], 1, 1, one),
                       whole = hash_of(ROOM OVERHEAD, modes[i], 1, 1, one);
        assert_true(cut == shape);
        assert_true(cut != whole);
    }
}

static void a_blended_card_dims_the_lamp_on_the_floor(void **state)
{
    (void)state;
    /* the camera sees only the floor, within the card's shadow */
    static const char view[] =
        "camera.position=0.1,1.5,0 camera.target=0,0,0.01 camera.fov_deg=20 background.color=0,0,0 "
        "background.horizon=0,0,0 leaf.ambient=0 leaf.diffuse=0 ";
    char text[400];
    scene *s = scene_of(ROOM OVERHEAD, view, 1, 1, quarter);
    set(s, "card.visible=off");
    const double open = mean_radiance(s);
    scene_destroy(s);
    static const char *const modes[] = {"render.integrator=whitted", "render.radiance=basic",
                                        "render.integrator=path render.depth=1"};
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "%s leaf.alpha=blend card.copies=1,1,2 card.spacing=1,1,0.25 %s", view, modes[i]);
        s = scene_of(ROOM OVERHEAD, text, 1, 1, quarter);
        assert_true(open > 0.1 && fabs(mean_radiance(s) / open - 0.75 * 0.75) < 1e-4);
        scene_destroy(s);
    }
}

#define SOLIDS                                                                                                     \
    "  card: {shape: mesh, mesh: square, material: leaf, position: [0.5, 1.5, 0.4], rotation: [20, 30, 0]}\n"      \
    "  ball: {shape: sphere, material: leaf, position: [-1, 0.7, 0.3], radius: 0.6}\n"                             \
    "  crate: {shape: mesh, mesh: closed, material: leaf, position: [1, 0.5, -1], rotation: [10, 20, 30]}\n"       \
    "  cup: {shape: cup, material: leaf, position: [0, 0.1, -1.4], radius: 0.4, inner_radius: 0.3, height: 0.6}\n" \
    "  glass: {shape: sphere, position: [-0.3, 0.8, -0.6], radius: 0.5, transparency: 1, ior: 1.5, priority: 3}\n"

/* Settings in which rays of every kind meet the surfaces. */
static const char *const settings[] = {"render.integrator=whitted",
                                       "render.lighting=phong",
                                       "render.integrator=aov",
                                       "render.radiance=basic background.medium=water background.absorb_per_m=1,2,3",
                                       "render.integrator=path render.paths=4",
                                       "render.integrator=path render.paths=2 lamp.radius=0.3 lamp.reach=5 "
                                       "background.absorb_per_m=1,2,3 render.roulette=off render.sampler=sobol",
                                       "render.caustics=photons render.photons=2000 background.absorb_per_m=1,2,3",
                                       "render.polarisation=on",
                                       "render.accel=none"};

/* The largest difference of two films. */
static double films_apart(const render_result *a, const render_result *b)
{
    double worst = 0.0;
    for (int i = 0; i < 3 * 24 * 18; i++)
        worst = fmax(
            worst, fabs(film_value(a->img, i / 3 % 24, i / 72, i % 3) - film_value(b->img, i / 3 % 24, i / 72, i % 3)));
    return worst;
}

static void alpha_0_everywhere_is_as_if_there_were_no_object(void **state)
{
    (void)state;
    static const char *const modes[] = {"mask", "blend"};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        char gone[300];
        snprintf(gone, sizeof gone, "%s card.visible=off ball.visible=off crate.visible=off cup.visible=off",
                 settings[i]);
        render_result *without = image_of(ROOM SOLIDS, gone, 1, 1, none);
        for (int k = 0; k < 2; k++) {
            char text[300];
            snprintf(text, sizeof text, "%s leaf.alpha=%s", settings[i], modes[k]);
            render_result *r = image_of(ROOM SOLIDS, text, 1, 1, none);
            /* an absorbing medium is added up in pieces, which are rounded */
            const double tolerance = strstr(settings[i], "absorb") ? 1e-6 : 0.0;
            if (films_apart(r, without) > tolerance)
                fail_msg("%s differs from the empty scene by %g", text, films_apart(r, without));
            render_result_destroy(r);
        }
        render_result_destroy(without);
    }
}

static void alpha_1_everywhere_is_as_if_the_texture_had_none(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        char text[300];
        snprintf(text, sizeof text, "%s leaf.alpha=blend", settings[i]);
        const uint64_t plain = hash_of(ROOM SOLIDS, settings[i], 1, 1, none);
        assert_true(hash_of(ROOM SOLIDS, text, 1, 1, one) == plain);
        /* with a cutoff below all alphas the card is searched as a partial surface, and is there everywhere */
        static const float far[2] = {0.5F, 1.0F};
        snprintf(text, sizeof text,
                 "%s leaf.alpha=mask ball.visible=off cup.visible=off crate.visible=off leaf.alpha_cutoff=0.25",
                 settings[i]);
        const uint64_t cut = hash_of(ROOM SOLIDS, text, 2, 1, far);
        snprintf(text, sizeof text, "%s ball.visible=off cup.visible=off crate.visible=off", settings[i]);
        assert_true(cut == hash_of(ROOM SOLIDS, text, 1, 1, one));
    }
}

/* The film does not depend on the search for interfaces, the instruction set or the threads. */
static void every_search_gives_the_same_film(void **state)
{
    (void)state;
    scene_text many = {.length = 0};
    add(&many, "%s", ROOM);
    for (int i = 0; i < 40; i++)
        add(&many, "  ball%d: {shape: sphere, material: leaf, position: [%g, 0.3, %g], radius: 0.2}\n", i,
            0.5 * (i % 8) - 2.0, 0.5 * (i / 8) - 1.0);
    static const float few[4] = {0.0F, 0.25F, 1.0F, 0.5F};
    static const char *const modes[] = {"render.integrator=whitted", "render.integrator=path render.paths=4"};
    for (int i = 0; i < 2; i++) {
        char text[200];
        uint64_t first = 0;
        for (int k = 0; k < 4; k++) {
            snprintf(text, sizeof text, "leaf.alpha=%s render.accel=%s render.threads=%d %s", "blend",
                     k < 2 ? "bvh" : "none", 1 + k % 2, modes[i]);
            scene *s = scene_of(many.at, text, 2, 2, few);
            for (isa level = ISA_BASE; level <= isa_best(); level++) {
                render_result *r = render_at(s, level, NULL);
                first = first ? first : film_hash(r->img);
                assert_true(film_hash(r->img) == first);
                render_result_destroy(r);
            }
            scene_destroy(s);
        }
    }
}

/* A card exactly on a table: through its holes the table's top is seen, not its inside. */
static void a_hole_shows_what_the_card_lies_on(void **state)
{
    (void)state;
    static const char text[] =
        CARD "  table: {shape: box, size: [4, 4, 2], position: [0, 0, 1], color: [0, 1, 0], ambient: 0, diffuse: 1, "
             "specular: 0, priority: -1}\nlights: {lamp: {position: [0, 0, -5]}}\n";
    static const float left[2] = {0.0F, 1.0F};
    render_result *r = image_of(text, "leaf.alpha=mask", 2, 1, left);
    /* the lamp shines on the top only; at this pixel's centre 0.625 from the axis, 5 from the lamp */
    const double lit = 5.0 / sqrt(25.0 + 0.625 * 0.625 + 0.125 * 0.125);
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(film_value(r->img, 1, 4, c) - (c == 1 ? lit : 0.0)) < 1e-5);
        assert_true(fabs(film_value(r->img, 6, 4, c) - glow[c]) < 1e-5);
    }
    render_result_destroy(r);
}

static void photons_pass_holes_and_blended_surfaces(void **state)
{
    (void)state;
    /* a mirror sends the lamp's light to the floor through a card */
    static const char text[] =
        "background: {color: [0, 0, 0], horizon: [0, 0, 0], ambient: [0, 0, 0]}\nrender: {width: 8, height: 8, "
        "caustics: "
        "photons, photons: 100000, depth: 4}\ncamera: {position: [4, 0.5, 0], target: [4, 0, 0.001], fov_deg: 60}\n"
        "meshes: {square: {generate: box}}\ntextures: {map: {file: none.png, filter: nearest}}\nmaterials: {leaf: "
        "{color: "
        "[0, 0, 0], diffuse: 0, specular: 0, ambient: 0, texture: map}}\nlights: {lamp: {kind: cone, position: [4, 3, "
        "0], "
        "target: [4, 5, 0], half_angle_deg: 20}}\nsolids:\n  floor: {shape: plane, diffuse: 1, specular: 0, ambient: "
        "0, color: [1, 1, 1]}\n"
        "  mirror: {shape: box, position: [2, 5, 0], size: [6, 0.1, 6], reflectivity: 1, diffuse: 0, specular: 0}\n"
        "  card: {shape: mesh, mesh: square, material: leaf, position: [0, 2, 0], rotation: [90, 0, 0], scale: [9, 9, "
        "9]}\n";
    scene *s = scene_of(text, "card.visible=off", 1, 1, one);
    const double open = mean_radiance(s);
    scene_destroy(s);
    assert_true(open > 0.0);
    static const struct {
        const char *mode;
        double passes;
    } cases[] = {{"leaf.alpha=opaque", 0.0}, {"leaf.alpha=blend", 0.75}};
    for (int i = 0; i < 2; i++) {
        s = scene_of(text, cases[i].mode, 1, 1, quarter);
        if (fabs(mean_radiance(s) / open - cases[i].passes) > 0.03)
            fail_msg("%s: %g of %g", cases[i].mode, mean_radiance(s), open);
        scene_destroy(s);
    }
}

static void combinations_without_a_meaning_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *assignments, *what;
    } cases[] = {
        {"ball.transparency=1 ball.alpha=mask", "ball: the surface of a transparent solid cannot have alpha: mask"},
        {"ball.transparency=1 ball.alpha=blend", "ball: the surface of a transparent solid cannot have alpha: blend"},
        {"ball.medium=gold ball.alpha=blend", "ball: alpha cannot remove a part of a metal"},
        {"ball.film_thickness_nm=300 ball.alpha=mask", "ball: alpha cannot remove a part of a film"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene *s = scene_from(ROOM "  ball: {shape: sphere, radius: 0.6}\n");
        diagnostic why = {0};
        set_all(s, cases[i].assignments);
        assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
        assert_string_equal(why.what, cases[i].what);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_blended_card_is_over_the_sky_and_a_mask_cuts_it),
        cmocka_unit_test(layers_of_blended_cards_multiply),
        cmocka_unit_test(a_solid_is_a_skin_with_two_sides),
        cmocka_unit_test(random_paths_meet_a_blended_surface_by_chance),
        cmocka_unit_test(a_blended_surface_keeps_the_light_of_a_furnace),
        cmocka_unit_test(a_masked_card_and_a_card_with_that_shape_give_one_film),
        cmocka_unit_test(a_blended_card_dims_the_lamp_on_the_floor),
        cmocka_unit_test(alpha_0_everywhere_is_as_if_there_were_no_object),
        cmocka_unit_test(alpha_1_everywhere_is_as_if_the_texture_had_none),
        cmocka_unit_test(every_search_gives_the_same_film),
        cmocka_unit_test(a_hole_shows_what_the_card_lies_on),
        cmocka_unit_test(photons_pass_holes_and_blended_surfaces),
        cmocka_unit_test(combinations_without_a_meaning_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
