/* Tests of light that is cut: the share of it in the account and in the map, against closed forms; ten scenes that are
 * wrong because light was cut have a note with a remedy that helps, and no shipped scene that lacks less than 1 % has
 * one. Run from the repository root. */
#include <dirent.h>
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "job/job.h"
#include "job/quantities.h"
#include "law_judge.h"
#include "lint/lint.h"
#include "lint/probe_images.h"
#include "scene/model/scene.h"

/* --- the share, in the account and in the map --- */

static render_result *with_map(const scene *s)
{
    renderer *r = NULL;
    render_result *result = NULL;
    diagnostic why = {0};
    worked(renderer_create(isa_best(), NULL, &r, &why), &why);
    worked(renderer_render(r, s, &(render_options){.pixel_cut = true}, &result, &why), &why);
    renderer_destroy(r);
    return result;
}

static quantity_value value_of(const char *name, const scene *s, const render_result *r)
{
    const job_account a = {.of = s, .result = (render_result *)(uintptr_t)r, .level = isa_best(), .complete = true};
    return frame_quantity(name)->read(&a, -1);
}

/* Between parallel mirrors of reflectance r, at a depth limit of D, each ray is cut with the throughput r^(D + 1). */
static void between_mirrors_the_share_is_a_power_of_the_reflectance(void **state)
{
    (void)state;
    need_counters();
    for (int depth = 0; depth <= 64; depth += 16) {
        char text[700];
        snprintf(text, sizeof text,
                 "render: {width: 6, height: 4, depth: %d, samples: 4, beyond: black}\n"
                 "camera: {position: [0, 0, 0], target: [0, 1, 0.05], fov_deg: 20}\n"
                 "solids:\n"
                 "  low: {shape: plane, reflectivity: 0.9, diffuse: 0, ambient: 0, position: [0, -1, 0]}\n"
                 "  high: {shape: plane, reflectivity: 0.9, diffuse: 0, ambient: 0, position: [0, 1, 0], rotation: "
                 "[180, 0, 0]}\n",
                 depth);
        scene *s = scene_from(text);
        render_result *r = with_map(s);
        const double expected = pow(0.9, depth + 1);
        assert_true(fabs(value_of("cut_fraction", s, r).real[0] - expected) < 1e-9);
        assert_true(fabs(value_of("cut_fraction_largest", s, r).real[0] - expected) < 1e-9);
        for (int i = 0; i < 24; i++)
            assert_true(fabs(r->pixel_cut[i] - expected) < 1e-9);
        render_result_destroy(r);
        scene_destroy(s);
    }
}

/* In a white furnace without losses each pixel is 1: with a black depth limit the film lacks what the map has. */
static void in_a_furnace_the_film_lacks_what_the_map_has(void **state)
{
    (void)state;
    static const char *const scenes[] = {
        "  ball: {shape: sphere, transparency: 1, ior: 1.5}\n  pane: {shape: box, size: [3, 3, 0.1], position: [0, 0, "
        "2], "
        "transparency: 1, ior: 1.7}\n",
        "  ball: {shape: sphere, transparency: 1, ior: 1.5, film_thickness_nm: 400, film_ior: 1.38}\n",
        "  ball: {shape: sphere, transparency: 1, ior: 1.65, extraordinary_ior: 1.48, optic_axis: [0, 1, 0]}\n",
    };
    static const char *const settings[] = {
        "render.depth=1", "render.depth=3 render.samples=4", "render.depth=6 render.min_weight=0.05",
        "render.depth=6 render.min_weight=0.05 render.polarisation=on", "render.depth=2 render.polarisation=on"};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
            char text[900];
            snprintf(text, sizeof text,
                     "render: {width: 24, height: 16, beyond: black}\nbackground: {color: [1, 1, 1]}\n"
                     "camera: {position: [0, 0, -4], target: [0.3, 0, 0]}\nsolids:\n%s",
                     scenes[i]);
            if (strstr(text, "film") && strstr(settings[k], "polarisation"))
                continue; /* refused without a spectrum */
            scene *s = scene_from(text);
            set_all(s, settings[k]);
            render_result *r = with_map(s);
            double worst = 0.0;
            for (int p = 0; p < 24 * 16; p++) {
                double mean = 0.0;
                for (int c = 0; c < 3; c++)
                    mean += film_value(r->img, p % 24, p / 24, c) / 3.0;
                worst = fmax(worst, fabs(1.0 - mean - r->pixel_cut[p]));
            }
            if (!(worst < 1e-6))
                fail_msg("%s, %s: %g", scenes[i], settings[k], worst);
            render_result_destroy(r);
            scene_destroy(s);
        }
}

/* One pass renders the images of all depth limits: the same light and the same cut throughput, bit by bit, as one pass
 * for each limit. */
