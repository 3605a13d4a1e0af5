/* Lens systems in scenes: they move, turn and scale as one; mirrors that fold the axis or are behind glass, against
 * closed forms; and mistakes. */
#include "lens_fixture.h"

/* --- mirrors that fold the axis, or are behind glass --- */

#define BREAK(number, parameters, thickness) "SURF " number "\n  TYPE COORDBRK\n" parameters "  DISZ " thickness "\n"

/* Where a ray that enters at the height x crosses the axis through `at` along `axis`. */
static vec3 crosses(const scene *s, const lens_prescription *p, double x, vec3 at, vec3 axis, const char *name)
{
    const ray_node r = traced(s, p, x, -50.0, name);
    const vec3 off = vec3_sub(r.origin, at), across = vec3_sub(off, vec3_scale(axis, vec3_dot(off, axis))),
               turn = vec3_sub(r.direction, vec3_scale(axis, vec3_dot(r.direction, axis)));
    return vec3_add(r.origin, vec3_scale(r.direction, -vec3_dot(across, turn) / vec3_dot(turn, turn)));
}

/* A flat and a convex side of radius R have the focus R / (n - 1) - d / n behind the flat one, if the convex side is
 * first. The mirror, 20 behind it at 45 degrees, sends the light along +Y. */
static void a_fold_mirror_of_a_zmx_file_turns_the_axis(void **state)
{
    (void)state;
    static const char text[] = ZMX_HEAD
        "SURF 1\n  STOP\n  CURV 0.02\n  DISZ 4\n  GLAS ___BLANK 1 0 1.5 0 0\n  DIAM 8\nSURF 2\n  CURV 0\n  DISZ 20\n  "
        "DIAM 8\n" BREAK("3", "  PARM 3 45\n", "0") "SURF 4\n  CURV 0\n  DISZ 0\n  GLAS MIRROR 0 0 1.5 40\n  DIAM "
                                                    "12\n" BREAK("5", "  PARM 3 45\n",
                                                                 "-30") "SURF 6\n  CURV 0\n  DISZ -40\n  DIAM 9\n"
                                                                        "SURF 7\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n";
    const double focus = 50.0 / 0.5 - 4.0 / 1.5;
    lens_prescription p = parsed("fold.zmx", text, strlen(text)), again;
    assert_int_equal(p.count, 4);
    assert_near(p.surface[2].tilt_x_deg, 45.0, 0.0, "tilt");
    assert_near(p.surface[2].thickness, -30.0, 1e-13, "after the mirror");
    const lens_first_order f = lens_first_order_of(&p, 587.5618);
    assert_near(f.efl, 100.0, 1e-12, "of the unfolded system");
    assert_near(20.0 - (f.back - 30.0), focus, 1e-12, "along the folded axis");
    scene *s = scene_of(&p, "fold");
    const vec3 mirror = vec3_make(0.0, 0.0, 24.0), up = vec3_make(0.0, 1.0, 0.0),
               to = crosses(s, &p, 1e-3, mirror, up, "fold");
    assert_near(to.y, focus - 20.0, 1e-6, "focus");
    assert_near(to.z, 24.0, 1e-12, "above the mirror");
    const solid_shape *screen = &s->solids[scene_find_solid(s, "objective-screen")].shape;
    assert_near(screen->position.y, 70.0 + screen->thickness, 1e-9, "screen");
    diagnostic why = {.what = ""};
    const char *const names[] = {"a.csv", "a.zmx"};
    for (size_t i = 0; i < 3; i++) {
        char *file = i < 2 ? written(&p, names[i]) : NULL;
        if (i < 2)
            again = parsed(names[i], file, strlen(file));
        else if (lens_of_scene(s, "objective", &again, NULL, &why) != STATUS_OK)
            fail_msg("%s; %s", why.what, why.remedy);
        if (i == 2) { /* the plane in air before the screen has no solid */
            assert_int_equal(again.count, 3);
            assert_near(again.surface[2].thickness, -70.0, 1e-9, "to the screen");
        } else {
            assert_same_system(&p, &again, 1e-13, "fold");
        }
        assert_near(again.surface[2].tilt_x_deg, 45.0, 1e-12, "tilt");
        assert_near(again.surface[2].tilt_y_deg, 0.0, 1e-12, "tilt");
        lens_prescription_release(&again);
        free(file);
    }
    scene_destroy(s);
    lens_prescription_release(&p);
}

