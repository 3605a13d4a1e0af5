/* Every parameter has an effect, or a note explains why not: for each shipped scene and each parameter that `cuvette
 * params SCENE` prints, other legal values change the film, or a note states why none does, or the table marks the
 * parameter as not affecting the image. A note is proved by its remedy: once the remedy is applied, the parameter
 * changes the film. New parameters of the table are covered automatically. ACTS_SCENE=rod.yaml tests that scene alone.
 * ACTS_SLICE=2/12 tests every twelfth scene, mode, condition and setting from the third on, and writes the notes that
 * it saw to the file ACTS_NOTES; ACTS_SLICE=notes tests that the slices of that file have proved each of them.
 * ACTS_VERBOSE=1 lists parameters of which only one value has an effect, and remedies that do not help.
 * ACTS_PATH=lamp.radius tests parameters of that name alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "acts_conditions.h"
#include "acts_judge.h"
#include "lint/inert.h"
#include "scene/model/medium.h"
#include <glob.h>
#include <pthread.h>
#include <stdatomic.h>

/* --- jobs on two threads, each with its own tally --- */

/* Which jobs run: those whose number has the remainder `at` when divided by `of`; none if `of` is 0. */
static struct {
    int at, of;
} slice = {0, 1};

static void read_slice(void)
{
    const char *text = getenv("ACTS_SLICE");
    if (!text || !*text)
        return;
    slice.at = slice.of = 0;
    if (strcmp(text, "notes") != 0 &&
        (sscanf(text, "%d/%d", &slice.at, &slice.of) != 2 || slice.at < 0 || slice.at >= slice.of)) {
        fprintf(stderr, "test_acts: ACTS_SLICE=%s is neither K/N with 0 <= K < N nor \"notes\"\n", text);
        exit(2);
    }
}

typedef void job(int number, tally *out);
typedef struct bench {
    job *job;
    tally *tallies;
    int count;
    atomic_int next;
} bench;

static tally tallies[JOBS_MAX], all;

static void *work(void *context)
{
    bench *b = context;
    for (int i; (i = atomic_fetch_add(&b->next, 1)) < b->count;)
        if (slice.of > 0 && i % slice.of == slice.at)
            b->job(i, &b->tallies[i]);
    return NULL;
}

static void run(job *one, int count)
{
    pthread_t other;
    bench b = {.job = one, .tallies = tallies, .count = count};
    assert_true(count <= JOBS_MAX);
    memset(tallies, 0, sizeof tallies);
    assert_int_equal(pthread_create(&other, NULL, work, &b), 0);
    work(&b);
    pthread_join(other, NULL);
}

static glob_t shipped;

static void try_scene(int number, tally *out)
{
    acts a;
    diagnostic why = {.what = ""};
    out->path = shipped.gl_pathv[number];
    if (getenv("ACTS_SCENE") && !strstr(out->path, getenv("ACTS_SCENE")))
        return;
    if (!acts_open(out->path, &a, &why)) {
        complain(out, "", "cannot be rendered", why.what);
        return;
    }
    visitor x = {&a, out};
    scene_each_param(a.s, try_parameter, &x);
    acts_close(&a);
}

/* Render modes in which light continues from surfaces. */
static const char *const modes[] = {
    "render.integrator=path render.paths=4",
    "render.integrator=path render.paths=4 render.polarisation=on",
    "render.integrator=aov",
    "render.integrator=aov render.layer=albedo",
    "render.integrator=aov liquid.capillary_length=0.1",
    "render.transmission=simple clear.transparency=0.8 clear.reflectivity=0.1",
    "render.weights=constant clear.transparency=0.8 clear.reflectivity=0.1",
    "render.spectrum=spectral render.wavelengths=4",
    "render.polarisation=on",
    "render.radiance=basic",
    "render.caustics=photons render.photons=2000",
};

static bool open_with(const char *name, const char *assignments, acts *out, diagnostic *why);

static void try_mode(int number, tally *out)
{
    acts a;
    diagnostic why = {.what = ""};
    out->path = modes[number];
    if (!open_with("rod", modes[number], &a, &why)) {
        complain(out, "", "cannot be rendered", why.what);
        return;
    }
    visitor x = {&a, out};
    scene_each_param(a.s, try_parameter, &x);
    acts_close(&a);
}

/* --- facts that no shipped scene has, and remedies that are not an assignment --- */

static bool open_with(const char *name, const char *assignments, acts *out, diagnostic *why)
{
    char path[200];
    snprintf(path, sizeof path, "experiments/scenes/%s.yaml", name);
    acts whole;
    if (!acts_open(path, &whole, why))
        return false;
    scene *s = scene_clone(whole.s);
    acts_close(&whole);
    if (s && acts_resize(s, 120) && acts_set_all(s, assignments, why))
        return acts_of(s, out, why);
    scene_destroy(s);
    return false;
}