static void one_pass_has_the_images_of_all_depth_limits(void **state)
{
    (void)state;
    enum { LIMIT = 5 };
    static const char *const changes[] = {
        "render.depth=5",
        "render.min_weight=0.05",
        "render.beyond=black",
        "render.beyond=mean background.kind=gradient",
        "render.transmission=simple render.weights=constant",
        "rod.transparency=1 rod.ior=1.65 rod.extraordinary_ior=1.48 rod.optic_axis=0,1,0",
        "rod.ior=0.2 rod.extinction=3",
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        scene *s = rod_scene("render.width=40 render.height=30");
        set_all(s, changes[i]);
        diagnostic why = {0};
        plan *made = NULL;
        probe_images images;
        probe_image levels[LIMIT + 1] = {{.rgb = NULL}}, one = {.rgb = NULL};
        double rays[LIMIT + 1], all = 0.0;
        worked(plan_build(s, &made, &why), &why);
        assert_true(probe_images_begin(&images, made, isa_best()));
        worked(probe_images_render_levels(&images, LIMIT, levels, rays, &why), &why);
        for (int d = 0; d <= LIMIT; d++) {
            const double before = images.spent;
            worked(probe_images_render(&images, d, &one, &why), &why);
            const size_t pixels = probe_pixels(&images);
            all += rays[d];
            if (memcmp(one.rgb, levels[d].rgb, 3 * pixels * sizeof *one.rgb) != 0)
                fail_msg("%s: the images with a depth of %d differ", changes[i], d);
            assert_true(fabs(lack_cut(pixels, &one) - lack_cut(pixels, &levels[d])) < 1e-6);
            assert_true(fabs(one.by_weight - levels[d].by_weight) < 1e-9);
            assert_true(images.spent - before == all);
        }
        probe_image_free(&one);
        for (int d = 0; d <= LIMIT; d++)
            probe_image_free(&levels[d]);
        probe_images_end(&images);
        plan_destroy(made);
        scene_destroy(s);
    }
}

/* The map's sum is that of the counters, for every integrator that cuts, and the same for any number of threads. */
static void the_map_adds_up_to_the_share(void **state)
{
    (void)state;
    need_counters();
    static const char *const settings[] = {
        "render.depth=2",
        "render.depth=3 render.samples=16 render.min_weight=0.02",
        "render.depth=3 render.integrator=path render.paths=8",
        "render.depth=6 render.integrator=path render.paths=8 render.roulette=on",
        "render.depth=3 render.integrator=path render.paths=64 render.error=0.05",
        "render.depth=2 render.spectrum=spectral render.wavelengths=8",
        "render.depth=2 render.polarisation=on camera.analyser=linear",
    };
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        render_result *r[2];
        double share = 0.0;
        for (int k = 0; k < 2; k++) {
            scene *s = rod_scene("render.width=80 render.height=60");
            set_all(s, settings[i]);
            set_all(s, k ? "render.threads=3 render.tile=8" : "render.threads=1");
            r[k] = with_map(s);
            share = value_of("cut_fraction", s, r[k]).real[0];
            scene_destroy(s);
        }
        double sum = 0.0;
        for (int p = 0; p < 80 * 60; p++) {
            sum += r[0]->pixel_cut[p] / (80 * 60);
            assert_true(r[0]->pixel_cut[p] == r[1]->pixel_cut[p]);
        }
        assert_true(share > 0.001);
        /* under render.error the map leaves the pilot out, whose paths are others */
        const double tolerance = strstr(settings[i], "error") ? 0.1 * share : 1e-12;
        if (!(fabs(sum - share) <= tolerance))
            fail_msg("%s: %.15g of the map, %.15g of the counters", settings[i], sum, share);
        render_result_destroy(r[0]);
        render_result_destroy(r[1]);
    }
}

/* --- notes --- */

typedef struct note_list {
    int count;
    scene_note note[16];
} note_list;

static void keep_note(void *context, const scene_note *note)
{
    note_list *all = context;
    if (strncmp(note->place, "render.", 7) == 0 && all->count < 16)
        all->note[all->count++] = *note;
}

static note_list lint(const scene *s)
{
    note_list all = {.count = 0};
    diagnostic why = {0};
    worked(lint_scene(s, isa_best(), &(note_sink){keep_note, &all}, &why), &why);
    return all;
}

#define PATHS_WITHOUT_LIMIT "set render.integrator=path and render.depth=unlimited"
#define NO_LIMIT "set render.depth=unlimited"
#define VIEW "render: {width: 48, height: 36}\n"

