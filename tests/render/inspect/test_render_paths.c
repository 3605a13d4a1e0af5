/* Tests of the paths of single rays, interface by interface, against closed forms: position, direction, angles,
 * weight. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "layers_fixture.h"

static const double BOUND = 1e-10; /* relative, whatever the number of interfaces */
static const vec3 turns[] = {{0.0, 0.0, 0.0}, {17.0, -33.0, 71.0}, {-8.0, 112.0, 203.0}};
static const vec3 places[] = {{0.0, 0.0, 0.0}, {0.7, -1.3, 2.9}, {-11.0, 4.0, 3.0}};

/* Snell's law from either side (Hecht, eq. 4.4): n_i sin i = n_t sin t, in the plane of incidence. */
static void snells_law_holds_from_either_side(void **state)
{
    (void)state;
    static const double pairs[][2] = {{1.0, 1.5},  {1.5, 1.0},  {1.0, 1.33}, {1.33, 1.0},
                                      {1.33, 1.5}, {1.0, 2.42}, {2.42, 1.0}, {4.0, 0.1}};
    for (size_t k = 0; k < COUNT(pairs); k++) {
        for (size_t turn = 0; turn < COUNT(turns); turn++) {
            scene_text text = scene_begin(pairs[k][0], 4);
            add_clear(&text, "half", pairs[k][1], 0, places[turn], turns[turn], "shape: plane");
            stage g = stage_of(text.at, "");
            for (double angle = 0.0; angle < 1.57; angle += 0.01) {
                if (pairs[k][0] * sin(angle) >= 0.999 * pairs[k][1])
                    continue;
                const layers none = {.count = 0, .outside = pairs[k][0]};
                known_way w = way_through_layers(&none, angle, places[turn], turns[turn]);
                const double sine = pairs[k][0] / pairs[k][1] * sin(angle);
                w.at[0].n_to = pairs[k][1];
                w.at[0].direction = turned(vec3_make(sine, -sqrt(1.0 - sine * sine), 0.0), turns[turn]);
                assert_true(way_error(stage_way(&g, w.origin, w.direction, -1), &w, 1.0) <= BOUND);
            }
            stage_close(&g);
        }
    }
}

/* How slabs are modelled: each separately; or each extending to the top, with higher priority above. */
typedef enum piling { SINGLY, OVERLAPPING } piling;

static stage pile(const layers *l, piling how, vec3 position, vec3 rotation_deg)
{
    scene_text text = scene_begin(l->outside, 64);
    double top = 0.0;
    for (int k = 0; k < l->count; top -= l->thickness[k++]) {
        const double thickness = l->thickness[k] - (how == SINGLY ? 0.0 : top),
                     middle = (how == SINGLY ? top : 0.0) - 0.5 * thickness;
        char name[16], more[120];
        snprintf(name, sizeof name, "slab%d", k);
        snprintf(more, sizeof more, "shape: box, size: [200, %.17g, 200]", thickness);
        if (l->n[k] != l->outside || how == OVERLAPPING)
            add_clear(&text, name, l->n[k], -k, vec3_add(position, turned(vec3_make(0.0, middle, 0.0), rotation_deg)),
                      rotation_deg, more);
    }
    return stage_of(text.at, "");
}

/* A pile of plane parallel slabs: the ray leaves in its original direction, shifted by the sum of d (tan i - tan t)
 * (Hecht, 4.4.1), with the product of Fresnel's transmittances. */