/* Allocates the values of a parameter of the scene. */
static const param *values_at(const acts *a, const char *path, acts_values *v)
{
    param_place at;
    char *now = NULL;
    if (param_place_find(a->s, path, &at, NULL) != STATUS_OK || scene_get(a->s, path, &now, NULL) != STATUS_OK)
        return NULL;
    acts_values_of(a->s, at.row, now, v);
    free(now);
    return at.row;
}

static void try_condition(int number, tally *out)
{
    const condition *k = &conditions[number];
    if (!is_selected(k->path))
        return;
    acts a;
    diagnostic why = {.what = ""};
    acts_values v;
    inert_answer answer;
    out->path = k->scene;
    if (!open_with(k->scene, k->assignments, &a, &why)) {
        complain(out, k->assignments, "cannot be rendered", why.what);
        return;
    }
    const param *row = values_at(&a, k->path, &v);
    if (!row || !acts_ask(&a, k->path, &answer) || strcmp(answer.rule, k->rule) != 0)
        complain(out, k->path, "the note that is expected is not said", k->rule);
    else {
        rule_count *rule = count_of(out, k->rule, row->name);
        const bool helped = k->works && remedy_works(&a, k->path, row, &answer);
        rule->reported++;
        if (helped)
            prove(rule);
        snprintf(rule->where, sizeof rule->where, "%s %s, %s", k->scene, k->assignments, k->path);
        drop_special_indices(&answer, row, &v);
        if (acts_try(&a, k->path, &v, 0, 1).changed > 0)
            complain(out, k->path, "acts, and yet a note says that it does not", answer.note.text);
        if (k->works && !helped)
            complain(out, k->path, "the note's remedy does not help", answer.note.remedy);
    }
    acts_close(&a);
}

static void try_counterpart(int number, tally *out)
{
    const counterpart *k = &counterparts[number];
    if (!is_selected(k->path))
        return;
    acts a;
    diagnostic why = {.what = ""};
    acts_values v;
    inert_answer answer;
    out->path = k->scene;
    if (!open_with(k->scene, k->assignments, &a, &why)) {
        complain(out, k->path, "cannot be rendered", why.what);
        return;
    }
    const param *row = values_at(&a, k->path, &v);
    if (!row || acts_ask(&a, k->path, &answer) || acts_try_sizes(&a, k->path, &v, 1).changed == 0)
        complain(out, k->path, "is to act without a note, where the condition is false", k->rule);
    else {
        rule_count *rule = count_of(out, k->rule, row->name);
        prove(rule);
        snprintf(rule->where, sizeof rule->where, "%s %s", k->scene, k->path);
    }
    acts_close(&a);
}

static void add_rules(const tally *one)
{
    for (int i = 0; i < one->rule_count; i++) {
        rule_count *r = count_of(&all, one->rules[i].rule, one->rules[i].name);
        r->reported += one->rules[i].reported;
        r->proved += one->rules[i].proved;
        if (one->rules[i].proved && !r->where[0])
            memcpy(r->where, one->rules[i].where, sizeof r->where);
    }
}

static void add_tally(const tally *one)
{
    if (one->tried == 0 && one->bad == 0) /* not selected */
        return;
    printf("# %-38s tried %4d, acting %3d, noted %3d, refused %d, marked %2d, unexplained or wrong %d\n", one->path,
           one->tried, one->acting, one->noted, one->refused, one->marked, one->bad);
    printf("%s", one->text);
    all.tried += one->tried, all.acting += one->acting, all.by_one += one->by_one, all.noted += one->noted;
    all.refused += one->refused, all.marked += one->marked, all.bad += one->bad;
    add_rules(one);
}

static void every_parameter_of_every_shipped_scene_changes_the_film_or_has_a_note(void **state)
{
    (void)state;
    assert_int_equal(glob("experiments/scenes/*.yaml", 0, NULL, &shipped), 0);
    assert_int_equal(glob("tests/data/acts/*.yaml", GLOB_APPEND, NULL, &shipped), 0);
    const int count = (int)shipped.gl_pathc;
    run(try_scene, count);
    for (int i = 0; i < count; i++)
        add_tally(&tallies[i]);
    printf("# all: tried %d, acting %d (%d by one value alone), noted %d, refused with a remedy %d, marked %d, "
           "unexplained: %d\n",
           all.tried, all.acting, all.by_one, all.noted, all.refused, all.marked, all.bad);
    globfree(&shipped);
    assert_int_equal(all.bad, 0);
}