/* Infinite mirrors above and below, and a red end far away. */
#define MIRRORS(reflectivity)                                                                                 \
    VIEW "background: {color: [1, 1, 1]}\ncamera: {position: [0, 0, 0], target: [0, 1, 0.05], fov_deg: 30}\n" \
         "solids:\n  a: {shape: plane, diffuse: 0, reflectivity: " reflectivity ", position: [0, -1, 0]}\n"   \
         "  b: {shape: plane, diffuse: 0, reflectivity: " reflectivity                                        \
         ", position: [0, 1, 0], rotation: [180, 0, 0]}\n"                                                    \
         "  end: {shape: box, size: [200, 2, 1], position: [0, 0, 60], color: [1, 0, 0], emission: 1}\n"

/* A cavity: a room in a block. */
#define ROOM(wall)                                                                                        \
    VIEW "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"                                           \
         "camera: {position: [0, -0.5, 0.1], target: [0, -1, 0.2], fov_deg: 60}\n"                        \
         "lights: {lamp: {position: [0, 0.2, 0], radius: 0.05, reach: 1}}\nsolids:\n"                     \
         "  block: {shape: box, size: [10, 10, 10], color: [" wall ", " wall ", " wall "], diffuse: 1}\n" \
         "  room: {shape: sphere, radius: 1, transparency: 1, ior: 1, priority: 1}\n"

#define BALLS                                                                                                \
    VIEW "background: {kind: gradient, color: [0.1, 0.1, 0.1], horizon: [1, 1, 1]}\n"                        \
         "camera: {position: [0, 0, -6], target: [0, 0, 0], fov_deg: 30}\nsolids:\n"                         \
         "  p: {shape: sphere, transparency: 1, ior: 1.5}\n  q: {shape: sphere, transparency: 1, ior: 1.5, " \
         "position: [0, 0, 3]}\n  r: {shape: sphere, transparency: 1, ior: 1.5, position: [0, 0, 6]}\n"

/* depth: of the remedy, at least and at most; 0: it is words */
static const struct wrong_scene {
    const char *name, *text, *settings, *place, *remedy;
    int least, most;
} wrong[] = {
    {"lossless mirrors", MIRRORS("1"), "render.depth=4", "render.depth", PATHS_WITHOUT_LIMIT, 0, 0},
    {"lossless mirrors, deep", MIRRORS("1"), "render.depth=64", "render.depth", PATHS_WITHOUT_LIMIT, 0, 0},
    {"mirrors of 0.97", MIRRORS("0.97"), "render.depth=16", "render.depth", PATHS_WITHOUT_LIMIT, 0, 0},
    {"mirrors of 0.8", MIRRORS("0.8"), "render.depth=8", "render.depth", NULL, 15, 45},
    {"mirrors with a black limit", MIRRORS("1"), "render.depth=12 render.beyond=black", "render.depth",
     PATHS_WITHOUT_LIMIT, 0, 0},
    {"integrating sphere of 0.99", ROOM("0.99"), "render.integrator=path render.depth=64", "render.depth", NO_LIMIT, 0,
     0},
    {"integrating sphere of 0.7", ROOM("0.7"), "render.integrator=path render.depth=4", "render.depth", NULL, 10, 40},
    {"milk of thickness 30",
     VIEW "background: {kind: cie, sky_type: 5, color: [1, 1, 1], horizon: [0, 0, 0]}\n"
          "camera: {position: [0, -60, 0.001], target: [0, -1, 0], projection: orthographic, view_height: 0.001}\n"
          "solids:\n  milk: {shape: box, size: [4000, 1, 4000], position: [0, -0.5, 0], transparency: 1, ior: 1, "
          "scatter_per_m: 30}\n",
     "render.integrator=path render.depth=64 render.beyond=black", "render.depth", NO_LIMIT, 0, 0},
    {"three balls of glass", BALLS, "render.depth=2", "render.depth", NULL, 4, 12},
    {"three balls of glass, faint rays cut", BALLS, "render.depth=12 render.min_weight=0.5", "render.min_weight",
     "set render.min_weight=0", 0, 0},
};

static const scene_note *noted_at(const note_list *all, const char *place)
{
    for (int i = 0; i < all->count; i++)
        if (strcmp(all->note[i].place, place) == 0)
            return &all->note[i];
    return NULL;
}