static void check_pile(const layers *l, piling how)
{
    double deep = 0.0;
    for (int k = 0; k < l->count; k++)
        deep += l->thickness[k];
    for (size_t turn = 0; turn < COUNT(turns); turn++) {
        stage g = pile(l, how, places[turn], turns[turn]);
        for (double angle = 0.0; angle < 84.5 * DEGREE; angle += 4.0 * DEGREE) {
            const known_way w = way_through_layers(l, angle, places[turn], turns[turn]);
            const ray_tree *tree = stage_way(&g, w.origin, w.direction, -1);
            assert_true(way_error(tree, &w, deep) <= BOUND);
            assert_true(apart(tree->node[w.count].direction, tree->node[0].direction) <= BOUND);
            double shift = 0.0; /* along the slabs, relative to the undeflected ray */
            for (int k = 0; k < l->count; k++)
                shift += l->thickness[k] * (tan(angle) - tan(asin(l->outside * sin(angle) / l->n[k])));
            const vec3 unbent = vec3_add(places[turn], turned(vec3_make(deep * tan(angle), -deep, 0.0), turns[turn]));
            assert_true(fabs(apart(tree->node[w.count].origin, unbent) - fabs(shift)) <= BOUND * deep);
        }
        stage_close(&g);
    }
}

static void slabs_with_gaps_offset_a_ray(void **state)
{
    (void)state;
    const layers seven = {13,
                          1.0,
                          {1.5, 1.0, 1.33, 1.0, 1.7, 1.0, 2.42, 1.0, 1.1, 1.0, 1.45, 1.0, 1.52},
                          {0.3, 0.2, 0.5, 0.1, 0.25, 0.4, 0.2, 0.15, 0.3, 0.1, 0.35, 0.2, 0.3}};
    check_pile(&seven, SINGLY); /* 14 interfaces */
}

static void slabs_in_contact_offset_a_ray(void **state)
{
    (void)state;
    const layers twelve = {12,
                           1.0,
                           {1.5, 1.33, 1.7, 1.2, 2.42, 1.1, 1.45, 1.6, 1.36, 1.9, 1.3, 1.52},
                           {0.3, 0.2, 0.5, 0.1, 0.25, 0.4, 0.2, 0.15, 0.3, 0.1, 0.35, 0.2}};
    check_pile(&twelve, OVERLAPPING); /* 13 interfaces */
    check_pile(&twelve, SINGLY);      /* faces that coincide up to rounding */
}

static stage nest(const shells *s, bool round, double height, vec3 position, vec3 rotation_deg)
{
    scene_text text = scene_begin(s->n[0], 64);
    for (int k = 0; k < s->count; k++) {
        char name[16], more[120];
        const vec3 base = vec3_add(position, turned(vec3_make(0.0, -0.5 * height, 0.0), rotation_deg));
        snprintf(name, sizeof name, "shell%d", k);
        snprintf(more, sizeof more,
                 round ? "shape: sphere, radius: %.17g" : "shape: cylinder, radius: %.17g, height: %.17g", s->radius[k],
                 height);
        add_clear(&text, name, s->n[k + 1], k, round ? position : base, rotation_deg, more);
    }
    return stage_of(text.at, "");
}

/* The total deflection is twice the sum of (i - t) (Born and Wolf, 3.2.1): heading starts at 0 and is measured in the
 * frame. */
static double deviation_of(const shells *s, double offset)
{
    double sum = 0.0;
    for (int k = 0; k < s->count; k++)
        sum +=
            asin(s->n[0] * offset / (s->n[k] * s->radius[k])) - asin(s->n[0] * offset / (s->n[k + 1] * s->radius[k]));
    return 2.0 * sum;
}

static const shells seven_shells = {
    7, {1.0, 0.93, 0.81, 0.74, 0.62, 0.5, 0.41}, {1.0, 1.5, 1.33, 1.7, 1.45, 1.6, 1.36, 2.1}};
static const shells in_water = {6, {1.1, 1.0, 0.9, 0.8, 0.7, 0.6}, {1.33, 1.5, 1.4, 1.62, 1.2, 1.1, 1.5}};
static const shells *const nests[] = {&seven_shells, &in_water};
enum { NESTS = 2 };

