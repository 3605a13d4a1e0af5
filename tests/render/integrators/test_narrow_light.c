/* Light narrower than a pixel: the power that a film receives from dots and lines of light does not depend on where
 * they are between the samples. Closed forms: a matte surface of albedo 1 has the radiance E / pi, so that power P in
 * a dot of the area A gives P / (pi A), and A covers cos s / r^2 of solid angle; what a pixel of the image plane at
 * depth 1 covers is cos^3 c of its area (Pharr, Jakob and Humphreys, Physically Based Rendering, 5.4.1). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "job/account.h"
#include "job/job.h"
#include "render_fixture.h"
#include "report/report.h"
#include "scene/model/camera.h"
#include "whole.h"

#define PI 3.14159265358979323846
/* Discs of PHOTON_RESOLVED cells keep their sum within 1e-3, narrower ones within rounding. */
#define TOLERANCE 1e-3

static uint32_t draws;

static double draw(double low, double high)
{
    return low + (high - low) * random_unit(random_at(47, draws++, 0, 0, 0).word[0]);
}

static scene *scene_of(const char *view, const char *light_beam, const char *solids)
{
    char text[2000];
    snprintf(
        text, sizeof text,
        "render: {width: 48, height: 36, depth: 8, caustics: photons, photons: 2000}\n"
        "camera: {target: [0, 0, 0], %s}\n"
        "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
        "beams: {laser: {lights: \"on\", white: \"on\", power: 1, position: [0.3, 1, 0.2], target: [0, 0, 0], %s}}\n"
        "solids:\n"
        "  floor: {shape: plane, diffuse: 1}\n%s",
        view, light_beam, solids);
    return scene_from(text);
}

/* The integral of radiance over the image plane. */
static double light_of(const scene *s)
{
    render_result *r = render(s);
    double sum = 0.0;
    for (int i = 0; i < r->img->width * r->img->height; i++)
        sum += film_radiance(r->img->sum[3 * i + 1]);
    render_result_destroy(r);
    const camera_frame view = camera_frame_of(s);
    const camera_pixel pixel = camera_pixel_of(&view, &s->render);
    return sum * pixel.across * pixel.down;
}

/* Area of the image plane per area of the floor at a point. */
static double magnification(const scene *s, vec3 at)
{
    const camera_frame f = camera_frame_of(s);
    const vec3 off = vec3_sub(at, f.eye);
    const double depth = vec3_dot(off, f.forward);
    return f.parallel ? fabs(f.forward.y) : fabs(off.y) / (depth * depth * depth);
}

static void aim(scene *s, vec3 at)
{
    s->beams[0].position = vec3_add(at, vec3_make(0.3, 1.0, 0.2));
    s->beams[0].target = at;
}

static void place_camera(scene *s, double least_degrees)
{
    const double height = draw(least_degrees, 89.0) * PI / 180.0, around = draw(0.0, 2.0 * PI), far = draw(2.0, 9.0);
    s->camera.position = vec3_make(far * cos(height) * cos(around), far * sin(height), far * cos(height) * sin(around));
}

static void assert_share(double measured, double expected, double tolerance, const char *what)
{
    if (!(fabs(measured / expected - 1.0) <= tolerance))
        fail_msg("%s %u: %.9g instead of %.9g, %.3g times", what, draws, measured, expected, measured / expected);
}

/* Seen from anywhere, at any slope, a dot brings its power. */
static void a_dot_keeps_its_power(void **state)
{
    (void)state;
    static const char *const views[] = {"fov_deg: 30", "fov_deg: 70", "projection: orthographic, view_height: 3"};
    static const char *const samples[] = {"render.samples=1", "render.samples=4", "render.samples=16"};
    scene *s[3];
    for (int v = 0; v < 3; v++)
        s[v] = scene_of(views[v], "kind: pencil, angle_deg: 0", "");
    const int trials = trials_of(2000);
    for (int i = 0; i < trials; i++) {
        scene *one = s[i % 3];
        place_camera(one, 8.0);
        set(one, samples[i / 3 % 3]);
        const vec3 at = vec3_make(draw(-0.1, 0.1), 0.0, draw(-0.1, 0.1));
        aim(one, at);
        assert_share(light_of(one), magnification(one, at) / PI, 1e-6, "dot");
    }
    for (int v = 0; v < 3; v++)
        scene_destroy(s[v]);
}

