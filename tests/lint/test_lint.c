/* Tests of the linter: each note is given at its mistake and not in the nearest valid scene; shipped scenes have only
 * true notes; on random legal scenes every note is true by an independent check (lint_oracle.h). LINT_SCENES, LINT_SEED
 * and LINT_FIRST select how many scenes and which. Run from the repository root. notes.sh has ten scenes as a
 * student would write them. */
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "law_judge.h"
#include "lint/lint.h"
#include "lint_oracle.h"
#include "scene/model/scene.h"

enum { NOTES_MAX = 64 };

typedef struct note_list {
    int count;
    scene_note note[NOTES_MAX];
} note_list;

static void keep_note(void *context, const scene_note *note)
{
    note_list *all = context;
    assert_true(all->count < NOTES_MAX && note->text[0] && note->place[0] && note->remedy[0]);
    all->note[all->count++] = *note;
}

static note_list lint(const scene *s)
{
    note_list all = {.count = 0};
    diagnostic why = {0};
    worked(lint_scene(s, isa_best(), &(note_sink){keep_note, &all}, &why), &why);
    return all;
}

static note_list lint_text(const char *text)
{
    scene *s = scene_from(text);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    const note_list all = lint(s);
    scene_destroy(s);
    return all;
}

#define STAGE                                                                            \
    "render: {width: 64, height: 48, depth: 12}\nbackground: {color: [0.5, 0.7, 0.9]}\n" \
    "lights: {lamp: {position: [4, 7, -5]}}\n"                                           \
    "materials: {glass: {transparency: 1, ior: 1.5}, water: {transparency: 1, ior: 1.33}, clay: {diffuse: 0.8}}\n"

#define ROOM                                                    \
    STAGE "camera: {position: [0, 1, -8], target: [0, 1, 0]}\n" \
          "meshes: {block: {generate: box, size: [1, 1, 1]}, ball: {generate: icosphere, level: 3}}\n"

/* For scenes with their own cameras. */
#define HALL STAGE "meshes: {block: {generate: box, size: [2, 2, 2]}}\n"

typedef struct lint_case {
    const char *scene, *place, *words; /* place NULL: no note */
} lint_case;

static void try_cases(const lint_case *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char text[2000];
        snprintf(text, sizeof text, ROOM "%s\n", cases[i].scene);
        const note_list all = lint_text(text);
        const bool right = cases[i].place ? all.count == 1 && strcmp(all.note[0].place, cases[i].place) == 0 &&
                                                strstr(all.note[0].text, cases[i].words)
                                          : all.count == 0;
        if (!right)
            fail_msg("%s\n%d notes, wanted: %s\n%s: %s", cases[i].scene, all.count,
                     cases[i].place ? cases[i].place : "none", all.count ? all.note[0].place : "",
                     all.count ? all.note[0].text : "");
    }
}
#define CHECK(cases) try_cases(cases, sizeof cases / sizeof *cases)