/* The largest offset at which the ray hits all shells, whatever the rise. */
static double widest(const shells *s, double d_y)
{
    double least = s->radius[0];
    const double rise = s->n[0] * d_y, n0 = sqrt(s->n[0] * s->n[0] - rise * rise);
    for (int k = 0; k < s->count; k++)
        for (int side = 0; side < 2; side++)
            least = fmin(least, s->radius[k] * sqrt(s->n[k + side] * s->n[k + side] - rise * rise) / n0);
    return least;
}

static void bouguers_invariant_is_conserved_in_coaxial_cylinders(void **state)
{
    (void)state;
    for (int k = 0; k < NESTS; k++) {
        for (size_t turn = 0; turn < COUNT(turns); turn++) {
            stage g = nest(nests[k], false, 30.0, places[turn], turns[turn]);
            for (double share = -0.98; share < 1.0; share += 0.07) {
                const known_way w =
                    way_through_shells(nests[k], share * widest(nests[k], 0.0), 0.0, places[turn], turns[turn]);
                const ray_tree *tree = stage_way(&g, w.origin, w.direction, -1);
                assert_true(way_error(tree, &w, 1.0) <= BOUND);
                const double turned_by = vec3_dot(tree->node[w.count].direction, w.direction);
                assert_true(fabs(turned_by - cos(deviation_of(nests[k], share * widest(nests[k], 0.0)))) <= BOUND);
            }
            stage_close(&g);
        }
    }
}

static void skew_rays_through_coaxial_cylinders_follow_bravais(void **state)
{
    (void)state;
    for (int k = 0; k < NESTS; k++) {
        for (size_t turn = 0; turn < COUNT(turns); turn++) {
            stage g = nest(nests[k], false, 60.0, places[turn], turns[turn]);
            for (double d_y = -0.75; d_y < 0.8; d_y += 0.15) {
                for (double share = -0.95; share < 1.0; share += 0.19) {
                    const known_way w =
                        way_through_shells(nests[k], share * widest(nests[k], d_y), d_y, places[turn], turns[turn]);
                    assert_true(way_error(stage_way(&g, w.origin, w.direction, -1), &w, 1.0) <= BOUND);
                }
            }
            stage_close(&g);
        }
    }
}

/* In any plane through the centre; n times the distance of the ray's line from the centre is invariant. */
static void the_impact_parameter_is_conserved_in_nested_spheres(void **state)
{
    (void)state;
    for (int k = 0; k < NESTS; k++) {
        for (size_t turn = 0; turn < COUNT(turns); turn++) {
            stage g = nest(nests[k], true, 0.0, places[turn], turns[turn]);
            for (double share = -0.98; share < 1.0; share += 0.07) {
                const double offset = share * widest(nests[k], 0.0);
                const known_way w = way_through_shells(nests[k], offset, 0.0, places[turn], turns[turn]);
                const ray_tree *tree = stage_way(&g, w.origin, w.direction, -1);
                assert_true(way_error(tree, &w, 1.0) <= BOUND);
                for (size_t j = 0; j < tree->count; j++) {
                    const vec3 arm = vec3_cross(vec3_sub(tree->node[j].origin, places[turn]), tree->node[j].direction);
                    assert_true(fabs(tree->node[j].n * vec3_length(arm) - nests[k]->n[0] * fabs(offset)) <= BOUND);
                }
            }
            stage_close(&g);
        }
    }
}

/* A cup of glass, filled: two coaxial shells, across it; above the liquid the inner one is air. Down through the liquid
 * and the floor: two plane layers. */