static void every_parameter_changes_the_film_or_has_a_note_in_every_render_mode(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    const int count = sizeof modes / sizeof *modes;
    int bad = 0;
    run(try_mode, count);
    for (int i = 0; i < count; i++) {
        const tally *x = &tallies[i];
        if (x->tried == 0 && x->bad == 0) /* not in this slice */
            continue;
        printf("# rod, %s: tried %d, acting %d (%d by one value alone), noted %d, unexplained: %d\n%s", x->path,
               x->tried, x->acting, x->by_one, x->noted, x->bad, x->text);
        add_rules(x);
        bad += x->bad;
    }
    assert_int_equal(bad, 0);
}

static void add_jobs(job *one, int count)
{
    int bad = 0;
    run(one, count);
    for (int i = 0; i < count; i++) {
        printf("%s", tallies[i].text);
        add_rules(&tallies[i]);
        bad += tallies[i].bad;
    }
    assert_int_equal(bad, 0);
}

/* --- conditions on another parameter: each row of lint/needs.c --- */

#define SIZED "render.integrator=path render.paths=4 lamp.reach=8 lamp.radius=0.3"
static const struct {
    const char *scene, *assignments;
} homes[] = {
    {"rod", "render.photons=2000"},
    {"rod", SIZED},
    {"rod", "render.samples=4 background.image=models.jpg background.kind=rain"},
    {"rod", "render.polarisation=on lamp.polarised=1 render.caustics=photons render.photons=2000"},
    {"shapes", "render.integrator=path render.paths=4"},
    {"magnifier", "render.caustics=photons render.photons=2000 sun.lights=on"},
    {"models", ""},
    {"slime", ""},
    {"slime", "toy.script= toy.ground=off"},
    {"rainbow-landscape", ""},
    {"meniscus", ""},
    {"../../tests/data/acts/faces", ""}, /* a mesh from a file */
};

/* The path of the parameter that the row needs, for an object of that name; returns where its sign is. */
static const char *needed_path(const needs_row *r, const char *object, char path[NOTE_PLACE_MAX])
{
    const size_t length = strcspn(r->needs, "=!>");
    const bool full = memchr(r->needs, '.', length) != NULL;
    snprintf(path, NOTE_PLACE_MAX, "%s%s%.*s", full ? "" : object, full ? "" : ".", (int)length, r->needs);
    return r->needs + length;
}

/* Values with which the need is not met. */
static void unmet_values(const needs_row *r, const char *sign, const param *row, acts_values *v)
{
    static const char *const others[] = {"0.5", "400,0.1,700,0.5", "1,-0.2,0"};
    char text[80];
    v->count = 0;
    if (*sign != '=') {
        const char *value = sign + 1 + (*sign == '!');
        snprintf(text, sizeof text, "%.*s", (int)strcspn(value, "|"), value);
        acts_add(v, "", text);
        return;
    }
    for (size_t i = 0; row->choices && row->choices[i]; i++)
        if (!strstr(r->needs, row->choices[i]))
            acts_add(v, "", row->choices[i]);
    for (size_t i = 0; !row->choices && i < 3; i++)
        acts_add(v, "", others[i]);
}

/* Follows the remedies of other notes until the row's note is said. */
static bool is_said(scene *s, const char *path, const needs_row *r, inert_answer *answer)
{
    for (int i = 0; i < 5 && param_is_inert(s, path, NULL, answer); i++) {
        if (strcmp(answer->rule, r->needs) == 0)
            return true;
        if (!acts_set_all(s, answer->note.remedy, NULL))
            return false;
    }
    return false;
}

/* Whether the film shows that the row is right where that assignment does not meet it. A false note is a complaint. */
static bool proves(const scene *home, const char *path, const needs_row *r, const char *assignment, tally *out)
{
    acts a = {.s = NULL};
    inert_answer answer;
    acts_values v;
    scene *s = scene_clone(home);
    if (!acts_set_all(s, assignment, NULL) || !is_said(s, path, r, &answer)) {
        scene_destroy(s);
        return false;
    }
    if (!acts_of(s, &a, NULL))
        return false;
    const param *row = values_at(&a, path, &v);
    bool proved = row && remedy_works(&a, path, row, &answer);
    if (proved && acts_try(&a, path, &v, 0, 1).changed > 0) {
        complain(out, path, "acts, and yet a note says that it does not", answer.note.text);
        proved = false;
    }
    acts_close(&a);
    return proved;
}

