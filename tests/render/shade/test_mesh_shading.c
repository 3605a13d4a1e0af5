/* Tests of mesh shading at points with a known result: Phong's sum with flat, interpolated and vertex values; textures;
 * and the limits of shading normals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>
#include <cmocka.h>

#include "mesh_stage.h"
#include "random_stream.h"
#include "render/plan/film.h"
#include "render_fixture.h"
#include "scene/model/face_materials.h"
#include "scene/model/scene.h"

#define DARK \
    "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\nrender: {width: 1, height: 1, depth: 2, shadows: off}\n"

/* A tilted square of side 2 in the plane z = 0, with corner normals leaning outwards; seen from z < 0. */
static void give_square(scene *s, vec3 *corner, vec3 *normal)
{
    static const double at[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    mesh *m = NULL;
    assert_int_equal(mesh_create(4, 2, true, true, false, &m, NULL), STATUS_OK);
    for (int k = 0; k < 4; k++) {
        corner[k] = m->vertices[k] = vec3_make(at[k][0], at[k][1], 0.0);
        normal[k] = m->normals[k] = vec3_normalize(vec3_make(0.5 * at[k][0], 0.25 * at[k][1], -1.0));
        m->uvs[k] = (mesh_uv){0.5 + 0.5 * at[k][0], 0.5 + 0.5 * at[k][1]};
    }
    m->triangles[0] = (mesh_triangle){{0, 2, 1}};
    m->triangles[1] = (mesh_triangle){{0, 3, 2}};
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    assert_false(m->closed);
    s->meshes[0].data = m;
}

static stage square_stage(const char *more, const char *assignments)
{
    scene_text t = {.length = 0};
    add(&t,
        DARK "meshes: {square: {generate: box}}\ntextures: {map: {file: none.png, filter: nearest}}\n"
             "lights: {lamp: {position: [1.5, 2, -3], color: [1, 0.5, 0.25]}}\nsolids: {sheet: {shape: mesh, mesh: "
             "square, %s}}\n",
        more);
    stage g = {.setting = scene_from(t.at)};
    vec3 unused[8];
    give_square(g.setting, unused, unused + 4);
    set_all(g.setting, assignments);
    static const double texels[24] = {0.125, 0.25, 1, 0.375, 0.25, 1, 0.625, 0.25, 1, 0.875, 0.25, 1,
                                      0.125, 0.75, 1, 0.375, 0.75, 1, 0.625, 0.75, 1, 0.875, 0.75, 1};
    give_texture(g.setting, "map", texels, 4, 2);
    diagnostic why = {0};
    worked(scene_load(g.setting, &why), &why);
    stage_look(&g);
    return g;
}

/* k_a + k_d (N.L) + k_s (R.V)^n, red channel, with a light of 1 on the eye's side. */
static double phong(vec3 n, vec3 at, vec3 eye, double k_d, double k_s, double shininess)
{
    const vec3 lamp = vec3_make(1.5, 2, eye.z < 0.0 ? -3 : 3);
    const vec3 l = vec3_normalize(vec3_sub(lamp, at)), v = vec3_normalize(vec3_sub(eye, at));
    const double n_l = vec3_dot(n, l);
    const vec3 r = vec3_sub(vec3_scale(n, 2.0 * n_l), l);
    return n_l > 0.0 ? k_d * n_l + k_s * pow(fmax(vec3_dot(r, v), 0.0), shininess) : 0.0;
}

/* Seen from behind, normals are turned to the eye. */
static void check_phong(int rule, bool behind, const vec3 *corner, const vec3 *normal)
{
    static const char *const rules[] = {"flat", "smooth", "gouraud"};
    char more[200];
    snprintf(more, sizeof more,
             "color: [1, 1, 1], ambient: 0.125, diffuse: 0.5, specular: 0.25, shininess: 5, shading: %s", rules[rule]);
    stage g = square_stage(more, behind ? "lamp.position=1.5,2,3" : "");
    const vec3 eye = vec3_make(0.25, -0.5, behind ? 4.0 : -4.0);
    for (int k = 0; k < 200; k++) {
        const double x = -0.95 + 1.9 * (k % 20) / 19.0, y = -0.93 + 1.8 * (k / 20) / 9.0;
        const vec3 at = vec3_make(x, y, 0.0);
        const ray_tree *tree = stage_ray(&g, eye, vec3_sub(at, eye));
        /* for the triangle 0 2 1 (x > y): weights of 0, 2, 1; else of 0, 2, 3 */
        const double third = fabs(x - y) / 2.0, second = x > y ? (1.0 + y) / 2.0 : (1.0 + x) / 2.0,
                     first = 1.0 - second - third;
        const int other = x > y ? 1 : 3;
        double expected;
        if (rule == 0)
            expected = phong(vec3_make(0, 0, behind ? 1 : -1), at, eye, 0.5, 0.25, 5.0);
        else if (rule == 1)
            expected = phong(
                vec3_normalize(vec3_add(vec3_scale(normal[0], first),
                                        vec3_add(vec3_scale(normal[2], second), vec3_scale(normal[other], third)))),
                at, eye, 0.5, 0.25, 5.0);
        else
            expected = first * phong(normal[0], corner[0], eye, 0.5, 0.25, 5.0) +
                       second * phong(normal[2], corner[2], eye, 0.5, 0.25, 5.0) +
                       third * phong(normal[other], corner[other], eye, 0.5, 0.25, 5.0);
        assert_true(fabs(tree->radiance[0] - (0.125 + expected)) < 1e-8);
        assert_true(fabs(tree->radiance[2] - (0.125 + 0.25 * expected)) < 1e-8);
    }
    stage_close(&g);
}

static void phongs_sum_has_its_known_values(void **state)
{
    (void)state;
    vec3 corner[4], normal[4];
    scene *unused = scene_from("meshes: {m: {generate: box}}\n");
    give_square(unused, corner, normal);
    scene_destroy(unused);
    for (int behind = 0; behind < 2; behind++) {
        for (int rule = 0; rule < 3; rule++)
            check_phong(rule, behind, corner, normal);
        for (int k = 0; k < 4; k++)
            normal[k] = vec3_scale(normal[k], -1.0);
    }
}

/* The light of the corners may be left out only where it rounds to nothing: half a unit of the film is one unit. */
static void light_of_corners_counts_from_half_a_unit_on(void **state)
{
    (void)state;
    for (int more = 0; more < 2; more++) {
        char text[600];
        snprintf(text, sizeof text,
                 "render: {width: 1, height: 1, depth: 0}\nbackground: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                 "camera: {position: [0, 0, -5], target: [0, 0, 0], fov_deg: 0.001}\n"
                 "meshes: {cube: {generate: box}}\nlights: {lamp: {position: [0, 0, -1e6], intensity: %.17g}}\n"
                 "solids: {box: {shape: mesh, mesh: cube, color: [1, 1, 1], diffuse: 1, shading: gouraud}}\n",
                 (more ? 0.5025 : 0.495) / FILM_ONE);
        scene *s = scene_with_meshes(text, "");
        render_result *r = render(s);
        assert_int_equal(r->img->sum[0], more);
        render_result_destroy(r);
        scene_destroy(s);
    }
}

/* From within a cube, straight on, no reflection is total, however many rays there are: kernels take whole vectors,
 * whose lanes behind the last ray repeat it. */
static void only_rays_are_counted(void **state)
{
    (void)state;
    need_counters();
    scene *s = scene_with_meshes("render: {height: 1, depth: 1}\ncamera: {target: [0, 0, 1], fov_deg: 1}\n"
                                 "meshes: {cube: {generate: box}}\nsolids: {box: {shape: mesh, mesh: cube, "
                                 "scale: [4, 4, 4], transparency: 1, ior: 1.6}}\n",
                                 "camera.position=0,0,0");
    for (int width = 1; width <= 17; width++) {
        s->render.width = width;
        render_result *r = render(s);
        assert_int_equal(r->counters.total_internal, 0);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

static void light_behind_the_plane_adds_nothing_to_the_ambient_term(void **state)
{
    (void)state;
    static const char *const rules[] = {"flat", "smooth", "gouraud"};
    for (int rule = 0; rule < 3; rule++) {
        char more[200];
        snprintf(more, sizeof more, "color: [1, 1, 1], ambient: 0.125, diffuse: 0.5, specular: 0.25, shading: %s",
                 rules[rule]);
        stage g = square_stage(more, "lamp.position=6,1,0.001 render.shadows=attenuated");
        for (int k = 0; k < 50; k++)
            assert_true(stage_ray(&g, vec3_make(0.1, 0.2, -3.0), vec3_make(-0.3 + 0.012 * k, 0.1, 3.0))->radiance[0] ==
                        0.125);
        stage_close(&g);
    }
}

/* Two coincident open sheets have no self-shadow and leak no light. */
static void coincident_sheets_have_no_self_shadow_and_no_light_leaks(void **state)
{
    (void)state;
    static const char *const sheets[] = {
        "shape: mesh, mesh: square, rotation: [31, 17, 5], ambient: 0.125, diffuse: 0.5, specular: 0, shading: flat}, "
        "second: {shape: mesh, mesh: square, rotation: [31, 17, 5], ambient: 0.125, diffuse: 0.5, specular: 0, "
        "shading: flat",
        "shape: mesh, mesh: square, rotation: [31, 17, 5], copies: [2, 1, 1], spacing: [0, 0, 0], ambient: 0.125, "
        "diffuse: 0.5, specular: 0, shading: flat"};
    for (size_t k = 0; k < COUNT(sheets); k++) {
        scene_text t = {.length = 0};
        add(&t,
            "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\nrender: {width: 1, height: 1}\nmeshes: {square: "
            "{generate: box}}\n"
            "lights: {lamp: {position: [1, 2, -30]}, behind: {position: [-2, 1, 40]}}\nsolids: {sheet: {%s}}\n",
            sheets[k]);
        stage g = {.setting = scene_from(t.at)};
        vec3 unused[8];
        give_square(g.setting, unused, unused + 4);
        stage_look(&g);
        uint64_t seed = 3;
        for (int i = 0; i < 3000; i++) {
            const vec3 at = vec3_make(random_real(&seed, -0.6, 0.6), random_real(&seed, -0.6, 0.6), 0.0),
                       world = turned(at, vec3_make(31, 17, 5));
            const vec3 n = turned(vec3_make(0, 0, -1), vec3_make(31, 17, 5)),
                       eye = vec3_make(random_real(&seed, -2, 2), 0.3, -5.0);
            const vec3 l = vec3_normalize(vec3_sub(vec3_make(1, 2, -30), world));
            const double expected = 0.125 + 0.5 * vec3_dot(n, l);
            assert_true(fabs(stage_ray(&g, eye, vec3_sub(world, eye))->radiance[0] - expected) < 1e-8);
        }
        stage_close(&g);
    }
}

/* On a coarse smooth ball, inside and outside, reflected rays stay on their side of the triangle and refracted rays
 * leave it. A mirror with the unit normal of the hit reflects away from the triangle, at least by the angle whose
 * tangent is 0.01 (mesh_surface_kernel.c). */
static void interpolated_normals_keep_rays_on_their_side(void **state)
{
    (void)state;
    static const char text[] =
        "background: {color: [1, 1, 1]}\nrender: {width: 1, height: 1, depth: 8, beyond: black}\nmeshes: {rough: "
        "{generate: icosphere, level: 0}}\n"
        "solids: {ball: {shape: mesh, mesh: rough, shading: smooth, transparency: 1, ior: 1.5}}\n";
    stage g = stage_with_meshes(text, "");
    const mesh *m = g.setting->meshes[0].data;
    uint64_t seed = 8;
    int reflected = 0, refracted = 0, bent = 0;
    double worst = 0.0;
    for (int i = 0; i < 4000; i++) {
        const vec3 o = vec3_scale(random_direction(&seed), 3.0), to = vec3_scale(random_direction(&seed), 0.97);
        const ray_tree *tree = stage_ray(&g, o, vec3_sub(to, o));
        for (size_t k = 1; k < tree->count; k++) {
            const ray_node *n = &tree->node[k], *p = &tree->node[n->parent];
            const mesh_triangle t = m->triangles[p->hit.face];
            const vec3 a = m->vertices[t.corner[0]];
            vec3 side = vec3_cross(vec3_sub(m->vertices[t.corner[1]], a), vec3_sub(m->vertices[t.corner[2]], a));
            side = vec3_dot(side, p->direction) > 0.0 ? vec3_scale(side, -1.0) : side;
            assert_true((vec3_dot(side, n->direction) > 0.0) == (n->kind == RAY_REFLECT));
            const vec3 normal = p->hit.normal, mirrored = direction_reflect(p->direction, normal, p->hit.cos_i);
            const double sine = vec3_dot(mirrored, vec3_normalize(side));
            assert_true(fabs(vec3_length(normal) - 1.0) < 1e-14 && sine > 0.01 / sqrt(1.0001) - 1e-14);
            bent += sine < 0.011;
            reflected += n->kind == RAY_REFLECT, refracted += n->kind == RAY_REFRACT;
        }
        worst = fmax(worst, fabs(tree->radiance[1] + tree_cut(tree, 1) - 1.0));
    }
    assert_true(reflected > 4000 && refracted > 4000 && bent > 100);
    assert_true(worst < 1e-8); /* and no energy is lost */
    stage_close(&g);
}

/* The white furnace (test_furnace.c) with nested meshes. */
static void meshes_in_a_furnace_conserve_energy(void **state)
{
    (void)state;
    static const char text[] =
        "background: {color: [1, 1, 1]}\ncamera: {position: [0.3, 1.9, -4.5], target: [0, 0.5, 0], fov_deg: "
        "40}\nrender: {width: 16, height: 12, beyond: black}\n"
        "meshes: {hoop: {generate: torus, around: 20, tube: 10}, globe: {generate: icosphere, level: 2}, cube: "
        "{generate: box}}\n"
        "solids:\n  bath: {shape: mesh, mesh: cube, scale: [2.5, 1, 2.5], transparency: 1, ior: 1.33, priority: 1}\n"
        "  ring: {shape: mesh, mesh: hoop, shading: smooth, transparency: 1, ior: 1.5, rotation: [20, 0, 30], "
        "position: [0, 0.4, 0], priority: 3}\n"
        "  ball: {shape: mesh, mesh: globe, shading: smooth, transparency: 1, ior: 1.8, scale: [0.7, 0.5, 0.6], "
        "position: [0.6, 0.4, 0], priority: 2}\n"
        "  bubble: {shape: sphere, radius: 0.5, transparency: 1, ior: 1, position: [-0.7, 0.5, 0.1], priority: 4}\n"
        "  beads: {shape: mesh, mesh: globe, transparency: 1, ior: 2.4, scale: [0.15, 0.15, 0.15], copies: [3, 2, 3], "
        "spacing: [0.5, 0.4, 0.5], position: [-0.6, 0.2, -0.5], priority: 5}\n";
    static const char *const eyes[] = {"", "camera.position=0,0.1,0", "camera.position=0.9,0.5,0.05",
                                       "render.polarisation=on"};
    for (size_t k = 0; k < COUNT(eyes); k++) {
        stage g = stage_with_meshes(text, eyes[k]);
        set(g.setting, "render.depth=8");
        stage_look(&g);
        for (int y = 0; y < 12; y++)
            for (int x = 0; x < 16; x++) {
                const ray_tree *tree = stage_pixel(&g, x, y);
                assert_true(fabs(tree->radiance[1] + tree_cut(tree, 1) - 1.0) < 1e-9);
            }
        stage_close(&g);
    }
}

/* exp(-a d) over the path straight through a box and through the centre of a fine sphere. */
static void absorption_in_meshes_has_its_closed_form(void **state)
{
    (void)state;
    static const char *const regions[] = {"{generate: box, size: [2, 1, 2]}", "{generate: icosphere, level: 6}"};
    for (int k = 0; k < 2; k++) {
        scene_text t = {.length = 0};
        add(&t,
            "background: {color: [1, 1, 1]}\nrender: {width: 1, height: 1, depth: 3}\nmeshes: {body: %s}\n"
            "solids: {lump: {shape: mesh, mesh: body, transparency: 1, ior: 1.25, absorb_per_m: [0.5, 1, 2], position: "
            "[0, 0, 4]}}\n",
            regions[k]);
        stage g = stage_with_meshes(t.at, "render.unit_m=0.5 background.ior=1.25 lump.ior=1.5");
        const double length = 2.0;
        const ray_node *in = &stage_ray(&g, vec3_make(0.001, 0.002, 0), vec3_make(0, 0, 1))->node[0];
        const ray_node *through = child_of(&g.tree, in, RAY_REFRACT);
        assert_non_null(through);
        for (int c = 0; c < 3; c++) {
            const double a = c == 0 ? 0.5 : c == 1 ? 1.0 : 2.0, share = exp(-a * length * 0.5);
            assert_true(fabs(through->hit.transmittance[c] - share) < (k == 0 ? 1e-14 : 1e-3));
        }
        stage_close(&g);
    }
}

static void expect_texel(const ray_tree *tree, double u, double v)
{
    assert_int_equal(tree->node[0].end, RAY_END_HIT);
    const double column = floor((u - floor(u)) * 4.0), line = floor((v - floor(v)) * 2.0);
    assert_true(fabs(tree->radiance[0] - (column + 0.5) / 4.0) < 1e-6 &&
                fabs(tree->radiance[1] - (line + 0.5) / 2.0) < 1e-6);
}

/* A texture in front of a viewer at -z who looks along +z begins at the viewer's left, on every shape. */
static void textures_have_the_expected_texels(void **state)
{
    (void)state;
    static const char head[] =
        DARK "textures: {map: {file: none.png, filter: nearest}}\nmeshes: {ball: {generate: icosphere, level: 5}, "
             "cube: {generate: box}, sheet: {generate: box}}\nsolids: {it: {ambient: 1, diffuse: 0, texture: map, ";
    static const struct {
        const char *shape;
        int kind;
    } things[] = {{"shape: sphere, radius: 1}}\n", 0},
                  {"shape: mesh, mesh: ball}}\n", 0},
                  {"shape: cylinder, radius: 1, height: 2, position: [0, -1, 0]}}\n", 1},
                  {"shape: box, size: [2, 2, 2]}}\n", 2},
                  {"shape: mesh, mesh: cube, scale: [2, 2, 2]}}\n", 2},
                  {"shape: plane, rotation: [-90, 0, 0], position: [0, 0, -1]}}\n", 3},
                  {"shape: plane, rotation: [-90, 0, 0], position: [0, 0, -1], texture_size: 2.5}}\n", 4}};
    for (size_t k = 0; k < COUNT(things); k++) {
        char text[2048];
        snprintf(text, sizeof text, "%s%s", head, things[k].shape);
        stage g = stage_with_meshes(text, "");
        for (int i = 0; i < 100; i++) {
            const double x = -0.713 + 0.149 * (i % 10), y = -0.67 + 0.147 * (i / 10);
            const ray_tree *tree = stage_ray(&g, vec3_make(x, y, -5.0), vec3_make(0, 0, 1));
            const vec3 p = tree->node[0].hit.point;
            const double turn = 0.5 + atan2(p.x, -p.z) / (2.0 * M_PI);
            if (things[k].kind < 2 && (fabs(turn * 4.0 - round(turn * 4.0)) < 0.01 || fabs(p.y) < 0.01))
                continue;
            switch (things[k].kind) {
            case 0: expect_texel(tree, turn, 0.5 + asin(p.y / vec3_length(p)) / M_PI); break;
            case 1: expect_texel(tree, turn, (y + 1.0) / 2.0); break;
            case 2: expect_texel(tree, (x + 1.0) / 2.0, (y + 1.0) / 2.0); break;
            case 3: expect_texel(tree, x, y); break;
            default: expect_texel(tree, x / 2.5, y / 2.5); break;
            }
        }
        stage_close(&g);
    }
}

/* A pixel that is smaller than a texel shows the texel alone where it is seen from straight ahead; the filter is wider
 * only where a surface is seen at a slant. */
static void a_texture_seen_from_ahead_is_sharp(void **state)
{
    (void)state;
    stage g = stage_with_meshes(DARK "textures: {map: {file: none.png, filter: trilinear}}\nsolids: {it: {ambient: 1, "
                                     "diffuse: 0, texture: map, shape: box, size: [2, 2, 2]}}\n",
                                "camera.position=0,0,-5 camera.fov_deg=40 render.width=64 render.height=64");
    for (int i = 0; i < 8; i++) { /* at the texels' centres */
        const double u = (i % 4 + 0.5) / 4.0, v = (i / 4 + 0.5) / 2.0;
        expect_texel(stage_ray(&g, vec3_make(2.0 * u - 1.0, 2.0 * v - 1.0, -5.0), vec3_make(0, 0, 1)), u, v);
    }
    stage_close(&g);
}

static const char *refusal_of(const char *text, const char *assignments, char *room)
{
    scene *s = scene_with_meshes(text, assignments);
    diagnostic why = {0};
    const status code = scene_check(s, &why);
    room[0] = '\0';
    if (code != STATUS_OK)
        diagnostic_text(&why, room, DIAGNOSTIC_TEXT_MAX);
    scene_destroy(s);
    return room;
}

static void an_open_dielectric_is_refused_with_its_open_edge(void **state)
{
    (void)state;
    char why[DIAGNOSTIC_TEXT_MAX];
    static const char open[] = DARK "meshes: {hills: {generate: terrain, around: 4, tube: 4}}\nsolids: {lens: {shape: "
                                    "mesh, mesh: hills, transparency: 1}}\n";
    assert_non_null(strstr(refusal_of(open, "", why), "the edge from ("));
    assert_null(strchr(why, '\n'));
    assert_string_equal(refusal_of(open, "lens.transparency=0", why), "");
    assert_string_equal(refusal_of(open, "render.transmission=simple lens.transparency=0.9", why), "");
}

static void spectral_films_refuse_textures(void **state)
{
    (void)state;
    char why[DIAGNOSTIC_TEXT_MAX];
    static const char text[] =
        DARK "textures: {map: {file: none.png}}\nsolids: {ball: {shape: sphere, texture: map}}\n";
    assert_non_null(strstr(refusal_of(text, "render.spectrum=spectral", why), "render.spectrum"));
    assert_string_equal(refusal_of(text, "", why), "");
}

/* Which numbers of materials the layer of a small image has, as bits. */
static int material_numbers(scene *s)
{
    int seen = 0;
    set_all(s, "camera.position=0,0,-3 camera.target=0,0,0 camera.fov_deg=40 render.width=8 render.height=8 "
               "render.integrator=aov");
    render_result *r = render_at(s, isa_best(), &(render_options){.layers = true});
    for (int i = 0; i < 64; i++)
        seen |= 1 << (int)r->layers->values[LAYER_MATERIAL][i];
    render_result_destroy(r);
    return seen;
}

/* Two triangles, two materials: the file's materials, and the scene's own material if it has the slot's name. */
static void faces_are_shaded_by_their_materials(void **state)
{
    (void)state;
    char folder[] = "/tmp/cuvette-faces-XXXXXX", path[64], text[1024], why[DIAGNOSTIC_TEXT_MAX];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/two.obj", folder);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs("mtllib two.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl left\nf 1 4 3\nusemtl right\nf 1 3 2\n", f);
    fclose(f);
    char library[64];
    snprintf(library, sizeof library, "%s/two.mtl", folder);
    f = fopen(library, "w");
    assert_non_null(f);
    fputs("newmtl left\nKd 0.25 0.5 0.75\nKs 0 0 0\nnewmtl right\nKd 0.5 0.125 0.0625\nKs 0 0 0\n", f);
    fclose(f);
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text,
                 DARK "lights: {lamp: {position: [0, 0, -1000000]}}\nmeshes: {two: {file: %s}}\n%ssolids: {sheet: "
                      "{shape: mesh, mesh: two%s}}\n",
                 path,
                 k == 1   ? "materials: {right: {color: [0, 1, 0], ambient: 0.5, diffuse: 0}}\n"
                 : k == 2 ? "materials: {own: {color: [0, 0, 1], diffuse: 1, ambient: 0}}\n"
                          : "",
                 k == 2 ? ", material: own" : "");
        stage g = stage_with_meshes(text, "");
        const double *left = stage_ray(&g, vec3_make(-0.5, 0.5, -3.0), vec3_make(0, 0, 1))->radiance;
        const double l[3] = {left[0], left[1], left[2]};
        const double *right = stage_ray(&g, vec3_make(0.5, -0.5, -3.0), vec3_make(0, 0, 1))->radiance;
        if (k == 2)
            assert_true(fabs(l[2] - 1.0) < 1e-6 && l[0] == 0.0 && fabs(right[2] - 1.0) < 1e-6);
        else
            assert_true(l[0] < l[1] && l[1] < l[2] &&
                        (k == 1 ? right[1] == 0.5 && right[0] == 0.0 : right[0] > right[1] && right[1] > right[2]));
        /* the scene's material is number 1, the solid's own, with the file's values, follows it */
        assert_int_equal(material_numbers(g.setting), k == 1 ? 1 << 1 | 1 << 2 : 1 << 1);
        stage_close(&g);
    }
    snprintf(text, sizeof text, DARK "meshes: {two: {file: %s}}\nsolids: {sheet: {shape: mesh, mesh: two}}\n", path);
    assert_non_null(strstr(refusal_of(text, "render.spectrum=spectral", why), "materials by face"));
    unlink(path);
    unlink(library);
    rmdir(folder);
}

static uint64_t hash_of_small_film(scene *s)
{
    set_all(s, "camera.position=0.3,0.3,-3 camera.target=0.2,0.2,0 camera.fov_deg=40 render.width=12 render.height=9");
    render_result *r = render_at(s, isa_best(), NULL);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    return hash;
}

/* A file that gives its faces no material has the solid's, whatever its format, in groups, and also as a metal: the
 * same spectral film as with a material of the scene. */
static void files_without_materials_have_that_of_their_solid(void **state)
{
    (void)state;
    static const char tetrahedron[] = "solid a\n"
                                      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\n"
                                      "endloop\nendfacet\n"
                                      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\n"
                                      "endloop\nendfacet\n"
                                      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\n"
                                      "endloop\nendfacet\n"
                                      "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\n"
                                      "endloop\nendfacet\nendsolid a\n";
    static const struct {
        const char *name, *text;
    } files[] = {
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n"},
        {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no one\nf 1 3 2\nf 1 4 3\ng two\nf 1 2 4\nf 2 3 4\n"},
        {"c.stl", tetrahedron},
        {"d.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
                  "0 0 1\n3 0 2 1\n3 0 3 2\n3 0 1 3\n3 1 2 3\n"},
    };
    static const char *const made_of[] = {"transparency: 1, medium: bk7", "medium: gold",
                                          "color: [0.2, 0.5, 0.9], diffuse: 0.7"};
    char name[] = "/tmp/cuvette-plain-XXXXXX", path[64], text[1024], why[DIAGNOSTIC_TEXT_MAX];
    assert_non_null(mkdtemp(name));
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        snprintf(path, sizeof path, "%s/%s", name, files[i].name);
        FILE *f = fopen(path, "w");
        assert_non_null(f);
        fputs(files[i].text, f);
        fclose(f);
        for (size_t k = 0; k < sizeof made_of / sizeof *made_of; k++) {
            uint64_t hash[2];
            for (int own = 0; own < 2; own++) {
                snprintf(text, sizeof text,
                         "render: {spectrum: spectral}\nlights: {lamp: {position: [1, 2, -3]}}\nmaterials: {m: {%s}}\n"
                         "meshes: {a: {file: %s}}\nsolids: {s: {shape: mesh, mesh: a, %s}}\n",
                         made_of[k], path, own ? "material: m" : made_of[k]);
                assert_string_equal(refusal_of(text, "", why), "");
                scene *s = scene_with_meshes(text, "");
                assert_false(has_face_materials(s, &s->solids[0]));
                hash[own] = hash_of_small_film(s);
                scene_destroy(s);
            }
            assert_true(hash[0] == hash[1]);
        }
        unlink(path);
    }
    rmdir(name);
}

/* A file's Ke is the emitted light, whatever the surface's colour; without it the solid's emission applies, times the
 * colour. */
static void faces_emit_by_their_materials(void **state)
{
    (void)state;
    char folder[] = "/tmp/cuvette-shine-XXXXXX", path[64], library[64], text[1024];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/two.obj", folder);
    snprintf(library, sizeof library, "%s/two.mtl", folder);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs("mtllib two.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl left\nf 1 4 3\nusemtl right\nf 1 3 2\n", f);
    fclose(f);
    f = fopen(library, "w");
    assert_non_null(f);
    fputs("newmtl left\nKd 0.25 0.5 0\nKe 3 3 1\nnewmtl right\nKd 0 0 0\nKe 4 2 1\n", f);
    fclose(f);
    snprintf(text, sizeof text,
             "background: {ambient: [0, 0, 0]}\nmeshes: {two: {file: %s}}\nsolids: {sheet: {shape: mesh, mesh: two, "
             "emission: 9}}\n",
             path);
    stage g = stage_with_meshes(text, "");
    const double *left = stage_ray(&g, vec3_make(-0.5, 0.5, -3.0), vec3_make(0, 0, 1))->radiance;
    assert_true(fabs(left[0] - 3.0) < 1e-9 && fabs(left[1] - 3.0) < 1e-9 && fabs(left[2] - 1.0) < 1e-9);
    const double *right = stage_ray(&g, vec3_make(0.5, -0.5, -3.0), vec3_make(0, 0, 1))->radiance;
    assert_true(fabs(right[0] - 4.0) < 1e-9 && fabs(right[1] - 2.0) < 1e-9 && fabs(right[2] - 1.0) < 1e-9);
    stage_close(&g);
    f = fopen(library, "w");
    assert_non_null(f);
    fputs("newmtl left\nKd 0.25 0.5 0\nnewmtl right\nKd 1 1 1\n", f);
    fclose(f);
    g = stage_with_meshes(text, "");
    assert_true(fabs(stage_ray(&g, vec3_make(-0.5, 0.5, -3.0), vec3_make(0, 0, 1))->radiance[1] - 4.5) < 1e-9);
    stage_close(&g);
    unlink(path);
    unlink(library);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phongs_sum_has_its_known_values),
        cmocka_unit_test(light_of_corners_counts_from_half_a_unit_on),
        cmocka_unit_test(only_rays_are_counted),
        cmocka_unit_test(light_behind_the_plane_adds_nothing_to_the_ambient_term),
        cmocka_unit_test(coincident_sheets_have_no_self_shadow_and_no_light_leaks),
        cmocka_unit_test(interpolated_normals_keep_rays_on_their_side),
        cmocka_unit_test(meshes_in_a_furnace_conserve_energy),
        cmocka_unit_test(absorption_in_meshes_has_its_closed_form),
        cmocka_unit_test(textures_have_the_expected_texels),
        cmocka_unit_test(a_texture_seen_from_ahead_is_sharp),
        cmocka_unit_test(an_open_dielectric_is_refused_with_its_open_edge),
        cmocka_unit_test(spectral_films_refuse_textures),
        cmocka_unit_test(faces_are_shaded_by_their_materials),
        cmocka_unit_test(files_without_materials_have_that_of_their_solid),
        cmocka_unit_test(faces_emit_by_their_materials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
