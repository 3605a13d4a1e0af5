/* Tests of scenes with meshes against the same scenes with analytic solids. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "mesh_stage.h"
#include "random_stream.h"

#define FRAME                                                                          \
    "background: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: [0.9, 0.8, 0.6]}\n" \
    "render: {width: 24, height: 18, depth: 5}\n"                                      \
    "camera: {position: [1.1, 1.3, -4], target: [0.1, 0.4, 0], fov_deg: 42}\n"         \
    "lights: {lamp: {position: [3, 5, -4]}, other: {position: [-4, 3, -1], intensity: 0.5}}\n"

/* A scene of boxes, as analytic solids or as meshes of twelve triangles. */
static scene_text with_boxes(const char *solids, bool as_mesh)
{
    scene_text t = {.length = 0};
    add(&t, "%s%ssolids:\n", FRAME, as_mesh ? "meshes: {block: {generate: box}}\n" : "");
    for (const char *c = solids; *c; c++)
        if (*c == '@')
            add(&t, "%s", as_mesh ? "shape: mesh, mesh: block, scale: " : "shape: box, size: ");
        else
            add(&t, "%c", *c);
    return t;
}

static void expect_same_tree(const ray_tree *a, const ray_tree *b, double *worst)
{
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        const ray_node *m = &a->node[i], *n = &b->node[i];
        assert_int_equal(m->kind, n->kind);
        assert_int_equal(m->end, n->end);
        assert_int_equal(m->medium, n->medium);
        if (m->end != RAY_END_HIT)
            continue;
        assert_int_equal(m->hit.solid, n->hit.solid);
        assert_int_equal(m->hit.from, n->hit.from);
        assert_int_equal(m->hit.to, n->hit.to);
        *worst = fmax(*worst, fabs(m->hit.t - n->hit.t));
        *worst = fmax(*worst, apart(m->hit.normal, n->hit.normal));
    }
    for (int c = 0; c < 3; c++)
        *worst = fmax(*worst, fabs(a->radiance[c] - b->radiance[c]));
}

static void mesh_boxes_have_the_ray_trees_of_boxes(void **state)
{
    (void)state;
    /* without a checker where an analytic box is exactly on the ground: which of the two surfaces is visible there is
     * undefined */
    static const char *const ground[] = {
        "  ground: {shape: plane, color: [0.8, 0.5, 0.3], checker: 0.4, checker_color: [0.1, 0.3, 0.2], diffuse: 0.8, "
        "ambient: 0.1}\n",
        "  ground: {shape: plane, color: [0.8, 0.5, 0.3], diffuse: 0.8, ambient: 0.1}\n"};
    static const char *const rooms[] = {
        "  glass: {@[1.2, 0.9, 0.7], transparency: 1, ior: 1.5, specular: 0.4, position: [0, 0.5, 0]}\n",
        "  wood: {@[1.2, 0.9, 0.7], color: [0.7, 0.4, 0.2], diffuse: 0.8, specular: 0.3, reflectivity: 0.2, position: "
        "[0, 0.5, 0], rotation: [10, 25, 5]}\n",
        /* partly in a liquid, with either priority */
        "  water: {shape: cylinder, radius: 1, height: 0.6, transparency: 1, ior: 1.33, priority: 1}\n"
        "  glass: {@[0.5, 1.6, 0.4], transparency: 1, ior: 1.5, position: [0.1, 0.95, 0], rotation: [0, 0, 20], "
        "priority: 2}\n",
        "  water: {shape: cylinder, radius: 1, height: 0.6, transparency: 1, ior: 1.33, priority: 3}\n"
        "  glass: {@[0.5, 1.6, 0.4], transparency: 1, ior: 1.5, position: [0.1, 0.95, 0], rotation: [0, 0, 20], "
        "priority: 2}\n"
        "  stick: {@[0.1, 1.2, 0.1], diffuse: 0.7, position: [0.3, 0.8, -0.2], rotation: [20, 0, 0], priority: 1}\n",
        /* exactly on the ground, next to each other, nested, and flush with an analytic box */
        "  glass: {@[1, 1, 1], transparency: 1, ior: 1.5, position: [0, 0.5, 0], priority: 1}\n",
        "  glass: {@[1, 1, 1], transparency: 1, ior: 1.5, position: [-0.5, 0.5, 0], priority: 1}\n"
        "  heavy: {@[1, 1, 1], transparency: 1, ior: 1.8, position: [0.5, 0.5, 0], priority: 1}\n",
        "  glass: {@[1.5, 1.5, 1.5], transparency: 1, ior: 1.5, position: [0, 0.75, 0], priority: 1}\n"
        "  core: {@[0.5, 0.5, 0.5], color: [0.2, 0.7, 0.2], diffuse: 0.8, position: [-0.5, 0.25, 0.1], priority: 2}\n",
        "  glass: {@[1, 1, 1], transparency: 1, ior: 1.5, absorb_per_m: [0.5, 0.1, 0.2], position: [-0.5, 0.5, 0], "
        "priority: 1}\n"
        "  flush: {shape: box, size: [1, 1, 1], diffuse: 0.8, color: [0.3, 0.3, 0.8], position: [0.5, 0.5, 0], "
        "priority: 0}\n",
    };
    for (size_t k = 0; k < COUNT(rooms); k++) {
        char solids[2048];
        snprintf(solids, sizeof solids, "%s%s", ground[k >= 4], rooms[k]);
        const scene_text analytic = with_boxes(solids, false), triangles = with_boxes(solids, true);
        stage g = stage_of(analytic.at, ""), m = stage_with_meshes(triangles.at, "");
        double worst = 0.0;
        for (int y = 0; y < 18; y++)
            for (int x = 0; x < 24; x++)
                expect_same_tree(stage_pixel(&m, x, y), stage_pixel(&g, x, y), &worst);
        if (!(worst < 1e-9))
            fail_msg("room %zu: apart by %g", k, worst);
        stage_close(&g);
        stage_close(&m);
    }
}