static bool home_proves(const scene *home, const needs_row *r, const char *name, tally *out)
{
    for (size_t i = 0; i < param_place_group_size(home, r->group); i++) {
        const char *object = param_place_group_name(home, r->group, i);
        char path[NOTE_PLACE_MAX], needed[NOTE_PLACE_MAX], assignment[NOTE_TEXT_MAX];
        param_place at, needed_at;
        acts_values v;
        snprintf(path, sizeof path, "%s.%s", object, name);
        const char *sign = needed_path(r, object, needed);
        if (param_place_find(home, path, &at, NULL) != STATUS_OK ||
            param_place_find(home, needed, &needed_at, NULL) != STATUS_OK)
            continue;
        const param *row = at.row;
        unmet_values(r, sign, needed_at.row, &v);
        for (int k = 0; k < v.count; k++) {
            snprintf(assignment, sizeof assignment, "%s=%.100s", needed, v.text[k]);
            if (proves(home, path, r, assignment, out)) {
                rule_count *rule = count_of(out, r->needs, row->name);
                prove(rule);
                snprintf(rule->where, sizeof rule->where, "%.100s, %.100s", path, assignment);
                return true;
            }
        }
    }
    return false;
}

static void try_need(const needs_row *r, const char *name, tally *out)
{
    for (size_t h = 0; h < sizeof homes / sizeof *homes; h++) {
        acts home;
        if (!open_with(homes[h].scene, homes[h].assignments, &home, NULL))
            continue;
        const bool proved = home_proves(home.s, r, name, out);
        acts_close(&home);
        if (proved)
            return;
    }
    complain(out, name, "no scene shows that it has an effect only if", r->needs);
}

static void try_row(int number, tally *out)
{
    size_t count;
    const needs_row *r = &needs_rows(&count)[number];
    char names[300], *rest = names;
    if (!r->needs)
        return;
    out->path = param_group_name(r->group);
    snprintf(names, sizeof names, "%s", r->names[0] == '*' ? "position" : r->names);
    for (char *name; (name = strtok_r(rest, " ", &rest));)
        if (is_selected(name))
            try_need(r, name, out);
}

static void every_condition_of_the_table_decides(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    size_t count;
    needs_rows(&count);
    add_jobs(try_row, (int)count);
}

static void remedies_of_rare_notes_make_their_parameters_effective(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    add_jobs(try_condition, sizeof conditions / sizeof *conditions);
    add_jobs(try_counterpart, sizeof counterparts / sizeof *counterparts);
}

/* The notes of slices, a line each: rule, name, how often reported and proved. */
static void write_notes(FILE *file)
{
    for (int i = 0; i < all.rule_count; i++)
        fprintf(file, "%s %s %d %d\n", all.rules[i].rule, all.rules[i].name, all.rules[i].reported,
                all.rules[i].proved);
}

static void add_notes(FILE *file)
{
    static char words[2 * RULES_MAX][80]; /* the tallies keep pointers */
    int reported, proved;
    for (int i = 0; fscanf(file, "%79s %79s %d %d", words[2 * i], words[2 * i + 1], &reported, &proved) == 4;) {
        const int before = all.rule_count;
        rule_count *r = count_of(&all, words[2 * i], words[2 * i + 1]);
        r->reported += reported, r->proved += proved;
        i += all.rule_count > before;
        assert_true(i < RULES_MAX);
    }
    assert_true(all.rule_count > 0);
}

static void visit_notes(const char *mode, void (*visit)(FILE *))
{
    FILE *file = fopen(getenv("ACTS_NOTES"), mode);
    assert_non_null(file);
    visit(file);
    assert_int_equal(fclose(file), 0);
}

/* Of the cases before, or of the slices that have run. */
static void the_remedy_of_each_note_was_seen_to_make_a_parameter_effective(void **state)
{
    (void)state;
    if (slice.of > 1 && getenv("ACTS_NOTES"))
        visit_notes("w", write_notes);
    else if (slice.of == 0)
        visit_notes("r", add_notes);
    if (getenv("ACTS_SCENE") || getenv("ACTS_PATH") || slice.of > 1)
        skip();
    int unproved = 0;
    for (int i = 0; i < all.rule_count; i++) {
        const rule_count *r = &all.rules[i];
        printf("# %-16s %-16s said %3d, proved in %s\n", r->rule, r->name, r->reported, r->where);
        if (r->proved == 0)
            printf("# %s of %s is not proved: give it a remedy that is an assignment, or add it to the counterparts\n",
                   r->rule, r->name);
        unproved += r->proved == 0;
    }
    assert_int_equal(unproved, 0);
}

/* --- other settings: every parameter that has a note under them is without effect --- */