static void a_vessel_with_its_liquid_refracts_like_shells_and_layers(void **state)
{
    (void)state;
    const shells filled = {2, {1.0, 0.9}, {1.0, 1.5, 1.33}}, empty = {2, {1.0, 0.9}, {1.0, 1.5, 1.0}};
    const layers down = {2, 1.0, {1.33, 1.5}, {1.9, 0.1}};
    for (size_t turn = 0; turn < COUNT(turns); turn++) {
        const vec3 at = places[turn], up = turned(vec3_make(0.0, 1.0, 0.0), turns[turn]);
        scene_text text = scene_begin(1.0, 64);
        add_clear(&text, "vessel", 1.5, 2, at, turns[turn],
                  "shape: cup, radius: 1, inner_radius: 0.9, height: 3, floor: 0.1");
        add_clear(&text, "liquid", 1.33, 1, vec3_add(at, vec3_scale(up, 0.05)), turns[turn],
                  "shape: cylinder, radius: 0.95, height: 1.95");
        stage g = stage_of(text.at, "");
        for (double share = -0.95; share < 1.0; share += 0.095) {
            known_way w = way_through_shells(&filled, share * 0.89, 0.05, vec3_add(at, up), turns[turn]);
            assert_true(way_error(stage_way(&g, w.origin, w.direction, -1), &w, 1.0) <= BOUND);
            w = way_through_shells(&empty, share * 0.89, 0.05, vec3_add(at, vec3_scale(up, 2.5)), turns[turn]);
            assert_true(way_error(stage_way(&g, w.origin, w.direction, -1), &w, 1.0) <= BOUND);
            w = way_through_layers(&down, 0.3 + 0.2 * share, vec3_add(at, vec3_scale(up, 2.0)), turns[turn]);
            assert_true(way_error(stage_way(&g, w.origin, w.direction, -1), &w, 1.0) <= BOUND);
        }
        stage_close(&g);
    }
}

/* Rainbows: k reflections inside a drop deflect light by D = 2 (i - r) + k (pi - 2 r) (Hecht, problem 4.32; van de
 * Hulst, Light Scattering by Small Particles, 12.31), with a hit on the surface every pi - 2 r; T R^k T of it
 * leaves. */
static void deflections_by_a_drop_equal_those_of_rainbows(void **state)
{
    (void)state;
    static const double pairs[][2] = {{1.0, 1.333}, {1.0, 1.5}, {1.0, 2.42}, {1.33, 1.5}};
    enum { REFLECTIONS = 20 };
    const double pi = acos(-1.0);
    for (size_t k = 0; k < COUNT(pairs); k++) {
        const vec3 at = places[k % COUNT(places)], turn = turns[k % COUNT(turns)];
        const shells drop = {1, {1.7}, {pairs[k][0], pairs[k][1]}};
        stage g = nest(&drop, true, 0.0, at, turn);
        for (double angle = 0.05; angle < 1.52; angle += 0.05) {
            const known_way w = way_through_shells(&drop, 1.7 * sin(angle), 0.0, at, turn);
            const ray_tree *tree = stage_ray(&g, w.origin, w.direction);
            const double r = asin(pairs[k][0] / pairs[k][1] * sin(angle));
            const reflectance share = reflectance_of_angles(angle, pairs[k][0], pairs[k][1]);
            double inside = 1.0 - share.mean;
            const ray_node *node = child_of(tree, &tree->node[0], RAY_REFRACT);
            for (int j = 0; j <= REFLECTIONS; j++) {
                const double polar = pi - angle - (j + 1) * (pi - 2.0 * r),
                             heading = -2.0 * (angle - r) - j * (pi - 2.0 * r);
                const vec3 point = vec3_add(at, turned(vec3_make(1.7 * cos(polar), 0.0, 1.7 * sin(polar)), turn));
                const ray_node *out = child_of(tree, node, RAY_REFRACT);
                assert_true(apart(node->hit.point, point) <= BOUND * 1.7);
                assert_true(apart(out->direction, turned(vec3_make(cos(heading), 0.0, sin(heading)), turn)) <= BOUND);
                assert_true(fabs(out->throughput[0] / (inside * (1.0 - share.mean)) - 1.0) <= BOUND);
                inside *= share.mean;
                node = child_of(tree, node, RAY_REFLECT);
            }
        }
        stage_close(&g);
    }
}