/* The ground's own checker is visible through the bottom of a block exactly on it, whichever surface comes first. */
static void the_grounds_checker_is_visible_through_a_block_on_it(void **state)
{
    (void)state;
    const scene_text t = with_boxes("  ground: {shape: plane, position: [0.05, 0, 0.03], color: [1, 0, 0], "
                                    "checker_color: [0, 1, 0], checker: 0.2, ambient: 1}\n"
                                    "  glass: {@[1.5, 1, 1.5], transparency: 1, ior: 1.5, position: [0, 0.5, 0], "
                                    "rotation: [0, 33, 0], priority: 1}\n",
                                    true);
    stage g = stage_with_meshes(t.at, "background.ambient=1,1,1");
    uint64_t seed = 5;
    for (int k = 0; k < 2000; k++) {
        const double u = (double)(random_bits(&seed) % 1000) / 1000.0 - 0.5,
                     v = (double)(random_bits(&seed) % 1000) / 1000.0 - 0.5;
        const vec3 o = vec3_make(0.3 * v, 0.7, 0.2 * u), d = vec3_make(u, -1.1, v);
        const ray_node *n = &stage_ray(&g, o, d)->node[0];
        assert_int_equal(n->hit.solid, 0);
        assert_int_equal(n->hit.from, 1);
        assert_int_equal(n->hit.face_solid, 0);
        const double x = (n->hit.point.x - 0.05) / 0.2, z = (n->hit.point.z - 0.03) / 0.2;
        if (fabs(x - round(x)) < 1e-9 || fabs(z - round(z)) < 1e-9)
            continue;
        const bool even = ((int)(floor(x) + floor(z)) & 1) == 0;
        assert_true(fabs(n->contribution[even ? 0 : 1] - 1.0) < 1e-9 && n->contribution[even ? 1 : 0] < 1e-9);
    }
    stage_close(&g);
}