static void overlaps_of_equal_priority_and_different_media_are_noted(void **state)
{
    (void)state;
    static const char note[] = "overlap with equal priority and different media";
    static const lint_case cases[] = {
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: water, position: [0.9, 0, 0]}}",
         "b.priority", note},
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: water, position: [0.9, 0, 0], "
         "priority: 1}}",
         NULL, ""},
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: water, position: [1, 0, 0]}}", NULL,
         ""}, /* the boxes touch */
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: glass, position: [0.9, 0, 0]}}", NULL,
         ""}, /* equal media */
        {"solids: {a: {shape: box, material: clay}, b: {shape: box, material: clay, position: [0.9, 0, 0], color: "
         "[1, 0, 0]}}",
         NULL, ""},
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: clay, position: [0.9, 0, 0]}}",
         "b.priority", note},
        {"solids: {a: {shape: sphere, material: glass}, b: {shape: cylinder, material: water, radius: 0.3, height: "
         "3, rotation: [20, 0, 40]}}",
         "b.priority", note},
        {"solids: {a: {shape: sphere, material: glass}, b: {shape: sphere, material: water, position: [0, 2, 0]}}",
         NULL, ""}, /* the spheres touch */
        {"solids: {a: {shape: mesh, mesh: block, material: glass}, b: {shape: sphere, material: water, position: "
         "[1.2, 0, 0]}}",
         "b.priority", note},
        {"solids: {a: {shape: mesh, mesh: block, material: glass}, b: {shape: sphere, material: water, position: "
         "[1.5, 0, 0]}}",
         NULL, ""},
        {"solids: {a: {shape: mesh, mesh: block, material: glass}, b: {shape: mesh, mesh: ball, material: water, "
         "position: [1.2, 0.3, 0]}}",
         "b.priority", note},
        {"solids: {a: {shape: plane, material: water}, b: {shape: sphere, material: glass}}", "b.priority", note},
        {"solids: {a: {shape: plane, material: clay}, b: {shape: sphere, material: glass, position: [0, 1, 0]}}", NULL,
         ""},
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: glass, position: [0.9, 0, 0], "
         "absorb_per_m: [1, 0, 0]}}",
         "b.priority", note},
        {"solids: {a: {shape: cup, material: glass, radius: 1, inner_radius: 0.9, height: 2, floor: 0.1}, "
         "b: {shape: cylinder, material: water, radius: 0.9, height: 1.5, position: [0, 0.1, 0]}}",
         NULL, ""}, /* in contact all around */
    };
    CHECK(cases);
}

static void narrow_gaps_are_noted(void **state)
{
    (void)state;
    static const char note[] = "is about";
    static const lint_case cases[] = {
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: water, position: [1.0001, 0, 0]}}", "b",
         note},
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: water, position: [1.0011, 0, 0]}}", NULL,
         ""}, /* wide enough */
        {"solids: {a: {shape: box, material: glass}, b: {shape: box, material: water, position: [1, 0, 0]}}", NULL,
         ""}, /* the boxes are in contact */
        {"solids: {a: {shape: box, material: clay}, b: {shape: box, material: clay, position: [1.0001, 0, 0]}}", NULL,
         ""}, /* both sides are opaque */
        {"solids: {a: {shape: plane, material: clay}, b: {shape: box, material: glass, position: [0, 0.5001, 0]}}", "b",
         note},
        {"solids: {a: {shape: plane, material: clay}, b: {shape: sphere, material: glass, position: [0, 1.0001, 0]}}",
         NULL, ""}, /* narrow at a single point only */
        {"solids: {a: {shape: plane, material: clay}, b: {shape: cylinder, material: glass, position: [1, 1.0001, "
         "0], rotation: [0, 0, 90]}}",
         NULL, ""},
        {"solids: {a: {shape: cup, material: glass, radius: 1, inner_radius: 0.9, height: 2, floor: 0.1}, "
         "b: {shape: cylinder, material: water, radius: 0.9, height: 1.5, position: [0, 0.10005, 0]}}",
         "b", note},
        {"solids: {a: {shape: cup, material: glass, radius: 1, inner_radius: 0.9, height: 2, floor: 0.1}, "
         "b: {shape: cylinder, material: water, radius: 0.89995, height: 1.5, position: [0, 0.1, 0]}}",
         "b", note},
        {"solids: {a: {shape: cup, material: glass, radius: 1, inner_radius: 0.9, height: 2, floor: 0.1}, "
         "b: {shape: cylinder, material: water, radius: 0.8995, height: 1.5, position: [0, 0.1005, 0]}}",
         NULL, ""},
        {"solids: {a: {shape: mesh, mesh: block, material: glass}, b: {shape: box, material: water, position: [0, "
         "1.0001, 0]}}",
         "b", note},
        {"solids: {a: {shape: mesh, mesh: block, material: glass}, b: {shape: box, material: water, position: [0, "
         "1, 0]}}",
         NULL, ""},
        /* a third solid fills the gap */
        {"solids: {a: {shape: box, material: glass, priority: 1}, b: {shape: box, material: water, position: "
         "[1.0001, 0, 0], priority: 1}, "
         "c: {shape: box, material: clay, position: [0.5, 0, 0], size: [0.5, 3, 3]}}",
         NULL, ""},
    };
    CHECK(cases);
}