/* In the middle of the image, between four samples, and on one. */
static void the_middle_of_the_image_is_no_exception(void **state)
{
    (void)state;
    scene *s = scene_of("position: [0, 5, -0.001]", "kind: pencil, angle_deg: 0", "");
    static const char *const sizes[] = {"render.width=40 render.height=30", "render.width=41 render.height=31"};
    for (int k = 0; k < 2; k++) {
        set_all(s, sizes[k]);
        assert_share(light_of(s), magnification(s, vec3_make(0.0, 0.0, 0.0)) / PI, 1e-6, "middle");
    }
    scene_destroy(s);
}

/* A line of light, seen in parallel: the magnification is one for all of it. */
static void a_line_keeps_its_power(void **state)
{
    (void)state;
    static const char *const samples[] = {"render.samples=1", "render.samples=16"};
    scene *s = scene_of("projection: orthographic, view_height: 3", "kind: sheet, width: 0.8", "");
    for (int i = 0; i < trials_of(500); i++) {
        place_camera(s, 20.0);
        const vec3 at = vec3_make(draw(-0.1, 0.1), 0.0, draw(-0.1, 0.1));
        aim(s, at);
        const double turn = i % 5 == 0 ? 0.0 : draw(0.0, PI);
        s->beams[0].normal = vec3_make(cos(turn), 0.0, sin(turn));
        set(s, samples[i % 2]);
        s->render.photons = i % 3 == 0 ? 200 : 20000;
        assert_share(light_of(s), magnification(s, at) / PI, TOLERANCE, "line");
    }
    scene_destroy(s);
}

/* Wide light, of discs that are looked up at points, and narrower ones between. */
static void light_of_any_width_keeps_its_power(void **state)
{
    (void)state;
    scene *s = scene_of("projection: orthographic, view_height: 3", "kind: bundle, width: 0.1", "");
    for (int i = 0; i < trials_of(300); i++) {
        place_camera(s, 20.0);
        const vec3 at = vec3_make(draw(-0.1, 0.1), 0.0, draw(-0.1, 0.1));
        aim(s, at);
        s->beams[0].width = draw(0.0, 0.6);
        assert_share(light_of(s), magnification(s, at) / PI, TOLERANCE, "bundle");
    }
    scene_destroy(s);
}

/* A flat mirror shows a dot at its image's place: on the other side, as far behind it. */
static void a_mirror_shows_the_dot(void **state)
{
    (void)state;
    scene *s = scene_of("fov_deg: 12", "kind: pencil, angle_deg: 0",
                        "  mirror: {shape: box, size: [40, 40, 1], position: [0, 0, 2.5], reflectivity: 1}\n");
    for (int i = 0; i < trials_of(300); i++) {
        const vec3 at = vec3_make(draw(-0.2, 0.2), 0.0, draw(-0.2, 0.2)), behind = vec3_make(at.x, 0.0, 4.0 - at.z);
        s->camera.position = vec3_make(draw(-1.0, 1.0), draw(2.5, 4.0), draw(-6.0, -3.0));
        s->camera.target = behind;
        s->camera.target.x += draw(-0.1, 0.1);
        aim(s, at);
        assert_share(light_of(s), magnification(s, behind) / PI, 1e-6, "mirrored dot");
    }
    scene_destroy(s);
}

/* Against 64 samples, in which the narrowest disc is 8 samples wide and is looked up at points. */
static void assert_like_64_samples(scene *s, double tolerance, const char *what)
{
    s->render.samples = 64;
    const double right = light_of(s);
    s->render.samples = 1;
    if (!(right > 0.0))
        fail_msg("%s: no light", what);
    assert_share(light_of(s), right, tolerance, what);
}

/* Through plates and a pool's surface. */
static void what_is_between_changes_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *name, *solids;
        double eye[3];
        double tolerance;
    } cases[] = {
        {"plate",
         "  plate: {shape: box, size: [8, 0.2, 8], position: [0, 1.6, 0], transparency: 1, ior: 1.5}\n",
         {1.0, 4.0, -2.0},
         1e-3},
        {"tilted plate",
         "  plate: {shape: box, size: [8, 0.4, 8], position: [0, 1.8, 0], rotation: [30, 0, 20], transparency: 1, "
         "ior: 1.5}\n",
         {1.0, 6.0, -2.0},
         1e-3},
        {"pool",
         "  water: {shape: box, size: [40, 1, 40], position: [0, 0.5, 0], transparency: 1, ior: 1.33, priority: 1}\n",
         {1.0, 4.0, -2.0},
         1e-3},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        scene *s = scene_of("fov_deg: 40", "kind: pencil, angle_deg: 0", cases[k].solids);
        set_all(s, "floor.priority=2 render.width=96 render.height=72");
        s->camera.position = vec3_make(cases[k].eye[0], cases[k].eye[1], cases[k].eye[2]);
        for (int i = 0; i < trials_of(10); i++) {
            const vec3 at = vec3_make(draw(-0.05, 0.05), 0.0, draw(-0.05, 0.05));
            s->beams[0].position = vec3_add(at, vec3_make(0.9, 0.9, 0.2));
            s->beams[0].target = at;
            assert_like_64_samples(s, cases[k].tolerance, cases[k].name);
        }
        scene_destroy(s);
    }
}