/* Two mirrors, about Y and about X: the light goes to +Z, -X, -Y; the lens behind them is on the folded axis. */
static void two_fold_mirrors_lead_to_a_lens(void **state)
{
    (void)state;
    const char *text = "pupil,2\nradius,thickness,medium,diameter,tilt_x,tilt_y,stop\n0,30,,10,0,0,1\n"
                       "60,2,1.5,20,0,0,\n60,10,,20,0,0,\n0,-15,mirror,20,0,45,\n0,25,mirror,20,30,0,\n"
                       "40,3,1.5,12,0,0,\n0,0,,12,0,0,\n";
    lens_prescription p = parsed("two.csv", text, strlen(text)), again;
    scene *s = scene_of(&p, "two");
    /* the normals, and the rays that they reflect */
    const double h = sqrt(0.5);
    vec3 d = vec3_make(0.0, 0.0, 1.0), at = vec3_make(0.0, 0.0, 42.0), n = vec3_make(h, 0.0, h);
    d = vec3_sub(d, vec3_scale(n, 2.0 * vec3_dot(n, d)));
    at = vec3_add(at, vec3_scale(d, 15.0));
    /* after it X, Y, Z are (0, 0, -1), (0, 1, 0), -d: tilted about that X by 30 degrees, Y towards Z */
    n = vec3_add(vec3_scale(d, -cos(M_PI / 6.0)), vec3_make(0.0, -0.5, 0.0));
    d = vec3_sub(d, vec3_scale(n, 2.0 * vec3_dot(n, d)));
    const double vertex = p.surface[4].thickness + 3.0, back = lens_first_order_of(&p, 587.5618).back;
    const vec3 to = crosses(s, &p, 1e-3, at, d, "two");
    assert_near(vec3_dot(vec3_sub(to, at), d), vertex + back, 1e-5, "focus");
    diagnostic why = {.what = ""};
    if (lens_of_scene(s, "objective", &again, NULL, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
    assert_same_system(&p, &again, 1e-9, "two");
    assert_near(again.surface[3].tilt_y_deg, 45.0, 1e-9, "about Y");
    assert_near(again.surface[4].tilt_x_deg, 30.0, 1e-9, "about X");
    lens_prescription_release(&again);
    scene_destroy(s);
    lens_prescription_release(&p);
}

/* A mirror behind glass, by vergences: (n - 1) / R1 at each passage of the front, -2 n / R2 at the mirror. */
static void a_mangin_mirror_focuses_by_its_vergences(void **state)
{
    (void)state;
    static const char text[] =
        ZMX_HEAD "SURF 1\n  STOP\n  CURV -0.008\n  DISZ 4\n  GLAS ___BLANK 1 0 1.5 0 0\n  DIAM 8\n"
                 "SURF 2\n  CURV -0.0055\n  DISZ -4\n  GLAS MIRROR 0 0 1.5 40\n  DIAM 8\n"
                 "SURF 3\n  CURV -0.008\n  DISZ -60\n  DIAM 8\nSURF 4\n  TYPE STANDARD\n  CURV 0\n  DISZ 0\n";
    const double n = 1.5, d = 4.0, R1 = -125.0, R2 = -1.0 / 0.0055;
    double V = (n - 1.0) / R1;
    V = V / (1.0 - d * V / n) - 2.0 * n / R2;
    V = V / (1.0 - d * V / n) + (n - 1.0) / R1;
    lens_prescription p = parsed("mangin.zmx", text, strlen(text)), again;
    const lens_first_order f = lens_first_order_of(&p, 587.5618);
    assert_near(f.back, -1.0 / V, 1e-10, "back");
    scene *s = scene_of(&p, "mangin");
    const vec3 to = crosses(s, &p, 1e-3, vec3_make(0, 0, 0), vec3_make(0, 0, 1), "mangin");
    assert_near(to.z, -1.0 / V, 1e-6, "focus");
    assert_int_equal(s->solid_count >= 3, 1); /* glass, mirror, screen: the way back has no glass of its own */
    assert_int_equal(scene_find_solid(s, "objective-3"), -1);
    diagnostic why = {.what = ""};
    lens_placement place;
    if (lens_of_scene(s, "objective", &again, &place, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
    assert_same_system(&p, &again, 1e-10, "mangin");
    assert_near(place.position.z, 0.0, 0.0, "the ring of the stop is before the surface whose edge it is");
    lens_prescription_release(&again);
    scene_destroy(s);
    lens_prescription_release(&p);
    p = parsed("a.csv", "radius,thickness,medium,diameter\n0,4,1.5,9\n-90,-4,mirror,9\n50,-9,,9\n", 72);
    assert_int_equal(lens_scene_create(&p, NULL, &s, &why), STATUS_BAD_INPUT);
    p.stop = 0;
    lens_prescription_release(&p);
}

/* A lens that is given again after a mirror is one solid, and is found twice on the way of the light. */
static void a_lens_before_a_mirror_is_passed_twice(void **state)
{
    (void)state;
    const char *text =
        "pupil,10\nradius,thickness,medium,diameter,stop\n80,4,1.5,20,1\n-300,20,,20\n-400,-20,mirror,20\n"
        "-300,-4,1.5,20\n80,-9,,20\n";
    const double n = 1.5, P1 = (n - 1.0) / 80.0, P2 = (1.0 - n) / -300.0;
    double V = P1;
    V = V / (1.0 - 4.0 * V / n) + P2;
    V = V / (1.0 - 20.0 * V) + 2.0 / 400.0;
    V = V / (1.0 - 20.0 * V) + P2;
    V = V / (1.0 - 4.0 * V / n) + P1;
    lens_prescription p = parsed("twice.csv", text, strlen(text)), again;
    assert_near(lens_first_order_of(&p, 587.5618).back, -1.0 / V, 1e-10, "back");
    scene *s = scene_of(&p, "twice");
    const vec3 to = crosses(s, &p, 1e-3, vec3_make(0, 0, 0), vec3_make(0, 0, 1), "twice");
    assert_near(to.z, -1.0 / V, 1e-6, "focus");
    diagnostic why = {.what = ""};
    if (lens_of_scene(s, "objective", &again, NULL, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
    assert_same_system(&p, &again, 1e-10, "twice");
    lens_prescription_release(&again);
    scene_destroy(s);
    lens_prescription_release(&p);
}

/* --- lens systems of scenes --- */

static const char singlet[] = "render: {unit_m: 0.001}\n"
                              "lens_systems:\n"
                              "  eyepiece:\n"
                              "    position: [1, 2, 3]\n"
                              "    rotation: [0, 0, 30]\n"
                              "    scale: 2\n"
                              "    pupil: 4\n"
                              "    surfaces:\n"
                              "      - {radius: 20, thickness: 3, medium: 1.5, diameter: 8}\n"
                              "      - {radius: -15, thickness: 2, medium: 1.7, diameter: 8}\n"
                              "      - {radius: 0, thickness: 6, diameter: 8}\n"
                              "      - {thickness: 30, stop: on}\n";

static void systems_move_as_one(void **state)
{
    (void)state;
    scene *s = scene_from(singlet);
    diagnostic why = {.what = ""};
    const mat3 before = rotation_from_deg(vec3_make(0, 0, 30));
    const vec3 stop = vec3_sub(position_of(s, "eyepiece-stop"), position_of(s, "eyepiece"));
    const vec3 along = mat3_apply_transposed(before, stop);
    assert_near(along.x, 0.0, 1e-14, "x");
    assert_near(along.y, 22.0, 0.01, "y");
    assert_int_equal(scene_set_assignment(s, "eyepiece.position=10,0,0", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(s, "eyepiece.rotation=90,0,0", &why), STATUS_OK);
    const vec3 now = position_of(s, "eyepiece-stop");
    assert_near(now.x, 10.0, 1e-14, "x");
    assert_near(now.y, 0.0, 1e-13, "y");
    assert_near(now.z, along.y, 1e-13, "z");
    assert_int_equal(scene_set_assignment(s, "eyepiece-2.position=0,0,0", &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "follows eyepiece"));
    assert_int_equal(scene_remove(s, "eyepiece", &why), STATUS_BAD_INPUT);
    assert_int_equal(scene_rename(s, "eyepiece", "ocular", &why), STATUS_OK);
    assert_int_equal(scene_move(s, "solids", vec3_make(0, 0, 1), &why), STATUS_OK);
    assert_near(position_of(s, "eyepiece-stop").z, along.y + 1.0, 1e-13, "moved");
    assert_int_equal(scene_turn(s, "solids", vec3_make(0, 90, 0), &why), STATUS_OK);
    assert_near(position_of(s, "eyepiece-stop").x, along.y + 1.0, 1e-12, "turned");
    scene *copy = scene_clone(s);
    assert_int_equal(scene_set_assignment(copy, "ocular.position=0,0,0", &why), STATUS_OK);
    assert_near(position_of(copy, "eyepiece-stop").x, along.y, 1e-12, "a clone");
    scene_destroy(copy);
    scene_destroy(s);
}

/* A point of the world in the frame of the solid objective. */
static vec3 local_of(const scene *s, vec3 point)
{
    const solid_shape *at = &s->solids[scene_find_solid(s, "objective")].shape;
    const vec3 v = mat3_apply_transposed(rotation_from_deg(at->rotation_deg), vec3_sub(point, at->position));
    return vec3_scale(v, 1.0 / at->scale.x);
}

static vec3 world_of(const scene *s, vec3 local)
{
    const solid_shape *at = &s->solids[scene_find_solid(s, "objective")].shape;
    const vec3 v = mat3_apply(rotation_from_deg(at->rotation_deg), vec3_scale(local, at->scale.x));
    return vec3_add(v, at->position);
}

/* The ray that begins at a point near a beam's start, along the beam. */
static ray_tree along_beam(const scene *s, const beam *b, vec3 local)
{
    probe *tracer;
    ray_tree tree = {.node = NULL};
    assert_int_equal(probe_create(s, isa_best(), &tracer, NULL), STATUS_OK);
    probe_limit_depth(tracer, 64, "");
    assert_int_equal(probe_path(tracer, world_of(s, local), vec3_normalize(beam_axis(b)), -1, &tree, NULL), STATUS_OK);
    probe_destroy(tracer);
    return tree;
}

static void same_rays(const lens_prescription *p, const scene *a, const scene *b)
{
    assert_int_equal(a->beam_count, b->beam_count);
    for (size_t i = 0; i < a->beam_count; i++) {
        const vec3 start = local_of(a, a->beams[i].position), there = local_of(b, b->beams[i].position);
        assert_near(vec3_length(vec3_sub(start, there)), 0.0, 1e-12, "start");
        assert_near(a->beams[i].width * 3.0, b->beams[i].width, 1e-12, "width");
        for (int k = 0; k < 5; k++) {
            const vec3 from = vec3_add(start, vec3_make(0.4 * k - 0.8, 0.0, 0.3 * k - 0.6));
            ray_tree one = along_beam(a, &a->beams[i], from), two = along_beam(b, &b->beams[i], from);
            for (size_t n = 0; n <= refractions_of(p); n++) {
                assert_true(n < one.count && n < two.count);
                const vec3 x = local_of(a, one.node[n].origin), y = local_of(b, two.node[n].origin);
                assert_near(vec3_length(vec3_sub(x, y)), 0.0, 1e-11, "a hit");
            }
            ray_tree_release(&one), ray_tree_release(&two);
        }
    }
}

static void moved_turned_and_scaled_systems_have_the_same_rays(void **state)
{
    (void)state;
    diagnostic why = {.what = ""};
    lens_prescription p = read_lens(LENSES "cooke-triplet.csv"), again;
    scene *a = scene_of(&p, "here"), *b = scene_of(&p, "there"), *c = scene_of(&p, "scaled by the page");
    assert_int_equal(scene_set_assignment(b, "objective.position=100,-20,3000", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(b, "objective.rotation=20,130,-40", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(b, "objective.scale=3,3,3", &why), STATUS_OK);
    assert_int_equal(scene_check(b, &why), STATUS_OK);
    same_rays(&p, a, b);
    assert_int_equal(lens_of_scene(b, "objective", &again, NULL, &why), STATUS_OK);
    for (size_t i = 0; i < p.count; i++) {
        assert_near(again.surface[i].radius, 3.0 * p.surface[i].radius, 1e-9 * fabs(p.surface[i].radius), "radius");
        assert_near(again.surface[i].thickness, 3.0 * p.surface[i].thickness, 1e-9, "thickness");
    }
    lens_prescription_release(&again);
    /* as the page drags: one scale, then a move and a turn of the first element */
    assert_int_equal(scene_scale(c, "objective", 3.0, &why), STATUS_OK);
    assert_int_equal(scene_move(c, "objective", vec3_make(0, 5, 0), &why), STATUS_OK);
    assert_int_equal(scene_turn(c, "objective", vec3_make(0, 70, 0), &why), STATUS_OK);
    assert_int_equal(lens_of_scene(c, "objective", &again, NULL, &why), STATUS_OK);
    assert_near(lens_first_order_of(&again, 550.0).efl, 3.0 * lens_first_order_of(&p, 550.0).efl, 1e-9, "scaled");
    const vec3 to = mat3_apply_transposed(rotation_from_deg(vec3_make(0, 70, 0)), c->beams[2].direction);
    assert_near(to.x * a->beams[2].direction.z, to.z * a->beams[2].direction.x, 1e-12, "turned");
    assert_near(c->beams[2].width, 3.0 * a->beams[2].width, 1e-12, "width");
    lens_prescription_release(&again);
    /* a follower's own rotation and scale are within its leader's */
    assert_int_equal(scene_set_assignment(a, "objective-2.rotation=0,0,10", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(a, "objective-2.scale=2,2,2", &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(a, "objective.scale=3,3,3", &why), STATUS_OK);
    const solid_shape *led = &a->solids[scene_find_solid(a, "objective-2")].shape;
    const vec3 axis = mat3_apply(rotation_from_deg(led->rotation_deg), vec3_make(0, 1, 0)),
               expected = mat3_apply(rotation_from_deg(vec3_make(90, 0, 0)),
                                     mat3_apply(rotation_from_deg(vec3_make(0, 0, 10)), vec3_make(0, 1, 0)));
    assert_near(vec3_length(vec3_sub(axis, expected)), 0.0, 1e-14, "rotated");
    assert_near(led->scale.y, 6.0, 0.0, "scaled");
    assert_int_equal(scene_set_assignment(a, "objective.scale=3,2,3", &why), STATUS_OK);
    assert_int_equal(scene_check(a, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "not scaled evenly"));
    assert_int_equal(scene_remove(a, "objective", &why), STATUS_BAD_INPUT);
    scene_destroy(a), scene_destroy(b), scene_destroy(c);
    lens_prescription_release(&p);
}

static void written_systems_are_read_back(void **state)
{
    (void)state;
    scene *s = scene_from(singlet);
    char *one, *two;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_write_text(s, NULL, false, &one, &why), STATUS_OK);
    scene *again = scene_from(one);
    assert_int_equal(scene_write_text(again, NULL, false, &two, &why), STATUS_OK);
    assert_string_equal(one, two);
    assert_non_null(strstr(one, "follows: eyepiece"));
    lens_prescription p;
    assert_int_equal(lens_of_scene(again, "eyepiece", &p, NULL, &why), STATUS_OK);
    assert_near(p.surface[0].radius, 40.0, 1e-12, "scaled");
    assert_near(p.surface[1].radius, -30.0, 1e-12, "cemented");
    assert_int_equal(p.stop, 3);
    lens_prescription_release(&p);
    free(one), free(two);
    scene_destroy(again);
    scene_destroy(s);
}

static void wrong_scene(const char *text, long line, long column, const char *what)
{
    scene *s;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_read_text("a.yaml", text, strlen(text), &s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what))
        fail_msg("'%s' does not contain '%s'", why.what, what);
    assert_int_equal(why.line, line);
    assert_int_equal(why.column, column);
    assert_true(why.remedy[0] != 0);
}

static void mistakes_in_scenes_are_located(void **state)
{
    (void)state;
    wrong_scene("lens_systems:\n  a:\n    surfaces:\n      - {radius: x, thickness: 1}\n", 4, 9, "radius: 'x'");
    wrong_scene("lens_systems:\n  a: {file: b.zmx}\n", 2, 13, "names a file");
    wrong_scene("lens_systems:\n  a: {glasses: b.agf, surfaces: []}\n", 2, 16, "names a file");
    wrong_scene("lens_systems:\n  a: {position: [0, 0, 0]}\n", 2, 6, "neither a file nor surfaces");
    wrong_scene("lens_systems:\n  a: {surfaces: [], scal: 2}\n", 2, 21, "scal");
    wrong_scene("lens_systems:\n  a: {surfaces: [], scale: 0}\n", 2, 28, "scale");
    wrong_scene("lens_systems:\n  a: {surfaces: [{radius: 1, thickness: 1, colour: 2}]}\n", 2, 44, "colour");
    wrong_scene("lens_systems:\n  a: {surfaces: [{radius: 9, thickness: 1, medium: 1.5}, {thickness: 1}]}\n", 2, 3,
                "diameter of surface 1 is not known");
    wrong_scene("solids:\n  a: {shape: sphere, follows: b}\n", 2, 3, "no solid before it");
    wrong_scene("solids:\n  a: {shape: sphere}\n  b: {shape: box, follows: a, position: [1, 0, 0]}\n", 3, 41,
                "own place");
    wrong_scene("solids:\n  a: {shape: box}\n  b: {shape: box, follows: a}\n  c: {shape: box, follows: b}\n", 4, 3,
                "follows another solid");
    wrong_scene("beams:\n  a: {follows: b}\nsolids:\n  c: {shape: box}\n", 2, 3, "no solid has that name");
    wrong_scene("beams:\n  a: {follows: b}\nsolids:\n  b: {shape: box, scale: [1, 2, 1]}\n", 2, 3, "not scaled evenly");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(systems_move_as_one),
        cmocka_unit_test(moved_turned_and_scaled_systems_have_the_same_rays),
        cmocka_unit_test(written_systems_are_read_back),
        cmocka_unit_test(mistakes_in_scenes_are_located),
        cmocka_unit_test(a_fold_mirror_of_a_zmx_file_turns_the_axis),
        cmocka_unit_test(two_fold_mirrors_lead_to_a_lens),
        cmocka_unit_test(a_mangin_mirror_focuses_by_its_vergences),
        cmocka_unit_test(a_lens_before_a_mirror_is_passed_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