static void indices_above_those_of_materials_are_noted(void **state)
{
    (void)state;
    static const char note[] = "higher than any transparent material";
    static const lint_case cases[] = {
        {"solids: {a: {shape: sphere, material: glass, ior: 5.1}}", "a.ior", note},
        {"solids: {a: {shape: sphere, material: glass, ior: 4.9}}", NULL, ""},
        {"solids: {a: {shape: sphere, material: glass, ior: 20000}}", NULL, ""}, /* a mirror, by definition */
        {"solids: {a: {shape: sphere, material: clay, ior: 50}}", "a.ior", note},
        {"solids: {a: {shape: sphere, material: clay, ior: 50, reflectivity: 0.8}}", "a.ior",
         "has a refractive index but is opaque"},
        {"solids: {a: {shape: sphere, material: clay, ior: 1.5}}", "a.ior", "has a refractive index but is opaque"},
        {"solids: {a: {shape: sphere, material: clay, reflectivity: 0.8}}", NULL, ""},
    };
    CHECK(cases);
}

static void cameras_inside_opaque_solids_are_noted(void **state)
{
    (void)state;
    static const struct {
        const char *eye, *solids, *words;
    } cases[] = {
        {"0, 1, 0", "a: {shape: box, material: clay, size: [4, 4, 4]}", "is inside a, which is opaque"},
        {"0, 1, -3", "a: {shape: box, material: clay, size: [4, 4, 4]}", NULL},
        {"0, 1, 0", "a: {shape: box, material: water, size: [4, 4, 4]}", NULL}, /* a camera under water is legal */
        {"0, 1, 0",
         "a: {shape: box, material: clay, size: [4, 4, 4]}, b: {shape: sphere, material: glass, radius: 1.5, "
         "priority: 1}",
         NULL},
        {"0, -1, -3", "a: {shape: plane, material: clay}", "is below the surface of a"},
        {"0, 0, -3", "a: {shape: plane, material: clay}, b: {shape: sphere, material: clay, position: [0, 1, 0]}",
         NULL}, /* exactly on the surface */
        {"0, -1, -3", "a: {shape: plane, material: water}", NULL},
        {"0.95, 1, 0", "a: {shape: cup, material: glass, radius: 1, inner_radius: 0.9, height: 2, floor: 0.1}",
         "is inside the wall of a"},
        {"0.8, 1, 0", "a: {shape: cup, material: glass, radius: 1, inner_radius: 0.9, height: 2, floor: 0.1}", NULL},
        {"0.1, 0.2, 0", "a: {shape: mesh, mesh: block, material: clay}", "is inside a, which is opaque"},
        {"0.1, 0.2, 0",
         "a: {shape: mesh, mesh: block, material: clay, visible: off}, b: {shape: sphere, material: clay, position: "
         "[0, 0, 9]}",
         NULL},
        {"0.1, 0.2, -1.1", "a: {shape: mesh, mesh: block, material: clay}", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[2000];
        snprintf(text, sizeof text, HALL "camera: {position: [%s], target: [0.3, 0.9, 9]}\nsolids: {%s}\n",
                 cases[i].eye, cases[i].solids);
        const note_list all = lint_text(text);
        int found = 0;
        for (int k = 0; k < all.count; k++)
            found += strcmp(all.note[k].place, "camera.position") == 0 &&
                     (!cases[i].words || strstr(all.note[k].text, cases[i].words));
        if (found != (cases[i].words != NULL))
            fail_msg("%s, eye %s: %d", cases[i].solids, cases[i].eye, found);
    }
}

/* Two panes before a board: a straight ray needs a depth of 4, at which 3.65 % of the throughput are cut, of rays that
 * two surfaces reflect and that the board would make nine times as bright as the sky does; at 5 it is 1.3 %. A smaller
 * depth gives a note, a larger one none. */
static void an_insufficient_depth_is_noted_with_the_sufficient_one(void **state)
{
    (void)state;
    for (int depth = 0; depth <= 8; depth++) {
        char text[2000];
        snprintf(
            text, sizeof text,
            "render: {width: 200, height: 150, depth: %d}\nbackground: {color: [0.1, 0.1, 0.1], ambient: [1, 1, 1]}\n"
            "camera: {position: [0, 0, -6], target: [0, 0, 0]}\nsolids:\n  p: {shape: box, transparency: 1, ior: "
            "1.5, size: [4, 4, 0.1]}\n"
            "  q: {shape: box, transparency: 1, ior: 1.5, size: [4, 4, 0.1], position: [0, 0, 1]}\n"
            "  board: {shape: box, size: [9, 9, 0.1], position: [0, 0, 4], ambient: 1}\n",
            depth);
        const note_list all = lint_text(text);
        assert_int_equal(all.count, depth < 5);
        if (depth < 5) {
            assert_string_equal(all.note[0].place, "render.depth");
            assert_string_equal(all.note[0].remedy, "set render.depth=5");
        }
    }
}

/* A tree of 40 levels has more rays than a machine traces in a day: the linter skips it and gives no note. */
static void a_depth_too_expensive_to_check_gives_no_note(void **state)
{
    (void)state;
    scene *s = rod_scene("render.depth=40");
    assert_int_equal(lint(s).count, 0);
    scene_destroy(s);
}

/* Half a mirror between mirrors: no light is lost, and whatever the depth, all of it is cut. The linter traces no rays
 * fainter than a ten-thousandth, and must not take deeper images, which lack theirs, for darker ones. */
static void light_of_faint_rays_is_not_taken_as_lost(void **state)
{
    (void)state;
    const note_list all =
        lint_text("render: {width: 4, height: 3, depth: 10, weights: constant}\n"
                  "camera: {position: [0, 0, -3], target: [0, 0, 0]}\nbackground: {color: [0.5, 0.5, 0.5]}\nsolids:\n"
                  "  front: {shape: box, size: [40, 40, 0.1], position: [0, 0, 4], reflectivity: 1}\n"
                  "  back: {shape: box, size: [40, 40, 0.1], position: [0, 0, -4], reflectivity: 1}\n"
                  "  pane: {shape: box, size: [40, 40, 1], transparency: 0.5, reflectivity: 0.5}\n");
    assert_int_equal(all.count, 1);
    assert_string_equal(all.note[0].place, "render.depth");
    assert_non_null(strstr(all.note[0].text, "could carry about "));
}

/* Regression: a wide disc protruding slightly above the ground was reported as entirely inside it. */
static void only_entirely_covered_solids_are_noted(void **state)
{
    (void)state;
    static const struct {
        const char *solid;
        bool hidden;
    } cases[] = {
        {"shape: cylinder, radius: 100, height: 1, position: [0, -0.99, 0]", false},
        {"shape: cylinder, radius: 100, height: 0.02, position: [0, 0.01, 0]", false},
        {"shape: cylinder, radius: 100, height: 1, position: [0, -1, 0]", true},
        {"shape: box, size: [100, 1, 100], position: [0, -0.4999, 0]", false},
        {"shape: box, size: [100, 1, 100], position: [0, -0.5, 0]", true},
        {"shape: sphere, position: [0, -0.999999, 0]", false},
        {"shape: sphere, position: [0, -1, 0]", true},
        {"shape: mesh, mesh: block, position: [0, -0.999, 0]", false},
        {"shape: mesh, mesh: block, position: [0, -1, 0]", true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[2000];
        snprintf(text, sizeof text,
                 HALL "camera: {position: [0, 3, -8], target: [0, 0, 0]}\n"
                      "solids: {ground: {shape: plane, material: clay}, x: {diffuse: 0.5, %s}}\n",
                 cases[i].solid);
        const note_list all = lint_text(text);
        const bool noted = all.count == 1 && strcmp(all.note[0].place, "x.priority") == 0 &&
                           strstr(all.note[0].text, "entirely inside ground");
        if (noted != cases[i].hidden || all.count > 1)
            fail_msg("%s: %d notes", cases[i].solid, all.count);
    }
}

static void shipped_scenes_have_only_true_notes(void **state)
{
    (void)state;
    static const struct {
        const char *name, *place, *remedy;
    } cases[] = {
        {"absorber", NULL, NULL},
        {"chequer", NULL, NULL},
        {"meniscus", "render.depth", "set render.depth=11"},
        {"models", NULL, NULL},
        {"plates", NULL, NULL},
        {"prism", "prism.medium", NULL}, /* extrapolated below 390 nm */
        {"rainbow", NULL, NULL},
        {"rod-from-inside", "render.depth", NULL}, /* total reflection keeps rays in the vessel */
        {"rod-leaning", "render.depth", NULL},
        {"rod", "render.depth", "set render.depth=7"},
        {"slime", NULL, NULL},
        {"shapes", NULL, NULL},
        {"solids", NULL, NULL},
        {"soup", NULL, NULL},
        {"vessel-mesh", "render.depth", "set render.depth=7"}, /* the same vessel, with fewer rays for it */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char path[100];
        snprintf(path, sizeof path, "experiments/scenes/%s.yaml", cases[i].name);
        scene *s = NULL;
        diagnostic why = {0};
        worked(scene_read(path, &s, &why), &why);
        worked(scene_load(s, &why), &why);
        const note_list all = lint(s);
        if (all.count != (cases[i].place != NULL) || (cases[i].place && strcmp(all.note[0].place, cases[i].place) != 0))
            fail_msg("%s: %d notes, %s: %s", path, all.count, all.count ? all.note[0].place : "",
                     all.count ? all.note[0].text : "");
        if (cases[i].remedy)
            assert_string_equal(all.note[0].remedy, cases[i].remedy);
        scene_destroy(s);
    }
}

static void a_frame_is_the_same_after_the_linter(void **state)
{
    (void)state;
    static const char *const paths[] = {"experiments/scenes/rod.yaml", "experiments/scenes/vessel-mesh.yaml"};
    judge j = judge_open();
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        scene *s[2];
        render_result *r[2];
        for (int k = 0; k < 2; k++) {
            diagnostic why = {0};
            worked(scene_read(paths[i], &s[k], &why), &why);
            set_all(s[k], "render.width=80 render.height=60");
            worked(scene_load(s[k], &why), &why);
            if (k == 1)
                lint(s[k]);
            r[k] = law_render(&j, s[k]);
        }
        assert_int_equal(film_hash(r[0]->img), film_hash(r[1]->img));
        assert_memory_equal(&r[0]->counters, &r[1]->counters, sizeof r[0]->counters);
        for (int k = 0; k < 2; k++) {
            render_result_destroy(r[k]);
            scene_destroy(s[k]);
        }
    }
    judge_close(&j);
}

/* --- random scenes --- */

typedef struct tallies {
    long scenes, silent, skipped, notes, untrue;
    long overlaps, gaps, covers, cameras, indices, depths, others;
    long pairs, unseen; /* pairs that overlap by the oracle, and those of them without a note */
} tallies;

static const solid *named(const scene *s, const char *name)
{
    const int index = scene_find_solid(s, name);
    return index < 0 ? NULL : &s->solids[index];
}

static double changed_share(judge *j, scene *s, int depth)
{
    render_result *r[2];
    const int64_t before = s->render.depth;
    size_t changed = 0;
    r[0] = law_render(j, s);
    s->render.depth = depth;
    r[1] = law_render(j, s);
    s->render.depth = before;
    for (int i = 0; i < (int)(s->render.width * s->render.height); i++) {
        double most = 1.0 / 255.0, apart_by = 0.0;
        for (int c = 0; c < 3; c++) {
            const int w = (int)s->render.width;
            const double a = fmin(1.0, film_value(r[0]->img, i % w, i / w, c)),
                         b = fmin(1.0, film_value(r[1]->img, i % w, i / w, c));
            most = fmax(most, fmax(a, b));
            apart_by = fmax(apart_by, fabs(a - b));
        }
        changed += apart_by > 0.05 * most;
    }
    render_result_destroy(r[0]);
    render_result_destroy(r[1]);
    return (double)changed / ((double)s->render.width * (double)s->render.height);
}

static bool depth_shows(judge *j, scene *s, int depth)
{
    const double share = changed_share(j, s, depth);
    if (!(share > 0.05))
        print_message("depth %d changes %.2f %%\n", depth, 100.0 * share);
    return share > 0.05;
}

/* What the image may lack, as a share of its light: the change by a greater depth, and what that still cuts, as bright
 * as the image in the mean. */
static double lacking_share(judge *j, scene *s, int depth)
{
    render_result *r[2];
    const int64_t before = s->render.depth;
    const int width = (int)s->render.width, pixels = width * (int)s->render.height;
    double moved = 0.0, whole = 0.0, cut = 0.0;
    r[0] = law_render(j, s);
    s->render.depth = depth;
    r[1] = law_render(j, s);
    s->render.depth = before;
    for (int i = 0; i < 3 * pixels; i++) {
        const double deep = film_value(r[1]->img, i / 3 % width, i / 3 / width, i % 3);
        moved += fabs(deep - film_value(r[0]->img, i / 3 % width, i / 3 / width, i % 3));
        whole += deep;
    }
    for (int c = 0; c < 3; c++)
        cut += (double)r[1]->counters.cut_depth_throughput[c] / (3.0 * COUNTERS_CUT_ONE * pixels);
    render_result_destroy(r[0]);
    render_result_destroy(r[1]);
    return moved / whole + cut;
}

static bool depth_lacks(judge *j, scene *s)
{
    const double share = lacking_share(j, s, (int)s->render.depth + 4);
    if (!(share > 0.01))
        print_message("depth %d lacks %.2g %%\n", (int)s->render.depth, 100.0 * share);
    return share > 0.01;
}

static bool camera_is_lost(const oracle *o, const char *text)
{
    const solid *winner = oracle_winner(o, quad3_from(o->s->camera.position));
    char name[SCENE_NAME_MAX + 1];
    if (!winner)
        return false;
    if (sscanf(text, "the camera is inside the wall of %63s", name) == 1)
        return winner == named(o->s, name) && winner->shape.kind == SHAPE_CUP && winner->surface.transparency > 0.0;
    const bool under = sscanf(text, "the camera is below the surface of %63[^,]", name) == 1;
    if (!under && sscanf(text, "the camera is inside %63[^,]", name) != 1)
        return false;
    return winner == named(o->s, name) && winner->surface.transparency == 0.0 &&
           under == (winner->shape.kind == SHAPE_PLANE);
}

static bool is_true(oracle *o, judge *j, scene *s, const scene_note *n, tallies *t)
{
    char a[SCENE_NAME_MAX + 1], b[SCENE_NAME_MAX + 1];
    int depth;
    if (sscanf(n->text, "%63s and %63s overlap", a, b) == 2 && strstr(n->text, "overlap")) {
        t->overlaps++;
        const solid *one = named(s, a), *two = named(s, b);
        return one->priority == two->priority && oracle_overlap(o, one, two, ORACLE_LINES, 0.0);
    }
    if (sscanf(n->text, "the gap between %63s and %63s is about", a, b) == 2) {
        t->gaps++;
        return oracle_gap(o, named(s, a), named(s, b));
    }
    if (sscanf(n->text, "%63s is entirely inside %63[^,]", a, b) == 2) {
        t->covers++;
        return oracle_covers(o, named(s, b), named(s, a));
    }
    if (strcmp(n->place, "camera.position") == 0) {
        t->cameras++;
        return camera_is_lost(o, n->text);
    }
    if (strcmp(n->place, "render.depth") == 0) {
        t->depths++;
        if (strstr(n->text, "of the pixels"))
            return depth_shows(j, s, 4 + (sscanf(n->remedy, "set render.depth=%d", &depth) == 1 ? depth : 4));
        return depth_lacks(j, s);
    }
    if (strstr(n->text, "is transparent with the refractive index") && sscanf(n->text, "%63s", a) == 1) {
        t->indices++;
        return oracle_bends_nothing(o, named(s, a));
    }
    t->others++;
    if (sscanf(n->text, "%63s acts as a point", a) == 1)
        for (size_t i = 0; i < s->light_count; i++)
            if (strcmp(s->lights[i].name, a) == 0)
                return light_extent(&s->lights[i]) > 0.0 && s->render.integrator != INTEGRATOR_PATH;
    return strcmp(n->place, "lights") == 0 && s->light_count == 0;
}

static bool is_noted(const note_list *all, const char *a, const char *b)
{
    for (int i = 0; i < all->count; i++) {
        char one[SCENE_NAME_MAX + 1], two[SCENE_NAME_MAX + 1];
        if ((strstr(all->note[i].text, "overlap with") && sscanf(all->note[i].text, "%63s and %63s", one, two) == 2) ||
            sscanf(all->note[i].text, "%63s is entirely inside %63[^,]", one, two) == 2)
            if ((!strcmp(one, a) && !strcmp(two, b)) || (!strcmp(one, b) && !strcmp(two, a)))
                return true;
    }
    return false;
}

/* Counts overlaps that a few random lines of the oracle find. */
static void count_unseen(oracle *o, const scene *s, const note_list *all, tallies *t)
{
    for (size_t i = 0; i < s->solid_count; i++)
        for (size_t k = i + 1; k < s->solid_count; k++) {
            const solid *a = &s->solids[i], *b = &s->solids[k];
            const bool clear = a->surface.transparency > 0.0 || b->surface.transparency > 0.0;
            const bool planes = a->shape.kind == SHAPE_PLANE && b->shape.kind == SHAPE_PLANE;
            const bool one_index =
                a->surface.transparency > 0.0 && b->surface.transparency > 0.0 && a->surface.ior == b->surface.ior;
            if (a->priority != b->priority || !clear || one_index || planes || !oracle_overlap(o, a, b, 20, 1e-4))
                continue;
            t->pairs++;
            t->unseen += !is_noted(all, a->name, b->name);
        }
}

/* print_message has a limited buffer: prints line by line. */
static void print_lines(const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, "\n");
        print_message("  %.*s\n", (int)length, text);
        text += length + (text[length] == '\n');
    }
}