/* The focus of a burning glass, with all the light that the lens gathers. */
static void a_focus_keeps_its_power(void **state)
{
    (void)state;
    scene *s = scene_of(
        "position: [3, 3, -2]", "kind: bundle, width: 0.8",
        "  glass: {shape: lens, diameter: 1, thickness: 0.2, radius_1: 2, radius_2: -2, position: [0, 2.1, 0], "
        "transparency: 1, ior: 1.5}\n");
    for (int i = 0; i < trials_of(40); i++) {
        const vec3 at = vec3_make(draw(-0.02, 0.02), 0.0, draw(-0.02, 0.02));
        s->beams[0].position = vec3_add(at, vec3_make(0.0, 4.0, 0.0));
        s->beams[0].target = at;
        s->render.photons = 20000;
        assert_like_64_samples(s, 2e-3, "focus");
    }
    scene_destroy(s);
}

/* In round mirrors a whole room is a few pixels wide, and the dot far narrower than one. Differentials are of first
 * order there, so that two neighbours can both miss a dot between them, unless its density is blurred. */
static void a_dot_in_a_round_surface_keeps_its_power(void **state)
{
    (void)state;
    static const struct {
        const char *name, *solids;
        double eye[3], target[3]; /* the dot itself is not in view */
    } cases[] = {
        {"mirror ball",
         "  ball: {shape: sphere, radius: 1, position: [0, 1.2, 4], reflectivity: 1}\n",
         {0.3, 3.0, -5.0},
         {0.0, 1.2, 4.0}},
        {"mirror rod",
         "  rod: {shape: cylinder, radius: 0.5, height: 3, position: [0, 0.01, 4], reflectivity: 1}\n",
         {0.3, 3.0, -5.0},
         {0.0, 1.5, 4.0}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        scene *s = scene_of("fov_deg: 18", "kind: pencil, angle_deg: 0", cases[k].solids);
        s->camera.position = vec3_make(cases[k].eye[0], cases[k].eye[1], cases[k].eye[2]);
        s->camera.target = vec3_make(cases[k].target[0], cases[k].target[1], cases[k].target[2]);
        for (int i = 0; i < trials_of(40); i++) {
            aim(s, vec3_make(draw(-1.0, 1.0), 0.0, draw(-0.5, 1.0)));
            assert_like_64_samples(s, 2e-2, cases[k].name);
        }
        scene_destroy(s);
    }
}

/* --- the notes --- */

static void keep_note(void *context, const scene_note *note)
{
    note_line(note, context, NOTE_LINE_MAX);
}

/* Fails if the note on a frame does not contain the text; NULL: if there is one. */
static void assert_note(scene *s, const char *text)
{
    char line[NOTE_LINE_MAX] = "";
    job *j;
    job_account made;
    diagnostic why;
    assert_int_equal(job_create(&(job_settings){.measured = true}, &j, NULL), STATUS_OK);
    assert_int_equal(job_load(j, s, NULL, NULL), STATUS_OK);
    assert_int_equal(job_render(j, s, &(render_options){.usage = true}, &made, &why), STATUS_OK);
    frame_notes(&made, &(note_sink){keep_note, line});
    json_t *page = report_image_numbers(&made), *notes = json_object_get(page, "notes");
    assert_int_equal(json_array_size(notes), line[0] ? 1 : 0);
    const char *told = json_string_value(json_object_get(json_array_get(notes, 0), "text"));
    assert_true(!line[0] || strstr(line, told));
    json_decref(page);
    job_account_release(&made);
    job_destroy(j);
    if (text ? !strstr(line, text) : line[0] != 0)
        fail_msg("'%s' instead of '%s'", line, text ? text : "");
}

/* Through a crystal the footprint is guessed. The narrowest disc has a radius of half a pixel, at a slope a little
 * less: 2.5 cells at 36 samples, not at 25. */
static void a_note_tells_how_many_samples_suffice(void **state)
{
    (void)state;
    need_counters();
    scene *s = scene_of("position: [0.2, 5, -0.3]", "kind: pencil, angle_deg: 0",
                        "  plate: {shape: box, size: [8, 0.2, 8], position: [0, 1.6, 0], transparency: 1, "
                        "ior: 1.6584, extraordinary_ior: 1.4864}\n");
    aim(s, vec3_make(0.01, 0.0, 0.02));
    assert_note(s, "render.samples: ");
    assert_note(s, "set render.samples=36");
    set(s, "render.samples=36");
    assert_note(s, NULL);
    set_all(s, "render.samples=1 plate.extraordinary_ior=0");
    assert_note(s, NULL); /* known */
    set_all(s, "plate.extraordinary_ior=1.4864 laser.kind=bundle laser.width=2");
    assert_note(s, NULL); /* wide */
    set_all(s, "laser.kind=pencil render.integrator=path");
    assert_note(s, NULL); /* random points */
    scene_destroy(s);
}

/* A ball shows the dot with its rim too, where the image turns faster than to first order. */
static void a_note_tells_of_light_behind_round_surfaces(void **state)
{
    (void)state;
    need_counters();
    scene *s = scene_of("position: [1.1, 3, -4], fov_deg: 18", "kind: pencil, angle_deg: 0",
                        "  ball: {shape: sphere, radius: 0.4, position: [0.55, 1.5, -2], transparency: 1, ior: 1.5}\n");
    s->camera.target = vec3_make(0.55, 1.5, -2.0);
    assert_note(s, "narrower than a pixel, behind surfaces where it may be missed");
    scene_destroy(s);
}

/* A made-up account, since a frame with the most photons takes minutes: no remedy sets what is set. */
static void a_note_has_no_remedy_at_the_most_photons(void **state)
{
    (void)state;
    char line[NOTE_LINE_MAX] = "";
    scene *s = scene_from("solids: {bead: {shape: sphere}}");
    render_result result = {.few = {.solid = 0, .arrived = 10, .enough = 1000000000}};
    const job_account made = {.of = s, .result = &result, .count = 1};
    s->render.photons = 67108863;
    frame_notes(&made, &(note_sink){keep_note, line});
    assert_non_null(strstr(line, "; set render.photons=67108864"));
    s->render.photons = 67108864;
    line[0] = '\0';
    frame_notes(&made, &(note_sink){keep_note, line});
    assert_non_null(strstr(line, "rests on only 10 photons"));
    assert_null(strstr(line, "set render.photons"));
    scene_destroy(s);
}

/* A lamp shines on a large ball and on a tiny bead far away, which gets the photons that are its share of the light.
 * The remedy's number does; a tenth of it rests on about 100. */
static void a_note_tells_how_many_photons_would_do(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 24, height: 18, depth: 4, caustics: photons, photons: 2000}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                          "camera: {position: [0, 4, -6], target: [0, 0, 0]}\n"
                          "lights: {lamp: {kind: point, position: [0, 4, 0]}}\n"
                          "solids:\n"
                          "  floor: {shape: plane, diffuse: 1}\n"
                          "  ball: {shape: sphere, radius: 0.5, position: [0, 1, 0], transparency: 1, ior: 1.5}\n"
                          "  bead: {shape: sphere, radius: 0.1, position: [3, 1, 0], transparency: 1, ior: 1.5}\n");
    assert_note(s, "render.photons: the light that 'bead' throws on matte surfaces rests on only ");
    int64_t enough = 0;
    render_result *r = render(s);
    assert_int_equal(r->few.solid, 2);
    enough = r->few.enough;
    assert_int_equal(enough, (2000 * 1000 + r->few.arrived - 1) / r->few.arrived);
    render_result_destroy(r);
    s->render.photons = enough + enough / 10; /* the number from a few photons is itself uncertain, by a twentieth */
    assert_note(s, NULL);
    s->render.photons = enough / 10;
    assert_note(s, "'bead'");
    set(s, "render.caustics=off");
    assert_note(s, NULL);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dot_keeps_its_power),
        cmocka_unit_test(the_middle_of_the_image_is_no_exception),
        cmocka_unit_test(a_line_keeps_its_power),
        cmocka_unit_test(light_of_any_width_keeps_its_power),
        cmocka_unit_test(a_mirror_shows_the_dot),
        cmocka_unit_test(what_is_between_changes_nothing),
        cmocka_unit_test(a_focus_keeps_its_power),
        cmocka_unit_test(a_dot_in_a_round_surface_keeps_its_power),
        cmocka_unit_test(a_note_tells_how_many_samples_suffice),
        cmocka_unit_test(a_note_tells_of_light_behind_round_surfaces),
        cmocka_unit_test(a_note_has_no_remedy_at_the_most_photons),
        cmocka_unit_test(a_note_tells_how_many_photons_would_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