static void a_mesh_with_the_liquids_index_is_invisible(void **state)
{
    (void)state;
    static const char basin[] =
        "  water: {shape: box, size: [2, 1, 2], transparency: 1, ior: 1.33, position: [0, 0.5, 0], priority: 1}\n";
    char both[1024];
    snprintf(both, sizeof both,
             "%s  lump: {shape: mesh, mesh: ring, transparency: 1, ior: 1.33, position: [0, 0.5, 0], rotation: [50, 0, "
             "0], priority: 2}\n",
             basin);
    scene_text a = {.length = 0}, b = {.length = 0};
    add(&a, "%ssolids:\n%s", FRAME, basin);
    add(&b, "%smeshes: {ring: {generate: torus, major: 0.4, minor: 0.15, around: 40, tube: 20}}\nsolids:\n%s", FRAME,
        both);
    scene *without = scene_with_meshes(a.at, "render.width=96 render.height=72"),
          *with = scene_with_meshes(b.at, "render.width=96 render.height=72");
    render_result *x = render(without), *y = render(with);
    assert_true(film_hash(x->img) == film_hash(y->img));
    render_result_destroy(x);
    render_result_destroy(y);
    scene_destroy(without);
    scene_destroy(with);
}

/* A glass ball in front of a uniform sky, so that only the ball's outline is an edge. Its vertices are on the sphere,
 * so the error of its radius and of interpolated normals is h^2, that of flat normals h, where h is the length of an
 * edge, halved at each level. */
static double error_at_level(int level, bool smooth, const film *expected)
{
    scene_text t = {.length = 0};
    add(&t,
        "%smeshes: {triangles: {generate: icosphere, level: %d}}\nsolids:\n  ball: {shape: mesh, mesh: triangles, "
        "shading: %s, transparency: 1, ior: 1.5,"
        " position: [0, 0.4, 0]}\n",
        FRAME, level, smooth ? "smooth" : "flat");
    scene *s = scene_with_meshes(t.at, "render.width=120 render.height=90 render.depth=6");
    render_result *r = render(s);
    const double rms = rms_between(r->img, expected);
    render_result_destroy(r);
    scene_destroy(s);
    return rms;
}

static void a_glass_mesh_sphere_converges_to_the_sphere(void **state)
{
    (void)state;
    enum { LEVELS = 8 };
    scene_text t = {.length = 0};
    add(&t, "%ssolids:\n  ball: {shape: sphere, radius: 1, transparency: 1, ior: 1.5, position: [0, 0.4, 0]}\n", FRAME);
    scene *s = scene_with_meshes(t.at, "render.width=120 render.height=90 render.depth=6");
    render_result *expected = render(s);
    double smooth[LEVELS], flat[LEVELS];
    for (int level = 0; level < LEVELS; level++) {
        smooth[level] = error_at_level(level, true, expected->img);
        flat[level] = error_at_level(level, false, expected->img);
        print_message("level %d: smooth %.3e (%.1f dB), flat %.3e (%.1f dB)\n", level, smooth[level],
                      psnr(smooth[level]), flat[level], psnr(flat[level]));
    }
    render_result_destroy(expected);
    scene_destroy(s);
    const double order_smooth = log2(smooth[2] / smooth[LEVELS - 1]) / (LEVELS - 3),
                 order_flat = log2(flat[2] / flat[LEVELS - 1]) / (LEVELS - 3);
    print_message("order: smooth %.2f, flat %.2f\n", order_smooth, order_flat);
    for (int level = 1; level < LEVELS; level++)
        assert_true(smooth[level] < smooth[level - 1] && flat[level] < flat[level - 1]);
    assert_true(order_smooth > 1.2 && order_flat > 0.5 && psnr(smooth[LEVELS - 1]) > 80.0);
}

#define TURNED "rotation: [-20, 10, 15]"

static render_result *glass(const char *meshes, const char *shape)
{
    scene_text t = {.length = 0};
    add(&t, "%s%ssolids:\n  body: {%s, transparency: 1, ior: 1.5, position: [0.1, 0.2, 0]}\n", FRAME, meshes, shape);
    scene *s = scene_with_meshes(t.at, "render.width=120 render.height=90 render.depth=6");
    render_result *r = render(s);
    scene_destroy(s);
    return r;
}

/* %d: segments. */
static double error_of_mesh(const char *generated, const char *keys, int segments, const film *expected)
{
    scene_text t = {.length = 0}, body = {.length = 0};
    add(&t, "meshes: {triangles: {");
    add(&t, generated, segments, segments);
    add(&t, "}}\n");
    add(&body, "shape: mesh, mesh: triangles, %s", keys);
    render_result *r = glass(t.at, body.at);
    const double rms = rms_between(r->img, expected);
    render_result_destroy(r);
    return rms;
}

