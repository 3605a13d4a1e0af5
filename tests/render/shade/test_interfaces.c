/* Tests of single interfaces hit by a ray, and of a film of air between two slabs of glass. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "probe_fixture.h"

/* Single interfaces hit by a ray: Fresnel's equations, and the onset of total internal reflection. */

static const vec3 turns[] = {{0.0, 0.0, 0.0}, {17.0, -33.0, 71.0}};
static const double pairs[][2] = {{1.0, 1.5},  {1.5, 1.0},  {1.0, 1.33}, {1.33, 1.0},
                                  {1.33, 1.5}, {1.5, 1.33}, {1.0, 2.42}, {2.42, 1.0}};

static stage half_space(double outside, double inside, vec3 rotation_deg, const char *more)
{
    scene_text text = scene_begin(outside, 4);
    add_clear(&text, "half", inside, 0, vec3_make(0.0, 0.0, 0.0), rotation_deg, "shape: plane");
    return stage_of(text.at, more);
}

/* The first hit of a ray on the half-space's surface at the origin, at an angle. */
static const ray_tree *hit_at(stage *g, double angle, vec3 rotation_deg)
{
    const vec3 d = turned(vec3_make(sin(angle), -cos(angle), 0.0), rotation_deg);
    return stage_ray(g, vec3_scale(d, -2.0), d);
}

/* Printed values: Hecht, Optics, 5th ed., 4.6.2 and 4.6.3 (r at normal incidence 0.2 and 4% for air and glass;
 * polarisation angle 56.3 degrees; with R_s = ((n^2 - 1) / (n^2 + 1))^2 there). The rest to four places from the sine
 * and tangent laws by hand. */
static void reflectances_equal_the_textbooks_values(void **state)
{
    (void)state;
    static const struct {
        double n_from, n_to, angle_deg, R_s, R_p;
    } known[] = {
        {1.0, 1.5, 0.0, 0.0400, 0.0400},  {1.5, 1.0, 0.0, 0.0400, 0.0400},  {1.0, 1.33, 0.0, 0.0201, 0.0201},
        {1.33, 1.5, 0.0, 0.0036, 0.0036}, {1.0, 2.42, 0.0, 0.1724, 0.1724}, {1.0, 1.5, 45.0, 0.0920, 0.0085},
        {1.0, 1.5, 80.0, 0.5386, 0.2368}, {1.0, 1.5, 56.3099, 0.1479, 0.0}, {1.5, 1.0, 33.6901, 0.1479, 0.0},
    };
    for (size_t k = 0; k < COUNT(known); k++) {
        stage g = half_space(known[k].n_from, known[k].n_to, turns[1], "");
        const ray_hit *h = &hit_at(&g, known[k].angle_deg * DEGREE, turns[1])->node[0].hit;
        assert_true(fabs(h->R_s - known[k].R_s) <= 5.1e-5 && fabs(h->R_p - known[k].R_p) <= 5.1e-5);
        stage_close(&g);
    }
}

/* At 0, 45 and 80 degrees and at Brewster's angle, to 1e-12: sin^2(i - t) / sin^2(i + t), tan^2(i - t) / tan^2(i + t),
 * which do not contain the index (Hecht, eqs. 4.42 and 4.43). The branches have weights R and 1 - R. */
static void reflectances_follow_the_sine_and_tangent_laws(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(pairs); k++) {
        const double n_from = pairs[k][0], n_to = pairs[k][1], brewster = atan(n_to / n_from);
        for (size_t turn = 0; turn < COUNT(turns); turn++) {
            stage g = half_space(n_from, n_to, turns[turn], "");
            const double angles[] = {0.0, 45.0 * DEGREE, brewster, 80.0 * DEGREE};
            for (size_t a = 0; a < COUNT(angles); a++) {
                const ray_tree *tree = hit_at(&g, angles[a], turns[turn]);
                const ray_hit *h = &tree->node[0].hit;
                const ray_node *back = child_of(tree, &tree->node[0], RAY_REFLECT),
                               *on = child_of(tree, &tree->node[0], RAY_REFRACT);
                if (n_from * sin(angles[a]) >= n_to) {
                    assert_true(h->tir && h->R_s == 1.0 && h->R_p == 1.0 && h->R == 1.0 && h->cos_t == 0.0 && !on);
                    assert_true(back->throughput[0] == 1.0);
                    continue;
                }
                const reflectance r = reflectance_of_angles(angles[a], n_from, n_to);
                assert_true(!h->tir && fabs(h->R_s - r.s) <= 1e-12 && fabs(h->R_p - r.p) <= 1e-12 &&
                            fabs(h->R - r.mean) <= 1e-12);
                assert_true(fabs(h->cos_t - sqrt(1.0 - pow(n_from / n_to * sin(angles[a]), 2.0))) <= 1e-12);
                assert_true(fabs(back->throughput[1] - r.mean) <= 1e-12 &&
                            fabs(on->throughput[1] - (1.0 - r.mean)) <= 1e-12);
                assert_true(back->throughput[2] + on->throughput[2] == 1.0);
                if (a == 2) /* tan i = n_t / n_i (Hecht, eq. 4.45): no p is reflected, and i + t is a right angle */
                    assert_true(h->R_p <= 1e-28 && fabs(vec3_dot(back->direction, on->direction)) <= 1e-14);
            }
            stage_close(&g);
        }
    }
}