static const struct {
    const char *scene, *assignments;
} settings[] = {
    {"rod", "render.integrator=path render.paths=2"},
    {"rod", "render.integrator=path render.paths=2 lamp.reach=8 lamp.radius=0.3"},
    {"rod", "render.integrator=path render.paths=2 render.polarisation=on liquid.sheet=retarder"},
    {"rod", "render.integrator=raycast"},
    {"rod", "render.integrator=zbuffer"},
    {"rod", "render.integrator=zbuffer render.lighting=phong"},
    {"rod", "render.integrator=raycast render.shadows=off"},
    {"rod", "render.lighting=phong"},
    {"rod-from-inside", "render.lighting=phong render.shadows=off"},
    {"rod", "clear.ior=1 liquid.ior=1"},
    {"absorber", "liquid.ior=1 liquid.color=0.5,0.5,0.5"},
    {"rod", "render.spectrum=spectral render.wavelengths=4"},
    {"rod", "render.weights=constant clear.transparency=0.8 clear.reflectivity=0.1"},
    {"rod", "render.transmission=simple clear.transparency=0.8 clear.reflectivity=0.1"},
    {"rod", "render.polarisation=on vessel.medium=bk7"},
    {"rod", "render.depth=0 render.beyond=black"},
    {"rod", "render.lighting=lambert vessel.ior=1e9"},
    {"rod", "render.shadows=off rod.checker=0.2 rod.priority=0"},
    {"rod", "lamp.intensity=0 background.ambient=0,0,0 clear.color=0.9,0.8,0.7"},
    {"solids", "render.integrator=zbuffer key.kind=cone"},
    {"solids", "render.integrator=path render.paths=1 render.roulette=on glass.diffuse=0.2"},
    {"solids", "background.image=models.jpg clay.transparency=0.3"},
    {"models", "render.integrator=zbuffer render.texturing=affine"},
    {"models", "render.integrator=path render.paths=1 silver.texture=tiles"},
    {"models", "bowl.visible=off lamp.intensity=0 render.shadows=opaque"},
    {"vessel-mesh", "render.weights=constant clear.transparency=0.5 render.integrator=raycast"},
    {"slime", "toy.script= toy.time_s=0 toy.ground=off"},
    {"solids", "glass.emission=0.2 steel.color=0,0,0 background.ambient=0,0,0 key.intensity=0 fill.intensity=0"},
};

typedef struct truth {
    acts *a;
    tally *out;
} truth;

static status try_note(void *context, const char *path, const param *row, const char *value)
{
    truth *x = context;
    acts_values v;
    inert_answer answer;
    char line[NOTE_LINE_MAX];
    if (!is_selected(path) || !param_is_inert(x->a->s, path, NULL, &answer))
        return STATUS_OK;
    acts_values_of(x->a->s, row, value, &v);
    drop_special_indices(&answer, row, &v);
    v.count = v.count < 4 ? v.count : 4;
    x->out->noted++;
    if (acts_try(x->a, path, &v, 0, 1).changed > 0)
        complain(x->out, path, "acts, and yet a note says that it does not",
                 note_line(&answer.note, line, sizeof line));
    return STATUS_OK;
}

static void try_setting(int number, tally *out)
{
    acts a;
    diagnostic why = {.what = ""};
    out->path = settings[number].assignments;
    if (!open_with(settings[number].scene, settings[number].assignments, &a, &why)) {
        complain(out, settings[number].scene, "cannot be rendered", why.what);
        return;
    }
    scene_each_param(a.s, try_note, &(truth){&a, out});
    acts_close(&a);
}

static void parameters_with_a_note_have_no_effect_under_other_settings(void **state)
{
    (void)state;
    if (getenv("ACTS_SCENE"))
        skip();
    const int count = sizeof settings / sizeof *settings;
    int noted = 0, bad = 0;
    run(try_setting, count);
    for (int i = 0; i < count; i++) {
        printf("%s", tallies[i].text);
        noted += tallies[i].noted, bad += tallies[i].bad;
    }
    printf("# other settings: %d notes, %d false\n", noted, bad);
    assert_int_equal(bad, 0);
}

int main(void)
{
    read_slice();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_condition_of_the_table_decides),
        cmocka_unit_test(remedies_of_rare_notes_make_their_parameters_effective),
        cmocka_unit_test(every_parameter_of_every_shipped_scene_changes_the_film_or_has_a_note),
        cmocka_unit_test(every_parameter_changes_the_film_or_has_a_note_in_every_render_mode),
        cmocka_unit_test(the_remedy_of_each_note_was_seen_to_make_a_parameter_effective),
        cmocka_unit_test(parameters_with_a_note_have_no_effect_under_other_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