/* Tori, cones and frustums of glass, as for the sphere above: the error of their triangles decreases with the square of
 * the number of segments, and that of the pixels at outlines more slowly. */
static void glass_meshes_converge_to_torus_cone_and_frustum(void **state)
{
    (void)state;
    static const struct {
        const char *solid, *mesh;
    } body[] = {
        {"shape: torus, radius: 0.8, tube_radius: 0.35, " TURNED,
         "generate: torus, major: 0.8, minor: 0.35, around: %d, tube: %d"},
        {"shape: cone, radius: 0.9, height: 1.3, " TURNED,
         "generate: lathe, profile: [0, 0, 0.9, 0, 0, 1.3], around: %d"},
        {"shape: cone, radius: 0.9, top_radius: 0.4, height: 1, " TURNED,
         "generate: lathe, profile: [0, 0, 0.9, 0, 0.4, 1, 0, 1], around: %d"},
    };
    for (size_t k = 0; k < COUNT(body); k++) {
        render_result *expected = glass("", body[k].solid);
        double coarse = error_of_mesh(body[k].mesh, TURNED, 16, expected->img), fine = 0.0;
        const double first = coarse;
        for (int segments = 64; segments <= 1024; segments *= 4, coarse = fine) {
            fine = error_of_mesh(body[k].mesh, TURNED, segments, expected->img);
            print_message("%s: %d segments, %.3e (%.1f dB)\n", body[k].solid, segments, fine, psnr(fine));
            assert_true(fine < coarse);
        }
        assert_true(fine < first / 10.0 && psnr(fine) > 50.0);
        render_result_destroy(expected);
    }
}

/* The lathe's first corner is at +z, the prism's at -z. */
static void a_lathe_of_few_segments_looks_like_a_prism(void **state)
{
    (void)state;
    for (int sides = 3; sides <= 8; sides++) {
        scene_text t = {.length = 0};
        add(&t, "shape: prism, radius: 0.8, height: 1.1, rotation: [0, 10, 15], sides: %d", sides);
        render_result *expected = glass("", t.at);
        const double rms = error_of_mesh("generate: lathe, profile: [0, 0, 0.8, 0, 0.8, 1.1, 0, 1.1], around: %d",
                                         "shading: flat, rotation: [0, 190, 15]", sides, expected->img);
        print_message("%d sides: rms %.3e\n", sides, rms);
        assert_true(rms < 1e-6);
        render_result_destroy(expected);
    }
}

static void a_mesh_vessel_looks_like_the_cup(void **state)
{
    (void)state;
    scene *cup = NULL, *turned_one = NULL;
    diagnostic why = {0};
    worked(scene_read(ROD_SCENE, &cup, &why), &why);
    worked(scene_read("experiments/scenes/vessel-mesh.yaml", &turned_one, &why), &why);
    worked(scene_load(turned_one, &why), &why);
    set_all(cup, "render.width=200 render.height=150");
    set_all(turned_one, "render.width=200 render.height=150");
    render_result *a = render(cup), *b = render(turned_one);
    const double rms = rms_between(a->img, b->img);
    print_message("vessel: rms %.3e, %.1f dB\n", rms, psnr(rms));
    assert_true(psnr(rms) > 65.0);
    render_result_destroy(a);
    render_result_destroy(b);
    scene_destroy(cup);
    scene_destroy(turned_one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mesh_boxes_have_the_ray_trees_of_boxes),
        cmocka_unit_test(the_grounds_checker_is_visible_through_a_block_on_it),
        cmocka_unit_test(a_mesh_with_the_liquids_index_is_invisible),
        cmocka_unit_test(a_glass_mesh_sphere_converges_to_the_sphere),
        cmocka_unit_test(glass_meshes_converge_to_torus_cone_and_frustum),
        cmocka_unit_test(a_lathe_of_few_segments_looks_like_a_prism),
        cmocka_unit_test(a_mesh_vessel_looks_like_the_cup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