static void try_scene(judge *j, long number, long seed, tallies *t)
{
    uint64_t stream = (uint64_t)seed * 0x9e3779b97f4a7c15u + (uint64_t)number;
    random_bits(&stream);
    law_scene w = random_law_scene(&stream, "depth: 4, threads: 1");
    for (int i = 0; i < w.solid_count; i++) { /* the oracle knows level solids, conics, plain media and lamps nearby */
        law_solid *one = &w.solid[i];
        one->gold = false;
        one->film_nm = one->extraordinary_ior = one->shape.capillary_length = 0.0;
        one->shape.diameter_1 = one->shape.diameter_2 = one->shape.chamfer_1 = one->shape.chamfer_2 = 0.0;
        if (!one->mesh)
            one->shape.scale = vec3_make(1.0, 1.0, 1.0);
        for (int k = 0; k < 9; k++)
            one->shape.even_1[k] = one->shape.even_2[k] = one->shape.odd_1[k] = one->shape.odd_2[k] = 0.0;
        one->shape.form_1 = one->shape.form_2 = SIDE_ROUND;
    }
    for (int i = 0; i < w.light_count; i++)
        if (is_sun(&w.light[i]))
            w.light[i].kind = NULL;
    for (int i = 0; i < w.solid_count; i++) /* solving a quartic in quadruple precision takes long */
        if (w.solid[i].shape.kind == SHAPE_TORUS && random_below(&stream, 16))
            w.solid[i].shape.kind = SHAPE_SPHERE;
    scene *s = law_load(&w);
    set_all(s, "render.width=80 render.height=64");
    if (scene_check(s, NULL) != STATUS_OK) {
        t->skipped++;
        scene_destroy(s);
        return;
    }
    oracle o = {s, stream};
    const note_list all = lint(s);
    t->scenes++;
    t->silent += all.count == 0;
    for (int i = 0; i < all.count; i++) {
        t->notes++;
        if (is_true(&o, j, s, &all.note[i], t))
            continue;
        if (t->untrue++ < 5) {
            print_message("not true, LINT_SEED=%ld scene %ld: %s: %s\n", seed, number, all.note[i].place,
                          all.note[i].text);
            print_lines(law_text(&w).at);
        }
    }
    count_unseen(&o, s, &all, t);
    scene_destroy(s);
}