/* A prism of apex angle A, which points along +y: a box of glass, clipped by two half-spaces of the surrounding
 * medium. */
static stage prism(double apex, double n, double outside)
{
    const double lean_deg = 90.0 + 0.5 * apex / DEGREE;
    const vec3 top = {0.0, 0.0, 0.0};
    scene_text text = scene_begin(outside, 8);
    add_clear(&text, "glass", n, 1, top, top, "shape: box, size: [20, 6, 6]");
    add_clear(&text, "left", outside, 2, top, vec3_make(0.0, 0.0, -lean_deg), "shape: plane");
    add_clear(&text, "right", outside, 2, top, vec3_make(0.0, 0.0, lean_deg), "shape: plane");
    return stage_of(text.at, "");
}

/* Deviation of a ray that enters at the middle of the left face under angle_i. */
static double deviation_through(stage *g, double apex, double angle_i)
{
    const vec3 entry = vec3_make(-sin(0.5 * apex), -cos(0.5 * apex), 0.0);
    /* the face's inward normal is at -A/2 from +x; the ray comes from below it */
    const double heading = -0.5 * apex + angle_i;
    const vec3 d = vec3_make(cos(heading), sin(heading), 0.0);
    const ray_tree *tree = stage_way(g, vec3_sub(entry, d), d, -1);
    assert_int_equal((int)tree->count, 3);
    assert_true(apart(tree->node[0].hit.point, entry) <= BOUND);
    const vec3 out = tree->node[2].direction;
    assert_true(fabs(out.z) <= BOUND);
    return atan2(d.y, d.x) - atan2(out.y, out.x); /* towards the base */
}

/* D = i + t2 - A with r + r2 = A (Hecht, 5.5.1, eqs. 5.52 to 5.54), least in the symmetric case: n = sin((A + D)/2) /
 * sin(A/2). */
static void deviation_is_minimal_for_the_symmetric_path(void **state)
{
    (void)state;
    static const double apexes[] = {20.0 * DEGREE, 45.0 * DEGREE, 60.0 * DEGREE},
                        indices[][2] = {{1.5, 1.0}, {1.7, 1.0}, {1.62, 1.33}};
    for (size_t a = 0; a < COUNT(apexes); a++) {
        for (size_t k = 0; k < COUNT(indices); k++) {
            const double apex = apexes[a], n = indices[k][0] / indices[k][1], alike = asin(n * sin(0.5 * apex));
            stage g = prism(apex, indices[k][0], indices[k][1]);
            const double least = deviation_through(&g, apex, alike);
            assert_true(fabs(sin(0.5 * (apex + least)) / sin(0.5 * apex) - n) <= BOUND);
            for (double off = -0.25; off <= 0.25; off += 0.0125) {
                const double r = asin(sin(alike + off) / n), closed = alike + off + asin(n * sin(apex - r)) - apex;
                if (!isfinite(closed))
                    continue; /* total reflection at the second face */
                const double seen = deviation_through(&g, apex, alike + off);
                assert_true(fabs(seen - closed) <= BOUND);
                assert_true(seen >= least - BOUND);
            }
            stage_close(&g);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(snells_law_holds_from_either_side),
        cmocka_unit_test(slabs_with_gaps_offset_a_ray),
        cmocka_unit_test(slabs_in_contact_offset_a_ray),
        cmocka_unit_test(bouguers_invariant_is_conserved_in_coaxial_cylinders),
        cmocka_unit_test(skew_rays_through_coaxial_cylinders_follow_bravais),
        cmocka_unit_test(the_impact_parameter_is_conserved_in_nested_spheres),
        cmocka_unit_test(a_vessel_with_its_liquid_refracts_like_shells_and_layers),
        cmocka_unit_test(deflections_by_a_drop_equal_those_of_rainbows),
        cmocka_unit_test(deviation_is_minimal_for_the_symmetric_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
