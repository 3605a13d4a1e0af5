#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "probe_fixture.h"

/* Tests of a film of air between two slabs of glass, modelled explicitly, against glass in contact, which is one
 * region. Light is incoherent here: a film shows no interference colours, but has two more interfaces. */

static const double GLASS = 1.5;
/* However thin the film: the tracer resolves boundaries down to their error bounds. */
static const double films[] = {1e-3, 1e-6, 1e-9};
static const vec3 askew = {17.0, -33.0, 71.0};

/* Each slab is 1 thick; they touch at y = 0 of a rotated frame, which is the place of the film if it has a
 * thickness. */
static stage slabs(double outside, double thickness, const char *assignments)
{
    scene_text text = scene_begin(outside, 60);
    const vec3 middle = vec3_make(0.0, 0.0, 0.0);
    char thin[80];
    snprintf(thin, sizeof thin, "shape: box, size: [100, %.17g, 100]", thickness);
    add_clear(&text, "upper", GLASS, 0, turned(vec3_make(0.0, 0.5, 0.0), askew), askew,
              "shape: box, size: [50, 1, 50]");
    add_clear(&text, "lower", GLASS, 0, turned(vec3_make(0.0, -0.5, 0.0), askew), askew,
              "shape: box, size: [50, 1, 50]");
    if (thickness > 0.0)
        add_clear(&text, "film", 1.0, 1, middle, askew, thin);
    return stage_of(text.at, assignments);
}

static vec3 downwards(double angle)
{
    return turned(vec3_make(sin(angle), -cos(angle), 0.0), askew);
}

/* From above both slabs through all interfaces. */
static const ray_tree *straight_through(stage *g, double angle)
{
    const vec3 d = downwards(angle);
    return stage_way(g, vec3_sub(turned(vec3_make(0.0, 1.0, 0.0), askew), vec3_scale(d, 2.0)), d, -1);
}

/* Two interfaces in contact, four with a film: the product of that many transmittances (Hecht, 4.6.3). */
static void an_air_film_adds_two_interfaces(void **state)
{
    (void)state;
    stage contact = slabs(1.0, 0.0, "");
    for (size_t k = 0; k < COUNT(films); k++) {
        stage air = slabs(1.0, films[k], "");
        for (double angle = 0.0; angle < 1.5; angle += 0.1) {
            const double T = 1.0 - reflectance_of_angles(angle, 1.0, GLASS).mean; /* equal at all interfaces */
            const ray_tree *tree = straight_through(&contact, angle);
            assert_int_equal((int)tree->count, 3);
            assert_true(fabs(tree->node[2].throughput[0] / (T * T) - 1.0) <= 1e-12);
            tree = straight_through(&air, angle);
            assert_int_equal((int)tree->count, 5);
            assert_true(fabs(tree->node[4].throughput[0] / (T * T * T * T) - 1.0) <= 1e-12);
            assert_int_equal(tree->node[2].hit.solid, 2);
            assert_true(fabs(tree->node[2].hit.t - films[k] / cos(angle)) <= 1e-12);
        }
        stage_close(&air);
    }
    stage_close(&contact);
}

/* The power transmitted downwards, or reflected upwards, after all reflections within the film, starting inside glass
 * that has no other surface. */
static double share_down(const ray_tree *tree, bool down)
{
    double sum = 0.0;
    for (size_t i = 0; i < tree->count; i++)
        if (tree->node[i].end == RAY_END_SKY && (vec3_dot(tree->node[i].direction, downwards(0.0)) > 0.0) == down)
            sum += tree->node[i].throughput[0];
    return sum;
}

/* T (1 + R^2 + R^4 + ...) T = (1 - R) / (1 + R), for each polarisation separately (Stokes 1862; Hecht, 8.6 for the pile
 * of plates; Born and Wolf, 7.6.1, with intensities instead of amplitudes). Without polarisation R is the mean of both
 * at each interface. */