static void notes_on_random_scenes_are_true(void **state)
{
    (void)state;
    const char *count = getenv("LINT_SCENES"), *from = getenv("LINT_SEED"), *first = getenv("LINT_FIRST");
    const char *laws = getenv("LAWS_SCENES"); /* fewer scenes under sanitizers and valgrind */
    const long scenes = count  ? strtol(count, NULL, 10)
                        : laws ? strtol(laws, NULL, 10) / 10
                               : 1000,
               seed = from ? strtol(from, NULL, 10) : 1;
    tallies t = {0};
    judge j = judge_open();
    for (long number = first ? strtol(first, NULL, 10) : 0; t.scenes < scenes; number++)
        try_scene(&j, number, seed, &t);
    judge_close(&j);
    print_message(
        "%ld random legal scenes (%ld more were not legal), %ld without a note; %ld notes: overlaps %ld, gaps %ld, "
        "covered %ld, "
        "camera %ld, index %ld, depth %ld, others %ld; not true: %ld; overlapping pairs %ld, of which without a "
        "note %ld\n",
        t.scenes, t.skipped, t.silent, t.notes, t.overlaps, t.gaps, t.covers, t.cameras, t.indices, t.depths, t.others,
        t.untrue, t.pairs, t.unseen);
    assert_int_equal(t.untrue, 0);
    if (!(t.overlaps > 0 && t.gaps > 0 && t.covers > 0 && t.cameras > 0 && t.depths > 0))
        fail_msg("a kind of note is missing above (0): the scenes are too few, or it is never said");
    assert_true(50 * t.unseen <= t.pairs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlaps_of_equal_priority_and_different_media_are_noted),
        cmocka_unit_test(narrow_gaps_are_noted),
        cmocka_unit_test(indices_above_those_of_materials_are_noted),
        cmocka_unit_test(cameras_inside_opaque_solids_are_noted),
        cmocka_unit_test(an_insufficient_depth_is_noted_with_the_sufficient_one),
        cmocka_unit_test(a_depth_too_expensive_to_check_gives_no_note),
        cmocka_unit_test(light_of_faint_rays_is_not_taken_as_lost),
        cmocka_unit_test(only_entirely_covered_solids_are_noted),
        cmocka_unit_test(shipped_scenes_have_only_true_notes),
        cmocka_unit_test(a_frame_is_the_same_after_the_linter),
        cmocka_unit_test(notes_on_random_scenes_are_true),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