/* Where the remedy is a value, the note is gone with it. */
static void scenes_that_are_wrong_because_light_was_cut_have_a_note(void **state)
{
    (void)state;
    need_counters();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const struct wrong_scene *w = &wrong[i];
        scene *s = scene_from(w->text);
        set_all(s, w->settings);
        const note_list all = lint(s);
        const scene_note *note = noted_at(&all, w->place);
        if (!note)
            fail_msg("%s: no note", w->name);
        print_message("%s: %s: %s; %s\n", w->name, note->place, note->text, note->remedy);
        if (w->remedy)
            assert_string_equal(note->remedy, w->remedy);
        int depth = 0;
        if (sscanf(note->remedy, "set render.depth=%d", &depth) == 1) {
            assert_in_range(depth, w->least, w->most);
            s->render.depth = depth;
        } else if (strcmp(note->remedy, "set render.min_weight=0") == 0)
            s->render.min_weight = 0.0;
        const note_list after = lint(s);
        if (strstr(note->remedy, "unlimited") == NULL && noted_at(&after, w->place))
            fail_msg("%s: after %s: %s; %s", w->name, note->remedy, after.note[0].text, after.note[0].remedy);
        scene_destroy(s);
    }
}

/* T(d) = q^(d + 1): q, and the least depth with T(d) / L <= 1 %, in closed form. */
static void the_depth_of_a_remedy_is_that_of_a_geometric_series(void **state)
{
    (void)state;
    for (int percent = 10; percent < 100; percent += 5) {
        const double q = percent / 100.0, radiance = 0.4;
        for (int depth = 2; depth < 12; depth++) {
            const double decay = lack_decay(pow(q, depth - 1), pow(q, depth + 1), 2);
            assert_true(fabs(decay - q) < 1e-12);
            int least = depth;
            while (pow(q, least + 1) / radiance > 0.01)
                least++;
            assert_int_equal(lack_depth_enough(depth, pow(q, depth + 1) / radiance, decay), least);
        }
    }
    assert_int_equal(lack_depth_enough(7, 0.5, lack_decay(0.5, 0.5, 2)), INT_MAX);
    assert_int_equal(lack_depth_enough(7, 0.5, (double)NAN), 14);
}

/* --- shipped scenes --- */

/* The change of the image's light by a greater depth; *cut: the share that its own cuts. */
static double lost_light(const scene *s, int deeper, double *cut)
{
    judge j = judge_open();
    scene *copy = scene_clone(s);
    render_settings *r = &copy->render;
    const double smaller = fmax((double)r->width, (double)r->height) / 64.0;
    r->width = (int64_t)((double)r->width / smaller), r->height = (int64_t)((double)r->height / smaller);
    r->samples = 1;
    r->paths = r->paths < 16 ? r->paths : 16;
    r->error = 0.0;
    render_result *here = law_render(&j, copy);
    *cut = value_of("cut_fraction", copy, here).real[0];
    r->depth += deeper;
    render_result *there = law_render(&j, copy);
    double moved = 0.0, whole = 0.0;
    for (int i = 0; i < 3 * (int)(r->width * r->height); i++) {
        const int x = i / 3 % (int)r->width, y = i / 3 / (int)r->width;
        const double deep = fmin(1.0, film_value(there->img, x, y, i % 3));
        moved += fabs(deep - fmin(1.0, film_value(here->img, x, y, i % 3)));
        whole += deep;
    }
    render_result_destroy(here);
    render_result_destroy(there);
    scene_destroy(copy);
    judge_close(&j);
    return moved / whole;
}

static void shipped_scenes_that_lack_little_light_have_no_note(void **state)
{
    (void)state;
    static const char folder[] = "experiments/scenes";
    DIR *scenes = opendir(folder);
    int noted = 0, silent = 0;
    assert_non_null(scenes);
    for (struct dirent *entry; (entry = readdir(scenes));) {
        char path[400];
        scene *s = NULL;
        diagnostic why = {0};
        if (!strstr(entry->d_name, ".yaml"))
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        worked(scene_read(path, &s, &why), &why);
        worked(scene_load(s, &why), &why);
        const note_list all = lint(s);
        if (all.count > 0) {
            double cut;
            const double lost = lost_light(s, 4, &cut);
            print_message("%s cuts %.2g %%, changes by %.2g %% with 4 levels more: %s: %s; %s\n", entry->d_name,
                          100.0 * cut, 100.0 * lost, all.note[0].place, all.note[0].text, all.note[0].remedy);
            assert_true(cut > 0.01 && lost > 0.01);
        }
        noted += all.count > 0;
        silent += all.count == 0;
        scene_destroy(s);
    }
    closedir(scenes);
    assert_true(noted > 0 && silent > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(between_mirrors_the_share_is_a_power_of_the_reflectance),
        cmocka_unit_test(in_a_furnace_the_film_lacks_what_the_map_has),
        cmocka_unit_test(one_pass_has_the_images_of_all_depth_limits),
        cmocka_unit_test(the_map_adds_up_to_the_share),
        cmocka_unit_test(scenes_that_are_wrong_because_light_was_cut_have_a_note),
        cmocka_unit_test(the_depth_of_a_remedy_is_that_of_a_geometric_series),
        cmocka_unit_test(shipped_scenes_that_lack_little_light_have_no_note),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