static void a_film_transmits_the_sum_of_its_internal_reflections(void **state)
{
    (void)state;
    stage plain = slabs(GLASS, films[0], ""), polarised = slabs(GLASS, films[0], "render.polarisation=on");
    for (double angle = 0.0; angle < 0.72; angle += 0.06) {
        const reflectance r = reflectance_of_angles(angle, GLASS, 1.0);
        const double mean = (1.0 - r.mean) / (1.0 + r.mean),
                     apart = 0.5 * ((1.0 - r.s) / (1.0 + r.s) + (1.0 - r.p) / (1.0 + r.p));
        const vec3 d = downwards(angle), from = turned(vec3_make(0.0, 0.3, 0.0), askew);
        const ray_tree *tree = stage_ray(&plain, from, d);
        const double missing = tree_cut(tree, 0), slack = 1e-12 + missing;
        assert_true(missing <= pow(r.mean, 59.0)); /* T R^59 (R + T) */
        assert_true(fabs(share_down(tree, true) - mean) <= slack &&
                    fabs(share_down(tree, false) - (1.0 - mean)) <= slack);
        tree = stage_ray(&polarised, from, d);
        const double faint = 1e-12 + tree_cut(tree, 0);
        assert_true(fabs(share_down(tree, true) - apart) <= faint &&
                    fabs(share_down(tree, false) - (1.0 - apart)) <= faint);
    }
    stage_close(&plain);
    stage_close(&polarised);
}

/* Beyond the critical angle, arcsin(1 / 1.5) = 41.8 degrees, the film reflects totally, and glass in contact has no
 * interface. */
static void beyond_the_critical_angle_a_film_reflects_totally_and_contact_transmits(void **state)
{
    (void)state;
    stage air = slabs(GLASS, films[0], ""), contact = slabs(GLASS, 0.0, "");
    for (double angle = asin(1.0 / GLASS) + 1e-6; angle < 1.5; angle += 0.05) {
        const vec3 d = downwards(angle), from = turned(vec3_make(0.0, 0.3, 0.0), askew);
        const ray_tree *tree = stage_ray(&air, from, d);
        assert_int_equal((int)tree->count, 2);
        assert_true(tree->node[0].hit.tir && tree->node[1].kind == RAY_REFLECT && tree->node[1].throughput[0] == 1.0);
        assert_true(share_down(tree, true) == 0.0 && share_down(tree, false) == 1.0);
        assert_int_equal((int)stage_ray(&contact, from, d)->count, 1);
        assert_true(contact.tree.node[0].end == RAY_END_SKY && share_down(&contact.tree, true) == 1.0);
    }
    stage_close(&air);
    stage_close(&contact);
}

/* The same as an image: an eye in the upper glass looks down at white paper below. */
static void beyond_the_critical_angle_a_film_hides_the_paper_below(void **state)
{
    (void)state;
    for (int air = 0; air < 2; air++) {
        for (int steep = 0; steep < 2; steep++) {
            char text[1024];
            const double angle = steep ? 30.0 : 50.0;
            snprintf(text, sizeof text,
                     "background: {color: [0, 0, 0], ambient: [1, 1, 1], ior: 1.5}\n"
                     "render: {width: 1, height: 1, depth: 40}\n"
                     "camera: {position: [0, 0.5, 0], yaw_deg: 0, pitch_deg: %g}\n"
                     "solids:\n"
                     "  paper: {shape: plane, position: [0, -1, 0], ambient: 1}\n"
                     "  film: {shape: box, transparency: 1, ior: 1, size: [100, 0.001, 100], visible: %s}\n",
                     angle - 90.0, air ? "on" : "off");
            scene *s = scene_from(text);
            const double R = reflectance_of_angles(angle * DEGREE, GLASS, 1.0).mean, seen = look(s).x;
            if (!air)
                assert_true(seen == 1.0);
            else if (steep)
                assert_true(fabs(seen - (1.0 - R) / (1.0 + R)) <= 1e-11);
            else
                assert_true(seen == 0.0);
            scene_destroy(s);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_air_film_adds_two_interfaces),
        cmocka_unit_test(a_film_transmits_the_sum_of_its_internal_reflections),
        cmocka_unit_test(beyond_the_critical_angle_a_film_reflects_totally_and_contact_transmits),
        cmocka_unit_test(beyond_the_critical_angle_a_film_hides_the_paper_below),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