/* R is the same from the other side, at the angle of refraction (Stokes's relations: Hecht, 4.10). */
static void the_reflectance_is_the_same_from_both_sides(void **state)
{
    (void)state;
    for (size_t k = 0; k + 1 < COUNT(pairs); k += 2) {
        stage there = half_space(pairs[k][0], pairs[k][1], turns[1], ""),
              back = half_space(pairs[k][1], pairs[k][0], turns[1], "");
        for (double angle = 0.0; angle < 1.55; angle += 0.05) {
            const ray_hit a = hit_at(&there, angle, turns[1])->node[0].hit;
            const ray_hit b = hit_at(&back, asin(pairs[k][0] / pairs[k][1] * sin(angle)), turns[1])->node[0].hit;
            assert_true(fabs(a.R_s - b.R_s) <= 1e-13 && fabs(a.R_p - b.R_p) <= 1e-13 &&
                        fabs(a.cos_i - b.cos_t) <= 1e-13);
        }
        stage_close(&there);
        stage_close(&back);
    }
}

/* A glass solid, and a ray inside it that determines the angle of incidence. */
typedef struct cell {
    const char *name, *shape;
    double offset;
} cell; /* offset: of the ray's origin from the centre of a sphere of radius 1 */
static const cell cells[] = {{"box", "shape: box, size: [1, 1, 1]", 0.0}, {"sphere", "shape: sphere, radius: 1", 0.9}};

/* From the box's centre the angle at its upper face is that of the direction; in a sphere sin i = offset sin(direction)
 * by the law of sines. */
static const ray_tree *hit_inside(stage *g, const cell *c, double angle_i, vec3 rotation_deg)
{
    const bool ball = c->offset > 0.0;
    const double angle = ball ? asin(sin(angle_i) / c->offset) : angle_i;
    const vec3 origin = vec3_make(0.0, ball ? c->offset : 0.49999, 0.0),
               d = vec3_make(0.6 * sin(angle), cos(angle), 0.8 * sin(angle));
    return stage_ray(g, turned(origin, rotation_deg), turned(d, rotation_deg));
}

/* Total internal reflection begins at sin i = n_t / n_i (Hecht, 4.7); beyond it nothing is transmitted. */
static void total_reflection_begins_at_the_critical_angle(const cell *c, const char *more)
{
    for (size_t k = 1; k < COUNT(pairs); k++) {
        if (pairs[k][0] <= pairs[k][1])
            continue;
        const double critical = asin(pairs[k][1] / pairs[k][0]);
        for (size_t turn = 0; turn < COUNT(turns); turn++) {
            scene_text text = scene_begin(pairs[k][1], 2);
            add_clear(&text, c->name, pairs[k][0], 0, vec3_make(0.0, 0.0, 0.0), turns[turn], c->shape);
            stage g = stage_of(text.at, more);
            double low = critical - 0.05, high = critical + 0.05;
            while (high - low > 1e-12) {
                const double middle = 0.5 * (low + high);
                *(hit_inside(&g, c, middle, turns[turn])->node[0].hit.tir ? &high : &low) = middle;
            }
            assert_true(fabs(0.5 * (low + high) - critical) <= 1e-9);
            for (double above = critical + 1e-9; above < 0.97 * asin(c->offset > 0.0 ? c->offset : 1.0);
                 above += 0.01) {
                const ray_tree *tree = hit_inside(&g, c, above, turns[turn]);
                const ray_node *root = &tree->node[0], *back = child_of(tree, root, RAY_REFLECT);
                assert_true(root->hit.tir && !child_of(tree, root, RAY_REFRACT) && back && back->next == RAY_NONE);
                for (int channel = 0; channel < 3; channel++)
                    assert_true(back->throughput[channel] ==
                                root->throughput[channel] * root->hit.transmittance[channel]);
            }
            assert_false(hit_inside(&g, c, critical - 1e-9, turns[turn])->node[0].hit.tir);
            assert_non_null(child_of(&g.tree, &g.tree.node[0], RAY_REFRACT));
            stage_close(&g);
        }
    }
}

static void total_reflection_in_a_box_begins_at_the_critical_angle(void **state)
{
    (void)state;
    total_reflection_begins_at_the_critical_angle(&cells[0], "");
    total_reflection_begins_at_the_critical_angle(&cells[0], "box.absorb_per_m=0.5,0,2");
}

static void total_reflection_in_a_sphere_begins_at_the_critical_angle(void **state)
{
    (void)state;
    total_reflection_begins_at_the_critical_angle(&cells[1], "");
    total_reflection_begins_at_the_critical_angle(&cells[1], "sphere.absorb_per_m=0.5,0,2");
}

/* A film of air between two slabs of glass, modelled explicitly, against glass in contact, which is one
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
        cmocka_unit_test(reflectances_equal_the_textbooks_values),
        cmocka_unit_test(reflectances_follow_the_sine_and_tangent_laws),
        cmocka_unit_test(the_reflectance_is_the_same_from_both_sides),
        cmocka_unit_test(total_reflection_in_a_box_begins_at_the_critical_angle),
        cmocka_unit_test(total_reflection_in_a_sphere_begins_at_the_critical_angle),
        cmocka_unit_test(an_air_film_adds_two_interfaces),
        cmocka_unit_test(a_film_transmits_the_sum_of_its_internal_reflections),
        cmocka_unit_test(beyond_the_critical_angle_a_film_reflects_totally_and_contact_transmits),
        cmocka_unit_test(beyond_the_critical_angle_a_film_hides_the_paper_below),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
